"""Rods that are bent into a pose: rings, curls, ribbons between clamps, against closed forms and a BVP."""

import itertools
from functools import cache

import numpy as np
import pytest
from outside import reissner
from outside.reissner import CLAMP, FREE, Load
from scipy.linalg import expm
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk, j0

import cosserat
from cosserat.errors import InputError
from cosserat.problems.critical import RodCriticalLoads
from cosserat.problems.modes import RodModes
from cosserat.problems.path import RodPath

RIBBON = {
    "section": {"height": 5e-3, "width": 5e-3},
    "material": {"young": 1e9, "poisson": 0.0, "line_density": 0.04195},
}
"""That of newton-physics/newton #3896, of 1 m: w L^3 / EI = 7.9."""
WEIGHT = {"g": 9.81, "along": "-E2"}
EI = 1e9 * 5e-3**4 / 12
HELD = ["x3", "x2", "d3", "d2"]
BOTH = [{"at": "first", "fixed": HELD}, {"at": "last", "fixed": HELD}]
CURL = {"kind": "arc", "curvature": 2 * np.pi}
STRAIGHT = {"kind": "straight"}


def posed(pose, vertices=41, rest=None, like="elastica", **changes):
    rod = RIBBON | {"vertices": vertices, "rest": rest or STRAIGHT} | changes.pop("rod", {})
    return cosserat.case(like).vary("posed", **{"forces": [], "rod": rod, "pose": pose} | changes)


def orders(errors):
    return [np.log2(coarse / fine) for coarse, fine in itertools.pairwise(errors)]


def between_clamps(height, rows=401):
    """A shape whose angle is `height` sin(2 pi s), so that its ends are parallel and J0(height) apart."""
    s = np.linspace(0, 1, rows)
    table = np.column_stack([s, height * 2 * np.pi * np.cos(2 * np.pi * s)])
    return {"kind": "curvature", "curvature": table, "between": "spline"}


@pytest.mark.parametrize("turns", [1, 2, -1])
def test_a_straight_rod_closed_to_a_ring_keeps_its_circle_and_its_moment(turns):
    """M = EI 2 pi / L everywhere, without forces; a polygon of equal edges that turn equally."""
    closed = 2 * np.sin(np.pi * turns / 40) * 40  # the arc whose 40 chords close
    data = cosserat.run(posed({"kind": "arc", "curvature": closed}, supports=BOTH))
    np.testing.assert_allclose(data.x[-1], 0, atol=1e-12)
    assert np.abs(data.u).max() < 1e-6
    force, d = data.support_force.to_numpy()[-1], data.d.to_numpy()[-1]
    assert d[0] * force[3] - d[1] * force[2] == pytest.approx(EI * 2 * np.pi * turns, rel=1e-6)
    assert np.abs(force[:2]).max() < 1e-3 * EI
    assert float(data.energy_parts.sum()) == pytest.approx(EI * (2 * np.pi * turns) ** 2 / 2, rel=2e-2)


@cache
def hung(curvature):
    body = reissner.Rod.rectangle(1.0, 5e-3, 5e-3, 1e9, curvature=curvature)
    return reissner.tip(body, Load(CLAMP, FREE, py=-0.04195 * 9.81))


@pytest.mark.parametrize(("pose", "rest"), [(STRAIGHT, CURL), (CURL, STRAIGHT)])
def test_a_curl_unrolled_and_a_rod_rolled_up_are_let_go_under_their_weight(pose, rest):
    """The clamp holds the first section along E3 in both; the answer is that of the rod, not of the pose."""
    right = hung(rest.get("curvature", 0.0))
    tips = [cosserat.run(posed(pose, n, rest, gravity=WEIGHT)).x[-1].to_numpy() for n in (21, 41, 81)]
    errors = [np.linalg.norm(tip - right) for tip in tips]
    assert orders(errors) == pytest.approx([2, 2], abs=0.25)
    assert errors[-1] < 2e-3


def ribbon(chord):
    """Height of the middle of an inextensible ribbon of 1 m between clamps: chord 2 E / K - 1, height k / K."""
    m = brentq(lambda m: 2 * ellipe(m) / ellipk(m) - 1 - chord, 1e-6, 0.9)
    return np.sqrt(m) / ellipk(m)


