"""Derivatives by integral operators over particles: the lecture note "Particle Approximations".

`moments` has the moments of a kernel, `shapes` the kernels of the note, `construction` the kernels that follow from
moment conditions, `approximation` the sums (9) and (21), `exchange` the particle strength exchange (26). Equation
numbers in this package are those of the note.
"""

from __future__ import annotations

from fracparticles.pse.approximation import derivative, lattice, reconstruct, regularised
from fracparticles.pse.construction import (
    construct,
    construct_laplacian,
    construct_stencil,
    required_moments,
)
from fracparticles.pse.exchange import StrengthExchange, cell_volumes
from fracparticles.pse.moments import gaussian_moment, lattice_moment, moment
from fracparticles.pse.shapes import (
    GAUSSIAN_20,
    TENT_27,
    GaussianKernel,
    Kernel,
    SplineKernel,
    Stencil,
    Tent,
)

__all__ = [
    "GAUSSIAN_20",
    "TENT_27",
    "GaussianKernel",
    "Kernel",
    "SplineKernel",
    "Stencil",
    "StrengthExchange",
    "Tent",
    "cell_volumes",
    "construct",
    "construct_laplacian",
    "construct_stencil",
    "derivative",
    "gaussian_moment",
    "lattice",
    "lattice_moment",
    "moment",
    "reconstruct",
    "regularised",
    "required_moments",
]
