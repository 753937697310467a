"""Every kind of damping against the exact decay of single modes, of rotations and of a creeping bar."""

from dataclasses import replace

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError
from cosserat.solvers import integrate
from cosserat.solvers.banded import band_product
from cosserat.solvers.damping import followed_fraction, momentum_damping, rest_strains

CLAMP = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}
EVERY = {
    "mass": {"kind": "mass", "ratio": 0.03},
    "rate": {"kind": "mass", "rate": 6.0},
    "rayleigh": {"kind": "rayleigh", "ratios": [0.02, 0.03], "modes": [1, 2]},
    "frequencies": {"kind": "rayleigh", "ratios": [0.02, 0.03], "frequencies": [16.0, 100.0]},
    "stiffness": {"kind": "stiffness", "ratio": 0.01},
    "time": {"kind": "stiffness", "time": 2e-4},
    "at": {"kind": "stiffness", "ratio": 0.05, "frequency": 100.0},
    "modal": {"kind": "modal", "ratios": [0.02, 0.04]},
    "alike": {"kind": "modal", "ratio": 0.02, "modes": 2},
}


def beam(damping, **changes):
    """A clamped beam of nine vertices."""
    rest = {"start": {"shape": "reference", "amplitude": 0.0}, "supports": [CLAMP], **changes}
    return cosserat.case("vibration_consistent").vary(
        "beam", rod={"vertices": 9}, damping=damping, **rest
    )


def rates_by_hand(name, omega):
    """Rates at which the two lowest modes lose energy, 2 zeta omega each, from the definition of every kind."""
    pair = omega if name == "rayleigh" else 2 * np.pi * np.array([16.0, 100.0])
    c, T = np.linalg.solve([[1, pair[0] ** 2], [1, pair[1] ** 2]], 2 * pair * [0.02, 0.03])
    return {
        "mass": np.full(2, 0.06 * omega[0]),
        "rate": np.full(2, 6.0),
        "rayleigh": c + T * omega**2,
        "frequencies": c + T * omega**2,
        "stiffness": 0.02 / omega[0] * omega**2,
        "time": 2e-4 * omega**2,
        "at": 0.1 / (200 * np.pi) * omega**2,
        "modal": 2 * omega * [0.02, 0.04],
        "alike": 2 * omega * 0.02,
    }[name]


def measured_rate(problem, number, step):
    """Rate at which a mode loses its energy, whole periods of it, in small motion."""
    system = problem.system(problem.geometry)
    found = problem.modes(2)
    omega, shape = found.angular_frequency[number], system.frame.into(found.shape[number])
    rest, rigidity = system.space.reference, omega**2
    state = integrate.State(rest + 1e-9 * shape, np.zeros(rest.size), system.history)
    settings = integrate.IntegratorSettings(step=step)

    def energy(state):
        at, rate = (shape @ band_product(system.inertia, u) for u in (state.q - rest, state.v))
        return (rigidity * at**2 + rate**2) / 2

    duration = 6 * np.pi / omega
    after, _ = integrate.integrate(system, state, duration, settings, "mode")
    return float(np.log(energy(state) / energy(after)) / duration)


def exact_rate(omega, rate):
    """The same of q'' + rate q' + omega^2 q = 0 from rest: its energy swings round its mean decay."""
    t, c = 6 * np.pi / omega, rate / 2
    root = np.sqrt(omega**2 - c**2)
    q = np.exp(-c * t) * (np.cos(root * t) + c / root * np.sin(root * t))
    v = -np.exp(-c * t) * omega**2 / root * np.sin(root * t)
    return -np.log(q**2 + v**2 / omega**2) / t


@pytest.mark.parametrize("name", EVERY)
def test_two_modes_fade_at_their_rates_to_second_order(name):
    problem = beam(EVERY[name]).problem
    omega = problem.modes(2).angular_frequency
    for number, rate in enumerate(rates_by_hand(name, omega)):
        period = 2 * np.pi / omega[number]
        errors = [
            abs(measured_rate(problem, number, period / n) / exact_rate(omega[number], rate) - 1)
            for n in (40, 80)
        ]
        assert errors[0] < 0.02, (number, errors)
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2), (number, errors)


