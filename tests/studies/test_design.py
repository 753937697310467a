"""Designs against closed forms of their optima."""

import pytest
from scipy.optimize import brentq

import cosserat
from cosserat.errors import InputError, NotConvergedError

YOUNG, POISSON, DENSITY, FACTOR, LENGTH, FORCE, VERTICES = 2e9, 0.3, 1200.0, 0.8, 1.0, 0.1, 11
RANGES = {"rod.section.height": ("5 mm", "80 mm"), "rod.section.width": ("4 mm", "50 mm")}
LARGEST = 1e-5  # m, so small that the rod is linear


def cantilever(**section):
    """A cantilever under a force at its tip, its stiffness far from any optimum."""
    section = {"shape": "rectangle", "height": 0.06, "width": 0.03, "shear_factor": FACTOR} | section
    rod = {
        "vertices": VERTICES,
        "length": LENGTH,
        "section": section,
        "material": {"young": YOUNG, "poisson": POISSON, "line_density": "none", "density": DENSITY},
    }
    push = [{"at": "last", "along": "E2", "force": FORCE}]
    return cosserat.case("elastica").vary("cantilever", rod=rod, forces=push)


def deflection(height, width):
    """Timoshenko's tip of a rod of edges of length e: the trapezoidal rule for its angle takes e^2 / 4 L^2 off."""
    area, edge = height * width, LENGTH / (VERTICES - 1)
    bending = FORCE * LENGTH**3 / (3 * YOUNG * area * height**2 / 12) * (1 - edge**2 / (4 * LENGTH**2))
    return bending + FORCE * LENGTH / (FACTOR * YOUNG / (2 * (1 + POISSON)) * area)


def test_the_lightest_cantilever_is_as_narrow_as_allowed():
    """Stiffness goes with b h^3 and mass with b h: the width is at its lower bound, the height follows from the tip."""
    found = cosserat.design(
        cantilever(), RANGES, "total_mass.E3", subject_to={"u.E2 at last": (None, "10 um")}
    )
    height = brentq(lambda h: deflection(h, 0.004) - LARGEST, 0.005, 0.5, xtol=1e-15)
    assert height > 0.08  # so narrow it would be too high: then the height is at its upper bound
    width = brentq(lambda b: deflection(0.08, b) - LARGEST, 0.001, 0.05, xtol=1e-15)
    assert found["height"].item() == pytest.approx(0.08, rel=1e-9)
    assert found["width"].item() == pytest.approx(width, rel=1e-6)
    assert found["goal"].item() == pytest.approx(DENSITY * LENGTH * 0.08 * width, rel=1e-6)
    assert found["constraint_1"].item() == pytest.approx(LARGEST, rel=1e-6)
    assert found["constraint_1_price"].item() == pytest.approx(-found["goal"].item() / LARGEST, rel=1e-5)
    assert found.attrs["optimality"] < 1e-6


def test_an_equality_and_the_height_that_follows():
    found = cosserat.design(
        cantilever(height=0.03, width=0.02),
        {"rod.section.height": (0.005, 0.2), "rod.section.width": (0.004, 0.05)},
        "total_mass.E3",
        subject_to={"u.E2 at last": "10 um"},
    )
    height = brentq(lambda h: deflection(h, 0.004) - LARGEST, 0.005, 0.5, xtol=1e-15)
    assert found["width"].item() == pytest.approx(0.004, rel=1e-9)
    assert found["height"].item() == pytest.approx(height, rel=1e-6)


def test_the_stiffest_and_the_softest_rod_of_a_mass():
    case = cantilever()
    found = cosserat.design(
        case,
        RANGES,
        "u.E2 at last",
        subject_to={"total_mass.E3": (None, "1.2 kg")},
    )
    assert found["height"].item() == pytest.approx(0.08, rel=1e-9)
    assert found["width"].item() == pytest.approx(1.2 / (DENSITY * LENGTH * 0.08), rel=1e-7)
    most = cosserat.design(
        case, RANGES, maximise="u.E2 at last", subject_to={"total_mass.E3": ("1.2 kg", None)}
    )
    assert most["width"].item() == pytest.approx(0.05, rel=1e-9)
    assert most["height"].item() == pytest.approx(1.2 / (DENSITY * LENGTH * 0.05), rel=1e-7)


def test_an_optimum_inside_the_range_is_that_of_linear_least_squares():
    """Deflections of small forces add: the norm of a + f b is least for f = -a . b / b . b."""
    pushes = [{"at": "last", "along": "E2", "force": 0.1}, {"at": 5, "along": "E2", "force": 0.0}]
    case = cantilever().vary("two", forces=pushes)
    first, second = (
        cosserat.run(case.vary("one", forces=[{**pushes[0], "force": one}, {**pushes[1], "force": two}]))
        for one, two in ((0.1, 0.0), (0.0, 0.1))
    )
    a, b = (found["u"].sel(axis="E2").to_numpy() for found in (first, second))
    found = cosserat.design(case, {"forces.1.force": (-5.0, 5.0)}, "norm u.E2")
    assert found["force"].item() == pytest.approx(-0.1 * (a @ b) / (b @ b), rel=1e-5)


@pytest.mark.parametrize(
    ("arguments", "error", "said"),
    [
        (
            {"free": {"rod.section.height": None}, "minimise": "total_mass.E3"},
            InputError,
            "has no range",
        ),
        ({"free": RANGES}, InputError, "one of 'minimise' and 'maximise'"),
        (
            {"free": RANGES, "minimise": "total_mass.E3", "subject_to": {"u.E2 at last": (2.0, 1.0)}},
            InputError,
            "is empty",
        ),
        (
            {
                "free": RANGES,
                "minimise": "total_mass.E3",
                "subject_to": {"u.E2 at last": (None, "1 nm")},
            },
            NotConvergedError,
            "no values within the ranges",
        ),
    ],
)
def test_what_has_no_optimum_is_said_in_one_sentence(arguments, error, said):
    with pytest.raises(error, match=said):
        cosserat.design(cantilever(), **arguments)
