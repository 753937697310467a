"""Figures for every reader: colours that a deuteranope tells apart, and a sentence for those who see none."""

import itertools

import numpy as np
import pytest
from colours import DEUTERANOPE, contrast, distance, lab, linear
from IPython.display import HTML

from cosserat.figures import crawlers, style
from cosserat.thesis.book import page
from cosserat.thesis.figures.catalogue import FIGURES

ENTRIES = list(FIGURES.items())


def test_the_measure_of_colours_is_the_published_one():
    assert lab(np.ones(3)) == pytest.approx([100, 0, 0], abs=1e-4)
    assert lab(linear("#ff0000")) == pytest.approx([53.24, 80.09, 67.20], abs=0.02)
    assert np.allclose(DEUTERANOPE.sum(axis=1), 1, atol=1e-5), "grey stays grey"
    assert contrast("#767676") == pytest.approx(4.54, abs=5e-3)
    assert distance("#c4501b", "#7a7a00") < 12, "an olive would be taken for vermilion"


@pytest.mark.parametrize(("one", "other"), list(itertools.combinations(style.CURVES, 2)))
def test_a_deuteranope_tells_any_two_colours_of_curves_apart(one, other):
    assert distance(one, other) >= 20


@pytest.mark.parametrize(
    "colour", [*style.CURVES, *crawlers.FRONTS.values(), *crawlers.STRETCHES.values(), crawlers.ANCHOR]
)
def test_a_colour_of_curves_is_dark_enough_for_text(colour):
    assert contrast(colour) >= 4.5


@pytest.mark.parametrize(("name", "entry"), ENTRIES, ids=list(FIGURES))
def test_a_figure_says_in_a_sentence_of_its_own_what_is_seen(name, entry):
    assert len(entry.alt) >= 40
    assert entry.alt[0].isupper()
    assert entry.alt.endswith(".")
    assert entry.title.rstrip(".") not in entry.alt
    assert not any(letter.isdigit() for letter in entry.alt), "a number is computed, or it is no picture"
    assert [other for other, found in ENTRIES if found.alt == entry.alt] == [name]


def test_the_book_shows_a_figure_with_its_sentence_and_not_its_title(tmp_path, monkeypatch):
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures/fig_3_12.svg").write_text("<svg/>")
    monkeypatch.setattr(page, "results", lambda: tmp_path)
    shown = page.figure("fig_3_12", "a caption")
    assert isinstance(shown, HTML)
    assert f'alt="{FIGURES["fig_3_12"].alt}"' in shown.data
    assert shown.data.count(FIGURES["fig_3_12"].title) == 1
