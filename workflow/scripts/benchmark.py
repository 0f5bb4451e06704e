"""Run a benchmark."""

import sys
from typing import Any

from fracparticles.benchmarks import benchmark
from fracparticles.dataset import write

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

data = benchmark(snakemake.wildcards.benchmark)(**snakemake.params.parameters)
write(data, snakemake.output[0])
