"""The command line: sufficient help, one sentence for bad input, and no incomplete files."""

import io
import os
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT, save_own

import cosserat
from cosserat.cli import main
from cosserat.data.digest import seal


def call(capsys, *arguments):
    code = main([str(argument) for argument in arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_help_lists_the_cases_and_says_how_to_run_one(capsys):
    with pytest.raises(SystemExit) as done:
        main(["--help"])
    assert done.value.code == 0
    text = capsys.readouterr().out
    for name in cosserat.published():
        assert name in text
    assert "cosserat run clamped_free" in text
    assert "writes clamped_free.nc here" in text


def test_run_prints_the_path_of_the_result(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = call(capsys, "run", "clamped_free")
    assert (code, err) == (0, "")
    assert "2 Newton iterations" in out
    assert out.strip().endswith("wrote clamped_free.nc")
    code, out, _ = call(capsys, "show", "clamped_free.nc")
    assert code == 0
    assert "rod.material.young = 1000000000.0" in out
    assert "centreline displacement" in out


def test_a_case_is_read_as_json_from_standard_input(capsys, tmp_path, monkeypatch):
    """The attribute `parameters` of a result runs its case again, to the same bytes."""
    first, again = tmp_path / "first.nc", tmp_path / "again.nc"
    assert call(capsys, "run", "necking", "--output", first)[0] == 0
    monkeypatch.setattr("sys.stdin", io.StringIO(cosserat.load(first).attrs["parameters"]))
    assert call(capsys, "run", "-", "--output", again)[0] == 0
    assert first.read_bytes() == again.read_bytes()
    lines = "\n".join(cosserat.case(name).model_dump_json() for name in ("necking", "hanging_bar"))
    monkeypatch.setattr("sys.stdin", io.StringIO(lines))
    code, out, _ = call(capsys, "run", "-", "--output", tmp_path)
    assert code == 0
    assert [line.split(":")[0] for line in out.splitlines()] == ["necking", "hanging_bar"]
    assert (tmp_path / "necking.nc").read_bytes() == first.read_bytes()
    monkeypatch.setattr("sys.stdin", io.StringIO(lines))
    code, _, err = call(capsys, "run", "-", "--output", tmp_path / "a.nc")
    assert code == 2
    assert "is not a folder" in err
    for text in ("", "{}", '{"name": "a", "title": "b", "problem": {"kind": "rod static"}}'):
        monkeypatch.setattr("sys.stdin", io.StringIO(text))
        code, _, err = call(capsys, "run", "-")
        assert code == 2
        assert "not those of a case" in err
    code, _, err = call(capsys, "run", "-", "--file", "my.toml")
    assert code == 2
    assert "leave it out" in err


def test_cases_are_listed(capsys, tmp_path):
    _, out, _ = call(capsys, "cases")
    assert [line.split()[0] for line in out.splitlines()] == list(cosserat.published())
    (tmp_path / "my.toml").write_text('[mine]\nlike = "necking"\n')
    _, out, _ = call(capsys, "cases", "--file", tmp_path / "my.toml")
    assert out.startswith("mine ")


MY = '[mine]\nlike = "clamped_free"\n'


@pytest.mark.parametrize(
    ("case", "text", "sentence"),
    [
        ("clamped_fre", None, "did you mean 'clamped_free'?"),
        ("mine", MY + 'rod.lenght = "5 m"', "did you mean 'length'?"),
        ("mine", '[mine]\nkind = "rod statics"\nsupports = []', "'rod' is missing"),
        ("mine", MY + 'rod.length = "5 kg"', "in kg"),
        ("mine", MY + "rod.length = [5]", "not a number"),
        ("mine", MY + "rod.vertices = 2", "it must be at least 3"),
        ("mine", MY + 'rod.length = "-5 m"', "it must be above 0"),
        ("mine", MY + 'rod.material.young = "0 Pa"', "it must be above 0"),
        ("mine", MY + "rod.material.poisson = 0.5", "it must be below 0.5"),
        ("mine", MY + "rod.material.poisson = nan", "it must be a finite number"),
        ("mine", MY + "supports = []", "free to move"),
        ("mine", MY + 'gravity.g = "500 m/s^2"\nnewton.max_iterations = 1', "no equilibrium found"),
    ],
)
def test_bad_cases_give_one_sentence_and_an_exit_code_and_keep_the_old_file(
    capsys, tmp_path, case, text, sentence
):
    arguments = ["run", case, "--output", tmp_path / "out.nc"]
    if text is not None:
        (tmp_path / "my.toml").write_text(text)
        arguments += ["--file", tmp_path / "my.toml"]
    (tmp_path / "out.nc").write_text("old")
    seal(tmp_path / "out.nc")
    before = {file.name: file.read_text() for file in tmp_path.iterdir()}
    code, out, err = call(capsys, *arguments)
    assert code in (1, 2)
    assert out == ""
    assert err.startswith("cosserat: ")
    assert sentence in err
    assert err.count("\n") == 1
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == before


def test_bad_files_and_folders_are_refused(capsys, tmp_path):
    (tmp_path / "bad.nc").write_bytes(b"\x89HDF\r\n\x1a\n but not really")
    for arguments, sentence in [
        (("run", "necking", "-o", tmp_path / "none" / "x.nc"), "does not exist"),
        (("show", tmp_path / "bad.nc"), "cannot read"),
        (("show", tmp_path / "none.nc"), "there is no file"),
        (("figure", "fig_3_99"), "there is no figure 'fig_3_99'; did you mean"),
        (
            ("figure", "fig_3_8", "fig_3_9", "-o", tmp_path / "f.svg"),
            "make a folder for several figures",
        ),
        (("figure", "fig_3_9", "--cases", tmp_path, "-o", tmp_path / "f.svg"), "run the case first"),
        (
            (
                "measure",
                "--cases",
                tmp_path,
                "--table",
                ROOT / "results/tolerances.csv",
                "-o",
                tmp_path / "r.csv",
            ),
            "run",
        ),
        (("check", tmp_path / "report.csv"), "there is no report"),
        (
            ("accept", "necking", "--because", "a reason in words", "--references", tmp_path / "none"),
            "does not exist",
        ),
        (("chapter", tmp_path / "none.py", "-o", tmp_path / "n.ipynb"), "there is no chapter"),
        (
            ("chapter", *[ROOT / "chapters/index.py"] * 2, "-o", tmp_path / "n.ipynb"),
            "is not a folder; make a folder for several notebooks",
        ),
        (("peers", tmp_path / "python", "-o", tmp_path / "peers.csv"), "there is no Python"),
        (("book", tmp_path / "none.ipynb", "-o", tmp_path / "book"), "there is no notebook"),
    ]:
        code, out, err = call(capsys, *arguments)
        assert (code, out) == (2, ""), arguments
        assert sentence in err
        assert err.count("\n") == 1
    assert [file.name for file in tmp_path.iterdir()] == ["bad.nc"]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_case_files_of_any_editor_are_read(tmp_path, mark, end):
    text = MY + f'rod.length = "3 m"{end}# \u00e9\u00b5{end}'
    (tmp_path / "my.toml").write_bytes(mark + text.replace("\n", end).encode())
    assert cosserat.case("mine", tmp_path / "my.toml").problem.rod.length == 3


@pytest.mark.parametrize("coding", ["utf-16", "utf-16-le", "latin-1"])
def test_a_case_file_in_another_encoding_is_refused_with_that_word(capsys, tmp_path, coding):
    (tmp_path / "my.toml").write_bytes((MY + "# \u00e9").encode(coding))
    code, _, err = call(capsys, "run", "mine", "--file", tmp_path / "my.toml")
    assert code == 2
    assert "is not in UTF-8" in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "holds no case"),
        ("like = 3", "'like' is outside a case"),
        ('[mine]\nkind = ["a"]', "'kind' is ['a']"),
        ('["../evil"]\nlike = "necking"', "there is no case 'mine' in "),
        (MY + 'rod.length = "3,5 m"', "with a decimal comma"),
        (MY + 'rod.length = "m"', "not a number with a unit"),
        (MY + 'rod.length = "9**9**9**9 m"', "not a number with a unit"),
        (MY + 'rod.length = "3 +- 1 m"', "not a number with a unit"),
        (MY + 'rod.length = "3 parrots"', "whose unit is not known"),
        (MY + "rod.vertices = 200_000", "rounding the degrees of freedom makes forces"),
        (MY + 'gravity.g = "1e300 m/s^2"', "it must be at least -1e12, at most 1e12"),
    ],
)
def test_malformed_case_files_give_one_sentence(capsys, tmp_path, text, sentence):
    (tmp_path / "my.toml").write_text(text)
    code, out, err = call(
        capsys, "run", "mine", "--file", tmp_path / "my.toml", "-o", tmp_path / "out.nc"
    )
    assert code in (1, 2)
    assert out == ""
    assert sentence in err
    assert err.count("\n") == 1
    assert [file.name for file in tmp_path.iterdir()] == ["my.toml"]


