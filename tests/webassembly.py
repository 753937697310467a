"""`python -m tests.webassembly` compiles the rod for WebAssembly twice and compares it with Numba and with the package.

It prints the digest of the module and what differs.  The exit code is 1 if anything does.  The functions below are
shared with `tests/package/test_webassembly.py`, which takes the module that `make` has made.
"""

from __future__ import annotations

import functools
import hashlib
import subprocess
import sys

import numpy as np
import wasmtime

import cosserat
from cosserat.export.webassembly import pulled
from cosserat.export.webassembly.build import pulled_rod
from cosserat.solvers.equilibrium import EquilibriumSolver
from cosserat.solvers.potential import HESSIAN
from cosserat.thesis.book.pulling import LENGTH, pulled_case

VERTICES, STATES = 41, 200


class Module:
    """A module of WebAssembly in a runtime that lends it nothing."""

    def __init__(self, code: bytes) -> None:
        engine = wasmtime.Engine()
        made = wasmtime.Module(engine, code)
        assert list(made.imports) == []
        self.store = wasmtime.Store(engine)
        self.exports = wasmtime.Instance(self.store, made, []).exports(self.store)
        self.address = 0

    def call(self, name, *arguments):
        return self.exports[name](self.store, *arguments)

    def on(self, room, name, *arguments):
        """Call a function on an array, which it overwrites."""
        self.address = self.address or self.call("reserve", room.nbytes)
        memory = self.exports["memory"]
        memory.write(self.store, room.tobytes(), self.address)
        result = self.call(name, self.address, room.size, VERTICES, *arguments)
        room[:] = np.frombuffer(memory.read(self.store, self.address, self.address + room.nbytes))
        return result


def random_states(rest):
    """States of the rod, (S, n): half of them rough, half of them curled far."""
    rng = np.random.default_rng(20)
    d = rest.reshape(VERTICES, 2, 2)[:, 1]
    for number in range(STATES):
        if number % 2:
            angle = np.cumsum(rng.normal(0, 0.15, VERTICES)) + rng.uniform(-3, 3)
            edges = np.column_stack([np.cos(angle), np.sin(angle)]) * LENGTH / (VERTICES - 1)
            directors = np.column_stack([-np.sin(angle), np.cos(angle)]) * np.hypot(*d[0])
            state = np.stack([np.cumsum(edges, axis=0), directors], axis=1).ravel()
        else:
            state = rest + rng.normal(0, 3e-4, rest.size)
        yield state - rest + rng.normal(0, 1e-5, rest.size)


def evaluated(room, states, evaluate):
    """Energy, gradient and Hessian of each state, in one row: (S, 1 + 9 n)."""
    rows = []
    for state in states:
        pulled.dofs(room, VERTICES)[:] = state.reshape(VERTICES, 4)
        energy = evaluate(room)
        gradient, band = pulled.derivatives(room, VERTICES)
        rows.append(np.concatenate([[energy], gradient, band.ravel()]))
    return np.array(rows)


@functools.cache
def energy_of_the_package():
    problem = pulled_case().problem
    return problem.energy(problem.geometry)


def by_numba(room):
    """What `evaluate` of the module does, by the kernel of the package as Numba compiles it."""
    own = energy_of_the_package()
    gradient, band = pulled.derivatives(room, VERTICES)
    return own.assemble(pulled.dofs(room, VERTICES).ravel().copy(), gradient, band)


LENT = """
import sys
import llvmlite.binding as llvm
import numpy as np
from numba import cfunc
from cosserat.export.webassembly import elementary

def lend(name, count):
    function = getattr(elementary, name)
    arguments = ", ".join("xyz"[:count])
    place = {"function": function}
    exec(f"def own({arguments}):\\n    return function({arguments})", place)
    lent = cfunc(f"float64({', '.join(['float64'] * count)})")(place["own"])
    llvm.add_symbol(name, lent.address)
    return lent

kept = [lend(*one) for one in (("sin", 1), ("cos", 1), ("tan", 1), ("atan2", 2))]
from tests import webassembly
np.save(sys.argv[1], webassembly.of_numba())
"""
"""A process in which Numba's code finds the four functions of the module in place of those of the machine's library."""


def of_numba():
    room = pulled.room_of(pulled_case().problem)
    rest = room[pulled.HEAD + 4 * VERTICES :][: 4 * VERTICES]
    return evaluated(room, random_states(rest), by_numba)


