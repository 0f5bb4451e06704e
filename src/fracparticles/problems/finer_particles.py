"""What the particles of a bounded domain make of the initial data by diffusion alone, beside three times as many.

A kink between the particles has its error from the first moment on, which half of the particles cannot tell, see
`frozen`. Three times as many along each axis have a third of it, so that two thirds are known. Without a velocity and a
source, and with a D that rests, a step may have any length: see `steady_diffusion`.

Where three times as many take more than a second, and the data are rough, fewer are given the same data, and their
error falls with the spacing: of n' particles for n it is taken n' / n times. This is how a jump falls once u has spread
over some spacings; a kink falls faster. How a jump lies between n' particles is not how it lies between n, and so there
it may lie anywhere, as in an array: see `interpolants`. Of data that are not rough nothing is known then: fewer
particles may not see how smooth they are.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.problems.fewer_particles import Solve, among, axes_of
from fracparticles.problems.interpolants import interpolants, is_rough
from fracparticles.problems.problem import Problem
from fracparticles.problems.steady_diffusion import diffused

__all__ = ["errors_of_diffusion", "values_of"]

_MOST = {
    "interval": 300,
    "square": 32,
    "disc": 24,
}  # particles of which thrice as many take a second
# Rings likewise, where D varies in space: all their modes are in one matrix.
_MOST_IN_ONE = 16
_WRAPPED = 12  # places that an angle goes on beyond a turn


def errors_of_diffusion(
    problem: Problem, initial: Any, fields: list[np.ndarray], solve: Solve
) -> list[list[np.ndarray]]:
    """Return at each output time the error at the particles, for all that the data may be; none where nothing is known.

    Parameters
    ----------
    problem : Problem
        Of a bounded domain.
    initial : callable or array
        The initial data: a function, or values at the particles, see `interpolants`.
    fields : list of arrays
        u at each output time, in whose size the errors are.
    solve : callable
        From a problem and its initial data to such a list.
    """
    nothing: list[list[np.ndarray]] = [[] for _ in fields]
    count = fields[0].shape[0]
    few = count // -(-count // _most(problem))
    try:
        some, many = (problem.model_copy(update={"particles": n}) for n in (few, 3 * few))
        if few < count and not is_rough(values_of(problem, initial)):
            return nothing
        values = values_of(some, initial) if callable(initial) else among(problem, some, initial)
        given = [initial] if callable(initial) else []
        if few < count or not callable(initial):
            given += _interpolated(some, many, values)
        made = diffused(some, values, solve)
        finer = [[among(many, some, w) for w in diffused(many, one, solve)] for one in given]
    except (InvalidInput, NonFiniteSolution):  # a function that knows its own particles alone
        return nothing
    sizes = [
        1.0 if problem.adds else _greatest(u) / (_greatest(v) or 1.0)
        for u, v in zip(fields, made, strict=True)
    ]
    return [
        [few / count * size * _placed(some, problem, v - w) for w in each]
        for size, v, *each in zip(sizes, made, *finer, strict=True)
    ]


def _most(problem: Problem) -> int:
    in_one = problem.domain == "disc" and problem.diffusion.depends_on - {"t"}
    return _MOST_IN_ONE if in_one else _MOST[str(problem.domain)]


def values_of(problem: Problem, initial: Any) -> np.ndarray:
    """Return the initial data at the particles; raises `InvalidInput` if a function does not know these."""
    try:
        return np.asarray(problem.bounded_domain.values("initial", initial))
    except Exception as error:  # whatever a function may raise that knows its own particles alone
        what = "a function of the place"
        raise InvalidInput(
            "initial", initial, what, "Evaluate it where it is asked for."
        ) from error


def _interpolated(some: Problem, many: Problem, values: np.ndarray) -> list[np.ndarray]:
    """What the values of some particles may be at many."""
    places = []
    for axis, ((_, turns), (at, _)) in enumerate(zip(axes_of(some), axes_of(many), strict=True)):
        behind = at * values.shape[axis] - 0.5 * (not turns)
        if turns:
            values = np.pad(values, [(0, 0)] * axis + [(_WRAPPED, _WRAPPED)], "wrap")
            behind = behind + _WRAPPED
        places.append(np.round(behind, 9))  # at a particle, without round-off
    return interpolants(values, *places)


def _placed(some: Problem, problem: Problem, error: np.ndarray) -> np.ndarray:
    same = some.particles == problem.bounded_domain.volumes.shape[0]
    return error if same else among(some, problem, error)


def _greatest(u: np.ndarray) -> float:
    return float(np.abs(u).max())
