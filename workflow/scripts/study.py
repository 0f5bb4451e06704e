"""Turn a scene's runs into its table, findings and series."""

import sys
from pathlib import Path
from typing import Any

import pandas as pd

from fracparticles.run.dataset import read_benchmark
from fracstudy.claims import read_claims, write_findings
from fracstudy.inputs import excuse, write_table
from fracstudy.studies import Inputs, study

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

parameters, output = snakemake.params, snakemake.output
claims = [c for c in read_claims(*snakemake.input.printed) if c.item in parameters.claimed]
inputs = Inputs(
    scene=snakemake.wildcards.scene,
    items=list(parameters.claimed),
    parameters={
        **parameters.parameters,
        "printed": {claim.id: claim.printed for claim in claims if claim.printed is not None},
    },
    runs=list(snakemake.input.runs),
    tables={
        name: pd.read_csv(path)
        for name, path in zip(parameters.tables, snakemake.input.tables, strict=True)
    },
    benchmarks={Path(path).stem: read_benchmark(path) for path in snakemake.input.benchmarks},
)
result = study(parameters.study)(inputs)
findings = excuse(result.findings, claims) if parameters.smoke else result.findings
write_findings(findings, output.findings)
write_table(result.series if result.series is not None else pd.DataFrame(), output.series)
write_table(result.table, output.csv, output.md)
