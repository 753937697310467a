"""Bad input ends at once in one short sentence: numbers outside sense, files that unfold, titles that steer."""

import decimal
import fractions
import itertools
import json
import re
import time
from typing import Annotated

import numpy as np
import pytest
from pydantic import Strict

import cosserat
from cosserat.cases.catalogue import parse
from cosserat.errors import InputError
from cosserat.parameters import Items, Parameters, Quantity, nearest
from cosserat.tables import Columns, Rows
from cosserat.text import shortened, shown
from cosserat.units import _KINDS, sizes_in

ROD = '[a]\nlike = "elastica"\n'
WORM = '[a]\nlike = "worm"\n'


def refused(tmp_path, text):
    """The sentence for a file, which comes within seconds even on a busy machine."""
    (tmp_path / "my.toml").write_text(text, encoding="utf-8")
    begun = time.process_time()
    with pytest.raises(InputError) as caught:
        cosserat.case("a", tmp_path / "my.toml")
    assert time.process_time() - begun < 2
    sentence = str(caught.value)
    assert "\n" not in sentence
    assert len(sentence) < 600
    return sentence


@pytest.mark.parametrize("unit", _KINDS)
def test_powers_and_ratios_of_what_makes_sense_are_far_from_overflow(unit):
    least, most = sizes_in(unit)
    assert 0 < least < 1 < most
    assert least**6 > 1e-290
    assert most**6 < 1e290
    assert (most / least) ** 3 < 1e290


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        (10**400, "it must be a finite number"),
        (-(10**400), "it must be a finite number"),
        (10**5000, "is a whole number of 16610 bits; it must be a finite number"),
        (fractions.Fraction(10**400, 3), "it must be a finite number"),
        (fractions.Fraction(1, 10**100), "is 1e-100 m; it must be above 0, at least 1e-12, at most 1e9"),
        (decimal.Decimal("1e500"), "it must be a finite number"),
        (decimal.Decimal("sNaN"), "it must be a finite number"),
        (np.float64(1e300), r"is 1e\+300 m; it must be above 0, at least 1e-12, at most 1e9"),
        (np.float32(1e-30), "is 1e-30 m; it must be above 0, at least 1e-12"),
        (np.longdouble("1e4000"), "it must be a finite number"),
        (np.array([1.0, 2.0]), "not a number"),
        (1 + 2j, "not a number"),
        ("1e300 m", r"is 1e\+300 m; it must be above 0, at least 1e-12, at most 1e9"),
        ("1e400 m", "it must be a finite number"),
        ("1e-400 m", "is 0 m; it must be above 0"),
        ("1 km^99", "whose unit is not known|in km"),
        ("1 ((m^99)^99)^99", "whose unit is not known|in "),
    ],
    ids=lambda given: type(given).__name__,
)
def test_any_number_outside_sense_is_refused_with_its_range(value, sentence):
    with pytest.raises(InputError, match=f"'rod.length' .*{sentence}") as caught:
        cosserat.case("elastica").vary("b", rod={"length": value})
    assert len(str(caught.value)) < 300


def test_decimal_and_rational_numbers_are_numbers():
    one = cosserat.case("elastica").vary("b", rod={"length": 0.5})
    for half in (decimal.Decimal("0.5"), fractions.Fraction(1, 2), np.float32(0.5), "1/2 m"):
        assert cosserat.case("elastica").vary("b", rod={"length": half}) == one


def test_a_number_near_zero_is_zero_or_is_refused():
    case = cosserat.case("elastica")
    force = {"at": "last", "along": "E2"}
    assert case.vary("b", forces=[force | {"force": 1e-30}]).problem.forces[0].force == 1e-30
    with pytest.raises(InputError, match="is 1e-300 N; it must be 0, or at least 1e-40 in size"):
        case.vary("b", forces=[force | {"force": 1e-300}])


