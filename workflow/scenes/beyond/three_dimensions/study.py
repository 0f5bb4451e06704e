"""Section 5 carried to n = 3, a study of our own: error and cost against h on a cube.

The schemes are those of the paper with the kernels for n = 3; the error is (59) over the ball |x| <= 5. Cost is
counted, not timed, so that the same runs give the same table; for times see the benchmark.
"""

from math import log2
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.fourier import transform_length
from fracparticles.special import green
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.orders import orders_by
from scenes.plane import particles_per_side

_KEY = ["scheme", "order", "exterior"]
_ROWS, _COLUMNS = 16, 8  # lines and wave numbers that the sums transform together
_VECTORS = 5  # strengths at t_initial and t_final, and three of the Chebyshev recurrence


def study(inputs: Inputs) -> Result:
    """Return the errors with their orders, what each run cost, and its mass beside the exact mass in the cube."""
    runs = inputs.scalars.rename(columns={"particle_spacing": "h", "relative_l1_error": "error"})
    runs["N"] = particles_per_side(inputs.scalars)
    runs = runs.sort_values([*_KEY, "h"], ascending=[True, True, False, False], ignore_index=True)
    counted = [_counted(run) for run in runs.itertuples()]
    applications, memory, exact = (np.array(part) for part in zip(*counted, strict=True))
    runs["work"] = runs["operator_applications"] * applications
    columns = {
        "scheme": runs["scheme"],
        "order": runs["order"].map(ORDERS).where(runs["scheme"] != "GPSE", "-"),
        "exterior": runs["exterior"],
        "N": runs["N"].astype(str) + "^" + runs["dim"].astype(str),
        "h": runs["h"],
        "error (59)": runs["error"],
        "order from the h above": orders_by(runs, _KEY, "error"),
        "operator applications": runs["operator_applications"],
        "work / 10^9 operations": 1e-9 * runs["work"],
        "kept / bytes a particle": (memory / runs["N"] ** runs["dim"]).round().astype(int),
        "mass at t0": runs["mass_initial"],
        "mass at tf": runs["mass_final"],
        "mass at tf, exact": exact,
    }
    return Result(pd.DataFrame(columns), series=runs[[*_KEY, "N", "h", "error", "work"]])


def _counted(run: Any) -> tuple[float, float, float]:
    """Operations of one application, bytes kept, and h^n sum_i G(x_i, t_f), the mass of the solution on the lattice."""
    work = operations(run.scheme, run.order, run.dim, run.N, run.overlap)
    memory = bytes_kept(run.scheme, run.order, run.dim, run.N, run.exterior)
    x = (np.arange(run.N) - run.N // 2) * run.h
    squares = sum(np.square(part) for part in np.meshgrid(*(x,) * run.dim, sparse=True))
    u = green(np.sqrt(squares), run.diffusivity * run.t_final, 1.0 + run.beta, run.dim)
    return work, memory, float(run.h**run.dim * np.sum(u))


def operations(scheme: str, order: int, dim: int, size: int, overlap: float) -> float:
    """Return the floating-point operations of one application on N^n particles, to leading order.

    5/2 L log2 L for a real transform of length L >= 2 N - 1, twice that for a complex one, one forward and one
    backward for each weight; only the lines that hold something are transformed: N^(n-1) along the last axis, half
    as many wave numbers and a factor L / N more lines with each axis that follows. FPSE has n weights, and the sums
    with the Gaussian kernel of its divergence, axis by axis, 3 M operations for a half band M.
    """
    length = transform_length(2 * size - 1)
    half = length // 2 + 1
    line = 2.5 * length * log2(length)
    transform = size ** (dim - 1) * line
    for axis in range(1, dim):
        transform += half * size ** (dim - 1 - axis) * length ** (axis - 1) * 2.0 * line
    weights = dim if scheme == "FPSE" else 1
    total = (1 + weights) * transform + 2.0 * weights * half * length ** (dim - 1)
    if scheme == "FPSE":
        # Every factor is a Gaussian of width epsilon times a polynomial; order IV is a sum of products.
        passes = dim * (dim if order == 2 else 2 + 3 * (dim - 1))
        total += passes * 3.0 * BandedConvolution.reach(overlap, 2) * size**dim
    return total


def bytes_kept(scheme: str, order: int, dim: int, size: int, exterior: str) -> float:
    """Return the memory that a run keeps after its set-up: the arrays of the sums and of the series, in bytes."""
    flux, opened = scheme == "FPSE", exterior == "open"
    weights = dim if flux else 1
    length = transform_length(2 * size - 1)
    half = length // 2 + 1
    columns = -(-half // _COLUMNS) * _COLUMNS
    symbols = weights * half ** (dim - 1) * columns
    spectra = 2 * (1 + weights) * size ** (dim - 1) * columns
    blocks = 4 * length ** (dim - 1) * _COLUMNS + _ROWS * (length + 2 * half)
    # Of the exterior four sums, on the part of the lattice where no coordinate is negative.
    beyond = 4.0 / 2**dim if opened else 0.0
    vectors = weights + _VECTORS + beyond  # the sums themselves
    diagonal = 0 if opened and flux else weights
    divergence = (3 if order == 2 else 5) if flux else 0
    return 8.0 * (symbols + spectra + blocks + (vectors + diagonal + divergence) * size**dim)
