"""What initial data that are an array may be between the particles.

Data that are smooth on the scale of h are their cubic spline there. An array of a kink does not say where the kink is,
nor does one of a jump. How smooth the data are is told by the cubic through four: what it misses of the value in their
middle,

    r_s = |u_i - (9 u_(i-s) + 9 u_(i+s) - u_(i-3s) - u_(i+3s)) / 16|,

falls with the stride s, from two to one, to a sixteenth where u is smooth, to 2^-p at a |x|^p: to a half at a kink and
not at all at a jump. Beside an end 9/24 of the fourth difference has its place, which asks for four strides. Where it
falls to no less than a fourth, u is one of these instead:

    about the particle with the greater r of the two beside it, even and odd part each a power of the distance y,

        u_i + e |y|^p + o sgn(y) |y|^q,    -1 <= y <= 1 spacings,

    as the particles one and two from it say: straight lines, right of a kink at a particle, or a root;
    or, where two particles differ by more than twice what those beside them do, the lesser or the greater of the two
    between them, right of a jump just beside a particle.

A kink between two particles has an error in between those of the spline and of the straight line, and a jump in between
those of its two ends; with the lesser everywhere, or the greater, the total is off by most.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import maximum_filter1d

__all__ = ["interpolants", "is_rough", "power"]

_ROUGH = 0.25  # of what the cubic misses at twice the stride
_JUMP = 2.0  # of the differences beside it
_LEAST = 1e-4  # of the greatest |u|, a miss that is no matter
_JUMPS = None, np.minimum, np.maximum
_NEAR = {1: 5, 2: 9}  # particles among which the greatest miss is taken, by stride
_CUBIC = np.array([1.0, 0.0, -9.0, 16.0, -9.0, 0.0, 1.0]) / 16.0
_FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) * 9.0 / 24.0
_EVEN, _ODD = 2.0, 1.0  # the powers of what is smooth


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
    return power(u) is not None


def power(u: np.ndarray) -> float | None:
    """Return p where u is |x|^p by its greatest miss, 0 at a jump; None where it is rough nowhere."""
    greatest, p = 0.0, None
    for axis in range(u.ndim):
        fine, coarse, rough = _misses(np.moveaxis(u, axis, 0))
        at = np.where(rough, fine, 0.0).argmax()
        if rough.any() and fine.flat[at] > greatest:
            greatest = float(fine.flat[at])
            p = float(np.log2(np.clip(coarse.flat[at] / greatest, 1.0, 1.0 / _ROUGH)))
    return p


def _splined(u: np.ndarray, at: np.ndarray, axis: int) -> np.ndarray:
    return np.asarray(CubicSpline(np.arange(u.shape[axis]), u, axis)(at))


def _in_parts(u: np.ndarray, at: np.ndarray, axis: int, of_jump: np.ufunc | None) -> np.ndarray:
    """The spline, where u is rough powers, and where it jumps one of the two values, if that is asked for."""
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
    """The powers about the one of the two particles beside each place which the cubic misses by more."""
    missed = _missed(values, 1)
    left, right = (_powers(values, cell + side, part - side) for side in (0, 1))
    return np.where(missed[cell + 1] > missed[cell], right, left)


def _powers(values: np.ndarray, i: np.ndarray, y: np.ndarray) -> np.ndarray:
    """u_i + e |y|^p + o sgn(y) |y|^q; u goes on beyond an end as in a point of symmetry."""
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
    """That of what is `near` at one spacing and `far` at two: none at a jump, at most that of what is smooth."""
    ratio = np.divide(far, near, out=np.ones_like(near), where=near != 0.0)
    return np.asarray(np.log2(np.clip(ratio, 1.0, 2.0**most)))


def _are_rough(values: np.ndarray) -> np.ndarray:
    """Whether u is rough between each two particles along the first axis."""
    *_, rough = _misses(values)
    return np.asarray(rough[:-1] | rough[1:])


def _misses(values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The greatest r_1 and r_2 near each particle along the first axis, and whether u is rough there."""
    fine, coarse = (
        maximum_filter1d(_missed(values, stride), near, axis=0) for stride, near in _NEAR.items()
    )
    return fine, coarse, (fine > _ROUGH * coarse) & (fine > _LEAST * np.abs(values).max())


def _missed(values: np.ndarray, stride: int) -> np.ndarray:
    """r_s at each particle; beside an end that of the outermost which has both others on either side."""
    missed = _differences(values, stride, _FOURTH)
    inner = slice(3 * stride, max(3 * stride, values.shape[0] - 3 * stride))
    missed[inner] = _differences(values, stride, _CUBIC)[inner]
    return missed


def _differences(values: np.ndarray, stride: int, weights: np.ndarray) -> np.ndarray:
    """|sum_k w_k u_(i + k s)| at each particle, beside an end that of the outermost which has them all."""
    far = stride * (weights.size // 2)
    count = values.shape[0] - 2 * far
    if count < 1:
        return np.zeros(values.shape)
    sums = sum(w * values[k * stride : k * stride + count] for k, w in enumerate(weights))
    return np.pad(np.abs(sums), [(far, far)] + [(0, 0)] * (values.ndim - 1), "edge")


def _jumps(values: np.ndarray) -> np.ndarray:
    """Whether two particles differ by more than twice what those beside them do, along the first axis."""
    steps = np.abs(np.diff(values, axis=0))
    longer = np.pad(steps, [(1, 1)] + [(0, 0)] * (values.ndim - 1))
    return np.asarray(steps > _JUMP * np.maximum(longer[:-2], longer[2:]))
