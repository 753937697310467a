"""Natural modes of rods against exact beams: frequencies, effective masses, growth, flutter."""

import numpy as np
import pytest
from outside.timoshenko import Piece, frequencies
from scipy.integrate import quad
from scipy.optimize import brentq

import cosserat
from cosserat.errors import InputError, UnsupportedRodError
from cosserat.exact.beams import first_root
from cosserat.problems.modes import RodModes
from cosserat.solvers.banded import to_dense

CLAMP = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}
HINGES = [{"at": "first", "fixed": ["x3", "x2"]}, {"at": "last", "fixed": ["x2"]}]
YOUNG, LINE_DENSITY = 1e9, 0.1


def statics(vertices, thickness=0.05, supports=(CLAMP,), **changes):
    """A straight rod of length one and a square section, without Poisson's effect."""
    rod = {"vertices": vertices, "section": {"height": thickness, "width": thickness}}
    case = cosserat.case("elastica").vary(
        "rod", **({"rod": rod, "forces": [], "supports": list(supports)} | changes)
    )
    return case.problem


def modes(vertices, count=6, **changes):
    asked = {key: changes.pop(key) for key in ("branch", "about") if key in changes}
    return RodModes.of(statics(vertices, **changes), count).replace(**asked).solve("the rod")


def bending(thickness):
    """EI."""
    return YOUNG * thickness**4 / 12


def second_order(errors, least=1.9):
    orders = np.log2(errors[:-1] / errors[1:])
    assert (orders > least).all(), orders
    assert (orders < 2.1).all(), orders


@pytest.mark.parametrize("free", [False, True])
def test_bending_frequencies_are_those_of_timoshenkos_beam_with_second_order(free):
    beam = Piece.rectangle(1.0, 0.05, 0.05, YOUNG, LINE_DENSITY)
    right = frequencies([beam], 3, clamped=not free, start=100.0, factor=1.2)
    supports, rigid = ((), 3) if free else ((CLAMP,), 0)
    found = [modes(n, 3 + rigid, supports=supports) for n in (11, 21, 41)]
    errors = np.abs([data["natural_frequency"][rigid:] / right - 1 for data in found])
    second_order(errors, least=1.8)
    assert errors[-1].max() < 4e-3
    assert all((data["natural_frequency"][:rigid] == 0).all() for data in found)
    assert found[0].statistics["rigid_modes"] == rigid
    assert not any(data["growth_rate"].any() for data in found)


def effective_shares(count):
    """(integral of w)^2 / integral of w^2 of the lowest modes of a clamped-free Euler beam of unit length and mass."""
    shares = []
    for k in range(count):
        b = brentq(
            lambda x: np.cosh(x) * np.cos(x) + 1, (k + 0.5) * np.pi - 0.4, (k + 0.5) * np.pi + 0.4
        )
        r = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))

        def w(x, b=b, r=r):
            return np.cosh(b * x) - np.cos(b * x) - r * (np.sinh(b * x) - np.sin(b * x))

        shares.append(quad(w, 0, 1)[0] ** 2 / quad(lambda x: w(x) ** 2, 0, 1)[0])
    assert brentq(lambda x: np.cosh(x) * np.cos(x) + 1, 1.5, 2) == pytest.approx(first_root())
    return np.array(shares)


def test_effective_masses_are_those_of_eulers_cantilever():
    right = effective_shares(3)
    np.testing.assert_allclose(right, [0.6131, 0.1883, 0.0647], atol=1e-4)
    found = [modes(n, 3, thickness=2e-3)["effective_mass"][:, 1] / LINE_DENSITY for n in (11, 21, 41)]
    errors = np.abs(np.array(found) - right)
    second_order(errors[:, :1])
    assert errors[-1].max() < 3e-4


