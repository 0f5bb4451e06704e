"""What the particles of an interval make of the initial data by diffusion alone, beside three times as many.

Of 3 n particles, at (j + 1/2) / (3 n), n are those of the interval itself, j = 3 i + 1. A kink between the particles
has its error from the first moment on, which half of the particles cannot tell, see `frozen`. Three times as many have
a third of it, so that two thirds are known. Without a velocity and a source all is in the modes, and a step may have
any length.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.problems.fewer_particles import Solve
from fracparticles.problems.interpolants import interpolants
from fracparticles.problems.problem import Problem

__all__ = ["errors_of_diffusion"]

_MOST = 900  # particles whose modes take a second


def errors_of_diffusion(
    problem: Problem, initial: Any, fields: list[np.ndarray], solve: Solve
) -> list[list[np.ndarray]]:
    """Return at each output time the error at the particles, for all that the data may be; none where nothing is known.

    Parameters
    ----------
    problem : Problem
        Of a bounded domain. On a square and a disc, and of a D that changes in time, nothing is known.
    initial : callable or array
        The initial data: a function, or values at the particles, see `interpolants`.
    fields : list of arrays
        u at each output time, in whose size the errors are.
    solve : callable
        From a problem and its initial data to such a list.
    """
    nothing: list[list[np.ndarray]] = [[] for _ in fields]
    many = 3 * fields[0].shape[0]
    if problem.domain != "interval" or many > _MOST or "t" in problem.diffusion.depends_on:
        return nothing
    try:
        alone = problem.model_copy(update={"velocity": None, "source": None})
        finer = alone.model_copy(update={"particles": many})
        given = [initial] if callable(initial) else interpolants(initial, _places(many))
        coarse, fine = solve(alone, initial), [solve(finer, one) for one in given]
    except (InvalidInput, NonFiniteSolution):  # a function that knows its own particles alone
        return nothing
    sizes = [
        1.0 if problem.adds else _greatest(u) / (_greatest(v) or 1.0)
        for u, v in zip(fields, coarse, strict=True)
    ]
    return [
        [size * (v - w[1::3]) for w in each]
        for size, v, *each in zip(sizes, coarse, *fine, strict=True)
    ]


def _places(many: int) -> np.ndarray:
    """Those of the finer particles, in spacings of the others behind the first of these."""
    return np.asarray((np.arange(many) - 1.0) / 3.0)


def _greatest(u: np.ndarray) -> float:
    return float(np.abs(u).max())
