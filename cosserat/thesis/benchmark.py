"""Speed of the solvers on this machine, for `cosserat speed`."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import numpy as np

from cosserat.cases.catalogue import find, find_base
from cosserat.data.dataset import to_dataset
from cosserat.problems.crawl import Crawl
from cosserat.problems.many import members_of, solve_many
from cosserat.problems.motion import RodMotion
from cosserat.problems.path import RodPath
from cosserat.problems.static import RodStatics
from cosserat.runner import run
from cosserat.solvers.integrate import IntegratorSettings, integrate
from cosserat.solvers.many import Family
from cosserat.solvers.members import REACHED
from cosserat.studies.family import Task
from cosserat.studies.readouts import read_out
from cosserat.studies.solving import solve_members

T = TypeVar("T")
_STEP = 2.5e-4  # s
_RUNS = 3
_STATICS_RUNS = 10
_MEMBERS = 4096
_PATHS = 64
_STEPS = {20: 800, 200: 200, 2000: 20}
"""Steps of a motion by the number of vertices."""


def _fastest(
    work: Callable[[], T], runs: int, clock: Callable[[], float] = time.perf_counter
) -> tuple[float, T]:
    """Seconds of the fastest of several runs, by wall clock or another one, and the result of the last one."""
    best = float("inf")
    for _ in range(runs):
        start = clock()
        done = work()
        best = min(best, clock() - start)
    return best, done


def statics() -> Iterator[str]:
    """Lines with the method and with the seconds for an equilibrium of each rod."""
    yield (
        "Equilibria, from the parameters to strains and support forces, by wall clock, kernels compiled, "
        f"nothing written; the fastest of {_STATICS_RUNS} runs:"
    )
    for name, vertices in (
        ("clamped_free", 20),
        ("clamped_free_consistent", 20),
        ("elastica", 41),
        ("elastica", 2001),
    ):
        problem = find(name).vary("speed", rod={"vertices": vertices}).problem_as(RodStatics)
        problem.solve("speed")  # kernels warm
        best, done = _fastest(functools.partial(problem.solve, "speed"), _STATICS_RUNS)
        yield (
            f"{vertices:5d} vertices: {1e3 * best:8.2f} ms, {done.statistics['iterations']} Newton iterations ({name})"
        )


def many() -> Iterator[str]:
    """Lines with the method and with the equilibria per second of many rods at once, and where their time goes."""
    yield (
        f"Equilibria of {_MEMBERS} rods of 20 vertices like case 'elastica' by the compiled loop, their constants "
        f"ready, by CPU time of one core; the fastest of {_RUNS} runs:"
    )
    slender = find("elastica").vary("speed", rod={"vertices": 20}).problem_as(RodStatics)
    unit = slender.rod.young * slender.rod.second_moment / slender.rod.length**2
    system = slender.system(slender.geometry)
    family = Family.of(system, slender.newton)
    assert family is not None
    spread = np.linspace(0.5, 1.0, _MEMBERS)
    for largest in (1.0, 2.0, 10.0):
        columns = {
            "forces.0.force": largest * unit * spread**2,
            "rod.material.young": slender.rod.young * spread,
        }
        members, _, _ = members_of(slender, columns, system)
        best, answers = _fastest(functools.partial(family.solve, members), _RUNS, time.process_time)
        mean = answers.counts[:, 0].mean()
        left = int((answers.status != REACHED).sum())
        yield (
            f"P L^2 / EI from {largest / 2:g} to {largest:g}: {_each(best)}, {mean:.1f} Newton iterations, {left} left"
        )
    yield "The same from columns of values, by CPU time of one core; in two threads positions by wall clock:"
    work: dict[str, Callable[[], object]] = {"constants": lambda: members_of(slender, columns, system)}
    work |= {"positions": lambda: solve_many(slender, columns, ["x"])}
    work |= {"all fields": lambda: solve_many(slender, columns)}
    for name, each in work.items():
        best, _ = _fastest(each, _RUNS, time.process_time)
        yield f"{name:>18}: {_each(best)}"
    halves = [{key: values[k::2] for key, values in columns.items()} for k in (0, 1)]
    with ThreadPoolExecutor(len(halves)) as pool:
        best, _ = _fastest(
            lambda: list(pool.map(lambda own: solve_many(slender, own, ["x"]), halves)), _RUNS
        )
    yield f"{'in two threads':>18}: {_each(best)}"


def _each(seconds: float) -> str:
    """The speed of so many members in a time, in words."""
    return f"{_MEMBERS / seconds:8.0f} a second, {1e6 * seconds / _MEMBERS:6.1f} µs each"


def paths() -> Iterator[str]:
    """Lines with the method and with the paths per second of the members of two studies."""
    yield (
        f"Paths of {_PATHS} members of a study, from their values to one read-out, by CPU time of one core; the "
        f"fastest of {_RUNS} runs:"
    )
    column = find("column_path").vary("speed", rod={"vertices": 20})
    deflection = read_out("tip", "final u.E2 at last", "speed")
    load = read_out("load", "load_factor where max |fibre_stress| reaches 0.2 MPa", "speed")
    for name, base, kept in (
        ("a column buckles", column, deflection),
        ("one with a bow", find_base("_imperfect_column"), load),
    ):
        young = base.problem_as(RodPath).rod.young * np.linspace(0.95, 1.05, _PATHS)
        task = Task(base, ("rod.material.young",), (young,), (kept,), ())
        best, solved = _fastest(functools.partial(solve_members, task), _RUNS, time.process_time)
        yield (
            f"{name:>18}: {_PATHS / best:6.0f} a second, {1e3 * best / _PATHS:6.2f} ms each, "
            f"{solved.iterations.mean():.1f} Newton iterations"
        )


def one_run() -> Iterator[str]:
    """Lines with the milliseconds of the parts of one run."""
    yield (
        f"One run of case 'clamped_free', from the case to the Dataset, by CPU time; the fastest of {_STATICS_RUNS} "
        "runs:"
    )
    case = find("clamped_free")
    problem = case.problem_as(RodStatics)
    geometry = problem.geometry
    system = problem.system(geometry)
    solution = problem.solve("speed")
    parts: dict[str, Callable[[], object]] = {
        "to vary it": lambda: case.vary("speed", gravity={"g": 9.0}),
        "its system": lambda: problem.system(geometry),
        "the equilibrium": lambda: problem.equilibrium(geometry, system, "speed"),
        "system to solution": lambda: problem.solve("speed"),
        "the Dataset": lambda: to_dataset(case, solution),
        "all of run": lambda: run(case),
    }
    for name, each in parts.items():
        best, _ = _fastest(each, _STATICS_RUNS, time.process_time)
        yield f"{name:>18}: {1e3 * best:6.2f} ms"


def integrator() -> Iterator[str]:
    """Lines with the method and with the steps per second of each rod for the vibrating beam of Fig. 3.13."""
    for name, rod in (
        ("vibration_c4_20", "the published rod"),
        ("vibration_consistent", "the consistent rod"),
    ):
        yield (
            f"Implicit steps of {1e3 * _STEP:g} ms from the start of case '{name}', {rod}, by wall clock, "
            f"kernels compiled and one step done before, nothing written; the fastest of {_RUNS} runs:"
        )
        settings = IntegratorSettings(step=_STEP)
        for vertices, steps in _STEPS.items():
            problem = find(name).vary("speed", rod={"vertices": vertices}).problem_as(RodMotion)
            system, state = problem.system(problem.geometry), problem.begin()
            integrate(system, state, settings.step, settings, "speed")
            work = functools.partial(integrate, system, state, steps * settings.step, settings, "speed")
            best, _ = _fastest(work, _RUNS)
            yield (
                f"{vertices:5d} vertices: {steps / best:8.0f} steps/s, {1e6 * best / steps:8.0f} µs a step "
                f"({steps} steps)"
            )


def stride() -> Iterator[str]:
    """Lines with the method and with the seconds of each solver for the instants of one stride of the worm."""
    yield (
        "One stride of case 'worm', by wall clock, kernels compiled, nothing written; collocation (SciPy's solve_bvp) "
        f"once, the banded Newton method the fastest of {_RUNS} runs:"
    )
    seconds = {}
    for solver, runs in (("collocation", 1), ("banded", _RUNS)):
        problem = find("worm").vary("speed", solver=solver, strides=1).problem_as(Crawl)
        problem.replace(step=1.0).solve("speed")  # kernels warm
        seconds[solver], done = _fastest(functools.partial(problem.solve, "speed"), runs)
        instants = done.statistics["instants"]
        each = 1e3 * seconds[solver] / instants
        yield f"a stride by {solver:11}: {seconds[solver]:8.3f} s, {each:6.2f} ms for each of {instants}"
    yield f"ratio: {seconds['collocation'] / seconds['banded']:.0f}"
