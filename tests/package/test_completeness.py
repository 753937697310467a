"""Lists agree with what they list, imports have one direction, and the repository is clean."""

import ast
import builtins
import functools
import importlib
import importlib.metadata
import re
import subprocess

import pytest
from conftest import ROOT
from numba.core.dispatcher import Dispatcher

import cosserat
from cosserat import errors
from cosserat.data.provenance import computing_sources
from cosserat.solvers import kernels
from cosserat.thesis.figures.catalogue import FIGURES
from cosserat.thesis.figures.explored import EXPLORED
from cosserat.thesis.figures.played import PLAYED
from cosserat.thesis.table.errata import read_errata

PACKAGE = ROOT / "cosserat"
ERRATA = read_errata(ROOT / "results/errata.toml")
CHAPTERS = sorted((ROOT / "chapters").glob("*.py"))

# Each room may import from the rooms before it, never from those after it.
ROOMS = (
    "solution",
    "text",
    "errors",
    "arguments",
    "signals",
    "threads",
    "memory",
    "surroundings",
    "reading",
    "units",
    "synonyms",
    "quantities",
    "explain",
    "parameters",
    "tables",
    "problem",
    "kinds",
    "publications",
    "progress",
    "limits",
    "exact",
    "solvers",
    "rods",
    "peristalsis",
    "problems",
    "cases",
    "describe",
    "data",
    "export",
    "runner",
    "studies",
    "figures",
    "thesis",
    "commands",
    "cli",
    "__main__",
)


@functools.cache
def tracked():
    done = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / line for line in done.stdout.splitlines()]


def room_of(module):
    return module.split(".")[1]


@functools.cache
def imports_of(file):
    return tuple(_imports(file))


def _imports(file):
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("cosserat"):
            names = (
                [f"{node.module}.{a.name}" for a in node.names]
                if node.module == "cosserat"
                else [node.module]
            )
            yield from names
        elif isinstance(node, ast.Import):
            yield from (a.name for a in node.names if a.name.startswith("cosserat"))


@pytest.mark.parametrize(
    "file", sorted(PACKAGE.rglob("*.py")), ids=lambda f: str(f.relative_to(PACKAGE))
)
def test_imports_have_one_direction(file):
    own = file.relative_to(PACKAGE).parts[0].removesuffix(".py")
    if own == "__init__":
        return
    for module in imports_of(file):
        assert ROOMS.index(room_of(module)) <= ROOMS.index(own), f"{own} imports {module}"


def test_solvers_import_no_model_and_formulas_import_nothing_of_ours():
    for file in (PACKAGE / "solvers").glob("*.py"):
        assert {room_of(m) for m in imports_of(file)} <= {"errors", "parameters", "solvers"}
    for file in (PACKAGE / "exact").glob("*.py"):
        assert {room_of(m) for m in imports_of(file)} <= {"exact"}


def test_the_library_never_imports_the_thesis():
    """The library for users does not import the part that reproduces one publication."""
    for file in PACKAGE.rglob("*.py"):
        if file.relative_to(PACKAGE).parts[0] != "thesis":
            assert "thesis" not in {room_of(m) for m in imports_of(file)}, file


def test_folders_with_kernels_are_those_with_a_managed_cache():
    holding = {
        str(file.parent.relative_to(PACKAGE))
        for file in computing_sources()
        if re.search(r"^from numba import .*\b(njit|cfunc)\b", file.read_text(), flags=re.MULTILINE)
    }
    assert holding == set(kernels.FOLDERS)


DOFS = ("q", "v", "u", "x", "after", "ends", "end", "middle", "change", "gradient", "force", "step")
PER_VERTEX = (
    4,
    6,
    9,
)  # numbers of DOFs of a vertex that a layout has: in the plane with one director or two, in space


