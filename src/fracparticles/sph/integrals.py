r"""SPH integrals: sums over all particles before a point, with the kernel's integral W~.

    <I f(z)>        = sum_j V_j f(x_j) W~(z - x_j),                                    (17)
    <I f(z)>        = sum_j V_j f(x-bar_j) W~(z - x-bar_j),                            (20)
    x-bar_j = (x_j + x_{j+1})/2,    f(x-bar_j) = (f(x_j) + f(x_{j+1}))/2,              (21)

and, with the power of a fractional integral in the integrand,

    J^p f(z)        = sum_j V_j (z - x_j)^p f(x_j) W~(z - x_j).

Particles up to 2 h beyond z contribute, because W~ is not yet 0 there. The power of a negative distance is complex,
(-d)^p = d^p exp(i pi p). Its real part belongs to the smoothed integral. Its imaginary part is an error of the same
size, which the paper's norms count.

There are three ways to place the volumes, `METHODS`. `standard` is (17) with the whole volume s of each particle.
`halved` is our repair of it: the two particles at the ends have s/2, since only half of their volume lies in the
domain. `modified` is (20).

All three take the integrand to be zero beyond b. J^p f then has a kink at b, and its derivative, as in (35), is wrong
there by about (h/(b-a))^p, which hardly falls with h for a small p. A fourth way, `completed`, has s/2 at a and goes
on beyond b, where f is continued by the straight line through its last two values.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles._compiled import njit
from fracparticles.sph.cubic_spline import iw
from fracparticles.sph.particles import ParticleLine

__all__ = ["COMPLETED", "METHODS", "power_integral", "power_sum"]

METHODS = ("standard", "halved", "modified")
COMPLETED = "completed"


def power_integral(
    line: ParticleLine, f: Any, z: Any, power: Any, method: str = "standard"
) -> np.ndarray:
    """J^p f at the points z, shape (M,), complex.

    Raises `InvalidInput` if the method does not exist, or the arrays do not fit together or are not finite.

    Parameters
    ----------
    line : ParticleLine
        The particles.
    f : array_like, shape (N,)
        The integrand on the real particles, real or complex.
    z : array_like, shape (M,)
        The points; for `completed` no farther beyond b than the virtual particles.
    power : array_like, shape (M,) or ()
        p at each point. A particle at z itself is left out where p < 0, since its term is infinite.
    method : {"standard", "halved", "modified", "completed"}
        The way to place the volumes.
    """
    line = check.instance("line", line, ParticleLine)
    f = check.vector("f", f, line.count, complex_too=True)
    check.choice("method", method, (*METHODS, COMPLETED))
    x = line.x
    if method == "modified":
        x, strengths = line.midpoints, line.spacing * 0.5 * (f[:-1] + f[1:])
    elif method == COMPLETED:
        # Twice the margin, since the kernel reaches as far beyond a virtual particle as beyond a real one. Positions
        # are rounded like those of `line.x_all`, or a particle might lie a little before itself.
        x = line.a + line.spacing * np.arange(line.count + 2 * line.margin)
        beyond = np.arange(1, 2 * line.margin + 1)
        strengths = line.spacing * np.append(f, f[-1] + (f[-1] - f[-2]) * beyond)
        strengths[0] *= 0.5
    else:
        strengths = line.spacing * f
        if method == "halved":
            strengths[[0, -1]] *= 0.5
    return power_sum(z, x, strengths, power, line.smoothing)


def power_sum(z: Any, x: Any, strengths: Any, power: Any, h: float) -> np.ndarray:
    """sum_j q_j (z_i - x_j)^{p_i} W~(z_i - x_j), complex, for any particles x and strengths q, shape (N,).

    The points z have the shape (M,), the powers (M,) or ().

    Raises `InvalidInput` if the arrays do not fit together or are not finite, or the powers overflow.
    """
    z, x, h = check.positions("z", z, least=0), check.positions("x", x), check.scale("h", h)
    strengths = check.vector("strengths", strengths, x.size, complex_too=True)
    power = np.ascontiguousarray(check.finite_array("power", power, z.shape))
    out = np.empty(z.size, dtype=complex)
    _power_sum(z, x, strengths, power, h, out)
    return check.finite_result("power", out)


@njit()
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
