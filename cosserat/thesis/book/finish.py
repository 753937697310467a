"""Last touches on a built book: what no page needs goes, and heads of tables say what they head."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

_FOLDERS = ("_static/locales",)
"""Translations of the search."""
_FILES = (
    "_static/scripts/fontawesome.js",
    "_static/scripts/fontawesome.js.LICENSE.txt",
    "_static/vendor/fontawesome/webfonts/fa-brands-400.woff2",
    "_static/vendor/fontawesome/webfonts/fa-regular-400.woff2",
    "_static/webpack-macros.html",
    "_static/sbt-webpack-macros.html",
    ".buildinfo",
)
"""The font of icons that is left draws all of them; the script, five times as large, would draw them again."""
_HEAD = re.compile(r'<th (class="head[^"]*")>')
_SCRIPT = re.compile(r'\s*<script defer src="(?:\.\./)?_static/scripts/fontawesome\.js[^"]*"></script>')


def finish(built: Path) -> None:
    """Remove files that are not used from a built book, and mend its pages."""
    for folder in _FOLDERS:
        shutil.rmtree(built / folder, ignore_errors=True)
    for file in (*(built / name for name in _FILES), *(built / "_static").rglob("*.map")):
        file.unlink(missing_ok=True)
    for file in built.rglob("*.html"):
        page = file.read_text(encoding="utf-8")
        file.write_text(_HEAD.sub(r'<th scope="col" \1>', _SCRIPT.sub("", page)), encoding="utf-8")
    for file in (built / "_static").rglob("*.[cj]s*"):
        if file.suffix in (".css", ".js"):
            text = file.read_text(encoding="utf-8")
            short = re.sub(r"\n?(?://|/\*)# sourceMappingURL=\S+(?: ?\*/)?\s*$", "\n", text)
            if short != text:
                file.write_text(short, encoding="utf-8")
