"""Data on a part of a circle, continued by their tails: one pair of transforms, and the images subtracted again.

The lattice lies in a longer circle. There powers continue the data, and the images of the data are added. After the
transforms the images of the result are subtracted, see `tails`. `whole_space` and `widening` are runs of this kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fracparticles.time.circle import Amplification, Circle, Look, unseen
from fracparticles.time.tails import Tails

__all__ = ["Continued"]


class Continued:
    """A run made ready, in units of the spacing.

    Parameters
    ----------
    points, length : int
        N of the lattice and L of the circle, along each axis.
    dim : int
        n.
    alpha, scaled_time, amplification, every, moved
        See `Circle`.
    before, after : arrays
        The gamma of the data and of the result, see `Tails`.
    middle : sequence of int, optional
        The place from which the tails fall, in points from the middle of the data; left out, it is this middle.
    outer : bool
        See `Meeting`.

    Attributes
    ----------
    tails : Tails
    length : int
        L.
    waves : callable
        See `Circle`.
    """

    def __init__(
        self,
        points: int,
        length: int,
        dim: int,
        alpha: float,
        scaled_time: float,
        before: np.ndarray,
        after: np.ndarray,
        *,
        amplification: Amplification | None = None,
        every: int = 1,
        middle: Sequence[int] | None = None,
        moved: Sequence[float] | None = None,
        outer: bool = False,
    ) -> None:
        starts = [length // 2 - points // 2 - by for by in middle or (0,) * dim]
        inside = tuple(slice(start, start + points) for start in starts)
        shown = inside
        self._shown: tuple[Any, ...] = (..., *inside)
        if every > 1:
            first = length // 2 - every * (points // 2)
            shown = (slice(first, first + every * (points - 1) + 1, every),) * dim
            self._shown = (..., *(slice(first // every, first // every + points),) * dim)
        time = scaled_time * float(length) ** -alpha
        self.tails = Tails(inside, shown, length, alpha, time, before, after, moved, outer)
        self.length = length
        circle = Circle(length, dim, alpha, scaled_time, amplification, every, moved)
        self._circle, self._every, self.waves = circle, every, circle.waves

    def __call__(
        self, u: np.ndarray, b: np.ndarray | None = None, look: Look = unseen
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the result from data of shape (data, N, .., N), and the numbers on which its tail depends.

        If the amplitudes b of the tail of the data are given, nothing is fitted. `look` is called with u^ of the data
        on the circle.
        """
        longer, images, numbers = self.tails.complete(u, b)
        return self._circle(longer, look)[self._shown] - images, numbers

    def amplitudes(self, numbers: np.ndarray) -> np.ndarray:
        """Return the amplitudes b of the tail of the result, shape (data, terms), in units of its spacing."""
        return self.tails.result(numbers, self._every)
