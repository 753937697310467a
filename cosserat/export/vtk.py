"""The body of a result for ParaView and other readers of VTK: a .vtu file for one state, .pvd for a sequence."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import numpy as np
import xarray as xr

from cosserat.data.dataset import case_of
from cosserat.data.files import check_destination, refusal, whole_or_absent
from cosserat.errors import InputError
from cosserat.export.table import INSTANTS
from cosserat.problem import Problem
from cosserat.progress import bar
from cosserat.publications import kinds


def instant_of(dataset: xr.Dataset) -> str | None:
    """The dimension of the instants of a result; None for a single state."""
    return next((dim for dim in INSTANTS if dim in dataset.sizes), None)


def write_vtk(dataset: xr.Dataset, path: Path) -> None:
    """Write the body as a mesh: one .vtu file, or a .pvd file with a folder of one .vtu file for each instant.

    The folder is called like the file, with .frames in place of .pvd.  The .pvd file is written last, so where it
    stands the sequence is whole.

    Raises
    ------
    InputError : the kind has no body, meshio is not installed, or the destination cannot be written.
    """
    problem, instant = case_of(dataset).problem, instant_of(dataset)
    if not kinds()[problem.kind].mesh:
        raise InputError(f"a result of kind '{problem.kind}' has no body; export it as csv")
    check_destination(path, *((".vtu", ".pvd") if instant is None else (".pvd",)))
    meshio = _meshio()
    if path.suffix == ".vtu":
        with whole_or_absent(path) as temporary:
            _write(meshio, dataset, problem, temporary)
        return
    folder = path.with_suffix(".frames")
    count = 1 if instant is None else dataset.sizes[instant]
    labels = np.arange(count) if instant is None else dataset[instant].to_numpy()
    names = [f"{number:05d}.vtu" for number in range(count)]
    with _replaced(folder, path) as temporary, bar(path.name) as progress:
        for number, name in enumerate(names):
            state = dataset if instant is None else dataset.isel({instant: number})
            _write(meshio, state, problem, temporary / name)
            progress((number + 1) / count, name)
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    collection = ElementTree.SubElement(root, "Collection")
    for label, name in zip(labels, names, strict=True):
        about = {"timestep": repr(label.item()), "part": "0", "file": f"{folder.name}/{name}"}
        ElementTree.SubElement(collection, "DataSet", about)
    ElementTree.indent(root)
    with whole_or_absent(path) as temporary:
        ElementTree.ElementTree(root).write(temporary, encoding="utf-8", xml_declaration=True)


def _meshio() -> ModuleType:
    try:
        import meshio
    except ImportError:
        raise InputError(
            "VTK files are written by meshio, which is not installed; install it with 'pip install meshio'"
        ) from None
    module: ModuleType = meshio
    return module


def _write(meshio: ModuleType, state: xr.Dataset, problem: Problem, path: Path) -> None:
    """Write one instant; coordinates without a place, such as the load factor, are given at all points."""
    body = kinds()[problem.kind].mesh_function()(state, problem)
    along = {
        str(name): np.full(len(body.points), values.item())
        for name, values in state.coords.items()
        if values.ndim == 0
    }
    mesh = meshio.Mesh(
        body.points,
        list(body.cells),
        point_data={**body.at_points, **along},
        cell_data={name: list(values) for name, values in body.in_cells.items()},
    )
    meshio.write(path, mesh, file_format="vtu")


@contextlib.contextmanager
def _replaced(folder: Path, listing: Path) -> Iterator[Path]:
    """A temporary folder beside `folder`, which it replaces when the block succeeds; the old listing goes before.

    Raises
    ------
    InputError : the folder holds other files than frames, or the system refuses to write.
    """
    temporary = folder.with_name(f".{folder.name}.{os.getpid()}.part")
    try:
        if folder.exists():
            strange = [
                file.name for file in folder.iterdir() if not re.fullmatch(r"\d+\.vtu", file.name)
            ]
            if strange:
                raise InputError(f"{folder} holds '{strange[0]}', which is no frame; move it away")
        shutil.rmtree(temporary, ignore_errors=True)
        temporary.mkdir()
        yield temporary
        listing.unlink(missing_ok=True)
        if folder.exists():
            shutil.rmtree(folder)
        temporary.replace(folder)
    except OSError as error:
        raise refusal(error, folder, temporary) from None
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
