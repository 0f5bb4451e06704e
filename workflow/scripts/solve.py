"""Solve a batch of cases, each to its own file."""

import sys
from typing import Any

from fracparticles.run.case import Case
from fracparticles.run.dataset import write
from fracparticles.run.solve import solve

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

for text, path in zip(snakemake.params.cases, snakemake.output, strict=True):
    write(solve(Case.from_json(text)), path)
