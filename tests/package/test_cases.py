"""Cases and parameters: right values are read with their units, bad values are refused with one sentence."""

import pytest
from conftest import ROOT

import cosserat
from cosserat.cases.catalogue import parse
from cosserat.errors import InputError

BEAM = """
[mine]
{like}
{line}
"""


@pytest.fixture
def load_mine(tmp_path):
    def load(line):
        file = tmp_path / "my.toml"
        like = "" if "like" in line else 'like = "clamped_free"'
        file.write_text(BEAM.format(like=like, line=line))
        return cosserat.case("mine", file)

    return load


def test_units_are_converted_to_si(load_mine):
    rod = load_mine(
        'rod.material.young = "2 N/mm^2"\nrod.length = "30 cm"\nrod.section.shear_factor = "5/6"'
    ).problem.rod
    assert rod.young == pytest.approx(2e6)
    assert rod.length == pytest.approx(0.3)
    assert rod.shear_correction == pytest.approx(5 / 6)


def test_python_takes_si_numbers_and_texts():
    case = cosserat.case("clamped_free")
    assert case.vary("a", rod={"length": 2}).problem == case.vary("a", rod={"length": "200 cm"}).problem


def test_python_takes_paths_as_text(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my.toml").write_text(
        '[mine]\nlike = "necking"\n[moving]\nlike = "vibration_consistent"\n'
    )
    assert list(cosserat.load_cases("my.toml")) == ["mine", "moving"]
    data = cosserat.run(cosserat.case("mine", "my.toml"), result="a.nc")
    cosserat.save(data, "a.nc")
    assert cosserat.load("a.nc").identical(data)
    moving = cosserat.case("moving", "my.toml").vary("brief", duration="5 ms")
    assert cosserat.run(moving, result="b.nc").identical(cosserat.run(moving))
    assert (tmp_path / "b.nc.parts").is_dir()


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda case: cosserat.load(5), "5 names no file; give a path as a text or a pathlib.Path"),
        (lambda case: cosserat.save(None, None), "None names no file"),
        (lambda case: cosserat.load_cases(["a"]), r"\['a'\] names no file"),
        (lambda case: cosserat.run(case, result=3), "3 names no file"),
        (
            lambda case: cosserat.case(None),
            "found by its name, a text such as 'clamped_free', not by None",
        ),
        (lambda case: cosserat.case(5), "not by 5"),
        (lambda case: cosserat.case(["a"]), r"not by \['a'\]"),
        (cosserat.case, r"not by <Case .*>|not by Case\("),
        (lambda case: case.vary(5), "'name' is 5; it must be a text"),
        (lambda case: case.vary("../x"), "'name' is '../x', which cannot name a file; use letters"),
        (lambda case: case.vary(""), "'name' is '', which cannot name a file"),
        (lambda case: cosserat.Case(), "'name' is missing.*'title' is missing.*'problem' is missing"),
        (lambda case: cosserat.Case(name="x", title="x"), "Case: 'problem' is missing"),
        (lambda case: type(case.problem.rod)(), "Rod: 'vertices' is missing"),
    ],
)
def test_bad_python_arguments_give_one_sentence(call, sentence):
    with pytest.raises(InputError, match=sentence) as caught:
        call(cosserat.case("necking"))
    assert "\n" not in str(caught.value)


def test_whole_numbers_of_numpy_name_vertices():
    import numpy as np

    case = cosserat.case("clamped_free")
    force = {"at": np.int64(10), "along": "E2", "force": np.float64(3)}
    bent = case.vary("a", forces=[force], rod={"vertices": np.int32(20)})
    assert bent == case.vary("a", forces=[force | {"at": 10}])
    assert parse(bent.model_dump_json()) == bent
    with pytest.raises(InputError, match="'forces.0.at' is np.int64"):
        case.vary("a", forces=[force | {"at": np.int64(-1)}])


