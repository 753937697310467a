"""Time and error of the consistent rod and of other packages on shared problems, in one run on one machine.

The other packages are in another environment.  Each has a script beside this file, which gets a problem as JSON and
prints its measurement for each line of input.  Runs of the packages alternate, so other load of the machine affects
all of them.  Errors are computed here, against the same exact answers for all.
"""

from __future__ import annotations

import contextlib
import csv
import datetime
import functools
import json
import os
import platform
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, Any, Self

import numpy as np

from cosserat.cases.catalogue import Case, find
from cosserat.data.files import whole_or_absent
from cosserat.data.provenance import environment, source
from cosserat.errors import CosseratError, InputError
from cosserat.exact import beams, elastica
from cosserat.problems.calibration import beam_of
from cosserat.problems.motion import RodMotion
from cosserat.problems.static import RodStatics
from cosserat.rods.loads.dead import PointForce
from cosserat.rods.problem import RodProblem
from cosserat.runner import run
from cosserat.solvers.equilibrium import EquilibriumSolver
from cosserat.solvers.incremental import solve_full_load
from cosserat.solvers.integrate import IntegratorSettings, integrate
from cosserat.thesis.table.readouts import period

RUNS = 5
_START = 30.0  # seconds in which a Python starts
_FORCE, _DURATION, _STEPS = 10.0, 0.2, 800
SCRIPTS = {"Exudyn": "with_exudyn.py", "PyElastica": "with_pyelastica.py"}


@dataclass(frozen=True)
class Problem:
    """One problem for all packages: a clamped rod in SI units.

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
    """One line of the table: median, least and most seconds of several runs, the relative error, and the machine.

    seconds : of the solver alone, the model built before.  whole : median seconds from the parameters to the answer,
        in statics of our rod from the case to the Dataset.
    versions : of the package and of its dependencies.  load : processes waiting for the machine just before.
    """

    problem: str
    package: str
    runs: int
    seconds: float
    least: float
    most: float
    whole: float
    error: float
    versions: str
    date: str
    processor: str
    load: float


def problems() -> dict[Problem, RodStatics | RodMotion]:
    """Every problem, with the problem of our rod."""
    case: dict[Problem, RodStatics | RodMotion] = {}
    weight = find("clamped_free_consistent").problem_as(RodStatics)
    assert weight.gravity is not None
    beam = beam_of(weight)
    case[
        _problem(
            "(a) clamped-free, 19 elements", "weight", 19, weight, beam.line_density * weight.gravity.g
        )
    ] = weight
    slender = find("elastica").problem_as(RodStatics)
    beam = beam_of(slender)
    force = _FORCE * beam.bending_stiffness / beam.length**2
    for count in (20, 40, 80):
        bent = slender.replace(
            rod=slender.rod.replace(vertices=count + 1),
            forces=(PointForce(at="last", along="E2", force=force),),
        )
        case[_problem(f"(b) elastica, {count} elements", "force", count, bent, force)] = bent
    for count in (20, 200, 2000):
        moved = (
            find("vibration_consistent").vary("peers", rod={"vertices": count + 1}).problem_as(RodMotion)
        )
        case[_problem(f"(c) vibration, {count} elements", "vibration", count, moved, 1e-3)] = moved
    return case


def _problem(name: str, kind: str, elements: int, case: RodStatics | RodMotion, load: float) -> Problem:
    beam = beam_of(case)
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


def compare(python: Path, progress: Callable[[str], None], runs: int = RUNS) -> Iterator[Line]:
    """Lines of the table, ours first of each problem; `python` is that of the other packages' environment.

    Raises
    ------
    InputError : there is no such Python.
    CosseratError : a package could not be run.
    """
    if not python.is_file():
        raise InputError(f"there is no Python {python}; make the environment with 'snakemake peers'")
    asked = subprocess.run(
        [python, "-c", "print('here')"], capture_output=True, text=True, timeout=_START, check=False
    )
    if asked.stdout != "here\n":
        raise InputError(f"{python} is no Python; make the environment with 'snakemake peers'")
    for problem, ours in problems().items():
        with contextlib.ExitStack() as running:
            packages: list[_Ours | _Peer] = [_Ours(problem, ours)]
            for package, script in SCRIPTS.items():
                progress(f"{problem.name}, {package} starts")
                peer = running.enter_context(_Peer.started(package, python, script, problem))
                packages += [peer] if peer.versions else []
            yield from _in_turns(problem, ours, packages, runs, progress)


def _in_turns(
    problem: Problem,
    ours: RodStatics | RodMotion,
    packages: list[_Ours | _Peer],
    runs: int,
    progress: Callable[[str], None],
) -> Iterator[Line]:
    """Run 1 of every package, then run 2 of every package, and so on; one line for each."""
    load = os.getloadavg()[0]
    answers: list[list[dict[str, Any]]] = [[] for _ in packages]
    for turn in range(runs):
        progress(f"{problem.name}, run {turn + 1} of {runs}")
        for package, given in zip(packages, answers, strict=True):
            given.append(package.run())
    for package, given in zip(packages, answers, strict=True):
        seconds = [float(answer["seconds"]) for answer in given]
        yield Line(
            problem.name,
            package.name,
            runs,
            statistics.median(seconds),
            min(seconds),
            max(seconds),
            statistics.median(float(answer["whole"]) for answer in given),
            _error(problem, ours, given[-1]),
            ", ".join(f"{name} {version}" for name, version in package.versions.items()),
            datetime.date.today().isoformat(),
            processor(),
            load,
        )


def processor() -> str:
    """The model of this machine's processor."""
    with contextlib.suppress(OSError), Path("/proc/cpuinfo").open(encoding="utf-8") as file:
        for line in file:
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


