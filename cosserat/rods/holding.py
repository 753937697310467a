"""What the constraints of a rod hold: a mask of degrees of freedom (DOFs), and frames of vectors held obliquely."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.constraints import Constraint
from cosserat.rods.kinematics import Kinematics
from cosserat.rods.places import vertex_at
from cosserat.solvers.banded import Mask, Vector, band_product
from cosserat.solvers.frames import Frame
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
_ALIKE = 1e-10  # sine of the angle below which two directions are the same
_UNHELD = 1e-10  # fraction of a rigid motion below which nothing holds it
_ROUND_OFF = 1e-12  # fraction of its terms below which a force of a rigid motion is round-off


def held_components(
    constraints: Iterable[Constraint], arc: Array, D: Array, kinematics: Kinematics
) -> tuple[Mask, Frame]:
    """The constrained DOFs (n,), in frames that have an axis along the one direction in which a vector is held.

    arc : (N,) arc length of the vertices [m].  D : (N, 2) their directors [m].
    """
    mask = np.zeros(arc.size * kinematics.per_vertex, dtype=np.bool_)
    directions: dict[int, list[Array]] = {}
    for item in constraints:
        vertex = vertex_at(item.at, arc)
        for vector, direction in item.holds(D[vertex]):
            first = vertex * kinematics.per_vertex + 2 * kinematics.vectors.index(vector)
            directions.setdefault(first, []).append(direction)
    oblique: dict[int, Array] = {}
    for first, along in directions.items():
        one = along[0]
        if any(abs(one[0] * other[1] - one[1] * other[0]) > _ALIKE for other in along):
            mask[first : first + 2] = True
            continue
        axis = int(abs(one[1]) > abs(one[0]))
        mask[first + axis] = True
        if abs(one[1 - axis]) > _ALIKE:
            oblique[first] = (one if axis == 0 else np.array([one[1], -one[0]])) * np.sign(one[axis])
    return mask, Frame.of(oblique)


def free_motions(system: MechanicalSystem) -> Array:
    """How free of supports and attachments each rigid motion from the reference is, from 0 to 1, (k,)."""
    at_rest = system.space.reference
    motions = system.space.rigid_motions(at_rest)
    rows = [motions[:, system.constrained] / np.abs(motions).max(axis=1)[:, None]]
    if system.attached:
        rows.append(_resisted(system, at_rest, motions))
    _, size, directions = np.linalg.svd(np.hstack(rows).T, full_matrices=True)
    size = np.append(size, np.zeros(motions.shape[0] - size.size))
    left: Array = np.abs(directions[size < _UNHELD]).max(axis=0, initial=0.0)
    return left


def _resisted(system: MechanicalSystem, at_rest: Vector, motions: Array) -> Array:
    """Forces of the attachments against each rigid motion, scaled to at most one for each DOF, (k, DOFs)."""
    band = np.zeros((at_rest.size, system.half_bandwidth + 1))
    for potential in system.attached:
        potential.add(at_rest, potential.history, np.zeros_like(at_rest), band)
    motions = motions / np.abs(motions).max(axis=1)[:, None]
    forces = np.array([band_product(band, motion) for motion in motions])
    terms = np.array([band_product(np.abs(band), np.abs(motion)) for motion in motions])
    size = np.abs(forces).max(axis=0)
    felt = size > _ROUND_OFF * terms.max(axis=0)
    scaled: Array = forces[:, felt] / size[felt]
    return scaled
