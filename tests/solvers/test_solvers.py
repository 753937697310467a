"""The solvers do not depend on rods: one degree of freedom, points in space and sliders have their closed forms.

A rod in space is in test_solvers_in_space.py.
"""

from dataclasses import replace

import numpy as np
import pytest
from bodies import (
    PointSpace,
    body,
    circulating,
    dead,
    differenced,
    hessian,
    patched,
    sliders,
    springs,
    wells,
)
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from cosserat.errors import InputError
from cosserat.solvers import continuation, equilibrium, runge_kutta, tangent
from cosserat.solvers.banded import to_dense
from cosserat.solvers.continuation import ArcLengthSettings, trace_path
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.incremental import solve_full_load, unloaded
from cosserat.solvers.integrate import (
    IntegratorSettings,
    State,
    highest_frequency,
    integrate,
    kinetic_energy,
)
from cosserat.solvers.modes import first_elastic_frequency, modes
from cosserat.solvers.potential import Potential

LIMIT = 2 / (3 * np.sqrt(3))
"""The load at which x^3 - x turns back, at x = -1 / sqrt(3)."""
METHODS = ("implicit", "rk4", "rk45")


def solver_of(system, **settings):
    return EquilibriumSolver(system, NewtonSettings(**settings), "the body")


def followed(system, *, first, longest, until=1.0):
    """The points of a path from the unloaded body on."""
    solver = solver_of(system)
    arc = ArcLengthSettings(first=first, longest=longest, count=1000, until=until, limit=9.0, branches=0)
    return list(trace_path(solver, unloaded(solver), arc))


def moved(system, state, duration, method, step, tolerance=1e-10):
    settings = IntegratorSettings(method=method, step=step, tolerance=tolerance)
    return integrate(system, state, duration, settings, "the body")


def energy_of(system, state):
    """Of motion, of the body and of its loads."""
    held = sum(p.energy(state.q, h) for p, h in zip(system.potentials, state.history, strict=True))
    return held + kinetic_energy(system, state)


# One number: the energy x^4 / 4 - x^2 / 2 about x = -1, which is its minimum, and a dead load.


def snapping(load, **more):
    return body(wells((1.0, -1.0, 1.0)), dead([load]), **more)


@pytest.mark.parametrize("load", [-0.7, 0.3, 1.0])
def test_one_degree_of_freedom_has_its_equilibrium_at_the_root_of_its_cubic(load):
    """The last load is beyond the limit point: the body comes to rest on the other side."""
    solver = solver_of(snapping(load))
    point = solve_full_load(solver)
    roots = np.roots([1.0, 0.0, -1.0, -load])
    real = roots[np.abs(roots.imag) < 1e-12].real
    right = real.max() if load > LIMIT else real.min()
    assert point.q[0] - 1 == pytest.approx(right, abs=1e-12)
    assert point.stable
    assert solver.passed_limit_load == (load > LIMIT)


def test_a_path_passes_the_limit_point_of_one_degree_of_freedom():
    path = followed(snapping(1.0), first=0.02, longest=0.02)
    x, factor = np.array([p.q[0] - 1 for p in path]), np.array([p.factor for p in path])
    np.testing.assert_allclose(factor, x**3 - x, atol=1e-10)
    assert [p.negative for p in path] == list((3 * x**2 < 1).astype(int))
    top = factor[: np.argmax(x > 0)].argmax()
    near = slice(top - 1, top + 2)
    a, b, c = np.polyfit(x[near], factor[near], 2)
    assert c - b**2 / (4 * a) == pytest.approx(LIMIT, rel=1e-4)
    assert factor.min() == pytest.approx(-LIMIT, rel=1e-3)
    assert factor[-1] == 1.0


def test_the_frequency_of_one_degree_of_freedom_follows_from_its_second_derivative():
    system = snapping(0.3, mass=2.0)
    point = solve_full_load(solver_of(system))
    right = np.sqrt((3 * (point.q[0] - 1) ** 2 - 1) / 2)
    found = modes(system, point.q, 1, "the body", supported=True)
    np.testing.assert_allclose(found.angular_frequency, right, rtol=1e-12)
    np.testing.assert_allclose(found.shape, 1 / np.sqrt(2), rtol=1e-12)
    assert highest_frequency(system, point.q) == pytest.approx(right)


