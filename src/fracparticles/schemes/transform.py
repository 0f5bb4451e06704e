"""The discrete-time Fourier transform of a kernel that is sampled on a lattice."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from fracparticles._compiled import njit
from fracparticles.kernels.families import KERNELS, family_of, kernel_transform
from fracparticles.kernels.high_order import wavenumber_reach
from fracparticles.schemes.setting import Setting
from fracparticles.special import chebyshev

__all__ = ["lattice_transform"]

# Width, in k, of the pieces in which the transform is tabulated. The transform is analytic except at k = 0, and the
# aliases of the smallest overlap, 1/4, begin at k = pi / 4, more than six half pieces away.
_WIDTH = 0.25
_SMALLEST = 1e-13  # error of an interpolated kernel: smaller ones are left out of the sum
_MOST = 20_000  # errors that are summed at most


def lattice_transform(name: str, theta: np.ndarray, setting: Setting) -> np.ndarray:
    """Return sum_m K(m / s) e^{-i m.theta} / s^n = sum_l K^(s (theta + 2 pi l)), Poisson's summation formula.

    For an odd kernel it is the imaginary part, sum_l (k_l / |k_l|) g(|k_l|): for dim = 1 with the sign of k_l, for
    dim > 1 a vector along the last axis. The aliases l fall like a Gaussian, those of E like exp(-|k|^alpha);
    they are summed until they vanish. For dim = 1 a kernel from a table has its own transform: the interpolation
    error is added as a sum over m.

    Parameters
    ----------
    name : str
        The kernel, see `kernels.kernel`.
    theta : array
        Any shape for dim = 1; for dim > 1 the last axis is the vector.
    setting : Setting
    """
    theta = np.asarray(theta, dtype=float)
    reach = _reach(name, setting)
    last = int(reach / (2.0 * np.pi * setting.overlap) + 0.5)  # s |theta + 2 pi l| <= reach
    if setting.dim > 1:
        return _in_a_box(name, theta, setting, reach, last)
    total = np.zeros_like(theta)
    for alias in range(-last, last + 1):
        k = setting.overlap * (theta + 2.0 * np.pi * alias)
        sign = 1.0 if KERNELS[name].parity == "even" else np.sign(k)
        total += sign * kernel_transform(name, np.abs(k), setting.alpha, **setting.kernels)
    if setting.kernel_table is not None:
        total += _of_the_table(name, theta, setting)
    return total


def _in_a_box(
    name: str, theta: np.ndarray, setting: Setting, reach: float, last: int
) -> np.ndarray:
    dim, even = setting.dim, KERNELS[name].parity == "even"
    k = setting.overlap * (theta - 2.0 * np.pi * np.round(theta / (2.0 * np.pi)))
    size = np.sqrt(np.square(k).sum(axis=-1))
    value, near = np.zeros_like(size), size <= reach
    value[near] = kernel_transform(name, size[near], setting.alpha, **setting.kernels)
    total = value if even else k * (value / np.where(size > 0.0, size, 1.0))[..., None]
    if last > 0:
        table = _table(name, setting.alpha, dim, setting.order, setting.family, reach)
        three = np.zeros((size.size, 3))
        three[:, :dim] = k.reshape(-1, dim)
        lasts = np.where(np.arange(3) < dim, last, 0)
        sums = total.reshape(size.size, -1)  # a view
        _add_aliases(three, 2.0 * np.pi * setting.overlap, lasts, reach, table, even, sums)
    return total


@lru_cache(maxsize=32)
def _table(
    name: str, alpha: float, dim: int, order: int, family: str | None, reach: float
) -> np.ndarray:
    """Return the transform in pieces, see `special.chebyshev`; it is wrong on the first ones, about k = 0."""
    points = chebyshev.sample_points(_WIDTH, int(reach / _WIDTH) + 1)
    values = kernel_transform(name, points, alpha, dim=dim, order=order, family=family)
    return chebyshev.fit(np.asarray(values))


@njit()
def _add_aliases(k, step, lasts, reach, table, even, total):
    """Add all aliases but k itself, for wave vectors of three components, shape (points, 3)."""
    most = reach * reach
    for point in range(k.shape[0]):
        for a in range(-lasts[0], lasts[0] + 1):
            x = k[point, 0] + step * a
            for b in range(-lasts[1], lasts[1] + 1):
                y = k[point, 1] + step * b
                if x * x + y * y > most:
                    continue
                for c in range(-lasts[2], lasts[2] + 1):
                    z = k[point, 2] + step * c
                    square = x * x + y * y + z * z
                    if square > most or (a == 0 and b == 0 and c == 0):
                        continue
                    size = np.sqrt(square)
                    value = chebyshev.horner(size / _WIDTH, table)
                    if even:
                        total[point, 0] += value
                        continue
                    for d in range(total.shape[1]):
                        total[point, d] += (x if d == 0 else y if d == 1 else z) * value / size


def _of_the_table(name: str, theta: np.ndarray, setting: Setting) -> np.ndarray:
    """Return the change of the transform on the line by interpolation in a table: the sum over m of its errors."""
    line = Setting(
        alpha=setting.alpha,
        overlap=setting.overlap,
        kernel_table=setting.kernel_table,
        **setting.kernels,
    )
    error = _errors_of_the_table(name, line)
    cosine = np.cos(theta)
    first, second = np.zeros_like(cosine), np.zeros_like(cosine)
    _clenshaw(error, cosine.reshape(-1), first.reshape(-1), second.reshape(-1))
    if KERNELS[name].parity == "even":
        return np.asarray((error[0] + 2.0 * (cosine * first - second)) / setting.overlap)
    return np.asarray(-2.0 * np.sin(theta) * first / setting.overlap)


@njit()
def _clenshaw(e, cosine, first, second):
    """Add up e_m cos(m theta) and e_m sin(m theta) over m > 0, to b_1 cos(theta) - b_2 and b_1 sin(theta).

    b_m = e_m + 2 cos(theta) b_(m+1) - b_(m+2).
    """
    for m in range(e.size - 1, 0, -1):
        for i in range(cosine.size):
            b = e[m] + 2.0 * cosine[i] * first[i] - second[i]
            second[i], first[i] = first[i], b


@lru_cache(maxsize=32)
def _errors_of_the_table(name: str, setting: Setting) -> np.ndarray:
    """Return K - K(m / s) for m = 0, 1, 2, ..: about step^2 K'' / 8, which falls like r^(-2-alpha) or faster."""
    assert setting.kernel_table is not None
    farthest = (setting.kernel_table**2 / _SMALLEST) ** (1.0 / (2.0 + setting.alpha))
    r = np.arange(min(int(farthest * setting.overlap) + 2, _MOST)) / setting.overlap
    exact = replace(setting, kernel_table=None)
    return np.asarray(setting.kernel(name, r) - exact.kernel(name, r))


def _reach(name: str, setting: Setting) -> float:
    """The wavenumber beyond which the transform is zero to round-off."""
    if name == "E":
        return float(44.0 ** (1.0 / setting.alpha))
    if setting.order > 2 and family_of(setting.order, setting.family) == "gamma":
        return wavenumber_reach(setting.order)
    return 14.0  # k^alpha exp(-k^2 / 4) < 1e-19
