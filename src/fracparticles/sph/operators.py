r"""Fractional operators of order 0 < alpha < 1 on [a, b], in the forms without a singular kernel.

Left-handed, by parts from Eqs. (1), (3), (5) and, with alpha = alpha(x) (Type I), from (7)-(9):

    I^alpha f   = [f(a) (x-a)^alpha + int_a^x f'(x') (x-x')^alpha dx'] / Gamma(1 + alpha),                     (33)
    RL D^alpha f = d/dx I^(1-alpha) f,                                                                         (34)
                 = [f(a) (x-a)^-alpha + d/dx int_a^x f'(x') (x-x')^(1-alpha)/(1-alpha) dx'] / Gamma(1-alpha),  (35)
    C D^alpha f = [f'(a) (x-a)^(1-alpha) + int_a^x f''(x') (x-x')^(1-alpha) dx'] / Gamma(2 - alpha),           (36)

(35) serves a constant order, and (34) a variable one. Derivatives are sums of `derivatives`, and integrals sums of
`integrals`. A field is given on all particles: the virtual ones carry the values of f beyond the ends. The outer
derivative of (34), (35) uses the integral at each virtual particle, too. (Eqs. (25) and (31) print the integral at x_i
inside the sum, where the one at x_j is meant.)

The right-handed operators (2), (4), (6) are the left-handed ones of the mirrored field: the sign (-1)^n of (4) and (6)
is that of the mirrored derivative.

The results are complex, see `integrals`; the value is the real part. At x = a the derivative of Riemann and Liouville
is infinite unless f(a) = 0. Each result is compared with the one of `comparison`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.special import gamma

from fracparticles import arguments as check
from fracparticles.sph import comparison
from fracparticles.sph.derivatives import gradient, second_derivative
from fracparticles.sph.integrals import COMPLETED, METHODS, power_integral
from fracparticles.sph.particles import ParticleLine

__all__ = ["caputo_derivative", "rl_derivative", "rl_integral", "singular_integral"]

Left = Callable[[ParticleLine, np.ndarray, np.ndarray, str], np.ndarray]
Other = Callable[[ParticleLine, np.ndarray, np.ndarray], np.ndarray]


def rl_integral(
    line: ParticleLine, f: Any, order: Any, *, side: str = "left", method: str = "standard"
) -> np.ndarray:
    """The Riemann-Liouville integral (33) on the real particles, shape (N,), complex.

    Raises `InvalidInput` if a value is not allowed; so do the other operators, with the same parameters.

    Parameters
    ----------
    line : ParticleLine
        The particles.
    f : array_like, shape (N + 2 margin,)
        The field on all particles, `line.x_all`.
    order : float or array_like of the same shape
        alpha, constant or on all particles (Type I), between 0 and 1.
    side : {"left", "right"}
        The integral from a, or up to b.
    method : {"standard", "halved", "modified", "completed"}
        The way to place the volumes of the sum, see `integrals`.

    Warns
    -----
    AccuracyWarning
        If a value is wrong by more than 5 % of the largest, by comparison with `comparison`. The others warn, too.
    """
    return _apply(_left_integral, comparison.rl_integral, 1, line, f, order, side, method)


def rl_derivative(
    line: ParticleLine, f: Any, order: Any, *, side: str = "left", method: str = "standard"
) -> np.ndarray:
    """The Riemann-Liouville derivative (35), or (34) for a variable order. Parameters as in `rl_integral`.

    Within 2 h of the end where the integral stops (b, or a for the right-handed one) all methods except `completed`
    are wrong by about (h/(b-a))^(1-alpha) / 2 of f' there.
    """
    return _apply(_left_rl_derivative, comparison.rl_derivative, -1, line, f, order, side, method)


def caputo_derivative(
    line: ParticleLine, f: Any, order: Any, *, side: str = "left", method: str = "standard"
) -> np.ndarray:
    """The Caputo derivative (36). Parameters as in `rl_integral`."""
    return _apply(_left_caputo, comparison.caputo_derivative, -1, line, f, order, side, method)


def singular_integral(
    line: ParticleLine, f: Any, order: Any, *, method: str = "standard"
) -> np.ndarray:
    """The left-handed integral by the singular sum (23), (24), whose infinite term j = i is left out.

    Parameters, errors and warnings as in `rl_integral`.
    """
    return _apply(
        _left_singular_integral, comparison.rl_integral, 1, line, f, order, "left", method
    )


def _apply(
    left: Left,
    other: Other,
    sign: int,
    line: ParticleLine,
    f: Any,
    order: Any,
    side: str,
    method: str,
) -> np.ndarray:
    """Apply an operator on one side, and compare the result; its unit is that of f times length^(sign * alpha)."""
    line = check.instance("line", line, ParticleLine)
    f, alpha = line.field("f", f), _orders(line, order)
    check.choice("method", method, (*METHODS, COMPLETED))
    turn = 1 if check.choice("side", side, ("left", "right")) == "left" else -1
    f, alpha = f[::turn], alpha[::turn]
    result = left(line, f, alpha, method)[::turn]
    with np.errstate(all="ignore"):  # differences of values near the greatest number overflow
        compared = comparison.among_more(other, line, f, alpha)[::turn]
        size = float((np.abs(f).max() * (line.b - line.a) ** (sign * alpha)).max())
        comparison.warn_of_difference(line, result, compared, size, method)
    return result


def _orders(line: ParticleLine, order: Any) -> np.ndarray:
    return check.within("order", order, 0.0, 1.0, inside=True, shape=line.x_all.shape)


def _left_integral(line: ParticleLine, f: np.ndarray, alpha: np.ndarray, method: str) -> np.ndarray:
    """(33) on the real particles."""
    return _integral_on_all(line, f, alpha, method)[line.inside]


def _integral_on_all(
    line: ParticleLine, f: np.ndarray, alpha: np.ndarray, method: str
) -> np.ndarray:
    """(33) on all particles: beyond a, the powers of the negative distances are complex."""
    boundary = f[line.inside.start] * (line.x_all - line.a + 0j) ** alpha
    integral = power_integral(line, _slope(line, f), line.x_all, alpha, method)
    return (boundary + integral) / gamma(1.0 + alpha)


def _left_singular_integral(
    line: ParticleLine, f: np.ndarray, alpha: np.ndarray, method: str
) -> np.ndarray:
    alpha = alpha[line.inside]
    return power_integral(line, f[line.inside], line.x, alpha - 1.0, method) / gamma(alpha)


def _left_rl_derivative(
    line: ParticleLine, f: np.ndarray, alpha: np.ndarray, method: str
) -> np.ndarray:
    if alpha.min() < alpha.max():  # (34)
        return _slope(line, _integral_on_all(line, f, 1.0 - alpha, method))
    integral = power_integral(line, _slope(line, f), line.x_all, 1.0 - alpha, method)
    derivative = _slope(line, integral / gamma(2.0 - alpha))
    at_a = f[line.inside.start]
    if at_a != 0.0:
        with np.errstate(divide="ignore"):
            power = (line.x - line.a) ** -alpha[line.inside]
        derivative.real += at_a * power / gamma(1.0 - alpha[line.inside])
    return derivative


def _left_caputo(line: ParticleLine, f: np.ndarray, alpha: np.ndarray, method: str) -> np.ndarray:
    power = 1.0 - alpha[line.inside]
    boundary = _slope(line, f)[0] * (line.x - line.a) ** power
    integral = power_integral(line, _curvature(line, f), line.x, power, method)
    return (boundary + integral) / gamma(1.0 + power)


def _slope(line: ParticleLine, f: np.ndarray) -> np.ndarray:
    """(16), (18) on the real particles, from f on all particles."""
    return gradient(line.x, line.x_all, line.spacing, f, line.smoothing)


def _curvature(line: ParticleLine, f: np.ndarray) -> np.ndarray:
    """(37) on the real particles, from f on all particles."""
    return second_derivative(line.x, f[line.inside], line.x_all, line.spacing, f, line.smoothing)