def layouts_in(source):
    """What of a solver's code fits DOFs of one layout only, as text."""
    tree = ast.parse(source)
    known = {
        target.id: node.value.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign | ast.AnnAssign) and isinstance(node.value, ast.Constant)
        for target in getattr(node, "targets", None) or [node.target]
        if isinstance(target, ast.Name)
    }

    def number(node):
        """The whole number that a node is, by itself or by its name; else None."""
        value = known.get(node.id) if isinstance(node, ast.Name) else getattr(node, "value", None)
        return value if type(value) is int else None

    def offsets(node):
        """Whole numbers that an index consists of or is shifted by."""
        if isinstance(node, ast.Slice | ast.Tuple):
            parts = (node.lower, node.upper, node.step) if isinstance(node, ast.Slice) else node.elts
            return [offset for part in parts if part for offset in offsets(part)]
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            return offsets(node.left) + offsets(node.right)
        return [] if number(node) is None else [number(node)]

    def fits_one_layout(node):
        if isinstance(node, ast.Subscript):
            if getattr(node.value, "attr", "") == "shape":
                return False
            of_dofs = getattr(node.value, "id", getattr(node.value, "attr", "")) in DOFS
            alone = of_dofs and number(node.slice) is not None
            return alone or max(offsets(node.slice), default=0) > 1
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.FloorDiv | ast.Mod):
            factors = {number(node.left), number(node.right)}
            return not factors.isdisjoint(PER_VERTEX) or (
                isinstance(node.op, ast.Mod) and factors != {None}
            )
        if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in (
            "reshape",
            "split",
            "array_split",
        ):
            return max((offset for part in node.args for offset in offsets(part)), default=0) > 1
        if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in ("zeros", "empty", "ones"):
            shapes = [part for part in node.args if isinstance(part, ast.Tuple)]
            return not {number(part) for shape in shapes for part in shape.elts}.isdisjoint(PER_VERTEX)
        if isinstance(node, ast.ImportFrom):
            return node.level > 0 or (node.module or "").startswith("cosserat.rods")
        return isinstance(node, ast.Import) and any(
            a.name.startswith("cosserat.rods") for a in node.names
        )

    return [ast.unparse(node) for node in ast.walk(tree) if fits_one_layout(node)]


@pytest.mark.parametrize("file", sorted((PACKAGE / "solvers").glob("*.py")), ids=lambda file: file.stem)
def test_the_solvers_do_not_use_positions_and_directors(file):
    assert layouts_in(file.read_text()) == []


@pytest.mark.parametrize(
    "planted",
    [
        "angle = np.arctan2(q[3], q[2])",
        "left = q[0]",
        "d = q[4 * K + 2]",
        "d = z[p + 2]",
        "d = q[K + 1, 2]",
        "size = n // 4",
        "turn = i % 2",
        "width = 4\nq[width * K]",
        "_PER_VERTEX: int = 9\ncount = _PER_VERTEX * vertices",
        "d = change.reshape(-1, 4)",
        "x = change.reshape(-1, 2, 2)",
        "e = np.diff(q[::4])",
        "d = room.change[2:]",
        "fields = np.zeros((n, 4))",
        "def f():\n    from cosserat.rods.kinematics import PLANAR",
        "from ..rods import kinematics",
        "import cosserat.rods.space",
    ],
)
def test_a_layout_planted_in_a_solver_is_noticed(planted):
    for file in (PACKAGE / "solvers" / "incremental.py", PACKAGE / "solvers" / "banded.py"):
        assert len(layouts_in(file.read_text() + "\n" + planted)) >= 1, planted


@pytest.mark.parametrize(
    "fair",
    [
        "band[j, 2 * width + k] += 1.0",
        "work[j, 0] = y[-2]",
        "q[:0], q[i], mass.shape[2]",
        "v = 2 / h * change[i] - v[i]",
        "rates[done + 1, i]",
        "fields = np.zeros((2, count + 1, n))",
    ],
)
def test_code_that_fits_every_layout_is_accepted(fair):
    assert layouts_in(fair) == []


