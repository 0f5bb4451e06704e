"""The fractional gradient of the particle representation and the divergence by exchange, Eqs. (19), (25):

    (grad^beta u)_i = (1 / epsilon^beta) sum_j V_j u_j F_epsilon(x_i - x_j),
    (div q)_i = (1 / epsilon) sum_j V_j (q_j + q_i) . eta1_epsilon(x_i - x_j).

Both have the kernels of FPSE: F^ = i (k / |k|) |k|^beta eta^(k), so that div grad^beta = -(-Laplacian)^(alpha/2).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.exterior import LineFarField
from fracparticles.lattice.sums import BOX_SUMMATIONS, SUMMATIONS, sums_of_weights
from fracparticles.schemes.base import lattice_radii
from fracparticles.schemes.fpse import divergence_weights, flux_weights
from fracparticles.schemes.setting import Setting
from fracparticles.schemes.transform import lattice_transform
from fracparticles.variable.exterior import PlaneGradientFarField, Tails, line_far_field

__all__ = ["ExchangeDivergence", "FractionalGradient"]


class FractionalGradient:
    """grad^beta u on the lattice and `pad` points beyond each end, shape (dim, N + 2 pad, ..)."""

    def __init__(self, setting: Setting, pad: int, tails: Tails) -> None:
        dim, size = setting.dim, setting.size
        self.setting, self.count = setting, size + 2 * pad
        unit = -(setting.spacing ** (1.0 - setting.alpha))
        exact = replace(setting, kernel_table=None)
        self._far: LineFarField | PlaneGradientFarField | None = None
        self._sums: Callable[[np.ndarray], np.ndarray]
        if dim == 1:
            w = unit * flux_weights(np.arange(size + pad, dtype=float), setting)
            self._sums = SUMMATIONS[setting.summation](w, size, parity=-1, pad=pad)
            if setting.is_open:
                self._far = line_far_field(
                    lambda m: unit * flux_weights(m, exact), setting.alpha, setting, tails, -1, pad
                )
            return

        def weights(count: int, chosen: Setting = exact) -> list[np.ndarray]:
            r = lattice_radii(count, dim)
            radial = unit * flux_weights(r, chosen) / np.where(r > 0.0, r, 1.0)
            m = np.meshgrid(*(np.arange(count, dtype=float),) * dim, indexing="ij", sparse=True)
            return [radial * part for part in m]

        summation = BOX_SUMMATIONS[setting.summation]
        self._sums = summation(weights(size + pad, setting), range(dim), size, self.count)
        if setting.is_open:
            self._far = PlaneGradientFarField(weights, setting, pad, tails[0])

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return the gradient."""
        g = self._sums(u)
        if self._far is not None:
            self._far.add(u, g)
        return np.array(g).reshape(self.setting.dim, *(self.count,) * self.setting.dim)

    @property
    def norm(self) -> float:
        """An upper bound of the norm on the infinite lattice, max |F^| / epsilon^beta."""
        return _largest("F", self.setting) * self._scale

    @property
    def _scale(self) -> float:
        return float((self.setting.overlap * self.setting.spacing) ** (1.0 - self.setting.alpha))


class ExchangeDivergence:
    """div q on the lattice, from q on the lattice and `pad` points beyond each end.

    If q is known as far as the kernel reaches, the sum of eta1 over all neighbours vanishes, and with it the term q_i.
    """

    def __init__(self, setting: Setting, pad: int) -> None:
        self.setting, self._pad = setting, pad
        dim, size = setting.dim, setting.size
        exact = replace(setting, kernel_table=None)
        if dim == 1:
            m = np.arange(self.reach(setting) + 1, dtype=float)
            c = divergence_weights(m, exact) / -setting.spacing
            self._banded = BandedConvolution(c, parity=-1)
            self.diagonal = None if pad else [sums_of_weights(c, parity=-1, size=size)]
            return
        count = size + pad
        r = lattice_radii(count, dim)
        scale = setting.overlap ** (-1.0 - dim) / setting.spacing
        radial = scale * exact.kernel("eta1", r / setting.overlap)
        radial /= np.where(r > 0.0, r, 1.0)
        offsets = np.meshgrid(*(np.arange(count, dtype=float),) * dim, indexing="ij", sparse=True)
        self._sums = [
            BOX_SUMMATIONS["fft"]([radial * part], [axis], size + 2 * pad, size)
            for axis, part in enumerate(offsets)
        ]
        ones = np.ones(setting.shape)
        self.diagonal = None if pad else [sums(ones)[0].copy() for sums in self._sums]

    @staticmethod
    def reach(setting: Setting) -> int:
        """Return how far the kernel reaches, in particles."""
        return BandedConvolution.reach(setting.overlap, setting.order, setting.family)

    def __call__(self, q: np.ndarray) -> np.ndarray:
        """Return the divergence, shape (N, ..); q has the shape of a `FractionalGradient`."""
        if self.setting.dim == 1:
            y = self._banded(np.ascontiguousarray(q[0]), np.empty(self.setting.size))
        else:
            y = np.zeros(self.setting.shape)
            for sums, component in zip(self._sums, q, strict=True):
                y += sums(np.ascontiguousarray(component))[0]
        for part, component in zip(self.diagonal or (), q, strict=False):
            y += part * component
        return y

    @property
    def norm(self) -> float:
        """An upper bound of the norm: max |eta1^| / epsilon plus the part of the ends."""
        ends = 0.0
        if self.diagonal is not None:
            ends = float(np.sqrt(sum(np.square(part) for part in self.diagonal)).max())
        return _largest("eta1", self.setting) / (self.setting.overlap * self.setting.spacing) + ends


def _largest(name: str, setting: Setting) -> float:
    """The largest length of the transform of a vector kernel on the lattice, among samples, plus 1 %."""
    theta = np.linspace(0.0, np.pi, 257 if setting.dim == 1 else 33)
    exact = replace(setting, kernel_table=None)
    if setting.dim == 1:
        return 1.01 * float(np.abs(lattice_transform(name, theta, exact)).max())
    waves = np.stack(np.meshgrid(*(theta,) * setting.dim, indexing="ij"), axis=-1)
    found = lattice_transform(name, waves.reshape(-1, setting.dim), exact)
    return 1.01 * float(np.linalg.norm(found, axis=-1).max())
