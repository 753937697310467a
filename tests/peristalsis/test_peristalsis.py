"""Chapter 2: materials, muscles, boundary value problems on regions by two solvers, and their invariants."""

import numpy as np
import pytest
from conftest import base_of
from hypothesis import given
from hypothesis import strategies as st

import cosserat
from cosserat.errors import InputError, NotConvergedError
from cosserat.peristalsis import doublets
from cosserat.peristalsis.crawler import Compressible, Crawler, Groups, Incompressible, Loads
from cosserat.peristalsis.instant import InstantProblem, Region
from cosserat.solvers import collocation
from cosserat.solvers.regions import RegionSettings

WORM = cosserat.case("worm").problem
ROBOT = cosserat.case("soft_robot").problem
BODIES = {"worm": WORM, "robot": ROBOT}
FINE = RegionSettings(elements=12, degree=10)
Z = np.linspace(0, 1, 2001)

PATTERNS = {
    "one": [("anchoring", 1.0)],
    "one advancing": [("advancing", 1.0)],
    "two": [("anchoring", 0.4), ("advancing", 1.0)],
    "thesis": [("anchoring", 0.25), ("advancing", 0.75), ("anchoring", 1.0)],
    "worm": [("advancing", 0.3), ("anchoring", 0.8), ("advancing", 1.0)],
    "six": [(("anchoring", "advancing")[k % 2], (k + 1) / 6) for k in range(6)],
}


def instant(problem, pattern, **loads):
    cuts = [0.0, *(right for _, right in PATTERNS[pattern])]
    regions = [
        Region(left, right, load)
        for left, (load, right) in zip(cuts[:-1], PATTERNS[pattern], strict=True)
    ]
    return InstantProblem(problem.crawler, problem.loads.replace(**loads), regions, "test")


@pytest.mark.parametrize("contact", ["weight", "printed"])
@pytest.mark.parametrize("name", BODIES)
def test_a_long_body_is_in_balance_with_its_loads_and_its_layers_decay_by_the_largest_eigenvalue(
    name, contact
):
    """The compiled states: the right-hand sides are zero there, and LAPACK finds the same eigenvalues."""
    problem = instant(BODIES[name], "six", contact=contact)
    (mu, shortest), spans = problem.plateaus, np.arange(6)
    local = problem.local(spans, spans / 6 + 0.1)
    f, df, _ = problem.source(mu, local, local.force / mu.prod(axis=1))
    assert np.abs(f / problem.groups.stiffness).max() < 1e-14
    assert np.ptp(mu[:, 0]) > 0.1  # of loads that matter
    fastest = np.abs(np.linalg.eigvals(df)).max()
    assert shortest == pytest.approx(1 / np.sqrt(fastest), rel=1e-13)


# ---------------------------------------------------------------- materials (section 2.6)


def sources(groups, mu, **given_):
    """f, df, mu_3 at one point."""
    one = {key: np.array([value]) for key, value in given_.items()}
    if groups.incompressible:
        return groups.incompressible_source(np.array([mu]), one["lam"], np.ones(1), one["c"])
    return groups.compressible_source(np.array([mu]), one["n"], one["c"])


def rest(groups, **given_):
    """The homogeneous state in which f vanishes."""
    mu = np.ones(2)
    for _ in range(30):
        f, df, mu_3 = sources(groups, mu, **given_)
        mu = mu - np.linalg.solve(df[0], f[0])
    return mu, mu_3[0]


