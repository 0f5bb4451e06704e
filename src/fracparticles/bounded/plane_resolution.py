"""Whether particles see a field of the caller's: its size by them against that by as many between them."""

from __future__ import annotations

import warnings

import numpy as np

from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning

__all__ = ["warn_of_the_unseen"]

_UNRESOLVED = 0.01  # of int |f|


def warn_of_the_unseen(
    name: str,
    values: FloatArray,
    volumes: FloatArray,
    between: FloatArray,
    volumes_between: FloatArray,
) -> None:
    """Warn if int |f| by the particles is not that by the points between them.

    Warns
    -----
    AccuracyWarning
        If the two differ by more than a hundredth.
    """
    seen = float((volumes * np.abs(values)).sum())
    other = float((volumes_between * np.abs(between)).sum())
    missed, size = abs(seen - other), max(seen, other)
    if missed > _UNRESOLVED * size:
        warnings.warn(
            f"the particles do not resolve {name}: int |{name}| differs by {missed / size:.1g} of it between them "
            "and the points in their middles. Take more.",
            AccuracyWarning,
            stacklevel=5,
        )
