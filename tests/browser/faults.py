"""`python -m tests.browser.faults` plants a fault of each sort in small pages and says whether the audit finds each.

A mark is in what the audit says of its fault and of nothing else.
"""

from __future__ import annotations

import sys
import tempfile
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from .audit import Fault, audit


@dataclass(frozen=True)
class Planted:
    """A fault of a page."""

    check: str
    mark: str
    html: str
    view: str = ""
    """The only views that have it are named so."""


FRAME = """<!DOCTYPE html>
<html lang="en" data-theme="light"><head><title>Page</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><style>
  body {{ margin: 0; }} article {{ display: block; max-width: 60rem; margin: 0 auto; padding: 1rem; }}
  html {{ color: #111; background: #fff; }} html[data-theme=dark] {{ color: #eee; background: #111; }}
  html[data-theme=dark] a {{ color: #9cf; }}
  mjx-container, mjx-c {{ display: inline-block; }} mjx-container[display] {{ display: block; }}
  @media print {{ html[data-theme] {{ color: #000; background: #fff; }} html[data-theme] a {{ color: #00c; }} }}
</style><script src="mathjax.js"></script></head><body><main><article>{body}</article></main></body></html>"""
HEAD = '<h1 id="top">A page</h1><p>With text and <a href="sound.html#top">a link</a>.</p>'
PICTURE = "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' width='{0}' height='9'/%3E"
SMALL, WIDE = PICTURE.format(9), PICTURE.format(700)
SOUND = f"""{HEAD}<h2>Part</h2>
<div style="overflow-x: auto" tabindex="0">
  <mjx-container display="true"><mjx-c style="width: 500px">x</mjx-c></mjx-container>
</div>
<figure>
  <img alt="A rod bends towards its tip, the more the longer it is." src="{SMALL}">
  <figcaption><b>Rods.</b> Two rods.</figcaption>
</figure>
<table class="rows"><thead><tr><th scope="col">row</th></tr></thead><tr><td>1</td></tr></table>
<pre>code</pre><button>play</button><label>time <input type="range"></label>
<details><summary>more</summary>text</details>
<svg role="img" aria-label="A black box that holds a white word, drawn in the page itself." width="90" height="30">
<rect width="90" height="30" fill="#000"/><text x="5" y="20" fill="#fff">word</text></svg>"""
"""What looks like a fault and is none."""


def equation(mark: str, box: str, width: int = 1500) -> str:
    return (
        f'<div style="{box}" tabindex="0"><mjx-container id="{mark}" display="true">'
        f'<mjx-c style="width: {width}px">x</mjx-c></mjx-container></div>'
    )


def picture(mark: str, alternative: str, caption: str = "") -> str:
    return f'<figure><img id="{mark}" {alternative} src="{SMALL}"><figcaption>{caption}</figcaption></figure>'


