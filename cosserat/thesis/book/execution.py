"""Executed notebooks from chapters."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from cosserat.data.files import check_destination, whole_or_absent
from cosserat.errors import CosseratError, InputError

_FRESH = "%reset -f\nimport os\nos.chdir({root!r})\ndel os"
"""What a kernel does before each chapter: it forgets the names of the one before, and goes back to its folder."""


def execute(chapters: Sequence[Path], outputs: Sequence[Path]) -> Iterator[Path]:
    """Run py:percent chapters from their repository's root, and write the notebooks with their outputs; yields each.

    One kernel runs them in turn, because half of the time of a short chapter is the start of its kernel; each begins
    without the names of the others.  The same outputs give the same bytes: cells are numbered, and no times are kept.

    Raises
    ------
    InputError : a chapter is missing, or a notebook cannot be written.
    CosseratError : a cell failed; its notebook and those after it are not written.
    """
    notebooks = [_read(chapter) for chapter in chapters]
    for output in outputs:
        check_destination(output, ".ipynb")
    root = chapters[0].resolve().parents[1]
    with _kernel(root) as kernel:
        for chapter, notebook, output in zip(chapters, notebooks, outputs, strict=True):
            _run(notebook, kernel, chapter, root)
            _write(notebook, output)
            yield output


def _read(chapter: Path) -> Any:
    import jupytext

    if not chapter.is_file():
        raise InputError(
            f"there is no chapter {chapter}; chapters are the .py files of the folder chapters"
        )
    try:
        return jupytext.read(chapter)
    except (OSError, ValueError) as error:  # of text that is no Python, or no text
        raise InputError(f"cannot read the chapter {chapter} ({error}); give a .py file") from None


class _Kernel(NamedTuple):
    """A running kernel, and the client that talks to it."""

    manager: Any
    client: Any


@contextmanager
def _kernel(root: Path) -> Iterator[_Kernel]:
    """A running kernel in a folder."""
    from jupyter_client.manager import KernelManager

    own = {**os.environ, "TQDM_DISABLE": "1"}  # a page shows no progress bars
    manager = KernelManager(kernel_name="python3")
    manager.start_kernel(
        cwd=str(root), env=own, extra_arguments=["--log-level=ERROR"]
    )  # its port is local
    client = manager.client()
    client.start_channels()
    try:
        client.wait_for_ready(timeout=60)
        yield _Kernel(manager, client)
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)


def _run(notebook: Any, kernel: _Kernel, chapter: Path, root: Path) -> None:
    """Execute the cells of a notebook in a kernel that forgets what it did before."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    notebook.cells.insert(0, nbformat.v4.new_code_cell(_FRESH.format(root=str(root))))
    client = NotebookClient(notebook, km=kernel.manager, timeout=300, record_timing=False)
    client.kc = kernel.client
    try:
        client.execute()
    except CellExecutionError as error:
        raise CosseratError(f"{chapter}: a cell failed: {error}") from None
    notebook.cells.pop(0)


def _write(notebook: Any, output: Path) -> None:
    """Write a notebook whose cells and executions are counted from its own start."""
    import nbformat

    count = 0
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number}"
        if cell.cell_type != "code" or cell.execution_count is None:
            continue
        count += 1
        cell.execution_count = count
        for shown in cell.outputs:
            if shown.output_type == "execute_result":
                shown.execution_count = count
    with whole_or_absent(output) as temporary:
        nbformat.write(notebook, temporary)
