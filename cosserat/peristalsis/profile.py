"""The stretches of one instant along the body, and the tilt of its centreline."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import OutOfReachError
from cosserat.peristalsis.crawler import Crawler
from cosserat.solvers.elements import Mesh

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Profile:
    """The stretches of one instant at the points of a mesh over [0, 1].

    mu, slope : (M, p + 1, 2) mu_1, mu_2 and their derivatives in z = xi / l_0.  mu_3 : (M, p + 1).
    multiplier : (M, p + 1) lambda_c of eq. (2.4.12); zero if compressible.  effort : iterations, or nodes of solve_bvp.
    radius : (M, p + 1) of the resting body [m].
    incompressible : whether mu_1 mu_2 mu_3 = 1, eq. (2.4.1).
    """

    mesh: Mesh
    mu: Array
    slope: Array
    mu_3: Array
    multiplier: Array
    radius: Array
    effort: int
    incompressible: bool

    def at(self, z: Array) -> tuple[Array, Array, Array, Array]:
        """mu (K, 2), slope (K, 2), mu_3 (K,) and multiplier (K,) at given places.

        The stretches and n = lambda_c mu_1 mu_2, constant in balance, are interpolated.  mu_3 and lambda_c follow from
        them, so (2.4.1) holds to round-off there too.
        """
        columns = np.empty((*self.mu_3.shape, 6))
        columns[..., :2], columns[..., 2:4], columns[..., 4] = self.mu, self.slope, self.mu_3
        columns[..., 5] = self.multiplier * (self.mu[..., 0] * self.mu[..., 1])
        found = self.mesh.interpolate(columns, z)
        mu, slope, mu_3, force = found[:, :2], found[:, 2:4], found[:, 4], found[:, 5]
        volume = mu[:, 0] * mu[:, 1]
        return mu, slope, 1 / volume if self.incompressible else mu_3, force / volume


def check_tilt(profile: Profile, body: Crawler, name: str) -> float:
    """The largest R mu_1' / mu_3, the sine of the tilt of the centreline, eq. (2.5.5).

    Raises
    ------
    OutOfReachError : it reaches one: (2.5.6) has no root there.
    """
    sine = np.abs(profile.slope[..., 0]) * (profile.radius / body.length) / profile.mu_3
    largest = float(sine.max())
    if not largest < 1:
        place = profile.mesh.places.ravel()[int(sine.argmax())] * body.length
        raise OutOfReachError(
            f"{name}: R mu_1' / mu_3 reaches {largest:.3g} at xi = {place:.4g} m, where eq. (2.5.6) has no root: the "
            "surface cannot stay on the ground; take weaker loads or a thinner body"
        )
    return largest
