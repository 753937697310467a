"""Three questions from public forums, each written as a new user would write it, with own numbers.

A mast that tapers: physicsforums.com/threads/deflection-of-tapered-beam-cantilever.353149.
A weight dropped on a beam: eng-tips.com/threads/impact-load.216709.
A rubber tube between two points: GazzolaLab/PyElastica issue 514.

Right values: quadrature of the beam's equation, a series of sines of the simply supported Timoshenko beam, and the
boundary value problem of the planar extensible, shearable rod.
"""

import functools
import re

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp
from scipy.linalg import eigh

import cosserat

MAST = """
[mast]
kind = "rod statics"
supports = [{ at = "first", fixed = "clamped" }]
forces = [{ at = "last", along = "-E2", force = "1 N" }]
rod.energy = "consistent"
rod.vertices = 21
rod.length = "3 m"
rod.section = { shape = "tube", diameter = "60 mm", wall = "3 mm", shear_factor = "cowper" }
rod.material = { young = "70 GPa", poisson = 0.33, density = "2700 kg/m^3" }
rod.stations = [{ at = "0 m" }, { at = "3 m", height = 0.5, width = 0.5 }]
"""
DROP = """
[drop]
kind = "rod motion"
supports = [{ at = "first", fixed = "pinned" }, { at = "last", fixed = "roller" }]
masses = [{ at = "50 %", mass = "45 kg" }]
forces = [{ at = "50 %", along = "-E2", force = "24.3 kN", time_function = { kind = "pulse", duration = "1 ms" } }]
duration = "10 ms"
every = "1 ms"
integrator.step = "50 us"
rod.energy = "consistent"
rod.vertices = 11
rod.length = "3 m"
rod.section = { shape = "I", height = "20 cm", width = "10 cm", flange = "8.5 mm", web = "5.6 mm", shear_factor = 0.38 }
rod.material = { young = "210 GPa", poisson = 0.3, density = "7850 kg/m^3" }
"""
THROWN = """start.velocities = [
    ["1.2 m", "0 m/s", "0 m/s", "0 rad/s"],
    ["1.5 m", "0 m/s", "-0.54 m/s", "0 rad/s"],
    ["1.8 m", "0 m/s", "0 m/s", "0 rad/s"],
]"""
TUBE = """
[tube]
kind = "rod statics"
supports = [{ at = "first", fixed = "clamped" }, { at = "last", fixed = "pinned" }]
prescribed_displacements = [{ at = "last", dof = "x3", by = "-30 cm" }, { at = "last", dof = "x2", by = "10 cm" }]
gravity = { g = "9.81 m/s^2", along = "-E2" }
probes = [{ name = "middle", at = "50 %" }]
rod.energy = "consistent"
rod.vertices = 31
rod.length = "1 m"
rod.section = { shape = "tube", diameter = "12 mm", wall = "2.5 mm", shear_factor = "cowper" }
rod.material = { young = "2 MPa", poisson = 0.49, density = "1100 kg/m^3" }
"""


def solved(text, tmp_path, **rod):
    file = tmp_path / "mine.toml"
    file.write_text(text)
    (case,) = cosserat.load_cases(file).values()
    return cosserat.run(case.vary(case.name, rod=rod))


def pipe(diameter, wall, poisson):
    """Area, second moment and Cowper's factor of a round tube."""
    inner = diameter - 2 * wall
    m2 = (inner / diameter) ** 2
    factor = (
        6
        * (1 + poisson)
        * (1 + m2) ** 2
        / ((7 + 6 * poisson) * (1 + m2) ** 2 + (20 + 12 * poisson) * m2)
    )
    return np.pi / 4 * (diameter**2 - inner**2), np.pi / 64 * (diameter**4 - inner**4), factor


def test_a_mast_that_tapers_bends_as_the_integral_of_its_curvature_says(tmp_path):
    def section(at):
        return pipe(0.06 * (1 - at / 6), 0.003 * (1 - at / 6), 0.33)

    def turned(at):
        area, moment, factor = section(at)
        return (3 - at) ** 2 / (70e9 * moment) + 1 / (factor * 70e9 / 2.66 * area)

    right = -quad(turned, 0, 3)[0]
    errors = [
        solved(MAST, tmp_path, vertices=n).u.sel(axis="E2")[-1].item() / right - 1 for n in (21, 41)
    ]
    assert abs(errors[1]) < 1e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


def test_the_largest_stress_of_the_mast_is_not_at_its_clamp(tmp_path):
    """With a tip half as wide as the foot, (1 - s) / (1 - s / 2)^3 is largest at half the length."""
    data = solved(MAST, tmp_path, vertices=41)
    stress = data.fibre_stress.sel(surface="upper")
    where = data.xi_edge[int(stress.to_numpy().argmax())].item()
    assert where == pytest.approx(1.5, abs=3 / 40)
    _, moment, _ = pipe(0.045, 0.00225, 0.33)
    assert stress.max().item() == pytest.approx(1.5 * 0.0225 / moment, rel=2e-3)


