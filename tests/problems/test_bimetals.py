"""Heated layers of several materials against Timoshenko's bimetal, and against the least energy of single fibres."""

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError

LENGTH, WIDTH = 0.1, 0.01
BRASS = {"young": 100e9, "poisson": 0.33, "density": 8500.0, "expansion": 19e-6}
INVAR = {"young": 145e9, "poisson": 0.28, "density": 8100.0, "expansion": 1.2e-6}
CLAMP = [{"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}]


def strip(layers, temperatures, supports=CLAMP, **rod):
    """A clamped strip of layers (thickness, material) from the lower surface, under nothing but its temperatures."""
    section = {
        "shape": "layers",
        "layers": [{"thickness": t, "width": WIDTH, "material": material} for t, material in layers],
    }
    given = {"length": LENGTH, "vertices": 41, "section": section, "material": "none"}
    return cosserat.case("elastica").vary(
        "strip", forces=[], temperatures=temperatures, supports=supports, rod=given | rod
    )


def timoshenko(lower, upper, change):
    """Curvature by Timoshenko (1925), towards the upper layer if the lower one expands more."""
    (t1, one), (t2, two) = lower, upper
    m, n, h = t1 / t2, one["young"] / two["young"], t1 + t2
    return (
        6
        * (one["expansion"] - two["expansion"])
        * change
        * (1 + m) ** 2
        / (h * (3 * (1 + m) ** 2 + (1 + m * n) * (m**2 + 1 / (m * n))))
    )


@pytest.mark.parametrize(
    ("lower", "upper"),
    [((0.5e-3, BRASS), (0.5e-3, INVAR)), ((0.8e-3, INVAR), (0.3e-3, BRASS))],
)
def test_a_bimetal_bends_as_timoshenko_says(lower, upper):
    """Without stress resultants the strip is an arc of a circle; 80 K roll it by a third of a radian and more."""
    data = cosserat.run(strip([lower, upper], [{"change": 80.0}]))
    curvature = timoshenko(lower, upper, 80.0)
    assert abs(curvature * LENGTH) > 0.1
    turns = np.diff(data.rotation.to_numpy())
    np.testing.assert_allclose(turns, curvature * LENGTH / 40, rtol=2e-4)


def least_energy(layers, change, gradient, height_scale=1.0):
    """Axial strain, curvature and mean stretch at which fibres of all layers, free to contract, have least energy.

    A fibre at y has the strain e - kappa y less its own expansion; a layer the stretch w_i less its own.
    """
    t = height_scale * np.array([t for t, _ in layers])
    E, nu, a = np.array([[m["young"], m["poisson"], m["expansion"]] for _, m in layers]).T
    bottom = np.concatenate([[0], np.cumsum(t)[:-1]])
    nodes, weights = np.polynomial.legendre.leggauss(4)
    y = bottom[:, None] + t[:, None] * (nodes + 1) / 2
    w = t[:, None] * weights / 2
    centre = (E[:, None] * w * y).sum() / (E[:, None] * w).sum()
    y = y - centre
    own = a[:, None] * (change + gradient * y)
    design = np.column_stack([np.ones(y.size), -y.ravel()]) * np.sqrt(E[:, None] * w).ravel()[:, None]
    (e, kappa), *_ = np.linalg.lstsq(design, (own * np.sqrt(E[:, None] * w)).ravel(), rcond=None)
    middle = (w * y).sum(axis=1) / t
    free = a * (change + gradient * middle)
    stretch = free - nu * (e - free)  # a layer that carries no lateral stress
    return e, kappa, (t / t.sum() * stretch).sum()


LAYERS = [(0.3e-3, BRASS), (0.5e-3, INVAR), (0.2e-3, BRASS | {"expansion": 30e-6})]


@pytest.mark.parametrize(("change", "gradient"), [(2.0, 0.0), (0.0, 3e3), (1.5, -4e3)])
def test_layers_are_at_rest_where_single_fibres_have_least_energy(change, gradient):
    data = cosserat.run(strip(LAYERS, [{"change": change, "gradient": gradient}]))
    e, kappa, stretch = least_energy(LAYERS, change, gradient)
    np.testing.assert_allclose(np.diff(data.rotation), kappa * LENGTH / 40, rtol=1e-5)
    inside = data.lam.isel(vertex=slice(15, -1)).to_numpy()  # away from the bonded clamp
    np.testing.assert_allclose(inside - 1, stretch, rtol=1e-3)
    far = float(data.x.sel(axis="E3")[-1])
    arc = 2 * np.sin(kappa * LENGTH / 2) / kappa * (1 + e)
    assert np.hypot(far, float(data.x.sel(axis="E2")[-1])) == pytest.approx(arc, rel=1e-6)


def test_a_taper_changes_the_curvature_of_a_change_but_not_that_of_a_gradient():
    half = [{"at": 0.0, "height": 0.5}]
    for change, gradient in ((2.0, 0.0), (0.0, 3e3)):
        data = cosserat.run(strip(LAYERS, [{"change": change, "gradient": gradient}], stations=half))
        kappa = least_energy(LAYERS, change, gradient, height_scale=0.5)[1]
        np.testing.assert_allclose(np.diff(data.rotation), kappa * LENGTH / 40, rtol=1e-5)


def test_a_bimetal_between_clamps_pushes_by_the_sum_of_its_layers():
    """Straight between clamps in which the sections can stretch: N = -sum E A alpha T."""
    walls = [{"at": end, "fixed": ["x3", "x2", "d3"]} for end in ("first", "last")]
    layers = [(0.5e-3, BRASS), (0.5e-3, INVAR)]
    data = cosserat.run(strip(layers, [{"change": 1.0}], supports=walls))
    push = sum(m["young"] * t * WIDTH * m["expansion"] for t, m in layers)
    assert float(data.normal_force.isel(edge=20)) == pytest.approx(-push, rel=1e-6)


def test_a_material_brings_its_coefficient_and_a_load_may_have_its_own():
    def run(material, load):
        rod = {"material": {"young": 1e8, "poisson": 0.3} | material}
        case = cosserat.case("elastica").vary("x", forces=[], temperatures=[load], rod=rod)
        return float(cosserat.run(case).u[-1, 0])

    own = run({"expansion": 2e-5}, {"change": 10.0})
    assert own == pytest.approx(run({}, {"change": 10.0, "expansion": 2e-5}), rel=1e-12)
    assert run({"expansion": 1.0}, {"change": 10.0, "expansion": 2e-5}) == pytest.approx(own, rel=1e-12)


def test_a_missing_coefficient_is_named_with_its_layer():
    bare = {key: value for key, value in INVAR.items() if key != "expansion"}
    with pytest.raises(InputError, match=r"'rod\.section\.layers\.1\.material' has none either"):
        strip([(1e-3, BRASS), (1e-3, bare)], [{"change": 1.0}])
    given = {
        "shape": "stiffnesses",
        "axial_stiffness": 1e5,
        "bending_stiffness": 1.0,
        "shear_stiffness": 3e4,
        "height": 0.01,
    }
    with pytest.raises(InputError, match="a section with shape = 'stiffnesses' has none either"):
        cosserat.case("elastica").vary(
            "x",
            forces=[],
            temperatures=[{"change": 1.0}],
            rod={
                "section": given,
                "material": {"young": "none", "poisson": "none", "line_density": 1.0},
            },
        )
