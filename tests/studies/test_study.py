"""Studies: families of cases as one labelled Dataset, the same for every way in which its members are solved."""

import json

import numpy as np
import pytest
import xarray as xr

import cosserat
from cosserat.errors import InputError
from cosserat.studies import command, plan, stored
from cosserat.studies.answer import answer
from cosserat.studies.door import family_of, find_study
from cosserat.studies.keys import case_with, table_of
from cosserat.studies.solving import STATUS

YOUNG, HEIGHT, FORCE = "rod.material.young", "rod.section.height", "forces.0.force"
TIP = {"tip": "u.E2 at last", "most": "max |kappa|"}
POINTS = {
    "sobol": 8,
    "seed": 1,
    FORCE: {"uniform": ["0.1 N", "4 N"]},
    YOUNG: {"normal": ["1 GPa", "0.1 GPa"]},
}


@pytest.fixture(scope="module")
def short():
    return cosserat.case("elastica").vary("short", rod={"vertices": 6})


@pytest.fixture(scope="module")
def grid(short):
    return cosserat.study(
        short, {YOUNG: ["1 GPa", 2e9], HEIGHT: ["8 mm", "9 mm", "1 cm"]}, TIP, keep_whole=["x"]
    )


def test_a_grid_has_a_dimension_for_each_key_with_its_unit(grid):
    assert grid["tip"].dims == ("young", "height")
    assert grid["young"].attrs["units"] == "Pa"
    assert grid["height"].attrs["key"] == HEIGHT
    np.testing.assert_allclose(grid["height"], [0.008, 0.009, 0.01], rtol=1e-15)
    assert grid["tip"].attrs["units"] == "m"
    assert grid["x"].dims == ("young", "height", "vertex", "axis")
    assert (grid["status"] == 0).all()


def test_a_member_is_bit_equal_to_its_case_solved_alone(short, grid):
    for young, height in ((1e9, 0.008), (2e9, 0.01)):
        alone = cosserat.run(
            short.vary("alone", rod={"material": {"young": young}, "section": {"height": height}})
        )
        own = grid.sel(young=young, height=height)
        assert float(own["tip"]) == float(alone["u"].sel(axis="E2")[-1])
        assert float(own["most"]) == float(np.abs(alone["kappa"]).max())
        np.testing.assert_array_equal(own["x"], alone["x"])


@pytest.mark.parametrize(
    ("name", "path", "values", "shared"),
    [
        ("worm", "crawler.material.young", (1e3, -1.0), "gait"),
        ("worm", "gait.phases", ((1.0, 2.0), (1.0,)), "crawler"),
        ("elastica", "forces.0.force", (2.0, "far"), "rod"),
        ("elastica", "rod.vertices", (9, 1), "newton"),
    ],
)
def test_a_member_reads_again_only_what_its_keys_enter(name, path, values, shared):
    """It is the case that is read from all keys, with the same refusals, and shares the rest with its base."""
    base = cosserat.case(name)
    whole, opened = table_of(base.problem), table_of(base.problem, [path])
    good, bad = values
    member = case_with(base, opened, {path: good}, "m")
    assert member == case_with(base, whole, {path: good}, "m")
    assert getattr(member.problem, shared) is getattr(base.problem, shared)
    refused = []
    for table in (whole, opened):
        with pytest.raises(InputError) as error:
            case_with(base, table, {path: bad}, "m")
        refused.append(str(error.value))
    assert refused[0] == refused[1]


def test_a_stiffer_cantilever_bends_less_as_its_stiffness_says():
    """Small deflections go with one over E I, whatever solved them."""
    weak = {"forces": [{"at": "last", "along": "E2", "force": 1e-3}]}
    case = cosserat.case("elastica").vary("weak", **weak, rod={"vertices": 21})
    data = cosserat.study(case, {YOUNG: [1e9, 2e9], HEIGHT: [0.008, 0.016]}, {"tip": "u.E2 at last"})
    np.testing.assert_allclose(data["tip"][0] / data["tip"][1], 2, rtol=1e-4)
    np.testing.assert_allclose(data["tip"][:, 0] / data["tip"][:, 1], 8, rtol=2e-3)  # shear adds 1e-4