@pytest.mark.parametrize("name", ["stiffness", "modal"])
def test_modes_of_a_rod_on_an_oblique_roller_fade_at_their_rates(name):
    """The degrees of freedom of the roller are in a frame of its own."""
    roller = {"at": "last", "fixed": "roller", "along": "30 deg"}
    problem = beam(EVERY[name], supports=[CLAMP, roller]).problem
    assert problem.system(problem.geometry).frame.oblique
    omega = problem.modes(2).angular_frequency
    for number, rate in enumerate(rates_by_hand(name, omega)):
        period = 2 * np.pi / omega[number]
        measured = measured_rate(problem, number, period / 200)
        assert measured == pytest.approx(exact_rate(omega[number], rate), rel=2e-3)


@pytest.mark.parametrize("omega_h", [0.01, 0.5, 3.0, 30.0])
@pytest.mark.parametrize("ratio", [0.001, 0.3, 1.0, 1.7])
def test_the_followed_fraction_is_that_of_the_powers_of_a_matrix(omega_h, ratio):
    """Steps of q' = v, v' = -q omega^2 - T omega^2 v by the midpoint rule, with h = 1."""
    time = 2 * ratio / omega_h
    A = np.array([[0, 1], [-(omega_h**2), -time * omega_h**2]])
    step = np.linalg.solve(np.eye(2) - A / 2, np.eye(2) + A / 2)
    slow, right = np.linalg.eigvals(step), np.linalg.eigvals(A).real.max()
    slower = slow[np.argmax(slow.real)] if ratio > 1 else slow[0]
    fades = -np.log(abs(slower)) if ratio <= 1 or slower.real > 0 else 0.0
    assert followed_fraction(omega_h, time, 1.0) == pytest.approx(fades / -right, rel=1e-6)


def test_damping_of_two_modes_leaves_the_third_alone():
    problem = beam({"kind": "modal", "ratio": 0.1, "modes": 2}).problem
    system, found = problem.system(problem.geometry), problem.modes(3)
    rest = system.space.reference
    state = integrate.State(rest, 1e-6 * found.shape[2], system.history)
    settings = integrate.IntegratorSettings(step=1e-4)
    after, _ = integrate.integrate(system, state, 0.02, settings, "mode")
    assert after.dissipated < 1e-8 * integrate.kinetic_energy(system, state)
    for shape, omega, ratio in zip(found.shape, found.angular_frequency, (0.1, 0.1, 0.0), strict=True):
        np.testing.assert_allclose(
            momentum_damping(system, shape), 2 * ratio * omega * shape, atol=1e-9 * omega
        )


@pytest.mark.parametrize("energy", ["consistent", "published"])
def test_stiffness_damping_takes_nothing_from_a_rotation(energy):
    """A free rod spins three times round: it settles in its stretched shape and keeps its angular momentum."""
    case = cosserat.case("vibration_consistent" if energy == "consistent" else "vibration_c4_20")
    spin, turns = 40.0, 3
    duration = turns * 2 * np.pi / spin
    run = cosserat.run(
        case.vary(
            "spun",
            rod={"vertices": 9},
            supports=[],
            start={"shape": "reference", "amplitude": 0.0, "spin": spin},
            damping={"kind": "stiffness", "time": 5e-3},
            duration=duration,
            every=duration / 60,
            integrator={"step": duration / 1200},
        )
    )
    taken, kinetic = run.dissipated_energy.to_numpy(), run.kinetic_energy.to_numpy()
    momentum = run.angular_momentum.to_numpy()
    assert np.diff(taken).min() > -1e-11 * kinetic[0]  # round-off of the rotation
    assert 0 < taken[-1] < 1e-3 * kinetic[0]
    assert taken[-1] - taken[30] < 1e-6 * taken[-1]  # it has settled, and goes on to spin
    assert np.ptp(momentum) < 1e-10 * abs(momentum[0])
    total = kinetic + run.strain_energy.to_numpy() + taken
    assert np.ptp(total) < 1e-9 * total[0]


def test_a_bar_creeps_to_its_length_in_the_time_of_its_damping():
    """Kelvin and Voigt: under a sudden force strain is (1 - exp(-t / T)) F / EA where T is long against all periods."""
    case = beam(
        {"kind": "stiffness", "time": 0.5},
        duration=1.0,
        every=0.1,
        integrator={"step": 5e-3},
        forces=[{"at": "last", "along": "E3", "force": 1.0}],
    )
    rod, run = case.problem.rod, cosserat.run(case)
    longer = run.x.sel(axis="E3").isel(vertex=-1).to_numpy() - rod.length
    exact = rod.length / (rod.young * rod.area) * (1 - np.exp(-run.time.to_numpy() / 0.5))
    assert longer == pytest.approx(exact, abs=2e-4 * exact[-1])