BOX = '<div id="{0}" style="{1}">words and words</div>'
PLANTED = (
    Planted(
        "equations",
        "#left",
        equation("left", "overflow: hidden; display: flex; justify-content: center"),
    ),
    Planted("equations", "#clipped", equation("clipped", "overflow: hidden", 400), "390"),
    Planted("equations", "#scrolled", equation("scrolled", "overflow-x: auto")),
    Planted(
        "equations",
        "#centred",
        equation("centred", "overflow: auto; display: flex; justify-content: center"),
    ),
    Planted("equations", "#paper", equation("paper", "overflow-x: auto", 800)),
    Planted("mathematics", "#dollars", r'<p id="dollars">the angle $\theta_1$</p>'),
    Planted("mathematics", "#command", r'<p id="command">the angle \theta</p>'),
    Planted("mathematics", "#bold", '<p id="bold">a **word**</p>'),
    Planted(
        "mathematics",
        "#merror",
        '<mjx-container id="merror"><mjx-merror><mjx-c>x</mjx-c></mjx-merror></mjx-container>',
    ),
    Planted("columns", "wider than the window", ""),
    Planted("columns", "#broad", BOX.format("broad", "width: 1000px")),
    Planted(
        "columns",
        "#phone",
        f'<img id="phone" alt="A picture that is wider than a phone is broad." src="{WIDE}">',
    ),
    Planted("columns", "#cut", BOX.format("cut", "width: 60px; overflow: hidden; white-space: nowrap")),
    Planted(
        "columns",
        "#long",
        '<pre id="long" tabindex="0" style="overflow-x: auto">' + "x" * 400 + "</pre>",
    ),
    Planted("columns", "#unbroken", '<p id="unbroken">' + "x" * 400 + "</p>"),
    Planted(
        "words",
        "#narrow",
        '<table><tr><td id="narrow" style="display: block; width: 20px; overflow-wrap: anywhere">claimed'
        "</td></tr></table>",
    ),
    Planted("contrast", "#pale", BOX.format("pale", "color: #999")),
    Planted("contrast", "#caption", BOX.format("caption", "color: #111"), "dark"),
    Planted("contrast", "#faded", BOX.format("faded", "opacity: 0.4")),
    Planted("contrast", "#ground", BOX.format("ground", "background: #777; color: #333")),
    Planted(
        "contrast",
        "#svgword",
        '<svg width="90" height="30" role="img" aria-label="A word in black on a box that is nearly black.">'
        '<rect width="90" height="30" fill="#111"/><text id="svgword" x="5" y="20" fill="#333">word</text></svg>',
    ),
    Planted(
        "contrast",
        "#hint",
        '<input id="hint" placeholder="a hint" style="background: #fff">'
        "<style>#hint::placeholder { color: #bbb }</style>",
    ),
    Planted(
        "contrast",
        "#ink",
        '<p id="ink">text</p><style>@media print { html[data-theme=dark] #ink { color: #ddd } }</style>',
        "paper dark",
    ),
    Planted(
        "requests",
        "example.org/x.png",
        '<img alt="A picture that another machine would have to send." src="https://example.org/x.png">',
    ),
    Planted("requests", "example.org/x.css", '<link rel="stylesheet" href="http://example.org/x.css">'),
    Planted("requests", "missing.js", '<script src="missing.js"></script>'),
    Planted("console", "an error", '<script>console.error("an error")</script>'),
    Planted("console", "a warning", '<script>console.warn("a warning")</script>'),
    Planted("console", "thrown", '<script>throw new Error("thrown")</script>'),
    Planted("anchors", "'nowhere.html'", '<a href="nowhere.html">a page</a>'),
    Planted("anchors", "'#nothing'", '<a href="#nothing">an anchor here</a>'),
    Planted("anchors", "'sound.html#nothing'", '<a href="sound.html#nothing">an anchor there</a>'),
    Planted("anchors", "a second 'twice'", '<p id="twice">one</p><p id="twice">two</p>'),
    Planted("figures", "#none", picture("none", "")),
    Planted(
        "figures",
        "#title",
        picture(
            "title",
            'alt="Fig. 2: rods that bend under load"',
            "<b>Fig. 2: rods that bend under load.</b> Text.",
        ),
    ),
    Planted(
        "figures",
        "#says",
        picture(
            "says",
            'alt="The tip sinks with the load, then rises."',
            "<b>Rods.</b> The tip sinks with the load, then rises.",
        ),
    ),
    Planted("figures", "#short", picture("short", 'alt="a rod"')),
    Planted("figures", "#one", picture("one", 'alt="The same words stand for two pictures."')),
    Planted("figures", "#other", picture("other", 'alt="The same words stand for two pictures."')),
    Planted("controls", "#clicked", '<div id="clicked" onclick="0">play</div>'),
    Planted("controls", "#skipped", '<button id="skipped" tabindex="-1">play</button>'),
    Planted("controls", "#first", '<button id="first" tabindex="3">play</button>'),
    Planted("controls", "#nameless", '<button id="nameless" class="n"></button>'),
    Planted(
        "controls", "#unfocused", '<button id="unfocused" class="u" style="outline: none">play</button>'
    ),
    Planted(
        "controls",
        "#trap",
        '<button id="trap" class="t" onkeydown="event.preventDefault()">play</button>',
    ),
    Planted(
        "controls",
        "#box",
        '<div id="box" style="overflow-x: auto"><p style="width: 500px">wide</p></div>',
        "390",
    ),
    Planted("headings", "#deep", '<h4 id="deep">Deep</h4>'),
    Planted("headings", "#again", '<h1 id="again">Again</h1>'),
    Planted(
        "tables", "#head", '<table class="rows"><thead><tr><th id="head">row</th></tr></thead></table>'
    ),
)


def write(folder: Path) -> None:
    """A page without a fault, and one for each check with all faults of its sort."""
    bodies = defaultdict(lambda: HEAD)
    bodies["sound"] = SOUND
    for planted in PLANTED:
        bodies[planted.check] += planted.html
    for name, body in bodies.items():
        (folder / f"{name}.html").write_text(FRAME.format(body=body), encoding="utf-8")
    (folder / "mathjax.js").write_text("", encoding="utf-8")


def missed(faults: list[Fault]) -> list[str]:
    """Planted faults that were not found, and found ones that were not planted, as lines."""
    lines = []
    for planted in PLANTED:
        views = [one.view for one in faults if one.check == planted.check and marks(planted, one)]
        if not views:
            lines.append(f"{planted.check} {planted.mark}: not found")
        elif not all(planted.view in view for view in views):
            lines.append(f"{planted.check} {planted.mark}: found in {', '.join(views)}")
    for one in faults:
        known = any(planted.check == one.check and marks(planted, one) for planted in PLANTED)
        if not known and one.page in (
            "sound.html",
            f"{one.check}.html",
        ):  # one fault may be another one too
            lines.append(f"{one.page}, {one.view}, {one.check}: {one.element}: {one.text}: not planted")
    return lines


def marks(planted: Planted, found: Fault) -> bool:
    return found.page == f"{planted.check}.html" and planted.mark in f"{found.element} {found.text}"


def main() -> int:
    with tempfile.TemporaryDirectory() as scratch:
        write(Path(scratch))
        found = audit(Path(scratch), processes=1)
    lines = missed(found.faults)
    for planted in PLANTED:
        caught = not any(line.startswith(f"{planted.check} {planted.mark}") for line in lines)
        print(f"{planted.check:12} {planted.mark:24} {'caught' if caught else 'MISSED'}")
    print(*lines, sep="\n")
    print(f"{len(PLANTED)} planted, {len(lines)} lines of complaint")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
