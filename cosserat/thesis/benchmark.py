"""Speed of the solvers on this machine, for `cosserat speed`."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator
from typing import TypeVar

from cosserat.cases.catalogue import find
from cosserat.problems.crawl import Crawl
from cosserat.problems.motion import RodMotion
from cosserat.problems.static import RodStatics
from cosserat.solvers.integrate import IntegratorSettings, integrate

T = TypeVar("T")
_STEP = 2.5e-4  # s
_RUNS = 3
_STATICS_RUNS = 10
_STEPS = {20: 800, 200: 200, 2000: 20}
"""Steps of a motion by the number of vertices."""


def _fastest(work: Callable[[], T], runs: int) -> tuple[float, T]:
    """Seconds of the fastest of several runs, by wall clock, and the result of the last one."""
    best = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        done = work()
        best = min(best, time.perf_counter() - start)
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
