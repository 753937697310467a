"""Bodies whose radius, modulus and muscles vary: closed forms, SciPy's solver, a manufactured solution, energy."""

import itertools

import numpy as np
import pytest
from conftest import base_of
from scipy.integrate import cumulative_simpson, solve_bvp

import cosserat
from cosserat.errors import InputError
from cosserat.export import mesh
from cosserat.figures.crawlers import picture
from cosserat.figures.crawling import animate
from cosserat.peristalsis.instant import InstantProblem, Region
from cosserat.solvers.elements import Mesh
from cosserat.solvers.regions import RegionSettings, Source, solve

ROBOT, WORM = (cosserat.case(name) for name in ("soft_robot", "worm"))
FINE = RegionSettings(elements=12, degree=10)
LENGTH, RADIUS, YOUNG, POISSON = 0.254, 0.0254, 10e3, 0.3


def body_of(case, segments, **changes):
    return case.vary("x", crawler={"segments": segments, **changes}).problem


def stiffnesses(radius, young):
    """k_S, k_P, k_G of (2.6.20) of the robot's material."""
    lame = young * np.pi * radius**2 / ((1 + POISSON) * (1 - 2 * POISSON))
    return (1 - POISSON) * lame, POISSON * lame, young * np.pi * radius**4 / (8 * (1 + POISSON))


# ---------------------------------------------------------------- closed forms


def test_muscles_as_strong_as_the_section_is_stiff_deform_a_varying_body_evenly():
    """No gradients: D over E A, and p over E, are the same everywhere; (2.6.3), (2.6.5) and (2.6.1)."""
    segments = [
        {"length": 0.1, "radius": 0.02, "young": 4e3, "anchoring": 0.4 * (0.02 / RADIUS) ** 2},
        {"length": 0.054, "young": [1e4, 2e4], "anchoring": [1, 2], "advancing": [1, 2]},
        {"length": 0.1, "radius": 0.03, "young": 2e4, "anchoring": 2 * (0.03 / RADIUS) ** 2},
    ]
    segments[0]["advancing"], segments[2]["advancing"] = 0.4, 2
    problem = body_of(ROBOT, segments)
    loads = problem.loads.replace(gravity=0)
    for load, force, pressure in (("anchoring", 1.0, 0.0), ("advancing", 0.0, 6.89e3)):
        whole = [Region(0, 1, load)]
        profile, _ = InstantProblem(problem.crawler, loads, whole, "x").solve(RegionSettings(), None)
        area = np.pi * RADIUS**2
        across = POISSON * force / (YOUNG * area) - pressure * (1 - POISSON) / YOUNG
        along = -force / (YOUNG * area) + 2 * POISSON * pressure / YOUNG
        np.testing.assert_allclose(profile.mu, 1 + across, rtol=1e-12)
        np.testing.assert_allclose(profile.mu_3, 1 + along, rtol=1e-12)


def test_a_step_of_radius_and_modulus_has_the_layers_of_the_closed_form():
    """(w s')' = k (s - s*) of the sum s of both strains; at the step s and k_G s' are continuous, and s' is not."""
    step, sizes = 0.1, ((0.02, 2e4), (0.03, 5e3))
    segments = [
        {"length": length, "radius": radius, "young": young}
        for length, (radius, young) in zip((step, LENGTH - step), sizes, strict=True)
    ]
    problem = body_of(ROBOT, segments)
    whole = [Region(0, 1, "anchoring")]
    profile, _ = InstantProblem(problem.crawler, problem.loads, whole, "x").solve(FINE, None)
    far, rate, gradient = [], [], []
    for radius, young in sizes:
        k_s, k_p, k_g = stiffnesses(radius, young)
        stiff = (k_s - k_p) * (k_s + 2 * k_p) / k_s
        weight = radius * 1000 * np.pi * radius**2 * 9.81
        far.append((2 * k_p / k_s - weight) / stiff)  # n = -1 N
        rate.append(np.sqrt(stiff / k_g))
        gradient.append(k_g)
    at = [step * rate[0], (LENGTH - step) * rate[1]]
    pull = [g * r * np.tanh(x) for g, r, x in zip(gradient, rate, at, strict=True)]
    amplitude = (far[1] - far[0]) * np.array([pull[1], -pull[0]]) / sum(pull)
    xi = np.linspace(0, LENGTH, 400)
    rear = far[0] + amplitude[0] * np.cosh(rate[0] * xi) / np.cosh(at[0])
    front = far[1] + amplitude[1] * np.cosh(rate[1] * (LENGTH - xi)) / np.cosh(at[1])
    mu, *_ = profile.at(xi / LENGTH)
    np.testing.assert_allclose(mu.sum(axis=1) - 2, np.where(xi < step, rear, front), atol=1e-11)
    near = profile.at(np.array([step - 1e-9, step + 1e-9]) / LENGTH)[1][:, 0]
    assert near[0] * gradient[0] == pytest.approx(near[1] * gradient[1], rel=1e-4)
    assert abs(far[1] - far[0]) > 1e-3


