"""What a deuteranope sees of a colour, and the contrast of a colour on white."""

import numpy as np
from matplotlib.colors import to_rgb

# Machado, Oliveira and Fernandes 2009, deuteranomaly of severity 1, of linear red, green and blue
DEUTERANOPE = np.array(
    [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ]
)
XYZ_OF_RGB = np.array(
    [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ]
)  # sRGB, white D65
WHITE = XYZ_OF_RGB.sum(axis=1)


def linear(colour):
    c = np.array(to_rgb(colour))
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    """CIE L*, a*, b* of linear red, green and blue."""
    t = XYZ_OF_RGB @ rgb / WHITE
    x, y, z = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def seen(colour):
    """CIE Lab of what a deuteranope sees."""
    return lab(np.clip(DEUTERANOPE @ linear(colour), 0, 1))


def distance(one, other):
    return np.linalg.norm(seen(one) - seen(other))


def contrast(colour):
    """Contrast of a colour on white, by the rule of the Web Content Accessibility Guidelines."""
    return 1.05 / (XYZ_OF_RGB[1] @ linear(colour) + 0.05)