def test_similar_files_of_other_programs_are_refused(capsys, tmp_path, solved):
    import os

    save_own(solved["necking"].assign_attrs(solver="{"), tmp_path / "a.nc")
    save_own(solved["necking"].assign_attrs(parameters="{}"), tmp_path / "old.nc")
    save_own(solved["necking"].drop_attrs(), tmp_path / "foreign.nc")
    os.mkfifo(tmp_path / "pipe.nc")
    (tmp_path / "empty.csv").write_text("")
    (tmp_path / "report.csv").write_text("id,verdict\na,OUTSIDE\n")
    for arguments, sentence in [
        (("show", tmp_path / "a.nc"), f"{tmp_path}/a.nc has no readable attribute 'solver'"),
        (("show", tmp_path / "foreign.nc"), f"{tmp_path}/foreign.nc is no result of cosserat"),
        (("plot", tmp_path / "foreign.nc"), f"{tmp_path}/foreign.nc is no result of cosserat"),
        (("show", tmp_path / "old.nc"), f"{tmp_path}/old.nc: the parameters are not those of a case"),
        (("plot", tmp_path / "old.nc"), f"{tmp_path}/old.nc: the parameters are not those of a case"),
        (("show", tmp_path), "is a folder"),
        (("run", "necking", "-o", tmp_path / "pipe.nc"), "not a regular file"),
        (("run", "necking", "-o", tmp_path / "a.png"), "let its name end in '.nc'"),
        (("run", "necking", "-o", tmp_path / ("a" * 300 + ".nc")), "File name too long"),
        (("measure", "--table", tmp_path / "empty.csv", "-o", tmp_path / "r.csv"), "has no rows"),
        (("check", tmp_path / "report.csv"), "is not a whole report"),
        (("check", tmp_path / "a.nc"), "is not a report"),
    ]:
        code, out, err = call(capsys, *arguments)
        assert (code, out) == (2, ""), arguments
        assert sentence in err
        assert err.count("\n") == 1


