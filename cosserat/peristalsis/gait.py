"""Gaits as data, section 2.5: fronts that travel through the body, or chambers, and the point anchored to the ground.

Times count phases: 0 is the start of the first phase, 1 its end, 1.5 the middle of the second.  Places are fractions
of the reference length: 0 the rear end, 1 the front end.
"""

from __future__ import annotations

import bisect
import functools
import itertools
import math
from dataclasses import dataclass, replace
from typing import Annotated, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Items, Parameters, Quantity
from cosserat.peristalsis import chambers as scheduled
from cosserat.peristalsis.chambers import Chamber, RampForm, State
from cosserat.peristalsis.measured import Measured
from cosserat.peristalsis.region import Muscle, Region, changed, load_ahead, load_behind
from cosserat.peristalsis.tracks import (
    PHASE_TOLERANCE,
    Track,
    check_track,
    check_work,
    distinct,
    follow,
    place_of,
)

_BREAK_OFFSET = 1e-7  # distance from a break at which its two sides are compared, in phases
_CHANGE_TOLERANCE = 1e-4  # fraction of the body that fronts pass between those sides, and the clearance
_MOST_INSTANTS = 20_000
_MOST_TRACKS = 100


@dataclass(frozen=True)
class Instant:
    """One instant of a gait: time [s] since the start of the stride, the regions, the anchored place."""

    phase: float
    time: float
    regions: tuple[Region, ...]
    anchor: float

    def risen(self, amplitude: float) -> Instant:
        """The same instant with this part of its loads."""
        weaker = (replace(r, amplitude=amplitude * r.amplitude) for r in self.regions)
        return replace(self, regions=tuple(weaker))


