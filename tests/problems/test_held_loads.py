"""Paths and critical loads that begin in a static answer whose loads stay: beam-columns, held and all at once."""

import itertools

import numpy as np
import pytest
from scipy.optimize import brentq

import cosserat
from cosserat.errors import InputError
from cosserat.problems.critical import RodCriticalLoads
from cosserat.problems.modes import RodModes
from cosserat.problems.path import RodPath

HINGES = [{"at": "first", "fixed": "pinned"}, {"at": "last", "fixed": "roller"}]
CLAMP = {"at": "first", "fixed": "clamped"}
YOUNG = 1e9


def static(vertices=11, side=0.1, **changes):
    """A straight rod of length one between hinges, without Poisson's effect."""
    rod = {"vertices": vertices, "section": {"height": side, "width": side}}
    return cosserat.case("elastica").vary(
        "rod", **{"rod": rod, "supports": HINGES, "forces": []} | changes
    )


def grown(start, kind=RodPath, **changes):
    """The loads of `changes` from the equilibrium of a case, on its rod and its supports."""
    table = start.problem.model_dump() | {"start_from": start.problem.model_dump()}
    loads = dict.fromkeys(("forces", "couples", "prescribed_displacements", "prescribed_rotations"), ())
    word = kind.model_fields["kind"].default
    loads |= {"temperatures": (), "follower_forces": (), "gravity": None}
    return kind.read(table | {"kind": word} | loads | changes, "x", units_required=False)


def push(size, at="last", along="-E3"):
    return {"at": at, "along": along, "force": size}


def second_order(errors, within=0.15):
    orders = [np.log2(abs(a / b)) for a, b in itertools.pairwise(errors)]
    assert orders == pytest.approx([2] * len(orders), abs=within)


@pytest.mark.parametrize("share", [0.3, 0.9, -0.5])
def test_a_held_push_lowers_the_critical_load_of_a_column_by_its_size(share):
    """Of the discrete column with shear and shortening: P (1 - P / EA + P / GA) = EI k^2."""
    EA, EI, GA = YOUNG * 0.1**2, YOUNG * 0.1**4 / 12, 5 / 12 * YOUNG * 0.1**2
    bent = EI * (20 * np.tan(np.pi / 20)) ** 2
    right = brentq(lambda P: P * (1 - P / EA + P / GA) - bent, 0, 2 * bent, xtol=1e-12 * bent)
    start = static(forces=[push(share * right)])
    found = grown(start, RodCriticalLoads, forces=[push(right)]).solve("it")
    assert found["special_load_factor"] == pytest.approx([1 - share], rel=1e-10)
    assert found["linear_load_factor"][0] == pytest.approx(1 - share, rel=0.1 * (1 - share))
    path = grown(start, forces=[push(1.5 * (1 - share) * right)]).solve("it")
    assert path["special_load_factor"] == pytest.approx([1 / 1.5], rel=1e-10)


