"""What a player shows is what is stored: its numbers, its gaps, its drawings, its size and its texts."""

import gzip
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

import cosserat
from cosserat.figures import player
from cosserat.figures.drawing import Frame, ticks
from cosserat.figures.stage import LOOKS, Line, Mark, Panel, Slider, Stage
from cosserat.publications import kinds
from cosserat.thesis.figures.explored import EXPLORED
from cosserat.thesis.figures.played import PLAYED


def moving_parts(stage):
    """Each part that moves, with the frame of its panel."""
    return [(part, Frame.of(panel)) for panel in stage.panels for part in panel.parts if part.moves]


def staged(solved, name):
    if name in EXPLORED:
        return EXPLORED[name].stage({study: solved[study] for study in EXPLORED[name].studies})
    return PLAYED[name].stage({case: solved[case] for case in PLAYED[name].cases})


def assert_travels(stage):
    """All that moves is in the page within half a step, which is a sixteenth of a pixel; returns the fields."""
    said = player.states(stage)
    parts = moving_parts(stage)
    assert len(said["parts"]) == len(parts)
    for travels, (part, frame) in zip(said["parts"], parts, strict=True):
        scales = frame.map[1], frame.map[3]
        for axis, scale in zip("xy", scales, strict=True):
            field, values = said["fields"][travels[axis]], getattr(part, axis)
            shown = player.unpacked(field)
            assert abs(scale) * field["step"] < 1 / 5
            assert shown.size == values.size
            np.testing.assert_array_equal(np.isnan(shown), np.isnan(values.ravel()))
            np.testing.assert_allclose(shown, values.ravel(), rtol=0, atol=0.5001 * field["step"])
    return said


@pytest.mark.parametrize("name", [*PLAYED, *EXPLORED])
def test_what_the_book_plays_and_explores_travels_within_a_sixteenth_of_a_pixel(solved, name):
    assert_travels(staged(solved, name))


def test_a_worm_in_a_page_is_the_stored_worm_and_is_small(solved):
    run, stage = solved["worm"], staged(solved, "play_worm")
    said, body = assert_travels(stage), stage.panels[0].parts[1]
    times = np.searchsorted(run.time, stage.slider.values)
    sections = np.linspace(0, run.sizes["section"] - 1, body.x.shape[1]).round().astype(int)
    field = said["fields"][said["parts"][0]["x"]]
    along = player.unpacked(field).reshape(body.x.shape)
    stored = 1e2 * run.along.to_numpy()[np.ix_(times, sections)]
    assert np.abs(along - stored).max() <= 0.5001 * field["step"]
    text = player.figure(stage, "worm").encode()
    assert len(text) < 300_000
    assert len(gzip.compress(text)) < 50_000


def test_the_same_data_give_the_same_text_and_an_array_travels_once(solved):
    first, second = (player.figure(staged(solved, "play_robot"), "x") for _ in range(2))
    assert first == second
    said = player.states(staged(solved, "play_robot"))
    numbers = [part["x"] for part in said["parts"]]
    assert numbers[0] == numbers[1], "the body and its advancing part have the same places"


def small(**changes):
    time = np.linspace(0, 2, 5)
    y = np.outer(time, [1.0, np.nan, 3.0])
    parts = (
        Line(np.array([0.0, 1.0, 2.0]), y, base=0.0, fill="body", label="a & b"),
        Mark(time, np.where(time > 1, time, np.nan), "triangle"),
    )
    panel = Panel(parts, "along [m]", "height [m]")
    return replace(Stage("<b>", 'a "quote"', (panel,), Slider("time", time, "s")), **changes)


def test_a_gap_stays_a_gap_and_a_lone_point_is_closed_down_to_its_base():
    said = assert_travels(small())
    shown = player.unpacked(said["fields"][said["parts"][0]["y"]]).reshape(5, 3)
    assert np.isnan(shown[:, 1]).all()
    drawn = player.figure(small(), "x")
    poster = drawn.split('class="poster"')[1].split("</svg>")[0]
    assert poster.split('class="alive"')[0].count("Z") == 3  # two runs, and the triangle


def test_texts_are_no_markup_and_a_page_is_well_formed():
    text = player.figure(small(title="</script><b>"), "x<", "plain")
    assert 'id="x&lt;"' in text
    assert 'aria-label="a &quot;quote&quot;"' in text
    assert "a &amp; b" in text
    page = player.page(small(title="</script><b>"), "</title>")
    assert page.count("</script>") == 2
    for drawing in re.findall(r"<svg.*?</svg>", text):
        ElementTree.fromstring(drawing.replace(" data-part/>", "/>"))
    slider = Slider("</script>", np.arange(5.0), "s")
    assert player.figure(small(slider=slider), "x").count("</script>") == 1


def test_an_axis_without_a_unit_and_a_wrong_number_of_states_are_refused():
    with pytest.raises(ValueError, match="the axis 'height' of a panel names no unit; end it as in"):
        Panel((), "time [s]", "height")
    with pytest.raises(ValueError, match="has 5 states and the slider 4; give as many"):
        small(slider=Slider("time", np.arange(4.0), "s"))


@pytest.mark.parametrize("kind", [name for name, entry in kinds().items() if entry.animate])
def test_a_stage_of_any_kind_has_text_for_those_who_do_not_see_it(kind, solved):
    from conftest import case_of_kind

    stage = cosserat.animate(solved[case_of_kind(kind).name], frames=7)
    assert_travels(stage)
    assert len(stage.alt) > 60
    assert stage.alt != stage.title
    assert stage.slider.spoken(0) != stage.slider.spoken(1)
    assert "data-player" in stage._repr_html_()
    named = {
        name
        for panel in stage.panels
        for part in panel.parts
        for name in (part.look, getattr(part, "fill", ""))
    }
    assert named <= {*LOOKS, ""}


@pytest.mark.parametrize(
    ("low", "high", "texts"),
    [
        (-0.05, 1.05, ["0.0", "0.5", "1.0"]),
        (-7.0, 7.0, ["−5", "0", "5"]),
        (2e-7, 9e-7, ["5e−7"]),
    ],
)
def test_ticks_are_round_numbers(low, high, texts):
    found = ticks(low, high, 3)
    assert [text for _, text in found][-len(texts) :] == texts
    assert all(low <= value <= high for value, _ in found)
