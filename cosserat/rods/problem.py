"""A rod with its constraints and loads, the common part of its static and dynamic problems, section 3.5."""

from __future__ import annotations

from collections.abc import Container, Iterator
from dataclasses import replace
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.problem import Problem
from cosserat.rods.attachments import ATTACHMENTS
from cosserat.rods.attachments.attachment import Attachment, attached_energy
from cosserat.rods.attachments.foundations import Foundation
from cosserat.rods.attachments.springs import Spring
from cosserat.rods.constraints import (
    Constraint,
    PrescribedDisplacement,
    PrescribedPart,
    PrescribedRotation,
    RodConstraints,
)
from cosserat.rods.energies.reissner import STRESSES
from cosserat.rods.holding import held_components
from cosserat.rods.imperfections import AnyImperfection
from cosserat.rods.loads.base import BaseMotion
from cosserat.rods.loads.couples import Couple, LineCouple
from cosserat.rods.loads.dead import Gravity, LineLoad, PointForce
from cosserat.rods.loads.following import FollowerForce, FollowerLineLoad
from cosserat.rods.loads.load import Load, LoadedRod
from cosserat.rods.loads.pressure import Pressure
from cosserat.rods.loads.strains import PreStrain, StressFreeStrain, Temperature
from cosserat.rods.masses import Mass
from cosserat.rods.naming import check_names
from cosserat.rods.places import check_place, mesh
from cosserat.rods.probes import Probe
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.rods.space import RodSpace
from cosserat.rods.supports import Support
from cosserat.rods.time_functions import TimeFunction
from cosserat.solvers.banded import Mask
from cosserat.solvers.frames import Frame, framed
from cosserat.solvers.potential import Potential
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]

LOADS: dict[str, type[Load]] = {
    "gravity": Gravity,
    "base_motion": BaseMotion,
    "line_loads": LineLoad,
    "forces": PointForce,
    "couples": Couple,
    "line_couples": LineCouple,
    "follower_forces": FollowerForce,
    "follower_line_loads": FollowerLineLoad,
    "pressures": Pressure,
    "prestrains": PreStrain,
    "temperatures": Temperature,
}
"""Kinds of loads by their key in a case."""
CONSTRAINTS: dict[str, type[Constraint]] = {
    "supports": Support,
    "prescribed_displacements": PrescribedDisplacement,
    "prescribed_rotations": PrescribedRotation,
}
"""Kinds of constraints by their key in a case."""


