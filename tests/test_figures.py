"""Figures: each is drawn from its cases, the same bytes twice, and shows what the table judges."""

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError
from cosserat.figures import motion, rod
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


def arrows(ax):
    """Directions of the arrows by the name beside their tips, rounded; and how many stand in rows without a name."""
    drawn, named, plain = [], {}, 0
    for text in ax.texts:
        if text.arrow_patch is not None:
            drawn.append(np.array(text.xy) - np.array(text.get_position()))
        elif drawn:
            named.setdefault(text.get_text(), []).append(drawn.pop())
            plain, drawn = plain + len(drawn), []
    return named, plain + len(drawn)


def test_loads_are_drawn_where_they_act_and_along_their_directions():
    case = cosserat.case("clamped_free").vary(
        "loaded",
        gravity={"g": 0.0, "along": "-E2"},
        forces=[{"at": "last", "along": "E2", "force": 2e4}, {"at": 7, "along": "E2", "force": -1e4}],
        couples=[{"at": "last", "moment": 1e4}],
    )
    data = cosserat.run(case)
    top = rod.picture(data).axes[-1]
    named, _ = arrows(top)
    assert set(named) == {"$n$", "$M$"}
    (up, down) = named["$n$"]
    assert up[1] > 0 > down[1]
    assert up[0] == down[0] == 0
    feet = [t.get_position() for t in top.texts if t.arrow_patch is not None][:2]
    x = data.x_ref + (data.x - data.x_ref) * rod.magnification(data.u.to_numpy(), 5.0)
    np.testing.assert_allclose(feet, x.to_numpy()[[-1, 7]])
    pressed = case.vary(
        "pressed",
        gravity={"g": 9.81, "along": "-E2"},
        forces=[{"at": "last", "along": "-E3", "force": 1.0}],
        couples=[],
        line_loads=[{"along": "-E2", "density": 5.0, "start": 1.0, "end": 2.0}],
    )
    top = rod.picture(cosserat.run(pressed)).axes[-1]
    named, plain = arrows(top)
    assert set(named) == {"$g$", "$n$"}
    assert plain == 9
    assert named["$n$"][0][0] < 0
    assert named["$g$"][0][1] < 0


def test_a_motion_is_drawn_as_bodies(solved):
    left = motion.picture(solved["relaxing_clamped_free"]).axes[0]
    bodies = [patch for patch in left.patches if len(patch.get_xy()) > 40]
    assert len(bodies) == 7
    tip = [patch.get_xy()[19, 1] - patch.get_xy()[20, 1] for patch in bodies]  # upper less lower surface
    np.testing.assert_allclose(tip, 0.5, rtol=1e-2)


def test_unknown_figures_are_refused(tmp_path):
    with pytest.raises(InputError, match="there is no figure"):
        draw("fig_3", {})
    with pytest.raises(InputError, match="does not exist"):
        draw_to("fig_3_8", tmp_path, tmp_path / "none" / "f.svg")
