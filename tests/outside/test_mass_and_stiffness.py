"""Weight and inertia have one mass, and steps inside an edge keep second order: values of independent codes."""

import numpy as np
import pytest

import cosserat
from cosserat.exact import elastica
from cosserat.problems.calibration import beam_of

from . import closed, timoshenko
from .checks import ORDER, frequencies, inputs, last, piece, run

# ---------------------------------------------------------------- a free rod falls without turning

TAPERS = {
    "none": [],
    "thinner tenfold": [{"at": 0.0}, {"at": 1.0, "height": 0.1, "width": 0.1}],
    "heavy end": [{"at": 0.99}, {"at": 0.99, "density": 51.0}],
    "heavy half": [{"at": 0.52}, {"at": 0.52, "density": 8.0}],
    "taper and step": [
        {"at": 0.1, "width": 2.0},
        {"at": 0.33, "height": 0.5},
        {"at": 0.33, "height": 0.8, "density": 4.0},
        {"at": 0.71, "height": 1.5, "young": 0.1},
    ],
}


def turned(data):
    """Angle of the line between the ends [degrees]."""
    chord = (data.x.isel(vertex=-1) - data.x.isel(vertex=0)).to_numpy()
    return np.degrees(np.arctan2(chord[:, 1], chord[:, 0]))


@pytest.mark.parametrize("stations", TAPERS.values(), ids=TAPERS)
@pytest.mark.parametrize(("vertices", "centreline"), [(11, 0.5), (21, 0.2)])
def test_a_free_rod_falls_without_turning(stations, vertices, centreline):
    rod = {"stations": stations, "vertices": vertices, "centreline": centreline}
    data = run("falling", rod=rod, duration=0.1)
    assert np.abs(turned(data)).max() < 1e-10
    fallen = data.x.isel(time=-1).to_numpy() - data.x_ref.to_numpy()
    np.testing.assert_allclose(fallen[:, 1], -9.81 * 0.1**2 / 2, rtol=1e-6)


@pytest.mark.parametrize("stations", TAPERS.values(), ids=TAPERS)
def test_a_free_published_rod_falls_without_turning(stations):
    published = cosserat.case("vibration_c4_20").problem.rod.calibration.model_dump()
    rod = {"stations": stations, "energy": "published", "calibration": published}
    assert np.abs(turned(run("falling", rod=rod, duration=0.05))).max() < 1e-10


def test_a_free_tapered_rod_does_not_turn_in_half_a_second():
    assert np.abs(turned(run("falling"))).max() < 1e-10


# ---------------------------------------------------------------- frequencies of masses inside an edge


@pytest.mark.parametrize("times", [1, 5])
def test_a_mass_inside_the_last_edge_is_of_second_order_in_frequency(times):
    """`times` the mass of the strip between 0.4995 and 0.5 m, against exact transfer matrices of both pieces."""
    density = 1 + 1000 * times
    stations = [
        {"at": 0.0},
        {"at": 0.4995},
        {"at": 0.4995, "density": density},
        {"at": 0.5, "density": density},
    ]
    heavy = piece("mass_inside", line_density=0.27 * density)
    right = timoshenko.frequencies([piece("mass_inside").part(0.4995), heavy.part(0.0005)], 2)
    meshes = [
        frequencies("mass_inside", 2, rod={"stations": stations, "vertices": n}) for n in (21, 41, 81)
    ]
    errors = np.abs(np.array(meshes) / right - 1)
    for error, edges in zip(errors, (20, 40, 80), strict=True):
        assert (error < np.array([1.0, 6.0]) / edges**2).all(), errors
    order = (
        np.log2(errors[0, 0] / errors[2, 0]) / 2
    )  # two errors of the second frequency cancel on the way
    assert order == pytest.approx(2, abs=ORDER), errors


@pytest.mark.parametrize("place", [1 / 3, 13 / 30])
def test_a_density_and_a_modulus_that_jump_inside_an_edge_are_of_second_order(place):
    """On meshes four times as fine the step is at the same fraction of an edge, so their errors are comparable."""
    at = 0.5 * place
    stations = [{"at": at}, {"at": at, "density": 8.0, "young": 0.2}]
    beam = piece("mass_inside")
    other = piece("mass_inside", line_density=8 * 0.27, young=0.2 * 70e9)
    right = timoshenko.frequencies([beam.part(at), other.part(0.5 - at)], 2)
    meshes = [
        frequencies("mass_inside", 2, rod={"stations": stations, "vertices": n}) for n in (11, 41, 161)
    ]
    errors = np.abs(np.array(meshes) / right - 1)
    orders = np.log2(errors[:-1] / errors[1:]) / 2
    assert (np.abs(orders[1] - 2) < ORDER).all(), (orders, errors)
    assert (errors[2] < [2e-4, 1e-3]).all(), errors


# ---------------------------------------------------------------- joints and tapers at rest

JOINT = [{"at": 0.52}, {"at": 0.52, "young": 0.3}]
EI, EA, GA = 1e9 * 0.01**4 / 12, 1e9 * 1e-4, 5 / 6 * 1e9 / 2 * 1e-4


def softer(s, at=0.52):
    return 1.0 if s < at else 0.3