@pytest.mark.parametrize(
    "material",
    [
        {"young": 1e4, "poisson": 0.3},
        {"young": 1e4, "bulk": 1e4 / (3 * 0.4)},
        {"poisson": 0.3, "bulk": 1e4 / (3 * 0.4)},
    ],
)
def test_thought_experiments_of_section_2_6_recover_the_moduli(material):
    body = Crawler(length=0.3, radius=0.02, mass=0, material=Compressible(**material))
    k_s, k_p, k_g = body.stiffnesses
    assert k_g == pytest.approx(1e4 * np.pi * 0.02**4 / (8 * 1.3))  # (2.6.21)
    groups = Groups.of(body, Loads(anchoring=0, advancing=0))
    pull, squeeze = 0.05, 20.0
    mu, mu_3 = rest(groups, n=pull / k_s, c=0.0)
    assert pull / body.area / (mu_3 - 1) == pytest.approx(1e4)  # (2.6.3)
    assert -(mu - 1) / (mu_3 - 1) == pytest.approx([0.3, 0.3])  # (2.6.6)
    square = body.length**2 / k_g
    mu, mu_3 = rest(groups, n=-squeeze * body.area / k_s, c=squeeze * body.area * square)
    volume = mu.sum() + mu_3 - 3
    assert -squeeze / volume == pytest.approx(
        1e4 / (3 * (1 - 2 * 0.3))
    )  # (2.6.14), kappa of linear elasticity
    assert (k_s + 2 * k_p) / (3 * body.area) == pytest.approx(
        -squeeze / volume
    )  # (2.6.15) with erratum E2.6


@pytest.mark.parametrize(
    ("material", "sentence"),
    [
        ({"young": 1e4}, "has young; give two of young, poisson and bulk"),
        ({"young": 1e4, "poisson": 0.3, "bulk": 1e4}, "has young, poisson, bulk; give two"),
        ({"young": 1e4, "poisson": 0.5}, "'poisson' is 0.5; it must be below 0.5"),
        ({"young": 1e4, "poisson": -1}, "'poisson' is -1; it must be above -1"),
        ({"young": 1e5, "bulk": 1e4}, "it must be above -1 and below 1/2"),
    ],
)
def test_impossible_moduli_are_refused(material, sentence):
    with pytest.raises(InputError, match=sentence):
        Compressible.read(material, "material", units_required=False)


# ---------------------------------------------------------------- forces are gradients


def potential(problem, mu, n, pressure, contact):
    """Energy (2.3.1), or the quadratic one under (2.4.3), less what the loads do, over k_G / l_0^2, mu_3 eliminated."""
    body = problem.crawler
    if isinstance(body.material, Compressible):
        k_s, k_p, k_g = body.stiffnesses
        mu_3 = 1 + n / k_s - k_p / k_s * (mu.sum() - 2)
        e1, e2, e3 = mu[0] - 1, mu[1] - 1, mu_3 - 1
        w = k_s / 2 * (e1**2 + e2**2 + e3**2) + k_p * (e1 * e2 + e1 * e3 + e2 * e3)
    else:
        k_i, k_g = body.incompressible_stiffnesses
        mu_3 = 1 / mu.prod()
        e1, e2 = mu[0] - 1, mu[1] - 1
        w = k_i * (e1**2 + e2**2 + e1 * e2)
    total = w - n * (mu_3 - 1) + pressure * body.area * mu.sum() + body.radius * contact * mu[0]
    return total * body.length**2 / k_g


@pytest.mark.parametrize("name", BODIES)
@given(st.integers(0, 1000))
def test_sources_are_the_gradient_of_a_potential_and_their_derivative_is_its_hessian(name, seed):
    problem = BODIES[name]
    rng = np.random.default_rng(seed)
    mu = rng.uniform(0.6, 1.4, 2)
    body = problem.crawler
    groups = Groups.of(body, problem.loads)
    n = -problem.loads.anchoring * rng.uniform(0, 1)
    pressure = problem.loads.advancing * rng.uniform(0, 1)
    contact = body.line_density * problem.loads.gravity
    c = groups.c * pressure / problem.loads.advancing

    def at(state):
        if groups.incompressible:
            fraction = -n / problem.loads.anchoring * groups.force
            return sources(groups, state, lam=-fraction / state.prod(), c=c)
        return sources(groups, state, n=n / body.stiffnesses[0], c=c)

    f, df, _ = at(mu)
    h = 1e-5
    for k in range(2):
        shift = h * np.eye(2)[k]
        slope = potential(problem, mu + shift, n, pressure, contact) - potential(
            problem, mu - shift, n, pressure, contact
        )
        assert slope / (2 * h) == pytest.approx(f[0, k], rel=1e-6, abs=1e-5 * groups.stiffness)
        column = (at(mu + shift)[0][0] - at(mu - shift)[0][0]) / (2 * h)
        np.testing.assert_allclose(column, df[0, :, k], rtol=1e-6, atol=1e-6 * groups.stiffness)
    np.testing.assert_allclose(df[0], df[0].T)


