"""The solvers on a rod in space, nine numbers a vertex, whose energy is of the tests alone: `spatial_rod`."""

from dataclasses import replace

import numpy as np
import pytest
from bodies import differenced, hessian, patched
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar
from scipy.spatial.transform import Rotation
from spatial_rod import arch, follower, straight
from test_solvers import energy_of, followed, moved, solver_of

from cosserat.solvers import equilibrium, tangent
from cosserat.solvers.equilibrium import EquilibriumSolver
from cosserat.solvers.incremental import solve_full_load
from cosserat.solvers.integrate import State
from cosserat.solvers.modes import modes

TURNED = Rotation.from_rotvec([0.4, -0.7, 1.1]).as_matrix()


def strains(rod, q):
    """The strains of `spatial_rod` at q (..., n), written again with vectors: by name, (..., edges or vertices)."""
    x, d1, d2 = np.moveaxis(q.reshape(*q.shape[:-1], -1, 3, 3), -2, 0)
    e, h = np.diff(x, axis=-2), rod.edges

    def dot(a, b):
        return (a * b).sum(axis=-1)

    def ends(d):
        return d[..., :-1, :], d[..., 1:, :]

    (a1, b1), (a2, b2) = ends(d1), ends(d2)
    return {
        "axial": dot(e, e) / h**2 / 2,
        "shear_1": dot(e, a1 + b1) / (2 * h),
        "shear_2": dot(e, a2 + b2) / (2 * h),
        "bending_1": dot(e, b1 - a1) / h**2,
        "bending_2": dot(e, b2 - a2) / h**2,
        "torsion": (dot(a2, b1) - dot(a1, b2)) / (2 * h),
        "section_1": dot(d1, d1) / 2,
        "section_2": dot(d2, d2) / 2,
        "section_12": dot(d1, d2),
    }


def energy(rod, q):
    """The energy at q (..., n)."""
    rest, total = strains(rod, rod.at_rest.ravel()), 0.0
    for name, strain in strains(rod, q).items():
        size = rod.parts if name.startswith("section") else rod.edges
        total = total + (rod.stiffness[name] * size / 2 * (strain - rest[name]) ** 2).sum(axis=-1)
    return total


def slope(rod, q):
    """The gradient at q (..., n) by complex steps, which round nothing off."""
    return energy(rod, q[..., None, :] + 1e-30j * np.eye(q.shape[-1])).imag / 1e-30


def shaken(rod, size=0.1):
    return rod.at_rest.ravel() + size * np.random.default_rng(1).normal(size=rod.at_rest.size)


# The energy itself.


@pytest.mark.parametrize("rod", [straight(5), arch(5, 0.2, TURNED)])
def test_energy_gradient_and_hessian_are_those_of_the_strains_written_again(rod):
    system, q = rod.system(), shaken(rod)
    gradient, dense = hessian(system, q)
    assert system.internal.energy(q) == pytest.approx(energy(rod, q), rel=1e-13)
    np.testing.assert_allclose(gradient, slope(rod, q), atol=1e-13 * np.abs(gradient).max())
    np.testing.assert_allclose(dense, differenced(system, q), atol=1e-8 * np.abs(dense).max())
    np.testing.assert_allclose(dense, dense.T)


def test_the_reference_has_no_energy_and_six_rigid_motions():
    rod = arch(7, 0.2, TURNED)
    system, q = rod.system(), rod.at_rest.ravel()
    gradient, dense = hessian(system, q)
    assert system.internal.energy(q) < 1e-30
    assert np.abs(gradient).max() < 1e-14 * np.abs(dense).max()
    motions = system.space.rigid_motions(q)
    assert np.linalg.matrix_rank(motions) == 6
    np.testing.assert_allclose(dense @ motions.T, 0.0, atol=1e-13 * np.abs(dense).max())
    values = np.linalg.eigvalsh(dense)
    assert (values[:6] < 1e-12 * values[-1]).all()
    assert values[6] > 1e-9 * values[-1]


