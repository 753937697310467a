"""Each page of a built book as a notebook without outputs and as a script, with links to both at its head."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

FOLDER = "_downloads"


def add_downloads(notebooks: Sequence[Path], built: Path) -> None:
    """Write both files of every page into the built book, and the links below the heading of the page."""
    import jupytext
    import nbformat

    folder = built / FOLDER
    folder.mkdir(exist_ok=True)
    for path in notebooks:
        page = built / f"{path.stem}.html"
        notebook = nbformat.read(path, as_version=4)
        for cell in notebook.cells:
            if cell.cell_type == "code":
                cell.outputs, cell.execution_count = [], None
        nbformat.write(notebook, folder / path.name)
        script = jupytext.writes(notebook, fmt="py:percent")
        (folder / f"{path.stem}.py").write_text(script, encoding="utf-8")
        page.write_text(with_links(page.read_text(encoding="utf-8"), path.stem), encoding="utf-8")


def with_links(page: str, name: str) -> str:
    """The HTML of a page with links to its notebook and its script below its heading."""
    start = max(page.find("<article"), 0)
    links = (
        f'<p class="downloads">This page as <a href="{FOLDER}/{name}.ipynb" download>notebook</a> or '
        f'<a href="{FOLDER}/{name}.py" download>script</a>; both run in a checkout of cosserat.</p>'
    )
    return page[:start] + re.sub(r"</h1>", lambda end: f"{end[0]}\n{links}", page[start:], count=1)
