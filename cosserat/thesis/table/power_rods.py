"""Changes of the rods of Chapter 3 that the results table should notice."""

from __future__ import annotations

import contextlib
import inspect
from collections.abc import Callable, Iterator
from typing import Any
from unittest import mock

import numpy as np
from numba.core.dispatcher import Dispatcher
from numpy.typing import NDArray

from cosserat.rods.energies import hemingway, hemingway_kernel
from cosserat.rods.energies.hemingway_stiffness import Stiffness, stiffnesses
from cosserat.rods.rod import Rod
from cosserat.thesis.table.power import Change, Physics

Array = NDArray[Any]
BAR = ("hanging_bar",)
_READINGS = ("", "_ends_halved", "_k_1", "_k_1_ends_halved")
CLAMPED_FREE = tuple(f"clamped_free{reading}" for reading in _READINGS)
CLAMPED_CLAMPED = tuple(f"clamped_clamped{reading}" for reading in _READINGS)
BEAMS = CLAMPED_FREE + CLAMPED_CLAMPED
NECKING = ("necking", "necking_printed")
LARGE_STRAINS = ("stretched", "sheared", "inflated")
VIBRATION = ("vibration_c4_2", "vibration_c4_20")
CONSISTENT = (
    "hanging_bar_consistent",
    "clamped_free_consistent",
    "clamped_clamped_consistent",
    "necking_consistent",
    "vibration_consistent",
)
SLENDER = ("elastica", "roll_up", "column_path")
_GROUPS = {
    "hanging bar": BAR,
    "beams": BEAMS,
    "necking": NECKING,
    "large strains": LARGE_STRAINS,
    "vibration": VIBRATION,
}

INFLATION = 1.5
"""Stretch of the edges of the case "inflated"."""

_CALIBRATED = ("hanging_bar", "clamped_free", "clamped_clamped", "necking")
_SCALE_INVARIANT = (
    "the rod and its closed form scale equally with it, and the fitted coefficients are dimensionless; "
    "rows of the four problems notice the change"
)
_NO_SHEAR = "nothing shears"
_NO_WEIGHT = "the rod has no weight and is at rest"
_EXACT_AT_EVERY_MESH = "weights lumped at the vertices give the linear bar exactly at every N"


def _times(factor: float) -> Callable[[float], float]:
    return lambda value: value * factor


def _plus(more: float) -> Callable[[float], float]:
    return lambda value: value + more


def _inputs(
    what: str,
    place: str,
    edit: Callable[[float], float],
    groups: tuple[str, ...] = tuple(_GROUPS),
    unseen: dict[str, str] | None = None,
) -> list[Change]:
    return [
        Change(f"{group}: {what}", _GROUPS[group], (place,), edit, unseen=(unseen or {}).get(group, ""))
        for group in groups
    ]


def _coefficient(name: str, factor: float, *groups: str) -> list[Change]:
    return _inputs(f"{name} x {factor:g}", f"rod.calibration.{name}", _times(factor), groups)


def _calibration(
    what: str,
    place: str,
    edit: Callable[[float], float] | None = None,
    problems: tuple[str, ...] = _CALIBRATED,
    physics: Physics = contextlib.nullcontext,
    unseen: str = "",
) -> Change:
    """A change of the fitted problems, at the published number of vertices only."""
    places = tuple(f"{problem}.{place}" for problem in problems if place)
    name = "calibration"
    return Change(f"{name}: {what}", (name,), places, edit, first=1, physics=physics, unseen=unseen)


def scaled(name: str, factor: float) -> Physics:
    """A property or method of the rod, too large by a factor."""

    @contextlib.contextmanager
    def physics() -> Iterator[None]:
        original = inspect.getattr_static(Rod, name)
        if isinstance(original, property):
            assert original.fget is not None
            own = original.fget
            changed: object = property(lambda self: factor * own(self))
        else:
            changed = lambda self, *args: factor * original(self, *args)  # noqa: E731
        with mock.patch.object(Rod, name, changed):
            yield

    return physics


