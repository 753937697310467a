"""The audit of the book in a browser, on small pages; `python -m tests.browser results/book` is the one of the book."""

import pytest

from cosserat.thesis.book import browser
from cosserat.errors import CosseratError
from .audit import audit
from .faults import missed, write
from .__main__ import size

needs_a_browser = pytest.mark.skipif(browser.find_browser() is None, reason="there is no Chromium here")


@needs_a_browser
def test_every_planted_fault_is_found_and_nothing_else(tmp_path):
    write(tmp_path)
    found = audit(tmp_path, processes=1)
    assert missed(found.faults) == []
    assert found.views == 8 * found.pages
    assert min(found.counts.values()) > 0


def test_a_book_of_more_than_its_size_is_a_fault(tmp_path):
    with (tmp_path / "large.html").open("wb") as file:
        file.truncate(16_000_001)
    assert [one.check for one in size(tmp_path)] == ["size"]
    (tmp_path / "large.html").write_text("small")
    assert size(tmp_path) == []


def test_a_machine_without_a_browser_says_what_to_do(monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(CosseratError, match="apt-get install chromium"), browser.browser():
        pass
