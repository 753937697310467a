"""Loads that ramp, chambers with pressures of their own, relaxed regions, measured fronts: closed forms and tables."""

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError
from cosserat.figures.crawlers import RELAXED, nearest, picture
from cosserat.peristalsis.instant import InstantProblem, Region
from cosserat.solvers.regions import RegionSettings

ROBOT, WORM = (cosserat.case(name) for name in ("soft_robot", "worm"))
YOUNG, POISSON, LENGTH = 10e3, 0.3, 0.254
CHAMBERS = [
    {"begin": 0, "end": 0.3, "schedule": [[0, 1, "advancing"]], "pressure": -1e3},
    {"begin": 0.3, "end": 0.6, "schedule": [[0.5, 2, "advancing"]], "pressure": 2e3},
    {"begin": 0.7, "end": 1, "schedule": [[0, 0.5, "advancing"], [1.5, 3, "advancing"]]},
]
GAIT = {
    "phases": [1.0, 2.0, 1.0],
    "gamma": [],
    "eta": [],
    "chambers": CHAMBERS,
    "at_rest": "relaxed",
    "anchor": [[[0, 0], [1, 0]], [[1, 1], [3, 1]]],
}
PUMPED = ROBOT.vary("pumped", gait=GAIT, loads={"anchoring": 0, "advancing": 1.5e3, "gravity": 0})


def mean_mu_3(problem, regions):
    """Mean of mu_3 along the body by the quadrature of the mesh: the layers add nothing, eq. (2.3.2)."""
    profile, _ = InstantProblem(problem.crawler, problem.loads, regions, "x").solve(
        RegionSettings(), None
    )
    return profile.mesh.cumulative(profile.mu_3)[-1, -1]


# ---------------------------------------------------------------- chambers


def smooth(x):
    return 3 * x**2 - 2 * x**3


@pytest.mark.parametrize(("form", "of"), [("linear", lambda x: x), ("smooth", smooth)])
def test_each_chamber_has_its_own_pressure_that_ramps(form, of):
    """Mean strain 2 nu p / E by share of the body; amplitudes from tables of their corners, typed in seconds."""
    problem = PUMPED.vary("x", gait={"ramp": 0.25, "ramp_form": form}).problem
    corners = [
        ([0, 0.25, 0.75, 1, 4], [0, 1, 1, 0, 0], -1e3),
        ([0, 0.5, 0.75, 2.75, 3, 4], [0, 0, 1, 1, 0, 0], 2e3),
        ([0, 0.25, 0.5, 2, 2.25, 4], [1, 1, 0, 0, 1, 1], 1.5e3),  # goes on from a stride to the next
    ]
    instants = problem.gait.instants(0.2)
    for instant in instants:
        acting = [p * of(np.interp(instant.time, times, part)) for times, part, p in corners]
        strain = 2 * POISSON / YOUNG * 0.3 * sum(acting)
        assert mean_mu_3(problem, instant.regions) - 1 == pytest.approx(strain, abs=1e-12)
    times = [instant.time for instant in instants]
    for corner in {time for row in corners for time in row[0]}:
        assert np.abs(np.array(times) - corner).min() < 1e-9


def test_without_a_ramp_a_load_is_there_at_once():
    regions = PUMPED.problem.gait.regions(0.5)
    assert [(r.load, r.amplitude, r.own) for r in regions] == [
        ("advancing", 1, -1e3),
        ("relaxed", 1, None),
        ("relaxed", 1, None),
        ("advancing", 1, None),
    ]
    assert [r.load for r in PUMPED.problem.gait.regions(0.5 + 1e-6)][1::2] == ["advancing", "relaxed"]
    assert PUMPED.problem.gait.regions(0) == PUMPED.problem.gait.regions(3)


def test_two_chambers_crawl_by_the_closed_form_from_the_first_stride_on():
    """The front half is squeezed while the rear end holds, and relaxed while the front end does: 2 nu p / E of it."""
    chambers = [
        {"begin": 0, "end": 0.5, "schedule": []},
        {"begin": 0.5, "end": 1, "schedule": [[0, 1, "advancing"]]},
    ]
    gait = {"phases": [1, 1], "chambers": chambers, "anchor": [[[0, 0], [1, 0]], [[1, 1], [2, 1]]]}
    thin = PUMPED.vary("x", gait=gait, crawler={"radius": 1e-4}, strides=3, loads={"advancing": 2e3})
    data = cosserat.run(thin)
    head = data.along[[nearest(data, 2 * k) for k in range(4)], -1].to_numpy()
    np.testing.assert_allclose(np.diff(head), LENGTH / 2 * 2 * POISSON * 2e3 / YOUNG, rtol=1e-4)
    assert "warnings" not in data.attrs


