"""Rods beyond the published problems: varying sections, any centreline, couples, line loads, curved references."""

import re
from itertools import pairwise

import numpy as np
import pytest
from conftest import assembled, differentiated, make_rod, random_state, sine
from scipy.integrate import quad

import cosserat
from cosserat.errors import InputError
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.loads.couples import couples
from cosserat.rods.reference import strains, unwrapped_angles
from cosserat.solvers import banded

BAR, BEAM = cosserat.case("hanging_bar"), cosserat.case("clamped_free")
PULL = {"gravity": None, "forces": [{"at": "last", "along": "E3", "force": 10.0}]}


def tip(case):
    return cosserat.run(case).u[-1].to_numpy()


def test_a_tapered_bar_stretches_as_the_integral_of_its_compliance():
    """u = n l ln(h1 / h0) / (E w (h1 - h0)): of second order, since the mean of A is not that of 1 / A."""
    rod = BAR.problem.rod
    taper = [{"at": 0, "height": 1.0}, {"at": rod.length, "height": 0.4}]
    exact = 10.0 * rod.length * np.log(0.4) / (rod.young * rod.width * rod.height * (0.4 - 1))
    errors = [
        abs(tip(BAR.vary("taper", **PULL, rod={"stations": taper, "vertices": n}))[0] / exact - 1)
        for n in (11, 21, 41)
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (np.abs(orders - 2) < 0.1).all(), (errors, orders)
    assert errors[-1] < 2e-4


def test_a_stepped_bar_is_a_row_of_springs():
    rod = BAR.problem.rod
    steps = [
        {"at": 0, "young": 1.0},
        {"at": 2, "young": 1.0},
        {"at": 2, "young": 3.0, "width": 0.5},
        {"at": 5, "young": 3.0, "width": 0.5},
    ]
    exact = 10.0 / rod.area * (2 / rod.young + 3 / (3 * 0.5 * rod.young))
    found = tip(BAR.vary("steps", **PULL, rod={"stations": steps, "vertices": 26}))[0]
    assert found == pytest.approx(exact, rel=1e-4)


TWO = [
    {"at": 0.0, "density": 1.0},
    {"at": 2.0, "density": 1.0},
    {"at": 2.0, "young": 0.25, "poisson": 1.5, "density": 3.0},
    {"at": 5.0, "young": 0.25, "poisson": 1.5, "density": 3.0},
]
"""Two materials glued together at 2 m."""


@pytest.mark.parametrize("name", ["hanging_bar", "hanging_bar_consistent"])
def test_a_hanging_bar_of_two_materials_has_the_tip_and_the_mass_of_two_bars(name):
    """u = g rho1 a (a / 2 + b r) / E1 A + g rho2 b^2 / 2 E2 A, with b = 3 m below a = 2 m and r = rho2 / rho1."""
    bar = cosserat.case(name).vary("two", rod={"stations": TWO, "vertices": 51})
    rod, g = bar.problem.rod, 9.81
    mass = rod.line_density * (2 + 3 * 3)
    geometry = rod.geometry()
    assert rod.part_masses(geometry).sum() == pytest.approx(mass, rel=1e-12)
    still = np.zeros((51, 4))
    still[:, 0] = 1.0
    whole = still.ravel() @ banded.band_product(bar.problem.system(geometry).inertia, still.ravel())
    assert whole == pytest.approx(mass, rel=1e-12)
    data = cosserat.run(bar)
    assert data.support_force.sel(dof="x3")[0].item() == pytest.approx(-mass * g, rel=1e-6)
    stiff = rod.young * rod.area
    exact = g * rod.line_density * (2 * (2 / 2 + 3 * 3) / stiff + 3 * 3**2 / 2 / (0.25 * stiff))
    assert tip(bar)[0] == pytest.approx(exact, rel=1e-3)


def test_a_pulled_bar_of_two_materials_narrows_as_each_of_them():
    """Far from the joint and the ends each part narrows by its own nu n / E A."""
    pulled = cosserat.case("necking_consistent").vary(
        "two", rod={"stations": TWO, "vertices": 101, "section": {"height": 0.1, "width": 0.1}}
    )
    rod = pulled.problem.rod
    data = cosserat.run(pulled)
    strain = pulled.problem.forces[-1].force / (rod.young * rod.area)
    narrowed = data.lam.to_numpy() - 1
    assert narrowed[20] == pytest.approx(-rod.poisson * strain, rel=1e-3)
    assert narrowed[70] == pytest.approx(-1.5 * rod.poisson * strain / 0.25, rel=1e-3)


def test_shear_modulus_and_poissons_ratio_are_averaged_separately():
    """Table 3.1: the mean of G is not G of the mean of E and nu."""
    problem = cosserat.case("necking").vary("two", rod={"stations": TWO, "vertices": 6}).problem
    rod, geometry = problem.rod, problem.geometry
    stiff = rod.strain_energy.stiffness(
        rod, geometry
    )  # the part round vertex 2 is half of either material
    shear = (1 / (2 * 1.3) + 0.25 / (2 * 1.45)) / 2 * rod.young
    assert stiff.k4[2] == pytest.approx(
        rod.calibration.c4 * rod.shear_correction * shear * rod.area, rel=1e-12
    )


def test_impossible_materials_are_refused():
    with pytest.raises(cosserat.InputError, match="take Poisson's ratio from 0.3 to 0.6; keep it above"):
        cosserat.case("necking").vary("bad", rod={"stations": [{"at": 0}, {"at": 5, "poisson": 2}]})
    with pytest.raises(cosserat.InputError, match="above 0"):
        BAR.vary("bad", rod={"stations": [{"at": 0, "density": 0}]})


def test_averages_of_a_tapered_section_are_its_integrals():
    """Eqs. (3.4.8)-(3.4.9) for A and I, against quadrature; the mass is that of the tapered body."""
    stations = [{"at": 0.5, "height": 1.0, "width": 1.0}, {"at": 3.0, "height": 0.5, "width": 2.0}]
    problem = BEAM.vary("taper", rod={"stations": stations, "vertices": 7}).problem
    rod, geometry = problem.rod, problem.geometry
    body = rod.strain_energy.stiffness(rod, geometry)

    def height(xi):
        return rod.height * np.interp(xi, [0.5, 3.0], [1.0, 0.5])

    def width(xi):
        return rod.width * np.interp(xi, [0.5, 3.0], [1.0, 2.0])

    def mean(f, a, b):
        return quad(f, a, b, points=[0.5, 3.0], epsabs=1e-14)[0] / (b - a)

    xi = geometry.arc_length
    areas = [mean(lambda s: width(s) * height(s), a, b) for a, b in pairwise(xi)]
    np.testing.assert_allclose(body.k1, rod.calibration.c1 * rod.young * np.array(areas), rtol=1e-9)
    middles = (xi[1:] + xi[:-1]) / 2
    moments = [mean(lambda s: width(s) * height(s) ** 3 / 12, a, b) for a, b in pairwise(middles)]
    np.testing.assert_allclose(
        body.k3[1:-1], rod.calibration.c3 * rod.young * np.array(moments), rtol=1e-9
    )
    mass = quad(
        lambda s: rod.line_density * width(s) * height(s) / rod.area, 0, rod.length, points=[0.5, 3.0]
    )[0]
    assert rod.part_masses(geometry).sum() == pytest.approx(mass, rel=1e-9)
    np.testing.assert_allclose(geometry.director_length, height(xi) / 2, rtol=1e-12)


def test_stations_out_of_order_are_refused():
    with pytest.raises(cosserat.InputError, match="'stations' are not in the order"):
        BEAM.vary("mixed", rod={"stations": [{"at": 2}, {"at": 1}]})


@pytest.mark.parametrize("centreline", [0.2, 0.5, 0.9])
def test_inertias_are_those_of_the_section(centreline):
    """Eq. (3.3.28) by quadrature over the height, X = y / |D| counted from the centreline."""
    rod = BEAM.vary("offset", rod={"centreline": centreline}).problem.rod
    low, high = -centreline * rod.height, (1 - centreline) * rod.height
    length = rod.geometry().director_length[0]
    assert length == pytest.approx(high)
    for power, found in ((1, rod.Y02), (2, rod.Y22)):
        assert found == pytest.approx(
            quad(lambda y, p=power: (y / length) ** p, low, high)[0] / rod.height
        )
    assert rod.second_moment == pytest.approx(rod.width * quad(lambda y: y * y, low, high)[0])


def test_an_offset_rod_in_flight_keeps_its_momenta_and_turns_about_its_centre_of_mass():
    """Y02 != 0: the centreline wobbles, the centre of mass flies straight (eqs. (3.3.30)-(3.3.33))."""
    case = cosserat.case("vibration_c4_20").vary(
        "offset",
        supports=[],
        rod={"centreline": 0.1},
        start={"amplitude": 0.0, "speed": 3.0, "along": "E2", "spin": 25.0},
        duration=0.1,
        every=1e-3,
    )
    data = cosserat.run(case)
    rod = case.problem.rod
    assert rod.Y02 > 0.4
    for name in ("momentum", "angular_momentum"):
        values = data[name].to_numpy().reshape(data.sizes["time"], -1)
        assert np.abs(values - values[0]).max() < 1e-10 * np.abs(values[0]).max()
    energy = (data.kinetic_energy + data.strain_energy).to_numpy()
    assert np.abs(energy / energy[0] - 1).max() < 1e-9
    part = rod.part_masses(rod.geometry())
    centre = np.einsum("k,tka->ta", part, (data.x + rod.Y02 * data.d).to_numpy()) / part.sum()
    straight = centre[0] + data.time.to_numpy()[:, None] * data.momentum.to_numpy()[0] / part.sum()
    np.testing.assert_allclose(centre, straight, atol=1e-9)
    line = np.einsum("k,tka->ta", part, data.x.to_numpy()) / part.sum()
    assert (
        np.abs(line - straight - (line - straight)[0]).max() > 1e-2
    )  # the centreline's mean does wobble


def test_an_offset_centreline_stiffens_the_published_bending():
    """It couples no stretching with bending: I about the centreline counts whole, and the beam sags less."""
    offset = BEAM.vary("offset", rod={"centreline": 0.2})
    larger = 1 + 12 * 0.3**2
    assert tip(BEAM)[1] / tip(offset)[1] == pytest.approx(larger, rel=0.06)


def test_an_offset_rod_falls_without_turning():
    """Its weight acts at the centre of mass, so that a free rod under gravity keeps its angle."""
    case = cosserat.case("vibration_c4_20").vary(
        "fall",
        supports=[],
        rod={"centreline": 0.2},
        start={"amplitude": 0.0},
        gravity={"g": 9.81, "along": "-E2"},
        duration=0.1,
        every=1e-2,
    )
    data = cosserat.run(case)
    np.testing.assert_allclose(data.d, np.broadcast_to(data.d_ref, data.d.shape), atol=1e-10)
    np.testing.assert_allclose(data.x.sel(axis="E2")[-1], -9.81 / 2 * 0.01, rtol=1e-9)


def test_a_couple_does_the_work_of_a_couple():
    """Brought up slowly from zero it does M alpha / 2 in small rotations, which is the strain energy."""
    case = BEAM.vary("turned", gravity=None, couples=[{"at": "last", "moment": 10.0}])
    data = cosserat.run(case)
    d = data.d[-1].to_numpy()
    alpha = np.arctan2(-d[0], d[1])
    assert alpha > 0
    assert data.energy.sum().item() == pytest.approx(10.0 * alpha / 2, rel=1e-5)


def test_a_couple_turns_a_free_rod_as_a_rigid_body():
    """Angular momentum grows at the rate M: the director force is M / |d|, twice the printed one (E3.10)."""
    case = cosserat.case("vibration_c4_20").vary(
        "spun",
        supports=[],
        start={"amplitude": 0.0},
        couples=[{"at": 10, "moment": 2.0}],
        duration=0.05,
        every=5e-3,
    )
    data = cosserat.run(case)
    np.testing.assert_allclose(data.angular_momentum, 2.0 * data.time, rtol=1e-9, atol=1e-12)
    total = (data.kinetic_energy + data.strain_energy + data.load_potential).to_numpy()
    assert np.abs(total).max() < 1e-9 * float(data.kinetic_energy.max())


@pytest.mark.parametrize("energy", ["published", "consistent"])
def test_a_motor_turns_a_hinged_rod_through_many_turns(energy):
    """Its work is M times the angle, counted through whole turns, also where a run goes on from its parts."""
    consistent = {"energy": "consistent", "calibration": "none"} if energy == "consistent" else {}
    case = cosserat.case("vibration_c4_20").vary(
        "motor",
        rod=consistent,
        supports=[{"at": "first", "fixed": ["x3", "x2"]}],
        start={"amplitude": 0.0},
        couples=[{"at": "first", "moment": 80.0}],
        duration=1.2,
        every=0.02,
        integrator={"step": "0.5 ms"},
    )
    data = cosserat.run(case)
    assert data.first_angle[-1] - data.first_angle[0] > 5 * np.pi
    total = (data.kinetic_energy + data.strain_energy + data.load_potential).to_numpy()
    assert np.abs(total).max() < 1e-9 * float(data.kinetic_energy.max())
    work = 80.0 * (data.first_angle - data.first_angle[0])
    np.testing.assert_allclose(data.load_potential, -work, atol=1e-9 * float(work.max()))


@pytest.mark.parametrize("displacements", [False, True])
def test_couples_have_exact_gradients_and_hessians(displacements):
    """By differences; and the gradient by the closed form: a force M / |d| across the director, on nothing else."""
    rod = make_rod(vertices=5)
    geometry, q = rod.geometry(), random_state(rod, 4, turn=0.4)
    moments = np.array([0, 0, 3e6, 0, -1e6])
    origin = geometry.q if displacements else None
    load = couples(moments, unwrapped_angles(geometry.D), origin=origin)
    d = q.reshape(-1, 4)[:, 2:]
    force = moments[:, None] * np.column_stack([-d[:, 1], d[:, 0]]) / (d**2).sum(axis=1)[:, None]
    q = q - geometry.q if displacements else q
    _, gradient, hessian = assembled(load, q)
    np.testing.assert_allclose(-gradient.reshape(-1, 4)[:, 2:], force, rtol=1e-12)
    assert (gradient.reshape(-1, 4)[:, :2] == 0).all()
    energy, only = differentiated(load, q)
    assert energy == load.energy(q)
    np.testing.assert_array_equal(only, gradient)
    for i, unit in enumerate(np.eye(q.size)):
        h = 1e-6
        up, down = assembled(load, q + h * unit), assembled(load, q - h * unit)
        assert gradient[i] == pytest.approx(
            (up[0] - down[0]) / (2 * h), abs=1e-6 * np.abs(gradient).max()
        )
        np.testing.assert_allclose(
            hessian[i], (up[1] - down[1]) / (2 * h), atol=1e-6 * np.abs(hessian).max()
        )


def test_a_line_load_over_the_rod_is_its_weight():
    weight = BEAM.problem.rod.line_density * 9.81
    loaded = BEAM.vary("loaded", gravity=None, line_loads=[{"along": "-E2", "density": weight}])
    np.testing.assert_allclose(cosserat.run(loaded).x, cosserat.run(BEAM).x, atol=1e-12)


def test_a_line_load_over_a_stretch_has_its_resultant_there():
    case = BEAM.vary(
        "loaded", gravity=None, line_loads=[{"along": "E2", "density": 7.0, "start": 1.3, "end": 3.1}]
    )
    force = cosserat.run(case).applied_force.sel(dof="x2").to_numpy()
    arc = case.problem.geometry.arc_length
    assert force.sum() == pytest.approx(7.0 * 1.8)
    assert (force[(arc < 1.1) | (arc > 3.3)] == 0).all()


def test_point_loads_may_act_anywhere():
    """By Maxwell and Betti: a force at A moves B as the same force at B moves A, in small displacements."""

    def moved(at, seen):
        case = BEAM.vary("poked", gravity=None, forces=[{"at": at, "along": "E2", "force": 1.0}])
        return cosserat.run(case).u.sel(axis="E2")[seen].item()

    assert moved(7, 15) == pytest.approx(moved(15, 7), rel=1e-6)


ARC = {"rest": {"kind": "arc", "curvature": 0.3}, "vertices": 41}


def test_a_curved_reference_is_at_rest_and_unsheared():
    problem = BEAM.vary("arc", rod=ARC).problem
    geometry = problem.geometry
    measured = strains(geometry, geometry.X, geometry.D)
    np.testing.assert_allclose(measured.theta, 0, atol=1e-14)  # D along B, section 3.3
    np.testing.assert_allclose(measured.mu_edge, 1, rtol=1e-14)
    assert measured.kappa[1:-1] == pytest.approx(0.3, rel=1e-3)
    energy, gradient, hessian = assembled(
        problem.rod.strain_energy.potential(problem.rod, geometry), geometry.q
    )
    assert abs(energy) < 1e-9
    assert np.abs(gradient).max() < 1e-12 * np.abs(hessian).max()


def test_E3_24_printed_bending_energy_does_not_let_a_curved_rod_rest():
    """Eq. (3.4.11) charges the whole curvature: a free end unbends until the rod is straight."""
    case = BEAM.vary(
        "arc",
        gravity=None,
        rod={
            "vertices": 41,
            "intrinsic_curvature": "printed",
            "rest": {"kind": "arc", "curvature": 0.05},
        },
    )
    problem = case.problem
    geometry = problem.geometry
    _, gradient, _ = assembled(problem.rod.strain_energy.potential(problem.rod, geometry), geometry.q)
    assert np.abs(gradient).max() > 1e3
    straightened = cosserat.run(case)
    assert np.abs(straightened.kappa[2:-1]).max() < 0.1 * 0.05
    rested = cosserat.run(case.vary("arc", rod={"intrinsic_curvature": "subtracted"}))
    assert np.abs(rested.u).max() < 1e-9


def test_a_curved_bar_has_castiglianos_displacement():
    """A thin quarter ring pulled across its tip moves there by pi P R^3 / (4 E I).

    The published energy bends at interior vertices only, so the half edge at the clamp stays stiff: first order.
    """
    radius, force = 5 * 2 / np.pi, 0.3
    ratios = []
    for n in (51, 101, 201):
        calibration = {
            "c3": 1.0,
            "c4": 200.0,
            "c5": 100.0,
        }  # so stiff in shear that the clamp does not give
        arc = {"kind": "arc", "curvature": 1 / radius}
        ring = {"rest": arc, "vertices": n, "section": {"height": 0.1, "width": 0.1}}
        ring["material"] = {"poisson": 0}
        case = BEAM.vary(
            "ring",
            gravity=None,
            rod={**ring, "calibration": calibration},
            forces=[{"at": "last", "along": "E3", "force": force}],
        )
        rod = case.problem.rod
        np.testing.assert_allclose(rod.geometry().X[-1], [radius, radius], rtol=1e-3)
        ratios.append(tip(case)[0] / (np.pi * force * radius**3 / (4 * rod.young * rod.second_moment)))
    steps = np.diff(ratios)
    assert steps[0] / steps[1] == pytest.approx(2, abs=0.1)
    assert ratios[-1] + steps[-1] == pytest.approx(1, abs=1e-3)


def test_mass_couples_position_and_director_as_in_3_3_43():
    problem = cosserat.case("vibration_c4_20").vary("offset", rod={"centreline": 0.3}).problem
    geometry = problem.geometry
    mass = problem.system(geometry).inertia
    rng = np.random.default_rng(1)
    v = rng.standard_normal((20, 4))
    part = problem.rod.part_masses(geometry)
    y02, y22 = problem.rod.Y02, problem.rod.Y22
    matrix = np.kron(np.array([[1, y02], [y02, y22]]), np.eye(2))  # eq. (3.3.43)
    expected = np.array([m * matrix @ row for m, row in zip(part, v, strict=True)])
    found = banded.band_product(mass, v.ravel()).reshape(20, 4)
    np.testing.assert_allclose(found, expected, rtol=1e-13)
    spin = PLANAR.rigid_motions(geometry.q)[2]
    assert spin @ banded.band_product(mass, spin) > 0


def test_a_moved_support_stretches_a_bar_by_hooke():
    case = BAR.vary(
        "stretched",
        gravity=None,
        supports=[{"at": "first", "fixed": ["x3", "x2", "d3"]}, {"at": "last", "fixed": ["x3"]}],
        prescribed_displacements=[{"at": "last", "dof": "x3", "by": "1 mm"}],
    )
    data = cosserat.run(case)
    rod = case.problem.rod
    force = rod.young * rod.area * 1e-3 / rod.length
    assert data.support_force.sel(dof="x3")[-1].item() == pytest.approx(force, rel=1e-3)
    np.testing.assert_allclose(data.mu_edge, 1 + 1e-3 / rod.length, rtol=1e-9)


@pytest.mark.parametrize("method", ["implicit", "rk45"])
def test_a_shaken_support_excites_the_mode_of_the_rod(method):
    """Far below the lowest frequency f1 the tip follows the base but for its inertia and the start."""
    f1 = cosserat.case("vibration_c4_20").problem.modes(1).angular_frequency[0] / (2 * np.pi)
    shaken = cosserat.case("vibration_c4_20").vary(
        "shaken",
        start={"shape": "reference", "amplitude": 0.0},
        prescribed_displacements=[
            {
                "at": "first",
                "dof": "x2",
                "by": "0.1 mm",
                "time_function": sine(f1 / 20),
            }
        ],
        duration=(5 if method == "implicit" else 0.5) / f1,
        every=0.05 / f1,
        integrator={"method": method, "step": 0.01 / f1},
    )
    data = cosserat.run(shaken)
    base = data.x.sel(axis="E2").isel(vertex=0).to_numpy()
    np.testing.assert_allclose(base, 1e-4 * np.sin(2 * np.pi * f1 / 20 * data.time), atol=1e-9)
    lag = data.x.sel(axis="E2").isel(vertex=-1).to_numpy() - base
    assert np.abs(lag).max() < 0.1 * 1e-4  # 1.57 (f / f1)^2 and the start's transient, 1.57 (f / f1)


def test_prescribed_motion_needs_a_support_and_statics_have_no_time():
    with pytest.raises(cosserat.InputError, match="moves x2 of vertex last, which no support fixes"):
        BEAM.vary("bad", prescribed_displacements=[{"at": "last", "dof": "x2", "by": 0.1}])
    with pytest.raises(cosserat.InputError, match="only kind = 'rod motion' has a time"):
        BEAM.vary(
            "bad",
            prescribed_displacements=[
                {
                    "at": "first",
                    "dof": "x2",
                    "by": 0.1,
                    "time_function": sine(2),
                }
            ],
        )


@pytest.mark.parametrize(
    ("energy", "angle"), [("published", 0.6), ("consistent", 0.6), ("consistent", np.pi)]
)
def test_a_rotated_clamp_rotates_the_rod_without_stretch(energy, angle):
    consistent = {"energy": "consistent", "calibration": "none"} if energy == "consistent" else {}
    turned = BEAM.vary(
        "turned", rod=consistent, gravity=None, prescribed_rotations=[{"at": "first", "by": angle}]
    )
    data = cosserat.run(turned)
    length = turned.problem.rod.length
    np.testing.assert_allclose(
        data.x[-1], [length * np.cos(angle), length * np.sin(angle)], atol=1e-6 * length
    )
    np.testing.assert_allclose(data.lam, 1, atol=1e-7)


def test_an_oscillating_clamp_keeps_its_section_and_drives_the_rod():
    rocked = cosserat.case("vibration_consistent").vary(
        "rocked",
        start={"amplitude": 0.0},
        prescribed_rotations=[{"at": "first", "by": "0.5 rad", "time_function": sine("2 Hz")}],
        duration="0.5 s",
        every="5 ms",
        integrator={"step": "1 ms"},
    )
    data = cosserat.run(rocked)
    first = data.d.isel(vertex=0).to_numpy()
    reach = np.linalg.norm(first, axis=1)
    np.testing.assert_allclose(reach, reach[0], rtol=1e-12)
    turned = 0.5 * np.sin(4 * np.pi * data.time.to_numpy())
    np.testing.assert_allclose(np.arctan2(-first[:, 0], first[:, 1]), turned, atol=1e-9)
    tip = data.x.isel(vertex=-1).sel(axis="E2").to_numpy()
    assert (
        np.corrcoef(tip, np.sin(turned))[0, 1] > 0.99
    )  # far below its first frequency the beam follows


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"prescribed_rotations": [{"at": "last", "by": 1.0}]},
            "'prescribed_rotations' rotates the section of vertex last, which no support fixes; add d3 to 'fixed'",
        ),
        (
            {
                "prescribed_rotations": [{"at": 0, "by": 1.0}],
                "prescribed_displacements": [{"at": "first", "dof": "d3", "by": 0.1}],
            },
            "move d3 of vertex 0 twice",
        ),
        (
            {"prescribed_rotations": [{"at": 0, "by": 1.0, "time_function": sine(2)}]},
            "has a 'time_function' in 'prescribed_rotations', but only kind",
        ),
        ({"prescribed_rotations": [{"at": 99, "by": 1.0}]}, "'at' is 99"),
        (
            {"rod": {"stations": [{"at": "7 m"}]}},
            "'stations' has one at 7 m, but the rod goes from 0 to 5 m",
        ),
    ],
)
def test_impossible_prescribed_rotations_are_refused(changes, sentence):
    with pytest.raises(InputError, match=re.escape(sentence)):
        BEAM.vary("turned", **changes)
