"""The manifest of all outputs, their check on another machine, and the file to deposit."""

import hashlib
import json
import platform
import shutil
import subprocess
import zipfile
from datetime import date
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
import yaml
from conftest import ROOT, save_own

import cosserat
from cosserat.cli import main
from cosserat.data.variables import VARIABLES
from cosserat.errors import InputError
from cosserat.studies.door import find_study
from cosserat.thesis.outputs import archive, crate, manifest
from cosserat.thesis.outputs.manifest import COLUMNS, Output
from cosserat.thesis.outputs.verify import DIFFERS, MISSING, SAME_BYTES, SAME_VALUES, WITHIN, verify
from cosserat.thesis.table.reference import compare
from cosserat.thesis.table.tolerances import read_report, read_table

REFERENCES = ROOT / "results/reference"
LISTED = manifest.read(REFERENCES / manifest.NAME)
ROWS = read_table(ROOT / "results/tolerances.csv")
STALE = "the manifest is stale: 'make', then 'cosserat manifest'"
PICTURE = '<svg><path id="p0123456789" d="M 1.5 2.25 L 30.1 4"/></svg>'


def test_the_manifest_lists_every_output_with_its_floor_and_its_rows():
    known = manifest.expected(ROWS)
    assert [output.path for output in LISTED] == list(known), STALE
    assert {output.path: output.rows for output in LISTED} == {
        path: rows for path, (_, rows) in known.items()
    }, STALE
    for output in LISTED:
        floor, _ = known[output.path]
        if floor:
            assert output.floor == floor, STALE
            continue
        for said in output.floor.split("; "):
            name, number, unit = said.split(" ", 2)
            name = read_by(output.path).get(name, name)
            assert (f"{VARIABLES[name].floor:g}", VARIABLES[name].units) == (number, unit), STALE


def read_by(path):
    """The variables that the read-outs of a study read, by their names."""
    if not path.startswith("studies/"):
        return {}
    return {one.name: one.variable for one in find_study(Path(path).stem).keep}


def test_a_study_of_another_machine_is_within_its_floor_and_another_study_is_not(tmp_path):
    stored = cosserat.load(REFERENCES / "calibration_reach.nc")
    nudged = stored.assign(sag=stored.sag * (1 + 1e-12))
    (change,) = compare(nudged, stored)
    assert 0 < change.largest < change.allowed
    (change,) = compare(stored.assign(sag=stored.sag * (1 + 1e-8)), stored)
    assert not change.held
    with pytest.raises(InputError, match="other members"):
        compare(stored.assign(status=stored.status + 1), stored)


def test_the_manifest_names_the_references_as_they_are():
    for output in LISTED:
        stored = manifest.reference_of(output.path, REFERENCES)
        assert output.reference == ("" if stored is None else manifest.digest(stored)), (
            f"{output.path}: {STALE}"
        )


def test_the_stored_report_has_the_rows_of_the_table():
    stored = read_report(REFERENCES / manifest.REPORT)
    assert [row["id"] for row in stored] == [row.id for row in ROWS], STALE
    for row, stored_row in zip(ROWS, stored, strict=True):
        for key in ("published", "claim", "standing", "case"):
            assert stored_row[key] == (getattr(row, key) or ""), f"{row.id}: {STALE}"


@pytest.fixture
def released(solved, tmp_path):
    """A folder of results with a case, a picture and a report, its references, and its manifest."""
    results, references = tmp_path / "results", tmp_path / "results/reference"
    for name in ("cases", "figures", "reference"):
        (results / name).mkdir(parents=True)
    cosserat.save(solved["clamped_free"], results / "cases/clamped_free.nc")
    shutil.copy(REFERENCES / "clamped_free.nc", references)
    (results / "figures/fig_far.svg").write_text(PICTURE)
    shutil.copy(REFERENCES / manifest.REPORT, results)
    shutil.copy(REFERENCES / manifest.REPORT, references)
    outputs = [
        manifest._output(results, references, path, "", "")
        for path in ("cases/clamped_free.nc", "figures/fig_far.svg", manifest.REPORT)
    ]
    manifest.write(outputs, references / manifest.NAME)
    return results, outputs


def verdicts(released):
    results, outputs = released
    return {
        found.path: (found.word, found.reason)
        for found in verify(outputs, results, results / "reference")
    }


def verdict(released, path):
    return verdicts(released)[path]


def save_moved(solved, released, by):
    data = solved["clamped_free"]
    values = data.u.to_numpy().copy()
    values[7, 1] += by
    save_own(data.assign(u=data.u.copy(data=values)), released[0] / "cases/clamped_free.nc")


