"""The stability limit a of Eqs. (54)-(56), D dt / h^alpha <= a, from the Fourier symbol of a scheme."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from itertools import combinations_with_replacement

import numpy as np

from fracparticles.arguments import real_between
from fracparticles.errors import InvalidInput
from fracparticles.schemes.discovery import scheme
from fracparticles.schemes.setting import Setting

__all__ = ["grows", "range_in", "stability_limit", "symbol_range", "worst_wave"]

Symbol = Callable[[np.ndarray], np.ndarray]  # of points, the last axis their coordinates

# By dimension: samples in each coordinate, then samples between the neighbours of an extreme, and how often these are
# refined. In one dimension each refinement is 16 times as close, and 256 times as exact.
_SAMPLES = {1: 513, 2: 65, 3: 21}
_LOOK = {1: 33, 2: 9, 3: 5}
_REFINEMENTS = {1: 4, 2: 8, 3: 16}
_SAMPLES_OF_A_LINE = 129  # along a line of symmetry in a box
# Between two samples the symbol may rise above the greatest sample, where the two factors of FPSE change sign close to
# one another. So on a line up to six extremes are refined: those within 2 % of the range from the greatest sample.
_NEARLY, _MOST_PEAKS = 0.02, 6
_ROUND_OFF = 1e-13  # of a symbol, relative to its range
_SLACK = 1e-9  # relative excess allowed of the overlap, which may be a quotient
_WAVES = np.linspace(0.0, np.pi, 4001)  # theta among which `worst_wave` chooses


def stability_limit(
    scheme: str,
    beta: float,
    order: int = 2,
    overlap: float = 2.0,
    dim: int = 1,
    family: str | None = None,
) -> float:
    """Return a = 2 D / (|lambda_min| h^alpha), Eq. (55), on the infinite lattice.

    Explicit Euler and the midpoint rule are stable for D dt / h^alpha <= a (Eq. 56). If the overlap is too small for
    the order of the kernels, the symbol is positive somewhere. Then no step is stable, and a is 0. For GPSE the limit
    holds for repeated steps; a single step over the whole run cannot blow up.

    Parameters
    ----------
    scheme : str
        Name of a scheme.
    beta : float
        0 < beta < 1.
    order : {2, 4, 6, 8, 10, 12}
        Order of the kernels.
    overlap : float
        epsilon / h.
    dim : {1, 2, 3}
        Space dimension.
    family : {"printed", "gamma"}, optional
        Family of the kernels, where there is a choice, see `kernels.kernel`.

    Raises
    ------
    InvalidInput
        If an argument is not allowed.
    """
    low, high = symbol_range(scheme, beta, order, overlap, dim, family)
    return 0.0 if grows(low, high) else -2.0 / low


def grows(low: float, high: float) -> bool:
    """Return whether a symbol with values from `low` to `high` amplifies some wave, because it is positive there."""
    return high > _ROUND_OFF * max(-low, high)


def symbol_range(
    name: str,
    beta: float,
    order: int = 2,
    overlap: float = 2.0,
    dim: int = 1,
    family: str | None = None,
) -> tuple[float, float]:
    """Return the least and the largest value of A(theta) h^alpha / D over all waves.

    Parameters and errors as for `stability_limit`.
    """
    one = scheme(name)
    allowed, remedy = "a number between 0 and 1 (exclusive)", "Give such a value."
    beta = real_between("beta", beta, 0.0, 1.0, inside=True, allowed=allowed, remedy=remedy)
    if not 1.0 < 1.0 + beta < 2.0:
        raise InvalidInput("beta", beta, "a number with 1 < 1 + beta < 2 in float64", remedy)
    low, high = 0.25 * (1.0 - _SLACK), 1000.0 * (1.0 + _SLACK)
    allowed = "a number from 0.25 to 1000"
    overlap = real_between("overlap", overlap, low, high, allowed=allowed, remedy=remedy)
    one.check(dim, order, family)
    alpha, order, dim = 1.0 + float(beta), int(order), int(dim)
    kernels = Setting(alpha=alpha, order=order, overlap=float(overlap), dim=dim, family=family)
    return _symbol_range(name, kernels)


def worst_wave(name: str, setting: Setting) -> float:
    """Return theta = k h of the wave on the line that a scheme damps the most, among 4001 evenly spaced ones."""
    return float(_WAVES[np.argmin(scheme(name).symbol(_WAVES, setting))])


def range_in(name: str, setting: Setting) -> tuple[float, float]:
    """Return the `symbol_range` of a scheme in a setting, on the line with the kernel table of the setting.

    The lattice of the setting does not matter.
    """
    table = setting.kernel_table if setting.dim == 1 else None
    kernels = Setting(
        alpha=setting.alpha, overlap=setting.overlap, kernel_table=table, **setting.kernels
    )
    return _symbol_range(name, kernels)


@lru_cache(maxsize=256)
def _symbol_range(name: str, setting: Setting) -> tuple[float, float]:
    one = scheme(name)

    def symbol(points: np.ndarray) -> np.ndarray:
        return one.symbol(points[..., 0] if setting.dim == 1 else points, setting)

    found = [
        extreme
        for f, dim in _searches(symbol, setting.dim)
        for extreme in _extremes(f, dim, setting)
    ]
    low, high = min(found), max(found)
    # An exchange subtracts K^(0) from the transform; this may be much greater than the range of the symbol.
    noise = _ROUND_OFF * setting.overlap**-setting.alpha
    return low, 0.0 if 0.0 < high <= noise else high


def _searches(symbol: Symbol, dim: int) -> Iterator[tuple[Symbol, int]]:
    """Yield the functions whose extremes are looked for, and the number of coordinates of each.

    In a box the symbol is nearly radial, and its least value on a sphere is only a little below the others. This value
    lies on a line of symmetry, on which each coordinate is 0, pi, or the same t. The grid finds all other extremes.
    """
    if dim == 1:
        yield symbol, 1
        return
    yield symbol, dim
    for line in combinations_with_replacement((0.0, np.nan, np.pi), dim):
        if np.isnan(line).any():
            yield partial(_along, symbol, line), 1


def _along(symbol: Symbol, line: tuple[float, ...], t: np.ndarray) -> np.ndarray:
    return symbol(np.where(np.isnan(line), t, line))


def _extremes(f: Symbol, dim: int, setting: Setting) -> tuple[float, float]:
    # The extremes lie near theta ~ 2 / s: sample evenly in theta as well as in theta s.
    samples = _SAMPLES[dim] if dim == setting.dim else _SAMPLES_OF_A_LINE
    near = np.linspace(0.0, min(np.pi, 16.0 / setting.overlap), samples)
    axis = np.union1d(near, np.linspace(0.0, np.pi, samples))
    values = _on_a_grid(f, axis, dim)
    return -_summit(lambda points: -f(points), axis, -values), _summit(f, axis, values)


def _on_a_grid(f: Symbol, axis: np.ndarray, dim: int) -> np.ndarray:
    """Return f at all points with coordinates from `axis`; f does not depend on the order of the coordinates."""
    shape = (axis.size,) * dim
    ordered = np.sort(np.indices(shape).reshape(dim, -1), axis=0)
    different, place = np.unique(np.ravel_multi_index(tuple(ordered), shape), return_inverse=True)
    points = axis[np.stack(np.unravel_index(different, shape), axis=-1)]
    return f(points)[place].reshape(shape)


def _summit(f: Symbol, axis: np.ndarray, values: np.ndarray) -> float:
    """Return the largest value of f, from its `values` at all points with coordinates from `axis`."""
    dim = values.ndim
    best = -np.inf
    for place in _peaks(values):
        axes = [axis] * dim
        for _ in range(_REFINEMENTS[dim]):
            axes = [
                np.linspace(theta[max(k - 1, 0)], theta[min(k + 1, theta.size - 1)], _LOOK[dim])
                for theta, k in zip(axes, place, strict=True)
            ]
            looked_at = f(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1))
            flat = int(looked_at.argmax())
            place = tuple(map(int, np.unravel_index(flat, looked_at.shape)))
        best = max(best, float(looked_at.max()))
    return best


def _peaks(values: np.ndarray) -> Iterator[tuple[int, ...]]:
    """Yield the places of nearly the largest values that exceed their neighbours, the largest first."""
    peak = values >= values.max() - _NEARLY * np.ptp(values)
    for axis in range(values.ndim):
        rise = np.diff(values, axis=axis, prepend=-np.inf, append=-np.inf)
        here = np.arange(values.shape[axis])
        peak &= (rise.take(here, axis) > 0.0) & (rise.take(here + 1, axis) <= 0.0)
    peak.flat[values.argmax()] = True
    places = np.argwhere(peak)
    order = np.argsort(-values[peak], kind="stable")
    for place in places[order[: _MOST_PEAKS if values.ndim == 1 else 1]].tolist():
        yield tuple(place)
