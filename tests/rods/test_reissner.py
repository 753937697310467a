"""The consistent rod: gradients, invariance, exact answers, orders of convergence, large deflections, locking."""

import numpy as np
import pytest
from conftest import assembled, differentiated, jacobian, sine
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq
from scipy.special import ellipk

import cosserat
from cosserat.cli import main
from cosserat.errors import InputError
from cosserat.exact import beams, elastica
from cosserat.problems.calibration import beam_of
from cosserat.problems.discretization import MEASURES
from cosserat.problems.static import RodStatics
from cosserat.rods.elasticity import of_one_material
from cosserat.rods.energies import reissner
from cosserat.rods.energies.compliance import stiffnesses
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.reference import Geometry
from cosserat.thesis.table.readouts import period

SECTIONS = ("free", "plane strain", "incompressible")
MATERIAL = {"young": 1e9, "poisson": 0.0, "line_density": 0.1}
CLAMP = [{"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}]


@pytest.mark.parametrize("height", [1e-4, 1e-5, 1e-7, 1e-12])
def test_frequencies_of_slender_beams_are_those_of_bernoulli_and_euler(height):
    """Right values: roots of cos b cosh b = -1 as printed in tables."""
    beam = beams.Beam(
        length=2.0,
        area=0.1 * height,
        second_moment=0.1 * height**3 / 12,
        young=1e9,
        poisson=0.3,
        line_density=0.7,
        shear_correction=5 / 6,
    )
    found = elastica.timoshenko_frequencies(beam, 3)
    right = np.square([1.875104068711961, 4.694091132974175, 7.854757438237613])
    right *= np.sqrt(beam.bending_stiffness / 0.7) / 4
    np.testing.assert_allclose(found, right, rtol=2e-7)


def small_rod(section="free", barrier=False, poisson=0.3, offset=0.0, displacements=False):
    geometry = Geometry.arc(np.linspace(0.0, 1.0, 6), np.full(6, 0.05), 0.7)

    stiffness = stiffnesses(
        (),
        geometry.arc_length,
        of_one_material(lambda _: 0.01, lambda _: 8e-6, 1e6, poisson, lambda _, nu: 5 / 6, section),
    )
    return geometry, reissner.potential(
        geometry,
        stiffness,
        barrier=barrier,
        product=section == "incompressible",
        offsets=offset,
        displacements=displacements,
    )


def strained(geometry, seed, size=0.02):
    rng = np.random.default_rng(seed)
    q = np.hstack([geometry.X, geometry.D])
    q[:, :2] += size * rng.uniform(-1, 1, geometry.X.shape)
    q[:, 2:] += size / 2 * rng.uniform(-1, 1, geometry.D.shape)
    return q.ravel()


def slender(elements, radius=0.005, **rod):
    """A clamped rod of length 1 whose section bends as a circle of that radius."""
    side = np.sqrt(3) * radius
    problem = cosserat.case("elastica").problem
    section = problem.rod.section.replace(height=side, width=side)
    bare = problem.replace(
        rod=problem.rod.replace(vertices=elements + 1, section=section, **rod), forces=()
    )
    return bare, bare.rod.young * bare.rod.second_moment


# ---------------------------------------------------------------- gradients and invariance


@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize(("barrier", "offset"), [(False, 0.0), (True, 0.0), (False, 0.7)])
@given(st.integers(0, 1000))
def test_forces_are_the_gradient_and_the_hessian_is_its_derivative(section, barrier, offset, seed):
    geometry, rod = small_rod(section, barrier, offset=offset)
    q = strained(geometry, seed)
    _, gradient, hessian = assembled(rod, q)
    numeric = jacobian(rod.energy, q, 1e-7)
    columns = jacobian(lambda p: differentiated(rod, p)[1], q, 1e-7)
    np.testing.assert_allclose(gradient, numeric, atol=1e-6 * np.abs(gradient).max())
    np.testing.assert_allclose(hessian, columns, atol=1e-6 * np.abs(hessian).max())
    assert rod.energy(q) == rod.energy_terms(q).sum()


@pytest.mark.parametrize("offset", [0.0, -0.4])
@given(st.integers(0, 1000), st.floats(-3, 3))
def test_rigid_motions_have_no_energy_and_forces_balance(offset, seed, turn):
    geometry, rod = small_rod(offset=offset)
    q = strained(geometry, seed)
    c, s = np.cos(turn), np.sin(turn)
    R = np.array([[c, -s], [s, c]])
    pairs = q.reshape(-1, 2, 2) @ R.T
    pairs[:, 0] += [3.0, -1.0]
    moved = pairs.reshape(-1)
    energy = rod.energy(q)
    assert rod.energy(moved) == pytest.approx(energy, rel=1e-10)
    _, gradient = differentiated(rod, q)
    work = PLANAR.rigid_motions(q) @ gradient
    assert np.abs(work).max() < 1e-11 * np.abs(gradient).max()


@pytest.mark.parametrize(("barrier", "offset"), [(False, 0.0), (True, 0.0), (False, 0.7)])
def test_the_reference_is_at_rest_also_where_it_is_curved(barrier, offset):
    geometry, rod = small_rod(barrier=barrier, offset=offset)
    energy, gradient = differentiated(rod, geometry.q)
    assert abs(energy) < 1e-25
    assert np.abs(gradient).max() < 1e-9


def test_displacements_from_the_reference_give_the_same_energy_and_forces():
    geometry, rod = small_rod(offset=0.3)
    q = strained(geometry, 1)
    _, displaced = small_rod(offset=0.3, displacements=True)
    for one, other in zip(assembled(rod, q), assembled(displaced, q - geometry.q), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-6)


# ---------------------------------------------------------------- exact answers


def test_every_measure_converges_with_second_order(solved):
    every = solved["convergence"].errors.transpose("measure", "vertices").to_numpy()
    orders = -np.diff(np.log(every), axis=1) / np.log(2)
    for name, order in zip(MEASURES, orders, strict=True):
        assert order[-3:] == pytest.approx(2.0, abs=0.1), name
    for name, errors in zip(MEASURES, every[:, 1:4], strict=True):
        if name.startswith("elastica displacement"):
            assert (errors < [1e-3, 2.5e-4, 6e-5]).all(), name


@pytest.mark.parametrize("centreline", [0.2, 0.7])
def test_a_body_does_not_depend_on_the_choice_of_its_centreline(centreline):
    """Sag and frequencies of a beam do not depend on the height of its centreline."""
    middle = cosserat.case("clamped_free_consistent").problem
    off = middle.replace(rod=middle.rod.replace(centreline=centreline))
    sags = [problem.solve("beam")["u"][-1, 1] for problem in (middle, off)]
    assert sags[1] == pytest.approx(sags[0], rel=5e-4)
    one, other = (problem.replace(gravity=None).modes(5).angular_frequency for problem in (middle, off))
    np.testing.assert_allclose(other, one, rtol=1e-9)


def test_directors_between_two_clamps_are_exact_at_the_vertices(solved):
    problem = cosserat.case("clamped_clamped_consistent").vary("light", gravity={"g": 1e-3}).problem
    beam, fields = beam_of(problem), problem.solve("light")
    exact = problem.rod.height / 2 * beams.clamped_clamped_director(beam, 1e-3, fields["xi"])
    np.testing.assert_allclose(fields["delta"][:, 0], exact, atol=1e-7 * np.abs(exact).max())


def test_the_beams_of_section_3_5_without_calibration(solved):
    for name, formula, allowed in (
        ("clamped_free_consistent", beams.clamped_free_displacement, 5e-4),
        ("clamped_clamped_consistent", beams.clamped_clamped_displacement, 1.1e-2),
    ):
        data = solved[name]
        problem = cosserat.case(name).problem
        exact = formula(beam_of(problem), problem.gravity.g, data.xi.to_numpy())
        computed = data.u.sel(axis="E2").to_numpy()
        assert data.sizes["vertex"] == 20
        assert np.abs(computed - exact).max() < allowed * np.abs(exact).max()
    fine = cosserat.run(cosserat.case("clamped_clamped_consistent").vary("fine", rod={"vertices": 161}))
    exact = beams.clamped_clamped_displacement(beam_of(problem), problem.gravity.g, fine.xi.to_numpy())
    assert float(fine.u.sel(axis="E2")[80]) == pytest.approx(exact[80], rel=1.5e-4)


@pytest.mark.parametrize(
    ("case", "theory"),
    [("necking_consistent", "free section"), ("necking_plane_strain", "plane strain")],
)
@pytest.mark.parametrize("poisson", [0.3, 0.4999])
def test_necking_follows_theory_up_to_near_incompressibility(case, theory, poisson):
    """(3.5.9) settled: 2 (1 + nu) A / I with the section free in E1, 2 A / (I (1 - nu)) in plane strain."""
    errors = []
    for vertices in (81, 161, 321):
        bar = cosserat.case(case).vary(
            "x", rod={"vertices": vertices, "material": {"poisson": poisson}, "length": "1 m"}
        )
        data = cosserat.run(bar)
        beam = beam_of(bar.problem)
        beta = beams.necking_decay(beam, theory)
        strain = beams.necking_strain(beam, 1000.0, beta, data.xi.to_numpy())
        if theory == "plane strain":
            strain = strain * (1 + poisson)
        errors.append(np.abs(data.lam - 1 - strain).max() / np.abs(strain).max())
    assert errors[-1] < 2e-3
    assert (np.diff(np.log2(errors)) < -1.8).all()


@pytest.mark.parametrize("thickness", [1e-1, 1e-2, 1e-3, 1e-4])
def test_no_shear_locking(thickness):
    problem, bending = slender(20, radius=thickness, material=MATERIAL | {"poisson": 0.3})
    pulled = problem.replace(forces=({"at": "last", "along": "E2", "force": 0.1 * bending},))
    tip = pulled.solve("x")["u"][-1, 1]
    shear = bending / (5 / 6 * problem.rod.young / 2.6 * problem.rod.area)
    assert tip == pytest.approx(elastica.transverse_tip(0.1)[0] + 0.1 * shear, rel=1e-3)


@pytest.mark.parametrize("fraction", [0.1, 0.2, 0.3])
def test_an_incompressible_section_keeps_its_area(fraction):
    """Stretch along times stretch across is one; the force is that of the energy with lambda = 1 / a."""
    problem, _ = slender(
        20, radius=0.05, lateral_constraint="incompressible", material=MATERIAL | {"poisson": 0.4999}
    )
    stiff = 2 * problem.rod.young / 3 * problem.rod.area
    pulled = problem.replace(
        supports=({"at": "first", "fixed": ["x3", "x2", "d3"]},),
        forces=({"at": "last", "along": "E3", "force": fraction * stiff},),
    )
    data = pulled.solve("x")
    wide = (data["lam"][1:] + data["lam"][:-1]) / 2
    np.testing.assert_allclose(data["mu_edge"] * wide, 1, atol=1e-5)
    a = data["mu_edge"][0]
    assert abs(a - 1) > 0.04
    assert fraction == pytest.approx((a - 1) - (1 / a - 1) / a**2, rel=1e-4)


@pytest.mark.parametrize(("elements", "allowed"), [(20, 1e-3), (40, 2.5e-4), (80, 6e-5)])
@pytest.mark.parametrize("force", [1.0, 5.0, 10.0])
def test_the_elastica_under_a_dead_tip_load(elements, allowed, force):
    """Against Reissner's rod of the same stiffnesses: the inextensible elastica is 1e-4 away from that by itself."""
    problem, bending = slender(elements)
    unit = bending
    shear = 5 / 6 * problem.rod.young / 2 * problem.rod.area / unit
    sideways, shortening = elastica.shearable_tip(
        force, problem.rod.young * problem.rod.area / unit, shear
    )
    u = problem.replace(forces=({"at": "last", "along": "E2", "force": force * unit},)).solve("x")["u"][
        -1
    ]
    assert u[1] == pytest.approx(sideways, abs=allowed)
    assert -u[0] == pytest.approx(shortening, abs=allowed)
    rigid = elastica.transverse_tip(force)
    assert (sideways, shortening) == pytest.approx(rigid, abs=1.1e-4)


def test_the_elastica_under_much_larger_loads():
    problem, bending = slender(40)
    done = problem.replace(forces=({"at": "last", "along": "E2", "force": 100 * bending},)).solve("x")
    assert done["u"][-1, 1] == pytest.approx(elastica.transverse_tip(100.0)[0], abs=2e-3)
    assert done.statistics["iterations"] < 100


@pytest.mark.parametrize("turns", [1, 2])
@pytest.mark.parametrize("elements", [10, 40])
def test_a_couple_rolls_the_rod_up(turns, elements):
    problem, bending = slender(elements)
    done = problem.replace(couples=({"at": "last", "moment": 2 * np.pi * turns * bending},)).solve("x")
    assert np.hypot(*done["x"][-1]) < 1e-10
    energy = done["energy_parts"]
    assert energy[2] == pytest.approx(bending * (2 * np.pi * turns) ** 2 / 2, rel=1e-9)
    assert energy[6] == pytest.approx(-2 * energy[2], rel=1e-9)  # the work of the couple


# ---------------------------------------------------------------- buckling and snapping


def column(factor, elements=80, radius=1e-3, aside=0.0):
    """A clamped-free column under a share of pi^2 EI / 4, and a small force across."""
    problem, bending = slender(elements, radius)
    load = factor * np.pi**2 / 4 * bending
    return problem.replace(
        forces=(
            {"at": "last", "along": "-E3", "force": load},
            {"at": "last", "along": "E2", "force": aside * bending},
        )
    )


@pytest.mark.parametrize("factor", [1.05, 1.5, 3.0])
@pytest.mark.parametrize("aside", [0.0, 1e-4])
def test_a_column_beyond_eulers_load_is_the_exact_elastica(factor, aside):
    x = column(factor, aside=aside).solve("x")["x"][-1]
    sideways, height = elastica.column_tip(factor * np.pi**2 / 4)
    assert abs(x[1]) == pytest.approx(sideways, abs=2e-3)
    assert x[0] == pytest.approx(height, abs=2e-3)


def test_eulers_load_is_where_the_straight_column_loses_its_stability():
    low, high = 0.9, 1.1
    for _ in range(20):
        middle = (low + high) / 2
        pushed = column(middle).solve("x").statistics["branch_switches"]
        low, high = (low, middle) if pushed else (middle, high)
    assert low == pytest.approx(1.0, abs=1e-4)


def test_the_path_leaves_the_straight_column_at_eulers_load(solved):
    path = solved["column_path"]
    factor = path.load_factor.to_numpy() * 2.3132 / (np.pi**2 / 4 * 0.46875)
    tip = np.abs(path.x.sel(axis="E2").isel(vertex=-1).to_numpy())
    bent = tip > 1e-3
    assert (
        0.99 < factor[~bent].max() < 1.0 + 1e-4
    )  # closed in on; the column shortens a little before it buckles
    assert factor[bent].min() > 0.9999
    assert path.stable.to_numpy().all()
    for load, sideways in zip(factor[bent], tip[bent], strict=True):
        if load > 1.02:
            assert sideways == pytest.approx(elastica.column_tip(load * np.pi**2 / 4)[0], abs=4e-3)
    assert path.load_factor[-1] == 1


def test_a_path_without_branch_switching_passes_the_bifurcation_and_is_unstable():
    straight = cosserat.run(cosserat.case("column_path").vary("stay", arc={"branch": "stay"}))
    assert np.abs(straight.x.sel(axis="E2")).max() < 1e-9
    factor = straight.load_factor.to_numpy() * 2.3132 / (np.pi**2 / 4 * 0.46875)
    assert (straight.stable.to_numpy() == (factor < 1)).all()


def test_an_arch_snaps_through(solved):
    path = solved["arch_path"]
    factor, middle = path.load_factor.to_numpy(), path.x.sel(axis="E2").isel(vertex=20).to_numpy()
    assert factor.min() < -0.05 < 0.15 < factor[: factor.argmin()].max() < 0.3
    assert (np.diff(middle[factor.argmax() if factor.argmax() < factor.argmin() else 0 :][:3]) > 0).all()
    assert not path.stable.to_numpy().all()
    assert factor[-1] == 1
    dead = cosserat.case("arch_path").vary("x").problem
    statics = RodStatics.read(
        {k: v for k, v in dead.model_dump().items() if k not in ("kind", "arc", "start_from")},
        "x",
        units_required=False,
    )
    snapped = statics.solve("x")["x"][20, 1]
    assert snapped == pytest.approx(middle[-1], abs=1e-6)


def loaded_arch(at, **arc):
    forces = [{"at": at, "along": "E2", "force": "46.875 N"}]
    return cosserat.case("arch_path").vary("arch", forces=forces, arc=arc)


@pytest.mark.parametrize("at", [15, 19])
def test_a_path_does_not_depend_on_its_arcs_and_never_jumps(at):
    """Loaded off its centre an arch runs through many limit points, some close to another path."""
    limits = []
    for longest in (0.5, 0.1, 0.04):
        path = cosserat.run(loaded_arch(at, longest=longest, first=min(longest, 0.05), count=2000))
        factor = path.load_factor.to_numpy()
        turning = np.arctan2(*path.d.to_numpy().T).T
        assert np.abs(np.angle(np.exp(1j * np.diff(turning, axis=0)))).max() < 0.2
        assert factor[-1] == 1
        inner = factor[1:-1]
        limits.append(inner[(inner - factor[:-2]) * (factor[2:] - inner) < 0])
    assert len(limits[-1]) >= 6
    for coarse in limits[:-1]:
        np.testing.assert_allclose(coarse, limits[-1], atol=5e-3)


def test_a_closed_branch_is_reported():
    """A symmetric arch: the tilting path between its two branching points is closed."""
    axis = cosserat.case("arch_path").problem.geometry.D[20]
    push = 46.875 * axis / np.hypot(*axis)
    forces = [
        {"at": 20, "along": along, "force": force}
        for along, force in zip(("E3", "E2"), push.tolist(), strict=True)
    ]
    tilting = cosserat.case("arch_path").vary("tilting", forces=forces)
    with pytest.raises(cosserat.NotConvergedError, match=r"returns to 0\.23\d* of the load, where it"):
        cosserat.run(tilting)
    upright = cosserat.run(tilting.vary("upright", arc={"branch": "stay"}))
    assert upright.load_factor[-1] == 1
    nudged = [
        {**force, "force": force["force"] * (1 + 1e-7 * (force["along"] == "E2"))} for force in forces
    ]
    with pytest.raises(cosserat.NotConvergedError, match=r"returns to 0\.23\d* of the load"):
        cosserat.run(tilting.vary("nudged", forces=nudged, arc={"branch": "stay"}))


@pytest.mark.parametrize("slenderness", [1e-3, 2e-4, 1e-4])
def test_very_thin_columns_leave_the_straight_path(slenderness):
    euler = np.pi**2 / 4 * 1e9 * slenderness**4 / 12
    thin = cosserat.case("column_path").vary(
        "thin",
        rod={"section": {"height": slenderness, "width": slenderness}},
        forces=[{"at": "last", "along": "-E3", "force": 2 * euler}],
    )
    path = cosserat.run(thin)
    tip = path.x.isel(vertex=-1).to_numpy()
    assert path.load_factor[-1] == 1
    assert path.load_factor.to_numpy()[np.abs(tip[:, 1]) < 1e-3].max() == pytest.approx(0.5, abs=1e-3)
    assert abs(tip[-1, 1]) == pytest.approx(elastica.column_tip(np.pi**2 / 2)[0], abs=4e-3)


def test_without_an_equilibrium_the_error_has_the_load_reached_and_the_last_state():
    """A bar pushed by twice EA: without a barrier its edges would have to vanish half-way."""
    problem, _ = slender(20, radius=0.05)
    stiff = problem.rod.young * problem.rod.area
    pushed = problem.replace(
        supports=[{"at": k, "fixed": ["x2", "d3"] if k else ["x3", "x2", "d3"]} for k in range(21)],
        forces=({"at": "last", "along": "-E3", "force": 2 * stiff},),
    )
    with pytest.raises(
        cosserat.NotConvergedError, match=r"x: no equilibrium found beyond 0\.(49\d*|5) of the load"
    ) as caught:
        pushed.solve("x")
    last = caught.value.state
    assert last.factor == pytest.approx(0.5, abs=1e-2)
    assert last.q.reshape(-1, 4)[-1, 0] == pytest.approx(-2 * last.factor)
    reached = caught.value.reached
    assert reached.statistics["load_factor_reached"] == last.factor
    assert reached["applied_force"][-1, 0] == pytest.approx(-2 * stiff * last.factor)
    assert np.abs(reached["applied_force"] + reached["support_force"]).sum(0)[1] < 1e-3
    kept = pushed.replace(rod=pushed.rod.replace(barrier=True)).solve("x")
    assert kept["mu_edge"].min() > 0.1


def test_an_unfinished_path_keeps_its_points_on_request(tmp_path, capsys):
    (tmp_path / "my.toml").write_text(
        '[far]\nlike = "arch_path"\narc.limit = 1.1\nforces = [{ at = 15, along = "E2", force = "46.875 N" }]\n'
    )
    command = ["run", "far", "--file", str(tmp_path / "my.toml"), "-o", str(tmp_path / "far.nc")]
    assert main(command) == 1
    assert "beyond the limit of 1.1; raise 'arc.limit'" in capsys.readouterr().err
    assert not (tmp_path / "far.nc").exists()
    assert main([*command, "--keep-last"]) == 1
    assert "the part reached, -1.0" in capsys.readouterr().err
    path = cosserat.load(tmp_path / "far.nc")
    assert path.sizes["point"] > 50
    assert path.load_factor.min() > -1.1


def test_prescribed_motion_of_a_support():
    problem, _ = slender(40)
    both = [*CLAMP, {"at": "last", "fixed": ["x3", "x2", "d3", "d2"]}]
    moved = problem.replace(
        supports=both, prescribed_displacements=({"at": "last", "dof": "x3", "by": -0.3},)
    ).solve("x")
    assert moved["x"][-1, 0] == pytest.approx(0.7)
    assert np.abs(moved["x"][:, 1]).max() > 0.25  # buckled between its clamps


# ---------------------------------------------------------------- motion


def test_the_period_of_the_exact_timoshenko_beam(solved):
    data = solved["vibration_consistent"]
    exact = (
        2
        * np.pi
        / elastica.timoshenko_frequencies(beam_of(cosserat.case("vibration_consistent").problem), 1)[0]
    )
    assert data.sizes["vertex"] == 20
    tip = data.x.sel(axis="E2").isel(vertex=-1).to_numpy()
    assert period(data.time.to_numpy(), tip) == pytest.approx(exact, rel=1e-3)
    energy = (data.kinetic_energy + data.strain_energy).to_numpy()
    assert np.abs(energy / energy[0] - 1).max() < 1e-10


@pytest.mark.parametrize(
    ("section", "poisson", "amplitude"),
    [("plane strain", 0.49, 0.1), ("plane strain", 0.4999, 0.1), ("incompressible", 0.4999, 0.01)],
)
def test_nearly_incompressible_sections_vibrate(section, poisson, amplitude):
    """If the pressure is taken at the midpoint, a step has no solution at any reasonable step size."""
    case = cosserat.case("vibration_consistent").vary(
        "x",
        rod={"lateral_constraint": section, "material": {"poisson": poisson}},
        start={"amplitude": amplitude},
    )
    data = cosserat.run(case)
    energy = (data.kinetic_energy + data.strain_energy).to_numpy()
    assert np.abs(energy / energy[0] - 1).max() < 1e-7
    tip = data.x.sel(axis="E2").isel(vertex=-1).to_numpy()
    lowest = 2 * np.pi / case.problem.modes(1).angular_frequency[0]
    assert period(data.time.to_numpy(), tip) == pytest.approx(lowest, rel=5e-3)


@pytest.mark.parametrize("section", ["plane strain", "incompressible"])
def test_an_incompressible_rod_spins_freely(section):
    case = cosserat.case("vibration_consistent").vary(
        "x",
        rod={"lateral_constraint": section, "material": {"poisson": 0.4999}},
        supports=[],
        start={"shape": "reference", "amplitude": 0.0, "spin": 20.0},
    )
    data = cosserat.run(case)
    energy = (data.kinetic_energy + data.strain_energy).to_numpy()
    assert np.abs(energy / energy[0] - 1).max() < 1e-8
    turning = data.angular_momentum.to_numpy()
    assert np.abs(turning / turning[0] - 1).max() < 1e-10
    assert data.first_angle[-1] - data.first_angle[0] == pytest.approx(20 * 0.2, rel=2e-2)


def test_a_tumbling_stretching_rod_keeps_energy_and_momenta(solved):
    flight = solved["tumbling"]
    assert '"steps": 2000' in flight.attrs["solver"]
    energy = (flight.kinetic_energy + flight.strain_energy).to_numpy()
    assert np.abs(energy / energy[0] - 1).max() < 1e-8
    spin, momentum = flight.angular_momentum.to_numpy(), flight.momentum.to_numpy()
    assert np.abs(spin / spin[0] - 1).max() < 1e-10
    assert np.abs(momentum - momentum[0]).max() < 1e-10 * np.abs(momentum[0]).max()


# ---------------------------------------------------------------- options, bad input, size


def test_the_barrier_changes_nothing_in_the_limit_of_small_strains():
    problem, bending = slender(40)
    bent = problem.replace(forces=({"at": "last", "along": "E2", "force": 10 * bending},))
    plain = bent.solve("x")["u"][-1, 1]
    distance = []
    for elements in (20, 40, 80):
        problem, bending = slender(elements)
        pulled = problem.replace(forces=({"at": "last", "along": "E2", "force": 10 * bending},))
        with_barrier = pulled.replace(rod=pulled.rod.replace(barrier=True)).solve("x")["u"][-1, 1]
        distance.append(abs(with_barrier - pulled.solve("x")["u"][-1, 1]))
    assert distance[0] > 1e-5
    assert distance[-1] < distance[0] / 8
    assert plain == pytest.approx(0.8107, abs=1e-3)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"calibration": {"c1": 1, "c2": 1, "c3": 1, "c4": 1, "c5": 1, "c6": 1, "c7": 1}},
            "has 'calibration', which only energy = 'published' takes; leave it out",
        ),
        ({"energy": "published"}, "needs a calibration"),
        ({"lateral_constraint": "incompressible"}, "'poisson' = 0; it must be 0.49 or more"),
        ({"lateral_constraint": "thick"}, "must be 'free', 'plane strain' or 'incompressible'"),
        ({"material": {"poisson": 0.5}}, "'rod.material.poisson' is 0.5; it must be below 0.5"),
    ],
)
def test_bad_keys_of_a_rod_are_refused(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        cosserat.case("elastica").vary("x", rod=changes)


def test_the_published_rod_has_no_section_and_no_path():
    with pytest.raises(InputError, match="which only energy = 'consistent' takes"):
        cosserat.case("clamped_free").vary("x", rod={"lateral_constraint": "plane strain"})
    table = cosserat.case("clamped_free").problem.model_dump() | {"kind": "rod path"}
    del table["newton"], table["pose"]
    from cosserat.problems.path import RodPath

    with pytest.raises(InputError, match="needs rod.energy = 'consistent'"):
        RodPath.read(table, "x", units_required=False)


@pytest.mark.parametrize("increments", [1, 5, 10, 20, 37])
def test_the_full_load_is_reached_before_a_crossing_beyond_it(increments):
    """A column between a clamp and a guide at twice its critical load: four quarters of a hinged elastica."""
    posed = cosserat.case("elastica").problem
    critical = 4 * np.pi**2 * posed.rod.young * posed.rod.second_moment / posed.rod.length**2
    table = posed.model_dump() | {
        "supports": [*CLAMP, {"at": "last", "fixed": ["x2", "d3", "d2"]}],
        "forces": [
            {"at": "last", "along": "-E3", "force": 2 * critical},
            {"at": 20, "along": "E2", "force": 1e-6 * critical},
        ],
        "newton": {"load_increments": increments},
    }
    found = RodStatics.read(table, "column", units_required=False).solve("column")
    modulus = brentq(lambda m: (2 * ellipk(m) / np.pi) ** 2 - 2, 0.1, 0.99)
    assert found["x"][20, 1] == pytest.approx(np.sqrt(modulus) / ellipk(modulus), rel=5e-3)
    assert not found.warnings


@pytest.mark.parametrize("increments", [1, 10, 30])
def test_a_tiny_load_is_not_refused(increments):
    """Between hinges that do not move: P L^3 / 48 EI + P L / 4 kGA, whatever the number of increments."""
    posed = cosserat.case("elastica").problem
    beam = beam_of(posed)
    force = 1e-6 * beam.bending_stiffness / beam.length**2
    hinges = [{"at": at, "fixed": ["x3", "x2"]} for at in ("first", "last")]
    found = posed.replace(
        supports=hinges,
        forces=[{"at": 20, "along": "E2", "force": force}],
        newton={"load_increments": increments},
    ).solve("beam")
    right = force * (beam.length**3 / 48 / beam.bending_stiffness)
    assert found["u"][20, 1] == pytest.approx(right, rel=2e-3)


def test_a_hundred_thousand_vertices():
    """In memory and in one step, as with few vertices: a hanging bar, whose answer is known."""
    problem = cosserat.case("hanging_bar_consistent").vary("x", rod={"vertices": 100_000}).problem
    solved = problem.solve("x")
    fields = solved
    assert solved.statistics["iterations"] == 1
    exact = beams.hanging_bar_displacement(beam_of(problem), 9.81, fields["xi"])
    assert fields["u"][-1, 0] == pytest.approx(exact[-1], rel=1e-6)


@pytest.mark.parametrize(
    ("supports", "compliance"),
    [
        # hinges at both ends: P L^3 / 48 EI + P L / 4 kGA
        ([{"at": "first", "fixed": ["x3", "x2"]}, {"at": "last", "fixed": ["x2"]}], (1 / 48, 1 / 4)),
        # a clamp and a guide, which keeps the slope: half of a clamped-clamped beam of twice the length
        (
            [{"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}, {"at": "last", "fixed": ["d3"]}],
            (1 / 12, 1.0),
        ),
        # a clamp and a hinge: 7 P L^3 / 768 EI without shear; left to the mesh's own limit
        ([{"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}, {"at": "last", "fixed": ["x2"]}], None),
    ],
)
def test_hinges_and_guides_are_of_second_order(supports, compliance):
    """A force at mid-span, or at the guide; small, so that the answer is linear."""
    guided = compliance == (1 / 12, 1.0)
    tips = []
    for elements in (10, 20, 40, 80):
        problem, bending = slender(elements, radius=0.05)
        at = elements if guided else elements // 2
        loaded = problem.replace(
            supports=supports, forces=({"at": at, "along": "E2", "force": 1e-5 * bending},)
        )
        tips.append(loaded.solve("x")["u"][at, 1] / 1e-5)
    if compliance:
        shear = 5 / 6 * problem.rod.young / 2 * problem.rod.area / bending
        exact = compliance[0] + compliance[1] / shear
    else:
        exact = tips[-1] + (tips[-1] - tips[-2]) / 3
    errors = np.abs(np.array(tips) - exact)
    assert -np.diff(np.log2(errors))[:2] == pytest.approx(2, abs=0.15)
    assert errors[1] < 1e-2 * exact


COLUMN = {"supports": [{"at": "first", "fixed": ["x3", "x2"]}, {"at": "last", "fixed": ["x2"]}]}


@pytest.mark.parametrize(
    "changes",
    [
        # a straight column turns nowhere, so that arcs grow past the branching point unless it is closed in on
        {**COLUMN, "forces": [{"at": "last", "along": "-E3", "force": "6 N"}]},
        {**COLUMN, "forces": [{"at": "last", "along": "-E3", "force": "9 N"}]},
        # a moved clamp: two eigenvalues change their sign within the first arc
        {
            "supports": [*CLAMP, {"at": "last", "fixed": ["x3", "x2", "d3", "d2"]}],
            "prescribed_displacements": [{"at": "last", "dof": "x3", "by": "-20 cm"}],
            "forces": [],
        },
        # imperfect columns, whose corrections end in rounding
        *(
            {
                "forces": [
                    {"at": "last", "along": "-E3", "force": force},
                    {"at": "last", "along": "E2", "force": "1 mN"},
                ]
            }
            for force in ("4 N", "11.5 N")
        ),
    ],
)
def test_paths_end_at_their_load_on_the_stable_bent_branch(changes):
    path = cosserat.run(cosserat.case("column_path").vary("x", **changes))
    assert path.load_factor[-1] == 1
    assert path.stable[-1] == 1
    assert np.abs(path.x.sel(axis="E2")[-1]).max() > 0.15
    assert path.load_factor.max() <= 1.5


def test_a_path_that_ends_early_is_reported():
    path = cosserat.run(cosserat.case("arch_path").vary("x", arc={"count": 3}))
    assert '"load_factor_reached": 0.' in path.attrs["solver"]
    from cosserat.data.dataset import effort

    assert "raise 'arc.count' to continue" in effort(path)


def test_the_stored_shear_is_that_of_the_edges():
    problem, bending = slender(40, radius=0.05)
    done = problem.replace(forces=({"at": "last", "along": "E2", "force": 1e-3 * bending},)).solve("x")
    shear = 1e-3 * bending / (5 / 6 * problem.rod.young / 2 * problem.rod.area)
    np.testing.assert_allclose(done["shear"], shear, rtol=1e-3)
    assert "theta" not in done


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"line_loads": [{"along": "E2", "density": "1 N/m", "start": "0.3 m", "end": "0.2 m"}]},
            "from 0.3 m to 0.2 m",
        ),
        (
            {"line_loads": [{"along": "E2", "density": "1 N/m", "start": "0.5 m", "end": "6 m"}]},
            "the rod goes from 0 to 1 m",
        ),
        (
            {
                "prescribed_displacements": [
                    {"at": "first", "dof": "x3", "by": "1 cm"},
                    {"at": 0, "dof": "x3", "by": "2 cm"},
                ]
            },
            "move x3 of vertex 0 twice",
        ),
        ({"rod": {"vertices": 100_000_000}}, "'rod.vertices' is 100000000; it must be at most 200000"),
        ({"newton": {"load_increments": 10**9}}, "it must be at most 10000"),
    ],
)
def test_loads_on_fixed_dofs_and_impossible_sizes_are_refused(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        cosserat.case("elastica").vary("x", **changes)


# ---------------------------------------------------------------- moved supports, free flight, whole turns


@pytest.mark.parametrize("method", ["rk45", "rk4"])
def test_moved_supports_act_through_the_coupled_mass(method):
    """The consistent mass couples a moved vertex to its neighbour, in explicit and implicit integrators."""
    shaken = cosserat.case("vibration_consistent").vary(
        "shaken",
        rod={"vertices": 3},
        start={"amplitude": 0.0},
        prescribed_displacements=[
            {
                "at": "first",
                "dof": "x3",
                "by": 1e-4,
                "time_function": sine(1400),
            }
        ],
        duration=5e-4,
        every=5e-4,
    )
    explicit = {"method": method, "step": 8e-7} | ({"tolerance": 1e-12} if method == "rk45" else {})
    exact = cosserat.run(shaken.vary("shaken", integrator=explicit))
    given = 1e-4 * 2 * np.pi * 1400 * np.cos(2 * np.pi * 1400 * 5e-4)
    assert exact.x_rate[-1, 0, 0] == pytest.approx(given, rel=1e-9)
    errors = []
    for step in (1e-5, 5e-6, 2.5e-6):
        found = cosserat.run(shaken.vary("shaken", integrator={"method": "implicit", "step": step}))
        errors.append(float(np.abs(found.x[-1] - exact.x[-1]).max()))
    assert errors[-1] < 1e-4 * 1e-3
    np.testing.assert_allclose(np.diff(np.log2(errors)), -2, atol=0.05)


@pytest.mark.parametrize(
    ("spin", "step", "allowed"), [(1.0, 1e-4, 1e-9), (1.0, 1e-3, 1e-5), (30.0, 1e-3, 1e-2)]
)
def test_a_nearly_rigid_rod_keeps_its_spin(spin, step, allowed):
    free = cosserat.case("vibration_consistent").vary(
        "free",
        rod={"vertices": 11},
        supports=[],
        start={"shape": "reference", "amplitude": 0.0, "spin": spin},
        every=0.02,
        integrator={"step": step},
    )
    data = cosserat.run(free)
    energy = (data.kinetic_energy + data.strain_energy).to_numpy()
    assert np.abs(energy / energy[0] - 1).max() < allowed
    turning = data.angular_momentum.to_numpy()
    assert np.abs(turning / turning[0] - 1).max() < 1e-12


@pytest.mark.parametrize("method", ["rk4", "rk45", "implicit"])
def test_large_rotations_between_frames_are_counted(method):
    motor = cosserat.case("vibration_consistent").vary(
        "motor",
        rod={"vertices": 3, "material": {"young": 1e7}},
        supports=[{"at": "first", "fixed": ["x3", "x2"]}],
        start={"shape": "reference", "amplitude": 0.0, "spin": 200.0},
        couples=[{"at": "first", "moment": 80.0}],
        duration=0.04,
        every=0.04,
        integrator={"method": method, "step": 2e-5},
    )
    data = cosserat.run(motor)
    total = data.kinetic_energy + data.strain_energy + data.load_potential
    assert float(total[-1]) == pytest.approx(float(total[0]), rel=1e-6)
    assert data.first_angle[-1] - data.first_angle[0] > 4  # more than half a turn


def test_a_clamp_rotated_by_a_whole_turn_winds_up_the_rod():
    both = [*CLAMP, {"at": "last", "fixed": ["d3", "d2"]}]
    problem, bending = slender(40)
    wound = problem.replace(
        supports=both, prescribed_rotations=({"at": "last", "by": 2 * np.pi},)
    ).solve("x")
    assert wound["energy_parts"].sum() == pytest.approx(bending * (2 * np.pi) ** 2 / 2, rel=1e-3)


def test_a_first_arc_of_any_length_ends_at_the_full_load():
    forces = [{"at": "last", "along": "-E3", "force": 2.3}, {"at": "last", "along": "E2", "force": 1e-4}]
    path = cosserat.run(
        cosserat.case("column_path").vary("x", forces=forces, arc={"first": 1.2, "longest": 3.0})
    )
    assert path.load_factor[-1] == 1


@pytest.mark.parametrize("longest", [0.3, 0.05])
def test_a_path_ends_at_the_full_load_also_just_below_a_limit(longest):
    peak = cosserat.run(loaded_arch(20, longest=0.02, count=2000)).load_factor.to_numpy()
    first = peak[: int(np.argmax(np.diff(peak) < 0)) + 1].max()
    force = 46.875 * first / 1.001
    near = loaded_arch(20, longest=longest).vary(
        "near", forces=[{"at": 20, "along": "E2", "force": force}]
    )
    path = cosserat.run(near)
    assert path.load_factor[-1] == 1
    assert path.stable.to_numpy().all()