def test_the_energy_does_not_depend_on_the_orientation_of_the_rod():
    rod = straight(6)
    system, q = rod.system(), shaken(rod)
    turned = q.reshape(-1, 3, 3) @ TURNED.T
    turned[:, 0] += [3.0, -1.0, 2.0]
    assert system.internal.energy(turned.ravel()) == pytest.approx(system.internal.energy(q), rel=1e-12)
    gradient, _ = hessian(system, q)
    again, _ = hessian(system, turned.ravel())
    np.testing.assert_allclose(
        again.reshape(-1, 3, 3), gradient.reshape(-1, 3, 3) @ TURNED.T, atol=1e-12
    )


# At rest.


def test_a_cantilever_bends_in_both_directions_as_timoshenko_says():
    """Second order in the mesh, down to the finest one."""
    force, errors = 1e-8 * np.array([1.0, 2.0, 0.0]), []
    for edges in (8, 16, 32, 256):
        rod = straight(edges + 1, clamped=True)
        point = solve_full_load(solver_of(rod.system(rod.pulled(-1, force))))
        tip = point.q.reshape(-1, 3, 3)[-1, 0] - [0, 0, 1]
        errors.append(tip[:2] / (force[:2] * (1 / (3 * np.square(rod.radii)) + 1 / rod.shear)) - 1)
    np.testing.assert_allclose(
        np.diff(np.log2(np.abs(errors)), axis=0), [[-2] * 2] * 2 + [[-6] * 2], atol=0.02
    )
    assert np.abs(errors[-1]).max() < 5e-6


def limit_of(rod, middle):
    """The largest force that the middle bears as it is pushed down, with no solver of the package."""
    rest = rod.at_rest.ravel()
    driven = 9 * middle
    free = np.setdiff1d(np.arange(rest.size), [*rod.held, driven])
    known = {0.0: rest}

    def pushed(down):
        """Minus the force at a displacement, by Newton's method from the nearest state that is known."""
        q = known[min(known, key=lambda other: abs(other - down))].copy()
        q[driven] = rest[driven] - down
        for _ in range(30):
            shifts = 1e-6 * np.eye(rest.size)[free]
            up, low = slope(rod, q + shifts)[:, free], slope(rod, q - shifts)[:, free]
            step = np.linalg.solve((up - low) / 2e-6, -slope(rod, q)[free])
            q[free] += step
            if np.abs(step).max() < 1e-7:
                known[down] = q
                return slope(rod, q)[driven]
        raise AssertionError("the oracle found no equilibrium")

    for down in (0.007, 0.014, 0.021, 0.028):
        pushed(down)
    least = minimize_scalar(pushed, bounds=(0.02, 0.04), method="bounded", options={"xatol": 1e-5})
    assert 0.021 < least.x < 0.039
    return -least.fun


def test_a_path_passes_the_limit_point_of_an_arch_in_space():
    """The arch is rotated in space; the arch of the reference values is not."""
    shape, radii = (7, 0.05), (0.008, 0.02)
    right = limit_of(arch(*shape, np.eye(3), radii=radii), 3)
    rod = arch(*shape, TURNED, radii=radii)
    path = followed(rod.system(rod.pulled(3, -1e-3 * TURNED[:, 0])), first=0.005, longest=0.005)
    factor, unstable = np.array([p.factor for p in path]), np.array([p.negative for p in path])
    turns = np.flatnonzero(np.diff(unstable))
    assert unstable.max() == 1
    assert len(turns) == 2  # it loses its stability at the limit point and comes back at the other one
    near = path[turns[0] - 2 : turns[0] + 4]
    down = np.array([-(p.q - path[0].q).reshape(-1, 3, 3)[3, 0] @ TURNED[:, 0] for p in near])
    place = np.linspace(down[1], down[-2], 10_001)
    found = np.polyval(np.polyfit(down, [p.factor for p in near], 4), place).max()
    assert 1e-3 * found == pytest.approx(right, rel=1e-7)
    assert factor[-1] == 1.0
    x = path[-1].q.reshape(-1, 3, 3) @ TURNED
    np.testing.assert_allclose(x[:, 0, 1], 0.0, atol=1e-10)  # it stays in its plane


