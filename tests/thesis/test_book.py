"""The book: pages with readable equations, and a folder in which only files of a book are replaced."""

import html
import importlib.metadata
import re
import shutil
from pathlib import Path

import jupytext
import nbformat
import numpy as np
import pytest
from conftest import ROOT

import cosserat
from cosserat.describe.keys import common_keys, keys
from cosserat.errors import CosseratError, InputError
from cosserat.figures.stage import Mark, Panel, Slider, Stage
from cosserat.publications import kinds
from cosserat.thesis.book import page
from cosserat.thesis.book.api import as_markup
from cosserat.thesis.book.build import render
from cosserat.thesis.book.edition import edition
from cosserat.thesis.book.execution import execute
from cosserat.thesis.book.finish import short, with_breaks

pytestmark = pytest.mark.filterwarnings(
    "ignore::DeprecationWarning", "ignore::PendingDeprecationWarning"
)


def shown(html):
    """A cell that has displayed HTML."""
    output = nbformat.v4.new_output("display_data", {"text/html": html})
    return nbformat.v4.new_code_cell("0", outputs=[output])


@pytest.fixture(scope="module")
def notebooks(tmp_path_factory):
    """Two pages, the first with a numbered equation."""
    folder = tmp_path_factory.mktemp("notebooks")
    time = np.linspace(0, 1, 5)
    panel = Panel((Mark(time, time**2),), "time [s]", "height [m]")
    moving = Stage("A point", "A point rises.", (panel,), Slider("time", time, "s"))
    with pytest.MonkeyPatch.context() as patch:
        (folder / "figures").mkdir()
        (folder / "figures" / "fig_2_1.svg").write_text("<svg/>")
        patch.setattr(page, "results", lambda: folder)
        drawn = page.figure("fig_2_1", "Ahead of $\\gamma$.").data
        drawn += page.player(moving, "From $t_p/2$ on.", name="play_point").data
    table = page.table([["$a < b$", "5"]], ["of $\\mu_3$", "times"]).data
    toctree = "```{toctree}\nother\n```"
    for name, text in (
        ("index", f"# Index\n\n$$ a = b \\tag{{1.2.3}} $$\n\n{toctree}"),
        ("other", "# Other"),
    ):
        cells = [nbformat.v4.new_markdown_cell(text), shown(table), shown(drawn)]
        if name == "other":
            exercise = ":::{admonition} Exercise 1.1: nothing\n:class: exercise\nDo nothing.\n:::"
            folded = {"tags": ["hide-cell"]}
            cells += [
                nbformat.v4.new_code_cell("0", metadata=folded),
                nbformat.v4.new_markdown_cell(exercise),
                nbformat.v4.new_code_cell("0", metadata=folded),
            ]
        book = nbformat.v4.new_notebook(cells=cells)
        book.metadata["language_info"] = {"name": "python", "pygments_lexer": "python3"}
        nbformat.write(book, folder / f"{name}.ipynb")
    return [folder / "index.ipynb", folder / "other.ipynb"]


@pytest.fixture(scope="module")
def built(notebooks, tmp_path_factory):
    book = tmp_path_factory.mktemp("book") / "book"
    assert render(notebooks, book) == book / "index.html"
    return book


@pytest.fixture
def book(built, tmp_path):
    return shutil.copytree(built, tmp_path / "book")


def contents(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else b""
        for path in folder.rglob("*")
    }


def rules(book):
    """Declarations of the stylesheet by selector, those for screens."""
    text = re.sub(r"/\*.*?\*/", "", (book / "_static" / "book.css").read_text(), flags=re.DOTALL).split(
        "@media print"
    )[0]
    return {
        selector.strip(): block
        for selectors, block in re.findall(r"([^{}]+)\{([^}]*)\}", text)
        for selector in selectors.split(",")
    }


def test_mathematics_of_captions_and_tables_is_typeset(built):
    text = (built / "index.html").read_text()
    found = re.findall(r'<span class="math notranslate nohighlight">\\\((.*?)\\\)</span>', text)
    assert found == [r"\mu_3", "a &lt; b", r"\gamma", "t_p/2"]
    assert "$" not in text.split("<article")[1].split("</article>")[0]
    assert re.search(r'"processHtmlClass": "[^"]*\bmath\b', text)  # what MathJax sets