def test_one_degree_of_freedom_moves_as_an_independent_integrator_finds():
    """From where it swings over the hill.  Energy is kept to rounding, and the implicit answer is of second order."""
    system = snapping(0.2, mass=2.0)
    start = State(np.array([-0.6]), np.array([0.5]), system.history)
    right = solve_ivp(
        lambda t, y: [y[1], -((y[0] - 1) ** 3 - (y[0] - 1) - 0.2) / 2],
        (0, 8.0),
        [-0.6, 0.5],
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
    ).y[:, -1]
    errors = []
    for step in (0.02, 0.01, 0.005):
        end, count = moved(system, start, 8.0, "implicit", step)
        errors.append(np.abs([end.q[0] - right[0], end.v[0] - right[1]]).max())
        assert count == round(8.0 / step)
        assert energy_of(system, end) == pytest.approx(energy_of(system, start), rel=1e-11)
    np.testing.assert_allclose(np.diff(np.log2(errors)), -2, atol=0.1)
    for method, tolerance in (("rk4", 1e-8), ("rk45", 1e-7)):
        end, _ = moved(system, start, 8.0, method, 0.01)
        np.testing.assert_allclose([end.q[0], end.v[0]], right, atol=tolerance)
        assert energy_of(system, end) == pytest.approx(energy_of(system, start), rel=1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_masses_coupled_by_inertia_alone_move_by_the_matrix_exponential(method):
    """The mass reaches farther than the energy, whose Hessian is diagonal."""
    n, rng = 12, np.random.default_rng(0)
    band = np.tile([2.0, 0.5, 0.0, 0.3], (n, 1))
    system = replace(body(wells(*[(0.0, 2.0, 0.0)] * n)), mass=lambda: band)
    start = State(rng.normal(size=n), np.zeros(n), system.history)
    squared, shapes = eigh(2 * np.eye(n), to_dense(band))
    right = shapes @ (np.cos(3 * np.sqrt(squared)) * (shapes.T @ to_dense(band) @ start.q))
    end, _ = moved(system, start, 3.0, method, 1e-3)
    np.testing.assert_allclose(end.q, right, atol=1e-5 if method == "implicit" else 1e-9)
    found = modes(system, np.zeros(n), n, "the body", supported=True).angular_frequency
    np.testing.assert_allclose(found, np.sqrt(squared), rtol=1e-12)


def test_displacements_are_refused_as_positions():
    """Potentials in Python add an origin; compiled steps do not and raise an error."""
    well = replace(wells((1.0, -1.0, 0.0)), origin=np.array([-1.0]))
    system, same = body(well, mass=2.0), body(wells((1.0, -1.0, 1.0)), mass=2.0)
    start = State(np.array([0.4]), np.zeros(1), system.history)
    np.testing.assert_allclose(
        moved(system, start, 2.0, "rk4", 0.01)[0].q, moved(same, start, 2.0, "rk4", 0.01)[0].q
    )
    with pytest.raises(InputError, match="positions"):
        moved(system, start, 2.0, "implicit", 0.01)

    class Displaced(PointSpace):
        def rigid_motions(self, q):
            return super().rigid_motions(q + TETRAHEDRON.ravel())

    with pytest.raises(InputError, match="positions"):
        flown(tetrahedron(Displaced(np.ones(12))))


# Points in space with springs between them.


def test_two_hanging_links_are_in_equilibrium_along_their_tensions():
    """Each link lies along what hangs on it, and is longer by that over its stiffness."""
    force = np.array([[0.0, 0, 0], [0.0, 0.3, -2.0], [0.7, 0.2, -1.0]])
    k, own = np.array([50.0, 20.0]), np.array([1.0, 0.8])
    system = body(
        springs([(0, 1, k[0], own[0]), (1, 2, k[1], own[1])]),
        dead(force.ravel()),
        held=range(3),
        n=9,
        space=PointSpace(np.ones(9)),
    )
    pull = np.array([force[1] + force[2], force[2]])
    size = np.linalg.norm(pull, axis=1)
    right = np.cumsum((own * (1 + size / (k * own)) / size)[:, None] * pull, axis=0)
    guess = np.array([0.0, 0, 0, 0.1, 0.1, -1.0, 0.2, 0.1, -1.8])
    point = solver_of(system).correct(guess, 1.0, system.history)
    np.testing.assert_allclose(point.q[3:].reshape(2, 3), right, atol=1e-12)
    np.testing.assert_allclose(point.reaction[:3], -force.sum(axis=0), atol=1e-9)
    assert point.stable


TETRAHEDRON = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])


