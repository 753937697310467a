"""Functions of Numba as one object of WebAssembly: their own LLVM code, with a library of mathematics of our own.

Numba leaves sine, cosine, tangent and arctangent to the machine that it runs on.  Here they are those of
`cosserat.export.webassembly.elementary`, compiled as well.  Memory is taken from a pile that each call puts back, and
reference counts have no meaning.  So nothing is left to be lent by whoever runs the code.

Numba's optimised code has the sizes of pointers of this machine in it.  A process of its own, without optimisation,
gives code without them, which LLVM then optimises for WebAssembly.  No operation on floats changes: there is no
reassociation and no fused product and sum in either.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import llvmlite.binding as llvm
from numba import types as numba_types
from numba.core.dispatcher import Dispatcher
from numba.extending import overload
from numba.np import arrayobj

from cosserat.export.webassembly import elementary
from cosserat.rods.energies.reissner_kernel import assemble
from cosserat.rods.space_kernel import planar
from cosserat.solvers.members import SPACE_KERNEL
from cosserat.solvers.potential import KERNEL

types: Any = numba_types  # which says nothing of its own types

ROOM = types.float64[::1]
"""The first argument of each exported function: all that it reads and writes."""
TARGET = "wasm32-unknown-unknown"
FEATURES = "+bulk-memory"  # to copy and clear memory in one instruction

_MATHEMATICS = {"sin": 1, "cos": 1, "tan": 1, "atan2": 2}
_PLAIN_TYPES = {types.int64: "i32", types.float64: "double"}

_RUNTIME = """
@pile = internal global i32 0
declare i32 @llvm.wasm.memory.size.i32(i32)
declare i32 @llvm.wasm.memory.grow.i32(i32, i32)

define i32 @reserve(i32 %size) {
start:
  %from = load i32, ptr @pile
  %odd = add i32 %from, 63
  %at = and i32 %odd, -64
  %end = add i32 %at, %size
  %pages = call i32 @llvm.wasm.memory.size.i32(i32 0)
  %room = shl i32 %pages, 16
  %fits = icmp ule i32 %end, %room
  br i1 %fits, label %take, label %grow
grow:
  %lack = sub i32 %end, %room
  %more = add i32 %lack, 65535
  %new = lshr i32 %more, 16
  %old = call i32 @llvm.wasm.memory.grow.i32(i32 0, i32 %new)
  %refused = icmp eq i32 %old, -1
  br i1 %refused, label %none, label %take
none:
  ret i32 0
take:
  store i32 %end, ptr @pile
  ret i32 %at
}

define ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %align) {
  %short = trunc i64 %size to i32
  %whole = add i32 %short, 64
  %at = call i32 @reserve(i32 %whole)
  %info = inttoptr i32 %at to ptr
  %none = icmp eq i32 %at, 0
  br i1 %none, label %end, label %fill
fill:
  %first = add i32 %at, 64
  %data = inttoptr i32 %first to ptr
  %count = getelementptr { i64, ptr, ptr, ptr, i64, ptr }, ptr %info, i32 0, i32 0
  store i64 1, ptr %count
  %place = getelementptr { i64, ptr, ptr, ptr, i64, ptr }, ptr %info, i32 0, i32 3
  store ptr %data, ptr %place
  %length = getelementptr { i64, ptr, ptr, ptr, i64, ptr }, ptr %info, i32 0, i32 4
  store i64 %size, ptr %length
  br label %end
end:
  ret ptr %info
}

define void @NRT_incref(ptr %info) {
  ret void
}

define void @NRT_decref(ptr %info) {
  ret void
}

