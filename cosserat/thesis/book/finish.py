"""Last touches on a built book: what no page needs goes, pictures become files, heads of tables say what they head.

Lines break where a reader expects it: after a slash, a point or an underscore in a name of the code, and never between
mathematics and the comma that follows it.
"""

from __future__ import annotations

import base64
import hashlib
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
_PICTURE = re.compile(r'src="data:image/svg\+xml;base64,([A-Za-z0-9+/=]+)"')
_CODE = re.compile(r"(<code[^>]*>)(.*?)(?=</code>)", re.DOTALL)
_BREAK = re.compile(r"(?<=[\w\]])([/_.])(?=[A-Za-z])(?!py\b)(?![^<]*>)")
_KEPT = re.compile(
    r"""[(\[“"]*<span class="math notranslate nohighlight">\\\([^<]*\\\)</span>[^\s<—–-]{1,12}"""
)
_LINES = re.compile(r'(?<=\s)(d|x|y|points)="([^"]*)"')


def finish(built: Path) -> None:
    """Remove files that are not used from a built book, and mend its pages."""
    for folder in _FOLDERS:
        shutil.rmtree(built / folder, ignore_errors=True)
    for file in (*(built / name for name in _FILES), *(built / "_static").rglob("*.map")):
        file.unlink(missing_ok=True)
    for file in built.rglob("*.html"):
        page = file.read_text(encoding="utf-8")
        page = with_breaks(_HEAD.sub(r'<th scope="col" \1>', _SCRIPT.sub("", page)))
        file.write_text(_PICTURE.sub(lambda found: _as_file(found, built), page), encoding="utf-8")
    for file in (built / "_static").rglob("*.[cj]s*"):
        if file.suffix in (".css", ".js"):
            text = file.read_text(encoding="utf-8")
            short = re.sub(r"\n?(?://|/\*)# sourceMappingURL=\S+(?: ?\*/)?\s*$", "\n", text)
            if short != text:
                file.write_text(short, encoding="utf-8")


def with_breaks(page: str) -> str:
    """A page whose lines break inside long names of the code, but not beside mathematics."""
    page = _CODE.sub(lambda code: code[1] + _BREAK.sub(r"\1<wbr>", code[2]), page)
    return _KEPT.sub(r'<span class="kept">\g<0></span>', page)


def _as_file(found: re.Match[str], built: Path) -> str:
    """A picture of a page as a file beside the pages, which is a third smaller, and short."""
    picture = short(base64.b64decode(found[1]).decode()).encode()
    file = built / "_images" / f"{hashlib.sha256(picture).hexdigest()[:16]}.svg"
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(picture)
    return f'src="_images/{file.name}"'


def short(picture: str) -> str:
    """A drawing with its coordinates rounded to 0.01 pt, which no eye sees, and without its description."""

    def rounded(found: re.Match[str]) -> str:
        text = re.sub(
            r"-?\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}".rstrip("0").rstrip("."), found[2]
        )
        return f'{found[1]}="{" ".join(text.split())}"'

    picture = re.sub(r"<metadata>.*?</metadata>", "", picture, flags=re.DOTALL)
    return re.sub(r">\s+<", "><", _LINES.sub(rounded, picture))
