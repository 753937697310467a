"""The twelve ways in which a section of a directed rod can deform, each alone, as states of a short body.

Every state is a straight or circular rod with the directors of one strain measure of eq. (1.2.19).  `rods.directed_rod`
gives its measures and its energy; the bodies here are drawn from the same directors.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray

from cosserat.figures.style import BODY, COMPUTED, EXACT

Array = NDArray[np.float64]

_OBLIQUE = np.array([[0.0, 1.0], [-0.46, -0.34], [1.0, 0.0]])
"""On paper E_3 points to the right, E_1 up, E_2 obliquely towards the reader; rows are E_1, E_2, E_3."""
_AWAY = np.array([-0.34, -1.0, -0.46])  # from the reader along the line of sight
_LIGHT = np.array([0.8, 0.5, -0.33])  # towards the light


@dataclass(frozen=True)
class Deformation:
    """One deformation of a section.

    measure : the strain that is not zero, as mathematics.  gamma, kappa : its places and signs in the arrays of
    `rods.directed_rod.measures`, counted from 0.  stiffness : the numbers i of eq. (1.2.98), each with the sign of k_i
    in the stiffness of this deformation.  beam : what theories of beams call it, or "" if they have no such thing.
    turn : the axis of a rod whose sections are rotated into each other.
    """

    title: str
    measure: str
    beam: str
    stiffness: Mapping[int, int]
    gamma: tuple[tuple[int, int], ...] = ()
    kappa: Mapping[tuple[int, int], int] | None = None
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def directors(self, amount: float, xi: Array) -> tuple[Array, Array, Array]:
        """r, shape (n, 3), d_i as rows, shape (n, 3, 3), and d_alpha', shape (n, 2, 3), at arc lengths xi, shape (n,).

        amount : the strain at xi = 0; of a gamma above -1 [1], of a kappa per unit of xi.
        """
        if any(self.turn):
            return _turned(amount * np.array(self.turn), xi)
        d, d_prime = _strained(amount, self.gamma), np.zeros((2, 3))
        for (alpha, i), sign in (self.kappa or {}).items():
            d_prime[alpha, i] = sign * amount
        along = np.broadcast_to(d, (xi.size, 3, 3)).copy()
        along[:, :2] += xi[:, None, None] * d_prime
        return xi[:, None] * d[2], along, np.broadcast_to(d_prime, (xi.size, 2, 3))

    @property
    def pays(self) -> str:
        """The stiffnesses that pay for it, as mathematics."""
        terms = (f"{'+' if sign > 0 else '-'} k_{{{i}}}" for i, sign in self.stiffness.items())
        return " ".join(terms).removeprefix("+ ")

    def stiffness_of(self, k: Mapping[int, float]) -> float:
        """What pays for it: 2 rho_0 psi over the square of the strain, from the stiffnesses k_i [N or N m^2]."""
        return sum(sign * k[number] for number, sign in self.stiffness.items())


def _strained(amount: float, places: tuple[tuple[int, int], ...]) -> Array:
    """Directors with one gamma_ij = gamma_ji = amount and no other strain, as rows."""
    d = np.eye(3)
    for i, j in places:
        if i == j:
            d[i, i] = np.sqrt(1 + amount)
        elif j == 2:  # sections stay upright, and the centreline slopes
            d[2] = np.sqrt(1 - amount**2) * np.eye(3)[2] + amount * np.eye(3)[i]
        else:
            half = np.arcsin(amount) / 2
            d[i] = np.cos(half) * np.eye(3)[i] + np.sin(half) * np.eye(3)[j]
            d[j] = np.cos(half) * np.eye(3)[j] + np.sin(half) * np.eye(3)[i]
    return d


def _turned(omega: Array, xi: Array) -> tuple[Array, Array, Array]:
    """Sections that are rotated into each other, d_i' = omega x d_i: a circle or a twisted bar."""
    rate = float(np.linalg.norm(omega))
    axis = omega / rate if rate else omega
    cross = np.cross(np.eye(3), axis)  # cross @ v = axis x v
    angle = (rate * xi)[:, None, None]
    turns = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    d = np.swapaxes(turns, 1, 2)
    bent = np.cross(axis, np.eye(3)[2])
    half = rate * xi[:, None] / 2
    r = (  # the integral of d_3 = e_3 + sin axis x e_3 + (1 - cos) axis x (axis x e_3)
        xi[:, None] * np.eye(3)[2]
        + xi[:, None] * np.sin(half) * np.sinc(half / np.pi) * bent
        + xi[:, None] * (1 - np.sinc(2 * half / np.pi)) * np.cross(axis, bent)
    )
    return r, d, np.cross(omega, d[:, :2])


