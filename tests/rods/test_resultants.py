"""Internal forces, director forces and stresses of one state, against derivatives of the energy and closed forms."""

import numpy as np
import pytest
from conftest import make_rod, random_state

import cosserat
from cosserat.figures import conventions
from cosserat.rods.resultants import (
    Resultants,
    contact_director_forces,
    intrinsic_director_forces,
    resultants,
    strain_gradients,
)
from cosserat.rods.stresses import beam_stresses, edge_sections

CONSISTENT = {"energy": "consistent", "calibration": None}
RODS = {
    "published": {},
    "consistent": CONSISTENT,
    "off-centre": {**CONSISTENT, "centreline": 0.3},
    "curved": {**CONSISTENT, "rest": {"kind": "arc", "curvature": 0.1}},
}
every_rod = pytest.mark.parametrize("name", RODS)


def some_rod(name, poisson=None, **changes):
    rod = make_rod(vertices=7, **{**RODS[name], **changes})
    return rod if poisson is None else rod.replace(material=rod.material.replace(poisson=poisson))


def state_of(rod, seed=3, size=0.1):
    """An energy of positions and a state of it, (1, n)."""
    geometry = rod.geometry()
    return rod.strain_energy.potential(rod, geometry), random_state(rod, seed, size)[None], geometry


def found_for(energy, q):
    vectors = q.reshape(1, -1, 2, 2)
    return resultants(vectors, strain_gradients(energy, q).reshape(vectors.shape))


def moved_beyond(q, K, shift=(0.0, 0.0), turn=0.0):
    """All that is beyond edge K, translated, and rotated about the middle of that edge."""
    vectors = q.reshape(-1, 2, 2).copy()
    c, s = np.cos(turn), np.sin(turn)
    R = np.array([[c, -s], [s, c]])
    middle = (vectors[K, 0] + vectors[K + 1, 0]) / 2
    vectors[K + 1 :, 0] = (vectors[K + 1 :, 0] - middle) @ R.T + middle + shift
    vectors[K + 1 :, 1] = vectors[K + 1 :, 1] @ R.T
    return vectors.ravel()


@every_rod
def test_force_and_moment_are_derivatives_of_the_energy_by_rigid_motions_beyond_the_cut(name):
    """By central differences of the energy itself, whose error falls with the square of the step."""
    rod = some_rod(name)
    energy, q, geometry = state_of(rod)
    found, h = found_for(energy, q), 1e-5 * geometry.edge_length[0]

    def slope(step, K, **motion):
        there, back = (
            {key: sign * step * np.asarray(value) for key, value in motion.items()} for sign in (1, -1)
        )
        ends = [energy.energy(moved_beyond(q[0], K, **one)) for one in (there, back)]
        return (ends[0] - ends[1]) / (2 * step)

    size = np.abs(found.force).max()
    for K in range(rod.vertices - 1):
        right = [slope(h, K, shift=axis) for axis in np.eye(2)]
        np.testing.assert_allclose(found.force[0, K], right, rtol=0, atol=2e-8 * size)
        turned = slope(1e-5, K, turn=1.0)
        np.testing.assert_allclose(
            found.moment[0, K], turned, rtol=0, atol=2e-8 * size * geometry.edge_length[0]
        )


@pytest.mark.parametrize("curvature", [0.0, 0.2])
def test_components_are_those_of_the_strains_of_reissner(curvature):
    """N = 2 mu A e + Lambda A (e + w), Q = k G A g and M = EI kappa, each measured here, at any state."""
    rod = some_rod("consistent", poisson=0.3, rest={"kind": "arc", "curvature": curvature})
    energy, q, geometry = state_of(rod)
    found, vectors = found_for(energy, q), q.reshape(-1, 2, 2)
    E, nu, A = rod.young, rod.poisson, rod.area
    h = geometry.edge_length

    def measured(x, d):
        angles = np.unwrap(np.arctan2(d[:, 1], d[:, 0]))
        along = (angles[1:] + angles[:-1]) / 2 - np.pi / 2  # of the normal
        e = np.diff(x, axis=0)
        axial = e[:, 0] * np.cos(along) + e[:, 1] * np.sin(along)
        slide = -e[:, 0] * np.sin(along) + e[:, 1] * np.cos(along)
        return axial / h, slide / h, np.diff(angles) / h

    now, rest = measured(*vectors.swapaxes(0, 1)), measured(geometry.X, geometry.D)
    e, g, kappa = (a - b for a, b in zip(now, rest, strict=True))
    wide = np.linalg.norm(vectors[:, 1], axis=1) / geometry.director_length - 1
    first = E * nu / (1 - nu**2)
    N = E / (1 + nu) * A * e + first * A * (e + (wide[1:] + wide[:-1]) / 2)
    Q = rod.shear_correction * E / (2 * (1 + nu)) * A * g
    for values, right in (
        (found.normal, N),
        (found.shear, Q),
        (found.moment, E * rod.second_moment * kappa),
    ):
        np.testing.assert_allclose(values[0], right, rtol=1e-9, atol=1e-9 * np.abs(right).max())


