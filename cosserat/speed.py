"""How fast the solvers are on this machine: what `cosserat speed` prints."""

from __future__ import annotations

import time
from collections.abc import Iterator

from cosserat.cases.catalogue import find
from cosserat.models.peristalsis import Crawl
from cosserat.models.rod_motion import RodMotion
from cosserat.solvers.motion import IntegratorSettings, advance

_STEP = 2.5e-4  # s
_RUNS = 3


def integrator() -> Iterator[str]:
    """How it is measured, then steps a second on the vibrating beam of Fig. 3.13."""
    yield (
        f"Implicit steps of {1e3 * _STEP:g} ms from the start of case 'vibration_c4_20' (Fig. 3.13), by wall clock, "
        f"kernels compiled and one step done before, nothing written; the fastest of {_RUNS} runs:"
    )
    settings = IntegratorSettings(step=_STEP)
    for vertices, steps in ((20, 800), (200, 200), (2000, 20)):
        problem = find("vibration_c4_20").vary("speed", rod={"vertices": vertices}).problem
        assert isinstance(problem, RodMotion)
        system, state = problem.system(problem.rod.geometry()), problem.begin()
        advance(system, state, settings.step, settings, "speed")
        best = float("inf")
        for _again in range(_RUNS):
            start = time.perf_counter()
            advance(system, state, steps * settings.step, settings, "speed")
            best = min(best, time.perf_counter() - start)
        yield (
            f"{vertices:5d} vertices: {steps / best:8.0f} steps/s, {1e6 * best / steps:8.0f} µs a step ({steps} steps)"
        )


def stride() -> Iterator[str]:
    """How it is measured, then seconds for the instants of one stride of the worm by either solver."""
    yield (
        "One stride of case 'worm', by wall clock, kernels compiled, nothing written; collocation (SciPy's solve_bvp) "
        f"once, the banded Newton method the fastest of {_RUNS} runs:"
    )
    seconds = {}
    for solver, runs in (("collocation", 1), ("banded", _RUNS)):
        problem = find("worm").vary("speed", solver=solver, strides=1).problem
        assert isinstance(problem, Crawl)
        problem.replace(step=1.0).solve("speed")  # kernels warm
        seconds[solver] = float("inf")
        for _ in range(runs):
            start = time.perf_counter()
            done = problem.solve("speed").statistics
            seconds[solver] = min(seconds[solver], time.perf_counter() - start)
        each = 1e3 * seconds[solver] / done["instants"]
        yield f"a stride by {solver:11}: {seconds[solver]:8.3f} s, {each:6.2f} ms for each of {done['instants']}"
    yield f"ratio: {seconds['collocation'] / seconds['banded']:.0f}"
