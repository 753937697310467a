"""Places along a rod and directions: how they are read, and that loads between vertices are of second order."""

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError
from cosserat.rods.loads.dead import PointForce
from cosserat.rods.naming import unit_vector
from cosserat.rods.places import located, mesh, vertex_at

CLAMP = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}


@pytest.mark.parametrize(
    ("written", "kept", "index", "share"),
    [
        ("first", "first", 0, 0.0),
        ("last", "last", 4, 0.0),
        (3, 3, 3, 0.0),
        ("0.35 m", "0.35 m", 0, 0.7),
        ("35 cm", "0.35 m", 0, 0.7),
        ("25 %", "25.0 %", 1, 0.0),
        ("30 %", "30.0 %", 1, 0.2),
        ("2 m", "2.0 m", 4, 0.0),
    ],
)
def test_a_place_is_a_vertex_a_distance_or_a_percentage(written, kept, index, share):
    at = PointForce.read({"at": written, "along": "E2", "force": "1 N"}, "it").at
    assert at == kept
    assert PointForce(at=at, along="E2", force=1.0).at == kept
    place = located(at, np.linspace(0, 2, 5))
    assert (place.index, place.share) == pytest.approx((index, share))


@pytest.mark.parametrize("written", [-1, 1.5, True, "middle", "3 kg", "-1 m", "0.5"])
def test_other_places_are_refused(written):
    with pytest.raises(InputError, match=r"'at' is .*; it must (be|not)"):
        PointForce.read({"at": written, "along": "E2", "force": "1 N"}, "it")


@pytest.mark.parametrize(
    ("written", "vector"),
    [
        ("-E2", (0, -1)),
        ("30 deg", (np.sqrt(3) / 2, 0.5)),
        (["3", 4], (0.6, 0.8)),
        ([-2, 0], (-1, 0)),
    ],
)
def test_a_direction_is_an_axis_an_angle_or_components(written, vector):
    along = PointForce.read({"at": 0, "along": written, "force": "1 N"}, "it").along
    np.testing.assert_allclose(unit_vector(along), vector, rtol=1e-15)
    np.testing.assert_allclose(unit_vector(PointForce(at=0, along=along, force=1.0).along), vector)


@pytest.mark.parametrize("written", ["E1", "up", [0, 0], [1], [1, 2, 3], "3 m", None])
def test_other_directions_are_refused(written):
    with pytest.raises(InputError, match="'along' is .*; it must be"):
        PointForce.read({"at": 0, "along": written, "force": "1 N"}, "it")


def test_a_mesh_has_a_vertex_at_each_place_and_nearly_equal_edges():
    arc = mesh(11, 1.0, ["first", 4, "0.43 m", "77 %"])
    assert (arc.size, arc[0], arc[-1]) == (11, 0.0, 1.0)
    assert arc[vertex_at("0.43 m", arc)] == 0.43
    assert arc[vertex_at("77 %", arc)] == pytest.approx(0.77, abs=1e-15)
    assert 0.07 < np.diff(arc).min() <= np.diff(arc).max() < 0.13
    np.testing.assert_array_equal(mesh(11, 1.0, ["0.3 m", "last"]), np.linspace(0, 1, 11))


def cantilever(vertices, **problem):
    rod = {"energy": "consistent", "vertices": vertices, "length": 2.0, "calibration": "none"}
    return cosserat.case("clamped_free").vary("it", rod=rod, gravity=None, supports=[CLAMP], **problem)


def tip(case):
    return cosserat.run(case).u.to_numpy()[-1, 1]


@pytest.mark.parametrize(
    "load",
    [
        {"forces": [{"at": "1 m", "along": "90 deg", "force": 3e3}]},
        {"couples": [{"at": "50 %", "moment": 3e3}]},
    ],
)
def test_a_load_between_vertices_is_of_second_order(load):
    """Timoshenko's cantilever of 2 m, loaded at the middle of an edge at 1 m: closed form."""
    rod = cantilever(12).problem.rod
    EI, kGA, a, L = rod.young * rod.second_moment, 5 / 6 * rod.young / 2 * rod.area, 1.0, 2.0
    bend = a**2 / 2 * (L - a / 3) / EI + a / kGA if "forces" in load else a * (L - a / 2) / EI
    exact = 3e3 * bend
    errors = [abs(tip(cantilever(n, **load)) - exact) / exact for n in (12, 24, 48)]
    assert errors[0] < 1e-2
    assert np.log2(errors[0] / errors[2]) > 3.4, errors


def test_a_support_in_metres_is_where_it_is_asked_for():
    """A propped cantilever with its prop at 1.3 of 2 m: reaction and tip by the force method."""
    a, L, P = 1.3, 2.0, 2e3
    prop = {"at": "1.3 m", "fixed": ["x2"]}
    errors = []
    for vertices in (12, 24, 48):
        case = cantilever(vertices, forces=[{"at": "last", "along": "-E2", "force": P}])
        case = case.vary("it", supports=[CLAMP, prop])
        run = cosserat.run(case)
        rod, at = case.problem.rod, int(np.abs(run.xi.to_numpy() - a).argmin())
        assert run.xi.to_numpy()[at] == pytest.approx(a, abs=1e-12)
        EI, kGA = rod.young * rod.second_moment, 5 / 6 * rod.young / 2 * rod.area
        exact = P * (a**2 / 2 * (L - a / 3) / EI + a / kGA) / (a**3 / 3 / EI + a / kGA)
        errors.append(abs(run.support_force.to_numpy()[at, 1] - exact) / exact)
    assert errors[0] < 2e-2
    assert np.log2(errors[0] / errors[2]) > 3.4, errors


def test_supports_need_vertices():
    with pytest.raises(
        InputError, match="has 3 vertices, but 4 of its ends, supports, springs and masses need"
    ):
        cantilever(3).vary(
            "it", supports=[CLAMP, *({"at": f"{x} m", "fixed": ["x2"]} for x in (0.3, 0.4))]
        )


def test_a_place_beyond_the_rod_is_refused():
    with pytest.raises(
        InputError, match=r"'forces' 'at' is 2\.5 m, but the rod is 2 m long; choose a place on it"
    ):
        cantilever(5, forces=[{"at": "2.5 m", "along": "E2", "force": 1.0}])
