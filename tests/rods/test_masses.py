"""Concentrated masses: frequencies, weight, momenta and energy, against exact answers."""

import numpy as np
import pytest
from transfer import CLAMPED, FREE, Beam, carried, frequencies, point

import cosserat
from cosserat.errors import InputError
from cosserat.rods.masses import Mass, mass_band
from cosserat.solvers.banded import to_dense

CLAMP = {"at": "first", "fixed": "clamped"}


def strip(vertices, **changes):
    """An aluminium strip of 0.5 m by 20 mm by 5 mm, 0.27 kg/m."""
    rod = {
        "vertices": vertices,
        "length": 0.5,
        "section": {"height": 5e-3, "width": 20e-3},
        "material": {"young": 70e9, "line_density": 0.27},
    }
    return cosserat.case("elastica").vary("it", rod=rod, supports=[CLAMP], forces=[], **changes)


def frequency_errors(steps, low, count, **changes):
    """Relative errors of the lowest frequencies at N = 11, 21, 41; steps : of the Timoshenko beam."""
    errors = []
    for vertices in (11, 21, 41):
        case = strip(vertices, **changes)
        exact = frequencies(CLAMPED, steps(Beam(case.problem.rod)), FREE, count, low)
        errors.append(np.abs(case.problem.modes(count).angular_frequency / exact - 1).max())
    return errors


def test_a_tip_mass_as_heavy_as_the_strip():
    """Euler's beam: 1 + cos b cosh b = b (sin b cosh b - cos b sinh b), b = 1.247917, 7.28615 Hz."""
    tip = [{"at": "last", "mass": 0.135}]
    found = strip(41, masses=tip).problem.modes(1).angular_frequency[0] / (2 * np.pi)
    assert found == pytest.approx(7.28615, rel=1e-4)
    errors = frequency_errors(
        lambda it: [it.part(it.L), point(mass=carried(0.135))], 20.0, 1, masses=tip
    )
    assert np.log2(errors[0] / errors[2]) == pytest.approx(4, abs=0.1), errors


@pytest.mark.parametrize(("place", "share"), [("last", 1.0), ("62.5 %", 0.625)])
def test_rotary_inertia_and_offset_are_of_second_order(place, share):
    """Transfer matrices; equal edges have no vertex at 62.5 %.  Each of J, a and b moves a frequency by 0.3 % or more.

    Frequencies are far below that of the stretch of the section that carries the mass.
    """
    m, J, a, b = 0.135, 3e-5, 0.012, -0.015
    item = {"at": place, "mass": m, "rotary_inertia": J, "offset": [a, b]}
    errors = frequency_errors(
        lambda it: [
            it.part(share * it.L),
            point(mass=carried(m, J, a, b)),
            it.part((1 - share) * it.L),
        ],
        20.0,
        2,
        masses=[item],
    )
    assert errors[0] < 3e-2
    assert np.log2(errors[0] / errors[2]) > 3.6, errors


def thick(vertices, **changes):
    """A rod of 1 m by 0.1 m of nu = 0."""
    base = cosserat.case("elastica").vary("it", rod=cosserat.case("vibration_consistent").problem.rod)
    changes = {"supports": [CLAMP], "forces": [], **changes}
    return base.vary("it", rod={"vertices": vertices}, **changes)


@pytest.mark.parametrize("along", ["-E2", "E3"])
def test_an_eccentric_mass_bends_by_its_weight(along):
    """P L^3 / 3 EI + P L / kGA + P a L^2 / 2 EI and the beam's own weight; along E3 a couple -P b; P is m g."""
    m, g, a, b, errors = 5.0, 1e-3, 0.11, -0.23, []
    for vertices in (11, 21, 41):
        case = thick(
            vertices,
            masses=[{"at": "last", "mass": m, "offset": [a, b]}],
            gravity={"g": g, "along": along},
        )
        it, P = Beam(case.problem.rod), m * g
        w = it.m * g
        bent = P * it.L**3 / 3 / it.EI + P * it.L / it.GA + P * a * it.L**2 / 2 / it.EI
        own = w * it.L**4 / 8 / it.EI + w * it.L**2 / 2 / it.GA
        exact = -bent - own if along == "-E2" else -P * b * it.L**2 / 2 / it.EI
        run = cosserat.run(case)
        errors.append(abs(run.u.to_numpy()[-1, 1] / exact - 1))
        held = run.support_force.to_numpy()[0]
        weight = {"-E2": (0, P + w * it.L), "E3": (-P - w * it.L, 0)}[along]
        np.testing.assert_allclose(held[:2], weight, atol=1e-6 * P)
    assert errors[0] < 5e-3
    assert errors[2] < 1e-6 or np.log2(errors[0] / errors[2]) > 3.8, errors