DEFORMATIONS: dict[str, Deformation] = {
    "stretch": Deformation("axial stretch", r"\gamma_{33}", "stretch of a bar", {3: 1}, gamma=((2, 2),)),
    "section_shear": Deformation("shear of the section", r"\gamma_{12}", "", {4: 1}, gamma=((0, 1),)),
    "lateral_1": Deformation("lateral stretch", r"\gamma_{11}", "", {1: 1}, gamma=((0, 0),)),
    "lateral_2": Deformation("lateral stretch", r"\gamma_{22}", "", {2: 1}, gamma=((1, 1),)),
    "shear_1": Deformation(
        "transverse shear", r"\gamma_{13}", "shear of Timoshenko's beam", {5: 1}, gamma=((0, 2),)
    ),
    "shear_2": Deformation(
        "transverse shear", r"\gamma_{23}", "shear of Timoshenko's beam", {6: 1}, gamma=((1, 2),)
    ),
    "bending_1": Deformation(
        "bending", r"\kappa_{13}", "bending of a beam", {14: 1}, kappa={(0, 2): 1}, turn=(0, -1, 0)
    ),
    "bending_2": Deformation(
        "bending", r"\kappa_{23}", "bending of a beam", {15: 1}, kappa={(1, 2): 1}, turn=(1, 0, 0)
    ),
    "taper_1": Deformation("taper", r"\kappa_{11}", "", {10: 1}, kappa={(0, 0): 1}),
    "taper_2": Deformation("taper", r"\kappa_{22}", "", {11: 1}, kappa={(1, 1): 1}),
    "twist": Deformation(
        "twist",
        r"\kappa_{12} = -\kappa_{21}",
        "twist of a shaft",
        {12: 1, 13: 1, 16: -1},
        kappa={(0, 1): 1, (1, 0): -1},
        turn=(0, 0, 1),
    ),
    "section_shear_gradient": Deformation(
        "growing shear of the section",
        r"\kappa_{12} = \kappa_{21}",
        "",
        {12: 1, 13: 1, 16: 1},
        kappa={(0, 1): 1, (1, 0): 1},
    ),
}
"""Six gamma and six combinations of kappa: together every homogeneous deformation of a section, eq. (1.2.19)."""


def on_paper(points: Array) -> Array:
    """Points or vectors (..., 3) as the reader sees them, shape (..., 2)."""
    seen: Array = points @ _OBLIQUE
    return seen


def draw_body(
    ax: Axes,
    r: Array,
    d: Array,
    half: tuple[float, float],
    place: tuple[float, float] = (0.0, 0.0),
    *,
    look: str = BODY,
) -> None:
    """A body with a rectangular section, seen obliquely, its middle at a place on paper.

    r : (n, 3) and d : (n, 3, 3) its centreline and directors.  half : half its height along d_1 and half its width
    along d_2.  look : colour of its faces, or "none" for the edges alone.
    """
    middle = np.asarray(place) - (on_paper(r.mean(axis=0)))
    ring = _ring(half)
    points = r[:, None] + np.einsum("pa,nai->npi", ring, d[:, :2])
    if look == "none":
        corners = points[:, :: len(ring) // 4]
        for line in (
            *np.swapaxes(corners, 0, 1),
            corners[0, [0, 1, 2, 3, 0]],
            corners[-1, [0, 1, 2, 3, 0]],
        ):
            ax.plot(*(on_paper(line) + middle).T, color=EXACT, linewidth=0.6, linestyle=":")
        return
    around = np.roll(points, -1, axis=1)
    quads = np.stack([points[:-1], around[:-1], around[1:], points[1:]], axis=2).reshape(-1, 4, 3)
    caps = [_cap(r[k], d[k], half) for k in (0, -1)]
    faces = np.concatenate([quads, *caps])
    normal = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    normal *= np.where(normal @ _AWAY > 0, -1, 1)[:, None]  # the side that the reader sees
    order = np.argsort(-(faces.mean(axis=1) @ _AWAY))  # the farthest first
    shade = 0.62 + 0.38 * np.clip(normal @ _LIGHT / np.linalg.norm(_LIGHT), 0, 1)
    colour = np.array([int(look[k : k + 2], 16) / 255 for k in (1, 3, 5)])
    drawn = PolyCollection(
        list((on_paper(faces) + middle)[order]),
        facecolors=np.clip(shade[:, None] * colour * 1.08, 0, 1)[order],
        edgecolors=COMPUTED,
        linewidths=0.25,
    )
    ax.add_collection(drawn, autolim=True)


def _ring(half: tuple[float, float], steps: int = 3) -> Array:
    """Points (X^1, X^2) round a rectangle, `steps` to a side, from a corner, shape (4 steps, 2)."""
    corners = np.array([[1, -1], [1, 1], [-1, 1], [-1, -1]], float) * half
    part = np.linspace(0, 1, steps, endpoint=False)[:, None]
    return np.concatenate(
        [a + part * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    )


def _cap(r: Array, d: Array, half: tuple[float, float], steps: int = 3) -> Array:
    """The squares of an end face, shape (steps^2, 4, 3)."""
    cuts = np.linspace(-1, 1, steps + 1)
    grid = r + cuts[:, None, None] * half[0] * d[0] + cuts[None, :, None] * half[1] * d[1]
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(
        -1, 4, 3
    )
