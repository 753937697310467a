"""Every page of a built book in Chromium: at three widths, in two themes, and on paper."""

from __future__ import annotations

import multiprocessing
import os
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import unquote, urldefrag

from cosserat.thesis.book.browser import browser, settle

SCRIPT = (Path(__file__).parent / "audit.js").read_text(encoding="utf-8")
WIDTHS = (390, 1200, 1440)
THEMES = ("light", "dark")
PAPER = 680  # px: the width of A4 between margins of 15 mm
SENTENCE = 30  # letters that an alternative text has at least
CHECKS = (
    "equations",
    "mathematics",
    "columns",
    "words",
    "contrast",
    "requests",
    "console",
    "anchors",
    "figures",
    "controls",
    "headings",
    "tables",
    "size",
)


@dataclass(frozen=True)
class Fault:
    """Something wrong in one view of one page."""

    check: str
    page: str
    view: str
    """Width and theme, or "paper" and theme."""
    element: str
    text: str


@dataclass
class Seen:
    """What the views of one page gave."""

    page: str
    views: int = 0
    counts: Counter = field(default_factory=Counter)
    faults: list[Fault] = field(default_factory=list)
    figures: list[list[str]] = field(default_factory=list)
    ids: set[str] = field(default_factory=set)
    links: list[list[str]] = field(default_factory=list)


@dataclass(frozen=True)
class Audit:
    """What the views of all pages gave."""

    pages: int
    views: int
    counts: Counter
    faults: list[Fault]


def pages_of(book: Path) -> list[str]:
    return sorted(file.relative_to(book).as_posix() for file in book.rglob("*.html"))


def audit(book: Path, pages: Iterable[str] | None = None, processes: int | None = None) -> Audit:
    """Look at pages of a book (all, if none are named) and at what they link to.

    The largest pages come first, so that no process waits at the end.
    """
    every = pages_of(book)
    asked = sorted(pages or every, key=lambda page: -(book / page).stat().st_size)
    processes = processes or min(os.cpu_count() or 1, len(asked))
    if processes == 1:
        seen = look_at_some((book, asked))
    else:
        tasks = [(book, asked[first::processes]) for first in range(processes)]
        with multiprocessing.get_context("spawn").Pool(processes) as pool:
            seen = [one for some in pool.map(look_at_some, tasks) for one in some]
    faults = [fault for one in seen for fault in one.faults]
    faults += faults_of_links(book, seen)
    faults += faults_of_figures(seen)
    counts: Counter = sum((one.counts for one in seen), Counter())
    return Audit(len(seen), sum(one.views for one in seen), counts, faults)


def look_at_some(task: tuple[Path, list[str]]) -> list[Seen]:
    """Look at some pages with one browser, on a phone and on a desk."""
    book, pages = task
    seen: list[Seen] = []
    with browser() as chromium:
        phone = chromium.new_context(
            viewport={"width": 390, "height": 844}, is_mobile=True, has_touch=True, color_scheme="light"
        ).new_page()
        desk = chromium.new_context(color_scheme="light").new_page()
        listen(phone, seen, "390")
        listen(desk, seen, "1200")
        for page in pages:
            seen.append(Seen(page))
            address = (book / page).resolve().as_uri()
            look_on_phone(phone, seen[-1], address)
            look_on_desk(desk, seen[-1], address)
    return seen


def look_on_phone(tab, seen: Seen, address: str) -> None:
    open_page(tab, address)
    look_at_width(tab, seen, 390)


def look_on_desk(tab, seen: Seen, address: str) -> None:
    """A page is loaded at 1200 px; then its window widens, and it is laid on paper."""
    tab.set_viewport_size({"width": 1200, "height": 900})
    tab.emulate_media(media="screen")
    open_page(tab, address)
    look_at_width(tab, seen, 1200)
    press_tab(tab, seen, "1200")
    tab.set_viewport_size({"width": 1440, "height": 900})
    look_at_width(tab, seen, 1440)
    tab.set_viewport_size({"width": PAPER, "height": 1000})
    tab.emulate_media(media="print")
    look_at_width(tab, seen, PAPER, paper=True)


