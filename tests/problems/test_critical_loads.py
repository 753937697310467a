"""Critical loads and special points of paths: closed forms of the discrete column, other codes, orders."""

import functools
import re

import numpy as np
import pytest
from outside import reissner
from scipy.linalg import eigh, eigvalsh
from scipy.optimize import brentq, minimize_scalar

import cosserat
from cosserat.errors import InputError, UnsupportedRodError
from cosserat.problems.critical import RodCriticalLoads
from cosserat.problems.path import RodPath
from cosserat.solvers.banded import to_dense
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.tangent import Tangent

CLAMP = ["x3", "x2", "d3", "d2"]
ENDS = {  # what is fixed at both ends, and the wave number over pi
    "clamped-free": (CLAMP, [], 1 / 2),
    "hinged-hinged": (["x3", "x2"], ["x2"], 1),
    "clamped-clamped": (CLAMP, ["x2", "d3", "d2"], 2),
    "clamped-hinged": (CLAMP, ["x2"], 1.4303),
}
YOUNG, THICKNESS = 1e9, 0.1
ROD = reissner.Rod.rectangle(1.0, THICKNESS, THICKNESS, YOUNG)


def column(vertices, ends="clamped-free", force=1.0, **changes):
    """A stout column of length one pushed at its last vertex, without Poisson's effect."""
    first, last, _ = ENDS[ends]
    supports = [{"at": "first", "fixed": first}] + [{"at": "last", "fixed": last}] * bool(last)
    rod = {"vertices": vertices, "section": {"height": THICKNESS, "width": THICKNESS}}
    push = [{"at": "last", "along": "-E3", "force": force}]
    given = {"rod": rod, "supports": supports, "forces": push} | changes
    return cosserat.case("elastica").vary("column", **given).problem


def critical(problem, count=2, **search):
    table = RodCriticalLoads.of(problem, count).model_dump() | {"search": search}
    return RodCriticalLoads.read(table, "x", units_required=False).solve("the column")


def discrete_column(edges, wave):
    """EI k^2 of edges of length h whose section angles go as sin(wave pi s), k = 2 / h tan(wave pi h / 2).

    derived: an edge has the measures of its mean angle b, N = -P cos b, Q = P sin b, and P b c / EI bends it, so
    (a[K+1] - 2 a[K] + a[K-1]) / h^2 + k^2 (a[K+1] + 2 a[K] + a[K-1]) / 4 = 0.
    """
    return ROD.EI * (2 * edges * np.tan(wave * np.pi / (2 * edges))) ** 2


def true_load(bent):
    """P of P (1 - P / EA + P / GA) = EI k^2."""
    return brentq(lambda P: P * (1 - P / ROD.EA + P / ROD.GA) - bent, 0, 2 * bent, xtol=1e-12 * bent)


def linear_load(bent):
    """P of P + P^2 / GA = EI k^2, Haringx's column: it bends and shears, but is not shortened before.

    derived: the second variation GA (w' - t)^2 + EI t'^2 - P (2 w' t - t^2) is least for w' - t = P t / GA.
    """
    return brentq(lambda P: P + P**2 / ROD.GA - bent, 0, 2 * bent, xtol=1e-12 * bent)


@pytest.mark.parametrize("ends", ["clamped-free", "hinged-hinged", "clamped-clamped"])
def test_both_criteria_meet_the_closed_form_of_the_discrete_column(ends):
    found = critical(column(11, ends), 1)
    bent = discrete_column(10, ENDS[ends][2])
    assert found["special_load_factor"] == pytest.approx([true_load(bent)], rel=1e-11)
    assert found["linear_load_factor"] == pytest.approx([linear_load(bent)], rel=1e-11)
    assert found.labels["special"] == ("bifurcation, first instability",)
    assert found.statistics["first_instability_load_factor"] == found["special_load_factor"][0]
    angle = -found["special_delta"][0, :, 0]
    wave = np.pi * ENDS[ends][2] * np.linspace(0, 1, 11)
    shape = np.cos(wave) if ends == "hinged-hinged" else np.sin(wave)
    np.testing.assert_allclose(angle / angle[1], shape / shape[1], atol=1e-6)
    assert np.abs(found["special_u"]).max() == found["special_u"].max() == 1
    np.testing.assert_allclose(found["linear_u"][0], found["special_u"][0], atol=0.02)


