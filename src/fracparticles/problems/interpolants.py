"""What initial data that are an array may be between the particles.

Data that are smooth on the scale of h are their cubic spline there. An array of a kink does not say where the kink is,
nor does one of a jump. How smooth the data are is told by the cubic through four: what it misses of the value in their
middle,

    r_s = |u_i - (9 u_(i-s) + 9 u_(i+s) - u_(i-3s) - u_(i+3s)) / 16|,

falls with the stride s, from two to one, to a sixteenth where u is smooth, to a half at a kink and not at all at a
jump. Where it falls to no less than a fourth, u is one of these instead:

    straight lines, right of a kink at a particle; or, where two particles differ by more than twice what those beside
    them do, the lesser or the greater of the two between them, right of a jump just beside a particle.

A kink between two particles has an error in between those of the spline and of the straight line, and a jump in between
those of its two ends; with the lesser everywhere, or the greater, the total is off by most. A root, whose slope is
infinite, may have three times as much.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import maximum_filter1d

__all__ = ["interpolants", "is_rough"]

_ROUGH = 0.25  # of what the cubic misses at twice the stride
_JUMP = 2.0  # of the differences beside it
_LEAST = 1e-4  # of the greatest |u|, a miss that is no matter
_JUMPS = None, np.minimum, np.maximum
_NEAR = {1: 5, 2: 9}  # particles among which the greatest miss is taken, by stride


def interpolants(u: np.ndarray, *at: np.ndarray) -> list[np.ndarray]:
    """Return what u may be at other places: its spline first, and where it is rough each of the others.

    Parameters
    ----------
    u : array, shape (N,) or (N, M)
        Values at particles that are equally spaced in some variable along each axis.
    *at : arrays
        The places along each axis, in spacings behind the first particle; what lies outside has the spline alone.
    """
    spline, rough = u, [u, u, u]
    for axis, places in enumerate(at):
        spline = _splined(spline, places, axis)
        rough = [_in_parts(one, places, axis, of) for one, of in zip(rough, _JUMPS, strict=True)]
    if np.array_equal(spline, rough[0]):
        return [spline]
    # What lies anywhere between the ends of a jump has less error than one of them.
    return [spline, rough[0]] if np.array_equal(rough[1], rough[2]) else [spline, *rough[1:]]


def is_rough(u: np.ndarray) -> bool:
    """Return whether there are places where the spline is not all that u may be."""
    return any(bool(_are_rough(np.moveaxis(u, axis, 0)).any()) for axis in range(u.ndim))


def _splined(u: np.ndarray, at: np.ndarray, axis: int) -> np.ndarray:
    return np.asarray(CubicSpline(np.arange(u.shape[axis]), u, axis)(at))


def _in_parts(u: np.ndarray, at: np.ndarray, axis: int, of_jump: np.ufunc | None) -> np.ndarray:
    """The spline, where u is rough a straight line, and where it jumps one of the two values, if that is asked for."""
    values = np.moveaxis(u, axis, 0)
    cell = np.clip(np.floor(at).astype(int), 0, values.shape[0] - 2)
    along = (-1,) + (1,) * (u.ndim - 1)
    part, left, right = (at - cell).reshape(along), values[cell], values[cell + 1]
    line = (1.0 - part) * left + part * right
    if of_jump is not None:
        line = np.where(
            _jumps(values)[cell] & (part > 0.0) & (part < 1.0), of_jump(left, right), line
        )
    chosen = _are_rough(values)[cell] & (part >= 0.0) & (part <= 1.0)
    return np.moveaxis(np.where(chosen, line, _splined(values, at, 0)), 0, axis)


def _are_rough(values: np.ndarray) -> np.ndarray:
    """Whether u is rough between each two particles along the first axis."""
    fine, coarse = (
        maximum_filter1d(_missed(values, stride), near, axis=0) for stride, near in _NEAR.items()
    )
    rough = (fine > _ROUGH * coarse) & (fine > _LEAST * np.abs(values).max())
    return np.asarray(rough[:-1] | rough[1:])


def _missed(values: np.ndarray, stride: int) -> np.ndarray:
    """r_s at each particle; beside an end that of the outermost which has all four others."""
    far, count = 3 * stride, values.shape[0] - 6 * stride
    if count < 1:
        return np.zeros(values.shape)

    def pair(k: int) -> np.ndarray:
        return np.asarray(values[far + k : far + k + count] + values[far - k : far - k + count])

    missed = np.abs(values[far:-far] - (9.0 * pair(stride) - pair(far)) / 16.0)
    return np.pad(missed, [(far, far)] + [(0, 0)] * (values.ndim - 1), "edge")


def _jumps(values: np.ndarray) -> np.ndarray:
    """Whether two particles differ by more than twice what those beside them do, along the first axis."""
    steps = np.abs(np.diff(values, axis=0))
    longer = np.pad(steps, [(1, 1)] + [(0, 0)] * (values.ndim - 1))
    return np.asarray(steps > _JUMP * np.maximum(longer[:-2], longer[2:]))
