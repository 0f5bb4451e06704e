"""Run a few particles through the compiled functions of the solver, so that numba's cache holds what the jobs need.

Every scheme, in one dimension, with few particles and with many, and in two; and what only studies evaluate.
"""

import sys
from itertools import product
from typing import Any

from fracparticles.kernels.families import PAPER_ORDERS
from fracparticles.run.case import Case
from fracparticles.run.solve import solve
from fracparticles.schemes import ALL_SCHEMES
from fracparticles.special import green_slope, tail_mass

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

tail_mass(1.0, 1.0, 1.5)
green_slope(1.0, 1.0, 1.5, 2)
for name, scheme in ALL_SCHEMES.items():
    orders = [order for order in scheme.orders if order in PAPER_ORDERS]
    own = {} if scheme.self_timed else {"dt": 0.01}
    for exterior, order in product(scheme.exteriors, orders):
        few = {"beta": 0.5, "truncation": 5.0, "spacing": 0.5, "exterior": exterior, **own}
        for spacing, evaluation in product((0.5, 0.1), ("series", "stepping")):
            if not scheme.moving or evaluation == "stepping":
                case = {**few, "spacing": spacing, "evaluation": evaluation}
                solve(Case(scheme=name, order=order, **case))
        if 2 in scheme.dims:
            solve(Case(scheme=name, order=order, dim=2, **few))
