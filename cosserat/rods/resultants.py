"""Internal forces of the planar rod, the same way for every energy: from the gradient of its strain energy alone.

Let W be the strain energy, cut edge K, and move all that is beyond the cut:

    a translation   n_K = sum over J > K of dW/dx_J,
    a rotation      M_K = sum over J > K of (x_J - c_K) x dW/dx_J + d_J x dW/dd_J,        c_K the middle of edge K.

derived: n_K and M_K are the force and the couple with which the part beyond the cut acts on the part before it, at
rest and in motion.  At rest n' + f = 0 and M' + x' x n + l = 0 follow, eqs. (1.2.71), (1.2.88).  For a rod in the plane
a x b is a_3 b_2 - a_2 b_3, positive from E3 towards E2.

The normal force N and the shear force Q are the components of n along the normal of the section and along the section,
as Reissner (ZAMP 23, 795, 1972) has them; the section of an edge is the mean of the unit directors of its two vertices.
So N > 0 is tension, Q > 0 pushes what is before the cut along its director, and M > 0 bends from E3 towards E2, as the
curvature is positive.  In a rod that is nearly straight M' = -Q.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cosserat.solvers.potential import Potential

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Resultants:
    """Internal forces of the edges, at their middles.

    force : (..., N - 1, 2) n [N].  normal, shear : (..., N - 1) its components N and Q [N].
    moment : (..., N - 1) M about the centreline [N m].
    """

    force: Array
    normal: Array
    shear: Array
    moment: Array


def cross(a: Array, b: Array) -> Array:
    """a x b of vectors (..., 2), positive from E3 towards E2: (...,)."""
    product: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def resultants(vectors: Array, gradient: Array) -> Resultants:
    """The internal forces of states.

    vectors : (..., N, m, 2) positions and directors [m].  gradient : (..., N, m, 2) of the strain energy by them [N].

    The moments are summed from edge to edge, with arms of one edge: sums about one point would cancel.
    """
    x, d = vectors[..., 0, :], vectors[..., 1, :]
    middle = (x[..., 1:, :] + x[..., :-1, :]) / 2
    force = _beyond(gradient[..., 0, :], axis=-2)[..., 1:, :]
    couple = cross(vectors[..., 1:, :], gradient[..., 1:, :]).sum(axis=-1)
    own = couple[..., 1:] + cross(x[..., 1:, :] - middle, gradient[..., 1:, 0, :])
    own[..., :-1] += cross(np.diff(middle, axis=-2), force[..., 1:, :])
    across = section_directions(d)
    normal = np.stack([across[..., 1], -across[..., 0]], axis=-1)
    return Resultants(
        force, (force * normal).sum(axis=-1), (force * across).sum(axis=-1), _beyond(own, axis=-1)
    )


def section_directions(d: Array) -> Array:
    """Unit vectors (..., N - 1, 2) along the sections of the edges, half-way between the directors (..., N, 2)."""
    unit = d / np.linalg.norm(d, axis=-1)[..., None]
    both = unit[..., 1:, :] + unit[..., :-1, :]
    direction: Array = both / np.linalg.norm(both, axis=-1)[..., None]
    return direction


def _beyond(values: Array, axis: int) -> Array:
    """Sums of the values from each place to the end."""
    sums: Array = np.flip(np.cumsum(np.flip(values, axis), axis), axis)
    return sums


def strain_gradients(energy: Potential, q: Array) -> Array:
    """The gradient of the strain energy at each of some states (S, n): (S, n) [N]."""
    gradient = np.zeros_like(q)
    for state, row in zip(q, gradient, strict=True):
        energy.add_gradient(state, energy.history, row)
    return gradient


def contact_director_forces(energy: Potential, between: Sequence[str], q: Array, m: int) -> Array:
    """The contact director force m of every edge, eq. (1.2.77), at states q of shape (S, n): (S, N - 1, 2) [N].

    between : fields of the constants with the stiffnesses of the terms of one edge that couple its two directors.
    m : number of vectors of a vertex.

    derived: an edge whose energy is V(d_K, d_(K+1)) does work with m = (dV/dd_(K+1) - dV/dd_K) / 2 on the difference of
    its directors, and with dV/dd_K + dV/dd_(K+1) on their mean.  The edges with even and with odd numbers, each alone,
    share no director.
    """
    vertices = energy.constants.size
    forces = np.empty((q.shape[0], vertices - 1, 2))
    for parity in (0, 1):
        constants = energy.constants.copy()
        for name in constants.dtype.names or ():
            if name in between:
                constants[name][1 - parity :: 2] = 0.0
            elif name.startswith("k"):
                constants[name] = 0.0
        by_director = strain_gradients(replace(energy, constants=constants), q).reshape(
            -1, vertices, m, 2
        )
        low, high = by_director[:, :-1, 1], by_director[:, 1:, 1]
        forces[:, parity::2] = ((high - low) / 2)[:, parity::2]
    return forces


def intrinsic_director_forces(contact: Array, by_director: Array) -> Array:
    """The intrinsic director force of the part round each vertex, eq. (1.2.78): (..., N, 2) [N].

    contact : (..., N - 1, 2) contact director forces.  by_director : (..., N, 2) dW/dd.

    derived: the balance (1.2.82) of a part is m_K - m_(K-1) - k_K + P_ext = L', and that of the discrete rod is
    P_ext - dW/dd = L', eqs. (3.3.36), (3.4.7); so k is dW/dd and the difference of m, which is zero beyond both ends.
    """
    none = np.zeros_like(contact[..., :1, :])
    change = np.diff(np.concatenate([none, contact, none], axis=-2), axis=-2)
    return by_director + change
