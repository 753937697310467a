"""Text of a built page with its numbers, names and paths as links; tags, mathematics and code stay as they are."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape, unescape
from importlib import resources

_TOKEN = re.compile(
    r"<!--.*?-->|<(?P<whole>script|style|svg|textarea|title)\b.*?</(?P=whole)\s*>"
    r"|<(?P<close>/?)(?P<tag>[a-zA-Z][\w-]*)(?P<rest>(?:[^<>\"']|\"[^\"]*\"|'[^']*')*)>|[^<]+|<",
    re.DOTALL,
)
_VOID = frozenset(
    ("area", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr")
)
_CLOSED = frozenset(
    ("a", "button", "summary", "label", "option", "select", "math", "h1", "h2", "h3", "h4", "h5", "h6")
)
"""Elements whose text has no links: their own behaviour or place would suffer."""
_WITHOUT = frozenset(("math", "sig", "no-links"))
"""Classes of elements without links: mathematics, signatures, and what asks for none."""
_OUTPUT = frozenset(("highlight-myst-ansi", "highlight-none", "highlight-default"))
"""Classes of what code has printed, whose text has links everywhere."""
_COMMENTS = frozenset(("c", "c1", "cm", "ch", "cs", "sd"))
"""Classes of comments and docstrings in shown code."""
_STRINGS = frozenset(("s1", "s2"))
"""Classes of strings in shown code: an equation stands there as "3.4.11"."""
_NUMBER = r"[1-4]\.\d{1,2}"
_END = r"(?!\d|\.\d|-\w)"
_MORE = rf"(?:(?:,|,? and|,? or| to|\s?-|\s?–)\s?{_NUMBER}(?:\([a-d]\))?{_END})*"


@dataclass(frozen=True)
class Target:
    """Where a link leads: the page's file, the anchor on it ("" for its head), and a title of what is there."""

    page: str
    anchor: str
    about: str

    def address(self, page: str) -> str:
        """The address as seen from a page."""
        anchor = f"#{self.anchor}" if self.anchor else ""
        depth = "../" * page.count("/")
        return anchor if page == self.page and anchor else f"{depth}{self.page}{anchor}"


