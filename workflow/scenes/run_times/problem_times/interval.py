"""Contests on (-1, 1) with absorbing ends: the first eigenvalue, and the mean time to leave (Getoor 1961)."""

from __future__ import annotations

from functools import partial

from fracparticles.bounded.interval import Interval
from fracparticles.bounded.interval_jacobi import jacobi_eigenvalues
from scenes.run_times.problem_times.contest import OURS, PEER, Contender, Contest, greatest_error
from scenes.run_times.problem_times.interval_peers import (
    Solution,
    difference_eigenvalue,
    difference_solution,
    element_eigenvalue,
    element_solution,
    getoor,
)

__all__ = ["eigenvalue", "leaving"]

_ENOUGH = 200  # polynomials for round-off


def eigenvalue(alpha: float) -> Contest:
    """The lowest eigenvalue of (-Laplacian)^(alpha/2); the answers are numbers."""
    exact = jacobi_eigenvalues(alpha, polynomials=_ENOUGH)[0]

    def ours(particles: int) -> tuple[int, float]:
        return particles, Interval(alpha=alpha, particles=particles).eigenvalues()[0]

    def elements(count: int, power: float) -> tuple[int, float]:
        return count - 1, element_eigenvalue(alpha, count, power)

    def polynomials(count: int) -> tuple[int, float]:
        return count, jacobi_eigenvalues(alpha, polynomials=count)[0]

    return Contest(
        lambda answer: float(abs(answer / exact - 1.0)),
        {
            "graded particles": Contender(OURS, ours),
            "Jacobi polynomials": Contender(PEER, polynomials),
            "elements, equal": Contender(PEER, partial(elements, power=1.0)),
            "elements, graded": Contender(PEER, elements),
            "differences": Contender(PEER, lambda n: (n, difference_eigenvalue(alpha, n))),
        },
    )


def leaving(alpha: float) -> Contest:
    """(-Laplacian)^(alpha/2) u = 1; the answers are (x, u)."""

    def ours(particles: int) -> tuple[int, Solution]:
        line = Interval(alpha=alpha, particles=particles)
        return particles, (line.x, line.stationary(1.0))

    def elements(count: int, power: float) -> tuple[int, Solution]:
        return count - 1, element_solution(alpha, count, power)

    return Contest(
        greatest_error(partial(getoor, alpha=alpha)),
        {
            "graded particles": Contender(OURS, ours),
            "elements, equal": Contender(PEER, partial(elements, power=1.0)),
            "elements, graded": Contender(PEER, elements),
            "differences": Contender(PEER, lambda n: (n, difference_solution(alpha, n))),
        },
    )