define { i64, i1 } @size_times(i64 %a, i64 %b) {
  %product = mul i64 %a, %b
  %first = insertvalue { i64, i1 } undef, i64 %product, 0
  %both = insertvalue { i64, i1 } %first, i1 false, 1
  ret { i64, i1 } %both
}
"""
"""A pile of memory; `reserve` takes bytes of it and gives their address, or zero where there are no more."""
_NEVER = {
    "NRT_Allocate": "ptr (i64)",
    "NRT_Free": "void (ptr)",
    "NRT_MemInfo_alloc": "ptr (i64)",
    "NRT_MemInfo_new_varsize_dtor": "ptr (i64, ptr)",
    "NRT_MemInfo_varsize_realloc": "ptr (ptr, i64)",
    "NRT_MemInfo_call_dtor": "void (ptr)",
    "log10": "double (double)",
    "PyErr_SetString": "void (ptr, ptr)",
}
"""What only the text of an error needs: a module has none, and stops."""


@dataclass(frozen=True)
class Export:
    """A function for the module under a name.

    function : compiled by Numba; its first argument is an array of floats, `ROOM`.  arguments : types of the others.
    result : its type.
    """

    name: str
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    result: Any


def object_code(exports: list[Export]) -> bytes:
    """A relocatable object of WebAssembly with these functions and `reserve`, for a process without optimisation.

    Without other names: from the same sources and versions the same bytes.
    """
    modules, shells, names = [], [_RUNTIME, *map(_stop, _NEVER)], {"reserve"}
    for name, count in _MATHEMATICS.items():
        function, wanted = getattr(elementary, name), (types.float64,) * count
        ir, symbol = _llvm_of(function, wanted)
        modules.append(ir)
        shells.append(_mathematics_shell(name, symbol, count))
    for export in exports:
        ir, symbol = _llvm_of(export.function, (ROOM, *export.arguments))
        modules.append(ir)
        shells.append(_export_shell(export, symbol))
        names.add(export.name)
    return _optimised(modules, "\n".join(shells), names | set(_MATHEMATICS))


def compile_less() -> None:
    """Let this process compile the functions of the package alone, once each, and not what calls them from Python.

    Numba would compile kernels once more for each task that is a constant, and code that writes arrays' shapes into
    errors.
    """
    for name, module in list(sys.modules.items()):
        if name.startswith("cosserat."):
            for thing in vars(module).values():
                if isinstance(thing, Dispatcher):
                    thing.targetoptions |= {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    for function, signature in ((assemble, KERNEL), (planar, SPACE_KERNEL)):
        function.compile(signature.args)
        function.disable_compile()
    arrayobj.raise_with_shape_context = _refuse_shapes


def _refuse_shapes(source: Any, index: Any) -> None:
    """In place of Numba's function of the same arguments."""


@overload(_refuse_shapes)
def _refuse_shapes_compiled(source: Any, index: Any) -> Callable[..., None]:
    def refuse(source: Any, index: Any) -> None:
        raise ValueError("the shapes of arrays differ")

    return refuse


def _llvm_of(function: Any, arguments: tuple[Any, ...]) -> tuple[str, str]:
    """The LLVM code of a function for some types, with all that it calls, and its symbol there."""
    function.compile(arguments)
    overload = function.overloads[arguments]
    return overload.library.get_llvm_str(), overload.fndesc.mangled_name


def _stop(name: str) -> str:
    """A function that is never to return."""
    result, given = _NEVER[name].split(" ", 1)
    return f"define {result} @{name}{given} noreturn {{\n  call void @llvm.trap()\n  unreachable\n}}\n"


def _mathematics_shell(name: str, symbol: str, count: int) -> str:
    """A function of floats under its plain name."""
    given = [f"double %x{k}" for k in range(count)]
    return _shell(name, "double", given, symbol, given)


