"""Starts of a motion against exact motions: released equilibria, single modes, velocities along the rod."""

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError, UnsupportedRodError
from cosserat.rods.problem import LOADS
from cosserat.solvers.banded import band_product

CLAMP = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}
ROOTS = np.array([1.8751040687, 4.6940911330, 7.8547574382, 10.9955407349])
"""cos x cosh x = -1: x^2 sqrt(EI / rho A) / L^2 are the angular frequencies of a cantilever."""


def static(vertices=9, energy="consistent", **loads):
    """A clamped slender rod of 1 m at rest under loads."""
    case = cosserat.case("vibration_consistent" if energy == "consistent" else "vibration_c4_20")
    rod = case.problem.rod.model_dump()
    return cosserat.case("clamped_free").vary(
        "still",
        rod={
            **rod,
            "vertices": vertices,
            "length": 1.0,
            "section": {**rod["section"], "height": 0.02, "width": 0.02},
        },
        supports=[CLAMP],
        **{"gravity": "none", "forces": [], "line_loads": [], **loads},
    )


def motion(start, still=None, plain=None, **changes):
    """The same rod in motion; still : the static problem from which it starts."""
    rod = (still or plain or static()).problem.rod.model_dump()
    if still is not None:
        changes["start_from"] = still.problem.model_dump()
    return cosserat.case("vibration_consistent").vary(
        "moving",
        rod=rod,
        supports=changes.pop("supports", [CLAMP]),
        start={"shape": "reference", "amplitude": 0.0, **start},
        **{"duration": 0.1, "every": 0.01, "integrator": {"step": 1e-3}, **changes},
    )


def bending(case):
    """EI and the lowest angular frequencies of the Euler-Bernoulli cantilever of 1 m."""
    rod = case.problem.rod
    EI = rod.young * rod.second_moment
    return EI, ROOTS**2 * np.sqrt(EI / rod.line_density)


def test_a_plucked_cantilever_is_the_sum_of_its_modes():
    """Its tip goes as sum of 4 F L^3 / (EI x^4) cos(omega t): the force is there before the start and then gone."""
    still = static(41, forces=[{"at": "last", "along": "E2", "force": 1e-3}])
    EI, omega = bending(still)
    period = 2 * np.pi / omega[0]
    run = cosserat.run(
        motion(
            {"shape": "equilibrium"},
            still,
            duration=period,
            every=period / 40,
            integrator={"step": period / 800},
        )
    )
    t, tip = run.time.to_numpy(), run.x.sel(axis="E2").isel(vertex=-1).to_numpy()
    exact = (4e-3 / EI / ROOTS**4) @ np.cos(omega[:, None] * t)
    assert tip[0] == pytest.approx(1e-3 / (3 * EI), rel=2e-3)
    np.testing.assert_allclose(tip, exact, atol=0.01 * tip[0])
    assert float(run.kinetic_energy[0]) == 0
    assert float(run.strain_energy[0]) == pytest.approx(1e-3 * tip[0] / 2, rel=1e-6)


@pytest.mark.parametrize("energy", ["consistent", "published"])
@pytest.mark.parametrize("own", [True, False])
def test_a_rod_that_keeps_its_loads_stays_in_equilibrium(energy, own):
    """Bent far, with directors in equilibrium too: given by the loads of the motion, or by a static problem."""
    plain = static(energy=energy)
    EI, _ = bending(plain)
    loads = {"forces": [{"at": "last", "along": "E2", "force": 2 * EI}]}
    still = static(energy=energy, **loads)
    case = motion({"shape": "equilibrium"}, None if own else still, still, **loads)
    run = cosserat.run(case)
    assert float(run.x[0, -1].sel(axis="E2")) > 0.3
    assert np.abs(run.x - run.x[0]).max() < 1e-7
    assert float(run.kinetic_energy.max()) < 1e-10 * float(run.strain_energy[0])