@pytest.mark.parametrize("name", BODIES)
def test_the_derivative_with_the_printed_contact(name):
    problem = BODIES[name]
    groups = Groups.of(problem.crawler, problem.loads.replace(contact="printed"))
    known = (
        {"lam": -0.7 * groups.force, "c": groups.c}
        if groups.incompressible
        else {"n": -0.01, "c": groups.c}
    )
    mu, h = np.array([0.9, 1.1]), 1e-6
    if groups.incompressible:
        _, df, _ = groups.incompressible_source(
            np.array([mu]), np.array([known["lam"]]), np.zeros(1), np.array([known["c"]])
        )
    else:
        _, df, _ = sources(groups, mu, **known)
    for k in range(2):
        shift = h * np.eye(2)[k]
        column = (sources(groups, mu + shift, **known)[0] - sources(groups, mu - shift, **known)[0]) / (
            2 * h
        )
        np.testing.assert_allclose(column[0], df[0, :, k], rtol=1e-6, atol=1e-7 * groups.stiffness)


# ---------------------------------------------------------------- muscles as doublets (section 2.2)


def test_the_contact_force_balances_the_muscles():
    xi = np.linspace(0, 1, 20_001)
    centres, width = doublets.row(0.2, 0.8, 7)
    force = doublets.load(xi, centres, width, 2.0)
    n = -np.concatenate([[0], np.cumsum((force[1:] + force[:-1]) / 2 * np.diff(xi))])  # (2.2.6)
    np.testing.assert_allclose(n, doublets.contact_force(xi, centres, width, 2.0), atol=2e-3)


def test_rows_of_muscles_tend_to_a_constant_force_with_first_order():
    xi = np.linspace(0, 1, 20_001)
    limit = np.where((xi > 0.2) & (xi < 0.8), -2.0, 0.0)  # (2.2.7)
    distance = []
    for count in (20, 40, 80, 160):
        centres, width = doublets.row(0.2, 0.8, count)
        n = doublets.contact_force(xi, centres, width, 2.0)
        inside = (xi >= centres[0]) & (xi <= centres[-1])
        np.testing.assert_allclose(n[inside], -2.0, atol=1e-12)
        distance.append(np.abs(n - limit).mean())
    np.testing.assert_allclose(np.diff(np.log2(distance)), -1, atol=0.05)


def test_a_window_of_muscles_pushes_its_neighbours_with_its_whole_force_at_either_end():
    xi = np.linspace(0, 1, 20_001)
    centres, width = doublets.row(0.2, 0.8, 100)
    force = doublets.load(xi, centres, width, 2.0)
    step = xi[1] - xi[0]
    middle = (xi > 0.3) & (xi < 0.7)
    assert force[xi < 0.5].sum() * step == pytest.approx(2.0, rel=0.01)  # at the rear end of the window
    assert force[xi > 0.5].sum() * step == pytest.approx(-2.0, rel=0.01)
    assert abs(force[middle].sum() * step) < 0.01


