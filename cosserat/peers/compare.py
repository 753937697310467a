"""Time and error of the consistent rod and of other packages on shared problems, in one run on one machine.

The other packages live in another environment: each has a script beside this file, which is given the problems as JSON
and answers with what it measured.  Errors are taken here, against the same exact answers for everyone.
"""

from __future__ import annotations

import csv
import json
import statistics
import subprocess
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cosserat import analytic, elastica
from cosserat.cases.catalogue import find
from cosserat.data.files import whole_or_absent
from cosserat.errors import CosseratError
from cosserat.models.calibration import beam_of
from cosserat.models.rod_motion import RodMotion
from cosserat.models.rod_problem import PointForce
from cosserat.models.rod_statics import RodStatics
from cosserat.solvers.climb import Climb
from cosserat.solvers.motion import IntegratorSettings, advance
from cosserat.solvers.path import lead
from cosserat.table.readouts import period

RUNS = 5
_FORCE, _DURATION, _STEPS = 10.0, 0.2, 800
SCRIPTS = {"Exudyn": "with_exudyn.py", "PyElastica": "with_pyelastica.py"}


@dataclass(frozen=True)
class Problem:
    """One problem, as every package gets it: a clamped rod in SI units.

    kind : "weight", "force" or "vibration".  load : weight per length, force, or amplitude of the first mode.
    """

    name: str
    kind: str
    elements: int
    length: float
    axial: float
    shear: float
    bending: float
    line_density: float
    rotary: float
    load: float
    duration: float
    steps: int


@dataclass(frozen=True)
class Line:
    """One line of the table: median, least and most seconds of several runs, and the relative error."""

    problem: str
    package: str
    version: str
    runs: int
    seconds: float
    least: float
    most: float
    error: float


def problems() -> dict[Problem, RodStatics | RodMotion]:
    """Every problem, and how our rod poses it."""
    posed: dict[Problem, RodStatics | RodMotion] = {}
    weight = find("clamped_free_consistent").problem
    assert isinstance(weight, RodStatics)
    assert weight.gravity is not None
    beam = beam_of(weight)
    posed[
        _problem(
            "(a) clamped-free, 19 elements", "weight", 19, weight, beam.line_density * weight.gravity.g
        )
    ] = weight
    slender = find("elastica").problem
    assert isinstance(slender, RodStatics)
    beam = beam_of(slender)
    force = _FORCE * beam.bending_stiffness / beam.length**2
    for count in (20, 40, 80):
        bent = slender.replace(
            rod=slender.rod.replace(vertices=count + 1),
            forces=(PointForce(at="last", along="E2", force=force),),
        )
        posed[_problem(f"(b) elastica, {count} elements", "force", count, bent, force)] = bent
    for count in (20, 200, 2000):
        moved = find("vibration_consistent").vary("peers", rod={"vertices": count + 1}).problem
        assert isinstance(moved, RodMotion)
        posed[_problem(f"(c) vibration, {count} elements", "vibration", count, moved, 1e-3)] = moved
    return posed


def _problem(name: str, kind: str, elements: int, posed: RodStatics | RodMotion, load: float) -> Problem:
    beam = beam_of(posed)
    return Problem(
        name,
        kind,
        elements,
        length=beam.length,
        axial=beam.axial_stiffness,
        shear=beam.shear_stiffness,
        bending=beam.bending_stiffness,
        line_density=beam.line_density,
        rotary=beam.line_density * beam.second_moment / beam.area,
        load=load,
        duration=_DURATION,
        steps=_STEPS,
    )


def compare(python: Path, progress: Callable[[str], None]) -> Iterator[Line]:
    """Lines of the table, ours first; `python` is that of the other packages' environment.

    Raises
    ------
    CosseratError : a package could not be run.
    """
    posed = problems()
    for problem, ours in posed.items():
        progress(f"{problem.name}, cosserat")
        yield _ours(problem, ours)
    for package, script in SCRIPTS.items():
        for problem, ours in posed.items():
            progress(f"{problem.name}, {package}")
            answer = _ask(python, script, problem)
            if answer:
                yield _line(
                    problem, package, answer["version"], answer["seconds"], _error(problem, ours, answer)
                )


