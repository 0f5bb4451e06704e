"""The discrete-time Fourier transform of a kernel that is sampled on a lattice."""

from __future__ import annotations

import numpy as np

from fracparticles.kernels.families import KERNELS, family_of, kernel_transform
from fracparticles.kernels.high_order import wavenumber_reach
from fracparticles.schemes.setting import Setting

__all__ = ["lattice_transform"]


def lattice_transform(name: str, theta: np.ndarray, setting: Setting) -> np.ndarray:
    """Return sum_m K(m / s) e^{-i m.theta} / s^n = sum_l K^(s (theta + 2 pi l)), Poisson's summation formula.

    For an odd kernel the imaginary part, sum_l (k_l / |k_l|) g(|k_l|): for dim = 1 with the sign of k_l, for
    dim > 1 a vector along the last axis. The aliases l fall like a Gaussian, those of E like exp(-|k|^alpha);
    they are summed until they vanish.

    Parameters
    ----------
    name : str
        The kernel, see `kernels.kernel`.
    theta : array
        Any shape for dim = 1; for dim > 1 the last axis is the vector.
    setting : Setting
    """
    theta = np.asarray(theta, dtype=float)
    dim, overlap, even = setting.dim, setting.overlap, KERNELS[name].parity == "even"
    reach = _reach(name, setting)
    last = int(reach / (2.0 * np.pi * overlap) + 0.5)  # s |theta + 2 pi l| <= reach, |theta| <= pi
    if dim == 1:
        total = np.zeros_like(theta)
        for alias in range(-last, last + 1):
            k = overlap * (theta + 2.0 * np.pi * alias)
            sign = 1.0 if even else np.sign(k)
            total += sign * kernel_transform(name, np.abs(k), setting.alpha, **setting.kernels)
        return total
    total = np.zeros(theta.shape[:-1] if even else theta.shape)
    # Aliases that stay beyond the reach for all theta are left out.
    greatest = np.abs(theta).max(initial=0.0)
    nearest = np.maximum(2.0 * np.pi * np.abs(np.arange(-last, last + 1)) - greatest, 0.0)
    for place in np.ndindex(*(2 * last + 1,) * dim):
        if overlap * np.sqrt(np.square(nearest[list(place)]).sum()) > reach:
            continue
        k = overlap * (theta + 2.0 * np.pi * (np.array(place) - last))
        size = np.sqrt(np.square(k).sum(axis=-1))
        value, near = np.zeros_like(size), size <= reach
        value[near] = kernel_transform(name, size[near], setting.alpha, **setting.kernels)
        if even:
            total += value
        else:
            total += k * (value / np.where(size > 0.0, size, 1.0))[..., None]
    return total


def _reach(name: str, setting: Setting) -> float:
    """The wavenumber beyond which the transform is zero to round-off."""
    if name == "E":
        return float(44.0 ** (1.0 / setting.alpha))
    if setting.order > 2 and family_of(setting.order, setting.family) == "gamma":
        return wavenumber_reach(setting.order)
    return 14.0  # k^alpha exp(-k^2 / 4) < 1e-19
