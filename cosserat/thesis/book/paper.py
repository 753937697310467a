"""The whole book as one PDF: its pages in their order and a list of contents, printed by the system's browser."""

from __future__ import annotations

import html
import io
import re
import tempfile
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from cosserat.data.files import check_destination, whole_or_absent
from cosserat.errors import CosseratError, InputError
from cosserat.thesis.book.browser import browser, settle
from cosserat.thesis.book.edition import edition

if TYPE_CHECKING:
    from playwright.sync_api import Browser

_TAG = re.compile(r"<[a-zA-Z][^>]*>")
_NAMES = re.compile(r'\s(id|for|name|aria-labelledby|aria-describedby|href|xlink:href)="([^"]*)"')
_FOOT = (
    '<div style="width: 100%; text-align: center; font-size: 8pt"><span class="pageNumber"></span></div>'
)


@dataclass(frozen=True)
class Part:
    """One page of the book as a part of the paper one."""

    name: str
    """File of the page."""
    title: str
    """Its title, as HTML."""
    sections: list[tuple[str, str]]
    """Anchors and titles of its sections."""
    body: str
    """Its article, as HTML."""


def print_book(book: Path, output: Path) -> int:
    """Print a built book to a PDF with an outline, a list of contents and page numbers; returns the number of pages.

    Solutions and misprints are opened.  Rows of the report, which are whole on their own page, and the tests of errata
    stay folded.  Players show the state that they begin with.  Pages of source code are left out.

    Raises
    ------
    InputError : the folder holds no book, or the file cannot be written.
    CosseratError : there is no browser.
    """
    if not (book / "index.html").is_file():
        raise InputError(f"{book} holds no book; build one with 'cosserat book' or 'make'")
    check_destination(output, ".pdf")
    parts = [_part(book, name) for name in _order(book)]
    parts = [_within(part, {part.name for part in parts}) for part in parts]
    styles = _styles(book)
    with tempfile.TemporaryDirectory() as scratch, browser() as chromium:
        for entry in book.iterdir():
            if entry.is_dir():
                (Path(scratch) / entry.name).symlink_to(entry.resolve())
        file = Path(scratch) / "paper.html"
        pages = _pages(_printed(chromium, file, _whole(parts, styles, {})), parts)
        printed = _printed(chromium, file, _whole(parts, styles, pages))
    with whole_or_absent(output) as temporary:
        temporary.write_bytes(printed)
    return _count(printed)


def _order(book: Path) -> list[str]:
    """The pages of the book in the order of its contents."""
    first = (book / "index.html").read_text(encoding="utf-8")
    contents = re.search(r'<ul class="nav bd-sidenav">.*?</nav>', first, flags=re.DOTALL)
    listed = re.findall(r'href="([\w.-]+\.html)"', contents[0]) if contents else []
    return list(dict.fromkeys(["index.html", *listed]))


def _part(book: Path, name: str) -> Part:
    """The article of a page; its scripts are left out, as paper does not move."""
    text = (book / name).read_text(encoding="utf-8")
    found = re.search(r"<article[^>]*>(.*)</article>", text, flags=re.DOTALL)
    if found is None:
        raise InputError(f"{book / name} is no page of a book; build it again")
    body = re.sub(r"<script\b.*?</script>", "", found[1], flags=re.DOTALL)
    body = re.sub(r'<a class="headerlink".*?</a>', "", body, flags=re.DOTALL)
    heading = re.search(r"<h1[^>]*>(.*?)</h1>", body, flags=re.DOTALL)
    sections = re.findall(
        r'<section\b[^>]*\bid="([^"]+)"[^>]*>\s*(?:<span[^>]*></span>\s*)*<h2>(.*?)</h2>',
        body,
        re.DOTALL,
    )
    return Part(name, heading[1].strip() if heading else name, sections, body)