def test_wide_equations_scroll_from_their_left_end_and_are_no_larger_than_the_text(built):
    page = (built / "index.html").read_text()
    assert "_static/book.css" in page
    assert 'class="math notranslate nohighlight"' in page
    assert re.search(r'"chtml": \{"matchFontHeight": false\}', page)
    style = rules(built)["div.math"]
    assert "display: block" in style
    assert "overflow-x: auto" in style
    assert "overflow-x: hidden" not in style


def test_pictures_and_animations_keep_within_the_column(built):
    for selector in ("figure.plot img", "figure.plot svg"):
        assert "max-width: 100%" in rules(built)[selector]
        assert "background: #fff" in rules(built)[selector]
    assert "overflow-wrap: anywhere" in rules(built)["code .pre"]


def test_dark_captions_have_the_background_of_the_page(built):
    """The theme puts outputs on a pale card; its selector counts five classes and three elements."""
    (selector,) = (key for key in rules(built) if key.endswith(".output.text_html"))
    assert 'html[data-theme="dark"]' in selector
    assert len(re.findall(r"[.\[]", selector)) > 5
    assert "background: none; color: inherit" in rules(built)[selector]


def test_a_page_names_its_edition_and_loads_no_more_than_it_needs(built):
    text = (built / "index.html").read_text()
    assert f"<p>{edition().text}</p>" in text
    assert edition().text.startswith(f"version {importlib.metadata.version('cosserat')}")
    assert 'data-default-mode="auto"' in text
    assert "fontawesome.js" not in text
    asked = re.findall(r'(?:src|href)="(_static/[^"?]+)', text)
    assert len(asked) > 10
    assert [file for file in asked if not (built / file).is_file()] == []
    assert "_static/player.js" in asked
    assert not {"_static/pull.js", "_static/pull.css", "_static/filter.js"} & set(asked)
    kept = contents(built)
    assert not [
        name for name in kept if name.endswith(".map") or "/locales/" in name or name == "genindex.html"
    ]
    assert sum(map(len, kept.values())) < 5e6


def test_a_folded_cell_says_whether_it_is_the_solution_of_an_exercise(built):
    text = (built / "other.html").read_text()
    assert text.count("Show the code and its result") == text.count("Show the solution") == 1
    assert text.index("Show the code") < text.index("Exercise 1.1") < text.index("Show the solution")


def test_lines_break_inside_names_and_not_beside_mathematics():
    x = '<span class="math notranslate nohighlight">\\(x\\)</span>'
    assert (
        with_breaks(f"at {x}, of {x} (<i>{x}</i>)")
        == f'at <span class="kept">{x},</span> of {x} (<i>{x}</i>)'
    )
    name = '<code><a href="a/b_c.html">a/b_c.d.py</a></code> a/b'
    assert with_breaks(name) == '<code><a href="a/b_c.html">a/<wbr>b_<wbr>c.<wbr>d.py</a></code> a/b'


def test_pictures_are_short_files_with_the_same_lines():
    drawn = (
        '<svg>\n <metadata>of today</metadata>\n <path id="a" d="M 1.23456789 -0.001 \nL 12 3.999999 " '
        'transform="scale(0.015625)"/>\n <use x="7.0199999" href="#m"/>\n <text>1.23456</text>\n</svg>'
    )
    assert short(drawn) == (
        '<svg><path id="a" d="M 1.23 -0 L 12 4" transform="scale(0.015625)"/>'
        '<use x="7.02" href="#m"/><text>1.23456</text></svg>'
    )


def test_a_book_replaces_a_book_and_an_empty_folder(notebooks, book, tmp_path):
    (book / "other.html").write_text("old")
    (book / "index.html").unlink()  # a rule's output, which Snakemake takes away first
    assert render(notebooks, book).is_file()
    assert "Other" in (book / "other.html").read_text()
    (tmp_path / "empty").mkdir()
    assert render(notebooks, tmp_path / "empty").is_file()
    (book / ".cosserat-book").unlink()  # as books were before
    assert render(notebooks, book).is_file()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["book", "empty"]


