"""What is made of an answer: pictures by what is varied, tables, contents, and bands of curves."""

import itertools
import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

import cosserat
from cosserat.cli import main
from cosserat.errors import InputError
from cosserat.figures.answer_points import binned
from cosserat.figures.answers import NO_ANSWER
from cosserat.figures.style import settings
from cosserat.studies.designs import sobol
from cosserat.studies.solving import STATUS


def answer_of(coords, dims, *, failed=()):
    """An answer with two read-outs of any values; failed : numbers of members without an answer."""
    data = xr.Dataset(coords=coords)
    shape = tuple(data.sizes[dim] for dim in dims)
    numbers = [c for c in data.coords.values() if "key" in c.attrs and c.dtype.kind in "fi"]
    total = sum(
        (c / float(c.max()) for c in numbers), xr.zeros_like(data[dims[0]].astype(bool), dtype=float)
    )
    values = (
        total.broadcast_like(xr.DataArray(np.zeros(shape), dims=dims)).transpose(*dims).to_numpy().copy()
    )
    status = np.zeros(shape, dtype=np.int8)
    values.flat[list(failed)] = np.nan
    status.flat[list(failed)] = 2
    reason = np.where(status > 0, "no equilibrium", "").astype(object)
    meanings = {"flag_values": np.arange(7, dtype=np.int8), "flag_meanings": " ".join(STATUS)}
    for name, unit, text in (("tip", "m", "u.E2 at last"), ("most", "m-1", "max |kappa|")):
        data[name] = (dims, values * (2 if name == "most" else 1), {"units": unit, "read_out": text})
    data["status"] = (dims, status, meanings)
    data["reason"] = (dims, reason)
    study = {"name": "beams", "study": {"of": "elastica"}, "case": {"problem": {"kind": "rod statics"}}}
    data.attrs = {"title": "Beams of $2 in a_row", "study": json.dumps(study), "source": "cosserat"}
    return data


def key(name, values, unit, dim=None):
    return {name: (dim or name, values, {"key": f"rod.{name}", "units": unit})}


HEIGHT = key("height", np.linspace(0.006, 0.01, 5), "m")
YOUNG = key("young", np.geomspace(1e8, 1e11, 4), "Pa")
MATERIAL = {
    "material": ("material", ["polyamide", "silicone rubber"]),
    **key("poisson", [0.3, 0.49], "1", "material"),
}
CUBE = sobol(32, 3, 1).cube
POINTS = {
    "member": ("member", np.arange(32), {"units": "1"}),
    **key("width", 1 + CUBE[:, 0], "m", "member"),
    **key("rod_section_height_of_the_second", 1e-3 * CUBE[:, 1], "m", "member"),
    **key("bulk", 10 ** (9 + 2 * CUBE[:, 2]), "Pa", "member"),
}
ANSWERS = {
    "lines": answer_of(HEIGHT, ("height",), failed=[1]),
    "lines by material": answer_of({**MATERIAL, **HEIGHT}, ("material", "height"), failed=[1, 7]),
    "names": answer_of(MATERIAL, ("material",)),
    "maps": answer_of({**HEIGHT, **YOUNG}, ("height", "young"), failed=[0, 19]),
    "maps by material": answer_of({**MATERIAL, **HEIGHT, **YOUNG}, ("material", "height", "young")),
    "points": answer_of(POINTS, ("member",), failed=[3, 4]),
    "points by material": answer_of({**MATERIAL, **POINTS}, ("material", "member"), failed=[3]),
    "three numbers": answer_of(
        {**HEIGHT, **YOUNG, **key("length", [1.0, 2.0], "m")}, ("height", "young", "length")
    ),
}
AXES = {"lines": 2, "lines by material": 2, "names": 2, "maps": 4, "maps by material": 8, "points": 6}
AXES |= {"points by material": 6, "three numbers": 6}


def texts_of(figure):
    """The texts that are drawn, with their boxes."""
    canvas = FigureCanvasAgg(figure)
    with settings():
        figure.draw_without_rendering()
    hidden = set()
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            for tick in {*axis.get_major_ticks(), *axis.get_minor_ticks()} - set(axis._update_ticks()):
                hidden |= {tick.label1, tick.label2}
    found = [
        t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip() and t not in hidden
    ]
    return [(text, text.get_window_extent(canvas.get_renderer()).padded(-1)) for text in found]


@pytest.mark.parametrize("kind", ["lines by material", "maps", "points by material"])
def test_each_kind_of_answer_has_its_picture(kind):
    """All axes with units, nothing outside and nothing on something else, members without an answer marked."""
    data = ANSWERS[kind]
    figure = cosserat.plot(data)
    assert len(figure.axes) == AXES[kind]
    for ax in figure.axes:
        labels = [ax.get_xlabel(), ax.get_ylabel()]
        assert all(label.endswith("]") or label in ("", "material") for label in labels), labels
    units = " ".join(ax.get_ylabel() for ax in figure.axes)
    assert "tip [m]" in units
    assert "most [m$^{-1}$]" in units
    texts = texts_of(figure)
    for text, box in texts:
        assert figure.bbox.padded(1).contains(box.x0, box.y0), text
        assert figure.bbox.padded(1).contains(box.x1, box.y1), text
    for (one, a), (other, b) in itertools.combinations(texts, 2):
        assert not a.overlaps(b), f"{one} and {other}"
    said = [text.get_text() for text, _ in texts]
    failed = int((data.status > 1).sum())
    assert (NO_ANSWER in said) == (failed > 0)
    assert any(
        f"{data.status.size - failed} of {data.status.size} members solved" in line for line in said
    )
    assert any(line.startswith(r"Beams of \$2 in a_row") for line in said)


