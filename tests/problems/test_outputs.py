"""Outputs of every kind of rod problem, against closed forms, free-body cuts and independent dynamics."""

import numpy as np
import pytest
from conftest import sine
from scipy.optimize import brentq

import cosserat
from cosserat.data.dataset import to_dataset, without_derived
from cosserat.problem import ALONE, Run
from cosserat.problems.outputs import rotations
from cosserat.solvers.banded import to_dense
from cosserat.solvers.integrate import State
from cosserat.solvers.reactions import reactions
from cosserat.thesis.table.reference import thin

CLAMP = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}


def steel(
    vertices=21,
    length=2.0,
    height=0.02,
    width=0.03,
    young=200e9,
    poisson=0.3,
    line_density=4.71,
    **changes,
):
    """A bar of steel, with changes."""
    section = {"shape": "rectangle", "height": height, "width": width, "shear_factor": 5 / 6}
    material = {"young": young, "poisson": poisson, "line_density": line_density}
    rod = {"energy": "consistent", "calibration": "none", "vertices": vertices, "length": length}
    return {**rod, "section": section, "material": material, **changes}


def solved_case(like="elastica", **changes):
    cleared = {"forces": [], "couples": [], "gravity": None, "supports": [CLAMP]}
    given = cosserat.case(like).vary("own", **{**cleared, "rod": steel(), **changes})
    return cosserat.run(given)


def cut(data, K):
    """Force and moment about the middle of edge K of all loads beyond it (dead forces alone)."""
    x, load = data.x.to_numpy(), data.applied_force.to_numpy()[:, :2]
    arm = x[K + 1 :] - (x[K] + x[K + 1]) / 2
    return load[K + 1 :].sum(axis=0), (arm[:, 0] * load[K + 1 :, 1] - arm[:, 1] * load[K + 1 :, 0]).sum()


# ---------------------------------------------------------------- statics


@pytest.mark.parametrize("name", ["published", "consistent"])
def test_a_cantilever_has_a_constant_shear_force_and_a_linear_moment(name):
    """N = 0, Q = P, M = P (L - x) for a force up at the end, and q (L - x), q (L - x)^2 / 2 for a weight down."""
    rod = {} if name == "published" else {"energy": "consistent", "calibration": "none"}
    base = cosserat.case("clamped_free")
    L, W = base.problem.rod.length, base.problem.rod.line_density * 9.81
    point = base.vary(
        "point", gravity=None, rod=rod, forces=[{"at": "last", "along": "E2", "force": 100.0}]
    )
    data = cosserat.run(point)
    s = data.xi_edge.to_numpy()
    np.testing.assert_allclose(data.shear_force, 100.0, rtol=1e-6)
    np.testing.assert_allclose(data.bending_moment, 100.0 * (L - s), rtol=1e-6)
    assert np.abs(data.normal_force).max() < 0.03  # P times the slope
    light = cosserat.run(base.vary("light", gravity={"g": 0.0981}, rod=rod))
    np.testing.assert_allclose(light.shear_force, -0.01 * W * (L - s), rtol=1e-6)
    lumped = (L - s) ** 2 / 2 + (s[1] - s[0]) ** 2 / 8  # of a weight given to vertices
    np.testing.assert_allclose(light.bending_moment, -0.01 * W * lumped, rtol=1e-6)


def test_an_elastica_and_a_bent_rod_obey_statics_of_what_is_cut_off():
    """A rod bent by 82 degrees under an end force, and a curved one under its weight: nothing elastic is used."""
    weight = {"g": 9.81, "along": "-E2"}
    curved = solved_case(rod=steel(rest={"kind": "arc", "curvature": 0.8}, height=0.002), gravity=weight)
    for data in (cosserat.run("elastica"), curved):
        for K in range(data.sizes["edge"]):
            force, moment = cut(data, K)
            scale = np.abs(data.applied_force.to_numpy()[:, :2].sum(axis=0)).max()
            np.testing.assert_allclose(data.contact_force[K], force, rtol=0, atol=1e-9 * scale)
            assert data.bending_moment[K].item() == pytest.approx(moment, abs=1e-9 * scale)
        assert np.abs(data.rotation).max() > 0.3


