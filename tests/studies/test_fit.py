"""Fits: against linear regression in closed form, and true values of noisy data."""

import numpy as np
import pytest
from scipy import stats

import cosserat
from cosserat.cli import main
from cosserat.errors import InputError, NotConvergedError
from cosserat.studies.analysis import fit as fits

from . import fit as coverage

PULLS = np.array([10.0, 20.0, 30.0, 40.0, 50.0, 60.0])
NOISE = np.array([0.3, -0.2, 0.4, -0.1, -0.35, 0.2]) * 1e-6
OF = {"end": "u.E3 at last"}


def bar(**rod):
    """A bar pulled at its end: u = F L / (E A), E A = 1e5 N."""
    section = {"height": 0.01, "width": 0.01}
    rod = {"vertices": 5, "length": 1.0, "section": section} | rod
    pull = [{"at": "last", "along": "E3", "force": 1.0}]
    return cosserat.case("elastica").vary("bar", rod=rod, forces=pull)


def test_a_fit_of_a_bar_is_linear_regression_through_the_origin():
    """The compliance 1 / E has a closed form: estimate, standard error and Student's t."""
    deviations = np.array([1.0, 2.0, 1.0, 3.0, 2.0, 1.0]) * 1e-7
    ends = PULLS / 1e5 + NOISE
    data = {"forces.0.force": PULLS, "end": ends, "end_deviation": deviations}
    found = cosserat.fit(bar(material={"young": 0.5e9}), data, ["rod.material.young"], OF)
    per, weights = PULLS / 1e-4, 1 / deviations**2
    compliance = (weights * per * ends).sum() / (weights * per**2).sum()
    left = ends - compliance * per
    variance = (weights * left**2).sum() / (PULLS.size - 1)
    error = np.sqrt(variance / (weights * per**2).sum()) / compliance**2
    reach = stats.t.ppf(0.975, PULLS.size - 1) * error
    assert found["young"].item() == pytest.approx(1 / compliance, rel=1e-7)
    assert found["young_error"].item() == pytest.approx(error, rel=1e-5)
    assert found["young_high"].item() - found["young_low"].item() == pytest.approx(2 * reach, rel=1e-5)
    assert found["end_residual"].to_numpy() == pytest.approx(left, abs=1e-12)
    assert found.attrs["reduced_chi_square"] == pytest.approx(variance, rel=1e-5)


def test_intervals_hold_the_true_values_of_an_elastica():
    """Seed 0 of those that `python -m tests.studies.fit` counts."""
    found = coverage.fitted(0)
    assert all(coverage.holds(found).values())
    assert found["correlation"].to_numpy() == pytest.approx(found["correlation"].to_numpy().T)
    assert 0.2 < found.attrs["reduced_chi_square"] < 3


def test_a_file_with_units_and_cells_that_were_not_measured(tmp_path):
    rows = ["forces.0.force [kN], end [um], end_deviation [um]"]
    rows += [f"{pull / 1e3}, {'' if pull == 30 else pull * 10}, 0.1" for pull in PULLS]
    (tmp_path / "data.csv").write_text("\n".join(rows))
    found = cosserat.fit(bar(), tmp_path / "data.csv", {"rod.material.young": ("0.1 GPa", "9 GPa")}, OF)
    assert found["young"].item() == pytest.approx(1e9, rel=1e-9)
    assert np.isnan(found["end_measured"].to_numpy()).tolist() == [
        False,
        False,
        True,
        False,
        False,
        False,
    ]
    assert found["force"].attrs["units"] == "N"
    cosserat.save(found, tmp_path / "fit.nc")
    stored = cosserat.load(tmp_path / "fit.nc")
    assert stored["young_high"].item() == found["young_high"].item()
    figure = cosserat.plot(stored, tmp_path / "fit.svg")
    values, residuals = figure.axes
    assert values.get_xlabel() == "end, fitted [µm]"
    shown = residuals.get_lines()[-1].get_ydata() * np.sqrt(found.attrs["reduced_chi_square"]) * 1e-7
    assert np.nan_to_num(shown) == pytest.approx(np.nan_to_num(found["end_residual"].to_numpy()))


@pytest.mark.parametrize(
    ("data", "free", "said"),
    [
        ({"end": [1e-4]}, ["rod.material.young"], "1 measured values cannot determine 1 keys"),
        ({"end": [1e-4] * 3, "rod.length": [1.0] * 3}, ["rod.length"], "free and a column"),
        ({"tip": [1e-4] * 3}, ["rod.length"], "no column end"),
        ({"end": [1e-4] * 3}, {"rod.length": (3.0, 2.0)}, "is empty"),
        ({"end": [1e-4] * 3}, {"rod.length": (2.0, 3.0)}, "begin inside"),
        ({"end": [1e-4] * 3, "end_deviation": [1, 0, 1]}, ["rod.length"], "must be above 0"),
        (
            {"forces.0.force": PULLS, "end": PULLS / 1e5},
            ["rod.section.width", "rod.material.young"],
            "do not determine the relative change",
        ),
    ],
)
def test_what_cannot_be_fitted_is_said_in_one_sentence(data, free, said):
    with pytest.raises(InputError, match=said):
        cosserat.fit(bar(), data, free, OF)


