"""Bad studies and fits by hand: keys that they vary, distributions, read-outs, and tables of other programs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cosserat.publications import FIT, STUDY

from .files import tables
from .judge import Input
from .schema import CASE, MEASURED, file_of
from .values import CONTROL, OPEN, SURE

SOLVE = {word: (word, CASE, "--file", "c.toml", "-o", "c.nc") for word in (STUDY, FIT)}
"""The commands that solve a study and a fit."""
_READ_OUTS = (
    "", " ", "u", "u.E2", "u.E9 at last", "u.E2 at 99", "u.E2 at -1", "u.E2 at 5 m", "u.E2 at 1 kg", "max", "nonsense",
    "max max u.E2", "final u.E2 at last", "u.E2 at last at last", "u.E2 at nan", "u.E2 at 1e400 m", "at last",
    "u.E2 where u.E2 reaches 1", "u.E2 at last where |u.E2| at last reaches 5 kg", "natural_frequency at 0",
    "u.E2 at " + "9" * 5000, "a" * 5000, CONTROL, "max |u.E2", "|u.E2|", "x.E3 at 50 %", "norm kappa", "range xi",
    "__class__ at last", "iterations", "status",
)  # fmt: skip
_VARIED = (
    "", ".", "rod", "rod.", ".rod", "rod.lenth", "rod.length.x", "forces.9.force", "forces.-1.force", "forces.x.force",
    "forces.0", "kind", "like", "rod.rest.kind", "rod.section.shape", "rod.vertices", "a" * 5000, CONTROL, "name",
    "newton", "supports.0.fixed", "rod.length..x", "rod.material.young.0",
)  # fmt: skip
_LAWS: tuple[Any, ...] = (
    5, "x", True, [], {}, {"uniform": []}, {"uniform": ["1 m"]}, {"uniform": ["2 m", "1 m"]}, {"uniform": [1, 2]},
    {"uniform": ["1 m", "1 m"]}, {"uniform": ["1 kg", "2 kg"]}, {"uniform": ["nan m", "1 m"]}, {"uniform": "1 m"},
    {"uniform": ["-1e300 m", "1e300 m"]}, {"uniform": ["1e-300 m", "1e300 m"]}, {"normal": ["1 m", "-1 m"]},
    {"normal": ["1 m", "0 m"]}, {"normal": ["1 m", "1e300 m"]}, {"normal": ["1 m"]}, {"log_uniform": ["0 m", "1 m"]},
    {"log_uniform": ["-1 m", "1 m"]}, {"truncated": ["1 m", "1 m", "5 m", "4 m"]}, {"nonsense": ["1 m", "2 m"]},
    {"truncated": ["1 m", "0.1 m", "90 m", "99 m"]}, {"uniform": ["1 m", "2 m"], "normal": ["1 m", "1 m"]},
)  # fmt: skip
_VALUES: tuple[Any, ...] = (
    5, "1 m", [], [[]], [{}], [True], ["1 m", 5], ["1 kg"], ["nan m"], ["0 m"], ["-1 m"], ["1e300 m", "1e-300 m"],
    ["9" * 400 + " m"], [CONTROL], ["none"], ["1 m"] * 3000, ["1 m^(9^9^9^9)"], [["1 m"]],
)  # fmt: skip
_FACTORS: tuple[Any, ...] = (
    [], [{}], [{"name": "a"}], [{"table": "t.csv"}], [{"table": "none.csv"}], [{"table": "/dev/zero"}],
    [{"table": "."}], [{"sobol": 4, "saltelli": 4, "rod": {"length": []}}],
    [{"sobol": 3, "rod": {"length": {"uniform": ["1 m", "2 m"]}}}],
    [{"sobol": 2**23, "rod": {"length": {"uniform": ["1 m", "2 m"]}}}], [{"rod": {"length": ["1 m"]}}] * 2,
    [{"rod": {"length": [f"1.{n} m" for n in range(300)]}},
     {"rod": {"section": {"height": [f"{n} mm" for n in range(300)]}}}],
    [{"rod": {"length": ["1 m"], "vertices": [5, 6]}}], [{"rod": {"length": ["1 m"], "vertices": [5]}}],
    [{"name": "status", "rod": {"length": ["1 m"]}}], [{"name": "tip", "rod": {"length": ["1 m"]}}],
    [{"name": "a b", "rod": {"length": ["1 m"]}}], [{"names": ["a"], "rod": {"length": ["1 m", "2 m"]}}],
    [{"names": ["a", "a"], "rod": {"length": ["1 m", "2 m"]}}], [{"names": [CONTROL], "rod": {"length": ["1 m"]}}],
    [{"sobol": 4, "covariance": [[-1.0]], "rod": {"length": {"normal": ["1 m"]}}}], [{"rod": {"length": ["1 m"]}}] * 21,
    [{"sobol": 4, "covariance": [[1.0, 2.0]], "rod": {"length": {"normal": ["1 m"]}}}],
    [{"rod": {"vertices": [3, 10**7]}}], [{"rod": {"vertices": [2, -1, 10**30]}}],
)  # fmt: skip
_FREE: tuple[Any, ...] = (
    [], {}, 5, ["rod.lenth"], ["rod"], ["rod.length", "rod.length"], {"rod": {"length": 5}}, {"rod": {"length": []}},
    {"rod": {"length": ["2 m", "1 m"]}}, {"rod": {"length": ["5 m", "6 m"]}}, {"rod": {"length": ["0 m", "1e300 m"]}},
    {"rod": {"vertices": [5, 9]}}, {"rod": {"length": ["1 kg", "2 kg"]}}, {"forces": {"0": {"force": ["0 N", "5 N"]}}},
    ["rod.length", "rod.material.young", "rod.section.height", "rod.section.width"], ["a" * 5000], [CONTROL],
)  # fmt: skip


def inputs() -> Iterator[Input]:
    """All of them."""
    for text in _READ_OUTS:
        yield _study("text inside", text, {"keep": {"tip": text}})
        yield _study("text inside", text, {"keep_whole": [text]})
        yield _fit("text inside", text, {"keep": {"tip": text}})
    for path in _VARIED:
        yield _study("unknown key inside", path, {"vary": [{path: ["1 m", "1.1 m"]}]})
    for law in _LAWS:
        yield _study("type inside", law, {"vary": [{"sobol": 4, "rod": {"length": law}}]})
    for values in _VALUES:
        yield _study("type inside", values, {"vary": [{"rod": {"length": values}}]})
    for factors in _FACTORS:
        yield _study("type inside", factors, {"vary": factors})
    for free in _FREE:
        yield _fit("type inside", free, {"free": free})
    for of in ("c", "none", "", "worm", "calibration", CONTROL, "a" * 5000):
        yield _study("name", of, {"of": of})
        yield _fit("name", of, {"of": of})
    for header, columns in (("rod.length [m]", 1), ("rod.length [m],forces.0.force [N]", 2)):
        for what, rows, _ in tables(header, columns):
            yield _study("CSV", what, {"vary": [{"table": "t.csv"}]}, {"t.csv": rows})
    for what, rows, _ in tables("forces.0.force [N],tip [m]", 2):
        yield _fit("CSV", what, {"data": "t.csv"}, {"t.csv": rows})
    for word, other in (
        (STUDY, FIT),
        (FIT, STUDY),
        ("run", STUDY),
        ("run", FIT),
        ("study", "modes"),
        ("fit", "modes"),
    ):
        given = {"c.toml": file_of(other, {})}
        yield Input(f"command: {word} of {other}", (word, "c", "--file", "c.toml"), given, codes=SURE)


def _study(
    what: str, shown: object, changes: dict[str, Any], more: dict[str, bytes] | None = None
) -> Input:
    return _of(STUDY, what, shown, changes, more or {})


def _fit(
    what: str, shown: object, changes: dict[str, Any], more: dict[str, bytes] | None = None
) -> Input:
    return _of(FIT, what, shown, changes, more or {})


def _of(word: str, what: str, shown: object, changes: dict[str, Any], more: dict[str, bytes]) -> Input:
    files = {"c.toml": file_of(word, changes), **MEASURED, **more}
    return Input(f"{what}: {word}, {str(shown)[:60]!r}", SOLVE[word], files, codes=OPEN)