@pytest.mark.parametrize(
    ("quantity", "written"),
    [
        (Quantity("m", above=0), "above 0, at least 1e-12, at most 1e9"),
        (Quantity("m"), "at least -1e9, at most 1e9"),
        (Quantity("s", at_least=0), "at least 0, at most 1e12"),
        (Quantity("1", above=-1, below=0.5), "above -1, below 0.5"),
        (Quantity("1", at_least=1e-13, below=1e-3), "at least 1e-13, below 0.001"),
        (Quantity("1", above=1, at_most=7), "above 1, at most 7"),
    ],
)
def test_a_range_is_said_with_all_of_its_ends(quantity, written):
    assert quantity.range == written


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (ROD + "forces = " + "[" * 5000, "lists or tables inside each other, too deep to read"),
        (ROD + "x = " + "{a=" * 5000, "lists or tables inside each other, too deep to read"),
        (ROD + "rod.vertices = " + "9" * 5000, "has a whole number of thousands of digits"),
        (ROD + "rod.vertices = 0x" + "f" * 5000, "'rod.vertices' is a whole number of 20000 bits"),
        (ROD + "a." * 5000 + "a = 1", "has a key of more than 30 parts"),
        (ROD + '"a" . ' * 5000 + "a = 1", "has a key of more than 30 parts"),
        ("#" * 1_000_001, "it is larger than 1 MB"),
        ("".join(f"[c{n}]\n" for n in range(1001)), "has 1001 cases; write up to 1000"),
        (ROD + "\n".join(f"k{n} = 1" for n in range(10_001)), "it has more than 10000 keys"),
        (
            '[a]\nlike = "c0"\n' + "".join(f'[c{n}]\nlike = "c{n + 1}"\n' for n in range(2000)),
            "has 2001 cases|leads through more than 50 cases",
        ),
        (
            '[a]\nlike = "c0"\n' + "".join(f'[c{n}]\nlike = "c{n + 1}"\n' for n in range(60)),
            "case 'a': its 'like' leads through more than 50 cases",
        ),
        (
            '[a]\nlike = "c0"\n[c40]\nlike = "elastica"\n'
            + "".join(f'[c{n}]\nx.like = "c{n + 1}"\ny.like = "c{n + 1}"\n' for n in range(40)),
            "with all that it inherits it has more than 10000 keys",
        ),
        ("[a]\nlike = [" + '"elastica", ' * 51 + "]", "'like' is .* or a list of up to 50"),
        ("[a]\nlike = 7", "'like' is 7; it must be the name of a case"),
        (ROD + 'forces = [{ at = 1, along = "E2", force = "1 N" }' + ", 1" * 1000 + "]", "1001 items"),
        (ROD + f'rod.length = "{"m*" * 3000}m"', "a text of 6001 characters"),
        (ROD + 'rod.length = "1 m^(9^9^9^9)"', "whose unit is not known"),
        (ROD + 'title = "' + "é" * 201 + '"', "of 201 characters; take up to 200"),
        (ROD + "k" * 5000 + " = 1", r"'k+\.\.\.' is not a key"),
        (ROD + 'kind = "' + "k" * 5000 + '"', "'kind' is 'k+...k+'; known are"),
        ('[a]\nlike = "' + "k" * 5000 + '"', "'like' names no case: 'k+...k+'; known are: "),
        (
            ROD + "forces = [" + '{ at = 1, along = "E7", forc = 1 }, ' * 300 + "]",
            r"also missing: .*; and 8\d\d more$",
        ),
        (WORM + 'step = "1e9 s"\ngait.phases = []', "'gait' 'phases' is empty"),
        (
            '[a]\nkind = "rod statics"\nsupports = []\nrod.section.shape = "rectangle"',
            "also missing: 'rod.section.shear_factor', 'rod.section.height', 'rod.section.width'$",
        ),
        (ROD + 'rod.barrier = "yes"', "'rod.barrier' is 'yes'; it must be true or false"),
        (WORM + 'step = "1 µs"', "into more than 20000 instants; take a longer one"),
        (WORM + f"gait.gamma = {[[[0, 0], [1, 1]]] * 101}", "'gait.gamma' has 101 items"),
        ('[a]\nlike = "_calibration"\nvertices = 4', "'vertices' is 4; it must be at least 5"),
        ('[a]\nlike = "_discretization"\nvertices = 12', "'vertices' is 12; it must be odd"),
    ],
    ids=itertools.count(),
)
def test_what_a_case_file_unfolds_into_is_bounded(tmp_path, text, sentence):
    said = refused(tmp_path, text)
    assert re.search(sentence, said), said