def test_a_hanging_bar_carries_what_is_below_and_its_prestress():
    """N(x) = q (L - x) + EA e - q L/2 of a bar drawn between two ends, to the strain."""
    ends = [{"at": at, "fixed": ["x3", "x2"]} for at in ("first", "last")]
    weight = {"g": 9.81, "along": "E3"}
    drawn = [{"at": "last", "dof": "x3", "by": 1e-5}]
    data = solved_case(
        rod=steel(poisson=0.0),
        supports=ends,
        gravity=weight,
        prescribed_displacements=drawn,
    )
    q, s = 4.71 * 9.81, data.xi_edge.to_numpy()
    right = 200e9 * 0.03 * 0.02 * 1e-5 / 2.0 + q * (2.0 / 2 - s)
    np.testing.assert_allclose(data.normal_force, right, rtol=2e-5)
    np.testing.assert_allclose(
        data.reaction_force.sel(axis="E3"), [-600.0 - q * 1.0, 600.0 - q * 1.0], rtol=2e-5
    )
    assert list(data.support.to_numpy()) == ["first", "last"]


def test_a_chain_has_the_tensions_of_a_catenary():
    """Of no stretch: H everywhere, w y above the directrix at the ends (bisection here)."""
    span, length = 1.5, 2.0
    a = brentq(lambda a: 2 * a * np.sinh(span / (2 * a)) - length, 0.1, 10.0, xtol=1e-14)
    ends = [{"at": at, "fixed": ["x3", "x2"]} for at in ("first", "last")]
    data = solved_case(
        rod=steel(vertices=81, height=1e-4, width=0.1, poisson=0.0),
        supports=ends,
        gravity={"g": 9.81, "along": "-E2"},
        prescribed_displacements=[{"at": "last", "dof": "x3", "by": span - length}],
    )
    w = 4.71 * 9.81
    np.testing.assert_allclose(data.contact_force.sel(axis="E3"), w * a, rtol=5e-4)
    tension = w * a * np.cosh(span / (2 * a))
    for at in ("first", "last"):
        force = data.reaction_force.sel(support=at).to_numpy()
        assert np.hypot(*force) == pytest.approx(tension, rel=5e-4)
        assert data.reaction_moment.sel(support=at).item() == pytest.approx(0.0, abs=1e-9)


def test_three_point_bending_has_the_stress_of_the_textbook():
    """sigma = 6 M / b h^2 with M = F x / 2 at the middles of the edges, and F/2 / b h of shear."""
    F, b, h = 10.0, 0.03, 0.02
    data = solved_case(
        supports=[{"at": "first", "fixed": ["x3", "x2"]}, {"at": "last", "fixed": ["x2"]}],
        forces=[{"at": 10, "along": "-E2", "force": F}],
        probes=[{"at": 10, "name": "midspan"}, {"at": "first", "name": "left end"}],
    )
    s = data.xi_edge.to_numpy()
    M = F / 2 * np.minimum(s, 2.0 - s)
    right = 6 * M / (b * h**2)
    np.testing.assert_allclose(data.fibre_stress.sel(surface="lower"), right, rtol=1e-4)
    np.testing.assert_allclose(data.fibre_stress.sel(surface="upper"), -right, rtol=1e-4)
    np.testing.assert_allclose(data.fibre_strain.sel(surface="lower"), right / 200e9, rtol=1e-4)
    np.testing.assert_allclose(np.abs(data.shear_stress), F / 2 / (b * h), rtol=1e-4)
    EI, kGA = 200e9 * b * h**3 / 12, 5 / 6 * 200e9 / 2.6 * b * h
    sag = F * 8 / (48 * EI) + F * 2 / (4 * kGA)
    assert data.probe_displacement.sel(probe="midspan", axis="E2").item() == pytest.approx(
        -sag, rel=3e-3
    )
    assert data.probe_rotation.sel(probe="left end").item() == pytest.approx(
        -F * 4 / (16 * EI), rel=5e-3
    )
    # a linear rod stores half of what its dead load gives up
    assert data.load_potential.item() == pytest.approx(-2 * data.strain_energy.item(), rel=1e-5)
    assert data.strain_energy.item() == pytest.approx(F * sag / 2, rel=3e-3)


