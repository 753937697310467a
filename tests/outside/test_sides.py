"""The side to which a slender body buckles is the one that the growing load leads to, for the smallest imperfection.

Right values: the boundary value problem of `reissner`, the load grown with a strong push to the same side which is then
taken away, or, of the ribbon, its weight put on first.  `python -m tests.outside.sides` finds them anew, in a minute.
"""

import numpy as np
import pytest

import cosserat
from cosserat.data.dataset import warnings_of

from .checks import inputs, last, rectangle
from .sides import BOWS, EULER, MULTIPLES, PUSHED, RIBBONS, SHIFTED, SIDES

MESH = 3e-3
"""Of the length: what 40 edges leave at twelve times the critical load, where the rod is bent to a loop."""


@pytest.mark.parametrize("steps", [1, 3, 10])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_compressed_bar_buckles_to_the_side_of_its_lateral_force(steps, side):
    forces = [
        {"at": "last", "along": "-E3", "force": 980665.0},
        {"at": "last", "along": "E2", "force": side * 1000.0},
    ]
    data = cosserat.run(
        inputs()["pushed_bar"].vary("x", forces=forces, newton={"load_increments": steps})
    )
    assert last(data) == pytest.approx(side * PUSHED[1], abs=2e-3)
    assert last(data, "E3") == pytest.approx(PUSHED[0], abs=4e-3)


@pytest.mark.parametrize("steps", [1, 3, 10, 30])
def test_the_ribbon_sags_the_way_of_its_weight_for_any_number_of_load_steps(steps):
    data = cosserat.run(inputs()["ribbon"].vary("x", newton={"load_increments": steps}))
    assert middle(data) == pytest.approx(RIBBONS[1e9, 0.1], abs=1e-3)


def middle(data):
    return float(data.x.sel(axis="E2").isel(vertex=20))


@pytest.mark.parametrize(("young", "push"), RIBBONS)
def test_a_ribbon_of_any_stiffness_sags_at_any_compression(young, push):
    prescribed_displacements = [{"at": "last", "dof": "x3", "by": -push}]
    data = cosserat.run(
        inputs()["ribbon"].vary(
            "x", rod={"material": {"young": young}}, prescribed_displacements=prescribed_displacements
        )
    )
    assert middle(data) == pytest.approx(RIBBONS[young, push], abs=1e-3)


def test_a_ribbon_goes_up_under_an_upward_weight():
    data = cosserat.run(inputs()["ribbon"].vary("x", gravity={"g": 9.81, "along": "E2"}))
    assert middle(data) == pytest.approx(-RIBBONS[1e9, 0.1], abs=1e-3)


def between_clamps(curvature, push, aside, **more):
    """The slender rod without weight, its last clamp moved nearer and aside."""
    prescribed_displacements = [
        {"at": "last", "dof": "x3", "by": -push},
        {"at": "last", "dof": "x2", "by": aside},
    ]
    return inputs()["ribbon"].vary(
        "x",
        gravity=None,
        rod={"rest": {"kind": "arc", "curvature": curvature}},
        prescribed_displacements=prescribed_displacements,
        **more,
    )


@pytest.mark.parametrize("steps", [1, 3, 10, 40])
@pytest.mark.parametrize(("curvature", "push", "aside"), SHIFTED)
def test_an_initial_curvature_decides_the_side_when_the_clamp_moves_laterally(
    curvature, push, aside, steps
):
    """The lateral motion of the clamp does not decide the side."""
    data = cosserat.run(between_clamps(curvature, push, aside, newton={"load_increments": steps}))
    assert middle(data) == pytest.approx(SHIFTED[curvature, push, aside], abs=1e-3)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_tiny_load_with_moved_supports_is_not_refused(side):
    """1e-7 N, 1e-5 of the support forces, decide.  1e-9 N are below round-off: the answer is right or has a warning."""
    push = [{"at": 20, "along": "E2", "force": side * 1e-7}]
    data = cosserat.run(between_clamps(0.0, 0.01, 0.0, forces=push))
    assert side * middle(data) > 0.05
    tiny = [{"at": 20, "along": "E2", "force": side * 1e-9}]
    data = cosserat.run(between_clamps(0.0, 0.01, 0.0, forces=tiny))
    assert abs(middle(data)) > 0.05
    assert side * middle(data) > 0 or warnings_of(data)


