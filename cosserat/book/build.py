"""Chapters into executed notebooks, and those into a book that needs no network."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import os
import shutil
import tempfile
from importlib import resources
from pathlib import Path

from cosserat.errors import CosseratError, InputError

_CONF = """
project = "cosserat"
author = "The cosserat project"
extensions = ["myst_nb"]
nb_execution_mode = "off"
nb_merge_streams = True
nb_render_markdown_format = "myst"
myst_enable_extensions = ["amsmath", "dollarmath", "colon_fence"]
suppress_warnings = ["mystnb.unknown_mime_type"]
html_theme = "sphinx_book_theme"
html_title = "Cosserat curves"
html_static_path = ["_static"]
html_css_files = ["book.css"]
html_copy_source = False
html_show_sourcelink = False
html_last_updated_fmt = None
html_theme_options = {
    "use_download_button": False,
    "use_fullscreen_button": False,
    "show_toc_level": 2,
    "navbar_persistent": [],
}
mathjax_path = "mathjax/tex-chtml-full.js"
mathjax3_config = {"options": {"enableMenu": False}, "tex": {"tagSide": "right"}}
"""


def execute(chapter: Path, output: Path) -> None:
    """Run a py:percent chapter from its repository's root and write the notebook with its outputs.

    Raises
    ------
    InputError : the chapter or the folder of the notebook is missing.
    CosseratError : a cell failed; nothing is written.
    """
    import jupytext
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    if not chapter.is_file():
        raise InputError(
            f"there is no chapter {chapter}; chapters are the .py files of the folder chapters"
        )
    if not output.parent.is_dir():
        raise InputError(
            f"the folder {output.parent} does not exist; make it first or choose another with --output"
        )
    notebook = jupytext.read(chapter)
    client = NotebookClient(
        notebook,
        timeout=300,
        kernel_name="python3",
        resources={"metadata": {"path": str(chapter.resolve().parents[1])}},
    )
    try:
        client.execute()
    except CellExecutionError as error:
        raise CosseratError(f"{chapter}: a cell failed: {error}") from None
    temporary = output.with_name(f".{output.name}.part")
    nbformat.write(notebook, temporary)
    temporary.replace(output)


def render(notebooks: list[Path], output: Path) -> Path:
    """Build the book from executed notebooks, `index.ipynb` among them; returns its first page.

    The folder is replaced only by a whole book.

    Raises
    ------
    InputError : a notebook is missing.
    CosseratError : Sphinx warned or failed; the old book stays.
    """
    missing = [str(path) for path in notebooks if not path.is_file()]
    if missing:
        raise InputError(
            f"there is no notebook {', '.join(missing)}; execute the chapters first ('cosserat chapter')"
        )
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".book.") as scratch:
        pages, built = Path(scratch) / "pages", Path(scratch) / "built"
        (pages / "_static").mkdir(parents=True)
        for path in notebooks:
            shutil.copy(path, pages / path.name)
        (pages / "conf.py").write_text(_CONF, encoding="utf-8")
        style = resources.files("cosserat.book") / "book.css"
        (pages / "_static" / "book.css").write_text(style.read_text(encoding="utf-8"), encoding="utf-8")
        _copy_mathjax(pages / "_static" / "mathjax")
        _sphinx(pages, built, Path(scratch) / "doctrees")
        shutil.rmtree(output, ignore_errors=True)
        os.replace(built, output)
    return output / "index.html"


def _copy_mathjax(folder: Path) -> None:
    """MathJax with its fonts, from the locked package that carries it, so that no page asks the network."""
    spec = importlib.util.find_spec("mathjax")
    if spec is None or not spec.submodule_search_locations:
        raise InputError(
            "the package django-static-mathjax is not installed; run 'make' or install cosserat[book]"
        )
    shipped = Path(spec.submodule_search_locations[0]) / "static" / "mathjax" / "es5"
    fonts = Path("output") / "chtml" / "fonts" / "woff-v2"
    shutil.copytree(shipped / fonts, folder / fonts)
    shutil.copy(shipped / "tex-chtml-full.js", folder)


def _sphinx(pages: Path, built: Path, doctrees: Path) -> None:
    from sphinx.cmd.build import build_main

    said = io.StringIO()
    arguments = ["-q", "-W", "--keep-going", "-b", "html", "-d", str(doctrees), str(pages), str(built)]
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        failed = build_main(arguments)
    if failed:
        raise CosseratError(f"the book could not be built:\n{said.getvalue()}")
    for page in built.glob("*.html"):
        if "\\begin{split}" in page.read_text(
            encoding="utf-8"
        ):  # Sphinx wraps lines so; MathJax then refuses a tag
            raise CosseratError(
                f"{page.name}: write an equation of several lines as \\begin{{equation*}}, not in $$"
            )
    (built / ".buildinfo").unlink(missing_ok=True)