@contextlib.contextmanager
def _kernel(**helpers: Callable[..., object]) -> Iterator[None]:
    """The published energy in plain Python, all of its functions, with other characteristics."""
    plain = {
        name: value.py_func
        for name, value in vars(hemingway_kernel).items()
        if isinstance(value, Dispatcher)
    }
    assemble = plain["assemble"]

    def with_records(q: Array, after: Array, data: Array, *others: Any) -> float:
        """Plain Python reads the fields of a constant by name only from such an array."""
        energy: float = assemble(q, after, data.view(np.recarray), *others)
        return energy

    with contextlib.ExitStack() as stack:
        for name, value in {**plain, **helpers, "assemble": with_records}.items():
            stack.enter_context(mock.patch.object(hemingway_kernel, name, value))
        yield


def quadratic_wells() -> contextlib.AbstractContextManager[None]:
    """s^2 - s + 1/s - 1 as its quadratic part."""
    return _kernel(stretching=lambda s: (2 * (s - 1) ** 2, 4 * (s - 1), 4.0))


def square_of_the_angle() -> contextlib.AbstractContextManager[None]:
    """tan^2 as the square of its angle."""
    return _kernel(
        squared_tangent=lambda angle, rest: ((angle - rest) ** 2, 2 * (angle - rest), 2.0),
    )


@contextlib.contextmanager
def current_curvature() -> Iterator[None]:
    """kappa in place of mu kappa for a prescribed centreline: k3 over the square of its stretch.

    The moments are then those of k3/2 kappa^2 L; the forces along the edges, which no row reads, are not.
    """

    def divided(*given: Any) -> Stiffness:
        stiff = stiffnesses(*given)
        return stiff._replace(k3=stiff.k3 / INFLATION**2)

    with mock.patch.object(hemingway, "stiffnesses", divided):
        yield


