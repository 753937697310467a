"""Extension of Sphinx: styles and scripts that a page loads only if it has what they are for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

_NEEDED = {
    "data-player": ("player.css", "player.js"),
    "data-pull": ("pull.css", "pull.js"),
    'class="filtered"': ("filter.js",),
}
"""Files by the words in the HTML of a page that need them."""


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect the function of this module; Sphinx calls this."""
    app.connect("html-page-context", _add)
    return {"parallel_read_safe": True}


def _add(app: Sphinx, page: str, template: str, context: Mapping[str, Any], doctree: object) -> None:
    """Add what one page needs."""
    for name in needed(context.get("body", "")):
        if name.endswith(".css"):
            app.add_css_file(name)
        else:
            app.add_js_file(name)


def needed(html: str) -> list[str]:
    """The files that the HTML of a page needs."""
    return [name for words, names in _NEEDED.items() if words in html for name in names]
