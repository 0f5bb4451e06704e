"""What a contest is: a problem with a known answer, and those who solve it."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from fracparticles.problems import Problem, solve_problem
from fracstudy.errors import off

OURS, PEER = "ours", "peer"

Solve = Callable[..., tuple[int, Any]]
"""`solve(*grid)` returns the number of unknowns and the answer; all of it is timed."""
Points = tuple[np.ndarray, np.ndarray]
"""An answer: points along an axis, and u."""


class Contest(NamedTuple):
    """The error of an answer, and who solves, by name."""

    error: Callable[[Any], float]
    ours: Mapping[str, Solve]
    peers: Mapping[str, Solve]

    @property
    def contenders(self) -> dict[str, tuple[str, Solve]]:
        """All of them, each with its group."""
        groups = ((OURS, self.ours), (PEER, self.peers))
        return {name: (group, solve) for group, of in groups for name, solve in of.items()}


def greatest_error(exact: Callable[[np.ndarray], np.ndarray]) -> Callable[[Points], float]:
    """Return the error of an answer (x, u): the greatest at its points, over the greatest of the exact values."""
    return lambda answer: off(answer[1], exact(answer[0]))


def on_lattices(
    forms: Iterable[str], start: Callable[..., np.ndarray], **fields: Any
) -> dict[str, Solve]:
    """Return forms of ours, each with the orders 4 and 12, that solve the problem of these fields."""

    def solve(
        form: str, order: int, half_width: float, spacing: float, rtol: float, overlap: float = 2.0
    ) -> tuple[int, Points]:
        grid: dict[str, Any] = {"half_width": half_width, "spacing": spacing, "overlap": overlap}
        problem = Problem(form=form, order=order, rtol=rtol, **grid, **fields)
        run = solve_problem(problem, start, estimate=False)
        return run["u"].size, (run["x"].values, run["u"].values)

    return {f"{form} {order}": partial(solve, form, order) for form in forms for order in (4, 12)}
