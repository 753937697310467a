"""Where slender bodies come to rest beyond their critical load, by `reissner`; as a command it finds the table anew."""

from dataclasses import replace

import numpy as np

from .reissner import CLAMP, Load, Rod, column_beyond, equilibrium

SLENDER = Rod.rectangle(1.0, 8.660254037844386e-3, 8.660254037844386e-3, 1e9)
EULER = np.pi**2 * SLENDER.EI / 4
"""Critical load of the slender rod, clamped and free [N]."""

PUSHED = (0.155208, 2.382274)
"""Tip (x, y) of the bar of `cases.toml` [m]."""

MULTIPLES = {
    1.05: (0.880428, 0.423599),
    1.2: (0.665635, 0.654951),
    1.5: (0.362073, 0.789054),
    2: (0.071358, 0.797250),
    3: (-0.203408, 0.708064),
    4: (-0.336812, 0.627459),
    6: (-0.473560, 0.518567),
    9: (-0.574407, 0.424690),
    12: (-0.632275, 0.367953),
}
"""Tip of the slender rod under a multiple of its critical load and 0.01 N across [m]."""

SIDES = {
    1e-9: (-0.337420, 0.626708),
    1e-6: (-0.337420, 0.626708),
    1e-4: (-0.337414, 0.626716),
    1e-2: (-0.336812, 0.627459),
    0.1: (-0.331347, 0.634136),
}
"""The same at four times the critical load, by the force across [N]."""

BOWS = {
    1e-6: (-0.337420, 0.626708),
    1e-4: (-0.337426, 0.626700),
    1e-2: (-0.338002, 0.625884),
    0.1: (-0.343142, 0.618451),
}
"""The same with no force across, by the curvature at rest [1/m]."""

RIBBONS = {
    (1e7, 0.01): -0.068365,
    (1e7, 0.1): -0.196705,
    (1e7, 0.3): -0.319153,
    (1e8, 0.01): -0.063740,
    (1e8, 0.1): -0.195489,
    (1e8, 0.3): -0.315143,
    (1e9, 0.01): -0.062826,
    (1e9, 0.1): -0.194785,
    (1e9, 0.3): -0.314301,
    (1e10, 0.01): -0.062692,
    (1e10, 0.1): -0.194698,
    (1e10, 0.3): -0.314209,
}
"""Height of the middle of a ribbon, its clamped ends pushed together under its weight, by E [Pa] and push [m]."""

SHIFTED = {
    (1.7e-4, 0.056, 0.128): -0.064136,
    (-1.7e-4, 0.056, 0.128): 0.192173,
    (1.7e-4, 0.0124, -0.0714): -0.093258,
    (-1.7e-4, 0.0124, -0.0714): 0.021814,
    (1e-2, 0.056, 0.128): -0.060938,
    (-1e-2, 0.0124, -0.0714): 0.018483,
}
"""Height of the middle of a bowed rod without weight between two clamps, of which one is moved nearer and aside, by the
curvature at rest [1/m] and both moves [m]."""


def bowed(curvature):
    """The slender rod at four times the critical load, bent at rest; a push to that side is taken away."""
    load = 4 * EULER
    loads = [
        Load(CLAMP, {"Nx": -load, "Ny": aside, "M": 0.0})
        for aside in 0.02 * load * np.array([1, 0.5, 0.2, 0.1, 0.03, 0.01, 0])
    ]
    return equilibrium(replace(SLENDER, K=curvature), loads[-1], through=loads, steps=40)


def ribbon(young, push):
    """The slender rod of another modulus between two clamps, its weight put on first, then the ends pushed together."""
    fraction = young / 1e9
    rod = Rod(1.0, fraction * SLENDER.EI, fraction * SLENDER.EA, fraction * SLENDER.GA)
    nearer = [
        Load(CLAMP, {"x": 1 - push * s * s, "y": 0.0, "a": 0.0}, py=-0.1 * 9.81)
        for s in np.linspace(0, 1, 41)
    ]
    return equilibrium(rod, nearer[-1], through=nearer)


def shifted(curvature, push, aside):
    """The slender rod, bowed between two clamps, the last of which is moved in so small steps that it stays smooth."""
    k = curvature
    moved = [
        Load(CLAMP, {"x": np.sin(k) / k - push * s**3, "y": (1 - np.cos(k)) / k + aside * s**3, "a": k})
        for s in np.linspace(0, 1, 401)
    ]
    return equilibrium(replace(SLENDER, K=k), moved[-1], through=moved, steps=1)


def main():
    bar = Rod.rectangle(3.0, 0.1, 0.1, 210e9, 0.28)
    print("pushed", column_beyond(bar, 980665.0, 1000.0)[:2, -1])
    for multiple in MULTIPLES:
        print("multiple", multiple, column_beyond(SLENDER, multiple * EULER, 0.01)[:2, -1])
    for aside in SIDES:
        print("side", aside, column_beyond(SLENDER, 4 * EULER, aside)[:2, -1])
    for curvature in BOWS:
        print("bow", curvature, bowed(curvature)[:2, -1])
    for young, push in RIBBONS:
        print("ribbon", young, push, ribbon(young, push)[1, 200])
    for curvature, push, aside in SHIFTED:
        print("shifted", curvature, push, aside, shifted(curvature, push, aside)[1, 200])


if __name__ == "__main__":
    main()
