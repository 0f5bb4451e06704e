"""The problems of the race: data, exact solution, and the error of a result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from fracparticles.special.stable import green, mean_radius

__all__ = ["Points", "Problem", "distance", "lattice"]

Points = tuple[np.ndarray, ...]
"""One array for each coordinate; their shapes broadcast."""


def distance(x: Points, centre: Sequence[float] = ()) -> np.ndarray:
    """Return |x - centre|; coordinates of the centre that are not given are zero."""
    offsets = [*centre, *(0.0,) * (len(x) - len(centre))]
    return np.sqrt(sum((line - c) ** 2 for line, c in zip(x, offsets, strict=True)))


def lattice(points: int, half_width: float, dim: int) -> Points:
    """Return x_i = (i - N // 2) h, h = 2 D / N, along each axis; N is `points` and D `half_width`."""
    x = (np.arange(points) - points // 2) * (2.0 * half_width / points)
    return tuple(np.meshgrid(*(x,) * dim, indexing="ij", sparse=True))


@dataclass(frozen=True)
class Problem:
    """Data at time 0, D = 1, and the solution at time 1, in `dim` dimensions.

    Attributes
    ----------
    beta : float
        Fractional order, alpha = 1 + beta.
    dim : {1, 2, 3}
    """

    beta: float
    dim: int = 1

    name = ""
    title = ""  # in a few words
    place = 100  # in lists
    dims: ClassVar[tuple[int, ...]] = (1, 2, 3)  # the dimensions in which it exists
    time = 1.0
    finest = 1.0  # the size of the finest detail, the unit of spacings

    @property
    def alpha(self) -> float:
        """Fractional order alpha = 1 + beta."""
        return 1.0 + self.beta

    @property
    def tail(self) -> tuple[float, ...] | None:
        """The powers by which the data fall, see `whole_space.evolve`."""
        return None

    @property
    def width(self) -> float:
        """R_alpha t_f^(1/alpha) of the papers' problem, the unit of half-widths: D = C times it, Eq. (46)."""
        return float(1.5 ** (1.0 / self.alpha) * mean_radius(self.alpha))

    @property
    def error_radius(self) -> float:
        """The error is taken over |x| <= 5 R_alpha (48) on the line, and over |x| <= 5 (59) for dim = 2 and 3."""
        return 5.0 * mean_radius(self.alpha) if self.dim == 1 else 5.0

    def initial(self, x: Points) -> np.ndarray:
        """Return the data."""
        raise NotImplementedError

    def exact(self, x: Points) -> np.ndarray:
        """Return the solution; it is asked for at most two error radii away."""
        raise NotImplementedError

    def green(self, x: Points, time: float, centre: Sequence[float] = ()) -> np.ndarray:
        """Return the fundamental solution about a centre."""
        return np.asarray(green(distance(x, centre), time, self.alpha, self.dim))

    def error(self, x: Points, volumes: np.ndarray | float, u: np.ndarray) -> float:
        """Return sum V |u - exact| / sum V |exact| over the points within the error radius; nan for fewer than two."""
        inside = distance(x) <= self.error_radius
        if np.count_nonzero(inside) < 2:
            return float("nan")
        volume = np.broadcast_to(volumes, inside.shape)[inside]
        exact = self.kept("exact", x)[inside]
        return float((volume * np.abs(u[inside] - exact)).sum() / (volume * np.abs(exact)).sum())

    def tail_error(self, x: Points, u: np.ndarray) -> float:
        """Return the greatest relative error between one and two error radii; nan if no points reach there."""
        r = distance(x)
        far = (r >= self.error_radius) & (r <= 2.0 * self.error_radius)
        if r.max() < 1.9 * self.error_radius or not far.any():
            return float("nan")
        return float(np.abs(u[far] / self.kept("exact", x)[far] - 1.0).max())

    def kept(self, which: str, x: Points) -> np.ndarray:
        """Return the `initial` data, or the `exact` solution, which is nan beyond two error radii.

        Both are kept for the last few sets of points, since many contenders try the same lattices.
        """
        return _kept(self, which, tuple(x.tobytes() for x in x), tuple(x.shape for x in x))


@lru_cache(maxsize=64)
def _kept(
    problem: Problem, which: str, data: tuple[bytes, ...], shapes: tuple[tuple[int, ...], ...]
) -> np.ndarray:
    lines = zip(data, shapes, strict=True)
    x = tuple(np.frombuffer(line).reshape(shape) for line, shape in lines)
    if which == "initial":
        return problem.initial(x)
    r = distance(x)
    near = r <= 2.0 * problem.error_radius
    u = np.full(r.shape, np.nan)
    u[near] = problem.exact(tuple(np.broadcast_to(line, r.shape)[near] for line in x))
    return u
