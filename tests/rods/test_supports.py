"""Supports by words and in any direction, at rest, along paths, in vibration and in motion, against exact answers."""

import numpy as np
import pytest
from transfer import CLAMPED, Beam, answer, frequencies, oblique, point

import cosserat
from cosserat.describe.keys import keys
from cosserat.errors import InputError
from cosserat.problem import Run
from cosserat.problems import checkpoints
from cosserat.problems.modes import RodModes
from cosserat.rods.supports import SUPPORTS

CLAMP = {"at": "first", "fixed": "clamped"}
SLOPE = np.radians(30)
ACROSS = np.array([-np.sin(SLOPE), np.cos(SLOPE)])
ROLLER = {"at": "last", "fixed": "roller", "along": "30 deg"}


def cross(a, b):
    a, b = np.asarray(a), np.asarray(b)
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def thick(vertices, base="elastica", **changes):
    """A rod of 1 m by 0.1 m of nu = 0."""
    rod = cosserat.case("vibration_consistent").problem.rod
    return (
        cosserat.case(base)
        .vary("it", rod=rod, **{"forces": [], **changes})
        .vary("it", rod={"vertices": vertices})
    )


@pytest.mark.parametrize(
    ("word", "names"),
    [
        ("clamped", ["x3", "x2", "d3", "d2"]),
        ("clamped, free to stretch", ["x3", "x2", "d3"]),
        ("pinned", ["x3", "x2"]),
        ("roller", ["x2"]),
        ("guided", ["x3", "d3"]),
    ],
)
def test_a_word_is_a_list_of_names_for_a_straight_rod(word, names):
    first = {"at": "first", "fixed": ["x3", "x2", "d3", "d2"]}
    force = [{"at": "last", "along": "E2", "force": 2.0}, {"at": "last", "along": "E3", "force": 3.0}]
    runs = [
        cosserat.run(thick(9, supports=[first, {"at": 6, "fixed": fixed}], forces=force))
        for fixed in (word, names)
    ]
    for name in ("x", "d", "support_force"):
        np.testing.assert_array_equal(runs[0][name], runs[1][name])


def test_what_each_word_holds_is_described():
    (key,) = (key for key in keys("rod statics") if key.path == "supports[].fixed")
    words = [word for item in key.value.items for word in item.words]
    assert words == list(SUPPORTS)
    assert all(f'"{word}":' in key.meaning for word in SUPPORTS)


def test_an_oblique_roller_pushes_across_and_is_of_second_order():
    """A cantilever on a roller that moves at 30 degrees from E3: compatibility of its free end, with shear."""
    errors = []
    for vertices in (9, 17, 33):
        force = [{"at": "50 %", "along": "-E2", "force": 1.0}]
        case = thick(vertices, supports=[CLAMP, ROLLER], forces=force)
        it = Beam(case.problem.rod)
        half = it.part(it.L / 2)
        steps = [half, point(load=[0, -1.0, 0]), half]
        _, end = answer(CLAMPED, steps, oblique(SLOPE))
        run = cosserat.run(case)
        reaction = run.support_force.to_numpy()[-1, :2]
        errors.append(abs(reaction @ ACROSS - end[3:5] @ ACROSS))
        assert abs(run.u.to_numpy()[-1] @ ACROSS) < 1e-20
        assert abs(reaction @ [ACROSS[1], -ACROSS[0]]) < 1e-15
        np.testing.assert_allclose(run.reaction_force[-1], reaction, atol=1e-12)
        total = run.support_force.to_numpy()[:, :2].sum(axis=0) - [0, 1]
        np.testing.assert_allclose(total, 0, atol=1e-8)
    assert errors[0] < 2e-3
    assert np.log2(errors[0] / errors[2]) > 3.7, errors


def test_a_large_displacement_follows_an_oblique_roller_and_so_does_a_path():
    slender = {
        "supports": [CLAMP, ROLLER],
        "forces": [{"at": "50 %", "along": "-E2", "force": 40.0}],
        "rod": {"vertices": 21},
    }
    run = cosserat.run(cosserat.case("elastica").vary("it", **slender))
    path = cosserat.run(cosserat.case("column_path").vary("it", **slender))
    assert np.hypot(*run.u.to_numpy()[-1]) > 0.05
    for end in (run.u.to_numpy()[-1], path.u.to_numpy()[-1, -1]):
        assert abs(end @ ACROSS) < 1e-15
    np.testing.assert_allclose(path.x[-1], run.x, atol=1e-7)
    moment = cross(run.reaction_force.to_numpy()[-1], ACROSS)
    assert abs(moment) < 1e-9 * float(np.abs(run.reaction_force).max())


