"""How a pose moves with parameters at fixed places of the body: the fields of its sections, and its anchors."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from cosserat.peristalsis.body import Piece, Scales, piece_at, scales_at
from cosserat.peristalsis.ground import Pose
from cosserat.peristalsis.rates import Numbers, ProfileRates

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_ON_EDGE = 1e-9  # a section nearer to a front, as a fraction of the length, lies on it
_JUMP = 1e-6  # of the largest value or slope, below which a jump at a front is round-off
_ALONG, _MU, _SLOPE, _MU_3, _FORCE = 0, slice(1, 3), slice(3, 5), 5, 6


class MovedPose:
    """A pose and its rates by J parameters.

    numbers : rates of the numbers of its instant.  columns : (M, p + 1, C) what is interpolated between its points:
    the distance along the ground and, if it is `whole`, mu_alpha, their slopes, mu_3 and n = lambda_c mu_1 mu_2.
    slopes : their derivatives.  rates : (J, M, p + 1, C) at fixed places.
    """

    def __init__(self, pose: Pose, moved: ProfileRates, numbers: Numbers, *, whole: bool) -> None:
        self.pose, self.numbers, self.mesh = pose, numbers, pose.profile.mesh
        self.columns, at_points = pose.along[..., None], moved.along[..., None]
        if whole:
            self.columns, at_points = _columns(pose, moved)
        self.slopes = self.mesh.slope(self.columns)
        self.rates = at_points - self.slopes * moved.z[..., None]
        self.points = moved.z

    def along_rate(self, place: float, place_rate: Array) -> Array:
        """Rate (J,) of the distance along the ground to a place that moves through the body at the rate (J,) [m]."""
        fields = np.stack([self.slopes[..., _ALONG], *self.rates[..., _ALONG]], axis=-1)
        found = self.mesh.interpolate(fields, np.array([place]))[0]
        return np.asarray(found[1:] + found[0] * place_rate)

    def at(self, z: Array) -> tuple[Array, Array, Mask]:
        """Columns (K, C) at places z, their rates (J, K, C), and where those have a kink (J, K, C)."""
        every = np.concatenate([self.columns[None], self.rates])
        found = self.mesh.interpolate(np.moveaxis(every, 0, 2), z)
        rates = np.moveaxis(found, 1, 0)
        return rates[0], rates[1:], self._kinks(z)

    def _kinks(self, z: Array) -> Mask:
        """Where a front passes a place and the column or its slope jumps there, (J, K, C)."""
        columns = self.columns.shape[-1]
        kinks = np.zeros((len(self.rates), z.size, columns), dtype=np.bool_)
        for e in np.flatnonzero(np.diff(self.mesh.region)):
            here = np.abs(z - self.mesh.ends[e + 1]) < _ON_EDGE
            passes = self.points[:, e, -1] != 0
            if not (here.any() and passes.any()):
                continue
            jumps = np.zeros(columns, dtype=np.bool_)
            for own in (self.columns, self.slopes):
                jumps |= np.abs(own[e + 1, 0] - own[e, -1]) > _JUMP * np.abs(own).max(axis=(0, 1))
            kinks |= passes[:, None, None] & here[None, :, None] & jumps
        return kinks


def _columns(pose: Pose, moved: ProfileRates) -> tuple[Array, Array]:
    """All columns, and their rates at points that move."""
    profile = pose.profile
    volume, lam = profile.mu.prod(axis=-1), profile.multiplier
    relative = (moved.mu / profile.mu).sum(axis=-1)
    force_rate = (moved.multiplier + lam * relative) * volume
    columns = (pose.along, profile.mu, profile.slope, profile.mu_3, lam * volume)
    rates = (moved.along, moved.mu, moved.slope, moved.mu_3, force_rate)
    return _joined(*columns), _joined(*rates)


def _joined(along: Array, mu: Array, slope: Array, mu_3: Array, force: Array) -> Array:
    return np.concatenate([along[..., None], mu, slope, mu_3[..., None], force[..., None]], axis=-1)


Rated = tuple[Array, Mask]
"""Rates of a field and where it has a kink, both (J, K)."""


class SectionFields:
    """The stored fields of a moved pose at K places z, by name; all but "along" need a `whole` one."""

    def __init__(self, moved: MovedPose, z: Array) -> None:
        self.body, self.numbers, self.z = moved.pose.problem.body, moved.numbers, z
        self.incompressible = moved.pose.profile.incompressible
        self.values, self.rates, self.kinks = moved.at(z)
        self.mu = self.values[:, _MU]
        self.volume = self.mu.prod(axis=-1)
        self.relative = (self.rates[..., _MU] / self.mu).sum(axis=-1)  # of mu_1 mu_2

    def named(self, names: set[str]) -> Mapping[str, Rated]:
        """Those of the names that there are."""
        return {name: form(self) for name, form in _FORMS.items() if name in names}

    def _along(self) -> Rated:
        return self._column(_ALONG)

    def _mu_1(self) -> Rated:
        return self._column(_MU.start)

    def _mu_2(self) -> Rated:
        return self._column(_MU.start + 1)

    def _column(self, number: int) -> Rated:
        return self.rates[..., number], self.kinks[..., number]

    def _slope(self) -> Rated:
        rates, kinks = self._column(_SLOPE.start)
        length, by_length = self.body.length, self.numbers.body[:, :1]
        return (rates - self.values[:, _SLOPE.start] * by_length / length) / length, kinks

    def _mu_3(self) -> Rated:
        if not self.incompressible:
            return self._column(_MU_3)
        return -self.relative / self.volume, self.kinks[..., _MU.start]  # (2.4.1)

    def _height(self) -> Rated:
        """(2.5.7)."""
        scales, rates = scale_rates(self.body.pieces, self.numbers.pieces, self.z)
        radius = rates[0] * self.body.radius + scales.radius * self.numbers.body[:, 1:2]
        own, kinks = self._column(_MU.start)
        return own * (scales.radius * self.body.radius) + radius * (self.mu[:, 0] - 1), kinks

    def _pressure(self) -> Rated:
        """(e k_I (2 - mu_1 - mu_2) mu_1 mu_2 - n G / r^2) / A, (2.8.8), (2.8.9); G is k_G / l_0^2.

        r and e are radius and modulus of the section over those of the body.
        """
        scales, (radius_rate, young_rate) = scale_rates(self.body.pieces, self.numbers.pieces, self.z)
        k_i, k_g = self.body.incompressible_stiffnesses
        stiffness, area = k_g / self.body.length**2, self.body.area
        k_i_rate, stiffness_rate, area_rate = np.moveaxis(self.numbers.body[:, 2:], 1, 0)[..., None]
        force, force_rate = self.values[:, _FORCE], self.rates[..., _FORCE]
        left = 2 - self.mu.sum(axis=-1)
        pulled = force * stiffness / scales.radius**2
        pulled_rate = (force_rate * stiffness + force * stiffness_rate) / scales.radius**2
        pulled_rate -= 2 * pulled * radius_rate / scales.radius
        swollen = scales.young * k_i * left * self.volume
        swollen_rate = (young_rate * k_i + scales.young * k_i_rate) * left * self.volume
        swollen_rate += swollen * self.relative
        swollen_rate -= scales.young * k_i * self.rates[..., _MU].sum(axis=-1) * self.volume
        total_rate = swollen_rate - pulled_rate
        return (total_rate - (swollen - pulled) * area_rate / area) / area, self.kinks[..., _FORCE]


_FORMS: Mapping[str, Callable[[SectionFields], Rated]] = {
    "along": SectionFields._along,
    "mu_1": SectionFields._mu_1,
    "mu_2": SectionFields._mu_2,
    "mu_1_slope": SectionFields._slope,
    "mu_3": SectionFields._mu_3,
    "height": SectionFields._height,
    "p_coelom": SectionFields._pressure,
}
OF_STRETCHES = frozenset(_FORMS) - {"along"}
"""Fields that need the stretches of a moved pose."""


def scale_rates(pieces: Sequence[Piece], rates: Array, z: Array) -> tuple[Scales, Array]:
    """Scales at fixed places z (K,), and the rates (2, J, K) of radius and modulus.

    rates : (J, P, 10) of the pieces as `body.tabulated` gives them.
    """
    number = piece_at(pieces, z)
    scales = scales_at(pieces, number, z)
    left, right = (np.array([getattr(p, side) for p in pieces])[number] for side in ("left", "right"))
    share, own = (z - left) / (right - left), rates[:, number]
    share_rate = -(own[..., 0] * (1 - share) + own[..., 1] * share) / (right - left)
    found = []
    for c, name in enumerate(("radius", "young")):
        rise = np.array([getattr(p.front, name) - getattr(p.rear, name) for p in pieces])[number]
        rear, front = own[..., 2 + c], own[..., 6 + c]
        found.append(rear + (front - rear) * share + rise * share_rate)
    return scales, np.array(found)
