"""Changes of the crawlers of Chapter 2 that the results table should notice."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any
from unittest import mock

import numpy as np
from numpy.typing import NDArray

from cosserat.peristalsis import equations
from cosserat.peristalsis.crawler import Crawler
from cosserat.peristalsis.profile import Profile
from cosserat.problems.crawl import Crawl
from cosserat.problems.crawler import CrawlerProblem
from cosserat.thesis import earthworm
from cosserat.thesis.table import crawl_readouts
from cosserat.thesis.table.power import Change, Physics
from cosserat.thesis.table.printed import PRINTED

Array = NDArray[np.float64]

ROBOT = ("soft_robot",)
WORM = ("worm_printed", "worm")
READINGS = (
    "worm_printed_early",
    "worm_balanced",
    "worm_balanced_early",
    "worm_early",
    "worm_clipped",
)
AT_REST = ("worm_at_rest",)
BODY_MASSES = ("worm_masses", "worm_masses_constant_pressure", "worm_masses_strip")
CALIBRATIONS = ("worm_calibration_printed", "worm_calibration")

_QUASISTATIC = "every instant is in equilibrium, and the printed numbers depend on their order alone"
_HEAD_ANCHORED = "the head is anchored from the start of eta on, and its speed does not matter"
_TIME_OF_HALF_ALONE = "the head advances until gamma is at 0.5, and the speed of gamma does not matter"
_FIT_INDEPENDENT_OF_START = "it is the start of the fit, and the fit does not depend on its start"
_SIZE_FROM_TABLE_2_1 = "each worm has its own mass, and its length by Table 2.1"
_UNIFORM_PLATEAUS = "both contractions are plateaus, and the printed numbers are uniform along each"


def _times(factor: float) -> Callable[[float], float]:
    return lambda value: value * factor


def _to(value: Any) -> Callable[[Any], Any]:
    return lambda _: value


def _inputs(
    what: str,
    place: str,
    edit: Callable[[Any], Any],
    *groups: tuple[str, ...],
    unseen: str = "",
) -> list[Change]:
    names = {
        ROBOT: "robot",
        WORM: "worm",
        READINGS: "other readings of the worm",
        AT_REST: "worm at rest",
        BODY_MASSES: "sizes",
        CALIBRATIONS: "calibration of the worm",
    }
    inner = {BODY_MASSES: "worm.", CALIBRATIONS: "worm."}
    return [
        Change(f"{names[group]}: {what}", group, (inner.get(group, "") + place,), edit, unseen=unseen)
        for group in groups
    ]


def _scaled_property(name: str, factors: tuple[float, ...]) -> Physics:
    """Stiffnesses of the body, each too large by its factor."""

    @contextlib.contextmanager
    def physics() -> Iterator[None]:
        own = vars(Crawler)[name].fget
        changed = property(lambda body: tuple(f * k for f, k in zip(factors, own(body), strict=True)))
        with mock.patch.object(Crawler, name, changed):
            yield

    return physics


def _mu_3_as_printed() -> contextlib.AbstractContextManager[object]:
    """(2.3.9) with (2.3.10) as printed, without the 2, where advancing loads act."""

    def compressible(
        mu: Array, n: Array, c: Array, g: Array, p: float, m: Array, printed_contact: bool
    ) -> tuple[Array, Array, Array]:
        f, df, mu_3 = known(mu, n, c, g, p, m, printed_contact)
        shorter = np.where(c != 0, 2 * p, 0.0)  # the loss of mu_3
        return f - (p * g * shorter)[:, None], df, mu_3 - shorter

    known = equations.compressible
    return mock.patch.object(equations, "compressible", compressible)


def _without_tilt() -> contextlib.AbstractContextManager[object]:
    """z' = mu_3 in place of (2.5.6)."""

    def length_along(self: CrawlerProblem, profile: Profile) -> Array:
        return profile.mesh.cumulative(profile.mu_3) * self.crawler.length

    return mock.patch.object(CrawlerProblem, "length_along", length_along)


def _pressure(of: Callable[[Crawl, Array, Array], Array]) -> Physics:
    """A pressure other than (2.8.8), from the problem, mu_1 and mu_2, and the reactive force lambda_c [N]."""

    def pressure(self: Crawl, mu: Array, multiplier: Array) -> Array:
        _, k_g = self.crawler.incompressible_stiffnesses
        return of(self, mu, multiplier * k_g / self.crawler.length**2)

    return lambda: mock.patch.object(CrawlerProblem, "pressure", pressure)