def test_vary_changes_nothing_else():
    case = cosserat.case("clamped_free")
    longer = case.vary("longer", rod={"length": 7})
    assert longer.problem.replace(rod=longer.problem.rod.replace(length=5)) == case.problem
    assert case.problem.rod.length == 5


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ('rod.lenght = "5 m"', r"'rod\.lenght' is not a key; did you mean 'length'\?"),
        ("gravty = 3", r"'gravty' is not a key; did you mean 'gravity'\?"),
        ("moments = []", r"'moments' is not a key; did you mean 'couples'\?"),
        ("rod.material.E = 3", r"'rod\.material\.E' is not a key; did you mean 'young'\?"),
        ('kind = "statics"', r"'kind' is 'statics'; did you mean 'rod statics'\?"),
        ('kind = "buckling"', r"'kind' is 'buckling'; did you mean 'critical loads'\?"),
        ('kind = "worm"', r"'kind' is 'worm'; did you mean 'crawl'\?"),
        ("rod.calibration.c9 = 1", r"'rod\.calibration\.c9' is not a key; known are: c1, c2"),
        ("rod.length = 5", r"'rod\.length' is 5, without a unit; write it with its unit"),
        (
            'rod.length = "5 kg"',
            r"'rod\.length' is \"5 kg\", in kg, a mass and not a length; write it with its unit",
        ),
        ('rod.length = "5"', r"'rod\.length' is \"5\", in no unit at all"),
        ('rod.length = "five m"', r"'rod\.length' is \"five m\""),
        ("rod.length = true", r"'rod\.length' is True, not a number"),
        ('rod.length = "nan m"', r"'rod\.length' is 'nan m'; it must be a finite number"),
        ("rod.material.poisson = nan", r"'rod\.material\.poisson' is nan; it must be a finite number"),
        ("rod.material.poisson = inf", r"'rod\.material\.poisson' is inf; it must be a finite number"),
        (
            'rod.material.poisson = "0.3 m"',
            r"'rod\.material\.poisson' is \"0\.3 m\", in m, a length and not a ratio; write a number",
        ),
        ("rod.material.poisson = 0.5", r"'rod\.material\.poisson' is 0\.5; it must be below 0\.5"),
        ("rod.material.poisson = -1", r"'rod\.material\.poisson' is -1; it must be above -1"),
        ('rod.length = "0 m"', r"'rod\.length' is 0 m; it must be above 0"),
        ('rod.length = "-5 m"', r"'rod\.length' is -5 m; it must be above 0"),
        ('rod.material.young = "-1 GPa"', r"'rod\.material\.young' is -1e\+09 Pa; it must be above 0"),
        ('rod.section.height = "0 m"', r"'rod\.section\.height' is 0 m"),
        ("rod.vertices = 2", r"'rod\.vertices' is 2; it must be at least 3"),
        ("rod.vertices = 20.0", r"'rod\.vertices' is 20\.0; it must be a whole number"),
        ('rod.vertices = "20"', r"'rod\.vertices' is '20'; it must be a whole number"),
        ('rod.end_sections = "half"', r"'rod\.end_sections' is 'half'; it must be 'full' or 'halved'"),
        ("rod = 3", r"it must be a table of keys|'rod' is 3"),
        (
            'supports = [{ at = "first", fixed = ["x4"] }]',
            r"'supports\.0\.fixed' has 'x4'; it must be \"clamped\", ",
        ),
        ('supports = [{ at = 20, fixed = ["x3"] }]', r"'at' is 20, but the rod's vertices are 0 to 19"),
        ('supports = [{ fixed = ["x3"] }]', r"'supports\.0\.at' is missing"),
        ('supports = "first"', r"'supports' is 'first'; it must be a list"),
        ("masses = 3", r"'masses' is 3; it must be a list"),
        ("elements = 3", r"'elements' is not a key; known are: rod, supports"),
        ("rod.ground = 3", r"'rod\.ground' is not a key; known are: energy, vertices"),
        (
            'forces = [{ direction = "E2" }]',
            r"'forces\.0\.direction' is not a key; did you mean 'along'\?",
        ),
        ("pins = []", r"'pins' is not a key; known are: rod, supports"),
        ("title = 7", r"'title' is 7; it must be a text"),
        ('kind = "rod static"', r"'kind' is 'rod static'; did you mean 'rod statics'\?"),
        ('like = "clamped_fre"', r"'like' names no case: 'clamped_fre'; did you mean 'clamped_free'\?"),
        ('like = "mine"', r"'like' refers back to itself"),
    ],
)
def test_bad_values_are_refused_with_name_value_and_remedy(load_mine, line, sentence):
    with pytest.raises(InputError, match=sentence) as caught:
        load_mine(line)
    assert "\n" not in str(caught.value)


