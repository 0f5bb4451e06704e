"""Time the reference problem."""

import sys
from typing import Any

from fracparticles.benchmark import benchmark_table, reference_benchmark
from fracparticles.dataset import write
from fracparticles.studies.common import write_table

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

data = reference_benchmark(**dict(snakemake.params.items()))
write(data, snakemake.output.data)
write_table(benchmark_table(data), snakemake.output.csv, snakemake.output.md)
