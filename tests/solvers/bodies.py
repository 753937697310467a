"""Small bodies that are no rods, for solvers that shall not know what they move: each a compiled potential.

Kernels do what `cosserat.solvers.potential.KERNEL` says.
"""

from __future__ import annotations

import types
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numba import njit

from cosserat.rods.kinematics import Kinematics
from cosserat.solvers.banded import to_dense
from cosserat.solvers.flat import FixedDofs, FlatSpace
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, KERNEL, Potential
from cosserat.solvers.system import MechanicalSystem
from cosserat.solvers.tangent import Tangent

WELL = np.dtype([("quartic", "f8"), ("quadratic", "f8"), ("middle", "f8")])
SPRING = np.dtype([("one", "i8"), ("other", "i8"), ("stiffness", "f8"), ("length", "f8")])
SLIDER = np.dtype([("stiffness", "f8"), ("cap", "f8"), *WELL.descr])
FORCE = np.dtype([("force", "f8")])
BELOW = 1 - 1e-9  # share of its cap below which a slider holds


@njit(KERNEL, cache=True)
def _well(q, after, data, history, strains, task, gradient, band, skew, terms):
    """Of each DOF, with x = q - middle: quartic x^4 / 4 + quadratic x^2 / 2."""
    wells = data.view(WELL)
    ends = after if after.size > 0 else q
    energy = 0.0
    for i in range(q.size):
        a, b = wells[i]["quartic"], wells[i]["quadratic"]
        y, x = ends[i] - wells[i]["middle"], q[i] - wells[i]["middle"]
        energy += a * y**4 / 4 + b * y**2 / 2
        if task in (GRADIENT, HESSIAN):
            gradient[i] += a * x**3 + b * x
        if task == HESSIAN:
            band[i, 0] += 3 * a * x**2 + b
    terms[0] = energy
    return energy


@njit(KERNEL, cache=True)
def _springs(q, after, data, history, strains, task, gradient, band, skew, terms):
    """Of each spring between two points in space, k (length - its own length)^2 / 2."""
    springs = data.view(SPRING)
    ends = after if after.size > 0 else q
    energy = 0.0
    for k in range(springs.size):
        a, b = 3 * springs[k]["one"], 3 * springs[k]["other"]
        stiffness, own = springs[k]["stiffness"], springs[k]["length"]
        e = q[b : b + 3] - q[a : a + 3]
        last = ends[b : b + 3] - ends[a : a + 3]
        energy += stiffness / 2 * (np.sqrt((last * last).sum()) - own) ** 2
        size = np.sqrt((e * e).sum())
        tension = stiffness * (size - own)
        if task in (GRADIENT, HESSIAN):
            for i in range(3):
                gradient[a + i] -= tension * e[i] / size
                gradient[b + i] += tension * e[i] / size
        if task == HESSIAN:
            for i in range(3):
                for j in range(3):
                    entry = (stiffness - tension / size) * e[i] * e[j] / size**2
                    if i == j:
                        entry += tension / size
                    if i >= j:
                        band[a + j, i - j] += entry
                        band[b + j, i - j] += entry
                    band[a + j, b + i - a - j] -= entry
    terms[0] = energy
    return energy


@njit(KERNEL, cache=True)
def _sliders(q, after, data, history, strains, task, gradient, band, skew, terms):
    """Of each DOF an elastic slider whose anchor gives way at a cap of its force, and the energy of `_well` beside it.

    history : the anchors, then how often a state was accepted.  The energy is that whose slope is the force: what is
    stored, and what sliding since the last accepted state has taken.  At its cap it is as soft as if it slid on.
    """
    sliders = data.view(SLIDER)
    ends = after if after.size > 0 else q
    n = q.size
    if task == COMMIT:
        for i in range(n):
            reach = sliders[i]["cap"] / sliders[i]["stiffness"]
            history[i] = min(max(history[i], q[i] - reach), q[i] + reach)
        history[n] += 1
        return 0.0
    energy = 0.0
    for i in range(n):
        k, cap = sliders[i]["stiffness"], sliders[i]["cap"]
        a, b, middle = sliders[i]["quartic"], sliders[i]["quadratic"], sliders[i]["middle"]
        y, x, e, s = ends[i] - middle, q[i] - middle, abs(ends[i] - history[i]), q[i] - history[i]
        energy += k * e * e / 2 if k * e <= cap else cap * e - cap * cap / (2 * k)
        energy += a * y**4 / 4 + b * y**2 / 2
        if task in (GRADIENT, HESSIAN):
            gradient[i] += min(max(k * s, -cap), cap) + a * x**3 + b * x
        if task == HESSIAN:
            band[i, 0] += 3 * a * x**2 + b + (k if abs(k * s) < BELOW * cap else 0.0)
    terms[0] = energy
    return energy


