"""What a command is given, how it ended, and whether that is what the README promises: one sentence and a code."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

LIMIT = 12.0
"""Seconds after which an input counts as endless, unless it shows progress; the first line of it comes after six."""
REFUSAL = 2.0
"""Seconds of CPU within which bad input is refused, after the start-up."""
LONGEST = 600
"""Most characters of a sentence."""

OWN_FAULT = "this is a fault of cosserat"
"""What a sentence says where the package is wrong and no input is."""
_PROGRESS = re.compile(r"^(?!cosserat: |warning: )[A-Za-z][\w-]*: ")
_WARNING = re.compile(r"\b\w*Warning\b: ")
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")


@dataclass(frozen=True)
class Input:
    """One command with its files.

    name : what is wrong with it; what stands before the colon is its class.
    arguments : the words behind `cosserat`.
    files : names and contents of the files that it finds; `links`, symbolic links and their targets.
    stdin : what it reads from standard input.
    codes : exit codes that are as promised.
    alone : whether it needs an interpreter of its own; then `shell` may join it with other programs.
    before : commands that come before it and are not judged.
    common : whether it stands for others like it, which only the whole corpus has.
    """

    name: str
    arguments: tuple[str, ...] = ()
    files: dict[str, bytes] = field(default_factory=dict)
    links: dict[str, str] = field(default_factory=dict)
    stdin: bytes = b""
    codes: tuple[int, ...] = (0, 1, 2)
    alone: bool = False
    shell: str = ""
    before: tuple[tuple[str, ...], ...] = ()
    common: bool = True

    @property
    def reproduction(self) -> str:
        """The files and the command, for a person; long ones shortened."""
        said = " ".join(
            [self.shell, *self.arguments, *(word for words in self.before for word in words)]
        )
        said += "".join(content.decode(errors="replace") for content in self.files.values())
        lines = [f"{name}: {_short(content)}" for name, content in self.files.items() if name in said]
        lines += [f"{name} -> {target}" for name, target in self.links.items() if name in said]
        lines += [f"stdin: {_short(self.stdin)}"] if self.stdin else []
        commands = [
            f"cosserat {' '.join(map(_quoted, words))}" for words in (*self.before, self.arguments)
        ]
        return "\n".join([*lines, *([self.shell] if self.shell else commands)])


def _short(content: bytes) -> str:
    try:
        text = content.decode()
    except UnicodeDecodeError:
        return f"{len(content)} bytes that begin with {content[:30]!r}"
    return (
        text.strip()
        if len(text) <= 500
        else f"{text[:200]} ... ({len(text)} characters) ... {text[-60:]}"
    )


def _quoted(word: str) -> str:
    word = word if len(word) <= 80 else f"{word[:60]}...({len(word)})"
    return word if re.fullmatch(r"[\w./-]+", word) else repr(word)


@dataclass(frozen=True)
class Outcome:
    """How a command ended.

    code : the exit code; None if it never ended, or by an exception.
    raised : the traceback that left `main`, and `where`, its exception and its last line in the package.
    added, changed : files that it left and that were not there, or that were there before and are no longer the same.
    wrong : faults of the result that it wrote.
    """

    code: int | None = None
    out: str = ""
    err: str = ""
    cpu: float = 0.0
    raised: str = ""
    where: str = ""
    added: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    wrong: tuple[str, ...] = ()


def faults(given: Input, ended: Outcome) -> list[str]:
    """Everything that is not as promised, each as "class" or "class: particulars"; empty if all is well."""
    if ended.where in ("no end", "no worker"):
        return _unended(ended)
    if ended.raised:
        return [f"traceback: {ended.where}"]
    found = []
    if ended.code not in given.codes:
        found.append(f"exit code: {ended.code}, not {' or '.join(map(str, given.codes))}")
    found += _spoken(ended) if "2>" not in given.shell else []
    written = ["c.nc"] if given.shell or ended.code == 0 else []  # perhaps nobody reads what it says
    written += given.links.values() if ended.code == 0 else []  # a link is followed
    kept = "c.study/" if ended.code in (0, 1) else "\0"  # of a study
    left = [
        name
        for name in ended.added
        if name not in written and not f"{name}/".startswith(kept) and not _promised(name, ended)
    ]
    found += [f"file left: {_named(name)}" for name in left]
    found += [f"file changed: {_named(name)}" for name in ended.changed if not _promised(name, ended)]
    found += ended.wrong
    if ended.code == 2 and ended.cpu > REFUSAL:
        found.append("slow refusal")
    return found


def pattern_of(sentence: str) -> str:
    """The beginning of a sentence, without what it quotes."""
    return re.sub(r"'[^']*'|\"[^\"]*\"|\d+|'.*", "..", sentence)[:60]


def _unended(ended: Outcome) -> list[str]:
    if ended.where == "no worker":
        return [f"crash: {ended.raised}"]
    shows = any(_PROGRESS.search(line) for line in ended.err.splitlines())
    return [] if shows else [f"endless: no end in {LIMIT:g} s, and no progress"]


def _named(file: str) -> str:
    """A file without what differs from run to run."""
    return re.sub(r"\d+", "N", file)


def _promised(file: str, ended: Outcome) -> bool:
    """Whether the command said that it leaves this file, or a folder that holds it."""
    said = ended.out + ended.err
    parts = file.split("/")
    names = ["/".join(parts[: n + 1]) for n in range(len(parts))]
    return any(name.replace(".frames", ".pvd") in said for name in names)


def _spoken(ended: Outcome) -> list[str]:
    """Faults of what a command says."""
    found = []
    lines = [line for line in re.split(r"[\n\r]", ended.err) if line.strip()]
    if "Traceback (most recent call last)" in ended.err:
        found.append(f"traceback printed: {lines[-1][:80]}")
    elif leaked := [
        line for line in lines if _WARNING.search(line) and not line.startswith("warning: ")
    ]:
        place, _, said = leaked[0].partition("Warning: ")
        found.append(f"warning leaked: {place.rpartition('/')[2]}{said[:60]}")
    else:
        found += _sentence(ended.code, lines)
    if OWN_FAULT in ended.err:
        found.append(f"own fault: {ended.err.partition(' failed')[0][-40:]}")
    spoken = ended.out + ended.err.replace("\r", "")
    if control := _CONTROL.search(spoken):
        found.append(f"control character: U+{ord(control[0]):04X}")
    return found


def _sentence(code: int | None, lines: list[str]) -> list[str]:
    other = [line for line in lines if not (line.startswith("warning: ") or _PROGRESS.search(line))]
    if code == 0:
        other = [line for line in other if not line.startswith("cosserat: ")]  # of a command in a pipe
        return [f"noise: {other[0][:80]}"] if other else []
    ours = [line for line in lines if line.startswith("cosserat: ")]
    if lines and (
        usage := re.match(r"cosserat (\w+ )?[\w ]*: error: (?:argument \S+ )?([\w ]+)", lines[-1])
    ):
        return [f"no sentence but argparse's: {usage[2][:40]}"]
    if not ours:
        return [f"no sentence: {lines[-1][:60] if lines else 'nothing is said'}"]
    found = [f"long sentence: {pattern_of(line)}" for line in ours if len(line) > LONGEST]
    strange = [line for line in other if line not in ours]
    if len(ours) > 1 or strange:
        found.append(f"several lines: {(strange or ours)[0][:80]}")
    return found