def test_a_load_that_doubles_swings_twice_as_far():
    """Start under half a weight along the rod: every mode swings about the whole one, so u - u_1 begins at -u_1 / 2."""
    half, whole = ({"g": g, "along": "E3"} for g in (5.0, 10.0))
    still = static(3, gravity=half)
    far = cosserat.run(static(3, gravity=whole)).u.sel(axis="E3").to_numpy()
    problem = motion({}, None, still).problem
    (w,) = problem.modes(40).angular_frequency[-1:]
    assert w > 0
    run = cosserat.run(
        motion(
            {"shape": "equilibrium"},
            still,
            gravity=whole,
            duration=0.02,
            every=2e-5,
            integrator={"step": 2e-5},
        )
    )
    moved = run.x.sel(axis="E3").to_numpy() - run.x_ref.sel(axis="E3").to_numpy()
    np.testing.assert_allclose(moved[0], far / 2, rtol=1e-6)
    total = run.kinetic_energy + run.strain_energy + run.load_potential
    assert np.ptp(total.to_numpy()) < 1e-9 * float(run.strain_energy.max())
    # the mean of an undamped motion is the equilibrium, and the middle of its swing
    np.testing.assert_allclose(moved.mean(axis=0)[1:], far[1:], rtol=0.02)
    assert moved[:, -1].max() == pytest.approx(1.5 * far[-1], rel=0.03)


def test_a_rod_on_an_oblique_roller_stays_in_equilibrium():
    forces = [{"at": "50 %", "along": "-E2", "force": 40.0}]
    roller = {"at": "last", "fixed": "roller", "along": "30 deg"}
    still = static(forces=forces)
    case = motion({"shape": "equilibrium"}, None, still, forces=forces, supports=[CLAMP, roller])
    run = cosserat.run(case)
    u = (run.x[0, -1] - run.x_ref[-1]).to_numpy()
    assert u[1] / u[0] == pytest.approx(np.tan(np.pi / 6), rel=1e-6)
    assert np.abs(run.x - run.x[0]).max() < 1e-7
    mode = case.vary("mode", start={"mode": 1, "amplitude": 1e-3}).problem.begin()
    moved = mode.q - case.problem.begin().q
    assert np.abs(moved).max() > 1e-4
    held = still.vary("held", supports=[CLAMP, roller]).problem
    right = held.system(held.geometry).frame.into(held.modes(1).shape[0])
    np.testing.assert_allclose(moved / np.abs(moved).max(), right / np.abs(right).max(), atol=1e-9)


@pytest.mark.parametrize("tension", [0.0, 20.0])
@pytest.mark.parametrize("speed", [False, True])
def test_a_motion_that_starts_in_a_mode_stays_in_it(tension, speed):
    """Also about an equilibrium, whose modes a tension stiffens."""
    forces = [{"at": "last", "along": "E3", "force": tension}]
    still = static(forces=forces)
    modes = still.problem.modes(6)
    omega, period = modes.angular_frequency[1], 2 * np.pi / modes.angular_frequency[1]
    size = {"mode_speed": 1e-7 * omega} if speed else {"amplitude": 1e-7}
    shape = "equilibrium" if tension else "reference"
    errors = []
    for steps in (100, 200):
        case = motion(
            {"shape": shape, "mode": 2, **size},
            still if tension else None,
            still,
            forces=forces if tension else [],
            duration=0.9 * period,
            every=0.9 * period / 10,
            integrator={"step": 0.9 * period / steps},
        )
        run, problem = cosserat.run(case), case.problem
        rest = problem.replace(start={"shape": shape}).begin().q
        band = problem.rod.mass(problem.geometry)
        q = np.concatenate([run.x, run.d], axis=2).reshape(len(run.time), -1)
        moved = modes.shape @ np.array([band_product(band, u - rest) for u in q]).T
        unit = modes.shape[1].reshape(-1, 2, 2)[:, 0]
        size_of_mode = 1e-7 / np.linalg.norm(unit, axis=1).max()
        wave = (np.sin if speed else np.cos)(omega * run.time.to_numpy())
        others = np.delete(moved, 1, axis=0)
        assert np.abs(others).max() < 1e-6 * size_of_mode
        errors.append(np.abs(np.abs(moved[1] / size_of_mode) - np.abs(wave)).max())
    assert errors[0] < 2e-2
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)


def test_loads_that_depend_on_time_are_not_in_the_equilibrium_of_a_start():
    constant = {"at": "last", "along": "E2", "force": 1.0}
    later = {**constant, "force": 5.0, "time_function": {"kind": "pulse", "duration": 1.0}}
    still = static(forces=[constant])
    moving = motion({"shape": "equilibrium"}, None, still, forces=[constant, later]).problem.begin()
    np.testing.assert_array_equal(moving.q, motion({"shape": "equilibrium"}, still).problem.begin().q)


