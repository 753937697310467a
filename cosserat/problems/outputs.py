"""Outputs of every kind of rod problem, computed from its states when the Dataset is made and not in the solver."""

from __future__ import annotations

from collections.abc import Callable, Sequence, Set
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.energies.reissner import STRESSES
from cosserat.rods.kinematics import rotated
from cosserat.rods.places import vertex_at
from cosserat.rods.probes import at_probes
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry
from cosserat.rods.resultants import (
    Resultants,
    contact_director_forces,
    cross,
    intrinsic_director_forces,
    resultants,
    strain_gradients,
)
from cosserat.rods.stresses import SURFACES, beam_stresses, edge_sections
from cosserat.solution import Field, Solution
from cosserat.solvers.equilibrium import Equilibrium
from cosserat.solvers.integrate import State
from cosserat.solvers.loading import coupled_energy, load_energy, load_gradient
from cosserat.solvers.potential import Potential
from cosserat.solvers.reactions import reactions
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
_GIVEN = {
    "_internal": {
        *("xi_edge", "contact_force", "normal_force", "shear_force", "bending_moment"),
        *("fibre_strain", "fibre_stress", "shear_stress"),
    },
    "_director_forces": {"contact_director_force", "intrinsic_director_force"},
    "_reactions": {"reaction_force", "reaction_moment", "reaction_director_force"},
    "_moves": {"u"},
    "_turns": {"rotation", "probe_displacement", "probe_rotation"},
    "_attached": {"attached_force"},
}
"""All that some makers of outputs give, which are left out where nothing of it is needed."""
_ELSEWHERE = set().union(*_GIVEN.values())


@dataclass(frozen=True)
class States:
    """States of a rod whose outputs are asked for.

    energy : strain energy, a potential of displacements.  along : name of the dimension of the states; empty for one.
    u : (S, n) displacements [m].  reactions : (S, n) forces of the constrained DOFs [N].
    couples : (S,) energy of the loads that are not dead [J].
    stresses : loads that are stresses of the rod itself, potentials of displacements, each with its factors (S,).
    attached : (S, n) force of springs and foundations [N]; (S, 0) without them.
    sense : gives (vertex, (S,)) a vertex, and the rotation of its section to within half a turn [rad]; None if that is
        not known.
    """

    problem: RodProblem
    geometry: Geometry
    energy: Potential
    along: str
    u: Array
    reactions: Array
    couples: Array
    stresses: Sequence[tuple[Potential, Array]]
    sense: Callable[[], tuple[int, Array] | None]
    attached: Array

    @cached_property
    def vectors(self) -> Array:
        """Positions and directors, (S, N, m, 2) [m]."""
        rod = self.problem.rod
        at_rest = rod.strain_energy.reference(self.geometry)
        return rod.kinematics.split(at_rest + self.u)

    @cached_property
    def gradient(self) -> Array:
        """Forces of the strains on positions and directors, (S, N, m, 2) [N]."""
        split = self.problem.rod.kinematics.split
        gradient = split(strain_gradients(self.energy, self.u))
        for stress, factor in self.stresses:
            gradient = gradient + split(strain_gradients(stress, self.u) * factor[:, None])
        return gradient


def outputs(states: States, names: Set[str] = frozenset()) -> Solution:
    """Internal forces, stresses, reactions, rotations, probes and parts of the energy.

    names : of the fields that are needed; all of them if there are none.
    """
    made = Solution({}, {}, {"axis": states.problem.rod.kinematics.axes})
    makers = _internal, _director_forces, _reactions, _moves, _turns, _parts_of_energy, _attached
    for maker in makers:
        if names and not names & _GIVEN.get(maker.__name__, names - _ELSEWHERE):
            continue
        more = maker(states)
        made = Solution({**made.fields, **more.fields}, {}, {**made.labels, **more.labels})
    if states.along:
        return made
    one = {
        name: (dims[1:], values[0]) if dims[0] == states.along else (dims, values)
        for name, (dims, values) in made.fields.items()
    }
    return replace(made, fields=one)