def test_the_energy_balance_holds_with_moved_supports():
    swing = {"kind": "sine", "frequency": 12.0}
    for name in ("stiffness", "modal", "rayleigh"):
        run = cosserat.run(
            beam(
                EVERY[name],
                duration=0.1,
                every=0.01,
                integrator={"step": 5e-4},
                prescribed_rotations=[{"at": "first", "by": 0.2, "time_function": swing}],
            )
        )
        kept = run.kinetic_energy + run.strain_energy + run.dissipated_energy - run.support_work
        assert np.ptp(kept.to_numpy()) < 1e-9 * float(np.abs(run.support_work).max()), name
        assert np.diff(run.dissipated_energy.to_numpy()).min() > 0, name


@pytest.mark.parametrize("name", ["stiffness", "mass", "modal"])
def test_a_support_carries_the_damping_of_the_strains_alone(name):
    """dP/dt = R + F - D: damping by stiffness is a force inside the rod, others act from outside on the free DOFs."""
    damping = (
        {**EVERY[name], "ratio": 0.3} if name != "modal" else {"kind": "modal", "ratio": 0.3, "modes": 2}
    )
    rise = {"kind": "ramp", "duration": 0.03, "smooth": True}
    case = beam(
        damping,
        forces=[{"at": "last", "along": "E2", "force": 1.0, "time_function": rise}],
        duration=0.03,
        every=2e-4,
        integrator={"step": 2e-4},
    )
    run, problem = cosserat.run(case), case.problem
    s = run.time.to_numpy() / 0.03
    v = np.concatenate([run.x_rate, run.d_rate], axis=2).reshape(s.size, -1)
    band, found = problem.rod.mass(problem.geometry), problem.modes(2)
    momentum = np.array([band_product(band, u) for u in v])
    outside = {
        "stiffness": np.zeros_like(v),
        "mass": 0.6 * found.angular_frequency[0] * momentum,
        "modal": np.array(
            [
                band_product(band, (0.6 * found.angular_frequency * (found.shape @ p)) @ found.shape)
                for p in momentum
            ]
        ),
    }[name]
    outside[:, problem.constrained()] = 0.0
    rate = np.gradient(momentum[:, 1::4].sum(axis=1), 2e-4)
    right = rate - s**3 * (10 - 15 * s + 6 * s**2) + outside[:, 1::4].sum(axis=1)
    force = run.reaction_force.sel(axis="E2").isel(support=0).to_numpy()
    np.testing.assert_allclose(force[1:-1], right[1:-1], atol=2e-3 * np.abs(right).max())


@pytest.mark.parametrize("name", EVERY)
def test_a_dataset_states_the_damping_of_the_lowest_modes(name):
    run = cosserat.run(beam(EVERY[name], duration=1e-3, every=1e-3, integrator={"step": 1e-4}))
    solver = cosserat.data.dataset.statistics_of(run)
    omega = beam(None).problem.modes(2).angular_frequency
    rates = rates_by_hand(name, omega)
    for number in (0, 1):
        stated = [solver[f"mode_{number + 1}_{key}"] for key in ("frequency_Hz", "damping_ratio")]
        right = [omega[number] / (2 * np.pi), rates[number] / (2 * omega[number])]
        assert stated == pytest.approx(right, rel=1e-6)
    assert (
        "mode_1_damping_ratio" not in beam(0.0, duration=1e-3, every=1e-3).problem.solve("x").statistics
    )


def named(case):
    return [words for words in case.problem.solve("x").warnings if words.startswith("damping")]


def test_steps_too_long_for_a_stated_damping_are_a_warning():
    """(omega h / 2)^2 is 0.09 at 95 Hz in steps of a millisecond, and 0.02 at half of that."""
    damping = {"kind": "stiffness", "ratio": 0.01, "frequency": 95.0}
    long = beam(damping, duration=0.01, every=0.01, integrator={"step": 1e-3})
    (words,) = named(long)
    assert "at 95 Hz, motions in steps of 0.001 s fade at 0.918 of the rate" in words
    assert named(long.vary("x", damping={**damping, "frequency": 47.0})) == []


