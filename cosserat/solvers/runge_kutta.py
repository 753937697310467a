"""Explicit Runge-Kutta methods: the thesis's adaptive one, and the classical one with a fixed step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cosserat.errors import DivergedError
from cosserat.solvers.banded import Vector, band_product, constrain, solve_positive
from cosserat.solvers.integrate import REMEDY, IntegratorSettings, State, step_count
from cosserat.solvers.system import MechanicalSystem


def fixed(
    system: MechanicalSystem, state: State, duration: float, settings: IntegratorSettings, name: str
) -> tuple[State, int]:
    """Move on by equal steps of the classical method."""
    count = step_count(duration, settings)
    h, rate, largest = duration / count, _Rates(system), 0.0
    weights = system.space.rotation_weights(state.q)
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(count):
            rate.history, y, t = state.history, _packed(state), state.time
            k1 = rate(t, y)
            k2 = rate(t + h / 2, y + h / 2 * k1)
            k3 = rate(t + h / 2, y + h / 2 * k2)
            k4 = rate(t + h, y + h * k3)
            before = state.q
            state = _accepted(system, state, t + h, y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
            vectors = (weights * (state.q - before)).reshape(-1, system.space.dimension)
            largest = max(largest, float(np.sqrt((vectors**2).sum(axis=1)).max()))
    return replace(state, largest_change=largest), count


def adaptive(
    system: MechanicalSystem, state: State, duration: float, settings: IntegratorSettings, name: str
) -> tuple[State, int]:
    """Move on by SciPy's RK45; returns the number of evaluations.

    Raises
    ------
    DivergedError : it stopped.
    """
    from scipy.integrate import RK45

    size = np.concatenate([np.abs(state.q), np.full(state.v.size, float(np.abs(state.v).max()))])
    allowed = np.full(size.size + 3, settings.tolerance * max(float(size.max()), 1e-300))
    allowed[-3:] = np.inf  # integrals of energy follow the motion
    rate = _Rates(system)
    rate.history = state.history
    method = RK45(
        rate,
        state.time,
        _packed(state),
        state.time + duration,
        max_step=settings.step,
        rtol=settings.tolerance,
        atol=allowed,
    )
    while method.status == "running":
        message = method.step()
        if method.status == "failed":
            raise DivergedError(f"{name}: the explicit integrator stopped ({message}); {REMEDY}")
        state = _accepted(system, state, method.t, method.y)
        rate.history = state.history
    return state, int(method.nfev)


def _packed(state: State) -> Vector:
    """DOFs, velocities, and what damping has taken and supports and loads have given, (2 n + 3,)."""
    return np.concatenate([state.q, state.v, [state.dissipated, state.driven, state.load_work]])


def _accepted(system: MechanicalSystem, before: State, time: float, y: Vector) -> State:
    """The state in the array of `_packed`, with its internal variables."""
    n = before.q.size
    q, v = y[:n], y[n : 2 * n]
    history = system.committed(q, before.history)
    dissipated, driven, load_work = y[2 * n :].tolist()
    return replace(
        before,
        q=q,
        v=v,
        history=history,
        time=time,
        dissipated=dissipated,
        driven=driven,
        load_work=load_work,
    )


class _Rates:
    """Rates of the array of `_packed`.

    The acceleration is M^-1 (-gradient - M (a + c v) of the prescribed DOFs) - c v, with the damping rate c.
    history : internal variables of the last accepted state.
    """

    def __init__(self, system: MechanicalSystem) -> None:
        self.system, self.history = system, system.history
        self.mass = system.inertia.copy()
        constrain(self.mass, system.constrained)

    def __call__(self, time: float, y: Vector) -> Vector:
        system, n = self.system, self.system.constrained.size
        q, v = y[:n], y[n : 2 * n]
        gradient = np.zeros(n)
        system.add_gradient(q, self.history, gradient)
        pushed = system.forces_at(q, self.history, time)
        gradient -= pushed
        force, gaining = -gradient, np.zeros_like(v)
        if system.constraints.moving:
            _, given, gaining = system.constraints.at_time(time)
            v = np.where(system.constrained, given, v)
            force -= band_product(system.inertia, gaining + system.damping_rate * given)
        force[system.constrained] = 0.0
        acceleration = solve_positive(self.mass, force)
        assert acceleration is not None  # a mass is positive
        slowing = np.where(system.constrained, 0.0, acceleration - system.damping_rate * v)
        working = float(pushed @ v)
        if not system.constraints.moving and not system.damping_rate:
            return np.concatenate([v, slowing, [0.0, 0.0, working]])
        momentum = band_product(system.inertia, v)
        taken = system.damping_rate * float((v * momentum)[~system.constrained].sum())
        reaction = band_product(system.inertia, slowing + gaining) + gradient
        driving = float((v * reaction)[system.constrained].sum())
        return np.concatenate([v, slowing, [taken, driving, working]])