def open_page(tab, address: str) -> None:
    """A page with its folded parts open, and a keyboard in use, so that it shows where that is."""
    tab.goto(address)
    settle(tab)
    tab.evaluate("() => document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    tab.keyboard.press("Tab")


def listen(tab, all_seen: list[Seen], width: str) -> None:
    """Keep what the last page asks for and complains about."""

    def add(check: str, element: str, text: str) -> None:
        seen = all_seen[-1]
        seen.faults.append(Fault(check, seen.page, width, element[:120], text[:200]))

    def asked(request) -> None:
        all_seen[-1].counts["requests"] += 1
        if not request.url.startswith(("file:", "data:", "blob:", "about:")):
            add("requests", request.url, "leaves the machine")

    def said(message) -> None:
        all_seen[-1].counts["console"] += 1
        if message.type in ("error", "warning"):
            add("console", message.type, message.text)

    def failed(request) -> None:
        if request.url.startswith("file:") and request.failure != "net::ERR_ABORTED":
            add("requests", request.url, "there is no such file")

    tab.on("request", asked)
    tab.on("requestfailed", failed)
    tab.on("console", said)
    tab.on("pageerror", lambda error: add("console", "script", str(error)))


def look_at_width(tab, seen: Seen, width: int, paper: bool = False) -> None:
    """Both themes at one width of the window."""
    both = tab.evaluate(SCRIPT, {"width": width, "paper": paper})
    for theme, found in zip(THEMES, both, strict=True):
        name = f"{'paper' if paper else width} {theme}"
        seen.views += 1
        seen.counts.update(found["counts"])
        seen.faults += [
            Fault(check, seen.page, name, element, text) for check, element, text in found["faults"]
        ]
        if "links" in found:  # what does not depend on the window is looked at once
            seen.figures, seen.ids, seen.links = found["figures"], set(found["ids"]), found["links"]
            if found["mathematics"] and not found["typesetter"]:
                seen.faults.append(
                    Fault("mathematics", seen.page, name, "page", "nothing sets its mathematics")
                )


def press_tab(tab, seen: Seen, view: str) -> None:
    """From one control of each sort a press of Tab leads on."""
    step = """(number) => {
      const all = window.auditedControls, last = number && all[number - 1];
      const stuck = last && document.activeElement === last[0] ? last[1] : null;
      if (number < all.length) all[number][0].focus({ preventScroll: true });
      return [stuck, number < all.length];
    }"""
    number, more = 0, True
    while more:
        stuck, more = tab.evaluate(step, number)
        if stuck:
            seen.faults.append(
                Fault("controls", seen.page, view, stuck, "does not let go of the keyboard")
            )
        if more:
            tab.keyboard.press("Tab")
        number += 1


def faults_of_links(book: Path, seen: list[Seen]) -> Iterator[Fault]:
    """Links within the book whose page or anchor there is not."""
    ids = {one.page: one.ids for one in seen}
    for one in seen:
        for address, element in one.links:
            one.counts["anchors"] += 1
            if address.startswith(("http:", "https:", "mailto:", "data:")) or address == "#":
                continue
            path, anchor = urldefrag(address)
            target = (
                os.path.normpath(os.path.join(os.path.dirname(one.page), unquote(path)))
                if path
                else one.page
            )
            if address.startswith("javascript:") or not (book / target).is_file():
                yield Fault(
                    "anchors", one.page, "all", element, f"leads to '{address}', which is not there"
                )
            elif anchor and target in ids and unquote(anchor) not in ids[target]:
                yield Fault(
                    "anchors",
                    one.page,
                    "all",
                    element,
                    f"leads to '{address}', which has no such anchor",
                )


def faults_of_figures(seen: list[Seen]) -> Iterator[Fault]:
    """Pictures without a text of their own: it is no title, no caption and no other picture's."""
    users = defaultdict(set)
    for one in seen:
        for element, text, _, _, figure in one.figures:
            users[text].add((one.page, figure or element))
    for one in seen:
        for element, text, title, caption, _ in one.figures:
            said = None
            if not text:
                said = "has no alternative text"
            elif len(text) < SENTENCE:
                said = f"'{text}' is no sentence"
            elif text.rstrip(".") == title or text.rstrip(".") in caption:
                said = "its alternative text is its title or caption"
            elif len(users[text]) > 1:
                said = "another picture has the same alternative text"
            if said:
                yield Fault("figures", one.page, "all", element, said)