def series(times, *, thrown, terms=150):
    """Displacement of the middle of the struck beam: sines of deflection and rotation of a Timoshenko beam.

    thrown : the weight and 30 cm of the beam on either side of it, less and less, move at the start; else a pulse.
    """
    length, young, density, height, width, flange, web = 3, 210e9, 7850, 0.2, 0.1, 0.0085, 0.0056
    area = 2 * width * flange + (height - 2 * flange) * web
    moment = (width * height**3 - (width - web) * (height - 2 * flange) ** 3) / 12
    shear = 0.38 * young / 2.6 * area
    odd = np.arange(1, 2 * terms, 2)
    a, middle, zero = odd * np.pi / length, np.sin(odd * np.pi / 2), np.zeros((terms, terms))
    coupling = np.diag(-shear * a)
    stiffness = np.block(
        [[np.diag(shear * a**2), coupling], [coupling, np.diag(shear + young * moment * a**2)]]
    )
    mass = density * np.diag(np.repeat([area, moment], terms))
    mass += 2 / length * 45 * np.block([[np.outer(middle, middle), zero], [zero, zero]])
    square, shapes = eigh(stiffness, mass)
    omega, seen = np.sqrt(square), middle @ shapes[:terms]
    if thrown:
        tent = 2 * (1 - np.cos(0.3 * a)) / (0.3 * a**2) * middle
        momentum = -0.54 * (density * area * tent + 45 * middle) @ shapes[:terms]
        return 2 / length * (seen * momentum / omega) @ np.sin(np.outer(omega, times))

    def stepped(since):
        return 1 - np.cos(np.outer(omega, np.maximum(since, 0)))

    return -24.3e3 * 2 / length * (seen**2 / square) @ (stepped(times) - stepped(times - 1e-3))


@pytest.mark.parametrize("thrown", [False, True])
def test_a_beam_struck_in_the_middle_moves_as_the_series_says(thrown, tmp_path):
    text, errors = re.sub("forces = .*", THROWN, DROP) if thrown else DROP, []
    for vertices, step in ((21, "50 us"), (41, "25 us")):
        data = solved(text.replace("50 us", step), tmp_path, vertices=vertices)
        right = series(data.time.to_numpy(), thrown=thrown)
        middle = data.u.sel(axis="E2")[:, vertices // 2].to_numpy()
        errors.append(np.abs(middle - right).max() / np.abs(right).max())
    assert errors[1] < 2e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.3)


@functools.cache
def sagging():
    """Middle of the tube, reaction of its second end, by the boundary value problem."""
    area, moment, factor = pipe(0.012, 0.0025, 0.49)
    stretch, bend, shear, weight = (
        2e6 * area,
        2e6 * moment,
        factor * 2e6 / 2.98 * area,
        1100 * area * 9.81,
    )

    def rates(s, y, end):
        angle, couple = y[2:]
        n = np.array([np.full_like(s, end[0]), end[1] + weight * (s - 1)])
        along, normal = (
            np.array([np.cos(angle), np.sin(angle)]),
            np.array([-np.sin(angle), np.cos(angle)]),
        )
        r = (1 + (n * along).sum(0) / stretch) * along + (n * normal).sum(0) / shear * normal
        return np.array([*r, couple / bend, r[1] * n[0] - r[0] * n[1]])

    def ends(first, last, _):
        return np.array([*first[:3], last[0] - 0.7, last[1] - 0.1, last[3]])

    s = np.linspace(0, 1, 60)
    guess = np.array(
        [
            0.7 * s,
            0.1 * s - 0.3 * np.sin(np.pi * s),
            2 * s - 1 + np.exp(-9 * s),
            3 * bend * np.sin(np.pi * s),
        ]
    )
    found = solve_bvp(rates, ends, s, guess, p=np.array([0.05, weight / 2]), tol=1e-8, max_nodes=9000)
    assert found.success
    return found.sol(0.5)[:2] - [0.5, 0], found.p


def test_a_rubber_tube_between_two_points_sags_as_the_boundary_value_problem_says(tmp_path):
    right, reaction = sagging()
    data = [solved(TUBE, tmp_path, vertices=n) for n in (31, 61)]
    errors = [np.linalg.norm(d.probe_displacement.sel(probe="middle") - right) for d in data]
    assert errors[1] < 1e-4
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)
    np.testing.assert_allclose(data[1].reaction_force.sel(support="last"), reaction, rtol=2e-3)
