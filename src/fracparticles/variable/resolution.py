r"""Warnings if a coefficient is not constant near the ends, or if the particles do not resolve it.

The value of a smooth coefficient at a particle is nearly that of the cubic through the particles s and 3 s places away.
s is the overlap, the width of the kernels, and s = 1, which shows waves of the lattice:

    e_i = |D_i - (9 (D_(i-s) + D_(i+s)) - D_(i-3s) - D_(i+3s)) / 16| / max_(|j-i| <= 3s) D_j.

At e = 0.1 a step of D leaves an error of 1 to 3 % of the peak of u, and more at a larger e
(tests/variable/test_resolved_coefficients.py). The exchange takes the mean of a pair and no slope: with steps, bumps
and dips it erred by at most 1.2 % up to e = 0.4. A single jump has at most e = 1/2; waves may have more. Where D is
below 1e-4 of its maximum, e is taken relative to 1e-4 of it.
"""

from __future__ import annotations

import warnings

import numpy as np
from scipy.ndimage import maximum_filter1d

from fracparticles.errors import AccuracyWarning
from fracparticles.schemes.setting import Setting

__all__ = ["UNRESOLVED", "UNRESOLVED_BY_PAIRS", "unresolved", "warn_unresolved", "warn_unsettled"]

_OUTER = 0.75  # share of the half-width beyond which a coefficient should be nearly constant
_UNSETTLED = 0.1  # share of its greatest value, by which it may vary there
UNRESOLVED, UNRESOLVED_BY_PAIRS = 0.1, 0.4  # e above which is warned; the second for the exchange
_NEGLIGIBLE = 1e-4  # share of the greatest D: e is not relative to less


def unresolved(values: np.ndarray, overlap: float) -> float:
    """Return the greatest e over the particles and the axes; 0 along axes of fewer than 6 s + 1 particles."""
    lines = [np.moveaxis(values, axis, -1) for axis in range(values.ndim)]
    return max(_missed(d, s) for d in lines for s in {1, max(1, round(overlap))})


def _missed(d: np.ndarray, s: int) -> float:
    """The greatest e along the last axis."""
    count = d.shape[-1] - 6 * s
    if count < 1:
        return 0.0
    far, near, middle, after, beyond = (d[..., k * s : k * s + count] for k in (0, 2, 3, 4, 6))
    guess = (9.0 * (near + after) - (far + beyond)) / 16.0
    around = maximum_filter1d(d, 6 * s + 1, axis=-1)[..., 3 * s : 3 * s + count]
    scale = np.maximum(around, _NEGLIGIBLE * float(d.max()))
    return float((np.abs(middle - guess) / np.where(scale > 0.0, scale, 1.0)).max())


def warn_unresolved(
    field: str, values: np.ndarray, setting: Setting, most: float = UNRESOLVED
) -> bool:
    """Warn of a coefficient whose e is above `most`: it varies too fast for the particles. Return whether it warned."""
    share = unresolved(values, setting.overlap)
    if share <= most:
        return False
    message = (
        f"{field} varies faster than particles of spacing {setting.spacing:.3g} and smoothing length "
        f"{setting.overlap * setting.spacing:.3g} resolve, by {share:.2g} of itself: take a smaller spacing, or smooth "
        "its jumps."
    )
    warnings.warn(message, AccuracyWarning, stacklevel=4)
    return True


def warn_unsettled(field: str, values: np.ndarray, n: int) -> bool:
    """Warn of a coefficient on the lattice that still varies near the ends, where the tail takes it for constant.

    Return whether it warned.
    """
    outer = round(_OUTER * n)
    middle = values.shape[0] // 2
    for axis in range(values.ndim):
        along = np.moveaxis(values, axis, 0)
        for part in (along[: middle - outer + 1], along[middle + outer :]):
            varied = float(np.ptp(part, axis=0).max())
            if varied > _UNSETTLED * float(np.abs(values).max()):
                message = (
                    f"{field} varies by {varied:.2g} in the outer quarter of the lattice, and the tail of the "
                    "solution is continued as if it were constant there: widen the domain."
                )
                warnings.warn(message, AccuracyWarning, stacklevel=4)
                return True
    return False