def test_outputs_as_released_have_the_same_bytes(released, capsys):
    results, outputs = released
    assert {word for word, _ in verdicts(released).values()} == {SAME_BYTES}
    folders = ["--results", str(results), "--references", str(results / "reference")]
    assert main(["verify", *folders]) == 0
    assert capsys.readouterr().out.endswith("3 outputs: 3 same bytes\n")
    (results / manifest.REPORT).unlink()
    assert main(["verify", *folders]) == 1
    said = capsys.readouterr()
    assert f"missing           {manifest.REPORT}: 'make' makes it" in said.out
    assert "3 outputs: 2 same bytes, 1 missing; these are not" in said.err
    assert len(outputs) == 3


def test_other_versions_with_the_same_numbers_have_the_same_values(solved, released):
    other = solved["clamped_free"].assign_attrs(source="cosserat 9.9", environment="{}", history="mine")
    save_own(other, released[0] / "cases/clamped_free.nc")
    assert verdict(released, "cases/clamped_free.nc") == (SAME_VALUES, "")


def test_a_result_of_another_processor_is_within_its_floor_and_says_by_how_much(solved, released):
    save_moved(solved, released, 1e-11)
    word, reason = verdict(released, "cases/clamped_free.nc")
    assert word == WITHIN
    assert "of what is allowed, u: 1e-11 m at vertex 7, axis 1" in reason
    assert float(reason.split()[0]) == pytest.approx(
        1e-11 / (1e-12 + 1e-9 * float(np.abs(solved["clamped_free"].u).max())), rel=0.05
    )


def test_a_changed_result_differs_and_says_where_and_by_how_much(solved, released):
    save_moved(solved, released, 1e-8)
    word, reason = verdict(released, "cases/clamped_free.nc")
    assert word == DIFFERS
    assert "u: 1e-08 m at vertex 7, axis 1" in reason


def test_what_reads_an_output_whose_digests_were_computed_anew_says_that_it_is_not_as_released(
    solved, released, capsys
):
    """Nobody can tell it by the file alone; rows and pictures of another processor's results need no word."""
    results, _ = released
    cases = ["--cases", str(results / "cases")]
    for by, said in ((1e-11, ""), (1e-8, "clamped_free.nc is not as released: ")):
        save_moved(solved, released, by)
        assert cosserat.data.netcdf.load(results / "cases/clamped_free.nc", own=True).sizes
        assert (
            main(["figure", "fig_3_10", *cases, "-o", str(results / "x.svg")]) == 2
        )  # other cases are missing
        told = capsys.readouterr().err
        assert (said in told) if said else ("released" not in told)
    assert "u: 1e-08 m at vertex 7" in told
    main(["measure", *cases, "-o", str(results / "y.csv")])
    assert said in capsys.readouterr().err
    report = results / manifest.REPORT
    assert main(["check", str(report)]) == 0
    assert "released" not in capsys.readouterr().err
    report.write_text(report.read_text().replace(",within\n", ',"outside, as claimed"\n', 1))
    main(["check", str(report)])
    assert "report.csv is not as released: " in capsys.readouterr().err


@pytest.mark.parametrize("content", [b"", b"not netCDF", b"\x89HDF\r\n\x1a\n"])
def test_a_damaged_result_differs(released, content):
    (released[0] / "cases/clamped_free.nc").write_bytes(content)
    assert verdict(released, "cases/clamped_free.nc")[0] == DIFFERS


def test_a_result_whose_reference_is_newer_than_the_manifest_differs(solved, released):
    save_moved(solved, released, 1e-11)
    cosserat.save(solved["clamped_free"], released[0] / "reference/clamped_free.nc")
    assert "'cosserat manifest'" in verdict(released, "cases/clamped_free.nc")[1]


@pytest.mark.parametrize(
    ("drawn", "word"),
    [
        (PICTURE.replace("0123456789", "abcdef0123"), SAME_VALUES),  # a name made from a digest
        (PICTURE.replace("2.25", "2.250001"), SAME_VALUES),
        (PICTURE.replace("2.25", "2.45"), DIFFERS),
        (PICTURE.replace("L 30.1 4", "L 30.1 4 L 5 6"), DIFFERS),
        (PICTURE.replace("<path", '<path fill="#0b5fa5"'), DIFFERS),
    ],
)
def test_a_picture_is_compared_by_its_drawing(released, drawn, word):
    (released[0] / "figures/fig_far.svg").write_text(drawn)
    assert verdict(released, "figures/fig_far.svg")[0] == word


def test_colours_of_a_picture_belong_to_its_form():
    form, places = manifest.structure('<path style="fill: #1e9999" d="M -1.5e-05 2"/>')
    assert "#1e9999" in form
    assert places == [-1.5e-05, 2]