def test_computing_sources_are_closed_under_import():
    """Every module that a computing source imports is one too: edits rerun simulations and change the digest."""
    computing = set(computing_sources())
    for file in computing:
        for module in imports_of(file):
            stem = PACKAGE.parent / module.replace(".", "/")
            imported = stem / "__init__.py" if stem.is_dir() else stem.with_suffix(".py")
            assert imported in computing, f"{file.relative_to(PACKAGE)} imports {module}"


def test_a_cached_kernel_calls_only_kernels_of_its_own_file():
    """Numba's cache of a function does not see edits of another file, so none may be called from there."""

    for file in computing_sources():
        name = ".".join(file.relative_to(ROOT).with_suffix("").parts)
        module = importlib.import_module(name)
        for value in vars(module).values():
            if isinstance(value, Dispatcher) and value.py_func.__module__ == name:
                called = [vars(module).get(word) for word in value.py_func.__code__.co_names]
                assert all(c.py_func.__module__ == name for c in called if isinstance(c, Dispatcher)), (
                    value
                )


class Collected:
    """A plugin of pytest that keeps the names of the tests that it finds."""

    def pytest_collection_finish(self, session):
        self.names = [item.nodeid for item in session.items]


def test_every_entry_of_the_errata_has_evidence_that_pytest_finds():
    """Parameters included: pytest collects exactly what the entries name, or all parameters of it."""
    asked = sorted({entry.evidence for entry in ERRATA.values()})
    collected = Collected()
    plugins = "terminal", "cacheprovider", "capture", "logging", "faulthandler", "xdist", "pytest_cov"
    without = [word for name in plugins for word in ("-p", f"no:{name}")]
    asked_at = [str(ROOT / name) for name in asked]
    code = pytest.main(["--collect-only", *without, *asked_at], plugins=[collected])
    assert code == 0, "a name that is no test"
    found = collected.names
    assert {name if name in asked else name.split("[")[0] for name in found} == set(asked)


def test_a_test_named_after_an_erratum_names_a_known_one():
    named = {
        f"{match[1]}.{match[2]}"
        for file in (ROOT / "tests").rglob("test_*.py")
        for match in re.finditer(r"^def test_(E\d+)_(\d+)_", file.read_text(), flags=re.MULTILINE)
    }
    assert len(named) > 20
    assert named <= set(ERRATA)


def test_figures_drawn_are_the_figures_shown():
    shown = {
        name
        for file in CHAPTERS
        for name in re.findall(r'page\.(?:figure|player|explore)\(\s*"(\w+)"', file.read_text())
    }
    assert shown == {*FIGURES, *PLAYED, *EXPLORED}


def test_every_row_that_is_attempted_is_shown_in_a_chapter():
    import csv

    prefixes = {
        p
        for f in CHAPTERS
        for call in re.findall(r"page\.rows\(([^)]*)\)", f.read_text())
        for p in re.findall(r'"([^"]+)"', call)
    }
    with (ROOT / "results/tolerances.csv").open(newline="") as file:
        rows = [row["id"] for row in csv.DictReader(file) if row["standing"] != "not attempted"]
    assert not [row for row in rows if not row.startswith(tuple(prefixes))]
    assert not [p for p in prefixes if not any(row.startswith(p) for row in rows)]


EQUATION = r"(?<![\d.])([123]\.\d{1,2}\.\d{1,3})(?![\d.])"


def shown_equations():
    return set(re.findall(r"\\tag\{([\d.]+)\}", "".join(file.read_text() for file in CHAPTERS)))


def test_equations_shown_in_a_chapter_are_cited_in_the_code():
    text = "".join(file.read_text() for file in PACKAGE.rglob("*.py"))
    assert shown_equations() <= set(re.findall(EQUATION, text))
    assert len(shown_equations()) >= 20


