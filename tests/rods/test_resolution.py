"""Resolution of a motion: rotating thin rods, the balance of energy, warnings, and sections that cross."""

import numpy as np
import pytest
from conftest import make_rod, sine

import cosserat
from cosserat.data.dataset import statistics_of, warnings_of
from cosserat.errors import CrossingError
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.reference import Geometry
from cosserat.rods.resolution import check_crossing, surface_stretch, unresolved_energy
from cosserat.solvers.banded import NO_BAND, to_dense
from cosserat.solvers.modes import modes
from cosserat.solvers.potential import GRADIENT, NOTHING, STRAINS

BEAM = cosserat.case("vibration_consistent")


def named(data):
    return [warning.split(":")[0] for warning in warnings_of(data)]


# ---------------------------------------------------------------- thin rods that turn


def spinning(radius, steps, like="vibration_consistent", turns=1.0):
    """A free rod of 1 m whose section bends as a circle of that radius, turning at 10 rad/s."""
    side, turn = np.sqrt(3) * radius, 2 * np.pi / 10
    return cosserat.case(like).vary(
        "spinning",
        rod={"section": {"height": side, "width": side}, "material": {"line_density": 0.1}},
        supports=[],
        start={"shape": "reference", "amplitude": 0.0, "spin": 10.0},
        duration=turns * turn,
        every=turn / 10,
        integrator={"step": turn / steps},
    )


@pytest.mark.parametrize("like", ["vibration_consistent", "vibration_c4_20"])
@pytest.mark.parametrize(("radius", "steps"), [(0.05, 50), (0.005, 30), (0.005, 50), (0.0005, 50)])
def test_a_thin_rod_rotates_freely_in_large_steps(like, radius, steps):
    """With stresses at the midpoint the thinner rods have no solution, and the thick one's energy drifts by 1e-3."""
    data = cosserat.run(spinning(radius, steps, like))
    energy = (data.kinetic_energy + data.strain_energy).to_numpy()
    assert np.abs(energy / energy[0] - 1).max() < 1e-9
    spin = data.angular_momentum.to_numpy()
    assert np.abs(spin / spin[0] - 1).max() < 1e-12
    if radius < 0.005:  # it flutters
        return
    tip, root = data.x.isel(vertex=-1).to_numpy(), data.x.isel(vertex=0).to_numpy()
    angle = np.unwrap(np.arctan2(*(tip - root).T[::-1]))
    h = 2 * np.pi / steps
    late = 1 - 2 * np.arctan(h / 2) / h  # the midpoint rule turns by 2 atan(h/2) in a step of h
    assert angle[-1] - angle[0] == pytest.approx(2 * np.pi * (1 - late), abs=5e-3)


@pytest.mark.parametrize("like", ["vibration_consistent", "vibration_c4_20"])
def test_forces_of_a_step_have_no_resultant_and_work_as_the_energy_changes(like):
    """Also where the body turns far in the step; the work misses the change of energy to third order in the step."""
    problem = (
        cosserat.case(like)
        .vary("x", supports=[], rod={"vertices": 6, "material": {"poisson": 0.3}})
        .problem
    )
    geometry = problem.geometry
    potential = problem.rod.strain_energy.potential(problem.rod, geometry)
    rng = np.random.default_rng(3)
    start, change = geometry.q, rng.uniform(-1, 1, 24) * 0.02
    start = start + rng.uniform(-1, 1, 24) * 0.005
    turned = 0.7 * PLANAR.rigid_motions(start)[2]
    strains, terms, missing = np.zeros(potential.strains), np.empty(len(potential.terms)), []
    for size in (1.0, 0.5, 0.25):
        step = size * (change + turned)
        gradient = np.zeros(24)
        before, after = (
            potential.evaluate(
                q, end, potential.data, NOTHING, strains, task, gradient, NO_BAND, NO_BAND, terms
            )
            for q, end, task in (
                (start, NOTHING, STRAINS),
                (start + step / 2, start + step, GRADIENT),
            )
        )
        assert after == pytest.approx(potential.energy(start + step), rel=1e-12)
        work = PLANAR.rigid_motions(start + step / 2) @ gradient
        assert np.abs(work).max() < 1e-11 * np.abs(gradient).max()
        missing.append(abs(after - before - gradient @ step))
    assert (np.diff(np.log2(missing)) < -2.5).all(), missing


