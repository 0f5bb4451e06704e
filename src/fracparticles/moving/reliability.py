r"""What the particles of a run reveal about its accuracy. No estimate uses the exact solution.

ripple
    Particles a distance d apart turn a uniform field into one that ripples by 2 K^(2 pi eps / d) of itself, where K^ is
    the Fourier transform of the kernel (Poisson's formula). The estimate is a mean over the particles, weighted by
    their strengths, of the greatest ripple that a gap of their size or a smaller one can give.

round-off
    Every step rounds a place x by half an ulp of it, or does not move it at all if it would move by less.

volumes
    The strengths assume that each particle stands for a length h. The places give the length for which it does stand,
    `cells`. Both give an integral of |u|, and the error of a run is their difference.

smoothing
    The field of the particles at the start is the data smoothed by the kernel. The estimate is its largest difference
    from the data, over their peak.

remeshing
    The estimate is the sum of what the remeshings of a run change of the field at places of the lattice, over its peak.
    The first, second, fourth and so on is measured, and stands for those up to the next of these.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles.errors import AccuracyWarning, StabilityWarning

__all__ = [
    "END",
    "RIPPLE",
    "Changes",
    "Particles",
    "cells",
    "looked_at",
    "ripple",
    "warn_of_misfit",
    "warn_of_remeshing",
    "warn_of_ripple",
    "warn_of_round_off",
    "warn_of_smoothing",
    "warn_of_step",
    "warn_of_volumes",
]

END = 3.0
"""Smoothing lengths from the ends of the lattice, within which what is left out changes the field."""

RIPPLE = 0.02  # above, a warning is given: the error of a run is about once or twice this
_OTHER = 0.05  # of the integral of |u|: the error of a run is this
_SMOOTHED = 0.1  # above, a warning is given: the error of a run is about half of this, of its peak
_ROUNDED = 0.02  # epsilon: of the places, by all steps together
_MOST_LOOKS = 2048  # places at which the field is looked at before and after a remeshing
_WAVENUMBERS = np.linspace(0.0, 60.0, 1201)

Transform = Callable[[np.ndarray], np.ndarray]
Particles = tuple[np.ndarray, ...]
"""Coordinates and strengths of particles."""


class Changes:
    """What the remeshings of a run change of the field, over its peak, at some places.

    Parameters
    ----------
    field : callable
        From particles to the field at the places, shape (M,).
    """

    def __init__(self, field: Callable[[Particles], np.ndarray]) -> None:
        self._field, self._count = field, 0
        self._sum: Any = 0.0
        self._last: Any = 0.0

    def add(self, before: Particles, after: Particles) -> None:
        """Add those of a remeshing: measured if its number is a power of two, else those of the last that was."""
        self._count += 1
        if self._count & (self._count - 1) == 0:
            held, found = self._field(before), self._field(after)
            self._last = (found - held) / (float(np.abs(held).max(initial=0.0)) or 1.0)
        self._sum = self._sum + self._last

    @property
    def largest(self) -> float:
        """That of the place where they are largest."""
        return float(np.abs(self._sum).max(initial=0.0))


def looked_at(u: np.ndarray) -> np.ndarray:
    """Return the indices of the places to look at: all, or half as many as may be by |u|, and half equally spaced.

    Parameters
    ----------
    u : array, shape (N,)
        The field, in the order of the places.
    """
    if u.size <= _MOST_LOOKS:
        return np.arange(u.size)
    half = _MOST_LOOKS // 2
    strongest = np.argpartition(np.abs(u), -half)[-half:]
    return np.union1d(strongest, np.linspace(0, u.size - 1, half).astype(int))


def cells(x: np.ndarray) -> np.ndarray:
    """Return the length of line of each particle: half the way to either neighbour; at an end the whole way to one.

    Parameters
    ----------
    x : array, shape (N,)
        Positions in any order; N at least 2.
    """
    order = np.argsort(x, kind="stable")
    gap = np.diff(x[order])
    width = np.empty(x.size)
    width[order] = 0.5 * (np.append(gap[:1], gap) + np.append(gap, gap[-1:]))
    return width


def ripple(x: np.ndarray, strength: np.ndarray, epsilon: float, transform: Transform) -> float:
    """Return the mean relative ripple that the gaps between the particles leave on their field; 1 for a single one.

    Parameters
    ----------
    x, strength : array, shape (N,)
    epsilon : float
        Smoothing length.
    transform : callable
        K^(k) of the kernel of unit smoothing length.
    """
    if x.size < 2:
        return 1.0
    sizes = 2.0 * np.abs(transform(_WAVENUMBERS))
    envelope = np.minimum(np.maximum.accumulate(sizes[::-1])[::-1], 1.0)
    with np.errstate(divide="ignore", over="ignore"):
        k = 2.0 * np.pi * epsilon / cells(x)
    share = np.abs(strength) / np.abs(strength).max()
    return float(share @ np.interp(k, _WAVENUMBERS, envelope) / share.sum())


def warn_of_ripple(found: float, epsilon: float, remedy: str, stacklevel: int) -> None:
    """Warn if the ripple is more than `RIPPLE`.

    Warns
    -----
    AccuracyWarning
    """
    if found > RIPPLE:
        warnings.warn(
            f"the particles are too far apart for the smoothing length {epsilon:.4g}: their field is wrong by about "
            f"{min(found, 1.0):.2g} of itself. {remedy}",
            AccuracyWarning,
            stacklevel=stacklevel + 1,
        )


def warn_of_round_off(x: np.ndarray, steps: int, epsilon: float) -> None:
    """Warn if so many steps may round the places x away by a fiftieth of the smoothing length.

    Warns
    -----
    AccuracyWarning
    """
    rounded = 0.5 * (steps + 1) * float(np.spacing(np.abs(x).max()))
    if rounded > _ROUNDED * epsilon:
        warnings.warn(
            f"the places are so far from zero that {steps} steps may round them by {rounded:.2g}, beside the smoothing "
            f"length {epsilon:.4g}: smaller steps do not move them. Move the origin, or take fewer steps.",
            AccuracyWarning,
            stacklevel=3,
        )


def warn_of_volumes(x: np.ndarray, u: np.ndarray, spacing: float, stacklevel: int) -> None:
    """Warn if the volume h of each particle is not the length of line that it has, on the mean weighted by |u|.

    Particles in one place share its length.

    Warns
    -----
    AccuracyWarning
    """
    places, which = np.unique(x, return_inverse=True)
    size = np.bincount(which, np.abs(u) / (np.abs(u).max() or 1.0))
    if places.size < 2 or not size.any():
        return
    length = float(size @ cells(places) / size.sum())
    if abs(length - spacing) > _OTHER * length:
        warnings.warn(
            f"each particle is given the volume spacing = {spacing:.4g}, and the places are {length:.4g} apart where u "
            "is: the field is wrong in this ratio. Give the spacing of x, of particles that are equally far apart.",
            AccuracyWarning,
            stacklevel=stacklevel + 1,
        )


def warn_of_smoothing(held: np.ndarray, u: np.ndarray) -> None:
    """Warn if the field `held` at the start is not the data u, of the same shape, by a tenth of their peak.

    Warns
    -----
    AccuracyWarning
    """
    missed, peak = float(np.abs(held - u).max()), float(np.abs(u).max())
    if missed > _SMOOTHED * peak:
        warnings.warn(
            f"the field of the particles is not u at the start, by {missed / peak:.2g} of its peak: the kernels smooth "
            "it, or the particles are not a spacing apart. Take a smaller spacing, an overlap of 2, or order 4.",
            AccuracyWarning,
            stacklevel=3,
        )


def warn_of_remeshing(changed: float, limit: float, stacklevel: int) -> None:
    """Warn if the remeshings of a run have changed the field by more than a limit, both parts of its peak.

    Warns
    -----
    AccuracyWarning
    """
    if changed > limit:
        warnings.warn(
            f"the remeshings have changed the field by {changed:.2g} of its peak. Take remeshing='Lambda6,4', a larger "
            "overlap, or a smaller spacing.",
            AccuracyWarning,
            stacklevel=stacklevel + 1,
        )


def warn_of_step(dt: float, limit: float, stacklevel: int) -> None:
    """Warn if a step of the diffusion velocity method is above the limit of stability.

    Warns
    -----
    StabilityWarning
    """
    if dt > limit:
        warnings.warn(
            f"dt = {dt:.6g} lies outside the stability interval of DVM: at most {limit:.6g} is stable. Beyond, waves "
            "of the particles' places grow. The run is computed as it is. Take a smaller dt.",
            StabilityWarning,
            stacklevel=stacklevel + 1,
        )


def warn_of_misfit(found: float, most: float, stacklevel: int) -> None:
    """Warn if the far field may hold more than this share of the total wrongly.

    Warns
    -----
    AccuracyWarning
    """
    if found > most:
        warnings.warn(
            "the far field that continues u beyond the particles does not meet the field inside: "
            f"{min(found, 1.0):.2g} of the total may be wrong. Take a wider lattice, or data about the origin.",
            AccuracyWarning,
            stacklevel=stacklevel + 1,
        )