def test_forces_and_reactions_are_those_of_the_critical_state():
    """A column is straight until it buckles: its normal force is the critical load, and its clamp bears it."""
    found = critical(column(9, force=2.0))
    (factor,) = found["special_load_factor"]
    state = found.derive()
    np.testing.assert_allclose(state["normal_force"], [[-2 * factor] * 8], rtol=1e-9)
    np.testing.assert_allclose(state["reaction_force"], [[[2 * factor, 0.0]]], rtol=1e-9, atol=1e-7)
    for name in ("shear_force", "bending_moment"):
        assert np.abs(state[name]).max() < 1e-7 * factor
    assert critical(column(9), limit=0.5).derive().fields == {}


def test_higher_critical_loads_of_the_linear_criterion():
    found = critical(column(11), 3)["linear_load_factor"]
    right = [linear_load(discrete_column(10, k + 1 / 2)) for k in range(3)]
    np.testing.assert_allclose(found, right, rtol=1e-10)


@pytest.mark.parametrize("ends", ENDS)
def test_eulers_four_loads_with_shear_and_shortening_have_second_order(ends):
    right = reissner.buckling_load(ROD, ends)
    assert right == pytest.approx((ENDS[ends][2] * np.pi) ** 2 * ROD.EI, rel=0.11)
    errors = [critical(column(n, ends), 1)["special_load_factor"][0] / right - 1 for n in (11, 21, 41)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 2, atol=0.06)


def test_greenhills_column_under_its_weight():
    errors = []
    for n in (11, 21, 41):
        problem = column(n, forces=[], gravity={"g": 1.0, "along": "-E3"})
        found = critical(problem, 1)["special_load_factor"][0] * problem.rod.material.line_density
        errors.append(found / reissner.greenhill(ROD) - 1)
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2, atol=0.1)
    slender = reissner.Rod(1.0, 1.0)
    assert reissner.greenhill(slender) == pytest.approx(7.8373, abs=5e-5)


def test_the_size_of_the_load_changes_no_critical_load():
    one, other = (critical(column(11, force=force), 2) for force in (1e-3, 1e4))
    for name in ("linear_load_factor", "special_load_factor"):
        np.testing.assert_allclose(1e-3 * one[name], 1e4 * other[name], rtol=1e-11)


def test_the_published_rod_has_critical_loads_too():
    """Coefficients of its own make it another column; both criteria agree up to its shortening and shear."""
    problem = cosserat.case("clamped_free").problem
    push = [{"at": "last", "along": "-E3", "force": 1e6}]
    pushed = cosserat.case("clamped_free").vary("x", gravity={"g": 0.0, "along": "E3"}, forces=push)
    found = critical(pushed.problem, 1)
    euler = np.pi**2 / 4 * problem.rod.material.young * problem.rod.second_moment / problem.rod.length**2
    for name in ("linear_load_factor", "special_load_factor"):
        assert 1e6 * found[name][0] == pytest.approx(euler, rel=0.1)


def test_a_column_that_is_pulled_has_none():
    """None however hard it is pulled, with GA = EA; Haringx's formula alone has one, where strains exceed one."""
    rod = {"vertices": 11, "section": {"height": THICKNESS, "width": THICKNESS, "shear_factor": 2.0}}
    found = critical(column(11, force=-1e5, rod=rod), 2)
    assert "special_load_factor" not in found.fields
    bent, EA = discrete_column(10, 1 / 2), ROD.EA
    right = (EA + np.sqrt(EA**2 + 4 * EA * bent)) / 2e5
    assert found["linear_load_factor"][0] == pytest.approx(right, rel=1e-9)
    assert [warning.partition(":")[0] for warning in found.warnings] == ["no critical load"]
    words = RodCriticalLoads.summary(found.statistics, {})
    assert re.fullmatch(r"no instability up to 30\d\.\d+ of the loads; linear criterion 100\.\d+", words)


def pinched():
    """F R^2 / EI of a quarter of an inextensible ring whose ends do not turn.

    derived: the force is F all along, so that N = -F sin x at the angle x.  The second variation of a rod that keeps
    its length is EI t'^2 + N t^2, and so t'' + F R^2 / EI sin x t = 0.  By Ritz's method with sines.
    """
    nodes, weights = np.polynomial.legendre.leggauss(60)
    x, weights = np.pi / 4 * (nodes + 1), np.pi / 4 * weights
    sines = np.sin(2 * np.arange(1, 21)[:, None] * x)
    rates = 2 * np.arange(1, 21)[:, None] * np.cos(2 * np.arange(1, 21)[:, None] * x)
    return eigh((rates * weights) @ rates.T, (sines * weights * np.sin(x)) @ sines.T)[0][0]


