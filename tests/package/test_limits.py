"""Work and space are estimated before they are spent, progress is shown anywhere, and signals end a run in one line."""

import io
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import ROOT
from numba import njit

import cosserat
from cosserat import memory, signals
from cosserat.cli import main
from cosserat.errors import InputError, NotConvergedError, OverLimitError
from cosserat.limits import Limits, Watched
from cosserat.problem import Forecast
from cosserat.problems.static import RodStatics
from cosserat.progress import Lines, bar, duration, size
from cosserat.publications import kinds
from cosserat.solution import Solution
from cosserat.solvers.heartbeat import beat, listening


def motion(**changes):
    return cosserat.case("vibration_c4_20").vary("long", **changes)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"duration": "1e8 s"},
            r"8e\+11 steps of 0\.000125 s would take about 370 days, over the limit of 24 h; take a longer "
            r"'integrator\.step' or a shorter 'duration', or raise the limit --hours",
        ),
        (
            {"duration": "100 s", "every": "0.2 us"},
            r"5e\+08 frames of 20 vertices would take 1\.68 TB, over the limit of 10 GB; take a longer 'every', or "
            r"raise the limit --gigabytes",
        ),
    ],
)
def test_a_run_without_end_is_refused_at_once(changes, sentence):
    with pytest.raises(OverLimitError, match=f"case 'long': {sentence}"):
        cosserat.run(motion(**changes))


FOLLOWED = [{"at": "last", "along": "E2", "force": 0.1}]


@pytest.mark.parametrize(
    ("kind", "changes", "sentence"),
    [
        ("modes", {"count": 20_000}, r"20000 modes of 20001 vertices would take about 35\.6 h, over"),
        (
            "modes",
            {"count": 2000},
            r"2000 modes of 20001 vertices need about 9\.6 GB of memory, and 8 GB are free; take",
        ),
        (
            "critical loads",
            {"forces": (), "follower_forces": FOLLOWED},
            "4 modes of 20001 vertices would take .* years",
        ),
        (
            "rod path",
            {"arc": {"longest": 1e-9, "count": 10_000}},
            "10000 points of 20001 vertices need about 70 GB of mem",
        ),
    ],
)
def test_eigenvalues_and_paths_that_the_machine_cannot_bear_are_refused_at_once(
    monkeypatch, kind, changes, sentence
):
    monkeypatch.setattr("cosserat.memory.free", lambda: 8e9)
    long = cosserat.case("column_path").problem.model_dump(exclude={"kind", "arc"})
    problem = kinds()[kind].problem_class().read(long | changes, "long", units_required=False)
    problem = problem.replace(rod=problem.rod.replace(vertices=20_001))
    with pytest.raises(InputError, match=f"^long: {sentence}"):
        Limits().check(problem.forecast, "long", None)


def test_memory_that_is_free_is_that_of_the_machine_and_of_the_limit(monkeypatch, tmp_path):
    machine, own = tmp_path / "meminfo", tmp_path / "statm"
    machine.write_text("MemTotal: 900 kB\nMemAvailable: 500 kB\n")
    own.write_text("100 20 10\n")
    monkeypatch.setattr(memory, "_MACHINE", machine)
    monkeypatch.setattr(memory, "_OWN", own)
    monkeypatch.setattr(memory, "limit_of_memory", lambda: None)
    assert memory.free() == 500 * 1024
    pages = 100 * os.sysconf("SC_PAGE_SIZE")
    monkeypatch.setattr(memory, "limit_of_memory", lambda: pages + 4000)
    assert memory.free() == 4000
    machine.unlink()
    assert memory.free() == 4000


WATCHED = """
import os, resource, signal, sys
from cosserat import memory
resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
memory._reserve = lambda: None
status = memory.watched(int(sys.argv[1]))
if status is not None:
    sys.exit(status)
os.write(2, b"of a library\\n")
print("of Python", file=sys.stderr)
exec(sys.argv[2])
"""


@pytest.mark.parametrize(
    ("limit", "end", "status", "words"),
    [
        (
            10**8,
            "",
            2,
            "cosserat: the limit of 100 MB of address space is too small, cosserat needs 1000 MB; raise",
        ),
        (
            2 * 10**9,
            "os.abort()",
            2,
            "of Python\ncosserat: there is not enough memory: a library gave up under",
        ),
        (
            2 * 10**9,
            "os.kill(os.getpid(), signal.SIGSEGV)",
            2,
            "of Python\ncosserat: there is not enough memory",
        ),
        (
            2 * 10**9,
            "os.kill(os.getpid(), signal.SIGKILL)",
            -signal.SIGKILL,
            "of Python\nof a library\n",
        ),
        (2 * 10**9, "sys.exit(7)", 7, "of Python\nof a library\n"),
    ],
)
def test_under_a_limit_of_memory_the_end_of_a_library_is_a_sentence(limit, end, status, words):
    done = subprocess.run(
        [sys.executable, "-c", WATCHED, str(limit), end],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr[: len(words)]) == (status, words)
    assert done.stderr.count("cosserat: ") == int(status == 2)


