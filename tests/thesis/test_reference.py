"""New runs compared with the stored references, and tests of the comparison."""

import numpy as np
import pytest
from conftest import ROOT

import cosserat
from cosserat.errors import InputError
from cosserat.studies.door import published_studies
from cosserat.thesis.table.reference import accept, compare

REFERENCES = ROOT / "results/reference"


@pytest.mark.parametrize("name", [*cosserat.published(), *published_studies()])
def test_results_agree_with_their_references(solved, name):
    changes = compare(solved[name], cosserat.load(REFERENCES / f"{name}.nc"))
    assert changes
    moved = [str(change) for change in changes if not change.held]
    assert not moved, "\n".join(moved)


def test_every_case_has_a_reference_and_every_reference_a_case():
    stored = {file.stem for file in REFERENCES.glob("*.nc")}
    assert stored == set(cosserat.published()) | set(published_studies())


def test_a_study_is_compared_and_accepted_like_a_case(solved, tmp_path):
    data, path = solved["calibration"], tmp_path / "calibration.nc"
    assert accept(data, path, "first answer of this study") == ["no reference was stored before"]
    values = data.necking_misfit.to_numpy().copy()
    values[2] += 1e-6
    moved = changed(data, "necking_misfit", values)
    (held,) = [str(change) for change in compare(moved, data) if not change.held]
    assert held.startswith("necking_misfit: 1e-06 1 at vertices 2 (allowed 1e-07)")
    assert accept(moved, path, "the third mesh was wrong")[0] == held
    history = cosserat.load(path).attrs["history"].split("\n")
    assert history == [
        "cosserat study calibration",
        "first answer of this study",
        "the third mesh was wrong",
    ]


def test_a_study_lacks_values_at_the_same_places_as_its_reference():
    """Of members with fewer vertices the ends are filled."""
    stored = cosserat.load(REFERENCES / "vertices_published.nc")
    assert np.isnan(stored.x).any()
    assert [change.largest for change in compare(stored, stored)] == [0.0] * 3
    with pytest.raises(InputError, match="'x' holds values that are not finite, at other places"):
        compare(stored.assign(x=stored.x.fillna(0.0)), stored)
    with pytest.raises(InputError, match="the study differs from the stored one"):
        compare(cosserat.load(REFERENCES / "vertices_consistent.nc"), stored)


def test_references_are_small():
    assert sum(file.stat().st_size for file in REFERENCES.glob("*.nc")) < 3_800_000


def changed(data, name, values):
    return data.assign({name: data[name].copy(data=values)})


def test_a_changed_value_is_reported_with_its_place(solved):
    data = solved["clamped_free"]
    values = data.u.to_numpy().copy()
    values[7, 1] += 1e-8
    change = next(c for c in compare(changed(data, "u", values), data) if c.variable == "u")
    assert not change.held
    assert change.where == {"vertex": 7, "axis": 1}
    assert str(change).startswith("u: 1e-08 m at vertex 7, axis 1 (allowed")


def test_results_that_cannot_be_compared_are_refused(solved):
    data = solved["clamped_free"]
    bad = data.mu.to_numpy().copy()
    bad[3] = np.nan
    with pytest.raises(InputError, match="'mu' holds values that are not finite"):
        compare(changed(data, "mu", bad), data)
    with pytest.raises(InputError, match="'mu' holds values that are not finite"):
        compare(data, changed(data, "mu", bad))
    other = data.copy()
    other["u"] = other.u.assign_attrs(units="mm")
    with pytest.raises(InputError, match="'u' has attributes .*mm"):
        compare(other, data)
    with pytest.raises(InputError, match="variables differ"):
        compare(data.drop_vars("mu"), data)
    with pytest.raises(InputError, match="attribute 'parameters' differs"):
        compare(data.assign_attrs(parameters=solved["necking"].attrs["parameters"]), data)
    with pytest.raises(InputError, match="shape"):
        compare(data.isel(vertex=slice(1, None)), data)


def test_accepting_needs_a_reason_and_stores_it(solved, tmp_path):
    path = tmp_path / "clamped_free.nc"
    with pytest.raises(InputError, match="says too little"):
        accept(solved["clamped_free"], path, "because")
    assert not path.exists()
    assert accept(solved["clamped_free"], path, "first result of this case") == [
        "no reference was stored before"
    ]
    moved = changed(solved["clamped_free"], "u", solved["clamped_free"].u.to_numpy() * 1.1)
    report = accept(moved, path, "the load was doubled by mistake")
    assert report[0].startswith("u: 0.0036")
    history = cosserat.load(path).attrs["history"]
    assert (
        history
        == "cosserat run clamped_free\nfirst result of this case\nthe load was doubled by mistake"
    )
