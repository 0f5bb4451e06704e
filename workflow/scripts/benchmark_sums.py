"""Time the sums on squares and cubes, and those over scattered particles."""

import sys
from typing import Any

from fracparticles.benchmark_sums import (
    box_benchmark,
    box_table,
    scattered_benchmark,
    scattered_table,
)
from fracparticles.dataset import write
from fracparticles.studies.common import write_table

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

output = snakemake.output
for benchmark, table, name in (
    (box_benchmark, box_table, "boxes"),
    (scattered_benchmark, scattered_table, "scattered"),
):
    data = benchmark(**snakemake.params[name])
    write(data, output[f"{name}_data"])
    write_table(table(data), output[f"{name}_csv"], output[f"{name}_md"])
