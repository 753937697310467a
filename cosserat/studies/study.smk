"""A planned study in batches: `cosserat study` calls this workflow, in the folder of the study.

    snakemake --snakefile study.smk --directory NAME.study --config answer=/path/to/NAME.nc
"""

import json
import sys

from snakemake.utils import min_version

from cosserat.studies import elsewhere

min_version("9.0")

if workflow.is_main_process:  # and none that a job on Slurm starts for itself
    RUNNING = elsewhere.alone(".", change=not workflow.output_settings.dryrun)

with open("plan.json", encoding="utf-8") as file:
    BATCHES = json.load(file)["batches"]
STEP = f"{sys.executable} -m cosserat.studies.worker"


localrules:
    study_gather,


rule study_gather:
    input:
        expand("batches/{batch}.nc", batch=BATCHES),
    output:
        config["answer"],
    log:
        "logs/gather.log",
    shell:
        "{STEP} gather . {output} > {log} 2>&1 || (cat {log} >&2; exit 1)"


rule study_batch:
    input:
        ancient("batches/{batch}.npz"),  # its name says what it holds
    output:
        "batches/{batch}.nc",
    log:
        "logs/{batch}.log",
    wildcard_constraints:
        batch="[0-9a-f]+",
    resources:
        mem_mb=600,
        runtime=30,
    retries: 2
    shell:
        "{STEP} batch {input} {output} > {log} 2>&1 || (cat {log} >&2; exit 1)"
