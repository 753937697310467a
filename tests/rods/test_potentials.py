"""The contract of every potential: each energy of the registry and each kind of load, by the same tests."""

from functools import cache

import numpy as np
import pytest
from conftest import differentiated, jacobian
from hypothesis import given
from hypothesis import strategies as st

import cosserat
from cosserat.errors import InputError
from cosserat.rods.energies import ENERGIES, energy_named
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.problem import LOADS
from cosserat.rods.rod import Rod
from cosserat.solvers.banded import to_dense
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, STRAINS

EXAMPLES = {"published": "clamped_free", "consistent": "elastica"}
"""A case with a rod of each energy; an energy without one fails here."""
MATERIAL = {"young": 1e3, "poisson": 0.3, "line_density": 0.1}
OPTIONS = {
    "published": ({}, {"end_sections": "halved"}, {"intrinsic_curvature": "printed"}),
    "consistent": (
        {},
        {"barrier": True},
        {"lateral_constraint": "plane strain"},
        {"lateral_constraint": "incompressible", "material": MATERIAL | {"poisson": 0.495}},
    ),
}
RODS = [(name, number) for name in ENERGIES for number in range(len(OPTIONS[name]))]
LOAD_EXAMPLES = {
    "gravity": [{"g": 3.0, "along": "-E2"}],
    "line_loads": [{"along": "E2", "density": 2.0, "start": 0.1}],
    "forces": [{"at": "last", "along": "E3", "force": 0.7}, {"at": 2, "along": "E2", "force": -0.2}],
    "prestrains": [
        {"extension": 0.1, "start": 0.1, "end": 0.7},
        {"curvature": 0.4},
        {"section": -0.2, "start": 0.3},
    ],
    "temperatures": [{"change": 4e3, "gradient": 5e3, "expansion": 2e-5, "end": 0.9}],
    "base_motion": [{"along": "30 deg", "acceleration": 3.0}],
    "couples": [{"at": "last", "moment": 0.4}, {"at": 1, "moment": -0.3}],
    "line_couples": [{"density": 0.4, "start": 0.13}],
    "follower_forces": [
        {"at": "last", "along": "30 deg", "force": 0.7},
        {"at": "0.35 m", "along": "-E3", "force": 0.4},
    ],
    "follower_line_loads": [{"along": [1, 2], "density": 0.6, "start": 0.17, "end": 0.71}],
    "pressures": [
        {"side": "upper", "pressure": 20.0, "start": 0.17, "end": 0.71},
        {"side": "lower", "pressure": 7.0},
    ],
}


@cache
def rod(name, number):
    """A short thick tapered rod that is bent, its centreline off the middle."""
    given_rod = cosserat.case(EXAMPLES[name]).problem.rod
    changes = {
        "vertices": 6,
        "length": 1.0,
        "section": given_rod.section.replace(height=0.2, width=0.1),
        "material": MATERIAL | {"line_density": given_rod.line_density},
        "rest": {"kind": "arc", "curvature": 0.6},
        "centreline": 0.4,
        "stations": [{"at": 0.2}, {"at": 0.8, "height": 0.7, "young": 1.5}],
    }
    if given_rod.calibration is not None:
        changes["calibration"] = given_rod.calibration.replace(c5=0.3, c6=0.2)
    options = dict(OPTIONS[name][number])
    if options.get("intrinsic_curvature"):
        changes["rest"] = {"kind": "straight"}
    return Rod.read({**dict(given_rod), **changes, **options}, "rod", units_required=False)


@cache
def made(name, number):
    geometry = rod(name, number).geometry()
    return geometry, energy_named(name).potential(rod(name, number), geometry)


@cache
def load(key):
    given_loads = [LOADS[key].read(item, key, units_required=False) for item in LOAD_EXAMPLES[key]]
    own = rod("consistent", 0)
    return own.geometry(), LOADS[key].potential(given_loads, LoadedRod(own, own.geometry()))


def strained(geometry, seed, size=0.01):
    return geometry.q + size * np.random.default_rng(seed).uniform(-1, 1, geometry.q.size)


