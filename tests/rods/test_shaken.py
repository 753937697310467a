"""A clamp that follows a prescribed motion: amplitude and phase, against the exact answer of a Timoshenko beam."""

import numpy as np
import pytest
from transfer import CLAMPED, FREE, Beam, answer, frequencies

import cosserat

RATIO, PERIODS, STEPS = 0.02, 70, 120


def shaken(key, item, omega, vertices=9):
    """A clamped rod of 1 m by 0.1 m of nu = 0 whose clamp moves by a sine, seventy periods."""
    period = 2 * np.pi / omega
    function = {"kind": "sine", "frequency": omega / (2 * np.pi)}
    return cosserat.case("vibration_consistent").vary(
        "it",
        rod={"vertices": vertices},
        supports=[{"at": "first", "fixed": "clamped"}],
        start={"shape": "reference", "amplitude": 0.0},
        damping=RATIO,
        duration=PERIODS * period,
        every=period / 8,
        integrator={"step": period / STEPS},
        **{key: [{"at": "first", "time_function": function, **item}]},
    )


def harmonic(values, phases):
    """Complex amplitude by sin of a steady answer, from one period."""
    columns = np.column_stack([np.sin(phases), np.cos(phases)])
    sine, cosine = np.linalg.lstsq(columns, values, rcond=None)[0]
    return complex(sine, cosine)


ACROSS = ("prescribed_displacements", {"dof": "x2", "by": 1e-4}, [0, 1e-4, 0])
ROUND = ("prescribed_rotations", {"by": 1e-4}, [0, 0, 1e-4])


@pytest.mark.parametrize(
    ("key", "item", "given", "ratio"),
    [(*ACROSS, 0.9), (*ACROSS, 1.0), (*ACROSS, 1.3), (*ROUND, 1.0)],
)
def test_the_tip_answers_a_shaken_clamp_with_the_exact_amplitude_and_phase(key, item, given, ratio):
    """The drag -2 zeta omega_1 m v acts on the velocity in space, so it makes the masses complex.

    The steps lower a frequency by (omega h)^2 / 12, which at resonance is a phase of 0.65 degrees.
    """
    it = Beam(shaken(key, item, 1.0).problem.rod)
    first = frequencies(CLAMPED, [it.part(it.L)], FREE, 1, low=10.0)[0]
    lowest = shaken(key, item, first).problem.modes(1).angular_frequency[0]
    omega, drag = ratio * lowest, 2 * RATIO * lowest
    assert lowest == pytest.approx(first, rel=1e-2)
    scale = (
        first / lowest
    )  # where it is compared, the exact beam is at the same fraction of its own frequency
    _, end = answer(
        CLAMPED, [it.part(it.L)], FREE, omega * scale, drag * scale, np.array([*given, 0, 0, 0])
    )
    run = cosserat.run(shaken(key, item, omega))
    tip = harmonic(run.x.to_numpy()[-9:, -1, 1], omega * run.time.to_numpy()[-9:])
    exact = end[1]
    assert abs(tip) == pytest.approx(abs(exact), rel=1e-2)
    turned = np.angle(tip / exact)
    assert abs(np.degrees(turned)) < 1.0