def test_segments_like_the_body_change_nothing():
    loaded = [(0, 0.3, "anchoring"), (0.3, 0.7, "advancing"), (0.7, 1, "anchoring")]
    case = cosserat.case("worm_at_rest").vary(
        "x",
        loads={"anchoring": 0.02, "advancing": 1e3},
        regions=[{"begin": a, "end": b, "load": load} for a, b, load in loaded],
        mesh={"elements": 12},
    )
    plain = cosserat.run(case)
    data = cosserat.run(case.vary("x", crawler={"segments": [{"length": 0.1}, {"length": 0.15}]}))
    for name in ("mu_1", "mu_2", "mu_3", "p_coelom", "along", "height"):
        np.testing.assert_allclose(data[name], plain[name], rtol=2e-9, atol=1e-10)
    np.testing.assert_allclose(data.resting_radius, 3.8e-3, rtol=1e-14)
    assert "resting_radius" not in plain


# ---------------------------------------------------------------- SciPy's solver

TAPERED = [
    {"length": 0.07, "radius": [2e-3, 3.8e-3], "anchoring": [0.6, 1]},
    {"length": 0.08, "young": [2e3, 3e3], "advancing": 0.8},
    {"length": 0.1, "radius": [3.5e-3, 3e-3], "young": 3e3, "anchoring": 1.2, "advancing": [1, 1.2]},
]
FRONTS = (0.3, 0.72)
UNIT = 1e-6  # N m: of the director moments, so that SciPy's tolerance means something


def line(value, default, along):
    rear, front = np.broadcast_to(default if value is None else value, 2)
    return rear + (front - rear) * along


def of_segment(segment, along):
    """R, E, and the factors of the muscles."""
    nominal = (("radius", 3.8e-3), ("young", 2e3), ("anchoring", 1.0), ("advancing", 1.0))
    return [line(segment.get(name), own, along) for name, own in nominal]


