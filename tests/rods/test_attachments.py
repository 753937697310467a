"""Springs and foundations: the contract of their energies, and exact answers of beams on them."""

import numpy as np
import pytest
from conftest import differentiated, jacobian
from hypothesis import given
from hypothesis import strategies as st
from transfer import FREE, Beam, answer, frequencies, point

import cosserat
from cosserat.errors import InputError, UnsupportedRodError
from cosserat.rods.attachments import ATTACHMENTS
from cosserat.rods.attachments.attachment import attached_energy
from cosserat.rods.attachments.foundations import Foundation
from cosserat.rods.loads.load import LoadedRod
from cosserat.solvers.banded import to_dense
from cosserat.solvers.potential import GRADIENT, STRAINS

EXAMPLES = {
    "springs": [
        {"at": "0.37 m", "along": "20 deg", "stiffness": 3.0, "rotational_stiffness": 0.4},
        {"at": "first", "rotational_stiffness": 0.7},
        {"at": "last", "along": "E2", "stiffness": 2.0},
    ],
    "foundations": [
        {"along": [3, 4], "stiffness": 5.0, "rotational_stiffness": 0.3, "start": 0.13, "end": 0.77}
    ],
}
BENT = cosserat.case("elastica").problem.rod.replace(vertices=6, rest={"kind": "arc", "curvature": 0.6})


def made(key, origin=False):
    geometry = BENT.geometry()
    items = [ATTACHMENTS[key].read(item, key, units_required=False) for item in EXAMPLES[key]]
    body = LoadedRod(BENT, geometry, geometry.q if origin else None)
    return geometry, attached_energy(items, body)


def strained(geometry, seed, size=0.002):
    return geometry.q + size * np.random.default_rng(seed).uniform(-1, 1, geometry.q.size)


every_kind = pytest.mark.parametrize("key", ATTACHMENTS)


@every_kind
@given(st.integers(0, 1000))
def test_forces_are_gradients_and_the_hessian_is_their_derivative(key, seed):
    geometry, potential = made(key)
    q = strained(geometry, seed)
    gradient, band = np.zeros(q.size), np.zeros((q.size, potential.half_bandwidth + 1))
    potential.add(q, potential.history, gradient, band)
    for found, right in (
        (gradient, jacobian(potential.energy, q, 1e-7)),
        (to_dense(band), jacobian(lambda p: differentiated(potential, p)[1], q, 1e-7)),
    ):
        np.testing.assert_allclose(found, right, atol=1e-5 * np.abs(right).max())


@every_kind
def test_the_reference_is_at_rest_in_positions_and_displacements(key):
    for origin in (False, True):
        geometry, potential = made(key, origin)
        rest = np.zeros_like(geometry.q) if origin else geometry.q
        assert abs(potential.energy(rest)) < 1e-25
        assert np.abs(differentiated(potential, rest)[1]).max() < 1e-10


@every_kind
def test_the_work_in_a_step_is_the_change_of_energy_to_third_order(key):
    geometry, potential = made(key)
    missing = np.zeros(2)
    for seed in range(12):
        q, step = strained(geometry, seed), strained(geometry, seed + 1, 5e-4) - geometry.q
        for k, fraction in enumerate((1.0, 0.5)):
            change, strains = fraction * step, np.zeros(potential.strains)
            before, _ = called(potential, q, np.empty(0), strains, STRAINS)
            after, gradient = called(potential, q + change / 2, q + change, strains, GRADIENT)
            assert after == pytest.approx(potential.energy(q + change), rel=1e-12)
            missing[k] += abs(after - before - gradient @ change)
    assert missing[0] / missing[1] == pytest.approx(8, rel=0.2)


def called(potential, q, after, strains, task):
    none, gradient = np.empty((0, 1)), np.zeros(q.size)
    arguments = (potential.history, strains, task, gradient, none, none, np.empty(1))
    return potential.evaluate(q, after, potential.data, *arguments), gradient


def beam(vertices, kind="rod statics", **changes):
    """A rod of 1 m by 0.1 m of nu = 0, shaken or at rest."""
    base = cosserat.case("elastica").vary("it", rod=cosserat.case("vibration_consistent").problem.rod)
    return base.vary("it", rod={"vertices": vertices}, **{"forces": [], "kind": kind, **changes})


ALONG = {"at": "first", "fixed": ["x3"]}
CLAMP = {"at": "first", "fixed": "clamped"}