def thrown(**changes):
    """A free rod that starts with a speed and a spin about its first vertex, with an eccentric mass."""
    item = {"at": "0.7 m", "mass": 6.0, "rotary_inertia": 0.3, "offset": [0.2, -0.3]}
    return (
        cosserat.case("vibration_consistent")
        .vary(
            "it",
            rod={"vertices": 9},
            supports=[],
            masses=[item],
            start={"shape": "reference", "amplitude": 0.0, "speed": 2.0, "along": "E2", "spin": 3.0},
            duration=0.2,
            every=0.02,
            integrator={"step": 5e-4},
        )
        .vary("it", **changes)
    )


def test_momenta_and_kinetic_energy_are_those_of_points():
    """A point at (0.9, -0.3) m of a rod that moves with 2 m/s and turns at 3 rad/s, with J = 0.3 kg m^2."""
    run, alone = (
        cosserat.run(thrown(rod={"vertices": 11}, masses=masses))
        for masses in (thrown().problem.masses, [])
    )
    v = np.array([0.9, 2 + 2.7])  # -3 y, 2 + 3 x at x = 0.9, y = -0.3
    more = {
        "kinetic_energy": 6 / 2 * v @ v + 0.3 / 2 * 9,
        "angular_momentum": 6 * (0.9 * v[1] + 0.3 * v[0]) + 0.3 * 3,
    }
    for name, right in more.items():
        assert float(run[name][0] - alone[name][0]) == pytest.approx(right, rel=1e-12)
    np.testing.assert_allclose(run.momentum[0] - alone.momentum[0], 6 * v, rtol=1e-12)
    assert np.ptp(run.angular_momentum.to_numpy()) < 1e-9 * float(run.angular_momentum[0])
    total = (run.kinetic_energy + run.strain_energy).to_numpy()
    assert np.ptp(total) < 1e-9 * total[0]


def test_a_rod_with_an_eccentric_mass_falls_without_turning():
    still = {"shape": "reference", "amplitude": 0.0, "speed": 0.0, "spin": 0.0}
    run = cosserat.run(thrown(start=still, gravity={"g": 9.81, "along": "-E2"}))
    fallen = run.x.to_numpy()[-1] - run.x.to_numpy()[0]
    np.testing.assert_allclose(fallen, np.tile([0, -9.81 * 0.02], (9, 1)), atol=1e-9)


def test_a_mass_is_at_its_place_in_any_reference():
    """T = m |r'|^2 / 2 + J w^2 / 2 of r by differences, on a curved rod that moves and turns without strain."""
    rod = thick(6).problem.rod.replace(rest={"kind": "arc", "curvature": 0.9})
    geometry, rate = rod.geometry(), 0.7
    item = Mass(at=3, mass=2.0, rotary_inertia=0.05, offset=[0.13, -0.21])
    band = mass_band([item], geometry, rod.kinematics)
    q = rate * rod.kinematics.rigid_motions(geometry.q)[2]
    unit = geometry.D[3] / geometry.director_length[3]
    r = geometry.X[3] + 0.13 * np.array([unit[1], -unit[0]]) - 0.21 * unit
    assert q @ to_dense(band) @ q / 2 == pytest.approx(rate**2 * (2.0 * r @ r + 0.05) / 2, rel=1e-12)


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ('mass = "1 kg"', "'masses.0.at' is missing"),
        ('at = "last"', "'masses.0.mass' is missing"),
        ('at = "last", mass = "0 kg"', "'masses.0.mass' is 0 kg; it must be above 0"),
        ('at = "last", mass = "1 N"', "in N, a force and not a mass"),
        ('at = "last", mass = "1 kg", rotary_inertia = "1 kg"', "a mass and not a moment of inertia"),
        ('at = "last", mass = "1 kg", rotary_inertia = "-1 kg*m^2"', "it must be at least 0"),
        ('at = "last", mass = "1 kg", offset = ["1 m"]', "'masses.0.offset"),
        (
            'at = "3 m", mass = "1 kg"',
            "'masses' 'at' is 3.0 m, but the rod is 1 m long; choose a place on it",
        ),
    ],
)
def test_a_fault_is_one_sentence(table, sentence, tmp_path):
    (tmp_path / "it.toml").write_text(f'[it]\nlike = "elastica"\nmasses = [{{ {table} }}]\n')
    with pytest.raises(InputError) as caught:
        cosserat.case("it", tmp_path / "it.toml")
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)