# ---------------------------------------------------------------- balance and warnings


@pytest.mark.parametrize("method", ["implicit", "rk4", "rk45"])
def test_the_work_of_drag_and_supports_closes_the_energy_balance(method):
    """The balance includes an oscillating clamp, a weight and a drag."""
    shaken = BEAM.vary(
        "shaken",
        rod={"vertices": 4},
        start={"amplitude": 0.01},
        gravity={"g": 9.81, "along": "-E2"},
        damping=0.05,
        prescribed_displacements=[{"at": "first", "dof": "x2", "by": 2e-3, "time_function": sine(20)}],
        prescribed_rotations=[{"at": "first", "by": 0.02, "time_function": sine(30)}],
        duration=0.005,
        every=1e-3,
        integrator={"method": method, "step": 2e-6 if method == "rk4" else 2e-5},
    )
    data = cosserat.run(shaken)
    energy = data.kinetic_energy + data.strain_energy + data.load_potential
    balance = (energy + data.dissipated_energy - data.support_work).to_numpy()
    size = float(data.strain_energy.max())
    assert (
        np.abs(balance - balance[0]).max() < {"implicit": 1e-7, "rk4": 1e-7, "rk45": 1e-5}[method] * size
    )
    assert data.dissipated_energy[-1] > 1e-3 * size
    assert abs(data.support_work[-1]) > 1e-3 * size
    assert "energy balance" not in named(data)


def test_the_filter_agrees_with_the_modes():
    problem = cosserat.case("vibration_c4_20").problem
    geometry = problem.geometry
    system, q = problem.system(geometry), geometry.q
    found = modes(system, q, 80, "x", supported=True)
    rng = np.random.default_rng(0)
    v = np.where(system.constrained, 0.0, rng.uniform(-1, 1, q.size))
    fraction = found.coordinates(system.inertia, [v])[0] ** 2 / 2
    gradient, band = np.empty(q.size), np.empty((q.size, 14))
    system.internal.assemble(q, gradient, band)
    for h in (1e-6, 1e-5, 1e-4, 1e-3):
        x = found.angular_frequency * h
        right = float((fraction * x**16 / (1 + x**16)).sum())
        assert unresolved_energy(band, system.inertia, system.constrained, v, h) == pytest.approx(
            right, rel=1e-6, abs=1e-9 * fraction.sum()
        )
    assert fraction.sum() == pytest.approx(v @ to_dense(system.inertia) @ v / 2, rel=1e-9)


def test_unresolved_modes_are_warned_of_and_resolved_ones_are_not():
    short = {"duration": 0.02, "every": 1e-3, "start": {"amplitude": "2 cm"}}
    assert named(cosserat.run(cosserat.case("vibration_c4_20").vary("fast", **short))) == [
        "unresolved modes"
    ]
    assert named(cosserat.run(BEAM.vary("slow", **short, integrator={"step": "0.05 ms"}))) == []


def test_a_growing_energy_is_warned_of(monkeypatch):
    from cosserat.problems import checkpoints

    monkeypatch.setattr(checkpoints, "UNBALANCED", 1e-14)
    data = cosserat.run(BEAM.vary("x", duration=0.01, every=1e-3))
    assert "energy balance" in named(data)


def test_large_rotations_in_a_step_are_warned_of():
    data = cosserat.run(spinning(0.05, 5).vary("fast", every=0.7))
    assert "fast rotation" in named(data)


@pytest.mark.parametrize("steps", [5, 50])
def test_every_step_is_checked_for_large_rotations(steps):
    """A steady spin omega turns by 2 atan(omega h / 2) in each step of the midpoint rule; frames see the last only."""
    data = cosserat.run(spinning(0.05, steps).vary("spin", every=3.0))
    turned = statistics_of(data)["largest_step_rotation_rad"]
    assert turned == pytest.approx(2 * np.arctan(np.pi / steps), rel=2e-2)


