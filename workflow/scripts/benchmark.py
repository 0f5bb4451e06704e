"""Run a benchmark."""

import sys
from typing import Any

from fracparticles.run.dataset import write
from fracstudy.benchmarks import benchmark

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

data = benchmark(snakemake.wildcards.benchmark)(**snakemake.params.parameters)
write(data, snakemake.output[0])
