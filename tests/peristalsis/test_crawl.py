"""Gaits and crawling, and the gaits that are refused."""

import numpy as np
import pytest
import xarray as xr
from conftest import ROOT, base_of, examples

import cosserat
from cosserat.errors import InputError
from cosserat.exact.beams import PushPullRod
from cosserat.peristalsis.gait import Gait
from cosserat.studies.door import published_studies
from cosserat.thesis.earthworm import (
    MUSCLE_LAWS,
    protrusion_time,
    resting_diameter,
    resting_length,
    stance_time,
)
from cosserat.thesis.table.crawl_readouts import READOUTS, slope, strides
from cosserat.thesis.table.measure import judge
from cosserat.thesis.table.power import Change, result
from cosserat.thesis.table.tolerances import read_table

CRAWLS = [name for name, case in cosserat.published().items() if case.problem.kind == "crawl"]
WORM = cosserat.case("worm")
CASES = {**cosserat.published(), **examples()}


def gait(**changes):
    """A gait of one phase with one front."""
    plain = {
        "phases": ["2 s"],
        "gamma": [[[0, 1], [1, 0]]],
        "anchor": [[[0, 0], [0.5, 0]], [[0.5, 1], [1, 1]]],
        "sudden": 1,
    }
    return Gait.read(plain | changes, "gait")


# ---------------------------------------------------------------- gaits


def test_fronts_divide_the_body():
    worm = WORM.problem.gait
    kinds = [
        [(round(r.left, 3), round(r.right, 3), r.load[:3]) for r in worm.regions(p)]
        for p in (0, 0.25, 0.5, 1, 1.5, 2)
    ]
    assert kinds == [
        [(0, 0.5, "adv"), (0.5, 1, "anc")],
        [(0, 0.25, "adv"), (0.25, 0.875, "anc"), (0.875, 1, "adv")],
        [(0, 0.75, "anc"), (0.75, 1, "adv")],
        [(0, 0.5, "anc"), (0.5, 1, "adv")],
        [(0, 0.25, "anc"), (0.25, 0.75, "adv"), (0.75, 1, "anc")],
        [(0, 0.5, "adv"), (0.5, 1, "anc")],
    ]
    robot = cosserat.case("soft_robot").problem.gait
    assert [len(robot.regions(p)) for p in (0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4)] == [
        1,
        1,
        1,
        2,
        2,
        3,
        2,
        2,
        1,
    ]
    assert robot.regions(0)[0].load == robot.regions(4)[0].load == "anchoring"


def test_fronts_that_reach_an_end_together_keep_their_order():
    both = gait(
        phases=["1 s", "1 s"],
        gamma=[[[0, 1], [1, 0.4], [2, 0]]],
        eta=[[[1, 1], [2, 0]]],
        anchor=[[[0, 0], [1, 0]], [[1, 1], [2, 1]]],
        sudden=0,
    )
    assert [r.load for r in both.regions(1.5)] == ["anchoring", "advancing", "anchoring"]
    assert [r.load for r in both.regions(2)] == ["anchoring"]


def test_every_event_of_a_gait_is_on_the_time_grid():
    worm = WORM.problem.gait
    instants = worm.instants(0.05)
    assert len(instants) == 98 + 1 + 1  # the start, and t_p / 2, which is no multiple of 0.05 s
    times = np.array([m.time for m in instants])
    assert np.diff(times).max() <= 0.05 + 1e-12
    for event in (0, 3.15 / 3, 3.15 / 2, 3.15, 4.9):
        assert np.abs(times - event).min() < 1e-12


