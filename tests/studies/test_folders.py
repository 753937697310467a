"""The folder of a study: what is mixed up, damaged or foreign in it is not believed; and values of NumPy."""

import decimal
import json
import shutil

import numpy as np
import pytest
import xarray as xr

import cosserat
from cosserat.errors import CosseratWarning, InputError
from cosserat.studies import plan, stored, worker
from cosserat.studies.answer import answer
from cosserat.studies.door import family_of
from cosserat.studies.solving import solve_members

HEIGHT, FORCE = "rod.section.height", "forces.0.force"
TIP = {"tip": "u.E2 at last"}
VALUES = {HEIGHT: [0.008, 0.009], FORCE: [1.0, 2.0, 3.0, 4.0, 5.0]}


@pytest.fixture(scope="module")
def short():
    return cosserat.case("elastica").vary("short", rod={"vertices": 7})


@pytest.fixture(scope="module")
def family(short):
    return family_of(short, VALUES, TIP, name="s")


def solve(found, folder):
    """Solve what is left in batches of four members; returns how many batches that were."""
    made = plan.plan(found, folder, 4)
    names = plan.left(folder, made)
    plan.set_aside(folder, names)
    for name in names:
        task = stored.read_task(folder / stored.BATCHES / f"{name}.npz")
        stored.write_solved(plan.answer_file(folder, name), task, solve_members(task))
    return len(names)


@pytest.fixture(scope="module")
def good(family, tmp_path_factory):
    folder = tmp_path_factory.mktemp("good") / "s.study"
    assert solve(family, folder) == 3
    return folder


@pytest.fixture
def folder(good, tmp_path):
    shutil.copytree(good, tmp_path / "s.study")
    return tmp_path / "s.study"


def swapped(files):
    first, last = files[0].read_bytes(), files[-1].read_bytes()
    files[0].write_bytes(last)
    files[-1].write_bytes(first)


def foreign(files):
    cosserat.save(cosserat.run(cosserat.case("elastica").vary("e", rod={"vertices": 7})), files[0])


def of_before(files):
    """An answer that does not say which batch it answers."""
    from cosserat.data.content import stamped

    cosserat.save(stamped(cosserat.load(files[0]).drop_vars("digest")), files[0])


