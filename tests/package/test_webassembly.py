"""The module of WebAssembly that a page of the book runs; `python -m tests.webassembly` also compiles it anew."""

from decimal import Decimal, localcontext
from fractions import Fraction
from math import atan2

import llvmlite.binding as llvm
import numpy as np
import pytest
import webassembly
from conftest import ROOT

from cosserat.export.webassembly import elementary, pulled
from cosserat.export.webassembly.compiled import FEATURES, TARGET
from cosserat.export.webassembly.linked import module

MODULE = ROOT / "results/pull.wasm"
made = pytest.mark.skipif(not MODULE.is_file(), reason="'make' makes the module")


def sine_and_cosine(x):
    """Both to 50 digits, by their series."""
    term, total = Decimal(1), [Decimal(0), Decimal(0)]
    for n in range(1, 120):
        total[(n - 1) % 2] += term * (-1) ** ((n - 1) // 2)
        term *= x / n
    return total[1], total[0]


def exact(name, *given):
    with localcontext() as context:
        context.prec = 60
        if name == "atan2":
            y, x = map(Decimal, given)
            z = Decimal(atan2(*given))
            for _ in range(2):
                s, c = sine_and_cosine(z)
                t = (y * c - x * s) / (x * c + y * s)
                z += t - t**3 / 3
            return float(Fraction(z))
        s, c = sine_and_cosine(Decimal(given[0]))
        return float(Fraction({"sin": s, "cos": c, "tan": s / c}[name]))


@pytest.mark.parametrize("name", ["sin", "cos", "tan", "atan2"])
def test_elementary_functions_give_the_nearest_float(name):
    rng = np.random.default_rng(5)
    values = rng.uniform(-4, 4, (150, 2)) * 10 ** rng.uniform(-8, 0, (150, 2))
    for one in values[:, : 2 if name == "atan2" else 1].tolist():
        assert getattr(elementary, name)(*one) == exact(name, *one), one


@pytest.mark.parametrize(
    ("y", "x"), [(0, 1), (0, -1), (1, 0), (-1, 0), (0, 0), (1e-30, 1), (-1e-30, -1)]
)
def test_the_angle_of_an_axis_is_that_of_the_standard(y, x):
    assert elementary.atan2(float(y), float(x)) == atan2(y, x)


def object_of(code):
    """The object of some LLVM code."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    machine = llvm.Target.from_triple(TARGET).create_target_machine(features=FEATURES, reloc="static")
    parsed = llvm.parse_assembly(f'target triple = "{TARGET}"\n@pile = global i32 0\n{code}')
    parsed.data_layout = str(machine.target_data)
    return machine.emit_object(parsed)


def test_a_module_has_its_own_memory_and_its_pile_begins_beyond_the_stack():
    code = "define i32 @first() {\n %at = load i32, ptr @pile\n ret i32 %at\n}"
    found = webassembly.Module(module(object_of(code), {"first"}))
    assert found.call("first") >= 1 << 17
    assert found.call("first") < found.exports["memory"].data_len(found.store)


def test_an_object_that_needs_a_function_from_outside_is_refused():
    call = "%y = call double @exp(double %x)\n ret double %y"
    code = f"declare double @exp(double)\ndefine double @one(double %x) {{\n {call}\n}}"
    with pytest.raises(ValueError, match="needs exp"):
        module(object_of(code), {"one"})


@pytest.fixture(scope="module")
def rod():
    return webassembly.Module(MODULE.read_bytes())


@made
def test_the_module_has_the_bits_of_numba(rod, tmp_path):
    """Numba's code is lent the four functions of the module, in a process of its own."""
    lent = webassembly.of_numba_with_our_functions(tmp_path)
    assert lent.shape == (webassembly.STATES, 1 + 9 * 4 * webassembly.VERTICES)
    assert np.isfinite(lent).all()
    assert np.array_equal(webassembly.of_module(rod).view(np.uint64), lent.view(np.uint64))


@made
def test_with_the_functions_of_the_machine_numba_differs_in_the_last_places(rod):
    assert max(webassembly.units_apart(webassembly.of_module(rod), webassembly.of_numba())) <= 4


@made
@pytest.mark.parametrize("way", webassembly.WAYS)
def test_a_dragged_rod_is_where_a_run_puts_it(rod, way):
    room, differences = webassembly.dragged(rod, webassembly.WAYS[way])
    assert room[pulled.DONE] == 1.0
    assert max(differences) <= 1e-9


@made
def test_a_rod_dragged_round_is_in_a_stable_equilibrium(rod):
    far, stable = webassembly.off_balance(rod, webassembly.ROUND)
    assert far <= 1e-9
    assert stable


@made
def test_a_rod_that_is_pushed_straight_falls_to_a_side(rod):
    room = pulled.room_of(webassembly.pulled_case().problem)
    rod.on(room, "pull", -0.003, 0.0)
    assert room[pulled.FALLS] == 0
    straight = np.abs(pulled.dofs(room, webassembly.VERTICES)[:, 1]).max()
    rod.on(room, "pull", -0.002, 0.0)
    assert room[pulled.FALLS] == 1
    assert straight < 1e-9
    assert np.abs(pulled.dofs(room, webassembly.VERTICES)[:, 1]).max() > 1e-3
    far, stable = webassembly.off_balance(rod, [(-0.005, 0.0)])
    assert far <= 1e-9
    assert stable
