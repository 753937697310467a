"""The instructions of CONTRIBUTING for a new energy, load, constraint and kind, followed with a toy of each.

None of them touches the package: each is a class, and one entry in a registry.
"""

import numpy as np
import pytest
from numba import njit
from scipy.integrate import solve_ivp

import cosserat
from cosserat.errors import InputError
from cosserat.kinds import KINDS, Kind
from cosserat.parameters import Parameters
from cosserat.problem import ALONE, Problem
from cosserat.problems.checkpoints import CheckpointedRun, state_of
from cosserat.problems.motion import RodMotion
from cosserat.problems.static import RodStatics
from cosserat.publications import kinds
from cosserat.rods.constraints import Constraint
from cosserat.rods.energies import ENERGIES
from cosserat.rods.energies.energy import Energy
from cosserat.rods.kinematics import Kinematics
from cosserat.rods.loads.load import Load
from cosserat.rods.problem import CONSTRAINTS, LOADS
from cosserat.solution import Solution
from cosserat.solvers.integrate import IntegratorSettings
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, STRAINS, Potential

CLAMP = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}

# ---------------------------------------------------------------- an energy of its own unknowns: a braced truss

BAR = np.dtype([("ends", "i8", (2,)), ("on", "f8", (2, 3)), ("stiffness", "f8"), ("square", "f8")])
"""Vertices of a bar; what its ends are in x, d and e of them; EA / L; L^2."""


@njit(cache=True)
def span(vectors, bar, r):
    """The vector of a bar, and its square."""
    a, b, square = bar.ends[0], bar.ends[1], 0.0
    for axis in range(2):
        r[axis] = 0.0
        for part in range(3):
            r[axis] += bar.on[1, part] * vectors[6 * b + 2 * part + axis]
            r[axis] -= bar.on[0, part] * vectors[6 * a + 2 * part + axis]
        square += r[axis] * r[axis]
    return square


