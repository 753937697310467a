"""The list of figures, with their titles, cases and rows."""

from __future__ import annotations

import csv
import importlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cosserat.errors import InputError
from cosserat.parameters import nearest
from cosserat.text import shortened

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


TABLE = Path("results/tolerances.csv")
"""The results table of the current checkout."""


@dataclass(frozen=True)
class Entry:
    """One figure: its title, the module of `cosserat.thesis.figures` that draws it, and the cases it needs.

    rows : rows of the results table whose published numbers it shows beside the cases.
    studies : published studies that it needs.
    tables : tracked tables beside the results table, such as "peers.csv", whose rows it shows.
    round_off : whether it draws round-off, which is another one on each kind of processor.
    """

    title: str
    module: str
    cases: tuple[str, ...]
    rows: tuple[str, ...] = ()
    round_off: bool = False
    studies: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()


FIGURES: dict[str, Entry] = {
    "fig_opening": Entry(
        "What the package solves", "opening", ("worm", "column_path", "arch_path", "tumbling")
    ),
    "fig_directed_rod": Entry("A directed rod as the body it stands for", "chapter1", ("soft_robot",)),
    "fig_2_1": Entry("Fig. 2.1: a stride of the earthworm", "chapter2", ("worm", "worm_printed")),
    "fig_2_2": Entry(
        "Fig. 2.2: segment 50 over three strides",
        "chapter2",
        ("worm", "worm_printed"),
        ("2.8.6-mu1-ratio", "2.8.6-mu3-ratio", "2.8-p-longitudinal-measured", "2.8-p-circular-measured"),
    ),
    "fig_2_5": Entry("Fig. 2.5: muscles as forces along the centreline", "chapter2", ()),
    "fig_five_regions": Entry("Five regions of muscles", "postures", ("worm", "worm_at_rest")),
    "fig_2_7": Entry("Fig. 2.7: a cycle of push and pull", "gaits", ("soft_robot",)),
    "fig_2_8": Entry("Fig. 2.8: fronts of the push-pull gait", "gaits", ("soft_robot",)),
    "fig_2_9": Entry("Fig. 2.9: the soft robot crawls", "gaits", ("soft_robot",)),
    "fig_2_11": Entry("Fig. 2.11: fronts of the protrusion-stance gait", "gaits", ("worm",)),
    "fig_2_12": Entry("Fig. 2.12: the anchored point", "chapter2", ("worm", "worm_early")),
    "fig_masses": Entry(
        "Earthworms of every size",
        "chapter2",
        ("worm_masses", "worm_masses_constant_pressure", "worm_masses_strip"),
    ),
    "anim_robot": Entry("The soft robot crawls", "chapter2", ("soft_robot",)),
    "anim_worm": Entry("The earthworm crawls", "chapter2", ("worm",)),
    "fig_3_1": Entry("Fig. 3.1: reference and current configuration", "geometry", ("bent_rod",)),
    "fig_3_2": Entry("Fig. 3.2: a rod-like body", "geometry", ("clamped_free",)),
    "fig_3_3": Entry("Fig. 3.3: section and directors", "geometry", ("clamped_free",)),
    "fig_3_4": Entry("Fig. 3.4: discrete osculating circle", "geometry", ("bent_rod",)),
    "fig_3_5": Entry("Fig. 3.5: bending, then stretching", "geometry", ("clamped_free",)),
    "fig_3_6": Entry("Fig. 3.6: tangents, director and angles", "geometry", ("bent_rod",)),
    "fig_3_7": Entry("Fig. 3.7: energy characteristics", "geometry", ()),
    "fig_3_8": Entry(
        "Fig. 3.8: equilibria of the four static problems",
        "chapter3",
        tuple(
            name + rod
            for name in ("hanging_bar", "clamped_free", "clamped_clamped", "necking")
            for rod in ("", "_consistent")
        ),
    ),
    "fig_3_9": Entry(
        "Fig. 3.9: bar hanging under its own weight",
        "chapter3",
        ("hanging_bar", "hanging_bar_consistent"),
    ),
    "fig_3_10": Entry(
        "Fig. 3.10: clamped-free Timoshenko beam",
        "chapter3",
        ("clamped_free", "clamped_free_ends_halved", "clamped_free_consistent"),
    ),
    "fig_3_11": Entry(
        "Fig. 3.11: clamped-clamped Timoshenko beam",
        "chapter3",
        ("clamped_clamped", "clamped_clamped_ends_halved", "clamped_clamped_consistent"),
    ),
    "fig_3_12": Entry(
        "Fig. 3.12: necking", "chapter3", ("necking", "necking_printed", "necking_consistent")
    ),
    "fig_calibration": Entry("Calibration and the number of vertices", "calibration", ("calibration",)),
    "fig_3_13": Entry(
        "Fig. 3.13: free vibration",
        "motion",
        ("vibration_c4_2", "vibration_c4_20", "vibration_consistent"),
    ),
    "fig_convergence": Entry(
        "Errors of the consistent rod", "consistent", ("convergence", "calibration")
    ),
    "fig_far": Entry(
        "Large deflections", "consistent", ("elastica", "roll_up", "column_path", "arch_path")
    ),
    "fig_paths": Entry("Paths of equilibria", "consistent", ("column_path", "arch_path")),
    "fig_tumbling": Entry("A tumbling rod", "consistent", ("tumbling",), round_off=True),
    "fig_conventions": Entry("Frames and signs", "conventions", ()),
    "fig_modes": Entry("The lowest modes of the vibrating beam", "motion", ("vibration_c4_20",)),
    "fig_worm_stride": Entry("Which inputs decide the stride", "studies", (), studies=("worm_stride",)),
    "fig_calibration_reach": Entry(
        "How far the published calibration reaches", "studies", (), studies=("calibration_reach",)
    ),
    "fig_column_strength": Entry(
        "The strength of imperfect columns", "studies", (), studies=("column_strength",)
    ),
    "fig_peers": Entry("Error against time", "peers", (), tables=("peers.csv",)),
    "anim_vibration": Entry("One period of the vibrating beam", "motion", ("vibration_c4_20",)),
    "anim_relaxation": Entry("The clamped-free beam settles", "motion", ("relaxing_clamped_free",)),
}
"""Figures by the name of the function that draws them."""


