"""Interpolation of measured data: values between points of any spacing, and their error.

The data are interpolated by a cubic spline, or by the monotone cubic of Fritsch and Carlson, which does not overshoot:
whichever is nearer to points that it was not given. To estimate the error of the interpolation, every second point is
left out, and then all but every fourth. With the relative 1-norms e_2 and e_4 of the two misses, the error with all
points is

    e = e_2 / r,   r = e_4 / e_2,  1 <= r <= 16.

Noise has r = 1, and r = 1 is taken for fewer than sixteen points along an axis. With fewer than 32 points, the few that
are left out may be met by chance: e is then at least the distance of the two cubics. With fewer than eight the error is
unknown, and e is at least 1. Beyond the outermost points the data are zero. If they fall like |x|^(-1-alpha) or faster,
the part beyond is at most the sum of |u| d at the ends, with the distance d to the middle of the data. This bound is
stated as well.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from fracparticles.arguments import places
from fracparticles.errors import AccuracyWarning, InvalidInput

__all__ = ["Measured"]

_TOO_FEW, _SOME, _MANY = 8, 16, 32  # points along an axis, see the module
_NOTICED = 0.05  # the relative error, or the missing share of the mass, from which data are doubted
_MOST_GAIN = 16.0  # the greatest r: the order of both cubics is four at most
_FIELD = "initial"  # the argument that messages name

Interpolant = Callable[[Sequence[np.ndarray], np.ndarray, list[np.ndarray]], np.ndarray]


@dataclass(frozen=True)
class Measured:
    """Data at the points of a line, a rectangular grid of the plane or of space; a function of x (y, z).

    Attributes
    ----------
    axes : tuple of arrays
        The points along each axis, ascending.
    values : array
        A value for each point of the grid.
    units : tuple of str
        The units of the axes and of the values, as far as the data name them; "" where they do not.
    source : str
        Where the data come from.
    is_file : bool
        Whether `source` is the path of a file.
    """

    axes: tuple[np.ndarray, ...]
    values: np.ndarray
    units: tuple[str, str]
    source: str
    is_file: bool = False

    def __call__(self, *x: Any) -> np.ndarray:
        """Return the interpolated values at points whose coordinates broadcast; zero beyond the data.

        Raises
        ------
        InvalidInput
            If there are more or fewer coordinates than the data have, or one is not finite.
        """
        if len(x) != len(self.axes):
            dims = f"data on {len(x)} axes for dim = {len(x)}, and these are on {len(self.axes)}"
            raise InvalidInput(_FIELD, self.source, dims, "Give dim to match.")
        points = [places(name, one) for name, one in zip("xyz", x, strict=False)]
        inside = np.ones(np.broadcast_shapes(*(one.shape for one in points)), dtype=bool)
        for one, axis in zip(points, self.axes, strict=True):
            inside &= (one >= axis[0]) & (one <= axis[-1])
        result = _INTERPOLANTS[self.method](self.axes, self.values, points)
        return np.where(inside, result, 0.0)

    @cached_property
    def method(self) -> str:
        """The interpolation that is used: "cubic spline" or "monotone cubic"."""
        return min(_INTERPOLANTS, key=lambda name: self._errors[name])

    @cached_property
    def interpolation_error(self) -> float:
        """The relative error in the 1-norm between the points; see the module."""
        few, found = min(axis.size for axis in self.axes), self._errors[self.method]
        if few < _TOO_FEW:
            return max(found, float(np.any(self.values)))
        return max(found, self._apart) if few < _MANY else found

    @cached_property
    def beyond(self) -> float:
        """The part of the data beyond the outermost points at most, as a share of the part between them."""
        size = np.abs(self.values)
        total, outside = _integral(self.axes, size), 0.0
        for k, axis in enumerate(self.axes):
            others = [one for m, one in enumerate(self.axes) if m != k]
            along = _integral(others, np.moveaxis(size, k, -1)) if others else size
            middle = float((axis * along).sum() / along.sum()) if along.sum() > 0.0 else 0.0
            outside += float(along[0]) * (middle - axis[0]) + float(along[-1]) * (axis[-1] - middle)
        return outside / float(total) if total > 0.0 else 0.0

    @property
    def error(self) -> float:
        """The interpolation error together with the part that may lie beyond."""
        return self.interpolation_error + self.beyond

    @cached_property
    def integral(self) -> float:
        """The integral of the interpolated data, by the trapezoidal rule on a grid eight times as fine."""
        fine = _finer(self.axes)
        return float(_integral(fine, self(*np.meshgrid(*fine, indexing="ij", sparse=True))))

    @property
    def estimates(self) -> dict[str, tuple[float, str]]:
        """The estimates that a run states for its data: by name, each with its meaning in words."""
        between = f"relative error of the initial data between their points, by a {self.method}"
        return {
            "interpolation_error": (self.interpolation_error, between),
            "beyond_data": (self.beyond, "share of the initial data that may lie beyond them"),
        }

    def check_lattice(self, strengths: np.ndarray, volume: float | np.ndarray) -> None:
        """Refuse a lattice that does not hold the data, or is too coarse for them; warn if the data are too coarse.

        Parameters
        ----------
        strengths : array
            The data at the particles.
        volume : float or array
            The volume of each particle.

        Raises
        ------
        InvalidInput
            If the mass on the lattice is off by more than a twentieth of the mass of the data.

        Warns
        -----
        AccuracyWarning
            If the data are too few, or end before they have fallen.
        """
        size = float(_integral(self.axes, np.abs(self.values)))
        apart = abs(float((volume * strengths).sum()) - self.integral)
        if apart > _NOTICED * size:
            allowed = f"data that the lattice holds and resolves: of their mass {apart / size:.2g} is missing there"
            raise InvalidInput(
                _FIELD, self.source, allowed, "Take a wider lattice or a smaller spacing."
            )
        for error, meaning in self.estimates.values():
            if error > _NOTICED:
                warnings.warn(
                    f"{self.source}: {meaning}: about {error:.2g}. Measure at more points, or farther out.",
                    AccuracyWarning,
                    stacklevel=5,
                )

    @cached_property
    def _errors(self) -> dict[str, float]:
        found = {}
        for name, interpolant in _INTERPOLANTS.items():
            found[name] = _left_out(interpolant, self.axes, self.values)
        return found

    @property
    def _apart(self) -> float:
        """The distance of the two cubics in the relative 1-norm."""
        fine = _finer(self.axes)
        one, other = (
            of(self.axes, self.values, list(np.meshgrid(*fine, indexing="ij", sparse=True)))
            for of in _INTERPOLANTS.values()
        )
        size = float(_integral(fine, np.abs(one)))
        return float(_integral(fine, np.abs(one - other))) / size if size > 0.0 else 0.0


# --- interpolation ---------------------------------------------------------------------------------------


def _spline(axes: Sequence[np.ndarray], values: np.ndarray, x: list[np.ndarray]) -> np.ndarray:
    from scipy.interpolate import CubicSpline

    return _by_axes(CubicSpline, axes, values, x)


def _monotone(axes: Sequence[np.ndarray], values: np.ndarray, x: list[np.ndarray]) -> np.ndarray:
    from scipy.interpolate import PchipInterpolator

    # Where data have underflowed, 1 / slope is infinite, and the slope becomes zero.
    with np.errstate(over="ignore"):
        return _by_axes(PchipInterpolator, axes, values, x)


_INTERPOLANTS: dict[str, Interpolant] = {"monotone cubic": _monotone, "cubic spline": _spline}


def _by_axes(
    kind: Any, axes: Sequence[np.ndarray], values: np.ndarray, x: list[np.ndarray]
) -> np.ndarray:
    """Interpolate along one axis after the other if the points are a grid, else point by point."""
    if len(axes) == 1:
        return np.asarray(kind(axes[0], values)(np.clip(x[0], axes[0][0], axes[0][-1])))
    clipped = [np.clip(one, axis[0], axis[-1]) for one, axis in zip(x, axes, strict=True)]
    if all(one.ndim == len(axes) and one.size == one.shape[k] for k, one in enumerate(clipped)):
        for k, one in enumerate(clipped):
            values = kind(axes[k], values, axis=k)(one.ravel())
        return np.asarray(values)
    flat = [one.ravel() for one in np.broadcast_arrays(*clipped)]
    shape = np.broadcast_shapes(*(one.shape for one in clipped))
    found = [
        _by_axes(kind, axes, values, [np.reshape(one[p], (1,) * len(axes)) for one in flat]).item()
        for p in range(flat[0].size)
    ]
    return np.array(found).reshape(shape)


def _left_out(interpolant: Interpolant, axes: Sequence[np.ndarray], values: np.ndarray) -> float:
    """Return the error e from the points left out, see the module. The ends are always kept."""
    missed = []
    for stride in (2, 4):
        kept = [np.unique([*range(0, axis.size, stride), axis.size - 1]) for axis in axes]
        if any(one.size < 2 for one in kept):
            break
        coarse = [axis[one] for axis, one in zip(axes, kept, strict=True)]
        points = (
            list(np.meshgrid(*axes, indexing="ij", sparse=True)) if len(axes) > 1 else [axes[0]]
        )
        guess = interpolant(coarse, values[np.ix_(*kept)], points)
        missed.append(float(_integral(axes, np.abs(guess - values))))
    size = float(_integral(axes, np.abs(values)))
    if not missed or size == 0.0:
        return 0.0 if size == 0.0 else 1.0
    # At the half of the points that is kept nothing is missed: the other half stands for all.
    error = 2.0 * missed[0] / size
    enough = len(missed) == 2 and min(axis.size for axis in axes) >= _SOME
    gain = missed[1] / missed[0] if enough and missed[0] > 0.0 else 1.0
    return error / min(max(gain, 1.0), _MOST_GAIN)


def _finer(axes: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return eight times as many points along each axis."""
    return [
        np.interp(np.arange(8 * axis.size - 7) / 8.0, np.arange(axis.size), axis) for axis in axes
    ]


def _integral(axes: Sequence[np.ndarray], values: np.ndarray) -> Any:
    """Return the integral over the first axes by the trapezoidal rule."""
    for axis in axes:
        values = np.trapezoid(values, axis, axis=0)
    return values
