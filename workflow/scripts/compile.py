"""Run every scheme once on a handful of particles, so that numba's cache is filled."""

import sys
from typing import Any

from fracparticles.case import Case
from fracparticles.schemes import SCHEMES
from fracparticles.solver import compute

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

for name, scheme in SCHEMES.items():
    for exterior in scheme.EXTERIORS:
        step = {} if name == "GPSE" else {"dt": 0.01}
        for evaluation in ("series", "stepping"):
            compute(
                Case(
                    scheme=name,
                    beta=0.5,
                    truncation=5.0,
                    spacing=0.5,
                    exterior=exterior,
                    evaluation=evaluation,
                    **step,
                )
            )
