"""A reader's own folder: what a page shows is what was written, run and drawn there."""

import os
from pathlib import Path

import pytest

from cosserat.errors import CosseratError
from cosserat.thesis.book import page

CASE = '[bar]\nlike = "elastica"\nrod.vertices = 5'


@pytest.fixture
def here():
    before = Path.cwd()
    folder = page.Folder.new()
    yield folder
    os.chdir(before)
    folder.home.cleanup()


def test_lines_are_shown_as_they_stand_in_the_file(here):
    shown = here.write("my.toml", CASE).data
    assert f"```toml\n{CASE}\n```" in shown
    shown = here.write("fronts.csv", "time [s], front [cm]").data
    assert "```text\ntime [s], front [cm]\n```" in shown
    assert Path("my.toml").read_text() == f"{CASE}\n"
    assert "rod.vertices = 7" in here.replace("my.toml", "= 5", "= 7").data
    assert Path("my.toml").read_text() == f"{CASE[:-1]}7\n"
    with pytest.raises(CosseratError, match=r"my\.toml has = 5 0 times, not once"):
        here.replace("my.toml", "= 5", "= 9")


def test_a_command_is_shown_with_what_it_prints_and_ends_as_the_page_says(here):
    here.write("my.toml", CASE)
    shown = here.command("cosserat run bar --file my.toml").data.splitlines()
    assert shown[:2] == ["```console", "$ cosserat run bar --file my.toml"]
    assert shown[2].startswith("bar: ")
    assert Path("bar.nc").is_file()
    assert "there is no case 'baz'" in here.command("cosserat run baz --file my.toml", status=2).data
    with pytest.raises(CosseratError, match="ended with 2, not 0: .*there is no case 'baz'"):
        here.command("cosserat run baz --file my.toml")
    assert here.command("cosserat show bar.nc", first=1).data.splitlines()[2:] == [
        "bar: bar",
        "...",
        "```",
    ]


def test_a_picture_of_the_folder_has_its_text(here):
    Path("bar.svg").write_text("<svg/>")
    shown = here.picture("bar.svg", 'a "thick" bar', "Its $u$.").data
    assert 'alt="a &quot;thick&quot; bar"' in shown
    assert "data:image/svg+xml;base64,PHN2Zy8+" in shown
    assert r"\(u\)" in shown