def test_effective_masses_sum_to_the_mass_that_no_support_carries():
    problem = statics(11)
    found = RodModes.of(problem, 44).solve("the rod")
    mass, held = to_dense(problem.rod.mass(problem.geometry)), problem.constrained()
    r = np.zeros((3, 44))
    r[0, 0::4] = r[1, 1::4] = 1
    r[2, 1::4], r[2, 2::4] = np.linspace(0, 1, 11), -problem.geometry.D[:, 1]
    M, m = mass[~held][:, ~held], mass[~held] @ r.T
    right = np.einsum("ij,ij->j", m, np.linalg.solve(M, m))
    np.testing.assert_allclose(found["effective_mass"].sum(axis=0), right[:2], rtol=1e-12)
    np.testing.assert_allclose(found["effective_inertia"].sum(), right[2], rtol=1e-12)
    np.testing.assert_allclose(found["total_mass"], LINE_DENSITY, rtol=1e-12)
    exact = LINE_DENSITY * (1 / 3 + 0.05**2 / 12)  # of a line and of its sections
    errors = [modes(n, 1)["total_inertia"] - exact for n in (11, 21, 41)]
    second_order(np.array(errors), least=1.99)


def test_a_free_rod_has_all_its_mass_in_rigid_modes():
    found = modes(11, 8, supports=())
    np.testing.assert_allclose(found["effective_mass"][:3].sum(axis=0), LINE_DENSITY, rtol=1e-9)
    np.testing.assert_allclose(found["effective_inertia"][:3].sum(), found["total_inertia"], rtol=1e-9)
    assert np.abs(found["effective_mass"][3:]).max() < 1e-9 * LINE_DENSITY


def test_shapes_have_a_modal_mass_of_one_and_go_to_the_positive_side():
    force = [{"at": "last", "along": "E2", "force": 500.0}]
    problem = statics(11, forces=force)
    found = RodModes.of(problem, 5).solve("the rod")
    mass = to_dense(problem.rod.mass(problem.geometry))
    shapes = np.concatenate([found["mode_u"], found["mode_delta"]], axis=2).reshape(5, -1)
    np.testing.assert_allclose(shapes @ mass @ shapes.T, np.eye(5), atol=1e-10)
    u = found["mode_u"].reshape(5, -1)
    assert (u.max(axis=1) == np.abs(u).max(axis=1)).all()
    np.testing.assert_allclose(
        2 * np.pi * found["natural_frequency"], problem.modes(5).angular_frequency, rtol=1e-12
    )
    bent = problem.solve("the rod")
    np.testing.assert_allclose(found["x"], bent["x"], atol=1e-14)
    assert found["x"][-1, 1] > 0.1
    np.testing.assert_allclose(found["applied_force"].sum(axis=0), [0, 500, 0, 0], atol=1e-9)


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_a_column_beyond_eulers_load_grows_where_below_it_vibrates(share):
    """Hinged: omega^2 = (pi / L)^4 EI / m (1 - P / P_E), of a thin beam."""
    thickness, errors = 2e-3, []
    right = np.pi**2 * np.sqrt(bending(thickness) / LINE_DENSITY * abs(1 - share))
    push = [{"at": "last", "along": "-E3", "force": share * np.pi**2 * bending(thickness)}]
    for n in (11, 21, 41):
        found = modes(n, 2, thickness=thickness, supports=HINGES, forces=push, branch="stay")
        s = found["growth_rate"][0] + 2j * np.pi * found["natural_frequency"][0]
        errors.append(abs(s - (right if share > 1 else 1j * right)) / right)
    second_order(np.array(errors))
    assert errors[-1] < 3e-3
    named = [warning.partition(":")[0] for warning in found.warnings]
    assert named == (["divergence"] if share > 1 else [])
    assert found.statistics["growing_modes"] == (share > 1)


def pushed_by(force, vertices, thickness):
    """The two lowest modes of a cantilever whose end is pushed along its section."""
    load = [{"at": "last", "along": "-E3", "force": force}]
    return modes(vertices, 2, thickness=thickness, follower_forces=load)


def test_becks_column_flutters_at_its_load():
    """Of two eigenvalues that meet, the square of half the difference goes through zero."""
    thickness, published = 5e-3, 20.0510

    def apart(share, vertices):
        found = pushed_by(share * bending(thickness), vertices, thickness)
        k = -((found["growth_rate"] + 2j * np.pi * found["natural_frequency"]) ** 2)
        return (
            ((k[0] - k[1]) ** 2).real if found.statistics["growing_modes"] == 0 else -4 * k[0].imag ** 2
        )

    right = [brentq(apart, 18, 22, args=(n,), xtol=1e-6) for n in (11, 21, 41)]
    errors = np.abs(np.array(right) - published) / published
    second_order(errors)
    assert errors[-1] < 2.5e-3