@pytest.mark.parametrize("thickness", [2e-3, 5e-4])
def test_the_linear_criterion_of_a_ring_does_not_depend_on_its_thickness(thickness):
    """A quarter of one between two forces: the bending before, to first order, would soften thin ones without bound."""
    R = 0.1
    problem = (
        cosserat.case("elastica")
        .vary(
            "ring",
            rod={
                "vertices": 81,
                "length": np.pi * R / 2,
                "rest": {"kind": "arc", "curvature": -1 / R},
                "section": {"height": thickness, "width": 0.01},
            },
            supports=[
                {"at": "first", "fixed": ["x3", "d3"]},
                {"at": "last", "fixed": ["x2", "d2", "d3"]},
            ],
            forces=[{"at": "first", "along": "-E2", "force": 1.0}],
        )
        .problem
    )
    EI = problem.rod.young * problem.rod.second_moment
    found = critical(problem, 1)["linear_load_factor"][0] * R**2 / EI
    assert found == pytest.approx(pinched(), rel=2e-3)


def test_a_load_without_a_potential_is_said_to_flutter_perhaps():
    push = [{"at": "last", "along": "-E3", "force": 10 * ROD.EI}]
    found = critical(column(11, forces=[], follower_forces=push), 2)
    assert "special_load_factor" not in found
    named = [warning.partition(":")[0] for warning in found.warnings]
    assert named == ["no linear critical load", "no critical load", "flutter"]


# ---------------------------------------------------------------- paths


def path_of(problem, **arc):
    table = problem.model_dump(exclude={"pose"}) | {"kind": "rod path", "arc": arc}
    return RodPath.read(table, "x", units_required=False)


@pytest.mark.parametrize("branch", ["leave", "stay"])
@pytest.mark.parametrize("longest", [0.1, 0.3])
def test_a_path_lists_the_bifurcation_of_the_column(branch, longest):
    right = true_load(discrete_column(10, 1 / 2))
    path = path_of(column(11, force=1.5 * right), branch=branch, longest=longest)
    found = path.solve("the column")
    assert found["special_load_factor"] == pytest.approx([1 / 1.5], rel=1e-11)
    assert found.labels["special"] == ("bifurcation, first instability",)
    after = int(found["special_after"][0])
    assert found["load_factor"][after] < 1 / 1.5
    assert found["load_factor"][after + 1] > 1 / 1.5 or branch == "leave"
    assert found.statistics["bifurcations"] == 1
    words = RodPath.summary(found.statistics, {})
    assert ", 1 bifurcation, first unstable at 0.66666667 of the load" in words


def test_an_imperfect_column_has_no_special_point():
    right = true_load(discrete_column(10, 1 / 2))
    both = [
        {"at": "last", "along": "-E3", "force": 1.5 * right},
        {"at": "last", "along": "E2", "force": 0.01 * right},
    ]
    found = path_of(column(11, forces=both)).solve("the column")
    assert "special_load_factor" not in found
    assert "first_instability_load_factor" not in found.statistics


SPAN, CURVATURE = 1.0, 0.6
ARCH = reissner.Rod.rectangle(SPAN, 0.02, 0.02, YOUNG, curvature=CURVATURE)