def test_zipped_lists_names_and_points_multiply(short):
    data = cosserat.study(
        short,
        [
            {
                "name": "material",
                "names": ["stiff", "soft"],
                YOUNG: [1e9, 1e8],
                "rod.material.poisson": [0, 0.3],
            },
            {"latin_hypercube": 3, FORCE: {"log_uniform": [0.1, 1]}},
        ],
        {"tip": "u.E2 at last"},
    )
    assert data["tip"].dims == ("material", "member")
    assert data["young"].dims == ("material",)
    assert float(data["tip"].sel(material="soft", member=2)) > float(
        data["tip"].sel(material="stiff", member=2)
    )
    assert data["force"].dims == ("member",)
    assert ((data["force"] > 0.1) & (data["force"] < 1)).all()


def test_words_and_counts_can_be_varied(short):
    data = cosserat.study(
        short,
        {"rod.vertices": [6, 11], "rod.lateral_constraint": ["free", "rigid"]},
        {"tip": "u.E2 at last"},
    )
    assert list(data["lateral_constraint"].to_numpy()) == ["free", "rigid"]
    assert data["vertices"].dtype.kind == "i"


def test_two_keys_of_one_last_word_have_their_whole_paths():
    pulled = [{"at": "last", "along": "E2", "force": "1 N"}, {"at": 2, "along": "E2", "force": "1 N"}]
    case = cosserat.case("elastica").vary("two", forces=pulled, rod={"vertices": 6})
    data = cosserat.study(case, {FORCE: [1, 2], "forces.1.force": [0, 1]}, {"tip": "u.E2 at last"})
    assert data["tip"].dims == ("forces_0_force", "forces_1_force")


def test_members_without_an_answer_keep_status_and_reason(short):
    """A twentieth of the members and more: out of range, and squeezed beyond collapse.  Progress counts them."""
    told = []
    squeezed = short.vary(
        "squeezed", forces=[{"at": "last", "along": "-E3", "force": "1 N"}], rod={"barrier": True}
    )
    data = cosserat.study(
        squeezed,
        [{"sobol": 4, YOUNG: {"normal": [1e9, 1e9]}}, {FORCE: [0.1, 1e7]}],
        {"tip": "u.E3 at last"},
        keep_whole=["lam"],
        progress=lambda fraction, words: told.append(words),
    )
    found = dict(zip(*np.unique(data["status"], return_counts=True), strict=True))
    assert set(found) <= {0, 1, 2, 3, 4}
    assert found[0] >= 3
    lost = data["status"] >= 2
    assert lost.any()
    assert told[-1] == f"{lost.size} of {lost.size} members, {int(lost.sum())} without an answer"
    assert np.isnan(data["tip"].where(lost)).all()
    assert np.isfinite(data["tip"].to_numpy()[~lost.to_numpy()]).all()
    assert all(data["reason"].to_numpy()[lost.to_numpy()])
    assert data["status"].attrs["flag_meanings"].split() == list(STATUS)


def test_points_of_twice_the_number_begin_with_the_same(short):
    few, many = (
        family_of(short, [POINTS | {"sobol": count}], TIP).task().digests() for count in (8, 16)
    )
    assert (few == many[:8]).all()
    few, many = (
        family_of(short, [{"saltelli": count, FORCE: {"uniform": [0, 1]}}], TIP).task().digests()
        for count in (4, 8)
    )
    assert (few == many[:12]).all()
    few, many = (
        family_of(
            short, [{"morris": count, FORCE: {"uniform": [0, 1]}, YOUNG: {"uniform": [1e8, 1e9]}}], TIP
        )
        for count in (4, 8)
    )
    assert (few.task().digests() == many.task().digests()[:12]).all()


def test_correlated_keys_have_their_covariance(short):
    covariance = [[1e14, 0.8e7 * 0.1], [0.8e7 * 0.1, 0.01]]
    laws = {YOUNG: {"normal": [1e9]}, FORCE: {"normal": [1.0]}}
    found = family_of(short, [{"sobol": 4096, "covariance": covariance, **laws}], TIP).task()
    np.testing.assert_allclose(np.cov(np.array(found.columns)), covariance, rtol=0.02)


def test_laws_have_their_moments(short):
    """Moments of the laws by their formulas; a normal law cut at one deviation keeps 0.2911 of its variance."""
    laws = {
        YOUNG: {"truncated": [5.0, 2.0, 3.0, 7.0]},
        FORCE: {"uniform": [2, 4]},
        HEIGHT: {"log_uniform": [0.01, 0.1]},
    }
    young, force, height = family_of(short, [{"sobol": 4096, **laws}], TIP).task().columns
    np.testing.assert_allclose([young.mean(), young.var()], [5, 4 * 0.2911], rtol=2e-3)
    np.testing.assert_allclose([force.mean(), force.var()], [3, 1 / 3], rtol=2e-3)
    np.testing.assert_allclose(height.mean(), 0.09 / np.log(10), rtol=2e-3)


