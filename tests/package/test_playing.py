"""The player in a real browser, where one is found: it plays, is steered by keys, and stands still where it should."""

import contextlib
import re
import shutil

import numpy as np
import pytest

from cosserat.figures import player
from cosserat.figures.stage import Line, Mark, Panel, Slider, Stage

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium")


def stage():
    """Eleven states of a line with a gap, of a body on the ground, and of a dot on a curve."""
    time = np.linspace(0, 1, 11)
    x = np.linspace(0, 4, 9)
    wave = np.sin(x + 3 * time[:, None])
    gap = np.where(np.abs(x - 2) < 0.1, np.nan, wave)
    body = Panel(
        (
            Line(x + time[:, None], 0.2 + wave**2, "ink", "body", base=0.0),
            Mark(time, 0 * time, "triangle", "anchor"),
        ),
        "along [m]",
        "height [m]",
        true=True,
        wide=True,
    )
    graph = Panel(
        (Line(x, gap, "variant"), Line(x, wave, closed=True), Mark(time, time**2)),
        "place [m]",
        "wave [1]",
    )
    slider = Slider("time", time, "s", 1)
    return Stage("A wave", "A wave runs along a body.", (body, graph), slider, 0.6, poster=(0, 5))


@pytest.fixture(scope="module")
def chromium():
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "wave.html"
    path.write_text(player.page(stage(), "wave"), encoding="utf-8")
    return path.as_uri()


@pytest.fixture
def opened(chromium, address):
    """A function that opens the page; nothing may be asked of the network or said on the console."""
    with contextlib.ExitStack() as stack:
        said, asked = [], []

        def open_page(**options):
            context = stack.enter_context(contextlib.closing(chromium.new_context(**options)))
            page = context.new_page()
            page.on("console", lambda message: said.append(message.text))
            page.on("pageerror", lambda error: said.append(str(error)))
            page.on("request", lambda request: asked.append(request.url))
            page.goto(address)
            return page

        yield open_page
        assert said == []
        assert set(asked) == {address}


def clock(page):
    return page.locator("output").inner_text()


def test_nothing_plays_by_itself_and_the_button_plays_to_the_end(opened):
    page = opened()
    assert clock(page) == "time 0.5 s"
    page.wait_for_timeout(120)
    assert clock(page) == "time 0.5 s"
    page.locator("button").click()
    assert page.locator("button").inner_text() == "Pause"
    page.wait_for_function("document.querySelector('output').textContent === 'time 1.0 s'", timeout=3000)
    page.wait_for_function("document.querySelector('button').textContent === 'Play'", timeout=3000)
    page.locator("button").click()  # from the end it begins again
    page.wait_for_function("+document.querySelector('input').value < 5", timeout=3000)


def test_every_state_can_be_reached_by_keys(opened):
    page = opened()
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.type") == "range"
    for key, shown in (
        ("Home", "0.0"),
        ("ArrowRight", "0.1"),
        ("ArrowUp", "0.2"),
        ("ArrowLeft", "0.1"),
        ("End", "1.0"),
    ):
        page.keyboard.press(key)
        assert clock(page) == f"time {shown} s"
        assert page.locator("input").get_attribute("aria-valuetext") == f"time {shown} s"
    page.keyboard.press("Space")
    page.wait_for_function("+document.querySelector('input').value < 9", timeout=3000)
    page.keyboard.press("Space")
    assert page.locator("button").inner_text() == "Play"


def test_the_script_draws_the_shapes_that_the_poster_has(opened):
    """At the last state of the poster: path by path, within the tenth of a pixel to which both are rounded."""
    page = opened()
    for panel in range(2):
        svg = page.locator(f"svg:nth-of-type({panel + 1}):not(.swatch)")
        wanted = svg.locator(".poster g:last-child path").evaluate_all(SHAPES)
        found = svg.locator(".alive path").evaluate_all(SHAPES)
        assert len(wanted) == len(found) > 1
        for one, other in zip(wanted, found, strict=True):
            assert re.sub(r"[-\d.]+", "0", one) == re.sub(r"[-\d.]+", "0", other)
            numbers = [np.array(re.findall(r"-?[\d.]+", text), dtype=float) for text in (one, other)]
            assert np.abs(numbers[0] - numbers[1]).max() < 0.17


SHAPES = (
    "nodes => nodes.map(node => node.getAttribute('d') + ' ' + (node.getAttribute('transform') || ''))"
)


def test_who_wants_no_motion_goes_from_state_to_state(opened):
    page = opened(reduced_motion="reduce")
    assert page.locator("button").inner_text() == "Next"
    page.locator("button").click()
    assert clock(page) == "time 0.6 s"
    page.wait_for_timeout(120)
    assert clock(page) == "time 0.6 s"


def test_without_scripts_and_on_paper_the_poster_is_shown(opened):
    shown = ".poster:visible", ".alive:visible", "p.drawn:visible", ".controls:visible"
    page = opened(java_script_enabled=False)
    assert [page.locator(part).count() for part in shown] == [2, 0, 1, 0]
    assert page.locator("p.drawn").inner_text() == "Drawn: time 0.0 s; time 0.5 s."
    page = opened()
    assert [page.locator(part).count() for part in shown] == [0, 2, 0, 1]
    page.emulate_media(media="print")
    assert [page.locator(part).count() for part in shown] == [2, 0, 1, 0]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_on_a_phone_all_of_it_is_on_the_screen_and_can_be_read(opened, scheme):
    page = opened(viewport={"width": 390, "height": 800}, color_scheme=scheme)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    tall = page.locator("svg:not(.swatch) text").evaluate_all(
        "all => all.map(t => t.getBoundingClientRect().height)"
    )
    assert min(tall) > 9
    colours = page.evaluate(
        "[getComputedStyle(document.querySelector('svg text')).fill, getComputedStyle(document.body).backgroundColor]"
    )
    ink, paper = (sum(map(int, re.findall(r"\d+", colour)[:3])) / 3 for colour in colours)
    assert (ink > 180 and paper < 60) if scheme == "dark" else (ink < 60 and paper > 180)