@pytest.mark.parametrize("hertz", [160.0, 500.0, 999.0, 1000.0])
def test_an_unresolved_drive_is_warned_of(hertz):
    """At 1000 Hz and a millisecond the steps see the support at rest, and nothing moves at all."""
    shaken = BEAM.vary(
        "shaken",
        start={"shape": "reference", "amplitude": 0.0},
        prescribed_displacements=[
            {
                "at": "first",
                "dof": "x2",
                "by": 1e-3,
                "time_function": sine(hertz),
            }
        ],
        duration=0.01,
        every=1e-3,
        integrator={"step": 1e-3},
    )
    assert "fast drive" in named(cosserat.run(shaken))
    step = 0.9 / (2 * np.pi * hertz)
    assert "fast drive" not in named(cosserat.run(shaken.vary("x", integrator={"step": step})))
    rocked = shaken.vary(
        "rocked",
        prescribed_displacements=[],
        prescribed_rotations=[{"at": "first", "by": 1e-3, "time_function": sine(hertz)}],
    )
    assert "fast drive" in named(cosserat.run(rocked))


def test_a_drag_beyond_the_limit_of_the_method_is_warned_of():
    stiff = {"damping": 2.0, "integrator": {"step": 2e-3}, "duration": 0.02, "every": 2e-3}
    assert "damping" in named(cosserat.run(cosserat.case("vibration_c4_20").vary("x", **stiff)))


def test_a_coarse_mesh_at_rest_is_warned_of_and_a_fine_one_is_not():
    rolled = cosserat.case("roll_up")
    assert named(cosserat.run(rolled.vary("coarse", rod={"vertices": 6}))) == ["coarse mesh"]
    assert named(cosserat.run(rolled)) == []


def test_warnings_are_in_the_file_on_the_screen_and_in_the_picture(tmp_path, capsys):
    from cosserat.cli import main

    (tmp_path / "my.toml").write_text('[coarse]\nlike = "roll_up"\nrod.vertices = 6\n')
    path = tmp_path / "coarse.nc"
    assert main(["run", "coarse", "--file", str(tmp_path / "my.toml"), "-o", str(path)]) == 0
    assert "warning: coarse mesh: " in capsys.readouterr().err
    assert named(cosserat.load(path)) == ["coarse mesh"]
    assert main(["show", str(path)]) == 0
    assert "warning: coarse mesh: " in capsys.readouterr().out
    plain = tmp_path / "plain.svg"
    assert main(["plot", str(path)]) == 0
    data = cosserat.load(path)
    del data.attrs["warnings"]
    cosserat.save(data, tmp_path / "plain.nc")
    assert main(["plot", str(tmp_path / "plain.nc")]) == 0
    assert len(path.with_suffix(".svg").read_text()) > len(plain.read_text())


# ---------------------------------------------------------------- columns, arches


def test_only_a_symmetric_column_warns_of_its_open_side():
    forces = [{"at": "last", "along": "-E3", "force": 2.3132}]
    column = cosserat.case("elastica").vary("column", forces=forces)
    assert named(cosserat.run(column)) == ["bifurcation"]
    nudge = {"at": "last", "along": "E2", "force": 1e-9}
    assert named(cosserat.run(column.vary("nudged", forces=[*forces, nudge]))) == []


def test_a_snapping_arch_is_reported():
    arch = cosserat.case("arch_path").problem
    table = {k: v for k, v in arch.model_dump().items() if k not in ("kind", "arc", "start_from")}
    snapped = cosserat.case("elastica").vary(
        "snapped", **{**table, "rod": {"rest": {"kind": "arc", "curvature": 1.0}}}
    )
    assert named(cosserat.run(snapped)) == ["limit load"]


# ---------------------------------------------------------------- sections that cross


def test_surfaces_of_a_bent_rod_stretch_by_half_its_height_times_the_curvature():
    """On a circle of curvature K, chords of the surfaces at +-H/2 are 1 -+ K H / 2 times that of the centreline."""
    K, H = 0.8, 0.5
    straight = Geometry.straight(np.linspace(0.0, 5.0, 41), H / 2)
    bent = Geometry.arc(np.linspace(0.0, 5.0, 41), np.full(41, H / 2), K)
    stretch = surface_stretch(straight, bent.X, bent.D, np.ones(41))[:, 1:-1]
    np.testing.assert_allclose(stretch[0], 1 - K * H / 2, rtol=2e-3)
    np.testing.assert_allclose(stretch[1], 1 + K * H / 2, rtol=2e-3)


