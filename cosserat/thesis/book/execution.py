"""Executed notebooks from chapters.  Several share one process, in which each begins with nothing defined."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cosserat.data.files import check_destination, whole_or_absent
from cosserat.errors import CosseratError, InputError

_FORGET = "import os\nos.chdir({root!r})\nget_ipython().reset()"
"""What stands between two chapters; modules stay imported, which is most of the time of a short chapter."""


def execute(chapters: Sequence[Path], outputs: Sequence[Path]) -> None:
    """Run py:percent chapters from their repository's root and write notebooks with their outputs.

    The same outputs give the same bytes, alone or after others: cells and executions are numbered, no times are kept.

    Raises
    ------
    InputError : a chapter is missing, chapters are in several folders, or a notebook cannot be written.
    CosseratError : a cell failed; nothing is written.
    """
    import nbformat

    for output in outputs:
        check_destination(output, ".ipynb")
    notebooks = [_read(chapter) for chapter in chapters]
    roots = {chapter.resolve().parents[1] for chapter in chapters}
    if len(roots) > 1:
        raise InputError(
            f"{chapters[0]} and {chapters[-1]} are of several checkouts; execute each by itself"
        )
    whole = nbformat.v4.new_notebook(metadata=notebooks[0].metadata)
    owners: list[Path] = []
    for chapter, notebook in zip(chapters, notebooks, strict=True):
        if owners:
            whole.cells.append(nbformat.v4.new_code_cell(_FORGET.format(root=str(*roots))))
            owners.append(chapter)
        whole.cells += notebook.cells
        owners += [chapter] * len(notebook.cells)
    _run(whole, owners, *roots)
    for notebook, output in zip(notebooks, outputs, strict=True):
        notebook.metadata["language_info"] = whole.metadata["language_info"]
        _number(notebook)
        with whole_or_absent(output) as temporary:
            nbformat.write(notebook, temporary)


def _read(chapter: Path) -> Any:
    """A chapter as a notebook."""
    import jupytext

    if not chapter.is_file():
        raise InputError(
            f"there is no chapter {chapter}; chapters are the .py files of the folder chapters"
        )
    try:
        return jupytext.read(chapter)
    except (OSError, ValueError) as error:  # of text that is no Python, or no text
        raise InputError(f"cannot read the chapter {chapter} ({error}); give a .py file") from None


def _run(notebook: Any, owners: Sequence[Path], root: Path) -> None:
    """Execute the cells of a notebook in place.

    owners : the chapter of each cell.
    """
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    reached = [0]

    def note(cell: Any, cell_index: int) -> None:
        reached[0] = cell_index

    client = NotebookClient(
        notebook,
        timeout=300,
        record_timing=False,
        coalesce_streams=True,  # a printed text comes in pieces that depend on time
        kernel_name="python3",
        resources={"metadata": {"path": str(root)}},
        on_cell_start=note,
    )
    try:
        client.execute(env={**os.environ, "TQDM_DISABLE": "1"})  # a page shows no progress bars
    except CellExecutionError as error:
        raise CosseratError(f"{owners[reached[0]]}: a cell failed: {error}") from None


def _number(notebook: Any) -> None:
    """Number cells, and executions from 1 on."""
    executed = 0
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number}"
        if cell.get("execution_count") is None:
            continue
        executed += 1
        cell.execution_count = executed
        for output in cell.outputs:
            if output.output_type == "execute_result":
                output.execution_count = executed
