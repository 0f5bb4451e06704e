"""What a scheme is, and what the schemes share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fracparticles.exterior import far_field
from fracparticles.kernels import kernel_transform
from fracparticles.operators import ConvolutionOperator, Operator
from fracparticles.sums import SUMMATIONS

__all__ = ["Scheme", "Setting", "lattice_transform", "one_pass_operator"]

Weights = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Setting:
    """One scheme on one lattice x_i = i h, i = -n .. n.

    Attributes
    ----------
    n : int
        Half the number of lattice intervals; there are N = 2 n + 1 particles.
    spacing : float
        Particle spacing h, which is the particle volume too.
    alpha : float
        Fractional order, alpha = 1 + beta.
    order : {2, 4}
        Order of the kernels.
    overlap : float
        s = epsilon / h.
    diffusivity : float
        D of Eq. (2).
    summation : {"fft", "naive"}
        See `sums`.
    exterior : {"truncated", "open"}
        See `exterior`.
    """

    n: int
    spacing: float
    alpha: float
    order: int = 2
    overlap: float = 2.0
    diffusivity: float = 1.0
    summation: str = "fft"
    exterior: str = "truncated"

    @property
    def size(self) -> int:
        """The number N of particles."""
        return 2 * self.n + 1

    @property
    def rate(self) -> float:
        """D / h^alpha, the unit of the operator."""
        return self.diffusivity / self.spacing**self.alpha


class Scheme(Protocol):
    """The names that a scheme module defines."""

    NAME: str
    TITLE: str
    EQUATION: str
    KERNEL: str
    ORDERS: tuple[int, ...]
    EXTERIORS: tuple[str, ...]
    CONSERVATIVE: bool  # total strength invariant (18)
    DISSIPATIVE: bool  # no eigenvalue above the range of the symbol

    def operator(self, setting: Setting) -> Operator:
        """Return A of du/dt = A u on the lattice."""

    def symbol(
        self, theta: np.ndarray, alpha: float, order: int = 2, overlap: float = 2.0
    ) -> np.ndarray:
        """Return A(theta) h^alpha / D on the infinite lattice, theta = k h in [0, pi]."""


def one_pass_operator(
    setting: Setting, weights: Weights, exchange_sum: float | None = None, decay: float = 0.0
) -> ConvolutionOperator:
    """Return the operator of a scheme with a single even sum, du_i/dt = sum_j w_{i-j} (u_j - [u_i]).

    Parameters
    ----------
    setting : Setting
    weights : callable
        a_m of the scheme as a function of the offset m, in units of D / h^alpha.
    exchange_sum : float, optional
        For a particle strength exchange, sum_j a_j (u_j - u_i): the sum of a_m over the infinite lattice, from
        the transform. None if the scheme has no - u_i.
    decay : float
        a_m ~ |m|^(-decay), for the open exterior.
    """
    size = setting.size

    def scaled(m: np.ndarray) -> np.ndarray:
        return setting.rate * weights(m)

    w = scaled(np.arange(size, dtype=float))
    far = None
    if setting.exterior == "open":
        far = far_field(scaled, decay, setting.alpha, setting.n)
    convolve = SUMMATIONS[setting.summation](w, size)
    if exchange_sum is None:
        return ConvolutionOperator(convolve, np.zeros(size), far)
    infinite = -setting.rate * exchange_sum
    if setting.exterior == "open":
        return ConvolutionOperator(convolve, np.full(size, infinite), far)
    return ConvolutionOperator(convolve, -present_sum(w, parity=1), far, infinite)


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
    name: str, theta: np.ndarray, alpha: float, order: int, overlap: float, parity: int = 1
) -> np.ndarray:
    """Return sum_m K(m / s) e^{-i m theta} / s = sum_l K^(s (theta + 2 pi l)), Poisson's summation formula.

    For an odd kernel the imaginary part, sum_l sgn(k_l) g(|k_l|). The aliases l fall like a Gaussian, those of
    E like exp(-|k|^alpha); they are summed until they are nil.
    """
    theta = np.asarray(theta, dtype=float)
    last = 1 + int(np.ceil(_NIL_BEYOND[name](alpha) / (2.0 * np.pi * overlap)))
    total = np.zeros_like(theta)
    for alias in range(-last, last + 1):
        k = overlap * (theta + 2.0 * np.pi * alias)
        sign = 1.0 if parity > 0 else np.sign(k)
        total += sign * kernel_transform(name, np.abs(k), alpha, order=order)
    return total


def _gaussian(alpha: float) -> float:
    return 14.0  # k^alpha exp(-k^2 / 4) < 1e-19


_NIL_BEYOND: dict[str, Callable[[float], float]] = {
    "E": lambda alpha: 44.0 ** (1.0 / alpha),
    **dict.fromkeys(("eta", "eta1", "Phi", "kappa", "F", "G", "K"), _gaussian),
}
