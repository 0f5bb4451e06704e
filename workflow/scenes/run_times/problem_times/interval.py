"""Contests on (-1, 1) with absorbing ends: the first eigenvalue, and the mean time to leave (Getoor 1961)."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from fracparticles.bounded.interval import Interval
from fracparticles.bounded.interval_jacobi import jacobi_eigenvalues
from scenes.run_times.problem_times.contest import Contest, Points, Solve, greatest_error
from scenes.run_times.problem_times.interval_peers import (
    difference_eigenvalue,
    difference_solution,
    element_eigenvalue,
    element_solution,
    getoor,
)

_ENOUGH = 200  # polynomials for round-off


def eigenvalue(alpha: float) -> Contest:
    """The lowest eigenvalue of (-Laplacian)^(alpha/2); the answers are numbers."""
    exact = jacobi_eigenvalues(alpha, polynomials=_ENOUGH)[0]
    ours = {"graded particles": lambda n: (n, Interval(alpha=alpha, particles=n).eigenvalues()[0])}
    peers = {"Jacobi polynomials": lambda n: (n, jacobi_eigenvalues(alpha, polynomials=n)[0])}
    others = _peers(alpha, element_eigenvalue, difference_eigenvalue)
    return Contest(lambda found: float(abs(found / exact - 1.0)), ours, peers | others)


def leaving(alpha: float) -> Contest:
    """(-Laplacian)^(alpha/2) u = 1; the answers are (x, u)."""

    def ours(particles: int) -> tuple[int, Points]:
        line = Interval(alpha=alpha, particles=particles)
        return particles, (line.x, np.asarray(line.stationary(1.0)))

    error, peers = (
        greatest_error(partial(getoor, alpha=alpha)),
        (element_solution, difference_solution),
    )
    return Contest(error, {"graded particles": ours}, _peers(alpha, *peers))


def _peers(
    alpha: float, elements: Callable[..., Any], differences: Callable[..., Any]
) -> dict[str, Solve]:
    return {
        "elements, equal": lambda count: (count - 1, elements(alpha, count)),
        "elements, graded": lambda count, power: (count - 1, elements(alpha, count, power)),
        "differences": lambda points: (points, differences(alpha, points)),
    }
