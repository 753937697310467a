"""Equilibria for columns of values: the bits of single runs, members that are left, and values out of range."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from pydantic_core import PydanticCustomError

import cosserat
from cosserat.errors import InputError
from cosserat.problems.columns import in_range
from cosserat.problems.many import members_of, solve_many
from cosserat.quantities import Quantity

SLENDER = {"vertices": 9}
ROUND = {
    "shape": "circle",
    "diameter": 0.01,
    "shear_factor": "cowper",
    "height": "none",
    "width": "none",
}
OVAL = {"shape": "ellipse", "shear_factor": "cowper", "height": 0.01, "width": 0.01}
LINE = [{"along": "-E2", "density": 1.0}]
FAMILIES = {
    "force": ("elastica", {"rod": SLENDER}, {"forces.0.force": (0.5, 4.6)}),
    "moduli": (
        "elastica",
        {"rod": SLENDER},
        {"rod.material.young": (9e8, 1.1e9), "rod.material.poisson": (0.1, 0.4)},
    ),
    "rectangle": (
        "elastica",
        {"rod": SLENDER},
        {"rod.section.height": (0.008, 0.011), "rod.section.width": (0.008, 0.011)},
    ),
    "circle": (
        "elastica",
        {"rod": {**SLENDER, "section": ROUND}},
        {"rod.section.diameter": (0.009, 0.012)},
    ),
    "ellipse": (
        "elastica",
        {"rod": {**SLENDER, "section": OVAL}},
        {"rod.section.height": (0.009, 0.012), "rod.section.width": (0.009, 0.012)},
    ),
    "length": (
        "elastica",
        {"rod": SLENDER, "line_loads": LINE},
        {"rod.length": (0.7, 1.0), "line_loads.0.density": (0.1, 2.0)},
    ),
    "centreline": (
        "elastica",
        {"rod": {**SLENDER, "centreline": 0.4}},
        {"rod.section.height": (0.008, 0.011)},
    ),
    "weight": (
        "clamped_free_consistent",
        {},
        {"gravity.g": (1.0, 9.0), "rod.material.young": (5e8, 2e9)},
    ),
    "mass": (
        "clamped_free_consistent",
        {},
        {"gravity.g": (1.0, 9.0), "rod.material.line_density": (100, 300), "rod.length": (3, 5)},
    ),
    "density": (
        "clamped_free_consistent",
        {"rod": {"centreline": 0.4, "material": {"line_density": "none", "density": 1000.0}}},
        {"rod.section.height": (0.4, 0.5), "rod.material.density": (900, 1100)},
    ),
    "published": ("clamped_free", {}, {"gravity.g": (1.0, 9.0)}),
}


def family(name, count=3):
    case, changes, ranges = FAMILIES[name]
    rng = np.random.default_rng(len(name))
    columns = {key: rng.uniform(*bounds, count) for key, bounds in ranges.items()}
    return cosserat.case(case).vary("family", **changes).problem, columns


def single(problem, columns, number):
    """One member, read and validated as any case."""
    table = problem.model_dump(exclude_none=True)
    for key, values in columns.items():
        at = table
        *path, last = key.split(".")
        for part in path:
            at = at[int(part)] if part.isdecimal() else at[part]
        at[last] = float(values[number])
    return type(problem).read(table, "a member", units_required=False)


@pytest.mark.parametrize("name", FAMILIES)
def test_a_member_has_the_bits_of_its_single_run(name):
    problem, columns = family(name)
    found = solve_many(problem, columns)
    assert found.solved.all()
    every, _, _ = members_of(problem, columns, problem.system(problem.geometry))
    for number in range(3):
        alone = single(problem, columns, number)
        one = alone.system(alone.geometry).member
        for part, values, expected in zip(every._fields, every, one, strict=True):
            assert (values[number] == expected[0]).all(), part
        solution = alone.solve("alone")
        for field, (dims, values) in found.fields.items():
            assert dims[1:] == solution.fields[field][0]
            assert np.array_equal(values[number], solution[field]), field
        for statistic, values in found.statistics.items():
            assert values[number] == solution.statistics[statistic], statistic
        assert found.labels.items() <= solution.labels.items()


def test_threads_and_parts_change_no_bit():
    problem, columns = family("force", 64)
    whole = solve_many(problem, columns)
    halves = [
        {key: values[part] for key, values in columns.items()} for part in (slice(32), slice(32, 64))
    ]
    with ThreadPoolExecutor(2) as pool:
        parts = list(pool.map(lambda own: solve_many(problem, own, ["x"]), halves))
    assert np.array_equal(np.concatenate([part.fields["x"][1] for part in parts]), whole.fields["x"][1])
    assert (whole.statistics["residual_N"] <= whole.statistics["tolerance_N"]).all()


def test_members_that_buckle_or_cross_are_left_to_their_own_problems():
    """A column under a small side force, below and beyond Euler's load; a thick rod whose sections meet."""
    forces = [{"at": "last", "along": "-E3", "force": 1.0}, {"at": "last", "along": "E2", "force": 1e-4}]
    column = cosserat.case("elastica").vary("column", rod=SLENDER, forces=forces).problem
    found = solve_many(column, {"forces.0.force": np.array([0.5, 2.3, 0.9])})
    assert found.solved.tolist() == [True, False, True]
    thick = (
        cosserat.case("elastica").vary("thick", rod={"vertices": 41, "section": {"height": 0.2}}).problem
    )
    loads = np.array([10.0, 200.0]) * thick.rod.young * thick.rod.second_moment / thick.rod.length**2
    found = solve_many(thick, {"forces.0.force": loads}, ["u"])
    assert found.solved.tolist() == [True, False]
    assert found.statistics["residual_N"][1] > 0  # solved, but its sections cross
    with pytest.raises(cosserat.errors.CrossingError):
        single(thick, {"forces.0.force": loads}, 1).solve("crossed")


