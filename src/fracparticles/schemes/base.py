"""What a scheme is, and what the schemes share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np

from fracparticles.kernels.families import KERNELS, family_of, kernel, kernel_transform
from fracparticles.kernels.high_order import wavenumber_reach
from fracparticles.kernels.tabulated import KernelValues, tabulated
from fracparticles.lattice.box import BOX_SUMMATIONS
from fracparticles.lattice.exterior import far_field
from fracparticles.lattice.exterior_box import box_far_field
from fracparticles.lattice.operators import ConvolutionOperator, LatticeOperator
from fracparticles.lattice.sums import SUMMATIONS

__all__ = ["Method", "Scheme", "Setting", "lattice_transform", "one_pass_operator"]

Weights = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Setting:
    """One scheme on one lattice x_i = i h, i = -n .. n in each of `dim` coordinates.

    Attributes
    ----------
    n : int
        Half the number of lattice intervals; there are N = 2 n + 1 particles in each direction.
    spacing : float
        Particle spacing h; the particle volume is h^dim.
    alpha : float
        Fractional order, alpha = 1 + beta.
    order : {2, 4, 6, 8, 10, 12}
        Order of the kernels.
    overlap : float
        s = epsilon / h.
    diffusivity : float
        D of Eq. (2).
    summation : {"fft", "naive"}
        See `sums`.
    exterior : {"truncated", "open"}
        See `exterior`.
    dim : {1, 2, 3}
        Space dimension.
    kernel_table : float, optional
        Step of the table that the kernels are interpolated in; exact kernels without it.
    family : {"printed", "gamma"}, optional
        Family of the kernels, see `kernels.kernel`.
    far_terms : {1, 2, 3}
        Terms that continue the solution in an open exterior, dim = 1.
    """

    n: int
    spacing: float
    alpha: float
    order: int = 2
    overlap: float = 2.0
    diffusivity: float = 1.0
    summation: str = "fft"
    exterior: str = "truncated"
    dim: int = 1
    kernel_table: float | None = None
    family: str | None = None
    far_terms: int = 1

    @property
    def size(self) -> int:
        """The number N of particles in each direction."""
        return 2 * self.n + 1

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the lattice."""
        return (self.size,) * self.dim

    @property
    def kernel(self) -> KernelValues:
        """The function that gives the kernels' values: exact, or interpolated."""
        if self.kernel_table is None:
            return partial(kernel, family=self.family)
        return tabulated(self.kernel_table, self.family)

    @property
    def rate(self) -> float:
        """D / h^alpha, the unit of the operator."""
        return self.diffusivity / self.spacing**self.alpha


class Method(Protocol):
    """The names that every scheme module defines."""

    NAME: str
    TITLE: str
    EQUATION: str
    KERNEL: str
    ORDERS: tuple[int, ...]
    BOX_ORDERS: tuple[int, ...]  # in two and three dimensions
    FAMILIES: tuple[str, ...]  # of kernels, where there is a choice
    DIMS: tuple[int, ...]
    EXTERIORS: tuple[str, ...]
    CONSERVATIVE: bool  # total strength invariant (18)


class Scheme(Method, Protocol):
    """The names that a module defines whose particles stay on the lattice."""

    DISSIPATIVE: bool  # no eigenvalue above the range of the symbol

    def operator(self, setting: Setting) -> LatticeOperator:
        """Return A of du/dt = A u on the lattice."""

    # (theta, alpha, order, overlap), and `dim` and `family` if there are several: A(theta) h^alpha / D on the infinite
    # lattice, theta = k h in [0, pi]; for dim > 1 the last axis of theta is the vector.
    symbol: Callable[..., np.ndarray]


def one_pass_operator(
    setting: Setting, weights: Weights, exchange_sum: float | None = None, decay: float = 0.0
) -> ConvolutionOperator:
    """Return the operator of a scheme with a single even sum, du_i/dt = sum_j w_{i-j} (u_j - [u_i]).

    Parameters
    ----------
    setting : Setting
    weights : callable
        a_m of the scheme as a function of the offset |m|, in units of D / h^alpha.
    exchange_sum : float, optional
        For a particle strength exchange, sum_j a_j (u_j - u_i): the sum of a_m over the infinite lattice, from
        the transform. None if the scheme has no - u_i.
    decay : float
        a_m ~ |m|^(-decay), for the open exterior.
    """

    def scaled(m: np.ndarray) -> np.ndarray:
        return setting.rate * weights(m)

    infinite = None if exchange_sum is None else -setting.rate * exchange_sum
    if setting.dim > 1:
        return _box_operator(setting, scaled, infinite, decay)
    size = setting.size
    w = scaled(np.arange(size, dtype=float))
    far = None
    if setting.exterior == "open":
        far = far_field(scaled, decay, setting.alpha, setting.n, terms=setting.far_terms)
    convolve = SUMMATIONS[setting.summation](w, size)
    if infinite is None:
        return ConvolutionOperator(convolve, np.zeros(size), far)
    if setting.exterior == "open":
        return ConvolutionOperator(convolve, np.full(size, infinite), far)
    return ConvolutionOperator(convolve, -present_sum(w, parity=1), far, infinite)