def test_points_and_supports_may_be_anywhere():
    """A beam on hinges, the second 3/4 along: the sag of its middle, amid an edge, and the turn of its free end."""
    F, EI, GA, span = 10.0, 200e9 * 0.03 * 0.02**3 / 12, 5 / 6 * 100e9 * 6e-4, 1.5
    errors = []
    for vertices in (21, 61):
        data = solved_case(
            rod=steel(poisson=0.0, vertices=vertices),
            supports=[{"at": "first", "fixed": ["x3", "x2"]}, {"at": "75 %", "fixed": ["x2"]}],
            forces=[{"at": "0.75 m", "along": "-E2", "force": F}],
            probes=[{"at": "0.75 m", "name": "middle"}, {"at": "last", "name": "tip"}],
        )
        assert list(data.support.to_numpy()) == ["first", "75.0 %"]
        np.testing.assert_allclose(data.reaction_force.sel(axis="E2"), F / 2, rtol=1e-5)
        sag = -data.probe_displacement.sel(probe="middle", axis="E2").item()
        turn = data.probe_rotation.sel(probe="tip").item()
        right = F * span**3 / (48 * EI) + F * span / (4 * GA)
        errors.append([sag / right - 1, turn / (F * span**2 / (16 * EI)) - 1])
    assert np.abs(errors[0]).max() < 2e-2
    np.testing.assert_allclose(np.log(np.divide(*errors)) / np.log(3), 2, atol=0.1)


def test_a_support_has_its_name_or_its_place():
    """A name counts before the place of what moves the same vertex, in whatever order they are."""
    data = solved_case(
        rod=steel(vertices=5),
        supports=[
            {"at": 0, "fixed": ["x3", "x2"], "name": "wall"},
            {"at": "50 %", "fixed": ["x2"]},
            {"at": "last", "fixed": ["x2"], "name": "pier 2"},
        ],
        prescribed_displacements=[{"at": "last", "dof": "x2", "by": 1e-3}],
    )
    assert list(data.support.to_numpy()) == ["wall", "50.0 %", "pier 2"]
    across = data.reaction_force.sel(axis="E2")
    assert float(across.sel(support="pier 2")) == pytest.approx(float(across.sel(support="wall")))
    assert float(across.sel(support="pier 2")) > 0


def test_a_clamp_that_cannot_stretch_gives_its_force_on_the_director():
    """The couple of the clamp is that of the free body; a bonded section of a pulled bar is held open."""
    data = solved_case(forces=[{"at": "last", "along": "E3", "force": 1e5}])
    assert data.reaction_force.sel(support="first").to_numpy() == pytest.approx([-1e5, 0.0], abs=1e-4)
    assert data.reaction_moment.item() == pytest.approx(0.0, abs=1e-6)
    held = data.reaction_director_force.sel(support="first", axis="E2").item()
    assert held > 0  # it would narrow
    np.testing.assert_allclose(held, data.support_force.isel(vertex=0).sel(dof="d2"))
    tilted = solved_case(couples=[{"at": "last", "moment": 3.0}])
    assert tilted.reaction_moment.item() == pytest.approx(-3.0, rel=1e-9)
    np.testing.assert_allclose(tilted.bending_moment, 3.0, rtol=1e-9)