DAMAGE = {
    "swapped": (swapped, 2, "answers of another batch"),
    "foreign": (foreign, 1, "does not say which batch"),
    "of before": (of_before, 1, "does not say which batch"),
    "truncated": (lambda files: files[0].write_bytes(files[0].read_bytes()[:3000]), 1, "is damaged"),
    "not ours": (lambda files: files[0].write_text("mine"), 1, "is damaged"),
    "a link": (lambda files: (files[0].unlink(), files[0].symlink_to(files[0].name)), 1, "is damaged"),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_an_answer_that_does_not_belong_is_solved_again_and_kept_aside(family, good, folder, name):
    damage, count, said = DAMAGE[name]
    damage([plan.answer_file(folder, batch) for batch in plan.plan(family, folder).batches])
    with pytest.raises(InputError, match=said):
        plan.gathered(folder)
    with pytest.warns(CosseratWarning, match=said):
        partial = answer(*plan.gathered(folder, partial=True))
    assert (partial["status"] == 6).any()
    with pytest.warns(CosseratWarning, match=said):
        assert solve(family, folder) == count
    assert answer(*plan.gathered(folder)).identical(answer(*plan.gathered(good)))
    assert len(list(folder.rglob(f"*{stored.ASIDE}"))) == count


def changed(folder, **parts):
    told = json.loads((folder / stored.PLAN).read_text())
    (folder / stored.PLAN).write_text(json.dumps(told | parts, sort_keys=True))


PLANS = {
    **{
        f"{key} {value}": lambda folder, key=key, value=value: changed(folder, **{key: value})
        for key, value in (
            ("batches", []),
            ("batches", None),
            ("batches", 5),
            ("about", None),
            ("about", []),
            ("factors", []),
        )
    },
    "no members": lambda folder: (folder / stored.MEMBERS).unlink(),
    "other members": lambda folder: (folder / stored.MEMBERS).write_bytes(b"mine"),
    "no JSON": lambda folder: (folder / stored.PLAN).write_text("[" * 100_000),
}


@pytest.mark.parametrize("name", PLANS)
def test_a_damaged_plan_is_made_again_and_keeps_what_is_solved(family, good, folder, capsys, name):
    PLANS[name](folder)
    assert worker.main(["gather", str(folder), str(folder / "a.nc")]) == 2
    assert "give the command of the study again" in capsys.readouterr().err
    assert solve(family, folder) == 0
    assert answer(*plan.gathered(folder)).identical(answer(*plan.gathered(good)))


def test_batches_to_solve_that_are_mixed_up_or_damaged_are_planned_again(family, good, tmp_path):
    for harm in (shutil.copy, lambda a, b: b.write_bytes(b"mine")):
        made = plan.plan(family, tmp_path / "s.study", 4)
        files = [tmp_path / "s.study" / stored.BATCHES / f"{name}.npz" for name in made.batches]
        harm(files[0], files[-1])
        with pytest.raises(InputError, match="delete it and give the command"):
            stored.read_task(files[-1])
        solve(family, tmp_path / "s.study")
        found = answer(*plan.gathered(tmp_path / "s.study"))
        assert found.identical(answer(*plan.gathered(good)))
        shutil.rmtree(tmp_path / "s.study")


def test_the_same_members_in_another_study_get_its_names(short, folder):
    rows = [(height, force) for height in VALUES[HEIGHT] for force in VALUES[FORCE]]
    heights, forces = map(list, zip(*rows, strict=True))
    other = family_of(short, [{"name": "pair", HEIGHT: heights, FORCE: forces}], TIP, name="s")
    assert solve(other, folder) == 0
    assert answer(*plan.gathered(folder))["tip"].dims == ("pair",)


def test_links_that_lead_nowhere_are_named(tmp_path, monkeypatch, capsys):
    from cosserat.cli import main

    monkeypatch.chdir(tmp_path)
    text = '[s]\nkind = "study"\nof = "elastica"\nkeep.tip = "u.E2 at last"\n[[s.vary]]\n'
    (tmp_path / "s.toml").write_text(text + "rod.vertices = [6, 7]\n")
    for target in ("s.study", "nowhere"):
        (tmp_path / "s.study").symlink_to(target)
        assert main(["study", "s", "--file", "s.toml"]) == 2
        assert "s.study is a link that leads to no folder" in capsys.readouterr().err
        (tmp_path / "s.study").unlink()
    (tmp_path / "s.study").mkdir()
    (tmp_path / "s.study/plan.json").symlink_to("plan.json")
    assert main(["study", "s", "--file", "s.toml"]) == 2
    assert "plan.json is a link that leads to no file" in capsys.readouterr().err


SAME = [
    ({"rod.length": np.linspace(0.5, 1, 3)}, {"rod.length": [0.5, 0.75, 1.0]}),
    ({"rod.vertices": list(np.arange(5, 7))}, {"rod.vertices": [5, 6]}),
    ({"rod.length": [np.float32(1)]}, {"rod.length": [1.0]}),
    ({"rod.vertices": [np.int8(5)]}, {"rod.vertices": [5]}),
    ({"rod.vertices": np.array([5, 7])}, {"rod.vertices": [5, 7]}),
    ({"rod.length": range(1, 3)}, {"rod.length": [1, 2]}),
    ({"rod": {"length": xr.DataArray([0.5, 1.0])}}, {"rod": {"length": [0.5, 1.0]}}),
    (
        [{"sobol": np.int64(4), FORCE: {"uniform": np.array([0.5, 4])}}],
        [{"sobol": 4, FORCE: {"uniform": [0.5, 4.0]}}],
    ),
    (
        [
            {
                "name": "m",
                "names": np.array(["a", "b"]),
                FORCE: np.array([1.0, 2]),
                HEIGHT: (0.01, "9 mm"),
            }
        ],
        [{"name": "m", "names": ["a", "b"], FORCE: [1.0, 2.0], HEIGHT: [0.01, "9 mm"]}],
    ),
]


@pytest.mark.parametrize("number", range(len(SAME)))
def test_values_of_numpy_are_plain_ones(short, number):
    given, same = SAME[number]
    assert cosserat.study(short, given, TIP).identical(cosserat.study(short, same, TIP))


@pytest.mark.parametrize(
    "value",
    [
        1j,
        decimal.Decimal(1),
        None,
        b"1 m",
        np.datetime64("2020-01-01"),
        np.ma.masked_array([1.0, 2.0], [0, 1]),
        {1.0},
    ],
)
def test_what_no_case_file_could_say_is_refused_before_anything_is_solved(short, monkeypatch, value):
    from cosserat.studies import door

    monkeypatch.setattr(door, "solve_members", lambda *_: pytest.fail("it was solved"))
    with pytest.raises(InputError, match="give numbers, texts"):
        cosserat.study(short, {"rod.length": [value]}, TIP)


def other_values(file, change):
    arrays = dict(np.load(file))
    np.savez(file, **(arrays | {"value 1": change(arrays["value 1"])}))


def no_values(file):
    arrays = dict(np.load(file))
    del arrays["value 1"]
    np.savez(file, **arrays)


@pytest.mark.parametrize(
    "harm",
    [
        lambda file: other_values(file, lambda values: 2 * values),
        lambda file: other_values(file, lambda values: values[:1]),
        no_values,
    ],
)
def test_members_with_other_values_than_their_digests_are_planned_again(family, good, tmp_path, harm):
    """Their answer never was that of the batch, so no command came to an end; or there was a traceback."""
    folder = tmp_path / "s.study"
    file = folder / stored.BATCHES / f"{plan.plan(family, folder, 4).batches[0]}.npz"
    harm(file)
    with pytest.raises(InputError, match="delete it and give the command"):
        stored.read_task(file)
    assert solve(family, folder) == 3
    assert answer(*plan.gathered(folder)).identical(answer(*plan.gathered(good)))