def test_a_signal_reaches_who_works_under_a_limit_and_one_that_is_deaf_is_ended():
    deaf = "signal.pthread_sigmask(signal.SIG_BLOCK, [15]); print('on', flush=True); signal.pause()"
    impatient = WATCHED.replace("memory._reserve", "memory._LATEST = 1; memory._reserve")
    process = subprocess.Popen(
        [sys.executable, "-c", impatient, "2000000000", deaf],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "on\n"
    process.terminate()
    _, errors = process.communicate(timeout=20)
    assert (process.returncode, errors.splitlines()[-1]) == (
        143,
        "cosserat: terminated; no incomplete file was written",
    )


def test_a_crawl_without_end_is_refused_and_the_limit_is_raised_by_name(capsys):
    crawl = cosserat.case("worm").vary("crawl", strides=5000)
    with pytest.raises(OverLimitError, match=r"crawl': .* instants would take .*GB.*--gigabytes"):
        cosserat.run(crawl, limits=Limits(gigabytes=0.1))
    assert main(["run", "worm", "--gigabytes", "0"]) == 2
    assert "'gigabytes' is 0; it must be above 0" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["vibration_c4_20", "worm"])
def test_the_forecast_is_near_what_is_stored(solved, name):
    found = cosserat.case(name).problem.forecast
    assert 0.5 < found.size / solved[name].nbytes < 2