def test_a_flutter_is_named_and_has_a_shape_with_an_imaginary_part():
    found = pushed_by(25 * bending(5e-3), 11, 5e-3)
    assert [warning.partition(":")[0] for warning in found.warnings] == ["flutter"]
    growth, hertz = found["growth_rate"], found["natural_frequency"]
    assert growth[0] == pytest.approx(-growth[1], rel=1e-6)
    assert growth[0] > 0
    assert hertz[0] == pytest.approx(hertz[1], rel=1e-9)
    assert np.abs(found["mode_u_imaginary"][0]).max() > 0.01 * found["mode_u"][0].max()
    assert "effective_mass" not in found
    u = found["mode_u"] + 1j * found["mode_u_imaginary"]
    for shape in u.reshape(2, -1):
        assert shape[np.abs(shape).argmax()].imag == pytest.approx(0, abs=1e-12)


def test_the_modes_of_a_motion_are_about_its_reference():
    motion = cosserat.case("vibration_consistent").problem
    found = RodModes.of(motion, 3).solve("the rod")
    right = motion.modes(3).angular_frequency
    np.testing.assert_allclose(2 * np.pi * found["natural_frequency"], right, rtol=1e-10)
    np.testing.assert_allclose(found["x"], found["x_ref"], atol=0)


def test_about_the_reference_no_load_counts():
    force = [{"at": "last", "along": "E2", "force": 500.0}]
    bent, straight = (modes(11, 3, forces=force, about=about) for about in ("equilibrium", "reference"))
    free = modes(11, 3)["natural_frequency"]
    np.testing.assert_allclose(straight["natural_frequency"], free, rtol=1e-12)
    assert np.abs(bent["natural_frequency"] / free - 1).max() > 1e-3
    assert not straight["support_force"].any()


def test_a_fine_mesh_has_the_same_modes_by_the_sparse_method(monkeypatch):
    from cosserat.solvers import modes as solver

    push = [{"at": "last", "along": "-E3", "force": 2 * np.pi**2 * bending(0.05)}]
    for changes in (
        {},
        {"supports": ()},
        {"supports": HINGES, "forces": push, "branch": "stay"},
        {"follower_forces": [{"at": "last", "along": "-E3", "force": 25 * bending(0.05)}]},
    ):
        monkeypatch.setattr(solver, "MOST_DENSE", 1200)
        dense = modes(21, 5, **changes)
        monkeypatch.setattr(solver, "MOST_DENSE", 10)
        sparse = modes(21, 5, **changes)
        for name in ("natural_frequency", "growth_rate"):
            size = np.abs(dense["natural_frequency"]).max()
            np.testing.assert_allclose(sparse[name], dense[name], rtol=1e-6, atol=1e-9 * size)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"count": 0}, "'count' is 0; it must be at least 1"),
        ({"about": "start"}, "'about' is 'start'; it must be 'equilibrium' or 'reference'"),
        ({"branch": "both"}, "'branch' is 'both'; it must be 'leave' or 'stay'"),
    ],
)
def test_bad_input(changes, sentence):
    table = statics(11).model_dump() | {"kind": "modes"} | changes
    with pytest.raises(InputError) as error:
        RodModes.read(table, "x", units_required=False)
    assert sentence in str(error.value)


def test_more_modes_than_the_rod_has_are_named():
    """Eleven vertices of four components, less the four of the clamp."""
    found = modes(11, 50)
    assert found["natural_frequency"].size == 40
    assert [text for text in found.warnings if "has 40, and 'count' asks for 50" in text]
    assert not modes(11, 40).warnings


def test_a_loaded_rod_that_floats_is_refused():
    force = [{"at": "last", "along": "E2", "force": 1.0}]
    with pytest.raises(UnsupportedRodError, match="leave the rod free to move"):
        modes(11, supports=(), forces=force)
