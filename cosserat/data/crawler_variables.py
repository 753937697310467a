"""The stored variables of crawlers."""

from __future__ import annotations

from cosserat.solution import Variable

CRAWLERS: dict[str, Variable] = {
    "xi_section": Variable(
        ("section",), "m", "reference arc length of the cross-sections", r"\xi", "1.3.1", 1e-14
    ),
    "resting_radius": Variable(
        ("section",), "m", "radius of the resting sections of a body that varies", "R", "2.2.8", 1e-14
    ),
    "mu_1": Variable(("section",), "1", "vertical stretch of the sections", r"\mu_1", "1.3.6", 1e-9),
    "mu_2": Variable(("section",), "1", "stretch of the sections across", r"\mu_2", "1.3.6", 1e-9),
    "mu_3": Variable(("section",), "1", "stretch of the centreline", r"\mu_3", "1.3.6", 1e-9),
    "mu_1_slope": Variable(
        ("section",), "m-1", "gradient of the vertical stretch", r"\mu_1'", "1.3.7", 1e-6
    ),
    "along": Variable(("section",), "m", "position along the ground", "z", "2.5.11", 1e-10),
    "height": Variable(
        ("section",), "m", "height of the centreline over its reference", "x", "2.5.7", 1e-11
    ),
    "p_coelom": Variable(("section",), "Pa", "coelomic pressure", r"p_{coelom}", "2.8.8", 1e-6),
    "advancing": Variable(
        ("section",), "1", "one where advancing loads act, else zero", "", "2.2.9", 1e-9
    ),
    "muscle_force": Variable(
        ("section",), "N", "force of the longitudinal muscles", r"\bar{D}", "2.2.7", 1e-12
    ),
    "muscle_pressure": Variable(
        ("section",), "Pa", "pressure of the circular muscles", "p", "2.2.8", 1e-9
    ),
    "anchor": Variable(
        ("time",), "m", "reference arc length of the anchored point", r"\xi_A", "2.5.10", 1e-14
    ),
    "anchor_along": Variable(
        ("time",), "m", "position of the anchored point", r"z(\xi_A)", "2.5.10", 1e-10
    ),
}