def test_a_beam_on_an_oblique_roller_vibrates_as_it_must():
    """Transfer matrices: bending and stretching are coupled by the roller."""
    errors = []
    for vertices in (11, 21, 41):
        case = thick(vertices, supports=[CLAMP, ROLLER])
        it = Beam(case.problem.rod)
        exact = frequencies(CLAMPED, [it.part(it.L)], oblique(SLOPE), 3, low=50.0)
        found = case.problem.modes(3)
        errors.append(np.abs(found.angular_frequency / exact - 1).max())
        ends = case.problem.rod.kinematics.split(found.shape)[:, -1, 0]
        assert np.abs(ends @ ACROSS).max() < 1e-12 * np.abs(ends).max()
    assert errors[0] < 5e-2
    assert np.log2(errors[0] / errors[2]) > 3.6, errors
    of_kind = RodModes.of(case.problem, 3).solve("it")
    np.testing.assert_allclose(
        2 * np.pi * of_kind["natural_frequency"], found.angular_frequency, rtol=1e-6
    )
    ends = of_kind["mode_u"][:, -1]
    assert np.abs(ends @ ACROSS).max() < 1e-12 * np.abs(ends).max()


def test_a_ring_pulled_apart_between_guided_sections():
    """A quarter of a ring, P = 2 F: 0.1488 P R^3 / EI along the forces, 0.1366 across (pi/8 - 1/pi, 2/pi - 1/2)."""
    R, errors = 1.0, []
    for vertices in (11, 21, 41):
        case = cosserat.case("elastica").vary(
            "it",
            rod={
                "vertices": vertices,
                "length": np.pi / 2 * R,
                "rest": {"kind": "arc", "curvature": 1 / R},
            },
            supports=[
                {"at": "first", "fixed": "guided"},
                {"at": "last", "fixed": "guided", "along": "E3"},
            ],
            forces=[{"at": "first", "along": "-E2", "force": 1e-5}],
        )
        rod = case.problem.rod
        unit = 2e-5 * R**3 / (rod.young * rod.second_moment)
        exact = np.array([-(np.pi / 8 - 1 / np.pi), -(1 / np.pi - 1 / 4)]) * unit
        run = cosserat.run(case)
        errors.append(np.abs([run.u[0, 1] - exact[0], run.u[-1, 0] - exact[1]]).max() / unit)
        turned = cross(run.d_ref.to_numpy()[[0, -1]], run.d.to_numpy()[[0, -1]])
        assert np.abs(turned).max() < 1e-18
    assert errors[0] < 1e-2
    assert np.log2(errors[0] / errors[2]) > 3.5, errors


def test_a_section_slides_on_its_clamp_as_it_stretches_wherever_it_points():
    """A curved rod of nu = 0.4 that is pulled: its last section keeps its angle and thins as the others do."""
    rod = cosserat.case("vibration_consistent").problem.rod.replace(
        vertices=9,
        rest={"kind": "arc", "curvature": 0.8},
        material={"young": 1e9, "poisson": 0.4, "line_density": 1.0},
    )
    pulled = [{"at": "first", "along": "200 deg", "force": 1e4}]
    lam = []
    for word in ("clamped", "clamped, free to stretch"):
        supports = [{"at": "last", "fixed": word}]
        run = cosserat.run(
            cosserat.case("elastica").vary("it", rod=rod, supports=supports, forces=pulled)
        )
        assert abs(cross(run.d[-1], run.d_ref[-1])) < 1e-17
        lam.append(run.lam.to_numpy()[[-1, -2]] - 1)
        along = run.support_force[-1, 2:].to_numpy() @ run.d_ref[-1].to_numpy()
        assert (abs(along) < 1e-6) == ("free" in word)
    assert lam[0][0] == pytest.approx(0, abs=1e-15)
    assert lam[1][0] < 0.8 * lam[1][1] < -1e-5


def swung(method="implicit", step=1e-3, **changes):
    """A rod on a clamp and an oblique roller that starts with a speed; no inertia of it is aligned with the roller."""
    given = {
        "supports": [{"at": "first", "fixed": "pinned"}, ROLLER],
        "start": {"shape": "reference", "amplitude": 0.0, "speed": 0.5, "along": SLOPE + 0.5},
        "duration": 0.2,
        "every": 0.02,
        "integrator": {"step": step, "method": method},
    }
    case = thick(7, base="vibration_consistent", **{**given, **changes})
    return case.vary("it", rod={"material": {"young": 1e6}})


