"""Wishes of other people that can be said now (`wishes.toml`) beside right values, and where the others are tested."""

import itertools

import numpy as np

from . import closed
from .checks import ORDER, Row, check, displaced, run


@check(quick=True)
def inner_forces():
    """Edges see a line load as forces at their ends, which shifts M by at most q h^2 / 8."""
    data = run("inner_forces")
    s = data.xi_edge.to_numpy()
    right = closed.inner_forces(2.0, s, (0.63, np.radians(-60), 2.0), (1.0, 2.0, 3.0))
    h = 2.0 / 20
    for name, unit, values, allowed in zip(
        ("normal_force", "shear_force", "bending_moment"),
        ("N", "N", "N m"),
        right,
        (1e-5, 1e-5, 3.0 * h**2 / 8 * 1.001),
        strict=True,
    ):
        away = float(np.abs(data[name].to_numpy() - values)[np.abs(s - 0.63) > h / 2].max())
        yield Row(f"largest error of the {name} [{unit}]", 0.0, away, allowed, "statics")


@check(quick=True)
def shock():
    """Waves to and fro: the end that is pushed, and the wall, which carries twice the force that arrives.

    The force begins and ends with a kink, which leaves two thirds of the order two in the tip.
    """
    EA, errors = 1e9 * 4e-4, []
    for n in (26, 51, 101):
        data = run("shock", rod={"vertices": n}, integrator={"step": 1e-3 / (n - 1)})
        t = data.time.to_numpy()
        tip, wall = closed.shocked_bar(1.0, 1e3, EA, 40.0, 3e-3, t)
        errors.append(float(np.abs(displaced(data, "E3") - tip).max()))
    allowed = 1e-3 * float(tip.max())
    yield Row("largest error of the tip [m]", 0.0, errors[-1], allowed, "D'Alembert")
    for coarse, fine in itertools.pairwise(errors):
        order = float(np.log2(coarse / fine))
        yield Row("order of the tip", 4 / 3, order, ORDER, "theory")
    held = -data.reaction_force.sel(support="first", axis="E3").to_numpy()
    yield Row("largest force on the wall [N]", 80.0, float(held.max()), 0.4, "D'Alembert")
    away = float(np.abs(held - wall).max())
    yield Row("largest error of the force on the wall [N]", 0.0, away, 1.6, "D'Alembert")


@check(quick=True)
def toggle_limit():
    right = closed.toggle_limit(1.0, 0.1, 10e6 * 0.2 * 0.05)
    data = run("toggle_limit")
    snaps = float(data.special_load_factor[0])
    yield Row("load at which it snaps [N]", right, snaps, 1e-8 * right, "linear bar")
    limits = float(data.special[0] == "limit point, first instability")
    yield Row("limit points there", 1.0, limits, 0.0, "linear bar")
