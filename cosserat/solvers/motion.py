"""Motion of an elastic body, M q'' = F, eq. (3.3.50): implicitly, keeping energy and momenta, or explicitly.

The implicit method is the midpoint rule with a discrete gradient (Gonzalez, J. Nonlinear Sci. 6, 449, 1996): the
elastic force is the gradient at the midpoint plus sigma z, where sigma makes its work the change of energy, exactly.
Gonzalez takes z along the step; here z is the step less its rigid part when nothing is held, so that the added force
has neither a resultant nor a moment and linear and angular momentum stay as they are.  Second order in the step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal, Protocol

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.errors import DivergedError, InputError, NotConvergedError
from cosserat.parameters import Parameters, Quantity
from cosserat.solvers.banded import Band, Mask, Vector, band_product, hold, solve_positive
from cosserat.solvers.stepping import MAX_ITERATIONS, STALL, TOLERANCE, Compiled, march

if TYPE_CHECKING:
    from scipy.sparse import dia_array

_MAX_ITERATIONS = 30
_EPS = float(np.finfo(float).eps)
_RK4_LIMIT = 2.8284271247461903  # largest omega h on the imaginary axis, 2 sqrt(2)


class Body(Protocol):
    """A body with a strain energy, as a moving body needs it."""

    @property
    def half_bandwidth(self) -> int:
        """Largest distance of two coupled unknowns."""

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
    drive : how held unknowns are moved; None where they rest.
    rigid : fields (k, n) at q that a free body's momenta belong to, as a function of q; None where something is held.
    """

    body: Body
    mass: Band
    load: Vector
    held: Mask
    drag: float
    rigid: RigidFields | None
    drive: Drive | None = None


class Drive(Protocol):
    """Prescribed displacements of held unknowns."""

    def __call__(self, time: float) -> tuple[Vector, Vector]:
        """Displacement and velocity at a time, each (n,), zero where nothing is prescribed."""


class RigidFields(Protocol):
    """Velocity fields that do not deform."""

    def __call__(self, q: Vector) -> NDArray[np.float64]:
        """The fields at q, shape (k, n)."""


@dataclass(frozen=True)
class State:
    """Positions q and velocities v, each (n,), at a time."""

    q: Vector
    v: Vector
    time: float = 0.0


def kinetic_energy(system: System, state: State) -> float:
    """v . M v / 2 [J]."""
    return float(state.v @ band_product(system.mass, state.v)) / 2