@every_rod
def test_sums_from_either_end_agree_to_rounding(name):
    """The gradient has neither a resultant nor a moment: what is before the cut gives minus what is beyond."""
    energy, q, _ = state_of(some_rod(name))
    found = found_for(energy, q)
    turned = q.reshape(1, -1, 2, 2)[:, ::-1]
    gradient = strain_gradients(energy, q).reshape(1, -1, 2, 2)[:, ::-1]
    other = resultants(turned, gradient)
    for one, two in ((found.force, other.force), (found.moment, other.moment)):
        assert np.abs(one + two[:, ::-1]).max() < 1e-13 * 7 * np.abs(one).max()


def test_the_drawn_page_has_the_signs_of_the_code():
    """What pulls the part before the cut along the drawn normal is N > 0, along the drawn director Q > 0."""
    vectors = np.zeros((1, 3, 2, 2))
    vectors[0, :, 0] = np.arange(3)[:, None] * conventions.NORMAL
    vectors[0, :, 1] = conventions.SECTION
    figure = conventions.picture()
    drawn = [
        np.subtract(text.xy, text.get_position()) for text in figure.axes[1].texts if not text.get_text()
    ]
    for arrow, name in zip(drawn[:2], ("normal", "shear"), strict=True):
        gradient = np.zeros_like(vectors)
        gradient[0, 2, 0] = arrow
        found = resultants(vectors, gradient)
        size = np.linalg.norm(arrow)
        np.testing.assert_allclose(getattr(found, name), size, rtol=1e-12)
        other = found.shear if name == "normal" else found.normal
        assert np.abs(other).max() < 1e-12


def director_forces(rod, q, energy):
    contact = contact_director_forces(energy, rod.strain_energy.between, q, 2)
    gradient = strain_gradients(energy, q).reshape(1, -1, 2, 2)
    return contact[0], intrinsic_director_forces(contact, gradient[:, :, 1])[0]


@every_rod
def test_director_forces_do_the_work_of_the_internal_forces_on_the_directors(name):
    """Sum of m . change of the difference and k . change of the directors: the change of energy by any change of d."""
    rod = some_rod(name)
    energy, q, _ = state_of(rod)
    contact, intrinsic = director_forces(rod, q, energy)
    change = np.random.default_rng(1).uniform(-1, 1, (rod.vertices, 2))
    step = np.zeros((rod.vertices, 2, 2))
    step[:, 1] = 1e-7 * change
    ends = [energy.energy(q[0] + sign * step.ravel()) for sign in (1, -1)]
    work = (contact * np.diff(change, axis=0)).sum() + (intrinsic * change).sum()
    assert work == pytest.approx((ends[0] - ends[1]) / 2e-7, rel=1e-6)


def test_in_pure_bending_the_contact_director_forces_are_the_couple():
    """m = M / |d| along the normal: the couple d x m of eq. (1.2.89)."""
    rod = some_rod("consistent", poisson=0.0)
    bent = rod.replace(rest={"kind": "arc", "curvature": 0.05}).geometry()
    energy = rod.strain_energy.potential(rod, rod.geometry())
    contact, _ = director_forces(rod, bent.q[None], energy)
    mean = (bent.D[1:] + bent.D[:-1]) / 2
    couple = mean[:, 0] * contact[:, 1] - mean[:, 1] * contact[:, 0]
    turn = 2 * np.arcsin(0.05 * bent.edge_length[0] / 2)
    inner = rod.young * rod.second_moment * turn / bent.edge_length[0] * np.cos(turn / 2) ** 2
    np.testing.assert_allclose(couple[1:-1], inner, rtol=1e-9)