def test_an_interrupted_run_says_so_and_writes_nothing(capsys, tmp_path, monkeypatch):
    from cosserat import runner

    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(runner, "run", interrupt)
    code, _, err = call(capsys, "run", "necking", "-o", tmp_path / "a.nc")
    assert code == 130
    assert "interrupted" in err
    assert not list(tmp_path.iterdir())


def test_a_stored_result_is_drawn(capsys, tmp_path, solved):
    cosserat.save(solved["clamped_free"], tmp_path / "a.nc")
    assert call(capsys, "plot", tmp_path / "a.nc")[0] == 0
    assert (tmp_path / "a.svg").read_text().startswith("<?xml")


def test_the_version_names_the_code(capsys):
    with pytest.raises(SystemExit) as done:
        main(["--version"])
    assert done.value.code == 0
    assert "sha256:" in capsys.readouterr().out


def test_an_unknown_command_is_refused(capsys):
    for words, sentence in [
        (["ran", "clamped_free"], "there is no command 'ran'; did you mean 'run'?"),
        (["plto", "a.nc"], "there is no command 'plto'; did you mean 'plot'?"),
        (["xyz"], "there is no command 'xyz'; known are: run, study, fit, plot, show, export, "),
        (
            ["run", "necking", "--ouput=a.nc"],
            "'cosserat run' has no option '--ouput'; did you mean '--output'?",
        ),
        (
            ["show", "a.nc", "b.nc"],
            "'b.nc' is one word too many; 'cosserat show --help' tells what it takes",
        ),
    ]:
        code, out, err = call(capsys, *words)
        assert (code, out) == (2, "")
        assert err.startswith(f"cosserat: {sentence}")
        assert err.count("\n") == 1


def test_help_has_the_commands_of_a_user_first_and_the_published_work_last(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    text = capsys.readouterr().out
    names = ["run", "plot", "show", "export", "describe", "schema", "cases"]
    order = [
        "commands:",
        *names,
        "example:",
        "commands that reproduce",
        "figure",
        "book",
        "published cases:",
    ]
    places = [re.search(rf"^ *{re.escape(word)}", text, flags=re.MULTILINE).start() for word in order]
    assert places == sorted(places)
    from cosserat.cli import parser_of_commands

    (commands,) = [a for a in parser_of_commands()._actions if a.dest != "help" and a.choices]
    for name in commands.choices:
        assert re.search(rf"^  {name}  +\w", text, flags=re.MULTILINE), f"{name} is not listed"


@pytest.mark.workflow
def test_the_commands_of_the_workflow_run_by_hand(capsys, solved, tmp_path):
    for place in ("cases", "studies"):
        (tmp_path / place).mkdir()
    for name in ("calibration", "worm_masses", "worm_masses_constant_pressure", "worm_masses_strip"):
        assert solved[name].attrs["history"] == f"cosserat study {name}"
        shutil.copy(solved.folder.parent / "studies" / f"{name}.nc", tmp_path / "studies")
    for name in solved:
        target = tmp_path / "cases" / f"{name}.nc"
        if name in ("clamped_free", "worm_at_rest"):
            assert call(capsys, "run", name, "-o", target)[0] == 0
        else:
            assert solved[name].attrs["case"] == name
            shutil.copy(solved.folder / f"{name}.nc", target)
    table, report = ROOT / "results/tolerances.csv", tmp_path / "report.csv"
    code, out, _ = call(capsys, "measure", "--table", table, "--cases", tmp_path / "cases", "-o", report)
    assert code == 0
    assert "0 claims fail" in out
    assert call(capsys, "check", report)[0] == 0
    report.write_text(
        report.read_text().replace(",within,", ",FAILS,", 1).replace(",within\n", ",FAILS\n", 1)
    )
    code, _, err = call(capsys, "check", report)
    assert code == 1
    assert "do not hold" in err


def executed(code, folder):
    """A process of its own that executes some Python in a folder."""
    return subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )


