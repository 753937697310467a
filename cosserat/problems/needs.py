"""What the problems inside a study must be: those whose closed forms it compares them with."""

from __future__ import annotations

import numpy as np
from pydantic_core import PydanticCustomError

from cosserat.problems.static import RodStatics
from cosserat.rods.attachments import ATTACHMENTS
from cosserat.rods.naming import Direction, unit_vector
from cosserat.rods.places import arc_of
from cosserat.rods.problem import LOADS
from cosserat.rods.sections.section import Homogeneous

_NEAR = 1e-9
_SLENDER = 5.0  # heights in the length of a rod that is bent far


def check_weighed(key: str, problem: RodStatics, along: Direction, *, both_ends: bool) -> None:
    """Raise PydanticCustomError if a problem is not a bar or beam under its weight alone."""
    _check_simple(key, problem, "gravity", both_ends=both_ends)
    gravity = problem.gravity
    if gravity is None or not gravity.g:
        raise _refused(key, "has no weight", f"give it 'gravity' along \"{along}\"")
    if np.abs(unit_vector(gravity.along) - unit_vector(along)).max() > _NEAR:
        raise _refused(key, f"has its weight along {gravity.along}", f'let it be along "{along}"')


def check_pulled(key: str, problem: RodStatics) -> None:
    """Raise PydanticCustomError if a problem is not a bar that forces alone pull along it, the last one at its end."""
    _check_simple(key, problem, "forces", both_ends=True)
    forces = problem.forces
    if not forces or not forces[-1].force or _end(problem, forces[-1].at) != 1:
        raise _refused(key, "is not pulled at its last vertex", "let the last of its 'forces' be there")
    if any(abs(unit_vector(force.along)[1]) > _NEAR for force in forces):
        raise _refused(key, "has forces across the bar", 'let them be along "E3" or "-E3"')


def check_slender(key: str, problem: RodStatics) -> None:
    """Raise PydanticCustomError if a problem is not a rod without loads, held at its first vertex alone."""
    _check_simple(key, problem, "", both_ends=False)
    length, height = problem.rod.length, problem.rod.height
    if length < _SLENDER * height:
        raise _refused(
            key,
            f"is {length:g} m long and {height:g} m high, too thick for large deflections",
            f"let its length be {_SLENDER:g} heights or more",
        )


def check_coefficients(key: str, problem: RodStatics, names: tuple[str, ...]) -> None:
    """Raise PydanticCustomError if a problem does not have positive coefficients of these names."""
    calibration = problem.rod.calibration
    if calibration is None:
        raise _refused(key, "has no 'rod.calibration' to fit", "give it energy = 'published'")
    for name in names:
        if getattr(calibration, name) <= 0:
            raise _refused(
                key,
                f"has rod.calibration.{name} = {getattr(calibration, name):g}, whose logarithm is fitted",
                "take one above 0",
            )


def _check_simple(key: str, problem: RodStatics, load: str, *, both_ends: bool) -> None:
    """The rod is straight, uniform, of one material, held at these ends, and bears at most this load."""
    rod = problem.rod
    if not isinstance(rod.section, Homogeneous):
        raise _refused(
            key, f"has a section of shape '{rod.section.shape}'", "take a section of one material"
        )
    if rod.stations or not rod.rest.straight or problem.imperfection is not None:
        raise _refused(key, "is not straight and uniform", "leave out what makes it vary or bend")
    others = [name for name in LOADS if name != load and problem.loads_of(name)]
    others += [name for name in (*ATTACHMENTS, "masses") if getattr(problem, name, ())]
    if others:
        raise _refused(key, f"has {', '.join(map(repr, others))}", "leave them out")
    held = {_end(problem, item.at) for _, item in problem.constraints()}
    if held != ({0, 1} if both_ends else {0}):
        raise _refused(
            key, "is held elsewhere", f'hold it at "first"{" and last" if both_ends else " alone"}'
        )


def _end(problem: RodStatics, at: str | int) -> int | None:
    """0 or 1 for the first or last vertex of any mesh, else None."""
    if isinstance(at, int):
        return 0 if at == 0 else None
    share = arc_of(at, np.array([0.0, problem.rod.length])) / problem.rod.length
    return next((end for end in (0, 1) if abs(share - end) < _NEAR), None)


def _refused(key: str, fault: str, remedy: str) -> PydanticCustomError:
    return PydanticCustomError(
        "study",
        f"has '{key}', which {fault}, but is compared with a closed form; {remedy}",
    )