class RodProblem(Problem):
    """A rod with its constraints and loads."""

    in_time: ClassVar[bool] = False
    """Whether it is a motion; if not, loads and prescribed DOFs grow together, in increments."""
    always: ClassVar[tuple[str, ...]] = ()
    """Keys of loads whose potential is always present, for its internal variables."""
    rod: Rod
    supports: tuple[Support, ...]
    """Supports of the rod; a motion, or a rod that springs hold, may have none."""
    springs: tuple[Spring, ...] = ()
    """Springs between places of the rod and the ground."""
    foundations: tuple[Foundation, ...] = ()
    """Elastic foundations, each along a stretch of the rod."""
    masses: tuple[Mass, ...] = ()
    """Concentrated masses, each on one section."""
    gravity: Gravity | None = None
    forces: tuple[PointForce, ...] = ()
    """Dead forces, each at one vertex."""
    line_loads: tuple[LineLoad, ...] = ()
    """Dead forces per length, each over a stretch of the rod."""
    couples: tuple[Couple, ...] = ()
    """Moments, each on one section; in the plane a moment is the same whether it turns with the section or not."""
    line_couples: tuple[LineCouple, ...] = ()
    """Moments per length, each over a stretch of the rod."""
    follower_forces: tuple[FollowerForce, ...] = ()
    """Forces that turn with the section, each at one place."""
    follower_line_loads: tuple[FollowerLineLoad, ...] = ()
    """Forces per length that turn with the sections, each over a stretch of the rod."""
    pressures: tuple[Pressure, ...] = ()
    """Pressures on the upper or the lower surface, each over a stretch of the rod."""
    prestrains: tuple[PreStrain, ...] = ()
    """Prescribed extensions and curvatures, each over a stretch of the rod."""
    temperatures: tuple[Temperature, ...] = ()
    """Changes of temperature, each over a stretch of the rod."""
    prescribed_displacements: tuple[PrescribedDisplacement, ...] = ()
    """Prescribed displacements of fixed degrees of freedom."""
    prescribed_rotations: tuple[PrescribedRotation, ...] = ()
    """Prescribed rotations of fixed sections."""
    probes: tuple[Probe, ...] = ()
    """Points whose displacements and rotations are stored by name; "modes" and "critical loads" have none to store."""

    imperfection: AnyImperfection | None = None
    """Small deviation of the unloaded rod from its shape at rest, without stress."""

    def loads_of(self, key: str) -> tuple[Load, ...]:
        """The loads of one kind."""
        given = vars(self).get(key)
        return given if isinstance(given, tuple) else () if given is None else (given,)

    @property
    def turned_before(self) -> tuple[PrescribedRotation, ...]:
        """Rotations of fixed sections where the loads begin to grow."""
        return ()

    def attachments(self) -> list[Attachment]:
        """Every spring and foundation."""
        return [item for key in ATTACHMENTS for item in getattr(self, key, ())]

    def constraints(self) -> Iterator[tuple[str, Constraint]]:
        """Every constraint with the key of its kind."""
        for key in CONSTRAINTS:
            for item in getattr(self, key, ()):
                yield key, item

    @property
    def arc_length(self) -> Array:
        """Reference arc length of the vertices, one of them at every constraint, spring and mass, shape (N,) [m]."""
        places = [item.at for _, item in self.constraints()]
        places += [item.at for item in self.springs] + [item.at for item in self.masses]
        return mesh(self.rod.vertices, self.rod.length, places)

    @property
    def geometry(self) -> Geometry:
        """The reference configuration of the rod, with its imperfection.

        Raises
        ------
        InputError : the imperfection does not fit the rod.
        """
        perfect = self.rod.geometry(self.arc_length)
        return self.imperfection.applied(self, perfect) if self.imperfection else perfect

    @model_validator(mode="after")
    def _fits(self) -> Self:
        loads = [(key, load) for key in LOADS for load in self.loads_of(key)]
        named = [(key, item.at) for key, item in self.constraints()]
        named += [
            (key, at) for key in ATTACHMENTS for item in getattr(self, key, ()) for at in item.places
        ]
        named += [(key, at) for key, load in loads for at in load.places]
        named += [(key, item.at) for key in ("masses", "probes") for item in getattr(self, key)]
        for key, at in named:
            check_place(at, self.rod.vertices, self.rod.length, key)
        for key, load in loads:
            load.check(self.rod, key)
        for item in self.attachments():
            item.check(self.rod)
        check_names("probes", [probe.name for probe in self.probes])
        check_names("supports", [support.name for support in self.supports if support.name])
        return self

    @model_validator(mode="after")
    def _only_a_motion_has_time(self) -> Self:
        for key, _ in self.time_functions if not self.in_time else ():
            raise PydanticCustomError(
                "static",
                f"has a 'time_function' in '{key}', but only kind = 'rod motion' has a time; leave it out",
            )
        return self

    @model_validator(mode="after")
    def _what_moves_is_constrained(self) -> Self:
        arc, met = self.arc_length, dict[int, str]()
        moved = [(key, item, dof) for key, item in self.constraints() for dof in item.moves]
        constrained = self._held_in_any_pose(arc) if moved else np.empty(0, dtype=np.bool_)
        for key, item, dof in moved:
            number = self.rod.dof(item.at, dof, arc)
            if number in met:
                keys = " and ".join(f"'{name}'" for name in dict.fromkeys([met[number], key]))
                raise PydanticCustomError(
                    "twice", f"{keys} move {dof} of vertex {item.at} twice; put both together"
                )
            met[number] = key
            if not constrained[number]:
                raise PydanticCustomError(
                    "support",
                    f"'{key}' {item.action} of vertex {item.at}, which no support fixes; "
                    f"add {dof} to 'fixed' of a support there",
                )
        for _, item in self.constraints():
            item.check(large_rotations=self.rod.strain_energy.large_rotations and not self.in_time)
        return self

    def _held_in_any_pose(self, arc: Array) -> Mask:
        """Which DOFs are constrained wherever the directors point, (n,); arc : (N,) of the vertices [m]."""
        mask, frame = self._held(arc, np.broadcast_to([0.6, 0.8], (arc.size, 2)))
        mask[frame.first] = mask[frame.first + 1] = False
        return mask

    @property
    def body(self) -> str:
        """Length, number of vertices and energy of the rod."""
        rod = self.rod
        return f"rod of {rod.length:g} m, {rod.vertices} vertices, {rod.energy} energy"

    @property
    def time_functions(self) -> list[tuple[str, TimeFunction]]:
        """The functions of time of its loads and constraints, with their keys."""
        items = [(key, load) for key in LOADS for load in self.loads_of(key)]
        given = [
            *((key, load.level) for key, load in items),
            *((key, getattr(item, "time_function", None)) for key, item in self.constraints()),
        ]
        return [(key, function) for key, function in given if function is not None]

    def system(self, geometry: Geometry, *, displacements: bool = True) -> MechanicalSystem:
        """The rod with its loads, constraints and mass.

        displacements : its DOFs are displacements from the reference; if not, they are positions and directors.
        """
        energy = self.rod.strain_energy.potential(self.rod, geometry, displacements=displacements)
        at_rest = self.rod.strain_energy.reference(geometry)
        mask, frame = self.held(geometry)
        still, attached = mask.copy(), self.attachments()
        still[frame.first] = still[frame.first + 1] = False
        for _, item in self.constraints():
            still[[self.rod.dof(item.at, dof, geometry.arc_length) for dof in item.moves]] = False
        origin = at_rest if displacements else None
        body = LoadedRod(self.rod, geometry, origin, still, self.masses)
        rounded = np.zeros_like(at_rest) if energy.origin is None else energy.origin
        system = MechanicalSystem(
            energy,
            tuple(self._potentials(body)),
            RodConstraints(mask, self.moves(geometry)),
            RodSpace(self.rod.kinematics, at_rest, displacements, rounded),
            lambda: body.mass,
            attached=(attached_energy(attached, body),) if attached else (),
        )
        return framed(system, frame).prepared()

    def moves(self, geometry: Geometry) -> tuple[PrescribedPart, ...]:
        """The prescribed motions of its constraints."""
        parts = [item.part(self.rod, geometry) for _, item in self.constraints()]
        return tuple(part for part in parts if part is not None)

    def _potentials(self, body: LoadedRod) -> Iterator[Potential]:
        """The potential of each kind of loads, and of each of its functions of time."""
        for key, kind in LOADS.items():
            loads = self.loads_of(key)
            if not loads and key not in self.always:
                continue
            constant = [load for load in loads if load.level is None]
            if constant or key in self.always:
                yield kind.potential(constant, body)
            for level in dict.fromkeys(load.level for load in loads if load.level):
                alike = [load for load in loads if load.level == level]
                yield replace(kind.potential(alike, body), level=level)

    def energy(self, geometry: Geometry) -> Potential:
        """The strain energy, a potential of displacements."""
        return self.rod.strain_energy.potential(self.rod, geometry, displacements=True)

    def stresses(self, geometry: Geometry) -> list[Potential]:
        """The loads that are stresses of the rod itself, potentials of displacements."""
        strained = (key for key, kind in LOADS.items() if issubclass(kind, StressFreeStrain))
        if not any(self.loads_of(key) for key in strained):
            return []
        body = LoadedRod(self.rod, geometry, self.rod.strain_energy.reference(geometry))
        return [load for load in self._potentials(body) if load.terms == STRESSES]

    def unloaded_rod(self, geometry: Geometry) -> MechanicalSystem:
        """The supported rod without loads and damping, in displacements."""
        return RodProblem.system(self, geometry).unloaded()

    def loaded_rod(self, geometry: Geometry, keys: Container[str]) -> MechanicalSystem:
        """The supported rod without pose and damping, under its loads and moved supports of some keys alone."""
        every = (*LOADS, "prescribed_displacements", "prescribed_rotations")
        known = type(self).model_fields
        left = {key: known[key].default for key in every if key in known and key not in keys}
        return RodProblem.system(self.model_copy(update=left), geometry)

    def held(self, geometry: Geometry) -> tuple[Mask, Frame]:
        """Which DOFs are constrained, (n,), in frames of the vectors that are held obliquely."""
        return self._held(geometry.arc_length, geometry.D)

    def _held(self, arc: Array, D: Array) -> tuple[Mask, Frame]:
        return held_components((item for _, item in self.constraints()), arc, D, self.rod.kinematics)

    def constrained(self) -> Mask:
        """Which DOFs are constrained, (n,); those of a vector that is held obliquely are in a frame of its own."""
        return self.held(self.geometry)[0]
