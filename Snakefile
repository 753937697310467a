"""Cases to netCDF, netCDF to the judged table and the figures, all of that to the book.  `snakemake all`."""

import os
import shutil
import sys
from pathlib import Path

from snakemake.utils import min_version

from cosserat.cases.catalogue import published
from cosserat.data.provenance import computing_sources
from cosserat.studies import elsewhere
from cosserat.studies.door import find_study, published_studies
from cosserat.thesis import PUBLICATION
from cosserat.thesis.book.edition import edition
from cosserat.thesis.figures.catalogue import FIGURES
from cosserat.thesis.table.citations import sources

min_version("9.0")


workdir: workflow.basedir


os.environ.update(PATH=os.pathsep.join([os.path.dirname(sys.executable), *os.get_exec_path()]))

CASES = published()
# Cases or chapters that one process takes in turn: most of the time of a short one is the start of its process.
BATCH = 6
STUDIES = published_studies()
CHAPTERS = sorted(glob_wildcards("chapters/{name}.py").name)
# Tracked files of chapters.
CITING = [file.as_posix() for file in sources(Path())]  # of pages that show tests, and places of equations
MEASURED = {
    "errata": CITING,
    "equations": CITING,
    "ch5_peers": ["results/peers.csv"],
    "reliability": ["results/faults.csv", "results/inputs.csv"],
}
SOLVER = [os.path.relpath(file) for file in computing_sources()]
FORMULAS = ["cosserat/exact/beams.py", "cosserat/exact/elastica.py"]
READOUTS = [
    f"cosserat/thesis/table/{name}.py"
    for name in ("crawl_readouts", "given", "printed", "printed_crawlers", "reading", "readouts")
]


def package(*names):
    """Files of these folders of the package: Snakemake does not see edits of what a command imports."""
    folders = [os.path.join("cosserat", name) for name in names]
    files = [os.path.join(folder, file) for folder in folders for file in os.listdir(folder)]
    return sorted(file for file in files if file.endswith((".py", ".css", ".js", ".toml")))


def batches():
    """Names of cases of one kind, in the order of their files, by the name of the batch.

    A case that cannot be solved stops its batch, whose results are then made again.
    """
    kinds = {}
    for name, case in CASES.items():
        kinds.setdefault(case.problem.kind, []).append(name)
    return {
        f"{kind.replace(' ', '_')}_{first // BATCH}": names[first : first + BATCH]
        for kind, names in kinds.items()
        for first in range(0, len(names), BATCH)
    }


def chapter_batches():
    """Names of chapters, in the order of the alphabet, by the name of the batch that one kernel executes in turn."""
    firsts = range(0, len(CHAPTERS), BATCH)
    return {f"chapters_{first // BATCH}": CHAPTERS[first : first + BATCH] for first in firsts}


def only_run_here():
    """Wait for whoever makes results in this folder; the locks that Snakemake finds after that are nobody's.

    `held` is held by each job on this machine, also by one that outlives a kill.  A job on Slurm holds nothing here, as
    Slurm knows of it.
    """
    running = elsewhere.alone(".", change=not workflow.output_settings.dryrun)
    with open(".snakemake/held", "a") as held:
        elsewhere.wait_for(held)
    shutil.rmtree(".snakemake/locks", ignore_errors=True)
    return running


if workflow.is_main_process:  # and none that a job on Slurm starts for itself
    RUNNING = only_run_here()
    HOLD = "exec 9<.snakemake/held; python -IS -c 'import fcntl; fcntl.flock(9, fcntl.LOCK_SH)'; "
    shell.prefix(f"set -euo pipefail; {HOLD}")
else:
    shell.prefix("set -euo pipefail; ")


def asks(megabytes, minutes):
    """What a job asks a cluster for: the memory of its benchmark [MB] with some to spare, and a time [min].

    A job on Slurm has two Snakemakes around the process of the rule, 460 MB.  Its second attempt asks for twice as much.
    """
    return {
        "mem_mb": lambda wildcards, attempt: attempt * (megabytes + 500),
        "runtime": lambda wildcards, attempt: attempt * minutes,
    }


wildcard_constraints:
    case="|".join(CASES),
    study="|".join(STUDIES),


report: "results/captions/workflow.rst"


localrules:  # where Snakemake itself runs: a second or two each, and `peers`, which needs a network
    all,
    measure,
    check,
    peers,
    pdf,


rule all:
    input:
        "results/check.txt",
        expand("results/figures/{figure}.svg", figure=FIGURES),
        "results/book/index.html",


for batch, names in batches().items():

    rule:
        name:
            f"simulate_{batch}"
        input:
            SOLVER,
        output:
            expand("results/cases/{case}.nc", case=names),
        params:
            cases=[CASES[name].model_dump_json() for name in names],
        log:
            f"results/logs/simulate/{batch}.log",
        benchmark:
            f"results/benchmarks/simulate/{batch}.tsv"
        resources:
            **asks(megabytes=400, minutes=10),
        shell:
            "printf '%s\\n' {params.cases:q} | python -m cosserat run - --output results/cases > {log} 2>&1"


rule study:
    input:
        SOLVER,
        package("studies"),
        ancient(expand("cosserat/thesis/cases/{file}", file=PUBLICATION.cases)),
    output:
        "results/studies/{study}.nc",
    params:
        # what is asked, so that a changed study is solved again; its batches are kept beside the answer
        asked=lambda wildcards: find_study(wildcards.study).asked,
    log:
        "results/logs/study/{study}.log",
    benchmark:
        "results/benchmarks/study/{study}.tsv"
    resources:
        **asks(megabytes=450, minutes=10),
    shell:
        "python -m cosserat study {wildcards.study} --output {output} > {log} 2>&1"


