"""Sensitivities of a case: `cosserat.sensitivity`."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from cosserat.arguments import TEXTS, taking
from cosserat.cases.catalogue import Case, case_given
from cosserat.data.content import stamped
from cosserat.data.dataset import origin
from cosserat.data.provenance import environment
from cosserat.errors import InputError
from cosserat.studies.answer import cf_unit, derivative_unit
from cosserat.studies.derivatives import Derivatives, Parameter, derivatives, parameter
from cosserat.studies.readouts import ReadOut, read_outs_by_name
from cosserat.threads import solving


@taking(keys=TEXTS)
def sensitivity(case: Case | str, keys: Sequence[str] | str, of: Mapping[str, str]) -> xr.Dataset:
    """Read-outs of a case and their exact derivatives by some of its keys.

    keys : dotted paths of quantities, such as "rod.material.young", "forces.0.force" or "gait.gamma.0.1.1", which is
        the place of the second point of the first track of a front gamma.
    of : read-outs by name, such as {"tip": "u.E2 at last"}.

    The Dataset has each read-out, 'tip'; its derivative by each key, 'tip_by_young', in its own unit; and on the
    dimension 'key' these times the value of the key, 'tip_scaled', all in the unit of the read-out.  The values of the
    keys are coordinates.  'error' is an attribute of each derivative, an estimate from its last extrapolation or from
    round-off, without the errors of the mesh.

    Equilibria, natural modes, critical load factors and their shapes, postures and crawls have derivatives by the
    tangent of the equilibrium, of every instant of a crawl, without another solve.  Those of other kinds, and of crawls
    solved by collocation, are differences of whole solves; the attribute 'method' says which.

    Raises
    ------
    InputError : a key or a read-out is not valid, or a derivative does not exist: at a limit point or a bifurcation,
        where two values share an extreme, or at an end of the range of a key.
    CosseratError : the case has no answer.
    """
    base = case_given(case, "sensitivity")
    name = f"case '{base.name}'"
    paths = [keys] if isinstance(keys, str) else list(keys)
    if not paths or not of:
        raise InputError(
            f"{name}: sensitivity takes keys and read-outs, such as ['rod.length'] and {{'tip': 'u.E2 at last'}}"
        )
    for path, times in Counter(paths).items():
        if times > 1:
            raise InputError(f"{name}: the key '{path}' is given {times} times; give it once")
    parameters = [parameter(base.problem, path, name) for path in paths]
    read_outs = read_outs_by_name(of, name)
    with solving():
        found = derivatives(base.problem, parameters, read_outs, name)
    for sentence in found.missing.values():
        raise InputError(sentence)
    return _dataset(base, parameters, read_outs, found)


def short_names(paths: Sequence[str], taken: Sequence[str]) -> dict[str, str]:
    """Names of keys by path: the last word, or the whole path where that is not unique or taken."""
    last = {path: path.rpartition(".")[2] for path in paths}
    times = Counter(last.values())
    return {
        path: word
        if times[word] == 1 and word not in taken and word.isidentifier()
        else path.replace(".", "_")
        for path, word in last.items()
    }


def _dataset(
    base: Case,
    parameters: Sequence[Parameter],
    read_outs: Sequence[ReadOut],
    found: Derivatives,
) -> xr.Dataset:
    paths = [own.key.path for own in parameters]
    names = short_names(paths, [one.name for one in read_outs])
    coords: dict[str, Any] = {
        "key": (("key",), paths, {"long_name": "key by which derivatives are taken"})
    }
    for own in parameters:
        about = {"units": cf_unit(own.key.unit), "long_name": own.key.meaning, "key": own.key.path}
        coords[names[own.key.path]] = ((), own.value, about)
    variables: dict[str, Any] = {}
    for one in read_outs:
        about = {"units": one.units, "long_name": one.long_name, "read_out": one.text}
        variables[one.name] = ((), found.values[one.name], about)
        for own in parameters:
            derivative = found.by[one.name, own.key.path]
            variables[f"{one.name}_by_{names[own.key.path]}"] = (
                (),
                derivative.value,
                {
                    "units": derivative_unit(one.units, cf_unit(own.key.unit)),
                    "long_name": f"derivative of {one.name} by {own.key.path}",
                    "key": own.key.path,
                    "error": derivative.error,
                },
            )
        scaled = [found.by[one.name, own.key.path].value * own.value for own in parameters]
        about = {
            "units": one.units,
            "long_name": f"derivatives of {one.name} times the values of the keys",
        }
        variables[f"{one.name}_scaled"] = (("key",), np.array(scaled), about)
    dataset = xr.Dataset(variables, coords)
    dataset.attrs = {
        **origin(f"{base.title}: sensitivities", base.source or "a case of the user"),
        "method": found.method,
        "parameters": json.dumps(base.model_dump(mode="json"), sort_keys=True),
        "environment": json.dumps(environment(), sort_keys=True),
    }
    return stamped(dataset)