def test_a_fit_in_a_case_file_by_the_command_line(tmp_path, capsys):
    rows = [
        "forces.0.force [kN], end [um]",
        *(f"{pull / 1e3}, {pull * 10 + 1e6 * off}" for pull, off in zip(PULLS, NOISE, strict=True)),
    ]
    (tmp_path / "measured.csv").write_text("\n".join(rows))
    (tmp_path / "my.toml").write_text(
        """
        [bar]
        like = "elastica"
        rod = { vertices = 5, section = { height = "10 mm", width = "10 mm" } }
        forces = [{ at = "last", along = "E3", force = "1 N" }]
        [stiffness]
        kind = "fit"
        of = "bar"
        data = "measured.csv"
        free.rod.material.young = ["0.1 GPa", "10 GPa"]
        keep.end = "u.E3 at last"
        """
    )
    assert list(cosserat.load_cases(tmp_path / "my.toml")) == ["bar"]
    ended = main(["fit", "stiffness", "--file", str(tmp_path / "my.toml"), "-o", str(tmp_path)])
    assert not ended
    said = capsys.readouterr().out
    found = cosserat.load(tmp_path / "stiffness.nc")
    assert f"young = {found['young'].item():.6g} Pa" in said
    assert found["young_low"].item() < 1e9 < found["young_high"].item()
    with pytest.raises(InputError, match="is a fit, not a case"):
        cosserat.cases.catalogue.find("stiffness", tmp_path / "my.toml")


TIP = {"tip": "u.E2 at last"}
STIFFNESS = {"rod.material.young": ("0.5 GPa", "2 GPa"), "rod.section.height": ("5 mm", "20 mm")}
FORCES = np.array([0.5, 1.0, 2.0, 3.0, 4.0])


@pytest.fixture(scope="module")
def tips():
    """The case's own tips, without noise: E h^3 decides them, but for stretch and shear."""
    found = cosserat.study("elastica", {"forces.0.force": FORCES.tolist()}, keep=TIP)
    return {"forces.0.force": FORCES, "tip": found["tip"].to_numpy()}


def test_a_search_that_does_not_end_names_what_the_data_leave_open(tips, monkeypatch):
    """It asked for ranges, which were given."""
    monkeypatch.setattr(fits, "_MOST_STEPS", 6)  # it does not end in a hundred either
    start = cosserat.case("elastica").vary("start", rod={"material": {"young": 9e8}})
    named = r"determine the relative change .0.95 'rod.material.young' .0.32 'rod.section.height'"
    with pytest.raises(NotConvergedError, match=named + ".*fix one of these keys"):
        cosserat.fit(start, tips, STIFFNESS, TIP)


@pytest.mark.filterwarnings("error")
def test_exact_data_of_a_nearly_open_direction_give_a_warning_and_no_error_of_zero(tips):
    """Their standard errors were 0, their correlation no number, and nothing was said."""
    found = cosserat.fit("elastica", tips, STIFFNESS, TIP)
    assert found["young"].item() == pytest.approx(1e9, rel=1e-6)
    assert 0 < found["young_error"].item() < 1e-4 * found["young"].item()
    assert found["correlation"].to_numpy() == pytest.approx(np.array([[1, -1], [-1, 1]]), abs=1e-6)
    open_direction, residuals = found.attrs["warnings"].split("\n")
    assert "-0.95 'rod.material.young' +0.32 'rod.section.height'" in open_direction
    assert residuals.startswith("residuals: the fit meets the data to the round-off of the solves")


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("deviation", ["1e-300 m", 1e300])
def test_deviations_without_squares_are_refused_with_a_range(tips, deviation):
    with pytest.raises(InputError, match="standard deviation of 'tip' is .*; give it from .* to"):
        cosserat.fit("elastica", tips, ["rod.material.young"], TIP, deviations={"tip": deviation})


@pytest.mark.filterwarnings("error")
def test_measured_values_without_squares_are_refused(tips):
    with pytest.raises(
        InputError, match=r"'tip' has the measured value 1e\+300; give values up to 1e\+30"
    ):
        cosserat.fit("elastica", tips | {"tip": [1e300] * 5}, ["rod.material.young"], TIP)
