"""Bad command lines: from the parser of the commands, and by hand for paths, pipes and other people's files."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from .judge import Input
from .schema import CASE, file_of
from .values import CONTROL, SURE

SLOW = ("speed", "power", "peers", "book", "chapter", "accept")
"""Commands that work for long before they look at all they are given; they are tried by hand."""
_WORDS = (
    "nonsense",
    "",
    "-",
    "..",
    "/",
    "/dev/null",
    "a" * 5000,
    CONTROL,
    "a\x00b",
    "a\udc80b",
    "$(x)",
    "--",
    "-1",
)
SMALL = ("run", CASE, "--file", "c.toml", "-o", "c.nc")

_OF_A_RESULT = """\
plot c.nc -o c.nc
plot c.nc -o x.jpg
plot c.nc -o none/x.svg
plot c.nc -o d
plot c.nc -o /dev/null
plot c.nc -o {long}.svg
plot c.nc -o {nul}.svg
plot c.nc --animate x.gif
plot c.nc --animate x.mp4
plot c.nc --animate x.gif --frames 0
plot c.nc --frames abc
plot c.nc --animate x.gif --frames {digits}
export c.nc --to csv -o c.nc
export c.nc --to vtk -o c.nc
export c.nc -o x.doc
export c.nc --to doc
export c.nc
export c.nc --to csv --place nowhere
export c.nc --to csv --place {control}
export c.nc --to csv --place {long}
export c.nc --to vtk --place vertex
export c.nc -o none/x.csv
export c.nc --to csv -o /dev/null
export c.nc --to vtk -o /dev/null"""
"""Commands that can do nothing with a right result."""
_REFUSED = """\
check .
check none
measure --table none
figure nonsense
figure {control}
figure {long}
figure fig_3_10 --cases none -o x.svg
power --table none x
figure fig_3_10 -o none/x.svg
figure fig_3_10 fig_3_11 -o x.svg
describe nonsense
describe {control}
describe {long}
describe rod statics nonsense
describe rod statics {long}
describe ''
schema x
run - --file x
accept nonsense --because x
accept elastica --because '' --references none
peers none
peers .
chapter none.py -o x.ipynb
chapter . -o x.ipynb
book none.ipynb -o b
book . -o b"""
"""Commands of the workflow that find nothing to work on."""
_FAILING = """\
peers /bin/false -o p.csv
peers /bin/true -o p.csv
peers a.py -o p.csv
chapter a.py -o x.ipynb
chapter b.py -o none/x.ipynb
book a.ipynb -o b
book e.ipynb -o b
book e.ipynb -o mine
book e.ipynb -o .
book e.ipynb -o e.ipynb
book b.py -o b"""
"""Commands of the workflow that find something else."""
_PATHS = """\
none/x.nc x.nc/ /dev/null /dev/full /proc/x.nc /x/y.nc . .. / .nc x x.txt -x.nc $(x).nc dangling.nc loop.nc
link.nc to_none c.toml d/keep d/keep/x.nc x.nc ~/x.nc http://host/x.nc d"""
_STRANGE_PATHS = (
    *("", "x\x00.nc", "x\udc80.nc", f"{CONTROL}.nc", "x\n.nc"),
    *("a" * 300 + ".nc", "a" * 252 + ".nc", "/".join(["a" * 200] * 30) + ".nc"),
)
"""Names of results that may not be written."""


def inputs() -> Iterator[Input]:
    """All of them."""
    yield from _from_the_parser()
    yield from _outputs()
    yield from _other_files()
    yield from _by_hand()
    yield from _pipes()


def _words_of(lines: str) -> Iterator[tuple[str, ...]]:
    """The words of each line."""
    strange = {"control": CONTROL, "long": "a" * 5000, "digits": "1" * 5000, "nul": "a\x00b"}
    for line in lines.splitlines():
        words = line.replace("rod statics", "rod_statics").split()
        yield tuple(
            "" if word == "''" else word.format(**strange).replace("rod_s", "rod s") for word in words
        )


def commands() -> dict[str, argparse.ArgumentParser]:
    """The parser of each command."""
    from cosserat.cli import parser_of_commands

    found = [a for a in parser_of_commands()._actions if isinstance(a, argparse._SubParsersAction)]
    return dict(found[0].choices)