def draw(name: str, data: Mapping[str, xr.Dataset], table: Path = TABLE) -> Figure | str:
    """Draw a figure, or the text of an animated SVG, from its Datasets by case name.

    table : the results table, read where the figure shows published numbers.

    Raises
    ------
    InputError : no figure of that name, or the table lacks a row that it shows.
    """
    from cosserat.figures.style import settings

    found = entry(name)
    module = importlib.import_module(f"cosserat.thesis.figures.{found.module}")
    published = (_published(found.rows, table),) if found.rows else ()
    tabulated = [_rows(table.parent / name) for name in found.tables]
    with settings():
        figure: Figure | str = getattr(module, name)(data, *published, *tabulated)
    return figure


def draw_to(name: str, folder: Path, path: Path, table: Path = TABLE) -> None:
    """Draw a figure from the files `<case>.nc` of a folder and the results table, and write it as SVG.

    Studies are in the folder `studies` beside the one of the cases.

    Raises
    ------
    InputError : no figure of that name, or a file is missing or unreadable.
    """
    from cosserat.data.files import check_destination
    from cosserat.data.netcdf import load, load_case
    from cosserat.figures.style import write

    check_destination(path, ".svg")
    found = entry(name)
    data = {case: load_case(folder, case) for case in found.cases}
    data |= {study: load(folder.parent / "studies" / f"{study}.nc", own=True) for study in found.studies}
    write(draw(name, data, table), path)


def _published(rows: tuple[str, ...], table: Path) -> dict[str, float]:
    """The published numbers of rows by their ids, in their SI units."""
    from cosserat.thesis.table.tolerances import read_table

    known = {row.id: row.expected for row in read_table(table) if row.expected is not None}
    missing = [name for name in rows if name not in known]
    if missing:
        raise InputError(f"{table} has no printed number {', '.join(missing)}; restore it")
    return {name: known[name] for name in rows}


def _rows(path: Path) -> list[dict[str, str]]:
    """The rows of a tracked table."""
    if not path.is_file():
        raise InputError(f"there is no {path}; restore it with 'git checkout {path}'")
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def draw_all(names: Sequence[str], folder: Path, output: Path) -> Iterator[Path]:
    """Draw figures one by one into the folder `output`, or one figure into the file; yields each path written.

    Raises
    ------
    InputError : as `draw_to`, or there are several figures and no such folder.
    """
    if len(names) > 1 and not output.is_dir():
        raise InputError(f"{output} is not a folder; make a folder for several figures first")
    for name in names:
        path = output / f"{name}.svg" if output.is_dir() else output
        draw_to(name, folder, path)
        yield path


def entry(name: str) -> Entry:
    """The entry of a figure.

    Raises
    ------
    InputError : no figure of that name.
    """
    if name not in FIGURES:
        raise InputError(f"there is no figure '{shortened(name)}'{nearest(name, list(FIGURES))}")
    return FIGURES[name]
