"""Every input ends in one sentence: the part of the corpus that is refused while it is read.

`python -m tests.hostile inputs` tries all of it.
"""

import functools

import pytest

from cosserat.publications import kinds

from . import inputs
from .judge import Input, Outcome, faults
from .schema import spots
from .values import wrong

GROUPS = (
    "CSV",
    "JSON",
    "choice",
    "command",
    "control",
    "control inside",
    "deep",
    "deep inside",
    "digits",
    "empty",
    "empty inside",
    "file",
    "file of others",
    "long",
    "long inside",
    "name",
    "name listed",
    "not a number",
    "not a number inside",
    "not a number inside inside",
    "not a number inside inside inside",
    "option",
    "output",
    "range",
    "range inside",
    "stdin",
    "text",
    "title",
    "title listed",
    "type",
    "type inside",
    "unfolded",
    "unit",
    "unit inside inside inside",
    "unknown key",
    "unknown key inside",
)
"""What is wrong with the inputs, one test each."""


@functools.cache
def quick():
    """The inputs by their group: made when the first of these tests runs, not by each process that collects them."""
    found = {}
    for given in inputs.refused_at_once():
        found.setdefault(given.name.partition(":")[0], []).append(given)
    return found


@pytest.mark.parametrize("group", GROUPS)
def test_bad_input_ends_in_one_sentence(worker, group):
    failures = []
    for given in quick()[group]:
        if wrong := faults(given, worker.run(given)):
            failures.append(f"{given.name}: {'; '.join(wrong)}\n{given.reproduction}")
    assert not failures, "\n\n".join([f"{len(failures)} of {group}", *failures[:5]])


def test_the_corpus_has_every_kind_and_every_key():
    assert set(quick()) == set(GROUPS)
    assert sum(map(len, quick().values())) >= 400
    tried = {spot.same for spot in inputs.each_key()}
    for kind in kinds():
        assert {spot.same for spot in spots(kind)} <= tried
    assert [spot.path for spot in inputs.each_key() if not list(wrong(spot.value))] == []


@pytest.mark.parametrize(
    ("ended", "fault"),
    [
        (Outcome(0), "exit code"),
        (Outcome(2, err="nonsense\n"), "no sentence"),
        (Outcome(2), "no sentence"),
        (Outcome(2, err="cosserat: a\ncosserat: b\n"), "several lines"),
        (Outcome(2, err=f"cosserat: {'a' * 600}\n"), "long sentence"),
        (Outcome(2, err="x.py:1: RuntimeWarning: overflow\n  f(x)\ncosserat: a\n"), "warning leaked"),
        (Outcome(2, err="Traceback (most recent call last):\n  a\nValueError\n"), "traceback"),
        (Outcome(2, err="cosserat: a\x1b[31m\n"), "control character"),
        (Outcome(2, err="cosserat: a\n", added=("c.nc.parts/stopped.nc",)), "file left"),
        (Outcome(2, err="cosserat: a\n", changed=("mine.toml",)), "file changed"),
        (Outcome(2, err="cosserat: a\n", cpu=5.0), "slow refusal"),
        (Outcome(2, err="usage: cosserat\ncosserat run: error: one argument\n"), "no sentence"),
        (Outcome(raised="...", where="ValueError in a.py:1"), "traceback"),
        (Outcome(raised="no end", where="no end"), "endless"),
        (Outcome(raised="-11", where="no worker"), "crash"),
    ],
)
def test_the_judge_sees_each_fault(ended, fault):
    assert next(found.partition(":")[0] for found in faults(Input("", codes=(2,)), ended)).startswith(
        fault
    )


def test_the_judge_is_content_with_a_sentence_and_with_what_is_promised():
    assert faults(Input("", codes=(2,)), Outcome(2, err="cosserat: a\n")) == []
    assert faults(Input(""), Outcome(0, "wrote c.nc\n", "warning: a\n", added=("c.nc",))) == []
    assert faults(Input(""), Outcome(where="no end", raised="no end", err="c: 3 %, 5 min left\n")) == []
