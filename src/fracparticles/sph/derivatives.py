r"""SPH derivatives: sums over the particles within 2 h.

    <grad f(x_i)>   = sum_j V_j f(x_j) grad_i W_ij,                                              (16)
    grad^c_i W_ij   = grad_i W_ij / L_i,     L_i = -sum_j V_j grad_i W_ij (x_i - x_j),      (18), (19)
    <grad^2 f(x_i)> = -2 sum_j V_j (f(x_j) - f(x_i)) x_ij grad^c_i W_ij / (x_ij^2 + eta^2),      (37)

V_j = m_j / rho_j. Equation (19) prints L_i^{-1} where L_i is meant: with L_i the gradient of f(x) = x is 1 and not
L_i^2. Equation (37), Brookshaw's, is printed with eta = 0.0001 (1/h)^2, which is far larger than a distance and of
another dimension. The paper's digits come with eta = 0.0001 h^2. This is no length either: it is small beside x_ij for
h << 1e4 only. For f = (x - x_i)^2 / 2, whose second derivative is 1, (37) gives sum_j w_j x_ij^2 / (x_ij^2 + eta^2),
with w_j the terms of L_i over L_i. Where this is not near 1, there is an `AccuracyWarning`.

A point within 2 h of the last particle lacks a part of its sums; the virtual particles of `particles` complete them.
The value of L shows whether there are enough particles: it is 1 inside, and a half at the end of a line. Values below a
quarter or above four raise an `AccuracyWarning`, too.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles._compiled import njit
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.sph.cubic_spline import SUPPORT, dw

__all__ = ["BROOKSHAW_ETA", "correction", "gradient", "second_derivative"]

BROOKSHAW_ETA = 1.0e-4  # eta / h^2
_ENOUGH = 0.25  # L: a smaller value, or one above its inverse, is warned of
_TAKEN = 0.02  # share of a second derivative: if eta takes more, it is warned of


def correction(z: Any, x: Any, volumes: Any, h: float) -> np.ndarray:
    """L_i of (19) at the points z, shape (M,), from the particles x, shape (N,): in one dimension it is a number.

    Errors as for `gradient`.
    """
    z, x, volumes, h = _particles(z, x, volumes, h)
    return check.finite_result("volumes", _correction_at(z, x, volumes, h))


def gradient(z: Any, x: Any, volumes: Any, f: Any, h: float, corrected: bool = True) -> np.ndarray:
    """<grad f> (16) at the points z, with the kernel gradient of (18), or with that of (22) if uncorrected.

    The result has the shape (M,) and is complex if f is.

    Raises `InvalidInput` if the arrays do not fit together or are not finite, the particles are not in rising order,
    or a volume or h is not positive; if corrected, also if no particle lies within 2 h of a point.

    Parameters
    ----------
    z : array_like, shape (M,)
        The points at which the derivative is wanted; it may be empty.
    x, f : array_like, shape (N,)
        Positions in rising order and values of the particles; f real or complex.
    volumes : array_like, shape (N,) or ()
        V_j, positive.
    h : float
        Smoothing length.
    corrected : bool
        Whether to divide by L_i.
    """
    z, x, volumes, h = _particles(z, x, volumes, h)
    f = check.vector("f", f, x.size, complex_too=True)
    out = np.empty(z.size, dtype=f.dtype)
    with np.errstate(all="ignore"):
        _gradient(z, x, volumes * f, h, *_neighbours(z, x, h), out)
    return _divided(out, z, x, volumes, h, corrected)


def second_derivative(
    z: Any,
    f_z: Any,
    x: Any,
    volumes: Any,
    f: Any,
    h: float,
    eta: float | None = None,
    corrected: bool = True,
) -> np.ndarray:
    """<grad^2 f> (37) at the points z, shape (M,), where f has the values f_z. Other parameters as in `gradient`.

    `eta` is the length of the formula, zero or more, by default 0.0001 h^2.

    Errors as for `gradient`. Warns with `AccuracyWarning`, too, if eta is not small beside the distances.
    """
    z, x, volumes, h = _particles(z, x, volumes, h)
    f = check.vector("f", f, x.size, complex_too=True)
    f_z = check.vector("f_z", f_z, z.size, least=0, complex_too=True)
    f, f_z = (a.astype(np.result_type(f, f_z), copy=False) for a in (f, f_z))
    eta = BROOKSHAW_ETA * h * h if eta is None else check.real_between("eta", eta, 0.0)
    near = _neighbours(z, x, h)
    out, parabola = np.empty(z.size, dtype=f.dtype), np.empty(z.size)
    _brookshaw(z, f_z, x, volumes, f, h, eta, *near, out)
    _parabola(z, x, volumes, h, eta, *near, parabola)
    _warn_of_eta(parabola, _correction_at(z, x, volumes, h), eta)
    return _divided(out, z, x, volumes, h, corrected)


def _particles(
    z: Any, x: Any, volumes: Any, h: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    z, x = check.positions("z", z, least=0), check.positions("x", x, rising=True, equal=True)
    volumes = check.within("volumes", volumes, 0.0, inside=True, shape=x.shape)
    return z, x, np.ascontiguousarray(volumes), check.scale("h", h)


def _divided(
    sums: np.ndarray, z: np.ndarray, x: np.ndarray, volumes: np.ndarray, h: float, corrected: bool
) -> np.ndarray:
    corrected = check.flag("corrected", corrected)
    factor = _correction_at(z, x, volumes, h)
    if corrected:
        if not (factor > 0.0).all():
            lonely = float(z[~(factor > 0.0)][0])
            allowed = "only points with a particle nearer than 2 h, and not in the same place"
            raise InvalidInput("z", lonely, allowed, "Take a larger h, or leave the point out.")
        with np.errstate(all="ignore"):
            sums = sums / factor
    result: np.ndarray = check.finite_result("f", sums)
    off = (factor < _ENOUGH) | (factor > 1.0 / _ENOUGH)
    if off.any():
        warnings.warn(
            f"L of (19) is from {factor.min():.2g} to {factor.max():.2g} at {np.count_nonzero(off)} of {off.size} "
            "points, where it must be near 1: do not trust the derivative there. Take a larger h, or other volumes.",
            AccuracyWarning,
            stacklevel=3,
        )
    return result


def _warn_of_eta(parabola: np.ndarray, factor: np.ndarray, eta: float) -> None:
    """Warn if eta takes more than 2 % of a second derivative that is 1."""
    with np.errstate(divide="ignore", invalid="ignore"):
        left = np.where(factor > 0.0, parabola / factor, 1.0)
    least = float(left.min(initial=1.0))
    if least < 1.0 - _TAKEN:
        warnings.warn(
            f"eta = {eta:.3g} is not small beside the distances of the particles: of a second derivative {least:.2g} "
            "is left. Give a smaller eta, such as 0.0001 h, or change the unit of length.",
            AccuracyWarning,
            stacklevel=3,
        )


def _correction_at(z: np.ndarray, x: np.ndarray, volumes: np.ndarray, h: float) -> np.ndarray:
    out = np.empty(z.size)
    _correction(z, x, volumes, h, *_neighbours(z, x, h), out)
    return out


def _neighbours(z: np.ndarray, x: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """The indices of the first particle within 2 h of each point, and of the first one beyond."""
    return np.searchsorted(x, z - SUPPORT * h), np.searchsorted(x, z + SUPPORT * h)


@njit()
def _correction(z, x, volumes, h, first, end, out):
    for i in range(z.size):
        total = 0.0
        for j in range(first[i], end[i]):
            d = z[i] - x[j]
            total -= volumes[j] * dw(d / h) * d
        out[i] = total / (h * h)


@njit()
def _gradient(z, x, strengths, h, first, end, out):
    for i in range(z.size):
        total = 0.0 * strengths[0]
        for j in range(first[i], end[i]):
            total += strengths[j] * dw((z[i] - x[j]) / h)
        out[i] = total / (h * h)


@njit()
def _brookshaw(z, f_z, x, volumes, f, h, eta, first, end, out):
    for i in range(z.size):
        total = 0.0 * f[0]
        for j in range(first[i], end[i]):
            d = z[i] - x[j]
            if d * d > 0.0:  # the particle itself has no share
                total -= 2.0 * volumes[j] * (f[j] - f_z[i]) * d * dw(d / h) / (d * d + eta * eta)
        out[i] = total / (h * h)


@njit()
def _parabola(z, x, volumes, h, eta, first, end, out):
    """(37), uncorrected, for (x - z_i)^2 / 2."""
    for i in range(z.size):
        total = 0.0
        for j in range(first[i], end[i]):
            d = z[i] - x[j]
            if d * d > 0.0:
                total -= volumes[j] * dw(d / h) * d * (d * d / (d * d + eta * eta))
        out[i] = total / (h * h)