def test_the_reference_value_of_the_joint_agrees_with_a_textbook():
    """P (a^3 + (1/n - 1)(L^3 - ...)): a cantilever whose outer part b has n times the stiffness; and shear."""
    a, b, n, P = 0.52, 0.48, 0.3, 1e-3
    bending = P / (3 * EI) * (1 - b**3 + b**3 / n)
    shear = P / GA * (a + b / n)
    right = closed.cantilever_tip(P, 1.0, lambda s: EI * softer(s), lambda s: GA * softer(s), [0.52])
    assert right == pytest.approx(bending + shear, rel=1e-12)
    assert right == pytest.approx(5.0327e-4, abs=1e-8)


@pytest.mark.parametrize("vertices", [11, 21, 41, 81, 161])
def test_a_joint_inside_an_edge_has_the_right_displacements(vertices):
    """The error of each mesh is at most 1.5 (h / L)^2, twice that of a joint on a vertex."""
    allowed = 1.5 / (vertices - 1) ** 2 + 1e-8
    bent = closed.cantilever_tip(1e-3, 1.0, lambda s: EI * softer(s), lambda s: GA * softer(s), [0.52])
    assert last(run("joint", rod={"vertices": vertices})) == pytest.approx(bent, rel=allowed)
    stretched = closed.pulled(1e-3, 1.0, lambda s: EA * softer(s), [0.52])
    pull = [{"at": "last", "along": "E3", "force": 1e-3}]
    data = run("joint_pulled", rod={"vertices": vertices}, forces=pull)
    assert last(data, "E3") - 1 == pytest.approx(stretched, rel=1e-6)


def test_a_joint_at_the_same_fraction_of_an_edge_is_of_second_order():
    at = 13 / 30
    stations = [{"at": at}, {"at": at, "young": 0.3}]
    right = closed.cantilever_tip(
        1e-3, 1.0, lambda s: EI * softer(s, at), lambda s: GA * softer(s, at), [at]
    )
    errors = [
        last(run("joint", rod={"vertices": n, "stations": stations})) / right - 1 for n in (11, 41, 161)
    ]
    orders = np.log2(np.abs(np.array(errors[:-1]) / errors[1:])) / 2
    assert (np.abs(orders - 2) < ORDER).all(), (orders, errors)


@pytest.mark.parametrize("thin", [0.1, 0.5, 2.0])
@pytest.mark.parametrize("end", [1.0, 23 / 30])
def test_tapers_are_of_second_order(thin, end):
    """Linear in height and width up to `end`, which is no vertex, and even beyond."""

    def fraction(s):
        return 1 + (thin - 1) * min(s / end, 1.0)

    right = closed.cantilever_tip(
        1e-4 * thin**3, 1.0, lambda s: EI * fraction(s) ** 4, lambda s: GA * fraction(s) ** 2, [end]
    )
    stretched = closed.pulled(1e-3, 1.0, lambda s: EA * fraction(s) ** 2, [end])
    stations = [{"at": 0.0}, {"at": end, "height": thin, "width": thin}]
    errors = []
    for n in (81, 321):
        rod = {"vertices": n, "stations": stations}
        across = run("joint", rod=rod, forces=[{"at": "last", "along": "E2", "force": 1e-4 * thin**3}])
        along = run("joint", rod=rod, forces=[{"at": "last", "along": "E3", "force": 1e-3}])
        errors.append(last(across) / right - 1)
        assert last(along, "E3") - 1 == pytest.approx(stretched, rel=1e-5)
    assert abs(errors[-1]) < 1e-3
    order = np.log2(abs(errors[0] / errors[1])) / 2
    assert order == pytest.approx(2, abs=ORDER), errors


@pytest.mark.parametrize("vertices", [20, 40, 80, 160])
def test_a_hanging_bar_of_two_materials_has_the_exact_tip(vertices):
    """u = g rho1 a (a / 2 + b r) / E1 A + g rho2 b^2 / 2 E2 A, with a joint at 2 of 5 m: 0.63765 mm on any mesh."""
    glued = [{"at": 2.0}, {"at": 2.0, "young": 0.3, "poisson": 1.5, "density": 3.0}]
    bar = cosserat.case("hanging_bar_consistent").vary(
        "glued", rod={"stations": glued, "vertices": vertices}
    )
    stiff = 1e9 * 0.25
    exact = 9.81 * 250 * (2 * (1 + 3 * 3) / stiff + 3 * 3**2 / 2 / (0.3 * stiff))
    assert exact == pytest.approx(0.63765e-3, abs=5e-9)
    tip = cosserat.run(bar).u.sel(axis="E3")[-1].item()
    assert tip == pytest.approx(exact, rel=1 / vertices**2)


def test_the_exact_beam_agrees_with_transfer_matrices():
    """Its first period, 0.06230951 s, also by a determinant of a third code."""
    beam = beam_of(cosserat.case("vibration_consistent").problem)
    found = elastica.timoshenko_frequencies(beam, 3) / (2 * np.pi)
    right = timoshenko.frequencies([timoshenko.Piece.rectangle(1.0, 0.1, 0.1, 1e9, 10.0)], 3)
    np.testing.assert_allclose(found, right, rtol=1e-8)
    assert 1 / right[0] == pytest.approx(0.06230951, abs=5e-9)


def test_each_input_is_a_case():
    assert {"falling", "mass_inside", "joint", "joint_pulled"} <= set(inputs())