def middle(start, **loads):
    """Deflection of the middle along a path, and its load factors."""
    path = grown(start, **loads).solve("it")
    return path["x"][:, path["x"].shape[1] // 2, 1], path["load_factor"]


@pytest.mark.parametrize("held", ["couples", "force"])
def test_a_beam_that_is_bent_and_then_pushed_follows_secant_and_tangent(held):
    """M / P (sec u - 1) and F L / (4 P) (tan u / u - 1) with u = sqrt(P / EI) L / 2, all along the path."""
    side, errors = 5e-3, []
    EI = YOUNG * side**4 / 12
    load = 0.8 * np.pi**2 * EI
    for n in (11, 21, 41):
        bend = {
            "couples": {
                "couples": [{"at": "first", "moment": -1e-5 * EI}, {"at": "last", "moment": 1e-5 * EI}]
            },
            "force": {"forces": [push(1e-4 * EI, "50 %", "-E2")]},
        }[held]
        down, factor = middle(static(n, side, **bend), forces=[push(load)])
        u = np.sqrt(factor[1:] * load / EI) / 2
        right = {
            "couples": 1e-5 * EI / (factor[1:] * load) * (1 / np.cos(u) - 1),
            "force": 1e-4 * EI / (4 * factor[1:] * load) * (np.tan(u) / u - 1),
        }[held]
        first = {"couples": 1e-5 / 8, "force": 1e-4 / 48}[held]
        assert -down[0] == pytest.approx(first, rel=0.05)
        errors.append(-down[-1] / right[-1] - 1)
        np.testing.assert_allclose(-down[1:], right, rtol=abs(errors[-1]) + 2e-3)
    second_order(errors)
    assert abs(errors[-1]) < 5e-3


def test_a_beam_that_is_stretched_first_sags_as_a_stiff_string():
    """F L^3 (u - tanh u) / (16 EI u^3), u = sqrt(T / EI) L / 2: its support stays where it was moved to."""
    side, by = 5e-3, 1e-4
    EI, tension = YOUNG * side**4 / 12, YOUNG * side**2 * by
    u = np.sqrt(tension / EI) / 2
    both = [{"at": at, "fixed": "pinned"} for at in ("first", "last")]
    moved = [{"at": "last", "dof": "x3", "by": by}]
    start = static(21, side, supports=both, prescribed_displacements=moved)
    path = grown(start, forces=[push(1e-4, "50 %", "-E2")]).solve("it")
    np.testing.assert_allclose(path["x"][:, -1], [[1 + by, 0]] * len(path["x"]), atol=1e-15)
    np.testing.assert_allclose(path.derive().fields["normal_force"][1], tension, rtol=1e-5)
    right = 1e-4 * (u - np.tanh(u)) / (16 * EI * u**3)
    assert -path["x"][-1, 10, 1] == pytest.approx(right, rel=2e-4)


FIRST = {
    "force": {"forces": [push(2e4, along="E2")]},
    "weight": {"gravity": {"g": 4e4, "along": "-E2"}},
    "couple": {"couples": [{"at": "last", "moment": 2e4}]},
    "follower": {"follower_forces": [push(2e4, along="E2")]},
    "temperature": {"temperatures": [{"change": 50.0, "gradient": 4e3, "expansion": 1e-3}]},
    "turned": {"prescribed_rotations": [{"at": "first", "by": 1.0}]},
    "curl": {"pose": {"kind": "arc", "curvature": 2.0}},
}
THEN = {
    "force": {"forces": [push(1e4, along="E2")]},
    "couple": {"couples": [{"at": "last", "moment": 1e4}]},
    "turned": {"prescribed_rotations": [{"at": "first", "by": -0.5}]},
    "cooled": {"temperatures": [{"gradient": -1e3, "expansion": 1e-3}]},
}
ADDED = {("turned", "turned"): {"prescribed_rotations": [{"at": "first", "by": 0.5}]}}


def together(first, then):
    """Both loads at once."""
    one, other = FIRST[first], THEN[then]
    lists = {key: [*one.get(key, []), *other[key]] for key in other}
    return one | lists | ADDED.get((first, then), {})


@pytest.mark.parametrize(("first", "then"), [*itertools.product(FIRST, THEN)])
def test_the_end_of_a_path_is_that_of_both_loads_at_once(first, then):
    """Every output, also where both loads are of one kind; energies of loads and works only by their sum."""
    spring = [{"at": "last", "rotational_stiffness": 3e3}]
    start = static(supports=[CLAMP], springs=spring, **FIRST[first])
    both = static(supports=[CLAMP], springs=spring, **together(first, then))
    path, right = grown(start, **THEN[then]), both.problem.solve("it")
    found = path.solve("it")
    assert np.abs(found["x"][0] - start.problem.solve("it")["x"]).max() < 1e-9
    assert np.abs(found["x"][0] - found["x"][-1]).max() > 1e-3
    for name in ("x", "d"):
        np.testing.assert_allclose(found[name][-1], right[name], atol=1e-8)
    ends, known = found.derive().fields, right.derive().fields
    assert set(known) - set(ends) == set()
    for name, (dims, values) in known.items():
        last = ends[name][1][-1] if "point" in ends[name][0] else ends[name][1]
        atol = 1e-6 * np.abs(values).max() + (
            1e-2 if "stress" in name else 1e-7
        )  # round-off where it is zero
        np.testing.assert_allclose(last, values, atol=atol, err_msg=f"{name} {dims}")


def test_a_spring_keeps_its_whole_turns_along_a_path():
    """The section of the clamp turns by more than half a turn before the force grows."""
    spring = [{"at": "last", "rotational_stiffness": 3e3}]
    turned = {
        "prescribed_rotations": [{"at": "first", "by": 4.0}],
        "supports": [CLAMP],
        "springs": spring,
    }
    path = grown(static(**turned), **THEN["force"]).solve("it")
    right = static(**turned, **THEN["force"]).problem.solve("it")
    np.testing.assert_allclose(path["x"][-1], right["x"], atol=1e-8)
    for name in ("attached_energy", "rotation"):
        found = path.derive().fields[name][1][-1]
        np.testing.assert_allclose(found, right.derive().fields[name][1], rtol=1e-6)


def test_work_and_energy_balance_along_a_path_with_held_loads():
    start = static(supports=[CLAMP], **FIRST["force"] | FIRST["couple"])
    errors = []
    for longest in (0.1, 0.05):
        path = grown(start, **THEN["couple"], arc={"first": longest / 2, "longest": longest})
        found = path.solve("it").derive().fields
        stored = found["strain_energy"][1] - found["strain_energy"][1][0]
        errors.append((found["total_load_work"][1] - stored)[-1] / stored[-1])
    assert abs(errors[0]) < 1e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.4)


