r"""Where particles are put on the line: by the solution itself: close where it is curved, ever wider apart elsewhere.

A length l(x) is the distance in which the solution changes. Particles are an equal number of parts of it apart,

    dx / ds = l(x),   x_i = x(i h),   V_i = h l(x_i).

What l should be at the particle i of an earlier placement, or at a sample, is

    l_i = (c M / |u''|)^(1/3),   M = int |u|,

which shares the error int |u''| l^2 dx of the first differences out equally; a bell of mass M gets l = its width in the
middle. A placement needs l to be smooth, and not to change by more than a share g of the distance: neighbours may
differ by a factor, and no more. Both follow from a mean of the power -p over all samples,

    l(x)^(-p) = sum_i (g v_i / (B l_i)) [l_i^2 + g^2 (x - x_i)^2]^(-p/2),   B = int (1 + s^2)^(-p/2) ds,

v_i the length that sample i stands for: a constant l_i comes back, one small l_i spreads like g |x - x_i|.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput

__all__ = ["MOST", "LengthField", "LineParticles", "curvature", "place_particles", "wanted_lengths"]

MOST = 3000  # particles: all eigenvalues of a matrix of that size are wanted
_CURVATURE = 0.2  # c: of a stable density, whose |u''| M^-1 w^3 in the middle is 0.2 to 0.3
_POWER = 4.0  # p
_GROWTH = 1.0  # g
_TOLERANCE = 1e-10  # of the positions, relative to the least l


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
        beta = math.sqrt(math.pi) * math.gamma(0.5 * (_POWER - 1.0)) / math.gamma(0.5 * _POWER)
        object.__setattr__(self, "_weights", _GROWTH * volumes / (beta * self.lengths))

    def __call__(self, x: float) -> float:
        """Return l(x)."""
        weights: FloatArray = self._weights  # type: ignore[attr-defined]
        squares = self.lengths**2 + (_GROWTH * (x - self.x)) ** 2
        return float((weights @ squares ** (-0.5 * _POWER)) ** (-1.0 / _POWER))


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


def place_particles(
    length: Callable[[float], float], low: float, high: float, step: float
) -> LineParticles:
    """Return particles from `low` to `high`, at most a `step` apart in s; those at the ends stand for half their part.

    Parameters
    ----------
    length : callable
        l(x), smooth and positive.
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

    def beyond(_: float, x: FloatArray) -> float:
        return float(x[0] - high)

    beyond.terminal = True  # type: ignore[attr-defined]

    def positions(least: float, digits: float) -> Any:
        return solve_ivp(
            lambda _, x: [length(x[0])], (0.0, step * MOST), [low],
            method="DOP853", dense_output=True, events=beyond, rtol=1e-3 * digits, atol=digits * least,
        )  # fmt: skip

    roughly = positions(length(0.5 * (low + high)), 1e-4)
    run = positions(min(map(length, roughly.y[0])), _TOLERANCE)
    if run.status != 1:
        allowed = f"a step that leaves at most {MOST} particles"
        raise InvalidInput("step", step, allowed, "Take a longer one, or a shorter reach.")
    parts = max(8, math.ceil(run.t[-1] / step - 1e-6))
    x = run.sol(np.linspace(0.0, run.t[-1], parts + 1))[0]
    x[[0, -1]] = low, high
    volumes = run.t[-1] / parts * np.array([length(one) for one in x])
    volumes[[0, -1]] *= 0.5
    return LineParticles(x, volumes)
