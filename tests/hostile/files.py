"""Bad case files, CSV files and standard input, by hand: what no schema knows of."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator
from typing import Any

from .judge import Input
from .schema import CASE, Spot, bases, file_of, spots, whole
from .toml import quoted
from .values import CONTROL, OPEN, SURE

RUN = ("run", CASE, "--file", "c.toml", "-o", "c.nc")
_LIKE = '[c]\nlike = "elastica"\nrod.vertices = 7\n'


def inputs() -> Iterator[Input]:
    """All of them."""
    for what, content in _not_cases():
        yield Input(f"file: {what}", RUN, {"c.toml": content}, codes=SURE)
    yield Input("file: /dev/zero", ("run", "c", "--file", "/dev/zero"), codes=SURE)
    for what, content in _unfolded():
        yield Input(f"unfolded: {what}", RUN, {"c.toml": content}, codes=SURE)
    for what, content, codes in _titles():
        yield Input(f"title: {what}", RUN, {"c.toml": content}, codes=codes)
        yield Input(
            f"title listed: {what}", ("cases", "--file", "c.toml"), {"c.toml": content}, codes=codes
        )
        if codes == OPEN:
            for command in ("plot", "show", "export --to csv"):
                word, *more = command.split()
                yield Input(
                    f"title, {word}: {what}", (word, "c.nc", *more), {"c.toml": content}, before=(RUN,)
                )
    for name in (*_NAMES.split(), *_STRANGE_NAMES):
        content = f'[{quoted(name)}]\nlike = "elastica"\nrod.vertices = 7\n'.encode(
            "utf-8", "surrogateescape"
        )
        codes = OPEN if name.isascii() and name.isalpha() else SURE
        yield Input(
            f"name: {name[:20]!r}", ("run", name, "--file", "c.toml"), {"c.toml": content}, codes=codes
        )
        listed = ("cases", "--file", "c.toml")
        yield Input(f"name listed: {name[:20]!r}", listed, {"c.toml": content}, codes=codes)
    yield from _csv()
    for what, content, codes in _standard_input():
        yield Input(f"stdin: {what}", ("run", "-", "-o", "c.nc"), stdin=content, codes=codes)


def _not_cases() -> Iterator[tuple[str, bytes]]:
    """Files that are not TOML, or hold no case."""
    yield "empty", b""
    yield "blank", b" \n\t\n"
    yield "only a mark", b"\xef\xbb\xbf"
    yield "binary", bytes(range(256))
    yield "HDF5", b"\x89HDF\r\n\x1a\n" + bytes(100)
    yield "NUL", _LIKE.encode() + b"\x00"
    yield "UTF-16", _LIKE.encode("utf-16")
    yield "UTF-32", _LIKE.encode("utf-32")
    yield "Latin-1", (_LIKE + "# é").encode("latin-1")
    yield "half a character", _LIKE.encode() + b"# \xe2\x82"
    yield "JSON", b'{"c": {"like": "elastica"}}'
    yield "YAML", b"c:\n  like: elastica\n"
    yield "Python", b"c = dict(like='elastica')\nprint(c)\n"
    yield "no table", b"like = 'elastica'\n"
    yield "a list of tables", b"[[c]]\nlike = 'elastica'\n"
    yield "twice", (_LIKE + _LIKE).encode()
    yield "a key twice", (_LIKE + "rod.vertices = 8\n").encode()
    yield "no end of a text", b'[c]\nlike = "elastica\n'
    yield "no end of a table", b"[c]\nrod = { vertices = 5\n"
    yield "a value without key", b"[c]\n= 5\n"
    yield "no value", b"[c]\nlike =\n"
    yield "a long line", b'[c]\nlike = "' + b"a" * 1_000_000 + b'"\n'
    yield "a long key", b"[c]\n" + b"a" * 100_000 + b" = 1\n"
    yield "a long broken line", b"[c]\nlike = " + b"a" * 100_000 + b"\n"
    yield "a long name of a case", b"[" + b"a" * 100_000 + b"]\nlike = 'elastica'\n"
    yield "digits", (_LIKE + f"a = {'9' * 5000}\n").encode()
    yield "hexadecimal digits", (_LIKE + f"a = 0x{'f' * 100_000}\n").encode()
    yield "a date that is none", (_LIKE + "a = 2020-13-45\n").encode()
    yield "bad escape", (_LIKE + 'a = "\\q"\n').encode()
    yield "surrogate", (_LIKE + 'a = "\\ud800"\n').encode()
    for depth in (500, 5000, 100_000):
        yield f"{depth} lists", (_LIKE + f"forces = {'[' * depth}{']' * depth}\n").encode()
        yield f"{depth} lists without end", (_LIKE + f"forces = {'[' * depth}\n").encode()
        yield f"{depth} tables", (_LIKE + f"rod = {'{a=' * depth}1{'}' * depth}\n").encode()
        yield f"{depth} dots", (_LIKE + f"rod.{'a.' * depth}a = 1\n").encode()
        yield f"{depth} dots of a table", (_LIKE + f"[c.{'a.' * depth}a]\n").encode()
    yield "another kind of like", b"[c]\nlike = 5\n"
    yield "like a table", b"[c]\nlike = { a = 1 }\n"
    yield "like lists", b'[c]\nlike = [["elastica"]]\n'
    yield "like nothing", b"[c]\nlike = []\n"
    yield "like itself", b'[c]\nlike = "c"\n'
    yield "like itself in a ring", b'[c]\nlike = "d"\n[d]\nlike = ["elastica", "c"]\n'
    yield "like nobody", b'[c]\nlike = "nobody"\n'
    yield "like a control character", f"[c]\nlike = {quoted(CONTROL)}\n".encode()
    yield "like a long name", b"[c]\nlike = '" + b"a" * 5000 + b"'\n"
    yield "a part like itself", b'[c]\nlike = "elastica"\nrod = { like = "c" }\n'
    yield "a part like a case", b'[c]\nlike = "elastica"\nrod = { like = "elastica" }\n'
    yield "a part like a list", b'[c]\nlike = "elastica"\nrod = { like = ["elastica"] }\n'
    yield "another case", b'[d]\nlike = "elastica"\n'
    yield "a kind that is none", b'[c]\nkind = "rods"\n'
    yield "a kind with control characters", f"[c]\nkind = {quoted(CONTROL)}\n".encode()
    yield "a long kind", b"[c]\nkind = '" + b"a" * 5000 + b"'\n"
    yield "kind a table", b"[c]\nkind = { a = [1] }\n"
    yield "keys with control characters", (_LIKE + f"{quoted(CONTROL)} = 1\n").encode()


def _unfolded() -> Iterator[tuple[str, bytes]]:
    """Small files with much inside them."""
    chain = "".join(f'[c{n}]\nlike = "c{n - 1}"\n' for n in range(1, 2001))
    yield "a chain of 2000", f'[c0]\nlike = "nobody"\n{chain}[c]\nlike = "c2000"\n'.encode()
    chain = "".join(f'[c{n}]\nlike = ["c{n - 1}", "c{n - 1}"]\n' for n in range(1, 41))
    yield "2^40 by like", f'[c0]\nlike = "elastica"\nbad = 1\n{chain}[c]\nlike = "c40"\n'.encode()
    many = ", ".join(['"elastica"'] * 3000)
    yield "like 3000 times", f"[c]\nlike = [{many}]\nbad = 1\n".encode()
    part = "".join(
        f'[p{n}]\na = {{ like = "p{n - 1}" }}\nb = {{ like = "p{n - 1}" }}\n' for n in range(1, 31)
    )
    yield "2^30 by parts", f'[p0]\na = 1\n{part}[c]\nlike = ["elastica", "p30"]\n'.encode()
    forces = ", ".join(['{ at = "last", along = "E2", force = "1 kg" }'] * 20_000)
    yield "20000 faults", (_LIKE + f"forces = [{forces}]\n").encode()
    keys = "\n".join(f"k{n} = {n}" for n in range(20_000))
    yield "20000 unknown keys", (_LIKE + keys).encode()
    cases = "".join(f'[d{n}]\nlike = "c"\n' for n in range(3000))
    yield "3000 cases and a bad one", (_LIKE + "bad = 1\n" + cases).encode()


def _titles() -> Iterator[tuple[str, bytes, tuple[int, ...]]]:
    """Titles and sources that are none, or that would change a terminal, a picture or a page."""
    for what, written in (
        ("a number", "7"),
        ("a table", "{ a = 1 }"),
        ("a list", "[1]"),
        ("a truth", "true"),
        ("a date", "2020-01-01"),
        ("not a number", "nan"),
    ):
        for key in ("title", "source"):
            yield f"{what} as {key}", (_LIKE + f"{key} = {written}\n").encode(), SURE
    for what, text in (
        ("control characters", CONTROL),
        ("lines", "one\ntwo\r\nthree\rfour"),
        ("backspaces", "wrong\b\b\b\b\bright"),
        ("C1 control characters", "\x9b31m"),
        ("right to left", "\u202eabc\u2066"),
        ("markup", "<script>alert(1)</script> & ]]> -- <!--"),
        ("wrong mathematics", r"$\frac$ and $x^$"),
        ("dollars", "costs $5 and $6"),
        ("long", "a" * 100_000),
        ("other scripts", "стержень 棒 🪱"),
        ("no character", "\ufffe\U0010ffff"),
        ("per cent", "%s %n {0} {x}"),
        ("empty", ""),
    ):
        for key in ("title", "source"):
            yield f"{what} as {key}", (_LIKE + f"{key} = {quoted(text)}\n").encode(), OPEN


_NAMES = "../x . -x a/b $(x) con a;b * %s стержень"
_STRANGE_NAMES = ("", " ", "my rod", "a\nb", CONTROL, "a" * 245, "a" * 5000, "a\udc80")
"""Names of cases."""


def _csv() -> Iterator[Input]:
    """Broken CSV files in the place of rows."""
    found = [spot for kind in bases() for spot in spots(kind) if "CSV" in spot.value.said]
    places: dict[tuple[str, ...], Spot] = {}
    for spot in found:
        places.setdefault(spot.same, spot)
    for number, spot in enumerate(places.values()):
        first = number == 0
        content = file_of(spot.kind, spot.given("t.csv", whole(spot.kind)))
        names = spot.value.said.split("[")[1].split("]")[0].split(", ")
        header = ",".join(
            f"{name} [{unit or '1'}]" for name, _, unit in (n.partition(" in ") for n in names)
        )
        for what, rows, codes in tables(header, len(names)):
            given = {"c.toml": content, "t.csv": rows}
            yield Input(f"CSV: {what}, {spot.path}", RUN, given, codes=codes, common=first)
        for name in (
            "missing.csv",
            "/dev/zero",
            "/dev/null",
            ".",
            "",
            "a\x00b",
            "a" * 5000,
            CONTROL,
            "~/x",
            "c.toml",
        ):
            content = file_of(spot.kind, spot.given(name, whole(spot.kind)))
            yield Input(
                f"CSV: named {name[:15]!r}, {spot.path}",
                RUN,
                {"c.toml": content},
                codes=SURE,
                common=first,
            )


@functools.cache
def _many(columns: int) -> str:
    return "\n".join(",".join([str(n)] * columns) for n in range(300_000))


def tables(header: str, columns: int) -> Iterator[tuple[str, bytes, tuple[int, ...]]]:
    """Broken CSV files: what is wrong, the file, and the exit codes that are as promised of a table of numbers."""

    def rows(*lines: str) -> bytes:
        return "\n".join(lines).encode()

    good = [",".join([str(n)] * columns) for n in range(3)]
    yield "empty", b"", SURE
    yield "header alone", rows(header), SURE
    yield "no header", rows(*good), SURE
    yield "one row", rows(header, good[0]), OPEN
    yield "only comments", rows("# a", "# b"), SURE
    yield "binary", bytes(range(256)), SURE
    yield "UTF-16", rows(header, *good).decode().encode("utf-16"), SURE
    yield "NUL", rows(header, *good) + b"\x00", SURE
    for bad in (
        "nan",
        "inf",
        "1e400",
        "",
        "x",
        "1,5",
        "9" * 5000,
        "x" * 200_000,
        '"',
        "0x10",
        CONTROL,
        "1_0",
    ):
        codes = OPEN if bad == "1_0" else SURE
        yield f"cell {bad[:8]!r}", rows(header, good[0], ",".join([bad] * columns), good[2]), codes
    yield "too few cells", rows(header, *good, "1"), SURE
    yield "too many cells", rows(header, *good, good[2] + ",1"), SURE
    yield "falling", rows(header, *good[::-1]), OPEN
    yield "equal rows", rows(header, good[0], good[0], good[0]), OPEN
    yield "other names", rows(",".join(["a [m]"] * columns), *good), SURE
    yield "wrong unit", rows(header.replace("[", "[mol "), *good), SURE
    yield "power of powers", rows(header.replace("]", "^(9^9^9^9)]"), *good), SURE
    yield "control characters", rows(header.replace(" [", CONTROL + " ["), *good), SURE
    yield "open bracket", rows(header.replace("]", ""), *good), SURE
    yield "100000 columns", rows(header + ",a" * 100_000, *good), SURE
    yield "large", rows(header, *(",".join([f"{n}e300"] * columns) for n in range(1, 4))), OPEN
    yield "small", rows(header, *(",".join([f"{n}e-300"] * columns) for n in range(1, 4))), OPEN
    yield "300000 rows", rows(header, _many(columns)), OPEN


def _standard_input() -> Iterator[tuple[str, bytes, tuple[int, ...]]]:
    right: dict[str, Any] = {
        "name": CASE,
        "title": "a title",
        "source": "",
        "problem": whole("rod statics"),
    }
    text = json.dumps(right)
    yield "empty", b"", SURE
    yield "not JSON", b"nonsense", SURE
    yield "binary", bytes(range(256)), SURE
    yield "half", text[: len(text) // 2].encode(), SURE
    yield "UTF-16", text.encode("utf-16"), SURE
    for what, value in (
        ("null", None),
        ("a number", 5),
        ("a list", [right]),
        ("a text", "c"),
        ("a table", {}),
    ):
        yield what, json.dumps(value).encode(), SURE
        yield f"problem {what}", json.dumps({**right, "problem": value}).encode(), SURE
        yield (
            f"title {what}",
            json.dumps({**right, "title": value}).encode(),
            SURE if what != "a text" else OPEN,
        )
        yield (
            f"name {what}",
            json.dumps({**right, "name": value}).encode(),
            SURE if what != "a text" else OPEN,
        )
    yield "a key too many", json.dumps({**right, "more": 1}).encode(), SURE
    yield "a long key", json.dumps({**right, "a" * 5000: 1}).encode(), SURE
    yield "a long text", b'"' + b"a" * 100_000, SURE
    yield "digits", text.replace('"vertices": 7', f'"vertices": {"9" * 5000}').encode(), SURE
    yield "surrogate", text.replace("a title", "\\ud800").encode(), OPEN
    yield "name with a path", json.dumps({**right, "name": "../x"}).encode(), SURE
    yield "name with control characters", json.dumps({**right, "name": CONTROL}).encode(), SURE
    yield "title with control characters", json.dumps({**right, "title": CONTROL}).encode(), OPEN
    for depth in (900, 5000, 200_000):
        yield f"{depth} lists", b"[" * depth, SURE
        yield f"{depth} tables", (b'{"a":' * depth) + b"1" + b"}" * depth, SURE
        deep = text.replace('"problem": {', '"problem": {"deep": ' + "[" * depth + "]" * depth + ", ")
        yield f"{depth} lists in a case", deep.encode(), SURE
