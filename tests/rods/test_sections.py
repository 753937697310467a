"""Sections of every shape: areas and moments by quadrature, shear factors, beams of one material, composite beams."""

import functools

import numpy as np
import pytest
from conftest import assembled
from outside import closed, published_energy, timoshenko
from scipy.integrate import quad

import cosserat
from cosserat.errors import InputError
from cosserat.rods.material import Material
from cosserat.rods.sections import SHAPES

STEEL = {"young": 210e9, "poisson": 0.3, "density": 7860.0}
CLAMP = [{"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}]
C = {"c1": 0.5, "c2": 0.4, "c3": 1.1, "c4": 1.9, "c5": 0.9, "c6": 0.6, "c7": 1.5}
DRAWN = {
    "rectangle": ({"height": 0.3, "width": 0.2}, [(0.0, 0.3, lambda y: 0.2)]),
    "square": ({"side": 0.2}, [(0.0, 0.2, lambda y: 0.2)]),
    "hollow rectangle": (
        {"height": 0.3, "width": 0.2, "wall": 0.02},
        [(0.0, 0.02, lambda y: 0.2), (0.02, 0.28, lambda y: 0.04), (0.28, 0.3, lambda y: 0.2)],
    ),
    "circle": ({"diameter": 0.3}, [(0.0, 0.3, lambda y: chord(y, 0.15, 0.15))]),
    "tube": (
        {"diameter": 0.3, "wall": 0.02},
        [
            (0.0, 0.02, lambda y: chord(y, 0.15, 0.15)),
            (0.02, 0.28, lambda y: chord(y, 0.15, 0.15) - chord(y - 0.02, 0.13, 0.13)),
            (0.28, 0.3, lambda y: chord(y, 0.15, 0.15)),
        ],
    ),
    "ellipse": ({"height": 0.3, "width": 0.1}, [(0.0, 0.3, lambda y: chord(y, 0.15, 0.05))]),
    "I": (
        {"height": 0.3, "width": 0.2, "flange": 0.03, "web": 0.01},
        [(0.0, 0.03, lambda y: 0.2), (0.03, 0.27, lambda y: 0.01), (0.27, 0.3, lambda y: 0.2)],
    ),
}
"""Lengths of each shape, and its width between heights above its lower surface."""
everywhere = pytest.mark.parametrize("shape", DRAWN)


def chord(y, half_height, half_width):
    """Width of an ellipse at a height above its lowest point."""
    return 2 * half_width * np.sqrt(max(0.0, 1 - (y / half_height - 1) ** 2))


def made(shape, factor=0.7, **lengths):
    return SHAPES[shape](shape=shape, shear_factor=factor, **(lengths or DRAWN[shape][0]))


def moment(shape, power, centre=0.0):
    """Integral of (y - centre)^power over a shape."""
    return sum(
        quad(lambda y, b=b: b(y) * (y - centre) ** power, low, high, epsabs=1e-14, epsrel=1e-11)[0]
        for low, high, b in DRAWN[shape][1]
    )


def beam(section, material=STEEL, like="elastica", **rod):
    """A cantilever of 2 m with this section."""
    if material is not None:
        material = dict.fromkeys(Material.model_fields) | material
    table = {"length": 2.0, "section": section, "material": material, **rod}
    return cosserat.case(like).vary("beam", rod=table, forces=[], supports=CLAMP)


def tip(case, force, along="E2"):
    """Displacement of the loaded end along a force [m]."""
    forces = [{"at": "last", "along": along, "force": force}]
    return float(cosserat.run(case.vary("pulled", forces=forces)).u.sel(axis=along)[-1])


def stiff(shape, factor=0.7):
    """EA, EI and kGA by quadrature."""
    area = moment(shape, 0)
    second = moment(shape, 2, moment(shape, 1) / area)
    return 210e9 * area, 210e9 * second, factor * 210e9 / 2.6 * area


# ---------------------------------------------------------------- areas, moments, shear factors


def test_every_shape_that_is_drawn_is_tested():
    assert set(SHAPES) - set(DRAWN) == {"given", "layers", "stiffnesses"}


@everywhere
def test_area_and_second_moment_are_the_integrals_over_the_shape(shape):
    section, area = made(shape), moment(shape, 0)
    middle = moment(shape, 1) / area
    assert section.area == pytest.approx(area, rel=1e-9)
    assert middle == pytest.approx(section.centre * section.height, rel=1e-9)
    assert section.second_moment == pytest.approx(moment(shape, 2, middle), rel=1e-8)
    spread = moment(shape, 2, middle) / area / section.height**2
    assert section.mass_spread == pytest.approx(spread, rel=1e-8)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5, -0.2])
