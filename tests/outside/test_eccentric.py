"""Rods with a step in height and an eccentric centreline converge with second order to independent codes."""

from itertools import pairwise

import numpy as np
import pytest

import cosserat

from . import eccentric
from .checks import ORDER, inputs

AT = {"on a vertex": 0.5, "inside an edge": 13 / 30}
"""Meshes of 10, 40 and 160 edges have a vertex at the first and meet the second at the same share of an edge."""
MESHES = (11, 41, 161)
DENSITY = 1e3
everywhere = pytest.mark.parametrize("centreline", [0.2, 0.7])
steps = pytest.mark.parametrize("at", AT.values(), ids=AT)


def pieces(height, at, centreline, poisson, thin=0.5):
    return [
        eccentric.Piece.rectangle(length, height * fraction, height, 1e9, poisson, centreline, DENSITY)
        for length, fraction in ((at, 1.0), (1 - at, thin))
    ]


def stepped(height, at, centreline, poisson, vertices, thin=0.5, **case):
    rod = {
        "section": {"height": height, "width": height},
        "centreline": centreline,
        "material": {"poisson": poisson, "line_density": DENSITY * height**2},
        "vertices": vertices,
        "stations": [{"at": at}, {"at": at, "height": thin}],
    }
    return inputs()["joint"].vary("stepped", rod=rod, **case)


def tip(*sizes, **case):
    """Displacement of the tip, (2,) [m]."""
    return cosserat.run(stepped(*sizes, **case)).u.isel(vertex=-1).to_numpy()


def linear_tip(along, across, **rod):
    """The part of it that is linear in the forces: half the difference of what they do and what their opposites do."""
    return (tip(forces=pulled(along, across), **rod) - tip(forces=pulled(-along, -across), **rod)) / 2


def pulled(along, across):
    return [
        {"at": "last", "along": axis, "force": force}
        for axis, force in (("E3", along), ("E2", across))
        if force
    ]


def check_order(errors, size, floor):
    """Four times as fine, a sixteenth of the error or less, or none to speak of: (meshes,) errors beside a size."""
    errors = np.abs(np.array(errors)) / size
    for coarse, fine in pairwise(errors):
        assert fine < floor or np.log2(coarse / fine) / 2 > 2 - ORDER, errors
    assert errors[-1] < 2e-4, errors


@everywhere
@pytest.mark.parametrize("poisson", [0.0, 0.3])
def test_the_reference_code_agrees_with_beam_theory_for_thin_rods(centreline, poisson):
    """Closed form, section stretch and shooting give one answer for a rod a hundred times as long as high."""
    parts = pieces(0.01, 0.4, centreline, poisson)
    for load in ((1e-7, 0.0), (0.0, 1e-7)):
        right = eccentric.beam_tip(parts, *load)
        np.testing.assert_allclose(eccentric.linear_tip(parts, *load), right, rtol=1e-4)
        if centreline < 0.5:  # large deflections of both are compared with the package below
            small = eccentric.large_tip(parts, *load)
            assert small[1] == pytest.approx(right[1], rel=1e-4)
    e, EI = 0.3 * 0.01, 1e9 * 0.01**4 / 12  # by hand: a couple N e at the ends of two cantilevers
    across = 1e-7 * e / EI * (0.4 - 0.4**2 / 2 + 0.5 / 0.5**3 * 0.6**2 / 2)
    assert eccentric.beam_tip(pieces(0.01, 0.4, 0.2, 0.0), 1e-7, 0.0)[1] == pytest.approx(across)


@everywhere
@steps
@pytest.mark.parametrize("poisson", [0.0, 0.3])
def test_a_slender_stepped_body_pulled_beside_its_axis_bends_as_a_beam(at, centreline, poisson):
    """The deflection by tension and the axial displacement by a lateral force, with the offset (0.5 - centreline) H."""
    parts = pieces(0.02, at, centreline, poisson)
    for along, across in ((1e-3, 0.0), (0.0, 1e-3)):
        judge = eccentric.linear_tip if poisson else eccentric.beam_tip
        right = judge(parts, along, across)
        found = [
            linear_tip(
                along, across, at=at, height=0.02, centreline=centreline, poisson=poisson, vertices=n
            )
            - right
            for n in MESHES
        ]
        check_order(np.array(found)[:, 1], abs(right[1]), 5e-6)
        if (
            across or not poisson
        ):  # these meshes do not resolve the layers, a fifth of the height, that stretch by themselves
            check_order(np.array(found)[:, 0], abs(right[0]), 5e-6)


