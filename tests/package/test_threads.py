"""Threads of one program, and its forks: libraries that know one thread only, and settings of the whole process."""

import hashlib
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import warnings
from concurrent.futures import ThreadPoolExecutor

import pytest
from threadpoolctl import threadpool_info

import cosserat
from cosserat.threads import FILES, solving

READ_AND_WRITE = """
import os, sys, threading
import cosserat

folder = sys.argv[1]
result = cosserat.run("elastica")
first = os.path.join(folder, "first.nc")
cosserat.save(result, first)
faults = []


def go(number):
    try:
        for _ in range(6):
            cosserat.load(first)
            cosserat.save(result, os.path.join(folder, f"{number}.nc"))
    except Exception as error:
        faults.append(error)


threads = [threading.Thread(target=go, args=(number,)) for number in range(6)]
for thread in threads:
    thread.start()
while threads[0].is_alive():
    child = os.fork()
    if child == 0:
        os._exit(int(not cosserat.load(first).identical(result)))
    faults += [status for status in os.waitpid(child, 0)[1:] if status]
for thread in threads:
    thread.join()
print(len(faults), faults[:1])
"""


FIRST_USE = """
import threading
import cosserat

names = ["elastica", "clamped_free", "worm", "vibration_consistent"]
together, found, faults = threading.Barrier(8), [], []


def go(number):
    together.wait(10)
    try:
        found.append(cosserat.case(names[number % 4]).name)
        cosserat.run("elastica")
    except Exception as error:
        faults.append(error)


threads = [threading.Thread(target=go, args=(number,)) for number in range(8)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(len(found), faults[:1])
"""


def printed(program, *arguments):
    """What a program of its own prints; without an error and without a word besides."""
    command = [sys.executable, "-c", program, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def together(*functions):
    with ThreadPoolExecutor(len(functions)) as pool:
        return [future.result() for future in [pool.submit(function) for function in functions]]


def test_threads_and_forks_read_and_write_files_at_once(tmp_path):
    """In a program of its own: HDF5 ends a program in which two threads call it."""
    assert printed(READ_AND_WRITE, tmp_path) == "0 []\n"
    digests = {hashlib.sha256(path.read_bytes()).hexdigest() for path in tmp_path.glob("*.nc")}
    assert len(digests) == 1


def test_threads_that_begin_together_read_units():
    """The first of them loads pint, which the others have to wait for."""
    assert printed(FIRST_USE) == "8 []\n"


def test_threads_draw_the_pictures_that_one_draws(tmp_path):
    results = [cosserat.run(name) for name in ("elastica", "clamped_free")]

    def drawn(number, name):
        cosserat.plot(results[number % 2], tmp_path / f"{name}{number}.svg")
        return (tmp_path / f"{name}{number}.svg").read_bytes()

    alone = [drawn(number, "alone") for number in range(2)]
    found = together(*[lambda number=number: drawn(number, "with") for number in range(8)])
    assert found == alone * 4


def test_each_thread_that_solves_keeps_its_own_warnings_and_the_last_gives_back_the_settings():
    before = [library["num_threads"] for library in threadpool_info()]
    shown, second_ended = [], threading.Event()
    both = threading.Barrier(2)

    def first():
        with solving() as kept:
            both.wait(10)
            warnings.warn("of the first", RuntimeWarning, stacklevel=1)
            assert second_ended.wait(10)
            assert {library["num_threads"] for library in threadpool_info()} == {1}
            warnings.warn("late", RuntimeWarning, stacklevel=1)
        return kept

    def second():
        with solving() as kept:
            both.wait(10)
            warnings.warn("of the second\nand more", RuntimeWarning, stacklevel=1)
        second_ended.set()
        return kept

    def other():
        assert second_ended.wait(10)
        warnings.warn("of another", UserWarning, stacklevel=1)

    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = lambda message, *where, **more: shown.append(str(message))
        usual = warnings.showwarning
        found = together(first, second, other)
        assert warnings.showwarning is usual
    assert found[:2] == [{"of the first", "late"}, {"of the second"}]
    assert shown == ["of another"]
    assert [library["num_threads"] for library in threadpool_info()] == before


def test_cases_are_solved_side_by_side_to_the_same_values():
    cases = [cosserat.case("elastica").vary(f"case{n}", rod={"length": 1 + n / 10}) for n in range(4)]
    alone = [cosserat.run(case) for case in cases]
    for found, own in zip(
        together(*[lambda case=case: cosserat.run(case) for case in cases]), alone, strict=True
    ):
        assert found.identical(own)


def test_a_fork_waits_for_a_thread_that_is_in_a_library():
    """Its child would find the library locked for ever, amid a call."""
    inside = threading.Event()

    def in_a_library():
        with FILES:
            inside.set()
            time.sleep(0.2)

    holding = threading.Thread(target=in_a_library)
    holding.start()
    assert inside.wait(10)
    child = os.fork()
    if child == 0:
        signal.alarm(5)
        with FILES:
            os._exit(0)
    assert os.waitpid(child, 0)[1] == 0
    holding.join()


def test_a_fork_has_a_reader_of_its_own(tmp_path):
    cosserat.save(cosserat.run("elastica"), tmp_path / "result.nc")
    cosserat.load(tmp_path / "result.nc")
    children = []
    for _ in range(3):
        child = os.fork()
        if child == 0:
            code = 1
            try:
                for _ in range(10):
                    cosserat.load(tmp_path / "result.nc")
                code = 0
            finally:
                os._exit(code)
        children.append(child)
    for _ in range(10):
        cosserat.load(tmp_path / "result.nc")
    assert [os.waitpid(child, 0)[1] for child in children] == [0, 0, 0]


def test_errors_results_and_cases_go_to_other_processes():
    case = cosserat.case("elastica").vary("stopped", newton={"max_iterations": 1})
    assert pickle.loads(pickle.dumps(case)) == case
    with pytest.raises(cosserat.NotConvergedError) as stopped:
        cosserat.run(case)
    arrived = pickle.loads(pickle.dumps(stopped.value))
    assert isinstance(arrived, cosserat.NotConvergedError)
    assert str(arrived) == str(stopped.value)
    assert arrived.residual == stopped.value.residual
    assert arrived.dataset.identical(stopped.value.dataset)
    assert arrived.reached is None
