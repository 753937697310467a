"""The description of the archive: a Workflow Run RO-Crate of the workflow, its one run, its inputs and its outputs."""

from __future__ import annotations

import hashlib
import json
import mimetypes
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocrate.model import ContextEntity, File
    from rocrate.rocrate import ROCrate

METADATA = "ro-crate-metadata.json"
WORKFLOW = "Snakefile"
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": ("Process Run Crate", "0.5"),
    "https://w3id.org/ro/wfrun/workflow/0.5": ("Workflow Run Crate", "0.5"),
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": ("Workflow RO-Crate", "1.0"),
}
"""The profiles that the crate conforms to; all three build on RO-Crate 1.1."""
_OF_WORKFLOW = "https://bioschemas.org/profiles/ComputationalWorkflow/1.0-RELEASE"

_TERMS = {"sha256": "https://w3id.org/ro/terms/workflow-run#sha256"}
_LICENCE = "https://spdx.org/licenses/MIT"
_TYPES = {
    ".nc": "application/x-netcdf",
    ".toml": "application/toml",
    ".md": "text/markdown",
    ".csv": "text/csv",
}
PARTS = {
    "chapters/": "the chapters of the book, as Python files",
    "cosserat/": "the package",
    "results/book/": "the book; its first page is index.html",
    "results/reference/": "stored references and the manifest of all outputs",
    "tests/": "the tests",
}
"""Folders that the crate describes as a whole."""


@dataclass(frozen=True)
class Contents:
    """What a crate describes.

    files : the bytes of every file by its path.  titles : of files, where they have one.
    inputs, outputs : paths of what the workflow read and made.
    citation : the tables of CITATION.cff.
    origin : of the outputs: code and versions.
    """

    files: Mapping[str, bytes]
    titles: Mapping[str, str]
    inputs: Sequence[str]
    outputs: Sequence[str]
    citation: Mapping[str, Any]
    origin: str


def metadata(contents: Contents) -> bytes:
    """The file `ro-crate-metadata.json` of an archive: the same for the same contents.

    The action has no time: the day of the release is the only date.
    """
    from rocrate.rocrate import ROCrate

    crate = ROCrate(version="1.1")
    crate.metadata.extra_terms.update(_TERMS)
    project = _context(crate, "#project", "Organization", name="The cosserat project")
    workflow = _workflow(crate, contents, project)
    files = {path: _file(crate, path, contents) for path in _described(contents)}
    for path, words in PARTS.items():
        crate.add_dataset(dest_path=path, properties={"name": path, "description": words})
    files["README.md"]["about"] = {"@id": "./"}
    inputs = [files[path] for path in contents.inputs]
    outputs = [files[path] for path in contents.outputs]
    run = crate.add_action(
        workflow,
        "#run",
        inputs,
        outputs,
        {
            "name": "The run that made these results",
            "description": f"'make' in the root of this archive. {contents.origin}",
            "actionStatus": "http://schema.org/CompletedActionStatus",
        },
    )
    run["agent"] = project
    _slots(crate, workflow, "input", inputs)
    _slots(crate, workflow, "output", outputs)
    _root(crate, contents, project, run)
    return json.dumps(crate.metadata.generate(), indent=1, sort_keys=True, ensure_ascii=False).encode()


def _described(contents: Contents) -> list[str]:
    """Files that the crate lists by themselves: inputs, outputs, and what stands at the root."""
    root = [path for path in contents.files if "/" not in path and path not in (WORKFLOW, METADATA)]
    return sorted({*root, *contents.inputs, *contents.outputs})


def _root(crate: ROCrate, contents: Contents, project: ContextEntity, run: ContextEntity) -> None:
    citation = contents.citation
    (thesis,) = citation["references"]
    (author,) = thesis["authors"]
    name = f"{author['given-names']} {author['family-names']}"
    university = _context(crate, "#university", "Organization", name=thesis["institution"]["name"])
    person = _context(crate, "#author-of-the-thesis", "Person", name=name, affiliation=university)
    crate.name = citation["title"]
    crate.description = (
        "A thesis reproduced: the code, the workflow, its results, and the book that explains them."
    )
    crate.datePublished = str(citation["date-released"])
    crate.license = _context(crate, _LICENCE, "CreativeWork", name=f"{citation['license']} licence")
    root = crate.root_dataset
    root["version"] = str(citation["version"])
    root["author"] = root["publisher"] = project
    root["mentions"] = run
    root["citation"] = _context(
        crate,
        "#thesis",
        "Thesis",
        name=thesis["title"],
        author=person,
        datePublished=str(thesis["year"]),
        sourceOrganization=university,
    )
    root["conformsTo"] = [
        _context(crate, address, "CreativeWork", name=title, version=version)
        for address, (title, version) in PROFILES.items()
    ]


def _workflow(crate: ROCrate, contents: Contents, project: ContextEntity) -> File:
    about = {
        "name": "Cases to netCDF, netCDF to the judged table and the figures, all of that to the book",
        "version": str(contents.citation["version"]),
        "license": {"@id": _LICENCE},
        "conformsTo": {"@id": _OF_WORKFLOW},
        "encodingFormat": "text/plain",
        **_size(contents.files[WORKFLOW]),
    }
    workflow = crate.add_workflow(dest_path=WORKFLOW, properties=about, main=True, lang="snakemake")
    workflow["creator"] = project
    return workflow


def _file(crate: ROCrate, path: str, contents: Contents) -> File:
    ending = path[path.rindex(".") :] if "." in path else ""
    kind = _TYPES.get(ending) or mimetypes.types_map.get(ending, "text/plain")
    about = {
        "name": contents.titles.get(path, path),
        "encodingFormat": kind,
        **_size(contents.files[path]),
    }
    return crate.add_file(dest_path=path, properties=about)


def _size(content: bytes) -> dict[str, str]:
    return {"contentSize": str(len(content)), "sha256": hashlib.sha256(content).hexdigest()}


def _slots(crate: ROCrate, workflow: File, way: str, files: Sequence[File]) -> None:
    """The parameters of a workflow: each file that goes in or comes out is the example of one."""
    for file in files:
        slot = crate.add_formal_parameter(
            file["name"], "File", f"#{way}-{file.id}", valueRequired=way == "input"
        )
        slot["workExample"] = file
        file["exampleOfWork"] = slot
        workflow.append_to(way, slot)


def _context(crate: ROCrate, identifier: str, kind: str, **about: object) -> ContextEntity:
    from rocrate.model import ContextEntity

    return crate.add(ContextEntity(crate, identifier, properties={"@type": kind, **about}))
