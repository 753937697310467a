"""A strip on a base that is shaken across: amplitude and phase of its tip, by beam elements that move with it."""

import numpy as np
import pytest
from scipy.linalg import eigh

from . import timoshenko
from .checks import piece, run


def relative_tip(strip, frequency, damping, count=40):
    """Complex amplitude of the tip against the base, per amplitude of the base; drag 2 zeta omega_1 M v against it."""
    K, M = timoshenko.elements(strip, count)
    free = slice(2, None)
    lowest = np.sqrt(eigh(K[free, free], M[free, free], eigvals_only=True, subset_by_index=[0, 0])[0])
    omega = 2 * np.pi * frequency
    carried = np.zeros(K.shape[0])
    carried[::2] = 1
    Z = K + (2j * damping * lowest * omega - omega**2) * M
    return np.linalg.solve(Z[free, free], omega**2 * (M @ carried)[free])[-2]


@pytest.mark.parametrize(
    ("fraction", "published"), [(0.9, 0.7526e-3), (1.0, 3.9153e-3), (1.3, 0.2864e-3)]
)
def test_a_shaken_base_has_the_amplitude_and_the_phase_of_beam_elements(fraction, published):
    strip = piece("shaken")
    frequency = fraction * timoshenko.frequencies([strip], 1)[0]
    right = 1e-4 * relative_tip(strip, frequency, 0.02)
    assert abs(right + 1e-4) == pytest.approx(published, rel=2e-3)  # of drag against the ground
    period, omega = 1 / frequency, 2 * np.pi * frequency
    data = run(
        "shaken",
        prescribed_displacements=[],
        base_motion={
            "along": "E2",
            "acceleration": -1e-4 * omega**2,
            "time_function": {"kind": "sine", "frequency": frequency},
        },
        duration=45 * period,
        every=period / 16,
        integrator={"step": period / 80},
    )
    t, tip = data.time.to_numpy()[-160:], data.x.sel(axis="E2").isel(vertex=-1).to_numpy()[-160:]
    found = 2j * np.mean(tip * np.exp(-1j * omega * t))
    assert abs(found) == pytest.approx(abs(right), rel=1e-2)
    assert np.angle(found / right) == pytest.approx(0, abs=0.05)  # a step of T/80 lowers f by 0.05 %
