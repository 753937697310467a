"""Motion of an elastic body, M q'' = F, eq. (3.3.50): the state, the settings, and the choice of an integrator.

The implicit method is that of `solvers.energy_momentum`, the explicit ones are those of `solvers.runge_kutta`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from scipy.linalg import eigvalsh

from cosserat.errors import DivergedError, InputError
from cosserat.parameters import Parameters, Quantity
from cosserat.solvers.banded import Vector, band_product, to_sparse
from cosserat.solvers.system import History, MechanicalSystem
from cosserat.solvers.tangent import Tangent

if TYPE_CHECKING:
    from scipy.sparse import dia_array

_MAX_DENSE_DOFS = 8  # up to so many DOFs all eigenvalues are found; an iteration needs more DOFs
_WHOLE_STEPS_TOLERANCE = 1e-9  # rounding of a duration to whole steps


class IntegratorSettings(Parameters):
    """How a motion is computed."""

    method: Literal["implicit", "rk45", "rk4"] = "implicit"
    """"implicit" keeps energy; "rk45" is the thesis's adaptive explicit Runge-Kutta; "rk4" has a fixed step."""
    step: Annotated[float, Quantity("s", "h", above=0)]
    """Time step; of "rk45", the largest."""
    tolerance: Annotated[float, Quantity("1", at_least=1e-13, below=1)] = 1e-8
    """Relative tolerance of "rk45"."""


@dataclass(frozen=True)
class State:
    """DOFs q and velocities v, each (n,), at a time.

    history : the internal variables of every potential of the system.
    largest_change : of a vector that rotates, in one of the steps that led here, as a fraction of its length.
    dissipated, driven : energy that the damping has taken and that moved supports have given since the start [J].
    load_work : work since the start of the loads that depend on time or have no potential [J].
    """

    q: Vector
    v: Vector
    history: History
    time: float = 0.0
    dissipated: float = 0.0
    driven: float = 0.0
    load_work: float = 0.0
    largest_change: float = 0.0


def kinetic_energy(system: MechanicalSystem, state: State) -> float:
    """v . M v / 2 [J]."""
    return float(state.v @ band_product(system.inertia, state.v)) / 2


def integrate(
    system: MechanicalSystem, state: State, duration: float, settings: IntegratorSettings, name: str
) -> tuple[State, int]:
    """Move on by a duration; returns the new state and the number of steps (of evaluations for "rk45").

    The result depends on the state alone, so an interrupted run resumes to the same numbers.

    Raises
    ------
    NotConvergedError : a step of the implicit method found no solution.
    DivergedError : the motion grew without bound.
    """
    after, count = _integrator(settings)(system, state, duration, settings, name)
    if settings.method == "implicit":
        return after, count
    with np.errstate(over="ignore", invalid="ignore"):
        energy = system.internal.energy(after.q, after.history[0]) + kinetic_energy(system, after)
    if not np.isfinite(energy):
        raise DivergedError(f"{name}: the motion diverged with '{settings.method}'; {REMEDY}")
    return _at_supports(system, state, after), count


REMEDY = "take a shorter 'integrator.step' or the method 'implicit'"
"""Remedy for an explicit method that diverges."""

Integrator = Callable[[MechanicalSystem, State, float, IntegratorSettings, str], tuple[State, int]]
"""(system, state, duration, settings, name) -> the state after it, and the number of steps or evaluations."""


def _integrator(settings: IntegratorSettings) -> Integrator:
    """The method, imported only where it is used."""
    if settings.method == "implicit":
        from cosserat.solvers.implicit import integrate_implicitly

        return integrate_implicitly
    from cosserat.solvers import runge_kutta

    return runge_kutta.adaptive if settings.method == "rk45" else runge_kutta.fixed


def step_count(duration: float, settings: IntegratorSettings) -> int:
    """The least number of equal steps in a duration, none longer than the given step."""
    return max(1, math.ceil(duration / settings.step * (1 - _WHOLE_STEPS_TOLERANCE)))


def _at_supports(system: MechanicalSystem, before: State, after: State) -> State:
    """The state after an explicit method, with places and rates of its constrained DOFs as prescribed."""
    if not system.constraints.moving:
        return after
    start, _, _ = system.constraints.at_time(before.time)
    place, rate, _ = system.constraints.at_time(after.time)
    return replace(
        after,
        q=np.where(system.constrained, before.q - start + place, after.q),
        v=np.where(system.constrained, rate, after.v),
    )


def stable_step(system: MechanicalSystem, q: Vector) -> float:
    """Longest step of the classical fourth-order Runge-Kutta method for small motions about q [s].

    derived: a mode of frequency omega under the damping rate c goes as exp(z t), z^2 + c z + omega^2 = 0.  These z lie
    on the real axis between -c and 0 and on a line across its middle, up to those of the highest frequency.  If the
    region of stability contains -c and those two, it contains all between.
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
    system: MechanicalSystem, q: Vector, duration: float, settings: IntegratorSettings, name: str
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


def highest_frequency(system: MechanicalSystem, q: Vector, history: History | None = None) -> float:
    """Largest angular frequency of small motions about q, without constrained DOFs [rad/s]."""
    stiffness, mass = free_matrices(system, q, history)
    if mass.shape[0] < _MAX_DENSE_DOFS:
        largest = np.abs(eigvalsh(stiffness.toarray(), mass.toarray())).max()
        return float(np.sqrt(largest))
    from scipy.sparse.linalg import eigsh  # 0.2 s: only where it is used

    (largest,) = eigsh(
        stiffness, 1, mass, which="LM", v0=np.ones(mass.shape[0]), return_eigenvectors=False
    )
    return float(np.sqrt(abs(largest)))


def free_matrices(
    system: MechanicalSystem, q: Vector, history: History | None = None
) -> tuple[dia_array, dia_array]:
    """Hessian at q, its symmetric part, and mass, of the free DOFs, as sparse matrices."""
    tangent = Tangent(system)
    system.assemble(q, system.history if history is None else history, 1.0, tangent)
    free = ~system.constrained
    return tuple(to_sparse(band)[free][:, free].tocsc() for band in (tangent.band, system.inertia))