def test_loads_of_chambers_are_stored_and_drawn():
    data = cosserat.run(PUMPED.vary("x", strides=1, gait={"ramp": 0.25}))
    now = data.isel(time=nearest(data, 0.125))
    assert now.time == pytest.approx(0.125, abs=0.13)
    z = data.xi_section.to_numpy() / LENGTH
    amplitude = min(1, float(now.time) / 0.25)
    inside = [(z > a + 1e-6) & (z < b - 1e-6) for a, b in ((0, 0.3), (0.3, 0.7), (0.7, 1))]
    for part, pressure in zip(inside, (-1e3 * amplitude, 0, 1.5e3), strict=True):
        np.testing.assert_allclose(now.muscle_pressure[part], pressure, atol=1e-9)
    assert not data.muscle_force.any()
    figure = picture(data)
    assert [ax.get_ylabel() for ax in figure.axes][3:] == [r"$\xi$ [cm]", "pressure [kPa]"]
    colours = [str(c.get_facecolor()) for c in figure.axes[0].collections]
    from matplotlib.colors import to_rgba

    assert any(str(np.array([to_rgba(RELAXED)])) == colour for colour in colours)
    plain = cosserat.run(ROBOT.vary("x", strides=1, step="10 s"))
    assert "muscle_force" not in plain


# ---------------------------------------------------------------- regions of one instant


def resting(regions, **loads):
    return cosserat.case("worm_at_rest").vary("x", regions=regions, loads=loads)


def test_a_relaxed_body_bears_its_weight_alone():
    loaded = {"anchoring": 0.03, "advancing": 1e3}
    relaxed = cosserat.run(resting([{"begin": 0, "end": 1, "load": "relaxed"}], **loaded))
    idle = cosserat.run(cosserat.case("worm_at_rest"))
    for name in ("mu_1", "mu_2", "mu_3", "p_coelom"):
        np.testing.assert_array_equal(relaxed[name], idle[name])
    weightless = resting([{"begin": 0, "end": 1, "load": "relaxed"}], gravity=0, **loaded)
    np.testing.assert_allclose(cosserat.run(weightless).mu_3, 1, atol=1e-14)


def test_a_region_of_its_own_strength_is_that_of_loads_as_strong():
    parts = [(0, 0.4, "anchoring", "force", 0.02), (0.4, 1, "advancing", "pressure", 900.0)]
    own = [{"begin": a, "end": b, "load": load, key: value} for a, b, load, key, value in parts]
    usual = [{"begin": a, "end": b, "load": load} for a, b, load, _, _ in parts]
    one = cosserat.run(resting(own, anchoring=0.05, advancing=3e3))
    other = cosserat.run(resting(usual, anchoring=0.02, advancing=900.0))
    np.testing.assert_array_equal(one.mu_1, other.mu_1)
    np.testing.assert_array_equal(one.muscle_force[:90], 0.02)
    assert "muscle_force" not in other


def test_the_contact_force_is_that_of_the_anchoring_region_behind_else_of_the_one_ahead():
    """n = lambda_c mu_1 mu_2 in N, by the stretches alone: the equation (2.4.4) far inside each region."""
    loads = WORM.problem.loads.replace(gravity=0)
    regions = [
        Region(0, 0.15, "advancing", own=300.0),
        Region(0.15, 0.35, "anchoring", own=0.01),
        Region(0.35, 0.55, "relaxed"),
        Region(0.55, 0.8, "anchoring", amplitude=0.5, own=0.04),
        Region(0.8, 1, "advancing", amplitude=0.5, own=400.0),
    ]
    problem = InstantProblem(WORM.problem.crawler, loads, regions, "x")
    profile, _ = problem.solve(RegionSettings(), None)
    mu, *_ = profile.at(np.array([0.0, 0.25, 0.45, 0.68, 1.0]))
    m, area = mu[:, 0], np.pi * 3.8e-3**2
    pressure = np.array([300, 0, 0, 0, 200])
    n = -(m**3) * (pressure * area + 2 / 3 * 2e3 * area * (3 * m - 3))
    np.testing.assert_allclose(n, [-0.01, -0.01, -0.01, -0.02, -0.02], rtol=1e-5)


