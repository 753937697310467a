"""`python -m tests.browser.drag results/book` drags the rod of the book with a mouse, a keyboard and a finger.

Each state is compared with `cosserat.run` for the same place of the tip.  The exit code is 1 if one differs by more
than `MOST` or if stored states do not stand in where the module cannot run, 2 if there is no browser.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from pathlib import Path

import numpy as np

import cosserat
from cosserat.errors import CosseratError
from cosserat.export.webassembly import pulled
from cosserat.thesis.book.browser import browser, settle
from cosserat.thesis.book.pulling import LENGTH, STEP, pulled_case

MOST = 1e-9
"""Largest difference, as a fraction of the length of the rod, of the largest force and of the energy."""
FIGURE = "figure[data-pull]"
_VERTICES = 41
_ROOM = f"() => document.querySelector('{FIGURE}').pulled()"


def state(tab):
    """The array of the figure when it has followed."""
    tab.wait_for_function(f"() => !document.querySelector('{FIGURE}').pulled().busy")
    return np.array(tab.evaluate(_ROOM)["room"])


def differences(room):
    """Of the state of the figure and that of `cosserat.run`, as fractions: displacements, force, energy."""
    u = pulled.dofs(room, _VERTICES)
    by_3, by_2 = u[-1, :2]
    found = cosserat.run(pulled_case(float(by_3), float(by_2)))
    expected = np.column_stack([found.u.to_numpy(), found.delta.to_numpy()])
    force = found.support_force.to_numpy()[-1, :2]
    energy = found.energy_parts.to_numpy()[: len(pulled.TERMS)].sum()
    hand = room[[pulled.FORCE_3, pulled.FORCE_2]]
    return (
        np.abs(u - expected).max() / LENGTH,
        np.abs(hand - force).max() / np.abs(force).max(),
        abs(room[pulled.ENERGY] / energy - 1),
    )


def by_mouse(tab, places):
    """Drag the ring through some places, as fractions of the figure, and let it go."""
    box = tab.locator(f"{FIGURE} .stage svg").bounding_box()
    ring = tab.locator(f"{FIGURE} circle.hand").bounding_box()
    tab.mouse.move(ring["x"] + ring["width"] / 2, ring["y"] + ring["height"] / 2)
    tab.mouse.down()
    for x, y in places:
        tab.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"], steps=12)
    tab.mouse.up()


def by_keys(tab, keys):
    """Press keys with the focus on the figure."""
    tab.locator(f"{FIGURE} .stage").focus()
    for key in keys:
        tab.keyboard.press(key)


def by_touch(tab, places):
    """Drag the ring with a finger, which must not move the page under it."""
    box = tab.locator(f"{FIGURE} .stage svg").bounding_box()
    ring = tab.locator(f"{FIGURE} circle.hand").bounding_box()
    way = [(ring["x"] + ring["width"] / 2, ring["y"] + ring["height"] / 2)]
    way += [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in places]
    before = _scrolled(tab)
    touch(tab, way)
    if _scrolled(tab) != before:
        raise CosseratError(
            "a finger on the ring scrolls the page; its touchstart needs preventDefault()"
        )


def touch(tab, way, steps=12):
    """A finger that goes down, moves along a polygon [px] and goes up, as the screen of a phone reports it."""
    session = tab.context.new_cdp_session(tab)

    def report(kind, *points):
        said = {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in points]}
        session.send("Input.dispatchTouchEvent", said)

    report("touchStart", way[0])
    for begin, end in itertools.pairwise(way):
        for share in np.linspace(0, 1, steps + 1)[1:]:
            report("touchMove", tuple((1 - share) * np.array(begin) + share * np.array(end)))
    report("touchEnd")
    session.detach()


def _scrolled(tab):
    return tab.evaluate("() => [scrollX, scrollY]")


WAYS = (
    ("mouse, up and back", by_mouse, [(0.60, 0.25)]),
    ("mouse, pulled long", by_mouse, [(0.90, 0.45)]),
    ("mouse, down", by_mouse, [(0.75, 0.62), (0.65, 0.85)]),
    ("keys, up", by_keys, ["ArrowUp"] * 5),
    ("keys, to the right and down", by_keys, ["Shift+ArrowRight", "ArrowRight", "ArrowDown"]),
)
TOUCHED = (
    ("finger, up and back", by_touch, [(0.60, 0.25)]),
    ("finger, pulled long and down", by_touch, [(0.90, 0.45), (0.75, 0.70)]),
)
DESK = {"viewport": {"width": 1200, "height": 900}}
PHONE = {
    "viewport": {"width": 390, "height": 844},
    "has_touch": True,
    "is_mobile": True,
    "device_scale_factor": 3,
}


def tried(book: Path) -> list[tuple[str, tuple[float, ...]]]:
    """Each way from rest, with the differences of its state."""
    found = []
    with browser() as chromium:
        for screen, ways in ((DESK, WAYS), (PHONE, TOUCHED)):
            tab = chromium.new_page(**screen)
            tab.goto((book / "pull.html").resolve().as_uri())
            tab.wait_for_selector(f"{FIGURE}[data-pull='ready']")
            settle(tab)
            for name, act, what in ways:
                tab.locator(f"{FIGURE} button.reset").click()
                tab.locator(f"{FIGURE} .stage svg").scroll_into_view_if_needed()
                found.append((name, _followed(tab, name, act, what)))
    return found


def _followed(tab, name, act, what):
    """The differences of the state after a rod at rest has been dragged in one way."""
    at_rest = state(tab)
    act(tab, what)
    room = state(tab)
    moved = np.hypot(*(pulled.dofs(room, _VERTICES) - pulled.dofs(at_rest, _VERTICES))[-1, :2])
    if moved < STEP / 2:
        raise CosseratError(f"{name}: the tip has not moved")
    return differences(room)


def stands_in(book: Path) -> list[tuple[str, bool]]:
    """Whether the stored states are seen, and the live figure is not, where the module cannot run."""
    seen = []
    with browser() as chromium:
        for name, scripts, before in (
            ("without scripts", False, ""),
            ("without WebAssembly", True, "delete window.WebAssembly"),
            (
                "with a module that is refused",
                True,
                "WebAssembly.instantiate = async () => { throw Error('no'); }",
            ),
        ):
            tab = chromium.new_context(java_script_enabled=scripts).new_page()
            tab.add_init_script(before)
            tab.goto((book / "pull.html").resolve().as_uri())
            stored = tab.locator(f"{FIGURE} .stored figure.player").is_visible()
            said = tab.locator(f"{FIGURE} .instead").is_visible()
            seen.append((name, stored and said and not tab.locator(f"{FIGURE} .live").is_visible()))
    return seen


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m tests.browser.drag", description=__doc__.split("\n")[0]
    )
    parser.add_argument("book", type=Path, help="folder of the book")
    options = parser.parse_args()
    if not (options.book / "pull.html").is_file():
        parser.error(f"{options.book} has no page pull.html; build the book with 'make'")
    try:
        found, seen = tried(options.book), stands_in(options.book)
    except CosseratError as error:
        print(f"python -m tests.browser.drag: {error}", file=sys.stderr)
        return 2
    for name, each in found:
        words = ", ".join(
            f"{what} {value:.1e}" for what, value in zip(("shape", "force", "energy"), each, strict=True)
        )
        print(f"{name:28} {words}{'' if max(each) <= MOST else '  DIFFERS'}")
    for name, good in seen:
        print(f"{name:28} {'stored states stand in' if good else 'NOTHING STANDS IN'}")
    return 0 if all(max(each) <= MOST for _, each in found) and all(good for _, good in seen) else 1


if __name__ == "__main__":
    sys.exit(main())