def test_cowpers_factors_are_those_of_his_table(nu):
    """Cowper (1966), Table 1: full shapes as they are, thin walls in their limit."""
    assert made("rectangle").cowper(nu) == pytest.approx(10 * (1 + nu) / (12 + 11 * nu))
    assert made("square").cowper(nu) == made("rectangle").cowper(nu)
    assert made("circle").cowper(nu) == pytest.approx(6 * (1 + nu) / (7 + 6 * nu))
    assert made("ellipse", height=0.2, width=0.2).cowper(nu) == pytest.approx(made("circle").cowper(nu))
    thin = made("tube", diameter=1.0, wall=1e-7)
    assert thin.cowper(nu) == pytest.approx(2 * (1 + nu) / (4 + 3 * nu), rel=1e-6)
    thick = made("tube", diameter=1.0, wall=0.5 - 1e-7)
    assert thick.cowper(nu) == pytest.approx(made("circle").cowper(nu), rel=1e-6)
    box = made("hollow rectangle", height=1.0, width=1.0, wall=1e-7)
    assert box.cowper(nu) == pytest.approx(20 * (1 + nu) / (48 + 39 * nu), rel=1e-6)
    web = made("I", height=1.0, width=0.1, flange=1e-9, web=0.1)
    assert web.cowper(nu) == pytest.approx(made("rectangle").cowper(nu), rel=1e-6)


def test_cowpers_factors_for_steel():
    """To the digits of his Table 2 for nu = 0.3: circle, square, thin tube."""
    found = [
        made("circle").cowper(0.3),
        made("square").cowper(0.3),
        made("tube", diameter=1.0, wall=1e-7).cowper(0.3),
    ]
    np.testing.assert_allclose(found, [0.886, 0.850, 0.531], atol=5e-4)


@pytest.mark.parametrize("wide", [0.3, 1.0, 2.0])
def test_without_contraction_thin_walls_have_the_factor_of_their_shear_flow(wide):
    """1/k = A / I^2 times the integral of Q^2 / t along the walls, to which Cowper's comes down at nu = 0."""
    high, t, f = 1.0, 1e-6, 2e-6

    def factor(walls, area, second):
        return (
            second**2
            / area
            / sum(quad(lambda s, Q=Q: Q(s) ** 2, *ends)[0] / wall for Q, ends, wall in walls)
        )

    flanges = [(lambda s: f * high / 2 * s, (0, wide / 2), f)] * 4
    web = (lambda y: wide * f * high / 2 + t * (high**2 / 4 - y**2) / 2, (-high / 2, high / 2), t)
    area, second = 2 * wide * f + high * t, wide * f * high**2 / 2 + t * high**3 / 12
    section = made("I", height=high + f, width=wide, flange=f, web=t)
    assert section.cowper(0.0) == pytest.approx(factor([*flanges, web], area, second), rel=1e-5)

    flanges = [(lambda s: t * high / 2 * s, (0, wide / 2), t)] * 4
    web = (lambda y: wide * t * high / 4 + t * (high**2 / 4 - y**2) / 2, (-high / 2, high / 2), t)
    area, second = 2 * t * (wide + high), wide * t * high**2 / 2 + t * high**3 / 6
    section = made("hollow rectangle", height=high + t, width=wide + t, wall=t)
    assert section.cowper(0.0) == pytest.approx(factor([*flanges, web, web], area, second), rel=1e-5)