@pytest.mark.parametrize("listed", [True, False])
@pytest.mark.parametrize(
    "name", ["thesis.tex", "mine.html", "_static/mine.css", "sub/mine.txt", "empty/"]
)
def test_a_users_file_in_a_book_is_kept_and_named(notebooks, book, name, listed):
    if not listed:
        (book / ".cosserat-book").unlink()  # as books were before
    path = book / name
    path.parent.mkdir(exist_ok=True)
    path.mkdir() if name.endswith("/") else path.write_text("mine")
    before = contents(book)
    with pytest.raises(InputError, match=rf"holds {name.rstrip('/')}, which does not belong to a book"):
        render(notebooks, book)
    assert contents(book) == before


def test_folders_of_the_user_are_kept(notebooks, tmp_path, monkeypatch):
    mine = tmp_path / "mine"
    (mine / "work" / "here").mkdir(parents=True)
    (mine / "thesis.tex").write_text("mine")
    (mine / "index.html").write_text("mine")
    (tmp_path / "link").symlink_to(mine)
    (tmp_path / "nowhere").symlink_to(tmp_path / "none")
    monkeypatch.chdir(mine / "work")
    before = contents(tmp_path)
    for output, sentence in [
        (mine, "holds the folder you work in"),
        (mine / "work", "holds the folder you work in"),
        (mine / "work" / "here" / "..", "holds the folder you work in"),
        (tmp_path, "holds the folder you work in"),
        (tmp_path / "link", "link is not a folder"),
        (tmp_path / "nowhere", "nowhere is not a folder"),
        (mine / "thesis.tex", "thesis.tex is not a folder"),
    ]:
        with pytest.raises(InputError, match=sentence):
            render(notebooks, output)
    for relative in (".", "..", "../..", "here/.."):
        with pytest.raises(InputError, match="holds the folder you work in"):
            render(notebooks, Path(relative))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="holds index.html, which does not belong to a book"):
        render(notebooks, mine)
    assert contents(tmp_path) == before


def test_each_page_of_a_built_book_can_be_had_as_notebook_and_script(built):
    for name in ("index", "other"):
        page = (built / f"{name}.html").read_text()
        assert f'<a href="_downloads/{name}.ipynb" download>' in page
        assert (built / "_downloads" / f"{name}.py").is_file()
    assert "_downloads/other.py" in (built / ".cosserat-book").read_text()


def test_a_failed_build_keeps_the_old_book(notebooks, book, tmp_path):
    bad = tmp_path / "index.ipynb"
    cell = nbformat.v4.new_markdown_cell("# Index\n\n[nowhere](none.md)")
    nbformat.write(nbformat.v4.new_notebook(cells=[cell]), bad)
    before = contents(book)
    with pytest.raises(CosseratError, match="could not be built"):
        render([bad, notebooks[1]], book)
    assert contents(book) == before


def test_the_page_of_keys_has_every_kind_under_its_own_heading():
    text = (ROOT / "chapters" / "case_keys.py").read_text()
    parts = re.findall(r"^# ## (.*?)\n.*?^page\.(.*?)$", text, flags=re.MULTILINE | re.DOTALL)
    assert parts == [("every case", "common_keys()"), *((kind, f'keys("{kind}")') for kind in kinds())]


def test_the_page_of_keys_has_an_anchor_and_the_whole_text_of_every_key():
    shown = page.common_keys().data + "".join(page.keys(kind).data for kind in kinds())
    addresses = re.findall(r'id="([^"]+)"', shown)
    assert len(addresses) == len(set(addresses))
    assert len(addresses) == len(common_keys()) + sum(len(keys(kind)) for kind in kinds())
    headings = {kind.replace(" ", "-") for kind in kinds()}
    assert set(re.findall(r'href="#([^"]+)"', shown)) <= {*addresses, *headings}
    assert {"rod-motion.rod.length", "crawl.crawler.material.young.compressible"} <= set(addresses)
    text = html.unescape(re.sub(r"<[^>]+>", "", shown))
    for kind in kinds():
        for key in keys(kind):
            assert key.path in text
            assert " ".join(key.meaning.replace("`", "").split()) in text
    assert r"\(\ell_0\), eq. (3.3.1)" in text
    assert 'a table, a whole problem of kind <a href="#rod-statics">rod statics</a>; required' in shown