def _from_the_parser() -> Iterator[Input]:
    """Each command with missing, unknown and surplus words, and each option without or with a wrong value."""
    for bad in (
        "",
        "nonsense",
        CONTROL,
        "a" * 5000,
        "--nonsense",
        "--" + "a" * 5000,
        "-",
        "--",
        "a\udc80",
        "shwo",
    ):
        yield Input(f"command: {bad[:20]!r}", (bad,), codes=SURE)
    for name, parser in commands().items():
        own = name in ("run", "plot")
        options = [a for a in parser._actions if a.option_strings and a.dest != "help"]
        needed = tuple("c" for a in parser._actions if not a.option_strings and a.nargs in (None, "+"))
        if needed or any(a.required for a in options):
            yield Input(f"command: {name} alone", (name,), codes=SURE)
        for bad in ("--nonsense", "-Z", "--" + "a" * 5000, "--" + CONTROL):
            yield Input(f"option: {name} {bad[:20]!r}", (name, *needed, bad), codes=SURE, common=own)
        for option in options:
            flag = option.option_strings[-1]
            if option.nargs != 0:
                given = (name, *needed, flag)
                yield Input(f"option: {name} {flag} without value", given, codes=SURE, common=own)
            else:
                yield Input(
                    f"option: {name} {flag} with value", (name, *needed, f"{flag}=1"), codes=SURE
                )
            yield Input(f"option: {name} {flag} twice", (name, *needed, flag, "a", flag, "b"))
        if name in SLOW:
            continue
        yield Input(f"words: {name}, too many", (name, *needed, *["more"] * 50))
        for word in _WORDS:
            if needed:
                yield Input(f"word: {name} {word[:10]!r}", (name, word))
            for option in options:
                if option.nargs != 0:
                    flag = option.option_strings[-1]
                    given = (name, *needed, f"{flag}={word}")
                    yield Input(
                        f"value: {name} {flag} {word[:10]!r}", given, {"c": b"", "c.nc": b"nonsense"}
                    )


def _outputs() -> Iterator[Input]:
    """Paths to write to that are no files, somebody else's, or what is read."""
    files = {
        "c.toml": file_of("rod statics", {}),
        "d/keep": b"",
        "x.nc.parts": b"mine",
        "old.nc": b"old",
    }
    links = {
        "dangling.nc": "nowhere.nc",
        "loop.nc": "loop.nc",
        "link.nc": "old.nc",
        "to_d": "d",
        "to_none": "none",
    }
    for path in (*_PATHS.split(), *_STRANGE_PATHS):
        yield Input(f"output: {path[:20]!r}", (*SMALL[:-1], path), files, links)
    motion = file_of("rod motion", {})
    for what, extra, bonds in (
        ("a file in the place of the parts", {"c.nc.parts": b"mine"}, {}),
        ("a folder of others in the place of the parts", {"c.nc.parts/mine": b"mine"}, {}),
        ("parts that are none", {"c.nc.parts/00000.nc": b"mine", "c.nc.parts/00001.nc": b""}, {}),
        ("parts that link to a folder", {"d/keep": b"mine"}, {"c.nc.parts": "d"}),
        ("parts that link to nothing", {}, {"c.nc.parts": "nothing"}),
    ):
        yield Input(f"parts: {what}", SMALL, {"c.toml": motion, **extra}, bonds)
    yield Input(
        "output: what is read",
        ("run", "c", "--file", "c.nc", "-o", "c.nc"),
        {"c.nc": files["c.toml"]},
        codes=SURE,
    )
    for words in _words_of(_OF_A_RESULT):
        yield Input(f"output: {' '.join(words)[:60]}", words, files, codes=SURE, before=(SMALL,))


def _other_files() -> Iterator[Input]:
    """Files that are no results, for each command that reads one."""
    contents = {
        "empty.nc": b"", "text.nc": b"a text\n", "head.nc": b"\x89HDF\r\n\x1a\n", "zeros.nc": bytes(5000),
        "half.nc": b"\x89HDF\r\n\x1a\n" + bytes(range(256)) * 20, "classic.nc": b"CDF\x01" + bytes(28),
        "bad.nc": b"CDF\x02" + b"\xff" * 100, "c.toml": file_of("rod statics", {}),
    }  # fmt: skip
    links = {"loop.nc": "loop.nc", "dangling.nc": "nowhere"}
    names = (
        *contents,
        *links,
        "none.nc",
        ".",
        "/dev/null",
        "/dev/zero",
        "a" * 5000,
        "a\x00b",
        "a\udc80.nc",
        CONTROL,
        "https://host/x.nc",
    )
    for command in (("show",), ("plot",), ("export", "--to", "csv"), ("export", "--to", "vtk")):
        for name in names:
            yield Input(
                f"file of others: {' '.join(command)} {name[:15]!r}",
                (*command, name),
                contents,
                links,
                codes=SURE,
                common=command[0] == "show",
            )


