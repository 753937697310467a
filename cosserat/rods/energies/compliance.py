"""Stiffnesses of the consistent rod where its section or material varies within an edge: compliances add up along it.

derived: along an edge the tension and, in a mesh that resolves the layers of the section stretch, that stretch w are
nearly constant, while the axial strain is not.  With a(s) = 2 mu A, b(s) = Lambda A and c = a + b, and q(s) of the
section, 2 mu A too if it is of one material, the energy per length, least over all axial strains of the mean e, is

    alpha/2 e^2 + alpha <b/c> e w + (<b> + <q> - <b^2/c> + alpha <b/c>^2) w^2 / 2,      1/alpha = <1/c>,

which is that of an edge with 2 mu A = alpha <a/c> and Lambda A = alpha <b/c> whose vertices have <a b/c> - alpha <a/c>
<b/c> more than their own q.  Shearing and bending add up their compliances alike.

If the height varies and the centreline is not in the middle, the area centres lie off it by e(s).  The moment about
an axis at E is nearly constant along the edge, m say, and the curvature is (m + n (e - E)) / EI under the tension n.
With E = <e/EI> / <1/EI> the mean curvature is m <1/EI>, and the mean strain of that axis is

    n <1/c + (e - E)^2/EI> - <b/c> w,

so tension and bending do not couple at E, and 1/alpha has <(e - E)^2/EI> more.  The rest stays as it is.

Means are along the line of the area centres, which in a rod of curvature K has the length 1 - K e per length of the
centreline.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.elasticity import Along
from cosserat.rods.reference import to_vertices
from cosserat.rods.variation import Scales, Station, mean, vertex_cuts

Array = NDArray[np.float64]


class EdgeStiffnesses(NamedTuple):
    """axial 2 mu A, volume Lambda A, shear k mu A, bending EI, stretch_gradient mu I: (N - 1,); section 2 mu A: (N,).

    The fourth and fifth in N m^2, the others in N.  axis : (N - 1,) E over the offset of the nominal section [1].
    length : (N - 1,) of the line of the area centres, per length of the centreline [1].
    """

    axial: Array
    volume: Array
    shear: Array
    bending: Array
    stretch_gradient: Array
    section: Array
    axis: Array
    length: Array


def stiffnesses(
    stations: Sequence[Station],
    arc: Array,
    along: Along,
    *,
    offset: float = 0.0,
    curvature: Array | float = 0.0,
) -> EdgeStiffnesses:
    """Stiffnesses of a rod whose nominal section and material vary along its stations.

    arc : (N,) arc length of the vertices [m].  along : stiffnesses at places, about the area centres.
    offset : of the nominal area centre from the centreline [m].  curvature : of the reference
    on every edge, or one for all [1/m].
    """
    first_height = stations[0].height if stations else 1.0
    lift = np.full(arc[..., 1:].shape, curvature * offset)
    lifted = bool(lift.any())

    def on_edges(s: Scales, _: Array) -> Array:
        axial, volume, _, shear, bending, gradient = along(s)
        both, higher = axial + volume, s.height - first_height
        ratios = [1 / both, axial / both, volume / both, axial * volume / both]
        inverses = [1 / shear, 1 / bending, 1 / gradient]
        every = [*ratios, *inverses, higher / bending, higher * higher / bending, higher]
        sums = np.stack(np.broadcast_arrays(*every))
        return np.concatenate([sums, s.height * sums]) if lifted else sums

    def across(s: Scales, _: Array) -> Array:
        own = along(s).section
        return np.array([own, s.height * own]) if lifted else own[None]

    means, edge, cuts = mean(stations, on_edges, arc), np.diff(arc), vertex_cuts(arc)
    length, parts = np.ones(edge.shape), np.diff(cuts)
    if lifted:
        plain, raised = np.split(means, 2)
        length = 1 - lift * (first_height + plain[-1])
        means = (plain - lift * raised) / length
    compliance, axial, volume, product, shear, bending, gradient, lever, square, _ = means
    alpha = 1 / (compliance + offset * offset * (square - lever * lever / bending))
    axis = first_height + lever / bending
    own = mean(stations, across, cuts)
    section = own[0] - to_vertices(edge * lift) / parts * own[1] if lifted else own[0]
    section = section + to_vertices((product - alpha * axial * volume) * length * edge) / parts
    return EdgeStiffnesses(
        alpha * axial, alpha * volume, 1 / shear, 1 / bending, 1 / gradient, section, axis, length
    )
