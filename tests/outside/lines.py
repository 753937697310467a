"""Lines that each case needs, in its words of a former commit and now: `python -m tests.outside --lines`.

What a user writes is counted in `cases.toml` and in the Python that reads the answer; `lines.toml` names both.  A case
counts with all that it inherits.  Comments, blank lines and docstrings do not count, and a line of more than 105
characters counts as several.
"""

import ast
import functools
import re
import subprocess
import tomllib
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
BEFORE = "6883527"
"""The commit before sections, loads, supports and outputs had the words of the field."""
WIDE = 105


class NoHistoryError(Exception):
    """The former commit is not in this copy of the repository."""


@dataclass(frozen=True)
class Files:
    """Text of case files and of Python files."""

    toml: tuple[str, ...]
    python: tuple[str, ...]


@functools.cache
def now():
    cases, python = ("cases.toml", "wishes.toml"), ("checks.py", "cases.py", "motions.py", "wishes.py")
    return Files(*(tuple((HERE / name).read_text() for name in names) for names in (cases, python)))


@functools.cache
def before():
    return Files((_former("cases.toml"),), (_former("cases.py"),))


def _former(name):
    place = f"{BEFORE}:tests/outside/{name}"
    done = subprocess.run(["git", "show", place], cwd=HERE, capture_output=True, text=True, check=False)
    if done.returncode:
        raise NoHistoryError(
            f"git has no {place}; fetch the whole history (git fetch --unshallow) to count lines"
        )
    return done.stdout


def _length(line):
    """Lines of at most 105 characters that it makes; none if it is blank or a comment."""
    code = re.sub(r"\s+# .*|^\s*#.*", "", line).strip()
    return -(-len(code) // WIDE)


def in_toml(files, cases):
    """Lines of cases of one file and of all that they inherit."""
    found = [text for text in files.toml if set(cases) <= set(tomllib.loads(text))]
    if not found:
        raise KeyError(f"no file has the cases {', '.join(cases)}")
    tables, blocks, name = tomllib.loads(found[0]), {}, ""
    for line in found[0].splitlines():
        if heading := re.match(r"\[+(\w+)", line):
            name = heading[1]
        blocks[name] = blocks.get(name, 0) + _length(line)
    needed, asked = set(), list(cases)
    while asked:
        needed.add(case := asked.pop())
        like = tables[case].get("like", [])
        asked += [like] if isinstance(like, str) else like
    return sum(blocks[case] for case in needed)


def in_python(files, beginnings):
    """Lines of the statements, functions among them, that begin with these texts."""
    return sum(_statement(files, beginning) for beginning in beginnings)


def _statement(files, beginning):
    """Lines of the first statement with this beginning; a function counts without its docstring."""
    for text in files.python:
        code = text.splitlines()
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.stmt) and code[node.lineno - 1].strip().startswith(beginning):
                described = isinstance(node, ast.FunctionDef) and ast.get_docstring(node)
                return _lines(code, node) - (_lines(code, node.body[0]) if described else 0)
    raise KeyError(f"no statement begins with {beginning!r}")


def _lines(code, node):
    return sum(map(_length, code[node.lineno - 1 : node.end_lineno]))


def table():
    """Each entry of `lines.toml`."""
    return tomllib.loads((HERE / "lines.toml").read_text())


def count(files, entry):
    """Lines of TOML and of Python."""
    return in_toml(files, entry["toml"]), in_python(files, entry.get("python", []))


def rows():
    """Name, lines before (None if the case could not be said), lines now, and what could not be said."""
    for name, entry in table().items():
        old = count(before(), entry["before"]) if "before" in entry else None
        yield name, old, count(now(), entry["now"]), entry.get("unsaid", "")


def text():
    """The table; a case that could not be said, or not all of it, does not count in the sums."""
    shown = [f"{'':<20}{'lines before':>18}{'lines now':>18}"]
    shown += [f"{'case':<20}{'TOML + Python':>18}{'TOML + Python':>18}  could not be said before"]
    sums = [0, 0]
    for name, old, new, unsaid in rows():
        numbers = [
            "-" if pair is None else f"{pair[0]} + {pair[1]} = {sum(pair)}" for pair in (old, new)
        ]
        shown.append(f"{name:<20}{numbers[0]:>18}{numbers[1]:>18}  {unsaid}".rstrip())
        if old is not None and not unsaid:
            sums = [sums[0] + sum(old), sums[1] + sum(new)]
    return "\n".join([*shown, f"{'those said in full':<20}{sums[0]:>18}{sums[1]:>18}"])
