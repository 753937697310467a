"""The commands of the command line with their options, from the parser that reads them."""

from __future__ import annotations

import argparse
import pkgutil
from html import escape

from IPython.display import HTML

_PARSER = "cosserat.cli:parser_of_commands"
"""By its name, as a chapter names what it shows: the command line imports the thesis, not the other way round."""
_HIDDEN = ("help", "command")


def commands() -> HTML:
    """Every command with what it does, its arguments and options with their defaults, and its examples."""
    return HTML("".join(_command(name, parser) for name, parser in parsers().items()))


def parsers() -> dict[str, argparse.ArgumentParser]:
    """The parser of each command, in the order of `cosserat --help`."""
    actions = pkgutil.resolve_name(_PARSER)()._actions
    (found,) = (action for action in actions if isinstance(action, argparse._SubParsersAction))
    return dict(found.choices)


def _command(name: str, parser: argparse.ArgumentParser) -> str:
    usage = " ".join(parser.format_usage().removeprefix("usage: ").split())
    options = "".join(
        f'<dt id="{name}-{action.dest}"><code>{escape(_written(action))}</code></dt><dd>{_told(parser, action)}</dd>'
        for action in parser._actions
        if action.dest not in _HIDDEN
    )
    more = parser.epilog and (
        f'<pre tabindex="0" class="no-links">{escape(parser.epilog, quote=False)}</pre>'
    )
    return (
        f'<section id="cosserat-{name}"><h2>cosserat {name}</h2><p>{escape(parser.description or "")}</p>'
        f'<p><code>{escape(usage)}</code></p><dl class="keys">{options}</dl>{more or ""}</section>'
    )


def _written(action: argparse.Action) -> str:
    """An option or argument as one writes it."""
    value = action.metavar or (action.dest if not action.option_strings else action.dest.upper())
    value = value if isinstance(value, str) else " ".join(value)
    if action.choices:
        value = "|".join(map(str, action.choices))
    if action.nargs in ("*", "+"):
        value = f"{value} ..."
    names = ", ".join(action.option_strings)
    return " ".join(filter(None, (names, "" if action.nargs == 0 else value)))


def _told(parser: argparse.ArgumentParser, action: argparse.Action) -> str:
    """What an option is, with its default."""
    text = parser._get_formatter()._expand_help(action) if action.help else ""
    needed = "required" if action.required and action.option_strings else ""
    return escape(", ".join(filter(None, (text, needed))), quote=False)