def solve_left(found, folder):
    made = plan.plan(found, folder)
    names = plan.left(folder, made)
    for name in names:
        task = stored.read_task(folder / stored.BATCHES / f"{name}.npz")
        stored.write_solved(plan.answer_file(folder, name), task, command_solve(task))
    return names


def command_solve(task):
    from cosserat.studies.solving import solve_members

    return solve_members(task)


def bytes_of(folder):
    data, file = answer(*plan.gathered(folder)), folder / "answer.nc"
    cosserat.save(data, file)
    return file.read_bytes()


def test_one_batch_or_many_extended_and_back_give_the_same_bytes(short, tmp_path, monkeypatch):
    few, many = (family_of(short, [POINTS | {"sobol": count}], TIP, name="s") for count in (8, 16))
    whole = tmp_path / "whole"
    assert len(solve_left(few, whole)) == 1
    first = bytes_of(whole)
    monkeypatch.setattr(plan, "batch_size", lambda members, seconds: 3)
    parts = tmp_path / "parts"
    assert len(solve_left(few, parts)) == 3
    assert bytes_of(parts) == first
    assert len(solve_left(many, parts)) == 3  # the eight new ones
    assert plan.gathered(parts)[0].size == 16
    assert solve_left(few, parts) == []  # back: nothing is solved again
    assert bytes_of(parts) == first


def test_whole_variables_of_several_sizes_do_not_depend_on_the_batches(short, tmp_path, monkeypatch):
    found = family_of(short, {"rod.vertices": [6, 9, 7]}, TIP, keep_whole=["x"], name="s")
    solve_left(found, tmp_path / "whole")
    monkeypatch.setattr(plan, "batch_size", lambda members, seconds: 1)
    solve_left(found, tmp_path / "parts")
    assert bytes_of(tmp_path / "whole") == bytes_of(tmp_path / "parts")
    data = answer(*plan.gathered(tmp_path / "parts"))
    assert data["x"].shape == (3, 9, 2)
    assert list(np.isfinite(data["x"][..., 0]).sum("vertex").to_numpy()) == [6, 9, 7]
    assert (data["status"] == 0).all()


def test_what_is_missing_is_not_yet(short, tmp_path, monkeypatch):
    monkeypatch.setattr(plan, "batch_size", lambda members, seconds: 3)
    found = family_of(short, [POINTS], TIP, name="s")
    solve_left(found, tmp_path)
    made = stored.read_plan(tmp_path)
    plan.answer_file(tmp_path, made.batches[1]).unlink()
    data = answer(*plan.gathered(tmp_path, partial=True))
    assert list(np.flatnonzero(data["status"] == STATUS.index("not_yet"))) == [3, 4, 5]
    with pytest.raises(InputError, match="missing"):
        plan.gathered(tmp_path)


STUDY = """
[bar]
like = "elastica"
rod.vertices = 6
[mine]
kind = "study"
of = "bar"
keep.tip = "u.E2 at last"
{more}
"""
VARY = '[[mine.vary]]\nrod.section.height = ["8 mm", "9 mm"]'


def written(tmp_path, more, table=""):
    file = tmp_path / "my.toml"
    file.write_text(STUDY.replace("{more}", more))
    if table:
        (tmp_path / "rows.csv").write_text(table)
    return file


def test_a_study_in_a_case_file_by_the_command_line(tmp_path, capsys, monkeypatch):
    file = written(tmp_path, VARY)
    monkeypatch.chdir(tmp_path)
    assert command_line("study", "mine", "--file", str(file)) == 0
    assert "2 of 2 members solved" in capsys.readouterr().out
    data = cosserat.load("mine.nc")
    assert command_line("run", "mine", "--member", "1", "--file", str(file)) == 0
    alone = cosserat.load("mine_1.nc")
    assert float(data["tip"][1]) == float(alone["u"].sel(axis="E2")[-1])
    assert command_line("study", "mine", "--file", str(file), "--status") == 0
    assert "left: 0 members" in capsys.readouterr().out
    assert command_line("cases", "--file", str(file)) == 0
    assert json.loads(data.attrs["study"])["study"]["of"] == "bar"


def command_line(*words):
    from cosserat.cli import main

    return main(list(words))