def test_an_elastic_clamp_adds_its_rotation():
    """P L^3 / 3 EI + P L / kGA + P L^2 / c."""
    P, c, errors = 1.0, 3e4, []
    for vertices in (9, 17, 33):
        case = beam(
            vertices,
            forces=[{"at": "last", "along": "E2", "force": P}],
            supports=[{"at": "first", "fixed": "pinned"}],
            springs=[{"at": "first", "rotational_stiffness": c}],
        )
        it = Beam(case.problem.rod)
        exact = P * (it.L**3 / 3 / it.EI + it.L / it.GA + it.L**2 / c)
        run = cosserat.run(case)
        errors.append(abs(run.u.to_numpy()[-1, 1] / exact - 1))
        d = run.d.to_numpy()[0]
        moment = d[0] * run.attached_force[0].sel(dof="d2") - d[1] * run.attached_force[0].sel(dof="d3")
        assert float(moment) == pytest.approx(-P * it.L, rel=1e-6)
        assert float(run.attached_energy) == pytest.approx((P * it.L) ** 2 / 2 / c, rel=1e-6)
    assert errors[0] < 3e-3
    assert np.log2(errors[0] / errors[2]) > 3.8, errors


def test_a_rotational_spring_counts_whole_turns():
    """A pinned rod under a couple M turns as a whole by M / c, here by three turns."""
    c = 2.0
    case = beam(
        5,
        supports=[{"at": "first", "fixed": "pinned"}],
        springs=[{"at": "37 %", "rotational_stiffness": c}],
        couples=[{"at": "37 %", "moment": 6 * np.pi * c}],
        newton={"load_increments": 12},
    )
    run = cosserat.run(case)
    assert float(run.attached_energy) == pytest.approx(c * (6 * np.pi) ** 2 / 2, rel=1e-9)
    np.testing.assert_allclose(run.u, 0, atol=1e-6)


@pytest.mark.parametrize("place", ["50 %", "last"])
def test_a_cantilever_on_a_spring_is_of_second_order(place):
    """Transfer matrices; the spring is at 30 degrees from E3, in the middle where equal edges have no vertex."""
    k, c, angle, errors = 2e5, 5e3, np.pi / 6, []
    n = np.array([np.cos(angle), np.sin(angle), 0])
    for vertices in (8, 15, 29):
        spring = {"at": place, "along": "30 deg", "stiffness": k, "rotational_stiffness": c}
        force = {"at": "last", "along": "E2", "force": 1.0}
        case = beam(vertices, supports=[CLAMP], springs=[spring], forces=[force])
        it = Beam(case.problem.rod)
        held = point(k * np.outer(n, n) + np.diag([0, 0, c]))
        half = it.part(it.L / 2)
        steps = [half, held, half] if place == "50 %" else [half, half, held]
        _, end = answer(np.eye(6)[:3], [*steps, point(load=[0, 1.0, 0])], FREE)
        found = cosserat.run(case).u.to_numpy()[-1]
        errors.append(np.abs(found - end[:2]).max() / np.abs(end[1]))
    assert errors[0] < 2e-2
    assert np.log2(errors[0] / errors[2]) > 3.4, errors


def test_transfer_matrices_give_hetenyis_infinite_beam():
    """P beta / 2 k under a force on a long slender beam: what judges the others is judged."""
    it = Beam(cosserat.case("elastica").problem.rod)
    it.GA = 1e12
    k, side = 4 * it.EI * 30**4, 0.3
    steps = [point(np.diag([1.0, 0, 0])), it.part(side, k), point(load=[0, 1.0, 0])]
    start, _ = answer(FREE, [*steps, it.part(side, k)], FREE)
    at = np.append(start, 1)
    for step in steps:
        at = step(0.0) @ at
    assert at[1] == pytest.approx(30 / 2 / k, rel=1e-4)


def test_a_foundation_has_the_energy_of_a_linear_displacement():
    """k / 2 of the integral of (1 + 2 s)^2 from 0.13 to 0.77: that of its springs to the last digit."""
    ground = {"along": "E2", "stiffness": 5.0, "start": 0.13, "end": 0.77}
    rod = BENT.replace(rest={"kind": "straight"})
    geometry = rod.geometry()
    potential = attached_energy([Foundation(**ground)], LoadedRod(rod, geometry))
    q = geometry.q.reshape(-1, 4).copy()
    q[:, 1] += 1 + 2 * geometry.arc_length
    exact = 5.0 / 2 * ((1 + 2 * 0.77) ** 3 - (1 + 2 * 0.13) ** 3) / 6
    assert potential.energy(q.ravel()) == pytest.approx(exact, rel=1e-13)


