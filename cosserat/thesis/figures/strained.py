"""The twelve deformations of a section as a stage of the player, whose slider is their amplitude."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from cosserat.figures.deformations import DEFORMATIONS, Deformation, on_paper
from cosserat.figures.stage import Line, Panel, Slider, Stage

Array = NDArray[np.float64]

_LENGTH, _HIGH, _WIDE = (
    3.0,
    0.5,
    0.35,
)  # of a drawn body: length, half height along d_1 and half width along d_2
_SECTIONS = 9
_STATES = 17
_LARGEST = {
    "axial stretch": 0.4,
    "lateral stretch": 0.5,
    "transverse shear": 0.35,
    "shear of the section": 0.5,
    "bending": 0.36,
    "twist": 0.3,
    "taper": 0.36,
    "growing shear of the section": 0.36,
}
"""Strains at the full amplitude: of a gamma [1], of a kappa per half of a drawn height."""
_LETTERS = {r"\gamma": "\N{GREEK SMALL LETTER GAMMA}", r"\kappa": "\N{GREEK SMALL LETTER KAPPA}"}
_LOWERED = str.maketrans("0123456789", "".join(chr(0x2080 + digit) for digit in range(10)))


def deformations(_: object) -> Stage:
    """Twelve bodies, each with one strain measure of eq. (1.2.19), and the stiffness that pays for it."""
    shares = np.linspace(-1, 1, _STATES)
    panels = tuple(_panel(found, shares) for found in DEFORMATIONS.values())
    alt = (
        "Twelve short bodies, each deformed in one way: longer, wider, higher, sheared along or across, "
        "bent in two planes, twisted, tapered in two planes, and two shears of the section. The slider makes "
        "each deformation larger, smaller, or turns its sign."
    )
    slider = Slider("amplitude", 100 * shares, "%", 0)
    return Stage("Twelve ways to deform a section", alt, panels, slider, 4.0, poster=(0, 12, -1))


def _panel(found: Deformation, shares: Array) -> Panel:
    largest = _LARGEST[found.title]
    xi = np.linspace(-_LENGTH / 2, _LENGTH / 2, _SECTIONS)
    shapes = [found.directors(share * largest, xi)[:2] for share in shares]
    r, d = (np.stack(arrays) for arrays in zip(*shapes, strict=True))
    faces = _faces(r - r.mean(axis=1, keepdims=True), d)
    rest = _faces(*(part[None] for part in found.directors(0.0, xi)[:2]))
    parts = [
        Line(face[0, :, 0], face[0, :, 1], "exact", closed=True, width=0.7, dash="2 2")
        for face in rest[:3]
    ]
    for face in faces[:3]:
        parts.append(Line(face[..., 0], face[..., 1], "computed", "body", closed=True, width=1.0))
    parts.append(Line(faces[3][..., 0], faces[3][..., 1], "computed", width=0.5))
    paid = f"{_letters(found.measure)}: {_letters(found.pays)}"
    return Panel(
        tuple(parts),
        "",
        paid,
        true=True,
        bare=True,
        title=found.title,
        xlim=(-2.2, 2.2),
        ylim=(-1.15, 1.15),
    )


def _faces(r: Array, d: Array) -> tuple[Array, Array, Array, Array]:
    """The face towards the reader, the upper face and the end as outlines on paper, and lines round the sections."""
    high, wide = _HIGH * d[..., 0, :], _WIDE * d[..., 1, :]
    low, top, back = r - high - wide, r + high - wide, r + high + wide  # three edges along the body
    end = np.stack([edge[:, -1] for edge in (low, top, back, r - high + wide)], axis=1)
    gap = np.full_like(low, np.nan)
    lines = np.stack([low, top, back, gap], axis=2).reshape(r.shape[0], -1, 3)
    front = np.concatenate([low, top[:, ::-1]], axis=1)
    upper = np.concatenate([top, back[:, ::-1]], axis=1)
    return on_paper(front), on_paper(upper), on_paper(end), on_paper(lines)


def _letters(mathematics: str) -> str:
    """Mathematics with the letters and lowered digits of Unicode."""
    for name, letter in _LETTERS.items():
        mathematics = mathematics.replace(name, letter)
    plain = re.sub(r"_\{(\d+)\}", lambda digits: digits[1].translate(_LOWERED), mathematics)
    return plain.replace("-", "\N{MINUS SIGN}")
