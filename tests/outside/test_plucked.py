"""The README's `plucked` compared with a fine explicit run of the thesis's energy, written independently in NumPy."""

import functools
from dataclasses import replace

import numpy as np
import pytest

import cosserat

from .published_energy import VIBRATION, energy, frequencies, gradient, lowest_frequency, plucked

TIMES = np.arange(11) / 10
RIGHT = (
    8.83111414,
    3.162623207,
    1.041549113,
    0.3775697818,
    0.1327246489,
    0.04396413598,
    0.01612284324,
    0.005557231413,
    0.001863203406,
    0.0006867854499,
    0.0002324089212,
)
"""Total energy [J] at those times.

`published_energy.plucked(VIBRATION, 0.02, 0.05, TIMES, 1e-11)`, DOP853, 1.9 million evaluations, some minutes.  Every
value grows as the tolerance falls: from 1e-9 to 1e-10 by 6e-6 of itself at 0.1 s and 1e-3 at 1 s, from 1e-10 to 1e-11
by 4e-7 and 8e-5.
"""


def package_rod(beam):
    case = cosserat.case("vibration_c4_20")
    rod = case.problem.rod
    return rod.replace(material=rod.material.replace(poisson=beam.poisson))


@functools.cache
def shaken_state(beam, seed):
    rng = np.random.default_rng(seed)
    x, d = beam.reference
    n = beam.vertices
    x = (x + 0.2 * beam.h * rng.uniform(-1, 1, (2, n)).T @ [1, 1j]) * np.exp(0.7j)
    d = (d + 0.3 * beam.height / 2 * rng.uniform(-1, 1, (2, n)).T @ [1, 1j]) * np.exp(0.7j)
    return x, d


def interleaved(x, d):
    return np.column_stack([x.real, x.imag, d.real, d.imag]).ravel()


@pytest.mark.parametrize("poisson", [0.0, 0.27])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_energy_and_its_gradient_are_those_of_the_package(poisson, seed):
    beam = replace(VIBRATION, poisson=poisson)
    x, d = shaken_state(beam, seed)
    rod = package_rod(beam)
    potential = rod.strain_energy.potential(rod, rod.geometry())
    theirs = np.zeros(4 * beam.vertices)
    found = potential.add_gradient(interleaved(x, d), potential.history, theirs)
    assert found == pytest.approx(energy(beam, x, d), rel=1e-12)
    ours = interleaved(*gradient(beam, x, d))
    np.testing.assert_allclose(theirs, ours, atol=1e-12 * np.abs(ours).max())


@pytest.mark.parametrize("poisson", [0.0, 0.27])
def test_the_gradient_is_that_of_the_energy(poisson):
    """By Richardson's differences of the energy alone."""
    beam = replace(VIBRATION, poisson=poisson)
    x, d = shaken_state(beam, 1)
    q = interleaved(x, d)

    def at(q):
        z = q.reshape(-1, 2) @ [1, 1j]
        return energy(beam, z[::2], z[1::2])

    def difference(step):
        return np.array([(at(q + s) - at(q - s)) / (2 * step) for s in step * np.eye(q.size)])

    ours = interleaved(*gradient(beam, x, d))
    numeric = (4 * difference(1e-5) - difference(2e-5)) / 3
    np.testing.assert_allclose(ours, numeric, atol=1e-8 * np.abs(ours).max())


def test_the_lowest_frequency_is_that_of_the_page():
    """105.44 rad/s: with (3.5.15) a period of the kinetic energy of 0.0298 s."""
    assert np.pi / lowest_frequency(VIBRATION) == pytest.approx(0.029795, abs=1e-6)


@pytest.mark.parametrize(("c4", "lowest"), [(2.0, 101.01406), (20.0, 105.44195)])
def test_four_frequencies_are_those_of_the_package(c4, lowest):
    """The lowest frequency also agrees with a third code."""
    c = (*VIBRATION.c[:3], c4, *VIBRATION.c[4:])
    right = frequencies(replace(VIBRATION, c=c), 4)
    assert right[0] == pytest.approx(lowest, rel=1e-6)
    found = cosserat.case(f"vibration_c4_{c4:.0f}").problem.modes(4).angular_frequency
    np.testing.assert_allclose(found, right, rtol=1e-6)


def test_a_short_run_agrees_with_the_start_of_the_long_one():
    """Two tolerances agree over a millisecond, start with the energy stored above, and lose energy."""
    times = np.array([0.0, 0.001])
    (coarse, _), (fine, _) = (
        plucked(VIBRATION, 0.02, 0.05, times, tolerance) for tolerance in (1e-7, 1e-8)
    )
    assert fine[0] == pytest.approx(RIGHT[0], rel=1e-8)
    assert coarse == pytest.approx(fine, rel=1e-4)
    assert fine[1] < fine[0]


def test_the_plucked_rod_loses_its_energy_at_the_exact_rate():
    """To 1 % at every tenth of a second, over five orders of ten."""
    case = cosserat.case("vibration_c4_20").vary(
        "plucked",
        duration="1 s",
        start={"shape": "first beam mode", "amplitude": "2 cm"},
        damping=0.05,
    )
    data = cosserat.run(case)
    total = (data.kinetic_energy + data.strain_energy).to_numpy()
    shown = np.round(TIMES / data.time.to_numpy()[1]).astype(int)
    assert data.time.to_numpy()[shown] == pytest.approx(TIMES)
    np.testing.assert_allclose(total[shown], RIGHT, rtol=1e-2)
