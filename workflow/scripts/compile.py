"""Run every scheme on a handful of particles, so that numba's cache holds what the jobs need.

The cache is emptied first: numba looks at the file of a function only, not at those of the functions that are inlined
into it, and would go on with what an edited module used to say.
"""

import sys
from pathlib import Path
from typing import Any

import fracparticles
from fracparticles.case import Case
from fracparticles.schemes import SCHEMES

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

for cached in Path(fracparticles.__file__).parent.rglob("__pycache__/*.nb[ic]"):
    cached.unlink()

from fracparticles.solver import solve  # noqa: E402  (after the cache is emptied)

for name, scheme in SCHEMES.items():
    for exterior in scheme.EXTERIORS:
        for order in scheme.ORDERS:
            for evaluation in ("series", "stepping"):
                solve(
                    Case(
                        scheme=name,
                        order=order,
                        beta=0.5,
                        truncation=5.0,
                        spacing=0.5,
                        exterior=exterior,
                        evaluation=evaluation,
                        **({} if name == "GPSE" else {"dt": 0.01}),
                    )
                )
