"""Motion of an elastic body, M q'' = F, eq. (3.3.50): implicitly, keeping energy and momenta, or explicitly.

The implicit method is that of `solvers.energy_momentum`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvalsh

from cosserat.errors import DivergedError, InputError, NotConvergedError
from cosserat.parameters import Parameters, Quantity
from cosserat.solvers.banded import Band, Mask, Vector, band_product, constrain, solve_positive
from cosserat.solvers.energy_momentum import MAX_ITERATIONS, TOLERANCE, integrate_steps, unwrap

if TYPE_CHECKING:
    from scipy.sparse import dia_array

DAMPED = 8.0
"""Largest c omega h^2 at which the implicit method takes energy from a mode of frequency omega at the rate c."""
_FEW = 8  # DOFs of which all eigenvalues are sought, as an iteration needs more than it seeks
_EXACT = 1e-9  # a duration that is so near to a whole number of steps is one


class Body(Protocol):
    """A body with a compiled energy, of the kind that `stepping.KERNEL` tells."""

    @property
    def half_bandwidth(self) -> int:
        """Largest distance of two coupled DOFs."""

    @property
    def kernel(self) -> object:
        """The compiled energy."""

    @property
    def parameters(self) -> NDArray[np.float64]:
        """What the kernel takes besides the DOFs."""

    def unwrapped_near(self, angle: float) -> Body:
        """The same body, the angle of its first director counted within half a turn of this one [rad]."""

    def assemble(self, q: Vector, gradient: Vector, band: Band) -> float:
        """Energy at q; overwrites its gradient and Hessian."""

    def differentiate(self, q: Vector, gradient: Vector) -> float:
        """Energy at q; overwrites its gradient."""

    def energy(self, q: Vector) -> float:
        """Energy at q."""


class IntegratorSettings(Parameters):
    """How a motion is computed."""

    method: Literal["implicit", "rk45", "rk4"] = "implicit"
    """"implicit" keeps energy; "rk45" is the thesis's adaptive explicit Runge-Kutta; "rk4" has a fixed step."""
    step: Annotated[float, Quantity("s", "h", above=0)]
    """Time step; of "rk45", the largest."""
    tolerance: Annotated[float, Quantity("1", above=0, below=1)] = 1e-8
    """Relative tolerance of "rk45"."""


@dataclass(frozen=True)
class System:
    """What moves: the body, its mass as a symmetric band (n, w + 1), dead load (n,), what is held and the drag [1/s].

    The damping force is -drag M v.
    translations : (2, n) displacements of a free body that only move it; (0, n) where something is held.
    drive : how constrained DOFs are moved; None where they rest.
    """

    body: Body
    mass: Band
    load: Vector
    constrained: Mask
    damping_rate: float
    translations: NDArray[np.float64]
    drive: PrescribedMotion | None = None


class PrescribedMotion(Protocol):
    """Prescribed displacements of constrained DOFs."""

    def __call__(self, time: float) -> tuple[Vector, Vector, Vector]:
        """Displacement, velocity and acceleration at a time, each (n,), zero where nothing is prescribed."""


@dataclass(frozen=True)
class State:
    """Positions q and velocities v, each (n,), at a time.

    angle : of the first director, counted through whole turns [rad]; None: within half a turn of the reference.
    dissipated, driven : energy that the drag has taken and that moved supports have given since the start [J].
    """

    q: Vector
    v: Vector
    time: float = 0.0
    angle: float | None = None
    dissipated: float = 0.0
    driven: float = 0.0


def body_at(system: System, state: State) -> Body:
    """The body with its angles counted as in this state."""
    return system.body if state.angle is None else system.body.unwrapped_near(state.angle)


def kinetic_energy(system: System, state: State) -> float:
    """v . M v / 2 [J]."""
    return float(state.v @ band_product(system.mass, state.v)) / 2


def integrate(
    system: System, state: State, duration: float, settings: IntegratorSettings, name: str
) -> tuple[State, int]:
    """Move on by a duration; returns the new state and the number of steps (of evaluations for "rk45").

    The result depends on the state alone, so that a run cut anywhere goes on to the same numbers.

    Raises
    ------
    NotConvergedError : a step of the implicit method found no solution.
    DivergedError : the motion grew without bound.
    """
    if settings.method == "rk45":
        return _adaptive(system, state, duration, settings, name)
    count = step_count(duration, settings)
    if settings.method == "implicit":
        return _implicit(system, state, duration / count, count, name), count
    move = _Rk4(system)
    after = state
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(count):
            after = _counted(move.step(after, duration / count))
    _check_divergence(system, after, settings, name)
    return _driven(system, state, after), count


