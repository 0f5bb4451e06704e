r"""Where particles are put on the line: by the solution itself: close where it is curved, ever wider apart elsewhere.

A length l(x) is the distance in which the solution changes. Particles are an equal number of parts of it apart,

    dx / ds = l(x),   x_i = x(i h),   V_i = h l(x_i).

What l should be at the particle i of an earlier placement, or at a sample, is

    l_i = (c M / |u''|)^(1/3),   M = int |u|,

which shares the error int |u''| l^2 dx of the first differences out equally; a bell of mass M gets l = its width in the
middle. A placement needs l to be smooth, and not to change by more than a share g of the distance: neighbours may
differ by a factor, and no more. Both follow from a mean of the power -4 over all samples,

    l(x)^(-4) = sum_i (v_i / (B l_i)) [l_i^2 + (x - x_i)^2]^(-2),   B = int (1 + s^2)^(-2) ds = pi / 2,

v_i the length that sample i stands for: a constant l_i comes back, one small l_i spreads like |x - x_i|.

The places are those where s(x) = int dx / l is a multiple of h. The integral is that of Legendre polynomials on panels
half an l wide, in whose complex neighbourhood, four times as wide, 1 / l has no singularity.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from fracparticles import arguments as check
from fracparticles._compiled import njit
from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput
from fracparticles.special.quadrature import gauss_legendre

__all__ = [
    "MOST",
    "LengthField",
    "LineParticles",
    "bent_lengths",
    "curvature",
    "place_particles",
    "wanted_lengths",
]

MOST = 3000  # particles: all eigenvalues of a matrix of that size are wanted
_CURVATURE = 0.2  # c: of a stable density, whose |u''| M^-1 w^3 in the middle is 0.2 to 0.3
_PANEL, _NODES = 0.5, 12  # of l; an error of 8^-12, 8 = 4 + 17^(1/2)
_NEWTON = 6  # steps to the place of a particle within its panel


@dataclass(frozen=True)
class LineParticles:
    """Particles of the line in ascending order, that a smooth map places.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        Positions, and what the particles stand for.
    """

    x: FloatArray
    volumes: FloatArray

    @property
    def distances(self) -> FloatArray:
        """|x_i - x_j|, shape (N, N)."""
        return np.asarray(np.abs(self.x[:, None] - self.x))


@dataclass(frozen=True)
class LengthField:
    """l(x) from the lengths l_i at samples x_i in ascending order."""

    x: FloatArray
    lengths: FloatArray

    def __post_init__(self) -> None:
        gaps = np.diff(self.x)
        volumes = 0.5 * (np.append(gaps, gaps[-1]) + np.append(gaps[0], gaps))
        weights = volumes / (0.5 * math.pi * self.lengths)
        unit = 2.0 ** np.round(np.log2(self.lengths.max()))  # l^4 may be no number in the caller's
        samples = self.x / unit, np.square(self.lengths / unit), weights
        object.__setattr__(self, "_samples", samples)
        object.__setattr__(self, "_unit", unit)

    def __call__(self, x: FloatArray) -> FloatArray:
        """Return l(x), shape (M,)."""
        mean = np.empty(x.size)
        _means(x / self._unit, *self._samples, mean)  # type: ignore[attr-defined]
        return np.asarray(self._unit * mean**-0.25)  # type: ignore[attr-defined]


def curvature(x: FloatArray, u: FloatArray) -> FloatArray:
    """Return |u''| at each x by three points; at the ends that of the next."""
    slopes = np.diff(u) / np.diff(x)
    second = np.abs(2.0 * np.diff(slopes) / (x[2:] - x[:-2]))
    return np.concatenate([second[:1], second, second[-1:]])


def wanted_lengths(x: FloatArray, u: FloatArray) -> FloatArray:
    """Return l_i for values u at x in ascending order, shape (N,); none above the whole length.

    Raises
    ------
    InvalidInput
        If u is zero everywhere.
    """
    mass = float(np.trapezoid(np.abs(u), x))
    if mass <= 0.0:
        raise InvalidInput("initial", "zero everywhere", "values that are not zero", "Give some.")
    whole = x[-1] - x[0]
    bent = np.maximum(curvature(x, u), _CURVATURE * mass / whole**3)
    return np.asarray(np.cbrt(_CURVATURE * mass / bent))


def bent_lengths(x: FloatArray, values: FloatArray) -> FloatArray:
    """Return (R / |f''|)^(1/2) for values f at x, R their range: of a coefficient, which need not fall off."""
    whole, range_ = x[-1] - x[0], float(np.ptp(values))
    return np.asarray(np.sqrt(range_ / np.maximum(curvature(x, values), range_ / whole**2)))


def place_particles(
    length: Callable[[FloatArray], FloatArray], low: float, high: float, step: float
) -> LineParticles:
    """Return particles from `low` to `high`, at most a `step` apart in s; those at the ends stand for half their part.

    Parameters
    ----------
    length : callable
        l(x) of an array, smooth and positive.
    low, high : float
    step : float
        h: the parts of l that neighbours are apart, up to 1.

    Raises
    ------
    InvalidInput
        If an argument is outside its range, or more than `MOST` particles were needed.
    """
    low, high = check.pair("ends", (low, high), rising=True)
    step = check.real_between("step", step, 1e-3, 1.0)
    edges = _panels(length, low, high, 2.0 * step * MOST)
    t, w = gauss_legendre(_NODES)
    half = 0.5 * np.diff(edges)
    x = (edges[:-1] + half) + half * t[:, None]
    rates = (half / length(x.ravel()).reshape(x.shape)).T
    orders = np.arange(_NODES) + 0.5
    rate = (orders * ((rates * w) @ legendre.legvander(t, _NODES - 1))).T
    s_inside = legendre.legint(rate, lbnd=-1)  # (nodes + 1, panels)
    s = np.append(0.0, np.cumsum(2.0 * rate[0]))
    parts = max(8, math.ceil(s[-1] / step - 1e-6))
    if edges[-1] < high or parts >= MOST:
        allowed = f"a step that leaves at most {MOST} particles"
        raise InvalidInput("step", step, allowed, "Take a longer one, or a shorter reach.")
    wanted = np.linspace(0.0, s[-1], parts + 1)
    panel = np.clip(np.searchsorted(s, wanted, side="right") - 1, 0, half.size - 1)
    inside, slope, goal = s_inside[:, panel], rate[:, panel], wanted - s[panel]
    at = goal / rate[0, panel] - 1.0
    for _ in range(_NEWTON):
        missed = legendre.legval(at, inside, tensor=False) - goal
        at = np.clip(at - missed / legendre.legval(at, slope, tensor=False), -1.0, 1.0)
    x = edges[panel] + half[panel] * (1.0 + at)
    x[[0, -1]] = low, high
    volumes = s[-1] / parts * length(x)
    volumes[[0, -1]] *= 0.5
    return LineParticles(x, volumes)


def _panels(
    length: Callable[[FloatArray], FloatArray], low: float, high: float, most: float
) -> FloatArray:
    """The ends of panels half an l wide, up to some number of them."""
    edges = [low]
    while edges[-1] < high and len(edges) <= most + 16.0:
        x = np.array(edges[-1:])
        middle = x + 0.5 * _PANEL * length(x)
        edges.append(float(x[0] + _PANEL * length(middle)[0]))
    edges[-1] = min(edges[-1], high)
    return np.array(edges)


@njit(error_model="numpy", fastmath={"contract", "reassoc"})
def _means(x, samples, squares, weights, out):
    for i in range(x.size):
        total = 0.0
        for j in range(samples.size):
            square = squares[j] + (x[i] - samples[j]) ** 2
            total += weights[j] / (square * square)
        out[i] = total
