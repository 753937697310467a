"""The pages of judgements: every entry of the errata table with its test, and every row of the results table."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Sequence
from html import escape
from pathlib import Path

from IPython.display import HTML

from cosserat.errors import InputError
from cosserat.thesis.book import tables
from cosserat.thesis.book.module_pages import coloured
from cosserat.thesis.book.tables import framed, prose, typeset
from cosserat.thesis.book.verdicts import Row, amount, assumed, errata, report
from cosserat.thesis.book.workflow import results
from cosserat.thesis.table.errata import Erratum

_WORDS = {
    "erratum": "misprint",
    "assumption": "assumption",
    "question": "question",
    "refuted": "no misprint",
}
_COLUMNS = (
    "verdict",
    "quantity",
    "printed text",
    "expected",
    "measured",
    "error / tolerance",
    "kind, standing",
    "row",
)


def errata_list(standing: str) -> HTML:
    """The entries of the errata table with a standing, each with an address and its test.

    Raises
    ------
    InputError : a test that an entry names is not there.
    """
    return HTML("".join(_entry(name, item) for name, item in errata(standing).items()))


def _entry(name: str, item: Erratum) -> str:
    about = f"{name}, {_WORDS[item.standing]}: {item.where.replace('$', '')}"
    lines = (("printed", item.printed), ("used instead", item.corrected), ("why", item.why))
    told = "".join(f"<dt>{word}</dt><dd>{prose(assumed(text))}</dd>" for word, text in lines)
    file, _, test = item.evidence.partition("::")
    code = coloured(_definition(results().parent / file, test.partition("[")[0]))
    return (
        f'<section class="erratum" id="{name}" data-about="{escape(about)}">'
        f'<p><a href="#{name}"><b>{name}</b></a>, {prose(item.where)}</p><dl>{told}</dl>'
        f"<details><summary>its test: <code>{escape(test)}</code> in <code>{file}</code></summary>"
        f'<div class="highlight source"><pre tabindex="0">{code}</pre></div></details></section>'
    )


def _definition(file: Path, name: str) -> str:
    """The lines of a function of a file, with its decorators."""
    try:
        text = file.read_text(encoding="utf-8")
    except OSError:
        raise InputError(f"there is no test {file}; restore it from the repository") from None
    for node in ast.parse(text).body:
        if isinstance(node, ast.FunctionDef) and node.name == name:
            first = min([node.lineno, *(mark.lineno for mark in node.decorator_list)])
            return "\n".join(text.splitlines()[first - 1 : node.end_lineno])
    raise InputError(f"{file} has no test '{name}'; correct the evidence in results/errata.toml")


def results_table() -> HTML:
    """Every attempted row of the report, verdict first, to filter and to sort; reasons fold."""
    attempted = [row for row in report() if row["standing"] != "not attempted"]
    return framed([_line(row) for row in attempted], _COLUMNS, what="rows", foot=total_of(attempted))


def total_of(rows: Sequence[Row]) -> str:
    """How many rows there are, by their verdicts."""
    counts = Counter(row["verdict"] for row in rows)
    told = ", ".join(f"{count} {verdict}" for verdict, count in counts.most_common())
    return f"{len(rows)} rows: {told}"


def _line(row: Row) -> str:
    name, unit = row["id"], row["units"]
    reason = [f"tolerance {row['tolerance']} {row['tolerance_kind']}: {row['why']}"]
    reason += [f"found at {row['found']} ± {row['found_tolerance']}"] if row["found"] else []
    reason += [f"another reading of {row['reading_of']}"] if row["reading_of"] else []
    why = "".join(f"<p>{typeset(text)}.</p>" for text in reason)
    cells = (
        f"{typeset(row['quantity'])} ({typeset(row['where'])})"
        f"<details><summary>tolerance</summary>{why}</details>",
        typeset(row["published"]),
        amount(row["expected"], unit),
        amount(row["measured"], unit),
        f"{float(row['error_over_tolerance']):.2f}",
        " ".join(filter(None, (f"{row['kind']}, {row['standing']}", row["erratum"]))),
        f'<a href="#row-{name}">{name}</a>',
    )
    about = f"{row['quantity']}: {row['verdict']}"
    mark = row["verdict"].partition(",")[0].lower()
    return tables.row(
        cells,
        marks=f'id="row-{name}" data-about="{escape(about)}"',
        head=f'<th scope="row" class="verdict-{mark}">{row["verdict"]}</th>',
    )