# ---------------------------------------------------------------- ramps of fronts, the first stride


@pytest.mark.parametrize(("form", "of"), [("linear", lambda x: x), ("smooth", smooth)])
def test_the_loads_of_fronts_rise_from_a_relaxed_body_in_the_first_stride(form, of):
    """In the pause all of the robot anchors: mu_3 - 1 = -a D / (E A), eq. (2.6.3)."""
    free = ROBOT.vary("x", loads={"gravity": 0}, step="2.5 s")
    risen, plain = cosserat.run(free.vary("x", gait={"ramp": 4, "ramp_form": form})), cosserat.run(free)
    early = risen.time.to_numpy() <= 5
    assert {0.0, 4.0} < set(risen.time.to_numpy()[early].round(9))
    amplitude = of(np.minimum(1, risen.time.to_numpy()[early] / 4))
    expected = 1 - amplitude * 1.0 / (YOUNG * np.pi * 0.0254**2)
    np.testing.assert_allclose(risen.mu_3[early], expected[:, None] * np.ones(251), rtol=1e-12)
    later = [nearest(risen, t) for t in plain.time.to_numpy() if t > 5]
    np.testing.assert_allclose(risen.mu_1[later], plain.mu_1[-len(later) :], atol=1e-9)
    assert (risen.muscle_force[0] == 0).all()


def test_a_first_stride_that_begins_otherwise_is_told():
    clipped = cosserat.case("worm_clipped").problem
    assert clipped.first_stride_warning().startswith(
        "first stride: at t = 0 the loads on 0.04 of the body are"
    )
    assert WORM.problem.first_stride_warning() is None
    tracks = {"phases": [1, 1], "gamma": [[[0, 0.5], [1, 0]]], "eta": [], "sudden": 1}
    tracks["anchor"] = [[[0, 0.9], [2, 0.9]]]
    sudden = ROBOT.vary("x", gait=tracks, strides=1, step="1 s")
    data = cosserat.run(sudden)
    assert "first stride: at t = 0 the loads on 0.5 of the body are not those" in data.attrs["warnings"]
    calm = cosserat.run(sudden.vary("x", gait={"ramp": 0.5}))
    assert "first stride" not in calm.attrs["warnings"]


# ---------------------------------------------------------------- measured fronts