def step_count(duration: float, settings: IntegratorSettings) -> int:
    """The least number of equal steps in a duration of which none is longer than the given step."""
    return max(1, math.ceil(duration / settings.step * (1 - _EXACT)))


def _driven(system: System, before: State, after: State) -> State:
    """The state after an explicit method has moved on, its constrained DOFs where and as fast as they are moved."""
    if system.drive is None:
        return after
    start, _, _ = system.drive(before.time)
    prescribe, rate, _ = system.drive(after.time)
    return replace(
        after,
        q=np.where(system.constrained, before.q - start + prescribe, after.q),
        v=np.where(system.constrained, rate, after.v),
    )


def _counted(state: State) -> State:
    """The state with the angle of its first director, if that is counted, followed by less than half a turn."""
    if state.angle is None:
        return state
    return replace(state, angle=unwrap(state.q[3], state.q[2], state.angle))


def _implicit(system: System, state: State, h: float, count: int, name: str) -> State:
    constrained = system.constrained
    q, v, parameters = state.q.copy(), state.v.copy(), body_at(system, state).parameters.copy()
    mass_width = 1 + max(np.flatnonzero(system.mass.any(axis=0)), default=0)
    moved = np.flatnonzero(constrained) if system.drive else np.empty(0, dtype=np.int64)
    path = np.zeros((2, count + 1, moved.size))
    if system.drive:
        for number in range(count + 1):
            prescribe, rate, _ = system.drive(state.time + number * h)
            path[:, number] = prescribe[moved], rate[moved]
    exchanged = np.array([state.dissipated, state.driven])
    done = integrate_steps()(
        system.body.kernel,
        parameters,
        q,
        v,
        np.ascontiguousarray(system.mass[:, :mass_width]),
        system.load,
        constrained,
        moved,
        *path,
        system.translations,
        system.damping_rate,
        h,
        system.body.half_bandwidth,
        exchanged,
    )
    if done < count:
        raise NotConvergedError(
            f"{name}: a time step of {h:.3g} s found no solution; take a shorter 'integrator.step'",
            iterations=MAX_ITERATIONS,
            tolerance=TOLERANCE,
        )
    return State(q, v, state.time + count * h, float(parameters[0, -1]), *exchanged.tolist())


def stable_step(system: System, q: Vector) -> float:
    """Longest step of the classical fourth-order Runge-Kutta method for small motions about q [s].

    derived: a mode of frequency omega under a drag c goes as exp(z t), z^2 + c z + omega^2 = 0.  These z lie on the
    real axis between -c and 0 and on a line across its middle, up to those of the highest frequency.  The region of
    stability holds with -c and those two whatever lies between.
    """
    root = np.emath.sqrt(system.damping_rate**2 / 4 - highest_frequency(system, q) ** 2)
    ends = (-system.damping_rate / 2 + root, -system.damping_rate / 2 - root, -system.damping_rate)
    return min(_longest(complex(z)) for z in ends if z)


def _longest(z: complex) -> float:
    """Largest h with |1 + h z + ... + (h z)^4 / 24| <= 1, for z with no positive real part."""
    from scipy.optimize import brentq  # only where it is used

    unit = z / abs(z)

    def growth(r: float) -> float:
        return abs(sum((r * unit) ** k / math.factorial(k) for k in range(5))) - 1

    return float(brentq(growth, 1.0, 4.0, xtol=1e-12)) / abs(z)


def check_stable_step(
    system: System, q: Vector, duration: float, settings: IntegratorSettings, name: str
) -> None:
    """Raise InputError if the steps of a fixed explicit method in a duration are beyond the stability limit at q."""
    if settings.method != "rk4":
        return
    limit, taken = stable_step(system, q), duration / step_count(duration, settings)
    if taken > limit:
        raise InputError(
            f"{name}: 'integrator.step' is {settings.step:g} s, which makes steps of {taken:.3g} s, but this rod is "
            f"stable with 'rk4' only up to {limit:.3g} s; take a shorter step or the method 'implicit'"
        )


def highest_frequency(system: System, q: Vector) -> float:
    """Largest angular frequency of small motions about q, constrained DOFs left out [rad/s]."""
    stiffness, mass = free_matrices(system, q)
    if mass.shape[0] < _FEW:
        largest = np.abs(eigvalsh(stiffness.toarray(), mass.toarray())).max()
        return float(np.sqrt(largest))
    from scipy.sparse.linalg import eigsh  # 0.2 s: only where it is used

    (largest,) = eigsh(
        stiffness, 1, mass, which="LM", v0=np.ones(mass.shape[0]), return_eigenvectors=False
    )
    return float(np.sqrt(abs(largest)))


