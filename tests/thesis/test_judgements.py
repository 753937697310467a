"""The pages of judgements: every row, erratum and equation has an address, and folds say what they hold."""

import html
import re

import pytest
from conftest import ROOT

from cosserat.errors import InputError
from cosserat.thesis.book import equation_list, judgements, page
from cosserat.thesis.book.tables import prose, typeset
from cosserat.thesis.table.citations import places
from cosserat.thesis.table.errata import read_errata
from cosserat.thesis.table.left_out import read_left_out
from cosserat.thesis.table.tolerances import read_report

ERRATA = read_errata(ROOT / "results/errata.toml")
LISTED = read_left_out(ROOT / "results/left_out.toml")


@pytest.fixture(autouse=True)
def report(monkeypatch):
    """The released report, which is there without any run."""
    rows = read_report(ROOT / "results/reference/report.csv")
    for module in (judgements, equation_list):
        monkeypatch.setattr(module, "report", lambda: rows)
    return rows


def plain(text):
    return html.unescape(re.sub(r"<[^>]+>", "", text))


def test_every_erratum_has_an_address_and_its_test():
    shown = "".join(
        page.errata_list(standing).data for standing in ("erratum", "assumption", "question", "refuted")
    )
    assert sorted(re.findall(r'<section class="erratum" id="([^"]+)"', shown)) == sorted(ERRATA)
    for item in ERRATA.values():
        assert f"def {item.evidence.split('::')[1].split('[')[0]}(" in plain(shown)


def test_an_erratum_without_its_test_is_refused(monkeypatch):
    item = ERRATA["E2.5"]
    for evidence in (
        "tests/thesis/test_errata_chapter2.py::test_nothing",
        "tests/none.py::test_nothing",
    ):
        lost = item.replace(evidence=evidence)
        monkeypatch.setattr(judgements, "errata", lambda _, lost=lost: {"E2.5": lost})
        with pytest.raises(InputError, match=r"has no test 'test_nothing'|there is no test"):
            judgements.errata_list("erratum")


def test_texts_of_the_errata_have_their_symbols_as_mathematics():
    outside = re.compile(r"\$[^$]*\$|`[^`]*`")
    for name, item in ERRATA.items():
        for text in (item.where, item.printed, item.corrected, item.why):
            rest = outside.sub("", text)
            assert typeset(rest) == html.escape(rest, quote=False), (name, rest)
            assert "the page" not in rest.lower(), name


def test_every_row_has_an_address_its_verdict_first_and_its_reason_folded(report):
    shown = page.results_table().data
    lines = re.findall(
        r'<tr id="row-([^"]+)" [^>]*><th scope="row" class="verdict-(\w+)">([^<]+)<', shown
    )
    assert [line[0] for line in lines] == [row["id"] for row in report]
    assert {line[1] for line in lines} == {"within", "outside"}
    for row in report:
        assert plain(typeset(row["why"])) in plain(shown)
    assert shown.count("<details>") == len(report)
    counted = re.search(
        r"(\d+) rows: (\d+) outside, as claimed, (\d+) within, (\d+) within, loose", shown
    )
    assert int(counted[1]) == sum(int(counted[k]) for k in (2, 3, 4)) == len(report)


def test_every_equation_that_is_not_left_out_has_a_line_and_the_others_an_address():
    lines = re.findall(r'<tr id="eq-([^"]+)"', page.equations().data)
    others = re.findall(r'<span id="eq-([^"]+)"', page.left_out_table().data)
    assert sorted(lines + others) == sorted(LISTED.numbered.names("equations"))
    assert sorted(others) == sorted(LISTED.names("equations"))
    assert sum(page.counts().values()) == len(lines) + len(others)


def test_an_equation_that_is_nowhere_is_named(monkeypatch):
    found = dict(places(ROOT))
    del found["1.2.96"]
    monkeypatch.setattr(equation_list, "places", lambda _: found)
    with pytest.raises(InputError, match=r"no file has the equations 1\.2\.96; list them"):
        page.equations()


def test_a_line_names_the_functions_that_use_an_equation():
    line = re.search(r'<tr id="eq-1\.2\.96".*?</tr>', page.equations().data)[0]
    assert "lame in cosserat/rods/directed_rod.py" in plain(line)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("from t_p/2", r"from \(t_{p}\)/2"),
        ("mu_1 of nu", r"\(\mu_{1}\) of \(\nu\)"),
        ("Kc3 = 1, c4", r"\({}_K c_3\) = 1, \(c_4\)"),
        ("10^0.4 L^2", r"\(10^{0.4}\) \(L^{2}\)"),
        ("nuance, test_of_x, u.E2, F3.9, a < b", "nuance, test_of_x, u.E2, F3.9, a < b"),
    ],
)
def test_plain_symbols_are_typeset(text, shown):
    assert plain(typeset(text)) == shown


def test_prose_has_code_emphasis_and_mathematics():
    assert prose("as *except* $a*b*c$ in `x_*y*` < 1") == (
        'as <em>except</em> <span class="math notranslate nohighlight">\\(a*b*c\\)</span> in <code>x_*y*</code> &lt; 1'
    )
