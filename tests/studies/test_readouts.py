"""Read-outs against numpy on whole results, and their derivatives against differences of whole solves."""

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError, OutOfReachError
from cosserat.studies.readouts import read_out
from cosserat.studies.reduced import reduced

from .gradients import FILE

FACTORS = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
U = np.random.default_rng(3).normal(size=(5, 4, 2))
XI = np.array([0.0, 0.2, 0.7, 1.6])  # vertices at unequal distances
PATH = {
    "load_factor": (("point",), FACTORS),
    "xi": (("vertex",), XI),
    "xi_edge": (("edge",), (XI[1:] + XI[:-1]) / 2),
    "u": (("point", "vertex", "axis"), U),
    "mu_edge": (("point", "edge"), U[:, 1:, 0]),
}
LABELS = {"axis": ("E3", "E2")}
WORDS = {
    "": lambda rows: rows[:, 0],
    "max": lambda rows: rows.max(axis=1),
    "min": lambda rows: rows.min(axis=1),
    "mean": lambda rows: rows.mean(axis=1),
    "norm": lambda rows: np.sqrt((rows**2).sum(axis=1)),
    "range": lambda rows: rows.max(axis=1) - rows.min(axis=1),
    "change": lambda rows: rows[:, 0] - rows[0, 0],
}


def value(text, fields=PATH):
    return float(read_out("it", text, "s").of(fields, LABELS))


def met(series, level, values):
    """Values where a series passes a level between two points, by hand."""
    k = int(np.flatnonzero((series[:-1] < level) != (series[1:] < level))[0])
    return np.interp(
        level, *zip(*sorted(zip(series[k : k + 2], values[k : k + 2], strict=True)), strict=True)
    )


@pytest.mark.parametrize("word", WORDS)
@pytest.mark.parametrize("size", [False, True])
def test_every_word_before_a_value_where_another_one_reaches_a_level(word, size):
    """Of the last vertex and of all, with and without sizes, at a point of the path and between two."""
    rows = np.abs(U[:, 3, 1:]) if size else U[:, 3, 1:]
    bar = "|" if size else ""
    series = WORDS[word](rows)
    text = f"{word} {bar}u.E2{bar} at last where load_factor reaches"
    assert value(f"{text} 0.75") == pytest.approx(series[3], abs=1e-15)
    assert value(f"{text} 0.6") == pytest.approx(0.6 * series[2] + 0.4 * series[3], abs=1e-14)
    whole = f"{word} {bar}u{bar} where load_factor reaches 0.6"
    if word in ("", "change"):
        with pytest.raises(InputError, match="more than one value at an instant"):
            value(whole)
        return
    every = WORDS[word]((np.abs(U) if size else U).reshape(5, -1))
    assert value(whole) == pytest.approx(0.6 * every[2] + 0.4 * every[3], abs=1e-14)


@pytest.mark.parametrize("word", ["", "max", "mean", "norm", "change"])
@pytest.mark.parametrize("size", [False, True])
def test_every_word_before_the_value_that_reaches_a_level(word, size):
    rows, bar = U[:, 3, 1:], "|" if size else ""
    series = WORDS[word](np.abs(rows) if size else rows)
    level = float(series[1] + 0.3 * (series[2] - series[1]))
    found = value(f"load_factor where {word} {bar}u.E2{bar} at last reaches {level!r} m")
    assert found == pytest.approx(met(series, level, FACTORS), abs=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "final u.E2 at last where load_factor reaches 0.5",
        "load_factor where final u.E2 at last reaches 1 m",
    ],
)
def test_a_final_value_has_no_other_instant(text):
    with pytest.raises(InputError, match="'final' and 'where' name two instants"):
        read_out("it", text, "s")


def test_a_change_needs_instants():
    """It was 0 for a result of one state."""
    with pytest.raises(InputError, match="'lam' has no instants between which it changes; leave out"):
        value("change lam at last", {"lam": (("vertex",), np.array([1.0, 2.0]))})


def test_sizes_are_taken_before_a_change():
    u = np.abs(U[:, 3, 1])
    assert value("change |u.E2| at last") == u[-1] - u[0]