def arch(vertices, force=1.0):
    """A shallow clamped arch, pushed in at its crown."""
    rod = {
        "vertices": vertices,
        "rest": {"kind": "arc", "curvature": CURVATURE},
        "section": {"height": 0.02, "width": 0.02},
    }
    inward = [-np.sin(CURVATURE / 2), np.cos(CURVATURE / 2)]
    given = {
        "rod": rod,
        "supports": [{"at": "first", "fixed": CLAMP}, {"at": "last", "fixed": CLAMP}],
        "forces": [{"at": (vertices - 1) // 2, "along": inward, "force": force}],
    }
    return cosserat.case("elastica").vary("arch", **given).problem


@functools.cache
def peak_of_the_arch():
    """Largest force at the crown [N] of the same arch by collocation: half of it, the crown led along its axis."""
    half = reissner.Rod(SPAN / 2, ARCH.EI, ARCH.EA, ARCH.GA, CURVATURE)
    angle, radius = CURVATURE / 2, 1 / CURVATURE
    crown, axis = np.array([np.sin(angle), 1 - np.cos(angle)]) * radius, [-np.sin(angle), np.cos(angle)]

    def force(moved):
        x, y = crown + moved * np.array(axis)
        load = reissner.Load(reissner.CLAMP, {"x": x, "y": y, "a": angle})
        return 2 * reissner.equilibrium(half, load, steps=6, tolerance=1e-7)[3:5, -1] @ axis

    found = minimize_scalar(
        lambda v: -force(v), bounds=(0.01, 0.08), method="bounded", options={"xatol": 1e-4}
    )
    return -found.fun


def test_the_limit_load_of_an_arch_is_that_of_the_boundary_value_problem():
    errors = []
    for n in (21, 41, 81):
        found = critical(arch(n), 1)
        assert found.labels["special"] == ("limit point, first instability",)
        errors.append(found["special_load_factor"][0] / peak_of_the_arch() - 1)
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2, atol=0.2)
    assert abs(errors[-1]) < 3e-3


def largest_force(problem, low, high):
    """Largest crown force [N] of the discrete arch itself: its crown led along its axis, by a dense Newton method."""
    system = problem.replace(forces=()).system(problem.geometry)
    crown = 4 * ((problem.rod.vertices - 1) // 2) + np.arange(2)
    axis = np.array([-np.sin(CURVATURE / 2), np.cos(CURVATURE / 2)])
    free, tangent = np.flatnonzero(~system.constrained), Tangent(system)
    a = np.zeros(system.constrained.size)
    a[crown] = axis
    a, q, force = a[free], np.zeros(system.constrained.size), 0.0

    def at(moved):
        nonlocal force
        for _ in range(12):
            system.assemble(q, system.history, 1.0, tangent)
            K = to_dense(tangent.band)[np.ix_(free, free)]
            both = np.block([[K, -a[:, None]], [a[None, :], np.zeros((1, 1))]])
            left = np.append(force * a - tangent.gradient[free], moved - a @ q[free])
            step = np.linalg.solve(both, left)
            q[free] += step[:-1]
            force += step[-1]
        return force

    for moved in np.linspace(0, low, 6)[1:]:
        at(moved)
    found = minimize_scalar(
        lambda v: -at(v), bounds=(low, high), method="bounded", options={"xatol": 1e-7}
    )
    return -found.fun, q


def test_the_limit_point_of_the_discrete_arch_is_located_to_round_off():
    problem = arch(13)
    right, q = largest_force(problem, 0.02, 0.06)
    found = critical(problem, 1)
    assert found["special_load_factor"][0] == pytest.approx(right, rel=1e-10)
    np.testing.assert_allclose(
        found["special_x"][0, :, 0] - problem.geometry.X[:, 0], q[0::4], atol=1e-6
    )
    path = path_of(arch(13, force=1.5 * right), limit=4.0, count=60).solve("the arch")
    assert path.labels["special"][0] == "limit point, first instability"
    assert 1.5 * path["special_load_factor"][0] == pytest.approx(1.0, rel=1e-10)
    assert path.statistics["limit_points"] == 2


def test_the_hessian_is_singular_at_a_special_point():
    problem = column(11)
    system = problem.system(problem.geometry)
    solver = EquilibriumSolver(system, NewtonSettings(tolerance=1e-14), "x")
    factor = critical(problem, 1)["special_load_factor"][0]
    lowest = []
    for share in (0.99, 1.0):
        point = solver.correct(np.zeros(44), share * factor, system.history)
        system.assemble(point.q, point.history, point.factor, solver.tangent)
        free = ~system.constrained
        lowest.append(eigvalsh(to_dense(solver.tangent.band)[free][:, free])[0])
    assert abs(lowest[1]) < 1e-8 * lowest[0]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"count": 0}, "'count' is 0; it must be at least 1"),
        ({"search": {"limit": 0.0}}, "'search.limit' is 0; it must be above 0"),
        ({"search": {"first": 0.0}}, "'search.first' is 0; it must be above 0"),
        ({"search": {"longest": "1 m"}}, "'search.longest' is \"1 m\", in m, a length and not a ratio"),
        ({"search": {"count": 1.5}}, "'search.count' is 1.5; it must be a whole number"),
    ],
)
def test_bad_input(changes, sentence):
    table = column(11).model_dump(exclude={"pose"}) | {"kind": "critical loads"} | changes
    with pytest.raises(InputError) as error:
        RodCriticalLoads.read(table, "x", units_required=False)
    assert sentence in str(error.value)


def test_a_rod_without_loads_is_refused():
    table = column(11).model_dump(exclude={"pose"}) | {"kind": "critical loads", "forces": []}
    with pytest.raises(InputError, match="has no load that could grow to a critical one; give one"):
        RodCriticalLoads.read(table, "x", units_required=False)


def test_a_rod_that_floats_is_refused():
    with pytest.raises(UnsupportedRodError, match="leave the rod free to move"):
        critical(column(11, supports=[{"at": "first", "fixed": ["x3"]}]), 1)