def test_an_oblique_roller_and_another_support_hold_the_rod_where_it_is():
    """A frame of its own for one vector; a tip that is fixed after it was bent has no reaction at first."""
    oblique = [CLAMP, {"at": "last", "fixed": "roller", "along": "30 deg"}]
    start = static(supports=oblique, forces=[push(2e4, "50 %", "E2")])
    both = static(supports=oblique, forces=[push(3e4, "50 %", "E2")])
    path = grown(start, forces=[push(1e4, "50 %", "E2")]).solve("it")
    np.testing.assert_allclose(path["x"][-1], both.problem.solve("it")["x"], atol=1e-9)
    bent = static(supports=[CLAMP], **FIRST["force"])
    caught = [CLAMP, {"at": "last", "fixed": "clamped"}]
    path = grown(bent, supports=caught, forces=[push(1e4, "50 %", "E2")]).solve("it")
    np.testing.assert_allclose(path["x"][:, -1], path["x"][0, -1:].repeat(len(path["x"]), 0), atol=1e-12)
    assert path["x"][0, -1, 1] > 0.1
    force = path.derive().fields["reaction_force"][1]
    assert np.abs(force[0, 1]).max() < 1e-4 * np.abs(force[-1, 1]).max()


def test_a_start_from_a_case_of_a_file(tmp_path):
    """The key in TOML, and its loads in a result that is read again and drawn."""
    (tmp_path / "my.toml").write_text(
        '[still]\nlike = "elastica"\nrod.vertices = 11\ntitle = "bent"\n'
        '[pushed]\nlike = "still"\nkind = "critical loads"\nstart_from = { like = "still" }\n'
        'forces = [{ at = "last", along = "E3", force = "1 N" }]\n'
    )
    case = cosserat.case("pushed", tmp_path / "my.toml")
    assert case.problem.start_from == cosserat.case("still", tmp_path / "my.toml").problem
    data = cosserat.run(case.vary("short", search={"count": 2}))
    assert cosserat.case_of(data).problem.start_from == case.problem.start_from
    assert float(np.abs(data.x - data.x_ref).max()) > 0
    cosserat.plot(data, tmp_path / "picture.svg")


