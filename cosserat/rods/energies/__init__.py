"""The strain energies of a rod, each with its compiled kernel in a file beside it."""

from __future__ import annotations

import functools
import pkgutil
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cosserat.rods.energies.energy import Energy

ENERGIES = {
    "published": "cosserat.rods.energies.hemingway:Hemingway",
    "consistent": "cosserat.rods.energies.reissner:Reissner",
}
"""Energies by the value of `rod.energy` in a case."""


def energy_named(name: str) -> Energy:
    """The energy of that name."""
    return _made(ENERGIES[name])


@functools.cache
def _made(place: str) -> Energy:
    made: Energy = pkgutil.resolve_name(place)()
    return made
