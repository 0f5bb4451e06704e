"""The stability limit a of Eqs. (54)-(56), D dt / h^alpha <= a, from the Fourier symbol of a scheme."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.special import gamma, gammainc

from fracparticles.errors import InvalidInput
from fracparticles.schemes import scheme

__all__ = ["closed_form_limit", "stability_limit", "symbol_range"]

_SAMPLES = 513
# Each look at the neighbourhood of an extreme is 16 times as close, which makes it 256 times as exact.
_REFINEMENTS = 5


def stability_limit(
    scheme: str, beta: float, order: int = 2, overlap: float = 2.0, dim: int = 1
) -> float:
    """Return a = 2 D / (|lambda_min| h^alpha), Eq. (55), on the infinite lattice.

    Explicit Euler and the midpoint rule are stable for D dt / h^alpha <= a (Eq. 56).

    Parameters
    ----------
    scheme : str
        Name of a scheme.
    beta : float
        0 < beta < 1.
    order : {2, 4}
        Order of the kernels.
    overlap : float
        epsilon / h.
    dim : {1}
        Space dimension.

    Raises
    ------
    InvalidInput
        If an argument is not allowed.
    """
    if dim != 1:
        raise InvalidInput("dim", dim, "1", "Symbols are those of the one-dimensional lattice.")
    return -2.0 / symbol_range(scheme, beta, order, overlap)[0]


def symbol_range(
    name: str, beta: float, order: int = 2, overlap: float = 2.0
) -> tuple[float, float]:
    """Return the least and the greatest value of A(theta) h^alpha / D."""
    module = scheme(name)
    if not (_is_number(beta) and 1.0 < 1.0 + beta < 2.0):
        raise InvalidInput(
            "beta", beta, "a number between 0 and 1 (exclusive)", "Give such a value."
        )
    if not (_is_number(order) and order in module.ORDERS):
        allowed = f"{' or '.join(map(str, module.ORDERS))} for {name}"
        raise InvalidInput("order", order, allowed, "Choose one of these.")
    if not (_is_number(overlap) and 0.25 <= overlap <= 1000.0):
        raise InvalidInput("overlap", overlap, "a number from 0.25 to 1000", "Give such a value.")
    return _symbol_range(name, float(beta), int(order), float(overlap))


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


@lru_cache(maxsize=256)
def _symbol_range(name: str, beta: float, order: int, overlap: float) -> tuple[float, float]:
    module = scheme(name)
    alpha = 1.0 + beta

    # The extremes lie near theta ~ 2 / s: sample evenly in theta as well as in theta s.
    near = np.linspace(0.0, min(np.pi, 16.0 / overlap), _SAMPLES)
    coarse = np.union1d(near, np.linspace(0.0, np.pi, _SAMPLES))
    extremes = []
    for pick in (np.argmin, np.argmax):
        theta = coarse
        for _ in range(_REFINEMENTS):
            values = module.symbol(theta, alpha, order, overlap)
            k = int(pick(values))
            theta = np.linspace(theta[max(k - 1, 0)], theta[min(k + 1, theta.size - 1)], 33)
        extremes.append(float(values[k]))
    return extremes[0], extremes[1]


def closed_form_limit(scheme: str, beta: float, overlap: float = 2.0) -> float:
    """Return a of DD, FPSE or KPSE, order II, in closed form, the aliases of the lattice neglected.

    DD:   a = 2 (s/2)^alpha (2 e / alpha)^(alpha/2)
    FPSE: a = 2 (s/2)^alpha (4 e / alpha)^(alpha/2)
    KPSE: a = 2 s^alpha / (alpha 2^beta gamma(alpha/2, (pi s / 2)^2))

    Raises
    ------
    InvalidInput
        For any other scheme.
    """
    alpha = 1.0 + beta
    if scheme in ("DD", "FPSE"):
        factor = 2.0 if scheme == "DD" else 4.0
        return 2.0 * (overlap / 2.0) ** alpha * (factor * np.e / alpha) ** (alpha / 2.0)
    if scheme == "KPSE":
        incomplete = gamma(alpha / 2.0) * gammainc(alpha / 2.0, (np.pi * overlap / 2.0) ** 2)
        return 2.0 * overlap**alpha / (alpha * 2.0**beta * incomplete)
    raise InvalidInput("scheme", scheme, "DD, FPSE or KPSE", "Use stability_limit for the others.")