# ---------------------------------------------------------------- states


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("solver", ["banded", "collocation"])
@pytest.mark.parametrize("pattern", ["one", "thesis"])
def test_without_load_and_weight_the_reference_is_exact(name, solver, pattern):
    idle = instant(BODIES[name], pattern, anchoring=0, advancing=0, gravity=0)
    if solver == "banded":
        profile, _ = idle.solve(RegionSettings(), None)
    else:
        profile = idle.collocate(RegionSettings(), 1e-6)
    rounding = 0 if solver == "banded" else 1e-14  # SciPy evaluates a spline
    assert np.abs(profile.mu - 1).max() <= rounding
    assert np.abs(profile.mu_3 - 1).max() <= rounding
    np.testing.assert_allclose(
        BODIES[name].length_along(profile), profile.mesh.places * BODIES[name].crawler.length, atol=1e-15
    )


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("contact", ["weight", "printed"])
def test_both_solvers_agree_on_any_sequence_of_regions(name, pattern, contact):
    problem = instant(BODIES[name], pattern, contact=contact)
    banded, _ = problem.solve(RegionSettings(), None)
    reference = problem.collocate(FINE, 1e-5)
    for ours, theirs in zip(banded.at(Z), reference.at(Z), strict=True):
        if ours.shape == (Z.size, 2) and np.abs(theirs).max() > 5:
            continue  # slopes, in 1 / l_0
        assert np.abs(ours - theirs).max() < 1e-6 * max(1, np.abs(theirs).max())


@pytest.mark.parametrize("pattern", ["two", "thesis", "worm", "six"])
def test_both_solvers_agree_on_the_printed_multiplier(pattern):
    problem = instant(WORM, pattern, multiplier="printed", contact="printed")
    banded, _ = problem.solve(RegionSettings(), None)
    reference = problem.collocate(FINE, 1e-5)
    assert banded.effort <= 8
    assert np.abs(banded.at(Z)[0] - reference.at(Z)[0]).max() < 1e-6
    assert np.abs(banded.at(Z)[2] - reference.at(Z)[2]).max() < 1e-6


def test_the_banded_solver_converges_with_the_mesh():
    problem = instant(WORM, "thesis")
    reference = problem.solve(RegionSettings(elements=24, degree=10), None)[0].at(Z)[0]
    errors = [
        np.abs(problem.solve(RegionSettings(elements=n, degree=4), None)[0].at(Z)[0] - reference).max()
        for n in (12, 24, 48)
    ]
    assert errors[0] < 1e-5
    assert (np.diff(np.log2(errors)) < -3).all()


def test_a_volume_force_is_constant_where_circular_muscles_act():
    """lambda_c mu_1 mu_2 = n, here of the solver that integrates lambda_c."""
    profile = instant(WORM, "thesis").collocate(FINE, 1e-6)
    n = profile.multiplier * profile.mu.prod(axis=2)
    delta = Groups.of(WORM.crawler, WORM.loads).force
    np.testing.assert_allclose(n, -delta, rtol=1e-7)


@pytest.mark.parametrize("multiplier", ["balanced", "printed"])
def test_the_incompressible_rod_keeps_the_product_of_its_stretches(multiplier):
    profile, _ = instant(WORM, "worm", multiplier=multiplier).solve(RegionSettings(), None)
    np.testing.assert_allclose(profile.mu.prod(axis=2) * profile.mu_3, 1, rtol=4e-16)


@pytest.mark.parametrize("name", ["worm", "worm_printed", "worm_at_rest", "worm_reference"])
def test_the_stored_stretches_keep_their_product_and_agree_with_the_pressure(name):
    """In the Dataset, between the points of the mesh; the contact force that p_coelom holds is constant there too."""
    problem = cosserat.case(name)
    if problem.problem.kind == "crawl":
        problem = problem.vary("x", strides=1, step="0.35 s")
    data = cosserat.run(problem)
    product = (data.mu_1 * data.mu_2 * data.mu_3).to_numpy()
    np.testing.assert_allclose(product, 1, rtol=1e-15)
    if name == "worm":
        body, loads = problem.problem.crawler, problem.problem.loads
        k_i, _ = body.incompressible_stiffnesses
        passive = k_i * (2 - data.mu_1 - data.mu_2) * data.mu_1 * data.mu_2
        force = (
            passive - data.p_coelom * body.area
        ).to_numpy()  # lambda_c^I mu_1 mu_2, (2.8.8), (2.8.9)
        np.testing.assert_allclose(force, -loads.anchoring, rtol=1e-12)


