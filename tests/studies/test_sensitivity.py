"""Derivatives of read-outs: against differenced solves and closed forms, and where there are none."""

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError
from cosserat.problems import moving
from cosserat.solvers.slopes import slope

from .gradients import FACTORS, FILE, STRIDE, by_other_means, compared, differenced

CASES = cosserat.load_cases(FILE)
PUSHED = [{"at": 5, "along": "E2", "force": 5.0}, {"at": 6, "along": "E3", "force": 0.5}]


@pytest.mark.parametrize(
    ("name", "keys"),
    [
        ("followed", ["rod.length", "follower_forces.0.force"]),
        ("published", ["rod.section.height", "gravity.g"]),
        ("moved", ["prescribed_rotations.0.by"]),
        ("robot_as_printed", ["crawler.material.poisson"]),
        ("earthworm_as_printed", ["crawler.length", "gait.gamma.0.2.1"]),
        ("tapered", ["gait.ramp", "loads.advancing"]),
        ("posed_arch", ["rod.length", "rod.section.height"]),
        ("begun_column", ["gravity.g"]),
    ],
)
def test_derivatives_are_those_of_differenced_solves(name, keys):
    errors, _, _ = compared(name, keys)
    assert max(errors.values()) < 1e-8, errors


def test_frequencies_and_shapes_follow_from_modulus_and_density():
    """A free rod: its frequencies go as sqrt(E / rho), its shapes of unit modal mass as 1 / sqrt(rho)."""
    keys = ["rod.material.young", "rod.material.density"]
    of = {"first": "natural_frequency at 0", "size": "norm mode_u.E2 at 0"}
    case = CASES["free"].vary("supported", supports=[{"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}])
    found = cosserat.sensitivity(case, keys, of)
    first, size = found["first"].item() / 2, found["size"].item() / 2
    assert found["first_scaled"].to_numpy() == pytest.approx([first, -first], rel=1e-8)
    assert found["size_scaled"].to_numpy() == pytest.approx([0, -size], rel=1e-8, abs=1e-8 * size)
    free = cosserat.sensitivity(CASES["free"], keys, {"first": "natural_frequency at 3"})
    assert free["first_scaled"].to_numpy() * 2 == pytest.approx(
        [1, -1] * free["first"].to_numpy(), rel=1e-8
    )
    assert free["first_by_young"].attrs["units"] == "Hz Pa-1"


def test_a_limit_point_and_its_shape_scale_as_dimensions_say():
    """Of an arch bent from a straight rod: its load goes as the modulus and a length squared, its shape as neither."""
    lengths = {"rod.length": 1, "rod.section.width": 1, "rod.section.height": 1, "pose.curvature": -1}
    read = {"true": FACTORS["true"], "shape": "norm special_u"}
    case = CASES["posed_arch"].vary("coarse", rod={"vertices": 11}, forces=PUSHED)
    found = cosserat.sensitivity(case, [*lengths, "rod.material.young"], read)
    for name, power in {"true": 1, "shape": 0}.items():
        scaled, size = found[f"{name}_scaled"].to_numpy(), found[name].item()
        assert scaled[-1] == pytest.approx(power * size, abs=1e-8 * size)
        assert scaled[:-1] @ [*lengths.values()] == pytest.approx(2 * power * size, abs=1e-8 * size)
    right = differenced(case, "rod.length", found["length"].item(), read)
    assert found["shape_scaled"].item(0) == pytest.approx(right[1], rel=1e-6)


def test_both_critical_loads_are_proportional_to_the_modulus():
    found = cosserat.sensitivity(CASES["column"], "rod.material.young", FACTORS)
    for name in FACTORS:
        assert found[f"{name}_scaled"].item() == pytest.approx(found[name].item(), rel=1e-8)


def test_a_stride_and_its_derivatives_by_other_means():
    value, errors = by_other_means(96, STRIDE[1:2])
    assert value < 5e-8
    assert errors < 3e-7  # both are 1e-9 with polynomials of degree 160


def breathing():
    """The whole robot pushed in one phase and pulled in the other, without weight: bars under uniform stresses."""
    gait = {
        "phases": ["1 s", "1 s"],
        "gamma": [],
        "eta": [],
        "anchor": [[[0, 0], [1, 0]], [[1, 1], [2, 1]]],
        "chambers": [{"begin": 0, "end": 1, "schedule": [[0, 1, "advancing"]]}],
    }
    return CASES["robot"].vary("breathing", gait=gait, loads={"gravity": 0.0}, strides=1, step="0.5 s")


def test_the_stride_of_a_body_without_fronts_follows_from_hookes_law():
    """A pressure p round a bar lengthens it by 2 nu p / E, and a force D shortens it by D / (E A)."""
    case = breathing()
    body, loads = case.problem.crawler, case.problem.loads
    young, poisson = body.material.moduli
    swells = 2 * poisson * loads.advancing / young * body.length
    shortens = loads.anchoring / (young * body.area) * body.length
    keys = ["crawler.length", "crawler.radius", "crawler.material.young", "crawler.material.poisson"]
    found = cosserat.sensitivity(
        case, [*keys, "loads.anchoring", "loads.advancing"], {"stride": "change along at last"}
    )
    stride = swells + shortens
    assert found["stride"].item() == pytest.approx(stride, rel=1e-12)
    exact = [stride, -2 * shortens, -stride, swells, shortens, swells]
    np.testing.assert_allclose(found["stride_scaled"], exact, rtol=0, atol=1e-12 * stride)
    assert "tangent" in found.attrs["method"]


def test_a_crawl_solved_in_the_thesiss_way_is_differenced_and_says_so():
    case = breathing().vary("collocated", solver="collocation", collocation_tolerance=1e-9)
    found = cosserat.sensitivity(case, "crawler.length", {"stride": "change along at last"})
    assert found.attrs["method"] == "differences of whole solves"
    assert found["stride_scaled"].item() == pytest.approx(found["stride"].item(), rel=1e-8)


def on_a_front():
    """The worm ends a stride with a front on the middle section."""
    return CASES["earthworm"].vary("front", strides=1, step="10 s", gait={"sudden": 0.1})


def test_units_names_and_values():
    keys = ["rod.material.young", "forces.0.force", "rod.material.density"]
    found = cosserat.sensitivity(CASES["bent"], keys, {"tip": "u.E2 at last", "mass": "total_mass.E3"})
    assert found["tip_by_young"].attrs["units"] == "m Pa-1"
    assert found["mass_by_density"].attrs["units"] == "kg kg-1 m3"
    assert found["young"].item() == 1e9
    assert found["young"].attrs["key"] == keys[0]
    assert found["mass"].item() == pytest.approx(1100 * 0.012 * 0.009, rel=1e-14)
    assert found["mass_scaled"].to_numpy() == pytest.approx([0, 0, found["mass"].item()], abs=1e-13)


def unloaded():
    return CASES["bent"].vary("unloaded", forces=[{"at": "last", "along": "E2", "force": 0.0}])


def at_euler():
    """A perfect column at its critical load to the last digits."""
    load = cosserat.run(CASES["column"])["special_load_factor"].item()
    table = CASES["column"].problem.model_dump()
    push = [{"at": "last", "along": "-E3", "force": load * (1 - 1e-9)}]
    return CASES["bent"].vary("euler", rod=table["rod"], forces=push)


@pytest.mark.parametrize(
    ("case", "key", "read_out", "said"),
    [
        (lambda: CASES["bent"], "rod.vertices", "u.E2 at last", "is a count"),
        (lambda: CASES["bent"], "rod.material.shear_modulus", "u.E2 at last", "is not given"),
        (lambda: CASES["bent"], "rod.length", "u.E2 at 0.5 m", "a kink"),
        (unloaded, "forces.0.force", "max |u.E2|", "a kink"),
        (at_euler, "rod.length", "u.E3 at last", "a limit point or a bifurcation"),
        (on_a_front, "gait.eta.1.1.1", "final mu_1_slope at 40", "a kink"),
        (on_a_front, "crawler.length", "max muscle_force", "no variable"),
        (on_a_front, "crawler.length", "max advancing", "at a section jumps"),
        (on_a_front, "gait.gamma.0.1.0", "final along at last", "two events of the gait"),
        (on_a_front, "step", "final along at last", "how many instants"),
        (on_a_front, "gait.phases", "final along at last", "derivatives are by quantities"),
        (on_a_front, "gait.phases.7", "final along at last", "names no item of a list of 2"),
        (on_a_front, "gait.gamma.0.1", "final along at last", "has no key 'gait.gamma.0.1'"),
        (lambda: CASES["column"], "rod.length", "max |x|", "only load factors"),
        (
            lambda: CASES["begun"],
            "rod.length",
            "natural_frequency at 0",
            "'start_from' with another 'rod'",
        ),
    ],
)
def test_what_has_no_derivative_is_said_in_one_sentence(case, key, read_out, said):
    with pytest.raises(InputError, match=said):
        cosserat.sensitivity(case(), key, {"it": read_out})


def test_a_slope_knows_its_error_and_its_kinks():
    smooth = slope(lambda s: np.array([np.exp(7 * s), np.sin(s)]), 1e-16)
    assert smooth.value == pytest.approx([7.0, 1.0], rel=1e-10)
    assert not smooth.kink.any()
    bent = slope(lambda s: np.array([abs(s) + s, s]), 1e-16)
    assert bent.kink.tolist() == [True, False]


def test_a_slope_halves_once_more_before_it_takes_much_shorter_steps():
    """Those would cost more values, and more round-off: it grows as the shortest step shrinks."""
    steps = []

    def values(step):
        steps.append(step)
        return np.array([np.exp(15 * step)])

    assert slope(values, 1e-16).value == pytest.approx([15.0], rel=1e-11)
    assert len(steps) == 9
    assert min(abs(step) for step in steps if step) == 2.0**-8


def test_a_study_stores_derivatives_of_its_members():
    of = {"tip": "u.E2 at last", "bent": "max |kappa|", "mass": "total_mass.E3"}
    vary = {"rod.material.young": [1e9, 2e9], "forces.0.force": [0.0, 3.0]}
    found = cosserat.study(CASES["bent"], vary, of, sensitivities=True, progress=lambda *_: None)
    alone = CASES["bent"].vary(
        "alone", rod={"material": {"young": 2e9}}, forces=[{"at": "last", "along": "E2", "force": 3.0}]
    )
    one = cosserat.sensitivity(alone, list(vary), of)
    for word in ("tip_by_young", "tip_by_force", "bent_by_young", "bent_by_force"):
        assert found[word][1, 1].item() == one[word].item()
        assert found[word].attrs["units"] == one[word].attrs["units"]
    assert np.isnan(found["bent_by_force"][0, 0].item())  # the largest size of nothing
    assert "'bent' has no derivative by 'forces.0.force'" in found["reason"][0, 0].item()
    assert found["tip_by_force"][0, 0].item() > 0
    assert found["tip_by_force"].attrs["method"].startswith("the equilibrium's tangent")
    assert found["mass"][1, 1].item() == one["mass"].item()
    del of[
        "mass"
    ]  # which single results have alone: without it, all members are solved and differentiated at once
    at_once = cosserat.study(CASES["bent"], vary, of, sensitivities=True, progress=lambda *_: None)
    for word in at_once.data_vars:
        assert at_once[word].equals(found[word]), word


def test_a_member_of_a_study_at_a_critical_load_has_no_derivative_and_says_so():
    case = at_euler()
    critical = case.problem.forces[0].force
    vary = {"forces.0.force": [0.5 * critical, critical]}
    found = cosserat.study(
        case, vary, {"end": "u.E3 at last"}, sensitivities=True, progress=lambda *_: None
    )
    assert np.isfinite(found["end"]).all()
    assert np.isnan(found["end_by_force"].to_numpy()).tolist() == [False, True]
    assert found["reason"].item(0) == ""
    assert "a limit point or a bifurcation" in found["reason"].item(1)


@pytest.mark.parametrize("name", ["elastica", "clamped_clamped_consistent"])
def test_columns_and_whole_problems_give_the_same_derivatives(name, monkeypatch):
    """Keys whose formulas take columns need no problem for each step; what is left goes the long way."""
    keys = ["rod.length", "rod.material.young", "rod.section.height", "rod.section.width"]
    keys += ["gravity.g"] if cosserat.case(name).problem.gravity else ["forces.0.force"]
    read = {"bent": "max |kappa|", "middle": "u.E2 at 10"}
    quick = cosserat.sensitivity(name, keys, read)
    asked = []
    monkeypatch.setattr(moving, "has_rates", lambda *own: asked.append(own) or False)
    whole = cosserat.sensitivity(name, keys, read)
    assert asked
    for one in ("bent_scaled", "middle_scaled"):
        size = np.abs(whole[one]).max()
        np.testing.assert_allclose(quick[one], whole[one], rtol=0, atol=1e-9 * size)
