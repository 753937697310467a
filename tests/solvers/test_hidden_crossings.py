"""Crossings of eigenvalues that are close to each other: two bars by closed forms, rods by scans of dense matrices."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from bodies import body, dead, springs
from scipy.linalg import eigvalsh
from scipy.optimize import brentq

import cosserat
from cosserat.solvers import continuation
from cosserat.solvers.banded import to_dense
from cosserat.solvers.continuation import ArcLengthSettings, trace_path
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.incremental import unloaded
from cosserat.solvers.indefinite import Factors
from cosserat.solvers.special import special_points
from cosserat.solvers.tangent import Tangent

STEEPEST = 0.41702882811414952
"""Half span of two bars over their height, beyond which the apex does not sway; `swaying` has no root from here on."""


def swaying(b):
    """Heights y at which the apex of two bars of height one begins and ends to sway, and its load per stiffness there.

    derived: the apex has the stiffness b^2 / l^2 - (l0 - l) y^2 / l^3 across, times 2 k, with l^2 = b^2 + y^2; it is
    zero where b^2 l = (l0 - l) y^2, and P = 2 k (l0 - l) y / l.
    """
    l0 = np.hypot(b, 1)

    def soft(y):
        return (l0 - np.hypot(b, y)) * y**2 - b**2 * np.hypot(b, y)

    def slope(y):
        return 2 * (l0 - np.hypot(b, y)) * y - (y**2 + b**2) * y / np.hypot(b, y)

    top = brentq(slope, 0.4, 0.9, xtol=1e-15)
    at = np.array([brentq(soft, top, 1, xtol=1e-15), brentq(soft, 0.1, top, xtol=1e-15)])
    return at, 2 * (l0 - np.hypot(b, at)) * at / np.hypot(b, at)


@pytest.mark.parametrize("longest", [0.2, 0.5])
@pytest.mark.parametrize("below", [1e-4, 1e-7, 1e-8])
def test_an_apex_that_sways_within_one_arc_is_found(below, longest):
    b, k = STEEPEST * (1 - below), 7.0
    _, loads = swaying(b)
    at = np.array([[-b, 0, 0], [0, 1, 0], [b, 0, 0]])
    bars = springs([(0, 1, k, np.hypot(b, 1)), (1, 2, k, np.hypot(b, 1))])
    push = np.zeros(9)
    push[4] = -k
    system = body(replace(bars, origin=at.ravel()), dead(push), held=(0, 1, 2, 5, 6, 7, 8), n=9)
    solver = EquilibriumSolver(system, NewtonSettings(), "bars")
    arc = ArcLengthSettings(first=0.05, longest=longest, count=100, until=0.65, limit=9, branches=0)
    list(trace_path(solver, unloaded(solver), arc))
    found = special(solver)
    assert [(point.label, point.first) for point in found] == [
        ("bifurcation", True),
        ("bifurcation", False),
    ]
    np.testing.assert_allclose([point.point.factor for point in found], loads, rtol=1e-8)


def special(solver):
    """The special points of the path that a solver has traced."""
    return [p for pair in solver.crossings for p in special_points(solver.system, "it", *pair)]


def negative(system, q, history, factor):
    """How many eigenvalues of the dense Hessian of the free DOFs are negative."""
    tangent, free = Tangent(system), ~system.constrained
    system.assemble(q, history, factor, tangent)
    return int((eigvalsh(to_dense(tangent.band)[np.ix_(free, free)]) < 0).sum())


def arch():
    """An arch pressed on its axis of symmetry, whose sway hardly begins before it ends."""
    edges, curvature = 20, 0.37314
    middle = edges * np.arcsin(curvature / edges / 2)
    return cosserat.case("arch_path").vary(
        "arch",
        rod={
            "vertices": edges + 1,
            "length": 1.0,
            "rest": {"kind": "arc", "curvature": curvature},
            "section": {"height": 0.02, "width": 0.02},
        },
        forces=[{"at": edges // 2, "along": (-np.sin(middle), np.cos(middle)), "force": 800.0}],
    )


def test_an_arch_that_sways_within_one_arc_is_found():
    """Against a scan of that arc in steps of a hundredth: dense matrices at their ends."""
    problem = arch().problem
    system, _ = problem.grown(problem.geometry, "arch")
    solver = EquilibriumSolver(system, problem.newton, "arch")
    coarse = ArcLengthSettings(0.05, 0.3, 100, until=1.0, limit=3.0, branches=0)
    points = list(trace_path(solver, unloaded(solver), coarse))
    assert len(points) < 100
    found = special(solver)
    lowest = int(np.argmin([p.factor for p in points]))
    before = list(itertools.takewhile(lambda p: p.factor < -0.005, points[lowest:]))[-1]
    fine = trace_path(solver, before, replace(coarse, first=0.002, longest=0.002, count=500))
    points = list(itertools.takewhile(lambda p: p.factor < 0.01, fine))
    counts = np.array([negative(system, p.q, p.history, p.factor) for p in points])
    steps = np.flatnonzero(np.diff(counts))
    assert np.diff(counts)[steps].tolist() == [1, -1]
    assert [p.label for p in found[3:5]] == ["bifurcation", "bifurcation"]
    for p, k in zip(found[3:5], steps, strict=True):
        assert points[k].factor < p.point.factor < points[k + 1].factor


@pytest.mark.parametrize("nearly", [1.00504, 1.00506])
def test_two_modes_of_a_column_on_a_foundation_that_nearly_meet_are_two(nearly):
    """Loads by bisection of counts of negative eigenvalues of dense matrices; one mode is even, the other is odd."""
    base = cosserat.case("column_path")
    rod = base.problem.rod
    euler = np.pi**2 * rod.young * rod.second_moment / rod.length**2
    stiffness = 4 * nearly * np.pi**2 * euler / rod.length**2
    column = base.vary(
        "column",
        rod={"vertices": 41},
        supports=[{"at": "first", "fixed": "pinned"}, {"at": "last", "fixed": "roller"}],
        foundations=[{"stiffness": stiffness, "along": "E2"}],
        forces=[{"at": "last", "along": "-E3", "force": 6.5 * euler}],
        arc={"branch": "stay"},
    )
    problem = column.problem
    system, _ = problem.grown(problem.geometry, "column")
    solver = EquilibriumSolver(system, NewtonSettings(), "column")

    def load_of(number):
        low, high = 0.7, 0.8
        while high - low > 1e-10:
            middle = (low + high) / 2
            point = solver.correct(np.zeros_like(system.start), middle, system.history)
            many = negative(system, point.q, point.history, middle) >= number
            low, high = (low, middle) if many else (middle, high)
        return low

    found = cosserat.run(column)
    right = [load_of(1), load_of(2)]
    assert 1e-7 < right[1] - right[0] < 2e-5
    np.testing.assert_allclose(found.special_load_factor, right, atol=1e-9)
    assert list(found.special.to_numpy()) == ["bifurcation, first instability", "bifurcation"]
    middle = np.abs(found.special_u.sel(axis="E2").isel(vertex=20))
    assert sorted(middle.to_numpy() > 0.5) == [False, True]


def test_the_determinant_of_a_point_is_that_of_its_dense_hessian():
    problem = cosserat.case("column_path").problem
    system = problem.system(problem.geometry)
    solver = EquilibriumSolver(system, NewtonSettings(), "column")
    arc = ArcLengthSettings(first=0.2, longest=0.5, count=12, until=1.5, limit=9, branches=0)
    points, free = list(trace_path(solver, unloaded(solver), arc)), ~system.constrained
    known = [point for point in points if point.log_determinant is not None]
    assert {point.stable for point in known} == {True, False}
    for point in known:
        tangent = Tangent(system)
        system.assemble(point.q, point.history, point.factor, tangent)
        dense = to_dense(tangent.band)[np.ix_(free, free)]
        assert point.log_determinant == pytest.approx(np.linalg.slogdet(dense)[1], rel=1e-11)
        tangent.constrain(system.constrained)
        tangent.band[~free, 0] = 1.0
        assert Factors(tangent.band).log == pytest.approx(point.log_determinant, rel=1e-11)


@pytest.mark.parametrize("it", ["column", "arch"])
def test_a_crossing_is_located_where_bisection_of_its_arc_locates_it(it, monkeypatch):
    """The determinant only tells which parts of the arc are worth a try."""

    def crossings():
        problem, tries = (arch() if it == "arch" else cosserat.case("column_path")).problem, []
        system, _ = problem.grown(problem.geometry, it)
        solver = EquilibriumSolver(system, problem.newton, it)
        locate = continuation._share
        with monkeypatch.context() as patched:
            patched.setattr(continuation, "_share", lambda *known: (tries.append(1), locate(*known))[1])
            list(trace_path(solver, unloaded(solver), ArcLengthSettings(0.05, 0.3, 100, 1.0, 3.0, 1)))
        return solver.crossings, len(tries)

    found, few = crossings()
    monkeypatch.setattr(continuation, "_share", lambda before, after, parts, runs: parts // 2)
    halved, many = crossings()
    assert few < many
    assert len(found) == len(halved) > 0
    for pair, same in zip(found, halved, strict=True):
        for one, other in zip(pair, same, strict=True):
            assert one.factor == other.factor
            np.testing.assert_array_equal(one.q, other.q)
