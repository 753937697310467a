"""Signs of supports, springs and masses in pictures: each is drawn at its place and in its direction."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import cosserat
from cosserat.figures.supports import draw_masses, draw_supports

SLOPE = np.radians(30)
SIZE = 0.022


def drawn(**changes):
    """Closed shapes and lines, as points, of the signs on a straight rod of 1 m."""
    problem = cosserat.case("elastica").vary("it", **{"supports": [], **changes}).problem
    ax, geometry = Figure().add_subplot(), problem.geometry
    draw_supports(ax, problem, geometry.X, geometry.D)
    draw_masses(ax, problem, geometry.X, geometry.D)
    return [patch.get_xy()[:-1] for patch in ax.patches], [line.get_xydata() for line in ax.lines]


def test_a_roller_is_a_wheel_on_a_line_along_which_it_rolls():
    shapes, lines = drawn(supports=[{"at": "last", "fixed": "roller", "along": "30 deg"}])
    normal = np.array([-np.sin(SLOPE), np.cos(SLOPE)])
    np.testing.assert_allclose(shapes[0].mean(axis=0), [1, 0] - SIZE * normal, atol=1e-12)
    along = np.diff(lines[0], axis=0)[0]
    assert along @ normal == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose(lines[0].mean(axis=0), [1, 0] - 2 * SIZE * normal, atol=1e-12)


@pytest.mark.parametrize(
    ("word", "shapes", "bars"),
    [
        ("clamped", 0, [3]),
        ("clamped, free to stretch", 0, [1.2]),
        ("pinned", 1, []),
        ("guided", 1, [1.2]),
    ],
)
def test_each_word_has_its_sign(word, shapes, bars):
    found, _ = drawn(supports=[{"at": "50 %", "fixed": word}])
    assert len(found) == shapes
    problem = cosserat.case("elastica").vary("it", supports=[{"at": "50 %", "fixed": word}]).problem
    ax = Figure().add_subplot()
    draw_supports(ax, problem, problem.geometry.X, problem.geometry.D)
    across = [line for line in ax.lines if np.allclose(line.get_xdata(), 0.5)]
    assert [line.get_linewidth() for line in across] == pytest.approx(bars, rel=0.02)


def test_springs_begin_at_their_places_and_go_against_their_directions():
    springs = [{"at": "40 %", "along": "E2", "stiffness": 1.0, "rotational_stiffness": 1.0}]
    _, lines = drawn(springs=springs, foundations=[{"along": "E3", "stiffness": 1.0, "start": 0.5}])
    np.testing.assert_allclose(lines[0][0], [0.4, 0], atol=1e-12)
    assert lines[0][-1][1] < -0.05
    feet = [line[0] for line in lines if len(line) == 8]
    assert min(foot[0] for foot in feet[1:]) == pytest.approx(0.5)
    assert max(foot[0] for foot in feet) == pytest.approx(1.0)


def test_a_mass_is_drawn_at_its_offset():
    shapes, lines = drawn(masses=[{"at": "30 %", "mass": 1.0, "offset": [0.02, -0.1]}])
    np.testing.assert_allclose(shapes[-1].mean(axis=0), [0.32, -0.1], atol=1e-12)
    np.testing.assert_allclose(lines[-1], [[0.3, 0], [0.32, -0.1]], atol=1e-12)
