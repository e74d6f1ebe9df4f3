# SPDX-License-Identifier: GPL-3.0-or-later
# The stages of a city for Snakemake, as an example: any engine that knows files can run them.
#
#     vdbmap tile plan survey/ -o city/
#     snakemake --snakefile tools/tile.smk --config job=city.job --cores 8
import json
from pathlib import Path

JOB = Path(config["job"]).resolve()
PLAN = json.loads((JOB / "job.json").read_text())
PARTS = expand(str(JOB / "parts/{source}.part"), source=range(len(PLAN["sources"])))
BUCKETS = expand(str(JOB / "tiles/{bucket}/map.json"), bucket=range(PLAN["buckets"]))

rule finish:
    input: BUCKETS
    shell: "vdbmap tile finish {JOB}"

rule map:
    output: str(JOB / "parts/{source}.part")
    shell: "vdbmap tile map {JOB} {wildcards.source} --threads 1"

rule reduce:
    input: PARTS
    output: str(JOB / "tiles/{bucket}/map.json")
    shell: "vdbmap tile reduce {JOB} {wildcards.bucket} --threads 1"
