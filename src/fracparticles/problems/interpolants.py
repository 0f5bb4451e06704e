"""The forms that initial data given as an array may have between the particles.

Data that are smooth on the scale of h are their cubic spline there. An array does not say where between two particles a
kink or a jump is. The cubic through four particles tells how smooth the data are: it misses the value in the middle by

    r_s = |u_i - (9 u_(i-s) + 9 u_(i+s) - u_(i-3s) - u_(i+3s)) / 16|.

From the stride s = 2 to s = 1 this falls to a sixteenth where u is smooth, and to 2^-p at a |x|^p: to a half at a kink,
and not at all at a jump. Beside an end 9/24 of the fourth difference takes its place, which needs four strides. Where
r_s falls to no less than a fourth, u has one of these forms instead:

    About the particle with the greater r of the two beside a place, even and odd part are each a power of the distance,

        u_i + e |y|^p + o sgn(y) |y|^q,    -1 <= y <= 1 spacings.

    They meet the particles at one and two spacings. This is exact for straight lines, a kink at a particle, or a root.

    Where two particles differ by more than twice the differences beside them, u between them is the lesser or the
    greater of the two values. This is exact for a jump just beside a particle.

Along an angle, data without waves shorter than four spacings are their trigonometric interpolation. Eight angles hold
cos 2 theta so, of which the cubic misses a third.

The error of a kink between two particles is between those of the spline and of the straight lines. The error of a jump
is between those for its two ends. With the lesser value everywhere, or the greater, the total is off by most.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import maximum_filter1d

__all__ = ["holds_no_short_waves", "interpolants", "is_rough", "power"]

_ROUGH = 0.25  # the miss of the cubic over that at twice the stride, above which u is rough
_JUMP = 2.0  # the difference of two particles over those beside it, above which u jumps
_LEAST = 1e-4  # share of the greatest |u|, or of its greatest wave, below which a miss or a wave does not count
_JUMPS = None, np.minimum, np.maximum  # the value between the ends of a jump, if not powers
_NEAR = {1: 5, 2: 9}  # particles among which the greatest miss is taken, by stride
# The weights of r_s, and of 9/24 of the fourth difference, by stride.
_CUBIC = np.array([1.0, 0.0, -9.0, 16.0, -9.0, 0.0, 1.0]) / 16.0
_FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) * 9.0 / 24.0
_EVEN, _ODD = 2.0, 1.0  # the powers p and q of a smooth u


def interpolants(u: np.ndarray, *at: np.ndarray) -> list[np.ndarray]:
    """Return the forms of u at other places: first its spline, and each of the others if u is rough.

    Parameters
    ----------
    u : array, shape (N,) or (N, M)
        Values at particles that are equally spaced in some variable along each axis.
    *at : arrays
        The places along each axis, in spacings behind the first particle; beyond the ends all forms are the spline.
    """
    spline, rough = u, [u, u, u]
    for axis, places in enumerate(at):
        spline = _splined(spline, places, axis)
        rough = [_in_parts(one, places, axis, of) for one, of in zip(rough, _JUMPS, strict=True)]
    if np.array_equal(spline, rough[0]):
        return [spline]
    # A jump anywhere in between has less error than one at either end.
    return [spline, rough[0]] if np.array_equal(rough[1], rough[2]) else [spline, *rough[1:]]


def holds_no_short_waves(u: np.ndarray, axis: int) -> bool:
    """Return whether u, along an angle, has only waves of four spacings and more."""
    waves = np.abs(np.fft.rfft(u, axis=axis))
    short = np.arange(waves.shape[axis]) > u.shape[axis] / 4
    return bool(waves.compress(short, axis).max(initial=0.0) <= _LEAST * waves.max())


def is_rough(u: np.ndarray) -> bool:
    """Return whether u has another form than its spline somewhere."""
    return power(u) is not None


def power(u: np.ndarray, axes: Iterable[int] | None = None) -> float | None:
    """Return the power p of |x|^p at the greatest miss of u, 0 at a jump; None if u is rough nowhere along the axes."""
    greatest, p = 0.0, None
    for axis in range(u.ndim) if axes is None else axes:
        fine, coarse, rough = _misses(np.moveaxis(u, axis, 0))
        at = np.where(rough, fine, 0.0).argmax()
        if rough.any() and fine.flat[at] > greatest:
            greatest = float(fine.flat[at])
            p = float(np.log2(np.clip(coarse.flat[at] / greatest, 1.0, 1.0 / _ROUGH)))
    return p


def _splined(u: np.ndarray, at: np.ndarray, axis: int) -> np.ndarray:
    return np.asarray(CubicSpline(np.arange(u.shape[axis]), u, axis)(at))


def _in_parts(u: np.ndarray, at: np.ndarray, axis: int, of_jump: np.ufunc | None) -> np.ndarray:
    """Return the spline, with powers where u is rough, and where it jumps one of the two values, if `of_jump` says."""
    values = np.moveaxis(u, axis, 0)
    cell = np.clip(np.floor(at).astype(int), 0, values.shape[0] - 2)
    part = (at - cell).reshape((-1,) + (1,) * (u.ndim - 1))
    inside = (part > 0.0) & (part < 1.0)
    rough = _in_powers(values, cell, part)
    if of_jump is not None:
        either = of_jump(values[cell], values[cell + 1])
        rough = np.where(_jumps(values)[cell] & inside, either, rough)
    chosen = _are_rough(values)[cell] & inside
    return np.moveaxis(np.where(chosen, rough, _splined(values, at, 0)), 0, axis)


def _in_powers(values: np.ndarray, cell: np.ndarray, part: np.ndarray) -> np.ndarray:
    """Return the powers about one of the two particles beside each place: the one that the cubic misses by more."""
    missed = _missed(values, 1)
    left, right = (_powers(values, cell + side, part - side) for side in (0, 1))
    return np.where(missed[cell + 1] > missed[cell], right, left)


def _powers(values: np.ndarray, i: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return u_i + e |y|^p + o sgn(y) |y|^q; beyond an end, u is continued by point symmetry."""
    n, others = values.shape[0], [(0, 0)] * (values.ndim - 1)
    u = np.pad(values, [(2, 2), *others], "reflect", reflect_type="odd")
    after, before = ([u[2 + side * s : n + 2 + side * s] for s in (1, 2)] for side in (1, -1))
    even = [0.5 * (a + b) - values for a, b in zip(after, before, strict=True)]
    odd = [0.5 * (a - b) for a, b in zip(after, before, strict=True)]
    p, q = _power(even[0], even[1], _EVEN), _power(odd[0], odd[1], _ODD)
    distance = np.abs(y)
    return np.asarray(
        values[i] + even[0][i] * distance ** p[i] + odd[0][i] * np.sign(y) * distance ** q[i]
    )


