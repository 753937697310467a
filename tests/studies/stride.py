"""One stride of the earthworm by other means, and its derivatives by complex steps.

It shares no code with the package: (2.4.10) to (2.4.13) with constant n, Chebyshev polynomials on every region and a
dense Newton's method in complex numbers.  A parameter p + ih gives the derivative as Im(stride) / h, without any
difference.
"""

import functools

import numpy as np

MASS, GRAVITY = 10e-3, 9.81  # kg, m/s^2
WORM = {"length": 0.25, "radius": 3.8e-3, "young": 2e3, "anchoring": 26.16e-3, "advancing": 1356.6}
"""Inputs of section 2.8 in SI units."""
EVENTS = ((0.5, True, 0.75), (0.75, False, 0.375), (0.5, False, 0.0), (0.5, True, 1.0))
"""Events of the gait: the front, whether the rear region advances, and what holds on in the motion that ends there."""
SHORT = 1e-30  # of a complex step


@functools.cache
def chebyshev(n):
    """Points on [0, 1], increasing, and the matrices of derivatives and of integrals from 0, of degree n."""
    x = -np.cos(np.pi * np.arange(n + 1) / n)
    vander = np.polynomial.chebyshev.chebvander(x, n)
    slopes = np.array(
        [np.polynomial.chebyshev.chebval(x, np.polynomial.chebyshev.chebder(c)) for c in np.eye(n + 1)]
    )
    areas = [
        np.polynomial.chebyshev.chebval(x, np.polynomial.chebyshev.chebint(c, lbnd=-1))
        for c in np.eye(n + 1)
    ]
    back = np.linalg.inv(vander)
    return (x + 1) / 2, 2 * slopes.T @ back, np.array(areas).T @ back / 2


def source(mu, worm, advances):
    """mu_alpha'' of (2.4.10), (2.4.13) at K points, (2, K), and its derivative (2, 2, K)."""
    square = 12 * worm["length"] ** 2 / (worm["young"] * np.pi * worm["radius"] ** 4)  # l_0^2 / k_G
    area = np.pi * worm["radius"] ** 2
    i = 2 / 3 * worm["young"] * area * square
    pushed = worm["advancing"] * area * square if advances else 0.0
    weight = worm["radius"] * MASS * GRAVITY / worm["length"] * square
    pulled = worm["anchoring"] * square / (mu[0] * mu[1])  # -lambda_c
    one = pushed + weight - pulled / mu[0] + i * (2 * mu[0] + mu[1] - 3)
    two = pushed - pulled / mu[1] + i * (2 * mu[1] + mu[0] - 3)
    mixed = i + pulled / (mu[0] * mu[1])
    rows = ((2 * i + 2 * pulled / mu[0] ** 2, mixed), (mixed, 2 * i + 2 * pulled / mu[1] ** 2))
    return np.array([one, two]), np.array(rows)


def instant(front, first_advances, worm, degree):
    """mu_1, mu_2 at the points of both regions, (2 regions, 2, n + 1), and their lengths."""
    slope = chebyshev(degree)[1]
    count, lengths = degree + 1, (front, 1 - front)
    u = np.ones((2, 2, count), dtype=complex)
    whole = np.arange(u.size).reshape(u.shape)
    for _ in range(30):
        residual, matrix = np.zeros(u.size, dtype=complex), np.zeros((u.size, u.size), dtype=complex)
        for r, length in enumerate(lengths):
            f, df = source(u[r], worm, first_advances == (r == 0))
            for a in range(2):
                rows = whole[r, a]
                residual[rows] = slope @ slope @ u[r, a] / length**2 - f[a]
                matrix[np.ix_(rows, rows)] += slope @ slope / length**2
                for b in range(2):
                    matrix[rows, whole[r, b]] -= df[a, b]
        for a in range(2):  # slopes vanish at the ends; values and slopes are continuous
            for row, parts in (
                (whole[0, a, 0], [(0, slope[0] / lengths[0])]),
                (whole[1, a, -1], [(1, slope[-1] / lengths[1])]),
                (whole[0, a, -1], [(0, np.eye(count)[-1]), (1, -np.eye(count)[0])]),
                (whole[1, a, 0], [(0, slope[-1] / lengths[0]), (1, -slope[0] / lengths[1])]),
            ):
                matrix[row] = 0
                for r, values in parts:
                    matrix[row, whole[r, a]] = values
                residual[row] = sum(values @ u[r, a] for r, values in parts)
        step = np.linalg.solve(matrix, residual).reshape(u.shape)
        u -= min(1, 0.3 / np.abs(step).max()) * step
        if np.abs(step).max() < 1e-13:
            return u, lengths
    raise AssertionError("Newton's method did not converge")


def distance(u, lengths, worm, place):
    """Distance along the ground from the rear end to a place, (2.5.6), (2.5.8) [m]."""
    _, slope, area = chebyshev(u.shape[-1] - 1)
    total = 0.0
    for r, length in enumerate(lengths):
        begin = sum(lengths[:r])
        tilt = worm["radius"] / worm["length"] * (slope @ u[r, 0]) / length
        along = length * (area @ np.sqrt(1 / (u[r, 0] * u[r, 1]) ** 2 - tilt**2))
        share = np.clip((place - begin) / length, 0, 1)
        total += worm["length"] * between(along, share)
    return total


def between(values, at):
    """A polynomial through the points, between them."""
    gaps = at - chebyshev(values.size - 1)[0]
    if np.abs(gaps).min() < 1e-14:
        return values[np.abs(gaps).argmin()]
    weights = (-1.0) ** np.arange(values.size) / gaps
    weights[[0, -1]] /= 2
    return weights @ values / weights.sum()


def stride(degree, **changed):
    """The stride of a worm with some inputs changed, by polynomials of a degree on each region [m]."""
    worm, total, before = WORM | changed, 0.0, None
    for front, first_advances, anchor in EVENTS:
        now = instant(front, first_advances, worm, degree)
        if before is not None:
            total += distance(*before, worm, anchor) - distance(*now, worm, anchor)
        before = now
    return total


def derivative(name, degree):
    """The stride, and its derivative by an input times that input [m]."""
    found = stride(degree, **{name: WORM[name] * (1 + 1j * SHORT)})
    return found.real, found.imag / SHORT
