"""A rod on a base that moves: response to a shock, and the same motion seen from outside."""

import numpy as np
import pytest
from scipy.linalg import eigh

import cosserat
from cosserat.errors import InputError

CLAMP = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}


def rod_on_a_base(**changes):
    """A clamped rod of 1 m that begins at rest."""
    rod = {"length": 1.0, **changes.pop("rod", {})}
    rest = {"supports": [CLAMP], "start": {"shape": "reference", "amplitude": 0.0}}
    return cosserat.case("vibration_consistent").vary("it", rod=rod, **{**rest, **changes})


def under_a_half_sine(w, peak, duration, t):
    """y'' + w^2 y = -peak sin(pi t / duration) until the duration, then free, from rest."""
    p = np.pi / duration

    def forced(t):
        size = -peak / (w**2 - p**2)
        return size * (np.sin(p * t) - p / w * np.sin(w * t)), size * p * (np.cos(p * t) - np.cos(w * t))

    y, rate = forced(duration)
    after = y * np.cos(w * (t - duration)) + rate / w * np.sin(w * (t - duration))
    return np.where(t < duration, forced(t)[0], after)


def shocked(steps, **base):
    """The end of a bar of two edges under a shock along it."""
    return rod_on_a_base(
        rod={"vertices": 3},
        base_motion={"along": "E3", **base},
        duration=0.02,
        every=1e-3,
        integrator={"step": 0.02 / steps},
    )


def test_a_bar_under_a_half_sine_shock_is_the_sum_of_its_modes():
    """Both modes as closed forms; without their frequencies no code of the package is used.  Second order in time."""
    peak, length = 50.0, 6e-3
    function = {"kind": "half-sine", "duration": length}
    case = shocked(100, acceleration=peak, time_function=function)
    rod, band = case.problem.rod, case.problem.rod.mass(case.problem.geometry)
    mass = np.array([[band[4, 0], band[4, 4]], [band[4, 4], band[8, 0]]])
    to_base = np.array([band[0, 4], 0.0])
    stiffness = 2 * rod.young * rod.area * np.array([[2, -1], [-1, 1]])
    squares, shapes = eigh(stiffness, mass)
    errors = []
    for steps in (800, 1600):
        run = cosserat.run(shocked(steps, acceleration=peak, time_function=function))
        t = run.time.to_numpy()
        exact = sum(
            shape[1] * (shape @ (mass.sum(axis=1) + to_base)) * under_a_half_sine(w, peak, length, t)
            for w, shape in zip(np.sqrt(squares), shapes.T, strict=True)
        )
        found = run.x.sel(axis="E3").isel(vertex=-1).to_numpy() - 1
        errors.append(np.abs(found - exact).max() / np.abs(exact).max())
    assert errors[0] < 0.02
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)


def test_the_largest_displacement_is_on_the_shock_spectrum():
    """Residual response of one mode: 2 b cos(pi / 2 b) / (1 - b^2) of the static one, b = pi / (omega duration).

    Largest when the shock is short: the first bending mode has nearly all of the motion of the tip after it.
    """
    case = rod_on_a_base(rod={"vertices": 9}, integrator={"step": 2e-4})
    found = case.problem.modes(1)
    w, shape = found.angular_frequency[0], found.shape[0].reshape(-1, 4)
    duration = 0.6 * np.pi / w
    b = np.pi / (w * duration)
    run = cosserat.run(
        case.vary(
            "it",
            base_motion={
                "along": "E2",
                "acceleration": 0.1,
                "time_function": {"kind": "half-sine", "duration": duration},
            },
            duration=duration + 2 * np.pi / w,
            every=2e-4,
        )
    )
    rod, arc = case.problem.rod, case.problem.geometry.arc_length
    # of a uniform cantilever: participation times tip of its first mode, 1.5660
    residual = 1.5660 * 0.1 / w**2 * 2 * b * np.cos(np.pi / (2 * b)) / (1 - b**2)
    after = run.x.sel(axis="E2").isel(vertex=-1, time=run.time.to_numpy() > duration)
    assert rod.length == arc[-1]
    assert shape[-1, 1] > 0
    assert float(np.abs(after).max()) == pytest.approx(abs(residual), rel=0.03)


