"""The rod that the reader pulls: its case, and the figure that solves it in the page by the package's own code.

The module of WebAssembly (`cosserat.export.webassembly`) is an output of the workflow.  A player of stored equilibria
stands in the same figure, for browsers that do not run it and for paper.
"""

from __future__ import annotations

import base64
import json
from html import escape
from pathlib import Path

import numpy as np
from IPython.display import HTML

from cosserat.cases.catalogue import Case, find
from cosserat.errors import InputError
from cosserat.export.webassembly import pulled
from cosserat.figures import player
from cosserat.figures.rod import outline
from cosserat.figures.stage import Line, Mark, Panel, Slider, Stage
from cosserat.rods.problem import RodProblem
from cosserat.runner import run
from cosserat.thesis.book.tables import mathematics
from cosserat.thesis.book.workflow import results

LENGTH = 0.2
"""Of the rod [m]."""
REACH = 1.25
"""Farthest distance of the tip from the clamp, in lengths of the rod."""
STEP = 0.002
"""The tip moves so far at a press of an arrow key [m]."""
_VIEW = (-0.1, 0.28, -0.125, 0.125)  # what is drawn: from and to along E3, along E2 [m]
_RULER = 0.05  # length of the scale [m]
_STRONGEST = 0.05  # section strain of the full colour
_ARROW = 12.0  # pixels for a newton
_STATES = 25
_ALT = (
    "A thick rubber rod, clamped at its left end, whose right end is a ring to drag. The body is tinted where its "
    "sections grow thin or thick, and an arrow at the ring is the force of the hand."
)
_STORED_ALT = (
    "The rubber rod is clamped at its left end. Its tip is pushed back and up along a straight line, the rod bends "
    "into an S, and below it the force of the hand is drawn over the way of the tip."
)


def pulled_case(by_3: float = 0.0, by_2: float = 0.0) -> Case:
    """A rubber rod, clamped at its first end, with its last vertex moved by a displacement along E3 and E2 [m]."""
    return find("elastica").vary(
        "pulled_rod",
        rod={
            "length": "0.2 m",
            "section": {"width": "20 mm", "height": "20 mm"},
            "material": {"young": "1 MPa", "poisson": 0.45},
        },
        supports=[{"at": "first", "fixed": "clamped"}, {"at": "last", "fixed": "pinned"}],
        forces=[],
        prescribed_displacements=[
            {"at": "last", "dof": "x3", "by": by_3},
            {"at": "last", "dof": "x2", "by": by_2},
        ],
    )


def _problem() -> RodProblem:
    return pulled_case().problem_as(RodProblem)


def module(path: Path | None = None) -> bytes:
    """The module of WebAssembly that the workflow has made.

    Raises
    ------
    InputError : there is none.
    """
    path = results() / "pull.wasm" if path is None else path
    if not path.is_file():
        raise InputError(f"there is no {path}; make it with 'cosserat webassembly', or run 'make'")
    return path.read_bytes()


def pull(caption: str, name: str = "pull") -> HTML:
    """The figure: what the reader drags, and the player in its place."""
    problem = _problem()
    room, rod = pulled.room_of(problem), problem.rod
    said = {
        "module": base64.b64encode(module()).decode(),
        "room": base64.b64encode(room.astype("<f8").tobytes()).decode(),
        "head": pulled.HEAD,
        "vertices": rod.vertices,
        "below": rod.centreline / (1 - rod.centreline),
        "view": _VIEW,
        "clamp": 0.8 * rod.height,
        "reach": REACH * LENGTH,
        "step": STEP,
        "ruler": _RULER,
        "strongest": _STRONGEST,
        "arrow": _ARROW,
    }
    width, height = _VIEW[1] - _VIEW[0], _VIEW[3] - _VIEW[2]
    arrows = {"ArrowLeft": "left", "ArrowRight": "right", "ArrowUp": "up", "ArrowDown": "down"}
    signs = dict(
        zip(
            arrows,
            "\N{LEFTWARDS ARROW}\N{RIGHTWARDS ARROW}\N{UPWARDS ARROW}\N{DOWNWARDS ARROW}",
            strict=True,
        )
    )
    buttons = "".join(
        f'<button type="button" data-key="{key}" aria-label="tip {5e3 * STEP:.0f} mm {way}">{signs[key]}</button>'
        for key, way in arrows.items()
    )
    how = (
        f"Drag the ring. With the keyboard, an arrow key moves the tip by {1e3 * STEP:.0f} mm, with Shift by "
        f"{5e3 * STEP:.0f} mm, and Home puts the rod back."
    )
    return HTML(
        f'<figure class="pull" id="{name}" data-pull>'
        '<div class="live" hidden>'
        f'<div class="stage" tabindex="0" role="application" aria-label="The tip of the rod. {how}">'
        f'<svg viewBox="0 0 640 {640 * height / width:.0f}" role="img" aria-label="{escape(_ALT)}"></svg></div>'
        f'<div class="controls">{buttons}<button type="button" class="reset">Reset</button><span>{how}</span></div>'
        '<output></output><p class="note" aria-live="polite"></p></div>'
        '<div class="stored"><p class="instead">This browser does not run the solver of this figure. Stored states '
        f"stand in for it.</p>{player.figure(stored(), name + '-stored')}</div>"
        f'<script type="application/json" class="rod">{json.dumps(said, separators=(",", ":"))}</script>'
        f"<figcaption><b>Pull it yourself.</b> {mathematics(caption)}</figcaption></figure>"
    )


def stored() -> Stage:
    """Equilibria as the tip is pushed back and up, for the player."""
    way = np.linspace(0.0, 1.0, _STATES)
    found = [run(pulled_case(-0.06 * part, 0.08 * part)) for part in way]
    problem = _problem()
    x, d = (np.array([data[key].to_numpy() for data in found]) for key in ("x", "d"))
    force = np.array([data.support_force.to_numpy()[-1, :2] for data in found])
    surface = outline(x, d, problem)
    body = Line(surface[..., 0], surface[..., 1], look="computed", fill="body", closed=True)
    tip = Mark(x[:, -1, 0], x[:, -1, 1], sign="ring", look="anchor", label="tip")
    side = Panel(
        (body, tip),
        "along E3 [m]",
        "along E2 [m]",
        true=True,
        wide=True,
        xlim=(-0.02, 0.24),
        ylim=(-0.06, 0.12),
    )
    distance = 1e3 * np.hypot(0.06, 0.08) * way
    size = np.hypot(*force.T)
    graph = Panel(
        (Line(distance, size), Mark(distance, size)),
        "way of the tip [mm]",
        "force of the hand [N]",
        wide=True,
    )
    return Stage(
        "Pulled rod, stored states",
        _STORED_ALT,
        (side, graph),
        Slider("way of the tip", distance, "mm", digits=0),
        poster=(0, _STATES // 3, -1),
    )