def test_a_table_gives_a_row_a_member(tmp_path):
    rows = "rod.section.height [mm], forces.0.force [N]\n8, 1\n9, 2 N\n10, 0.5\n"
    file = written(tmp_path, '[[mine.vary]]\ntable = "rows.csv"', rows)
    found = find_study("mine", file)
    assert found.dims() == ("member",)
    np.testing.assert_allclose(found.task().columns[0], [0.008, 0.009, 0.010], rtol=1e-15)
    np.testing.assert_array_equal(found.task().columns[1], [1, 2, 0.5])


WRONG = {
    "an unknown key": ('[[mine.vary]]\nrod.hight = ["1 mm"]', "no key 'rod.hight'.*rod.length"),
    "a key inside a table that is not there": (
        '[[mine.vary]]\ngravity.g = ["1 m/s^2"]',
        "has no 'gravity'",
    ),
    "an item of a list that is not there": (
        '[[mine.vary]]\nforces.3.force = ["1 N"]',
        "no item of a list of 1",
    ),
    "an empty list": ("[[mine.vary]]\nrod.length = []", "give a list"),
    "an empty range": (
        '[[mine.vary]]\nsobol = 4\nrod.length = { uniform = ["2 m", "1 m"] }',
        "range from 2 to 1 is empty",
    ),
    "no distribution": ('[[mine.vary]]\nsobol = 4\nrod.length = ["2 m"]', "takes a distribution"),
    "no points": ('[[mine.vary]]\nrod.length = { uniform = ["1 m", "2 m"] }', "has no points"),
    "not a power of two": (
        '[[mine.vary]]\nsobol = 5\nrod.length = { uniform = ["1 m", "2 m"] }',
        "take 4 or 8",
    ),
    "a billion members": (
        "".join(
            f"[[mine.vary]]\n{key} = {list(range(6, 1006))}\n"
            for key in ("rod.vertices", "newton.max_iterations")
        )
        + f"[[mine.vary]]\nnewton.load_increments = {list(range(1, 1001))}",
        "has 1000000000 members",
    ),
    "clashing names": (
        VARY + '\n[[mine.vary]]\nname = "tip"\nrod.length = ["1 m"]\nrod.vertices = [6]',
        "2 things of the name 'tip'",
    ),
    "a key twice": (VARY + "\n" + VARY, "varies 'rod.section.height' 2 times"),
    "a wrong unit": ('[[mine.vary]]\nrod.length = ["1 m", "2 kg"]', "item 1 of 'rod.length'.*kg"),
    "no unit": ("[[mine.vary]]\nrod.length = [1, 2]", "item 0 of 'rod.length'.*without a unit"),
    "lists of two lengths": (
        '[[mine.vary]]\nname = "a"\nrod.length = ["1 m"]\nrod.vertices = [6, 7]',
        "different numbers",
    ),
    "a read-out of nothing": ('keep.other = "strength"\n' + VARY, "'strength', which no result has"),
    "a read-out that is none": ('keep.other = "the tip"\n' + VARY, "write a variable of the result"),
    "a word that is no key of a factor": ("[[mine.vary]]\nsobole = 8", "no key 'sobole'"),
}


@pytest.mark.parametrize("name", WRONG)
def test_bad_input_is_one_sentence_and_nothing_is_written(tmp_path, monkeypatch, capsys, name):
    more, said = WRONG[name]
    file = written(tmp_path, more)
    monkeypatch.chdir(tmp_path)
    before = set(tmp_path.iterdir())
    assert command_line("study", "mine", "--file", str(file)) == 2
    error = capsys.readouterr().err
    assert len(error.strip().split("\n")) == 1
    import re

    assert re.search(said, error), error
    assert set(tmp_path.iterdir()) == before


def test_a_bad_unit_in_a_row_of_a_table_names_the_row(tmp_path):
    rows = ["rod.section.height [mm]", *["8"] * 416, "8 kg", *["9"] * 10]
    file = written(tmp_path, '[[mine.vary]]\ntable = "rows.csv"', "\n".join(rows))
    with pytest.raises(InputError, match=r"rows.csv, row 417: 'rod.section.height'.*kg"):
        find_study("mine", file)


def test_a_study_is_no_case_and_says_so(tmp_path):
    file = written(tmp_path, VARY)
    with pytest.raises(InputError, match="'mine' is a study.*cosserat study mine"):
        cosserat.case("mine", file)
    assert list(cosserat.load_cases(file)) == ["bar"]