def test_a_front_at_an_end_has_left_the_body():
    assert [r.load for r in gait().regions(0)] == ["anchoring"]
    assert [r.load for r in gait().regions(1)] == ["advancing"]
    assert len(gait(clearance=0.05).regions(0.04)) == 1
    assert len(gait(clearance=0.03).regions(0.04)) == 2


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"phases": []}, "'phases' is empty"),
        ({"phases": ["0 s"]}, "'phases.0' is 0 s; it must be above 0"),
        ({"phases": [2]}, "'phases.0' is 2, without a unit"),
        (
            {"anchor": [[[0, 0], [0.4, 0]], [[0.5, 1], [1, 1]]]},
            "'anchor' has a gap between phases 0.4 and 0.5",
        ),
        (
            {"anchor": [[[0, 0], [0.6, 0]], [[0.5, 1], [1, 1]]]},
            "'anchor' overlaps between phases 0.5 and 0.6",
        ),
        ({"anchor": [[[0, 0], [0.5, 0]]]}, "'anchor' has a gap between phases 0.5 and 1"),
        ({"anchor": []}, "'anchor' has a gap between phases 0 and 1"),
        ({"anchor": [[[0, 0], [1, 1.2]]]}, "'anchor.0' is at 1.2 at phase 1, off the body"),
        ({"anchor": [[[0, 0.1], [1, 0.6]]]}, "gamma and anchor cross at phase 0.6"),
        (
            {"anchor": [[[0, 0.5], [0.5, 0.5]], [[0.5, 1], [1, 1]]]},
            "the anchor lies on the front gamma at 0.5",
        ),
        ({"gamma": [[[0, 1]]]}, "'gamma.0' has 1 points"),
        (
            {"gamma": [[[0, 1], [0, 0.5], [1, 0]]]},
            "'gamma.0' goes from phase 0 to phase 0; let its times increase",
        ),
        ({"gamma": [[[0, 1], [1.5, 0]]]}, "'gamma.0' ends at phase 1.5, but 'phases' has 1"),
        ({"gamma": [[[0, 1], [1, -0.5]]]}, "'gamma.0' is at -0.5 at phase 1, off the body"),
        ({"eta": [[[0, 0.5], [1, 0.4]]]}, "gamma and eta cross at phase"),
        ({"eta": [[[0, 0.9], [1, 0.4]]], "gamma": [[[0, 0.3], [1, 0.6]]]}, "gamma and eta cross"),
        (
            {"gamma": [[[0, 0.9], [1, 0.8]], [[0, 0.3], [1, 0.2]]]},
            "the fronts gamma at 0.3 and gamma at 0.9 overlap",
        ),
        ({"gamma": [[[0, "1 m"], [1, 0]]]}, "gamma"),
        ({"sudden": 0}, "at phase 0 the load on 1 of the body changes at once; let fronts enter"),
        (
            {
                "phases": ["1 s", "1 s"],
                "gamma": [[[0, 1], [1, 0.5]]],
                "anchor": [[[0, 0], [2, 0]]],
                "sudden": 0.1,
            },
            "at phase 1 the load on 0.5 of the body",
        ),
        (
            {"gamma": [], "eta": [[[0, 0.6], [1, 0.2]]], "sudden": 0.3},
            "at phase 0 the load on 0.4 of the body",
        ),
        ({"clearance": 0}, "'clearance' is 0; it must be above 0"),
        ({"speed": "1 m/s"}, "'speed' is not a key"),
    ],
)
def test_bad_gaits_are_refused(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        gait(**changes)


# ---------------------------------------------------------------- postures

REGIONS = [{"begin": 0, "end": 0.4, "load": "anchoring"}, {"begin": 0.4, "end": 1, "load": "advancing"}]


def posture(regions):
    return cosserat.case("worm_at_rest").vary("mine", regions=regions)


@pytest.mark.parametrize(
    ("regions", "sentence"),
    [
        (
            [REGIONS[0], {"begin": 0.3, "end": 1, "load": "advancing"}],
            "'regions.1' begins at 0.3 and overlaps the one before",
        ),
        (
            [REGIONS[0], {"begin": 0.5, "end": 1, "load": "advancing"}],
            "'regions.1' begins at 0.5 and leaves a gap",
        ),
        (
            [REGIONS[0], {"begin": 0.4, "end": 0.4, "load": "advancing"}],
            "'regions.1' from 0.4 to 0.4 is empty",
        ),
        ([REGIONS[0]], "'regions' end at 0.4; they must cover the body"),
        ([], "'regions' has 0 items; it must have 1 to 500"),
        (
            [{**REGIONS[0], "load": "pulling"}, REGIONS[1]],
            "it must be 'anchoring', 'advancing' or 'relaxed'",
        ),
        ([{**REGIONS[0], "end": float("nan")}, REGIONS[1]], "must be a finite number"),
    ],
)
def test_regions_that_do_not_cover_the_body_are_refused(regions, sentence):
    with pytest.raises(InputError, match=sentence):
        posture(regions)


def test_a_users_posture_and_gait_are_solved(tmp_path):
    data = cosserat.run(
        posture(REGIONS).vary("mine", loads={"advancing": "1 kPa", "anchoring": "20 mN"})
    )
    assert data.mu_1.sel(section=50) > 1 > data.mu_1.sel(section=200)
    assert data.along[0] == 0
    (tmp_path / "my.toml").write_text(
        '[inchworm]\nlike = "worm"\nstrides = 2\nstep = "0.1 s"\n'
        'gait.phases = ["1 s", "1 s"]\n'
        "gait.gamma = [[[0, 1], [1, 0.2], [2, 0]]]\n"
        "gait.eta = [[[1, 1], [2, 0]]]\n"
        "gait.anchor = [[[0, 0], [1, 0]], [[1, 1], [2, 1]]]\n"
    )
    crawled = cosserat.run(cosserat.load_cases(tmp_path / "my.toml")["inchworm"])
    lengths = np.ptp(crawled.along.to_numpy(), axis=1)
    assert strides(crawled) == pytest.approx(
        lengths.max() - lengths.min()
    )  # stretched with one anchor, shortened with one
    assert (strides(crawled) > 0.09).all()


def test_an_incompressible_body_without_an_anchoring_region_is_refused():
    whole = {
        "gamma": [
            [
                [0, 1],
                [1, 0],
            ]
        ],
        "eta": [[[1, 1], [2, 0]]],
        "anchor": [[[0, 0], [1, 0]], [[1, 1], [2, 1]]],
    }
    with pytest.raises(InputError, match="at phase 1 no region anchors, and the force"):
        WORM.vary("x", gait=whole)
    crawled = cosserat.run(
        WORM.vary("x", gait=whole, loads={"advancing_force": "none"}, strides=1, step="0.5 s")
    )
    assert strides(crawled)[0] > 0.3


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"step": "1 ns"},
            "'step' = 1e-09 s divides a stride of 4.9 s into more than 20000 instants",
        ),
        ({"mesh": {"elements": 2}}, "'mesh.elements' is 2; it must be at least 3"),
        (
            {"crawler": {"radius": "1 nm"}},
            "has length / radius = 2.5e[+]08; it must be below 1e[+]06",
        ),
        ({"crawler": {"density": "1 kg/m^3"}}, "'crawler' has both a mass and a density; give one"),
        (
            {"crawler": {"material": {"kind": "compressible", "young": "10 kPa", "bulk": "1e15 Pa"}}},
            "Poisson's ratio nu = 0.499999999998; it must be",
        ),
        ({"crawler": {"material": {"kind": "rubber"}}}, "crawler.material"),
        (
            {"collocation_tolerance": 1e-20},
            "'collocation_tolerance' is 1e-20; it must be at least 1e-13",
        ),
        ({"strides": 0}, "'strides' is 0; it must be at least 1"),
        ({"loads": {"anchoring": "-1 N"}}, "'loads.anchoring' is -1 N; it must be at least 0"),
    ],
)
def test_impossible_crawls_are_refused(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        WORM.vary("x", **changes)


def test_a_calibration_needs_an_incompressible_worm_and_loads_to_start_from():
    case = cosserat.case("worm_calibration")
    with pytest.raises(InputError, match="'worm.loads' has a load that is not above 0"):
        case.vary("x", worm={"loads": {"anchoring": 0}})
    with pytest.raises(InputError, match="is 'compressible'; only 'incompressible' has a p_coelom"):
        case.vary("x", worm=cosserat.case("soft_robot").problem.model_dump())


def test_a_calibration_recovers_the_parameters_of_the_measured_worm():
    case = cosserat.case("worm_calibration")
    soft = case.problem.loaded(1500, 0.02, 1000)
    ratio_1, ratio_3, low, high = case.problem.fractions(soft, "soft") * (0.75, 1.60, 300, 800)
    wanted = {"mu_1_ratio": ratio_1, "mu_3_ratio": ratio_3, "p_longitudinal": low, "p_circular": high}
    found = cosserat.run(case.vary("x", **wanted))
    assert float(found.fitted_young) == pytest.approx(1500, rel=1e-7)
    assert float(found.fitted_anchoring) == pytest.approx(0.02, rel=1e-7)
    assert float(found.fitted_advancing) == pytest.approx(1000, rel=1e-7)


def test_a_scaled_worm_needs_two_phases_and_a_weight_can_collapse_a_body():
    with pytest.raises(InputError, match="'worm.gait.phases' has 4; give two"):
        base_of("worm_masses").vary("x", worm=cosserat.case("soft_robot").problem.model_dump())
    with pytest.raises(
        InputError, match="'loads.anchoring' = 0 N and a weight of 40 N/m would collapse"
    ):
        cosserat.run(cosserat.case("worm_at_rest").vary("x", loads={"gravity": 1000}))


def test_equal_neighbours_are_one_region():
    printed = cosserat.case("worm_at_rest").vary(
        "x", loads={"anchoring": "26 mN", "advancing": "1.36 kPa", "multiplier": "printed"}
    )
    ends = [(0, 0.2, "anchoring"), (0.2, 0.8, "advancing"), (0.8, 1, "anchoring")]
    split = [ends[0], (0.2, 0.5, "advancing"), (0.5, 0.8, "advancing"), ends[2]]
    whole, parts = (
        cosserat.run(
            printed.vary("x", regions=[{"begin": a, "end": b, "load": load} for a, b, load in rows])
        )
        for rows in (ends, split)
    )
    assert whole.mu_3.equals(parts.mu_3)


# ---------------------------------------------------------------- crawling


@pytest.mark.parametrize("name", CRAWLS)
def test_the_anchored_point_does_not_move_within_a_step(name, solved):
    """At every instant: anchors lie on plateaus or at an end, where positions are straight between stored sections."""
    data = solved[name]
    along, anchor, xi = data.along.to_numpy(), data.anchor.to_numpy(), data.xi_section.to_numpy()
    before = [np.interp(at, xi, places) for at, places in zip(anchor[1:], along[:-1], strict=True)]
    after = [np.interp(at, xi, places) for at, places in zip(anchor[1:], along[1:], strict=True)]
    allowed = 1e-9 * xi[-1]
    np.testing.assert_allclose(after, before, rtol=0, atol=allowed)
    np.testing.assert_allclose(after, data.anchor_along[1:], rtol=0, atol=allowed)
    assert np.abs(np.diff(along, axis=0)).max() > 1e3 * allowed  # while others move


def fatness_of_the_anchor(data):
    """Where mu_1 of the anchored point lies between the least (0) and the largest (1) of each instant that has both."""
    xi, anchor = data.xi_section.to_numpy(), data.anchor.to_numpy()
    mu = data.mu_1.to_numpy()
    held = np.array([np.interp(at, xi, row) for at, row in zip(anchor, mu, strict=True)])
    both = (data.advancing.max("section") != data.advancing.min("section")).to_numpy()
    return ((held - mu.min(axis=1)) / np.ptp(mu, axis=1))[both]


@pytest.mark.parametrize("name", CRAWLS)
def test_crawlers_anchor_with_a_fat_part_except_at_the_early_switch(name, solved):
    """At every instant, by the gait and by the stretches that were solved for; section 2.1."""
    problem = cosserat.case(name).problem
    thin = [instant.time for instant in problem.thin_anchors()]
    fat = fatness_of_the_anchor(solved[name])
    if not name.endswith("_early"):
        assert thin == []
        assert problem.thin_anchor_warning() is None
        assert fat.min() > 0.5  # beside a front that has just entered the layer takes its share
        return
    assert len(thin) == 10
    assert (thin[0], thin[-1]) == pytest.approx((1.10, 1.55))
    assert (fat < 0.5).sum() == 10 * problem.strides


def test_a_thin_anchor_is_warned_of_with_its_instants():
    said = cosserat.case("worm_early").problem.thin_anchor_warning()
    assert said.startswith("thin anchor: at 10 of 100 instants of a stride (t = 1.1 to 1.55 s)")
    assert "the point that holds on, xi = 0 m, lies where the body is thin" in said
    assert said.endswith(
        "; move 'gait.anchor' to a thicker part, or exchange 'gait.gamma' and 'gait.eta'"
    )
    twice = [[[0, 0.75], [0.1, 0.65]], [[0.1, 0], [0.2, 0]], [[0.2, 0.6], [0.3, 0.5]]]
    twice += [[[0.3, 0], [1, 0]], [[1, 1], [2, 1]]]
    said = WORM.vary("x", gait={"anchor": twice}).problem.thin_anchor_warning()
    assert "(t = 0.35 to 0.63 s and 0.95 to 1.55 s)" in said
    same = WORM.vary("x", loads={"anchoring": 0, "advancing": 0}, gait={"anchor": twice})
    assert same.problem.thin_anchors() == []  # nothing makes one part thinner than another


def test_a_pneumatic_robot_moves_by_the_closed_form_and_anchors_in_inflated_regions():
    """Section 2.7: D = 0 and p < 0.  Inflated regions are short and fat, so the robot's fronts change their places."""
    robot = cosserat.case("soft_robot")
    own = robot.problem.gait
    swapped = {"gamma": own.eta, "eta": own.gamma, "at_rest": "advancing"}
    inflated = {"anchoring": 0, "advancing": "-2 kPa"}
    forwards = robot.vary("forwards", loads=inflated, gait=swapped)
    backwards = robot.vary("backwards", loads=inflated)
    assert forwards.problem.thin_anchors() == []
    both = [m for m in own.instants(robot.problem.step) if len(m.regions) > 1]
    assert [m.time for m in backwards.problem.thin_anchors()] == [m.time for m in both]
    assert "xi = 0 to 0.254 m, lies where" in backwards.problem.thin_anchor_warning()
    young, poisson, radius, length = 10e3, 0.3, 2.54e-2, 25.4e-2
    area, half = np.pi * radius**2, young / (1 + poisson)
    rod = PushPullRod(
        k_s=half * (1 - poisson) / (1 - 2 * poisson) * area,  # (2.6.20)
        k_p=half * poisson / (1 - 2 * poisson) * area,
        k_g=half * np.pi * radius**4 / 8,
        length=length,
        radius=radius,
        weight=1e3 * area * 9.81,
        anchoring=0.0,
        advancing=-2e3 * area,
    )
    # the rear part is inflated until eta has come to a quarter: its mirror image is inflated before the junction
    pushed = rod.stretched_length(0.75 * length) - rod.stretched_length(0.0)
    moved = strides(cosserat.run(forwards))
    np.testing.assert_allclose(moved, pushed, atol=1e-8)
    assert pushed > 0.02
    pulled = rod.stretched_length(0.25 * length) - rod.stretched_length(length)
    np.testing.assert_allclose(strides(cosserat.run(backwards)), pulled, atol=1e-8)
    assert pulled < -0.02


@pytest.mark.parametrize("name", CRAWLS)
def test_gaits_are_periodic(name, solved):
    data, problem = solved[name], cosserat.case(name).problem
    count = (data.sizes["time"] - 1) // problem.strides
    for variable in ("mu_1", "mu_2", "mu_3", "advancing"):
        values = data[variable].to_numpy()
        for k in range(1, problem.strides):
            np.testing.assert_allclose(
                values[k * count : (k + 1) * count + 1][1:], values[1 : count + 1], atol=1e-9
            )
    lengths = strides(data)
    settled = lengths[1:] if name == "worm_clipped" else lengths  # its fronts begin inside the body
    np.testing.assert_allclose(settled, settled[0], rtol=1e-10)


@pytest.mark.parametrize("name", [name for name in CRAWLS if not name.endswith("_reference")])
def test_the_stride_does_not_depend_on_the_time_step_once_events_are_on_the_grid(name):
    """An anchor between the fronts lies on a plateau without a change of stretch: any point of it may be the anchor."""
    case = cosserat.case(name)
    count = 2 if name == "worm_clipped" else 1  # its first stride begins elsewhere
    lengths = [
        strides(cosserat.run(case.vary("x", strides=count, step=fraction * case.problem.step)))[-1]
        for fraction in (4, 1)
    ]
    np.testing.assert_allclose(lengths, lengths[0], rtol=1e-9)


def test_events_off_the_time_grid_cost_millimetres():
    """The switch at t_p/3 put one step of 0.05 s later."""
    late = 1 / 3 + 0.05 / 3.15
    anchor = [[[0, 0.75], [late, 0.75 - 0.75 * late]], [[late, 0], [1, 0]], [[1, 1], [2, 1]]]
    early = cosserat.case("worm_early")
    moved = cosserat.run(early.vary("x", strides=1, gait={"anchor": anchor}))
    assert strides(moved)[0] - strides(cosserat.run(early.vary("y", strides=1)))[0] > 1e-3


def test_a_crawl_run_backwards_in_mirror_image_is_the_same_crawl():
    """Fronts that travel forward through a mirrored body carry it as far to the other side."""

    def mirrored(tracks):
        return [[[p, 1 - z] for p, z in track] for track in tracks]

    own = WORM.problem.gait
    mirror = WORM.vary(
        "mirror",
        strides=1,
        gait={"gamma": mirrored(own.eta), "eta": mirrored(own.gamma), "anchor": mirrored(own.anchor)},
    )
    one = cosserat.run(WORM.vary("x", strides=1))
    other = cosserat.run(mirror)
    np.testing.assert_allclose(other.mu_1[:, ::-1], one.mu_1, atol=1e-8)
    moved = other.along - other.along[0, 125]
    kept = one.along - one.along[0, 125]
    np.testing.assert_allclose(-moved[:, ::-1], kept, atol=1e-9)


def test_progress_is_reported_and_a_failing_instant_is_named():
    told = []
    cosserat.run(
        WORM.vary("x", strides=2, step=1),
        progress=lambda fraction, words: told.append((fraction, words)),
    )
    done = [one for one in told if "instants" in one[1]]  # beside iterations where the machine is slow
    assert done == [(k / 7, f"{k} of 7 instants") for k in range(1, 8)]  # of both strides
    with pytest.raises(
        InputError, match=r"case 'x' at t = 5.25 s: 'loads.advancing' = 60000 Pa and a weight"
    ):
        cosserat.run(cosserat.case("soft_robot").vary("x", loads={"advancing": 6e4}))


@pytest.mark.parametrize("ramp", [0, 3.15])
def test_strides_are_those_of_a_gait_that_says_each_of_them(ramp):
    """An instant is solved once for all strides; a gait of three strides as one solves every one of them."""
    gait = WORM.problem.gait
    one = WORM.problem.replace(gait=gait.replace(ramp=ramp), step=0.8, strides=3).solve("x")
    long = {
        name: tuple(
            tuple((phase + 2 * stride, place) for phase, place in track)
            for stride in range(3)
            for track in getattr(gait, name)
        )
        for name in ("gamma", "eta", "anchor")
    }
    whole = gait.replace(phases=3 * gait.phases, ramp=ramp, **long)
    every = WORM.problem.replace(gait=whole, step=0.8, strides=1).solve("x")
    assert every.statistics["newton_iterations"] > one.statistics["newton_iterations"]
    for name in ("time", "mu_1", "mu_2", "mu_3", "along", "anchor", "anchor_along", "p_coelom"):
        scale = np.abs(every[name]).max()
        np.testing.assert_allclose(one[name] / scale, every[name] / scale, rtol=0, atol=1e-10)


def test_a_gait_is_checked_and_divided_once_for_all_cases_that_share_it(monkeypatch):
    worm = WORM.problem.replace(step=0.3)
    before = worm.gait.instants(0.3)
    monkeypatch.setattr(Gait, "_check_anchor", None)
    monkeypatch.setattr(Gait, "regions", None)
    heavier = worm.replace(loads=worm.loads.replace(gravity=20))
    assert heavier.gait.instants(0.3) is before
    with pytest.raises(TypeError):
        heavier.gait.replace(clearance=1e-7)


@pytest.mark.parametrize(
    ("name", "changes", "sentence"),
    [
        (
            "soft_robot",
            {"loads": {"advancing": "14 kPa"}},
            r"case 'x' at t = 5.25 s: 'loads.advancing' = 14000 Pa and a weight of 19.9 N/m would collapse",
        ),
        (
            "soft_robot",
            {"loads": {"advancing": "14 kPa"}, "solver": "collocation"},
            r"case 'x' at t = 5.25 s: 'loads.advancing' = 14000 Pa",
        ),
        (
            "soft_robot",
            {"loads": {"anchoring": "25 N"}},
            r"case 'x' at t = 0 s: 'loads.anchoring' = 25 N .* \(mu_3 falls to zero\)",
        ),
        (
            "worm",
            {"loads": {"advancing": "40 kPa", "advancing_force": "none"}},
            r"case 'x' at t = 0 s: 'loads.advancing' = 40000 Pa",
        ),
        (
            "worm_of_one_gram",
            {"body_mass": 0.01, "worm": {"loads": {"gravity": 400, "anchoring": 0}}},
            r"case 'x' at t = 0 s: 'loads.advancing' = 1356.6 Pa and a weight of 16 N/m would collapse",
        ),
    ],
)
def test_a_crawl_that_will_collapse_is_refused_before_its_first_solve(
    name, changes, sentence, monkeypatch
):
    def never(*_):
        raise AssertionError("solved")

    for solver in ("solve", "collocate"):
        monkeypatch.setattr(f"cosserat.peristalsis.instant.{solver}", never)
    with pytest.raises(InputError, match=sentence):
        cosserat.run(CASES[name].vary("x", **changes))


def test_a_copy_of_a_gait_has_times_of_its_own():
    gait = cosserat.case("worm").problem.gait
    assert gait.time(1.5) == pytest.approx(3.15 + 1.75 / 2)
    assert gait.model_copy(update={"phases": (2.0, 1.75)}).time(1.5) == pytest.approx(2 + 1.75 / 2)


def test_doubling_the_mesh_changes_no_row_by_a_tenth_of_its_tolerance(solved):
    """The change is below a tenth of the tolerance, and below half of the last digit of another number found.

    Of a crawl whose strides are alike the finer mesh has one.
    """
    rows = [
        row
        for row in read_table(ROOT / "results/tolerances.csv")
        if row.id.startswith("2.") and row.kind != "arithmetic"
    ]
    fine = {}
    for name in {row.case for row in rows}:
        if name in published_studies():
            fine[name] = result(name, Change("", (), ("worm.mesh.elements",), lambda _: 12))
            continue
        mesh = {"elements": 12}
        case = cosserat.case(name)
        own = case.problem.kind in ("crawl", "posture")
        alike = case.problem.kind == "crawl" and np.ptp(strides(solved[name])) < 1e-9
        one = {"strides": 1} if alike else {}
        fine[name] = cosserat.run(
            case.vary(name, **({"mesh": mesh, **one} if own else {"worm": {"mesh": mesh}}))
        )
    assert len(rows) > 40
    for row in rows:
        coarse, refined = judge(row, solved), judge(row, fine)
        scale = abs(coarse.expected) if row.tolerance_kind == "rel" else 1.0
        moved = abs(coarse.measured - refined.measured)
        assert moved <= 0.1 * row.tolerance * scale, row.id
        assert row.found_tolerance is None or moved <= 0.5 * row.found_tolerance, row.id


@pytest.mark.parametrize("name", ["worm", "worm_printed", "worm_balanced"])
def test_values_found_outside_agree_with_collocation(name):
    """Solved in the thesis's way, at both contractions and the ends of a stride, to the last digit of the rows."""
    rows = [row for row in read_table(ROOT / "results/tolerances.csv") if row.case == name and row.found]
    way = {"solver": "collocation", "collocation_tolerance": 1e-5, "strides": 1, "step": 0.875}
    data = {name: cosserat.run(cosserat.case(name).vary(name, **way))}
    assert len(rows) >= 4
    for row in rows:
        assert abs(judge(row, data).measured - row.found) <= row.found_tolerance, row.id


# ---------------------------------------------------------------- worms of every size


def test_scaling_laws_are_those_of_table_2_1():
    for value, printed, digits in (
        (stance_time(0.01), 1.75, 0.005),
        (protrusion_time(0.01), 3.15, 0.005),
        (resting_length(0.01), 0.250, 0.001),
        (resting_diameter(0.01), 7.6e-3, 0.06e-3),
    ):
        assert value == pytest.approx(printed, abs=digits)


def test_only_muscles_of_constant_stress_scale_like_an_earthworm(solved):
    known = {
        "stride_exponent": 0.40,
        "speed_slope": 0.33,
        "strain_along_slope": 0.0,
        "strain_across_slope": 0.0,
    }
    distance = {
        name: max(abs(READOUTS[key](solved[name]).measured - value) for key, value in known.items())
        for name in ("worm_masses", "worm_masses_constant_pressure", "worm_masses_strip")
    }
    assert distance["worm_masses"] < 0.01
    assert slope(solved["worm_masses"], "frequency") == pytest.approx(-0.07, abs=6e-3)  # by Table 2.1
    assert min(distance["worm_masses_constant_pressure"], distance["worm_masses_strip"]) > 0.1


def test_the_exponent_of_a_strain_is_not_that_of_the_stretch():
    """Strains of 0.6 m^0.1 grow with the power 0.1; the stretches with about a third of it."""
    mass = np.array([1e-5, 1e-4, 1e-3, 1e-2])
    most, least = 1 + 0.6 * (mass / 0.01) ** 0.1, np.ones(4)
    data = xr.Dataset(
        {"mu_3_most": ("mass", most), "mu_3_least": ("mass", least)}, {"body_mass": ("mass", mass)}
    )
    assert READOUTS["strain_along_slope"](data).measured == pytest.approx(0.1)
    assert slope(data, "mu_3_most") < 0.04


def test_scaled_worms_have_the_loads_of_their_law():
    for law, (force, pressure) in MUSCLE_LAWS.items():
        big, small = (
            base_of("worm_masses").vary("x", muscles=law, body_mass=mass).problem.scaled()
            for mass in (0.01, 0.001)
        )
        grown = big.crawler.radius / small.crawler.radius
        assert big.loads.anchoring / small.loads.anchoring == pytest.approx(grown**force)
        assert big.loads.advancing / small.loads.advancing == pytest.approx(grown**pressure)
        assert big.crawler.mass == 0.01
        assert small.gait.duration == pytest.approx(stance_time(0.001) + protrusion_time(0.001))