class Gait(Parameters):
    """A periodic gait.

    A front gamma has anchoring loads behind it and advancing loads before it; a front eta the other way round.  If one
    track ends when another begins, the first one counts at that time.  Chambers may take the place of fronts.
    """

    phases: Annotated[
        tuple[Annotated[float, Quantity("s", "t_p, t_s", "section 2.8", above=0)], ...],
        Items(at_most=_MOST_TRACKS),
    ]
    """Durations of the phases of one stride; tracks count phases from 0."""
    gamma: Annotated[tuple[Track, ...], Items(at_most=_MOST_TRACKS)] = ()
    """Tracks of the fronts gamma, each of points [phase, place]; a place is a fraction of the length from the rear."""
    eta: Annotated[tuple[Track, ...], Items(at_most=_MOST_TRACKS)] = ()
    """Tracks of the fronts eta, each a list of points [phase, place]."""
    anchor: Annotated[tuple[Track, ...], Items(at_most=_MOST_TRACKS)] = ()
    """Tracks of the point anchored to the ground, likewise; they follow each other without gaps."""
    measured: Annotated[tuple[Measured, ...], Items(at_most=_MOST_TRACKS)] = ()
    """Measured tracks, in addition to those above."""
    chambers: Annotated[tuple[Chamber, ...], Items(at_most=_MOST_TRACKS)] = ()
    """Chambers from the rear to the front, in place of fronts."""
    at_rest: Muscle = "anchoring"
    """The load on the whole body while no front is on it, or where no row of a chamber says another."""
    ramp: Annotated[float, Quantity("s", at_least=0)] = 0.0
    """Time in which a load of a chamber rises after its start and falls before its end.

    With fronts, the time in which all loads rise at the start of the first stride, from a relaxed body.
    """
    ramp_form: RampForm = "linear"
    """Whether a load rises along a straight line, or smoothly, with no rate at either end."""
    clearance: Annotated[float, Quantity("1", "", "2.5.9", above=0, below=0.1)] = 1e-6
    """A front nearer to an end than this has left the body.  ASSUME next to nothing: no stride depends on it, E2.14."""
    sudden: Annotated[float, Quantity("1", at_least=0)] = 0.0
    """Largest fraction of the body whose load may change at once, where tracks end and begin."""

    @model_validator(mode="after")
    def _is_a_gait(self) -> Self:
        _ = self._checked  # once, however many cases share this gait
        return self

    @functools.cached_property
    def _checked(self) -> bool:
        """True, or what a gait may not be is raised."""
        if not self.phases:
            raise PydanticCustomError(
                "gait", "'phases' is empty; give the duration of at least one phase"
            )
        check_work((*self.gamma, *self.eta, *self.anchor, *(m.table for m in self.measured)))
        self._check_measured()
        self._check_chambers()
        for name in ("gamma", "eta", "anchor"):
            for number, track in enumerate(self.tracks(name)):
                check_track(f"'{name}.{number}'", track, len(self.phases))
        self._check_anchor()
        for begin, end in itertools.pairwise(self.breaks()):
            self._refuse_crossing(begin, end)
            for phase in (begin, (begin + end) / 2, end):
                self._refuse_overlap(phase)
        for phase in self.breaks():
            self._refuse_sudden_change(phase)
        return True

    @property
    def duration(self) -> float:
        """Duration of one stride [s]."""
        return math.fsum(self.phases)

    def tracks(self, kind: str) -> tuple[Track, ...]:
        """The tracks of the fronts "gamma" or "eta", or of the "anchor", those measured in phases and fractions."""
        given: tuple[Track, ...] = getattr(self, kind)
        return given + tuple(
            track for m, track in zip(self.measured, self._converted, strict=True) if m.front == kind
        )

    @functools.cached_property
    def _converted(self) -> tuple[Track, ...]:
        """The measured tracks in phases and fractions."""
        return tuple(
            tuple((self.phase(time), at / m.length) for time, at in m.table) for m in self.measured
        )

    def breaks(self) -> list[float]:
        """Phases at which a track or a load begins, ends or turns, and the ends of all phases, increasing."""
        tracks = itertools.chain(*map(self.tracks, ("gamma", "eta", "anchor")))
        found = [float(n) for n in range(len(self.phases) + 1)] + [
            p for track in tracks for p, _ in track
        ]
        if self.chambers:
            found += scheduled.breaks(self.chambers, self.at_rest, self.last, self._a_ramp_from)
        elif self.ramp:
            found.append(self.phase(self.ramp))
        return distinct(found)

    @property
    def last(self) -> float:
        """The phase at which a stride ends."""
        return float(len(self.phases))

    def time(self, phase: float) -> float:
        """Seconds since the start of the stride."""
        whole = min(int(phase), len(self.phases) - 1)
        return self._starts[whole] + (phase - whole) * self.phases[whole]

    def phase(self, time: float) -> float:
        """The phase at a time [s] since the start of the stride; beyond its end, as if the last phase went on."""
        whole = max(
            n
            for n, start in enumerate(self._starts)
            if n == 0 or time >= start - PHASE_TOLERANCE * self.phases[n]
        )
        return whole + max(0.0, (time - self._starts[whole]) / self.phases[whole])

    @functools.cached_property
    def _starts(self) -> tuple[float, ...]:
        """When each phase starts [s]."""
        return tuple(math.fsum(self.phases[:n]) for n in range(len(self.phases)))

    def rise(self, time: float) -> float:
        """The part of the loads that acts at a time [s] of the first stride; chambers have ramps of their own."""
        return (
            1.0 if self.chambers or not self.ramp else scheduled.ramp(time / self.ramp, self.ramp_form)
        )

    def first_change(self) -> float:
        """The fraction of the body whose load at the start of the first stride is not that at the end of a stride."""
        return 0.0 if self.chambers or self.ramp else changed(self.regions(self.last), self.regions(0.0))

    def _a_ramp_from(self, phase: float, ramps: float) -> float:
        return self.phase(self.time(phase) + ramps * self.ramp)

    def _amplitude(self, state: State, phase: float) -> float:
        """The part of the load of a state that acts."""
        now = self.time(phase)
        shares = [1.0] if self.ramp else []
        if self.ramp and state.rises:
            shares.append((now - self.time(state.begin)) / self.ramp)
        if self.ramp and state.falls:
            shares.append((self.time(state.end) - now) / self.ramp)
        return scheduled.ramp(min(shares), self.ramp_form) if shares else 1.0

    def fronts(self, phase: float) -> list[tuple[float, str]]:
        """Places and kinds ("gamma" or "eta") of the fronts on the body, from the rear, their tracks' ends included."""
        found = []
        for kind in ("gamma", "eta"):
            for track in self.tracks(kind):
                place = follow(track, phase)
                if place is not None:
                    inside = phase - _BREAK_OFFSET if phase > track[0][0] else phase + _BREAK_OFFSET
                    found.append(
                        (place, place_of(track, inside), kind)
                    )  # two at one end: in their order inside the body
        return [(place, kind) for place, _, kind in sorted(found)]

    def regions(self, phase: float) -> tuple[Region, ...]:
        """The regions of one time, without those shorter than the clearance."""
        if self.chambers:
            return scheduled.regions(self.chambers, self.at_rest, self.last, phase, self._amplitude)
        load: Muscle = self.at_rest
        fronts = self.fronts(phase)
        if fronts:
            load = load_behind(fronts[0][1])
        cuts = [0.0]
        loads = [load]
        for place, kind in fronts:
            load = load_ahead(kind)
            if place < self.clearance:
                loads[-1] = load
            elif place <= 1 - self.clearance:
                cuts.append(place)
                loads.append(load)
        return tuple(Region(a, b, m) for a, b, m in zip(cuts, [*cuts[1:], 1.0], loads, strict=True))

    def anchored(self, phase: float) -> float:
        """The place anchored to the ground."""
        for track in self.tracks("anchor"):
            place = follow(track, phase)
            if place is not None:
                return place
        raise AssertionError("the tracks of the anchor were checked to cover the stride")

    def instant(self, phase: float) -> Instant:
        """The instant at a phase."""
        return Instant(phase, self.time(phase), self.regions(phase), self.anchored(phase))

    def instants(self, step: float) -> tuple[Instant, ...]:
        """The instants of one stride: its breaks, and between them at most `step` [s] apart."""
        return _instants(self, step)

    def idle_phase(self, step: float) -> float | None:
        """The first phase at which no region anchors, if there is one."""
        return _idle_phase(self, step)

    def telling_phases(self, step: float) -> list[float]:
        """Phases of its breaks and of one instant between each two: all that tell which loads ever act."""
        phases, found = self.divided(step), self.breaks()
        for begin, end in itertools.pairwise(tuple(found)):
            next_one = phases[bisect.bisect_right(phases, begin + PHASE_TOLERANCE)]
            if next_one < end - PHASE_TOLERANCE:
                found.append(next_one)
        return sorted(found)

    def check_step(self, step: float) -> None:
        """Raise PydanticCustomError if a step [s] makes too many instants."""
        if self.duration > _MOST_INSTANTS * step:
            raise PydanticCustomError(
                "step",
                f"'step' = {step:g} s divides a stride of {self.duration:g} s into more than {_MOST_INSTANTS} "
                "instants; take a longer one",
            )

    def divided(self, step: float) -> list[float]:
        """The phases of the instants, increasing."""
        phases = self.breaks()
        for number, duration in enumerate(self.phases):
            count = max(1, math.ceil(duration / step - PHASE_TOLERANCE))
            phases.extend(number + k / count for k in range(count + 1))
        return distinct(phases)

    def _check_measured(self) -> None:
        for number, measured in enumerate(self.measured):
            for time, place in measured.table:
                if not (
                    0 <= time <= self.duration * (1 + PHASE_TOLERANCE) and 0 <= place <= measured.length
                ):
                    raise PydanticCustomError(
                        "gait",
                        f"'measured.{number}' is at {place:g} m at {time:g} s; times run from 0 to the "
                        f"{self.duration:g} s of a stride, and places from 0 to the {measured.length:g} m of the body",
                    )

    def _check_chambers(self) -> None:
        if not self.chambers:
            if self.ramp > self.duration:
                raise PydanticCustomError(
                    "gait",
                    f"'ramp' is {self.ramp:g} s, longer than a stride of {self.duration:g} s; take a shorter one",
                )
            return
        if self.tracks("gamma") or self.tracks("eta"):
            raise PydanticCustomError("gait", "has both 'chambers' and fronts; give one of them")
        scheduled.check(self.chambers, self.last)
        for number, chamber in enumerate(self.chambers):
            for state in scheduled.states(chamber, self.at_rest, self.last):
                lasts = self.time(state.end) - self.time(state.begin)
                if (state.rises + state.falls) * self.ramp > lasts * (1 + PHASE_TOLERANCE):
                    raise PydanticCustomError(
                        "gait",
                        f"'ramp' is {self.ramp:g} s, too long for the state '{state.load}' of 'chambers.{number}', "
                        f"which lasts {lasts:g} s and rises or falls within it; take a shorter one",
                    )

    def _check_anchor(self) -> None:
        expected = 0.0
        anchors = sorted(self.tracks("anchor"), key=lambda track: track[0][0])
        for track in (*anchors, None):
            begins = len(self.phases) if track is None else track[0][0]
            if abs(begins - expected) > PHASE_TOLERANCE:
                what = "overlaps" if begins < expected else "has a gap"
                raise PydanticCustomError(
                    "gait",
                    f"'anchor' {what} between phases {min(begins, expected):g} and {max(begins, expected):g}; "
                    "let each track begin where the one before it ends, from 0 to the last phase",
                )
            if track is not None:
                expected = track[-1][0]

    def _refuse_sudden_change(self, phase: float) -> None:
        """Fronts carry every change of load; the end of the stride is its start."""
        if self.chambers:
            return  # a schedule says when a load begins
        last = self.last
        before = self.regions((last if phase == 0 else phase) - _BREAK_OFFSET)
        after = self.regions((0.0 if phase == last else phase) + _BREAK_OFFSET)
        part = changed(before, after)
        if part > self.sudden + _CHANGE_TOLERANCE:
            raise PydanticCustomError(
                "gait",
                f"at phase {phase % last:g} the load on {part:.3g} of the body changes at once; let fronts enter "
                "and leave at the ends and the stride end as it began, set 'at_rest', or allow it with 'sudden'",
            )

    def _refuse_crossing(self, begin: float, end: float) -> None:
        """All tracks are straight between two breaks: two of them cross if their order changes."""
        middle = (begin + end) / 2
        active = [
            (kind, track)
            for kind in ("gamma", "eta", "anchor")
            for track in self.tracks(kind)
            if follow(track, middle) is not None
        ]
        for (first, one), (second, other) in itertools.combinations(active, 2):
            before, after = (place_of(one, p) - place_of(other, p) for p in (begin, end))
            if before * after < 0:
                phase = begin + (end - begin) * before / (before - after)
                raise PydanticCustomError(
                    "gait",
                    f"{first} and {second} cross at phase {phase:g}; keep them apart, or end one where the other "
                    "begins",
                )

    def _refuse_overlap(self, phase: float) -> None:
        inner = [f for f in self.fronts(phase) if self.clearance <= f[0] <= 1 - self.clearance]
        for (a, first), (b, second) in itertools.pairwise(inner):
            if first == second or b - a < self.clearance:
                raise PydanticCustomError(
                    "gait",
                    f"at phase {phase:g} the fronts {first} at {a:g} and {second} at {b:g} overlap or leave an empty "
                    "region; gamma and eta must alternate along the body",
                )
        anchor = self.anchored(phase)
        for one, two in itertools.pairwise(self.regions(phase) if self.chambers else ()):
            if one.state != two.state and abs(one.right - anchor) < self.clearance:
                raise PydanticCustomError(
                    "gait",
                    f"at phase {phase:g} the anchor lies at {one.right:g}, where two chambers meet that bear different "
                    "loads; put it inside of one",
                )
        for place, kind in inner:
            if abs(place - anchor) < self.clearance:
                raise PydanticCustomError(
                    "gait",
                    f"at phase {phase:g} the anchor lies on the front {kind} at {place:g}, where the body changes "
                    "under it; put it beside the front",
                )


@functools.lru_cache(maxsize=4)
def _instants(gait: Gait, step: float) -> tuple[Instant, ...]:
    return tuple(map(gait.instant, gait.divided(step)))


@functools.lru_cache(maxsize=4)
def _idle_phase(gait: Gait, step: float) -> float | None:
    return next(
        (
            phase
            for phase in gait.telling_phases(step)
            if not any(region.load == "anchoring" for region in gait.regions(phase))
        ),
        None,
    )