def test_a_disk_that_is_too_small_is_named_with_need_and_free_space(tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.disk_usage", lambda path: type("Usage", (), {"free": 1000}))
    sentence = r"801 frames of 20 vertices need [\d.]+ MB while it runs, and 1 kB are free in .*; take a longer 'every'"
    with pytest.raises(InputError, match=sentence):
        cosserat.run("vibration_c4_20", result=tmp_path / "x.nc")
    assert not list(tmp_path.iterdir())


def test_a_run_stops_after_its_time():
    now, told = iter(np.arange(0, 100, 0.5)), []
    watched = Watched(
        lambda *said: told.append(said), Limits(hours=1 / 3600), "case 'x'", lambda: next(now)
    )
    watched(0.5, "half")
    with pytest.raises(
        OverLimitError, match="case 'x' stopped after 1 s, at half; raise the limit --hours"
    ):
        watched.hear(0.7, 12)
    assert told == [(0.5, "half"), (0.5, "half")]


def test_a_static_solution_tells_of_its_iterations_and_can_be_stopped(monkeypatch):
    heard = []
    sprung = cosserat.case("elastica").vary(
        "sprung", springs=[{"at": "last", "rotational_stiffness": 0.1}]
    )
    with listening(lambda *said: heard.append(said)):
        sprung.problem.solve("x")
    factors, iterations = zip(*heard, strict=True)
    assert factors[-1] == 1.0
    assert list(iterations) == list(range(1, len(iterations) + 1))
    beat(1.0, 1)
    assert len(heard) == len(iterations)
    with listening(lambda *said: heard.append(said)):
        found = cosserat.case("elastica").problem.solve("x")  # one compiled loop, which tells of its end
    assert heard[len(iterations) :] == [(1.0, found.statistics["iterations"])]
    told = []
    watched = Watched(lambda *said: told.append(said), Limits(), "x", iter(range(10)).__next__)
    watched.hear(np.float64(0.5), 3)
    watched.hear(0.0, 4)
    assert told == [(0.0, "0.5 of the load, 3 iterations"), (0.0, "4 iterations")]
    monkeypatch.setattr("cosserat.limits._OFTEN", 0.0)
    with pytest.raises(OverLimitError, match="of the load, .* iterations"):
        cosserat.run(sprung, limits=Limits(hours=1e-12))


def test_progress_is_told_in_lines_where_there_is_no_terminal(monkeypatch):
    now = [0.0]
    screen = io.StringIO()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.delenv("TQDM_DISABLE", raising=False)
    lines = Lines("long", lambda: now[0])
    for second in range(1, 101):
        now[0] = float(second)
        lines(second / 100, f"{second} of 100 s")
    told = screen.getvalue().splitlines()
    assert told[0] == "long: 6%, 6 of 100 s, about 1.57 min left"
    assert 4 <= len(told) <= 8
    now[0] = 1000.0
    lines(0.0, "12 iterations")
    assert screen.getvalue().splitlines()[-1] == "long: 12 iterations"
    monkeypatch.setenv("TQDM_DISABLE", "1")
    now[0] = 1e4
    lines(1.0, "end")
    assert len(screen.getvalue().splitlines()) == len(told) + 1


def test_compiling_is_told_as_progress(monkeypatch):
    """Where no kernels are cached, the first run compiles for many seconds; a warm one tells nothing of it."""
    screen = io.StringIO()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.delenv("TQDM_DISABLE", raising=False)
    kernel = njit(lambda x: x + 1.0)
    with bar("first", since=time.monotonic() - 7.0):
        kernel(1.0)
    assert screen.getvalue() == "first: compiling, once for each version of cosserat\n"
    with bar("second", since=time.monotonic() - 7.0):
        kernel(1.0)
    assert "second" not in screen.getvalue()


def test_times_and_sizes_are_told_in_units_of_their_own():
    times = {2.5: "2.5 s", 200: "3.33 min", 8000: "2.22 h", 4e5: "4.63 days", 1e9: "31.7 years"}
    assert {seconds: duration(seconds) for seconds in times} == times
    sizes = {12: "12 bytes", 1500: "1.5 kB", 4.8e6: "4.8 MB", 2e9: "2 GB", 3e12: "3 TB"}
    assert {count: size(count) for count in sizes} == sizes


def test_warnings_of_numerical_libraries_become_a_sentence_of_the_dataset(monkeypatch):
    def solve(self, name, run):
        found = original(self, name)
        np.array([1e308]) * 10
        return found

    original = RodStatics.solve
    monkeypatch.setattr(RodStatics, "solve", solve)
    data = cosserat.run("clamped_free")
    assert data.attrs["warnings"].splitlines()[-1] == (
        "numerics: overflow encountered in multiply in the solution; check the sizes of the values of the case"
    )


def test_linear_algebra_has_one_thread_in_a_run(monkeypatch):
    from threadpoolctl import threadpool_info

    def solve(self, name, run):
        assert {pool["num_threads"] for pool in threadpool_info()} == {1}
        return Solution({}, {})

    monkeypatch.setattr(RodStatics, "solve", solve)
    cosserat.run("clamped_free")


def test_statics_foresee_nothing_and_a_path_only_what_it_needs_at_least():
    assert cosserat.case("elastica").problem.forecast == Forecast()
    path = cosserat.case("column_path").problem
    assert path.arc.longest == 0.3
    assert path.forecast.work == f"4 points of {path.rod.vertices} vertices"


SLOW = "import sys, time, cosserat.cli, cosserat.__main__ as m\n"
SLOW += "def main():\n    print('on', flush=True)\n    {}\n    return 0\n"
SLOW += "cosserat.cli.main = main; sys.exit(m.main())"
DEAF = "while True:\n        try: time.sleep(30)\n        except KeyboardInterrupt: pass"

TURNED = "try: time.sleep(30)\n    except KeyboardInterrupt: raise SystemError('of a compiled function')"


@pytest.mark.parametrize(
    ("number", "status", "words", "work"),
    [
        (signal.SIGINT, 130, "interrupted", "time.sleep(30)"),
        (signal.SIGTERM, 143, "terminated", "time.sleep(30)"),
        (signal.SIGHUP, 129, "its terminal was closed", "time.sleep(30)"),
        (signal.SIGTERM, 143, "terminated", DEAF),
        (signal.SIGHUP, 129, "its terminal was closed", TURNED),
    ],
)
def test_signals_end_a_process_with_one_line_also_where_the_exception_is_swallowed(
    number, status, words, work
):
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW.format(work)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "on\n"
    process.send_signal(number)
    _, errors = process.communicate(timeout=20)
    assert (process.returncode, errors) == (
        status,
        f"cosserat: {words}; no incomplete file was written\n",
    )


def test_a_second_signal_does_not_disturb_the_end_of_the_run(monkeypatch):
    monkeypatch.setattr(signals, "received", [])
    with pytest.raises(signals.Stopped):
        signals._stop(signal.SIGINT, None)
    signals._stop(signal.SIGINT, None)


def test_an_error_keeps_its_class_and_its_parts(tmp_path, capsys, monkeypatch):
    from cosserat import runner

    def fail(case, result, limits):
        (tmp_path / "a.nc.parts").mkdir()
        raise NotConvergedError("stuck")

    monkeypatch.setattr(runner, "run", fail)
    assert main(["run", "necking", "-o", str(tmp_path / "a.nc")]) == 1
    assert re.search(r"stuck; the computed part is in .*a\.nc\.parts; remove", capsys.readouterr().err)