def test_winklers_foundation_under_a_part_of_a_beam_is_of_second_order():
    """From 0.25 to 0.75 of the length, both at the middle of an edge of each mesh."""
    k, c, errors = 4e6, 2e4, []
    for vertices in (11, 31, 91):
        ground = {"along": "E2", "stiffness": k, "rotational_stiffness": c, "start": 0.25, "end": 0.75}
        force = {"at": "last", "along": "E2", "force": 1.0}
        case = beam(vertices, supports=[ALONG], foundations=[ground], forces=[force])
        it = Beam(case.problem.rod)
        steps = [point(np.diag([1.0, 0, 0])), it.part(0.25), it.part(0.5, k, c), it.part(0.25)]
        start, end = answer(FREE, [*steps, point(load=[0, 1.0, 0])], FREE)
        run = cosserat.run(case)
        found = run.u.to_numpy()[[0, -1], 1]
        errors.append(np.abs(found - [start[1], end[1]]).max() / abs(end[1]))
        assert float(run.attached_force.sel(dof="x2").sum()) == pytest.approx(-1.0, rel=1e-9)
    assert errors[0] < 2e-2
    assert np.log(errors[0] / errors[2]) / np.log(9) > 1.9, errors


def test_a_beam_on_springs_and_a_foundation_vibrates_as_it_must():
    errors = []
    for vertices in (10, 20, 40):
        case = beam(
            vertices,
            supports=[ALONG],
            springs=[
                {"at": "first", "along": "E2", "stiffness": 1e5, "rotational_stiffness": 2e4},
                {"at": "50 %", "along": "E2", "stiffness": 3e5},
            ],
            foundations=[{"along": "E2", "stiffness": 2e5}],
        )
        it = Beam(case.problem.rod)
        first = np.array([np.eye(6)[0], *np.eye(6)[4:]])  # u = Q = M = 0
        half = it.part(it.L / 2, 2e5)
        steps = [point(np.diag([0, 1e5, 2e4])), half, point(np.diag([0, 3e5, 0])), half]
        exact = frequencies(first, steps, FREE, 3)
        errors.append(np.abs(case.problem.modes(3).angular_frequency / exact - 1).max())
    assert errors[0] < 2e-2
    assert np.log2(errors[0] / errors[2]) > 3.6, errors


def bouncing(**changes):
    """A stiff rod without supports on two springs of 50 N/m; it starts across with 1 cm/s."""
    return (
        cosserat.case("vibration_consistent")
        .vary(
            "it",
            rod={"vertices": 17},
            supports=[],
            springs=[{"at": at, "along": "E2", "stiffness": 50.0} for at in ("first", "last")],
            start={"shape": "reference", "amplitude": 0.0, "speed": 0.01, "along": "E2"},
            duration=1.0,
            every=0.02,
            integrator={"step": 1e-3},
        )
        .vary("it", **changes)
    )


def balanced(run):
    total = (run.kinetic_energy + run.strain_energy + run.attached_energy).to_numpy()
    return np.ptp(total) / total[0]


def test_a_rod_bounces_on_springs_and_keeps_its_energy():
    """v / omega sin(omega t), omega^2 = 2 k / m, of a rod that is ten thousand times as stiff."""
    run, omega = cosserat.run(bouncing()), np.sqrt(2 * 50.0 / 10.0)
    exact = 0.01 / omega * np.sin(omega * run.time)
    np.testing.assert_allclose(run.x.sel(axis="E2").mean("vertex"), exact, atol=1e-3 * 0.01 / omega)
    assert balanced(run) < 1e-9
    assert float(run.attached_energy.max() / run.kinetic_energy[0]) == pytest.approx(1, abs=1e-2)


def test_explicit_and_implicit_methods_agree_on_springs_and_a_foundation():
    soft = bouncing(
        rod={"vertices": 5, "material": {"young": 1e6}},
        springs=[{"at": "first", "along": "E2", "stiffness": 80.0, "rotational_stiffness": 9.0}],
        foundations=[{"along": [1, 2], "stiffness": 300.0, "start": 0.3}],
        duration=0.2,
    )
    runs = [
        cosserat.run(soft.vary("it", integrator={"method": method, "step": 1e-4}))
        for method in ("implicit", "rk4")
    ]
    assert max(map(balanced, runs)) < 1e-6
    np.testing.assert_allclose(runs[0].x, runs[1].x, atol=2e-6)
    moved = [run.x.sel(axis="E2").to_numpy() for run in runs]
    assert np.ptp(moved[0]) > 500 * np.abs(moved[0] - moved[1]).max()


def test_an_elastic_clamp_in_motion_keeps_the_energy_and_its_frequency():
    """A stiff rod on a rotational spring: omega^2 = c / (m L^2 / 3 + m h^2 / 12)."""
    c, spin = 40.0, 0.05
    run = cosserat.run(
        bouncing(
            supports=[{"at": "first", "fixed": "pinned"}],
            springs=[{"at": "first", "rotational_stiffness": c}],
            start={"speed": 0.0, "spin": spin},
        )
    )
    omega = np.sqrt(c / (10 / 3 + 10 * 0.01 / 12))
    turned = np.arctan2(*np.moveaxis(run.x.to_numpy()[:, -1], -1, 0)[::-1])
    np.testing.assert_allclose(turned, spin / omega * np.sin(omega * run.time), atol=5e-3 * spin / omega)
    assert balanced(run) < 1e-9


