"""The audit in a browser, tried on small pages; `python -m tests.browser results/book` looks at the book."""

import re

import nbformat
import pytest
from pypdf import PdfReader

from cosserat.errors import CosseratError
from cosserat.thesis.book import browser, page
from cosserat.thesis.book.build import render
from cosserat.thesis.book.paper import print_book

from .__main__ import size
from .audit import audit
from .faults import missed, write
from .paper import complaints

needs_a_browser = pytest.mark.skipif(browser.find_browser() is None, reason="there is no Chromium here")
SUM = " + ".join(rf"\frac{{k_{{{i}}}^2}}{{2}} \gamma_{{{i}}}^2" for i in range(9))
TEXT = f"""# A rod

:::{{admonition}} After this chapter you can
:class: objectives
- read a line of the report
:::

## Its energy

It is $w = \\mu_1 \\mu_2 \\mu_3 = 1 - {SUM}$, with a long and `quite.unbreakable.name.of.a.function.in.the.library`, and

$$ 2 w = {SUM} \\tag{{1.2.3}} $$

| what | unit |
|---|---|
| length | m |

:::{{admonition}} Exercise 1.1: nothing
:class: exercise
Do nothing.
:::
"""


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """A book of one page that has what pages have, and an equation that is too long for a phone."""
    folder = tmp_path_factory.mktemp("small")
    details = (
        "<details class='verdict'><summary>1 row</summary>"
        + page.table([["a", "b " * 90]] * 2, ["one", "two"]).data
    )
    note = (
        "<aside class='misprints'><details><summary>Misprint E1</summary><p>It is.</p></details></aside>"
    )
    outputs = [
        nbformat.v4.new_output("display_data", {"text/html": html})
        for html in (f"{details}</details>", note)
    ]
    outputs.append(nbformat.v4.new_output("stream", name="stdout", text="a long message " * 30))
    code = (
        "def energy(rod: Rod) -> float:  # a line that has as many columns as the code of the library has, "
        + "x" * 18
    )
    cells = [
        nbformat.v4.new_markdown_cell(TEXT),
        nbformat.v4.new_code_cell(code, outputs=outputs),
        nbformat.v4.new_code_cell("1 + 1", metadata={"tags": ["hide-cell"]}),
    ]
    made = nbformat.v4.new_notebook(cells=cells)
    made.metadata["language_info"] = {"name": "python", "pygments_lexer": "python3"}
    nbformat.write(made, folder / "index.ipynb")
    return render([folder / "index.ipynb"], folder / "book", partial=True).parent


@needs_a_browser
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::PendingDeprecationWarning")
def test_a_page_of_the_book_has_no_fault_at_any_width_in_any_theme_or_on_paper(small):
    found = audit(small, ["index.html"], processes=1)
    assert found.faults == []
    assert found.views == 8
    assert (
        min(found.counts[check] for check in ("equations", "columns", "contrast", "controls", "anchors"))
        > 5
    )


@pytest.mark.workflow
@needs_a_browser
def test_every_planted_fault_is_found_and_nothing_else(tmp_path):
    write(tmp_path)
    found = audit(tmp_path, processes=1)
    assert missed(found.faults) == []
    assert found.views == 8 * found.pages
    assert min(found.counts.values()) > 0


@needs_a_browser
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::PendingDeprecationWarning")
def test_the_printed_book_has_its_pages_numbered_its_outline_and_what_was_folded(small, tmp_path):
    count = print_book(small, tmp_path / "small.pdf")
    pdf = PdfReader(tmp_path / "small.pdf")
    assert len(pdf.pages) == count >= 3
    assert complaints(pdf, ["A rod"]) == []
    assert complaints(pdf, ["A worm"]) == ["the outline has no 'A worm'"]
    text = "\n".join(page.extract_text() for page in pdf.pages)
    assert "It is." in text  # a misprint, which is folded on the screen
    assert "1 row" in text
    assert "b b b" not in text  # rows of the report stay folded
    contents = pdf.pages[1].extract_text()
    assert re.search(r"Its energy\s*3", contents)


def test_a_book_of_more_than_its_size_is_a_fault(tmp_path):
    with (tmp_path / "large.html").open("wb") as file:
        file.truncate(16_000_001)
    assert [one.check for one in size(tmp_path)] == ["size"]
    (tmp_path / "large.html").write_text("small")
    assert size(tmp_path) == []


def test_a_machine_without_a_browser_says_what_to_do(monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(CosseratError, match="apt-get install chromium"), browser.browser():
        pass