# In motion.


def free_beam(number):
    """The root of cosh cos = 1 of a beam with free ends."""
    guess = (number + 0.5) * np.pi
    return brentq(lambda z: np.cosh(z) * np.cos(z) - 1, guess - 0.1, guess + 0.1, xtol=1e-14)


def test_a_free_rod_has_six_zero_frequencies_and_those_of_a_beam_in_both_planes():
    radii, found = (0.002, 0.0015), []
    for edges in (10, 20):
        rod = straight(edges + 1, radii=radii)
        system = rod.system()
        found.append(modes(system, system.space.reference, 8, "rod", supported=False).angular_frequency)
    np.testing.assert_array_equal(np.array(found)[:, :6], 0.0)
    right = free_beam(1) ** 2 * np.sort(radii)
    errors = np.array(found)[:, 6:] / right - 1
    np.testing.assert_allclose(errors[0] / errors[1], 4, rtol=0.1)
    np.testing.assert_allclose((4 * errors[1] - errors[0]) / 3, 0.0, atol=1e-3)


def test_a_thin_rod_that_spins_about_a_skew_axis_keeps_energy_and_angular_momentum():
    """20 turns of 50 steps each, checked every seven steps; r / L = 0.005."""
    rod, rate = straight(12, radii=(0.005, 0.003)), 0.1
    axis = rate * np.array([1.0, 0.3, 1.0]) / np.sqrt(2.09)
    q = rod.at_rest - [[0, 0, 0.5], [0, 0, 0], [0, 0, 0]]
    system, step = rod.system(), 2 * np.pi / rate / 50
    state = State(q.ravel(), np.cross(axis, q).ravel(), system.history)
    first, spin, strained = energy_of(system, state), rod.angular_momentum(state.q, state.v), 0.0
    assert abs(spin @ axis) < 0.9 * np.linalg.norm(spin) * rate
    for _ in range(143):
        state, _ = moved(system, state, 7 * step, "implicit", step)
        strained = max(strained, system.internal.energy(state.q) / first)
        assert energy_of(system, state) == pytest.approx(first, rel=1e-9)
        np.testing.assert_allclose(
            rod.angular_momentum(state.q, state.v), spin, atol=1e-10 * np.linalg.norm(spin)
        )
    assert strained > 1e-4
    np.testing.assert_allclose(state.q.reshape(-1, 3, 3)[:, 0].T @ rod.parts, 0.0, atol=1e-10)


# A force that follows the tip, along its first director.


def elastica(load):
    """Tip and its angle of an inextensible cantilever of unit length and stiffness, from the tip backwards.

    There the moment is zero and the force is across: psi'' = -load cos psi, psi the angle from the tip's.
    """

    def rates(s, y):
        return [y[1], -load * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])]

    psi, _, a, b = solve_ivp(rates, (0, -1), np.zeros(4), method="DOP853", rtol=1e-12, atol=1e-13).y[
        :, -1
    ]
    c, s = np.cos(psi), np.sin(psi)
    return np.array([s * a - c * b, -c * a - s * b]), -psi


@pytest.mark.parametrize("load", [2.0, 6.0, 20.0])
def test_a_cantilever_under_a_follower_force_is_the_elastica(load):
    """At the last two loads the symmetric part of the Hessian is not positive, but nothing else is near."""
    radius, tips = 3e-4, []
    for edges in (32, 64):
        rod = straight(edges + 1, clamped=True, radii=(radius, radius))
        system = rod.system(follower(load * radius**2))
        point = solve_full_load(solver_of(system))
        assert point.stable
        x, d, _ = point.q.reshape(-1, 3, 3)[-1]
        tips.append([x[0], x[2], np.arctan2(-d[2], d[0])])
    right, angle = elastica(load)
    errors = np.array(tips) - [*right, angle]
    assert np.divide(*np.linalg.norm(errors, axis=1)) == pytest.approx(4, rel=0.05)
    np.testing.assert_allclose((4 * errors[1] - errors[0]) / 3, 0.0, atol=3e-5)
    dense = hessian(system, point.q)[1][9:, 9:]
    assert (np.linalg.eigvalsh(dense + dense.T)[0] > 0) == (load < 3)