def derivatives(potential, q):
    """Gradient and Hessian by the kernel, and by differences of the energy and of the gradient."""
    n = q.size
    gradient, band = np.zeros(n), np.zeros((n, max(potential.half_bandwidth, 0) + 1))
    skew = np.zeros((0 if potential.symmetric else n, band.shape[1]))
    potential.add(q, potential.history, gradient, band, skew)
    hessian = to_dense(band)
    if skew.size:
        lower = np.tril(to_dense(skew), -1)
        hessian = hessian + lower - lower.T
    by_energy = jacobian(potential.energy, q, 1e-6)
    by_gradient = jacobian(lambda p: differentiated(potential, p)[1], q, 1e-6)
    return gradient, hessian, by_energy, by_gradient


def close(found, right, relative=1e-6):
    np.testing.assert_allclose(found, right, atol=relative * max(float(np.abs(right).max()), 1e-9))


every_energy = pytest.mark.parametrize(("name", "number"), RODS)
every_load = pytest.mark.parametrize("key", LOADS)


def test_every_energy_and_every_load_has_an_example():
    assert set(EXAMPLES) == set(OPTIONS) == set(ENERGIES)
    assert set(LOAD_EXAMPLES) == set(LOADS)


@every_energy
@given(st.integers(0, 1000))
def test_forces_are_gradients_and_the_hessian_is_their_derivative(name, number, seed):
    geometry, potential = made(name, number)
    gradient, hessian, by_energy, by_gradient = derivatives(potential, strained(geometry, seed))
    close(gradient, by_energy)
    close(hessian, by_gradient)


@every_load
@given(st.integers(0, 1000))
def test_loads_are_gradients_and_their_hessian_is_the_derivative(key, seed):
    geometry, potential = load(key)
    gradient, hessian, by_energy, by_gradient = derivatives(potential, strained(geometry, seed))
    if potential.symmetric:
        close(gradient, by_energy)
    close(hessian, by_gradient, 1e-5)


@every_energy
def test_the_half_bandwidth_is_exact(name, number):
    geometry, potential = made(name, number)
    q = strained(geometry, 1)
    gradient, band = np.zeros(q.size), np.zeros((q.size, potential.half_bandwidth + 1))
    potential.add(q, potential.history, gradient, band)
    assert np.abs(band[:, -1]).max() > 0  # no narrower


@every_energy
@given(st.integers(0, 1000))
def test_the_energy_is_the_sum_of_its_named_terms(name, number, seed):
    geometry, potential = made(name, number)
    terms = potential.energy_terms(strained(geometry, seed))
    assert terms.size == len(potential.terms) == len(set(potential.terms))
    assert potential.energy(strained(geometry, seed)) == pytest.approx(terms.sum(), rel=1e-13)


@every_energy
def test_every_term_contributes_somewhere(name, number):
    geometry, potential = made(name, number)
    terms = np.array([potential.energy_terms(strained(geometry, seed)) for seed in range(8)])
    assert (np.abs(terms).max(axis=0) > 0).all(), potential.terms


@every_energy
def test_the_reference_is_at_rest_with_no_energy(name, number):
    geometry, potential = made(name, number)
    gradient, hessian, _, _ = derivatives(potential, geometry.q)
    assert abs(potential.energy(geometry.q)) < 1e-12
    assert np.abs(gradient).max() < 1e-12 * np.abs(hessian).max()


@every_energy
@given(st.integers(0, 1000), st.floats(-3, 3))
def test_rigid_motions_change_no_energy_and_forces_balance(name, number, seed, turn):
    geometry, potential = made(name, number)
    q = strained(geometry, seed)
    c, s = np.cos(turn), np.sin(turn)
    moved = q.reshape(-1, 2, 2) @ np.array([[c, s], [-s, c]])
    moved[:, 0] += [3.0, -1.0]
    assert potential.energy(moved.ravel()) == pytest.approx(potential.energy(q), rel=1e-9)
    gradient = np.zeros(q.size)
    potential.add_gradient(q, potential.history, gradient)
    work = rod(name, number).kinematics.rigid_motions(q) @ gradient
    assert np.abs(work).max() < 1e-11 * np.abs(gradient).max()


@every_energy
def test_displacements_give_the_same_energy_as_positions(name, number):
    geometry, potential = made(name, number)
    shifted = energy_named(name).potential(rod(name, number), geometry, displacements=True)
    q = strained(geometry, 3)
    for one, other in zip(
        derivatives(potential, q)[:2], derivatives(shifted, q - geometry.q)[:2], strict=True
    ):
        close(other, one, 1e-9)