def test_a_narrow_ellipse_without_contraction_has_the_factor_of_its_shear_stresses():
    """As narrow walls have: tau goes as 1 - (2 y / H)^2, which makes 9/10."""
    assert made("ellipse", height=1.0, width=1e-6).cowper(0.0) == pytest.approx(0.9, rel=1e-9)


# ---------------------------------------------------------------- beams of one material


@everywhere
def test_a_cantilever_bends_shears_and_stretches_as_closed_forms_say(shape):
    """P L^3 / 3 EI + P L / kGA and n L / EA, the consistent rod at second order."""
    EA, EI, GA = stiff(shape)
    right, errors = 2.0**3 / (3 * EI) + 2.0 / GA, []
    for vertices in (6, 11, 21):
        case = beam(made(shape).model_dump(), vertices=vertices)
        errors.append(tip(case, 1.0) / right - 1)
    assert abs(errors[-1]) < 1e-3
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2, atol=0.05)
    free = [{"at": "first", "fixed": ["x3", "x2", "d3"]}]
    assert tip(case.vary("free", supports=free), 1.0, "E3") == pytest.approx(2.0 / EA, rel=1e-6)


@everywhere
@pytest.mark.parametrize("constraint", ["free", "plane strain"])
def test_a_pulled_rod_of_any_shape_thins_by_its_poissons_ratio(shape, constraint):
    case = beam(made(shape).model_dump(), vertices=5, lateral_constraint=constraint).vary(
        "pulled",
        supports=[{"at": "first", "fixed": ["x3", "x2", "d3"]}],
        forces=[{"at": "last", "along": "E3", "force": 1.0}],
    )
    data, EA = cosserat.run(case), stiff(shape)[0]
    plane = 1 - 0.3**2 if constraint == "plane strain" else 1.0
    ratio = 0.3 / 0.7 if constraint == "plane strain" else 0.3
    assert float(data.u.sel(axis="E3")[-1]) == pytest.approx(2 * plane / EA, rel=1e-6)
    np.testing.assert_allclose(data.lam - 1, -ratio * plane / EA, rtol=1e-5)


@everywhere
def test_the_published_energy_of_any_shape_is_that_of_independent_code(shape):
    """Written for rectangles: that of the same A and I, its directors drawn out to the height of the shape."""
    rod = beam(
        made(shape).model_dump(), like="clamped_free", vertices=6, calibration=C, stations=[]
    ).problem.rod
    EA, EI, GA = stiff(shape)
    high = np.sqrt(12 * EI / EA)
    other = published_energy.Beam(
        6, 2.0, high, EA / 210e9 / high, 210e9, 0.3, 1.0, GA / (EA / 2.6), tuple(C.values())
    )
    rng = np.random.default_rng(4)
    x, d = other.reference
    x = x + 0.02 * rng.uniform(-1, 1, (2, 6)).T @ [1, 1j]
    d = d * (1 + 0.2 * rng.uniform(-1, 1, (2, 6)).T @ [1, 1j])
    scale = rod.height / high
    q = np.column_stack([x.real, x.imag, scale * d.real, scale * d.imag]).ravel()
    body = rod.strain_energy.potential(rod, rod.geometry())
    found = np.zeros(24)
    assert body.add_gradient(q, body.history, found) == pytest.approx(
        published_energy.energy(other, x, d), rel=1e-7
    )
    by_x, by_d = published_energy.gradient(other, x, d)
    right = np.column_stack([by_x.real, by_x.imag, by_d.real / scale, by_d.imag / scale]).ravel()
    np.testing.assert_allclose(found, right, atol=1e-7 * np.abs(right).max())