def test_modes_of_a_rod_that_turns_far_are_a_warning():
    bent = {"shape": "reference", "spin": 30.0}
    for duration, count in ((0.005, 0), (0.02, 1)):
        case = beam(EVERY["modal"], start=bent, duration=duration, every=duration)
        words = named(case.vary("x", supports=[{"at": "first", "fixed": ["x3", "x2"]}]))
        assert len(words) == count
        assert all("rad from the reference, about which the damped modes are" in said for said in words)


def test_a_number_alone_is_the_ratio_of_mass_damping():
    assert beam(0.02).problem == beam({"kind": "mass", "ratio": 0.02}).problem
    assert beam("none").problem.damping is beam(0).problem.damping is None
    again = type(beam(0.02).problem).model_validate_json(beam(0.02).problem.model_dump_json())
    assert again == beam(0.02).problem


@pytest.mark.parametrize(
    ("damping", "sentence"),
    [
        (-0.1, "'damping.ratio' is -0.1; it must be at least 0"),
        ("much", "'damping.ratio' is \"much\", which is not a number"),
        ({"kind": "viscous"}, "'damping.kind' is 'viscous'; it must be 'mass', 'rayleigh'"),
        ({"ratio": 0.02}, "'damping.kind' is missing: write 'mass' or 'rayleigh'"),
        ({"kind": "mass"}, "'damping' has no size; give 'ratio' or 'rate', just one of them"),
        ({"kind": "mass", "ratio": 0.1, "rate": "1 1/s"}, "'damping'"),
        ({"kind": "rayleigh", "ratios": [0.02], "modes": [1, 2]}, "'damping' has 1 'ratios'; give two"),
        ({"kind": "rayleigh", "ratios": [0.02, 0.02]}, "'damping' has no place of its ratios"),
        ({"kind": "rayleigh", "ratios": [0.02, 0.02], "modes": [3, 1]}, "is for 3 before 1"),
        (
            {"kind": "rayleigh", "ratios": [0.02, 0.001], "frequencies": ["5 Hz", "40 Hz"]},
            "with the ratios 0.02 at 5 Hz and 0.001 at 40 Hz would feed energy into other modes; "
            "give a second ratio from 0.0025 to 0.16",
        ),
        ({"kind": "stiffness", "time": "1 m"}, "'damping.time'"),
        ({"kind": "stiffness", "time": "1 ms", "frequency": "5 Hz"}, "has a 'time' and a 'frequency'"),
        ({"kind": "modal", "ratio": 0.02}, "'damping' needs 'modes', the number of damped modes"),
        ({"kind": "modal", "ratios": []}, "'damping' has no 'ratios'"),
    ],
)
def test_a_fault_is_one_sentence(damping, sentence):
    with pytest.raises(InputError) as caught:
        beam(damping)
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("damping", "sentence"),
    [
        (
            {"kind": "modal", "ratio": 0.1, "modes": 99},
            "'damping' is for mode 99, but the rod has 32 modes",
        ),
        (
            {"kind": "rayleigh", "ratios": [0.02, 0.5], "modes": [1, 2]},
            "'damping' with the ratios 0.02 at 16.03 Hz",
        ),
    ],
)
def test_a_fault_that_needs_the_modes_is_one_sentence(damping, sentence):
    with pytest.raises(InputError) as caught:
        beam(damping).problem.solve("x")
    assert sentence in str(caught.value)


def test_a_posed_rod_has_mass_damping_alone():
    arc = {"kind": "arc", "curvature": 1.0}
    with pytest.raises(InputError, match="has a 'pose' and a damping of kind 'modal', which is about"):
        beam(EVERY["modal"], pose=arc)
    assert beam(EVERY["mass"], pose=arc).problem.pose is not None


def test_a_body_with_stresses_at_its_reference_has_no_stiffness_damping():
    """An equal shift of all positions by a twentieth of the first edge, but for the first vertex, as a reference."""
    problem = beam(EVERY["time"]).problem
    system = problem.system(problem.geometry)
    strained = system.space.reference.copy()
    strained[4::4] += 0.05 * problem.geometry.edge_length[0]
    system = replace(system, space=replace(system.space, at_rest=strained))
    with pytest.raises(
        InputError, match="x: 'damping' in proportion to stiffness is for a body without"
    ):
        rest_strains(system, "x")


def test_explicit_methods_have_mass_damping_alone():
    with pytest.raises(InputError, match="'rk4', which has no damping of kind 'stiffness'; take"):
        beam(EVERY["stiffness"], integrator={"method": "rk4", "step": 1e-6})