def _per_deformed_area(problem: Crawl, mu: Array, reactive: Array) -> Array:
    k_i, _ = problem.crawler.incompressible_stiffnesses
    result: Array = -(reactive - k_i * (2 - mu.sum(axis=-1))) / problem.crawler.area
    return result


def _without_the_passive_part(problem: Crawl, mu: Array, reactive: Array) -> Array:
    result: Array = -reactive * mu.prod(axis=-1) / problem.crawler.area
    return result


def _power_of_mass(name: str, more: float) -> Physics:
    """A law of Table 2.1 with another exponent and the same value at 10 g."""

    @contextlib.contextmanager
    def physics() -> Iterator[None]:
        own = getattr(earthworm, name)
        with mock.patch.object(earthworm, name, lambda mass: own(mass) * (mass / 0.01) ** more):
            yield

    return physics


def _segment_at(place: float) -> Physics:
    return lambda: mock.patch.object(crawl_readouts, "SEGMENT_50", place)


def _moved(track: int, point: int, to: float) -> Callable[[Any], Any]:
    """Change the place of one point of one track of a front."""

    def edit(tracks: Any) -> Any:
        moved = [[list(point) for point in track] for track in tracks]
        moved[track][point][1] = to
        return moved

    return edit


_EARLY: Any = PRINTED["worm_early"]["gait.anchor"].value
_INTERMEDIATE = [[_EARLY[0][0], [0.4, 0.45]], [[0.4, 0], [1, 0]], _EARLY[2]]
_ROBOT_EARLY = [[[0, 0], [1.9, 0]], [[1.9, 1], [4, 1]]]


def _two_tracks(to: float) -> Callable[[Any], Any]:
    """Change the place at which the first track of the worm's eta begins and the last one ends."""
    return lambda tracks: _moved(1, 1, to)(_moved(0, 0, to)(tracks))


