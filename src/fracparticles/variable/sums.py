"""The sum with one even kernel, for u with a tail of its own:

    y_i = sum_j w_{i-j} u_j,    w_m = (1 / h^alpha) c s^(-n-alpha) K(m / s).

c K is the kernel of a scheme with one pass: G of DD, Eq. (10), alpha K of KPSE, Eq. (34).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fracparticles.lattice.exterior import LineFarField
from fracparticles.lattice.exterior_box import BoxFarField, box_far_field
from fracparticles.lattice.sums import BOX_SUMMATIONS, SUMMATIONS
from fracparticles.schemes.base import OnePass, exactly_summed, lattice_radii
from fracparticles.schemes.setting import Setting
from fracparticles.variable.exterior import Tails, line_far_field

__all__ = ["EvenSum"]


class EvenSum:
    """The sum over the particles and, in an open exterior, over their continuation.

    Parameters
    ----------
    scheme : OnePass
        The scheme that gives the weights.
    setting : Setting
    tails : (float, float)
        p of u ~ |x|^-p at the left and the right end; both are equal in the plane.

    Attributes
    ----------
    weights : array, shape (N,) * dim
        w_m for m >= 0 in each coordinate.
    total : float
        The sum of w_m over the infinite lattice.
    far : LineFarField, BoxFarField or None
        The sum over the exterior; None if it is truncated.
    """

    def __init__(self, scheme: OnePass, setting: Setting, tails: Tails) -> None:
        self.setting, self._scheme = setting, scheme
        dim, size = setting.dim, setting.size
        rate, exact = setting.rate, replace(setting, kernel_table=None)
        self.weights = rate * scheme.weights(lattice_radii(size, dim), setting)
        self.total = rate * float(scheme.scaled_transform(np.zeros((1, dim)), exact).flat[0])
        self.far: LineFarField | BoxFarField | None = None
        self._sums: Callable[[np.ndarray], np.ndarray]
        if dim == 1:
            self._sums = SUMMATIONS[setting.summation](self.weights, size)
            if setting.is_open:
                self.far = line_far_field(
                    lambda m: rate * scheme.weights(np.abs(m), exact),
                    1.0 + setting.alpha,
                    setting,
                    tails,
                )
            return
        self._sums = BOX_SUMMATIONS[setting.summation]([self.weights], [None], size, size)
        if setting.is_open:
            fast = exactly_summed(setting)
            inside = self._sums
            if fast != setting:
                w = rate * scheme.weights(lattice_radii(size, dim), fast)
                inside = BOX_SUMMATIONS["fft"]([w], [None], size, size)
            self.far = box_far_field(
                lambda theta: rate * scheme.scaled_transform(theta, exact),
                lambda u: inside(u)[0],
                _off_poles(tails[0] - dim),
                setting.n,
                dim,
            )

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return the sums with the exterior, shape of u."""
        y = self.inside(u)
        if self.far is not None:
            self.far.add(u.reshape(-1), y.reshape(-1))
        return y

    def inside(self, u: np.ndarray) -> np.ndarray:
        """Return the sums over the particles of the lattice."""
        y = self._sums(u)
        return np.array(y if self.setting.dim == 1 else y[0])

    @property
    def sides(self) -> np.ndarray:
        """How often each weight occurs in the sum over all offsets: a factor 2 for each coordinate that is not zero."""
        size, dim = self.setting.size, self.setting.dim
        each = np.where(np.arange(size) == 0, 1.0, 2.0)
        return np.prod(np.meshgrid(*(each,) * dim, indexing="ij", sparse=False), axis=0)

    @property
    def norm(self) -> float:
        """An upper bound of sum_m |w_m|; far away the weights have one sign."""
        present = float(np.sum(self.sides * np.abs(self.weights)))
        return present + abs(self.total - float(np.sum(self.sides * self.weights)))


def _off_poles(alpha: float) -> float:
    """The order of a tail for `box_far_field`, whose exponential integrals have poles at the whole numbers."""
    return alpha + 1e-7 if abs(alpha - round(alpha)) < 1e-7 else alpha
