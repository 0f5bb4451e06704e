"""Clusters of markers: where they are, how far apart, and how empty the line is between them."""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles.arguments import finite_array, positions, scale
from fracparticles.errors import InvalidInput

__all__ = ["cluster_centres", "emptiness", "marker_spectrum"]

_FEWEST = 3  # markers that make a cluster


def cluster_centres(x: Any, gap: float, within: float) -> np.ndarray:
    """Return the centres, in |x| < within, of the groups of three markers or more with gaps above `gap` between them.

    Raises `InvalidInput` if there are no positions, or a length is not positive. So do the others.
    """
    x = np.sort(positions("x", x))
    groups = np.split(x, np.flatnonzero(np.diff(x) > scale("gap", gap)) + 1)
    centres = np.array([g.mean() for g in groups if g.size >= _FEWEST])
    return centres[np.abs(centres) < scale("within", within)]


def emptiness(x: Any, gap: float, within: float) -> float:
    """Return the fraction of |x| < within that lies in gaps wider than `gap`: near 1 with clusters, near 0 without."""
    x, within = positions("x", x), scale("within", within)
    inside = np.sort(x[np.abs(x) < within])
    gaps = np.diff(np.concatenate([[-within], inside, [within]]))
    return float(gaps[gaps > scale("gap", gap)].sum() / (2.0 * within))


def marker_spectrum(x: Any, q: Any, within: float) -> np.ndarray:
    """Return |sum_j w_j exp(i q x_j)|^2 / sum_j w_j^2 with w = cos^2(pi x / (2 within)) for |x| < within.

    Independent markers give about 1, equally spaced ones about 0, clusters a peak at 2 pi / their distance.

    Raises `InvalidInput` as the others do, and if there are no markers there.
    """
    x, q, within = positions("x", x), finite_array("q", q), scale("within", within)
    x = x[np.abs(x) < within]
    if not x.size:
        raise InvalidInput(
            "within", within, "a part of the line with markers", "Take a larger one."
        )
    w = np.cos(0.5 * np.pi * x / within) ** 2
    return np.abs(np.exp(1j * np.multiply.outer(q, x)) @ w) ** 2 / np.sum(w * w)