def test_a_gait_from_csv_files_is_the_gait_that_was_measured(tmp_path):
    """The fronts of the worm at their corners, in ms and mm on a body of another length; no file is needed later."""
    own = WORM.problem.gait
    lines = []
    for kind in ("gamma", "eta", "anchor"):
        for number, track in enumerate(getattr(own, kind)):
            rows = [f"{1e3 * own.time(p)!r}, {at * 212!r}, 7" for p, at in track]
            (tmp_path / f"{kind}{number}.csv").write_text(
                "\n".join(["time [ms], front [mm], other", *rows])
            )
            lines.append(f'{{ front = "{kind}", table = "{kind}{number}.csv", length = "212 mm" }},')
    (tmp_path / "my.toml").write_text(
        '[mine]\nlike = "worm"\nstrides = 1\nstep = "1 s"\ngait.gamma = "none"\ngait.eta = "none"\n'
        'gait.anchor = "none"\ngait.measured = [\n' + "\n".join(lines) + "\n]\n"
    )
    case = cosserat.case("mine", tmp_path / "my.toml")
    for file in tmp_path.glob("*.csv"):
        file.unlink()
    data, plain = cosserat.run(case), cosserat.run(WORM.vary("x", strides=1, step="1 s"))
    np.testing.assert_allclose(data.time, plain.time, atol=1e-12)
    for name in ("mu_1", "along", "anchor"):
        np.testing.assert_allclose(data[name], plain[name], atol=1e-8)
    assert cosserat.case_of(data).problem == case.problem


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"gamma": [[[0, 1], [1, 0]]]}, "'gait' has both 'chambers' and fronts; give one of them"),
        (
            {"chambers": [{"begin": 0.4, "end": 0.4, "schedule": []}]},
            "'chambers.0' runs from 0.4 to 0.4; let it",
        ),
        (
            {"chambers": [{"begin": 0.4, "end": 1.1, "schedule": []}]},
            "'chambers.0' runs from 0.4 to 1.1; let it",
        ),
        (
            {"chambers": [CHAMBERS[0], CHAMBERS[0]]},
            "'chambers.1' begins at 0, before the one behind it ends at 0.3",
        ),
        (
            {"chambers": [{**CHAMBERS[0], "schedule": [[0, 1, "relaxed"], [0.5, 2, "advancing"]]}]},
            "'chambers.0' has a 'schedule' whose rows overlap or do not advance; give rows",
        ),
        (
            {"chambers": [{**CHAMBERS[0], "schedule": [[1, 1, "relaxed"]]}]},
            "'schedule' whose rows overlap or do not advance",
        ),
        (
            {"chambers": [{**CHAMBERS[0], "schedule": [[0, 4, "relaxed"]]}]},
            "'schedule' that ends at phase 4, but 'phases' has 3; end it there",
        ),
        (
            {"chambers": [{**CHAMBERS[0], "schedule": [[0, 1, "off"]]}]},
            r"'gait.chambers.0.schedule.0.2' is 'off'; it must be 'anchoring', 'advancing' or 'relaxed'",
        ),
        ({"chambers": [{**CHAMBERS[0], "pressure": "1 N"}]}, "'gait.chambers.0.pressure' is \"1 N\""),
        (
            {"chambers": [{**CHAMBERS[0], "force": -1}]},
            "'gait.chambers.0.force' is -1 N; it must be at least 0",
        ),
        (
            {"ramp": "0.6 s"},
            "'ramp' is 0.6 s, too long for the state 'advancing' of 'chambers.0', which lasts 1 s and rises",
        ),
        ({"ramp": "-1 s"}, "'gait.ramp' is -1 s; it must be at least 0"),
        ({"ramp_form": "cubic"}, "'gait.ramp_form' is 'cubic'; it must be 'linear' or 'smooth'"),
        (
            {"anchor": [[[0, 0.3], [3, 0.3]]]},
            "the anchor lies at 0.3, where two chambers meet that bear different",
        ),
    ],
)
def test_chambers_that_cannot_be_are_refused(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        PUMPED.vary("x", gait=changes)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"ramp": "30 s"}, "'ramp' is 30 s, longer than a stride of 22.5 s; take a shorter one"),
        (
            {"measured": [{"front": "eta", "table": [[0, 0.2], [23, 0]]}]},
            "'measured.0' is at 0 m at 23 s; times run",
        ),
        (
            {"measured": [{"front": "eta", "table": [[0, 0.3], [2, 0]]}]},
            "'measured.0' is at 0.3 m at 0 s; times run",
        ),
        (
            {"measured": [{"front": "tail", "table": [[0, 0.2], [2, 0]]}]},
            "'gait.measured.0.front' is 'tail'; it must",
        ),
        (
            {"measured": [{"front": "eta", "table": "no.csv"}]},
            "'gait.measured.0.table' is the file 'no.csv', which can",
        ),
        (
            {"measured": [{"front": "eta", "table": [[0, 0.2]]}]},
            "'gait.measured.0.table' has 1 row; it needs 2",
        ),
        ({"anchor": []}, "'anchor' has a gap between phases 0 and 4"),
    ],
)
def test_fronts_that_cannot_be_are_refused(changes, sentence):
    for measured in changes.get("measured", []):
        measured["length"] = 0.25
    with pytest.raises(InputError, match=sentence):
        ROBOT.vary("x", gait=changes)


def test_other_faults_are_one_sentence():
    with pytest.raises(
        InputError, match="'regions.0' has a 'force' but is 'advancing'; only an anchoring region"
    ):
        resting([{"begin": 0, "end": 1, "load": "advancing", "force": 1}])
    with pytest.raises(
        InputError, match="'regions.0' has a 'pressure' but is 'relaxed'; only an advancing region"
    ):
        resting([{"begin": 0, "end": 1, "load": "relaxed", "pressure": 1}])
    strong = [{**CHAMBERS[0], "pressure": "60 kPa"}]
    with pytest.raises(
        InputError, match=r"at t = 0.25 s: an own load of 60000 Pa and a weight of 0 N/m would coll"
    ):
        cosserat.run(PUMPED.vary("x", gait={"chambers": strong}))
    wet = {"crawler": {"material": {"kind": "incompressible", "young": 1e4}}}
    with pytest.raises(
        InputError, match="at phase 0 no region anchors, and the force in the advancing ones"
    ):
        PUMPED.vary("x", loads={"anchoring": 1}, **wet)
    PUMPED.vary("x", **wet)  # there is no force that could vanish
