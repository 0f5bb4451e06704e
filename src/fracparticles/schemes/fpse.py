"""Flux particle strength exchange (FPSE), Eqs. (19), (25):

    Q_i = -(1 / epsilon^beta) sum_j V_j u_j F_epsilon(x_i - x_j),
    du_i/dt = -(D / epsilon) sum_j V_j (Q_j + Q_i) eta1_epsilon(x_i - x_j).

The fractional flux by direct differentiation, its divergence by particle strength exchange. Conservative; not
symmetric, because the two sums do not commute on a bounded set of particles.
Stable for D dt / h^alpha <= a; order II, aliases neglected: a = 2 (s/2)^alpha (4 e / alpha)^(alpha/2).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.kernels.tabulated import KernelValues
from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.box import BOX_SUMMATIONS
from fracparticles.lattice.exterior import far_field
from fracparticles.lattice.exterior_box import box_far_field
from fracparticles.lattice.operators import FluxDivergenceOperator, LatticeOperator, TwoPassOperator
from fracparticles.lattice.sums import SUMMATIONS
from fracparticles.schemes.base import Setting, lattice_transform, present_sum

NAME = "FPSE"
TITLE = "Flux particle strength exchange"
EQUATION = "Eq. (25)"
KERNEL = "Eqs. (20), (23)"
ORDERS = (2, 4, 6, 8, 10, 12)
BOX_ORDERS = (2, 4)  # eta1 as a sum of products, see _Divergence
FAMILIES = ("printed", "gamma")
DIMS = (1, 2, 3)
EXTERIORS = ("truncated", "open")
CONSERVATIVE = True
DISSIPATIVE = True


def flux_weights(
    m: np.ndarray,
    alpha: float,
    order: int,
    overlap: float,
    dim: int = 1,
    values: KernelValues = kernel,
) -> np.ndarray:
    """Q_i = h^(-beta) sum_j b_{i-j} u_j with b_m = -s^(-n-beta) F(m / s), Eq. (19), along m / |m|."""
    return -(overlap ** (1.0 - dim - alpha)) * values("F", m / overlap, alpha, dim=dim, order=order)


def divergence_weights(
    m: np.ndarray, alpha: float, order: int, overlap: float, family: str | None = None
) -> np.ndarray:
    """du_i/dt = (D / h) sum_j c_{i-j} (Q_j + Q_i) with c_m = -s^(-2) eta1(m / s), Eq. (25), n = 1."""
    return -(overlap**-2.0) * kernel("eta1", m / overlap, alpha, order=order, family=family)


def operator(setting: Setting) -> LatticeOperator:
    """Return A of Eqs. (19), (25).

    With the open exterior, the flux is also taken at the lattice points next to the ends, as far as the
    divergence reaches; then the sum of eta1 over all neighbours vanishes and with it the term Q_i.
    """
    return _line_operator(setting) if setting.dim == 1 else _box_operator(setting)


def _line_operator(setting: Setting) -> LatticeOperator:
    alpha, order, overlap = setting.alpha, setting.order, setting.overlap
    size, is_open = setting.size, setting.exterior == "open"
    reach = BandedConvolution.reach(overlap, order, setting.family)
    pad = reach if is_open else 0

    def flux(m: np.ndarray) -> np.ndarray:
        return setting.rate * flux_weights(m, alpha, order, overlap, values=setting.kernel)

    convolve = SUMMATIONS[setting.summation](
        flux(np.arange(size + pad, dtype=float)), size, parity=-1, pad=pad
    )
    c = divergence_weights(np.arange(reach + 1, dtype=float), alpha, order, overlap, setting.family)
    far, diagonal = None, np.zeros(size)
    if is_open:
        far = far_field(flux, alpha, alpha, setting.n, -1, pad, setting.far_terms)
    else:
        diagonal = present_sum(c, parity=-1, size=size)
    return TwoPassOperator(convolve, BandedConvolution(c, parity=-1), diagonal, far)


def _box_operator(setting: Setting) -> LatticeOperator:
    alpha, order, overlap, dim = setting.alpha, setting.order, setting.overlap, setting.dim
    size, is_open = setting.size, setting.exterior == "open"
    pad = BandedConvolution.reach(overlap, order) if is_open else 0

    def component(axis: int) -> Callable[..., np.ndarray]:
        def flux(*m: np.ndarray) -> np.ndarray:
            r = np.sqrt(sum(np.square(part) for part in m))
            radial = setting.rate * flux_weights(r, alpha, order, overlap, dim, setting.kernel)
            return radial * (m[axis] / np.where(r > 0.0, r, 1.0))

        return flux

    weights = [component(axis) for axis in range(dim)]
    offsets = np.arange(size + pad, dtype=float)
    grid = np.meshgrid(*(offsets,) * dim, indexing="ij", sparse=True)
    convolve = BOX_SUMMATIONS[setting.summation](
        [flux(*grid) for flux in weights], range(dim), size, size + 2 * pad
    )
    divergence = _Divergence(order, overlap, dim, size)
    far, diagonal = None, None
    if is_open:
        far = box_far_field(weights, range(dim), dim + alpha - 1.0, alpha, setting.n, dim, pad=pad)
    else:
        diagonal = np.array([divergence.part(np.ones(setting.shape), axis) for axis in range(dim)])
    return FluxDivergenceOperator(convolve, divergence, diagonal, far, setting.shape)


class _Divergence:
    """sum_j c_{i-j} . q_j with c_m = -s^(-n-1) eta1(m / s) as products of sums along the axes.

    eta1 of order II is a product, x_d e^(-x_d^2) times e^(-x_e^2) in the other coordinates. That of order IV, with
    n + 4 - 2 |r|^2 = (n + 4 - 2 x_d^2) - 2 sum_e x_e^2, is a sum of n products; it is the same in both families.
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
        """Return sum_j of the component of c along `axis` times that of q, shape (N, .., N)."""
        size, others = self._size, [other for other in range(self._dim) if other != axis]
        p = self._odd.along(component, axis, size)
        if self._polynomial is None:
            for other in others:
                p = self._even.along(p, other, size)
            return p
        linear, square = self._polynomial
        # p: with the factors so far, the product for x_d; q: the same, still without a factor x_e^2.
        q = linear.along(component, axis, size)
        for other in others:
            p = self._even.along(p, other, size)
            p += square.along(q, other, size)
            q = self._even.along(q, other, size)
        return p


def symbol(
    theta: np.ndarray,
    alpha: float,
    order: int = 2,
    overlap: float = 2.0,
    dim: int = 1,
    family: str | None = None,
) -> np.ndarray:
    """A(theta) h^alpha / D = -s^(-alpha) f(theta) . e(theta).

    f and e are the sums over the aliases of F^ = i (k / |k|) |k|^beta eta^(k) and of eta1^.
    """
    f = lattice_transform("F", theta, alpha, order, overlap, parity=-1, dim=dim, family=family)
    e = lattice_transform("eta1", theta, alpha, order, overlap, parity=-1, dim=dim, family=family)
    product = f * e if dim == 1 else (f * e).sum(axis=-1)
    return -(overlap**-alpha) * product
