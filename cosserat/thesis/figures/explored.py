"""What the book explores: studies as stages of the player, whose sliders are the keys that vary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import NDArray

from cosserat.exact import beams, elastica
from cosserat.figures import crawling
from cosserat.figures.animations import ALONG, UP, body_panel, curve
from cosserat.figures.rod import outline
from cosserat.figures.stage import Line, Mark, Panel, Slider, Stage
from cosserat.figures.strokes import strokes
from cosserat.problems.calibration import beam_of
from cosserat.problems.crawler import CrawlerProblem
from cosserat.problems.static import RodStatics
from cosserat.rods.problem import RodProblem
from cosserat.studies.door import case_of_study
from cosserat.thesis.figures.strained import deformations

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_SAG = 10.0  # magnification of the displacements of the clamped beam
_NECK = 5e4  # of the necked bar
_TALL = 3.0  # of the height of the worm
_ARROW = 0.06  # length of an arrow for a newton [m]
_XI = "\N{GREEK SMALL LETTER XI}"
_LAMBDA = "\N{GREEK SMALL LETTER LAMDA} \N{MINUS SIGN} 1"
_NU = "Poisson's ratio \N{GREEK SMALL LETTER NU}"


@dataclass(frozen=True)
class Explored:
    """One figure with a parameter as its slider: the studies that it needs, and the function that makes its stage."""

    studies: tuple[str, ...]
    stage: Callable[[Data], Stage]


def vertices(data: Data) -> Stage:
    """The sagging beam by the published and by the consistent energy, for each number of vertices."""
    problem = case_of_study(data["vertices_published"]).problem_as(RodStatics)
    beam, count = beam_of(problem), data["vertices_published"].vertices.to_numpy().astype(float)
    assert problem.gravity is not None
    weight = problem.gravity.g
    parts: list[Line | Mark] = []
    errors: list[Line | Mark] = []
    sizes: list[Line | Mark] = []
    xi = np.linspace(0, beam.length, 41)
    sag = beams.clamped_free_displacement(beam, weight, xi)
    for energy, look, dash in (("published", "variant", ""), ("consistent", "consistent", "6 3")):
        answer = data[f"vertices_{energy}"]
        x, d = _filled(answer.x.to_numpy()), _filled(answer.d.to_numpy())
        X = np.stack(
            [x[..., 0], np.zeros_like(x[..., 1])], axis=-1
        )  # the beam is straight, and the weight across it
        D = np.stack(
            [np.zeros_like(d[..., 0]), np.full_like(d[..., 1], problem.rod.height / 2)], axis=-1
        )
        surface = outline(X + _SAG * (x - X), D + _SAG * (d - D), problem)
        parts += [
            Line(
                surface[..., 0], surface[..., 1], look, closed=True, dash=dash, label=f"{energy} energy"
            ),
            _sections(surface, look),
        ]
        error = answer.tip.to_numpy() / sag[-1] - 1
        errors += curve(count, 100 * error, look, dash=dash)
        sizes += curve(count, np.log10(np.abs(error)), look, dash=dash)
    parts.append(Line(xi, _SAG * sag, "exact", dash="2 3", label="closed form (3.5.3), centreline"))
    number = "number of vertices N [1]"
    panels = (
        Panel(
            tuple(parts),
            ALONG,
            f"displacements \N{MULTIPLICATION SIGN} {_SAG:g}, {UP}",
            true=True,
            wide=True,
        ),
        Panel(tuple(errors), number, "error of the tip [%]"),
        Panel(tuple(sizes), number, "10-logarithm of that error [1]"),
    )
    alt = (
        "Two sagging beams over each other and the closed form. With few vertices the published beam is "
        "too stiff, at twenty it fits, with more it sags too much; the consistent beam fits at any "
        "number. Below: the error of both tips."
    )
    drawn = tuple(int(np.abs(count - wanted).argmin()) for wanted in (6, 20, 80))
    return Stage("How many vertices?", alt, panels, Slider("N =", count, "1", 0), 6.0, poster=drawn)


def _filled(values: Array) -> Array:
    """Vertices (members, N, 2) of which those that a member lacks lie on its last one."""
    known = np.isfinite(values[..., 0])
    last = np.where(known, np.arange(known.shape[1]), 0).max(axis=1)
    places = np.minimum(np.arange(known.shape[1]), last[:, None])
    return np.take_along_axis(values, places[..., None], axis=1)


def _sections(surface: Array, look: str) -> Line:
    """A line across the body at each vertex, from outlines of shape (states, 2 N, 2)."""
    half = surface.shape[1] // 2
    upper, lower = surface[:, :half], surface[:, : half - 1 : -1]
    gaps = np.full_like(upper, np.nan)
    lines = np.stack([upper, lower, gaps], axis=2).reshape(surface.shape[0], -1, 2)
    return Line(lines[..., 0], lines[..., 1], look, width=0.5)


def muscles(data: Data) -> Stage:
    """One instant of the worm for each tension behind and each pressure in front."""
    answer = data["muscles_of_an_instant"]
    problem = case_of_study(answer).problem_as(CrawlerProblem)
    state = answer.stack(state=("anchoring", "advancing")).transpose("state", ...)
    tension, pressure = 1e3 * answer.anchoring.to_numpy(), 1e-3 * answer.advancing.to_numpy()
    length = 1e2 * answer.length.to_numpy()
    many = pressure.size
    each = np.repeat(length, many, axis=0)  # of all pressures at the tension of each state
    lines = (
        Line(pressure, each, "computed", label="length at this tension"),
        Mark(np.tile(pressure, tension.size), length.ravel(), "dot", "computed"),
    )
    panels = (
        *_two_regions(state, problem, 0.5),
        Panel(lines, "pressure p [kPa]", "length of the body [cm]"),
    )
    alt = (
        "A worm from the side, its rear half under tension, its front half under pressure. More tension "
        "makes the rear shorter and thicker, more pressure makes the front longer and thinner. Below: "
        "the stretches, and the length."
    )
    sliders = Slider("tension", tension, "mN", 1), Slider("pressure", pressure, "kPa")
    drawn = (many + 1, 2 * many + 2, 4 * many + 4)  # weaker muscles, and at last those of the thesis
    title = "Tension and pressure at one instant"
    return Stage(title, alt, panels, sliders[0], 4.0, poster=drawn, second=sliders[1])


def front(data: Data) -> Stage:
    """The soft robot with the front at each place of its body."""
    answer = data["front_through_the_body"]
    problem = case_of_study(answer).problem_as(CrawlerProblem)
    place = answer.end.to_numpy()
    state = answer.transpose("front", ...)
    graph = curve(place, 1e2 * answer.length.to_numpy())
    reach = "place of the front / length at rest [1]"
    panels = (
        *_two_regions(state, problem, place, tall=1.0),
        Panel(graph, reach, "length of the body [cm]"),
    )
    alt = (
        "The soft robot from the side. As the front travels from its front end to its rear, the thin "
        "part grows and the body becomes longer by the same amount for each step. Near the front the "
        "thickness changes over some centimetres."
    )
    slider = Slider("front at", place, "of the length")
    return Stage("A front travels through the body", alt, panels, slider, 4.0, poster=(2, 9, 16))


def _two_regions(
    state: xr.Dataset, problem: CrawlerProblem, place: float | Array, tall: float = _TALL
) -> tuple[Panel, Panel]:
    """The body and its stretches in each state; place : of the front between both regions, as a share of the length."""
    count, crawler = state.sizes["section"], problem.crawler
    share = np.linspace(0, 1, count)
    along, top = 1e2 * state.along.to_numpy(), 2e2 * crawler.radius * state.mu_1.to_numpy()
    thin = share > np.broadcast_to(np.asarray(place), along.shape[0])[:, None] - 1e-9
    side = crawling.side_panel(along, top, thin, tall=tall)
    return side, crawling.stretches_panel(state, crawler.length * share)


def poisson(data: Data) -> Stage:
    """The necked bar for each Poisson's ratio: by both readings of the published energy and by the consistent one."""
    published, answer = data["poisson_published"], data["poisson_consistent"]
    problem = case_of_study(answer).problem_as(RodStatics)
    ratio, xi = answer.poisson.to_numpy(), problem.geometry.arc_length
    strains: list[Line | Mark] = []
    middles: list[Line | Mark] = []
    for values, look, dash, label in (
        (
            published.lam.sel(poisson_coupling="printed"),
            "exact",
            "2 3",
            "published energy, coupling as printed",
        ),
        (published.lam.sel(poisson_coupling="halved"), "variant", "6 3", "published energy, corrected"),
        (answer.lam, "consistent", "", "consistent energy"),
    ):
        strain = 1e6 * (values.to_numpy() - 1)
        strains.append(Line(xi, strain, look, dash=dash, label=label))
        middles += curve(ratio, strain[:, strain.shape[1] // 2], look, dash=dash)
    force = max(one.force for one in problem.forces)
    free = -1e6 * ratio * force / beam_of(problem).axial_stiffness
    middles.append(
        Line(
            ratio,
            free,
            "ink",
            width=1.0,
            dash="1 3",
            label="\N{MINUS SIGN}\N{GREEK SMALL LETTER NU} n / EA",
        )
    )
    X, D = problem.geometry.X, problem.geometry.D
    moved = X + _NECK * (answer.x.to_numpy() - X), D + _NECK * (answer.d.to_numpy() - D)
    side = body_panel(
        problem,
        (X, D),
        moved,
        title="consistent energy, displacements \N{MULTIPLICATION SIGN} 50000",
        wide=True,
    )
    panels = (
        side,
        Panel(
            tuple(strains),
            f"arc length {_XI} [m]",
            f"section strain {_LAMBDA} [10\N{SUPERSCRIPT MINUS}\N{SUPERSCRIPT SIX}]",
        ),
        Panel(
            tuple(middles),
            f"{_NU} [1]",
            f"{_LAMBDA} at the middle [10\N{SUPERSCRIPT MINUS}\N{SUPERSCRIPT SIX}]",
        ),
    )
    alt = (
        "A bar pulled at both ends, whose end sections cannot contract. Between the ends it contracts in"
        " proportion to Poisson's ratio; the energy as printed contracts twice as much and then without "
        "bound."
    )
    slider = Slider("\N{GREEK SMALL LETTER NU} =", ratio, "1", 3)
    return Stage("Poisson's ratio in necking", alt, panels, slider, 4.0, poster=(0, 7, -1))


def load(data: Data) -> Stage:
    """A slender rod under a growing load across its tip, and the elastica's exact tip."""
    answer = data["load_bending"]
    problem = case_of_study(answer).problem_as(RodStatics)
    beam, force = beam_of(problem), answer.force.to_numpy()
    x, d = answer.x.to_numpy(), answer.d.to_numpy()
    reference = problem.geometry.X, problem.geometry.D
    unloaded: RodProblem = problem.replace(forces=())
    side = body_panel(unloaded, reference, (x, d), wide=False)
    side = Panel((*side.parts, *_arrow(x[:, -1], force)), ALONG, UP, true=True)
    many = np.linspace(0, force[-1], 41)[1:]
    exact = np.array(
        [elastica.transverse_tip(one * beam.length**2 / beam.bending_stiffness) for one in many]
    )
    small = force * beam.length**3 / (3 * beam.bending_stiffness)
    lines: list[Line | Mark] = []
    for axis, look, label in ((1, "computed", "across"), (0, "variant", "along")):
        moved = np.abs(x[:, -1, axis] - reference[0][-1, axis])
        tip = np.r_[0.0, beam.length * exact[:, 1 - axis]]
        lines += [
            Line(np.r_[0.0, many], tip, look, label=f"displacement of the tip {label}, exact"),
            Mark(force, moved, "dot", look, f"{label}, rod of {problem.rod.vertices} vertices"),
        ]
    lines.append(
        Line(
            force[small < 0.8],
            small[small < 0.8],
            "exact",
            dash="5 4",
            label="small deflections, P L\N{SUPERSCRIPT THREE} / 3 EI",
        )
    )
    panels = (side, Panel(tuple(lines), "load P [N]", "displacement of the tip [m]"))
    alt = (
        "A slender clamped rod and the force across its tip. First the tip moves in proportion to the "
        "force; then the rod turns along the force, and the dots follow the exact curve of the elastica,"
        " which bends away from the straight line."
    )
    return Stage(
        "From small to large deflections",
        alt,
        panels,
        Slider("load", force, "N"),
        5.0,
        poster=(4, 11, -1),
    )


def _arrow(tip: Array, force: Array) -> list[Line]:
    """The arrow of a force across the rod at its tip, as long as the force is large."""

    def draw(ax: Axes, state: int) -> None:
        if force[state]:
            head = tip[state] + [0.0, _ARROW * force[state]]
            ax.annotate("", tuple(head), tuple(tip[state]), arrowprops={})

    return strokes(draw, force.size)


EXPLORED = {
    "explore_deformations": Explored((), deformations),
    "explore_vertices": Explored(("vertices_published", "vertices_consistent"), vertices),
    "explore_muscles": Explored(("muscles_of_an_instant",), muscles),
    "explore_front": Explored(("front_through_the_body",), front),
    "explore_poisson": Explored(("poisson_published", "poisson_consistent"), poisson),
    "explore_load": Explored(("load_bending",), load),
}
"""Figures with a parameter as their slider, by the names that chapters use."""