def _within(part: Part, names: set[str]) -> Part:
    """A part whose anchors have the name of its page before them, and whose links lead to such anchors.

    A link to a page that is not printed becomes plain.
    """

    def renamed(found: re.Match[str]) -> str:
        kind, value = found[1], html.unescape(found[2])
        if not kind.endswith("href"):
            words = " ".join(_anchor(part.name, word) for word in value.split())
            return f' {kind}="{html.escape(words)}"'
        page, _, anchor = value.partition("#")
        if re.match(r"[a-z]+:", value):
            return found[0]
        page = page or part.name
        if page not in names:
            return ""
        return f' {kind}="#{html.escape(_anchor(page, anchor))}"'

    body = _TAG.sub(lambda tag: _NAMES.sub(renamed, tag[0]), part.body)
    body = re.sub(
        r"url\((&quot;|'|\")?#([^)&'\"]+)(&quot;|'|\")?\)",
        lambda at: f"url(#{_anchor(part.name, at[2])})",
        body,
    )
    return Part(
        part.name, part.title, [(_anchor(part.name, one), title) for one, title in part.sections], body
    )


def _anchor(page: str, anchor: str) -> str:
    stem = page.removesuffix(".html")
    return f"{stem}--{anchor}" if anchor else stem


def _styles(book: Path) -> str:
    """The links to the styles of a page."""
    first = (book / "index.html").read_text(encoding="utf-8")
    return "\n".join(re.findall(r'<link [^>]*rel="stylesheet"[^>]*>', first))


def _whole(parts: list[Part], styles: str, pages: dict[str, int]) -> str:
    """One HTML file: a title, the contents with the numbers of pages as far as they are known, and all parts."""

    def line(level: int, anchor: str, title: str) -> str:
        number = pages.get(anchor, "")
        plain = re.sub(r"</?a\b[^>]*>", "", title)
        return (
            f'<li class="level-{level}"><a href="#{anchor}"><span>{plain}</span></a><b>{number}</b></li>'
        )

    contents = "".join(
        line(1, _anchor(part.name, ""), part.title)
        + "".join(line(2, *section) for section in part.sections)
        for part in parts
    )
    bodies = "".join(
        f'<article class="bd-article" id="{_anchor(part.name, "")}">{part.body}</article>'
        for part in parts
    )
    frame = (resources.files("cosserat.thesis.book") / "paper.html").read_text(encoding="utf-8")
    filled = {
        "STYLES": styles,
        "EDITION": html.escape(edition().text),
        "CONTENTS": contents,
        "BODIES": bodies,
    }
    for key, text in filled.items():
        frame = frame.replace(f"<!--{key}-->", text)
    return frame


def _printed(chromium: Browser, file: Path, text: str) -> bytes:
    """A file of HTML as a PDF, once its mathematics is set."""
    file.write_text(text, encoding="utf-8")
    page = chromium.new_page()
    page.set_default_timeout(300_000)
    page.emulate_media(media="print", color_scheme="light")
    page.set_viewport_size({"width": 680, "height": 1000})
    page.goto(file.resolve().as_uri())
    settle(page)
    page.evaluate(
        "() => document.querySelectorAll('details.hide, .misprints details').forEach((one) => { one.open = true; })"
    )
    printed = page.pdf(
        format="A4",
        margin={"top": "16mm", "bottom": "18mm", "left": "15mm", "right": "15mm"},
        outline=True,
        tagged=True,
        print_background=True,
        display_header_footer=True,
        header_template="<span></span>",
        footer_template=_FOOT,
    )
    page.close()
    return printed


def _pages(printed: bytes, parts: list[Part]) -> dict[str, int]:
    """The page on which each anchor of the contents is, from 1 on."""
    from pypdf import PdfReader

    reader = PdfReader(io.BytesIO(printed))
    found = {}
    for name, place in reader.named_destinations.items():
        number = reader.get_destination_page_number(place)
        if number is not None:
            found[name.removeprefix("/")] = number + 1
    wanted = [
        anchor
        for part in parts
        for anchor in (_anchor(part.name, ""), *(one for one, _ in part.sections))
    ]
    missing = [anchor for anchor in wanted if anchor not in found]
    if missing:
        raise CosseratError(f"the PDF has no place '{missing[0]}', which its contents name")
    return {anchor: found[anchor] for anchor in wanted}


def _count(printed: bytes) -> int:
    from pypdf import PdfReader

    return len(PdfReader(io.BytesIO(printed)).pages)