@pytest.mark.parametrize("like", ["clamped_free", "clamped_free_consistent"])
def test_sections_that_cross_are_refused_by_name(like):
    """A couple that bends a rod of 1 m height about a circle of 0.4 m."""
    rod = make_rod()
    moment = rod.young * rod.width * 1.0**3 / 12 / 0.4
    tight = cosserat.case(like).vary(
        "tight",
        gravity=None,
        rod={"section": {"height": 1.0}, "vertices": 41},
        couples=[{"at": "last", "moment": moment}],
    )
    with pytest.raises(
        CrossingError, match=r"case 'tight': the sections of vertices \d+ and \d+ cross at the"
    ):
        cosserat.run(tight)


def leaning(rod, surface, gap):
    """Sections 1 and 2 of a straight rod lean until `gap` of an edge is left between them at one surface."""
    geometry = rod.geometry()
    x, d = geometry.X.copy(), geometry.D.copy()
    reach = np.hypot(*d[1]) * (1.0 if surface == "upper" else rod.below)
    lean = np.arcsin((1 - gap) * geometry.edge_length[1] / (2 * reach))
    turn = -lean if surface == "upper" else lean
    for K, angle in ((1, turn), (2, -turn)):
        c, s = np.cos(angle), np.sin(angle)
        d[K] = np.array([[c, -s], [s, c]]) @ d[K]
    return geometry, x, d


@pytest.mark.parametrize("energy", ["published", "consistent"])
@pytest.mark.parametrize(("surface", "centreline"), [("upper", 0.5), ("upper", 0.2), ("lower", 0.8)])
def test_sections_that_cross_by_shear_are_refused(surface, centreline, energy):
    """The two displays after (3.4.11), the second with (H / D - 1) d (E3.30): the energy alone does not stop them."""
    own = {"energy": "consistent", "calibration": "none"} if energy == "consistent" else {}
    rod = cosserat.case("clamped_free").vary("x", rod={"centreline": centreline, **own}).problem.rod
    for gap in (0.01, -0.01):
        geometry, x, d = leaning(rod, surface, gap)
        fraction = -1.0 if surface == "upper" else rod.below
        distance = np.linalg.norm(fraction * d[1] + x[2] - x[1] - fraction * d[2])
        assert distance == pytest.approx(0.01 * geometry.edge_length[1], rel=1e-9)
        assert np.isfinite(rod.strain_energy.potential(rod, geometry).energy(np.hstack([x, d]).ravel()))
        if gap > 0:
            check_crossing(geometry, x, d, rod.below, "x")
        else:
            with pytest.raises(CrossingError, match=f"vertices 1 and 2 cross at the {surface} surface"):
                check_crossing(geometry, x, d, rod.below, "x")


def test_a_path_and_a_motion_stop_before_sections_cross(tmp_path):
    rod = make_rod()
    moment = rod.young * rod.width * 1.0**3 / 12 / 0.4
    couples = [{"at": "last", "moment": moment}]
    bent = cosserat.case("clamped_free_consistent").vary(
        "tight", gravity=None, rod={"section": {"height": 1.0}, "vertices": 41}, couples=couples
    )
    table = bent.problem.model_dump()
    table["rod"]["rest"] = {"kind": "arc", "curvature": 0.0}  # that of the arch is an arc
    path = cosserat.case("arch_path").vary(
        "path", **{k: table[k] for k in ("rod", "supports", "couples")}, forces=[]
    )
    with pytest.raises(CrossingError, match="of the load: the sections") as caught:
        cosserat.run(path)
    assert 0.7 < caught.value.dataset.load_factor[-1] < 0.85  # the circle of half a metre: 0.4 / 0.5
    wound = cosserat.case("relaxing_clamped_free").vary(
        "wound",
        gravity=None,
        rod={"section": {"height": 1.0}, "energy": "consistent", "calibration": "none"},
        couples=couples,
        duration=0.3,
        every=2e-3,
        damping=0.2,
        integrator={"step": 1e-4},
    )
    with pytest.raises(CrossingError, match="s: the sections of vertices"):
        cosserat.run(wound)
