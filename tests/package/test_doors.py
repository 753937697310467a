"""What a user calls or types for pictures, animations and progress, and the names by which files are given."""

import io
import os
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from conftest import ROOT, base_of, case_of_kind, save_own
from matplotlib.figure import Figure
from PIL import Image

import cosserat
from cosserat import progress
from cosserat.cli import main
from cosserat.errors import InputError


def call(capsys, *arguments):
    code = main([str(argument) for argument in arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_a_case_says_in_one_line_what_it_is(tmp_path):
    assert repr(cosserat.case("elastica")) == (
        "<Case 'elastica': rod statics; rod of 1 m, 41 vertices, consistent energy; Bisshopp and Drucker (1945)>"
    )
    (tmp_path / "my.toml").write_text('[mine]\nlike = "soft_robot"\n')
    assert str(cosserat.case("mine", tmp_path / "my.toml")) == (
        "<Case 'mine': crawl; crawler of 0.254 m, radius 0.0254 m, compressible; a case of the user>"
    )
    assert repr(base_of("convergence")).startswith("<Case 'discretization': discretization errors; ")


@pytest.mark.parametrize("given", [str, Path])
def test_files_are_given_by_text_or_path(solved, tmp_path, given):
    cosserat.save(solved["necking"], given(tmp_path / "a.nc"))
    assert cosserat.load(given(tmp_path / "a.nc")).identical(solved["necking"])
    (tmp_path / "my.toml").write_text('[mine]\nlike = "necking"\n')
    assert list(cosserat.load_cases(given(tmp_path / "my.toml"))) == ["mine"]
    cosserat.plot(given(tmp_path / "a.nc"), given(tmp_path / "a.png"))
    assert (
        len(cosserat.to_dataframe(given(tmp_path / "a.nc"), "vertex"))
        == solved["necking"].sizes["vertex"]
    )


@pytest.mark.parametrize("ending", ["svg", "pdf", "png"])
def test_a_picture_is_a_figure_and_a_file_of_the_same_bytes(solved, tmp_path, ending):
    figure = cosserat.plot(solved["column_path"], tmp_path / f"a.{ending}")
    assert isinstance(figure, Figure)
    assert any(solved["column_path"].attrs["title"] in ax.get_title("left") for ax in figure.axes)
    cosserat.plot(solved["column_path"], tmp_path / f"b.{ending}")
    first, second = ((tmp_path / f"{name}.{ending}").read_bytes() for name in "ab")
    assert first == second
    assert first.startswith({"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}[ending])
    assert figure._repr_png_().startswith(b"\x89PNG"), "a notebook shows it"


def test_pictures_and_animations_that_cannot_be_are_one_sentence(solved, tmp_path, capsys):
    file = tmp_path / "a.nc"
    cosserat.save(solved["necking"], file)
    for words, sentence in [
        ((file, "-o", tmp_path / "a.jpg"), "let its name end in '.svg' or '.pdf' or '.png'"),
        ((file, "-o", tmp_path), "is a folder"),
        ((file, "-o", tmp_path / "none" / "a.svg"), "does not exist"),
        ((file, "-o", "/proc/a.svg"), "/proc"),
        ((file, "--animate", tmp_path / "a.mp4"), "let its name end in '.gif' or '.html'"),
        ((file, "--animate", tmp_path), "is a folder"),
        (
            (file, "--animate", tmp_path / "a.gif"),
            "'rod statics', which has no animation; kinds with one are",
        ),
        ((tmp_path / "none.nc", "--animate", tmp_path / "a.gif"), "there is no file"),
        ((tmp_path, "--animate", tmp_path / "a.gif"), "is a folder"),
    ]:
        code, out, err = call(capsys, "plot", *words)
        assert (code, out) == (2, ""), words
        assert sentence in err, (words, err)
        assert err.count("\n") == 1
    assert [found.name for found in tmp_path.iterdir()] == ["a.nc"]
    numbers_only = xr.Dataset(attrs={"parameters": base_of("convergence").model_dump_json()})
    with pytest.raises(
        InputError, match="this Dataset is of kind 'discretization errors', which has no picture"
    ):
        cosserat.plot(numbers_only)


def test_the_modes_of_any_rod_are_one_call():
    """Of a slender cantilever without load, beside Euler and Bernoulli's closed form."""
    case = cosserat.case("elastica").vary("free", forces=[])
    found, rod = cosserat.modes(case, 2), case.problem.rod
    bending = rod.young * rod.width * rod.height**3 / 12
    roots = np.array([1.8751040687, 4.6940911330])
    exact = (roots / rod.length) ** 2 * np.sqrt(bending / rod.line_density) / (2 * np.pi)
    np.testing.assert_allclose(found.natural_frequency, exact, rtol=5e-4)
    assert found.attrs["case"] == "free_modes"
    for args, sentence in [
        (("worm", 2), "is of kind 'crawl'; use one of kind 'rod statics' or"),
        (("elastica", 0), "'count' is 0; it must be at least 1"),
        (("elastic", 2), "did you mean 'elastica'?"),
        ((3, 2), "modes takes a case or the name of a published one, not 3"),
    ]:
        with pytest.raises(InputError, match=re.escape(sentence)):
            cosserat.modes(*args)


# ---------------------------------------------------------------- animations


def test_a_long_crawl_is_shown_at_equal_distances_from_first_to_last(solved):
    whole = solved["soft_robot"]
    for frames in (2, 7, 100, 1000):
        times = cosserat.animate(whole, frames=frames).slider.values
        chosen = np.searchsorted(whole.time, times)
        assert (chosen[0], chosen[-1]) == (0, whole.sizes["time"] - 1)
        assert chosen.size == min(frames, whole.sizes["time"])
        assert np.ptp(np.diff(chosen)) <= 1
    for frames in (1, 1001):
        with pytest.raises(InputError, match=f"of {frames} frames cannot be drawn; take 2 to 1000"):
            cosserat.animate(whole, frames=frames)


@pytest.fixture(scope="module")
def crawled(solved):
    """A few instants of the soft robot."""
    return solved["soft_robot"].isel(time=[0, 40, 100])


def test_an_animated_crawl_shows_body_and_anchor_where_they_are(crawled):
    stage = cosserat.animate(crawled)
    body, anchor = stage.panels[0].parts[1], stage.panels[0].parts[-1]
    radius = cosserat.case("soft_robot").problem.crawler.radius
    np.testing.assert_array_equal(stage.slider.values, crawled.time)
    np.testing.assert_allclose(body.x[:, [0, -1]], 100 * crawled.along[:, [0, -1]])
    np.testing.assert_allclose(body.y.max(axis=1), 200 * radius * crawled.mu_1.max("section"), rtol=1e-3)
    assert body.base == 0
    np.testing.assert_allclose(anchor.x, 100 * crawled.anchor_along)


def test_a_gif_has_every_frame_and_goes_on_for_ever(crawled, tmp_path):
    for name in "ab":
        cosserat.animate(crawled, tmp_path / f"{name}.gif")
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()
    with Image.open(tmp_path / "a.gif") as drawn:
        assert (drawn.n_frames, drawn.info["loop"], drawn.info["duration"]) == (
            3,
            0,
            6670,
        )  # 20 s in all
        pictures = []
        for frame in range(3):
            drawn.seek(frame)
            pictures.append(np.asarray(drawn.convert("RGB"), dtype=float))
    assert all(np.abs(one - pictures[0]).max() > 100 for one in pictures[1:]), "nothing moves"


def test_a_page_holds_its_states_and_needs_no_network(crawled, tmp_path, capsys):
    save_own(crawled, tmp_path / "a.nc")
    for name in "ab":
        target = tmp_path / f"{name}.html"
        assert call(capsys, "plot", tmp_path / "a.nc", "--animate", target) == (
            0,
            f"wrote {target}\n",
            "",
        )
    page = (tmp_path / "a.html").read_text()
    assert page.replace("<title>a<", "<title>b<") == (tmp_path / "b.html").read_text()
    assert page.count("<figure class") == page.count("<script>") == 1
    assert not re.search(r"https?://(?!www.w3.org/2000/svg)|src=|href=|@import|fetch\(|import\(", page)
    assert sorted(found.name for found in tmp_path.iterdir()) == ["a.html", "a.nc", "b.html"]


def test_an_animation_that_was_stopped_leaves_the_old_file(crawled, tmp_path, monkeypatch):
    from matplotlib.animation import PillowWriter

    def stop(self):
        raise KeyboardInterrupt

    (tmp_path / "a.gif").write_text("old")
    monkeypatch.setattr(PillowWriter, "finish", stop)
    with pytest.raises(KeyboardInterrupt):
        cosserat.animate(crawled, tmp_path / "a.gif")
    assert [(found.name, found.read_text()) for found in tmp_path.iterdir()] == [("a.gif", "old")]


# ---------------------------------------------------------------- progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


SHORT = ("worm", {"strides": 2, "step": 1})


def test_a_run_shows_a_bar_on_a_terminal_and_cleans_up(monkeypatch):
    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(progress, "_AFTER", 0.0)
    monkeypatch.setattr(progress, "_EVERY", 0.0)
    monkeypatch.setattr("tqdm.std.tqdm.monitor_interval", 0)  # else a thread of its own would stay
    cosserat.run(cosserat.case(SHORT[0]).vary("x", **SHORT[1]))
    shown = screen.getvalue()
    assert re.search(r"x: +0%\|", shown)
    assert re.search(r"x: +14%\|.*1 of 7 instants.*x: 100%\|.*7 of 7 instants", shown, flags=re.DOTALL)
    assert shown.endswith("\r")
    assert shown.split("\r")[-2].strip() == "", "the bar stays on the screen"


def test_a_quick_run_a_pipe_and_a_caller_with_a_report_have_no_bar(monkeypatch):
    case = cosserat.case(SHORT[0]).vary("x", **SHORT[1])
    for screen in (Terminal(), io.StringIO()):
        monkeypatch.setattr(sys, "stderr", screen)
        monkeypatch.setattr("tqdm.std.tqdm.monitor_interval", 0)
        if not screen.isatty():
            monkeypatch.setattr(progress, "_AFTER", 0.0)
        cosserat.run(case)
        assert screen.getvalue().strip() == ""
    told, screen = [], Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    cosserat.run(case, progress=lambda fraction, words: told.append(words))
    assert [w for w in told if "instants" in w] == [f"{k} of 7 instants" for k in range(1, 8)]
    assert screen.getvalue() == ""


def test_a_kernel_of_jupyter_counts_as_a_notebook(monkeypatch):
    for config, expected in (({"IPKernelApp": {}}, True), ({}, False)):
        shell = SimpleNamespace(config=config)
        monkeypatch.setitem(
            sys.modules, "IPython", SimpleNamespace(get_ipython=lambda shell=shell: shell)
        )
        assert progress._in_notebook() == expected
    monkeypatch.delitem(sys.modules, "IPython")
    assert not progress._in_notebook()


@pytest.mark.parametrize("off", [False, True])
def test_a_variable_of_the_environment_switches_bars_off(off):
    code = (
        "import sys; sys.stderr.isatty = lambda: True\n"
        "from cosserat import progress\n"
        "progress._AFTER = progress._EVERY = 0\n"
        "with progress.bar('x') as report: report(0.5, 'half')"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
    environment |= {"TQDM_DISABLE": "1"} if off else {}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    assert ("half" in done.stderr) != off


@pytest.mark.parametrize("kind", ["rod path", "calibration", "body mass"])
def test_progress_grows_to_one(kind):
    told = []
    cosserat.run(case_of_kind(kind), progress=lambda fraction, words: told.append(fraction))
    assert told == sorted(told)
    assert told[0] < 1
    assert told[-1] == 1


def test_a_result_that_xarray_opened_is_drawn_and_tabled_like_one_that_cosserat_loaded(solved, tmp_path):
    cosserat.save(solved["worm"], tmp_path / "worm.nc")
    with xr.open_dataset(tmp_path / "worm.nc") as opened:
        cosserat.plot(opened, tmp_path / "opened.svg")
        assert cosserat.to_dataframe(opened).equals(cosserat.to_dataframe(tmp_path / "worm.nc"))
    cosserat.plot(tmp_path / "worm.nc", tmp_path / "loaded.svg")
    assert (tmp_path / "opened.svg").read_bytes() == (tmp_path / "loaded.svg").read_bytes()