def _internal(states: States) -> Solution:
    """N, Q, M, and stresses as beams have them."""
    arc = states.geometry.arc_length
    found = resultants(states.vectors, states.gradient)
    edge, vector = (states.along, "edge"), (states.along, "edge", "axis")
    fields: dict[str, Field] = {
        "xi_edge": (("edge",), (arc[1:] + arc[:-1]) / 2),
        "contact_force": (vector, found.force),
        "normal_force": (edge, found.normal),
        "shear_force": (edge, found.shear),
        "bending_moment": (edge, found.moment),
    }
    return Solution(fields | _stresses(states, found), {}, {"surface": SURFACES})


def _director_forces(states: States) -> Solution:
    """The forces on directors, of an energy that has them."""
    rod = states.problem.rod
    between, count = rod.strain_energy.between, len(rod.kinematics.vectors)
    if not between:
        return Solution({}, {})
    contact = contact_director_forces(states.energy, between, states.u, count)
    for stress, factor in states.stresses:
        own = contact_director_forces(stress, between, states.u, count)
        contact = contact + own * factor[:, None, None]
    intrinsic = intrinsic_director_forces(contact, states.gradient[..., 1, :])
    fields: dict[str, Field] = {
        "contact_director_force": ((states.along, "edge", "axis"), contact),
        "intrinsic_director_force": ((states.along, "vertex", "axis"), intrinsic),
    }
    return Solution(fields, {})


def _stresses(states: States, found: Resultants) -> dict[str, Field]:
    arc = states.geometry.arc_length
    sections = edge_sections(states.problem.rod, (arc[1:] + arc[:-1]) / 2)
    if sections is None:
        return {}
    stress = beam_stresses(sections, found)
    edge = (states.along, "edge")
    fields: dict[str, Field] = {"fibre_strain": ((*edge, "surface"), stress.strain)}
    if stress.fibre is not None and stress.shear is not None:
        fields["fibre_stress"] = ((*edge, "surface"), stress.fibre)
        fields["shear_stress"] = (edge, stress.shear)
    return fields


def _reactions(states: States) -> Solution:
    """Force and couple of the supports of each vertex that has some."""
    rod = states.problem.rod
    held = rod.kinematics.split(states.problem.held(states.geometry)[0]).any(axis=(1, 2))
    vertices = np.flatnonzero(held)
    if not vertices.size:
        return Solution({}, {})
    force = rod.kinematics.split(states.reactions)[:, vertices]
    along = (states.along, "support")
    directors = states.vectors[:, vertices, 1:]
    fields: dict[str, Field] = {
        "reaction_force": ((*along, "axis"), force[:, :, 0]),
        "reaction_moment": (along, cross(directors, force[:, :, 1:]).sum(axis=-1)),
        "reaction_director_force": ((*along, "axis"), force[:, :, 1]),
    }
    arc, names = states.geometry.arc_length, dict[int, str]()
    items = [item for _, item in states.problem.constraints()]
    for item in sorted(items, key=lambda item: item.label == str(item.at)):  # names before places
        names.setdefault(vertex_at(item.at, arc), item.label)
    return Solution(fields, {}, {"support": tuple(names[int(vertex)] for vertex in vertices)})


def _moves(states: States) -> Solution:
    """Displacements of the vertices."""
    moved = states.vectors[:, :, 0] - states.geometry.X
    return Solution({"u": ((states.along, "vertex", "axis"), moved)}, {})