@every_energy
def test_the_work_in_a_step_is_the_change_of_energy_to_third_order(name, number):
    """Stresses of the mean of both ends at the midpoint: what is missing falls eightfold as the step is halved."""
    geometry, potential = made(name, number)
    missing = np.zeros(2)
    for seed in range(12):
        q, step = strained(geometry, seed), strained(geometry, seed + 1, 2e-3) - geometry.q
        for k, fraction in enumerate((1.0, 0.5)):
            change, strains = fraction * step, np.zeros(potential.strains)
            before, _, _ = called(potential, q, None, strains, STRAINS)
            after, gradient, _ = called(potential, q + change / 2, q + change, strains, GRADIENT)
            assert after == pytest.approx(potential.energy(q + change), rel=1e-12)
            missing[k] += abs(after - before - gradient @ change)
    assert missing[0] / missing[1] == pytest.approx(8, rel=0.1)


@every_energy
def test_a_rotation_in_a_step_gives_no_strain(name, number):
    """At the midpoint alone it would seem a compression."""
    geometry, potential = made(name, number)
    c, s = np.cos(0.5), np.sin(0.5)
    turned = (geometry.q.reshape(-1, 2, 2) @ np.array([[c, s], [-s, c]])).ravel()
    strains = np.zeros(potential.strains)
    called(potential, geometry.q, None, strains, STRAINS)
    _, gradient, band = called(potential, (geometry.q + turned) / 2, turned, strains, HESSIAN)
    assert np.abs(gradient).max() < 1e-12 * np.abs(band).max()


@every_load
def test_a_load_has_no_energy_in_the_reference(key):
    geometry, potential = load(key)
    assert abs(potential.energy(geometry.q)) < 1e-14


@every_load
def test_a_linear_load_does_not_depend_on_the_configuration(key):
    geometry, potential = load(key)
    near, far = np.zeros(geometry.q.size), np.zeros(geometry.q.size)
    potential.add_gradient(geometry.q, potential.history, near)
    potential.add_gradient(strained(geometry, 2, 0.1), potential.history, far)
    assert (near == far).all() == potential.linear


@every_load
def test_internal_variables_change_only_at_accepted_states(key):
    geometry, potential = load(key)
    q, history = strained(geometry, 2, 0.1), potential.history.copy()
    kept, gradient = history.copy(), np.zeros(geometry.q.size)
    potential.add(q, history, gradient, np.zeros((q.size, max(potential.half_bandwidth, 0) + 1)))
    potential.energy(q, history)
    assert (history == kept).all()
    once = potential.committed(q, history)
    assert (history == kept).all()
    assert (potential.committed(q, once) == once).all()  # accepted twice, the same


def test_a_couple_counts_whole_turns():
    geometry, potential = load("couples")
    history = potential.history
    c, s = np.cos(0.3), np.sin(0.3)
    q = geometry.q
    for _ in range(50):
        q = (q.reshape(-1, 2, 2) @ np.array([[c, s], [-s, c]])).ravel()
        history = potential.committed(q, history)
    assert history[0] - potential.history[0] == pytest.approx(50 * 0.3)
    assert potential.energy(q, history) == pytest.approx(-(0.4 - 0.3) * 50 * 0.3)


@every_energy
def test_options_of_another_energy_are_refused(name, number):
    own = rod(name, number)
    for other in set(ENERGIES) - {name}:
        foreign = {"barrier": True} if other == "consistent" else {"end_sections": "halved"}
        with pytest.raises(InputError, match=f"only energy = '{other}' takes"):
            own.replace(**foreign)


def called(potential, q, after, strains, task):
    """Energy, gradient and band of one call of the kernel."""
    none, n = np.empty(0), q.size
    gradient, terms = np.zeros(n), np.empty(len(potential.terms))
    band = np.zeros((n if task == HESSIAN else 0, potential.half_bandwidth + 1))
    after = none if after is None else after
    found = potential.evaluate(
        q, after, potential.data, potential.history, strains, task, gradient, band, band[:0], terms
    )
    return found, gradient, band


def test_names_of_kernel_tasks_are_distinct():
    assert len({GRADIENT, HESSIAN, STRAINS, COMMIT}) == 4
