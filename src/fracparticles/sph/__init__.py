"""Smoothed particle hydrodynamics (SPH) for fractional operators in one dimension.

Ghorbani and Semperlotti, "On the one-dimensional SPH approximation of fractional-order operators"; its equations
are cited by their numbers. `cubic_spline` is the kernel, `particles` the real, virtual and auxiliary particles,
`derivatives` and `integrals` the sums over them, `operators` the fractional operators, `closed_forms` the exact
solutions of the Appendix, and `definition` the defining integral by quadrature.
"""

from __future__ import annotations

from fracparticles.sph.operators import caputo_derivative, rl_derivative, rl_integral
from fracparticles.sph.particles import ParticleLine

__all__ = ["ParticleLine", "caputo_derivative", "rl_derivative", "rl_integral"]