def _turns(states: States) -> Solution:
    """Rotations of the sections, and what the named points do."""
    problem, vectors = states.problem, states.vectors
    turned = rotations(vectors[:, :, 1], states.geometry.D, states.sense())
    fields: dict[str, Field] = {"rotation": ((states.along, "vertex"), turned)}
    if not problem.probes:
        return Solution(fields, {})
    arc, moved = states.geometry.arc_length, vectors[:, :, 0] - states.geometry.X
    read = at_probes(problem.probes, arc, np.concatenate([moved, turned[..., None]], axis=-1))
    fields["probe_displacement"] = ((states.along, "probe", "axis"), read[..., :2])
    fields["probe_rotation"] = ((states.along, "probe"), read[..., 2])
    return Solution(fields, {}, {"probe": tuple(probe.name for probe in problem.probes)})


def attached_forces(system: MechanicalSystem, states: Sequence[Equilibrium | State]) -> Array:
    """The force of springs and foundations, (S, n) [N]; (S, 0) without them."""
    if not system.attached:
        return np.zeros((len(states), 0))
    return np.array([system.attached_force(state.q, state.history) for state in states])


def _attached(states: States) -> Solution:
    """The force of springs and foundations."""
    if not states.attached.size:
        return Solution({}, {})
    kinematics = states.problem.rod.kinematics
    shape = (states.attached.shape[0], -1, kinematics.per_vertex)
    force = states.attached.reshape(shape)
    dims = (states.along, "vertex", "dof")
    return Solution({"attached_force": (dims, force)}, {}, {"dof": kinematics.dofs})


def _parts_of_energy(states: States) -> Solution:
    """The energy by term, and what else the energy itself gives of a state."""
    energy = states.problem.rod.strain_energy
    labels, own = energy.fields(
        states.problem.rod, states.geometry, states.energy, states.u, states.couples
    )
    fields: dict[str, Field] = {
        name: ((states.along, *dims), values) for name, (dims, values) in own.items()
    }
    return Solution(fields, {}, labels)


def rotations(d: Array, D: Array, sense: tuple[int, Array] | None) -> Array:
    """Angles of directors (S, N, 2) from those of the reference (N, 2), counted through whole turns: (S, N) [rad].

    Neighbouring sections are within half a turn of each other, and so are those of one vertex in neighbouring states.
    sense : what that of `States` gives; without it the first section of the first state is within half a turn of its
        reference.
    """
    own = rotated_back(d, D)
    steps = np.arctan2(cross(own[:, :-1], own[:, 1:]), (own[:, :-1] * own[:, 1:]).sum(axis=-1))
    first = np.arctan2(own[:, :1, 1], own[:, :1, 0])
    angles = np.cumsum(np.concatenate([first, steps], axis=1), axis=1)
    if sense is None:
        return np.asarray(angles + (np.unwrap(first, axis=0) - first))
    vertex, near = sense
    whole = np.round((near - angles[:, vertex]) / (2 * np.pi))
    return np.asarray(angles + 2 * np.pi * whole[:, None])


def rotated_back(d: Array, D: Array) -> Array:
    """Directors (S, N, 2) seen from those of the reference (N, 2), as if these were along E3."""
    back = np.broadcast_to(-np.arctan2(D[:, 1], D[:, 0]), d.shape[:-1])
    return rotated(d.reshape(-1, 2), back.reshape(-1, 1)).reshape(d.shape)


def of_equilibria(
    problem: RodProblem,
    geometry: Geometry,
    system: MechanicalSystem,
    points: Sequence[Equilibrium],
    along: str,
    couples: Array,
) -> States:
    """States of equilibria; the system is one of displacements; couples : as in `States`."""
    factors = np.array([point.factor for point in points])
    held = [(load, np.ones_like(factors)) for load in system.held if load.terms == STRESSES]
    return States(
        problem,
        geometry,
        system.internal,
        along,
        np.array([point.q for point in points]),
        np.array([point.reaction for point in points]),
        couples,
        [(stress, factors) for stress in problem.stresses(geometry)] + held,
        partial(_held_section, problem, geometry, factors),
        attached_forces(system, points),
    )


