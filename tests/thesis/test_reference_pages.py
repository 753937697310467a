"""Pages made from the code and from one table: the command line, references, how to cite, downloads."""

import argparse
import html
import re

import nbformat
import pytest
from conftest import ROOT

from cosserat.thesis.book import command_line, downloads, page
from cosserat.thesis.book.references import bibtex, literature

CHAPTERS = sorted((ROOT / "chapters").glob("*.py"))
KNOWN = frozenset(
    re.findall(
        r"\w+",
        """
Newton Gauss Runge Kutta Rayleigh Lobatto Cholesky Hermite Sylvester Hessian Jacobian Latin Monte Carlo
Poisson Young Euler Bernoulli Cauchy Hooke Lamé Piola
Voronoi Kronecker Cosserat Voigt Kelvin Dirac Greenhill Steiner
University California Berkeley Evan Grant Debian Python Numba Dataset Snakemake Slurm Exudyn Ctrl Jupyter Chromium
Lustre Chapter Chapters Table Fig Figs Exercise Misprint Strains Discrete Curves Descriptions Peristalsis Pa
""",
    )
)
"""Capital words inside sentences that name no author of a work: eponyms in everyday use, places, and words."""


def plain(text):
    return html.unescape(re.sub(r"<[^>]+>", "", text))


def sentences(text):
    """The prose of a chapter, without code, mathematics and links."""
    cells = re.findall(r"^# %% \[markdown\]\n((?:#.*\n)+)", text, flags=re.MULTILINE)
    prose = "\n\n".join(re.sub(r"^# ?", "", cell, flags=re.MULTILINE) for cell in cells)
    prose = re.sub(r"```.*?```|\$\$.*?\$\$|\\begin.*?\\end\{\w+\*?\}", " X. ", prose, flags=re.DOTALL)
    prose = re.sub(r"\$[^$]*\$|`[^`]*`|\*\w[^*\n]*\*", "X", prose)
    prose = re.sub(r"^:.*$", ". ", prose, flags=re.MULTILINE)
    return re.sub(r"\n\n+|\n(?=[#*:-])", ". ", prose)


def names_in(text):
    """Capital words that follow a small one, so that they begin no sentence."""
    return set(
        re.findall(r"(?<=[a-z,;] )([A-Z][a-zé']*[a-zé])(?='s|\b)", " ".join(sentences(text).split()))
    )


def names_of_works():
    return {
        word.removesuffix("'s")
        for work in literature().values()
        for text in (*work.names, *(author.partition(",")[0] for author in work.authors))
        for word in re.findall(r"[A-Z][\w']+", text)
    }


@pytest.mark.parametrize("chapter", CHAPTERS, ids=lambda path: path.stem)
def test_every_author_named_in_a_chapter_has_an_entry(chapter):
    allowed = names_of_works() | KNOWN
    found = {word.removesuffix("'s") for word in names_in(chapter.read_text())}
    assert {word for word in found if not word.isupper()} - allowed == set()


def test_an_author_without_an_entry_is_noticed():
    text = "# %% [markdown]\n# The test of Nobody is that of Deuflhard's book, and $Some$ `Thing` of Newton. Then we\n"
    found = {word.removesuffix("'s") for word in names_in(text)}
    assert found - names_of_works() == {"Nobody", "Newton"}


def test_authors_of_docstrings_and_errata_have_entries():
    """Those of places that a docstring or a table cites with a year."""
    texts = [path.read_text() for path in (ROOT / "cosserat").rglob("*.py") if "book" not in path.parts]
    texts += [(ROOT / "results" / name).read_text() for name in ("errata.toml", "tolerances.csv")]
    cited = {
        name
        for text in texts
        for name in re.findall(r"\b([A-Z][a-z]{3,})(?: et al\.?)?,? \(?(?:19|20)\d\d\b", text)
    }
    assert len(cited) > 3
    assert cited - names_of_works() - {"Berkeley"} == set()


def test_works_have_addresses_and_names_of_their_own():
    works = literature().values()
    names = [name for work in works for name in work.names]
    assert len(names) == len(set(names))
    for work in works:
        assert work.doi in ("", "none") or re.fullmatch(r"10\.\d{4,5}/\S+", work.doi)
        assert not (work.doi and work.url)
    shown = page.references().data
    assert re.findall(r'<li id="ref-([^"]+)"', shown) == list(literature())
    assert 'data-names="Perry and Robertson|Robertson"' in shown


def test_works_are_written_as_bibtex():
    known = literature()
    assert bibtex("cowper1966", known["cowper1966"]).splitlines() == [
        "@article{cowper1966,",
        "  author = {Cowper, G. R.},",
        "  title = {{The shear coefficient in Timoshenko's beam theory}},",
        "  year = {1966},",
        "  journal = {Journal of Applied Mechanics},",
        "  volume = {33},",
        "  pages = {335--340},",
        "  doi = {10.1115/1.3625046}",
        "}",
    ]
    assert bibtex("hemingway2020", known["hemingway2020"]).startswith("@phdthesis{")


def test_how_to_cite_is_that_of_the_citation_file():
    shown = plain(page.how_to_cite().data)
    for line in (ROOT / "CITATION.cff").read_text().splitlines():
        if line.startswith(("title", "version", "license")):
            assert line.split(": ", 1)[1].strip('"') in shown
    assert "author = {Hemingway, Evan Grant}" in shown


def test_the_page_of_commands_has_every_command_and_option_with_its_help():
    shown = page.commands().data
    text = " ".join(plain(shown).split())
    found = command_line.parsers()
    assert re.findall(r'<section id="cosserat-([^"]+)"', shown) == list(found)
    for parser in found.values():
        assert " ".join(parser.description.split()) in text
        for action in parser._actions:
            if not isinstance(action, argparse._HelpAction):
                assert all(option in text for option in action.option_strings)
                assert "%(" not in command_line._told(parser, action)
                assert " ".join(plain(command_line._told(parser, action)).split()) in text
    assert "required" in shown
    addresses = re.findall(r'id="([^"]+)"', shown)
    assert len(addresses) == len(set(addresses))


def test_a_page_can_be_had_as_a_notebook_without_outputs_and_as_a_script(tmp_path):
    output = nbformat.v4.new_output("stream", text="2\n")
    cells = [
        nbformat.v4.new_markdown_cell("# Sum"),
        nbformat.v4.new_code_cell("print(1 + 1)", outputs=[output]),
    ]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), tmp_path / "sum.ipynb")
    built = tmp_path / "built"
    built.mkdir()
    (built / "sum.html").write_text("<h1>no</h1><article><h1>Sum</h1><h1>Other</h1></article>")
    downloads.add_downloads([tmp_path / "sum.ipynb"], built)
    shown = (built / "sum.html").read_text()
    assert shown.startswith('<h1>no</h1><article><h1>Sum</h1>\n<p class="downloads">')
    for address in re.findall(r'href="([^"]+)"', shown):
        assert (built / address).is_file()
    notebook = nbformat.read(built / "_downloads" / "sum.ipynb", as_version=4)
    assert [cell.get("outputs", []) for cell in notebook.cells] == [[], []]
    assert "# %%\nprint(1 + 1)" in (built / "_downloads" / "sum.py").read_text()


def test_keys_have_an_example_and_the_cases_that_use_them():
    shown = plain(page.keys("rod statics").data)
    assert re.search(r'As in \w+(?: and \d+ more)?: g = "9.81 m/s\^2"', shown)
    assert re.search(r'As in \w+ and \d+ more: at = "\w+"', shown)
