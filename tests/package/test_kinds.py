"""The contract of every kind of problem of the registry.  These tests name no kind."""

import ast
import importlib
import inspect
import io
import itertools

import numpy as np
import pytest
from conftest import ROOT, case_of_kind
from PIL import Image, ImageSequence

import cosserat
from cosserat.cases.catalogue import parse
from cosserat.cli import main
from cosserat.data.checkpoints import Parts
from cosserat.data.dataset import effort
from cosserat.data.provenance import computing_sources
from cosserat.data.variables import COORDINATES, LABELS, VARIABLES
from cosserat.figures.style import settings
from cosserat.kinds import KINDS
from cosserat.problem import Problem
from cosserat.publications import kinds, publications

PACKAGE = ROOT / "cosserat"
NAMES = {  # files of the package that may hold the names of kinds, and why
    "kinds.py": "the registry",
    "thesis/__init__.py": "the registry of what one publication adds",
}
every_kind = pytest.mark.parametrize("kind", kinds())


def concrete(base):
    """The classes below one that can be made."""
    for cls in base.__subclasses__():
        if not inspect.isabstract(cls) and cls.__module__.startswith("cosserat."):
            yield cls
        yield from concrete(cls)


def test_every_class_of_problems_is_registered_once_under_its_own_name():
    for file in computing_sources():
        importlib.import_module(".".join(file.relative_to(ROOT).with_suffix("").parts))
    classes = {name: kind.problem_class() for name, kind in kinds().items()}
    assert {cls.model_fields["kind"].default: cls for cls in concrete(Problem)} == classes
    assert len(classes) == len(set(concrete(Problem)))
    assert len(classes) == len(KINDS) + sum(len(publication.kinds) for publication in publications())


@every_kind
def test_a_result_holds_described_variables_with_their_dimensions(solved, kind):
    data = solved[case_of_kind(kind).name]
    assert set(data.variables) <= set(VARIABLES) | set(LABELS)
    described = [name for name in data.variables if name in VARIABLES]
    assert described
    for name in described:
        about, values = VARIABLES[name], data[name]
        along = [(dim, *about.dims) for dim in ("time", "point", "special")]
        assert values.dims in (about.dims, *along), name
        assert values.attrs["units"] == about.units, name
        assert values.attrs["long_name"] == about.long_name, name
        assert np.isfinite(values).all(), name
    assert set(data.coords) == (set(COORDINATES) | set(LABELS)) & set(data.variables)
    assert data.attrs["case"] == case_of_kind(kind).name


@every_kind
def test_a_result_is_summarised_in_one_line(solved, kind):
    text = effort(solved[case_of_kind(kind).name])
    assert text.strip() == text != ""
    assert "\n" not in text


@every_kind
def test_a_reference_is_thinned_along_dimensions_that_the_result_has(solved, kind):
    case = case_of_kind(kind)
    sizes = solved[case.name].sizes
    for dim, count in case.problem.thinned.items():
        assert sizes.get(dim, 0) > count, (
            f"kind '{kind}' thins '{dim}' to {count}; its result has {dict(sizes)}"
        )


@every_kind
def test_a_result_is_drawn_or_its_picture_is_refused(solved, kind, tmp_path, capsys):
    case = case_of_kind(kind)
    code = main(["plot", str(stored(solved, case)), "-o", str(tmp_path / "picture.svg")])
    said = capsys.readouterr()
    if not kinds()[kind].picture:
        assert code == 2
        assert f"is of kind '{kind}', which has no picture; see it with 'cosserat show'" in said.err
        assert list(tmp_path.iterdir()) == []
        return
    assert (code, said.err) == (0, "")
    with settings():
        axes = kinds()[kind].picture_function()(solved[case.name]).axes
    assert axes
    for ax in axes:
        assert ax.get_xlabel().endswith("]"), ax.get_xlabel()
        assert ax.get_ylabel().endswith("]"), ax.get_ylabel()


@every_kind
def test_a_result_is_animated_or_nothing_moves(solved, kind, tmp_path):
    """A film of as many frames as asked for, each of them another picture."""
    if not kinds()[kind].animate:
        return
    cosserat.animate(solved[case_of_kind(kind).name], tmp_path / "film.gif", frames=3)
    with Image.open(tmp_path / "film.gif") as shown:
        pictures = [np.asarray(frame.convert("L")) for frame in ImageSequence.Iterator(shown)]
    assert len(pictures) == 3
    assert all((one != other).any() for one, other in itertools.pairwise(pictures))