KEPT = {"kind": "table", "rows": [[0.0, 0.4], [0.05, 0.4], [0.06, 1.0]]}
"""A load that is there before the motion, at 0.4 of its size, until 0.05 s."""
BEFORE = {
    "gravity": {"g": 1.0, "along": "-E2"},
    "forces": [{"at": "30 %", "along": "E2", "force": 3.0}],
    "line_loads": [{"along": "E3", "density": 2.0, "start": 0.1, "end": 0.6}],
    "couples": [{"at": "last", "moment": 4.0}],
    "line_couples": [{"density": 2.0}],
    "follower_forces": [{"at": "last", "along": "-E3", "force": 5.0}],
    "follower_line_loads": [{"along": "E2", "density": 3.0}],
    "pressures": [{"side": "upper", "pressure": 50.0}],
    "prestrains": [{"extension": 0.02, "section": 0.01, "curvature": 0.3}],
    "temperatures": [{"change": 50.0, "expansion": 1e-4}],
}
"""A load of every kind that a motion may start with."""
TURN = {"prescribed_rotations": [{"at": "first", "by": 0.8}]}


def over_time(given, function):
    """Loads or moved supports with a function of time."""
    if isinstance(given, dict):
        return given | {"time_function": function}
    return [item | {"time_function": function} for item in given]


FORCES = {"forces", "couples", "line_couples", "follower_forces"}
"""Half of the loads, with as many potentials as compiled steps have places for."""


def test_every_kind_of_load_is_tried_before_a_motion():
    assert set(BEFORE) == set(LOADS) - {"base_motion"}


@pytest.mark.parametrize(
    ("constraint", "kinds"), [("free", FORCES), ("incompressible", set(BEFORE) - FORCES)]
)
def test_loads_that_are_there_before_a_motion_hold_its_start(constraint, kinds):
    """Loads and a clamp that turns, each a table: the start is the equilibrium under its first values.

    Nothing moves before the tables rise.
    """
    plain = static()
    soft = {"lateral_constraint": constraint, "material": {"poisson": 0.49, "young": 1e8}}
    still = plain.vary("still", rod=soft)
    loads = {key: BEFORE[key] for key in sorted(kinds)}
    every = {key: over_time(given, KEPT) for key, given in {**loads, **TURN}.items()}
    moving = motion({"shape": "equilibrium"}, None, still, **every, duration=0.04)
    run = cosserat.run(moving)
    assert np.abs(run.x[0] - run.x_ref).max() > 0.1
    np.testing.assert_allclose(run.x, run.x[0].broadcast_like(run.x), atol=1e-7)
    np.testing.assert_allclose(run.d, run.d[0].broadcast_like(run.d), atol=1e-7)
    first, rest = run.d[0, 0].to_numpy(), run.d_ref[0].to_numpy()
    assert np.arctan2(-first[0], first[1]) == pytest.approx(0.4 * 0.8, rel=1e-9)
    assert np.hypot(*first) == pytest.approx(np.hypot(*rest), rel=1e-12)


@pytest.mark.parametrize(
    ("function", "before"),
    [
        ({"kind": "table", "rows": [[-1.0, 0.0], [1.0, 1.0]]}, 0.5),
        ({"kind": "table", "rows": [[0.2, 0.3], [1.0, 1.0]]}, 0.3),
        ({"kind": "sine", "frequency": 3.0, "phase": 1.0}, 0.0),
        ({"kind": "ramp", "duration": 1.0}, 0.0),
    ],
)
def test_what_a_load_is_before_time_zero(function, before):
    """Against a static problem under that part of the force."""
    force = {"at": "last", "along": "E2", "force": 5.0}
    own = motion({"shape": "equilibrium"}, forces=[force | {"time_function": function}]).problem.begin()
    held = static(forces=[force | {"force": 5.0 * before}])
    given = motion({"shape": "equilibrium"}, held).problem.begin()
    np.testing.assert_allclose(own.q, given.q, atol=1e-9)


def test_a_motion_takes_over_a_clamp_that_was_turned():
    """From a static answer with a turned clamp: the motion turns it further, from its reference, without a stretch."""
    turned = {"at": "first", "by": 0.8}
    table = {"kind": "table", "rows": [[0.0, 1.0], [0.02, 1.0], [0.04, 1.5]]}
    still = static(prescribed_rotations=[turned])
    moving = motion(
        {"shape": "equilibrium"},
        still,
        prescribed_rotations=[turned | {"time_function": table}],
        duration=0.06,
    )
    run = cosserat.run(moving)
    first = run.d[:, 0].to_numpy()
    angles = np.arctan2(-first[:, 0], first[:, 1])
    np.testing.assert_allclose(angles[[0, 1, 4, 6]], [0.8, 0.8, 1.2, 1.2], atol=1e-9)
    np.testing.assert_allclose(np.hypot(*first.T), 0.01, rtol=1e-9)
    np.testing.assert_allclose(run.x[1], run.x[0], atol=1e-9)