def tetrahedron(space=None):
    """Four masses of 0.7 and springs of 3 between all of them: a body that has six rigid motions."""
    rows = [(a, b, 3.0, np.sqrt(8)) for a in range(4) for b in range(a + 1, 4)]
    space = PointSpace(np.ones(12)) if space is None else space
    return body(springs(rows), mass=0.7, space=space, n=12)


def test_the_hessian_of_points_is_the_derivative_of_their_gradient():
    q = TETRAHEDRON.ravel() + 0.3 * np.random.default_rng(3).normal(size=12)
    np.testing.assert_allclose(hessian(tetrahedron(), q)[1], differenced(tetrahedron(), q), atol=1e-8)


def test_a_tetrahedron_has_six_zero_modes_and_the_frequencies_of_a_molecule():
    """Of four equal masses with central forces: omega^2 m / k = 1, 1, 2, 2, 2, 4 (Herzberg 1945, P4)."""
    system, q = tetrahedron(), TETRAHEDRON.ravel()
    found = modes(system, q, 12, "the body", supported=False).angular_frequency
    np.testing.assert_array_equal(found[:6], 0.0)
    np.testing.assert_allclose(found[6:] ** 2 * 0.7 / 3, [1, 1, 2, 2, 2, 4], rtol=1e-12)
    assert first_elastic_frequency(system, q, supported=False) == pytest.approx(found[6])
    for motion in system.space.rigid_motions(q):
        np.testing.assert_allclose(hessian(system, q)[1] @ motion, 0.0, atol=1e-12)


def flown(system):
    """Largest drifts of energy, momentum and angular momentum in a tumbling flight, by their sizes."""
    rng = np.random.default_rng(4)
    q, v = TETRAHEDRON.ravel() + 0.2 * rng.normal(size=12), rng.normal(size=12)
    state = State(q, v, system.history)

    def kept(state):
        x, u = state.q.reshape(-1, 3), 0.7 * state.v.reshape(-1, 3)
        return energy_of(system, state), u.sum(axis=0), np.cross(x, u).sum(axis=0)

    first, drifts = kept(state), np.zeros(3)
    for _ in range(20):
        state, _ = moved(system, state, 2.0, "implicit", 0.05)
        now = kept(state)
        off = [np.abs(b - a).max() / np.abs(a).max() for a, b in zip(first, now, strict=True)]
        drifts = np.maximum(drifts, off)
    return drifts


def test_free_points_keep_energy_and_both_momenta():
    energy, momentum, angular_momentum = flown(tetrahedron())
    assert energy < 1e-10
    assert momentum < 1e-12
    assert angular_momentum < 1e-12


def test_without_rigid_motions_the_momenta_are_not_conserved():
    """So the test above checks their use: the force that conserves the energy then has a resultant."""

    class Mute(PointSpace):
        def rigid_motions(self, q):
            return np.empty((0, q.size))

    energy, momentum, angular_momentum = flown(tetrahedron(Mute(np.ones(12))))
    assert energy < 1e-10
    assert max(momentum, angular_momentum) > 1e-6


# A force without a potential: z = x + i y, m z'' + k z = i p z + F.

CIRCULATING = {"k": 2.0, "p": 0.6, "m": 1.5}


def circulated(force=(0.0, 0.0)):
    k, p, m = CIRCULATING.values()
    return body(wells((0.0, k, 0.0), (0.0, k, 0.0)), circulating(p), dead(force), mass=m)


def test_a_force_without_a_potential_has_a_skew_tangent_and_the_equilibrium_of_both():
    k, p, _ = CIRCULATING.values()
    system = circulated((1.0, 0.5))
    right = np.array([[k, p], [-p, k]])
    np.testing.assert_allclose(hessian(system, np.ones(2))[1], right)
    np.testing.assert_allclose(differenced(system, np.ones(2)), right, rtol=1e-8)
    solver = solver_of(system)
    point = solver.correct(np.zeros(2), 1.0, system.history)
    np.testing.assert_allclose(point.q, np.linalg.solve(right, [1.0, 0.5]), rtol=1e-12)
    assert solver.iterations == 1


@pytest.mark.parametrize("method", METHODS)
def test_a_force_without_a_potential_does_work_on_a_motion(method):
    """The integrator does not correct the work of this force as an error of the energy."""
    k, p, m = CIRCULATING.values()
    s = np.emath.sqrt((-k + 1j * p) / m)
    right = np.cosh(s * 6.0) * (1 + 0.3j)
    system, errors = circulated(), []
    start = State(np.array([1.0, 0.3]), np.zeros(2), system.history)
    for step in (0.02, 0.01):
        end, _ = moved(system, start, 6.0, method, step)
        errors.append(abs(complex(*end.q) - right))
    assert errors[1] < {"implicit": 1e-3, "rk4": 1e-7, "rk45": 1e-8}[method]
    if method == "implicit":
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.05)
    assert energy_of(system, end) > 2 * energy_of(system, start)


