"""The particles on [a, b]: real ones, virtual ones beyond the ends, and auxiliary ones in between (Fig. 1)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial
from math import ceil
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.sph.cubic_spline import SUPPORT

__all__ = ["ParticleLine"]

_FINEST = 1e-8  # spacing over the farthest position: the spacing is then equal to eight digits
_LEAST, _WIDEST = float(np.nextafter(1.0 / SUPPORT, 1.0)), 1000.0  # bounds of h / s


def _ratio(field: str, value: Any) -> float:
    words = "a number above 1/2, at most 1000", "The paper has 1.1."
    return check.real_between(field, value, _LEAST, _WIDEST, allowed=words[0], remedy=words[1])


@dataclass(frozen=True)
class ParticleLine:
    """N real particles from a to b, both ends included, and the virtual ones that complete every support.

    Raises `InvalidInput` if a value is not allowed.

    Parameters
    ----------
    a, b : float
        Ends of the domain, a < b.
    count : int
        N, at least 3.
    smoothing_ratio : float
        h / s, above 1/2 and at most 1000; the paper has 1.1. With 1/2 a particle would have no neighbours.
    """

    a: float
    b: float
    count: int
    smoothing_ratio: float = 1.1

    def __post_init__(self) -> None:
        count = partial(check.whole_number, least=3, most=check.MOST)
        check.fields(self, a=check.place, b=check.place, count=count, smoothing_ratio=_ratio)
        if not self.a < self.b:
            raise InvalidInput("b", self.b, "a finite number above a", "Give a < b.")
        # The positions are rounded to the last digit of the farthest one.
        if not self.spacing >= max(_FINEST * max(abs(self.a), abs(self.b)), check.SIZES[0]):
            allowed = f"particles more than {_FINEST:g} of their distance from zero apart"
            raise InvalidInput("count", self.count, allowed, "Take fewer, or move the origin.")

    @property
    def spacing(self) -> float:
        """s, the spacing of the particles and the volume m_j / rho_j of each."""
        return (self.b - self.a) / (self.count - 1)

    @property
    def smoothing(self) -> float:
        """h, the smoothing length."""
        return self.smoothing_ratio * self.spacing

    @property
    def margin(self) -> int:
        """The number of virtual particles beyond each end: those within 2 h of it."""
        return ceil(SUPPORT * self.smoothing_ratio)

    @property
    def inside(self) -> slice:
        """The real particles among `x_all`."""
        return slice(self.margin, self.margin + self.count)

    @cached_property
    def x_all(self) -> np.ndarray:
        """Positions of all particles, virtual, real, virtual, shape (N + 2 margin,)."""
        return self.a + self.spacing * np.arange(-self.margin, self.count + self.margin)

    @cached_property
    def x(self) -> np.ndarray:
        """Positions of the real particles, shape (N,)."""
        return self.x_all[self.inside]

    @cached_property
    def midpoints(self) -> np.ndarray:
        """Positions of the auxiliary particles (20), (x_j + x_{j+1}) / 2, shape (N - 1,)."""
        return 0.5 * (self.x[:-1] + self.x[1:])

    def field(self, name: str, values: Any) -> np.ndarray:
        """Return a field on all particles, virtual ones included, as a float array.

        Raises `InvalidInput` if it has another shape, or is not real and finite.
        """
        each = "a number on all particles, the virtual ones included (`ParticleLine.x_all`)"
        return check.of_shape(name, check.finite_array(name, values), self.x_all.shape, each)
