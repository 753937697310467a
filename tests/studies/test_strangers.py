"""What people write at first: places and directions in lists, misnamed variables, options, and stored answers."""

import fcntl
import threading
from pathlib import Path

import numpy as np
import pytest

import cosserat
from cosserat.cli import main
from cosserat.errors import InputError
from cosserat.signals import Stopped
from cosserat.studies import door, worker
from cosserat.studies.readouts import meant_variable

END = {"end": "u.E3 at last"}
STUDY = """
[mine]
kind = "study"
of = "elastica"
keep.tip = "u.E2 at last"
[[mine.vary]]
rod.length = ["1 m", "2 m"]
"""


def bar():
    """A bar pulled by 1 N: u = F a / (E A), with E A = 1e5 N and the place a of the force."""
    rod = {"vertices": 9, "length": 1.0, "section": {"height": 0.01, "width": 0.01}}
    pull = [{"at": "last", "along": "E3", "force": 1.0}]
    return cosserat.case("elastica").vary("bar", rod=rod, forces=pull)


def test_places_are_varied_as_they_are_written():
    """The places are vertices of the mesh: the distance to each gives the elongation in closed form."""
    found = cosserat.study(bar(), {"forces.0.at": ["last", "250 mm", "50 %", 6]}, keep=END)
    assert found["at"].to_numpy().tolist() == ["last", "250 mm", "50 %", "6"]
    assert found["end"].to_numpy() == pytest.approx(np.array([1, 0.25, 0.5, 0.75]) * 1e-5, rel=1e-4)
    assert found["end"].sel(at="250 mm").item() == found["end"][1].item()


def test_directions_are_words_angles_or_components():
    """The tip moves across by the part of a small force that acts across."""
    bent = bar().vary("bent", forces=[{"at": "last", "along": "E3", "force": 1e-5}])
    across = {"tip": "u.E2 at last"}
    found = cosserat.study(bent, {"forces.0.along": ["E2", "30 deg", [3, 4], "-E2"]}, keep=across)
    assert (found["tip"] / found["tip"][0]).to_numpy() == pytest.approx([1, 0.5, 0.8, -1], rel=1e-4)


def test_a_table_of_places(tmp_path):
    Path(tmp_path / "pulls.csv").write_text("forces.0.at, forces.0.along\nlast, E3\n0.5 m, -E3\n4, E3\n")
    factor = [{"table": str(tmp_path / "pulls.csv")}]
    assert cosserat.study(bar(), factor, keep=END)["end"].to_numpy() == pytest.approx(
        np.array([1, -0.5, 0.5]) * 1e-5, rel=1e-4
    )


@pytest.mark.parametrize("place", ["40 kg", "the end", 0.3])
def test_what_is_no_place_is_refused_with_all_that_are(place):
    with pytest.raises(InputError, match=r"item 1 of 'forces.0.at' is .*a distance such as"):
        cosserat.study(bar(), {"forces.0.at": ["last", place]}, keep=END)


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("moment", "'bending_moment' or 'reaction_moment'"),
        ("kapa", "'kappa'"),
        ("velocity", "'x_rate'"),
        ("M", "'cosserat show' lists"),
    ],
)
def test_a_misnamed_variable_is_told_by_what_it_means(word, said):
    assert said in meant_variable(word)


def test_read_outs_without_names_are_one_sentence():
    """Each of these was an AttributeError, or was passed over in silence."""
    data = {"forces.0.force": [1.0, 2.0], "end": [1e-5, 2e-5]}
    for given in (
        lambda: cosserat.sensitivity(bar(), "rod.length", "u.E3 at last"),
        lambda: cosserat.fit(bar(), data, ["rod.material.young"], ["u.E3 at last"]),
        lambda: cosserat.estimate_error(bar(), "u.E3 at last"),
    ):
        with pytest.raises(InputError, match="give each a name"):
            given()
    with pytest.raises(InputError, match="give each read-out a range"):
        cosserat.design(bar(), {"rod.length": (0.5, 2)}, "total_mass.E3", subject_to=["max |u|"])
    with pytest.raises(InputError, match="'deviations' names 'top', which is not fitted"):
        cosserat.fit(bar(), data, "rod.material.young", END, deviations={"top": "1 mm"})
    with pytest.raises(InputError, match="'vary' is 'rod.length'; give the values too"):
        cosserat.study(bar(), "rod.length", keep=END)
    with pytest.raises(InputError, match="with points a distribution: uniform"):
        cosserat.study(bar(), [{"sobol": 4, "rod.length": {"gamma": [1, 2]}}], keep=END)