def test_each_table_is_merged_once(tmp_path):
    """Two to the fortieth merges would take a year."""
    chain = "".join(f'[c{n}]\nlike = ["c{n + 1}", "c{n + 1}"]\n' for n in range(40))
    (tmp_path / "my.toml").write_text(f'[a]\nlike = "c0"\n{chain}[c40]\nlike = "elastica"\n')
    assert cosserat.case("a", tmp_path / "my.toml").problem == cosserat.case("elastica").problem


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[" * 100_000, "too deep to read"),
        ('{"problem": ' + "9" * 5000 + "}", "thousands of digits"),
        ('{"problem": 7}', "there is no table 'problem'"),
        ("7", "there is no table 'problem'"),
        ("", "Expecting value"),
        (" " * 20_000_001, "longer than 20 million characters"),
        (None, "None is no text"),
    ],
    ids=itertools.count(),
)
def test_parameters_of_a_result_are_bounded(text, sentence):
    with pytest.raises(InputError, match=sentence) as caught:
        parse(text)
    assert len(str(caught.value)) < 300


def test_numbers_in_json_have_ranges():
    table = json.loads(cosserat.case("elastica").model_dump_json())
    table["problem"]["rod"]["length"] = 10**400
    with pytest.raises(InputError, match="'rod.length' .*; it must be a finite number"):
        parse(json.dumps(table))


TIMES = "time [s],acceleration [m/s^2]\n"


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (
            TIMES + "0,1\n1,1e300\n",
            r"row 2 has a fault: acceleration is 1e\+300 m/s\^2; it must be at least",
        ),
        (TIMES + "0,1\n1," + "9" * 140_000, "which is no table .*field"),
        (
            TIMES + "\n".join(f"{n},1" for n in range(100_001)),
            "has 100001 rows; it may have up to 100000",
        ),
        ("a," * 1001 + "\n", "more than 1000 columns"),
        (
            TIMES + "0,1\n" + "x" * 5000 + ",1\n",
            "whose row 2 is 'x+...x+,1', with a cell that is no number",
        ),
    ],
    ids=itertools.count(),
)
def test_tables_are_bounded(tmp_path, content, sentence):
    (tmp_path / "t.csv").write_text(content)
    like = '[a]\nlike = "vibration_consistent"\n'
    said = refused(tmp_path, like + 'base_motion = { along = "E2", record = "t.csv" }\n')
    assert re.search(sentence, said), said


@pytest.mark.parametrize("name", ["/dev/zero", ".", "missing.csv", "a\\u0000b", "k" * 5000])
def test_only_files_are_tables(tmp_path, name):
    like = '[a]\nlike = "vibration_consistent"\n'
    said = refused(tmp_path, like + f'base_motion = {{ along = "E2", record = "{name}" }}\n')
    assert "which cannot be read (" in said


@pytest.mark.parametrize(
    "title",
    [
        r"\u001b[31m",
        r"\u0007",
        r"\u0000",
        r"a\nb",
        r"a\tb",
        r"\u202e",
        r"\u2066",
        r"\u2028",
        r"\ufeff",
        r"\uffff",
    ],
)
def test_a_title_that_steers_is_refused(tmp_path, title):
    for key in ("title", "source"):
        said = refused(tmp_path, ROD + f'{key} = "my {title} rod"')
        assert f"'{key}' has " in said
        assert said.isprintable()


def test_titles_of_any_language_are_taken(tmp_path):
    title = "Stab № 1: 5 µm, naïve $x$ — 日本語 العربية क्\u200dष 👩\u200d🔬"
    (tmp_path / "my.toml").write_text(ROD + f'title = "{title}"')
    assert cosserat.case("a", tmp_path / "my.toml").title == title


@pytest.mark.parametrize("bad", ["7", "0", '["x"]', "[]", "{ a = 1 }", "true"])
def test_a_title_is_a_text(tmp_path, bad):
    said = refused(tmp_path, ROD + f"title = {bad}")
    assert "'title' is " in said
    assert "it must be a text" in said


def test_names_are_short_enough_for_files(tmp_path):
    (tmp_path / "my.toml").write_text('["../evil"]\nlike = "necking"')
    with pytest.raises(InputError, match="'name' is '../evil', which cannot name a file"):
        cosserat.case("../evil", tmp_path / "my.toml")
    case = cosserat.case("necking")
    assert case.vary("n" * 100).name == "n" * 100
    for name in ("n" * 101, "n" * 5000, "a\x1b[31m", "a\nb", "../x", "_a", "1a", "é"):
        with pytest.raises(InputError) as caught:
            case.vary(name)
        assert len(str(caught.value)) < 500
        assert str(caught.value).isprintable()


