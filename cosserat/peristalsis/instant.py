"""One instant of a crawler: anchoring and advancing loads in consecutive regions, and the stretches they cause.

Conditions, the same for both solvers: stretches and their slopes (hence m^alpha) are continuous where regions meet,
slopes vanish at the ends (2.3.13), and `crawler.Loads.advancing_force` gives n in advancing regions.  `body` has the
conditions where the body itself changes.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError, NotConvergedError
from cosserat.peristalsis import equations
from cosserat.peristalsis.body import UNIFORM, Ints, Piece, mean_square, spans, tabulated
from cosserat.peristalsis.crawler import Crawler, Groups, Incompressible, Loads
from cosserat.peristalsis.profile import Profile
from cosserat.peristalsis.region import Region, continued, merged
from cosserat.solvers.collocation import RegionSystem, collocate
from cosserat.solvers.elements import Mesh, graded
from cosserat.solvers.regions import RegionSettings, Remote, Source, solve

Array = NDArray[np.float64]

_MIN_STRETCH = 0.02  # a plateau with a stretch below this has collapsed


def holds_force(body: Crawler, loads: Loads) -> bool:
    """Whether advancing regions carry the force of the anchoring ones beside them."""
    default = "continuous" if isinstance(body.material, Incompressible) else "none"
    return (loads.advancing_force or default) == "continuous"


@dataclass(frozen=True)
class Common:
    """What all instants of a body under the same loads have in common.

    pieces : of the body; table : the same as `body.tabulated`.  weight : m where the radius is that of the body.
    """

    loads: Loads
    groups: Groups
    pieces: tuple[Piece, ...]
    table: Array
    weight: float
    holds_force: bool

    @classmethod
    def of(cls, body: Crawler, loads: Loads) -> Common:
        """Of a body under loads."""
        groups, pieces = Groups.of(body, loads), body.pieces
        weight = groups.m / mean_square(pieces)
        return cls(loads, groups, pieces, tabulated(pieces), weight, holds_force(body, loads))

    @property
    def has_exponents(self) -> bool:
        """Whether lambda_c in advancing regions is that of eq. (2.4.18) as printed."""
        return self.groups.incompressible and self.loads.multiplier == "printed"

    def strength(self, region: Region) -> float:
        """The force [N] or the pressure [Pa] of the muscles of a region."""
        usual = {"anchoring": self.loads.anchoring, "advancing": self.loads.advancing}.get(
            region.load, 0.0
        )
        return (usual if region.own is None else region.own) * region.amplitude

    def acting(self, regions: Sequence[Region]) -> tuple[list[float], list[float]]:
        """n and c in consecutive regions, in the units of `Local`."""
        groups = self.groups
        pulling = [groups.force_of(self.strength(r)) if r.load == "anchoring" else None for r in regions]
        if self.holds_force:
            pulling = continued(pulling)
        pushing = (groups.c_of(self.strength(r)) if r.load == "advancing" else 0.0 for r in regions)
        return [-(force or 0.0) for force in pulling], list(pushing)


class Local(NamedTuple):
    """What the equations have at K points, each (K,), with k_G and l_0 of the body itself as units.

    force : n over k_S of this place, or lambda_c mu_1 mu_2 l_0^2 / k_G.  pressure : c.  exponent : that of mu_1 mu_2.
    stiffness, weight : g or i, and m.  gradient : k_G over that of the body itself.  radius : likewise.
    """

    force: Array
    pressure: Array
    exponent: Array
    stiffness: Array
    weight: Array
    gradient: Array
    radius: Array


class InstantProblem:
    """One boundary value problem: a body, its loads, and the regions in which they act.

    common : that of the body under the loads, if it is known.
    span_ends : (S, 2) of its spans.  span_pieces : (S,) number of the piece of each.
    of_spans : (3, S) force, pressure and exponent of each in a body that does not vary.
    """

    def __init__(
        self,
        body: Crawler,
        loads: Loads,
        regions: Sequence[Region],
        name: str,
        common: Common | None = None,
    ) -> None:
        self.body, self.loads, self.name = body, loads, name
        self.common = common or Common.of(body, loads)
        self.groups, self.pieces = self.common.groups, self.common.pieces
        self.regions = regions = merged(regions)
        self.advancing = [r.load == "advancing" for r in regions]
        self.force, self.pressure = self.common.acting(regions)
        printed = self.common.has_exponents
        self.exponent = [r.right - r.left if printed and r.load == "advancing" else 1.0 for r in regions]
        self.spans = spans(regions, self.pieces)
        self.span_ends = np.array([(s.left, s.right) for s in self.spans])
        self.span_pieces = np.array([s.piece for s in self.spans])
        per_region = np.array([self.force, self.pressure, self.exponent])
        self.of_spans = per_region[:, [s.region for s in self.spans]]

    def local(self, span: Ints, z: Array) -> Local:
        """The equations at places z, each in the span of that number."""
        return Local(*self._rows(span, z))

    def _rows(self, span: Ints, z: Array) -> Array:
        """The same as an array (7, K)."""
        of_body = self.groups.stiffness, self.common.weight
        divided = not self.groups.incompressible
        rows: Array = equations.local_terms(
            z, span, self.of_spans, self.span_pieces, self.common.table, of_body, divided
        )
        return rows

    @property
    def plateaus(self) -> tuple[Array, float]:
        """mu_1, mu_2 far inside a long span, the mean of its ends, shape (S, 2), and the shortest length of decay.

        Raises
        ------
        InputError : the loads collapse a section.
        """
        mu, layer = self._homogeneous
        return (mu[:, 0] + mu[:, 1]) / 2, layer

    @functools.cached_property
    def _homogeneous(self) -> tuple[Array, float]:
        """mu_1, mu_2 of a long body with the loads and the section of either end of every span, shape (S, 2, 2)."""
        ends = self.span_ends.ravel()
        rows = self._rows(np.repeat(np.arange(len(self.spans)), 2), ends)
        groups = self.groups
        mu, mu_3, df, left = equations.homogeneous(
            rows, groups.p, groups.incompressible, groups.printed_contact
        )
        for k, number in np.argwhere(~(np.column_stack([mu, mu_3]) > _MIN_STRETCH)):
            raise self._collapse(self.regions[self.spans[k // 2].region], number + 1, ends[k])
        if not left < equations.PLATEAU_TOLERANCE:
            raise NotConvergedError(
                f"{self.asked}: no homogeneous state found in {equations.MOST_PLATEAU_STEPS} steps; take weaker loads",
                iterations=equations.MOST_PLATEAU_STEPS,
                residual=left,
            )
        layer = 1 / math.sqrt(equations.fastest(df, Local(*rows).gradient))
        return mu.reshape(-1, 2, 2), layer

    @property
    def asked(self) -> str:
        """The instant with the parameters that may prevent a solution, eq. (2.3.19), for a message."""
        cuts = " and ".join(f"{region.right:.4g}" for region in self.regions[:-1]) or "no place"
        return (
            f"{self.name} with 'loads.anchoring' = {self.loads.anchoring:g} N, 'loads.advancing' = "
            f"{self.loads.advancing:g} Pa and regions that meet at {cuts}"
        )

    def check_collapse(self) -> None:
        """Nothing, or what `plateaus` raises."""
        _ = self.plateaus

    def _collapse(self, region: Region, number: int, at: float) -> InputError:
        key, unit = {"anchoring": ("anchoring", "N"), "advancing": ("advancing", "Pa")}.get(
            region.load, ("anchoring", "N")
        )
        strength = self.common.strength(region)
        muscles = (
            f"'loads.{key}' = {strength:g} {unit}"
            if region.own is None
            else f"an own load of {strength:g} {unit}"
        )
        weight = self.body.line_density * self.loads.gravity
        place = "" if self.pieces is UNIFORM else f", at xi = {at * self.body.length:.4g} m"
        return InputError(
            f"{self.name}: {muscles} and a weight of {weight:.3g} N/m would collapse the sections where they act"
            f"{place} (mu_{number} falls to zero); take weaker loads or a stiffer material than E = "
            f"{self.body.material_young:g} Pa"
        )

    def source(self, mu: Array, local: Local, multiplier: Array) -> tuple[Array, Array, Array]:
        """f, its derivative and mu_3 at K points; multiplier : (K,) lambda_c there, if incompressible."""
        own = local.stiffness, local.weight
        if not self.groups.incompressible:
            return self.groups.compressible_source(mu, local.force, local.pressure, own)
        return self.groups.incompressible_source(mu, multiplier, local.exponent, local.pressure, own)

    def mesh(self, settings: RegionSettings) -> Mesh:
        """The mesh of this instant."""
        _, layer = self._homogeneous
        edges = [self.span_ends[0, 0], *self.span_ends[:, 1]]
        varies = self.pieces is not UNIFORM  # then there are layers at the ends too
        return graded(edges, layer, settings.elements, settings.degree, fine_ends=varies)

    def guess(self, z: Array, span: Ints) -> Array:
        """Plateaus joined by layers, shape (K, 2), at places z in the spans with these indices."""
        mu, layer = self._homogeneous
        guessed: Array = equations.layered(z, span, self.span_ends, mu, layer)
        return guessed

    def _first_guess(self, mesh: Mesh) -> Array:
        """The guess at the nodes of a mesh."""
        z = np.append(mesh.places[:, :-1].ravel(), mesh.ends[-1])
        return self.guess(z, np.append(np.repeat(mesh.region, mesh.degree), mesh.region[-1]))

    def solve(self, settings: RegionSettings, before: Array | None) -> tuple[Profile, Array]:
        """The banded solver, started from the last instant's nodal values if their number is the same.

        Returns the profile and its nodal values, shape (nodes, 2).

        Raises
        ------
        InputError : the loads collapse a section.  NotConvergedError : no solution.
        """
        mesh = self.mesh(settings)
        equation = InstantEquation(self, mesh)
        weight = equation.weight
        if before is None or before.shape[0] != mesh.nodes:
            solved = solve(mesh, equation, self._first_guess(mesh), settings, self.asked, weight)
        else:
            try:
                solved = solve(mesh, equation, before, settings, self.asked, weight)
            except NotConvergedError:
                solved = solve(mesh, equation, self._first_guess(mesh), settings, self.asked, weight)
        mu = mesh.split(solved.u)
        mu_3, multiplier = equation.along(mu)
        return self._profile(equation, mu, mesh.slope(mu), mu_3, multiplier, solved.iterations), solved.u

    def _profile(
        self,
        equation: InstantEquation,
        mu: Array,
        slope: Array,
        mu_3: Array,
        multiplier: Array,
        effort: int,
    ) -> Profile:
        radius = (equation.local.radius * self.body.radius).reshape(mu_3.shape)
        return Profile(
            equation.mesh, mu, slope, mu_3, multiplier, radius, effort, self.groups.incompressible
        )

    def collocate(self, settings: RegionSettings, tolerance: float) -> Profile:
        """The thesis's way: first-order systems on a common domain, eqs. (2.3.17)-(2.3.18), (2.4.18)-(2.4.19).

        The profile is sampled on the mesh of the banded solver.  The body must be uniform.

        Raises
        ------
        InputError : the loads collapse a section.  NotConvergedError : no solution.
        """
        mesh = self.mesh(settings)
        systems = [self._system(number) for number in range(len(self.regions))]
        start = np.unique(
            np.concatenate(
                [
                    (mesh.ends[np.append(mesh.region == r, False)] - s.left) / (s.right - s.left)
                    for r, s in enumerate(systems)
                ]
                + [np.ones(1)]
            ).round(12)
        )
        found = collocate(systems, self._conditions, start, tolerance, self.asked)
        y = [
            found.solution(int(r), z).T for r, z in zip(mesh.region, mesh.places, strict=True)
        ]  # (p + 1, 4 or 5) each
        mu, slope = np.array([v[:, 0:3:2] for v in y]), np.array([v[:, 1:4:2] for v in y])
        equation = InstantEquation(self, mesh)
        mu_3, multiplier = equation.along(mu)
        for e, values in enumerate(y):
            if values.shape[1] > 4:
                multiplier[e] = values[:, 4]
        return self._profile(equation, mu, slope, mu_3, multiplier, found.nodes)

    def _system(self, number: int) -> RegionSystem:
        region = self.regions[number]
        c, force = self.pressure[number], self.force[number]
        followed = self.groups.incompressible and bool(self.advancing[number])

        def rate(y: Array) -> Array:
            mu = np.ascontiguousarray(y[0:3:2].T)
            count = np.ones(mu.shape[0])
            if not self.groups.incompressible:
                f, _, _ = self.groups.compressible_source(mu, force * count, c * count)
                return np.array([y[1], f[:, 0], y[3], f[:, 1]])
            multiplier = y[4] if followed else force / (y[0] * y[2])
            f, _, _ = self.groups.incompressible_source(mu, multiplier, count, c * count)
            dy = [y[1], f[:, 0], y[3], f[:, 1]]
            if followed:  # (2.4.13)_3; as printed, (2.4.18) has the length of the region once too often
                exponent = self.exponent[number]
                dy.append(-exponent * y[4] * (y[1] / y[0] + y[3] / y[2]))
            return np.array(dy)

        def guess(z: Array) -> Array:
            mu = self.guess(z, np.full(z.size, number))
            slope = np.gradient(mu, z, axis=0)
            y = [mu[:, 0], slope[:, 0], mu[:, 1], slope[:, 1]]
            if followed:
                y.append(force / (mu[:, 0] * mu[:, 1]))
            return np.array(y)

        return RegionSystem(region.left, region.right, 5 if followed else 4, rate, guess)

    def _conditions(self, left: list[Array], right: list[Array]) -> Array:
        """(2.3.18), or (2.4.19) with (2.4.14): also for regions that begin or end with an advancing one (E2.12)."""
        residuals = [left[0][1], left[0][3], right[-1][1], right[-1][3]]
        for a, b in zip(right[:-1], left[1:], strict=True):
            residuals.extend(a[:4] - b[:4])
        for number, (a, b) in enumerate(zip(left, right, strict=True)):
            if a.size > 4:
                near = b if number == 0 and len(left) > 1 else a
                residuals.append(near[4] - self.force[number] / (near[0] * near[2]))
        return np.array(residuals)


class InstantEquation:
    """The sources of an instant at the points of a mesh, for the banded solver."""

    def __init__(self, instant: InstantProblem, mesh: Mesh) -> None:
        self.instant, self.mesh = instant, mesh
        self.span = np.repeat(mesh.region, mesh.degree + 1)
        self.local = instant.local(self.span, mesh.places.ravel())
        varies = instant.pieces is not UNIFORM
        self.weight = self.local.gradient.reshape(mesh.places.shape) if varies else None
        self.far = [
            (number, self._junction(number))
            for number, s in enumerate(instant.exponent)
            if s != 1.0 and instant.force[number] != 0.0
        ]

    def _junction(self, region: int) -> int:
        """The node where an advancing region takes its contact force from: its left end, or its only junction."""
        elements = np.flatnonzero(self.mesh.region == region)
        return int(elements[0] if region > 0 else elements[-1] + 1) * self.mesh.degree

    def source(self, u: Array) -> Source | None:
        """f, its derivative, and its dependence on the junctions."""
        if not (u > 0).all():
            return None
        mu = u.reshape(-1, 2)
        multiplier = self._multiplier(u)
        f, df, mu_3 = self.instant.source(mu, self.local, multiplier)
        if not (mu_3 > 0).all():
            return None
        remote = tuple(self._remote(u, multiplier, number, node) for number, node in self.far)
        return Source(f.reshape(u.shape), df.reshape(*u.shape, 2), remote)

    def _multiplier(self, u: Array) -> Array:
        """lambda_c at every point, shape (M (p + 1),); zero if compressible."""
        local = self.local
        if not self.instant.groups.incompressible:
            return np.zeros_like(local.force)
        multiplier: Array = equations.multiplier_of(u.reshape(-1, 2), local.force, local.exponent)
        for number, node in self.far:
            at_junction = self.node_value(u, node).prod()
            inside = self.span == number
            multiplier[inside] *= at_junction ** (self.instant.exponent[number] - 1)
        return multiplier

    def node_value(self, u: Array, node: int) -> Array:
        """What a field (..., M, p + 1, m) is at a node, (..., m)."""
        element = min(node // self.mesh.degree, u.shape[-3] - 1)
        value: Array = u[..., element, node - element * self.mesh.degree, :]
        return value

    def _remote(self, u: Array, multiplier: Array, number: int, node: int) -> Remote:
        """f changes with the logarithm of mu_1 mu_2 at the junction through lambda_c there."""
        inside = self.span == number
        change = np.where(inside, (self.instant.exponent[number] - 1) * multiplier, 0.0)
        return Remote(node, change.reshape(u.shape[:2])[..., None] / u, 1 / self.node_value(u, node))

    def along(self, u: Array) -> tuple[Array, Array]:
        """mu_3 and lambda_c, shape (M, p + 1) each."""
        shape, multiplier = u.shape[:2], self._multiplier(u)
        _, _, mu_3 = self.instant.source(u.reshape(-1, 2), self.local, multiplier)
        return mu_3.reshape(shape), multiplier.reshape(shape)
