"""Flux particle strength exchange (FPSE), Eqs. (19), (25):

    Q_i = -(1 / epsilon^beta) sum_j V_j u_j F_epsilon(x_i - x_j),
    du_i/dt = -(D / epsilon) sum_j V_j (Q_j + Q_i) eta1_epsilon(x_i - x_j).

The fractional flux is computed by direct differentiation, and its divergence by particle strength exchange. The
scheme is conservative. It is not symmetric, because the two sums do not commute on a bounded set of particles. For
order II and without aliases it is stable for D dt / h^alpha <= a with

    a = 2 (s/2)^alpha (4 e / alpha)^(alpha/2).
"""

from __future__ import annotations

from dataclasses import replace
from math import e

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.exterior import LineFarField, far_field
from fracparticles.lattice.exterior_box import box_far_field
from fracparticles.lattice.operators import (
    ConvolutionOperator,
    FluxDivergenceOperator,
    LatticeOperator,
    TwoPassOperator,
)
from fracparticles.lattice.sums import BOX_SUMMATIONS, SUMMATIONS, sums_of_weights
from fracparticles.schemes.base import Function, LatticeScheme, exactly_summed, lattice_radii
from fracparticles.schemes.setting import Setting
from fracparticles.schemes.transform import lattice_transform


def flux_weights(m: np.ndarray, setting: Setting) -> np.ndarray:
    """Q_i = h^(-beta) sum_j b_{i-j} u_j with b_m = -s^(-n-beta) F(m / s), Eq. (19), along m / |m|."""
    s = setting.overlap
    return -(s ** (1.0 - setting.dim - setting.alpha)) * setting.kernel("F", m / s)


def divergence_weights(m: np.ndarray, setting: Setting) -> np.ndarray:
    """du_i/dt = (D / h) sum_j c_{i-j} (Q_j + Q_i) with c_m = -s^(-2) eta1(m / s), Eq. (25), n = 1."""
    s = setting.overlap
    return np.asarray(-(s**-2.0) * kernel("eta1", m / s, setting.alpha, **setting.kernels))