def test_all_faults_of_a_case_are_named_together(load_mine):
    with pytest.raises(InputError, match="'rod.lenght' is not a key") as caught:
        load_mine('rod.lenght = "5 m"\nrod.material.poisson = 0.7')
    assert "'rod.material.poisson' is 0.7" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            'kind = "rod statics"\nsupports = []\nrod.vertices = 9\nrod.length="1 m"\nrod.section.shape = "rectangle"',
            "'rod.section.height' is missing, height of the section, in the plane of motion, H of section 3.5: write "
            'it with its unit, such as "2.5 m"; ',
        ),
        (
            'kind = "rod statics"\nsupports = []\nrod.vertices = 9\nrod.length="1 m"\nrod.section.shape = "rectangle"',
            "'rod.section.shear_factor' is missing, factor k of the shear stiffness k mu A: write a number above 0",
        ),
        (
            'kind = "rod statics"\nsupports = []\nrod.length = "1 m"',
            "'rod.vertices' is missing, number of vertices of the discrete rod, both ends included, N of eq. (3.3.1): "
            "write a whole number, 3 or more; ",
        ),
        (
            'kind = "rod statics"\nsupports = []',
            "'rod' is missing, a rod of one section and material, section 3.5: write a table with vertices, length, ",
        ),
        (
            'kind = "rod statics"\nsupports = []\nrod.length = "1 m"',
            "'rod.section' is missing, cross-section of the rod: write a table with shape = 'rectangle' or ",
        ),
        (
            'kind = "rod statics"\nsupports = []\nrod.section = { height = "1 m" }',
            "'rod.section.shape' is missing: write 'rectangle' or ",
        ),
        (
            'kind = "rod statics"\nsupports = []\nrod.section = { shape = "cirle" }',
            "'rod.section.shape' is 'cirle'; it must be 'rectangle', ",
        ),
        (
            'like = "clamped_free"\nsupports = [{ fixed = ["x3"] }]',
            '\'supports.0.at\' is missing, the place that is constrained: write "first", "last", the index',
        ),
        (
            'like = "clamped_free"\ngravity = "none"\nforces = [{ at = 1, force = "1 N" }]',
            '\'forces.0.along\' is missing, direction of the force: write "E3", "-E3", "E2", "-E2", an angle',
        ),
        (
            'kind = "crawl"\ncrawler.material.kind = "incompressible"',
            "'crawler.material.young' is missing, young's modulus, E of eq. (2.6.17): write it "
            'with its unit, such as "2.5 Pa"',
        ),
        (
            'kind = "crawl"\nloads.advancing = "1 Pa"',
            "'loads.anchoring' is missing, force of the longitudinal muscles, D of eq. (2.2.7): write it with",
        ),
    ],
)
def test_a_missing_key_is_named_with_its_meaning_its_unit_and_a_remedy(tmp_path, text, sentence):
    file = tmp_path / "my.toml"
    file.write_text(f"[mine]\n{text}\n")
    with pytest.raises(InputError) as caught:
        cosserat.case("mine", file)
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_unknown_cases_and_unreadable_files_are_refused(tmp_path):
    with pytest.raises(InputError, match="there is no case 'clamped_fre'; did you mean 'clamped_free'"):
        cosserat.run("clamped_fre")
    with pytest.raises(InputError, match="cannot read the case file"):
        cosserat.case("mine", tmp_path / "none.toml")
    broken = tmp_path / "broken.toml"
    broken.write_text("[mine\n")
    with pytest.raises(InputError, match=r"broken\.toml is not TOML"):
        cosserat.case("mine", broken)