def test_rotations_count_whole_turns():
    """A rod rolled up by 4 pi EI / L twists its tip twice round; a clamp turned by 200 degrees carries it."""
    EI = 200e9 * 0.03 * 0.002**3 / 12
    rolled = solved_case(
        rod=steel(height=0.002, vertices=41),
        couples=[{"at": "last", "moment": 4 * np.pi * EI / 2.0}],
    )
    assert rolled.rotation[-1].item() == pytest.approx(4 * np.pi, rel=1e-6)
    backwards = solved_case(
        rod=steel(height=0.002, vertices=41),
        supports=[{**CLAMP, "at": "last"}],
        couples=[{"at": "first", "moment": 4 * np.pi * EI / 2.0}],
    )
    assert backwards.rotation[0].item() == pytest.approx(4 * np.pi, rel=1e-6)
    turned = solved_case(prescribed_rotations=[{"at": "first", "by": np.radians(200)}])
    np.testing.assert_allclose(turned.rotation, np.radians(200), rtol=1e-9)


def test_without_a_held_section_rotations_follow_from_state_to_state():
    angles = np.linspace(0, 9, 20)[:, None] + np.linspace(0, 8, 12)
    d = np.stack([-np.sin(angles), np.cos(angles)], axis=-1)
    D = np.tile([0.0, 1.0], (12, 1))
    np.testing.assert_allclose(rotations(d, D, None), angles, atol=1e-12)
    np.testing.assert_allclose(rotations(d[5:], D, (3, angles[5:, 3] - 0.4)), angles[5:], atol=1e-12)


# ---------------------------------------------------------------- paths


def pushed(longest):
    """A bar on two hinges, one of which moves across it by a tenth of its length."""
    end = {"at": "last", "fixed": ["x3", "x2"]}
    down = [{"at": "last", "dof": "x2", "by": -0.1}]
    return solved_case(
        like="column_path",
        rod=steel(vertices=3, length=1.0, young=10e6, poisson=0.0, rest={"kind": "straight"}),
        supports=[{"at": "first", "fixed": ["x3", "x2"]}, end],
        prescribed_displacements=down,
        arc={"first": longest, "longest": longest, "count": 1000, "limit": 3.0},
    )


def test_a_pulled_string_has_its_reactions_and_works_along_its_path():
    """A hinged bar whose end moves across: tension EA (l/L - 1) along it, work EA (l - L)^2 / 2 L at every point."""
    errors = []
    for longest in (0.02, 0.01):
        data = pushed(longest)
        EA = 10e6 * 0.03 * 0.02
        down = 0.1 * data.load_factor.to_numpy()
        now = np.hypot(1.0, down)
        tension = EA * (now - 1)
        np.testing.assert_allclose(
            data.reaction_force.sel(support="last", axis="E2"), -tension * down / now, atol=1e-7
        )
        np.testing.assert_allclose(
            data.reaction_force.sel(support="first", axis="E3"), -tension / now, atol=1e-7
        )
        work = EA * (now - 1) ** 2 / 2
        np.testing.assert_allclose(data.strain_energy, work, rtol=1e-8, atol=1e-12)
        np.testing.assert_allclose(data.energy_parts.sum("part"), work, rtol=1e-8, atol=1e-12)
        assert np.abs(data.total_load_work).max() == 0.0
        errors.append(abs(data.support_work[-1].item() / work[-1] - 1))
        assert data.sizes["point"] > 6
    assert errors[0] < 0.02
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.25)


def test_along_a_path_loads_and_supports_give_what_the_rod_stores():
    """A column under a couple and a force, by the trapezoidal rule; its moment is that of the free body."""
    errors = []
    for longest in (0.2, 0.1):
        data = solved_case(
            like="column_path",
            rod=steel(height=0.002),
            forces=[{"at": "last", "along": "E2", "force": 2.0}],
            couples=[{"at": "last", "moment": 3.0}],
            arc={"first": longest, "longest": longest, "count": 500, "limit": 3.0},
        )
        assert data.load_factor[-1].item() == 1.0
        errors.append(abs(data.total_load_work[-1].item() / data.strain_energy[-1].item() - 1))
    assert errors[0] < 5e-3
    assert np.log2(errors[0] / errors[1]) > 1.8
    x = data.x.to_numpy()
    middle = (x[:, 1:] + x[:, :-1]) / 2
    factor = data.load_factor.to_numpy()[:, None]
    right = factor * (2.0 * (x[:, -1:, 0] - middle[:, :, 0]) + 3.0)
    np.testing.assert_allclose(data.bending_moment, right, atol=1e-8)
    np.testing.assert_allclose(data.u, data.x - data.x_ref, atol=1e-12)


