"""Run a few particles through the compiled functions of the solver, so that numba's cache holds what the jobs need.

Every scheme, in one dimension, with few particles and with many, and in two; and what only studies evaluate. The two
dimensions are compiled side by side, after what they share.
"""

import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from typing import Any

from fracparticles.kernels.families import PAPER_ORDERS
from fracparticles.run.case import Case
from fracparticles.run.solve import solve
from fracparticles.schemes import ALL_SCHEMES
from fracparticles.special import green_slope, tail_mass

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

FEW = {"beta": 0.5, "truncation": 5.0, "spacing": 0.5, "dt": 0.01}
HOW = {
    1: [(0.5, "series"), (0.1, "series"), (0.5, "stepping"), (0.1, "stepping")],
    2: [(0.5, None)],
}


def fill(dim: int) -> None:
    """Solve with every scheme, order and exterior in that dimension."""
    for name, scheme in ALL_SCHEMES.items():
        orders = [order for order in scheme.orders if order in PAPER_ORDERS]
        ways = product(scheme.exteriors, orders, HOW[dim] if dim in scheme.dims else [])
        for exterior, order, (spacing, evaluation) in ways:
            if not scheme.moving or evaluation != "series":
                given = {**FEW, "spacing": spacing, "evaluation": evaluation, "dim": dim}
                if scheme.self_timed:
                    del given["dt"]
                solve(Case(scheme=name, order=order, exterior=exterior, **given))


tail_mass(1.0, 1.0, 1.5)
green_slope(1.0, 1.0, 1.5, 2)
for exterior, dim in product(("truncated", "open"), HOW):
    solve(Case(scheme="KPSE", order=4, exterior=exterior, dim=dim, **FEW))
with ProcessPoolExecutor(snakemake.threads) as pool:
    list(pool.map(fill, HOW))