@everywhere
@pytest.mark.parametrize("like", ["elastica", "clamped_free"])
def test_a_section_that_turns_has_the_inertia_of_its_material(like, shape):
    """Kinetic energy of a turn about the centreline at 0.3 of the height, by quadrature."""
    rod = beam(made(shape).model_dump(), like=like, vertices=4, centreline=0.3).problem.rod
    band = rod.mass(rod.geometry())
    turning = np.zeros(16)
    turning[2::4] = rod.geometry().director_length
    total = sum(
        (1 if k == 0 else 2) * band[i, k] * turning[i] * turning[i + k]
        for i in range(16)
        for k in range(min(band.shape[1], 16 - i))
    )
    assert total == pytest.approx(7860 * 2.0 * moment(shape, 2, 0.3 * rod.height), rel=1e-7)


@pytest.mark.parametrize("centreline", [0.1, 0.5, 0.9])
def test_a_tube_bends_alike_whichever_line_of_it_is_followed(centreline):
    """By a couple: M L^2 / 2 EI.  A force off the area centre would stretch the section where it acts."""
    couples = [{"at": "last", "moment": 1.0}]
    case = beam(made("tube").model_dump(), vertices=11, centreline=centreline)
    found = cosserat.run(case.vary("turned", couples=couples)).u.sel(axis="E2")[-1]
    assert float(found) == pytest.approx(4 / (2 * stiff("tube")[1]), rel=1e-6)


@pytest.mark.parametrize(
    ("shape", "stations"),
    [
        ("tube", [(0.0, 1.0), (2.0, 0.4)]),
        ("circle", [(0.3, 1.2), (1.13, 0.6), (1.13, 0.9), (1.7, 0.5)]),
        ("I", [(0.0, 1.0), (1.13, 1.0), (1.13, 0.5)]),
    ],
)
def test_tapers_and_steps_are_of_second_order(shape, stations):
    """Heights and widths alike; a step and kinks inside edges, at the same share of an edge of both meshes."""
    _, EI, GA = stiff(shape)
    places, factors = zip(*stations, strict=True)

    def scale(s):
        after = [k for k, place in enumerate(places) if place <= s]
        if not after:
            return factors[0]
        k = after[-1]
        if k == len(places) - 1:
            return factors[-1]
        return factors[k] + (factors[k + 1] - factors[k]) * (s - places[k]) / (places[k + 1] - places[k])

    right = closed.cantilever_tip(
        1.0, 2.0, lambda s: EI * scale(s) ** 4, lambda s: GA * scale(s) ** 2, [*places]
    )
    table = [{"at": at, "height": factor, "width": factor} for at, factor in stations]
    errors = [
        tip(beam(made(shape).model_dump(), stations=table, vertices=n), 1.0) / right - 1
        for n in (11, 41, 161)
    ]
    orders = np.log2(np.abs(np.array(errors[:-1]) / errors[1:])) / 2
    assert orders[-1] == pytest.approx(2, abs=0.15), (orders, errors)
    assert abs(errors[-1]) < 1e-3


def test_cowpers_factor_follows_poissons_ratio_along_a_rod():
    """Half of the rod has half the ratio: shear compliances of both halves, by the formula of the circle."""
    stations = [{"at": 1.0}, {"at": 1.0, "poisson": 0.5}]
    section = {"shape": "circle", "diameter": 1.0, "shear_factor": "cowper"}
    rod = beam(section, vertices=5, stations=stations).problem.rod
    for like, nu in ((0, 0.3), (3, 0.15)):
        k, G = 6 * (1 + nu) / (7 + 6 * nu), 210e9 / (2 * (1 + nu))
        body = rod.strain_energy.potential(rod, rod.geometry())
        assert body.constants["k_shear"][like] == pytest.approx(k * G * np.pi / 4)


TOWER = """
[tower]
like = "elastica"
gravity = { g = "9.80665 m/s^2", along = "-E3" }
forces = []
rod.length = "30 m"
rod.vertices = 31
rod.section = { shape = "tube", diameter = "3 m", wall = "0.1 m", shear_factor = 0.53 }
rod.material = { young = "210 GPa", poisson = 0.3, density = "7860 kg/m^3", line_density = "none" }
"""


