"""Results for other programs: a table holds every number where it was computed; bodies have their size."""

import csv
import itertools
import sys
from types import SimpleNamespace
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
import xarray as xr
from conftest import case_of_kind, save_own

import cosserat
from cosserat.cli import main
from cosserat.export import mesh, table
from cosserat.publications import kinds


def call(capsys, *arguments):
    code = main([str(argument) for argument in arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def name_of_kind(kind):
    return case_of_kind(kind).name


def two_instants(data):
    """A result with its first and its last instant only."""
    return data.isel({dim: [0, -1] for dim in table.INSTANTS if dim in data.sizes})


@pytest.mark.parametrize("kind", kinds())
def test_the_table_of_any_kind_holds_every_number_and_no_other(solved, kind):
    data = two_instants(solved[name_of_kind(kind)])
    found = cosserat.to_dataframe(data)
    instants = [c for c in found.columns if c in (*table.INSTANTS, "time [s]")]
    assert not found.duplicated(["place", "number", *instants]).any()
    for name, values in data.variables.items():
        if values.dtype.kind not in "fi":
            continue
        units = f" [{values.attrs['units']}]"
        held = [
            c
            for c in found.columns
            if c.endswith(units) and (c == name + units or c.startswith(f"{name}_"))
        ]
        assert held, name
        cells = found[held].to_numpy()
        assert set(np.unique(values)) <= set(cells[~np.isnan(cells)]), name
    numbers = np.concatenate(
        [v.to_numpy().ravel() for v in data.variables.values() if v.dtype.kind in "fi"]
    )
    names = [c for c in found.columns if c in ("place", "number") or c.endswith("_name")]
    cells = found.drop(columns=names).to_numpy(dtype=float, na_value=np.nan)
    extra = {0.0, 1.0} if set(data.sizes) & set(table.INSTANTS) else set()  # their numbers
    assert set(cells[~np.isnan(cells)]) <= set(numbers) | extra


def test_a_motion_is_a_row_for_each_vertex_at_each_time(solved):
    """Against the tables that xarray itself makes of single variables."""
    data = solved["tumbling"]
    found = cosserat.to_dataframe(data, "vertex").set_index(["time [s]", "number"])
    for axis in ("E3", "E2"):
        expected = data.x.sel(axis=axis, drop=True).to_series()
        np.testing.assert_array_equal(found[f"x_{axis} [m]"].to_numpy(), expected.to_numpy())
        assert list(found.index) == list(expected.index)
    first = found.loc[data.time[7].item()]
    np.testing.assert_array_equal(first["xi [m]"], data.xi)
    np.testing.assert_array_equal(first["x_ref_E2 [m]"], data.x_ref.sel(axis="E2"))
    whole = cosserat.to_dataframe(data, "whole")
    np.testing.assert_array_equal(whole["momentum_E3 [kg m s-1]"], data.momentum.sel(axis="E3"))
    assert list(whole["time [s]"]) == list(data.time)


def test_nothing_is_interpolated_and_nothing_of_the_whole_is_repeated(solved):
    found = cosserat.to_dataframe(solved["elastica"])
    edges = found[found["place"] == "edge"]
    np.testing.assert_array_equal(edges["shear [rad]"], solved["elastica"].shear)
    assert edges["x_E2 [m]"].isna().all()
    assert found.loc[found["place"] != "edge", "shear [rad]"].isna().all()
    assert found["energy_parts_bending [J]"].notna().sum() == 1


def test_the_points_of_a_path_have_their_load_in_every_row(solved):
    data = solved["column_path"]
    found = cosserat.to_dataframe(data, "vertex").dropna(subset="point")  # without special points
    assert list(found["point"]) == sorted(list(range(data.sizes["point"])) * data.sizes["vertex"])
    np.testing.assert_array_equal(found.groupby("point")["load_factor [1]"].first(), data.load_factor)


def test_special_points_of_a_path_are_rows_of_their_own():
    """Of the same name twice, beside the points of the path."""
    fields = {
        "x": (("point", "vertex"), np.arange(6.0).reshape(2, 3), {"units": "m"}),
        "special_x": (("special", "vertex"), np.arange(6.0, 12).reshape(2, 3), {"units": "m"}),
        "special_load": (("special",), np.array([0.3, 0.7]), {"units": "1"}),
        "xi": (("vertex",), np.array([0.0, 1, 2]), {"units": "m"}),
    }
    data = xr.Dataset(fields, {"special": ["bifurcation", "bifurcation"]})
    found = cosserat.to_dataframe(data, "vertex")
    assert list(found["x [m]"].dropna()) == [0, 1, 2, 3, 4, 5]
    special = found[found["special"].notna()]
    assert list(special["special_x [m]"]) == [6, 7, 8, 9, 10, 11]
    assert list(special["special"]) == [0, 0, 0, 1, 1, 1]
    assert set(special["special_name"]) == {"bifurcation"}
    assert list(special["xi [m]"]) == [0, 1, 2, 0, 1, 2]
    whole = cosserat.to_dataframe(data, "whole")
    assert list(whole["special_load [1]"]) == [0.3, 0.7]


def test_csv_reads_back_to_the_same_bits(capsys, solved, tmp_path):
    """By Python's own reader."""
    data = solved["elastica"]
    save_own(data, tmp_path / "a.nc")
    assert call(capsys, "export", tmp_path / "a.nc", "--to", "csv") == (
        0,
        f"wrote {tmp_path}/a.csv\n",
        "",
    )
    with (tmp_path / "a.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    x = [float(row["x_E2 [m]"]) for row in rows if row["place"] == "vertex"]
    np.testing.assert_array_equal(x, data.x.sel(axis="E2"))
    assert {row["x_E2 [m]"] for row in rows if row["place"] == "edge"} == {""}
    out = tmp_path / "v.csv"
    assert call(capsys, "export", tmp_path / "a.nc", "-o", out, "--place", "vertex")[0] == 0
    assert "" not in out.read_text().replace("\n", ",").rstrip(",").split(",")


# ---------------------------------------------------------------- bodies


def rod_on_an_arc(radius, height, centreline, turn=2.0, count=9):
    """A state on a circle about the origin, whose upper surface is outside, turning with 3 rad/s."""
    angle = np.linspace(0, turn, count)
    out = np.column_stack([np.sin(angle), np.cos(angle)])
    x, d = radius * out, (1 - centreline) * height * out
    spun = {
        f"{name}_rate": 3.0 * np.column_stack([-v[:, 1], v[:, 0]]) for name, v in (("x", x), ("d", d))
    }
    vectors = {"x": x, "d": d, "x_ref": 0 * x, "d_ref": 0 * d, **spun}
    fields = {name: (("vertex", "axis"), values) for name, values in vectors.items()}
    fields |= {"lam": (("vertex",), angle), "mu_edge": (("edge",), angle[1:])}
    problem = SimpleNamespace(rod=SimpleNamespace(below=centreline / (1 - centreline)))
    return xr.Dataset(fields, {"axis": ["E3", "E2"]}), problem


@pytest.mark.parametrize("centreline", [0.5, 0.3])
def test_a_bent_rod_has_the_area_and_the_velocities_of_its_arc(centreline):
    """Polygons in circles of r and R with n sides of angle a between them: n sin(a) (R^2 - r^2) / 2."""
    radius, height, turn, sides = 2.0, 0.5, 2.0, 8
    state, problem = rod_on_an_arc(radius, height, centreline, turn, sides + 1)
    body = mesh.rod(state, problem)
    ((name, quads),) = body.cells
    assert name == "quad"
    x, y = body.points[quads, 0], body.points[quads, 1]
    signed = np.sum(x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y, axis=1) / 2
    inner, outer = radius - centreline * height, radius + (1 - centreline) * height
    exact = np.sin(turn / sides) * (outer**2 - inner**2) / 2
    np.testing.assert_allclose(signed, exact, rtol=1e-12)
    turned = 3.0 * np.column_stack([-body.points[:, 1], body.points[:, 0], 0 * body.points[:, 0]])
    np.testing.assert_allclose(body.at_points["velocity"], turned, atol=1e-12)
    np.testing.assert_array_equal(body.at_points["displacement"], body.points)
    np.testing.assert_array_equal(body.at_points["lam"], np.tile(state.lam, 2))
    np.testing.assert_array_equal(body.in_cells["mu_edge"][0], state.mu_edge)


@pytest.mark.parametrize("varies", [False, True])
def test_a_crawler_is_a_closed_surface_on_the_ground_with_the_volume_of_its_prism(varies):
    """Of an n-gon in an ellipse: area n sin(2 pi / n) a b / 2; the volume by the divergence theorem."""
    tall, wide, length = 1.3, 0.8, 0.5
    along = np.linspace(-0.1, length - 0.1, 6)
    fields = {"along": along, "mu_1": np.full(6, tall), "mu_2": np.full(6, wide), "p_coelom": along**2}
    state = xr.Dataset({name: (("section",), values) for name, values in fields.items()})
    radius = 0.02
    if varies:  # the radius of each section counts, not that of the body
        state["resting_radius"], radius = (("section",), np.full(6, 0.03)), 0.03
    body = mesh.crawler(state, SimpleNamespace(crawler=SimpleNamespace(radius=0.02)))
    assert body.points[:, 1].min() == pytest.approx(0, abs=1e-16)
    assert body.points[:, 1].max() == pytest.approx(2 * radius * tall)
    faces = [[*cell] for _, cells in body.cells for cell in cells]
    edges = [(a, b) for face in faces for a, b in zip(face, face[1:] + face[:1], strict=True)]
    assert len(set(edges)) == len(edges), "an edge is passed twice in one direction"
    assert {(b, a) for a, b in edges} == set(edges), "the surface is open"
    corners = [[f[0], a, b] for f in faces for a, b in itertools.pairwise(f[1:])]
    volume = np.linalg.det(body.points[corners]).sum() / 6
    n = mesh.AROUND
    exact = n / 2 * np.sin(2 * np.pi / n) * radius**2 * tall * wide * length
    assert volume == pytest.approx(exact, rel=1e-12)
    assert len(body.points) == 6 * n + 2
    np.testing.assert_allclose(body.at_points["p_coelom"], body.points[:, 0] ** 2, atol=1e-15)


def test_a_worm_in_a_file_keeps_its_volume(solved, tmp_path, capsys):
    """An incompressible body between its n-gon and the tilt of its sections: 0.64 % and a little."""
    cosserat.save(solved["worm_at_rest"], tmp_path / "a.nc")
    assert call(capsys, "export", tmp_path / "a.nc", "--to", "vtk") == (
        0,
        f"wrote {tmp_path}/a.vtu\n",
        "",
    )
    read = meshio.read(tmp_path / "a.vtu")
    triangles = read.cells_dict["quad"]
    corners = np.concatenate(
        [triangles[:, [0, 1, 2]], triangles[:, [0, 2, 3]], read.cells_dict["triangle"]]
    )
    crawler = cosserat.case("worm_at_rest").problem.crawler
    exact = np.pi * crawler.radius**2 * crawler.length * np.sin(np.pi / 16) / (np.pi / 16)
    assert np.linalg.det(read.points[corners]).sum() / 6 == pytest.approx(exact, rel=2e-3)


def test_a_path_in_files_is_a_frame_for_each_point(solved, tmp_path, capsys):
    data, target = solved["column_path"].isel(point=[0, 3, 15]), tmp_path / "b.pvd"
    save_own(data, tmp_path / "a.nc")
    for _ in range(2):  # the second replaces the first
        assert call(capsys, "export", tmp_path / "a.nc", "-o", target) == (0, f"wrote {target}\n", "")
    assert sorted(f.name for f in tmp_path.iterdir()) == ["a.nc", "b.frames", "b.pvd"]
    listed = [entry.attrib for entry in ElementTree.parse(target).iter("DataSet")]
    assert [float(entry["timestep"]) for entry in listed] == [0, 1, 2]
    for number, entry in enumerate(listed):
        read, state = meshio.read(tmp_path / entry["file"]), data.isel(point=number)
        np.testing.assert_allclose(read.points[:41, :2], state.x + state.d, atol=1e-16)
        assert set(read.point_data["load_factor"]) == {state.load_factor.item()}


def test_times_of_a_motion_are_those_of_the_frames(solved, tmp_path, capsys):
    data = solved["tumbling"].isel(time=slice(0, 3))
    save_own(data, tmp_path / "a.nc")
    assert call(capsys, "export", tmp_path / "a.nc", "--to", "vtk")[0] == 0
    listed = [
        entry.attrib["timestep"] for entry in ElementTree.parse(tmp_path / "a.pvd").iter("DataSet")
    ]
    assert [float(time) for time in listed] == list(data.time)


@pytest.mark.parametrize("kind", kinds())
def test_any_kind_is_a_body_or_says_that_it_is_none(solved, kind, tmp_path, capsys):
    save_own(two_instants(solved[name_of_kind(kind)]), tmp_path / "a.nc")
    code, out, err = call(capsys, "export", tmp_path / "a.nc", "--to", "vtk", "-o", tmp_path)
    if kinds()[kind].mesh:
        assert (code, err) == (0, "")
        assert out.startswith(f"wrote {tmp_path}/a.")
        return
    assert (code, out) == (2, "")
    assert f"a result of kind '{kind}' has no body; export it as csv" in err
    assert [file.name for file in tmp_path.iterdir()] == ["a.nc"]


def test_frames_that_could_not_be_written_leave_the_old_ones(solved, tmp_path, capsys, monkeypatch):
    save_own(solved["column_path"], tmp_path / "a.nc")
    assert call(capsys, "export", tmp_path / "a.nc", "--to", "vtk")[0] == 0
    before = {str(f): f.read_bytes() for f in tmp_path.rglob("*") if f.is_file()}
    write = meshio.write

    def stop(path, *rest, **options):
        if path.name == "00002.vtu":
            raise KeyboardInterrupt
        write(path, *rest, **options)

    monkeypatch.setattr(meshio, "write", stop)
    assert call(capsys, "export", tmp_path / "a.nc", "--to", "vtk")[0] == 130
    assert {str(f): f.read_bytes() for f in tmp_path.rglob("*") if f.is_file()} == before
    assert sorted(f.name for f in tmp_path.iterdir()) == ["a.frames", "a.nc", "a.pvd"]


def test_exports_that_cannot_be_are_one_sentence(solved, tmp_path, capsys, monkeypatch):
    static, motion = tmp_path / "a.nc", tmp_path / "m.nc"
    cosserat.save(solved["necking"], static)
    save_own(solved["tumbling"].isel(time=[0, 1]), motion)
    save_own(solved["necking"].drop_attrs(), tmp_path / "foreign.nc")
    (tmp_path / "bad.nc").write_text("no")
    (tmp_path / "t.frames").mkdir()
    (tmp_path / "t.frames" / "thesis.tex").write_text("mine")
    before = sorted(str(file) for file in tmp_path.rglob("*"))
    for words, sentence in [
        ((static,), "nothing says what to write; add '--to csv' or '--to vtk'"),
        ((static, "-o", tmp_path), "nothing says what to write"),
        ((static, "-o", tmp_path / "a.vtk"), "nothing says what to write"),
        ((static, "--to", "vtk", "-o", tmp_path / "a.vtk"), "let its name end in '.vtu' or '.pvd'"),
        ((static, "--to", "csv", "-o", tmp_path / "a.vtu"), "let its name end in '.csv'"),
        ((motion, "-o", tmp_path / "m.vtu"), "let its name end in '.pvd'"),
        ((motion, "-o", tmp_path / "t.pvd"), "holds 'thesis.tex', which is no frame; move it away"),
        ((static, "--to", "csv", "--place", "vertx"), "no place 'vertx'; did you mean 'vertex'?"),
        ((static, "--to", "vtk", "--place", "edge"), "'--place edge' chooses rows of a table"),
        ((static, "-o", tmp_path / "none" / "a.csv"), "does not exist"),
        ((static, "-o", "/proc/a.csv"), "/proc"),
        ((motion, "-o", "/proc/a.pvd"), "/proc"),
        ((tmp_path, "--to", "csv"), "is a folder"),
        ((tmp_path / "none.nc", "--to", "csv"), "there is no file"),
        ((tmp_path / "bad.nc", "--to", "csv"), "cannot read"),
        ((tmp_path / "foreign.nc", "--to", "vtk"), "has no attribute 'parameters'"),
    ]:
        code, out, err = call(capsys, "export", *words)
        assert (code, out) == (2, ""), words
        assert sentence in err, (words, err)
        assert err.count("\n") == 1
    monkeypatch.setitem(sys.modules, "meshio", None)
    code, _, err = call(capsys, "export", static, "--to", "vtk")
    assert code == 2
    assert "install it with 'pip install meshio'" in err
    assert sorted(str(file) for file in tmp_path.rglob("*")) == before