def _held_section(problem: RodProblem, geometry: Geometry, factors: Array) -> tuple[int, Array] | None:
    """A section that supports hold, and its rotation at some load factors [rad]."""
    rod = problem.rod
    held = rod.kinematics.split(problem.held(geometry)[0])[:, 1].all(axis=-1)
    if not held.any():
        return None
    vertex = int(np.argmax(held))
    arc = geometry.arc_length
    grown, before = (
        sum(turn.by for turn in turns if vertex_at(turn.at, arc) == vertex)
        for turns in (problem.prescribed_rotations, problem.turned_before)
    )
    return vertex, factors * grown + before


def of_instants(
    problem: RodProblem,
    geometry: Geometry,
    system: MechanicalSystem,
    instants: Sequence[State],
    first_angle: Array,
) -> States:
    """States of a motion, whose system is one of positions.

    first_angle : angle of the first director through whole turns, (S,) [rad].
    """
    rod, frame, given = problem.rod, system.frame, instants
    instants = [replace(state, q=frame.out(state.q), v=frame.out(state.v)) for state in given]
    q = np.array([state.q for state in instants])
    start = float(np.arctan2(geometry.D[0, 1], geometry.D[0, 0]))
    return States(
        problem,
        geometry,
        problem.energy(geometry),
        "time",
        q - rod.strain_energy.reference(geometry),
        frame.out(reactions(system, given)),
        np.array([system.nonlinear_load_energy(state.q, state.history) for state in given]),
        [(stress, _levels(stress, given)) for stress in problem.stresses(geometry)],
        lambda: (0, first_angle - start),
        attached_forces(system.unframed, instants),
    )


def _levels(load: Potential, instants: Sequence[State]) -> Array:
    """The factor of a load at some instants, (S,)."""
    times = np.array([state.time for state in instants])
    return np.ones_like(times) if load.level is None else load.level.value(times)


def parts_of_energy(
    system: MechanicalSystem, points: Sequence[Equilibrium]
) -> tuple[Array, Array, Array]:
    """Strain energy, that of springs and, at the load factor, that of the loads that are not dead, (S,) each [J]."""
    strain = np.array([system.internal.energy(point.q) for point in points])
    attached = np.zeros(len(points))
    if system.attached:
        attached = np.array([system.attached_energy(point.q, point.history) for point in points])
    return strain, attached, coupled_energies(system, points)


def coupled_energies(system: MechanicalSystem, points: Sequence[Equilibrium]) -> Array:
    """The energy of the loads that are not dead, (S,) [J]."""
    if not system.held and all(load.linear for load in system.external):
        return np.zeros(len(points))
    return np.array([coupled_energy(system, point) for point in points])


def energies(
    system: MechanicalSystem, points: Sequence[Equilibrium], parts: tuple[Array, Array, Array]
) -> dict[str, Array]:
    """Strain energy, energy of springs, and potential of the loads at their load factor, (S,) each [J]."""
    strain, attached, coupled = parts
    loads = [load_energy(system, *one) for one in zip(points, coupled, strict=True)]
    return {"strain_energy": strain, "attached_energy": attached, "load_potential": np.array(loads)}


def work_along(system: MechanicalSystem, points: Sequence[Equilibrium]) -> dict[str, Array]:
    """Work of the loads and of the moved supports from the first point of a path to each, (S,) each [J].

    By the trapezoidal rule from point to point: of second order in their distance.
    """
    q = np.array([point.q for point in points])
    loads = np.array([-load_gradient(system, point) for point in points])
    held = np.array([point.reaction for point in points])
    moved = np.diff(q, axis=0)
    steps = [((forces[1:] + forces[:-1]) / 2 * moved).sum(axis=1) for forces in (loads, held)]
    by_loads, by_supports = (np.concatenate([[0.0], np.cumsum(step)]) for step in steps)
    return {"total_load_work": by_loads, "support_work": by_supports}
