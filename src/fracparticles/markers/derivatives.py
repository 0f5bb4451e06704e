r"""What the gaps between the markers leave on the flux of an equation that has even derivatives of F, as KdV.

Markers a distance d apart make of a uniform F one that ripples, and of its m-th derivative

    F k^m 2 S^(eps k) cos(k x),    k = 2 pi / d,

S^ the Fourier transform of the shape function. The markers lie at x = 0, d, ..: for an odd m they do not see it, for an
even one they see its peak, each with the same sign. F itself may be smooth to four digits and F_xx wrong altogether.
"""

from __future__ import annotations

import warnings
from functools import lru_cache

import numpy as np

from fracparticles.errors import AccuracyWarning, FracparticlesError
from fracparticles.markers.reliability import CORE, Velocity
from fracparticles.markers.shapes import Shape
from fracparticles.moving.reliability import cells

__all__ = ["flux_ripple", "warn_of_derivatives"]

# eps k; beyond, S2 and what is smoother leave little: 0 is said.
_WAVENUMBERS = np.linspace(0.0, 400.0, 8001)
_MOST = 0.1  # of the flux


def flux_ripple(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> float:
    """Return by how much the ripples of the even derivatives change the flux, in the mean over its greatest value.

    Zero if there are none, or the flux is zero; the mean over the markers away from the ends, by their weights.
    """
    fields = velocity.fields(x, weights)
    even = range(2, len(fields), 2)
    felt = min(velocity.shape.reach, CORE) * velocity.epsilon
    inner = (x > x.min() + felt) & (x < x.max() - felt)
    if x.size < 2 or not even or not inner.any():
        return 0.0
    k = 2.0 * np.pi / cells(x)
    amplitude = np.interp(velocity.epsilon * k, _WAVENUMBERS, _envelope(velocity.shape), right=0.0)
    with np.errstate(all="ignore"):
        flux, rippled = velocity.flux(x, fields), fields.copy()
        for m in even:
            rippled[m] -= (-1.0) ** (m // 2 + 1) * fields[0] * k**m * amplitude
        off = np.abs(velocity.flux(x, rippled) - flux)[inner]
    size, share = float(np.abs(flux[inner]).max()), np.abs(weights[inner])
    found = float(share @ off / (share.sum() * size)) if size > 0.0 else 0.0
    return found if np.isfinite(found) else 0.0


@lru_cache(maxsize=16)
def _envelope(shape: Shape) -> np.ndarray:
    sizes = 2.0 * np.abs(shape.transform(_WAVENUMBERS))
    envelope = np.maximum.accumulate(sizes[::-1])[::-1]
    envelope.flags.writeable = False
    return envelope


def warn_of_derivatives(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> None:
    """Warn if the derivatives of F are those of the gaps between the markers.

    Warns
    -----
    AccuracyWarning
    """
    try:
        found = flux_ripple(velocity, x, weights)
    except FracparticlesError:
        return  # the run will say so, with the step
    if found > _MOST:
        warnings.warn(
            f"the gaps between the markers leave {found:.2g} of the flux on the derivatives of F, although F is "
            "smooth. Take a smoother shape function, S8, a larger epsilon, or more markers.",
            AccuracyWarning,
            stacklevel=3,
        )
