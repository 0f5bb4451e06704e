"""Waves that a velocity makes on a disc and its angles are too few for.

A velocity takes each wave along the rings for its neighbours, and those beyond the shortest for others. In the modes a
high wave may be slow, so that its rate does not tell. None of them grows by itself, see `bounded.disc_transport`.
"""

from __future__ import annotations

from fracparticles.arguments import FloatArray
from fracparticles.bounded.disc import Disc
from fracparticles.bounded.modes import size_of

__all__ = ["high_waves"]


def high_waves(disc: Disc, v: FloatArray) -> float:
    """Return the norm of v in the upper half of the waves along the rings."""
    return size_of(disc.all_modes().into(v)[disc.angular // 4 + 1 :].reshape(-1))
