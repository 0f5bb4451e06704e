r"""Peers on (-1, 1) with u = 0 outside: linear finite elements on any mesh, and fractional centred differences.

The energy of (-Laplacian)^(alpha/2), 1 < alpha < 2, by the slopes (the transform of c |r|^(1-alpha) is |k|^(alpha-2)):

    a(u, v) = int int c |x - y|^(1-alpha) u'(x) v'(y) dx dy.

The slopes of hat functions are constant on the elements. Over a pair of elements that are near each other the integral
is a second difference of c G(r), G = |r|^(3-alpha) / ((2-alpha)(3-alpha)): the stiffness in closed form. Where that
would cancel, for elements far apart, the first terms in the half-widths a, b over the distance r of the middles are
taken, p = alpha - 1:

    4 a b c r^-p [1 + (p)_2 (a^2 + b^2) / (6 r^2) + (p)_4 ((a^4 + b^4) / 120 + a^2 b^2 / 36) / r^4].

Orders: Acosta & Borthagaray, SIAM J. Numer. Anal. 55 (2017) 472.
"""

from math import gamma

import numpy as np
from scipy.linalg import eigh, solve, solve_toeplitz, toeplitz

from fracparticles.adaptive.maps import GradedParticles
from fracparticles.schemes.riesz import potential_constant
from scenes.run_times.problem_times.contest import Points
from scenes.run_times.problem_times.line_peers import centred_weights

_FAR = 16.0  # half-widths away, where the next term is below 1e-9


def getoor(x: np.ndarray, alpha: float) -> np.ndarray:
    """Return u of (-Laplacian)^(alpha/2) u = 1: (1 - x^2)^(alpha/2) / Gamma(1 + alpha)."""
    return np.asarray(np.clip(1.0 - x * x, 0.0, None) ** (0.5 * alpha) / gamma(1.0 + alpha))


def graded_mesh(elements: int, power: float) -> GradedParticles:
    """Return the nodes of an even number of elements, -1 and 1 included: the second is (2 / elements)^power from -1.

    With their distances from the ends, and as volumes what a hat function holds.
    """
    near = (np.arange(elements // 2 + 1) / (elements // 2)) ** power
    left = np.concatenate((near, 2.0 - near[-2::-1]))
    h = np.diff(near)
    h = np.concatenate(([0.0], h, h[::-1], [0.0]))
    return GradedParticles(left - 1.0, 0.5 * (h[1:] + h[:-1]), left, left[::-1].copy())


def stiffness(distances: np.ndarray, alpha: float) -> np.ndarray:
    """Return a(phi_i, phi_j) of the hat functions at the inner nodes, from |x_i - x_j| of all."""
    scale, p = potential_constant(alpha), alpha - 1.0
    h = np.diagonal(distances, 1)
    g = scale / ((2.0 - alpha) * (3.0 - alpha)) * distances ** (3.0 - alpha)
    pairs = g[1:, :-1] - g[:-1, :-1] - g[1:, 1:] + g[:-1, 1:]
    middles = 0.5 * (distances[:-1, :-1] + distances[1:, 1:])
    far = middles > _FAR * (h[:, None] + h)
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v = (0.5 * h[:, None] / middles) ** 2, (0.5 * h / middles) ** 2
        terms = 1.0 + p * (p + 1.0) * (
            (u + v) / 6.0 + (p + 2.0) * (p + 3.0) * ((u * u + v * v) / 120.0 + u * v / 36.0)
        )
        pairs = np.where(far, scale * h[:, None] * h * middles**-p * terms, pairs)
    slopes = pairs / (h[:, None] * h)
    return np.asarray(slopes[:-1, :-1] - slopes[1:, :-1] - slopes[:-1, 1:] + slopes[1:, 1:])


def element_eigenvalue(alpha: float, elements: int, power: float = 1.0) -> float:
    """Return the first eigenvalue by linear elements, as 1 / the last one of the inverse, which round-off spares."""
    mesh = graded_mesh(elements, power)
    distances = mesh.distances
    inner = np.diagonal(distances, 1)[1:-1] / 6.0
    mass = np.diag(mesh.volumes[1:-1] / 1.5) + np.diag(inner, 1) + np.diag(inner, -1)
    last = [elements - 2] * 2
    high = eigh(mass, stiffness(distances, alpha), eigvals_only=True, subset_by_index=last)
    return float(1.0 / high[0])


def element_solution(alpha: float, elements: int, power: float = 1.0) -> Points:
    """Return the inner nodes and u of (-Laplacian)^(alpha/2) u = 1 by linear elements."""
    mesh = graded_mesh(elements, power)
    u = solve(stiffness(mesh.distances, alpha), mesh.volumes[1:-1], assume_a="pos")
    return mesh.x[1:-1], u


def difference_eigenvalue(alpha: float, points: int) -> float:
    """Return the first eigenvalue by (2 sin(theta/2) / h)^alpha on the points inside."""
    h = 2.0 / (points + 1)
    matrix = toeplitz(h**-alpha * centred_weights(alpha, points))
    return float(eigh(matrix, eigvals_only=True, subset_by_index=(0, 0))[0])


def difference_solution(alpha: float, points: int) -> Points:
    """Return the points inside and u of (-Laplacian)^(alpha/2) u = 1 by the same differences."""
    h = 2.0 / (points + 1)
    u = solve_toeplitz(h**-alpha * centred_weights(alpha, points), np.ones(points))
    return h * np.arange(1, points + 1) - 1.0, u
