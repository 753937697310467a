"""Results of rods as stages of the player: natural modes, critical loads, motions and paths.

Each takes a Dataset and the most states that are shown.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.animated import FRAMES
from cosserat.figures.modes import SHOWN, amplitude, buckled, mode_shape, spoken
from cosserat.figures.rod import draw_loads, magnification, outline
from cosserat.figures.stage import Line, Mark, Panel, Slider, Stage, chosen
from cosserat.figures.strokes import strokes
from cosserat.figures.supports import draw_masses, draw_supports
from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]

ALONG, UP = "along E\N{SUBSCRIPT THREE} [m]", "along E\N{SUBSCRIPT TWO} [m]"
_FLAT = 0.45  # a body lower than this share of its length takes a row of its own
_CYCLE = 3.0  # seconds of one cycle of a mode
_STATES = 72  # of one cycle
_PACE = (2.0, 8.0)  # shortest and longest time that anything else plays [s]
_STATES_PER_SECOND = 12


def body_panel(
    problem: RodProblem,
    reference: tuple[Array, Array],
    moved: tuple[Array, Array],
    *,
    times: Array | None = None,
    loads: bool = False,
    title: str = "",
    wide: bool | None = None,
) -> Panel:
    """A rod in its states over its dotted reference, with supports, masses and, if asked, loads.

    reference : x and d of shape (N, 2).  moved : x and d of shape (states, N, 2), magnified as they shall be drawn.
    times : of the states [s], for loads that vary in time.
    """
    x, d = moved

    def signs(ax: Axes, state: int) -> None:
        draw_supports(ax, problem, x[state], reference[1])
        draw_masses(ax, problem, x[state], d[state])
        if loads:
            draw_loads(ax, problem, x[state], d[state], None if times is None else float(times[state]))

    surface, still = outline(x, d, problem), outline(*reference, problem)
    parts = (
        Line(
            still[:, 0], still[:, 1], look="exact", closed=True, width=0.9, dash="2 3", label="reference"
        ),
        Line(surface[..., 0], surface[..., 1], "computed", "body", closed=True, width=1.1),
        *strokes(signs, x.shape[0]),
    )
    if wide is None:
        every = np.concatenate([surface.reshape(-1, 2), still])
        size = np.ptp(every, axis=0)
        wide = bool(size[1] < _FLAT * size[0])
    return Panel(parts, ALONG, UP, true=True, wide=wide, title=title)


def curve(
    x: Array, y: Array, look: str = "computed", label: str = "", dash: str = ""
) -> tuple[Line, Mark]:
    """A curve that stays with a dot that runs along it, both of shape (states,)."""
    return Line(x, y, look, label=label, dash=dash), Mark(x, y, "dot", look)


def modes(data: xr.Dataset, frames: int = FRAMES) -> Stage:
    """The lowest modes side by side, each through one cycle of its own; none grows or fades while it is shown."""
    problem, x, d = problem_of(data, RodProblem), data.x.to_numpy(), data.d.to_numpy()
    degrees, panels = np.linspace(0, 360, min(frames, _STATES) + 1), []
    cycle = np.exp(1j * np.deg2rad(degrees))[:, None, None]
    for mode in range(min(SHOWN, data.sizes["mode"])):
        u, delta = mode_shape(data, mode)
        size = amplitude(problem, np.abs(u), np.abs(delta), d)
        moved = x + size * (cycle * u).real, d + size * (cycle * delta).real
        panels.append(body_panel(problem, (x, d), moved, title=spoken(data, mode), wide=False))
    alt = (
        f"{len(panels)} natural modes of a rod side by side, each moves to and fro along its own shape."
    )
    return _cycling(data, alt, panels, degrees)


def critical(data: xr.Dataset, frames: int = FRAMES) -> Stage:
    """The rod moves to and fro along each mode of its critical loads."""
    problem, reference, panels = problem_of(data, RodProblem), data.d_ref.to_numpy(), []
    degrees = np.linspace(0, 360, min(frames, _STATES) + 1)
    for x, d, u, delta, title in buckled(data):
        size = amplitude(problem, u, delta, d) * np.sin(np.deg2rad(degrees))[:, None, None]
        moved = x + size * u, d + size * delta
        panels.append(
            body_panel(problem, (x, reference), moved, loads=True, title=_short(title), wide=False)
        )
    alt = "A rod under its critical loads moves to and fro along the shape in which it loses its stability."
    return _cycling(data, alt, panels, degrees, 90)


def _short(title: str) -> str:
    return title.replace(" criterion", "").replace(" the loads", "")


def _cycling(data: xr.Dataset, alt: str, panels: list[Panel], degrees: Array, drawn: float = 0) -> Stage:
    poster = tuple(int(np.abs(degrees - angle).argmin()) for angle in (drawn + 180, drawn))
    slider = Slider("phase", degrees, "\N{DEGREE SIGN}", 0)
    return Stage(
        str(data.attrs.get("title", "")), alt, tuple(panels), slider, _CYCLE, loop=True, poster=poster
    )


def motion(data: xr.Dataset, frames: int = FRAMES) -> Stage:
    """The body through the frames of its motion, in equal times, with its energies and the place of its last vertex."""
    shown = chosen(data.sizes["time"], frames)
    state, time = data.isel(time=shown), data.time.to_numpy()[shown]
    problem, reference, moved, title = _magnified(state)
    body = body_panel(problem, reference, moved, times=time, loads=True, title=title)
    tip = state.x.to_numpy()[:, -1] - state.x_ref.to_numpy()[-1]
    axis = int(np.ptp(tip, axis=0).argmax())
    panels = [body, energies(state)]
    if body.wide:
        label = f"last vertex, {(ALONG, UP)[axis]}"
        panels.append(Panel(curve(time, tip[:, axis], "ink"), "time [s]", label))
    alt = (
        "A rod moves from state to state. Beside or below it are its kinetic and its strain energy in time, and what "
        "its last vertex does."
    )
    slider = Slider("time", time, "s", _digits(time))
    return Stage(
        str(data.attrs.get("title", "")), alt, tuple(panels), slider, _pace(time.size), poster=(0, -1)
    )


def energies(state: xr.Dataset) -> Panel:
    """Kinetic and strain energy in time, each with a dot at the state that is shown."""
    largest = max(float(np.abs(state[name]).max()) for name in ("kinetic_energy", "strain_energy"))
    factor, unit = next(pair for pair in _UNITS if largest * pair[0] >= 1 or pair is _UNITS[-1])
    time = state.time.to_numpy()
    parts: list[Line | Mark] = []
    for name, look, label, dash in (
        ("kinetic_energy", "computed", "kinetic energy", ""),
        ("strain_energy", "variant", "strain energy", "6 3"),
    ):
        parts += curve(time, factor * state[name].to_numpy(), look, label, dash)
    return Panel(tuple(parts), "time [s]", f"energy [{unit}]")


_UNITS = ((1e-3, "kJ"), (1.0, "J"), (1e3, "mJ"), (1e6, "\N{GREEK SMALL LETTER MU}J"))


def path(data: xr.Dataset, frames: int = FRAMES) -> Stage:
    """The body along its path of equilibria, beside the load over the largest displacement."""
    shown = chosen(data.sizes["point"], frames)
    state = data.isel(point=shown)
    problem, reference, moved, title = _magnified(state)
    loads, stable = state.load_factor.to_numpy(), state.stable.to_numpy() > 0.5
    size = np.linalg.norm(state.x.to_numpy() - state.x_ref.to_numpy(), axis=2).max(axis=1)
    parts: list[Line | Mark] = [Line(size, loads, "exact", width=1.0)]
    for kind, look, dash in ((stable, "computed", ""), (~stable, "variant", "5 3")):
        joined = kind.copy()
        joined[:-1] |= kind[1:] & ~kind[:-1] & (look == "variant")
        label = "stable" if look == "computed" else "unstable"
        if kind.any():
            parts.append(
                Line(size, np.where(joined, loads, np.nan), look, width=2.4, dash=dash, label=label)
            )
    parts += _special(data)
    parts.append(Mark(size, loads, "dot", "ink", "the state that is shown"))
    body = body_panel(problem, reference, moved, loads=True, title=title)
    graph = Panel(tuple(parts), "largest displacement [m]", "load / full load [1]")
    said = tuple("stable" if rests else "unstable" for rests in stable)
    words = tuple(f"load factor {load:.3f}, {rests}" for load, rests in zip(loads, said, strict=True))
    number = np.arange(1, shown.size + 1, dtype=float)
    alt = (
        "A rod along its path of equilibria. Beside it the load over its largest displacement, with a dot at the state "
        "that is shown."
    )
    slider = Slider("point", number, "1", 0, words)
    return Stage(
        str(data.attrs.get("title", "")), alt, (body, graph), slider, _pace(shown.size), poster=(0, -1)
    )


def magnified_panel(state: xr.Dataset, title: str) -> Panel:
    """A rod in all states of a motion; its title ends with the magnification of the displacements."""
    problem, reference, moved, said = _magnified(state)
    title = f"{title} {said.removeprefix('displacements ')}".rstrip()
    return body_panel(problem, reference, moved, title=title, wide=False)


def _special(data: xr.Dataset) -> list[Mark]:
    """Limit points and bifurcations on the load over the largest displacement."""
    if "special" not in data.sizes:
        return []
    size = np.linalg.norm(data.special_x.to_numpy() - data.x_ref.to_numpy(), axis=2).max(axis=1)
    loads, kinds = data.special_load_factor.to_numpy(), data.special.to_numpy()
    return [
        Mark(np.array(across), np.array(load), "diamond", "ink", f"{kind} at {load:.4g}")
        for across, load, kind in zip(size, loads, map(str, kinds), strict=True)
    ]


def _magnified(state: xr.Dataset) -> tuple[RodProblem, tuple[Array, Array], tuple[Array, Array], str]:
    """The problem, the reference, and all states with displacements magnified as in the picture, and words on that."""
    problem = problem_of(state, RodProblem)
    X, D = state.x_ref.to_numpy(), state.d_ref.to_numpy()
    x, d = state.x.to_numpy(), state.d.to_numpy()
    factor = magnification(x - X, problem.rod.length)
    title = "" if factor == 1 else f"displacements \N{MULTIPLICATION SIGN} {factor:g}"
    return problem, (X, D), (X + factor * (x - X), D + factor * (d - D)), title


def _pace(count: int) -> float:
    """How long so many states play [s]."""
    return float(np.clip(count / _STATES_PER_SECOND, *_PACE))


def _digits(time: Array) -> int:
    """Decimals that tell one time from the next."""
    step = float(np.diff(time).min()) if time.size > 1 else 1.0
    return int(np.clip(np.ceil(-np.log10(step)), 1, 6)) if step > 0 else 2