@pytest.mark.parametrize(
    ("line", "remedy"),
    [
        ("rod.material.poisson = 0,3", "for a decimal comma write a decimal point"),
        ('forces = [{ at = "last", along = "E2", force = -1,5 N }]', "for a decimal comma write"),
        (
            "rod.length = 1.5 m",
            'write a number that has a unit between quotation marks, such as "2.5 mm"',
        ),
        ("rod.material.young = 1e9Pa", "between quotation marks"),
        ("rod.vertices = [1, 2", "in cosserat/thesis/cases"),
        ('rod = { vertices = 9 }\nrod.length = "1 m"', "give each key once"),
        ("rod.vertices = 9\nrod.vertices = 10", "give each key once"),
        ("rod = {\n  vertices = 9 }", "on one line, or write its keys with dots"),
    ],
)
def test_a_number_that_is_not_toml_is_refused_with_its_remedy(tmp_path, line, remedy):
    file = tmp_path / "mine.toml"
    file.write_text(f'[mine]\nlike = "elastica"\n{line}\n')
    with pytest.raises(InputError, match=r"mine\.toml is not TOML: ") as caught:
        cosserat.case("mine", file)
    assert remedy in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("encoding", ["utf-16", "latin-1"])
def test_a_file_in_another_encoding_is_refused_with_the_one_that_is_read(tmp_path, encoding):
    file = tmp_path / "mine.toml"
    file.write_text('[mine]\ntitle = "café"\n', encoding=encoding)
    with pytest.raises(InputError, match=r"mine\.toml is not TOML: .* save it as UTF-8"):
        cosserat.case("mine", file)


def test_a_case_survives_its_own_json():
    for case in cosserat.published().values():
        assert parse(case.model_dump_json()) == case


def test_cases_are_frozen():
    with pytest.raises(Exception, match="frozen"):
        cosserat.case("clamped_free").problem.rod.length = 3


def test_assumptions_of_the_cases_are_marked():
    text = (ROOT / "cosserat/thesis/cases/chapter3.toml").read_text()
    assert text.count("ASSUME") >= 5


def test_lumped_properties_may_vary_along_the_rod():
    """Table 3.1 is an array for each property: a rod stiffer on its right half strains half as much there."""
    import numpy as np

    stations = [{"at": "2.5 m"}, {"at": "2.5 m", "young": 2.0}]
    pulled = cosserat.case("clamped_free").vary(
        "two_halves",
        rod={"vertices": 11, "material": {"poisson": 0}, "stations": stations},
        gravity=None,
        forces=[{"at": "last", "along": "E3", "force": 100.0}],
    )
    strain = cosserat.run(pulled).mu_edge.to_numpy() - 1
    young = np.where(np.arange(10) < 5, 1e9, 2e9)
    np.testing.assert_allclose(strain, 100.0 / (young * 0.25), rtol=1e-5)


def test_a_bad_case_does_not_stop_other_cases_of_its_file(tmp_path):
    file = tmp_path / "my.toml"
    file.write_text('[good]\nlike = "necking"\n[bad]\nlike = "necking"\nrod.length = "5 kg"\n')
    assert cosserat.case("good", file).name == "good"
    with pytest.raises(InputError, match="case 'bad': 'rod.length'"):
        cosserat.case("bad", file)
    with pytest.raises(InputError, match="run takes a case or the name of a published one, not 3"):
        cosserat.run(3)
