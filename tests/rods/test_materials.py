"""Materials of a rod: any two moduli, mass per volume or per length."""

import itertools

import pytest

import cosserat
from cosserat.errors import InputError
from cosserat.rods.material import MODULI, Material

E, NU = 3.0, 0.27
VALUES = {
    "young": E,
    "poisson": NU,
    "shear_modulus": E / (2 * (1 + NU)),
    "bulk_modulus": E / (3 * (1 - 2 * NU)),
}


@pytest.mark.parametrize("pair", list(itertools.combinations(MODULI, 2)))
def test_any_two_moduli_are_the_same_material(pair):
    material = Material(**{key: VALUES[key] for key in pair}, density=2.0)
    assert material.moduli == pytest.approx((E, NU))
    assert material.mass_per_length(0.5) == 1.0


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"shear_modulus": 1e9}, "has 'young' and 'shear_modulus' and 'poisson'; give two of young"),
        ({"poisson": "none"}, "has 'young'; give two of young, shear_modulus, poisson, bulk_modulus"),
        ({"poisson": "none", "shear_modulus": 1e8}, "of a Poisson's ratio 4; it must be above -1 and"),
        ({"poisson": "none", "bulk_modulus": 1e8}, "of a Poisson's ratio -1.16667; it must be above -1"),
        ({"density": 1e3}, "has both a 'density' and a 'line_density'; give one of them"),
        ({"line_density": "none"}, "has neither a 'density' nor a 'line_density'; give one of them"),
        ({"shear_modulus": -1.0}, "'rod.material.shear_modulus' is -1 Pa; it must be above 0"),
        ({"bulk_modulus": "3 N"}, "'rod.material.bulk_modulus' is \"3 N\", in N"),
        ({"density": 0.0}, "'rod.material.density' is 0 kg/m\\^3; it must be above 0"),
    ],
)
def test_bad_input_is_answered_in_one_sentence(changes, sentence):
    with pytest.raises(InputError, match=sentence) as caught:
        cosserat.case("elastica").vary("x", rod={"material": changes})
    assert "\n" not in str(caught.value)


def test_a_beam_by_shear_and_bulk_modulus_is_that_by_young_and_poisson():
    by_two = {"young": "none", "poisson": "none", "shear_modulus": 4e8, "bulk_modulus": 8e8}
    case = cosserat.case("elastica").vary("x", rod={"vertices": 11, "material": by_two})
    young = 9 * 8e8 * 4e8 / (3 * 8e8 + 4e8)
    other = {"young": young, "poisson": young / 8e8 - 1}
    same = cosserat.case("elastica").vary("y", rod={"vertices": 11, "material": other})
    found, right = (cosserat.run(each).u.to_numpy() for each in (case, same))
    assert abs(found - right).max() < 1e-9
