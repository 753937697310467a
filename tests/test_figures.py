"""Figures: each is drawn from its cases, the same bytes twice, and shows what the table judges."""

import numpy as np
import pytest

from cosserat.errors import InputError
from cosserat.figures.catalogue import FIGURES, draw, draw_to
from cosserat.figures.style import write
from cosserat.table import readouts


@pytest.mark.parametrize("name", list(FIGURES))
def test_each_figure_is_the_same_twice(solved, name, tmp_path):
    for number in (1, 2):
        write(
            draw(name, {case: solved[case] for case in FIGURES[name].cases}), tmp_path / f"{number}.svg"
        )
    first = (tmp_path / "1.svg").read_bytes()
    assert first == (tmp_path / "2.svg").read_bytes()
    assert b"<dc:date>" not in first
    assert sorted(file.name for file in tmp_path.iterdir()) == ["1.svg", "2.svg"]


def curves(ax):
    return {line.get_label(): line.get_xydata() for line in ax.get_lines()}


def test_beam_figures_plot_the_computed_and_the_analytic_curve_in_millimetres(solved):
    figure = draw("fig_3_10", {case: solved[case] for case in FIGURES["fig_3_10"].cases})
    computed, exact = readouts.clamped_free_curve(solved["clamped_free"])
    shown = curves(figure.axes[0])
    np.testing.assert_allclose(shown["end areas full"][:, 1], computed * 1e3)
    np.testing.assert_allclose(shown["eq. (3.5.3)"][-1], [5.0, exact[-1] * 1e3])
    directors, exact_directors = readouts.clamped_free_directors(solved["clamped_free"])
    shown = curves(figure.axes[1])
    np.testing.assert_allclose(shown["end areas full"][:, 1], directors * 1e3)
    np.testing.assert_allclose(shown["eq. (3.5.4)"][-1, 1], exact_directors[-1] * 1e3)


def test_every_axis_of_a_graph_has_a_unit(solved):
    for name, entry in FIGURES.items():
        if name.startswith("anim_"):
            continue
        for ax in draw(name, {case: solved[case] for case in entry.cases}).axes:
            assert "[" in ax.get_xlabel(), name
            assert "[" in ax.get_ylabel() or not ax.get_yticks().size, (
                name
            )  # bodies below each other have no axis


def test_unknown_figures_are_refused(tmp_path):
    with pytest.raises(InputError, match="there is no figure"):
        draw("fig_3", {})
    with pytest.raises(InputError, match="does not exist"):
        draw_to("fig_3_8", tmp_path, tmp_path / "none" / "f.svg")
