"""What the book plays: stored cases as stages of the player, by the names that chapters use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from cosserat.data.dataset import problem_of
from cosserat.exact import beams
from cosserat.figures import animations, crawling
from cosserat.figures.stage import Panel, Slider, Stage
from cosserat.problems.calibration import beam_of
from cosserat.rods.problem import RodProblem
from cosserat.thesis.earthworm import SEGMENT_50
from cosserat.thesis.table.crawl_readouts import instants_per_stride

Data = Mapping[str, xr.Dataset]

_RELAXING = ("hanging_bar", "clamped_free", "clamped_clamped", "necking")
_SETTLED = 0.75  # s, after which no eye sees a motion
_TALL = 3.0  # magnification of the height of the worm, which is thirty times as long
_STATES = 120  # of a crawl


@dataclass(frozen=True)
class Played:
    """One player of the book: the cases that it needs, and the function that makes its stage of them."""

    cases: tuple[str, ...]
    stage: Callable[[Data], Stage]


def worm(data: Data) -> Stage:
    """Two strides of the worm."""
    run = data["worm"].isel(time=slice(0, 2 * instants_per_stride(data["worm"]) + 1))
    alt = (
        "The earthworm from the side. Its front half grows thin and reaches forward while its rear stays"
        " at the anchor; then the front holds and the rear is pulled after it. It moves forward in each "
        "of two strides."
    )
    return replace(
        crawling.animate(run, _STATES, tall=_TALL, mark=SEGMENT_50, alt=alt),
        title="The earthworm crawls",
    )


def robot(data: Data) -> Stage:
    """Two cycles of the robot, four times as fast."""
    run = data["soft_robot"]
    alt = (
        "The soft robot from the side. A thin part grows from its front while the rear is anchored; then"
        " the front is the anchor, the thin part leaves through the rear, and the rear moves up."
    )
    stage = crawling.animate(run, _STATES, alt=alt)
    return replace(stage, title="The soft robot crawls", seconds=float(run.time[-1]) / 4)


def vibration(data: Data) -> Stage:
    """One period of the vibrating beam with its energies."""
    run = data["vibration_c4_20"]
    period = 2 * np.pi / beams.first_frequency(beam_of(problem_of(run, RodProblem)))
    part = run.sel(time=slice(0, 0.963 * period))
    alt = (
        "A clamped beam swings down and up again once, displacements magnified. Meanwhile its strain "
        "energy goes to nearly zero and back twice, and the kinetic energy has its largest values where "
        "the strain energy is smallest."
    )
    stage = animations.motion(part, part.sizes["time"])
    return replace(stage, title="One period of the vibrating beam", alt=alt, seconds=6.0)


def relaxation(data: Data) -> Stage:
    """The four static problems, released from their reference, settle under their loads."""
    panels, time = [], np.empty(0)
    for name in _RELAXING:
        run = data[f"relaxing_{name}"]
        part = run.sel(time=slice(0, _SETTLED))
        time = part.time.to_numpy()
        panels.append(animations.magnified_panel(part, name.replace("_", " ")))
    alt = (
        "Four rods side by side, displacements magnified: a hanging bar grows longer, a clamped beam "
        "sinks at its free end, a beam clamped at both ends sags in the middle, a pulled bar grows "
        "longer and thinner. Each overshoots little or not."
    )
    return Stage(
        "The four rods settle", alt, tuple(panels), Slider("time", time, "s", 3), 5.0, poster=(0, -1)
    )


def tumbling(data: Data) -> Stage:
    """The thrown rod."""
    alt = (
        "A rod without supports flies upwards, turns, bends to and fro and changes its length. Its "
        "kinetic and strain energy oppose each other."
    )
    run = data["tumbling"]
    stage = animations.motion(run, run.sizes["time"])
    change = run.kinetic_energy - run.kinetic_energy[0]
    parts = (
        *animations.curve(
            run.time.to_numpy(), run.strain_energy.to_numpy(), "variant", "strain energy", "6 3"
        ),
        *animations.curve(
            run.time.to_numpy(), change.to_numpy(), "computed", "change of the kinetic energy"
        ),
    )
    panels = (stage.panels[0], Panel(parts, "time [s]", "energy [J]"))
    return replace(
        stage, title="A rod in the air", alt=alt, panels=panels, poster=(0, 33, 66, -1), seconds=8.0
    )


def along_path(case: str, title: str, alt: str, middle: int) -> Played:
    """A case along its path; without scripts its first, its last and the point `middle` between them are seen."""

    def stage(data: Data) -> Stage:
        return replace(animations.path(data[case]), title=title, alt=alt, poster=(0, middle, -1))

    return Played((case,), stage)


PLAYED = {
    "play_robot": Played(("soft_robot",), robot),
    "play_worm": Played(("worm",), worm),
    "play_vibration": Played(("vibration_c4_20",), vibration),
    "play_relaxation": Played(tuple(f"relaxing_{name}" for name in _RELAXING), relaxation),
    "play_tumbling": Played(("tumbling",), tumbling),
    "play_column": along_path(
        "column_path",
        "A column buckles",
        "A column under a thrust. It stays nearly straight until the load comes near the critical one, "
        "then it bends aside far while the load hardly grows; the dot on the load curve turns from steep"
        " to flat.",
        8,
    ),
    "play_arch": along_path(
        "arch_path",
        "An arch snaps through",
        "An arch on two hinges under a load at its middle. The load grows to a first limit, falls below "
        "zero while the arch turns over, and grows again when the arch hangs on the other side; between "
        "both limits it is unstable.",
        18,
    ),
}
"""Players by the names that chapters use."""