def test_lines_and_maps_show_the_values():
    data = ANSWERS["lines by material"]
    drawn = [
        line
        for line in cosserat.plot(data).axes[0].lines
        if line.get_label() in ("polyamide", "silicone rubber")
    ]
    for line, values in zip(drawn, data.tip.to_numpy(), strict=True):
        assert np.array_equal(line.get_ydata(), values, equal_nan=True)
    ax = cosserat.plot(ANSWERS["maps"]).axes[0]
    assert np.array_equal(
        ax.collections[0].get_array().filled(np.nan), ANSWERS["maps"].tip, equal_nan=True
    )
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "linear")
    crosses = next(line for line in ax.lines if line.get_label() == NO_ANSWER)
    assert np.allclose(crosses.get_xydata(), [[1e8, 0.006], [1e11, 0.01]])


def test_main_effects_are_conditional_means():
    x = np.arange(80.0)[::-1]
    places, means = binned(x, x**2)
    groups = np.arange(80.0).reshape(10, 8)
    assert np.allclose(places, groups.mean(axis=1))
    assert np.allclose(means, (groups**2).mean(axis=1))
    places, means = binned(np.array([1.0, 2, 1, 2]), np.array([0.0, 1, 4, 5]))
    assert (places.tolist(), means.tolist()) == ([1, 2], [2, 3])
    ax = cosserat.plot(ANSWERS["points"]).axes[0]
    there = ANSWERS["points"].status.to_numpy() < 2
    line = next(line for line in ax.lines if line.get_label() == "mean of members nearby")
    assert np.allclose(
        line.get_ydata(),
        binned(ANSWERS["points"].width.to_numpy()[there], ANSWERS["points"].tip.to_numpy()[there])[1],
    )


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (ANSWERS["lines"].drop_vars(["tip", "most"]), "keeps no read-out to draw"),
        (answer_of(HEIGHT, ("height",), failed=range(5)), "has no member with an answer"),
        (ANSWERS["lines"].isel(height=0), "is one member of an answer"),
        (ANSWERS["lines by material"].isel(material=[0, 1] * 5), "would have 10 lines in a panel"),
        (ANSWERS["maps by material"].isel(material=[0, 1] * 4), "would have 8 maps beside each other"),
    ],
)
def test_what_cannot_be_drawn_is_one_sentence(data, sentence):
    with pytest.raises(InputError, match=sentence):
        cosserat.plot(data)


def test_a_table_of_an_answer_has_a_row_for_each_member():
    table = cosserat.to_dataframe(ANSWERS["lines by material"])
    assert list(table) == [
        "material",
        "poisson [1]",
        "height [m]",
        "tip [m]",
        "most [m-1]",
        "status",
        "reason",
    ]
    assert table["material"].tolist() == ["polyamide"] * 5 + ["silicone rubber"] * 5
    assert table["height [m]"].tolist() == 2 * ANSWERS["lines by material"].height.to_numpy().tolist()
    assert (
        table["status"].tolist()
        == ["solved", "not_converged"] + ["solved"] * 5 + ["not_converged"] + ["solved"] * 2
    )
    assert table["tip [m]"].isna().tolist() == (table["status"] != "solved").tolist()
    with pytest.raises(InputError, match="no place 'vertex'"):
        cosserat.to_dataframe(ANSWERS["lines"], "vertex")


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """A small study with a whole variable, as a file."""
    factor = {
        "sobol": 8,
        "forces.0.force": {"uniform": [0.5, 4.0]},
        "rod.material.young": {"uniform": [1e9, 2e9]},
    }
    answer = cosserat.study(
        "elastica",
        [{"rod.section.height": [8e-3, 9e-3]}, factor],
        {"tip": "u.E2 at last"},
        keep_whole=["u"],
        name="tips",
        progress=lambda *_: None,
    )
    path = tmp_path_factory.mktemp("answers") / "tips.nc"
    cosserat.save(answer, path)
    return path


def test_show_prints_factors_counts_and_ranges(file, tmp_path, capsys):
    assert main(["show", str(file)]) == 0
    out = capsys.readouterr().out
    tip = cosserat.load(file).tip
    for line in (
        "a study of 'elastica', rod statics: 16 of 16 members solved",
        "  height (2)",
        "    young ",
        f"{float(tip.min()):.7g} {float(tip.max()):>14.7g} m      u.E2 at last",
        "  u (height, member, vertex, axis)",
    ):
        assert line in out
    data = ANSWERS["points"].assign_attrs(Conventions="CF-1.11 cosserat-1")
    cosserat.save(data, tmp_path / "failed.nc")
    assert main(["show", str(tmp_path / "failed.nc")]) == 0
    assert "reasons\n  2 not converged: no equilibrium" in capsys.readouterr().out