def scipy_worm(mass, anchoring, advancing, length=0.25):
    """mu_1, k_G mu_1' / UNIT, mu_2, k_G mu_2' / UNIT of the worm by `solve_bvp`, on parts between fronts and joints."""
    joints = np.cumsum([s["length"] for s in TAPERED])
    cuts = np.sort([0, *joints, *(f * length for f in FRONTS)])
    parts = list(itertools.pairwise(cuts))
    volume = sum(
        np.pi * s["length"] * np.mean(of_segment(s, np.linspace(0, 1, 20_001))[0] ** 2) for s in TAPERED
    )

    def coefficients(part, x):
        a, b = part
        number = int(np.searchsorted(joints, (a + b) / 2))
        start = joints[number] - TAPERED[number]["length"]
        radius, young, d, p = of_segment(
            TAPERED[number], (a + (b - a) * x - start) / TAPERED[number]["length"]
        )
        area = np.pi * radius**2
        inside = FRONTS[0] < (a + b) / 2 / length < FRONTS[1]
        return (
            2 / 3 * young * area,
            young * np.pi * radius**4 / 12,
            -anchoring * d * np.ones_like(x),
            (advancing * p * area if inside else 0) * np.ones_like(x),
            radius * mass / volume * area * 9.81,
            radius * np.ones_like(x),
            young,
        )

    def rate(x, y):
        rows = []
        for part, (m1, g1, m2, g2) in zip(parts, y.reshape(-1, 4, x.size), strict=True):
            k_i, k_g, n, p, weight, _, _ = coefficients(part, x)
            reaction = n / (m1 * m2)
            f1 = p + weight + reaction / m1 + k_i * (2 * m1 + m2 - 3)
            f2 = p + reaction / m2 + k_i * (2 * m2 + m1 - 3)
            span = part[1] - part[0]
            rows += [span * g1 * UNIT / k_g, span * f1 / UNIT, span * g2 * UNIT / k_g, span * f2 / UNIT]
        return np.array(rows)

    def conditions(left, right):
        left, right = left.reshape(-1, 4), right.reshape(-1, 4)
        return np.concatenate([left[0, 1::2], right[-1, 1::2], (right[:-1] - left[1:]).ravel()])

    x = np.linspace(0, 1, 41)
    guess = np.tile(np.array([1.0, 0, 1, 0])[:, None], (len(parts), 41))
    found = solve_bvp(rate, conditions, x, guess, tol=1e-6, max_nodes=60_000)
    assert found.success, found.message
    return parts, coefficients, found.sol


def test_a_tapered_stepped_worm_is_that_of_scipy():
    """Stretches, coelomic pressure and place along the ground, with fronts inside a taper; mass over volume is even."""
    case = cosserat.case("worm_at_rest").vary(
        "x",
        crawler={"segments": TAPERED},
        loads={"anchoring": 0.02, "advancing": 800.0},
        regions=[
            {"begin": 0, "end": FRONTS[0], "load": "anchoring"},
            {"begin": FRONTS[0], "end": FRONTS[1], "load": "advancing"},
            {"begin": FRONTS[1], "end": 1, "load": "anchoring"},
        ],
        sections=1001,
        mesh={"elements": 12},
    )
    data = cosserat.run(case)
    parts, coefficients, solution = scipy_worm(0.01, 0.02, 800.0)
    xi, before = data.xi_section.to_numpy(), 0.0
    for number, part in enumerate(parts):
        inside = (xi > part[0] + 1e-9) & (xi < part[1] - 1e-9)
        x = (xi[inside] - part[0]) / (part[1] - part[0])
        m1, _, m2, _ = solution(x)[4 * number : 4 * number + 4]
        np.testing.assert_allclose(data.mu_1[inside], m1, atol=1e-6)
        np.testing.assert_allclose(data.mu_2[inside], m2, atol=1e-6)
        k_i, _, n, _, _, radius, _ = coefficients(part, x)
        reactive = n / (m1 * m2) - k_i * (2 - m1 - m2)  # (2.8.9)
        np.testing.assert_allclose(
            data.p_coelom[inside], -reactive * m1 * m2 / (np.pi * radius**2), rtol=1e-5
        )
        np.testing.assert_allclose(data.resting_radius[inside], radius, rtol=1e-12)
        fine = np.linspace(0, 1, 4001)
        f1, g1, f2, _ = solution(fine)[4 * number : 4 * number + 4]
        _, k_g, _, _, _, wide, _ = coefficients(part, fine)
        dz = np.sqrt((f1 * f2) ** -2 - (wide * g1 * UNIT / k_g) ** 2) * (part[1] - part[0])
        z = before + cumulative_simpson(dz, x=fine, initial=0)
        np.testing.assert_allclose(data.along[inside], np.interp(x, fine, z), atol=1e-7)
        before = z[-1]
    assert np.ptp(data.mu_1.to_numpy()) > 0.15


# ---------------------------------------------------------------- energy