@pytest.fixture(scope="module")
def reference_page(tmp_path_factory):
    """The page of the Python API as it is built, as text."""
    folder = tmp_path_factory.mktemp("api")
    notebook = jupytext.read(ROOT / "chapters" / "python_api.py")
    notebook.metadata["language_info"] = {"name": "python", "pygments_lexer": "python3"}
    index = "# Index\n\n```{toctree}\npython_api\ncase_keys\n```"
    for name, cells in (
        ("python_api", notebook.cells),
        ("index", [nbformat.v4.new_markdown_cell(index)]),
        ("case_keys", [nbformat.v4.new_markdown_cell("# Keys")]),
    ):
        nbformat.write(
            nbformat.v4.new_notebook(cells=cells, metadata=notebook.metadata), folder / f"{name}.ipynb"
        )
    render(sorted(folder.glob("*.ipynb")), folder / "book", partial=True)
    article = (
        (folder / "book" / "python_api.html").read_text().split("<article")[1].split("</article>")[0]
    )
    return " ".join(html.unescape(re.sub(r"<[^>]+>", "", article)).split())


def test_the_page_of_the_api_has_every_public_name_with_its_docstring(reference_page):
    for name in cosserat.__all__:
        assert f"cosserat.{name}" in reference_page
        first = getattr(cosserat, name).__doc__.strip().split("\n\n")[0]
        assert " ".join(first.replace("`", "").split()).replace("'", "’")[:60] in reference_page.replace(
            "'", "’"
        )


def test_the_page_of_the_api_shows_signatures_as_they_are_written(reference_page):
    assert "cosserat.run( case: Case | str, *, result: str | Path | None = None," in reference_page
    assert "class cosserat.rods.rod.Rod( *, energy=..., vertices, length, section," in reference_page
    assert "displacements: bool = True, ) → MechanicalSystem" in reference_page
    assert "solve( name: str, run: Run = ALONE, ) → Solution" in reference_page
    assert not re.search(
        r"0x[0-9a-f]{6}|ForwardRef|ndarray\[|<function|model_config|Report nothing|factory|~",
        reference_page,
    )


def test_docstrings_are_plain_text_with_terms_and_sections():
    docstring = """The norm ||E|| of x_ * y.

    length, width : of the rod,
        both [m].  unit : of either.

    Raises
    ------
    InputError : it is `wrong`.
    """
    lines = [line.removeprefix("    ") for line in docstring.split("\n")]
    assert as_markup(lines) == [
        r"The norm \|\|E\|\| of x\_ \* y.",
        "",
        "* ``length, width``: of the rod, both [m].",
        "* ``unit``: of either.",
        "",
        "Raises:",
        "",
        "* ``InputError``: it is `wrong`.",
        "",
    ]


def chapters(tmp_path, **cells):
    """Chapters by name, each of one cell, and where their notebooks go."""
    folder = tmp_path / "chapters"
    folder.mkdir()
    for name, cell in cells.items():
        (folder / f"{name}.py").write_text(f"# %% [markdown]\n# # Sum\n\n# %%\n{cell}\n")
    return [folder / f"{name}.py" for name in cells], [tmp_path / f"{name}.ipynb" for name in cells]


def test_chapters_of_one_kernel_give_the_same_bytes_and_know_nothing_of_each_other(tmp_path):
    mine = "import os\nknown = 'known' in globals(), os.getcwd()\nos.chdir('/')\nknown"
    files, notebooks = chapters(tmp_path, one=mine, other=mine)
    assert list(execute(files, notebooks)) == notebooks
    text = notebooks[0].read_text()
    assert "(False," in text
    assert '"text/plain"' in text
    assert text == notebooks[1].read_text()


def test_a_chapter_that_fails_keeps_those_before_it_alone(tmp_path):
    files, notebooks = chapters(tmp_path, one="1 + 1", other="1 / 0", third="2")
    with pytest.raises(CosseratError, match="other.py: a cell failed: "):
        list(execute(files, notebooks))
    assert [path.is_file() for path in notebooks] == [True, False, False]


def test_a_number_in_powers_of_ten_is_mathematics():
    assert page.tens(2.45e-5) == r"$2 \cdot 10^{-5}$"
    assert page.tens(-1234.5, 3) == r"$-1.23 \cdot 10^{3}$"
    assert page.tens(9.96, 2) == r"$1.0 \cdot 10^{1}$"


def test_stored_variables_are_shown_with_dimensions_unit_and_meaning():
    shown = page.variables("fibre_stress").data
    for told in ("fibre_stress", "edge, surface", "Pa", "axial stress"):
        assert told in shown
    with pytest.raises(InputError, match="no result has a variable colour"):
        page.variables("fibre_stress", "colour")
