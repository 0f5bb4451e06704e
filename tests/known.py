"""Solutions in closed form, and measures of errors, that several files of tests take."""

from __future__ import annotations

from math import gamma

import numpy as np
from scipy.special import hyp2f1

from fracparticles.special import green


def orders(errors):
    """The observed orders of errors, each with twice as many particles along an axis as the one before."""
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def error_of(run, exact) -> float:
    """The greatest error of a solved problem, over the greatest of the solution."""
    return float(np.abs(run.u.values - exact).max() / np.abs(exact).max())


def blobs(x, t, alpha):
    """Two fundamental solutions, of widths 0.01 and 1 at the time zero, 50 apart."""
    return 0.5 * green(x, 0.01**alpha + t, alpha) + 0.5 * green(x - 50.0, 1.0 + t, alpha)


def in_the_whole_plane(alpha):
    """u = (1 + |x|^2)^-p about (0.3, 0), and (-Laplacian)^s u, s = alpha/2:

    2^alpha Gamma(p+s) Gamma(1+s) / Gamma(p) 2F1(p+s, 1+s; 1; -|x|^2).
    """
    s, p = 0.5 * alpha, 2.3

    def u(x, y):
        return (1.0 + (x - 0.3) ** 2 + y**2) ** -p

    def source(x, y):
        size = 2.0**alpha * gamma(p + s) * gamma(1.0 + s) / gamma(p)
        return size * hyp2f1(p + s, 1.0 + s, 1.0, -((x - 0.3) ** 2) - y**2)

    return u, source


def pieces_of_the_line():
    """Pieces of (0, 24 1.5^39): their ends, Gauss nodes in each, shape (pieces, 30), and the weights for length 2."""
    nodes, weights = np.polynomial.legendre.leggauss(30)
    edges = np.concatenate([np.arange(0.0, 24.0, 0.5), 24.0 * 1.5 ** np.arange(0, 40)])
    low, width = edges[:-1], np.diff(edges)
    return low, edges[1:], low[:, None] + 0.5 * width[:, None] * (1.0 + nodes), weights