def test_a_tower_of_steel_in_a_few_lines(tmp_path):
    """OpenFAST #2325: weight, and two frequencies against transfer matrices of the tube."""
    (tmp_path / "tower.toml").write_text(TOWER)
    case = cosserat.case("tower", tmp_path / "tower.toml")
    area = np.pi * (1.5**2 - 1.4**2)
    second = np.pi / 4 * (1.5**4 - 1.4**4)
    m = 7860 * area
    base = cosserat.run(case).support_force.sel(dof="x3").isel(vertex=0)
    assert float(base) == pytest.approx(m * 30 * 9.80665, rel=1e-9)
    piece = timoshenko.Piece(30.0, 210e9 * second, 0.53 * 210e9 / 2.6 * area, m, 7860 * second)
    right = timoshenko.frequencies([piece], 2)
    np.testing.assert_allclose(right, [3.2457, 18.691], rtol=3e-4)
    errors = []
    for vertices in (16, 31, 61):
        bare = case.vary("bare", gravity=None, rod={"vertices": vertices}).problem
        errors.append(bare.modes(2).angular_frequency / (2 * np.pi) / right - 1)
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2, atol=0.1)
    assert (np.abs(errors[-1]) < 3e-4).all()


# ---------------------------------------------------------------- composite beams

SOFT = {"young": 2e9, "poisson": 0.4, "density": 1100.0}
HARD = {"young": 70e9, "poisson": 0.2, "density": 2700.0}


def layers(*given, **section):
    return {
        "shape": "layers",
        "layers": [{"thickness": t, "width": b, "material": m} for t, b, m in given],
        **section,
    }


TWO = layers((0.03, 0.05, HARD), (0.05, 0.02, SOFT), shear_factor=0.8)


def two_layers():
    """EA, EI, kGA and height of the elastic centre: the textbook's transformed section."""
    (E1, b1, t1), (E2, b2, t2) = (70e9, 0.05, 0.03), (2e9, 0.02, 0.05)
    EA = E1 * b1 * t1 + E2 * b2 * t2
    both = 2 * E1 * E2 * b1 * b2 * t1 * t2 * (2 * t1**2 + 3 * t1 * t2 + 2 * t2**2)
    EI = (E1**2 * b1**2 * t1**4 + E2**2 * b2**2 * t2**4 + both) / (12 * EA)
    GA = 0.8 * (70e9 / 2.4 * b1 * t1 + 2e9 / 2.8 * b2 * t2)
    return EA, EI, GA, (E1 * b1 * t1 * t1 / 2 + E2 * b2 * t2 * (t1 + t2 / 2)) / EA


def test_a_beam_of_two_layers_bends_and_stretches_as_the_transformed_section():
    EA, EI, GA, middle = two_layers()
    case = beam(TWO, None, vertices=41, centreline=middle / 0.08)
    assert tip(case, 1.0) == pytest.approx(8 / (3 * EI) + 2 / GA, rel=3e-4)
    supports = [{"at": "first", "fixed": ["x3", "x2", "d3"]}]
    pull = [{"at": "last", "along": "E3", "force": 1.0}]
    data = cosserat.run(case.vary("pulled", supports=supports, forces=pull))
    assert float(data.u.sel(axis="E3")[-1]) == pytest.approx(2 / EA, rel=1e-6)
    assert abs(float(data.u.sel(axis="E2")[-1])) < 1e-6 * 2 / EA
    contraction = (0.03 * 0.2 + 0.05 * 0.4) / 0.08 / EA
    np.testing.assert_allclose(data.lam - 1, -contraction, rtol=1e-5)


def test_a_beam_of_two_layers_pulled_along_another_line_bends():
    """A pull at the middle of the height has the arm from there to the elastic centre."""
    _, EI, _, middle = two_layers()
    case = beam(TWO, None, vertices=21)
    found = cosserat.run(case.vary("pulled", forces=[{"at": "last", "along": "E3", "force": 1e-3}]))
    arm = 0.04 - middle
    d = found.d.isel(vertex=-1).to_numpy()
    assert np.arctan2(-d[0], d[1]) == pytest.approx(-1e-3 * arm * 2 / EI, rel=1e-6)


