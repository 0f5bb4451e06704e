r"""Peers on (-1, 1) with u = 0 outside: linear finite elements on any mesh, and fractional centred differences.

The energy of (-Laplacian)^(alpha/2), 1 < alpha < 2, by the slopes (the transform of c |r|^(1-alpha) is |k|^(alpha-2)):

    a(u, v) = int int c |x - y|^(1-alpha) u'(x) v'(y) dx dy.

The slopes of hat functions are constant on the elements, and the integral over a pair of elements is a second difference
of c G(r), G = |r|^(3-alpha) / ((2-alpha)(3-alpha)): the stiffness in closed form. Orders: Acosta & Borthagaray,
SIAM J. Numer. Anal. 55 (2017) 472.
"""

from __future__ import annotations

from math import gamma

import numpy as np
from scipy.linalg import eigh, solve, solve_toeplitz, toeplitz

from fracparticles.schemes.riesz import potential_constant
from scenes.run_times.problem_times.line_peers import centred_weights

__all__ = [
    "difference_eigenvalue",
    "difference_solution",
    "element_eigenvalue",
    "element_solution",
    "getoor",
    "graded_mesh",
    "stiffness",
]

Solution = tuple[np.ndarray, np.ndarray]


def getoor(x: np.ndarray, alpha: float) -> np.ndarray:
    """Return u of (-Laplacian)^(alpha/2) u = 1: (1 - x^2)^(alpha/2) / Gamma(1 + alpha)."""
    return np.asarray(np.clip(1.0 - x * x, 0.0, None) ** (0.5 * alpha) / gamma(1.0 + alpha))


def graded_mesh(elements: int, power: float) -> np.ndarray:
    """Return the nodes, -1 and 1 included, an even number of elements: the first is (2 / elements)^power from its end."""
    near = (np.arange(elements // 2 + 1) / (elements // 2)) ** power
    return np.concatenate((near - 1.0, 1.0 - near[-2::-1]))


def stiffness(nodes: np.ndarray, alpha: float) -> np.ndarray:
    """Return a(phi_i, phi_j) of the hat functions at the inner nodes."""
    scale = potential_constant(alpha) / ((2.0 - alpha) * (3.0 - alpha))
    g = scale * np.abs(nodes[:, None] - nodes) ** (3.0 - alpha)
    pairs = g[1:, :-1] - g[:-1, :-1] - g[1:, 1:] + g[:-1, 1:]
    h = np.diff(nodes)
    slopes = pairs / (h[:, None] * h)
    return np.asarray(slopes[:-1, :-1] - slopes[1:, :-1] - slopes[:-1, 1:] + slopes[1:, 1:])


def element_eigenvalue(alpha: float, elements: int, power: float = 1.0) -> float:
    """Return the first eigenvalue by linear elements."""
    nodes = graded_mesh(elements, power)
    h = np.diff(nodes)
    mass = np.diag((h[:-1] + h[1:]) / 3.0) + np.diag(h[1:-1] / 6.0, 1) + np.diag(h[1:-1] / 6.0, -1)
    low = eigh(stiffness(nodes, alpha), mass, eigvals_only=True, subset_by_index=(0, 0))
    return float(low[0])


def element_solution(alpha: float, elements: int, power: float = 1.0) -> Solution:
    """Return the inner nodes and u of (-Laplacian)^(alpha/2) u = 1 by linear elements."""
    nodes = graded_mesh(elements, power)
    h = np.diff(nodes)
    u = solve(stiffness(nodes, alpha), 0.5 * (h[:-1] + h[1:]), assume_a="pos")
    return nodes[1:-1], u


def difference_eigenvalue(alpha: float, points: int) -> float:
    """Return the first eigenvalue by (2 sin(theta/2) / h)^alpha on the points inside."""
    h = 2.0 / (points + 1)
    matrix = toeplitz(h**-alpha * centred_weights(alpha, points))
    return float(eigh(matrix, eigvals_only=True, subset_by_index=(0, 0))[0])


def difference_solution(alpha: float, points: int) -> Solution:
    """Return the points inside and u of (-Laplacian)^(alpha/2) u = 1 by the same differences."""
    h = 2.0 / (points + 1)
    u = solve_toeplitz(h**-alpha * centred_weights(alpha, points), np.ones(points))
    return h * np.arange(1, points + 1) - 1.0, u
