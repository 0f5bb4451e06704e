"""Run a few particles through every compiled function of an area, so that numba's cache holds what the jobs need.

The area's cache is emptied first: numba looks at the file of a function only, not at those of the functions that are
inlined into it, and would go on with what an edited module used to say.
"""

import sys
from itertools import product
from pathlib import Path
from typing import Any

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115


def core() -> None:
    """Every scheme, in one dimension, with few particles and with many, and in two; what only studies evaluate."""
    from fracparticles.kernels.families import PAPER_ORDERS
    from fracparticles.run.case import Case
    from fracparticles.run.solver import solve
    from fracparticles.schemes import METHODS
    from fracparticles.special import green_slope, tail_mass

    tail_mass(1.0, 1.0, 1.5)
    green_slope(1.0, 1.0, 1.5, 2)
    for name, scheme in METHODS.items():
        orders = [order for order in scheme.ORDERS if order in PAPER_ORDERS]
        own = {} if name == "GPSE" else {"dt": 0.01}
        for exterior, order in product(scheme.EXTERIORS, orders):
            few = {"beta": 0.5, "truncation": 5.0, "spacing": 0.5, "exterior": exterior, **own}
            many = {**few, "spacing": 0.1}
            for evaluation in ("stepping",) if name == "DVM" else ("series", "stepping"):
                solve(Case(scheme=name, order=order, evaluation=evaluation, **few))
                solve(Case(scheme=name, order=order, evaluation=evaluation, **many))
            if 2 in scheme.DIMS:
                solve(Case(scheme=name, order=order, dim=2, **few))


def random_walk() -> None:
    """A few walkers."""
    import numpy as np

    from fracparticles.moving.random_walk import cell_counts, walk

    x = walk(np.zeros(10), 1.5, 1.0, np.random.default_rng(1), steps=2)
    cell_counts(x, 1.0, 4)


def sph() -> None:
    """The operators on a short line, real and complex, and the spline."""
    from fracparticles.sph import ParticleLine, caputo_derivative, rl_derivative, rl_integral
    from fracparticles.sph.cubic_spline import spline, spline_gradient, spline_integral

    line = ParticleLine(0.0, 1.0, 11)
    for operator in (rl_integral, rl_derivative, caputo_derivative):
        operator(line, line.x_all, 0.5)
    for curve in (spline, spline_gradient, spline_integral):
        curve(line.x, 1.0)


for source in map(Path, snakemake.input.code):
    for cached in (source.parent / "__pycache__").glob(f"{source.stem}.*.nb[ic]"):
        cached.unlink(missing_ok=True)
globals()[snakemake.wildcards.area]()