@pytest.mark.parametrize("material", ["robot", "worm"])
def test_the_solved_state_makes_the_potential_of_a_varying_body_stationary(material):
    """Its derivative in any direction, by Gauss's rule on energies in SI, vanishes; the weight of k_G is in it."""
    if material == "robot":
        segments = [
            {"length": 0.1, "radius": [0.02, 0.03], "young": 2e4, "anchoring": 0.7},
            {"length": 0.154, "radius": 0.022, "young": [8e3, 1e4], "advancing": [0.5, 1]},
        ]
        problem = body_of(ROBOT, segments)
    else:
        problem = body_of(WORM, TAPERED)
    body, loads = problem.crawler, problem.loads
    length, front = body.length, 0.55
    regions = [Region(0, front, "anchoring"), Region(front, 1, "advancing")]
    profile, _ = InstantProblem(body, loads, regions, "x").solve(FINE, None)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    half = np.diff(profile.mesh.ends) / 2
    z = (profile.mesh.ends[:-1, None] + half[:, None] * (1 + nodes)).ravel()
    dz = (half[:, None] * weights).ravel()
    mu, slope, *_ = profile.at(z)
    starts = np.cumsum([0, *(s.length for s in body.segments)]) / length
    number = np.searchsorted(starts[1:-1], z)
    values = []
    for name, own in (
        ("radius", body.radius),
        ("young", body.material_young),
        ("anchoring", 1),
        ("advancing", 1),
    ):
        ends = np.array([np.broadcast_to(getattr(s, name) or own, 2) for s in body.segments])[number]
        values.append(ends[:, 0] + np.diff(ends)[:, 0] * (z - starts[number]) / np.diff(starts)[number])
    radius, young, d, p = values
    area = np.pi * radius**2
    volume = (area * dz).sum() * length
    rho = body.mass / volume if body.mass else body.density
    pressure = np.where(z > front, loads.advancing * p * area, 0)

    def potential(mu, slope):
        if material == "robot":
            k_s, k_p, k_g = stiffnesses(radius, young)
            n = np.where(z < front, -loads.anchoring * d, 0)
            e1, e2 = mu.T - 1
            e3 = (n - k_p * (e1 + e2)) / k_s
            w = k_s / 2 * (e1**2 + e2**2 + e3**2) + k_p * (e1 * e2 + e1 * e3 + e2 * e3) - n * e3
        else:
            k_i, k_g = 2 / 3 * young * area, young * np.pi * radius**4 / 12
            e1, e2 = mu.T - 1
            w = k_i * (e1**2 + e2**2 + e1 * e2) + loads.anchoring * d / mu.prod(axis=1)
        w = w + k_g / 2 * (slope**2).sum(axis=1) / length**2
        w = w + pressure * mu.sum(axis=1) + radius * rho * area * loads.gravity * mu[:, 0]
        return (w * dz).sum()

    for k, component in itertools.product((0, 1, 3, 8), (0, 1)):
        v, dv = np.zeros_like(mu), np.zeros_like(mu)
        v[:, component], dv[:, component] = np.cos(k * np.pi * z), -k * np.pi * np.sin(k * np.pi * z)
        h = 1e-4
        change = (potential(mu + h * v, slope + h * dv) - potential(mu - h * v, slope - h * dv)) / (
            2 * h
        )
        curvature = potential(mu + h * v, slope + h * dv) + potential(mu - h * v, slope - h * dv)
        curvature = (curvature - 2 * potential(mu, slope)) / h**2
        assert abs(change) < 1e-7 * curvature


# ---------------------------------------------------------------- the solver