def test_a_follower_force_along_a_path_gives_what_the_rod_stores():
    """It has no potential: its work is that of the path, and the trapezoidal rule is of second order."""
    errors = []
    for longest in (0.2, 0.1):
        data = solved_case(
            like="column_path",
            rod=steel(height=0.002),
            follower_forces=[{"at": "last", "along": "E2", "force": 4.0}],
            arc={"first": longest, "longest": longest, "count": 500, "limit": 3.0},
        )
        assert data.load_factor[-1].item() == 1.0
        assert data.load_potential[-1].item() == 0.0
        errors.append(abs(data.total_load_work[-1].item() / data.strain_energy[-1].item() - 1))
    assert errors[0] < 1e-2
    assert np.log2(errors[0] / errors[1]) > 1.8


# ---------------------------------------------------------------- motions


def moving(like="vibration_consistent", **changes):
    cleared = {"supports": [], "start": {"shape": "reference", "amplitude": 0.0}}
    return solved_case(like, **{**cleared, **changes})


def hinge(vertices):
    """A uniform bar on a hinge, let go from the level: sine and cosine below it, forces along and across, over m g."""
    data = moving(
        rod=steel(vertices=vertices, poisson=0.0, height=0.1, line_density=0.5, length=1.0),
        supports=[{"at": "first", "fixed": ["x3", "x2"]}],
        gravity={"g": 9.81, "along": "-E2"},
        duration=0.4,
        every=5e-4,
        damping=0.0,
        integrator={"method": "implicit", "step": 1e-4},
    )
    along = np.diff(data.x.isel(vertex=[0, -1]).to_numpy(), axis=1)[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    force = -data.reaction_force.sel(support="first").to_numpy() / (0.5 * 9.81)
    across = np.column_stack([along[:, 1], -along[:, 0]])  # down, at first
    return -along[:, 1], along[:, 0], (force * along).sum(axis=1), (force * across).sum(axis=1)


def test_the_hinge_of_a_pendulum_has_the_force_of_mechanics():
    """5/2 m g sin along it and m g cos / 4 across it, at an angle below the level; of second order in the edges.

    derived: J theta'^2 / 2 = m g L/2 sin and J theta'' = m g L/2 cos about the hinge, so that with s = m L^2 / 4 J the
    centre needs 2 s m g sin towards the hinge and s m g cos down.  s is 3/4 for a thin bar.  Across it the bar rings,
    as its weight acts at once: the mean counts.
    """
    share = 0.5**2 / (1 / 3 + 0.1**2 / 12)
    errors = []
    for vertices in (6, 11):
        sine, cosine, inward, up = hinge(vertices)
        later = sine > 0.1
        ratio = inward[later] / ((1 + 2 * share) * sine[later])
        errors.append(1 - ratio.mean())
        assert np.abs(ratio - ratio.mean()).max() < 3e-4
    assert up.sum() / cosine.sum() == pytest.approx(1 - share, rel=5e-3)
    assert errors[1] < 2e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


def shaken(damping=0.0):
    """An elastic beam whose clamp shakes across it, under gravity and 3 N sin(2 pi 80 Hz t) along its tip."""
    return moving(
        rod=steel(vertices=6, young=2e5),
        supports=[CLAMP],
        gravity={"g": 9.81, "along": "-E2"},
        prescribed_displacements=[{"at": "first", "dof": "x2", "by": 0.01, "time_function": sine(5.0)}],
        forces=[{"at": "last", "along": "E3", "force": 3.0, "time_function": sine(80.0)}],
        damping=damping,
        duration=0.01,
        every=2e-5,
        integrator={"method": "implicit", "step": 1e-5},
    )


def test_reactions_and_loads_are_the_rate_of_momentum():
    """In the shaken beam, by central differences between the frames."""
    data = shaken()
    rate = (data.momentum[2:].to_numpy() - data.momentum[:-2].to_numpy()) / 4e-5
    found = data.reaction_force.sum("support").to_numpy()[1:-1]
    found[:, 0] += 3.0 * np.sin(2 * np.pi * 80 * data.time.to_numpy()[1:-1])
    found[:, 1] -= 4.71 * 2.0 * 9.81
    assert np.abs(rate[:, 1]).max() > 1.0
    assert np.abs(found - rate).max() < 2e-5 * np.abs(rate).max()


def kkt(problem, q, v, time):
    """Reactions by accelerations and multipliers of the constraints, together in one dense system."""
    geometry = problem.rod.geometry()
    system = problem.system(geometry)
    gradient = np.zeros(q.size)
    system.add_gradient(q, system.history, gradient)
    M, fixed = to_dense(system.inertia), np.flatnonzero(system.constrained)
    damping = system.damping_rate * M @ v
    damping[fixed] = 0.0
    n, k = q.size, fixed.size
    A, b = np.zeros((n + k, n + k)), np.zeros(n + k)
    A[:n, :n], b[:n] = M, -gradient - damping
    b[5] += 50.0 * np.sin(2 * np.pi * 7.0 * time)  # the load of the case: x2 of vertex 1
    A[fixed, n + np.arange(k)] = -1.0
    A[n + np.arange(k), fixed] = 1.0
    b[n:] = system.constraints.at_time(time)[2][fixed]
    return fixed, np.linalg.solve(A, b)[n:], system


def test_reactions_of_an_instant_are_multipliers_of_the_constraints():
    """A damped, curved, tapered rod with a clamp that shakes and turns, at a random state."""
    case = cosserat.case("vibration_consistent").vary(
        "any",
        start={"shape": "reference", "amplitude": 0.0},
        rod={
            "rest": {"kind": "arc", "curvature": 0.05},
            "centreline": 0.4,
            "vertices": 6,
            "stations": [{"at": 0.0}, {"at": 1.0, "height": 0.5}],
        },
        supports=[CLAMP, {"at": "last", "fixed": ["x2"]}],
        prescribed_displacements=[{"at": "first", "dof": "x3", "by": 0.1, "time_function": sine(3.0)}],
        prescribed_rotations=[{"at": "first", "by": 0.3, "time_function": sine(2.0)}],
        forces=[{"at": 1, "along": "E2", "force": 50.0, "time_function": sine(7.0)}],
        damping=0.2,
        gravity={"g": 9.81, "along": "-E2"},
    )
    problem = case.problem
    rng = np.random.default_rng(4)
    q = problem.rod.geometry().q + 0.02 * rng.uniform(-1, 1, 24)
    v = rng.uniform(-1, 1, 24)
    fixed, right, system = kkt(problem, q, v, 0.123)
    found = reactions(system, [State(q, v, system.history, 0.123)] * 2)
    np.testing.assert_allclose(found[1, fixed], right, rtol=1e-9, atol=1e-9 * np.abs(right).max())
    assert np.delete(found[1], fixed).any() == False  # noqa: E712 - an array


def test_a_free_rod_has_no_reactions_and_its_weight_works():
    data = moving(
        gravity={"g": 9.81, "along": "-E2"},
        start={"shape": "reference", "amplitude": 0.0, "spin": 12.0},
        duration=1.2,
        every=0.3,
        damping=0.0,
        integrator={"method": "implicit", "step": 1e-3},
        probes=[{"at": "last", "name": "tip"}],
    )
    assert "reaction_force" not in data
    heights = data.x.sel(axis="E2").to_numpy()
    fall = (heights[:, 1:] + heights[:, :-1]).mean(axis=1) / 2  # of the centre of mass
    np.testing.assert_allclose(
        data.total_load_work, 4.71 * 2.0 * 9.81 * (fall[0] - fall), rtol=1e-9, atol=1e-9
    )
    np.testing.assert_allclose(
        data.rotation, 12.0 * data.time.to_numpy()[:, None] + 0 * data.rotation, atol=2e-3
    )
    np.testing.assert_allclose(
        data.energy_parts.sum("part"), data.strain_energy, atol=1e-9 * data.kinetic_energy.max().item()
    )
    np.testing.assert_allclose(data.probe_displacement.sel(probe="tip"), data.u.isel(vertex=-1), atol=0)


def test_the_wall_of_a_struck_bar_carries_twice_the_force():
    """D'Alembert: nothing before L/c, then 2 F until 3 L/c; behind the front N = F."""
    F, speed = 40.0, np.sqrt(1e9 * 6e-4 / 0.6)
    data = moving(
        rod=steel(vertices=81, young=1e9, poisson=0.0, line_density=0.6),
        supports=[CLAMP],
        forces=[{"at": "last", "along": "E3", "force": F}],
        damping=0.0,
        duration=3 * 2.0 / speed,
        every=0.02 * 2.0 / speed,
        integrator={"method": "implicit", "step": 0.002 * 2.0 / speed},
    )
    t = data.time.to_numpy() * speed / 2.0
    wall = -data.reaction_force.sel(support="first", axis="E3").to_numpy()
    assert np.abs(wall[t < 0.8]).max() < 0.05 * F
    assert wall[(t > 1.2) & (t < 2.8)].mean() == pytest.approx(2 * F, rel=0.01)
    end = data.normal_force.isel(edge=slice(60, None)).sel(time=data.time[(t > 0.5) & (t < 1.4)])
    assert end.mean().item() == pytest.approx(F, rel=0.01)


# ---------------------------------------------------------------- storage


def test_what_follows_from_the_states_is_named_and_not_in_references(solved):
    for name in ("clamped_free", "column_path", "vibration_consistent"):
        data = solved[name]
        derived = data.attrs["derived"].split()
        assert {"normal_force", "shear_force", "bending_moment", "fibre_stress", "rotation"} <= set(
            derived
        )
        left = thin(data)
        assert not set(derived) & set(left.variables)
        assert not {"surface", "support"} & set(left.dims)
        assert "derived" not in left.attrs
        assert set(without_derived(left).variables) == set(left.variables)


def test_layers_have_forces_and_no_stresses():
    """A beam of two layers under a force at its end: M = P (L - x), and no formula of one material."""
    core = {"young": 2e9, "poisson": 0.0, "density": 1000.0}
    layers = [{"thickness": 0.01, "width": 0.03, "material": {**core, "young": e}} for e in (2e9, 8e9)]
    made = {
        **steel(),
        "calibration": None,
        "section": {"shape": "layers", "layers": layers},
        "material": None,
    }
    problem = cosserat.case("elastica").problem.replace(
        rod=made, forces=[{"at": "last", "along": "E2", "force": 0.1}]
    )
    found = problem.solve("layers").derive()
    middles = found["xi_edge"]
    np.testing.assert_allclose(found["bending_moment"], 0.1 * (2.0 - middles), rtol=1e-4)
    assert "fibre_stress" not in found


def test_a_solver_computes_no_outputs():
    found = cosserat.case("clamped_free").problem.solve("beam", ALONE)
    assert "bending_moment" not in found
    assert found.derive is not None
    assert "bending_moment" in to_dataset(cosserat.case("clamped_free"), found)


def test_a_path_gives_what_is_read_and_leaves_out_what_costs_time():
    problem = cosserat.case("column_path").problem
    whole, part = problem.solve("column", ALONE), problem.solve("column", Run(wanted={"u", "x"}))
    assert {"potential", "special_load_factor"} <= set(whole.fields) - set(part.fields)
    assert set(part.fields) < set(whole.fields)
    assert whole.statistics["iterations"] == part.statistics["iterations"]
    assert (part["x"] == whole["x"]).all()
    derived = part.derive({"u"})
    assert set(derived.fields) == {"u"}
    every = whole.derive()
    assert (derived["u"] == every["u"]).all()
    assert set(whole.derive({"strain_energy"}).fields) < set(every.fields)
    for name in every.fields:
        assert name in whole.derive({name})