def test_equations_of_chapter_3_with_an_errata_entry_are_shown_in_a_chapter():
    """Of an erratum the list of errata shows both forms."""
    doubted = {
        equation
        for entry in ERRATA.values()
        if entry.standing in ("question", "assumption")
        for equation in re.findall(EQUATION, entry.where)
        if equation.startswith("3.")
    }
    assert doubted >= {"3.4.10", "3.5.1", "3.3.41"}
    assert doubted <= shown_equations()


def test_results_are_not_typed_into_chapters():
    """No number of more than three digits stands in a chapter's prose or code outside equations and citations."""
    for file in CHAPTERS:
        text = re.sub(
            r"\$\$.*?\$\$|\$.*?\$|\(\d\.\d+\.\d+\)|\(\d\.\d+\.\d+\)-\(\d\.\d+\.\d+\)",
            "",
            file.read_text(),
            flags=re.DOTALL,
        )
        assert not re.findall(r"\d\.\d{3,}", re.sub(r"\d\.\d+\.\d+", "", text)), file


def called(node):
    """The last word of what is called: `vary` of `case.vary(...)`; None of anything but a call."""
    return (
        getattr(node.func, "attr", getattr(node.func, "id", "")) if isinstance(node, ast.Call) else None
    )


def solved_unchanged(source):
    """What the code gives to `run` that is neither a case of its own file nor varied in some key."""
    tree = ast.parse(source)
    values = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            values.setdefault(node.targets[0].id, []).append(node.value)
        if isinstance(node, ast.For | ast.comprehension) and isinstance(node.target, ast.Name):
            values.setdefault(node.target.id, []).extend(getattr(node.iter, "elts", [node.iter]))

    def is_new(node):
        if isinstance(node, ast.Name):
            return node.id in values and all(map(is_new, values[node.id]))
        own = called(node) in ("case", "find") and len(node.args) > 1
        return own or (called(node) == "vary" and len(node.keywords) > 0)

    runs = [node for node in ast.walk(tree) if called(node) == "run"]
    return [ast.unparse(call) for call in runs if not (call.args and is_new(call.args[0]))]


@pytest.mark.parametrize(
    ("source", "unchanged"),
    [
        ('cosserat.run("necking")', True),
        ('run(cosserat.case("necking"))', True),
        ('bar = cosserat.case("necking")\ncosserat.run(bar)', True),
        ('[cosserat.run(name) for name in ("necking", "worm")]', True),
        ('for name in ["necking"]:\n    cosserat.run(name)', True),
        ('cosserat.run(cosserat.case("necking").vary("mine"))', True),
        ('cosserat.run(cosserat.case("necking").vary("mine", rod={"length": 4}))', False),
        ('bar = cosserat.case("necking").vary("mine", rod={"length": 4})\ncosserat.run(bar)', False),
        ('cosserat.run(cosserat.case("mine", file))', False),
    ],
)
def test_a_published_case_solved_again_is_noticed(source, unchanged):
    assert bool(solved_unchanged(source)) == unchanged


@pytest.mark.parametrize("file", CHAPTERS, ids=lambda file: file.stem)
def test_chapters_solve_no_published_case_again(file):
    assert solved_unchanged(file.read_text()) == []


def test_every_dependency_is_explained_in_the_readme():
    readme = (ROOT / "README.md").read_text()
    asked = re.findall(r"^[a-zA-Z][\w-]*", (ROOT / "requirements.in").read_text(), flags=re.MULTILINE)
    assert [name for name in asked if f"`{name}`" not in readme] == []


def test_nothing_that_a_rule_writes_is_tracked():
    by_hand = ("tolerances.csv", "errata.toml", "left_out.toml")
    allowed = (*by_hand, "peers.csv", "faults.csv", "inputs.csv", "reference", "captions")
    for file in tracked():
        parts = file.relative_to(ROOT).parts
        assert parts[0] != "results" or parts[1] in allowed, file
        assert file.suffix != ".ipynb", file


