"""The file to deposit: the repository with its results and its book, as a research object, without clock or host."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from cosserat.cases.catalogue import published
from cosserat.data.files import whole_or_absent
from cosserat.data.netcdf import load
from cosserat.errors import InputError
from cosserat.thesis.figures.catalogue import FIGURES
from cosserat.thesis.outputs import crate
from cosserat.thesis.outputs.manifest import CHECK, NAME, REPORT, read

CHECKLIST = "codecheck.yml"
FOLDERS = (
    ".ci",
    ".github",
    "chapters",
    "cosserat",
    "profiles",
    "results/captions",
    "results/reference",
    "tests",
)
FILES = (
    ".gitignore",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "LICENSE",
    "Makefile",
    "README.md",
    "Snakefile",
    "pyproject.toml",
    "requirements.in",
    "requirements.lock",
    "results/errata.toml",
    "results/faults.csv",
    "results/inputs.csv",
    "results/left_out.toml",
    "results/peers.csv",
    "results/tolerances.csv",
)
INPUTS = ("results/errata.toml", "results/left_out.toml", "results/tolerances.csv")
_CASES = "cosserat/thesis/cases/"
_LEFTOVERS = (".pyc", ".nbi", ".nbc", ".part")
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the first date that a zip file knows
_HOW = (
    "# To make these files again, in the folder of this file, and to compare them with those released:",
    "#   make environment && .venv/bin/snakemake all --forceall && .venv/bin/cosserat verify",
    "# Whoever checks them adds codechecker, certificate, report and summary.",
)


def sources(root: Path) -> list[str]:
    """Paths of the files of the repository, sorted: all that `make` and the tests need."""
    return sorted([*FILES, *(path for folder in FOLDERS for path in _below(root, folder))])


def _below(root: Path, folder: str) -> Iterator[str]:
    for path in (root / folder).rglob("*"):
        if path.is_file() and "__pycache__" not in path.parts and path.suffix not in _LEFTOVERS:
            yield path.relative_to(root).as_posix()


def write(root: Path, path: Path) -> None:
    """Archive the repository at `root` with its outputs: the same files give the same bytes.

    Raises
    ------
    InputError : a file is missing, or the archive cannot be written.
    """
    outputs = [f"results/{output.path}" for output in read(root / "results/reference" / NAME)]
    book = list(_below(root, "results/book"))
    if "results/book/index.html" not in book:
        raise InputError(f"there is no book in {root / 'results/book'}; make it with 'make'")
    files = {name: _content(root / name) for name in sorted({*sources(root), *outputs, *book})}
    citation = _citation(files["CITATION.cff"])
    files[CHECKLIST] = checklist(citation, outputs)
    files[crate.METADATA] = crate.metadata(
        crate.Contents(
            files=files,
            titles=titles(),
            inputs=[
                *(name for name in files if name.startswith(_CASES) and name.endswith(".toml")),
                *INPUTS,
            ],
            outputs=outputs,
            citation=citation,
            origin=_origin(root, outputs),
        )
    )
    with whole_or_absent(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name in sorted({*files, *crate.PARTS}):
            content = files.get(name, b"")
            archive.writestr(_entry(name, content), content, zipfile.ZIP_DEFLATED, 6)


def _entry(name: str, content: bytes) -> zipfile.ZipInfo:
    """An entry of no date and no owner; folders, and what begins as a script does, can be entered and executed."""
    entry = zipfile.ZipInfo(name, _EPOCH)
    entry.create_system = 3  # Unix, wherever it is written: permissions count
    entry.external_attr = (0o755 if entry.is_dir() or content.startswith(b"#!") else 0o644) << 16
    return entry


def _content(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise InputError(f"cannot archive {file} ({error.strerror}); make it with 'make'") from None


def _citation(text: bytes) -> dict[str, Any]:
    import yaml

    return dict(yaml.safe_load(text))


def titles() -> dict[str, str]:
    """Titles of outputs by their path."""
    cases = {f"results/cases/{name}.nc": case.title for name, case in published().items()}
    figures = {f"results/figures/{name}.svg": entry.title for name, entry in FIGURES.items()}
    table = {
        f"results/{REPORT}": "the results table: each published number, measured and judged",
        f"results/{CHECK}": "the summary of the results table",
    }
    return cases | figures | table


def _origin(root: Path, outputs: Sequence[str]) -> str:
    """Code and versions that made the netCDF files."""
    made = {
        (data.attrs["source"], data.attrs["environment"])
        for name in outputs
        if name.endswith(".nc")
        for data in [load(root / name, own=True)]
    }
    return "; ".join(f"{source}, with {versions}" for source, versions in sorted(made))


def checklist(citation: Mapping[str, Any], outputs: Sequence[str]) -> bytes:
    """The file of the CODECHECK community, with what authors fill in: outputs that a checker makes again, and how.

    The netCDF files are left to `cosserat verify`, which compares all of them.
    """
    import yaml

    known = titles()
    (thesis,) = citation["references"]
    content = {
        "version": "https://codecheck.org.uk/spec/config/2.0/",
        "manifest": [
            {"file": name, "comment": known[name]} for name in outputs if not name.endswith(".nc")
        ],
        "paper": {
            "title": thesis["title"],
            "authors": [
                {"name": f"{author['given-names']} {author['family-names']}"}
                for author in thesis["authors"]
            ],
        },
    }
    text = yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=100)
    return "\n".join(["---", *_HOW, text]).encode()