def test_running_a_case_as_a_process_loads_no_more_than_it_needs(tmp_path):
    """Most of the time of a short run is imports; `cosserat speed` and the workflow's benchmarks have the seconds.

    The packages of the extra `thesis` are blocked in the process, which then shows and draws its result.
    """
    spared = "matplotlib", "hypothesis", "scipy.optimize", "scipy.integrate", "scipy.sparse.linalg"
    spared += ("scipy.interpolate",)
    extra = "snakemake", "jupytext", "IPython", "ipykernel", "nbclient", "nbformat", "sphinx", "myst_nb"
    code = f"""
import os, sys
sys.modules.update(dict.fromkeys({extra}))
from cosserat.cli import main
assert main(["run", "clamped_free"]) == 0
print(sorted(set({spared}) & set(sys.modules)))
os.environ["MPLBACKEND"] = "nonsense"  # a way to show pictures, which nobody asks for
sys.argv = ["cosserat", "plot", "clamped_free.nc"]
from cosserat.__main__ import main as process
sys.exit(main(["show", "clamped_free.nc"]) or process())
"""
    done = executed(code, tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "[]" in done.stdout.splitlines()
    assert (tmp_path / "clamped_free.svg").is_file()


def test_every_case_has_a_summary(solved):
    from cosserat.data.dataset import effort

    for name, data in solved.items():
        assert effort(data)[0].isdigit() or effort(data).startswith("solve_bvp"), name


def test_crawlers_and_paths_are_drawn(capsys, tmp_path, solved):
    code, _, err = call(capsys, "run", "column_path", "--output", tmp_path / "column_path.nc")
    assert (code, err.split(":")[:2]) == (0, ["warning", " bifurcation"])
    for name in ("worm_at_rest", "soft_robot", "column_path", "vibration_consistent"):
        if name != "column_path":
            cosserat.save(solved[name], tmp_path / f"{name}.nc")
        code, _, err = call(capsys, "plot", tmp_path / f"{name}.nc")
        assert (code, err) == (0, "")
        assert (tmp_path / f"{name}.svg").stat().st_size > 10_000
    cosserat.save(solved["errors_of_one_mesh"], tmp_path / "c.nc")
    code, _, err = call(capsys, "plot", tmp_path / "c.nc")
    assert code == 2
    assert "is of kind 'discretization errors', which has no picture" in err


@pytest.mark.usefixtures("untraced")
def test_speed_is_measured(capsys, monkeypatch):
    from cosserat.thesis import benchmark

    monkeypatch.setattr(benchmark, "_RUNS", 1)
    monkeypatch.setattr(benchmark, "_STATICS_RUNS", 1)
    monkeypatch.setattr(benchmark, "_MEMBERS", 8)
    monkeypatch.setattr(benchmark, "_PATHS", 2)
    monkeypatch.setattr(benchmark, "_STEPS", {20: 80, 200: 20, 2000: 2})
    coarse = cosserat.case("worm").vary("worm", step=0.5)
    monkeypatch.setattr(
        benchmark, "find", lambda name: coarse if name == "worm" else cosserat.case(name)
    )
    code, out, _ = call(capsys, "speed")
    assert code == 0
    first = [line.split()[0] for line in out.splitlines()]
    steps = ["Implicit", "20", "200", "2000"]
    many = ["Equilibria", "P", "P", "P", "The", "constants:", "positions:", "all", "in"]
    paths = ["Paths", "a", "one"]
    one = ["One", "to", "its", "the", "system", "the", "all"]
    solvers = [*steps, *steps, "One", "a", "a", "ratio:"]
    assert first == ["Equilibria,", "20", "20", "41", "2001", *many, *paths, *one, *solvers]
    assert (out.count("by wall clock"), out.count("kernels compiled")) == (5, 4)
    assert out.count("the fastest of") == 7
    assert out.count("steps/s") == 6
    assert out.count("Newton iterations") == 9
    assert float(out.split()[-1]) > 0