def _by_hand() -> Iterator[Input]:
    """Commands of the workflow, with files that are none of theirs."""
    table = (Path(__file__).parents[2] / "results" / "tolerances.csv").read_bytes()
    for what, content in (
        ("empty", b""), ("binary", bytes(range(256))), ("text", b"a,b\n1,2\n"), ("header", table.split(b"\n")[0]),
        ("half", table[: len(table) // 2]), ("quotes", b'"' * 1001), ("large cell", b"a" * 200_000), ("NUL", b"\x00"),
        ("UTF-16", table.decode().encode("utf-16")),
    ):  # fmt: skip
        files = {"t.csv": content}
        yield Input(f"table: check {what}", ("check", "t.csv"), files, codes=(1, 2))
        yield Input(
            f"table: measure {what}",
            ("measure", "--table", "t.csv", "--cases", ".", "-o", "r.csv"),
            files,
            codes=(1, 2),
        )
        yield Input(f"table: power {what}", ("power", "--table", "t.csv", "nonsense"), files)
    for words in _words_of(_REFUSED):
        yield Input(f"command: {' '.join(words)[:60]!r}", words, codes=SURE)
    files = {
        "a.py": b"\xff\xfe\x00",
        "b.py": b"x = 1\n",
        "d/keep": b"",
        "a.ipynb": b"nonsense",
        "e.ipynb": b"{}",
        "mine/x.tex": b"",
    }
    for words in _words_of(_FAILING):
        yield Input(f"command: {' '.join(words)!r}", words, files, codes=(1, 2), alone=True)
    garbage = {
        f"g/{name}.nc": b"nonsense" for name in ("clamped_free", "clamped_free_ends_halved", "worm")
    }
    yield Input(
        "command: figure of garbage",
        ("figure", "fig_3_10", "--cases", "g", "-o", "x.svg"),
        garbage,
        codes=SURE,
    )


def _pipes() -> Iterator[Input]:
    """Readers that have gone, streams that are closed or full."""
    files = {"c.toml": file_of("rod statics", {}), "m.toml": file_of("rod motion", {})}
    solved = "cosserat run c --file c.toml -o c.nc && "
    for line, codes in (
        ("cosserat cases | head -1", (0,)),
        ("cosserat --help | true", (0,)),
        ("cosserat describe rod statics | head -1", (0,)),
        ("cosserat schema | head -c 10", (0,)),
        ("cosserat schema | true", (0,)),
        (f"{solved}cosserat show c.nc | true", (0,)),
        ("cosserat run c --file c.toml | true", (0,)),
        ("cosserat run none --file c.toml 2>&1 | true", (2,)),
        ("cosserat cases > /dev/full", (1, 2)),
        ("cosserat --help > /dev/full", (1, 2)),
        ("cosserat --version > /dev/full", (1, 2)),
        ("cosserat run c --file c.toml > /dev/full", (0, 1, 2)),
        ("cosserat cases >&-", (0, 1, 2)),
        ("cosserat run c --file c.toml >&-", (0, 1, 2)),
        ("cosserat run none 2>&-", (2,)),
        ("cosserat run none 2>/dev/full", (2,)),
        ("cosserat run - <&-", (2,)),
        ("head -c 100000 /dev/urandom | cosserat run -", (2,)),
        ("cosserat run c --file <(cat c.toml)", (0,)),
        ("cosserat run c --file /dev/stdin < c.toml", (0,)),
        ("ulimit -f 4; trap '' XFSZ; cosserat run c --file c.toml", (1, 2)),
        ("ulimit -v 300000; cosserat run c --file c.toml", (1, 2)),
        ("ulimit -n 8; cosserat run c --file c.toml", (0, 1, 2)),
        (
            "HOME=/none TMPDIR=/none MPLCONFIGDIR=/none NUMBA_CACHE_DIR=/proc/none cosserat run c --file c.toml",
            (0,),
        ),
        ("LC_ALL=C PYTHONIOENCODING=ascii cosserat cases", (0,)),
        ("LC_ALL=C PYTHONIOENCODING=ascii cosserat run c --file c.toml", (0,)),
        ("timeout -s INT 0.3 cosserat run c --file m.toml; true", (0,)),
        ("timeout -s TERM 0.3 cosserat run c --file m.toml; true", (0,)),
        ("timeout -s HUP 0.3 cosserat run c --file m.toml; true", (0,)),
    ):
        yield Input(
            f"shell: {line}", shell=f"set -o pipefail; {line}", files=files, codes=codes, alone=True
        )