def change_report(released, name, key, change):
    path = released[0] / manifest.REPORT
    lines = path.read_text().splitlines()
    place = next(k for k, line in enumerate(lines) if line.startswith(f"{name},"))
    old = next(row for row in read_report(path) if row["id"] == name)[key]
    assert f",{old}," in f"{lines[place]},"
    lines[place] = f"{lines[place]},".replace(f",{old},", f",{change(old)},")[:-1]
    path.write_text("\n".join(lines) + "\n")


@pytest.mark.parametrize(("share", "word"), [(0.05, WITHIN), (0.5, DIFFERS)])
def test_a_measured_number_may_move_by_a_part_of_its_tolerance(released, share, word):
    row = next(row for row in ROWS if row.id == "2.8-mu1-longitudinal")
    change_report(released, row.id, "measured", lambda old: float(old) + share * row.tolerance)
    found, reason = verdict(released, manifest.REPORT)
    assert found == word
    assert reason.startswith(f"{row.id} moved by {share}")


def test_a_row_with_another_verdict_differs(released):
    change_report(released, "2.8-mu1-longitudinal", "verdict", lambda _: "FAILS")
    assert verdict(released, manifest.REPORT) == (DIFFERS, "other verdicts: 2.8-mu1-longitudinal: FAILS")


def test_a_missing_output_is_named(released):
    (released[0] / "figures/fig_far.svg").unlink()
    assert verdict(released, "figures/fig_far.svg")[0] == MISSING


@pytest.mark.parametrize("text", ["", "path,bytes\n", ",".join(COLUMNS) + "\na,b\n"])
def test_a_damaged_manifest_is_refused(tmp_path, capsys, text):
    (tmp_path / manifest.NAME).write_text(text)
    assert main(["verify", "--references", str(tmp_path)]) == 2
    assert "'cosserat manifest'" in capsys.readouterr().err


def tracked():
    done = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return {name for name in done.stdout.split("\0") if name}


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="an archive has no history")
def test_the_archive_holds_every_file_of_the_repository():
    missing = {name for name in tracked() if (ROOT / name).exists()} - set(archive.sources(ROOT))
    assert missing == set()


@pytest.fixture(scope="module")
def repository(tmp_path_factory, solved):
    """A copy of the repository with a few outputs and a book of one page."""
    root = tmp_path_factory.mktemp("archive") / "repository"
    left_out = shutil.ignore_patterns("__pycache__", "*.nc")
    for folder in archive.FOLDERS:
        shutil.copytree(ROOT / folder, root / folder, ignore=left_out)
    for name in archive.FILES:
        shutil.copy(ROOT / name, root / name)
    results = root / "results"
    for name in ("cases", "figures", "book"):
        (results / name).mkdir()
    cosserat.save(solved["clamped_free"], results / "cases/clamped_free.nc")
    (results / "figures/fig_far.svg").write_text(PICTURE)
    (results / "book/index.html").write_text("<html></html>")
    for name in (manifest.REPORT, manifest.CHECK):
        shutil.copy(REFERENCES / name, results)
    paths = ("cases/clamped_free.nc", "figures/fig_far.svg", manifest.REPORT, manifest.CHECK)
    outputs = [Output(path, "", "", "", "", "") for path in paths]
    manifest.write(outputs, results / "reference" / manifest.NAME)
    return root


@pytest.fixture(scope="module")
def archived(repository):
    path = repository.parent / "archive.zip"
    archive.write(repository, path)
    return path