@everywhere
@steps
@pytest.mark.parametrize("poisson", [0.0, 0.3])
def test_a_thick_stepped_body_with_layers_converges(at, centreline, poisson):
    """Five times as long as high, so that the meshes resolve the layers of section stretch."""
    parts = pieces(0.2, at, centreline, poisson)
    for along, across in ((1.0, 0.0), (0.0, 1.0)):
        right = eccentric.linear_tip(parts, along, across)
        found = [
            linear_tip(
                along, across, at=at, height=0.2, centreline=centreline, poisson=poisson, vertices=n
            )
            - right
            for n in (41, 161)
        ]
        for k in range(2):
            check_order(np.array(found)[:, k], abs(right[k]), 1e-5)


@everywhere
@steps
@pytest.mark.parametrize("poisson", [0.0, 0.3])
@pytest.mark.parametrize(("along", "across"), [(0.0, 0.5), (0.5, 0.5)])
def test_large_deflections_of_a_stepped_body_are_of_second_order(at, centreline, poisson, along, across):
    """Loads in EI / L^2 of the thicker part: the thinner one turns by more than half a right angle."""
    height = 0.02
    unit = 1e9 * height**4 / 12
    right = eccentric.large_tip(pieces(height, at, centreline, poisson), along * unit, across * unit) - [
        1.0,
        0.0,
    ]
    found = []
    for n in MESHES:
        forces = pulled(along * unit, across * unit)
        found.append(tip(height, at, centreline, poisson, n, forces=forces) - right)
    for k in range(2):
        check_order(np.array(found)[:, k], 1.0, 1e-9)


@everywhere
@steps
@pytest.mark.parametrize("thin", [0.5, 1.0])
def test_a_curved_body_whose_height_jumps_is_of_second_order(at, centreline, thin):
    """A third of a circle; the area centres of both parts have other radii than the line, also where nothing jumps."""
    height, curvature = 0.05, 2.0
    unit = 1e9 * height**4 / 12
    right = eccentric.large_tip(
        pieces(height, at, centreline, 0.0, thin), 0.1 * unit, 0.1 * unit, curvature
    )
    forces, found = pulled(0.1 * unit, 0.1 * unit), []
    for n in MESHES:
        case = stepped(height, at, centreline, 0.0, n, thin, forces=forces)
        found.append(
            cosserat.run(case.vary("curved", rod={"rest": {"kind": "arc", "curvature": curvature}})).x[
                -1
            ]
            - right
        )
    for k in range(2):
        check_order(np.array(found)[:, k], 1.0, 1e-6)


@everywhere
@steps
def test_the_weight_of_a_hanging_stepped_body_bends_it_by_the_offset_of_its_halves(at, centreline):
    """The thin part hangs beside the area centres of the thick one, by e1 - e2, and nothing bends the thin one."""
    height, g = 0.05, 1e-3
    thick, thin = pieces(height, at, centreline, 0.0)
    moment = thin.m * g * thin.length * (thick.e - thin.e)
    right = moment / thick.EI * (at - at**2 / 2)
    found = [
        tip(height, at, centreline, 0.0, n, forces=[], gravity={"g": g, "along": "E3"})[1]
        for n in MESHES
    ]
    check_order(np.array(found) - right, abs(right), 2e-6)


@everywhere
@steps
@pytest.mark.parametrize("poisson", [0.0, 0.3])
def test_frequencies_of_a_stepped_body_are_of_second_order(at, centreline, poisson):
    """The fourth stretches the body; ten edges are too few for it."""
    parts = pieces(0.1, at, centreline, poisson)
    right = eccentric.frequencies(parts, 4, 10.0)
    meshes = [
        stepped(0.1, at, centreline, poisson, n, forces=[]).problem.modes(4).angular_frequency
        for n in MESHES[1:]
    ]
    errors = np.array(meshes) / (2 * np.pi) - right
    for k in range(4):
        check_order(errors[:, k], right[k], 1e-5)
