"""How the stretches of an instant move with parameters: by the tangent of its equations, without another solve.

derived: an instant solves R(u, s) = 0 for the stretches u at the points of its mesh, whatever the step s of a
parameter.  `Numbers` are all that R is made of, and their derivatives come from differences of the numbers alone.  The
points of the mesh keep their fractions of the parts of the body, so they move with the fronts; the rates of a
`Profile` are those at moving points.  A value at a fixed place changes at its rate less its slope times the rate of
the point.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError
from cosserat.peristalsis import equation_rates
from cosserat.peristalsis.body import Piece, spans
from cosserat.peristalsis.crawler import Crawler, Loads
from cosserat.peristalsis.gait import Instant
from cosserat.peristalsis.instant import Common, InstantEquation, InstantProblem
from cosserat.peristalsis.profile import Profile
from cosserat.peristalsis.region import Region, merged
from cosserat.solvers.elements import Mesh
from cosserat.solvers.regions import Change, moved
from cosserat.solvers.slopes import slope

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
_ROUGH = 1e-6  # of the largest derivative of a number, above which its error says that there is none


@dataclass(frozen=True)
class Layout:
    """Where loads act at I instants, on S parts of the body in all.

    begins, ends : (S,) of the parts, fractions of the length.
    lengths : (S,) of the regions that they lie in.  advances : (S,) whether these advance.
    sequences : of regions, whose loads are those of some instant.  region : (S,) number of the region of each part
    among those of all sequences.  anchors : (I,) fractions of the length.  times : (I,) in the stride [s].
    """

    begins: Array
    ends: Array
    lengths: Array
    advances: NDArray[np.bool_]
    sequences: tuple[tuple[Region, ...], ...]
    region: Ints
    anchors: Array
    times: Array

    @classmethod
    def of(cls, instants: Sequence[Instant], pieces: tuple[Piece, ...]) -> Layout:
        """Of the instants of a body with these pieces."""
        first: dict[tuple[Any, ...], tuple[int, tuple[Region, ...]]] = {}
        parts, count = [], 0
        for instant in instants:
            regions = merged(instant.regions)
            states = tuple(r.state for r in regions)
            if states not in first:
                first[states] = count, regions
                count += len(regions)
            found = spans(regions, pieces)
            own = [(regions[s.region], first[states][0] + s.region) for s in found]
            parts += [
                (s.left, s.right, r.right - r.left, r.load == "advancing", number)
                for s, (r, number) in zip(found, own, strict=True)
            ]
        begins, ends, lengths, advances, region = np.array(parts).T
        return cls(
            begins,
            ends,
            lengths,
            advances > 0,
            tuple(regions for _, regions in first.values()),
            region.astype(np.int64),
            np.array([m.anchor for m in instants]),
            np.array([m.time for m in instants]),
        )


class Numbers(NamedTuple):
    """The numbers that the equations of I instants are made of, S parts of the body in all.

    begins, ends, anchors, times : of `Layout`.  force, pressure, exponent : (S,) of `instant.Local`.
    pieces : (P, 10) of `body.tabulated`.  stiffness : g or i.  weight : m.  p : k_P / k_S.
    body : length and radius [m], k_I [N] and k_G / l_0^2 [N] of an incompressible body, A [m^2].
    duration : of a stride [s].
    """

    begins: Array
    ends: Array
    force: Array
    pressure: Array
    exponent: Array
    anchors: Array
    times: Array
    pieces: Array
    stiffness: Array
    weight: Array
    p: Array
    body: Array
    duration: Array

    @classmethod
    def of(cls, layout: Layout, body: Crawler, loads: Loads, duration: float) -> Numbers:
        """Of a body under loads at some instants."""
        common = Common.of(body, loads)
        groups = common.groups
        acting = [common.acting(regions) for regions in layout.sequences]
        force, pressure = (np.concatenate([own[side] for own in acting]) for side in (0, 1))
        exponents = layout.advances & common.has_exponents
        return cls(
            layout.begins,
            layout.ends,
            force[layout.region],
            pressure[layout.region],
            np.where(exponents, layout.lengths, 1.0),
            layout.anchors,
            layout.times,
            common.table,
            np.array(groups.stiffness),
            np.array(common.weight),
            np.array(groups.p),
            _of_body(body, groups.incompressible),
            np.array(duration),
        )

    def part(self, spans: slice) -> Numbers:
        """The numbers of one instant; rates have a first axis more."""
        return self._replace(
            begins=self.begins[..., spans],
            ends=self.ends[..., spans],
            force=self.force[..., spans],
            pressure=self.pressure[..., spans],
            exponent=self.exponent[..., spans],
        )


def _of_body(body: Crawler, incompressible: bool) -> Array:
    k_i, k_g = body.incompressible_stiffnesses if incompressible else (0.0, 0.0)
    return np.array([body.length, body.radius, k_i, k_g / body.length**2, body.area])


def numbers_rate(at: Callable[[float], Numbers]) -> Numbers:
    """How numbers change with the step of a parameter; at : the numbers after a step.

    Raises
    ------
    InputError : they do not change smoothly, or the parameter is at an end of its range.
    """
    base = at(0.0)
    sizes = [float(np.abs(own).max(initial=0.0)) or 1.0 for own in base]

    def values(step: float) -> Array:
        found = base if step == 0.0 else at(step)
        if any(one.shape != own.shape for one, own in zip(found, base, strict=True)):
            raise InputError(
                "neighbouring regions with equal loads are one, and come apart with it; let their loads differ a bit"
            )
        return np.concatenate([one.ravel() / size for one, size in zip(found, sizes, strict=True)])

    found = slope(values, float(np.finfo(float).eps))
    if found.relative > _ROUGH or found.kink.any():
        raise InputError("its body, fronts or loads do not change smoothly with the parameter")
    cuts = np.cumsum([own.size for own in base])[:-1]
    parts = zip(np.split(found.value, cuts), base, sizes, strict=True)
    return Numbers(*((rate * size).reshape(own.shape) for rate, own, size in parts))


def stacked(rates: Sequence[Numbers]) -> Numbers:
    """The rates by several parameters, with a first axis for these."""
    return Numbers(*(np.stack(parts) for parts in zip(*rates, strict=True)))


@dataclass(frozen=True)
class ProfileRates:
    """How a profile moves with J parameters at points of its mesh that move too.

    z : (J, M, p + 1) of the points.  mu, slope : (J, M, p + 1, 2).  mu_3, multiplier : (J, M, p + 1).
    along : (J, M, p + 1) of the distances along the ground from the rear end [m].
    """

    z: Array
    mu: Array
    slope: Array
    mu_3: Array
    multiplier: Array
    along: Array


def profile_rates(
    problem: InstantProblem, profile: Profile, nodal: Array, along: Array, rates: Numbers
) -> ProfileRates | None:
    """The rates of the profile that solves an instant; None where the equations are singular.

    nodal : (nodes, 2) its solution.  along : (M, p + 1) distances along the ground [m].
    rates : of the numbers of this instant, by J parameters.
    """
    mesh, equation = profile.mesh, InstantEquation(problem, profile.mesh)
    z = _places(problem, mesh, rates)
    sizes = z[..., -1] - z[..., 0]
    rows = _rows(problem, equation, z, rates)
    source, mu_3, multiplier = _source(equation, profile, rows, rates.p)
    weight = None if equation.weight is None else rows[:, 5].reshape(z.shape)
    change = Change(source, sizes, weight)
    found = moved(mesh, equation, nodal, equation.weight, change)
    if found is None:
        return None
    mu = np.stack([mesh.split(one) for one in found])
    relative = sizes / mesh.sizes
    slope = np.stack([mesh.slope(one) for one in mu]) - relative[..., None, None] * profile.slope
    mu_3, multiplier = _followed(equation, profile, mu, mu_3, multiplier)
    whole = _along(problem, profile, along, (slope, mu_3, rows[:, 6].reshape(z.shape), relative), rates)
    return ProfileRates(z, mu, slope, mu_3, multiplier, whole)


def _places(problem: InstantProblem, mesh: Mesh, rates: Numbers) -> Array:
    """Rates of the points of the mesh, (J, M, p + 1): they keep their fractions of the parts of the body."""
    begins, ends = problem.span_ends.T
    fraction = (mesh.places - begins[mesh.region, None]) / (ends - begins)[mesh.region, None]
    first, length = rates.begins, rates.ends - rates.begins
    found: Array = first[:, mesh.region, None] + fraction * length[:, mesh.region, None]
    return found


def _rows(problem: InstantProblem, equation: InstantEquation, z: Array, rates: Numbers) -> Array:
    """Rates of the terms of the equations, (J, 7, K)."""
    groups, mesh = problem.groups, equation.mesh
    rows: Array = equation_rates.local_rates(
        mesh.places.ravel(),
        z.reshape(len(z), -1),
        equation.span,
        problem.of_spans,
        np.stack([rates.force, rates.pressure, rates.exponent], axis=1),
        problem.span_pieces,
        problem.common.table,
        rates.pieces,
        (groups.stiffness, problem.common.weight),
        np.stack([rates.stiffness, rates.weight], axis=1),
        not groups.incompressible,
    )
    return rows


def _source(
    equation: InstantEquation, profile: Profile, rows: Array, p_rate: Array
) -> tuple[Array, Array, Array]:
    """Rates of f, mu_3 and lambda_c while the stretches are fixed: (J, M, p + 1, 2), (J, M, p + 1) twice."""
    groups, shape = equation.instant.groups, (len(rows), *profile.mu_3.shape)
    mu, local = profile.mu.reshape(-1, 2), np.array(equation.local)
    if groups.incompressible:
        far = np.ones(len(mu))
        for number, node in equation.far:
            far[equation.span == number] = equation.node_value(profile.mu, node).prod()
        multiplier = equation_rates.multiplier_rates(mu, local, rows, far)
        f = equation_rates.incompressible_rates(mu, multiplier, rows, groups.printed_contact)
        return f.reshape(*shape, 2), np.zeros(shape), multiplier.reshape(shape)
    f, mu_3 = equation_rates.compressible_rates(
        mu, local, rows, groups.p, p_rate, groups.printed_contact
    )
    return f.reshape(*shape, 2), mu_3.reshape(shape), np.zeros(shape)


def _followed(
    equation: InstantEquation, profile: Profile, mu: Array, mu_3: Array, multiplier: Array
) -> tuple[Array, Array]:
    """Rates of mu_3 and lambda_c with those of the stretches, mu (J, M, p + 1, 2)."""
    if not profile.incompressible:
        return mu_3 - equation.instant.groups.p * mu.sum(axis=-1), multiplier
    relative = (mu / profile.mu).sum(axis=-1)  # of mu_1 mu_2
    exponent = equation.local.exponent.reshape(profile.mu_3.shape)
    followed = multiplier - exponent * profile.multiplier * relative
    for number, node in equation.far:
        at_junction = equation.node_value(relative[..., None], node)[:, 0]
        inside = equation.mesh.region == number
        change = (exponent - 1) * profile.multiplier * at_junction[:, None, None]
        followed[:, inside] += change[:, inside]
    return -profile.mu_3 * relative, followed


def _along(
    problem: InstantProblem,
    profile: Profile,
    along: Array,
    moving: tuple[Array, Array, Array, Array],
    rates: Numbers,
) -> Array:
    """Rates of the distances along the ground, eqs. (2.5.6), (2.5.8).

    moving : rates of the slopes, of mu_3, of the radius over that of the body, and relative ones of element lengths.
    """
    slope, mu_3, radius, relative = moving
    length, wide = problem.body.length, problem.body.radius
    by_length = (rates.body[:, 0] / length)[:, None, None]
    own = radius * wide + profile.radius * (rates.body[:, 1] / wide)[:, None, None]
    tilt = profile.slope[..., 0] * profile.radius / length
    tilt_rate = (
        slope[..., 0] * profile.radius + profile.slope[..., 0] * own
    ) / length - tilt * by_length
    integrand = np.sqrt(profile.mu_3**2 - tilt**2)
    changed = (profile.mu_3 * mu_3 - tilt * tilt_rate) / integrand + relative[..., None] * integrand
    found = np.stack([profile.mesh.cumulative(one) for one in changed])
    return found * length + along * by_length