def test_the_archive_has_the_same_bytes_at_any_time_and_for_any_user(repository, archived):
    again = repository.parent / "again.zip"
    for file in repository.rglob("*.py"):
        file.touch()
        file.chmod(0o600)
    (repository / "cosserat/__pycache__").mkdir()
    (repository / "cosserat/__pycache__/left.pyc").touch()
    archive.write(repository, again)
    assert again.read_bytes() == archived.read_bytes()
    with zipfile.ZipFile(archived) as files:
        assert {entry.date_time for entry in files.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert files.namelist() == sorted(files.namelist())
        executable = {entry.filename for entry in files.infolist() if entry.external_attr >> 16 == 0o755}
        assert {".ci/environment", ".ci/run"} <= executable


def test_what_the_archive_says_of_itself_names_no_clock_and_no_host(archived):
    with zipfile.ZipFile(archived) as files:
        said = b"".join(files.read(name) for name in (crate.METADATA, archive.CHECKLIST)).decode()
        released = yaml.safe_load(files.read("CITATION.cff"))["date-released"]
    for told in (platform.node(), str(ROOT), str(archived.parent), "startTime", "endTime"):
        assert told not in said
    assert str(date.today()) not in said.replace(str(released), "")


def test_an_archive_lacks_no_output(repository, capsys, monkeypatch):
    monkeypatch.chdir(repository)
    file = repository / "results/figures/fig_far.svg"
    file.unlink()
    assert main(["archive"]) == 2
    assert "cannot archive results/figures/fig_far.svg" in capsys.readouterr().err
    assert not (repository / "results/archive.zip").exists()
    file.write_text(PICTURE)


def test_the_checklist_names_what_to_make_again_and_how(archived):
    with zipfile.ZipFile(archived) as files:
        text = files.read(archive.CHECKLIST).decode()
        names = set(files.namelist())
    assert text.startswith("---\n")
    assert "snakemake all --forceall && .venv/bin/cosserat verify" in text
    content = yaml.safe_load(text)
    listed = {item["file"]: item["comment"] for item in content["manifest"]}
    assert set(listed) == {"results/figures/fig_far.svg", "results/report.csv", "results/check.txt"}
    assert listed["results/figures/fig_far.svg"] == "Large deflections"
    assert set(listed) <= names
    assert content["paper"]["authors"] == [{"name": "Evan Grant Hemingway"}]


def test_the_crate_says_truly_what_is_in_it(archived):
    with zipfile.ZipFile(archived) as files:
        graph = {entity["@id"]: entity for entity in json.loads(files.read(crate.METADATA))["@graph"]}
        described = [entity for entity in graph.values() if "sha256" in entity]
        assert len(described) > 20
        for entity in described:
            content = files.read(entity["@id"])
            assert entity["sha256"] == hashlib.sha256(content).hexdigest()
            assert entity["contentSize"] == str(len(content))
    run = graph["#run"]
    assert run["instrument"] == {"@id": "Snakefile"} == graph["./"]["mainEntity"]
    results = {item["@id"] for item in run["result"]}
    assert results == {
        f"results/{name}"
        for name in ("cases/clamped_free.nc", "figures/fig_far.svg", "report.csv", "check.txt")
    }
    assert {"cosserat/thesis/cases/chapter2.toml", "results/tolerances.csv"} <= {
        item["@id"] for item in run["object"]
    }
    assert "code sha256:" in run["description"]


def context_of_crates():
    """The context of RO-Crate 1.1: that of 1.3, which `rocrate` carries, with the older addresses of four terms.

    Of the terms that both have, these are the only ones that differ, but for 'cite-as', which no crate of ours has.
    """
    text = (resources.files("rocrate") / "data/ro-crate.jsonld").read_text(encoding="utf-8")
    context = json.loads(text)
    workflow, parameter = (
        "https://bioschemas.org/ComputationalWorkflow",
        "https://bioschemas.org/FormalParameter",
    )
    context["@context"] |= {
        "ComputationalWorkflow": workflow,
        "FormalParameter": parameter,
        "input": f"{workflow}#input",
        "output": f"{workflow}#output",
    }
    return json.dumps(context).encode()


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """The validator's cache of pages, with the one that it needs: so it asks no network."""
    from requests_cache import CachedSession
    from requests_cache.models import CachedRequest, CachedResponse

    path, address = tmp_path_factory.mktemp("cache") / "pages", "https://w3id.org/ro/crate/1.1/context"
    page = CachedResponse(
        url=address,
        status_code=200,
        headers={"Content-Type": "application/ld+json"},
        request=CachedRequest(method="GET", url=address, headers={}),
    )
    page._content = context_of_crates()
    with CachedSession(cache_name=str(path), backend="sqlite") as session:
        session.cache.save_response(page, session.cache.create_key(page.request))
    return path


def validated(path, cache):
    """What the validator of the profile finds at fault, without a network."""
    from rocrate_validator.services import ValidationSettings, validate

    settings = ValidationSettings(
        rocrate_uri=str(path),
        profile_identifier="workflow-run-crate-0.5",
        requirement_severity="REQUIRED",
        offline=True,
        cache_path=cache,
    )
    return [issue.message for issue in validate(settings).get_issues()]


@pytest.mark.workflow  # it takes five seconds
@pytest.mark.filterwarnings("ignore")  # of the validator's own libraries
def test_the_archive_is_a_workflow_run_crate(archived, cache):
    assert validated(archived, cache) == []


@pytest.mark.workflow
@pytest.mark.filterwarnings("ignore")
def test_the_validator_notices_a_crate_without_its_run(archived, cache, tmp_path):
    broken = tmp_path / "broken.zip"
    with zipfile.ZipFile(archived) as files, zipfile.ZipFile(broken, "w") as written:
        for name in files.namelist():
            content = files.read(name)
            if name == crate.METADATA:
                content = content.replace(b'"CreateAction"', b'"Action"')
            written.writestr(name, content)
    assert any("CreateAction" in message for message in validated(broken, cache))