class Small(Parameters):
    flag: Annotated[bool, Strict()] = False
    pair: tuple[int, int] = (0, 0)
    words: tuple[str, ...] = ()


@pytest.mark.parametrize(
    "bad", [7.5, "x" * 5000, {"a": 1}, [1] * 5000, None, object(), np.zeros(10_000)]
)
@pytest.mark.parametrize("key", ["flag", "pair", "words"])
def test_the_words_of_pydantic_reach_no_user(key, bad):
    with pytest.raises(InputError) as caught:
        Small(**{key: bad})
    said = str(caught.value)
    assert len(said) < 600
    assert not any(word in said for word in ("Input", "pydantic", "valid ", "type=", "[type"))


def test_values_and_known_words_are_shown_in_part():
    deep = [[[[[[[["x" * 1000] * 1000]]]]]]]
    for value in (
        deep,
        "é" * 10**6,
        10**10_000,
        {n: n for n in range(1000)},
        np.zeros(10**6),
        "\x1b" * 100,
    ):
        assert len(shown(value)) < 400
        assert shown(value).isprintable()
    assert shown("short") == "'short'"
    assert shortened("a" * 61) == "a" * 57 + "..."
    assert nearest("x", [f"word{n}" for n in range(1000)]).endswith("word37 and 962 more")
    assert len(nearest("x" * 10**6, ["y" * 10**6])) < 100


CLOSED_FORMS = [
    ("_calibration", 'hanging_bar = { like = "hanging_bar_consistent" }', "no 'rod.calibration' to fit"),
    ("_calibration", 'hanging_bar = { like = "clamped_clamped" }', "'hanging_bar', which is held elsewhere"),
    ("_calibration", 'hanging_bar = { like = "clamped_free" }', "'hanging_bar', which has its weight along -E2"),
    ("_calibration", 'hanging_bar = { like = "vibration_c4_2" }', "'hanging_bar.kind' is 'rod motion'"),
    ("_calibration", 'necking = { like = "necking", forces = [] }', "which is not pulled at its last vertex"),
    ("_calibration", 'clamped_free = { like = "clamped_free", gravity.g = "0 m/s^2" }', "which has no weight"),
    ("_calibration", 'clamped_free = { like = "clamped_free", rod.calibration.c5 = 0 }', "take one above 0"),
    ("_calibration", 'necking = { like = "necking", springs = [{ at = 1, along = "E2", stiffness = "1 N/m" }] }',
     "which has 'springs'"),
    ("_calibration", 'necking = { like = "necking", rod.stations = [{ at = "1 m" }] }', "not straight and uniform"),
    ("_discretization", 'necking = { like = "necking_consistent", forces = [] }', "is not pulled"),
    ("_discretization", 'clamped_clamped = { like = "clamped_clamped_consistent", gravity = "none" }', "has no weight"),
    ("_discretization", 'slender = { like = "elastica" }', "'slender', which has 'forces'"),
]  # fmt: skip


@pytest.mark.parametrize(("like", "line", "sentence"), CLOSED_FORMS)
def test_a_comparison_takes_only_problems_with_its_closed_forms(tmp_path, like, line, sentence):
    assert sentence in refused(tmp_path, f'[a]\nlike = "{like}"\n{line}\n')


def test_a_crawl_of_many_instants_is_read_at_once(tmp_path):
    (tmp_path / "my.toml").write_text(WORM + 'step = "0.25 ms"\n')
    begun = time.process_time()
    crawl = cosserat.case("a", tmp_path / "my.toml").problem
    assert time.process_time() - begun < 2
    assert len(crawl.gait.telling_phases(crawl.step)) < 10


def test_lists_have_a_length():
    class Listed(Parameters):
        few: tuple[int, ...] = ()
        three: Annotated[tuple[int, ...], Items(3, 3)] | None = None
        rows: Annotated[Rows, Columns((("x", "m"),))] | None = None

    assert len(Listed(rows=np.arange(2000.0)).rows) == 2000
    with pytest.raises(InputError, match="'three' has 2 items; it must have 3 to 3"):
        Listed(three=[1, 2])

    assert len(Listed(few=(1,) * 1000).few) == 1000
    with pytest.raises(InputError, match="has 1001 items in 'few'; it may have up to 1000"):
        Listed(few=(1,) * 1001)
    assert [Items(2, 3).range, Items(0, 3).range] == ["2 to 3", "up to 3"]