def test_export_and_plot_take_the_file_of_an_answer(file, tmp_path, capsys):
    assert main(["export", str(file), "-o", str(tmp_path / "a.csv")]) == 0
    read = pd.read_csv(tmp_path / "a.csv", keep_default_na=False)
    assert (read["tip [m]"].to_numpy() == cosserat.load(file).tip.to_numpy().ravel()).all()
    assert main(["plot", str(file), "-o", str(tmp_path / "a.png")]) == 0
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    capsys.readouterr()
    for words, sentence in (
        (("export", str(file), "--to", "vtk"), "holds the answer of a study, without a body; write csv"),
        (
            ("plot", str(file), "--animate", str(tmp_path / "a.gif")),
            "holds the answer of a study, without a motion",
        ),
    ):
        assert main(list(words)) == 2
        assert sentence in capsys.readouterr().err


def test_what_is_not_of_one_case_says_so_in_place_of_a_picture_a_motion_or_a_body(tmp_path, capsys):
    base = cosserat.case("elastica").vary("small", rod={"vertices": 7})
    points = {"saltelli": 4, "rod": {"length": {"uniform": ["1 m", "1.2 m"]}}}
    study = cosserat.study(base, [points], {"tip": "u.E2 at last"})
    made = {
        "sensitivities": cosserat.sensitivity(base, ["rod.length"], {"tip": "u.E2 at last"}),
        "the answer of a design": cosserat.design(
            base, {"rod.length": ("0.9 m", "1.2 m")}, "max |kappa|"
        ),
        "indices": cosserat.indices(study, "tip"),
        "quantiles of a study": cosserat.bands(study, "tip"),
    }
    for content, answer in made.items():
        path = str(tmp_path / "a.nc")
        cosserat.save(answer, path)
        for words, lacking in (
            (("export", path, "--to", "vtk"), "a body"),
            (("plot", path, "--animate", str(tmp_path / "a.gif")), "a motion"),
            (("plot", path), "a picture"),
        ):
            if "bands" not in answer.attrs or lacking != "a picture":
                assert main(list(words)) == 2
                assert f"a.nc holds {content}, without {lacking}; " in capsys.readouterr().err
        for words in (("show", path), ("export", path, "--to", "csv")):
            assert main(list(words)) == 0
            assert capsys.readouterr().err == ""


def test_bands_are_quantiles_of_the_members(file, tmp_path):
    answer = cosserat.load(file)
    found = cosserat.bands(answer, "u", (0.25, 0.5, 1.0))
    rows = answer.u.transpose("height", "member", ...).to_numpy()
    assert found.u.dims == ("height", "quantile", "vertex", "axis")
    for k, level in enumerate((0.25, 0.5, 1.0)):
        assert np.array_equal(found.u[:, k], np.quantile(rows, level, axis=1))
    assert found.u.units == "m"
    assert found.used.to_numpy().tolist() == [8, 8]
    cosserat.save(found, tmp_path / "bands.nc")
    figure = cosserat.plot(tmp_path / "bands.nc", tmp_path / "bands.svg")
    assert [ax.get_ylabel() for ax in figure.axes] == ["u E3 [m]", "u E2 [m]"]
    texts = texts_of(figure)
    for (one, a), (other, b) in itertools.combinations(texts, 2):
        assert not a.overlaps(b), f"{one} and {other}"
    assert {"height = 0.008 m: 25 to 100 %", "height = 0.009 m: median"} <= {
        t.get_text() for t, _ in texts
    }


def test_bands_leave_out_failed_members_and_count_them(file):
    answer = cosserat.load(file)
    answer["status"][0, 2] = 5
    answer["u"][0, 2] = np.nan
    found = cosserat.bands(answer, "u", [0.5])
    assert found.used.to_numpy().tolist() == [7, 8]
    left = np.delete(answer.u.to_numpy()[0], 2, axis=0)
    assert np.array_equal(found.u[0, 0], np.quantile(left, 0.5, axis=0))


def test_bands_that_have_no_meaning_are_one_sentence(file):
    answer = cosserat.load(file)
    for data, how, sentence in (
        (answer, {"of": "x"}, "has no variable 'x' of its members"),
        (answer, {"of": "u", "quantiles": [1.5]}, "they must be between 0 and 1"),
        (
            answer,
            {"of": "u", "over": "width"},
            "no members along 'width'; its factors are along height, member",
        ),
        (answer.isel(member=0), {"of": "u"}, "has no random points, only lists of values"),
        (answer.isel(member=[0]), {"of": "u"}, "has 1 members with an answer"),
        (
            answer.assign_coords(trajectory=("member", np.arange(8))),
            {"of": "u"},
            "no sample of their distributions",
        ),
    ):
        with pytest.raises(InputError, match=sentence):
            cosserat.bands(data, **how)
    with pytest.raises(InputError, match="has no curve"):
        cosserat.plot(cosserat.bands(answer, "tip"))