@njit(cache=True)
def truss(q, after, data, history, strains, task, gradient, band, skew, terms):
    """k (r.r - L^2)^2 / (8 L^2) of every bar r, whose strain r.r is quadratic."""
    bars = data.view(BAR)
    terms[0], r = 0.0, np.zeros(2)
    for number in range(bars.size):
        bar = bars[number]
        square, stiffness = bar.square, bar.stiffness
        last = strain = span(after if after.size > 0 else q, bar, r)
        if task == STRAINS:
            strains[number, 0] = last
        if after.size > 0:
            strain = (strains[number, 0] + last) / 2
            span(q, bar, r)
        terms[0] += stiffness * (last - square) ** 2 / (8 * square)
        if task not in (GRADIENT, HESSIAN):
            continue
        first, second = stiffness * (strain - square) / (4 * square), stiffness / (4 * square)
        for i in range(6):
            p, one = 6 * bar.ends[i // 3] + 2 * (i % 3), (2 * (i // 3) - 1) * bar.on[i // 3, i % 3]
            for axis in range(2):
                gradient[p + axis] += 2 * first * one * r[axis]
            for j in range(6):
                s, other = 6 * bar.ends[j // 3] + 2 * (j % 3), (2 * (j // 3) - 1) * bar.on[j // 3, j % 3]
                for axis in range(2):
                    for along in range(2):
                        k = p + axis - (s + along)
                        if task == HESSIAN and k >= 0:
                            entry = 4 * second * r[axis] * r[along] + 2 * first * (axis == along)
                            band[s + along, k] += one * other * entry
    return terms[0]


class Truss(Energy):
    """A rod of braced bars: every section is a bar up, d, and a bar down, e."""

    kinematics = Kinematics(("E3", "E2"), ("x", "d", "e"))

    def check(self, rod):
        pass

    def reference(self, geometry):
        return np.hstack([geometry.X, geometry.D, -geometry.D]).ravel()

    def bars(self, rod):
        n, x, up, down = rod.vertices, (1, 0, 0), (1, 1, 0), (1, 0, 1)
        inside = [(K, K, x, up) for K in range(n)] + [(K, K, x, down) for K in range(n)]
        along = [(K, K + 1, part, part) for K in range(n - 1) for part in (x, up, down)]
        braces = [
            (K, K + 1, *pair) for K in range(n - 1) for pair in ((x, up), (up, x), (x, down), (down, x))
        ]
        return [*inside, *along, *braces]

    def potential(self, rod, geometry, *, displacements=False):
        at_rest = self.reference(geometry)
        bars = np.zeros(len(self.bars(rod)), BAR)
        for bar, (a, b, one, other) in zip(bars, self.bars(rod), strict=True):
            bar["ends"], bar["on"] = (a, b), (one, other)
            vectors = at_rest.reshape(-1, 3, 2)
            r = other @ vectors[b] - one @ vectors[a]
            bar["square"] = r @ r
            bar["stiffness"] = rod.young * rod.area / np.sqrt(r @ r)
        return Potential(
            truss,
            bars,
            ("bars",),
            half_bandwidth=11,
            strains=(bars.size, 1),
            origin=at_rest if displacements else None,
        )

    def mass(self, rod, geometry):
        m, zero = rod.part_masses(geometry), np.zeros(rod.vertices)
        own = [[m if a == b else zero for a in range(3)] for b in range(3)]
        return self.kinematics.mass_band(np.array(own) / 3)


@pytest.fixture
def trussed(monkeypatch):
    monkeypatch.setitem(ENERGIES, "truss", "test_toys:Truss")
    return {
        "energy": "truss",
        "calibration": "none",
        "vertices": 9,
        "section": {"height": 0.2},
        "length": 2.0,
    }


def truss_stiffness(rod):
    """The dense stiffness matrix: bars resist along their own direction."""
    own, at_rest = Truss(), Truss().reference(rod.geometry()).reshape(-1, 3, 2)
    K = np.zeros((6 * rod.vertices, 6 * rod.vertices))
    for a, b, one, other in own.bars(rod):
        r = other @ at_rest[b] - one @ at_rest[a]
        row = np.zeros((rod.vertices, 3, 2))
        row[b] += np.outer(other, r)
        row[a] -= np.outer(one, r)
        row = row.ravel() / np.linalg.norm(r)
        K += rod.young * rod.area / np.linalg.norm(r) * np.outer(row, row)
    return K


def linear_truss(rod, load):
    """Displacements of small size."""
    K = truss_stiffness(rod)
    free = np.r_[4 : K.shape[0]]  # x and d of the first vertex are fixed
    u = np.zeros(K.shape[0])
    u[free] = np.linalg.solve(K[np.ix_(free, free)], load[free])
    return u.reshape(-1, 3, 2)


def test_an_energy_with_its_own_unknowns_has_equilibria_motions_and_modes(trussed):
    forces = [{"at": "last", "along": "E2", "force": 1e-4}]
    braced = cosserat.case("elastica").vary("braced", rod=trussed, forces=forces, supports=[CLAMP])
    data = cosserat.run(braced)
    load = np.zeros((9, 3, 2))
    load[-1, 0, 1] = 1e-4
    right = linear_truss(braced.problem.rod, load.ravel())
    np.testing.assert_allclose(data.u, right[:, 0], atol=1e-6 * np.abs(right).max())
    assert braced.problem.modes(3).angular_frequency[0] > 0
    moved = cosserat.case("vibration_consistent")
    free = moved.vary(
        "thrown",
        rod={**trussed, "material": {"young": 1e6}},
        supports=[],
        start={"shape": "reference", "amplitude": 0.0, "speed": 1.0, "spin": 3.0},
        duration=0.2,
        every=0.05,
        integrator={"step": 1e-3},
    )
    flown = cosserat.run(free)
    total = (flown.kinetic_energy + flown.strain_energy).to_numpy()
    assert np.ptp(total) < 1e-9 * total[0]
    assert np.ptp(flown.angular_momentum.to_numpy()) < 1e-10 * abs(flown.angular_momentum[0])
    assert flown.other_dofs.shape == (5, 9, 2)


def test_a_damped_motion_with_its_own_unknowns_finds_its_fastest_mode(trussed):
    """The warning of unresolved damping has the fastest mode of the dense matrices."""
    case = cosserat.case("vibration_consistent").vary(
        "damped",
        rod={**trussed, "material": {"young": 1e6}},
        supports=[CLAMP],
        start={"shape": "reference"},
        damping=1.0,
    )
    rod = case.problem.rod
    mass = np.repeat(rod.part_masses(rod.geometry()) / 3, 6)[4:]
    squared = np.linalg.eigvalsh(truss_stiffness(rod)[4:, 4:] / np.sqrt(np.outer(mass, mass)))
    lowest, highest = np.sqrt(squared[[0, -1]])
    step = float(np.sqrt(10 / (2 * lowest * highest)))
    moved = case.problem.replace(duration=step, every=step, integrator=IntegratorSettings(step=step))
    (named,) = [words for words in moved.solve("damped").warnings if words.startswith("damping")]
    assert f"the fastest has {highest:.3g})" in named


def test_a_misspelt_energy_is_refused_with_the_known_names(trussed):
    with pytest.raises(InputError, match="'published' or 'consistent' or 'truss'"):
        cosserat.case("elastica").vary("x", rod={"energy": "trus"})


# ---------------------------------------------------------------- a load with a tangent that is not symmetric

PUSH = np.dtype([("force", "f8"), ("length", "f8"), ("at", "i8")])


@njit(cache=True)
def push(q, after, data, history, strains, task, gradient, band, skew, terms):
    """A force on a vertex along its director, which turns with it; no energy."""
    given = data.view(PUSH)[0]
    terms[0] = 0.0
    if task in (GRADIENT, HESSIAN):
        per = given.force / given.length
        for axis in range(2):
            gradient[given.at + axis] -= per * q[given.at + 2 + axis]
            if task == HESSIAN:  # of d(gradient of x) / d(director), above the diagonal
                band[given.at + axis, 2] -= per / 2
                if skew.size > 0:
                    skew[given.at + axis, 2] += per / 2
    return 0.0


class Push(Load):
    """A force that follows the director of the last vertex."""

    force: float

    @classmethod
    def potential(cls, loads, body):
        constants = np.zeros(1, PUSH)
        constants["force"] = sum(load.force for load in loads)
        constants["length"] = body.geometry.director_length[-1]
        constants["at"] = body.rod.dof("last", "x3", body.geometry.arc_length)
        return Potential(
            push,
            constants,
            ("push",),
            half_bandwidth=2,
            symmetric=False,
            origin=body.origin,
        )


class PushedStatics(RodStatics):
    kind: str = "pushed statics"
    pushes: tuple[Push, ...] = ()


class PushedMotion(RodMotion):
    kind: str = "pushed motion"
    pushes: tuple[Push, ...] = ()


@pytest.fixture
def pushes(monkeypatch):
    monkeypatch.setitem(LOADS, "pushes", Push)
    monkeypatch.setitem(KINDS, "pushed statics", Kind("test_toys:PushedStatics"))
    monkeypatch.setitem(KINDS, "pushed motion", Kind("test_toys:PushedMotion"))
    kinds.cache_clear()
    yield
    kinds.cache_clear()


def follower_angle(load):
    """Angle of the tip of an elastica of unit length and stiffness under an end force that stays across it.

    Seen from the tip the force keeps its direction, so that it is an initial value problem: theta'' = -load cos theta.
    """

    def rates(s, y):
        return [y[1], load * np.cos(y[0])]

    done = solve_ivp(rates, (0, 1), [0, 0], rtol=1e-11, atol=1e-12)
    return abs(done.y[0, -1])


def test_a_follower_load_agrees_with_the_elastica(pushes):
    problem = cosserat.case("elastica").problem
    section = problem.rod.section
    section = section.replace(height=section.height / 8, width=section.width / 8)
    base = problem.replace(rod=problem.rod.replace(section=section))
    bending = base.rod.young * base.rod.second_moment / base.rod.length**2
    table = base.model_dump() | {"kind": "pushed statics", "forces": []}
    found = []
    for vertices in (21, 41, 81):
        table["rod"] = table["rod"] | {"vertices": vertices}
        table["pushes"] = [{"force": 2.0 * bending}]
        problem = PushedStatics.read(table, "pushed", units_required=False)
        solution = problem.solve("pushed")
        d = solution["d"][-1]
        found.append(np.arctan2(-d[0], d[1]))
        assert solution.statistics["iterations"] < 60
    errors = np.abs(np.array(found) - follower_angle(2.0))
    assert errors[-1] < 1e-3
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(2, abs=0.2)


def test_the_work_of_a_follower_load_is_the_change_of_energy(pushes):
    table = cosserat.case("vibration_consistent").problem.model_dump()
    force = 1e-3 * table["rod"]["material"]["young"] * table["rod"]["section"]["height"] ** 4
    table |= {"kind": "pushed motion", "start": {}, "duration": 0.05, "every": 0.005, "damping": 0.0}
    table["pushes"] = [{"force": force}]
    missing = []
    for step in (5e-4, 2.5e-4):
        table["integrator"] = {"step": step}
        table["every"] = step
        moved = PushedMotion.read(table, "pushed", units_required=False).solve("pushed")
        x, d, D = moved["x"][:, -1], moved["d"][:, -1], np.linalg.norm(moved["d_ref"][-1])
        middle = (d[1:] + d[:-1]) / (2 * D)
        work = force * (middle * np.diff(x, axis=0)).sum()
        energy = moved["kinetic_energy"] + moved["strain_energy"]
        missing.append(abs(energy[-1] - energy[0] - work) / abs(work))
    assert missing[-1] < 1e-9  # exactly what the midpoint rule gives


def test_modes_under_a_follower_load_are_refused(pushes):
    table = cosserat.case("elastica").problem.model_dump() | {"kind": "pushed statics", "forces": []}
    table["pushes"] = [{"force": 1e-6}]
    with pytest.raises(InputError, match="a load has no potential"):
        PushedStatics.read(table, "pushed", units_required=False).modes(1)


@njit(cache=True)
def counter(q, after, data, history, strains, task, gradient, band, skew, terms):
    """No force; counts accepted states."""
    if task == COMMIT:
        history[0] += 1
    else:
        terms[0] = 0.0
    return 0.0


class Counter(Load):
    """Remembers how many states were accepted."""

    @classmethod
    def potential(cls, loads, body):
        return Potential(counter, np.zeros(1, [("none", "f8")]), ("counter",), -1, history=np.zeros(1))


class CountedMotion(RodMotion):
    kind: str = "counted motion"
    counters: tuple[Counter, ...] = ()


def test_internal_variables_of_a_load_are_kept_between_parts_of_a_run(monkeypatch):
    monkeypatch.setitem(LOADS, "counters", Counter)
    table = cosserat.case("vibration_consistent").problem.model_dump() | {"kind": "counted motion"}
    table |= {"duration": 0.01, "every": 0.005, "integrator": {"step": 5e-4}, "counters": [{}]}
    problem = CountedMotion.read(table, "counted", units_required=False)
    run = CheckpointedRun.of(problem, "counted")
    part, state, stopped = run.part(0, problem.begin())
    assert stopped is None
    again = state_of(part, run.system)
    assert state.history[-1] == 1 + 20  # the start and every step
    for one, other in zip(state.history, again.history, strict=True):
        np.testing.assert_array_equal(one, other)


# ---------------------------------------------------------------- a constraint: a vertex that is led along a circle


class Led:
    """Both numbers of a position on a circle through its reference place."""

    def __init__(self, index, radius, angle):
        self.index, self.radius, self.angle = index, radius, angle
        self.time_function, self.rotation = None, 0.0

    def place(self, fraction):
        a = fraction * self.angle
        c, s, w = np.cos(a), np.sin(a), self.angle
        return (
            self.radius * np.array([c - 1, s]),
            self.radius * w * np.array([-s, c]),
            -self.radius * w**2 * np.array([c, s]),
        )


class Circle(Constraint):
    """The vertex is led along a circle about a centre to its left."""

    radius: float
    angle: float

    @property
    def fixes(self):
        return ("x3", "x2")

    def part(self, rod, geometry):
        return Led(rod.dof(self.at, "x3", geometry.arc_length), self.radius, self.angle)


class LedStatics(RodStatics):
    kind: str = "led statics"
    circles: tuple[Circle, ...] = ()


def test_a_constraint_moves_a_vertex_and_a_hinged_rod_follows_it_rigidly(monkeypatch):
    monkeypatch.setitem(CONSTRAINTS, "circles", Circle)
    base = cosserat.case("elastica").problem
    table = base.model_dump() | {
        "kind": "led statics",
        "forces": [],
        "supports": [{"at": "first", "fixed": ["x3", "x2"]}],
        "circles": [{"at": "last", "radius": base.rod.length, "angle": 0.9}],
    }
    solution = LedStatics.read(table, "led", units_required=False).solve("led")
    assert solution["x"][-1] == pytest.approx(base.rod.length * np.array([np.cos(0.9), np.sin(0.9)]))
    assert np.abs(solution["energy_parts"]).max() < 1e-12 * base.rod.young * base.rod.area


# ---------------------------------------------------------------- a kind


class Fall(Problem):
    """A mass falls for a while: its kinetic energy at two times."""

    kind: str = "fall"
    mass: float
    speed: float

    def solve(self, name, run=ALONE):
        times = np.array([0.0, 1.0])
        energy = self.mass * (self.speed + 9.81 * times) ** 2 / 2
        return Solution(
            {"time": (("time",), times), "kinetic_energy": (("time",), energy)}, {"steps": 1}
        )

    @classmethod
    def summary(cls, statistics, sizes):
        return f"{statistics['steps']} step"


def test_a_kind_is_one_class_and_one_entry(monkeypatch, tmp_path):
    monkeypatch.setitem(KINDS, "fall", Kind("test_toys:Fall"))
    kinds.cache_clear()
    try:
        file = tmp_path / "my.toml"
        file.write_text('[stone]\nkind = "fall"\nmass = 2.0\nspeed = 1.0\n', encoding="utf-8")
        data = cosserat.run(cosserat.case("stone", file))
        assert data.kinetic_energy.to_numpy() == pytest.approx([1.0, 10.81**2])
        cosserat.save(data, tmp_path / "stone.nc")
        assert cosserat.load(tmp_path / "stone.nc").identical(data)
    finally:
        kinds.cache_clear()


def test_toys_are_parameters_like_any_other():
    assert all(issubclass(toy, Parameters) for toy in (Push, Circle, Fall))
