"""Extension of Sphinx: every number, row, erratum, chapter, name and path in the text of the book leads to its target.

It works on the built pages, so that text, tables, captions, notes, comments of shown code and docstrings are alike.  A
target is an anchor on a page: "eq-3.4.11", which each displayed equation gets from its tag; "fig_3_8"; "table-2.1";
"row-2.8-stride"; "E2.5"; "ref-..." with the names of its authors in `data-names`.  The first in reading order counts.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape, unescape
from pathlib import Path
from typing import TYPE_CHECKING

from cosserat.thesis.book import module_pages
from cosserat.thesis.book.link_text import Linker, Target

if TYPE_CHECKING:
    from sphinx.application import Sphinx

_DISPLAYED = re.compile(
    r'<div class="(?P<classes>(?:amsmath )?math notranslate nohighlight)"(?P<anchor> id="eq-[\d.]+")?>\s*'
    r"(?P<source>\\\[(?:(?!</div>).)*?\\tag\{(?P<number>[\d.]+)\}(?:(?!</div>).)*)</div>",
    re.DOTALL,
)
_ANCHORS = (
    (re.compile(r"eq-(\d\.\d\.\d+)"), "eq"),
    (re.compile(r"fig[_-](\d)[._](\d+)"), "fig"),
    (re.compile(r"table-(\d)\.(\d+)"), "table"),
    (re.compile(r"row-(.+)"), "row"),
    (re.compile(r"(E\d\.\d+)"), "erratum"),
    (re.compile(r"((?:cosserat)(?:\.\w+)+)"), "name"),
)
"""Anchors, and the kind of what stands there; the groups joined by points are its name."""

_LISTED = re.compile(
    r'(?P<before><code[^>]*><span class="pre">)(?P<name>\w+(?:\.\w+)*)'
    r'(?P<between></span></code> in <code[^>]*><span class="pre"><a [^>]*>(?P<path>cosserat/[\w/]+\.py)</a>)'
)
"""The line over shown code: a name and its file, which is a link by then."""

_FILES = {
    "results/errata.toml": "errata",
    "results/left_out.toml": "left_out",
    "results/report.csv": "results_table",
    "results/tolerances.csv": "results_table",
}
"""Files outside the package that a page shows."""


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect the functions of this module; Sphinx calls this."""
    app.set_html_assets_policy("always")  # outputs have mathematics too, and links show equations
    app.add_config_value("links_are_complete", True, "html")
    app.connect("html-collect-pages", _module_pages)
    app.connect("build-finished", _link_pages)
    return {"parallel_read_safe": True}


def _module_pages(app: Sphinx) -> Iterator[tuple[str, dict[str, str], str]]:
    texts = [text for _, text in _pages(app)] if app.builder.name == "html" else []
    return module_pages.pages(texts)


def _link_pages(app: Sphinx, error: Exception | None) -> None:
    """Rewrite every page; warn of each number without a target, which fails a build with -W."""
    from sphinx.util import logging

    if error is not None or app.builder.name != "html":
        return
    folder = Path(app.outdir)
    found = dict(with_equation_anchors(_pages(app)))
    linker = Linker(targets(found))
    for name, text in found.items():
        (folder / name).write_text(_linked(linker, name, text), encoding="utf-8")
    (folder / "_static" / "equations.js").write_text(equations_script(found), encoding="utf-8")
    if app.config.links_are_complete:
        for fault in dict.fromkeys(linker.faults):
            logging.getLogger(__name__).warning(fault)


def _linked(linker: Linker, name: str, text: str) -> str:
    """A page with links in its article."""
    start, end = text.find("<article"), text.find("</article>")
    if start < 0:
        return text
    article = _LISTED.sub(
        lambda listed: _with_definition(linker, name, listed), linker.page(name, text[start:end])
    )
    return text[:start] + article + text[end:]


def _with_definition(linker: Linker, page: str, listed: re.Match[str]) -> str:
    """The line over shown code, whose name leads to its definition among its neighbours."""
    module = listed["path"].removesuffix(".py").replace("/", ".")
    target = linker.targets.get(f"name {module}.{listed['name'].split('.')[0]}")
    if target is None:
        return listed[0]
    link = f'<a class="ref to-name" href="{target.address(page)}">{listed["name"]}</a>'
    return f"{listed['before']}{link}{listed['between']}"


