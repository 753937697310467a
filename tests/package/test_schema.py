"""The JSON Schemas of cases, with the validator jsonschema: published cases pass, and bad cases are refused."""

import copy
import json
import re
import tomllib

import pytest
from conftest import ROOT
from jsonschema import Draft202012Validator
from test_units import READ, REFUSED

import cosserat
from cosserat.cases import catalogue
from cosserat.cases.tables import Tables
from cosserat.cli import main
from cosserat.describe.keys import common_keys, described, keys
from cosserat.describe.schema import as_written, merged
from cosserat.errors import InputError
from cosserat.parameters import Dropped
from cosserat.publications import published_tables, titles

FILES = [(ROOT / f"cosserat/thesis/cases/{name}.toml").read_text() for name in ("chapter2", "chapter3")]
README = re.findall(r"```toml\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.DOTALL)


NAMES = {
    "1": "ratio",
    "m": "length",
    "m^2": "area",
    "m^4": "second-moment-of-area",
    "m^-1": "curvature",
    "kg": "mass",
    "kg*m^2": "moment-of-inertia",
    "kg/m": "mass-per-length",
    "kg/m^3": "density",
    "s": "time",
    "Hz": "frequency",
    "1/s": "rate",
    "m/s": "speed",
    "m/s^2": "acceleration",
    "N": "force",
    "N/m": "force-per-length",
    "N*m": "moment",
    "N*m^2": "bending-stiffness",
    "N*m/rad": "rotational-stiffness",
    "N*m/rad/m": "rotational-stiffness-per-length",
    "Pa": "pressure",
    "K": "temperature-difference",
    "K/m": "temperature-gradient",
    "K^-1": "thermal-expansion",
    "rad": "angle",
    "rad/s": "angular-speed",
}
"""The shared schema of the texts in each unit."""


@pytest.fixture(scope="module")
def written():
    return Draft202012Validator(as_written())


@pytest.fixture(scope="module")
def whole():
    return Draft202012Validator(merged())


@pytest.mark.parametrize("made", [as_written, merged])
def test_the_schemas_are_schemas(made):
    Draft202012Validator.check_schema(made())


def table_of(name):
    """The merged table of a published case."""
    return without_dropped(Tables(published_tables()).inherited(name))


def without_dropped(table):
    """A merged table without the keys that "none" drops; of the published ones, one key has it as a word."""
    return {
        key: without_dropped(value) if isinstance(value, dict) else value
        for key, value in table.items()
        if not isinstance(value, Dropped) or key == "advancing_force"
    }


def mine(text):
    """The tables of a case of one's own."""
    return tomllib.loads(f'[mine]\nlike = "{"worm" if "crawler" in text else "clamped_free"}"\n{text}\n')


def reads(text, tmp_path):
    """Whether the reader takes a case of one's own."""
    file = tmp_path / "mine.toml"
    file.write_text(f'[mine]\nlike = "{"worm" if "crawler" in text else "clamped_free"}"\n{text}\n')
    try:
        cosserat.case("mine", file)
    except InputError:
        return False
    return True


@pytest.mark.parametrize("text", [*FILES, *README])
def test_published_case_files_pass_the_schema(written, text):
    assert [error.message for error in written.iter_errors(tomllib.loads(text))] == []


def test_merged_published_cases_pass_the_schema(whole):
    assert [name for name in titles() if not whole.is_valid(table_of(name))] == []


@pytest.mark.parametrize(
    "text",
    [
        'rod.lenght = "5 m"',
        'lenght = "5 m"',
        'rod.length = "3 kg"',
        'rod.length = "3 kg/m^3"',
        'rod.length = "3"',
        "rod.length = 3",
        'rod.material.young = "1 Gpa"',
        'rod.material.young = "1,0 GPa"',
        'rod.material.poisson = "0.3 m"',
        "rod.material.poisson = 0.5",
        "rod.material.poisson = true",
        'rod.vertices = "20"',
        "rod.vertices = 2",
        "rod.vertices = 20.5",
        'rod.energy = "publishd"',
        'rod.barrier = "yes"',
        'rod.calibration = "nothing"',
        'rod = "long"',
        'kind = "rod static"',
        'kind = "rod motion"\nnewton.tolerance = 1e-9',  # a key of another kind
        'supports = [{ fixed = ["x3"] }]',  # lists are replaced as a whole
        'supports = [{ at = "first", fixed = ["x1"] }]',
        'supports = { at = "first", fixed = ["x3"] }',
        'forces = [{ at = "middle", along = "E2", force = "1 N" }]',
        'forces = [{ at = -1, along = "E2", force = "1 N" }]',
        'forces = [{ at = 1, along = "E2", force = "1 Nm" }]',
        "title = 5",
        'crawler.material = { kind = "incompressible", poisson = 0.3 }',
        'crawler.mass = "nothing"',
        'crawler.length = "none"',  # the body needs one
        'gait.gamma = [[[0, 1, 2]]]\ncrawler.length = "1 m"',
        'gait.phases = ["1 m"]\ncrawler.length = "1 m"',
    ],
)
def test_bad_cases_are_refused_by_the_schema_and_by_the_reader(written, text, tmp_path):
    assert not written.is_valid(mine(text))
    assert not reads(text, tmp_path)


@pytest.mark.parametrize(
    "text",
    [
        'rod.length = "3 furlong*turn"',  # of units that it does not know it leaves the dimension to the reader
        'rod.length = "5 m m"',
        'rod.length = "-5 m"',
        "rod.vertices = 20.0",
        "forces = [{ at = 99, along = 'E2', force = '1 N' }]",
        'crawler.density = "none"',  # whether there is something to drop
        'rod.calibration = "none"',  # that the published energy needs one joins two keys
        'like = "no_such_case"',
        "prescribed_displacements = [{ at = 1, dof = 'x2', by = '1 m' }]",
    ],
)
def test_faults_beyond_a_schema_are_refused_by_the_reader(written, text, tmp_path):
    text = text if "like" not in text else 'rod = { like = "no_such_case" }'
    assert written.is_valid(mine(text))
    assert not reads(text, tmp_path)


@pytest.mark.parametrize(
    "text",
    [
        "",
        'rod = { like = "_slender", length = "2 m" }',
        'rod.calibration = "none"\nrod.energy = "consistent"',
        'crawler.mass = "none"\ncrawler.density = "1 g/cm³"',
        'crawler.material = { kind = "compressible", poisson = "30 %" }',
        'rod.section.shear_factor = "5/6"',
        "rod.material.poisson = 0.3",
        'gait.eta = "none"\ncrawler.mass = "10 g"',
        'gravity = "none"',
        "gravity = { g = '9.81 m s-2', along = '-E2' }",
    ],
)
def test_right_cases_pass_the_schema(written, text):
    assert written.is_valid(mine(text))


def test_names_of_cases_are_names_of_files(written):
    assert not written.is_valid({})
    assert not written.is_valid({"mine": 5})
    assert not written.is_valid({"my rod": {"like": "clamped_free"}})
    assert written.is_valid({"_part": {"lenght": 5}, "mine": {"like": ["clamped_free", "_part"]}})


@pytest.mark.parametrize(
    "name", ["clamped_free", "vibration_c4_2", "worm", "_of_constant_stress", "_calibration"]
)
def test_a_merged_case_without_a_required_key_is_refused(whole, name):
    kind = table_of(name)["kind"]
    needed = [key.path for key in keys(kind) if key.required and "." not in key.path]
    assert len(needed) >= 3
    for key in needed:
        table = table_of(name)
        del table[key]
        assert not whole.is_valid(table), key
        with pytest.raises(InputError):
            catalogue._read_problem(table, name, units_required=True)


@pytest.mark.parametrize(
    ("name", "path"),
    [("clamped_free", "rod.section.shape"), ("worm", "crawler.material.kind"), ("worm", "gait.phases")],
)
def test_a_merged_case_without_a_key_of_a_table_is_refused(whole, name, path):
    table = copy.deepcopy(table_of(name))
    *outer, last = path.split(".")
    inner = table
    for part in outer:
        inner = inner[part]
    del inner[last]
    assert not whole.is_valid(table)


def test_a_merged_case_has_the_keys_of_its_kind_alone(whole):
    assert not whole.is_valid(table_of("clamped_free") | {"kind": "rod motion"})
    assert not whole.is_valid(table_of("clamped_free") | {"like": "clamped_free"})
    assert whole.is_valid(table_of("clamped_free") | {"title": "Mine", "source": "here"})


def test_the_schema_takes_every_spelling_of_a_unit_that_the_reader_takes(whole):
    for unit, texts in (READ | {"m/s": ["5 m/s", "18 km/h", "5 m s⁻¹", "5 m s-1", "1 mm/s"]}).items():
        if unit in NAMES:
            validator = Draft202012Validator(whole.schema["$defs"][NAMES[unit]])
            assert [text for text in texts if not validator.is_valid(text)] == [], unit


def test_wrong_units_are_refused_except_those_beyond_a_pattern(whole):
    defs = whole.schema["$defs"]
    passing = [
        text for unit, text, _ in REFUSED if Draft202012Validator(defs[NAMES[unit]]).is_valid(text)
    ]
    assert passing == ["5 m m", "1/0 m", "1e400 m"]


def test_a_wrong_unit_in_the_schema_would_be_seen():
    schema = as_written()
    schema["$defs"]["length"] = schema["$defs"]["mass"]
    broken = Draft202012Validator(schema)
    assert not any(broken.is_valid(tomllib.loads(text)) for text in FILES)


def shown(node, before=""):
    """Paths of the keys of a schema, with what an editor shows of each."""
    for choice in [node, *node.get("anyOf", [])]:
        for name, inner in choice.get("properties", {}).items():
            for alternative in [inner] if "description" in inner else inner["anyOf"]:
                yield before + name, alternative
                yield from shown(alternative, f"{before}{name}.")
        if "items" in choice:
            yield from shown(choice["items"], f"{before[:-1]}[].")


def is_of(node, key):
    """Whether a node says what the list says of a key."""
    unit = getattr(key.value.about, "unit", "")
    texts = [{"$ref": f"#/$defs/{NAMES[unit]}"}] if unit else []
    default = None if key.default is None else tomllib.loads(f"x = {key.default}")["x"]
    return (
        " ".join(key.meaning.split()) in node["description"]
        and json.dumps(node.get("default")) == json.dumps(default)
        and (unit in ("", "1") or (f" in {unit}" in node["description"] and unit in node["examples"][0]))
        and all(text in node["anyOf"] + node["anyOf"][0].get("anyOf", []) for text in texts)
    )


def test_an_editor_is_shown_every_key_with_its_meaning_unit_and_default(written):
    case = written.schema["additionalProperties"]
    found = {}
    for path, node in shown({"properties": case["properties"]}):
        found.setdefault(path, []).append(node)
    listed = [key for kind in described() for key in (*common_keys(), *keys(kind))]
    assert {path for path in found if "like" not in path} == {key.path for key in listed} - {"like"}
    for key in listed:
        assert any(is_of(node, key) for node in found[key.path]), key.path
    together = {choice["title"]: choice["propertyNames"]["enum"] for choice in case["anyOf"]}
    for kind in described():
        assert set(together[kind]) == {
            key.path for key in (*common_keys(), *keys(kind)) if not re.search(r"\W", key.path)
        }


def test_a_fault_is_reported_at_its_key(written):
    places = {
        'rod.length = "3 kg"': "$.mine.rod.length",
        'rod.lenght = "3 m"': "$.mine.rod",
        'gravity.along = "down"': "$.mine.gravity.along",
        'lenght = "3 m"': "$.mine",
    }
    for text, place in places.items():
        assert place in [error.json_path for error in written.iter_errors(mine(text))]


@pytest.mark.parametrize(("options", "made"), [([], as_written), (["--merged"], merged)])
def test_the_command_prints_the_schema(capsys, options, made):
    assert main(["schema", *options]) == 0
    assert json.loads(capsys.readouterr().out) == made()