# Sliders: what they have seen changes only where a state is accepted.

STIFF, CAP, BESIDE = 4.0, 0.5, 1.0
YIELD = CAP * (STIFF + BESIDE) / STIFF
"""The load at which a slider with a spring beside it begins to slide."""


def loaded_and_unloaded(solver_class=EquilibriumSolver, load=1.0):
    """The states of two numbers, of which only the first slides, as the load comes and goes."""
    rows = (STIFF, CAP, 0.0, BESIDE, 0.0), (STIFF, 9.0, 0.0, BESIDE, 0.0)
    system = body(sliders(*rows), dead([load, load]))
    solver = solver_class(system, NewtonSettings(), "the body")
    point = solver.correct(np.zeros(2), 0.0, system.history)
    points = [point]
    up = np.linspace(0, 1, 9)
    for factor in [*up[1:], *up[-2::-1]]:
        point = solver.correct(point.q, factor, point.history)
        points.append(point)
    return points


def judge_history(points):
    """The set left after the load is gone, the anchor, how often a state was accepted, and the work."""
    load = 1.0
    x, anchor = (load - CAP) / BESIDE, (load - CAP) / BESIDE - CAP / STIFF
    left = x - load / (STIFF + BESIDE)
    assert points[-1].q[0] == pytest.approx(left, abs=1e-12)
    assert points[-1].q[1] == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(points[-1].history[0][:2], [anchor, 0.0], atol=1e-12)
    assert [p.history[0][2] for p in points] == list(range(1, len(points) + 1))
    factor, q = np.array([p.factor for p in points]), np.array([p.q[0] for p in points])
    work = float(((factor[1:] + factor[:-1]) / 2 * np.diff(q)).sum()) * load
    stored = BESIDE * left**2 / 2 + STIFF * (left - anchor) ** 2 / 2
    assert work - stored == pytest.approx(CAP * anchor, abs=1e-12)


def test_a_slider_keeps_its_permanent_set_and_dissipates_energy():
    """The load steps by an eighth, and it begins to slide at five of them."""
    assert YIELD == 5 / 8
    points = loaded_and_unloaded()
    judge_history(points)


@pytest.fixture
def commits(monkeypatch):
    """How often a potential was asked for the internal variables of an accepted state."""
    asked, original = [], Potential.committed

    def counting(self, q, history):
        asked.append(q.copy())
        return original(self, q, history)

    monkeypatch.setattr(Potential, "committed", counting)
    return asked


SNAPPING = 2.0, 0.1
"""Stiffness and cap of its slider: a path is followed round the corner where it begins to slide."""


def snapping_slider(load):
    """The snapping number with a slider, which slides all the way to the limit point and beyond."""
    return body(sliders((*SNAPPING, 1.0, -1.0, 1.0)), dead([load]))


def test_refused_increments_leave_no_trace(commits):
    """Increments are cut back short of the limit point; the rest of the way is a path."""
    solver = solver_of(snapping_slider(0.6))
    point = solve_full_load(solver)
    (x,) = np.real([r for r in np.roots([1.0, 0, -1, 0.1 - 0.6]) if abs(r.imag) < 1e-12])
    assert solver.passed_limit_load
    assert solver.cutbacks > 0
    assert point.q[0] - 1 == pytest.approx(x, abs=1e-12)
    anchor, count = point.history[0]
    assert anchor == pytest.approx(x + 1 - SNAPPING[1] / SNAPPING[0], abs=1e-12)
    assert count < len(commits) / 2  # of the sliders alone, not of the dead load
    assert count < solver.iterations


def test_refused_arcs_leave_no_trace(monkeypatch):
    """Arcs begin so long that the path turns too sharply within them."""
    found, original = [], continuation.corrected

    def noted(*given):
        point = original(*given)
        found.append(point)
        return point

    monkeypatch.setattr(continuation, "corrected", noted)
    path = followed(snapping_slider(1.0), first=0.6, longest=0.6)
    assert len(found) > len(path)
    assert [p.history[0][1] for p in path] == list(range(1, len(path) + 1))
    sliding = path[2:]
    x = np.array([p.q[0] - 1 for p in sliding])
    np.testing.assert_allclose([p.factor for p in sliding], x**3 - x + 0.1, atol=1e-10)
    np.testing.assert_allclose(
        [p.history[0][0] for p in sliding], x + 1 - SNAPPING[1] / SNAPPING[0], atol=1e-12
    )