def _export_shell(export: Export, symbol: str) -> str:
    """The function (room, its size, other arguments) under its name, which leaves the pile as it was."""
    given, passed, lines = ["ptr %room", "i32 %size"], [], ["%long = sext i32 %size to i64"]
    passed = ["ptr null", "ptr null", "i64 %long", "i64 8", "ptr %room", "i64 %long", "i64 8"]
    for number, kind in enumerate(export.arguments):
        plain = _PLAIN_TYPES[kind]
        given.append(f"{plain} %x{number}")
        if plain == "i32":
            lines.append(f"%y{number} = sext i32 %x{number} to i64")
            passed.append(f"i64 %y{number}")
        else:
            passed.append(f"double %x{number}")
    result = "i64" if export.result is types.int64 else "double"
    return _shell(export.name, result, given, symbol, passed, lines)


def _shell(
    name: str,
    result: str,
    given: list[str],
    symbol: str,
    passed: list[str],
    lines: list[str] | None = None,
) -> str:
    """A function that calls one of Numba, whose first two arguments are places for the result and for an error."""
    plain = "i32" if result == "i64" else result
    types_only = ", ".join(["ptr", "ptr", *(word.rsplit(" ", 1)[0] for word in passed)])
    end = "%value = trunc i64 %full to i32" if result == "i64" else "%value = fadd double %full, -0.0"
    body = [
        "%before = load i32, ptr @pile",
        f"%place = alloca {result}",
        "%error = alloca ptr",
        *(lines or []),
        f'%status = call i32 @"{symbol}"({", ".join(["ptr %place", "ptr %error", *passed])})',
        "store i32 %before, ptr @pile",
        "%failed = icmp ne i32 %status, 0",
        "br i1 %failed, label %stop, label %good",
    ]
    text = "\n  ".join(body)
    return (
        f'declare i32 @"{symbol}"({types_only})\n'
        f"define {plain} @{name}({', '.join(given)}) {{\n  {text}\n"
        "stop:\n  call void @llvm.trap()\n  unreachable\n"
        f"good:\n  %full = load {result}, ptr %place\n  {end}\n  ret {plain} %value\n}}\n"
    )


def _optimised(modules: list[str], shells: str, names: set[str]) -> bytes:
    """One object from the code of several modules."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    machine = llvm.Target.from_triple(TARGET).create_target_machine(
        opt=2, features=FEATURES, reloc="static"
    )
    whole = llvm.parse_assembly(f'target triple = "{TARGET}"\ndeclare void @llvm.trap()\n{shells}')
    whole.data_layout = str(machine.target_data)
    for ir in modules:
        part = llvm.parse_assembly(_for_webassembly(ir))
        part.data_layout = str(machine.target_data)
        whole.link_in(part)
    for thing in (*whole.functions, *whole.global_variables):
        if not thing.is_declaration and thing.name not in names:
            thing.linkage = "internal"
    settings = llvm.create_pipeline_tuning_options(speed_level=2)
    builder = llvm.create_pass_builder(machine, settings)
    builder.getModulePassManager().run(whole, builder)
    whole.verify()
    return bytes(machine.emit_object(whole))


def _for_webassembly(ir: str) -> str:
    """The code of a module of Numba without what is of this machine, and without its reference counts."""
    ir = re.sub(r"^target (triple|datalayout) = .*$", "", ir, flags=re.MULTILINE)
    ir = re.sub(r'"(target-cpu|target-features|probe-stack|tune-cpu)"="[^"]*"', "", ir)
    for name in ("NRT_incref", "NRT_decref"):
        ir = re.sub(
            rf"^define [^\n]*@{name}\(.*?^}}$", f"declare void @{name}(ptr)", ir, flags=re.M | re.S
        )
    ir = re.sub(r"^ *store ptr @\.const\.picklebuf\.\w+, .*$", "", ir, flags=re.MULTILINE)
    ir = re.sub(r"@llvm\.(sin|cos|tan|log10)\.f64", r"@\1", ir)
    ir = re.sub(r"@sqrt\b", "@llvm.sqrt.f64", ir)
    ir = ir.replace("@llvm.smul.with.overflow.i64", "@size_times")
    return ir.replace(" = common ", " = weak ")
