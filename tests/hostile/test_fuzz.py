"""Input by chance ends as promised: fixed counts of case files, command lines and damaged results.

`python -m tests.hostile fuzz`, `lines` and `damage` try more.
"""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cosserat.publications import kinds

from . import damage, fuzz, lines
from .judge import faults
from .regressions import FOUND
from .schema import FAMILIES

CASES, LINES, FILES, FOREIGN = 220, 40, 100, 4
"""Case files, command lines, and damaged results with and without a digest that are tried, the same in each run: to
read one without a digest takes a process of its own."""
CHANGES = st.lists(
    st.tuples(st.sampled_from(fuzz.CHANGES), st.integers(0, 2**32 - 1)), min_size=1, max_size=6
)
EXAMPLES = st.builds(
    fuzz.Example, st.sampled_from([*kinds(), *FAMILIES]), CHANGES.map(tuple), st.booleans()
)


@given(example=EXAMPLES)
@settings(max_examples=CASES)
def test_a_changed_case_is_read_or_refused_in_one_sentence(worker, example):
    wrong = fuzz.faults_of(fuzz.read(worker, example))
    assert not wrong, f"{wrong}\n{example.input.reproduction}"


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return damage.results(tmp_path_factory.mktemp("results"), ["rod statics", "posture", "study"])


def test_a_changed_command_line_ends_in_one_sentence(worker, results):
    content = results[0].read_bytes()
    failures = []
    for number in range(LINES):
        example = lines.example(0, number, content)
        if wrong := faults(example, worker.run(example)):
            failures.append(f"{wrong}\n{example.reproduction}")
    assert not failures, "\n\n".join(failures[:5])


@pytest.mark.parametrize(
    ("digest", "files", "damages"), [("kept", FILES, damage.WITHIN), ("cut", FOREIGN, ())]
)
def test_a_damaged_result_is_refused_or_read_as_it_was(
    worker, results, tmp_path, digest, files, damages
):
    failures = []
    for number in range(files):
        example = damage.example(results, 0, number, [digest], damages)
        tried = damage.tried(worker, example, tmp_path / f"{number}.nc", commands=0)
        failures += [f"{example}: {wrong}" for _, _, wrong in tried if wrong]
    assert not failures, "\n".join(failures[:10])


@pytest.mark.parametrize("name", FOUND)
def test_what_was_found_before_is_mended(worker, name):
    found = FOUND[name]()
    assert faults(found, worker.run(found)) == [], found.reproduction