def test_an_oblique_roller_in_motion_by_two_methods():
    runs = [cosserat.run(swung("implicit", 1e-4)), cosserat.run(swung("rk4", 1e-4))]
    for run in runs:
        total = (run.kinetic_energy + run.strain_energy).to_numpy()
        assert np.ptp(total) < 1e-6 * total[0]
        end = run.x.to_numpy()[:, -1] - [1.0, 0.0]
        assert np.abs(end @ ACROSS).max() < 1e-15
        assert np.abs(end).max() > 1e-3
    size = np.abs(runs[0].x - runs[0].x_ref).max()
    assert float(np.abs(runs[0].x - runs[1].x).max() / size) < 1e-4
    reaction = runs[0].reaction_force.to_numpy()[:, -1]
    assert np.abs(reaction @ [ACROSS[1], -ACROSS[0]]).max() < 1e-9 * np.abs(reaction).max()
    np.testing.assert_allclose(
        reaction, runs[1].reaction_force.to_numpy()[:, -1], atol=2e-2 * np.abs(reaction).max()
    )


def test_everything_on_a_rod_is_the_same_in_an_oblique_frame():
    """A couple, springs, a mass and its weight, which rises slowly: with drag it comes to rest where it is at rest."""
    more = {
        "couples": [{"at": "last", "moment": 1.0}],
        "springs": [{"at": "last", "along": "E2", "stiffness": 300.0, "rotational_stiffness": 20.0}],
        "gravity": {"g": 1.0, "along": "-E2"},
        "masses": [{"at": "last", "mass": 1.0, "offset": [0.05, 0.02]}],
    }
    still = thick(7, supports=[CLAMP, ROLLER], **more).vary("it", rod={"material": {"young": 1e6}})
    rise = {"kind": "ramp", "duration": 1.0, "smooth": True}
    more["gravity"] = {**more["gravity"], "time_function": rise}
    moving = swung(
        damping=0.5, **more, supports=[CLAMP, ROLLER], start={"shape": "reference", "speed": 0.0}
    )
    moving = moving.vary("it", duration=2.0, every=0.5, integrator={"step": 2e-3})
    rest, run = cosserat.run(still), cosserat.run(moving)
    np.testing.assert_allclose(run.x[-1], rest.x, atol=2e-3 * float(np.abs(rest.u).max()))


class Store:
    """Parts of a run, kept in memory."""

    def __init__(self, parts=()):
        self.parts = dict(parts)

    def load(self, number):
        return self.parts.get(number)

    def save(self, number, part, *, whole):
        self.parts[number] = part


def test_an_interrupted_motion_on_an_oblique_roller_goes_on_to_the_same_bits(monkeypatch):
    monkeypatch.setattr(checkpoints, "FRAMES_PER_PART", 3)
    kept, case = Store(), swung()
    whole = case.problem.solve("it", Run(checkpoints=kept))
    assert len(kept.parts) > 2
    resumed = case.problem.solve("it", Run(checkpoints=Store({0: kept.parts[0]})))
    for name in ("x", "d", "x_rate", "d_rate", "kinetic_energy"):
        np.testing.assert_array_equal(resumed[name], whole[name])


@pytest.mark.parametrize(
    ("support", "sentence"),
    [
        ('at = "first", fixed = "fixed"', "'supports.0.fixed' is 'fixed'; it must be \"clamped\", "),
        ('at = "first", fixed = ["x1"]', "'supports.0.fixed' has 'x1'; it must be \"clamped\", "),
        ('at = "first", fixed = 3', "'supports.0.fixed' is 3; it must be"),
        ('at = "first", fixed = "roller", along = "up"', "'supports.0.along' is 'up'; it must be"),
        ('at = "first", fixed = "pinned", along = "E2"', "has 'along', but fixed = 'pinned' has no dir"),
        ('at = "first", fixed = ["x3"], along = "E2"', "but fixed = ['x3'] has no direction in which"),
        (
            'at = "first", fixed = "pinned", name = "2nd"',
            "'supports.0.name' is '2nd'; begin it with a l",
        ),
        (
            'at = "first", fixed = "pinned", name = "a" }, { at = "last", fixed = "roller", name = "a"',
            "'supports' has two named 'a'; give each a name of its own",
        ),
    ],
)
def test_a_fault_is_one_sentence(support, sentence, tmp_path):
    (tmp_path / "it.toml").write_text(f'[it]\nlike = "elastica"\nsupports = [{{ {support} }}]\n')
    with pytest.raises(InputError) as caught:
        cosserat.case("it", tmp_path / "it.toml")
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_vector_that_is_held_obliquely_is_not_moved():
    moved = [{"at": "last", "dof": "x2", "by": 0.1}]
    with pytest.raises(
        InputError, match=r"which no support fixes; add x2 to 'fixed' of a support there"
    ):
        thick(7, supports=[CLAMP, ROLLER], prescribed_displacements=moved)


def test_two_words_of_one_section_hold_what_both_hold():
    """A roller and an oblique roller at one place hold both components of the position."""
    both = [CLAMP, ROLLER, {"at": "last", "fixed": "roller"}]
    mask = thick(7, supports=both).problem.constrained().reshape(7, 4)
    assert mask[-1].tolist() == [True, True, False, False]