def bent(monkeypatch, system_class=None):
    """The residuals of Newton's method from four fifths of a following force to all of it."""
    rod = straight(9, clamped=True)
    system = rod.system(follower(2 * rod.radii[0] ** 2))
    solver = solver_of(system)
    start = solver.correct(system.space.reference, 0.8, system.history)
    residuals, original = [], EquilibriumSolver.unbalanced

    def noted(self):
        forces, residual, reaction = original(self)
        residuals.append(residual)
        return forces, residual, reaction

    with monkeypatch.context() as patch:
        patch.setattr(EquilibriumSolver, "unbalanced", noted)
        if system_class is not None:
            patch.setattr(equilibrium, "Tangent", system_class)
        point = solver_of(system).correct(start.q, 1.0, start.history)
    assert point is not None
    return np.array(residuals)


def test_the_tangent_of_a_follower_force_has_a_skew_part():
    rod = straight(4, clamped=True)
    system = rod.system(follower(0.3))
    q = shaken(rod)
    dense = hessian(system, q)[1]
    np.testing.assert_allclose(dense, differenced(system, q), atol=1e-8 * np.abs(dense).max())
    assert np.abs(dense - dense.T).max() == pytest.approx(0.3)


def test_newtons_method_is_quadratic_with_the_skew_part_and_slower_without(monkeypatch):
    last = "factors = Factors(self.band, self.skew)\n        return None"
    faulty = patched(tangent, last, "factors = Factors(self.band)\n        return None")
    fast, slow = bent(monkeypatch), bent(monkeypatch, faulty.Tangent)
    falls, lags = (np.diff(np.log(r[r > 1e-12 * r.max()])) for r in (fast, slow))
    assert falls[-1] < 1.8 * falls[-2] < 0
    assert lags[-1] > 1.5 * lags[-2]
    assert slow.size > 1.5 * fast.size


def driven(load, step, duration=20.0):
    """What a rod gains under a following force, and the work of the force at the midpoints of its steps."""
    rod = straight(5, clamped=True)
    system, work = rod.system(load), 0.0
    state = State(system.space.reference, np.zeros(45), system.history)
    for _ in range(round(duration / step)):
        after, _ = moved(system, state, step, "implicit", step)
        (x, d, _), (y, f, _) = state.q.reshape(-1, 3, 3)[-1], after.q.reshape(-1, 3, 3)[-1]
        work += FORCE * (d + f) / 2 @ (y - x)
        state = after
    return energy_of(system, state), work


FORCE = 2e-3


def test_the_integrator_does_not_correct_the_work_of_a_follower_force():
    """What the rod gains is that work, to the rounding; along the path itself, to second order."""
    rod, load = straight(5, clamped=True), follower(FORCE)
    system = rod.system(load)
    start = State(system.space.reference, np.zeros(45), system.history)
    right = energy_of(system, moved(system, start, 20.0, "rk4", 0.01)[0])
    errors = []
    for step in (0.2, 0.1):
        gained, work = driven(load, step)
        assert gained == pytest.approx(work, rel=1e-9)
        errors.append(gained - right)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)
    assert abs(errors[1]) < 1e-3 * right


def test_an_integrator_that_corrects_the_work_of_a_load_is_noticed():
    """As it would be if the force claimed a potential, which is then zero."""
    gained, work = driven(replace(follower(FORCE), symmetric=True), 0.2)
    assert gained != pytest.approx(work, rel=1e-3)