CHANGES: tuple[Change, ...] = (
    *_inputs(
        "E x 1.01", "crawler.material.young", _times(1.01), ROBOT, WORM, READINGS, AT_REST, BODY_MASSES
    ),
    *_inputs("nu = 0.301", "crawler.material.poisson", _to(0.301), ROBOT),
    *_inputs(
        "E x 1.01",
        "crawler.material.young",
        _times(1.01),
        CALIBRATIONS,
        unseen=_FIT_INDEPENDENT_OF_START,
    ),
    *_inputs(
        "R x 1.01", "crawler.radius", _times(1.01), ROBOT, WORM, AT_REST, BODY_MASSES, CALIBRATIONS
    ),
    *_inputs("l_0 x 1.01", "crawler.length", _times(1.01), ROBOT, WORM, AT_REST, CALIBRATIONS),
    *_inputs("l_0 x 1.01", "crawler.length", _times(1.01), BODY_MASSES, unseen=_SIZE_FROM_TABLE_2_1),
    *_inputs("rho_0* x 1.01", "crawler.density", _times(1.01), ROBOT),
    *_inputs("m x 1.01", "crawler.mass", _times(1.01), WORM, AT_REST, CALIBRATIONS),
    *_inputs("m x 1.01", "crawler.mass", _times(1.01), BODY_MASSES, unseen=_SIZE_FROM_TABLE_2_1),
    *_inputs("g x 1.01", "loads.gravity", _times(1.01), ROBOT, WORM, AT_REST, BODY_MASSES, CALIBRATIONS),
    *_inputs("D x 1.01", "loads.anchoring", _times(1.01), ROBOT, WORM, READINGS),
    *_inputs("p x 1.01", "loads.advancing", _times(1.01), ROBOT, WORM, READINGS),
    *_inputs("D x 1.1", "loads.anchoring", _times(1.1), BODY_MASSES),
    *_inputs("p x 1.1", "loads.advancing", _times(1.1), BODY_MASSES),
    *_inputs("D x 1.1", "loads.anchoring", _times(1.1), CALIBRATIONS, unseen=_FIT_INDEPENDENT_OF_START),
    *_inputs("p x 1.1", "loads.advancing", _times(1.1), CALIBRATIONS, unseen=_FIT_INDEPENDENT_OF_START),
    *_inputs("a pause of 6 s", "gait.phases", _to([6, 7.5, 2.5, 7.5]), ROBOT, unseen=_QUASISTATIC),
    *_inputs("v x 2", "gait.phases", _to([5, 3.75, 1.25, 3.75]), ROBOT, unseen=_QUASISTATIC),
    *_inputs("t_p, t_s x 2", "gait.phases", _to([6.3, 3.5]), WORM, unseen=_QUASISTATIC),
    *_inputs("T = 0.3", "gait.gamma", _moved(0, 1, 0.3), ROBOT),
    *_inputs("eta slower first", "gait.eta", _moved(0, 1, 0.9), ROBOT, unseen=_HEAD_ANCHORED),
    *_inputs("front anchor a tenth of a phase early", "gait.anchor", _to(_ROBOT_EARLY), ROBOT),
    *_inputs("rear anchor from t_p/3 on", "gait.anchor", _to(_EARLY), WORM),
    *_inputs("another rear anchor", "gait.anchor", _to(_INTERMEDIATE), READINGS),
    *_inputs("gamma = 0.8 at t_p/2", "gait.gamma", _moved(0, 1, 0.8), WORM, unseen=_TIME_OF_HALF_ALONE),
    *_inputs("gamma = 0.45 at t_p", "gait.gamma", _moved(0, 2, 0.45), WORM),
    *_inputs("eta from 0.55", "gait.eta", _two_tracks(0.55), WORM),
    Change("worm: segment 50 in the middle", WORM, physics=_segment_at(0.5), unseen=_UNIFORM_PLATEAUS),
    Change("robot: (2.2.20) as printed", ROBOT, ("loads.contact",), _to("printed")),
    Change("worm: (2.2.20) as printed", ("worm",), ("loads.contact",), _to("printed")),
    Change("worm: (2.2.20) corrected", ("worm_printed",), ("loads.contact",), _to("weight")),
    Change("worm: dy9 of (2.4.18) as printed", ("worm",), ("loads.multiplier",), _to("printed")),
    Change("worm: dy9 of (2.4.18) corrected", ("worm_printed",), ("loads.multiplier",), _to("balanced")),
    Change("robot: section 2.4's junctions", ROBOT, ("loads.advancing_force",), _to("continuous")),
    Change("worm: section 2.3's junctions", ("worm",), ("loads.advancing_force",), _to("none")),
    Change("robot: mu_3 of (2.3.10) as printed", ROBOT, physics=_mu_3_as_printed),
    Change("robot: k_S x 1.01", ROBOT, physics=_scaled_property("stiffnesses", (1.01, 1, 1))),
    Change("robot: k_P x 1.01", ROBOT, physics=_scaled_property("stiffnesses", (1, 1.01, 1))),
    Change("robot: k_G x 1.01", ROBOT, physics=_scaled_property("stiffnesses", (1, 1, 1.01))),
    Change("worm: k_I x 1.01", WORM, physics=_scaled_property("incompressible_stiffnesses", (1.01, 1))),
    Change("worm: k_G x 1.01", WORM, physics=_scaled_property("incompressible_stiffnesses", (1, 1.01))),
    Change("robot: z' = mu_3 in (2.5.6)", ROBOT, physics=_without_tilt),
    Change("worm: z' = mu_3 in (2.5.6)", WORM, physics=_without_tilt),
    Change("worm: p_coelom per deformed area", WORM, physics=_pressure(_per_deformed_area)),
    Change("worm: p_coelom without k_I of (2.8.9)", WORM, physics=_pressure(_without_the_passive_part)),
    *(
        Change(f"sizes: a power of {name} + 0.01", BODY_MASSES, physics=_power_of_mass(name, 0.01))
        for name in ("resting_length", "resting_diameter", "protrusion_time", "stance_time")
    ),
    *(
        Change(f"calibration of the worm: {name} x 1.01", CALIBRATIONS, (name,), _times(1.01))
        for name in ("mu_1_ratio", "mu_3_ratio", "p_longitudinal", "p_circular")
    ),
)
"""Changes of inputs, gaits and mechanics, each tried separately."""