def test_wrong_types_of_a_study_are_one_sentence_before_anything_is_solved(monkeypatch):
    """All but the first two were a TypeError or a ValueError."""
    monkeypatch.setattr(door, "solve_members", lambda *_: pytest.fail("it was solved"))
    vary = {"rod.length": [1.0]}
    for given, more, said in (
        ((None, vary, END), {}, "takes a case or the name of a published one, not None"),
        ((Path("elastica"), vary, END), {}, "takes a case or the name"),
        ((bar(), vary, "u.E3 at last"), {}, "'keep' is 'u.E3 at last'; give each read-out a name"),
        ((bar(), vary, ["u.E3 at last"]), {}, "'keep' is .*; give each read-out a name"),
        ((bar(), vary, 5), {}, "'keep' is 5; give each"),
        ((bar(), vary, 0), {}, "'keep' is 0; give each"),
        ((bar(), vary, END), {"keep_whole": None}, "'keep_whole' is None; give a list"),
        ((bar(), vary, END), {"keep_whole": 5}, "'keep_whole' is 5; give a list"),
        ((bar(), vary, END), {"name": 5}, "'name' of a study is 5; give a text"),
    ):
        with pytest.raises(InputError, match=said):
            cosserat.study(*given, **more)


def test_long_numbers_of_numpy_are_plain_ones():
    given, same = (cosserat.study(bar(), {"rod.length": [one]}, END) for one in (np.longdouble(1), 1.0))
    assert given.identical(same)


@pytest.mark.parametrize(
    ("options", "said"),
    [("--cores 0", "--cores is 0"), ("--hours 0", "above 0"), ("--profile no", "no profile no")],
)
def test_bad_options_are_refused_before_anything_is_written(
    tmp_path, monkeypatch, capsys, options, said
):
    monkeypatch.chdir(tmp_path)
    Path("my.toml").write_text(STUDY)
    assert main(["study", "mine", "--file", "my.toml", *options.split()]) == 2
    assert said in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["my.toml"]


def test_what_an_analysis_finds_can_be_stored_read_and_shown(tmp_path, capsys):
    ends = cosserat.study(bar(), {"rod.vertices": [3, 5, 9]}, keep=END)
    fitted = cosserat.fit(
        bar(), {"forces.0.force": [1, 2], "end": [1e-5, 2e-5]}, "rod.material.young", END
    )
    slopes = cosserat.sensitivity(bar(), "rod.length", END)
    for number, made in enumerate((cosserat.orders(ends), fitted, slopes)):
        file = tmp_path / f"{number}.nc"
        cosserat.save(made, file)
        assert cosserat.load(file).identical(made)
        assert main(["show", str(file)]) == 0
        assert str(next(iter(made.data_vars))) in capsys.readouterr().out


def test_a_worker_that_is_interrupted_says_nothing(monkeypatch, capsys):
    def stopped(task, file):
        raise Stopped(2)

    monkeypatch.setattr(worker, "batch", stopped)
    monkeypatch.setattr(worker, "end_by_signals", lambda: None)
    assert worker.main(["batch", "a", "b"]) == 130
    assert capsys.readouterr().err == ""


def test_what_a_killed_run_still_solves_is_waited_for(tmp_path, monkeypatch, capsys):
    """Its Snakemake holds the lock; without the wait, one of both would remove what the other reads."""
    monkeypatch.chdir(tmp_path)
    Path("my.toml").write_text(STUDY)
    assert main(["study", "mine", "--file", "my.toml", "--plan"]) == 0
    Path("mine.study/.snakemake").mkdir()
    with Path("mine.study/.snakemake/running").open("a") as running:
        fcntl.flock(running, fcntl.LOCK_EX)
        threading.Timer(0.3, fcntl.flock, (running, fcntl.LOCK_UN)).start()
        assert main(["study", "mine", "--file", "my.toml"]) == 0
    assert "waiting for another run" in capsys.readouterr().err
