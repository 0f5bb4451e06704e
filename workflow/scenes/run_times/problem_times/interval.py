"""Contests on (-1, 1) with absorbing ends: the first eigenvalue, and the mean time to leave (Getoor 1961)."""

from functools import partial

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

    def ours(particles: int) -> tuple[int, float]:
        return particles, Interval(alpha=alpha, particles=particles).eigenvalues()[0]

    def polynomials(count: int) -> tuple[int, float]:
        return count, jacobi_eigenvalues(alpha, polynomials=count)[0]

    def elements(count: int, power: float) -> tuple[int, float]:
        return count - 1, element_eigenvalue(alpha, count, power)

    def differences(points: int) -> tuple[int, float]:
        return points, difference_eigenvalue(alpha, points)

    peers = {"Jacobi polynomials": polynomials, **_peers(elements, differences)}
    return Contest(lambda ours: float(abs(ours / exact - 1.0)), {"graded particles": ours}, peers)


def leaving(alpha: float) -> Contest:
    """(-Laplacian)^(alpha/2) u = 1; the answers are (x, u)."""

    def ours(particles: int) -> tuple[int, Points]:
        line = Interval(alpha=alpha, particles=particles)
        return particles, (line.x, np.asarray(line.stationary(1.0)))

    def elements(count: int, power: float) -> tuple[int, Points]:
        return count - 1, element_solution(alpha, count, power)

    def differences(points: int) -> tuple[int, Points]:
        return points, difference_solution(alpha, points)

    error = greatest_error(partial(getoor, alpha=alpha))
    return Contest(error, {"graded particles": ours}, _peers(elements, differences))


def _peers(elements: Solve, differences: Solve) -> dict[str, Solve]:
    equal = partial(elements, power=1.0)
    return {"elements, equal": equal, "elements, graded": elements, "differences": differences}