def test_a_coarse_member_keeps_its_warning():
    bent = cosserat.case("elastica").vary("bent", rod={"vertices": 3}).problem
    found = solve_many(bent, {"forces.0.force": np.array([0.1, 4.6])})
    alone = single(bent, {"forces.0.force": np.array([4.6])}, 0).solve("alone")
    assert list(found.warnings) == [1]
    assert tuple(found.warnings[1]) == alone.warnings


@pytest.mark.parametrize(
    ("key", "values"),
    [
        ("rod.material.poisson", [-1.0, -0.99, 0.0, 0.49, 0.5, np.nan]),
        ("rod.section.height", [-1.0, 0.0, 1e-300, 0.01, 1e300, np.inf]),
        ("rod.material.young", [0.0, 1e9, 1e-30, 1e40]),
        ("forces.0.force", [0.0, 1e-200, -1.0, 1.0, 1e200]),
    ],
)
def test_values_are_refused_as_those_of_a_single_problem(key, values):
    problem, columns = family("force")[0], {key: np.array(values)}

    def accepted(number):
        try:
            return bool(single(problem, columns, number))
        except InputError:
            return False

    expected = [accepted(number) for number in range(len(values))]
    assert in_range(problem, columns).tolist() == expected
    found = solve_many(problem, columns, ["x"])
    assert not found.solved[~np.array(expected)].any()
    assert np.isnan(found.fields["x"][1][~np.array(expected)]).all()


@pytest.mark.parametrize(
    "quantity",
    [
        Quantity("1", above=-1, below=0.5),
        Quantity("m", above=0),
        Quantity("Pa", at_least=0),
        Quantity("N"),
        Quantity("rad", at_least=-1e3, at_most=1e3),
    ],
)
def test_a_column_is_in_a_range_where_each_number_is(quantity):
    bounds = [
        b for b in (quantity.above, quantity.below, quantity.least, quantity.most) if abs(b) < np.inf
    ]
    values = [0.0, np.nan, np.inf, -np.inf, 1e-300, -1e-300, 0.3, -0.3]
    values += [near for b in bounds for near in (b, np.nextafter(b, np.inf), np.nextafter(b, -np.inf))]

    def accepted(number):
        try:
            return quantity.checked(float(number)) == number
        except PydanticCustomError:
            return False

    assert quantity.holds(np.array(values)).tolist() == [accepted(number) for number in values]


@pytest.mark.parametrize(
    ("case", "key"),
    [
        ("elastica", "rod.vertices"),
        ("elastica", "rod.centreline"),
        ("elastica", "couples.0.moment"),
        ("elastica", "forces.1.force"),
        ("elastica", "rod.material.bulk_modulus"),
        ("clamped_free", "rod.material.young"),
        ("clamped_free_consistent", "rod.material.density"),
        ("roll_up", "rod.material.young"),
    ],
)
def test_other_keys_are_solved_one_by_one(case, key):
    assert solve_many(cosserat.case(case).problem, {key: np.array([1.0, 2.0])}) is None
