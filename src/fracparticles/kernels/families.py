r"""The kernels of the particle schemes, by name.

Every kernel is radial (a function of r = |r|) or a vector along r; each has unit smoothing length,
K_eps(r) = eps^-n K(r / eps). With M(a, b, z) = 1F1(a; b; -z), orders II and IV differ in one rule:

    order II:  M(a, b, r^2)
    order IV:  2 M(a, b, r^2) - 2^-a M(a, b, r^2 / 2)

((B.18), which misprints the last argument; compare (12), (15), (21)). In Fourier space the rule is
2 f(k) - f(sqrt(2) k) for the two Gaussians of (8) and (9).

These are the `printed` family. There is a second one, `gamma`, of any even order to 12 (`kernels_high_order`): the
same in order 2, another in order 4, and the only one from order 6.

`KERNELS` lists what there is; `kernel` evaluates, `kernel_transform` gives the Fourier transform.
Equation numbers are those of Lucchesi et al. (2020).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import gamma, gammaincc

from fracparticles.arguments import fractional_order, real_array
from fracparticles.errors import InvalidInput
from fracparticles.kernels import high_order as kernels_high_order
from fracparticles.kernels.high_order import gamma_nb
from fracparticles.special.hypergeometric import kummer_order_four, kummer_transformed
from fracparticles.special.stable import reduced_green

__all__ = [
    "FAMILIES",
    "KERNELS",
    "PAPER_ORDERS",
    "Kernel",
    "family_of",
    "kernel",
    "kernel_transform",
]

FloatArray = NDArray[np.float64]
LARGEST = 1e150  # the square must not overflow
FAMILIES = ("printed", "gamma")
PAPER_ORDERS = (2, 4)  # of the printed family


# --- in space -------------------------------------------------------------------------------------


def _m(c: float, b: float, r: FloatArray, order: int) -> FloatArray:
    """M(b - c, b, r^2) in order II or IV (B.18); c = b - a keeps its digits as alpha nears 2."""
    return np.asarray(
        kummer_transformed(c, b, r * r) if order == 2 else kummer_order_four(c, b, r * r)
    )


def _gaussian(r: FloatArray, n: int) -> FloatArray:
    return np.exp(-r * r) / math.pi ** (0.5 * n)


def _wide_gaussian(r: FloatArray, n: int) -> FloatArray:
    return np.exp(-0.5 * r * r) / (2.0 * math.pi) ** (0.5 * n)


def _eta(r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """eta = pi^(-n/2) exp(-r^2)  (8);  2 pi^(-n/2) exp(-r^2) - (2 pi)^(-n/2) exp(-r^2/2)  (9)."""
    if order == 2:
        return _gaussian(r, n)
    return 2.0 * _gaussian(r, n) - _wide_gaussian(r, n)


def _eta1(r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """eta1 = -2 r pi^(-n/2) exp(-r^2)  (23);  -(n + 4 - 2 r^2) r pi^(-n/2) exp(-r^2).

    (24) prints 5 - 2 r^2, which is n = 1; the second-moment condition gives n + 4.
    """
    if order == 2:
        return -2.0 * r * _gaussian(r, n)
    return -(n + 4.0 - 2.0 * r * r) * (r * _gaussian(r, n))


def _phi(r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """Phi = -(1/r) d eta/dr = 2 pi^(-n/2) exp(-r^2)  (17); order IV: the same of (9)."""
    if order == 2:
        return 2.0 * _gaussian(r, n)
    return 4.0 * _gaussian(r, n) - _wide_gaussian(r, n)


def _kappa(r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """kappa = Gamma_{n,0}(beta-1) M((beta-1+n)/2, n/2, r^2)  (14), (15)."""
    return gamma_nb(n, 0, alpha - 2.0) * _m(0.5 * (2.0 - alpha), 0.5 * n, r, order)


def _f(r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """F = -Gamma_{n,2}(alpha) M((n+alpha)/2, (n+2)/2, r^2) r  (20), (21)."""
    return -r * _k(r, alpha, n, order)


def _g(r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """G = -Gamma_{n,0}(alpha) M((alpha+n)/2, n/2, r^2)  (11), (12)."""
    return -gamma_nb(n, 0, alpha) * _m(-0.5 * alpha, 0.5 * n, r, order)


def _k(r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """K = -F . r / |r|^2 = Gamma_{n,2}(alpha) M((alpha+n)/2, (n+2)/2, r^2)  (31), (32)."""
    return gamma_nb(n, 2, alpha) * _m(0.5 * (2.0 - alpha), 0.5 * (n + 2), r, order)


def _e(r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """E = L_alpha^0  (39); Phi_{n,alpha} of (57), (58) in n dimensions."""
    return np.asarray(reduced_green(r, alpha, n))


# --- in Fourier space -----------------------------------------------------------------------------


def _eta_hat(k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """exp(-k^2/4);  2 exp(-k^2/4) - exp(-k^2/2)."""
    narrow = np.exp(-0.25 * k * k)
    return narrow if order == 2 else 2.0 * narrow - np.exp(-0.5 * k * k)


def _eta1_hat(k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """k exp(-k^2/4);  k (1 + k^2/4) exp(-k^2/4), for every n.

    Order IV is the gradient of ((n + 2)/2 - r^2) pi^(-n/2) exp(-r^2).
    """
    return k * np.exp(-0.25 * k * k) * (1.0 if order == 2 else 1.0 + 0.25 * k * k)


def _phi_hat(k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """2 exp(-k^2/4);  4 exp(-k^2/4) - exp(-k^2/2)."""
    narrow = np.exp(-0.25 * k * k)
    return 2.0 * narrow if order == 2 else 4.0 * narrow - np.exp(-0.5 * k * k)


def _kappa_hat(k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """k^(alpha-2) eta^(k)  (B.11): infinite at k = 0."""
    with np.errstate(divide="ignore"):
        return k ** (alpha - 2.0) * _eta_hat(k, alpha, n, order)


def _f_hat(k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """k^(alpha-1) eta^(k)  (B.12)."""
    return k ** (alpha - 1.0) * _eta_hat(k, alpha, n, order)


def _g_hat(k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """-k^alpha eta^(k)  (B.13)."""
    return -(k**alpha) * _eta_hat(k, alpha, n, order)


def _k_hat(k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """2^beta Gamma(s, k^2/4);  2^alpha Gamma(s, k^2/4) - 2^(s-1) Gamma(s, k^2/2),  s = alpha/2.

    From r K = -F the transform obeys dK^/dk = -k^(alpha-1) eta^(k), for every n, and vanishes at
    infinity; Gamma(s, x) is the upper incomplete gamma function.
    """
    s = 0.5 * alpha
    narrow = 2.0 ** (alpha - 1.0) * gamma(s) * gammaincc(s, 0.25 * k * k)
    if order == 2:
        return narrow
    return 2.0 * narrow - 2.0 ** (s - 1.0) * gamma(s) * gammaincc(s, 0.5 * k * k)


def _e_hat(k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
    """exp(-k^alpha)."""
    return np.exp(-(k**alpha))


# --- by name --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Kernel:
    """A kernel of the paper.

    Attributes
    ----------
    name : str
        Name in the interface.
    symbol : str
        Symbol in TeX.
    equation : str
        Equations of order II and order IV of the printed family.
    parity : str
        "even" (a radial function) or "odd" (a vector along r).
    orders, dims : tuple of int
        Orders of accuracy and numbers of dimensions that exist.
    """

    name: str
    symbol: str
    equation: str
    parity: str
    _space: Callable[[FloatArray, float, int, int], FloatArray]
    _transform: Callable[[FloatArray, float, int, int], FloatArray]
    _excess: float = math.inf  # the far field is r^-(n + alpha + excess); inf: Gaussian
    orders: tuple[int, ...] = kernels_high_order.ORDERS
    dims: tuple[int, ...] = (1, 2, 3)

    def decay(self, alpha: float, dim: int = 1) -> float:
        """Return the exponent p of the far field r^-p; inf where the decay is Gaussian."""
        return dim + alpha + self._excess


KERNELS: Mapping[str, Kernel] = MappingProxyType(
    {
        entry.name: entry
        for entry in (
            Kernel("eta", r"\eta", "(8), (9)", "even", _eta, _eta_hat),
            Kernel("eta1", r"\eta^1", "(23), (24)", "odd", _eta1, _eta1_hat),
            Kernel("Phi", r"\Phi", "(17)", "even", _phi, _phi_hat),
            Kernel("kappa", r"\kappa^\beta", "(14), (15)", "even", _kappa, _kappa_hat, -2.0),
            Kernel("F", r"\mathbf{F}", "(20), (21)", "odd", _f, _f_hat, -1.0),
            Kernel("G", "G", "(11), (12)", "even", _g, _g_hat, 0.0),
            Kernel("K", "K", "(31), (32)", "even", _k, _k_hat, 0.0),
            Kernel("E", "E", "(39)", "even", _e, _e_hat, 0.0, orders=(2,)),
        )
    }
)


def family_of(order: int, family: str | None = None, field: str = "family") -> str:
    """Return the family, the default resolved: printed for the orders 2 and 4, gamma beyond.

    Raises
    ------
    InvalidInput
        If there is no such family, or it has no such order.
    """
    if family is None:
        return "printed" if order in PAPER_ORDERS else "gamma"
    if family not in FAMILIES:
        raise InvalidInput(field, family, f"one of {', '.join(FAMILIES)}", "Choose a family.")
    if family == "printed" and order not in PAPER_ORDERS:
        raise InvalidInput(
            field,
            family,
            f"'gamma' for order {order}: the paper prints the orders 2 and 4",
            "Leave it out, or choose order 2 or 4.",
        )
    return family


def _select(name: str, alpha: Any, dim: int, order: int) -> tuple[Kernel, float]:
    if not isinstance(name, str) or name not in KERNELS:
        raise InvalidInput("name", name, f"one of {', '.join(KERNELS)}", "Choose a kernel.")
    entry = KERNELS[name]
    if dim not in entry.dims:
        raise InvalidInput("dim", dim, f"one of {entry.dims} for {name}", "Choose a dimension.")
    if order not in entry.orders:
        raise InvalidInput("order", order, f"one of {entry.orders} for {name}", "Choose an order.")
    return entry, fractional_order(alpha)


def _takes_gamma(entry: Kernel, order: int, family: str | None) -> bool:
    """Whether the kernel is one of the gamma family that the printed one does not have."""
    if family is not None and len(entry.orders) == 1:
        raise InvalidInput("family", family, f"nothing for {entry.name}", "Leave it out.")
    return family_of(order, family) == "gamma" and order > 2


def kernel(
    name: str, r: Any, alpha: float, dim: int = 1, order: int = 2, family: str | None = None
) -> FloatArray | float:
    """Return the kernel `name` at distance r, for unit smoothing length.

    Parameters
    ----------
    name : str
        One of `KERNELS`: eta (8), (9); eta1 (23), (24); Phi (17); kappa (14), (15); F (20), (21);
        G (11), (12); K (31), (32); E (39).
    r : array_like
        Distances |r| <= 1e150, any shape. For dim = 1 they may have a sign.
    alpha : float
        Fractional order, 1 < alpha < 2 (eta, eta1 and Phi do not depend on it).
    dim : int
        Number of dimensions, 1 to 3.
    order : int
        2, 4, 6, 8, 10 or 12 (E: 2, it has no other form).
    family : {"printed", "gamma"}, optional
        Family of the kernels; printed for the orders 2 and 4, gamma beyond if left out. Order 2 is the same in both.

    Returns
    -------
    ndarray or float
        Same shape as r. Vector kernels (eta1, F) give the component along r/|r|; for dim = 1 that
        is the odd function of signed r. Relative accuracy 1e-11; next to a zero, relative to the
        parts that cancel there.

    Raises
    ------
    InvalidInput
        If the kernel does not exist, alpha is outside (1, 2), or r is not a distance.
    """
    entry, alpha = _select(name, alpha, dim, order)
    if _takes_gamma(entry, order, family):
        return kernels_high_order.kernel(name, r, alpha, dim=dim, order=order)
    r = real_array("r", r)
    if (np.abs(r) > LARGEST).any():
        raise InvalidInput("r", float(np.abs(r).max()), "|r| <= 1e150", "Scale the distances.")
    if dim > 1 and (r < 0.0).any():
        raise InvalidInput("r", float(r.min()), "a radius r >= 0 for dim > 1", "Give |r|.")
    value = entry._space(r, alpha, dim, order)
    return float(value) if r.ndim == 0 else value


def kernel_transform(
    name: str, k: Any, alpha: float, dim: int = 1, order: int = 2, family: str | None = None
) -> FloatArray | float:
    """Return the Fourier transform, int K(r) exp(-i k.r) dr, at angular wavenumber |k|.

    Parameters
    ----------
    name, alpha, dim, order, family
        As for `kernel`.
    k : array_like
        Angular wavenumbers 0 <= k <= 1e150, any shape.

    Returns
    -------
    ndarray or float
        Same shape as k. For vector kernels (eta1, F) the real g(k) of the transform i k/|k| g(k).
        The transform of kappa is infinite at k = 0.

    Raises
    ------
    InvalidInput
        If the kernel does not exist, alpha is outside (1, 2), or k is negative or not numeric.
    """
    entry, alpha = _select(name, alpha, dim, order)
    if _takes_gamma(entry, order, family):
        return kernels_high_order.kernel_transform(name, k, alpha, dim=dim, order=order)
    k = real_array("k", k)
    if not ((k >= 0.0) & (k <= LARGEST)).all():
        raise InvalidInput("k", k, "0 <= k <= 1e150", "Give the modulus of the wave vector.")
    value = entry._transform(k, alpha, dim, order)
    return float(value) if k.ndim == 0 else value