def test_the_version_is_written_in_one_place():

    version = importlib.metadata.version("cosserat")
    changelog = (ROOT / "CHANGELOG.md").read_text()
    assert f"## {version}" in changelog
    assert f"version: {version}" in (ROOT / "CITATION.cff").read_text()


LONGER = {"energy_momentum.py": 720, "reissner_kernel.py": 430, "climb.py": 1120}
"""Compiled functions that call each other stand in one file."""


def test_modules_and_functions_stay_small():
    for file in PACKAGE.rglob("*.py"):
        text = file.read_text()
        assert text.count("\n") <= LONGER.get(file.name, 400), file
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef) and node.name not in ("assemble", "add_commands"):
                assert node.end_lineno - node.lineno <= 60, f"{file}: {node.name}"


def test_public_names_are_documented():
    for name in cosserat.__all__:
        assert getattr(cosserat, name).__doc__, name


def docstrings_of(tree):
    """Every text that stands as a statement of its own."""
    return [
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    ]


def resolves(name):
    """Whether a dotted name is that of a module or an object; the package or one of its folders may be left out."""
    for place in (
        name,
        *(f"cosserat{folder}.{name}" for folder in ("", ".peristalsis", ".rods.energies")),
    ):
        parts = place.split(".")
        for count in range(len(parts), 0, -1):
            try:
                found = importlib.import_module(".".join(parts[:count]))
            except ImportError:
                continue
            for part in parts[count:]:
                found = getattr(found, part, getattr(found, "model_fields", {}).get(part))
            if found is not None:
                return True
    return False


NAMED_ELSEWHERE = {
    "rod.energy",
    "rod.section",
    "shape",
    "kind",
    "Equilibrium",
    "factor",
    "state",
    "anyOf",
    "oneOf",
}
"""Keys of a case, a class that errors cannot import, attributes of that and of an error, words of schemas."""


def stale_names(source):
    """Names in docstrings, between backquotes or as terms of a list, that stand for nothing in the code."""
    tree = ast.parse(source)
    texts = docstrings_of(tree)
    quoting = set(map(id, texts))
    known = (
        NAMED_ELSEWHERE
        | set(dir(builtins))
        | set(vars(errors))
        | {path.name for path in tracked()}
        | {"report.csv", "stopped.nc", "index.ipynb"}
    )
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in quoting:
            known |= set(re.findall(r"\w+", node.value))
        known |= {getattr(node, key, None) for key in ("id", "arg", "attr", "name", "asname")}
    found = []
    for text in texts:
        quoted = re.findall(r"`([\w./]+)`", text.value)
        terms = re.findall(
            r"(?:^ *|\.  )([^\W\d]\w*(?:, [^\W\d]\w*)*) : ", text.value, flags=re.MULTILINE
        )
        for name in quoted + [name for term in terms for name in term.split(", ")]:
            if name.rsplit("/")[-1] not in known and not resolves(name):
                found.append(name)
    return found


@pytest.mark.parametrize(
    "file", sorted(PACKAGE.rglob("*.py")), ids=lambda f: str(f.relative_to(PACKAGE))
)
def test_docstrings_name_only_existing_names(file):
    assert stale_names(file.read_text()) == []


@pytest.mark.parametrize(
    ("text", "gone"),
    [
        ("Every `legs`-th stop is a frame.", ["legs"]),
        ("branchings : how often a path was left.", ["branchings"]),
        (
            "See `cosserat.models.rod` and `solvers.potential.KERNELS`.",
            ["cosserat.models.rod", "solvers.potential.KERNELS"],
        ),
        (
            "q, step : see `solvers.potential.KERNEL`, `scipy.integrate.solve_bvp` and `results/tolerances.csv`.",
            [],
        ),
    ],
)
def test_a_removed_name_in_a_docstring_is_noticed(text, gone):
    assert stale_names(f'def solve(q, step):\n    """{text}"""') == gone