def test_the_true_volume_changes_only_where_sections_tilt():
    """(d_1 x d_2) . r' = mu_1 mu_2 mu_3 cos(theta): less than one in the layers."""
    profile, _ = instant(WORM, "thesis").solve(FINE, None)
    sine = profile.slope[..., 0] * WORM.crawler.radius / WORM.crawler.length / profile.mu_3
    volume = np.sqrt(1 - sine**2)
    far = np.min(np.abs(profile.mesh.places[..., None] - [0.25, 0.75]), axis=-1) > 0.03
    assert volume.min() == pytest.approx(0.75, abs=0.01)
    assert (1 - volume[far]).max() < 1e-9
    lost = 1 - profile.mesh.cumulative(volume)[-1, -1]
    assert 1e-4 < lost < 2e-3


@pytest.mark.parametrize("name", BODIES)
def test_a_mirrored_pattern_gives_the_mirrored_state(name):
    one = instant(BODIES[name], "two")
    other = InstantProblem(
        BODIES[name].crawler,
        BODIES[name].loads,
        [Region(0, 0.6, "advancing"), Region(0.6, 1, "anchoring")],
        "test",
    )
    a, b = one.solve(RegionSettings(), None)[0], other.solve(RegionSettings(), None)[0]
    np.testing.assert_allclose(a.at(Z)[0], b.at(1 - Z)[0], atol=1e-10)


def test_a_vanishing_region_changes_nothing_in_the_limit():
    """The rule that drops regions shorter than the clearance is the limit of keeping them."""
    alone = InstantProblem(WORM.crawler, WORM.loads, [Region(0, 1, "anchoring")], "test").solve(
        RegionSettings(), None
    )[0]
    change = []
    for short in (1e-4, 1e-5, 1e-6):
        regions = [Region(0, 1 - short, "anchoring"), Region(1 - short, 1, "advancing")]
        profile = InstantProblem(WORM.crawler, WORM.loads, regions, "test").solve(
            RegionSettings(), None
        )[0]
        change.append(np.abs(profile.at(Z)[0] - alone.at(Z)[0]).max())
    assert change[0] < 0.02
    np.testing.assert_allclose(np.diff(np.log10(change)), -1, atol=0.05)


def nearly_incompressible(poisson, fraction):
    """Largest difference of a stretch between the worm and a robot of that Poisson's ratio, under a part of the loads.

    Both have the junctions of section 2.4.  derived: at nu = 1/2 the robot keeps the sum of the stretches, (2.3.2), the
    worm their product, (2.4.1); they differ by products of two strains.
    """
    weak = WORM.loads.replace(
        anchoring=fraction * WORM.loads.anchoring,
        advancing=fraction * WORM.loads.advancing,
        gravity=fraction * WORM.loads.gravity,
        advancing_force="continuous",
    )
    soft = Compressible(young=WORM.crawler.material_young, poisson=poisson)
    regions = [
        Region(0, 0.25, "anchoring"),
        Region(0.25, 0.75, "advancing"),
        Region(0.75, 1, "anchoring"),
    ]
    mu = [
        InstantProblem(body, weak, regions, "test").solve(RegionSettings(), None)[0].at(Z)[0]
        for body in (WORM.crawler, WORM.crawler.replace(material=soft))
    ]
    return np.abs(mu[0] - mu[1]).max()


def test_for_small_loads_the_compressible_rod_tends_to_the_incompressible_one_with_first_order():
    distance = [nearly_incompressible(0.5 - gap, 1e-6) for gap in (1e-2, 1e-3, 1e-4)]
    np.testing.assert_allclose(np.diff(np.log10(distance)), -1, atol=0.001)


def test_at_finite_loads_the_linear_volume_separates_the_two_rods():
    """(2.2.14) in the one, (2.2.13) in the other: what remains at nu = 1/2 grows with the square of the load."""
    remains = [nearly_incompressible(0.5 - 1e-7, fraction) for fraction in (1.25e-2, 2.5e-2, 5e-2)]
    np.testing.assert_allclose(np.diff(np.log2(remains)), 2, atol=0.01)


