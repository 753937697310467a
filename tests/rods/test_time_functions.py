"""Loads and supports that depend on time, against exact answers."""

import itertools

import numpy as np
import pytest
from pydantic import TypeAdapter
from scipy.integrate import quad
from scipy.linalg import eigh

import cosserat
from cosserat.errors import InputError
from cosserat.rods.time_functions import AnyTimeFunction

CLAMP = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}
EVERY = {
    "ramp": {"kind": "ramp", "start": 0.3, "duration": 1.1},
    "smooth": {"kind": "ramp", "start": 0.3, "duration": 1.1, "smooth": True},
    "sine": {"kind": "sine", "frequency": 0.7, "phase": 0.4, "start": 0.2},
    "pulse": {"kind": "pulse", "start": 0.3, "duration": 0.55},
    "half-sine": {"kind": "half-sine", "start": 0.3, "duration": 0.55},
    "chirp": {
        "kind": "chirp",
        "start": 0.1,
        "duration": 1.5,
        "first_frequency": 0.5,
        "last_frequency": 3.0,
    },
    "table": {"kind": "table", "rows": [[0.2, 1.0], [0.7, -2.0], [1.5, 3.0]]},
    "spline": {
        "kind": "table",
        "rows": [[0.2, 1.0], [0.7, -2.0], [1.5, 3.0]],
        "interpolation": "spline",
    },
}
BY_HAND = {
    "ramp": lambda t: min(max((t - 0.3) / 1.1, 0), 1),
    "smooth": lambda t: np.polyval([6, -15, 10, 0, 0, 0], min(max((t - 0.3) / 1.1, 0), 1)),
    "sine": lambda t: np.sin(2 * np.pi * 0.7 * (t - 0.2) + 0.4) * (t >= 0.2),
    "pulse": lambda t: float(0.3 <= t < 0.85),
    "half-sine": lambda t: np.sin(np.pi * (t - 0.3) / 0.55) * (0.3 <= t < 0.85),
    "chirp": lambda t: (
        np.sin(2 * np.pi * (0.5 * (t - 0.1) + 2.5 / 3 * (t - 0.1) ** 2)) * (0.1 <= t < 1.6)
    ),
    "table": lambda t: np.interp(t, [0.2, 0.7, 1.5], [1, -2, 3]),
}


def made(name):
    return TypeAdapter(AnyTimeFunction).validate_python(EVERY[name])


@pytest.mark.parametrize("name", BY_HAND)
def test_its_values_are_those_written_by_hand(name):
    times = np.linspace(0, 2, 173)
    np.testing.assert_allclose(made(name).value(times), [BY_HAND[name](t) for t in times], atol=1e-14)


def test_a_spline_passes_through_its_rows_and_keeps_its_ends():
    times = np.array([0.0, 0.2, 0.7, 1.5, 2.0])
    np.testing.assert_allclose(made("spline").value(times), [1, 1, -2, 3, 3], atol=1e-14)


@pytest.mark.parametrize("name", EVERY)
def test_rates_are_derivatives_and_means_are_integrals(name):
    given, step = made(name), 1e-5
    times = np.linspace(0.0123, 1.9, 57)
    smooth = times[np.abs(times[:, None] - np.array([*given.breaks, 1.6])).min(axis=1) > 1e-3]
    _, rate, second = given.derivatives(smooth)
    around = [given.derivatives(smooth + side * step) for side in (-1, 1)]
    np.testing.assert_allclose(rate, (around[1][0] - around[0][0]) / 2 / step, atol=1e-6)
    np.testing.assert_allclose(second, (around[1][1] - around[0][1]) / 2 / step, atol=1e-5)
    cuts = np.linspace(0, 2, 12)
    means = [
        quad(lambda t: given.value(np.array([t]))[0], a, b, points=given.breaks, epsabs=1e-12)[0]
        / (b - a)
        for a, b in itertools.pairwise(cuts)
    ]
    np.testing.assert_allclose(given.means(cuts), means, atol=2e-7)


def bar(vertices, steps, duration, rod=(), **changes):
    """A bar of 1 m clamped at its first end."""
    return cosserat.case("vibration_consistent").vary(
        "bar",
        rod={"vertices": vertices, "length": 1.0, **dict(rod)},
        supports=[CLAMP],
        start={"shape": "reference", "amplitude": 0.0},
        duration=duration,
        every=duration / 20,
        integrator={"step": duration / steps},
        **changes,
    )


def moduli(case):
    rod = case.problem.rod
    return rod.young * rod.area, np.sqrt(rod.young * rod.area / rod.line_density)


def test_a_sudden_force_makes_a_triangular_wave():
    """The end of a bar goes to 2 F L / EA and back, in the time 4 L / c (one-dimensional waves)."""
    EA, c = moduli(bar(3, 1, 1.0))
    errors = []
    for vertices in (41, 81):
        case = bar(
            vertices,
            10 * vertices,
            4 / c,
            forces=[{"at": "last", "along": "E3", "force": 1e-6 * EA}],
        )
        run = cosserat.run(case)
        wave = 2e-6 * (1 - np.abs(1 - run.time * c / 2))
        errors.append(float(np.abs(run.x.sel(axis="E3").isel(vertex=-1) - 1 - wave).max()) / 2e-6)
    assert errors[0] < 0.02
    assert errors[1] < 0.7 * errors[0]  # order 2/3 at the corners