@pytest.mark.parametrize("side", [1, -1])
def test_the_pose_decides_the_side_of_a_ribbon_between_clamps(side):
    """It stays where it was bent to, also against a weight."""
    errors = []
    for n in (21, 41, 81):
        case = posed(
            between_clamps(0.9 * side),
            n,
            supports=BOTH,
            rod={"section": {"height": 5e-4, "width": 5e-3}},
        )
        data = cosserat.run(case)
        right = side * ribbon(float(data.x[-1, 0]))
        errors.append(float(data.x[n // 2, 1]) - right)
    assert abs(right) > 0.2
    assert float(data.x[-1, 0]) == pytest.approx(j0(0.9), abs=5e-4)
    assert orders(np.abs(errors)) == pytest.approx([2, 2], abs=0.2)
    assert abs(errors[-1]) < 1e-3
    weight = [{"along": "-E2", "density": 5 * EI * (5e-4 / 5e-3) ** 3}]
    assert 0.9 < float(cosserat.run(case.vary("heavy", line_loads=weight)).x[40, 1]) / right < 1.1


def test_a_pose_that_is_the_shape_at_rest_changes_nothing():
    found = [cosserat.run(posed(pose, 21, CURL, gravity=WEIGHT)).x.to_numpy() for pose in (CURL, None)]
    np.testing.assert_allclose(*found, atol=1e-6)


def test_the_end_of_a_pose_is_that_of_the_rod_itself():
    """The same rod, unrolled or not, has the same shape, energy and reactions."""
    found = [cosserat.run(posed(pose, 41, CURL, gravity=WEIGHT)) for pose in (STRAIGHT, None)]
    for name in ("x", "energy_parts"):
        values = [data[name].to_numpy() for data in found]
        np.testing.assert_allclose(*values, atol=2e-2 * np.abs(values[1]).max())
    for data in found:
        force, d = data.support_force.to_numpy()[0], data.d.to_numpy()[0]
        assert force[1] == pytest.approx(0.04195 * 9.81, rel=1e-6)
        lever = np.trapezoid(data.x[:, 0], data.xi)
        assert d[0] * force[3] - d[1] * force[2] == pytest.approx(0.04195 * 9.81 * lever, rel=0.05)


def motion(pose, rest, duration, step, **changes):
    return cosserat.run(
        posed(
            pose,
            rest=rest,
            like="vibration_consistent",
            start={"shape": "reference", "amplitude": 0.0},
            duration=duration,
            every=duration / 20,
            damping=0.0,
            integrator={"step": step},
            rod={"length": 1.0, "vertices": 21},
            **changes,
        )
    )


def test_a_motion_starts_in_its_pose_with_the_energy_of_bending():
    """EI K^2 L / 2 for a curl unrolled, and for a straight rod rolled up; then the curl rolls up again."""
    for pose, rest in ((STRAIGHT, CURL), (CURL, STRAIGHT)):
        data = motion(pose, rest, 0.01, 2e-5)
        start = data.isel(time=0)
        assert float(np.abs(start.x_rate).max()) == float(np.abs(start.d_rate).max()) == 0.0
        assert float(start.strain_energy) == pytest.approx(EI * (2 * np.pi) ** 2 / 2, rel=0.06)
        bent = EI * ((rest.get("curvature", 0.0)) - pose.get("curvature", 0.0))
        np.testing.assert_allclose(start.bending_moment[3:-3], -bent, rtol=0.02)
        total = data.strain_energy + data.kinetic_energy
        np.testing.assert_allclose(total, total[0], rtol=1e-6)
        assert float(np.abs(data.x[-1, -1] - data.x[0, -1]).max()) > 0.01
    rod = posed(CURL, 21).problem.rod
    np.testing.assert_allclose(
        start.x,
        rod.placed(posed(CURL).problem.pose, rod.length * np.linspace(0, 1, 21), np.full(21, 2.5e-3)).X,
    )


def test_a_small_pose_swings_as_the_first_mode_does():
    """The shape of a cantilever's first mode by points, against the start that has it by name."""
    from cosserat.exact.beams import first_beam_mode

    case = cosserat.case("vibration_consistent").vary("x", rod={"length": 1.0, "vertices": 21, **RIBBON})
    s = np.linspace(0, 1, 81)
    y = 1e-3 * first_beam_mode(1.0, s)[0]
    points = {"kind": "points", "points": np.column_stack([s, y])}
    length = cosserat.rods.shapes.Points.read(points, "x", units_required=False).length
    points["points"] = points["points"] / length
    one, step = {"duration": 0.2, "every": 0.01, "damping": 0.0}, {"step": 1e-3}
    named = cosserat.run(case.vary("a", start={"amplitude": 1e-3}, integrator=step, **one))
    bent = cosserat.run(
        case.vary(
            "b", start={"shape": "reference", "amplitude": 0.0}, pose=points, integrator=step, **one
        )
    )
    assert np.abs(named.x[:, -1, 1]).max() > 9e-4
    np.testing.assert_allclose(bent.x[:, -1, 1], named.x[:, -1, 1], atol=2e-5)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"pose": {"kind": "points", "points": [[0, 0], [2, 0]]}},
            "'pose' has points along 2 m, but 'length' is 1",
        ),
        ({"pose": {"kind": "arc", "curvature": 99}}, "'pose' rotates an edge by more than a radian"),
        ({"pose": {"kind": "ring"}}, "'arc'"),
        (
            {"pose": CURL, "rod": {"barrier": True}},
            "'pose' needs rod.energy = 'consistent' without 'rod.barrier'",
        ),
    ],
)
def test_a_pose_that_fits_no_rod_is_refused_in_one_sentence(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        cosserat.case("elastica").vary("x", **changes)


def test_a_pose_and_a_beam_mode_and_the_published_energy_are_refused():
    with pytest.raises(InputError, match=r"has 'pose' and start.shape = 'first beam mode'; leave one"):
        cosserat.case("vibration_consistent").vary("x", pose=STRAIGHT)
    with pytest.raises(InputError, match="'pose' needs rod.energy = 'consistent'"):
        cosserat.case("clamped_free").vary("x", pose=STRAIGHT)
    with pytest.raises(InputError, match="has 'pose' and about = 'reference', but a rod that is bent"):
        RodModes.of(posed(CURL).problem, 2).replace(about="reference")


# ---------------------------------------------------------------- modes, critical loads and paths


def modes(case, count=4):
    return cosserat.modes(case, count).natural_frequency.to_numpy()


def of_a_clamped_ring(count):
    """Circular frequencies of a thin ring of unit length, clamped at one section, over sqrt(EI / m).

    derived: without extension, the tangential displacement v goes by the angle as v6 + 2 v4 + v2 = l (v2 - v), l = m
    R^4 w^2 / EI, each number a derivative; v, v1 and v2 are zero at both ends.
    """

    def determinant(root):
        step = np.eye(6, k=1)
        step[5] = [-(root**2), 0, root**2 - 1, 0, -2, 0]
        return np.linalg.det(expm(2 * np.pi * step)[:3, 3:])

    grid = np.linspace(0.2, 12, 120)
    signs = np.sign([determinant(root) for root in grid])
    roots = [brentq(determinant, grid[k], grid[k + 1]) for k in np.flatnonzero(signs[1:] != signs[:-1])]
    return np.array(roots[:count]) * (2 * np.pi) ** 2


def closed(vertices):
    """The arc whose chords close."""
    return {"kind": "arc", "curvature": 2 * np.sin(np.pi / (vertices - 1)) * (vertices - 1)}


THIN = {"section": {"height": 1e-3, "width": 5e-3}}
UNIT = np.sqrt(1e9 * 5e-3 * 1e-3**3 / 12 / 0.04195) / (2 * np.pi)
"""Frequency of the thin ribbon, sqrt(EI / m) / (2 pi)."""


def test_a_ring_closed_from_a_strip_vibrates_as_one_that_is_round_at_rest():
    """Its ends do not turn, so the moment of closing does no work; against the equation of an inextensible ring."""
    right, errors = of_a_clamped_ring(3) * UNIT, []
    for n in (21, 41, 81):
        found = modes(posed(closed(n), n, supports=BOTH, rod=THIN), 3)
        np.testing.assert_allclose(
            found, modes(posed(None, n, closed(n), supports=BOTH, rod=THIN), 3), rtol=1e-5
        )
        errors.append(found / right - 1)
    np.testing.assert_allclose(orders(np.abs(errors)), 2, atol=0.15)
    assert np.abs(errors[-1]).max() < 6e-3


def test_a_curl_unrolled_between_clamps_vibrates_as_a_straight_beam():
    roots = [brentq(lambda x: np.cosh(x) * np.cos(x) - 1, b - 0.3, b + 0.3) for b in (4.7, 7.9, 11)]
    found = modes(posed(STRAIGHT, 81, CURL, supports=BOTH, rod=THIN), 3)
    np.testing.assert_allclose(found, np.square(roots) * UNIT, rtol=3e-3)


def test_modes_are_about_the_equilibrium_to_which_a_pose_leads():
    """The same hanging rod, unrolled or not; that of a motion is without its loads."""
    hanging = [modes(posed(pose, 41, CURL, gravity=WEIGHT)) for pose in (STRAIGHT, None)]
    np.testing.assert_allclose(*hanging, rtol=2e-2)
    moving = posed(
        closed(21),
        21,
        like="vibration_consistent",
        start={"shape": "reference", "amplitude": 0.0},
        damping="none",
        supports=BOTH,
        gravity=WEIGHT,
        rod={"length": 1.0},
    )
    np.testing.assert_allclose(modes(moving), modes(posed(closed(21), 21, supports=BOTH)), rtol=1e-9)


def test_a_curl_unrolled_and_compressed_buckles_at_the_load_of_a_straight_column():
    """Between a clamp and a guide its moment does no work; the closed form of the discrete column."""
    rod = {"section": {"height": 0.1, "width": 0.1}}
    guided = [BOTH[0], {"at": "last", "fixed": ["x2", "d3", "d2"]}]
    push = [{"at": "last", "along": "-E3", "force": 1.0}]
    case = posed(STRAIGHT, 11, {"kind": "arc", "curvature": 1.0}, supports=guided, forces=push, rod=rod)
    found = RodCriticalLoads.of(case.problem, 1).solve("it")
    EA, EI = 1e9 * 0.1**2, 1e9 * 0.1**4 / 12
    GA, bent = 5 / 12 * EA, EI * (20 * np.tan(np.pi / 10)) ** 2
    right = brentq(lambda P: P * (1 - P / EA + P / GA) - bent, 0, 2 * bent)
    assert found["special_load_factor"] == pytest.approx([right], rel=1e-9)
    assert found["linear_load_factor"] == pytest.approx([right], rel=0.1)
    np.testing.assert_allclose(found["x"], found["x_ref"], atol=1e-12)


def path_of(case):
    table = case.problem.model_dump() | {"kind": "rod path"}
    return RodPath.read(table, "x", units_required=False).solve("the path")


def test_the_path_of_a_ring_that_is_pinched_begins_in_its_pose():
    """Its height falls by (pi / 4 - 2 / pi) F R^3 / EI; at the end it is the static answer."""
    radius, bending, found = 1 / (2 * np.pi), 1e9 * 5e-3 * 1e-3**3 / 12, []
    force = 1e-4 * bending / radius**2
    for n in (21, 41, 81):
        push = [{"at": (n - 1) // 2, "along": "-E2", "force": force}]
        case = posed(closed(n), n, supports=BOTH, forces=push, rod=THIN)
        path = path_of(case)
        height = path["x"][:, (n - 1) // 2, 1]
        found.append((height[0] - height[-1]) / (force * radius**3 / bending))
        assert path["load_factor"][0] == 0
    errors = np.array(found) - (np.pi / 4 - 2 / np.pi)
    assert orders(np.abs(errors)) == pytest.approx([2, 2], abs=0.15)
    assert abs(errors[-1]) < 1e-3
    still = cosserat.run(case)
    np.testing.assert_allclose(path["x"][-1], still.x, atol=1e-9)
    np.testing.assert_allclose(path.derive().fields["bending_moment"][1][-1], still.bending_moment)


def test_supports_move_along_a_path_from_where_the_pose_holds_them():
    moved = {
        "prescribed_displacements": [{"at": "last", "dof": "x2", "by": 0.1}],
        "prescribed_rotations": [{"at": "last", "by": 0.5}],
    }
    case = posed(closed(21), 21, supports=BOTH, **moved)
    path, still = path_of(case), cosserat.run(case)
    np.testing.assert_allclose(path["x"][0, -1], path["x_ref"][-1], atol=1e-12)
    for name in ("x", "d"):
        np.testing.assert_allclose(path[name][-1], still[name], atol=1e-9)
    assert path["d"][-1, -1] == pytest.approx(2.5e-3 * np.array([-np.sin(0.5), np.cos(0.5)]), abs=1e-8)


def test_the_path_of_a_curl_that_is_unrolled_and_let_go_begins_with_its_circle():
    case = posed(STRAIGHT, 41, CURL, gravity=WEIGHT)
    path, still = path_of(case), cosserat.run(case)
    np.testing.assert_allclose(path["x"][0, -1], 0, atol=1e-2)
    assert path["x"][0, 20] == pytest.approx([0, 1 / np.pi], abs=1e-2)
    np.testing.assert_allclose(path["x"][-1], still.x, atol=1e-9)
    critical = RodCriticalLoads.of(case.problem, 1)
    begun = critical.replace(search={"count": 1}).solve("it")["x"]
    np.testing.assert_allclose(begun, path["x"][0], atol=1e-9)