def test_read_outs_of_motions_and_paths():
    fields = {
        "time": (("time",), np.array([0.0, 1.0, 2.0])),
        "xi": (("vertex",), np.array([0.0, 0.5, 1.0])),
        "u": (("time", "vertex", "axis"), np.arange(18.0).reshape(3, 3, 2) - 5),
    }
    labels = {"axis": ("E3", "E2")}
    from cosserat.studies.readouts import read_out

    def value(text):
        return float(read_out("it", text, "s").of(fields, labels))

    u = fields["u"][1]
    assert value("max |u.E2| at last") == np.abs(u[:, 2, 1]).max()
    assert value("final u.E3 at 0.75 m") == pytest.approx((u[2, 1, 0] + u[2, 2, 0]) / 2)
    assert value("max u.E2 at 0.5 s") == pytest.approx((u[0, :, 1] + u[1, :, 1]).max() / 2)
    assert value("norm u") == pytest.approx(np.sqrt((u**2).sum()))
    with pytest.raises(InputError, match="more than one value"):
        value("u.E2 at last")
    with pytest.raises(InputError, match="outside the result"):
        value("max u at 3 s")


def test_the_answer_is_clean_cf(grid, tmp_path):
    cosserat.save(grid, tmp_path / "a.nc")
    with xr.open_dataset(tmp_path / "a.nc") as read:
        for name, variable in read.variables.items():
            assert "long_name" in variable.attrs, name
            if variable.dtype.kind == "f":
                assert "units" in variable.attrs, name
        frame = read[["tip", "status"]].to_dataframe()
    assert frame.shape[0] == 6
    assert float(read["tip"].interp(height=0.0085)[0]) > 0
    assert command.WORKFLOW.exists()


def test_a_value_where_another_one_reaches_a_level():
    from cosserat.errors import OutOfReachError
    from cosserat.studies.readouts import read_out

    fields = {
        "load_factor": (("point",), np.array([0.0, 0.5, 1.0])),
        "u": (
            ("point", "vertex", "axis"),
            np.array([[[0, 0], [0, 0]], [[0, 0], [0, 1]], [[0, 0], [0, -4]]]) * 1.0,
        ),
    }
    labels = {"axis": ("E3", "E2")}

    def value(text):
        return float(read_out("it", text, "s").of(fields, labels))

    assert value("load_factor where |u.E2| at last reaches 25 cm") == 0.125
    assert value("load_factor where max |u| reaches 2 m") == pytest.approx(0.5 + 0.5 / 3)
    assert value("change u.E2 at last") == -4
    assert value("final |u.E2| at last") == 4
    with pytest.raises(OutOfReachError, match="does not reach 5"):
        value("load_factor where |u.E2| at last reaches 5 m")


def test_imperfect_columns_have_the_strength_of_perry_and_robertson():
    """The stress of a bow between hinges is P/A (1 + e c / r^2 / (1 - P/P_E)); edges see a little less."""
    found = find_study("column_strength")
    members = np.arange(0, 128, 16)
    task = found.task(members)
    from cosserat.studies.solving import solve_members

    strength = solve_members(task).values["strength"]
    bow, young, height = (task.columns[task.keys.index(key)] for key in task.keys)
    width = found.base.problem.rod.width
    euler = np.pi**2 * young * height**2 / 12
    middle = (2e5 + (1 + 6 * bow / height) * euler) / 2
    exact = middle - np.sqrt(middle**2 - 2e5 * euler)
    np.testing.assert_allclose(strength * 5.55 / (width * height), exact, rtol=6e-3)


def test_a_whole_variable_is_named_in_a_list(short):
    with pytest.raises(InputError, match=r"'keep_whole' is 'x'; give a list"):
        cosserat.study(short, {YOUNG: [1e9]}, keep_whole="x")


def test_a_place_that_some_members_do_not_reach_fails_those_alone(short):
    """The compiled loop solves all of them; the others keep their answers."""
    data = cosserat.study(short, {"rod.length": [0.4, 1.0, 0.9]}, {"middle": "u.E2 at 0.5 m"})
    assert list(data["status"].to_numpy()) == [STATUS.index("refused_input"), 0, 0]
    assert "outside the result, from 0 to 0.4" in data["reason"].to_numpy()[0]
    alone = cosserat.run(short.vary("alone", rod={"length": 1.0})).u.sel(axis="E2").to_numpy()
    assert float(data["middle"][1]) == pytest.approx((alone[2] + alone[3]) / 2, rel=1e-12)