CHANGES: tuple[Change, ...] = (
    *_inputs("E x 1.1", "rod.material.young", _times(1.1)),
    *_inputs("E x 0.9", "rod.material.young", _times(0.9)),
    *_inputs("g x 1.1", "gravity.g", _times(1.1), ("hanging bar", "beams")),
    *_inputs("g x 2", "gravity.g", _times(2.0), ("hanging bar", "beams")),
    *_inputs("weight the other way", "gravity.g", _times(-1.0), ("hanging bar", "beams")),
    *_inputs(
        "rho_0 x 1.2",
        "rod.material.line_density",
        _times(1.2),
        unseen={"necking": _NO_WEIGHT, "large strains": _NO_WEIGHT},
    ),
    *_inputs("L x 1.02", "rod.length", _times(1.02)),
    *_inputs("H x 1.02", "rod.section.height", _times(1.02)),
    *_inputs("W x 1.02", "rod.section.width", _times(1.02)),
    *_inputs(
        "N = 19",
        "rod.vertices",
        lambda _: 19,
        ("hanging bar", "beams", "necking", "vibration"),
        {"hanging bar": _EXACT_AT_EVERY_MESH},
    ),
    *_inputs(
        "N = 21",
        "rod.vertices",
        lambda _: 21,
        ("hanging bar", "beams", "necking", "vibration"),
        {"hanging bar": _EXACT_AT_EVERY_MESH},
    ),
    *_inputs("nu + 0.05", "rod.material.poisson", _plus(0.05)),
    *_inputs(
        "k x 1.02",
        "rod.section.shear_factor",
        _times(1.02),
        ("hanging bar", "beams", "necking", "large strains"),
        {"hanging bar": _NO_SHEAR, "necking": _NO_SHEAR},
    ),
    *_coefficient("c1", 1.02, "hanging bar", "necking", "large strains"),
    *_coefficient("c2", 1.02, "necking", "large strains"),
    *_coefficient("c3", 1.02, "beams", "large strains", "vibration"),
    *_coefficient("c4", 1.02, "beams", "large strains"),
    *_coefficient("c5", 1.02, "beams"),
    *_coefficient("c6", 1.1, "necking"),
    *_coefficient("c7", 1.02, "necking"),
    *_inputs("k x 1.2", "rod.section.shear_factor", _times(1.2), ("vibration",)),
    *_coefficient("c4", 2.0, "vibration"),
    *_coefficient("c4", 0.5, "vibration"),
    *_coefficient("c5", 3.0, "vibration"),
    Change("necking: n x 1.1", NECKING, ("forces.0.force", "forces.1.force"), _times(1.1)),
    Change("necking: n = 1 MN", NECKING, ("forces.0.force", "forces.1.force"), _times(1e3)),
    *_inputs(
        "amplitude x 1.2",
        "start.amplitude",
        _times(1.2),
        ("vibration",),
        {
            "vibration": "the thesis prints no amplitude and no energy, and small vibrations have one period"
        },
    ),
    *[
        Change(f"{group}: {what}", _GROUPS[group], physics=scaled(name, factor), unseen=unseen)
        for group, what, name, factor, unseen in (
            ("beams", "I of the model x 1.04", "second_moment", 1.04, ""),
            ("large strains", "I of the model x 1.04", "second_moment", 1.04, ""),
            ("vibration", "I of the model x 1.04", "second_moment", 1.04, ""),
            ("hanging bar", "A of the model x 1.04", "area", 1.04, ""),
            ("beams", "A of the model x 1.04", "area", 1.04, ""),
            ("necking", "A of the model x 1.04", "area", 1.04, ""),
            ("vibration", "Y22 x 5", "Y22", 5.0, ""),
            ("vibration", "Y22 / 100", "Y22", 0.01, ""),
            ("hanging bar", "mass of parts x 1.25", "part_masses", 1.25, ""),
            ("beams", "mass of parts x 1.25", "part_masses", 1.25, ""),
            ("vibration", "mass of parts x 1.25", "part_masses", 1.25, ""),
        )
    ],
    *[
        _calibration(f"{letter} of the model x 1.04", "", physics=scaled(name, 1.04))
        for letter, name in (("I", "second_moment"), ("A", "area"))
    ],
    _calibration("E x 1.1", "rod.material.young", _times(1.1), unseen=_SCALE_INVARIANT),
    _calibration("rho_0 x 1.2", "rod.material.line_density", _times(1.2), unseen=_SCALE_INVARIANT),
    _calibration("g x 2", "gravity.g", _times(2.0), _CALIBRATED[:3], unseen=_SCALE_INVARIANT),
    _calibration("n x 1.1", "forces.1.force", _times(1.1), _CALIBRATED[3:], unseen=_SCALE_INVARIANT),
    _calibration("L x 1.02", "rod.length", _times(1.02)),
    _calibration("H x 1.02", "rod.section.height", _times(1.02)),
    _calibration("W x 1.02", "rod.section.width", _times(1.02)),
    _calibration("k x 1.02", "rod.section.shear_factor", _times(1.02)),
    _calibration("nu + 0.05", "rod.material.poisson", _plus(0.05)),
    Change("large strains: wells of (3.4.11) made quadratic", LARGE_STRAINS, physics=quadratic_wells),
    Change("large strains: tan^2 made the square", LARGE_STRAINS, physics=square_of_the_angle),
    Change("large strains: mu kappa made kappa", LARGE_STRAINS[2:], physics=current_curvature),
    *[
        Change(f"own rod: {what}", CONSISTENT, (place,), edit)
        for what, place, edit in (
            ("E x 1.1", "rod.material.young", _times(1.1)),
            ("rho_0 x 1.2", "rod.material.line_density", _times(1.2)),
            ("L x 1.02", "rod.length", _times(1.02)),
            ("H x 1.02", "rod.section.height", _times(1.02)),
            ("N = 10", "rod.vertices", lambda _: 10),
            ("k x 1.2", "rod.section.shear_factor", _times(1.2)),
            ("nu + 0.05", "rod.material.poisson", _plus(0.05)),
        )
    ],
    Change("own rod: Y22 x 5", CONSISTENT[-1:], physics=scaled("Y22", 5.0)),
    Change("own slender rods: E x 1.1", SLENDER, ("rod.material.young",), _times(1.1)),
    Change("own slender rods: L x 1.02", SLENDER, ("rod.length",), _times(1.02)),
    Change("elastica: load x 0.9", SLENDER[:1], ("forces.0.force",), _times(0.9)),
    Change("roll-up: couple x 0.9", SLENDER[1:2], ("couples.0.moment",), _times(0.9)),
    Change("column: load x 0.9", SLENDER[2:], ("forces.0.force",), _times(0.9)),
    *[
        Change(
            f"{group}: {what}",
            _GROUPS[group],
            physics=physics,
            unseen="strains of a thousandth see the quadratic part alone" if unseen else "",
        )
        for group, what, physics, unseen in (
            ("hanging bar", "wells made quadratic", quadratic_wells, True),
            ("beams", "wells made quadratic", quadratic_wells, True),
            ("beams", "tan^2 made the square", square_of_the_angle, True),
            ("necking", "wells made quadratic", quadratic_wells, False),
        )
    ],
)
"""Changes of the rods, each tried separately."""