def _ours(problem: Problem, posed: RodStatics | RodMotion) -> Line:
    from cosserat.data.provenance import source

    seconds: list[float] = []
    answer: dict[str, Any] = {}
    for run in range(RUNS + 1):
        answer, taken = _solve(problem, posed)
        if run:  # the first has compiled what was not
            seconds.append(taken)
    return _line(
        problem, "cosserat", source().split(",")[0].split()[1], seconds, _error(problem, posed, answer)
    )


def _solve(problem: Problem, posed: RodStatics | RodMotion) -> tuple[dict[str, Any], float]:
    if isinstance(posed, RodStatics):  # as for the others, the model is built before
        loaded = posed.loaded(posed.rod.geometry())
        start = time.perf_counter()
        found = lead(Climb(loaded, posed.newton, problem.name), np.zeros(loaded.held.size))
        taken = time.perf_counter() - start
        u = found.q.reshape(-1, 4)[:, 1]
        return {"profile": u.tolist(), "tip": float(u[-1])}, taken
    small = posed.replace(start=posed.start.replace(amplitude=problem.load))
    system, state = small.system(small.rod.geometry()), small.begin()
    settings = IntegratorSettings(step=problem.duration / problem.steps)
    start = time.perf_counter()
    advance(system, state, problem.duration, settings, problem.name)
    taken = time.perf_counter() - start
    times, tips = [0.0], [float(state.q[-3])]
    for _ in range(problem.steps // 4):
        state, _done = advance(system, state, 4 * settings.step, settings, problem.name)
        times.append(state.time)
        tips.append(float(state.q[-3]))
    return {"times": times, "tips": tips}, taken


def _error(problem: Problem, posed: RodStatics | RodMotion, answer: dict[str, Any]) -> float:
    """Against the same exact answers for everyone."""
    if problem.kind == "weight":
        beam = beam_of(posed)
        g = problem.load / beam.line_density
        xi = np.array(answer.get("places", np.linspace(0, beam.length, problem.elements + 1)))
        exact = analytic.clamped_free_displacement(beam, g, xi)
        return float(np.abs(np.array(answer["profile"]) - exact).max() / np.abs(exact).max())
    unit = problem.bending / problem.length**2
    if problem.kind == "force":
        exact_tip, _ = elastica.shearable_tip(
            problem.load / unit, problem.axial / unit, problem.shear / unit
        )
        return abs(float(answer["tip"]) / problem.length / exact_tip - 1)
    exact_period = 2 * np.pi / elastica.timoshenko_frequencies(beam_of(posed), 1)[0]
    return abs(period(np.array(answer["times"]), np.array(answer["tips"])) / float(exact_period) - 1)


def _ask(python: Path, script: str, problem: Problem) -> dict[str, Any]:
    done = subprocess.run(
        [str(python), str(Path(__file__).with_name(script)), json.dumps(asdict(problem)), str(RUNS)],
        capture_output=True,
        text=True,
        check=False,
        env={"OMP_NUM_THREADS": "1", "PATH": ""},
    )
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise CosseratError(
            f"{script} failed on {problem.name}: {last}; make the environment with 'snakemake peers'"
        )
    answer: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1])
    return answer


def _line(problem: Problem, package: str, version: str, seconds: list[float], error: float) -> Line:
    return Line(
        problem.name,
        package,
        version,
        len(seconds),
        statistics.median(seconds),
        min(seconds),
        max(seconds),
        error,
    )


def write(lines: list[Line], path: Path) -> None:
    """Write the table."""
    with whole_or_absent(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(Line.__dataclass_fields__), lineterminator="\n")
        writer.writeheader()
        for line in lines:
            writer.writerow(
                {k: f"{v:.4g}" if isinstance(v, float) else v for k, v in asdict(line).items()}
            )