def test_sections_that_cannot_narrow_push_with_lambda_a_e():
    """derived: W = Lambda A (e + w)^2 / 2 + mu A (e^2 + w^2) per length, so that dW/dw = Lambda A e at w = 0."""
    rod, e = some_rod("consistent", poisson=0.3), 1e-3
    geometry = rod.geometry()
    vectors = np.stack([geometry.X * (1 + e), geometry.D], axis=1)
    energy = rod.strain_energy.potential(rod, geometry)
    contact, intrinsic = director_forces(rod, vectors.reshape(1, -1), energy)
    first = rod.young * 0.3 / (1 - 0.3**2)
    right = first * rod.area * e / geometry.director_length * geometry.voronoi_length
    np.testing.assert_allclose(intrinsic[:, 1], right, rtol=1e-9)
    assert np.abs(intrinsic[:, 0]).max() < 1e-9 * right.max()
    assert np.abs(contact).max() < 1e-9 * right.max()


def test_a_gradient_of_the_section_stretch_is_carried_by_mu_i():
    """derived: W = mu I w'^2 / 2, so that |D| m = mu I w'."""
    rod, slope = some_rod("consistent", poisson=0.0), 1e-3
    geometry = rod.geometry()
    wide = 1 + slope * geometry.arc_length
    vectors = np.stack([geometry.X, geometry.D * wide[:, None]], axis=1)
    energy = rod.strain_energy.potential(rod, geometry)
    contact, _ = director_forces(rod, vectors.reshape(1, -1), energy)
    right = rod.young / 2 * rod.second_moment * slope / geometry.director_length[0]
    np.testing.assert_allclose(contact[:, 1], right, rtol=1e-9)


def test_stresses_of_a_pulled_and_bent_section_whichever_line_of_it_is_followed():
    """N/A -+ M h / 2 I, and the same body about a line 0.3 of the height above its lower surface."""
    for place in (0.5, 0.3):
        rod = some_rod("consistent", centreline=place)
        b, h = rod.width, rod.height
        N, M, offset = 2e3, -70.0, (0.5 - place) * h
        forces = Resultants(
            np.zeros((1, 6, 2)), *(np.full((1, 6), value) for value in (N, 500.0, M - offset * N))
        )
        stress = beam_stresses(edge_sections(rod, np.linspace(0, 1, 6)), forces)
        bending = 6 * M / (b * h**2)
        right = N / (b * h) + np.array([-bending, bending])
        np.testing.assert_allclose(stress.fibre[0], np.tile(right, (6, 1)), rtol=1e-12)
        np.testing.assert_allclose(stress.strain, stress.fibre / rod.young, rtol=1e-12)
        np.testing.assert_allclose(stress.shear, 500.0 / (b * h), rtol=1e-12)


def test_stresses_take_the_section_of_their_place_and_the_modulus_of_their_constraint():
    """A rod half as high and three times as wide at its end, and a strip in plane strain."""
    rod = some_rod(
        "consistent",
        poisson=0.3,
        stations=[{"at": 0.0}, {"at": 5.0, "height": 0.5, "width": 3.0, "young": 2.0}],
    )
    sections = edge_sections(rod, np.array([0.0, 2.5, 5.0]))
    h, b = rod.height * np.array([1, 0.75, 0.5]), rod.width * np.array([1, 2, 3])
    np.testing.assert_allclose(sections.area, b * h, rtol=1e-12)
    np.testing.assert_allclose(sections.bending, sections.young * b * h**3 / 12, rtol=1e-12)
    np.testing.assert_allclose(sections.young, rod.young * np.array([1, 1.5, 2]), rtol=1e-12)
    strip = some_rod("consistent", poisson=0.3, lateral_constraint="plane strain")
    assert edge_sections(strip, np.array([1.0])).young == pytest.approx(strip.young / (1 - 0.09))


def test_names_of_probes_are_checked():
    case = cosserat.case("clamped_free")
    for probes, said in (
        (
            [{"at": "last", "name": "tip"}, {"at": 3, "name": "tip"}],
            "'probes' has two named 'tip'; give each",
        ),
        ([{"at": "last", "name": "1st"}], "'probes.0.name' is '1st'; begin it with a letter"),
        ([{"at": 20, "name": "end"}], "'at' is 20, but the rod's vertices are 0 to 19"),
        ([{"at": "last"}], "'probes.0.name' is missing"),
    ):
        with pytest.raises(cosserat.InputError, match=said):
            case.vary("probed", probes=probes)
