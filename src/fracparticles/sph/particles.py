"""The particles on [a, b]: real ones, virtual ones beyond the ends, auxiliary ones between (Fig. 1)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial
from math import ceil
from typing import Any

import numpy as np

from fracparticles.arguments import (
    MOST,
    SIZES,
    check_fields,
    finite_array,
    real_between,
    whole_number,
)
from fracparticles.errors import InvalidInput
from fracparticles.sph.cubic_spline import SUPPORT

__all__ = ["ParticleLine"]

_FINEST = 1e-8  # of the farthest position: the spacing is then the same everywhere to eight digits
_WIDEST = 1000.0


@dataclass(frozen=True)
class ParticleLine:
    """N real particles from a to b, both ends included, and the virtual ones that complete every support.

    Parameters
    ----------
    a, b : float
        Ends of the domain, a < b.
    count : int
        N, at least 3.
    smoothing_ratio : float
        h / s; the paper has 1.1. Above 1/2, or a particle would see no other; at most 1000.

    Raises
    ------
    InvalidInput
        If a value is not allowed.
    """

    a: float
    b: float
    count: int
    smoothing_ratio: float = 1.1

    def __post_init__(self) -> None:
        place = partial(real_between, low=-SIZES[1], high=SIZES[1])
        check_fields(self, a=place, b=place, count=partial(whole_number, least=3, most=MOST))
        if not self.a < self.b:
            raise InvalidInput("b", self.b, "a finite number above a", "Give a < b.")
        # Positions are rounded to the last digit of the farthest.
        if not self.spacing >= max(_FINEST * max(abs(self.a), abs(self.b)), SIZES[0]):
            raise InvalidInput(
                "count",
                self.count,
                f"particles that are more than {_FINEST:g} of their distance from zero apart",
                "Take fewer, or move the origin.",
            )
        ratio = real_between("smoothing_ratio", self.smoothing_ratio, 0.0, _WIDEST)
        if ratio <= 1.0 / SUPPORT:
            raise InvalidInput("smoothing_ratio", ratio, "a number above 1/2", "The paper has 1.1.")
        object.__setattr__(self, "smoothing_ratio", ratio)

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
        """The real ones among `x_all`."""
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

        Raises
        ------
        InvalidInput
            If it has another shape, or is not real and finite.
        """
        array = finite_array(name, values)
        if array.shape != self.x_all.shape:
            raise InvalidInput(
                name,
                f"array of shape {array.shape}",
                f"finite numbers on all {self.x_all.size} particles, the virtual ones included",
                "Evaluate the function at ParticleLine.x_all.",
            )
        return array
