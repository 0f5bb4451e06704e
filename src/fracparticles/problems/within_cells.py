r"""What the means of a function over cells leave out of its solution at early times.

Particles that are given the means m of a function f have its solution once it has spread over a cell, and m before. A
jump through a cell is then wrong by up to a half, where a solution from values has hardly any error yet. Let Q be the
spline through m. The solution from f - Q is, with a place X of the fundamental solution,

    E (f - Q)(x + (D t)^(1/alpha) X).

f - Q is almost nothing but in the cells about a kink or a jump, where
it has the mean zero. So only places within some cells count, and D is that of the particle. The mean is over quantiles
of |X|, in both or in many directions.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.ndimage import map_coordinates, maximum_filter

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.problems.fewer_particles import axes_of
from fracparticles.problems.problem import Problem
from fracparticles.special import central_mass

__all__ = ["WithinCells"]

_NEAR = 2.5  # cells from a particle, beyond which f - Q counts as zero
_LEAST = 1e-3  # share of the greatest |f|: where means and values differ less, nothing is left out
_RADII = {1: 64, 2: 24}  # quantiles of |X|
_DIRECTIONS = {1: 2, 2: 16}
_RANGE = np.geomspace(1e-4, 1e4, 160)  # of |X|


class WithinCells:
    """The solution from f - Q at the particles.

    Parameters
    ----------
    problem : Problem
        A problem on a bounded domain, with a constant order.
    initial : callable
        f.
    values, means : arrays
        f and m at the particles.
    """

    def __init__(
        self, problem: Problem, initial: object, values: FloatArray, means: FloatArray
    ) -> None:
        self._initial, self._means = initial, means
        places = np.stack([np.broadcast_to(x, values.shape) for x in problem.places.values()])
        turns = [turn for _, turn in axes_of(problem)]
        off = np.abs(means - values) > _LEAST * np.abs(values).max()
        mode = ["wrap" if turn else "nearest" for turn in turns]
        near = maximum_filter(off.astype(np.uint8), 2 * int(_NEAR) + 3, mode=mode).astype(bool)
        self._of = np.nonzero(near)
        self._index = np.stack(self._of).astype(float)
        self._at = np.stack([x[self._of] for x in places])
        per_cell = np.stack([
            np.stack([_slope(x, axis, turn)[self._of] for axis, turn in enumerate(turns)])
            for x in places
        ])  # fmt: skip
        # From a place beside the particle to cells, for each particle.
        self._to_cells = np.linalg.inv(np.moveaxis(per_cell, -1, 0))
        self._turns = turns

    def after(self, problem: Problem, t: float) -> FloatArray:
        """Return the solution of a problem on these particles at a time."""
        found = np.zeros(self._means.shape)
        if not self._of[0].size:
            return found
        d = problem.diffusion(problem.places | {"t": np.array(problem.t_initial)})
        d = np.broadcast_to(d, self._means.shape)[self._of]
        width = (d * (t - problem.t_initial)) ** (1.0 / problem.alpha)
        beside = width * _quantiles(problem.alpha, problem.dim)[..., None]
        cells = np.einsum("nij,jqn->iqn", self._to_cells, beside)
        index = self._index[:, None] + cells
        places = self._at[:, None] + beside
        size = np.hypot(*places)[None] if problem.domain == "disc" else np.abs(places)
        counts = (np.abs(cells) < _NEAR).all(axis=0) & (size <= problem.half_width).all(axis=0)
        for i, n, turn in zip(index, self._means.shape, self._turns, strict=True):
            counts &= turn | ((i >= 0.0) & (i <= n - 1.0))
        mode = "grid-wrap" if any(self._turns) else "nearest"
        missed = np.zeros(counts.shape)
        missed[counts] = check.sampled("initial", self._initial, *places[:, counts])
        missed[counts] -= map_coordinates(self._means, index[:, counts], order=3, mode=mode)
        found[self._of] = missed.mean(axis=0)
        return found


def _slope(x: FloatArray, axis: int, turns: bool) -> FloatArray:
    """Return how far a place moves with one particle along an axis."""
    if not turns:
        return np.asarray(np.gradient(x, axis=axis))
    return np.asarray(0.5 * (np.roll(x, -1, axis) - np.roll(x, 1, axis)))


@lru_cache(maxsize=16)
def _quantiles(alpha: float, dim: int) -> FloatArray:
    """Return places X of equal weight, shape (dim, Q), for D t = 1."""
    mass = np.asarray(central_mass(_RANGE, 1.0, alpha, dim))
    share = (np.arange(_RADII[dim]) + 0.5) / _RADII[dim]
    radius = np.exp(np.interp(share, mass, np.log(_RANGE)))
    if dim == 1:
        return np.concatenate([-radius, radius])[None]
    turned = np.arange(_DIRECTIONS[dim]) + 0.5 * (np.arange(radius.size) % 2)[:, None]
    angle = 2.0 * np.pi * turned / _DIRECTIONS[dim]
    return np.stack([radius[:, None] * f(angle) for f in (np.cos, np.sin)]).reshape(dim, -1)