@pytest.mark.parametrize("steps", [1, 3, 10, 40])
@pytest.mark.parametrize(("push", "aside"), [(0.056, 0.128), (0.0104, 0.0309), (0.06, -0.07)])
def test_without_an_initial_curvature_the_open_side_is_warned_of(push, aside, steps):
    """A rotation by half a turn about the middle between the clamps exchanges the two answers."""
    data = cosserat.run(between_clamps(0.0, push, aside, newton={"load_increments": steps}))
    assert abs(middle(data) - aside / 2) > 0.05
    assert [warning.split(":")[0] for warning in warnings_of(data)] == ["bifurcation"]


def column(multiple, aside=0.0, curvature=0.0, **more):
    """The slender rod of `elastica` under a multiple of its critical load."""
    forces = [
        {"at": "last", "along": "-E3", "force": multiple * EULER},
        {"at": "last", "along": "E2", "force": aside},
    ]
    return cosserat.case("elastica").vary(
        "x", forces=forces, rod={"rest": {"kind": "arc", "curvature": curvature}}, **more
    )


def stands_at(case, place, side):
    data = cosserat.run(case)
    assert last(data) == pytest.approx(side * place[1], abs=MESH)
    assert last(data, "E3") == pytest.approx(place[0], abs=MESH)


@pytest.mark.parametrize("multiple", MULTIPLES)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_side_force_decides_at_any_multiple_of_the_critical_load(multiple, side):
    stands_at(column(multiple, side * 0.01), MULTIPLES[multiple], side)


@pytest.mark.parametrize("aside", SIDES)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_side_force_of_any_size_decides_the_side(aside, side):
    stands_at(column(4, side * aside), SIDES[aside], side)


@pytest.mark.parametrize("bow", BOWS)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_initial_curvature_of_any_size_decides_the_side(bow, side):
    stands_at(column(4, curvature=side * bow), BOWS[bow], side)


@pytest.mark.parametrize("steps", [2, 7, 20])
@pytest.mark.parametrize("multiple", [1.2, 4, 12])
def test_the_side_does_not_depend_on_the_number_of_load_steps(steps, multiple):
    stands_at(column(multiple, -0.01, newton={"load_increments": steps}), MULTIPLES[multiple], -1.0)


@pytest.mark.parametrize("steps", [1, 5, 20])
@pytest.mark.parametrize("multiple", [1.1, 1.5, 3.0])
@pytest.mark.parametrize("aside", [0.1, -0.1, 1.0, -1.0])
def test_the_side_force_decides_for_the_published_rod(multiple, aside, steps):
    """Of 500 kN along the column 0.1 N across are 2e-7."""
    beam = cosserat.case("clamped_free")
    rod = beam.problem.rod
    euler = np.pi**2 * rod.young * rod.width * rod.height**3 / 12 / (2 * rod.length) ** 2
    forces = [
        {"at": "last", "along": "-E3", "force": multiple * euler},
        {"at": "last", "along": "E2", "force": aside},
    ]
    data = cosserat.run(beam.vary("x", gravity=None, forces=forces, newton={"load_increments": steps}))
    assert last(data) * np.sign(aside) > 0.2 * rod.length
    assert warnings_of(data) == []


@pytest.mark.parametrize("fraction", [1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_path_does_not_jump_to_the_other_side(fraction, side):
    """Every point beyond the critical load lies on the side of the force, and the last agrees with the elastica."""
    load = 2.3132
    forces = [
        {"at": "last", "along": "-E3", "force": load},
        {"at": "last", "along": "E2", "force": side * fraction * load},
    ]
    path = cosserat.run(cosserat.case("column_path").vary("x", forces=forces))
    assert float(path.load_factor[-1]) == 1
    tip = side * path.x.sel(axis="E2").isel(vertex=-1).to_numpy()
    assert (tip[1:] > 0).all()
    assert tip[-1] == pytest.approx(MULTIPLES[2][1], abs=MESH)


def test_the_inputs_are_those_of_the_reference_values():
    rod = rectangle("ribbon")
    assert np.pi**2 * rod.EI / 4 == pytest.approx(EULER, rel=1e-12)