def advance(
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
    count = max(1, round(duration / settings.step))
    if settings.method == "implicit" and _runs_compiled(system):
        return _marched(system, state, duration / count, count, name), count
    move = _Implicit(system, name).step if settings.method == "implicit" else _Rk4(system).step
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(count):
            state = move(state, duration / count)
    _refuse_divergence(system, state, settings, name)
    return state, count


def _runs_compiled(system: System) -> bool:
    """Whether the body's energy is a compiled function, its supports rest and its momenta are of no concern."""
    return isinstance(system.body, Compiled) and system.rigid is None and system.drive is None


def _marched(system: System, state: State, h: float, count: int, name: str) -> State:
    body = system.body
    assert isinstance(body, Compiled)
    q, v = state.q.copy(), np.where(system.held, 0.0, state.v)
    width = 1 + max((k for k in range(system.mass.shape[1]) if system.mass[:, k].any()), default=0)
    done = march()(
        body.kernel,
        body.parameters,
        q,
        v,
        np.ascontiguousarray(system.mass[:, :width]),
        system.load,
        system.held,
        system.drag,
        h,
        count,
        body.half_bandwidth,
    )
    if done < count:
        raise _no_step(name, h, MAX_ITERATIONS)
    return State(q, v, state.time + count * h)


def _no_step(name: str, h: float, iterations: int) -> NotConvergedError:
    return NotConvergedError(
        f"{name}: a time step of {h:.3g} s found no solution; take a shorter 'integrator.step'",
        iterations=iterations,
        tolerance=TOLERANCE,
    )


def stable_step(system: System, q: Vector) -> float:
    """Longest step of the classical fourth-order Runge-Kutta method at q, from the highest frequency there [s]."""
    return _RK4_LIMIT / highest_frequency(system, q)


def refuse_unstable_step(system: System, q: Vector, settings: IntegratorSettings, name: str) -> None:
    """Raise InputError if a fixed explicit step is beyond the stability limit at q."""
    if settings.method != "rk4":
        return
    limit = stable_step(system, q)
    if settings.step > limit:
        raise InputError(
            f"{name}: 'integrator.step' is {settings.step:g} s, but this rod is stable with 'rk4' only up to "
            f"{limit:.3g} s; take a shorter step or the method 'implicit'"
        )


def highest_frequency(system: System, q: Vector) -> float:
    """Largest angular frequency of small motions about q, held unknowns left out [rad/s]."""
    from scipy.sparse.linalg import eigsh  # 0.2 s: only where it is used

    stiffness, mass = free_matrices(system, q)
    (largest,) = eigsh(
        stiffness, 1, mass, which="LM", v0=np.ones(mass.shape[0]), return_eigenvectors=False
    )
    return float(np.sqrt(abs(largest)))


def free_matrices(system: System, q: Vector) -> tuple[dia_array, dia_array]:
    """Hessian at q and mass, of the free unknowns, as sparse matrices."""
    gradient, band = np.empty(q.size), np.empty((q.size, system.body.half_bandwidth + 1))
    system.body.assemble(q, gradient, band)
    free = ~system.held
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


@njit(cache=True)
def _step_matrix(band: Band, mass: Band, factor: float) -> None:
    """Overwrite a Hessian with half of it plus factor times the mass."""
    for j in range(band.shape[0]):
        for k in range(band.shape[1]):
            band[j, k] *= 0.5
        for k in range(mass.shape[1]):
            band[j, k] += factor * mass[j, k]


class _Implicit:
    """The energy- and momentum-keeping midpoint rule, with its work arrays."""

    def __init__(self, system: System, name: str) -> None:
        n = system.held.size
        self.system, self.name = system, name
        self.gradient = np.empty(n)
        self.band = np.empty((n, system.body.half_bandwidth + 1))

    def step(self, state: State, h: float) -> State:
        body, mass, held = self.system.body, self.system.mass, self.system.held
        before = body.energy(state.q)
        given = np.zeros_like(state.q)
        if self.system.drive is not None:
            given = self.system.drive(state.time + h)[0] - self.system.drive(state.time)[0]
        change = np.where(held, given, h * state.v)
        factor = 2 / h**2 + self.system.drag / h
        pull = self.system.load + (2 / h) * band_product(mass, state.v)
        size = np.inf
        for _ in range(_MAX_ITERATIONS):
            middle = body.assemble(state.q + change / 2, self.gradient, self.band)
            if not np.isfinite(middle):
                break
            force = pull - factor * band_product(mass, change) - self.gradient
            force -= self._correction(state.q, change, before)
            force[held] = 0.0
            _step_matrix(self.band, mass, factor)
            hold(self.band, held)
            correction = solve_positive(self.band, force)
            if correction is None:
                break
            change += correction
            size, last = float(np.abs(correction).max()), size
            rounding = _EPS * float(np.abs(state.q).max())
            stalled = size > last / 2 and size < STALL * rounding
            if stalled or size <= max(TOLERANCE * float(np.abs(change).max()), rounding):
                return self._arrived(state, change, h)
        raise _no_step(self.name, h, _MAX_ITERATIONS)

    def _arrived(self, state: State, change: Vector, h: float) -> State:
        v = 2 / h * change - state.v
        if self.system.drive is not None:
            v = np.where(self.system.held, self.system.drive(state.time + h)[1], v)
        return State(state.q + change, v, state.time + h)

    def _correction(self, q: Vector, change: Vector, before: float) -> Vector:
        """The force sigma z that makes the work of the elastic forces the change of energy."""
        after = self.system.body.energy(q + change)
        missing = after - before - float(self.gradient @ change)
        along = change
        if self.system.rigid is not None:
            fields, _ = np.linalg.qr(self.system.rigid(q + change / 2).T)
            along = change - fields @ (fields.T @ change)
        size = float(along @ change)
        # rounding a position by eps q changes an energy Pi = k u^2 / 2 by sqrt(2 k Pi) eps q
        stiffest = float(np.abs(self.band[:, 0]).max())
        slip = _EPS * float(np.abs(q).max()) * np.sqrt(2 * stiffest * (abs(before) + abs(after)))
        if size == 0.0 or not abs(missing) > slip + _EPS * (abs(before) + abs(after)):
            return np.zeros_like(change)
        return missing / size * along


class _Rk4:
    """The classical Runge-Kutta method with a fixed step."""

    def __init__(self, system: System) -> None:
        self.rate = _Acceleration(system)

    def step(self, state: State, h: float) -> State:
        y = np.concatenate([state.q, state.v])
        t = state.time
        k1 = self.rate(t, y)
        k2 = self.rate(t + h / 2, y + h / 2 * k1)
        k3 = self.rate(t + h / 2, y + h / 2 * k2)
        k4 = self.rate(t + h, y + h * k3)
        q, v = np.split(y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), 2)
        return State(q, v, t + h)


class _Acceleration:
    """Rates of (q, v): velocities, and M^-1 (load - gradient) - drag v."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.gradient = np.empty(system.held.size)
        self.mass = system.mass.copy()
        hold(self.mass, system.held)

    def __call__(self, time: float, y: Vector) -> Vector:
        q, v = np.split(y, 2)
        if self.system.drive is not None:
            v = np.where(self.system.held, self.system.drive(time)[1], v)
        self.system.body.differentiate(q, self.gradient)
        force = np.where(self.system.held, 0.0, self.system.load - self.gradient)
        acceleration = solve_positive(self.mass, force)
        assert acceleration is not None  # a mass is positive
        slowing = np.where(self.system.held, 0.0, acceleration - self.system.drag * v)
        rate = np.concatenate([v, slowing])
        return rate


def _adaptive(
    system: System, state: State, duration: float, settings: IntegratorSettings, name: str
) -> tuple[State, int]:
    from scipy.integrate import solve_ivp

    start = np.concatenate([state.q, state.v])
    size = np.concatenate([np.abs(state.q), np.full(state.v.size, float(np.abs(state.v).max()))])
    done = solve_ivp(
        _Acceleration(system),
        (state.time, state.time + duration),
        start,
        method="RK45",
        max_step=settings.step,
        rtol=settings.tolerance,
        atol=settings.tolerance * max(float(size.max()), 1e-300),
    )
    if not done.success:
        raise DivergedError(f"{name}: the explicit integrator stopped ({done.message}); {_REMEDY}")
    q, v = np.split(done.y[:, -1], 2)
    after = State(q, v, state.time + duration)
    _refuse_divergence(system, after, settings, name)
    return after, int(done.nfev)


_REMEDY = "take a shorter 'integrator.step' or the method 'implicit'"


def _refuse_divergence(system: System, state: State, settings: IntegratorSettings, name: str) -> None:
    energy = system.body.energy(state.q) + kinetic_energy(system, state)
    if not np.isfinite(energy):
        raise DivergedError(f"{name}: the motion diverged with '{settings.method}'; {_REMEDY}")
