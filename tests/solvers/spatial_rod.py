"""A rod in space with two directors, nine numbers a vertex: an energy of the tests alone, objective and short.

Its strains are quadratic in the degrees of freedom.  With e the edge, h its length, d_a and d_a' the directors a = 1, 2
at its ends, all of unit length in the reference:

    edge     (e.e / h^2) / 2,   e.(d_a + d_a') / (2 h),   e.(d_a' - d_a) / h^2,   (d_2.d_1' - d_1.d_2') / (2 h)
    vertex   d_a.d_a / 2,   d_1.d_2

and the energy is the sum of w (strain - reference)^2 / 2.  In small strains that is Timoshenko's beam.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from bodies import FORCE, dead, potential_of, table
from numba import njit

from cosserat.rods.kinematics import SPATIAL
from cosserat.rods.space import RodSpace
from cosserat.solvers.flat import FixedDofs
from cosserat.solvers.potential import GRADIENT, HESSIAN, KERNEL, STRAINS
from cosserat.solvers.system import MechanicalSystem

FORM = np.dtype(
    [("first", "i8"), ("vectors", "i8"), ("weight", "f8"), ("reference", "f8"), ("B", "f8", (6, 6))]
)
"""A strain, half the sum of B[v, w] y_v . y_w over so many vectors y from a first DOF on."""


@njit(cache=True)
def _strain(q, p, vectors, B, slope):
    """The strain of a form; overwrites its gradient (6, 3).  Positions count from the first, lest they cancel."""
    total = 0.0
    for v in range(vectors):
        for i in range(3):
            slope[v, i] = 0.0
            for w in range(vectors):
                start = q[p + i] if w % 3 == 0 else 0.0
                slope[v, i] += B[v, w] * (q[p + 3 * w + i] - start)
            start = q[p + i] if v % 3 == 0 else 0.0
            total += slope[v, i] * (q[p + 3 * v + i] - start) / 2
    return total


@njit(KERNEL, cache=True)
def _form_energy(q, after, data, history, strains, task, gradient, band, skew, terms):
    """As `cosserat.solvers.potential.KERNEL` says."""
    forms = data.view(FORM)
    energy, slope = 0.0, np.empty((6, 3))
    for k in range(forms.size):
        p, vectors, weight = forms[k]["first"], forms[k]["vectors"], forms[k]["weight"]
        rest, B, n = forms[k]["reference"], forms[k]["B"], 3 * forms[k]["vectors"]
        strain = _strain(after if after.size > 0 else q, p, vectors, B, slope)
        energy += weight / 2 * (strain - rest) ** 2
        if task == STRAINS:
            strains[k, 0] = strain
        if task not in (GRADIENT, HESSIAN):
            continue
        start = strains[k, 0] if after.size > 0 else strain
        stress = weight * ((strain + start) / 2 - rest)
        _strain(q, p, vectors, B, slope)
        for i in range(n):
            gradient[p + i] += stress * slope[i // 3, i % 3]
        if task == HESSIAN:
            tension = max(stress, weight * (start - rest))
            for j in range(n):
                for i in range(j, n):
                    band[p + j, i - j] += weight * slope[i // 3, i % 3] * slope[j // 3, j % 3]
                for v in range(j // 3, vectors):
                    band[p + j, 3 * (v - j // 3)] += tension * B[v, j // 3]
    terms[0] = energy
    return energy


@njit(KERNEL, cache=True)
def _follower(q, after, data, history, strains, task, gradient, band, skew, terms):
    """A force along the first director of the last vertex, as long as that is: there is no potential."""
    force, x = data.view(FORCE)[0]["force"], q.size - 9
    d = x + 3
    for i in range(3):
        if task in (GRADIENT, HESSIAN):
            gradient[x + i] -= force * q[d + i]
        if task == HESSIAN:
            band[x + i, 3] -= force / 2
            if skew.shape[0] > 0:
                skew[x + i, 3] += force / 2
    terms[0] = 0.0
    return 0.0


def follower(force):
    """The force along the first director of the last vertex."""
    return potential_of(_follower, table(FORCE, (force,)), 3, symmetric=False)


def edge_forms(h):
    """B (6, 6) of the strains of an edge between (x, d_1, d_2) and (x', d_1', d_2')."""
    x, d1, d2, y, f1, f2 = np.eye(6)
    e = y - x

    def product(a, b):
        return np.outer(a, b) + np.outer(b, a)

    return {
        "axial": product(e, e) / (2 * h**2),
        "shear_1": product(e, d1 + f1) / (2 * h),
        "shear_2": product(e, d2 + f2) / (2 * h),
        "bending_1": product(e, f1 - d1) / h**2,
        "bending_2": product(e, f2 - d2) / h**2,
        "torsion": (product(d2, f1) - product(d1, f2)) / (2 * h),
    }


def vertex_forms():
    """B (6, 6) of the strains of a vertex."""
    _, d1, d2, *_ = np.eye(6)
    return {
        "section_1": np.outer(d1, d1),
        "section_2": np.outer(d2, d2),
        "section_12": np.outer(d1, d2) + np.outer(d2, d1),
    }


@dataclass(frozen=True)
class SpatialRod:
    """A rod of Young's modulus, density and area one.

    at_rest : (N, 3, 3) positions and unit directors.  radii : of gyration, along both directors.
    shear : k G / E.  held : DOFs that are fixed.
    """

    at_rest: np.ndarray
    radii: tuple[float, float] = (0.05, 0.03)
    shear: float = 0.4
    held: np.ndarray = field(default_factory=lambda: np.empty(0, int))

    @property
    def edges(self):
        """Lengths (N - 1,)."""
        return np.linalg.norm(np.diff(self.at_rest[:, 0], axis=0), axis=1)

    @property
    def parts(self):
        """Lengths (N,) that belong to the vertices."""
        h = np.concatenate([[0.0], self.edges, [0.0]])
        return (h[1:] + h[:-1]) / 2

    @property
    def masses(self):
        """Of positions and directors (N, 3)."""
        return self.parts[:, None] * np.array([1.0, *np.square(self.radii)])

    @property
    def stiffness(self):
        """Per length, by the name of the strain."""
        I1, I2 = np.square(self.radii)
        own = {
            "axial": 1.0,
            "shear_1": self.shear,
            "shear_2": self.shear,
            "bending_1": I1,
            "bending_2": I2,
        }
        sections = {"section_1": 1.0, "section_2": 1.0, "section_12": self.shear}
        return own | {"torsion": self.shear * (I1 + I2)} | sections

    def energy(self):
        """The potential, zero at rest."""
        q, rows = self.at_rest.ravel(), []
        for K, h in enumerate(self.edges):
            rows += [(9 * K, 6, h, name, B) for name, B in edge_forms(h).items()]
        for K, part in enumerate(self.parts):
            rows += [(9 * K, 3, part, name, B) for name, B in vertex_forms().items()]
        forms = table(
            FORM,
            *(
                (p, m, size * self.stiffness[name], _strain(q, p, m, B, np.empty((6, 3))), B)
                for p, m, size, name, B in rows
            ),
        )
        return potential_of(_form_energy, forms, 17, strains=(forms.size, 1))

    def system(self, *loads):
        """The rod under loads."""
        mask = np.zeros(self.at_rest.size, bool)
        mask[self.held] = True
        mass = np.repeat(self.masses.ravel(), 3)[:, None]
        q = self.at_rest.ravel()
        space = RodSpace(SPATIAL, q, displacements=False, rounded=np.zeros_like(q))
        return MechanicalSystem(self.energy(), loads, FixedDofs(mask), space, lambda: mass)

    def pulled(self, vertex, force):
        """A dead force (3,) at a vertex."""
        forces = np.zeros_like(self.at_rest)
        forces[vertex, 0] = force
        return dead(forces.ravel())

    def angular_momentum(self, q, v):
        """About the origin, (3,)."""
        return (self.masses[..., None] * np.cross(q.reshape(-1, 3, 3), v.reshape(-1, 3, 3))).sum(
            axis=(0, 1)
        )


def straight(vertices, length=1.0, *, clamped=False, **more):
    """A rod from the origin along the third axis, its directors along the first two."""
    at_rest = np.zeros((vertices, 3, 3))
    at_rest[:, 0, 2] = np.linspace(0, length, vertices)
    at_rest[:, 1, 0] = at_rest[:, 2, 1] = 1.0
    held = np.arange(9) if clamped else np.empty(0, int)
    return SpatialRod(at_rest, held=held, **more)


def arch(vertices, rise, turned, **more):
    """A flat circular arch of unit span, clamped at both ends, the first director outwards, turned as a whole."""
    half = 2 * np.arctan(2 * rise)
    radius = 0.5 / np.sin(half)
    angle = np.linspace(-half, half, vertices)
    out = np.column_stack([np.cos(angle), np.zeros(vertices), np.sin(angle)])
    across = np.broadcast_to([0.0, 1.0, 0.0], out.shape)
    at_rest = np.stack([radius * out, out, across], axis=1) @ turned.T
    n = at_rest.size
    return SpatialRod(at_rest, held=np.r_[0:9, n - 9 : n], **more)
