"""A copy of the checkout with a few cases: what runs, and reruns after which change, does not depend on how many.

    python tests/workflow/small.py FOLDER CASE... --figures FIGURE...

writes one with these cases, the rows of the table that read them, and these figures.
"""

import argparse
import csv
import re
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def copy(folder, cases, figures):
    """The tracked files, and those that would be, with some cases of Chapter 3 alone; compiled kernels come along."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    compiled = [str(file.relative_to(ROOT)) for file in (ROOT / "cosserat").rglob("__pycache__/*.nb?")]
    for name in [*listed.stdout.splitlines(), *compiled]:
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            # with its time: a kernel whose source has another one is compiled anew
            shutil.copy2(ROOT / name, folder / name)
    shrink(folder, cases, figures)


def shrink(folder, cases, figures):
    """Leave these cases, the hidden ones that cases are built on, their rows, these figures and one chapter."""
    for chapter in (folder / "chapters").glob("*.py"):
        if chapter.stem != "results_table":
            chapter.unlink()
    files = folder / "cosserat/thesis/cases"
    for name in ("chapter2.toml", "studies.toml"):
        (files / name).write_text("")
    blocks = re.split(r"\n(?=\[)", (files / "chapter3.toml").read_text())
    kept = [
        b
        for b in blocks
        if not (name := re.match(r"\[(\w+)", b)) or name[1] in cases or name[1][0] == "_"
    ]
    (files / "chapter3.toml").write_text("\n".join(kept))
    table = folder / "results/tolerances.csv"
    with table.open(newline="") as file:
        head, *rows = csv.reader(file)
    rows = [row for row in rows if row[head.index("case")] in cases]
    with table.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *rows])
    with (folder / "cosserat/thesis/figures/catalogue.py").open("a") as file:
        file.write(f"\nFIGURES = {{name: FIGURES[name] for name in {tuple(figures)}}}\n")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("cases", nargs="+")
    parser.add_argument("--figures", nargs="+", required=True)
    given = parser.parse_args()
    copy(given.folder, given.cases, given.figures)