def test_masses_of_layers_are_about_their_own_centre():
    """Mass, first and second moment about the centreline, by integrals over the layers."""
    rod = beam(TWO, None, vertices=4, centreline=0.3).problem.rod
    line, length = 0.3 * 0.08, 0.7 * 0.08
    density = [(0.0, 0.03, 2700 * 0.05), (0.03, 0.08, 1100 * 0.02)]
    m = [
        sum(w * quad(lambda y, p=p: ((y - line) / length) ** p, a, b)[0] for a, b, w in density)
        for p in range(3)
    ]
    assert rod.line_density == pytest.approx(m[0])
    assert pytest.approx(m[1] / m[0]) == rod.Y02
    assert pytest.approx(m[2] / m[0]) == rod.Y22


def test_section_stretches_of_layers_are_least_energy():
    """Energy of free stretches of each layer with a given mean, minimised without the closed form."""
    e, w = 0.3, -0.5
    E, nu, t, b = (np.array(v) for v in ((70e9, 2e9), (0.2, 0.4), (0.03, 0.05), (0.05, 0.02)))
    c, A, share = E / (1 - nu**2), b * t, t / t.sum()

    def energy(first):
        own = np.array([first, (w - share[0] * first) / share[1]])
        return float(A * c @ (e**2 + 2 * nu * e * own + own**2)) / 2

    values = [energy(s) for s in (-1.0, 0.0, 1.0)]  # a parabola, whose lowest value follows
    a2, a1 = (values[0] + values[2]) / 2 - values[1], (values[2] - values[0]) / 2
    least = values[1] - a1**2 / (4 * a2)
    k = beam(TWO, None).problem.rod.elastic
    assert (k.axial * e**2 + k.volume * (e + w) ** 2 + k.section * w**2) / 2 == pytest.approx(least)
    assert k.pulled == pytest.approx(float(E @ A))


def test_jourawskis_factor_of_like_layers_is_five_sixths_and_that_of_a_sandwich_an_integral():
    plain = layers((0.02, 0.05, HARD), (0.07, 0.05, HARD))
    G = 70e9 / 2.4
    assert beam(plain, None).problem.rod.elastic.shear == pytest.approx(5 / 6 * G * 0.09 * 0.05)
    sandwich = layers((0.004, 0.05, HARD), (0.05, 0.05, SOFT), (0.004, 0.05, HARD))
    found = beam(sandwich, None).problem.rod.elastic

    def young(y):
        return 2e9 if abs(y) < 0.025 else 70e9

    EI = quad(lambda y: 0.05 * young(y) * y**2, -0.029, 0.029, points=[-0.025, 0.025])[0]
    assert found.bending == pytest.approx(EI)

    def density(y):
        points = [0.025] if abs(y) < 0.025 else None
        Q = quad(lambda z: 0.05 * young(z) * z, abs(y), 0.029, points=points)[0]
        shear = 2e9 / 2.8 if abs(y) < 0.025 else G
        return Q**2 / (EI**2 * shear * 0.05)

    compliance = 2 * (quad(density, 0, 0.025)[0] + quad(density, 0.025, 0.029)[0])
    assert found.shear == pytest.approx(1 / compliance)
    average = 0.05 * (0.05 * 2e9 / 2.8 + 0.008 * G)
    assert found.shear < 0.2 * average


GIVEN = {
    "shape": "stiffnesses",
    "axial_stiffness": 4e6,
    "bending_stiffness": 900.0,
    "shear_stiffness": 1.1e6,
    "height": 0.06,
}


def test_given_stiffnesses_bend_and_stretch_a_beam():
    case = beam(GIVEN, {"line_density": 3.0}, vertices=41)
    assert tip(case, 1e-3) == pytest.approx(1e-3 * (8 / 2700 + 2 / 1.1e6), rel=3e-4)
    assert tip(case, 1.0, "E3") == pytest.approx(2 / 4e6, rel=1e-6)
    rod = case.problem.rod
    assert rod.Y22 * rod.height**2 / 4 == pytest.approx(900 / 4e6)
    other = case.vary("heavy", rod={"section": {"gyration": 0.02}}).problem.rod
    assert other.Y22 * other.height**2 / 4 == pytest.approx(0.02**2)