def small_of_kind(kind):
    """A case of that kind that is solved at once, if there is one."""
    small = cosserat.load_cases(ROOT / "tests" / "hostile" / "bases.toml").values()
    return next((case for case in small if case.problem.kind == kind), None) or case_of_kind(kind)


def stored(solved, case):
    """The file of a solved case."""
    assert solved[case.name].attrs["case"] == case.name
    return solved.folder / f"{case.name}.nc"


@every_kind
def test_a_result_runs_its_case_again_and_resumes_after_an_interruption(
    solved, kind, tmp_path, tmp_path_factory, monkeypatch, capsys
):
    """From the text that it carries, to the same bytes; a kind that stores parts is stopped after the first.

    One that stores none is shown by a small case.
    """
    case = case_of_kind(kind)
    in_parts = "run.checkpoints" in inspect.getsource(type(case.problem).solve)
    if in_parts:
        first = stored(solved, case)
    else:
        case, first = small_of_kind(kind), tmp_path_factory.mktemp("first") / "first.nc"
        cosserat.save(cosserat.run(case), first)
    text = cosserat.load(first).attrs["parameters"]
    assert parse(text) == case
    assert parse(case.model_dump_json()) == case
    save, kept = Parts.save, []

    def stop_after_the_first(self, number, part, *, whole=True):
        save(self, number, part, whole=whole)
        kept.append(self.folder / f"{number:05d}.nc")
        if len(kept) == 1:
            raise KeyboardInterrupt

    def run():
        monkeypatch.setattr("sys.stdin", io.StringIO(text))
        return main(["run", "-", "-o", str(tmp_path)])

    monkeypatch.setattr(Parts, "save", stop_after_the_first)
    if in_parts:
        assert run() == 130
        assert [file.name for file in kept[0].parent.iterdir()] == ["00000.nc"]
    assert run() == 0, capsys.readouterr().err
    assert len(set(kept)) == len(kept), "a stored part was computed again"
    assert [file.name for file in tmp_path.iterdir()] == [f"{case.name}.nc"]
    assert (tmp_path / f"{case.name}.nc").read_bytes() == first.read_bytes()


def decisions(tree, words, classes):
    """Places where code decides by the name of a kind, or by the class of a problem, as (line, what)."""

    def texts(node):
        inner = ast.walk(node) if isinstance(node, ast.Tuple | ast.List | ast.Set) else [node]
        return [n.value for n in inner if isinstance(n, ast.Constant)]

    for node in ast.walk(tree):
        held, tested = [], []
        match node:
            case ast.Dict():
                held = [text for key in node.keys if key is not None for text in texts(key)]
            case ast.Compare():
                held = [text for side in (node.left, *node.comparators) for text in texts(side)]
            case ast.MatchValue():
                held = texts(node.value)
            case ast.MatchClass():
                tested = [node.cls]
            case ast.Call(func=ast.Name(id="isinstance")):
                tested = [node.args[1]]
        yield from ((node.lineno, text) for text in held if text in words)
        named = [getattr(n, "id", getattr(n, "attr", "")) for t in tested for n in ast.walk(t)]
        yield from ((node.lineno, name) for name in named if name in classes)


def classes_of_problems():
    """Names of the classes of problems and of their common bases."""
    lines = [kind.problem_class().__mro__ for kind in kinds().values()]
    return {c.__name__ for line in lines for c in line if issubclass(c, Problem)} - {"Problem"}


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ('TABLE = {"crawl": 1}', True),
        ('if kind == "rod statics": pass', True),
        ('if kind in ("rod motion", "rod path"): pass', True),
        ('match kind:\n    case "posture": pass', True),
        ("isinstance(problem, RodStatics)", True),
        ("isinstance(problem, crawl.Crawl | RodProblem)", True),
        ("match problem:\n    case RodMotion(): pass", True),
        ('data["calibration"]', False),
        ('kind: Literal["crawl"] = "crawl"', False),
        ("isinstance(problem, asked)", False),
    ],
)
def test_a_branch_on_the_kind_of_a_problem_is_noticed(source, found):
    assert bool(list(decisions(ast.parse(source), set(kinds()), classes_of_problems()))) == found


def test_only_the_registries_branch_on_the_kind_of_a_problem():
    """So a new kind is a class and an entry, and no other file is edited."""
    words, classes = set(kinds()), classes_of_problems()
    found = {}
    for file in sorted(PACKAGE.rglob("*.py")):
        places = list(decisions(ast.parse(file.read_text()), words, classes))
        if places:
            found[str(file.relative_to(PACKAGE))] = places
    assert set(NAMES) <= set(found), "an exemption that nothing needs"
    assert {name: places for name, places in found.items() if name not in NAMES} == {}