class FluxExchange(LatticeScheme):
    """FPSE."""

    name, place = "FPSE", 3
    title = "Flux particle strength exchange"
    equation, kernel = "Eq. (25)", "Eqs. (20), (23)"
    orders = (2, 4, 6, 8, 10, 12)
    box_orders = (2, 4)  # eta1 as a sum of products, see _Divergence
    families = ("printed", "gamma")
    exteriors = ("truncated", "open")
    conservative = True
    tabulated = True
    colour, marker = "#D55E00", "s"

    def operator(self, setting: Setting) -> LatticeOperator:
        """Return A of Eqs. (19), (25).

        With the open exterior, the flux is also taken at the lattice points beyond the ends, as far as the divergence
        reaches. The sum of eta1 over all neighbours then vanishes, and with it the term Q_i.
        """
        pad = 0
        if setting.is_open:
            pad = self.padding(setting.order, setting.overlap, setting.dim, setting.family)
        if setting.dim == 1:
            return _line_operator(setting, pad)
        return _box_operator(setting, pad, lambda theta: self.symbol(theta, setting))

    def symbol(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return A(theta) h^alpha / D = -s^(-alpha) f(theta) . e(theta).

        f and e are the sums over the aliases of F^ = i (k / |k|) |k|^beta eta^(k) and of eta1^.
        """
        exact = replace(setting, kernel_table=None)  # eta1 is never interpolated
        product = lattice_transform("F", theta, setting) * lattice_transform("eta1", theta, exact)
        if setting.dim > 1:
            product = product.sum(axis=-1)
        return -(setting.overlap**-setting.alpha) * product

    def padding(self, order: int, overlap: float, dim: int, family: str | None) -> int:
        """Return the reach of the divergence."""
        # In a box the divergence is that of the printed kernel: eta1 of order IV is the same in both families.
        return BandedConvolution.reach(overlap, order, family if dim == 1 else None)

    def ends_amplify(self, setting: Setting) -> bool:
        """Return whether the order is 6 or more, on the line."""
        return setting.dim == 1 and setting.order >= 6

    def closed_form_limit(self, beta: float, overlap: float) -> float:
        """Return a, see the module."""
        alpha = 1.0 + beta
        return 2.0 * (overlap / 2.0) ** alpha * (4.0 * e / alpha) ** (alpha / 2.0)


def _line_operator(setting: Setting, pad: int) -> LatticeOperator:
    alpha, size, exact = setting.alpha, setting.size, replace(setting, kernel_table=None)
    reach = BandedConvolution.reach(setting.overlap, setting.order, setting.family)

    def flux_from_outside(m: np.ndarray) -> np.ndarray:
        return setting.rate * flux_weights(m, exact)

    b = setting.rate * flux_weights(np.arange(size + pad, dtype=float), setting)
    c = divergence_weights(np.arange(reach + 1, dtype=float), setting)
    divergence = BandedConvolution(c, parity=-1)
    far, diagonal = None, np.zeros(size)
    if setting.is_open:
        far = far_field(flux_from_outside, alpha, alpha, setting.n, -1, pad, setting.far_terms)
        if setting.summation == "fft":
            # Since the flux is known as far as the divergence reaches, the two sums are one with the weights c * b.
            both = divergence(np.concatenate([-b[:0:-1], b]), np.empty(2 * size - 1))
            convolve = SUMMATIONS["fft"](both[size - 1 :], size)
            ends = (
                np.array([divergence(sums, np.empty(size)) for sums in side])
                for side in (far.right, far.left)
            )
            return ConvolutionOperator(convolve, diagonal, LineFarField(far.depth, *ends))
    else:
        diagonal = sums_of_weights(c, parity=-1, size=size)
    flux_sums = SUMMATIONS[setting.summation](b, size, parity=-1, pad=pad)
    return TwoPassOperator(flux_sums, divergence, diagonal, far)


def _box_operator(setting: Setting, pad: int, symbol: Function) -> LatticeOperator:
    dim, size, shape = setting.dim, setting.size, setting.shape
    divergence = _Divergence(setting.order, setting.overlap, dim, size)
    convolve = _box_flux(setting, pad)
    far, diagonal = None, None
    if setting.is_open:
        exact = exactly_summed(setting)
        inside = convolve if exact == setting else _box_flux(exact, pad)
        far = box_far_field(
            lambda theta: setting.rate * symbol(theta),
            lambda u: divergence(inside(u)),
            setting.alpha,
            setting.n,
            dim,
        )
    else:
        diagonal = np.array([divergence.part(np.ones(shape), axis) for axis in range(dim)])
    return FluxDivergenceOperator(convolve, divergence, diagonal, far, shape)


def _box_flux(setting: Setting, pad: int) -> Function:
    dim, size = setting.dim, setting.size
    offsets = np.arange(size + pad, dtype=float)
    m = np.meshgrid(*(offsets,) * dim, indexing="ij", sparse=True)
    r = lattice_radii(size + pad, dim)
    radial = setting.rate * flux_weights(r, setting) / np.where(r > 0.0, r, 1.0)
    b = [radial * part for part in m]
    return BOX_SUMMATIONS[setting.summation](b, range(dim), size, size + 2 * pad)


class _Divergence:
    """sum_j c_{i-j} . q_j with c_m = -s^(-n-1) eta1(m / s) as products of sums along the axes.

    eta1 of order II is a product, x_d e^(-x_d^2) times e^(-x_e^2) in the other coordinates. eta1 of order IV has the
    factor n + 4 - 2 |r|^2 = (n + 4 - 2 x_d^2) - 2 sum_e x_e^2, so that it is a sum of n products. It is the same in
    both families.
    """

    def __init__(self, order: int, overlap: float, dim: int, size: int) -> None:
        self._dim, self._size = dim, size
        x = np.arange(BandedConvolution.reach(overlap, order) + 1) / overlap
        gauss = np.exp(-x * x) / (overlap * np.sqrt(np.pi))
        odd = x * gauss / overlap
        self._even = BandedConvolution(gauss, parity=1)
        self._polynomial = None
        if order == 2:
            self._odd = BandedConvolution(2.0 * odd, parity=-1)
        else:
            self._odd = BandedConvolution((dim + 4.0 - 2.0 * x * x) * odd, parity=-1)
            self._polynomial = (
                BandedConvolution(-2.0 * odd, parity=-1),
                BandedConvolution(x * x * gauss, parity=1),
            )

    def __call__(self, q: np.ndarray) -> np.ndarray:
        """Return the sum over the components, shape (N, .., N)."""
        total = self.part(q[0], 0)
        for axis in range(1, self._dim):
            total += self.part(q[axis], axis)
        return total

    def part(self, component: np.ndarray, axis: int) -> np.ndarray:
        """Return the sum over j of the components of c and q along `axis`, multiplied; shape (N, .., N)."""
        size, others = self._size, [other for other in range(self._dim) if other != axis]
        p = self._odd.along(component, axis, size)
        if self._polynomial is None:
            for other in others:
                p = self._even.along(p, other, size)
            return p
        linear, square = self._polynomial
        # p holds the sum of products with the factors so far; q holds the product that still lacks a factor x_e^2.
        q = linear.along(component, axis, size)
        for other in others:
            p = self._even.along(p, other, size)
            p += square.along(q, other, size)
            q = self._even.along(q, other, size)
        return p