class _Ours:
    """The consistent rod on one problem, its kernels compiled."""

    name = "cosserat"

    def __init__(self, problem: Problem, case: RodStatics | RodMotion) -> None:
        self.problem, self.case = problem, case
        self.versions = {"cosserat": source().split(",")[0].split()[1], **environment()}
        self.run()

    def run(self) -> dict[str, Any]:
        """One run."""
        return _solve(self.case, self.problem)


@dataclass
class _Peer:
    """Another package on one problem, in a process of its own that waits between its runs."""

    name: str
    script: str
    problem: Problem
    process: subprocess.Popen[str]
    complaints: IO[str]
    versions: dict[str, str]

    @classmethod
    @contextlib.contextmanager
    def started(cls, name: str, python: Path, script: str, problem: Problem) -> Iterator[Self]:
        """The package, ready to run; without versions if the problem is too large for it."""
        command = [str(python), str(Path(__file__).parent / script), json.dumps(asdict(problem))]
        with (
            tempfile.TemporaryFile("w+", encoding="utf-8") as complaints,
            subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=complaints,
                text=True,
                env={"OMP_NUM_THREADS": "1", "PATH": ""},
            ) as process,
        ):
            peer = cls(name, script, problem, process, complaints, {})
            try:
                peer.versions = peer._answer()
                yield peer
            finally:
                process.kill()

    def run(self) -> dict[str, Any]:
        """One run."""
        assert self.process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.write("\n")
            self.process.stdin.flush()
        return self._answer()

    def _answer(self) -> dict[str, Any]:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            if line.startswith("{"):  # other output of a package
                answer: dict[str, Any] = json.loads(line)
                return answer
        self.process.wait()
        self.complaints.seek(0)
        last = (self.complaints.read().strip().splitlines() or ["no message"])[-1]
        raise CosseratError(
            f"{self.script} failed on {self.problem.name}: {last}; make the environment with 'snakemake peers'"
        )


@functools.singledispatch
def _solve(case: RodProblem, problem: Problem) -> dict[str, Any]:
    """One run of our rod; as for the others, the model is built before the clock starts."""
    raise NotImplementedError(type(case).__name__)


@_solve.register
def _solve_statics(case: RodStatics, problem: Problem) -> dict[str, Any]:
    system = case.system(case.geometry)
    start = time.perf_counter()
    found = solve_full_load(EquilibriumSolver(system, case.newton, problem.name))
    taken = time.perf_counter() - start
    posed = Case(name="peers", title=problem.name, problem=case)
    start = time.perf_counter()
    run(posed)
    whole = time.perf_counter() - start
    u = found.q.reshape(-1, 4)[:, 1]
    return {"seconds": taken, "whole": whole, "profile": u.tolist(), "tip": float(u[-1])}


@_solve.register
def _solve_motion(case: RodMotion, problem: Problem) -> dict[str, Any]:
    small = case.replace(start=case.start.replace(amplitude=problem.load))
    built = time.perf_counter()
    system, state = small.system(small.geometry), small.begin()
    settings = IntegratorSettings(step=problem.duration / problem.steps)
    start = time.perf_counter()
    integrate(system, state, problem.duration, settings, problem.name)
    taken, whole = time.perf_counter() - start, time.perf_counter() - built
    times, tips = [0.0], [float(state.q[-3])]
    for _ in range(problem.steps // 4):
        state, _done = integrate(system, state, 4 * settings.step, settings, problem.name)
        times.append(state.time)
        tips.append(float(state.q[-3]))
    return {"seconds": taken, "whole": whole, "times": times, "tips": tips}


def _error(problem: Problem, case: RodStatics | RodMotion, answer: dict[str, Any]) -> float:
    """Relative error, against the same exact answers for all packages."""
    if problem.kind == "weight":
        beam = beam_of(case)
        g = problem.load / beam.line_density
        xi = np.array(answer.get("places", np.linspace(0, beam.length, problem.elements + 1)))
        exact = beams.clamped_free_displacement(beam, g, xi)
        return float(np.abs(np.array(answer["profile"]) - exact).max() / np.abs(exact).max())
    unit = problem.bending / problem.length**2
    if problem.kind == "force":
        exact_tip, _ = elastica.shearable_tip(
            problem.load / unit, problem.axial / unit, problem.shear / unit
        )
        return abs(float(answer["tip"]) / problem.length / exact_tip - 1)
    exact_period = 2 * np.pi / elastica.timoshenko_frequencies(beam_of(case), 1)[0]
    return abs(period(np.array(answer["times"]), np.array(answer["tips"])) / float(exact_period) - 1)


def write(lines: list[Line], path: Path) -> None:
    """Write the table."""
    with whole_or_absent(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(Line.__dataclass_fields__), lineterminator="\n")
        writer.writeheader()
        for line in lines:
            writer.writerow(
                {k: f"{v:.4g}" if isinstance(v, float) else v for k, v in asdict(line).items()}
            )
