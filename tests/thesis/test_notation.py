"""The notation: no symbol is used before the page that defines it, and names and units are those of the code."""

import re

import pytest
from conftest import ROOT

from cosserat.thesis.book import notation, page
from cosserat.thesis.book.symbols import Atom, atom, atoms, formulas, paragraphs

REFERENCE = {
    "notation",
    "conventions",
    "case_keys",
    "command_line",
    "python_api",
    "results_table",
    "errata",
    "equations",
    "left_out",
    "reliability",
    "references",
}
"""Pages for looking up, on which a symbol is not used."""
AROUND = 3  # paragraphs before and behind the first use in which its meaning is told


def reading_order():
    """Chapters as the tables of contents of the first page list them."""
    text = (ROOT / "chapters" / "index.py").read_text()
    listed = re.findall(r"^# ```\{toctree\}\n((?:#.*\n)*?)# ```", text, flags=re.MULTILINE)
    return [
        name for block in listed for name in re.findall(r"^# ([a-z]\w+)$", block, flags=re.MULTILINE)
    ]


ORDER = [name for name in reading_order() if name not in REFERENCE]
TEXTS = [(name, paragraphs((ROOT / "chapters" / f"{name}.py").read_text())) for name in ORDER]


def too_early(texts):
    """Symbols whose first use is on a page before the one that defines their first meaning."""
    used = notation.first_uses(texts)
    first = {}
    for symbol in notation.symbols():
        first.setdefault(symbol.symbol, symbol.page)
    order = [name for name, _ in texts]
    return [
        f"{symbol} of {defined} on {used[symbol][0]}"
        for symbol, defined in first.items()
        if symbol in used and order.index(used[symbol][0]) < order.index(defined)
    ]


def test_no_symbol_is_used_before_the_page_that_defines_it():
    assert too_early(TEXTS) == []


def test_a_use_that_is_too_early_is_noticed():
    first, text = TEXTS[0]
    assert too_early([(first, [*text, r"Let $\xi_A$ be"]), *TEXTS[1:]]) == [
        r"\xi_A of ch2_peristalsis on " + first
    ]


def words_of(meaning):
    passed = {"second", "first", "with", "along", "that", "body", "rest", "same"}
    return [word[:5] for word in re.findall(r"[a-zé']{4,}", meaning.lower()) if word not in passed]


@pytest.mark.parametrize(
    "symbol", notation.symbols(), ids=lambda symbol: f"{symbol.page}-{symbol.symbol}"
)
def test_a_symbol_is_explained_where_its_page_uses_it_first(symbol):
    text = dict(TEXTS)[symbol.page]
    uses = [
        place
        for place, paragraph in enumerate(text)
        if any(symbol.atom.names(used) for formula in formulas(paragraph) for used in atoms(formula))
    ]
    assert uses, "its page does not use it"
    near = " ".join(text[max(0, uses[0] - AROUND) : uses[0] + AROUND + 1]).lower()
    near = re.sub(r"\$[^$]*\$", " ", near)
    assert any(word in near for word in words_of(symbol.meaning)), (
        f"none of {words_of(symbol.meaning)} near it"
    )


@pytest.mark.parametrize(
    ("symbol", "names"),
    [
        (r"\mu_i", {"mu_1", "mu_2", "mu_3"}),
        (r"{}_K \mu", {"mu"}),
        (r"\bar{D}", {"loads.anchoring", "muscle_force"}),
        ("c_i", {"rod.calibration.c1", "rod.calibration.c7"}),
        ("{}_K k_i", set()),
    ],
)
def test_symbols_have_their_names_in_the_code(symbol, names):
    (mine,) = (item for item in notation.symbols() if item.symbol == symbol)
    found = {item.name for item in notation.declared() if notation.meant(mine, item)}
    assert names <= found if names else not found


def test_a_name_of_another_unit_or_chapter_is_another_symbol():
    mine = notation.Symbol("E", "modulus", "Pa", "2.6.3", "page")
    known = notation.Declared("young", "E", "modulus", "Pa", "2.6.17")
    assert notation.meant(mine, known)
    for changes in ({"unit": "N"}, {"equation": "3.5.5"}, {"symbol": "EI"}, {"symbol": "E_1"}):
        assert not notation.meant(mine, notation.Declared(**{**vars(known), **changes}))


def test_every_symbol_of_the_code_is_on_the_page():
    shown = page.notation().data + page.other_symbols().data
    assert len(notation.declared()) > 100
    shown_names = set(re.findall(r"<code>([^<]+)</code>", shown))
    hidden = [item for item in notation.declared() if item.name not in shown_names]
    assert {item.symbol for item in hidden} <= {
        item.symbol for item in notation.declared() if item.name in shown_names
    }


def test_equations_of_the_notation_are_of_the_thesis():
    for symbol in notation.symbols():
        assert re.fullmatch(r"[123]\.\d\.\d{1,2}|section \d\.\d|", symbol.equation), symbol


def test_letters_with_several_meanings_are_listed():
    shown = page.several_meanings().data
    for letter in (r"\mu", r"\lambda", "D", "k", "z", "W"):
        assert (
            rf"<td><span class=\"math notranslate nohighlight\">\({letter}\)</span></td>".replace(
                '\\"', '"'
            )
            in shown
        )


@pytest.mark.parametrize(
    ("formula", "found"),
    [
        (
            r"\mathbf{d}_\alpha \cdot \mathbf{d}'_{\beta}",
            [(False, r"\mathbf{d}", r"\alpha"), (False, r"\mathbf{d}", r"\beta")],
        ),
        (r"{}_K\mu^2 + {}^K \mathbf{e}", [(True, r"\mu", ""), (True, r"\mathbf{e}", "")]),
        (
            r"\hat\mu_3 = \bar{D} p_{coelom}",
            [(False, r"\hat{\mu}", "3"), (False, r"\bar{D}", ""), (False, "p", "coelom")],
        ),
        (r"\tag{1.2.3} \cosh x", [(False, "x", "")]),
    ],
)
def test_symbols_of_a_formula(formula, found):
    assert list(atoms(formula)) == [Atom(*parts) for parts in found]


@pytest.mark.parametrize(
    ("symbol", "used", "same"),
    [
        (r"\mathbf{d}_i", r"\mathbf{d}_\alpha", True),
        (r"\mathbf{d}_i", r"{}_K\mathbf{d}", False),
        (r"\mu", r"\mu_1", False),
        (r"\mu", r"\mu^2", True),
        ("k_S", "k_P", False),
        (r"\kappa_{\alpha i}", r"\kappa_{13}", True),
    ],
)
def test_a_letter_as_index_stands_for_any(symbol, used, same):
    assert atom(symbol).names(atom(used)) is same
