r"""The kernels of the particle schemes, by name and kernel family.

Every kernel is radial (a function of r = |r|) or a vector along r; each has unit smoothing length,
K_eps(r) = eps^-n K(r / eps). There are two kernel families: `printed`, the paper's orders II and IV
(`kernels.printed`), and `gamma`, of any even order to 12 (`kernels.high_order`). They agree in order 2 and differ in
order 4; from order 6 on there is only `gamma`.

`KERNELS` lists the kernels; `kernel` evaluates one, `kernel_transform` its Fourier transform.
Equation numbers are those of Lucchesi et al. (2020).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from fracparticles.arguments import FloatArray, choice
from fracparticles.errors import InvalidInput, one_of
from fracparticles.kernels.high_order import GAMMA, ORDERS
from fracparticles.kernels.printed import PRINTED
from fracparticles.kernels.rules import KernelFamily, is_order

__all__ = [
    "FAMILIES",
    "KERNELS",
    "PAPER_ORDERS",
    "Kernel",
    "family_of",
    "gaussian_reach",
    "kernel",
    "kernel_transform",
]

FAMILIES = ("printed", "gamma")
PAPER_ORDERS = PRINTED.orders

# By kernel family and order, the distance in epsilon beyond which a Gaussian kernel counts as zero. exp(-r^2) falls
# below the round-off of a unit sum, 1e-18, at r = 6.44. Printed kernels of order IV may hold exp(-r^2 / 2), which falls
# below it at r = 9.1. In the gamma family exp(-r^2) is multiplied by a polynomial: the distances were measured, where
# eta1 falls below 2^-56 of its greatest value.
_GAUSSIAN_REACH = {
    "printed": {2: 6.5, 4: 9.2},
    "gamma": {2: 6.5, 4: 6.7, 6: 6.9, 8: 7.1, 10: 7.3, 12: 7.4},
}


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
        Equations of order II and order IV of the printed kernel family.
    parity : str
        "even" (a radial function) or "odd" (a vector along r).
    orders, dims : tuple of int
        Orders of accuracy and numbers of dimensions that exist.
    """

    name: str
    symbol: str
    equation: str
    parity: str
    _excess: float = math.inf  # the far field is r^-(n + alpha + excess); inf: Gaussian
    orders: tuple[int, ...] = ORDERS
    dims: tuple[int, ...] = (1, 2, 3)

    def decay(self, alpha: float, dim: int = 1) -> float:
        """Return the exponent p of the far field r^-p; inf where the decay is Gaussian."""
        return dim + alpha + self._excess


_LISTED = (
    Kernel("eta", r"\eta", "(8), (9)", "even"),
    Kernel("eta1", r"\eta^1", "(23), (24)", "odd"),
    Kernel("Phi", r"\Phi", "(17)", "even"),
    Kernel("kappa", r"\kappa^\beta", "(14), (15)", "even", -2.0),
    Kernel("F", r"\mathbf{F}", "(20), (21)", "odd", -1.0),
    Kernel("G", "G", "(11), (12)", "even", 0.0),
    Kernel("K", "K", "(31), (32)", "even", 0.0),
    Kernel("E", "E", "(39)", "even", 0.0, orders=(2,)),
)
KERNELS: Mapping[str, Kernel] = MappingProxyType({entry.name: entry for entry in _LISTED})


def family_of(order: int, family: str | None = None, field: str = "family") -> str:
    """Return the kernel family; the default is printed for the orders 2 and 4, and gamma beyond.

    Raises `InvalidInput` if the kernel family does not exist, or does not have this order.
    """
    if family is None:
        return "printed" if order in PAPER_ORDERS else "gamma"
    choice(field, family, FAMILIES)
    if family == "printed" and order not in PAPER_ORDERS:
        allowed = f"'gamma' for order {order}: the paper prints the orders 2 and 4"
        raise InvalidInput(field, family, allowed, "Leave it out, or choose order 2 or 4.")
    return family


def gaussian_reach(order: int, family: str | None = None) -> float:
    """Return the distance beyond which Gaussian kernels of an order are zero to round-off; errors as `family_of`."""
    return _GAUSSIAN_REACH[family_of(order, family)][order]


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
        Kernel family; printed for the orders 2 and 4, gamma beyond if left out. Order 2 is the same in both.

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
    return _family(name, order, family).kernel(name, r, alpha, dim, order)


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
    return _family(name, order, family).kernel_transform(name, k, alpha, dim, order)


def _family(name: str, order: int, family: str | None) -> KernelFamily:
    """The kernel family that has the kernel in this order; of the two that have order 2, the printed one."""
    entry = KERNELS[choice("name", name, tuple(KERNELS))]
    if not is_order(order, entry.orders):
        raise one_of("order", order, entry.orders, name)
    if family is not None and len(entry.orders) == 1:
        raise InvalidInput("family", family, f"nothing for {name}", "Leave it out.")
    return GAMMA if family_of(order, family) == "gamma" and order > 2 else PRINTED