rule measure:
    input:
        package("thesis/table"),
        FORMULAS,
        table="results/tolerances.csv",
        cases=expand("results/cases/{case}.nc", case=CASES),
        studies=expand("results/studies/{study}.nc", study=STUDIES),
    output:
        report("results/report.csv", caption="results/captions/report.rst", category="Results table"),
    log:
        "results/logs/measure.log",
    benchmark:
        "results/benchmarks/measure.tsv"
    shell:
        "python -m cosserat measure --table {input.table} --cases results/cases --output {output} > {log} 2>&1"


rule check:
    input:
        "results/report.csv",
    output:
        "results/check.txt",
    log:
        "results/logs/check.log",
    benchmark:
        "results/benchmarks/check.tsv"
    shell:
        "python -m cosserat check {input} > {output} 2> {log} || (cat {log} >&2; exit 1)"


for module in sorted({entry.module for entry in FIGURES.values()}):  # most of the time of a process is its start
    drawn = [name for name, entry in FIGURES.items() if entry.module == module]

    rule:
        name:
            f"figure_{module}"
        input:
            package("figures", "thesis/figures"),
            FORMULAS,
            READOUTS,
            cases=sorted({f"results/cases/{case}.nc" for name in drawn for case in FIGURES[name].cases}),
            studies=sorted({f"results/studies/{study}.nc" for name in drawn for study in FIGURES[name].studies}),
            table=["results/tolerances.csv"] if any(FIGURES[name].rows for name in drawn) else [],
            tables=sorted({f"results/{table}" for name in drawn for table in FIGURES[name].tables}),
        output:
            *(
                report(
                    f"results/figures/{name}.svg",
                    caption="results/captions/figure.rst",
                    category="Figures",
                    labels={"figure": name},
                )
                for name in drawn
            ),
        params:
            figures=drawn,
        log:
            f"results/logs/figure/{module}.log",
        benchmark:
            f"results/benchmarks/figure/{module}.tsv"
        resources:
            **asks(megabytes=450, minutes=5),
        shell:
            "python -m cosserat figure {params.figures} --cases results/cases --output results/figures > {log} 2>&1"


rule webassembly:
    input:
        package("solvers", "rods", "rods/energies", "problems", "export/webassembly"),
    output:
        "results/pull.wasm",
    log:
        "results/logs/webassembly.log",
    benchmark:
        "results/benchmarks/webassembly.tsv"
    resources:
        **asks(megabytes=700, minutes=5),
    shell:
        "python -m cosserat webassembly --output {output} > {log} 2>&1"


for batch, names in chapter_batches().items():

    rule:
        name:
            batch
        input:
            package("describe", "thesis/book", "thesis/table", "figures", "thesis/figures"),
            "results/check.txt",
            "results/report.csv",
            "results/tolerances.csv",
            "results/errata.toml",
            "results/left_out.toml",
            expand("results/cases/{case}.nc", case=CASES),
            expand("results/figures/{figure}.svg", figure=FIGURES),
            expand("results/studies/{study}.nc", study=STUDIES),
            measured=[file for name in names for file in MEASURED.get(name, []) if os.path.exists(file)],
            module=["results/pull.wasm"] if "pull" in names else [],
            source=expand("chapters/{chapter}.py", chapter=names),
        output:
            expand("results/notebooks/{chapter}.ipynb", chapter=names),
        log:
            f"results/logs/{batch}.log",
        benchmark:
            f"results/benchmarks/{batch}.tsv"
        resources:
            **asks(megabytes=700, minutes=5),
        shell:
            "python -m cosserat chapter {input.source} --output results/notebooks > {log} 2>&1"


rule peers:  # its table is tracked, so it is the output of no rule, and measured whenever it is asked for
    params:
        packages="exudyn==1.13.6 pyelastica==1.0.0 scipy",
    log:
        "results/logs/peers.log",
    threads: workflow.cores
    shell:
        "(python -m venv --clear .peers && .peers/bin/python -m pip install --quiet {params.packages} && "
        "python -m cosserat peers .peers/bin/python --output results/peers.csv) > {log} 2>&1 || (cat {log} >&2; exit 1)"


rule book:
    input:
        package("thesis/book", "thesis/book/static", "figures"),
        "cosserat/__init__.py",
        notebooks=expand("results/notebooks/{chapter}.ipynb", chapter=CHAPTERS),
    output:
        "results/book/index.html",
    params:
        edition=edition().text,  # each page names its commit
    log:
        "results/logs/book.log",
    benchmark:
        "results/benchmarks/book.tsv"
    resources:
        **asks(megabytes=500, minutes=10),
    shell:
        "python -m cosserat book {input.notebooks} --output results/book > {log} 2>&1"


rule pdf:  # it needs Chromium
    input:
        "results/book/index.html",
        "cosserat/thesis/book/paper.html",
    output:
        "results/cosserat.pdf",
    log:
        "results/logs/pdf.log",
    benchmark:
        "results/benchmarks/pdf.tsv"
    resources:
        **asks(megabytes=2000, minutes=10),
    shell:
        "python -m cosserat pdf results/book --output {output} > {log} 2>&1 || (cat {log} >&2; exit 1)"