def test_springs_hold_a_rod_where_they_resist_it():
    across = [{"at": at, "along": "E2", "stiffness": 1e3} for at in ("first", "last")]
    loaded = beam(5, supports=[], springs=across, forces=[{"at": 2, "along": "E2", "force": 1.0}])
    with pytest.raises(UnsupportedRodError, match=r"free to move \(translation along E3\); add one"):
        cosserat.run(loaded)
    turning = [across[0], {"at": 1, "rotational_stiffness": 1e9}]
    along = [{"at": "last", "along": "E3", "stiffness": 1e3}]
    run = cosserat.run(loaded.vary("it", springs=[*turning, *along]))
    assert float(run.u.sel(axis="E2").mean()) == pytest.approx(1e-3, rel=1e-2)
    with pytest.raises(UnsupportedRodError, match=r"\(translation along E2, rotation\)"):
        cosserat.run(loaded.vary("it", springs=along))


def test_a_path_has_the_energy_of_its_springs():
    case = beam(
        5,
        supports=[ALONG],
        springs=[{"at": at, "along": "E2", "stiffness": 1e3} for at in ("first", "last")],
        forces=[{"at": 2, "along": "E2", "force": 1.0}],
    )
    keys = ("rod", "supports", "springs", "forces")
    path = cosserat.run(
        cosserat.case("column_path").vary("it", **{key: getattr(case.problem, key) for key in keys})
    )
    at_rest = cosserat.run(case)
    np.testing.assert_allclose(path.attached_force[-1], at_rest.attached_force, atol=1e-9)
    assert float(path.potential[-1]) == pytest.approx(
        float(at_rest.energy_parts.sum() + at_rest.attached_energy), rel=1e-6
    )


@pytest.mark.parametrize(
    ("key", "table", "sentence"),
    [
        ("springs", {}, "'springs.0.at' is missing"),
        ("springs", {"at": 1}, "has no stiffness; give 'stiffness' and 'along', or 'rotational_stiff"),
        ("springs", {"at": 1, "stiffness": "1 N/m"}, "has 'stiffness' without 'along'; give both"),
        ("springs", {"at": 1, "along": "E2", "rotational_stiffness": "1 N*m"}, "has 'along' without"),
        ("springs", {"at": 1, "stiffness": "1 N"}, 'is "1 N", in N, a force and not a force per length'),
        ("springs", {"at": 1, "along": "E2", "stiffness": "-1 N/m"}, "it must be above 0"),
        ("springs", {"at": 1, "rotational_stiffness": "-1 N*m/rad"}, "it must be above 0"),
        ("springs", {"at": 99, "along": "E2", "stiffness": "1 N/m"}, "'at' is 99, but the rod's vert"),
        ("foundations", {"along": "up", "stiffness": "1 Pa"}, "'foundations.0.along' is 'up'; it must"),
        ("foundations", {"along": "E2", "stiffness": "1 N"}, "a force and not a pressure"),
        ("foundations", {"rotational_stiffness": "1 Pa"}, 'is "1 Pa", in Pa'),
        (
            "foundations",
            {"along": "E2", "stiffness": "1 Pa", "start": "2 m"},
            "has one from 2 m to 1 m, but the rod goes from 0 to 1 m; let it begin before it ends",
        ),
        ("foundations", {"along": "E2", "stiffness": "1 Pa", "end": "3 m"}, "from 0 m to 3 m, but"),
    ],
)
def test_a_fault_is_one_sentence(key, table, sentence, tmp_path):
    with pytest.raises(InputError) as caught:
        read(tmp_path, key, table)
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def read(folder, key, table):
    """A case of a file with one table of a list."""
    values = ", ".join(f"{name} = {value!r}".replace("'", '"') for name, value in table.items())
    (folder / "it.toml").write_text(f'[it]\nlike = "elastica"\n{key} = [{{ {values} }}]\n')
    return cosserat.case("it", folder / "it.toml")


def test_units_of_stiffness_are_read_as_people_write_them(tmp_path):
    table = {"at": 1, "along": "E2", "stiffness": "2 kN/m", "rotational_stiffness": "3 Nm/rad"}
    (spring,) = read(tmp_path, "springs", table).problem.springs
    assert spring.stiffnesses == (2e3, 3.0)
    assert read(tmp_path, "springs", table | {"rotational_stiffness": "3 kNm"}).problem.springs[
        0
    ].stiffnesses == (2e3, 3e3)