@pytest.mark.parametrize(
    ("kind", "method"),
    [*((kind, "implicit") for kind in ("half-sine", "pulse", "ramp", "sine")), ("half-sine", "rk45")],
)
def test_one_mode_follows_duhamels_integral(kind, method):
    """A bar of two edges is two masses; its end follows the convolution of the force with the exact response."""
    case = bar(3, 4000, 0.02)
    EA, _ = moduli(case)
    function = {
        "half-sine": {"kind": "half-sine", "start": 1e-3, "duration": 6e-3},
        "pulse": {"kind": "pulse", "start": 1.37e-3, "duration": 5.123e-3},
        "ramp": {"kind": "ramp", "start": 1e-3, "duration": 9e-3},
        "sine": {"kind": "sine", "frequency": 170.0, "phase": 0.3},
    }[kind]
    run = cosserat.run(
        case.vary(
            "it",
            forces=[{"at": "last", "along": "E3", "force": 1e-6 * EA, "time_function": function}],
            integrator={
                "method": method,
                "step": {"implicit": 5e-6}.get(method, 1e-4),
                "tolerance": 1e-11,
            },
        )
    )
    stiffness = 2 * EA * np.array([[2, -1], [-1, 1]])
    square, shapes = eigh(stiffness, mass_of_two_edges(case))
    value = TypeAdapter(AnyTimeFunction).validate_python(function)
    points = np.linspace(0, 0.02, 40_001)
    force = value.value((points[1:] + points[:-1]) / 2) * np.diff(points)
    middles = (points[1:] + points[:-1]) / 2
    for number, time in list(enumerate(run.time.to_numpy()))[1::4]:
        past = middles < time
        exact = sum(
            shapes[1, mode] ** 2 * (force[past] * np.sin(w * (time - middles[past]))).sum() / w
            for mode, w in enumerate(np.sqrt(square))
        )
        found = float(run.x[number].sel(axis="E3")[-1]) - 1
        assert found == pytest.approx(1e-6 * EA * exact, abs=2e-3 * 1e-6)
    balance = run.kinetic_energy + run.strain_energy - run.load_work
    assert np.abs(balance).max() < 1e-6 * float(np.abs(run.load_work).max())


def mass_of_two_edges(case):
    """The masses of x3 of the two free vertices, from the band."""
    band = case.problem.rod.mass(case.problem.geometry)
    return np.array([[band[4, 0], band[4, 4]], [band[4, 4], band[8, 0]]])


def test_gravity_and_a_couple_depend_on_time():
    """Slowly raised, a weight and a couple bend the rod as they do at rest."""
    loads = {
        "gravity": {"g": 1e-3, "along": "-E2"},
        "couples": [{"at": "last", "moment": 20.0}],
    }
    case = bar(9, 200, 1.0, rod={"length": 2.0})
    rod = case.problem.rod.model_dump()
    still = cosserat.case("clamped_free").vary("still", rod=rod, supports=[CLAMP], **loads)
    rise = {"kind": "ramp", "duration": 3.0, "smooth": True}
    moving = case.vary(
        "moving",
        gravity={**loads["gravity"], "time_function": rise},
        couples=[{**loads["couples"][0], "time_function": rise}],
        duration=4.0,
        every=1.0,
        integrator={"step": 2e-3},
    )
    at_rest, run = cosserat.run(still), cosserat.run(moving)
    tip = float(at_rest.u[-1].sel(axis="E2"))
    assert float(run.x[-1].isel(vertex=-1).sel(axis="E2")) == pytest.approx(tip, rel=2e-3)
    stored = float(run.strain_energy[-1] + run.kinetic_energy[-1])
    assert float(run.load_work[-1]) == pytest.approx(stored, rel=1e-6)


@pytest.mark.parametrize(
    ("function", "sentence"),
    [
        ({"kind": "saw"}, "'saw'"),
        ({"kind": "ramp"}, "'forces.0.time_function.duration' is missing"),
        ({"kind": "sine", "frequency": "5 s"}, "in s, a time and not a frequency"),
        ({"kind": "half-sine", "duration": "-1 s"}, "is -1 s; it must be above 0"),
        ({"kind": "table", "rows": [["1 s", 1], ["0 s", 2]]}, "has time 1 before 0; sort the rows"),
        ({"kind": "table", "rows": "nowhere.csv"}, "is the file 'nowhere.csv', which cannot be read"),
    ],
)
def test_a_fault_is_one_sentence(function, sentence):
    force = {"at": "last", "along": "E3", "force": "1 N", "time_function": function}
    case = bar(3, 10, 1.0)
    with pytest.raises(InputError) as caught:
        case.vary("it", forces=[force])
    assert sentence in str(caught.value)


def test_a_static_problem_has_no_time():
    force = {"at": "last", "along": "E3", "force": 1.0, "time_function": EVERY["ramp"]}
    with pytest.raises(
        InputError, match="has a 'time_function' in 'forces', but only kind = 'rod motion'"
    ):
        cosserat.case("clamped_free").vary("it", forces=[force])


def test_a_case_with_a_record_survives_its_own_json(tmp_path):
    (tmp_path / "record.csv").write_text("time [ms],value\n0,0\n1,1\n2,0\n")
    (tmp_path / "my.toml").write_text(
        '[mine]\nlike = "vibration_consistent"\n[[mine.forces]]\nat = "last"\nalong = "E2"\nforce = "1 N"\n'
        'time_function = { kind = "table", rows = "record.csv" }\n'
    )
    case = cosserat.case("mine", tmp_path / "my.toml")
    assert case.problem.forces[0].time_function.rows == ((0, 0), (1e-3, 1), (2e-3, 0))
    assert type(case.problem).model_validate_json(case.problem.model_dump_json()) == case.problem