SLIDING = {"mass": 2.0, "speed": 1.5, "stiff": 40.0, "cap": 0.5}


def slid(method, step, duration=4.0, parts=1):
    """A mass on a slider: the friction is an external load, and there is no elastic body."""
    given = SLIDING
    friction = sliders((given["stiff"], given["cap"], 0.0, 0.0, 0.0))
    system = body(wells((0.0, 0.0, 0.0)), friction, mass=given["mass"])
    state, count = State(np.zeros(1), np.array([given["speed"]]), system.history), 0
    for _ in range(parts):
        state, more = moved(system, state, duration / parts, method, step)
        count += more
    return system, state, count


def exact_slide(duration):
    """Place and speed: a spring up to the cap, a constant force to rest, then a spring for ever; the anchor."""
    m, v, k, cap = SLIDING.values()
    omega = np.sqrt(k / m)
    first = np.arcsin(cap / (k * v / omega)) / omega
    speed = v * np.cos(omega * first)
    rest = first + speed * m / cap
    farthest = cap / k + m * speed**2 / (2 * cap)
    assert duration > rest + np.pi / omega  # it has swung back, so that the anchor matters
    phase, anchor = omega * (duration - rest), farthest - cap / k
    return anchor + cap / k * np.cos(phase), -cap / k * omega * np.sin(phase), anchor


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("parts", [1, 3])
def test_a_sliding_mass_comes_to_rest_at_its_anchor(method, parts):
    duration = 7.0
    x, v, anchor = exact_slide(duration)
    system, state, count = slid(method, 2e-3, duration, parts)
    assert state.history[1][0] == pytest.approx(anchor, rel=2e-4)
    np.testing.assert_allclose([state.q[0], state.v[0]], [x, v], atol=2e-3 * abs(v) + 1e-3)
    accepted = state.history[1][1]
    assert accepted == count if method != "rk45" else duration / 2e-3 <= accepted < count / 6
    left = SLIDING["stiff"] * (state.q[0] - state.history[1][0]) ** 2 / 2 + kinetic_energy(system, state)
    taken = SLIDING["mass"] * SLIDING["speed"] ** 2 / 2 - left
    assert taken == pytest.approx(SLIDING["cap"] * anchor, rel=2e-4)


# Faults planted in solvers, which the tests above notice.

ASSEMBLED = """\
            if not system.assemble(q, history, factor, tangent):
                return None
            unbalanced, residual, reaction = self.unbalanced()
            largest"""


def test_a_solver_that_reads_a_director_fails_where_there_is_none():
    faulty = patched(equilibrium, ASSEMBLED, f"            turn = q[3], q[2]\n{ASSEMBLED}")
    with pytest.raises(IndexError):
        faulty.EquilibriumSolver(snapping(0.3), NewtonSettings(), "x").correct(np.zeros(1), 0.0, ())


def test_a_solver_that_commits_trial_states_is_noticed():
    commit = f"            history = system.committed(q, history)\n{ASSEMBLED}"
    faulty = patched(equilibrium, ASSEMBLED, commit)
    with pytest.raises(AssertionError):
        judge_history(loaded_and_unloaded(faulty.EquilibriumSolver))


def test_an_integrator_that_commits_trial_states_is_noticed(monkeypatch):
    asked = "        system.add_gradient(q, self.history, gradient)\n"
    at_once = f"        self.history[1][:] = system.committed(q, self.history)[1]\n{asked}"
    monkeypatch.setattr(runge_kutta, "_Rates", patched(runge_kutta, asked, at_once)._Rates)
    with pytest.raises(AssertionError):
        test_a_sliding_mass_comes_to_rest_at_its_anchor("rk4", 1)


def test_a_solver_that_forgets_the_skew_part_is_noticed(monkeypatch):
    right = "factors = Factors(self.band, self.skew)\n        return None"
    faulty = patched(tangent, right, "factors = Factors(self.band)\n        return None")
    monkeypatch.setattr(equilibrium, "Tangent", faulty.Tangent)
    with pytest.raises(AssertionError):
        test_a_force_without_a_potential_has_a_skew_tangent_and_the_equilibrium_of_both()
