"""Chambers: parts of the body whose loads follow schedules, each with its own force or pressure."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters, Quantity
from cosserat.peristalsis.region import Muscle, Region

Phase = Annotated[float, Quantity("1", at_least=0)]
Place = Annotated[float, Quantity("1", r"\tilde{z}", "2.3.14")]
RampForm = Literal["linear", "smooth"]
_MOST_ROWS = 200  # of the schedules of all chambers, which are compared with each other
NEAR = 1e-9  # phases and places closer than this are one


class Chamber(Parameters):
    """A part of the body whose load follows a schedule."""

    begin: Place
    """Start of the chamber, a fraction of the length from the rear end."""
    end: Place
    """End of the chamber, likewise."""
    schedule: tuple[tuple[Phase, Phase, Muscle], ...]
    """Rows [from phase, to phase, load] of one stride in order; outside of them the load is that of 'at_rest'."""
    force: Annotated[float, Quantity("N", r"\bar{D}", "2.2.7", at_least=0)] | None = None
    """Force of its longitudinal muscles; by default that of 'loads.anchoring'."""
    pressure: Annotated[float, Quantity("Pa", "p", "2.2.8")] | None = None
    """Pressure of its circular muscles; by default that of 'loads.advancing'."""

    def own(self, load: Muscle) -> float | None:
        """The own strength of a load [N or Pa]; None if it is that of the loads."""
        return {"anchoring": self.force, "advancing": self.pressure}.get(load)


@dataclass(frozen=True)
class State:
    """A load of a chamber between two phases, and whether it rises at its start and falls before its end."""

    begin: float
    end: float
    load: Muscle
    rises: bool
    falls: bool


def states(chamber: Chamber, at_rest: Muscle, last: float) -> list[State]:
    """What loads a chamber from phase 0 to the last one.  A stride follows a stride: its end is beside its start."""
    rows: list[tuple[float, float, Muscle]] = []
    cursor = 0.0
    for begin, end, load in (*chamber.schedule, (last, last, at_rest)):
        if begin > cursor + NEAR:
            rows.append((cursor, begin, at_rest))
        if end > begin:
            rows.append((begin, end, load))
        cursor = end
    joined = rows[:1]
    for row in rows[1:]:
        if row[2] == joined[-1][2]:
            joined[-1] = (joined[-1][0], row[1], row[2])
        else:
            joined.append(row)
    loads = [row[2] for row in joined]
    return [
        State(begin, end, load, rises=before != load, falls=after != load)
        for (begin, end, load), before, after in zip(
            joined, [loads[-1], *loads[:-1]], [*loads[1:], loads[0]], strict=True
        )
    ]


def ramp(share: float, form: RampForm) -> float:
    """The amplitude of a load that has risen for this share of the ramp, from 0 to 1."""
    s = min(1.0, max(0.0, share))
    return s * s * (3 - 2 * s) if form == "smooth" else s


def breaks(
    chambers: Sequence[Chamber], at_rest: Muscle, last: float, phase_of: Callable[[float, float], float]
) -> list[float]:
    """Phases at which a load of a chamber begins, has risen, starts to fall or ends.

    phase_of : from a phase and -1, 0 or 1, the phase a ramp before it, itself, or the phase a ramp after it.
    """
    found = []
    for chamber in chambers:
        for state in states(chamber, at_rest, last):
            found += [state.begin, state.end]
            found += [phase_of(state.begin, 1)] * state.rises + [phase_of(state.end, -1)] * state.falls
    return found


def regions(
    chambers: Sequence[Chamber],
    at_rest: Muscle,
    last: float,
    phase: float,
    amplitude: Callable[[State, float], float],
) -> tuple[Region, ...]:
    """The loads along the body at a phase; at the end of one load and the start of another the first one counts."""
    now = last if phase < NEAR else phase
    found: list[Region] = []
    cursor = 0.0
    for chamber in chambers:
        if chamber.begin > cursor + NEAR:
            found.append(Region(cursor, chamber.begin, at_rest))
        every = states(chamber, at_rest, last)
        state = next(s for s in every if now <= s.end + NEAR)
        strength = 1.0 if state.load == "relaxed" else amplitude(state, now)
        begin = found[-1].right if found else 0.0
        found.append(Region(begin, chamber.end, state.load, strength, chamber.own(state.load)))
        cursor = chamber.end
    if cursor < 1 - NEAR:
        found.append(Region(cursor, 1.0, at_rest))
    return tuple(found)


def check(chambers: Sequence[Chamber], last: float) -> None:
    """Raise PydanticCustomError if chambers overlap or leave the body, or if rows overlap or leave the stride."""
    rows = sum(len(chamber.schedule) for chamber in chambers)
    if rows > _MOST_ROWS:
        raise PydanticCustomError(
            "gait", f"has {rows} rows in 'chambers' together; give {_MOST_ROWS} or fewer"
        )
    for number, chamber in enumerate(chambers):
        name = f"'chambers.{number}'"
        if not 0 <= chamber.begin < chamber.end <= 1:
            raise PydanticCustomError(
                "chambers",
                f"{name} runs from {chamber.begin:g} to {chamber.end:g}; let it begin before it ends, from 0 to 1",
            )
        times = [time for begin, end, _ in chamber.schedule for time in (begin, end)]
        if any(b < a - NEAR for a, b in itertools.pairwise(times)) or any(
            end <= begin for begin, end, _ in chamber.schedule
        ):
            raise PydanticCustomError(
                "chambers",
                f"{name} has a 'schedule' whose rows overlap or do not advance; give rows [from, to, load] in order",
            )
        if times and times[-1] > last + NEAR:
            raise PydanticCustomError(
                "chambers",
                f"{name} has a 'schedule' that ends at phase {times[-1]:g}, but 'phases' has {last:g}; end it there",
            )
    for number, (one, other) in enumerate(itertools.pairwise(chambers)):
        if other.begin < one.end - NEAR:
            raise PydanticCustomError(
                "chambers",
                f"'chambers.{number + 1}' begins at {other.begin:g}, before the one behind it ends at {one.end:g}; "
                "give them from the rear to the front, without overlap",
            )
