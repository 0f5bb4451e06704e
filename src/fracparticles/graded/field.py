"""One Green step of the field between graded particles, which need not resolve the Green's function.

The particles x_j = L sinh(s_j) of `graded` carry the field that is band-limited in s,

    u(y) = sum_j u_j S_j(y),   S_j(y) = sinc(s(y) / ds - j),   s(y) = arcsinh(y / L),

zero beyond the outermost ones. GPSE over the whole time, epsilon^alpha = D T, is then exact for that field:

    u_i(T) = sum_j u_j int E_epsilon(x_i - y) S_j(y) dy.                         (interpolated)

One error is that of the interpolation. It is exponentially small in 1 / ds where u is smooth in s, as it is for a
solution whose tails fall like a power of |y|. The other comes from the region beyond the outermost particles. Volumes
far larger than epsilon do no harm here, unlike in `graded.green_step`: this pays most for alpha near 1, with its
heavy tails. As T goes to zero the matrix tends to the identity, except for the outermost particles, where the field
jumps: they keep one half.

The integrals are done by Gauss's rule on panels. These double in length away from y = x_i, up to half the way to y = 0,
and away from y = 0. Within each panel both factors are smooth except for the waves of S_j, for which the rule has
enough nodes. A node is kept as its distance from one of these two points, so that an epsilon far below an ulp of x_i is
resolved: with a = y / L, b = x_i / L of one sign

    s(y) - s(x_i) = arcsinh[(a - b) (a + b) / (a sqrt(1 + b^2) + b sqrt(1 + a^2))],

in which nothing cancels once a - b is known.
"""

from __future__ import annotations

import math

import numpy as np

from fracparticles._compiled import njit
from fracparticles.arguments import choice, fractional_order, positive_real
from fracparticles.graded.particles import FORMS, graded_particles, green_step, refuse_many
from fracparticles.special import green
from fracparticles.special.quadrature import gauss_legendre

__all__ = ["GRADED_FORMS", "INTERPOLATED", "graded_step", "green_step_of_field"]

INTERPOLATED = "interpolated"
GRADED_FORMS = (*FORMS, INTERPOLATED)

# Nodes of a panel without waves. The worst panel, of length d, has singularities at the distance d over one of its
# ends. There the error of Gauss's rule is about 4.6^(-2 n), 1e-16 for 12 nodes.
_NODES = 12


def graded_step(
    count: int, reach: float, scale: float, alpha: float, time: float, form: str = INTERPOLATED
) -> np.ndarray:
    """Return the matrix of one step on graded particles in any of the `GRADED_FORMS`, shape (N, N).

    It is that of `green_step_of_field` for "interpolated", and else that of `green_step`, with the same parameters.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    if choice("form", form, GRADED_FORMS) == INTERPOLATED:
        return green_step_of_field(count, reach, scale, alpha, time)
    return green_step(*graded_particles(count, reach, scale), alpha, time, form)


def green_step_of_field(
    count: int, reach: float, scale: float, alpha: float, time: float
) -> np.ndarray:
    """Return the matrix M of one step, u(T) = M u(0), shape (N, N), for `graded_particles(count, reach, scale)`.

    Parameters
    ----------
    count, reach, scale : int, float, float
        N, the position of the outermost particle, and L.
    alpha : float
        Fractional order, 1 < alpha < 2.
    time : float
        D T.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    x, volumes = graded_particles(count, reach, scale)
    refuse_many("count", x.size)
    alpha, time = fractional_order(alpha), positive_real("time", time)
    half = x.size // 2
    step = volumes[half] / scale
    # A panel spans at most arcsinh(1) in s; waves of pi / ds take a node for each radian of half the panel's phase.
    span = np.arcsinh(min(x[-1] / scale, 1.0))
    rule = gauss_legendre(_NODES + math.ceil(0.5 * np.pi * span / step))
    epsilon = time ** (1.0 / alpha)
    matrix = np.empty((x.size, x.size))
    for i in range(half + 1):
        near, near_weights = _nodes(*_panels_around(x[i], x[-1], scale, epsilon), rule)
        far, far_weights = _nodes(*_panels_around_zero(x[i], x[-1], scale, epsilon), rule)
        places = np.concatenate([
            _mapped_distance(near / scale, x[i] / scale),
            np.arcsinh(far / scale) - (i - half) * step,
        ])  # fmt: skip
        kernel = green(np.concatenate([near, far - x[i]]), time, alpha)
        kernel *= np.concatenate([near_weights, far_weights])
        matrix[i] = _against_sincs(kernel, places / step, np.arange(x.size) - i)
    matrix[half + 1 :] = matrix[:half][::-1, ::-1]
    return matrix


def _panels_around(
    x: float, reach: float, scale: float, epsilon: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of the panels next to x <= 0 as distances from x: down to -reach, and up to x / 2."""
    first = min(epsilon, math.hypot(x, scale))
    return _doubling(first, reach + x), _doubling(first, -0.5 * x)


def _panels_around_zero(
    x: float, reach: float, scale: float, epsilon: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of the other panels as distances from zero: down to x / 2, and up to reach."""
    first = min(scale, math.hypot(x, epsilon))
    return _doubling(first, -0.5 * x), _doubling(first, reach)


def _doubling(first: float, end: float) -> np.ndarray:
    """Return 0, first, 2 first, 4 first, .., end; only 0, no panel, for an end at zero."""
    if end <= 0.0:
        return np.zeros(1)
    doublings = max(0, math.ceil(math.log2(end) - math.log2(first)) + 1)
    ends = np.ldexp(first, np.arange(doublings))
    return np.concatenate([[0.0], ends[ends < end], [end]])


def _nodes(
    down: np.ndarray, up: np.ndarray, rule: tuple[np.ndarray, np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes and weights of the rule on the panels on either side."""
    nodes, weights = rule
    start, end = np.concatenate([-down[1:], up[:-1]]), np.concatenate([-down[:-1], up[1:]])
    middles, halves = 0.5 * (end + start), 0.5 * (end - start)
    return (middles[:, None] + halves[:, None] * nodes).ravel(), np.outer(halves, weights).ravel()


def _mapped_distance(difference: np.ndarray, b: float) -> np.ndarray:
    """Return arcsinh(a) - arcsinh(b) for a - b = `difference`, a and b of one sign, to relative round-off."""
    a = b + difference
    root = math.hypot(1.0, b)
    return np.arcsinh(difference / root * ((a + b) / (a + b * (np.hypot(1.0, a) / root))))


def _against_sincs(values: np.ndarray, t: np.ndarray, j: np.ndarray) -> np.ndarray:
    """Return sum_q values_q sinc(t_q - j), j whole numbers: sin(pi (t - j)) / pi is (-1)^j sin(pi t) / pi."""
    nearest = np.rint(t)
    # The distance to the nearest j is exact; where it is zero, anything small has the right quotient, one.
    distance = np.where(t == nearest, np.finfo(float).tiny, t - nearest)
    waves = values * np.sin(np.pi * distance) / np.pi * (1.0 - 2.0 * (nearest % 2.0))
    total = np.zeros(j.size)
    _add_poles(waves, t, j.astype(float), np.finfo(float).tiny, total)
    return (1.0 - 2.0 * (j % 2)) * total


@njit()
def _add_poles(waves, t, j, least, total):
    """total_k += sum_q waves_q / (t_q - j_k), in one order, so that the bits do not depend on threads."""
    for q in range(t.size):
        for k in range(j.size):
            apart = t[q] - j[k]
            total[k] += waves[q] / (apart if apart != 0.0 else least)