def shifted(step, *, from_outside):
    """A rod whose base moves by 0.3 m across it, smoothly, in 0.1 s; its tip relative to the base."""
    by, duration = 0.3, 0.1
    s = np.linspace(0, 1, 2001)
    record = [
        [t, a]
        for t, a in zip(duration * s, by * 60 * s * (1 - s) * (1 - 2 * s) / duration**2, strict=True)
    ]
    rise = {"kind": "ramp", "duration": duration, "smooth": True}
    moved = {"prescribed_displacements": [{"at": "first", "dof": "x2", "by": by, "time_function": rise}]}
    run = cosserat.run(
        rod_on_a_base(
            rod={"vertices": 9},
            duration=0.12,
            every=0.02,
            damping={"kind": "stiffness", "time": 1e-3},
            integrator={"step": step},
            **(moved if from_outside else {"base_motion": {"along": "E2", "record": record}}),
        )
    )
    seen = run.x.isel(vertex=-1) - run.x.isel(vertex=0)
    return seen.to_numpy(), run


def test_a_record_of_the_base_is_the_motion_seen_from_it():
    """The same rod seen from outside, its base led along the twice integrated record: equal to second order."""
    errors = []
    for step in (1e-3, 5e-4):
        inside, run = shifted(step, from_outside=False)
        outside, _ = shifted(step, from_outside=True)
        errors.append(np.abs(inside - outside).max())
    assert np.abs(inside[:, 1]).max() > 0.05
    assert errors[1] < 1e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.3)
    balance = run.kinetic_energy + run.strain_energy + run.dissipated_energy - run.load_work
    assert np.abs(balance).max() < 1e-9 * float(np.abs(run.load_work).max())
    assert float(np.abs(run.x.isel(vertex=0)).max()) == 0  # the base is at rest in its own frame


def test_a_record_is_zero_outside_and_a_constant_acceleration_is_a_weight():
    still = {"rod": {"vertices": 5}, "duration": 0.05, "every": 0.01, "integrator": {"step": 1e-3}}
    late = rod_on_a_base(**still, base_motion={"along": "E2", "record": [[0.04, 5.0], [0.041, 5.0]]})
    moved = np.abs(cosserat.run(late).x.sel(axis="E2").isel(vertex=-1).to_numpy())
    assert moved[:5].max() < 1e-15
    assert moved[5] > 1e-5
    one = cosserat.run(rod_on_a_base(**still, base_motion={"along": "-E2", "acceleration": 9.81}))
    two = cosserat.run(rod_on_a_base(**still, gravity={"along": "E2", "g": 9.81}))
    np.testing.assert_allclose(one.x, two.x, atol=1e-15)


def test_a_record_comes_from_a_file(tmp_path):
    (tmp_path / "quake.csv").write_text("time [ms],acceleration [mm/s^2]\n0,0\n10,500\n20,0\n")
    (tmp_path / "my.toml").write_text(
        '[mine]\nlike = "vibration_consistent"\nbase_motion = { along = "E2", record = "quake.csv" }\n'
    )
    problem = cosserat.case("mine", tmp_path / "my.toml").problem
    assert problem.base_motion.record == ((0, 0), (0.01, 0.5), (0.02, 0))
    assert problem.base_motion.level.value(np.array([-1.0, 0.005, 0.03])) == pytest.approx([0, 0.25, 0])
    assert type(problem).model_validate_json(problem.model_dump_json()) == problem


@pytest.mark.parametrize(
    ("base", "sentence"),
    [
        ({"along": "E2"}, "'base_motion' needs 'acceleration' or 'record', just one of them"),
        ({"along": "E2", "acceleration": "1 m/s"}, "'base_motion.acceleration'"),
        ({"along": "E2", "record": [[0, 0]]}, "'base_motion.record' has 1 row; it needs 2 or more"),
        ({"along": "E2", "record": [[1, 0], [0, 0]]}, "has time 1 before 0; sort the rows by time"),
        (
            {
                "along": "E2",
                "record": [[0, 0], [1, 0]],
                "time_function": {"kind": "pulse", "duration": 1.0},
            },
            "'base_motion' has a 'record' and a 'time_function'; leave one of them out",
        ),
    ],
)
def test_a_fault_is_one_sentence(base, sentence):
    with pytest.raises(InputError) as caught:
        rod_on_a_base(base_motion=base)
    assert sentence in str(caught.value)


def test_only_a_motion_has_a_base_that_moves():
    with pytest.raises(InputError, match="'base_motion' is not a key"):
        cosserat.case("elastica").vary("it", base_motion={"along": "E2", "acceleration": 1.0})