@njit(KERNEL, cache=True)
def _dead(q, after, data, history, strains, task, gradient, band, skew, terms):
    """A constant force on each DOF."""
    forces = data.view(FORCE)
    ends = after if after.size > 0 else q
    energy = 0.0
    for i in range(q.size):
        energy -= forces[i]["force"] * ends[i]
        if task in (GRADIENT, HESSIAN):
            gradient[i] -= forces[i]["force"]
    terms[0] = energy
    return energy


@njit(KERNEL, cache=True)
def _circulating(q, after, data, history, strains, task, gradient, band, skew, terms):
    """A force on two DOFs across where they are, p (-q[1], q[0]): it has no potential."""
    p = data.view(FORCE)[0]["force"]
    if task in (GRADIENT, HESSIAN):
        gradient[0] += p * q[1]
        gradient[1] -= p * q[0]
    if task == HESSIAN and skew.shape[0] > 0:
        skew[0, 1] -= p
    terms[0] = 0.0
    return 0.0


def potential_of(kernel, constants, half_bandwidth, **more):
    """A potential of one term."""
    return Potential(kernel, constants, ("energy",), half_bandwidth, **more)


def table(dtype, *rows):
    """A structured array of rows."""
    return np.array([tuple(row) for row in rows], dtype)


def wells(*rows):
    """Rows (quartic, quadratic, middle), one a DOF."""
    return potential_of(_well, table(WELL, *rows), 0)


def springs(rows):
    """Rows (one point, the other, which is a later one, stiffness, length)."""
    constants = table(SPRING, *rows)
    reach = int((constants["other"] - constants["one"]).max())
    return potential_of(_springs, constants, 3 * reach + 2)


def sliders(*rows):
    """Rows (stiffness, cap, quartic, quadratic, middle), one a DOF, anchored at zero."""
    return potential_of(_sliders, table(SLIDER, *rows), 0, history=np.zeros(len(rows) + 1))


def dead(force):
    """Constant forces (n,)."""
    return potential_of(_dead, table(FORCE, *((f,) for f in force)), -1)


def circulating(p):
    """The force without a potential."""
    return potential_of(_circulating, table(FORCE, (p,)), 1, symmetric=False)


@dataclass(frozen=True)
class PointSpace(FlatSpace):
    """Points in space, which know how they move as one."""

    dimension: int = 3

    def rigid_motions(self, q):
        return Kinematics(("E1", "E2", "E3"), ("x",)).rigid_motions(q)


def body(internal, *loads, mass=None, space=None, held=(), n=None, **more):
    """A system of DOFs without rotations; held: those that are fixed."""
    n = internal.constants.size if n is None else n
    mask = np.zeros(n, bool)
    mask[list(held)] = True
    band = np.broadcast_to(np.asarray(0.0 if mass is None else mass, float), (n,))[:, None].copy()
    space = FlatSpace(np.ones(n)) if space is None else space
    return MechanicalSystem(
        internal, loads, FixedDofs(mask), space, None if mass is None else lambda: band, **more
    )


def hessian(system, q, history=None, factor=1.0):
    """The gradient and the dense Hessian, of which no symmetry is asked, at q."""
    tangent = Tangent(system)
    assert system.assemble(q, system.history if history is None else history, factor, tangent)
    n, dense = q.size, to_dense(tangent.band)
    for j in range(tangent.skew.shape[0]):
        for k in range(1, min(tangent.skew.shape[1], n - j)):
            dense[j + k, j] += tangent.skew[j, k]
            dense[j, j + k] -= tangent.skew[j, k]
    return tangent.gradient.copy(), dense


def differenced(system, q, step=1e-6):
    """The Hessian by central differences of the gradient, a column each."""
    columns = []
    for i in range(q.size):
        shift = np.zeros(q.size)
        shift[i] = step
        up, down = hessian(system, q + shift)[0], hessian(system, q - shift)[0]
        columns.append((up - down) / (2 * step))
    return np.column_stack(columns)


def patched(module, old, new):
    """The module as it would be with other text, for tests that shall fail then."""
    source = Path(module.__file__).read_text()
    assert source.count(old) == 1
    other = types.ModuleType(module.__name__)
    exec(compile(source.replace(old, new), module.__file__, "exec"), other.__dict__)
    return other
