"""Shared pieces of the tests: a rod of any size, and random states of it."""

from __future__ import annotations

import fcntl
import gc
import os
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from cosserat.problems.static import RodStatics
from cosserat.rods.rod import Rod
from cosserat.thesis.stored import STUDIES

gc.set_threshold(
    100_000
)  # as the command line does: collecting and importing make millions of objects that stay
settings.register_profile("project", deadline=None, derandomize=True, max_examples=40)
settings.load_profile("project")

ROOT = Path(__file__).parents[1]


def examples():
    """Cases of kinds that no publication has a case of, by name."""
    import cosserat

    return cosserat.load_cases(ROOT / "tests" / "examples.toml")


def case_of_kind(kind):
    """The first published case of that kind, or else the first of `tests/examples.toml`."""
    import cosserat

    known = [*cosserat.published().values(), *examples().values()]
    found = [case for case in known if case.problem.kind == kind]
    assert found, f"no case is of kind '{kind}'; add one to a case file or to tests/examples.toml"
    return found[0]


def base_of(study):
    """The case that a published study varies."""
    from cosserat.studies.door import find_study

    return find_study(study).base


def make_rod(**changes):
    """The rod of section 3.5 with changes."""
    import cosserat

    return cosserat.case("necking").problem.rod.replace(**changes)


def save_own(data, path):
    """Write a changed Dataset as if the package had computed it."""
    import cosserat
    from cosserat.data.content import stamped

    cosserat.save(stamped(data), path)


def sine(frequency):
    """A function of time that oscillates."""
    return {"kind": "sine", "frequency": frequency}


def random_state(rod: Rod, seed: int, size: float = 0.3, turn: float | None = None):
    """A strained and rotated configuration, shape (4 N,): relative strains up to about `size`."""
    rng = np.random.default_rng(seed)
    geometry = rod.geometry()
    h, director = geometry.edge_length.mean(), geometry.director_length.mean()
    x = geometry.X + size * h * rng.uniform(-1, 1, geometry.X.shape)
    d = geometry.D + size * director * rng.uniform(-1, 1, geometry.D.shape)
    angle = rng.uniform(-np.pi, np.pi) if turn is None else turn
    c, s = np.cos(angle), np.sin(angle)
    R = np.array([[c, -s], [s, c]])
    return np.hstack([x @ R.T + rng.uniform(-3, 3, 2), d @ R.T]).ravel()


def assembled(potential, q):
    """Energy, gradient (n,) and dense Hessian (n, n) at q."""
    from cosserat.solvers.banded import to_dense

    gradient = np.empty(q.size)
    band = np.empty((q.size, potential.half_bandwidth + 1))
    energy = potential.assemble(q, gradient, band)
    return energy, gradient, to_dense(band)


def jacobian(function, q, h):
    """Derivatives of a function at q by central differences, one column per entry of q."""
    columns = [(function(q + shift) - function(q - shift)) / (2 * h) for shift in h * np.eye(q.size)]
    return np.array(columns).T


def differentiated(potential, q):
    """Energy and gradient (n,) at q."""
    gradient = np.zeros(q.size)
    return potential.add_gradient(q, potential.history, gradient), gradient


@pytest.fixture(scope="session")
def solved(tmp_path_factory):
    """Every published case, example and study by name, solved when first asked for, once for all processes of a run."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if os.environ.get("PYTEST_XDIST_WORKER") else base
    return Solved(shared / "solved" / "cases")


def solution_of(name):
    """The result of a published case, of an example, or of a published study."""
    import cosserat
    from cosserat.studies.door import find_study, published_studies, solved

    if name in published_studies():
        return solved(find_study(name), silent)
    return cosserat.run(examples().get(name, name))


def silent(fraction, words):
    """Report nothing."""


class Solved(Mapping):
    """Results by the name of their case or study, kept as files that other processes of the same run read.

    folder : of the cases; that of the studies is beside it, as the workflow has them.
    """

    def __init__(self, folder):
        self.folder, self.known = folder, {}
        for one in (folder, folder.parent / STUDIES):
            one.mkdir(parents=True, exist_ok=True)

    def __getitem__(self, name):
        import cosserat
        from cosserat.studies.door import published_studies

        if name not in self.known:
            place = self.folder.parent / STUDIES if name in published_studies() else self.folder
            path = place / f"{name}.nc"
            with (self.folder / f"{name}.lock").open("w") as lock:
                fcntl.flock(lock, fcntl.LOCK_EX)
                if not path.exists():
                    cosserat.save(solution_of(name), path)
            self.known[name] = cosserat.load(path)
        return self.known[name]

    def __iter__(self):
        import cosserat

        return iter(cosserat.published())

    def __len__(self):
        return len(list(iter(self)))


@pytest.fixture(scope="session", autouse=True)
def compiled(tmp_path_factory):
    """Where nothing is compiled yet, two processes of a run compile one half each instead of all of it twice."""
    worker = os.environ.get("PYTEST_XDIST_WORKER", "")
    if not worker or os.environ["PYTEST_XDIST_WORKER_COUNT"] == "1":
        return
    share = int(worker.removeprefix("gw")) % 2
    locks = [tmp_path_factory.getbasetemp().parent / f"compiling_{number}" for number in (0, 1)]
    with locks[share].open("w") as own:
        fcntl.flock(own, fcntl.LOCK_EX)
        compile_share(share)
    with locks[1 - share].open("w") as other:
        fcntl.flock(other, fcntl.LOCK_EX)


def compile_share(share):
    """Half of the kernels: that of the implicit method, which takes as long as all others together, or those."""
    import cosserat

    if share == 0:
        cosserat.run(cosserat.case("vibration_consistent").vary("x", duration=1e-3, every=1e-3))
        return
    for name, changes in (("clamped_free", {}), ("worm", COARSE), ("soft_robot", COARSE)):
        cosserat.run(cosserat.case(name).vary("x", **changes))
    for name in ("roll_up", "column_path"):
        cosserat.run(name)


COARSE = {"strides": 1, "step": 1.0}


@pytest.fixture
def untraced():
    """No tracing of lines while something is timed: coverage slows Python, not what is compiled."""
    tracer = sys.gettrace()
    sys.settrace(None)
    yield
    sys.settrace(tracer)


@pytest.fixture
def problem() -> RodStatics:
    """The clamped-free beam."""
    import cosserat

    return cosserat.case("clamped_free").problem
