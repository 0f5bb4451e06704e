"""Whether particles resolve a field of the caller's: its size by them against that by as many points between them."""

from __future__ import annotations

import warnings

import numpy as np

from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning

__all__ = ["warn_of_the_unseen"]

_UNRESOLVED = 0.01  # share of int |f| by which the two sizes may differ


def warn_of_the_unseen(
    name: str,
    values: FloatArray,
    volumes: FloatArray,
    between: FloatArray,
    volumes_between: FloatArray,
) -> None:
    """Warn if int |f| by the particles is not that by the points between them.

    Parameters
    ----------
    name : str
        The name of the field in the warning.
    values, volumes : arrays
        f at the particles, and their volumes.
    between, volumes_between : arrays
        f at points between the particles, and the volumes of these.

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
