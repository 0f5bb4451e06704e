r"""SPH integrals: sums over all particles before a point, with the kernel's integral W~.

    <I f(z)>        = sum_j V_j f(x_j) W~(z - x_j),                                    (17)
    <I f(z)>        = sum_j V_j f(x-bar_j) W~(z - x-bar_j),                            (20)
    x-bar_j = (x_j + x_{j+1})/2,    f(x-bar_j) = (f(x_j) + f(x_{j+1}))/2,              (21)

and, with the power of a fractional integral in the integrand,

    J^p f(z)        = sum_j V_j (z - x_j)^p f(x_j) W~(z - x_j).

Particles up to 2 h beyond z have a share, for W~ is not yet 0 there; the power of a negative distance is complex,
(-d)^p = d^p exp(i pi p). Its real part belongs to the smoothed integral, its imaginary part is an error of the same
size, which the paper's norms count.

Three ways to place the volumes, `METHODS`: `standard` is (17) with the whole volume s of each particle, `halved`
our repair of it, s/2 for the two particles at the ends, of whose volume only a half lies in the domain; `modified`
is (20).
"""

from __future__ import annotations

from math import cos, pi, sin

import numba as nb
import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.sph.cubic_spline import iw
from fracparticles.sph.particles import ParticleLine

__all__ = ["METHODS", "power_integral", "power_sum"]

METHODS = ("standard", "halved", "modified")


def power_integral(
    line: ParticleLine, f: np.ndarray, z: np.ndarray, power: np.ndarray, method: str = "standard"
) -> np.ndarray:
    """J^p f at the points z, shape (M,), complex.

    Parameters
    ----------
    line : ParticleLine
        The particles.
    f : ndarray, shape (N,)
        The integrand on the real particles, real or complex.
    z, power : ndarray, shape (M,)
        Where, and p there. A particle at z itself has no share where p < 0: its term is infinite.
    method : {"standard", "halved", "modified"}
        How the volumes are placed.

    Raises
    ------
    InvalidInput
        If there is no such method.
    """
    if method not in METHODS:
        raise InvalidInput("method", method, f"one of {', '.join(METHODS)}", "Choose one.")
    if method == "modified":
        strengths = line.spacing * 0.5 * (f[:-1] + f[1:])
        return power_sum(z, line.midpoints, strengths, power, line.smoothing)
    strengths = line.spacing * f
    if method == "halved":
        strengths[[0, -1]] *= 0.5
    return power_sum(z, line.x, strengths, power, line.smoothing)


def power_sum(
    z: np.ndarray, x: np.ndarray, strengths: np.ndarray, power: np.ndarray, h: float
) -> np.ndarray:
    """sum_j q_j (z_i - x_j)^{p_i} W~(z_i - x_j), complex, for any particles x and strengths q, shape (N,)."""
    out = np.empty(z.size, dtype=complex)
    _power_sum(z, x, strengths, np.broadcast_to(power, z.shape).astype(float), h, out)
    return out


@nb.njit(cache=True, nogil=True)
def _power_sum(z, x, strengths, power, h, out):
    for i in range(z.size):
        p = power[i]
        behind = 0.0 * strengths[0]
        ahead = 0.0 * strengths[0]
        for j in range(x.size):
            d = z[i] - x[j]
            if d > 0.0:
                behind += strengths[j] * d**p * iw(d / h)
            elif d < 0.0:
                share = iw(d / h)
                if share > 0.0:
                    ahead += strengths[j] * (-d) ** p * share
            elif p == 0.0:
                behind += 0.5 * strengths[j]
        out[i] = behind + ahead * complex(cos(pi * p), sin(pi * p))