def _box_operator(
    setting: Setting, scaled: Weights, infinite: float | None, decay: float
) -> ConvolutionOperator:
    size, shape = setting.size, setting.shape
    w = scaled(lattice_radii(size, setting.dim))
    sums = BOX_SUMMATIONS[setting.summation]([w], [None], size, size)

    def convolve(u: np.ndarray) -> np.ndarray:
        return sums(u.reshape(shape)).reshape(-1)

    far = None
    if setting.exterior == "open":
        far = box_far_field(
            [lambda *m: scaled(np.sqrt(sum(np.square(part) for part in m)))],
            [None],
            decay,
            setting.alpha,
            setting.n,
            setting.dim,
        )
    particles = size**setting.dim
    if infinite is None:
        return ConvolutionOperator(convolve, np.zeros(particles), far, dim=setting.dim)
    if setting.exterior == "open":
        return ConvolutionOperator(convolve, np.full(particles, infinite), far, dim=setting.dim)
    diagonal = -convolve(np.ones(particles))
    return ConvolutionOperator(convolve, diagonal, far, infinite, setting.dim)


def lattice_radii(count: int, dim: int) -> np.ndarray:
    """Return |m| for m = 0 .. count - 1 in each coordinate, shape (count,) * dim."""
    squares = np.arange(count, dtype=float) ** 2
    total = squares
    for _ in range(dim - 1):
        total = total[..., None] + squares
    return np.sqrt(total)


def present_sum(w: np.ndarray, parity: int, size: int | None = None) -> np.ndarray:
    """Return sum_j w_{i-j} over the particles present, for each of the N particles.

    By cumulative sums from the small far weights to the large near ones.
    """
    size = w.size if size is None else size
    tail = np.zeros(size)
    tail[1 : w.size] = w[1:size]
    one_sided = np.cumsum(tail)
    return w[0] * (1 + parity) / 2 + parity * one_sided[::-1] + one_sided


def lattice_transform(
    name: str,
    theta: np.ndarray,
    alpha: float,
    order: int,
    overlap: float,
    parity: int = 1,
    dim: int = 1,
    family: str | None = None,
) -> np.ndarray:
    """Return sum_m K(m / s) e^{-i m.theta} / s^n = sum_l K^(s (theta + 2 pi l)), Poisson's summation formula.

    For an odd kernel the imaginary part, sum_l (k_l / |k_l|) g(|k_l|): for dim = 1 with the sign of k_l, for
    dim > 1 a vector along the last axis. The aliases l fall like a Gaussian, those of E like exp(-|k|^alpha);
    they are summed until they are nil.

    Parameters
    ----------
    theta : array
        Any shape for dim = 1; for dim > 1 the last axis is the vector.
    """
    theta = np.asarray(theta, dtype=float)
    if dim > 1:
        return _box_transform(name, theta, alpha, order, overlap, dim, family)
    last = _last_alias(_nil_beyond(name, alpha, order, family), overlap)
    total = np.zeros_like(theta)
    for alias in range(-last, last + 1):
        k = overlap * (theta + 2.0 * np.pi * alias)
        sign = 1.0 if parity > 0 else np.sign(k)
        total += sign * kernel_transform(name, np.abs(k), alpha, order=order, family=family)
    return total


def _box_transform(
    name: str,
    theta: np.ndarray,
    alpha: float,
    order: int,
    overlap: float,
    dim: int,
    family: str | None,
) -> np.ndarray:
    nil = _nil_beyond(name, alpha, order, family)
    even = KERNELS[name].parity == "even"
    total = np.zeros(theta.shape[:-1] if even else theta.shape)
    last = _last_alias(nil, overlap)
    # Aliases that stay beyond `nil` for all theta are left out.
    nearest = 2.0 * np.pi * np.maximum(np.abs(np.arange(-last, last + 1)) - 0.5, 0.0)
    for alias in np.ndindex(*(2 * last + 1,) * dim):
        if overlap * np.sqrt(np.square(nearest[list(alias)]).sum()) > nil:
            continue
        k = overlap * (theta + 2.0 * np.pi * (np.array(alias) - last))
        size = np.sqrt(np.square(k).sum(axis=-1))
        value = kernel_transform(name, size, alpha, dim=dim, order=order, family=family)
        if even:
            total += value
        else:
            total += k * (value / np.where(size > 0.0, size, 1.0))[..., None]
    return total


def _last_alias(nil: float, overlap: float) -> int:
    """The last l for which s |theta + 2 pi l| <= `nil` for any |theta| <= pi."""
    return int(nil / (2.0 * np.pi * overlap) + 0.5)


def _nil_beyond(name: str, alpha: float, order: int, family: str | None) -> float:
    """The wavenumber beyond which the transform is nil."""
    if name == "E":
        return float(44.0 ** (1.0 / alpha))
    if order > 2 and family_of(order, family) == "gamma":
        return wavenumber_reach(order)
    return 14.0  # k^alpha exp(-k^2 / 4) < 1e-19