def free_matrices(system: System, q: Vector) -> tuple[dia_array, dia_array]:
    """Hessian at q and mass, of the free DOFs, as sparse matrices."""
    gradient, band = np.empty(q.size), np.empty((q.size, system.body.half_bandwidth + 1))
    system.body.assemble(q, gradient, band)
    free = ~system.constrained
    return tuple(_sparse(matrix)[free][:, free].tocsc() for matrix in (band, system.mass))


def _sparse(band: Band) -> dia_array:
    from scipy.sparse import dia_array

    n, width = band.shape
    offsets = range(min(width, n))
    lower = dia_array(
        (np.array([band[:, k] for k in offsets]), [-k for k in offsets]), shape=(n, n)
    ).tocsr()
    return (
        lower
        + dia_array(
            (np.array([np.roll(band[:, k], k) for k in offsets[1:]]), offsets[1:]), shape=(n, n)
        ).tocsr()
    )


class _Rk4:
    """The classical Runge-Kutta method with a fixed step."""

    def __init__(self, system: System) -> None:
        self.rate = _Rates(system)

    def step(self, state: State, h: float) -> State:
        y, t = _packed(state), state.time
        k1 = self.rate(t, y)
        k2 = self.rate(t + h / 2, y + h / 2 * k1)
        k3 = self.rate(t + h / 2, y + h / 2 * k2)
        k4 = self.rate(t + h, y + h * k3)
        return _unpacked(y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), t + h, state.angle)


def _packed(state: State) -> Vector:
    """Positions, velocities, and what drag and supports have taken and given, (2 n + 2,)."""
    return np.concatenate([state.q, state.v, [state.dissipated, state.driven]])


def _unpacked(y: Vector, time: float, angle: float | None) -> State:
    n = y.size // 2 - 1
    q, v = y[:n], y[n : 2 * n]
    return State(q, v, time, angle, float(y[-2]), float(y[-1]))


class _Rates:
    """Rates of what `_packed` holds.

    The acceleration is M^-1 (load - gradient - M (a + drag v) of what is moved) - drag v.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.gradient = np.empty(system.constrained.size)
        self.mass = system.mass.copy()
        constrain(self.mass, system.constrained)

    def __call__(self, time: float, y: Vector) -> Vector:
        system, n = self.system, self.gradient.size
        q, v = y[:n], y[n : 2 * n]
        system.body.differentiate(q, self.gradient)
        force, gaining = system.load - self.gradient, np.zeros_like(v)
        if system.drive is not None:
            _, given, gaining = system.drive(time)
            v = np.where(system.constrained, given, v)
            force -= band_product(system.mass, gaining + system.damping_rate * given)
        force[system.constrained] = 0.0
        acceleration = solve_positive(self.mass, force)
        assert acceleration is not None  # a mass is positive
        slowing = np.where(system.constrained, 0.0, acceleration - system.damping_rate * v)
        if system.drive is None and not system.damping_rate:
            return np.concatenate([v, slowing, np.zeros(2)])
        momentum = band_product(system.mass, v)
        taken = system.damping_rate * float((v * momentum)[~system.constrained].sum())
        pushed = band_product(system.mass, slowing + gaining) + self.gradient - system.load
        return np.concatenate([v, slowing, [taken, float((v * pushed)[system.constrained].sum())]])


def _adaptive(
    system: System, state: State, duration: float, settings: IntegratorSettings, name: str
) -> tuple[State, int]:
    from scipy.integrate import solve_ivp

    size = np.concatenate([np.abs(state.q), np.full(state.v.size, float(np.abs(state.v).max()))])
    allowed = np.full(size.size + 2, settings.tolerance * max(float(size.max()), 1e-300))
    allowed[-2:] = np.inf  # the books follow the motion
    done = solve_ivp(
        _Rates(system),
        (state.time, state.time + duration),
        _packed(state),
        method="RK45",
        max_step=settings.step,
        rtol=settings.tolerance,
        atol=allowed,
    )
    if not done.success:
        raise DivergedError(f"{name}: the explicit integrator stopped ({done.message}); {_REMEDY}")
    after = state
    for y in done.y.T:  # every step, so that no turn is missed
        after = _counted(_unpacked(y, state.time + duration, after.angle))
    _check_divergence(system, after, settings, name)
    return _driven(system, state, after), int(done.nfev)


_REMEDY = "take a shorter 'integrator.step' or the method 'implicit'"


def _check_divergence(system: System, state: State, settings: IntegratorSettings, name: str) -> None:
    with np.errstate(over="ignore", invalid="ignore"):
        energy = system.body.energy(state.q) + kinetic_energy(system, state)
    if not np.isfinite(energy):
        raise DivergedError(f"{name}: the motion diverged with '{settings.method}'; {_REMEDY}")
