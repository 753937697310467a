"""A reader's own folder in a tutorial: the files, commands and pictures that a page shows are those that it made."""

from __future__ import annotations

import base64
import contextlib
import io
import os
import pkgutil
import shlex
import tempfile
import textwrap
from dataclasses import dataclass
from html import escape
from pathlib import Path

from IPython.display import HTML, Markdown

from cosserat.errors import CosseratError
from cosserat.thesis.book.tables import mathematics

_COLUMNS = 96  # of the terminal that a page shows


@dataclass(frozen=True)
class Folder:
    """An empty folder, which is the working directory from now on."""

    home: tempfile.TemporaryDirectory[str]

    @classmethod
    def new(cls) -> Folder:
        """Make the folder and enter it."""
        folder = cls(tempfile.TemporaryDirectory(prefix="cosserat-"))
        os.chdir(folder.home.name)
        return folder

    def write(self, name: str, text: str) -> Markdown:
        """Add lines to a file, and show them."""
        with (Path(self.home.name) / name).open("a", encoding="utf-8") as file:
            file.write(f"{text.strip()}\n")
        return _listing(name, text.strip())

    def replace(self, name: str, old: str, new: str) -> Markdown:
        """Change a text that stands once in a file, and show its new line.

        Raises
        ------
        CosseratError : the file does not have it exactly once.
        """
        path = Path(self.home.name) / name
        before = path.read_text(encoding="utf-8")
        if before.count(old) != 1:
            raise CosseratError(f"{name} has {old} {before.count(old)} times, not once")
        path.write_text(before.replace(old, new), encoding="utf-8")
        changed = next(line for line in before.splitlines() if old in line).replace(old, new)
        return _listing(name, changed)

    def command(self, line: str, *, status: int = 0, first: int = 0) -> Markdown:
        """Run a line that begins with `cosserat`, and show it with what it prints.

        status : the exit status that the page expects.  first : show only so many lines of the output; 0 shows all.

        Raises
        ------
        CosseratError : it ended with another status.
        """
        _, *arguments = shlex.split(line)
        main = pkgutil.resolve_name(
            "cosserat.cli:main"
        )  # which imports the commands of this publication
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            ended = main(arguments)
        if ended != status:
            raise CosseratError(f"'{line}' ended with {ended}, not {status}: {said.getvalue()}")
        lines = [part for whole in said.getvalue().splitlines() for part in _as_on_a_terminal(whole)]
        shown = [*lines[:first], "..."] if 0 < first < len(lines) else lines
        return Markdown("```console\n" + "\n".join([f"$ {line}", *shown]) + "\n```")

    def picture(self, name: str, alt: str, caption: str) -> HTML:
        """Show an SVG of the folder."""
        drawn = base64.b64encode((Path(self.home.name) / name).read_bytes()).decode()
        image = f'<img alt="{escape(alt)}" src="data:image/svg+xml;base64,{drawn}">'
        text = f"<b>{escape(name)}.</b> {mathematics(caption)}"
        return HTML(f'<figure class="plot drawn">{image}<figcaption>{text}</figcaption></figure>')


def _as_on_a_terminal(line: str) -> list[str]:
    """A line in parts that fit the page."""
    return textwrap.wrap(line, _COLUMNS) or [""]


def _listing(name: str, text: str) -> Markdown:
    """Lines of a file, under its name."""
    language = "toml" if name.endswith(".toml") else "text"
    return Markdown(f"In `{name}`:\n\n```{language}\n{text}\n```")