def test_velocities_along_the_rod():
    """A line of velocities with its spin is a rotation; half a rod that moves has half the momentum."""
    turning = [[0.0, 0.0, 0.0, 3.0], [1.0, 0.0, 3.0, 3.0]]
    free = {"supports": [], "duration": 1e-3, "every": 1e-3}
    table, spin = motion({"velocities": turning}, **free), motion({"spin": 3.0}, **free)
    np.testing.assert_allclose(table.problem.begin().v, spin.problem.begin().v, atol=1e-14)
    halves = [[0.0, 2.0, 1.0, 0.0], [0.5 - 1e-9, 2.0, 1.0, 0.0], [0.5 + 1e-9, 0, 0, 0], [1, 0, 0, 0]]
    run = cosserat.run(motion({"velocities": halves, "speed": 1.0}, plain=static(10), **free))
    mass = table.problem.rod.line_density
    assert run.momentum[0].to_numpy() == pytest.approx([2 * mass, 0.5 * mass], rel=1e-9)


def test_a_start_from_a_case_of_a_file(tmp_path):
    (tmp_path / "my.toml").write_text(
        '[_rod]\nrod.energy = "consistent"\nrod.vertices = 5\nrod.length = "1 m"\n'
        'rod.section = { shape = "rectangle", shear_factor = "5/6", height = "2 cm", width = "2 cm" }\n'
        'rod.material = { young = "1 GPa", poisson = 0, line_density = "1 kg/m" }\n'
        'supports = [{ at = "first", fixed = ["x3", "x2", "d3", "d2"] }]\n'
        '[still]\nlike = "_rod"\nkind = "rod statics"\nforces = [{ at = "last", along = "E2", force = "1 N" }]\n'
        '[moving]\nlike = "_rod"\nkind = "rod motion"\nstart.shape = "equilibrium"\n'
        'start_from = { like = "still" }\nduration = "1 s"\nevery = "0.1 s"\nintegrator.step = "1 ms"\n'
    )
    still, moving = (cosserat.case(name, tmp_path / "my.toml") for name in ("still", "moving"))
    assert moving.problem.start_from == still.problem
    assert moving.problem.forces == ()
    again = type(moving.problem).model_validate_json(moving.problem.model_dump_json())
    assert again == moving.problem


def test_what_an_equilibrium_warns_of_is_among_the_warnings():
    """A column under more than its buckling load stands on one of two sides."""
    plain = static()
    EI, _ = bending(plain)
    forces = [{"at": "last", "along": "-E3", "force": 3.0 * EI}]
    case = motion({"shape": "equilibrium"}, None, plain, forces=forces, duration=0.002, every=0.002)
    words = case.problem.solve("x").warnings
    assert any(said.startswith("bifurcation") and said.endswith("(of the start)") for said in words)


@pytest.mark.parametrize(
    ("start", "sentence"),
    [
        ({"shape": "bent"}, "'start.shape' is 'bent'; it must be 'reference'"),
        ({"mode": 0}, "'start.mode' is 0; it must be at least 1"),
        ({"mode_speed": 1.0}, "has start.mode_speed without start.mode; give the number of the mode"),
        ({"shape": "equilibrium", "amplitude": 0.1}, "has start.amplitude without start.mode"),
        ({"shape": "first beam mode", "mode": 2}, "has start.mode and start.shape = 'first beam mode'"),
        (
            {"velocities": [[0, 1]]},
            "'start.velocities' has the row [0, 1] at 0; each row must be [at, E3",
        ),
        ({"velocities": []}, "'start.velocities' has 0 rows; it needs 1 or more"),
    ],
)
def test_a_fault_is_one_sentence(start, sentence):
    with pytest.raises(InputError) as caught:
        motion(start)
    assert sentence in str(caught.value)


def test_faults_of_an_equilibrium_are_sentences():
    with pytest.raises(InputError, match="has 'start_from' and start.shape = 'reference'; write"):
        motion({}, static())
    with pytest.raises(InputError, match="'start_from' has other vertices than the motion"):
        motion({"shape": "equilibrium"}, static(9)).vary("x", rod={"vertices": 10}).problem.begin()
    with pytest.raises(UnsupportedRodError, match="the start: the supports leave the rod free to move"):
        motion({"shape": "equilibrium"}, supports=[]).problem.begin()
    with pytest.raises(
        InputError, match="'start.mode' is 99, but the rod has 32 modes; take a lower one"
    ):
        motion({"mode": 99, "amplitude": 1e-3}).problem.begin()
