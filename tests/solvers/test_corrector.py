"""Corrections of a path by the compiled loop and step by step; elsewhere closed forms say which are right."""

from dataclasses import replace

import numpy as np
import pytest

from cosserat.cases.catalogue import find
from cosserat.solvers import corrector
from cosserat.solvers.arcs import path_tangent
from cosserat.solvers.continuation import ArcLengthSettings, trace_path
from cosserat.solvers.equilibrium import EquilibriumSolver
from cosserat.solvers.incremental import unloaded

ARC = ArcLengthSettings(first=0.05, longest=0.3, count=500, until=1.0, limit=3.0, branches=1)


def path(name):
    """The solver of a published path, and its points."""
    problem = find(name).problem
    system, _ = problem.grown(problem.geometry, name)
    solver = EquilibriumSolver(system, problem.newton, name)
    return solver, list(trace_path(solver, unloaded(solver), ARC))


@pytest.mark.parametrize("name", ["column_path", "arch_path"])
def test_the_compiled_loop_and_single_steps_find_one_path(monkeypatch, name):
    solver, found = path(name)
    assert solver.corrector.compiled
    monkeypatch.setattr(corrector.Family, "of", lambda *_: None)
    other, stepped = path(name)
    assert not other.corrector.compiled
    assert [p.negative for p in found] == [p.negative for p in stepped]
    for one, two in zip(found, stepped, strict=True):
        assert one.factor == pytest.approx(two.factor, abs=1e-9)
        np.testing.assert_allclose(one.q, two.q, atol=1e-9)
        np.testing.assert_allclose(one.reaction, two.reaction, atol=1e-7)


def test_arcs_found_at_once_are_those_found_one_by_one(monkeypatch):
    solver, found = path("arch_path")
    monkeypatch.setattr(corrector, "_MOST_AHEAD", 1)
    other, alone = path("arch_path")
    assert other.iterations == solver.iterations
    for one, two in zip(found, alone, strict=True):
        assert (one.factor, one.iterations, one.residual) == (two.factor, two.iterations, two.residual)
        assert (one.q == two.q).all()


def test_the_rate_known_from_a_correction_is_that_of_an_assembly():
    solver, found = path("arch_path")
    known = [point for point in found if point.rate is not None]
    assert len(known) > 5
    assert any(not point.stable for point in known)
    for point in known:
        change, slope = path_tangent(solver, point, None)
        other, same = path_tangent(solver, replace(point, rate=None), None)
        np.testing.assert_allclose(change, other, atol=1e-8)
        assert slope == pytest.approx(same, abs=1e-8)