# ---------------------------------------------------------------- what is refused


def test_neither_solver_returns_an_unconverged_answer(monkeypatch):
    """Both name the loads and the junctions, the parameters that may be out of reach, (2.3.19)."""
    problem = instant(WORM, "thesis")
    known = (
        r"test with 'loads.anchoring' = 0.02616 N, 'loads.advancing' = 1356.6 Pa and regions that meet at 0.25 and "
        r"0.75: "
    )
    with pytest.raises(NotConvergedError, match=known + "no solution on the regions found"):
        problem.solve(RegionSettings(max_iterations=1), None)
    monkeypatch.setattr(collocation, "_MOST_NODES", 1000)
    with pytest.raises(
        NotConvergedError,
        match=known + r"solve_bvp found no solution \(The maximum number of mesh nodes",
    ):
        problem.collocate(RegionSettings(), 1e-12)


@pytest.mark.parametrize("poisson", [-0.9999999999, -0.99995])
def test_a_material_that_hardly_resists_a_change_of_volume_is_refused_by_its_poisson_ratio(poisson):
    sentence = rf"has a Poisson's ratio nu = {poisson}; it must be above -0.9999: .*\(2.3.19\)"
    with pytest.raises(InputError, match=sentence):
        cosserat.case("soft_robot").vary("x", crawler={"material": {"poisson": poisson}})


def test_both_solvers_agree_near_the_refused_poisson_ratio():
    near = ROBOT.replace(
        crawler=ROBOT.crawler.replace(material=Compressible(young=1e4, poisson=-0.9998))
    )
    problem = instant(near, "thesis", anchoring=0.05, advancing=300, gravity=0.5)
    banded, _ = problem.solve(RegionSettings(), None)
    reference = problem.collocate(FINE, 1e-5)
    assert np.abs(banded.at(Z)[0] - 1).max() > 0.01
    np.testing.assert_allclose(banded.at(Z)[0], reference.at(Z)[0], atol=1e-6)


@pytest.mark.parametrize(
    ("name", "loads", "sentence"),
    [
        (
            "robot",
            {"advancing": 3e4},
            "'loads.advancing' = 30000 Pa and a weight of 19.9 N/m would collapse the sections",
        ),
        (
            "robot",
            {"anchoring": 25.0},
            r"'loads.anchoring' = 25 N .* would collapse .* \(mu_3 falls to zero\)",
        ),
        ("worm", {"advancing": 2e4, "advancing_force": "none"}, "would collapse the sections"),
    ],
)
def test_loads_that_collapse_a_section_are_refused_before_any_solving(
    name, loads, sentence, monkeypatch
):
    monkeypatch.setattr("cosserat.peristalsis.instant.solve", None)
    with pytest.raises(InputError, match=sentence):
        instant(BODIES[name], "thesis", **loads).solve(RegionSettings(), None)


def test_layers_too_steep_for_the_ground_are_refused():
    steep = base_of("worm_masses_strip").vary("small", body_mass="1 g")
    with pytest.raises(cosserat.CosseratError, match=r"small' at t = 0 s: R mu_1' / mu_3 reaches 1\.1"):
        cosserat.run(steep)


def test_both_solvers_agree_on_instants_of_a_stride():
    """At some instants of the stride; `cosserat speed` compares their times."""
    problem = WORM.replace(strides=1, step=1.0)
    banded = problem.solve("test")
    reference = problem.replace(solver="collocation").solve("test")
    for name in ("mu_1", "mu_2", "mu_3"):
        assert np.abs(banded[name] - reference[name]).max() < 1e-6


def test_incompressible_needs_young_alone():
    assert Incompressible(young=2e3).young == 2e3
    with pytest.raises(InputError, match="'poisson' is not a key"):
        Incompressible.read({"young": 2e3, "poisson": 0.4}, "material", units_required=False)