def _power(near: np.ndarray, far: np.ndarray, most: float) -> np.ndarray:
    """Return the power of a part that is `near` at one spacing and `far` at two: 0 at a jump, `most` if smooth."""
    ratio = np.divide(far, near, out=np.ones_like(near), where=near != 0.0)
    return np.asarray(np.log2(np.clip(ratio, 1.0, 2.0**most)))


def _are_rough(values: np.ndarray) -> np.ndarray:
    """Return whether u is rough between each two particles along the first axis."""
    *_, rough = _misses(values)
    return np.asarray(rough[:-1] | rough[1:])


def _misses(values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the greatest r_1 and r_2 near each particle along the first axis, and whether u is rough there."""
    fine, coarse = (
        maximum_filter1d(_missed(values, stride), near, axis=0) for stride, near in _NEAR.items()
    )
    return fine, coarse, (fine > _ROUGH * coarse) & (fine > _LEAST * np.abs(values).max())


def _missed(values: np.ndarray, stride: int) -> np.ndarray:
    """Return r_s at each particle; beside an end, 9/24 of the fourth difference."""
    missed = _differences(values, stride, _FOURTH)
    inner = slice(3 * stride, max(3 * stride, values.shape[0] - 3 * stride))
    missed[inner] = _differences(values, stride, _CUBIC)[inner]
    return missed


def _differences(values: np.ndarray, stride: int, weights: np.ndarray) -> np.ndarray:
    """Return |sum_k w_k u_(i + k s)| at each particle; beside an end, that of the outermost that has all terms."""
    far = stride * (weights.size // 2)
    count = values.shape[0] - 2 * far
    if count < 1:
        return np.zeros(values.shape)
    sums = sum(w * values[k * stride : k * stride + count] for k, w in enumerate(weights))
    return np.pad(np.abs(sums), [(far, far)] + [(0, 0)] * (values.ndim - 1), "edge")


def _jumps(values: np.ndarray) -> np.ndarray:
    """Return whether two particles differ by more than twice the differences beside them, along the first axis."""
    steps = np.abs(np.diff(values, axis=0))
    longer = np.pad(steps, [(1, 1)] + [(0, 0)] * (values.ndim - 1))
    return np.asarray(steps > _JUMP * np.maximum(longer[:-2], longer[2:]))