def test_a_level_that_is_met_exactly_is_reached():
    """At the first and the last point, by a value that turns there, and after a change of unit."""
    humped = np.array([0.1, 0.3, 0.7, 0.3, 0.07108937152128947])
    fields = {**PATH, "u": (("point", "vertex", "axis"), np.tile(humped[:, None, None], (1, 4, 2)))}
    reached = "load_factor where u.E2 at last reaches"
    for text, factor in {"0.1 m": 0, "0.3 m": 0.25, "0.7 m": 0.5, f"{float(humped[-1])!r} m": 1}.items():
        assert value(f"{reached} {text}", fields) == factor
    for k, number in enumerate(humped[:3]):
        assert value(f"{reached} {100 * number:.15g} cm", fields) == FACTORS[k]
    assert value("u.E2 at last where load_factor reaches 0") == U[0, 3, 1]
    with pytest.raises(OutOfReachError, match="does not reach 0.05; it goes from 0.0710894 to 0.7"):
        value(f"{reached} 5 cm", fields)


def test_what_a_read_out_where_needs_and_lacks_is_said():
    with pytest.raises(InputError, match="the result has no variable 'kappa'"):
        value("load_factor where max |kappa| reaches 1 m^-1")


def test_a_path_and_its_study_give_what_numpy_gives():
    case = cosserat.case("column_path")
    whole = cosserat.run(case)
    x, u = (whole[name].to_numpy() for name in ("x", "u"))
    along = list(whole.axis.to_numpy()).index("E3")
    end = x[:, -1, along]
    keep = {
        "size": "|u.E3| at last where load_factor reaches 1.0",
        "most": "max |u| where load_factor reaches 1.0",
        "moved": "change x.E3 at last where load_factor reaches 0.75",
        "begun": "u.E3 at last where load_factor reaches 0",
        "ended": f"load_factor where x.E3 at last reaches {float(end[-1])!r} m",
    }
    factors = whole.load_factor.to_numpy()
    k = int(np.flatnonzero((factors[:-1] < 0.75) & (factors[1:] >= 0.75))[0])
    there = np.interp(0.75, factors[k : k + 2], end[k : k + 2])
    right = [abs(u[-1, -1, along]), np.abs(u[-1]).max(), there - end[0], u[0, -1, along], factors[-1]]
    young = float(case.problem.rod.material.young)
    found = cosserat.study(case, {"rod.material.young": [young]}, keep, progress=lambda *_: None)
    assert [found[name].item() for name in keep] == pytest.approx(right, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize(("size", "sign"), [("|u.E3|", -1), ("change u.E3", 1)])
def test_derivatives_where_a_level_is_reached(size, sign):
    """The tip moves towards the clamp: its size is minus its displacement, and its change is that itself."""
    where = "at last where load_factor reaches 0.75"
    of = {"own": f"{size} {where}", "plain": f"u.E3 {where}"}
    found = cosserat.sensitivity("column_path", "rod.length", of)
    assert found["own"].item() == pytest.approx(sign * found["plain"].item(), rel=1e-12)
    own, plain = found["own_by_length"].item(), found["plain_by_length"].item()
    assert own == pytest.approx(sign * plain, rel=1e-8)
    assert abs(own) > 1


@pytest.mark.parametrize("percent", [0, 12.5, 50, 87.5, 100])
def test_a_percentage_is_a_place_in_metres(percent):
    place = percent / 100 * XI[-1]
    right = np.interp(place, XI, U[-1, :, 1])
    assert value(f"final u.E2 at {percent} %") == pytest.approx(right, abs=1e-14)
    assert value(f"final u.E2 at {percent}%") == pytest.approx(right, abs=1e-14)
    edges = PATH["xi_edge"][1]
    if edges[0] <= place <= edges[-1]:
        right = np.interp(place, edges, U[-1, 1:, 0])
        assert value(f"final mu_edge at {percent} %") == pytest.approx(right, abs=1e-14)


def test_a_percentage_beyond_the_rod_is_refused():
    with pytest.raises(InputError, match=r"write 0 % to 100 %"):
        read_out("it", "u.E2 at 101 %", "s")


def test_a_percentage_of_every_member_and_its_derivative():
    """The place moves with the rod; half of it is the middle vertex for every length, where metres have a kink."""
    case = cosserat.case("elastica").vary("short", rod={"vertices": 7})
    vary = {"rod.length": [0.8, 1.0]}
    keep = {"part": "u.E2 at 50 %", "vertex": "u.E2 at 3", "between": "u.E2 at 40 %"}
    keep |= {"metres": "u.E2 at 0.4 m"}
    found = cosserat.study(case, vary, keep, sensitivities=True, progress=lambda *_: None)
    np.testing.assert_allclose(found["part"], found["vertex"], rtol=1e-13)
    np.testing.assert_allclose(found["part_by_length"], found["vertex_by_length"], rtol=1e-9)
    assert found["between"][1].item() == pytest.approx(found["metres"][1].item(), rel=1e-13)


def pushed():
    """A rod clamped at both ends under two forces that mirror each other: so do its moments."""
    forces = [{"at": at, "along": "E2", "force": "10 N"} for at in (6, 13)]
    return cosserat.case("clamped_clamped_consistent").vary("pushed", gravity=None, forces=forces)


def test_values_tied_to_what_a_solve_resolves_have_no_derivative_if_they_change_differently():
    """More of the first force alone breaks the tie; the length and both forces keep it."""
    of, said = {"bent": "max |bending_moment|"}, "2 values share the largest one and change differently"
    with pytest.raises(InputError, match=said):
        cosserat.sensitivity(pushed(), "forces.0.force", of)
    found = cosserat.study(
        pushed(), {"forces.0.force": [10.0]}, of, sensitivities=True, progress=lambda *_: None
    )
    assert np.isnan(found["bent_by_force"].item())
    assert said in found["reason"].item()
    assert found["status"].item() == 1
    kept = cosserat.sensitivity(pushed(), "rod.length", of)["bent_by_length"].item()
    length = pushed().problem.rod.length
    near = cosserat.study(
        pushed(), {"rod.length": [length * 0.9999, length * 1.0001]}, of, progress=lambda *_: None
    )
    assert kept == pytest.approx(np.diff(near["bent"])[0] / (2e-4 * length), rel=1e-6)


@pytest.mark.parametrize("word", ["max |bending_moment|", "min bending_moment"])
def test_tied_values_whose_changes_are_round_off_keep_their_derivative(word):
    """Small moments under dead loads do not depend on the modulus, whatever ties them."""
    found = cosserat.sensitivity(pushed(), "rod.material.young", {"bent": word})
    assert abs(found["bent_scaled"].item()) < 1e-9 * abs(found["bent"].item())


@pytest.mark.parametrize(("apart", "split"), [(1e-8, False), (1e-10, True), (1e-14, True)])
@pytest.mark.parametrize("word", ["max", "min", "range"])
def test_a_tie_is_as_wide_as_a_solve_resolves(apart, split, word):
    values = (
        np.array([[1.0, 1.0 + apart, 1.5]]) if word == "min" else np.array([[-1.5, 1.0, 1.0 + apart]])
    )
    smooth = np.zeros((1, 3), dtype=bool)
    one = read_out("it", f"{word} u.E2", "s")
    _, why = reduced(one, values, np.array([[0.2, 0.3, 0.4]]), smooth)
    assert bool(why) == split
    _, why = reduced(one, values, np.array([[0.3, 0.3, 0.3]]), smooth)
    assert not why


@pytest.mark.parametrize(
    ("key", "value", "reach"),
    [
        pytest.param("rod.length", 1.0, 4e-4, marks=pytest.mark.workflow),
        pytest.param("rod.material.young", 1e9, 1e-3, marks=pytest.mark.workflow),
        ("forces.0.force", 2.0, 3e-2),
    ],
)
def test_the_stated_error_of_a_motions_derivative_holds(key, value, reach):
    """Against a polynomial of degree 7 near 41 solves, which scatter; the same number has the same derivative."""
    of = {
        "end": "final u.E2 at last",
        "most": "max |u.E2|",
        "small": "final u.E3 at 2",
        "mean": "mean u.E2 at last",
        "energy": "final kinetic_energy",
    }
    case = cosserat.load_cases(FILE)["swinging"]
    found = cosserat.sensitivity(case, key, of)
    assert found.attrs["method"] == "differences of whole solves"
    steps = np.linspace(-1.0, 1.0, 41)
    near = cosserat.study(case, {key: list(value * (1 + reach * steps))}, of, progress=lambda *_: None)
    for name in of:
        own = found[f"{name}_by_{key.rpartition('.')[2]}"]
        right = np.polynomial.polynomial.polyfit(steps, near[name].to_numpy(), 7)[1] / (reach * value)
        assert abs(own.item() - right) <= own.attrs["error"], (name, own.item(), right)
        assert own.attrs["error"] < 3e-5 * abs(own.item())
    end, most = (found[f"{name}_by_{key.rpartition('.')[2]}"] for name in ("end", "most"))
    assert abs(end.item() - most.item()) <= most.attrs["error"]