def _pages(app: Sphinx) -> Iterator[tuple[str, str]]:
    """File and text of the built pages: those of the table of contents in reading order, then all others."""
    folder = Path(app.outdir)
    order = [f"{name}.html" for name in reading_order(app.env.toctree_includes, app.config.root_doc)]
    others = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.html"))
    for name in dict.fromkeys([*order, *others]):
        path = folder / name
        if path.is_file() and not name.startswith(("_static/", "genindex", "search")):
            yield name, path.read_text(encoding="utf-8")


def reading_order(included: Mapping[str, Iterable[str]], first: str) -> list[str]:
    """Pages as the table of contents lists them, from the first one on."""
    found = [first]
    for name in included.get(first, ()):
        found += [page for page in reading_order(included, name) if page not in found]
    return found


def with_equation_anchors(pages: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """The pages, where the first display of each numbered equation has the anchor "eq-" and its number."""
    seen: set[str] = set()

    def anchored(match: re.Match[str]) -> str:
        number = match["number"]
        if number in seen:
            return match[0]
        seen.add(number)
        return f'<div class="{match["classes"]}" id="eq-{number}">\n{match["source"]}</div>'

    for name, text in pages:
        yield name, _DISPLAYED.sub(anchored, text)


def targets(pages: Mapping[str, str]) -> dict[str, Target]:
    """Every target on the pages, which are in reading order, by kind and name."""
    found: dict[str, Target] = {}
    for page, text in pages.items():
        heading = _heading(text)
        chapter = re.match(r"ch(\d)_", page)
        if chapter:
            found.setdefault(f"chapter {chapter[1]}", Target(page, "", heading))
        for key, target in _anchors(page, text, heading):
            found.setdefault(key, target)
    for path, name in _FILES.items():
        if f"{name}.html" in pages:
            found[f"place {path}"] = Target(f"{name}.html", "", _heading(pages[f"{name}.html"]))
    return found


def _anchors(page: str, text: str, heading: str) -> Iterator[tuple[str, Target]]:
    """The targets on one page."""
    for tag in re.finditer(r"<[a-z]\w*\s[^<>]*?\bid=\"([^\"]+)\"[^<>]*>", text):
        anchor = unescape(tag[1])
        about = re.search(r'data-about="([^"]*)"', tag[0])
        names = re.search(r'data-names="([^"]*)"', tag[0])
        if names:
            target = Target(page, anchor, unescape(about[1]) if about else heading)
            yield from ((f"person {name}", target) for name in unescape(names[1]).split("|"))
        elif anchor == "module":
            yield f"file {heading}", Target(page, "", heading)
        for pattern, kind in _ANCHORS:
            match = pattern.fullmatch(anchor)
            if match:
                name = ".".join(match.groups())
                title = unescape(about[1]) if about else _title(kind, name, text, tag.end(), heading)
                yield f"{kind} {name}", Target(page, anchor, title)


def _title(kind: str, name: str, text: str, place: int, heading: str) -> str:
    """What a link to an anchor at this place says when the pointer rests on it."""
    if kind == "fig":
        caption = re.search(r"<figcaption><b>(.*?)\.?</b>", text[place:], re.DOTALL)
        return f"{_plain(caption[1]) if caption else f'Fig. {name}'}; in {heading}"
    words = {"eq": f"Eq. ({name})", "table": f"Table {name}", "row": f"Row {name}"}.get(kind, name)
    return f"{words}; in {heading}"


def _heading(text: str) -> str:
    """The first heading of a page as plain text."""
    article = text[max(text.find("<article"), 0) :]
    found = re.search(r"<h1[^>]*>(.*?)(?:<a class=\"headerlink\".*?)?</h1>", article, re.DOTALL)
    return _plain(found[1]) if found else ""


def _plain(html: str) -> str:
    """Text without tags; of mathematics, nothing but its letters."""
    text = unescape(re.sub(r"<[^>]+>", "", html))
    return " ".join(re.sub(r"\\\((.*?)\\\)", r"\1", text).replace("\\", "").split())


def equations_script(pages: Mapping[str, str]) -> str:
    """A classic script with the source of every displayed equation by its number, for the preview of a link."""
    sources = {
        match["number"]: unescape(match["source"]).strip()
        for text in pages.values()
        for match in _DISPLAYED.finditer(text)
        if match["anchor"]
    }
    return f"const EQUATIONS = {json.dumps(sources, sort_keys=True, indent=0)};\n"


def marked(anchor: str, about: str, names: Sequence[str] = ()) -> str:
    """The attributes of an element that links lead to: its anchor, what it is, and names that lead there."""
    led = f' data-names="{escape("|".join(names))}"' if names else ""
    return f'id="{escape(anchor)}" data-about="{escape(about)}"{led}'