def of_numba_with_our_functions(folder):
    path = folder / "lent.npy"
    subprocess.run([sys.executable, "-c", LENT, str(path)], check=True)
    return np.load(path)


def of_module(module):
    room = pulled.room_of(pulled_case().problem)
    rest = room[pulled.HEAD + 4 * VERTICES :][: 4 * VERTICES]
    return evaluated(room, random_states(rest), lambda room: module.on(room, "evaluate", HESSIAN))


def units_apart(one, other):
    """Largest difference in units of the last place of the largest number: of energies, gradients and Hessians."""
    n = 4 * VERTICES
    found = []
    for part in (slice(0, 1), slice(1, 1 + n), slice(1 + n, None)):
        unit = np.spacing(np.abs(other[:, part]).max(axis=1))
        found.append(float((np.abs(one[:, part] - other[:, part]).max(axis=1) / unit).max()))
    return tuple(found)


WAYS = {
    "up and back": [(-0.06, 0.08)],
    "in fifty steps": [(-0.0012, 0.0016)] * 50,
    "long": [(0.04, 0.01)],
}
ROUND = [(-0.02, 0.05), (-0.05, 0.02), (-0.02, -0.1)]
"""A way that ends on another path of equilibria than the straight one."""


def dragged(module, way):
    """The array after some pulls, and its differences from `cosserat.run`: displacements [L], force, energy."""
    room = pulled.room_of(pulled_case().problem)
    for by in way:
        module.on(room, "pull", *by)
    u = pulled.dofs(room, VERTICES)
    found = cosserat.run(pulled_case(*map(float, u[-1, :2])))
    shape = np.abs(u - np.column_stack([found.u, found.delta])).max() / LENGTH
    force = found.support_force.to_numpy()[-1, :2]
    hand = room[[pulled.FORCE_3, pulled.FORCE_2]]
    energy = found.energy_parts.to_numpy()[: len(pulled.TERMS)].sum()
    return room, (
        shape,
        np.abs(hand - force).max() / np.abs(force).max(),
        abs(room[pulled.ENERGY] / energy - 1),
    )


def off_balance(module, way):
    """How far a dragged state is from the equilibrium to which the package corrects it [L]; whether that is stable."""
    room = pulled.room_of(pulled_case().problem)
    for by in way:
        module.on(room, "pull", *by)
    u = pulled.dofs(room, VERTICES)
    problem = pulled_case(*map(float, u[-1, :2])).problem
    system = problem.system(problem.geometry)
    solver = EquilibriumSolver(system, problem.newton, "dragged")
    point = solver.correct(u.ravel().copy(), 1.0, system.history)
    return np.abs(point.q - u.ravel()).max() / LENGTH, point.stable


def main() -> int:
    import tempfile
    from pathlib import Path

    code = pulled_rod()
    same = pulled_rod() == code
    print(
        f"module of {len(code)} bytes, sha256 {hashlib.sha256(code).hexdigest()}, again the same: {same}"
    )
    module = Module(code)
    ours = of_module(module)
    with tempfile.TemporaryDirectory() as folder:
        lent = of_numba_with_our_functions(Path(folder))
    bits = np.array_equal(ours.view(np.uint64), lent.view(np.uint64))
    print(f"{STATES} states, Numba with the module's functions: same bits: {bits}")
    plain = of_numba()
    units = units_apart(ours, plain)
    equal = (ours == plain).all(axis=1).sum()
    print(
        f"Numba with the machine's library: {equal} of {STATES} states have the same bits; units in the last place of "
        f"the largest: energy {units[0]:.2g}, gradient {units[1]:.2g}, Hessian {units[2]:.2g}"
    )
    good = same and bits and max(units) <= 4
    for name, way in WAYS.items():
        room, each = dragged(module, way)
        print(f"{name:16} shape {each[0]:.1e}, force {each[1]:.1e}, energy {each[2]:.1e}")
        good &= max(each) <= 1e-9 and room[pulled.DONE] == 1.0
    far, stable = off_balance(module, ROUND)
    print(f"round, on another path: {far:.1e} from an equilibrium of the package, stable: {stable}")
    return 0 if good and far <= 1e-9 and stable else 1


if __name__ == "__main__":
    sys.exit(main())