def test_given_stiffnesses_of_one_material_are_its_rod():
    """Their defaults complete EA, EI, kGA and nu to the rod of a given A and I, at any state and any taper."""
    area, second, E, nu = 2e-3, 4e-7, 1e9, 0.3
    given = {
        "shape": "given",
        "area": area,
        "second_moment": second,
        "height": 0.06,
        "shear_factor": 0.6,
    }
    stiffnesses = {
        "shape": "stiffnesses",
        "axial_stiffness": E * area,
        "bending_stiffness": E * second,
        "shear_stiffness": 0.6 * E / 2.6 * area,
        "poisson": nu,
        "height": 0.06,
    }
    shared = {
        "vertices": 5,
        "centreline": 0.4,
        "stations": [{"at": 0.0}, {"at": 1.2, "height": 0.5, "width": 2.0, "young": 0.7}],
    }
    one = beam(given, {"young": E, "poisson": nu, "line_density": 2.0}, **shared).problem.rod
    two = beam(stiffnesses, {"line_density": 2.0}, **shared).problem.rod
    q = one.geometry().q + 5e-3 * np.random.default_rng(1).uniform(-1, 1, 20)
    found, right = (assembled(r.strain_energy.potential(r, r.geometry()), q) for r in (two, one))
    for mine, theirs in zip(found, right, strict=True):
        np.testing.assert_allclose(mine, theirs, rtol=1e-9, atol=1e-9 * np.abs(theirs).max())
    np.testing.assert_allclose(two.mass(two.geometry()), one.mass(one.geometry()), rtol=1e-12)


# ---------------------------------------------------------------- bad input


@functools.cache
def table_of(name):
    return {
        "circle": {"shape": "circle", "diameter": 0.1, "shear_factor": 0.9},
        "tube": {"shape": "tube", "diameter": 0.1, "wall": 0.01, "shear_factor": 0.5},
        "I": {**DRAWN["I"][0], "shape": "I", "shear_factor": 0.5},
        "ellipse": {**DRAWN["ellipse"][0], "shape": "ellipse", "shear_factor": "cowper"},
        "hollow": {**DRAWN["hollow rectangle"][0], "shape": "hollow rectangle", "shear_factor": 0.4},
        "given": {
            "shape": "given",
            "area": 1e-2,
            "second_moment": 1e-5,
            "height": 0.1,
            "shear_factor": 1,
        },
        "layers": TWO,
        "stiffnesses": GIVEN,
    }[name]


WIDER = [{"at": 0.0}, {"at": 1.0, "width": 2.0}]


