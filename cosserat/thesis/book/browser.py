"""The browser of the system, which looks at pages and prints them; none is downloaded."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from typing import TYPE_CHECKING

from cosserat.errors import CosseratError

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")


def find_browser() -> str | None:
    """Where Chromium is, or None."""
    return next((path for path in map(shutil.which, _NAMES) if path), None)


@contextlib.contextmanager
def browser() -> Iterator[Browser]:
    """Chromium without a window and without a network.

    Raises
    ------
    CosseratError : there is none, or it does not start.
    """
    from playwright.sync_api import Error, sync_playwright

    path = find_browser()
    if path is None:
        raise CosseratError("there is no Chromium on this machine; on Debian: apt-get install chromium")
    with sync_playwright() as driver:
        try:
            chromium = driver.chromium.launch(
                executable_path=path, args=["--disable-gpu", "--host-resolver-rules=MAP * ~NOTFOUND"]
            )
        except Error as error:
            raise CosseratError(f"{path} does not start ({error.message.splitlines()[0]})") from None
        try:
            yield chromium
        finally:
            chromium.close()


def settle(page: Page) -> None:
    """Wait until mathematics is set and fonts are there; nothing moves from then on."""
    page.evaluate(
        """async () => {
          const still = document.createElement("style");
          still.textContent = "*, *::before, *::after { transition: none !important; animation: none !important; }";
          document.head.append(still);
          await window.MathJax?.startup?.promise;
          await document.fonts.ready;
          await new Promise((done) => setTimeout(done, 0));
        }"""
    )