@pytest.mark.parametrize(
    ("start", "changes", "sentence"),
    [
        (
            {},
            {"pose": {"kind": "arc", "curvature": 1.0}},
            "has a 'start_from' with another 'pose'; give both",
        ),
        (
            {},
            {"springs": [{"at": 3, "along": "E2", "stiffness": 1.0}]},
            "with another 'springs'; give both",
        ),
        (
            {"masses": [{"at": "0.33 m", "mass": 1.0}]},
            {"masses": []},
            "'start_from' with other vertices",
        ),
        (
            {"supports": [CLAMP], **FIRST["force"]},
            {"supports": HINGES},
            "a support holds the rod in the equil",
        ),
        ({}, {"start_from": {"supports": []}}, "'start_from.rod' is missing"),
    ],
)
def test_a_start_that_does_not_fit_is_refused_in_one_sentence(start, changes, sentence):
    with pytest.raises(InputError, match=sentence):
        grown(static(**start), **{"forces": [push(1.0)]} | changes).solve("it")


def test_modes_of_a_path_are_about_the_end_of_its_loads_with_those_that_stay():
    start = static(side=1e-2, forces=[push(10.0)])
    path = grown(start, forces=[push(5.0)])
    both = RodModes.of(static(side=1e-2, forces=[push(15.0)]).problem, 3).solve("it")
    found = RodModes.of(path, 3).solve("it")
    np.testing.assert_allclose(found["natural_frequency"], both["natural_frequency"], rtol=1e-9)


def hinged_frequency(side, push):
    """The lowest angular frequency of a slender hinged column of length one under an axial push."""
    material = static(side=side).problem.rod
    euler = np.pi**2 * YOUNG * side**4 / 12
    return np.pi**2 * np.sqrt(YOUNG * side**4 / 12 / material.line_density * (1 - push / euler))


@pytest.mark.parametrize("own", [0.0, 0.4])
def test_modes_about_a_held_push_are_those_of_a_column_under_all_of_it(own):
    """Frequency pi^2 sqrt(EI / rho_0) sqrt(1 - P / P_E), P the held push with that of the case, of second order."""
    side = 5e-3
    euler, errors = np.pi**2 * YOUNG * side**4 / 12, []
    for vertices in (11, 21, 41):
        start = static(vertices, side, forces=[push(0.5 * euler)])
        forces = [push(own * euler)] if own else []
        found = grown(start, RodModes, forces=forces, count=1).solve("it")
        right = hinged_frequency(side, (0.5 + own) * euler)
        errors.append(2 * np.pi * found["natural_frequency"][0] / right - 1)
    second_order(errors)
    assert abs(errors[-1]) < 0.02


def test_modes_about_a_held_bend_are_those_of_all_loads_at_once():
    """Tension across a clamped rod that hangs far to one side, which straight rods do not see."""
    held, more = push(6.0, along="E2"), push(3.0, along="-E3")
    start = static(side=1e-2, supports=[CLAMP], forces=[held])
    both = static(side=1e-2, supports=[CLAMP], forces=[held, more])
    found = grown(start, RodModes, forces=[more], count=4).solve("it")
    right = RodModes.of(both.problem, 4).solve("it")
    np.testing.assert_allclose(found["natural_frequency"], right["natural_frequency"], rtol=1e-9)
    np.testing.assert_allclose(found["x"], right["x"], atol=1e-9)
    bare = RodModes.of(static(side=1e-2, supports=[CLAMP]).problem, 4).solve("it")
    assert abs(found["natural_frequency"][0] / bare["natural_frequency"][0] - 1) > 0.02


def test_modes_say_which_supports_let_go_and_take_no_reference():
    start = static(side=1e-2, supports=[CLAMP], forces=[push(1.0, along="E2")])
    with pytest.raises(InputError, match="a support holds the rod in the equilibrium of 'start_from'"):
        grown(start, RodModes, supports=HINGES).solve("it")
    with pytest.raises(InputError, match="has 'start_from' and about = 'reference'"):
        grown(start, RodModes, about="reference")