@dataclass
class Linker:
    """Makes links of what it knows.

    targets : by kind and name, such as "eq 3.4.11", "fig 3.8", "table 2.1", "erratum E2.5", "chapter 2",
        "file cosserat/text.py", "name cosserat.run", "row 2.8-stride", "person Quillin".
    faults : what had no target, as "page: text", in the order of the pages.
    made : the number of links by kind.
    """

    targets: Mapping[str, Target]
    faults: list[str] = field(default_factory=list)
    made: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._pattern = re.compile("|".join(f"(?P<{kind}>{text})" for kind, text in self._forms()))

    def _forms(self) -> Iterator[tuple[str, str]]:
        yield "eq", r"\([1-3]\.\d\.\d{1,3}\)"
        yield "quoted", r"(?:&quot;|\")[1-3]\.\d\.\d{1,3}(?:&quot;|\")"
        yield "fig", rf"\bFig(?:ure)?s?\.?\s{_NUMBER}(?:\([a-d]\))?{_END}{_MORE}"
        yield "table", rf"\bTables?\s{_NUMBER}{_END}"
        yield "erratum", r"(?<![\w.])E[1-9]\.\d{1,2}(?!\.\d|\w)"
        yield "chapter", r"\bChapters?\s\d(?!\.\d)(?:(?:,|,? and|,? or| to)\s\d(?!\.\d))*"
        yield "file", r"(?<![\w/.])cosserat(?:/\w+)+\.(?:py|toml|css|js|smk)\b"
        yield "name", r"(?<![\w/.])cosserat(?:\.\w+)+"
        for kind in ("row", "person", "place"):
            names = [name.partition(" ")[2] for name in self.targets if name.startswith(f"{kind} ")]
            if names:
                words = "|".join(
                    re.escape(escape(name)) for name in sorted(names, key=len, reverse=True)
                )
                yield kind, rf"(?<![\w./\-])(?:{words})(?![\w\-/]|\.\w)"

    def page(self, name: str, html: str) -> str:
        """The HTML of a page, or of its article, with links."""
        open_tags: list[tuple[str, str, str]] = []  # tag, classes, id
        parts = []
        for token in _TOKEN.finditer(html):
            text, tag = token[0], token["tag"]
            if tag is None:
                plain = token["whole"] is None and not text.startswith("<")
                parts.append(self._text(name, text, open_tags) if plain else text)
                continue
            parts.append(text)
            if token["close"]:
                _close(open_tags, tag)
            elif tag not in _VOID and not token["rest"].rstrip().endswith("/"):
                open_tags.append(
                    (tag, _attribute(token["rest"], "class"), _attribute(token["rest"], "id"))
                )
        return "".join(parts)

    def _text(self, page: str, text: str, open_tags: list[tuple[str, str, str]]) -> str:
        """A text between tags."""
        if not text.strip() or not _may_link(open_tags):
            return text
        own = {anchor for _, _, anchor in open_tags if anchor}
        in_string = bool(open_tags) and open_tags[-1][1] in _STRINGS

        def linked(match: re.Match[str]) -> str:
            kind = str(match.lastgroup)
            return (
                self._numbers(page, kind, match[0], own) if in_string == (kind == "quoted") else match[0]
            )

        return self._pattern.sub(linked, text)

    def _numbers(self, page: str, kind: str, text: str, own: set[str]) -> str:
        """Links of every number in what a pattern has found; a word before the first one belongs to its link."""
        if kind not in _NUMBERS:
            return self._link(page, kind, text, text, own)
        parts: list[str] = []
        done = 0
        for number in re.finditer(_NUMBERS[kind], text):
            start = 0 if not parts and kind in _WORDED else number.start()
            link = self._link(page, _SAME.get(kind, kind), number[1], text[start : number.end()], own)
            parts += [text[done:start], link]
            done = number.end()
        return "".join([*parts, text[done:]])

    def _link(self, page: str, kind: str, name: str, shown: str, own: set[str]) -> str:
        """One link, or the text alone where there is no target or the reader stands in it."""
        target = self.targets.get(f"{kind} {unescape(name)}")
        if target is None:
            if kind in _STRICT and not (kind == "file" and _is_of_the_package(name)):
                self.faults.append(f"{page}: {shown} has no target")
            return shown
        if target.page == page and target.anchor in own:
            return shown
        self.made[kind] = self.made.get(kind, 0) + 1
        title = f' title="{escape(target.about)}"' if target.about else ""
        return f'<a class="ref to-{kind}" href="{escape(target.address(page))}"{title}>{shown}</a>'


_STRICT = frozenset(("eq", "fig", "table", "erratum", "chapter", "file"))
"""Kinds that must have a target."""
_NUMBERS = {
    "eq": r"\(([1-3]\.\d\.\d{1,3})\)",
    "quoted": r"([1-3]\.\d\.\d{1,3})",
    "fig": rf"({_NUMBER})(?:\([a-d]\))?",
    "table": rf"({_NUMBER})",
    "chapter": r"(\d)",
}
"""The numbers inside what a pattern has found."""
_WORDED = frozenset(("fig", "table", "chapter"))
"""Kinds whose first number is linked together with the word before it."""
_SAME = {"quoted": "eq"}


def _may_link(open_tags: list[tuple[str, str, str]]) -> bool:
    """Whether text at this place may be linked."""
    code = False
    for tag, classes, _ in open_tags:
        words = set(classes.split())
        if tag in _CLOSED or words & _WITHOUT:
            return False
        code = (
            code or "source" in words or any(word.startswith("highlight-") for word in words - _OUTPUT)
        )
    tag, classes, _ = open_tags[-1] if open_tags else ("", "", "")
    return not code or (tag == "span" and classes in _COMMENTS | _STRINGS)


def _is_of_the_package(path: str) -> bool:
    """Whether there is such a file, which has no page if no chapter names it."""
    return (resources.files("cosserat") / path.removeprefix("cosserat/")).is_file()


def _close(open_tags: list[tuple[str, str, str]], tag: str) -> None:
    """Close a tag and what was left open inside."""
    for place in range(len(open_tags) - 1, -1, -1):
        if open_tags[place][0] == tag:
            del open_tags[place:]
            return


def _attribute(rest: str, name: str) -> str:
    found = re.search(rf"\b{name}\s*=\s*(?:\"([^\"]*)\"|'([^']*)')", rest)
    return (found[1] or found[2] or "") if found else ""
