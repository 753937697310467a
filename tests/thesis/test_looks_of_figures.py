"""Figures for every reader: a sentence for those who cannot see them."""

import pytest
from IPython.display import HTML

from cosserat.thesis.book import page
from cosserat.thesis.figures.catalogue import FIGURES

ENTRIES = list(FIGURES.items())


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
