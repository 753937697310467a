"""The keys of a case: their list agrees with the classes, and its text with the reader."""

import math
import re
import tomllib
from typing import Annotated, Literal, get_args, get_origin

import pytest
from pydantic import BaseModel, TypeAdapter
from pydantic_core import PydanticUndefined

from cosserat.cases import catalogue
from cosserat.cases.tables import Tables, merged
from cosserat.cli import main
from cosserat.describe import keys as listing
from cosserat.describe.keys import keys
from cosserat.describe.text import list_of_keys, type_of
from cosserat.errors import InputError
from cosserat.parameters import FROM_FILE, Count, Quantity
from cosserat.problem import Problem
from cosserat.publications import kinds, published_tables
from cosserat.rods.problem import LOADS as LOADED
from cosserat.synonyms import SYNONYMS

KINDS = list(kinds())
CHOOSING = ("kind", "shape")
"""Keys that decide which others a table has; they come first."""


def classes_in(annotation):
    """Parameter classes that an annotation names, and whether each stands in a list."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [(annotation, False)]
    inside = [found for part in get_args(annotation) for found in classes_in(part)]
    return [(owner, listed or get_origin(annotation) is tuple) for owner, listed in inside]


def walk(owner, before=""):
    """Path and field of every key, by way of the classes alone; whole problems are not entered."""
    for name, field in sorted(owner.model_fields.items(), key=lambda item: item[0] not in CHOOSING):
        yield before + name, field
        for inner, listed in classes_in(field.annotation):
            if not issubclass(inner, Problem):
                yield from walk(inner, f"{before}{name}[]." if listed else f"{before}{name}.")


def fields(kind):
    """Paths and fields of a kind, that of its word first."""
    found = walk(kinds()[kind].problem_class())
    return sorted(found, key=lambda pair: pair[0] != "kind")


def whole(field):
    """The annotation of a field with what pydantic took out of it."""
    return Annotated[field.annotation, *field.metadata, None]


def marks(annotation):
    """Every Quantity and Count in an annotation."""
    found = annotation.__metadata__ if get_origin(annotation) is Annotated else ()
    inner = [mark for part in get_args(annotation) for mark in marks(part)]
    return [mark for mark in found if isinstance(mark, Quantity | Count)] + inner


def limits(mark):
    """How a range is written."""
    if isinstance(mark, Count):
        return f"(from {mark.at_least} to {mark.at_most})"
    low = mark.least if mark.least > mark.above else -math.inf
    high = mark.most if mark.most < mark.below else math.inf
    parts = [("above", mark.above), ("at least", low), ("at most", high), ("below", mark.below)]
    said = ", ".join(f"{words} {end:g}" for words, end in parts if math.isfinite(end))
    return f"({said})".replace("e+", "e").replace("e0", "e").replace("e-0", "e-")


def printed(kind):
    """The paths of a printed kind, each with its lines."""
    blocks = [block.split("\n") for block in list_of_keys(kind).split("\n\n")[1:]]
    return [(lines[0].split()[0], " ".join(line.strip() for line in lines[1:])) for lines in blocks]


def unfolded(kind):
    """The same, with the keys that it leaves to another table which has them too."""
    found = printed(kind)
    for path, text in found:
        yield path, text
        like = re.search(r" The keys inside are those of (\S+)\.$", text)
        inside = re.compile(rf"{re.escape(like[1])}(\[\])?\." if like else "(?!)")
        for inner, said_of_it in found:
            if inside.match(inner):
                yield path + inner.removeprefix(like[1]), said_of_it


@pytest.mark.parametrize("kind", KINDS)
def test_the_keys_printed_are_the_fields_of_the_classes(kind):
    declared = [path for path, _ in fields(kind)]
    assert [path for path, _ in unfolded(kind)] == declared == [key.path for key in keys(kind)]


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_has_a_meaning_and_every_quantity_a_unit_that_has_a_word(kind):
    for key in keys(kind):
        assert re.fullmatch(r"(?s)[A-Z\"].*\.", key.meaning), key.path
        assert "a quantity" not in type_of(key), key.path


def test_a_field_without_a_meaning_is_noticed(monkeypatch):
    known = listing.docstrings
    monkeypatch.setattr(
        listing,
        "docstrings",
        lambda owner: {k: v for k, v in known(owner).items() if k != "young"},
    )
    found = listing.keys.__wrapped__("rod path")
    assert [key.path for key in found if not key.meaning] == [
        "rod.section.layers[].material.young",
        "rod.material.young",
        "rod.stations[].young",
    ]


@pytest.mark.parametrize("kind", KINDS)
def test_units_words_and_symbols_in_the_text_are_those_of_the_classes(kind):
    for (path, text), (_, field) in zip(unfolded(kind), fields(kind), strict=True):
        for mark in marks(whole(field)):
            if isinstance(mark, Quantity) and mark.unit != "1":
                assert re.search(rf" in {re.escape(mark.unit)}(?: \(|;| or |,|\])", text), path
            assert limits(mark) in text.split(";")[0], path
            if mark.symbol and "[" not in text.split(";")[0]:
                assert f"Thesis: {mark.symbol}" in text, path
        for part in (field.annotation, *get_args(field.annotation)):
            if get_origin(part) is Literal:
                assert tuple(re.findall(r'"([^"]*)"', text))[: len(get_args(part))] == get_args(part)
        assert ("; required" in text) == (
            field.is_required() or path.endswith(("kind", "section.shape"))
        ), path


@pytest.mark.parametrize("kind", KINDS)
def test_a_default_as_printed_is_read_as_the_default_of_the_class(kind):
    for key, (path, field) in zip(keys(kind), fields(kind), strict=True):
        if field.default is PydanticUndefined or field.default is None:
            assert key.default is None, path
        else:
            written = tomllib.loads(f"value = {key.default}")["value"]
            read = TypeAdapter(whole(field)).validate_python(written, context=FROM_FILE)
            assert read == field.default, path


# Cases that have something at every key with a range, of which one is then moved to the ends of its range.
BASES = {
    "rod statics": """
        like = ["elastica", "_loads"]
        rod = { energy = "published", calibration = { c1 = 1, c2 = 1, c3 = 1, c4 = 1, c5 = 1, c6 = 1, c7 = 1 } }
    """,
    "rod path": 'like = ["elastica", "_loads"]\nkind = "rod path"',
    "modes": 'like = ["elastica", "_loads"]\nkind = "modes"',
    "critical loads": 'like = ["elastica", "_loads"]\nkind = "critical loads"',
    "rod motion": """
        like = ["vibration_c4_20", "_loads"]
        base_motion = { along = "E2", acceleration = "1 m/s^2" }
    """,
    "calibration": 'like = "_calibration"',
    "discretization errors": 'like = "_discretization"',
    "posture": 'like = "worm_at_rest"\ncrawler.segments = [{ length = "250 mm" }]',
    "crawl": """
        like = "soft_robot"
        crawler.segments = [{ length = "25.4 cm" }]
        gait.anchor = [[[0, 0], [2, 0]]]
        gait.measured = [
            { front = "anchor", table = [["12.5 s", "25.4 cm"], ["22.5 s", "25.4 cm"]], length = "25.4 cm" },
        ]
    """,
    "body mass": 'like = "_of_constant_stress"',
    "worm calibration": 'like = "worm_calibration"',
}
LOADS = """
[_loads]
gravity = { g = "9.81 m/s^2", along = "-E2" }
line_loads = [{ along = "E2", density = "1 N/m", start = "0 m" }]
forces = [{ at = "last", along = "E2", force = "1 N" }]
couples = [{ at = 1, moment = "1 N*m" }]
line_couples = [{ density = "1 N", start = "0 m" }]
follower_forces = [{ at = "last", along = "E2", force = "1 N" }]
follower_line_loads = [{ along = "E2", density = "1 N/m", start = "0 m" }]
pressures = [{ side = "upper", pressure = "1 Pa", start = "0 m" }]
springs = [{ at = 1, along = "E2", stiffness = "1 N/m", rotational_stiffness = "1 N*m/rad" }]
foundations = [{ along = "E2", stiffness = "1 Pa", rotational_stiffness = "1 N*m/rad/m" }]
masses = [{ at = 1, mass = "1 kg" }]
rod.stations = [{ at = "0 m" }]
supports = [{ at = "first", fixed = ["x3", "x2"] }, { at = "last", fixed = ["d3", "d2"] }]
prescribed_displacements = [{ at = "first", dof = "x2", by = "1 cm" }]
prescribed_rotations = [{ at = "last", by = "1 deg" }]
"""
"""One rule at a time: only loads that bear any number of vertices and any length."""
STRAINS = {
    "rod": {"energy": "consistent", "calibration": "none"},
    "prestrains": [{"extension": 0.0}],
    "temperatures": [{"change": "0 K", "expansion": "1e-5 1/K"}],
}
"""Loads that only one energy takes."""


def base(kind):
    """The merged table of the case of a kind."""
    tables = published_tables() | tomllib.loads(LOADS) | {"it": tomllib.loads(BASES[kind])}
    return Tables(tables).inherited("it")


def put(table, path, value):
    """A copy of a table with a value at a path: in the first of several tables, as the first of several numbers."""
    head, _, rest = path.partition(".")
    name = head.removesuffix("[]")
    old = table.get(name)
    if not rest:
        return table | {name: first(old, value) if isinstance(old, list) else value}
    if head.endswith("[]"):
        return table | {name: [put(old[0], rest, value), *old[1:]]}
    return table | {name: put(old or {}, rest, value)}


def first(items, value):
    head = first(items[0], value) if isinstance(items[0], list) else value
    return [head, *items[1:]]


def ends(about):
    """Just inside and just outside of each end of a range, in SI, and whether the key states this end."""
    if isinstance(about, Count):
        return [(about.at_least, about.at_least - 1, True), (about.at_most, about.at_most + 1, True)]
    least, most = about.least, about.most
    lower = (least + 1e-9, least) if least == about.above else (least, least - 1e-6 * (abs(least) or 1))
    upper = (most - 1e-9, most) if most == about.below else (most, most + 1e-6 * (abs(most) or 1))
    above = [(max(1e-9, least), 0.0, True)] if about.above == 0 else []
    return [*above, (*lower, least in (about.above, about.at_least)), (*upper, most == about.below)]


def said(table):
    """What the reader says of a table; nothing if it takes it."""
    try:
        catalogue._read_problem(dict(table), "it", units_required=True)
    except InputError as error:
        return str(error)
    return ""


ELASTIC = {"young": "1 GPa", "poisson": 0.3, "density": "1 g/cm^3"}
SIDES = {"height": "0.3 m", "width": "0.2 m", "shear_factor": 0.5}
CHOICES = {
    "compressible": {"kind": "compressible", "young": "10 kPa", "poisson": 0.3},
    "incompressible": {"kind": "incompressible", "young": "2 kPa"},
    "straight": {},
    "arc": {"curvature": "0 1/m"},
    "curvature": {},
    "points": {},
    "bow": {"kind": "bow", "amplitude": "1 mm"},
    "mode": {"kind": "mode", "amplitude": "1 mm"},
    "buckling mode": {"kind": "buckling mode", "amplitude": "1 mm"},
    "rectangle": SIDES,
    "square": {"side": "0.2 m", "shear_factor": 1},
    "hollow rectangle": SIDES | {"wall": "2 cm"},
    "circle": {"diameter": "0.2 m", "shear_factor": 1},
    "tube": {"diameter": "0.2 m", "wall": "2 cm", "shear_factor": 1},
    "ellipse": SIDES,
    "I": SIDES | {"flange": "1 cm", "web": "1 cm"},
    "given": {"area": "1 m^2", "second_moment": "1 m^4", "height": "3 m", "shear_factor": 1},
    "layers": {"layers": [{"thickness": "1 cm", "width": "1 cm", "material": ELASTIC}]},
    "stiffnesses": {
        "axial_stiffness": "4 N",
        "bending_stiffness": "1 N*m^2",
        "shear_stiffness": "1 N",
        "height": "2 m",
    },
    "mass": {"kind": "mass", "ratio": 0.1},
    "rayleigh": {  # each key is there, in the end too many of them
        "kind": "rayleigh",
        "ratios": [0.1, 0.1],
        "modes": [1, 2],
        "frequencies": ["1 Hz", "2 Hz"],
    },
    "stiffness": {"kind": "stiffness", "ratio": 0.1},
    "modal": {"kind": "modal", "ratios": [0.1, 0.1], "ratio": 0.1, "modes": 2},
    "ramp": {"kind": "ramp", "duration": "1 s"},
    "sine": {"kind": "sine", "frequency": "1 Hz"},
    "pulse": {"kind": "pulse", "duration": "1 s"},
    "half-sine": {"kind": "half-sine", "duration": "1 s"},
    "chirp": {
        "kind": "chirp",
        "duration": "1 s",
        "first_frequency": "1 Hz",
        "last_frequency": "2 Hz",
    },
    "table": {"kind": "table", "rows": [["0 s", 0], ["1 s", 1]]},
}
"""Tables with a choice, by their `kind` or `shape`."""
CHAMBERS = {  # in place of fronts
    "phases": ["1 s"],
    "anchor": [[[0, 0], [1, 0]]],
    "chambers": [
        {"begin": 0, "end": 1, "schedule": [[0, 0.5, "advancing"]], "force": "1 N", "pressure": "1 kPa"}
    ],
}


def chosen(case, key):
    """The case with the table of the word that brings a key."""
    if not key.when:
        return case
    place = "rod.section" if key.by == "shape" else key.path.rpartition(".")[0]
    case = put(case, place, {**CHOICES[key.when], key.by: key.when})
    if key.when == "layers":
        case = case | {"rod": {name: own for name, own in case["rod"].items() if name != "material"}}
    if key.when == "stiffnesses":
        case = put(case, "rod.material", {"line_density": "1 kg/m"})
    return case


# Just inside of its range, a key may break a rule that joins several keys, which has a sentence of its own.
JOINED = {
    "prescribed_rotations[].by": "only the consistent rod at rest rotates it by more than a quarter turn",
    "rod.calibration": "is missing",  # of a path, whose rod has none
    "crawler.length": "let them be equal",
    "crawler.segments[].length": "let them be equal",
    "rod.section": "it must be (below half|at most|below)|radius of gyration|whose stiffnesses energy",
    "rod.section.layers[]": "whose stiffnesses energy",
    "rod.section.layers[].material": "whose stiffnesses energy|give two of|has both",
    "rod.material": "give two of|has both",
    "crawler.radius": "length / radius",
    "crawler.material.poisson": "has a Poisson's ratio",
    "crawler.material.bulk": "give two of young, poisson and bulk",
    "crawler.mass": "give one of them",
    "crawler.density": "give one of them",
    "meshes": "must be odd",
    "gait.eta": "gamma and eta cross",
    "gait.phases": "times run from 0 to",
    "gait.measured[].length": "places from 0 to",
    "rod.stations[].wall": "has no wall",
    "damping": "just one of them|give two|needs 'modes'|leave one of them out|would feed energy",
    "base_motion": "just one of them|leave one of them out",
    "start": "leave one of them out|give the number of the mode",
    "step": "more than 20000 instants",
    **{
        f"{load}.time_function": "only kind = 'rod motion' has a time"
        for load in ("gravity", *(f"{key}[]" for key in LOADED if key != "gravity"))
    },
    **{
        f"prescribed_{key}[].time_function": "only kind = 'rod motion' has a time"
        for key in ("displacements", "rotations")
    },
}


SEEN = set()
"""Fields whose range is tested; those of a table are the same in every kind."""


@pytest.mark.parametrize("kind", KINDS)
def test_ranges_accept_just_inside_and_refuse_just_outside(kind):
    case = base(kind)
    assert said(case) == ""
    for key, (path, field) in zip(keys(kind), fields(kind), strict=True):
        if id(field) in SEEN:  # of a table that stands at several places
            continue
        SEEN.add(id(field))
        if path == "gait.chambers":
            case = put(case, "gait", CHAMBERS)
        if path.startswith(("prestrains", "temperatures")):
            case = merged(case, STRAINS)
        there = chosen(case, key)
        for mark in marks(whole(field))[:1]:
            unit = "" if isinstance(mark, Count) or mark.unit == "1" else mark.unit
            plain = re.escape(path).replace(r"\[\]", r"\.0")
            refused = rf"'{plain}(\.0)*' is .*; it must be (above|below|at least|at most) "
            for inside, outside, stated in ends(mark):
                within, beyond = (f"{x!r} {unit}" if unit else x for x in (inside, outside))
                if key.value.form == "row":
                    within, beyond = [within, within], [beyond, beyond]
                assert re.search(refused, said(put(there, path, beyond))), (path, beyond)
                answer = said(put(there, path, within))
                if not stated:  # so far out, a key breaks rules that join several keys
                    assert not re.search(refused, answer), (path, within, answer)
                    continue
                joined = JOINED.get(path) or JOINED.get(path.rpartition(".")[0])
                assert not answer or (joined and re.search(joined, answer)), (path, within, answer)


def test_kinds_and_common_keys_are_listed_without_a_kind(capsys):
    assert main(["describe"]) == 0
    lines = capsys.readouterr().out.split("\n")
    assert [re.split(r" {2,}", line)[0] for line in lines[: len(KINDS)]] == KINDS
    assert all(re.fullmatch(r"\S.* {2,}[A-Z].*\.", line) for line in lines[: len(KINDS)])
    assert [line for line in lines if re.fullmatch(r"\w+", line)] == ["title", "source", "like"]


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_is_described_in_a_hundred_columns_of_plain_text(kind, capsys):
    assert main(["describe", *kind.split()]) == 0
    text = capsys.readouterr().out
    assert text == list_of_keys(kind) + "\n"
    assert max(map(len, text.split("\n"))) <= 100
    assert "\t" not in text


def test_a_key_is_printed_as_expected():
    """The expected text is written by hand."""
    said_of = dict(printed("rod motion"))
    assert said_of["rod.length"] == (
        "a length in m (above 0, at least 1e-12, at most 1e9); required Length of the centreline in the reference "
        r"configuration. Thesis: \ell_0, eq. (3.3.1)"
    )
    assert said_of["start.speed"] == (
        'a speed in m/s (at least -1e9, at most 1e9); default "0 m/s" Speed of the whole rod.'
    )
    assert said_of["rod.barrier"].startswith("true or false; default false ")
    assert said_of["rod.calibration"].startswith("a table; may be left out ")
    assert said_of["supports[].at"].startswith(
        '"first", "last", the index of a vertex, a distance such as "0.35 m", or a percentage '
    )
    assert said_of["supports"].startswith("a list of tables; required ")
    assert said_of["rod.vertices"].startswith("a whole number (from 3 to 200000); required ")


@pytest.mark.parametrize(
    ("words", "paths"),
    [
        ("modes count", ["count"]),
        ("rod path arc", ["arc", "arc.first", "arc.longest", "arc.count", "arc.limit", "arc.branch"]),
        ("rod statics couples", ["couples", "couples[].at", "couples[].moment"]),
        ("rod motion rod.length", ["rod.length"]),
    ],
)
def test_the_keys_of_one_table_are_described(words, paths, capsys):
    assert main(["describe", *words.split()]) == 0
    blocks = capsys.readouterr().out.split("\n\n")[1:]
    asked = [block.split("\n")[0].split()[0] for block in blocks]
    assert [path for path in asked if "time_function" not in path] == paths


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("rod statics suports", "no key 'suports' in kind 'rod statics'; did you mean 'supports'?"),
        ("rod path arc.frist", "no key 'arc.frist' in kind 'rod path'; did you mean 'arc.first'?"),
        ("modes wheels", "no key 'wheels' in kind 'modes'; known are: kind, rod, supports, "),
        ("modes rod.length.x", "no key 'rod.length.x' in kind 'modes'; known are: rod.section.shape, "),
    ],
)
def test_an_unknown_key_is_refused_with_those_of_its_level(words, sentence, capsys):
    assert main(["describe", *words.split()]) == 2
    said = capsys.readouterr().err
    assert sentence in said
    assert said.count("\n") == 1


def test_words_for_a_key_lead_to_keys_and_kinds_and_are_none_themselves():
    names = {key.name for kind in KINDS for key in keys(kind)}
    assert set(SYNONYMS.values()) <= names | set(KINDS)
    assert list(SYNONYMS) == sorted(SYNONYMS) == [word.lower() for word in SYNONYMS]
    assert not set(SYNONYMS) & set(KINDS)


def test_an_unknown_kind_is_refused_with_the_nearest_name(capsys):
    assert main(["describe", "rod", "static"]) == 2
    assert (
        capsys.readouterr().err
        == "cosserat: there is no kind 'rod static'; did you mean 'rod statics'?\n"
    )
    assert main(["describe", "spring"]) == 2
    assert capsys.readouterr().err.endswith("; known are: " + ", ".join([*KINDS, "study", "fit"]) + "\n")