@pytest.mark.parametrize("degree", [2, 3])
def test_the_weighted_solver_converges_to_a_manufactured_solution(degree):
    """(w u')' = u - g with w = (1 + z/2)^4, eight times as much before 0.4, where u' jumps so that w u' does not."""
    joint = 0.4
    jump = (1 + joint / 2) ** 4

    def weight(z, front):
        return (1 + z / 2) ** 4 * np.where(front, 1, 8)

    def exact(z, front):
        smooth = np.cos(np.pi * z) + 0.3 * np.cos(2 * np.pi * z)
        flux = -np.pi * (np.sin(np.pi * joint) + 0.6 * np.sin(2 * np.pi * joint)) * jump
        tail = (z - joint) * (1 - np.minimum(z, 1)) ** 2 / (1 - joint) ** 2 * 7 * flux / jump
        return smooth, tail * front, flux

    def rate(z, front):
        """(w u')' by complex steps of the exact flux."""
        h = 1e-20
        c = z + 1j * h
        slope = -np.pi * (np.sin(np.pi * c) + 0.6 * np.sin(2 * np.pi * c))
        a = 7 * exact(joint, True)[2] / jump / (1 - joint) ** 2
        slope = slope + np.where(front, a * ((1 - c) ** 2 - 2 * (c - joint) * (1 - c)), 0)
        return ((1 + c / 2) ** 4 * np.where(front, 1, 8) * slope).imag / h

    class Equation:
        def __init__(self, z, front):
            self.u = sum(exact(z, front)[:2])[..., None]
            self.g = rate(z, front)[..., None]

        def source(self, u):
            return Source(self.g + u - self.u, np.ones((*u.shape, 1)))

    errors = []
    for count in (4, 8, 16, 32):
        ends = np.concatenate([np.linspace(0, joint, count + 1), np.linspace(joint, 1, count + 1)[1:]])
        mesh = Mesh(ends, np.repeat([0, 1], count), degree)
        front = (mesh.region == 1)[:, None] & np.ones(degree + 1, bool)
        w = weight(mesh.places, front)
        found = solve(
            mesh, Equation(mesh.places, front), np.zeros((mesh.nodes, 1)), RegionSettings(), "x", w
        )
        z = np.linspace(0, 1, 3001)
        errors.append(
            np.abs(mesh.interpolate(mesh.split(found.u), z)[:, 0] - sum(exact(z, z >= joint)[:2])).max()
        )
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx(degree + 1, abs=0.15)
    assert errors[-1] < 1e-4


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"segments": [{"length": "10 cm"}]},
            "has 'segments' of 0.1 m together and a 'length' of 0.254 m; let them",
        ),
        (
            {"segments": [{"length": 0.254, "radius": [1, 2, 3]}]},
            "'crawler.segments.0.radius' has 3 values; give one",
        ),
        (
            {"segments": [{"length": 0.254, "radius": "0 mm"}]},
            "'crawler.segments.0.radius' is 0 m; it must be above 0",
        ),
        (
            {"segments": [{"length": 0.254, "young": ["1 kPa", "2 m"]}]},
            "'crawler.segments.0.young' is \"2 m\"",
        ),
        (
            {"segments": [{"length": 0.254, "anchoring": -1}]},
            "'crawler.segments.0.anchoring' is -1; it must be at",
        ),
        (
            {"segments": [{"length": 0.254, "until": 1}]},
            "'crawler.segments.0.until' is not a key; known are: length",
        ),
        (
            {"segments": [{"radius": 1}]},
            "'crawler.segments.0.length' is missing, length of the resting segment",
        ),
        (
            {"segments": [{"length": 1e-9}, {"length": 0.254}]},
            "'segments.0' of 1e-09 m, less than a millionth",
        ),
        (
            {"segments": [{"length": 0.254, "radius": 1e-7}]},
            r"has length / radius = 2.54e\+06; it must be below",
        ),
        ({"segments": "body.csv"}, "'crawler.segments' is 'body.csv'; it must be a list"),
    ],
)
def test_segments_that_make_no_body_are_refused(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        ROBOT.vary("x", crawler=changes)


def test_what_is_for_a_uniform_body_is_refused_for_another():
    segments = {"segments": [{"length": 0.25}]}
    with pytest.raises(
        InputError, match="'solver' = 'collocation' is for a uniform body; take the default"
    ):
        WORM.vary("x", crawler=segments, solver="collocation")
    with pytest.raises(InputError, match="'loads.multiplier' = 'printed' is for a uniform body"):
        WORM.vary("x", crawler=segments, loads={"multiplier": "printed"})
    weak = [{"length": "200 mm"}, {"length": "54 mm", "young": "0.1 kPa"}]
    with pytest.raises(InputError, match="would collapse the sections where they act, at xi = 0.2 m"):
        cosserat.run(ROBOT.vary("x", crawler={"segments": weak}))


def test_a_front_may_pass_a_joint_at_any_distance():
    """A joint nearer than a millionth of the length is moved onto the front: the answer moves by as little."""
    problem = body_of(WORM, [{"length": 0.1, "radius": 3e-3}, {"length": 0.15}])
    found = []
    for off in (0, 1e-9, 0.9e-6, 1.1e-6, 1e-5, -1e-5):
        regions = [Region(0, 0.4 + off, "anchoring"), Region(0.4 + off, 1, "advancing")]
        profile, _ = InstantProblem(problem.crawler, problem.loads, regions, "x").solve(
            RegionSettings(), None
        )
        found.append(profile.at(np.linspace(0, 1, 101))[0])
        assert np.abs(found[-1] - found[0]).max() <= 100 * abs(off) + 1e-10


def test_a_varying_worm_crawls_from_a_file_and_is_drawn_as_thick_as_it_is(tmp_path):
    """The drawn top of the body is 2 R mu_1 of each place; a study of scaled worms takes uniform ones."""
    (tmp_path / "my.toml").write_text(
        '[mine]\nlike = "worm"\nstrides = 1\nstep = "2 s"\n'
        'crawler.segments = [{ length = "5 cm", radius = ["2 mm", "3.8 mm"] }, { length = "20 cm", young = "3 kPa" }]\n'
    )
    case = cosserat.case("mine", tmp_path / "my.toml")
    data = cosserat.run(case)
    cosserat.save(data, tmp_path / "mine.nc")
    assert cosserat.case_of(cosserat.load(tmp_path / "mine.nc")).problem == case.problem
    body, *_ = picture(data).axes
    outline = body.patches[0].get_xy() if body.patches else body.collections[0].get_paths()[0].vertices
    radius = np.interp(np.linspace(0, 0.25, 251), [0, 0.05], [2e-3, 3.8e-3])
    tops = 2e2 * radius * data.mu_1[-1].to_numpy()
    assert outline[:, 1].max() == pytest.approx(tops.max())
    assert np.abs(outline[:, 1, None] - tops).min(axis=0).max() < 1e-12
    for other in (base_of("worm_masses"), cosserat.case("worm_calibration")):
        with pytest.raises(
            InputError, match="'worm.crawler.segments' is given; the worms .* are uniform; leave"
        ):
            other.vary("x", worm={"crawler": {"segments": [{"length": 0.25}]}})


def test_the_mesh_and_the_animation_of_a_tapered_body_are_as_thick_as_it_is():
    """Without loads: the volume of a frustum with polygons of as many corners as the mesh, and the drawn outline."""
    case = cosserat.case("worm_at_rest").vary(
        "x", crawler={"segments": [{"length": 0.25, "radius": [2e-3, 5e-3]}]}, loads={"gravity": 0}
    )
    data = cosserat.run(case)
    body = mesh.crawler(data, case.problem)
    volume = 0.0
    for _, cells in body.cells:
        corners = body.points[cells]
        for k in range(1, cells.shape[1] - 1):
            volume += np.einsum("ci,ci", corners[:, 0], np.cross(corners[:, k], corners[:, k + 1])) / 6
    polygon = mesh.AROUND / 2 * np.sin(2 * np.pi / mesh.AROUND)
    assert abs(volume) == pytest.approx(polygon * 0.25 * (4 + 10 + 25) * 1e-6 / 3, rel=1e-4)
    crawl = cosserat.run(WORM.vary("x", strides=1, step="3 s", crawler={"segments": TAPERED}))
    body = animate(crawl, 3).panels[0].parts[1]
    tops = 2e2 * crawl.resting_radius * crawl.mu_1[0]
    assert body.y[0].max() == pytest.approx(float(tops.max()), rel=1e-3)