@pytest.mark.parametrize(
    ("name", "section", "rod", "sentence"),
    [
        ("tube", {"wall": 0.05}, {}, "'wall' is 0.05 m; it must be below half the diameter, 0.05 m"),
        ("hollow", {"wall": 0.11}, {}, "'wall' is 0.11 m; it must be below half the width, 0.1 m"),
        ("I", {"flange": 0.15}, {}, "'flange' is 0.15 m; it must be below half the height, 0.15 m"),
        ("I", {"web": 0.3}, {}, "'web' is 0.3 m; it must be at most the width, 0.2 m"),
        ("circle", {"shear_factor": 0}, {}, "'rod.section.shear_factor' is 0; it must be above 0"),
        ("circle", {"shear_factor": "timoshenko"}, {}, "is 'timoshenko'; it must be a number above 0"),
        ("circle", {"height": 1.0}, {}, "'rod.section.height' is not a key; known are: shape"),
        ("circle", {}, {"stations": WIDER}, "but a circle keeps its proportions; give both the same"),
        ("tube", {}, {"stations": WIDER}, "height = 1 and width = 2 at 1 m, but a tube keeps"),
        ("ellipse", {}, {"stations": WIDER}, "but a shear_factor of 'cowper' keeps its proportions"),
        ("given", {"second_moment": 1e-4}, {}, "it must be at most 2.5e-05 m\\^4, that of this area"),
        ("given", {"shear_factor": "cowper"}, {}, "shape = 'given' has no such factor; give a number"),
        ("circle", {}, {"material": None}, "has no 'material'; write a table with two of its moduli"),
        ("circle", {}, {"material": {"density": 1.0}}, "has a 'material' with no modulus; give two of"),
        ("layers", {}, {"material": STEEL}, "has a 'material' beside the layers, which have their own"),
        ("layers", {"layers": []}, {}, "'layers' is empty; give at least one"),
        ("layers", {"shear_factor": "cowper"}, {}, "is 'cowper'; it must be a number above 0"),
        ("layers", {}, {"lateral_constraint": "plane strain"}, "shape = 'layers' contracts freely"),
        ("layers", {}, {"stations": [{"at": 0, "poisson": 0.9}]}, "has no single Poisson's ratio"),
        ("layers", {}, {"energy": "published", "calibration": C}, "shape = 'layers', whose stiffnesses"),
        ("stiffnesses", {}, {"material": STEEL}, "whose 'material' has a 'line_density' and nothing"),
        ("stiffnesses", {"poisson": 0.5}, {}, "'rod.section.poisson' is 0.5; it must be below 0.5"),
        ("stiffnesses", {"height": 0.01}, {}, "radius of gyration 0.015 m above half its height 0.01"),
        (
            "stiffnesses",
            {"poisson": 0.4, "section_stiffness": 2e7},
            {},
            "'section_stiffness' is 2e\\+07 N; with this 'poisson' and 'axial_stiffness' it must be below",
        ),
        ("stiffnesses", {}, {"energy": "published", "calibration": C}, "shape = 'stiffnesses', whose"),
    ],
)
def test_bad_input_of_a_section_is_answered_in_one_sentence(name, section, rod, sentence):
    material = {"layers": None, "stiffnesses": {"line_density": 1.0}}.get(name, STEEL)
    with pytest.raises(InputError, match=sentence) as caught:
        beam({**table_of(name), **section}, **{"material": material, **rod})
    assert "\n" not in str(caught.value)


def test_a_layer_needs_its_own_material():
    with pytest.raises(InputError, match="with no modulus; give two of"):
        beam(layers((0.1, 0.1, {"density": 1.0})), None)
    with pytest.raises(InputError, match="has neither a 'density' nor"):
        beam(layers((0.1, 0.1, {"young": 1e9, "poisson": 0.3})), None)


@pytest.mark.parametrize(
    "name", ["young", "poisson", "area", "second_moment", "shear_correction", "width"]
)
def test_what_a_section_without_a_single_material_lacks_is_said(name):
    rod = beam(GIVEN, {"line_density": 1.0}).problem.rod
    with pytest.raises(InputError, match="shape = 'stiffnesses' has no"):
        getattr(rod, name)


def test_another_shape_replaces_an_inherited_section_as_a_whole(tmp_path):
    (tmp_path / "my.toml").write_text(
        '[a]\nlike = "elastica"\n'
        'rod.section = { shape = "circle", diameter = "1 cm", shear_factor = "cowper" }\n'
        '[b]\nlike = "a"\nrod.section.diameter = "2 cm"\n'
        '[c]\nlike = "b"\nrod.section = { shape = "tube", diameter = "2 cm", wall = "1 mm" }\n'
    )
    cases = [cosserat.case(name, tmp_path / "my.toml") if name != "c" else None for name in "ab"]
    assert [case.problem.rod.height for case in cases] == [0.01, 0.02]
    with pytest.raises(InputError, match="'rod.section.shear_factor' is missing"):
        cosserat.case("c", tmp_path / "my.toml")


def test_results_of_composite_rods_are_read_again(tmp_path):
    case = beam(TWO, None, vertices=5)
    cosserat.save(cosserat.run(case), tmp_path / "a.nc")
    from cosserat.data.dataset import case_of

    assert case_of(cosserat.load(tmp_path / "a.nc")).problem == case.problem
