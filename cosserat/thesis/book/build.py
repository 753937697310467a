"""A book from executed notebooks that needs no network."""

from __future__ import annotations

import contextlib
import importlib.util
import io
import itertools
import json
import shutil
import tempfile
from importlib import resources
from pathlib import Path

from cosserat.errors import CosseratError, InputError
from cosserat.figures import player
from cosserat.thesis.book.downloads import add_downloads
from cosserat.thesis.book.finish import finish

_FILE_LIST = ".cosserat-book"
"""File that lists the files of a book."""


def render(notebooks: list[Path], output: Path, *, partial: bool = False) -> Path:
    """Build the book from executed notebooks, `index.ipynb` among them; returns its first page.

    Only a whole book replaces the folder, and only if the folder holds nothing but a book from this function.

    partial : these are some pages of a book, so a number whose target is on another page stays plain text.

    Raises
    ------
    InputError : a notebook is missing, or the folder holds something else.
    CosseratError : Sphinx warned or failed; the old book stays.
    """
    missing = [str(path) for path in notebooks if not path.is_file()]
    if missing:
        raise InputError(
            f"there is no notebook {', '.join(missing)}; execute the chapters first ('cosserat chapter')"
        )
    for path in notebooks:
        try:
            json.loads(path.read_text(encoding="utf-8"))["cells"]
        except (OSError, ValueError, LookupError, TypeError):
            raise InputError(f"{path} is no notebook; execute its chapter again") from None
    _check_destination(output)
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".book.") as scratch:
        pages, built = Path(scratch) / "pages", Path(scratch) / "built"
        _gather(notebooks, pages)
        _sphinx(pages, built, Path(scratch) / "doctrees", partial)
        finish(built)
        add_downloads(notebooks, built)
        (built / _FILE_LIST).write_text("\n".join([_FILE_LIST, *_files(built)]), encoding="utf-8")
        _check_destination(output, set(_files(built)))
        if output.exists():
            output.rename(Path(scratch) / "old")
        built.rename(output)
    return output / "index.html"


def _gather(notebooks: list[Path], pages: Path) -> None:
    """Put into a folder what Sphinx reads: the notebooks, its configuration, styles and scripts, and MathJax."""
    with resources.as_file(resources.files("cosserat.thesis.book")) as here:
        shutil.copytree(here / "static", pages / "_static", ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(here / "conf.py", pages)
    for path in notebooks:
        _with_solutions(path, pages / path.name)
    (pages / "_static" / "player.css").write_text(player.style(), encoding="utf-8")
    (pages / "_static" / "player.js").write_text(player.script(), encoding="utf-8")
    _copy_mathjax(pages / "_static" / "mathjax")


def _with_solutions(notebook: Path, copy: Path) -> None:
    """A copy of a notebook in which the folded cell after an exercise says that it is the solution."""
    page = json.loads(notebook.read_text(encoding="utf-8"))
    for before, cell in itertools.pairwise(page["cells"]):
        if ":class: exercise" in "".join(before["source"]) and cell["cell_type"] == "code":
            cell["metadata"]["mystnb"] = {
                "code_prompt_show": "Show the solution",
                "code_prompt_hide": "Hide the solution",
            }
    copy.write_text(json.dumps(page), encoding="utf-8")


def _check_destination(output: Path, of_a_book: set[str] | None = None) -> None:
    """Raise InputError unless a folder is missing, empty, or holds only files of a book.

    of_a_book : files of the new book; a book without its own list may have no others.
    """
    remedy = "choose another with --output"
    if output.is_symlink() or (output.exists() and not output.is_dir()):
        raise InputError(f"{output} is not a folder; {remedy}")
    if Path.cwd().is_relative_to(output.resolve()):
        raise InputError(f"{output} holds the folder you work in; {remedy}")
    if not output.is_dir():
        return
    found, file_list = _files(output), output / _FILE_LIST
    if file_list.is_file():
        ours = set(file_list.read_text(encoding="utf-8").splitlines())
    elif (output / "_static" / "book.css").is_file():  # a book from before there was a list
        ours = of_a_book or {file for file in found if _looks_built(Path(file))}
    else:
        ours = set()
    others = [file for file in found if file not in ours]
    if others:
        raise InputError(
            f"{output} holds {others[0]}, which does not belong to a book of cosserat; move it away or {remedy}"
        )


def _files(folder: Path) -> list[str]:
    """Everything below a folder except plain folders that are not empty, as paths from there."""
    return sorted(
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_symlink() or not path.is_dir() or not any(path.iterdir())
    )


def _looks_built(file: Path) -> bool:
    if file.parts[0] in ("_static", "_sources", "_images", "_downloads", "source"):
        return True
    return len(file.parts) == 1 and (
        file.suffix == ".html" or file.name in ("objects.inv", "searchindex.js")
    )


def _copy_mathjax(folder: Path) -> None:
    """MathJax with its fonts, from the locked package that contains it, so no page needs the network."""
    spec = importlib.util.find_spec("mathjax")
    if spec is None or not spec.submodule_search_locations:
        raise InputError(
            "the package django-static-mathjax is not installed; run 'make' or install cosserat[book]"
        )
    shipped = Path(spec.submodule_search_locations[0]) / "static" / "mathjax" / "es5"
    fonts = Path("output") / "chtml" / "fonts" / "woff-v2"
    shutil.copytree(shipped / fonts, folder / fonts)
    shutil.copy(shipped / "tex-chtml-full.js", folder)


def _sphinx(pages: Path, built: Path, doctrees: Path, partial: bool) -> None:
    from sphinx.cmd.build import build_main

    said = io.StringIO()
    settings = ["-D", f"links_are_complete={int(not partial)}"]
    arguments = [
        *settings,
        "-q",
        "-W",
        "--keep-going",
        "-b",
        "html",
        "-d",
        str(doctrees),
        str(pages),
        str(built),
    ]
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
