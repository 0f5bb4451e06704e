"""What a contest is: a problem with a known answer, and those who solve it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

__all__ = ["OURS", "PEER", "Contender", "Contest", "greatest_error"]

OURS, PEER = "ours", "peer"


class Contender(NamedTuple):
    """One who solves: `solve(*grid)` returns the number of unknowns and the answer; all of it is timed."""

    group: str
    solve: Callable[..., tuple[int, Any]]


class Contest(NamedTuple):
    """The error of an answer, and the contenders by name."""

    error: Callable[[Any], float]
    contenders: Mapping[str, Contender]


def greatest_error(
    exact: Callable[[np.ndarray], np.ndarray],
) -> Callable[[tuple[np.ndarray, np.ndarray]], float]:
    """Return the error of an answer (x, u): the greatest at its points, over the greatest of the exact values."""

    def error(answer: tuple[np.ndarray, np.ndarray]) -> float:
        x, u = answer
        known = exact(x)
        return float(np.abs(u - known).max() / np.abs(known).max())

    return error
