"""The stability limit a of Eqs. (54)-(56), D dt / h^alpha <= a, from the Fourier symbol of a scheme."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy.special import gamma, gammainc

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import family_of
from fracparticles.schemes import Setting, scheme

__all__ = ["closed_form_limit", "grows", "range_in", "stability_limit", "symbol_range"]

# By dimension: samples in each coordinate, then closer and closer looks at the neighbourhood of an extreme, with so
# many samples from neighbour to neighbour. In one dimension each is 16 times as close: 256 times as exact.
_SAMPLES = {1: 513, 2: 65, 3: 21}
_LOOK = {1: 33, 2: 9, 3: 7}
_REFINEMENTS = {1: 4, 2: 8, 3: 10}
_ROUND_OFF = 1e-13  # of a symbol, against its range
_SLACK = 1e-9  # of a bound of the overlap, which may be a quotient


def stability_limit(
    scheme: str,
    beta: float,
    order: int = 2,
    overlap: float = 2.0,
    dim: int = 1,
    family: str | None = None,
) -> float:
    """Return a = 2 D / (|lambda_min| h^alpha), Eq. (55), on the infinite lattice.

    Explicit Euler and the midpoint rule are stable for D dt / h^alpha <= a (Eq. 56). It is 0 where the symbol is
    positive somewhere, at an overlap too small for the order of the kernels: no step is stable there. For GPSE it binds
    steps that are repeated; a single one, the whole run, cannot grow.

    Parameters
    ----------
    scheme : str
        Name of a scheme.
    beta : float
        0 < beta < 1.
    order : {2, 4, 6, 8, 10, 12}
        Order of the kernels.
    overlap : float
        epsilon / h.
    dim : {1, 2, 3}
        Space dimension.
    family : {"printed", "gamma"}, optional
        Family of the kernels of DD, FPSE and KPSE, see `kernels.kernel`.

    Raises
    ------
    InvalidInput
        If an argument is not allowed.
    """
    low, high = symbol_range(scheme, beta, order, overlap, dim, family)
    return 0.0 if grows(low, high) else -2.0 / low


def grows(low: float, high: float) -> bool:
    """Return whether a symbol of this range amplifies some wave: whether it is positive, beyond round-off."""
    return high > _ROUND_OFF * max(-low, high)


def symbol_range(
    name: str,
    beta: float,
    order: int = 2,
    overlap: float = 2.0,
    dim: int = 1,
    family: str | None = None,
) -> tuple[float, float]:
    """Return the least and the greatest value of A(theta) h^alpha / D."""
    module = scheme(name)
    if not (_is_number(beta) and 1.0 < 1.0 + beta < 2.0):
        raise InvalidInput(
            "beta", beta, "a number between 0 and 1 (exclusive)", "Give such a value."
        )
    if not (_is_number(overlap) and 0.25 * (1.0 - _SLACK) <= overlap <= 1000.0 * (1.0 + _SLACK)):
        raise InvalidInput("overlap", overlap, "a number from 0.25 to 1000", "Give such a value.")
    if not (_is_number(dim) and dim in module.DIMS):
        allowed = f"{' or '.join(map(str, module.DIMS))} for {name}"
        raise InvalidInput("dim", dim, allowed, "Choose one of these.")
    orders = module.ORDERS if dim == 1 else module.BOX_ORDERS
    if not (_is_number(order) and order in orders):
        where = "" if dim == 1 else f" in {dim} dimensions"
        allowed = f"{' or '.join(map(str, orders))} for {name}{where}"
        raise InvalidInput("order", order, allowed, "Choose one of these.")
    if family is not None:
        if not module.FAMILIES:
            raise InvalidInput("family", family, f"nothing for {name}", "Leave it out.")
        family_of(order, family)
    return _symbol_range(name, float(beta), int(order), float(overlap), int(dim), family)


def range_in(name: str, setting: Setting) -> tuple[float, float]:
    """Return the `symbol_range` of a scheme in its setting."""
    s = setting
    return symbol_range(name, s.alpha - 1.0, s.order, s.overlap, s.dim, s.family)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


@lru_cache(maxsize=256)
def _symbol_range(
    name: str, beta: float, order: int, overlap: float, dim: int, family: str | None
) -> tuple[float, float]:
    module = scheme(name)
    alpha, samples = 1.0 + beta, _SAMPLES[dim]
    given = {} if family is None else {"family": family}  # where there is a choice

    def symbol(axes: Sequence[np.ndarray]) -> np.ndarray:
        if dim == 1:
            return module.symbol(axes[0], alpha, order, overlap, **given)
        theta = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        return module.symbol(theta, alpha, order, overlap, dim, **given)

    # The extremes lie near theta ~ 2 / s: sample evenly in theta as well as in theta s.
    near = np.linspace(0.0, min(np.pi, 16.0 / overlap), samples)
    coarse = np.union1d(near, np.linspace(0.0, np.pi, samples))
    everywhere = symbol([coarse] * dim)
    extremes = []
    for pick in (np.argmin, np.argmax):
        axes, values = [coarse] * dim, everywhere
        for _ in range(_REFINEMENTS[dim]):
            place = map(int, np.unravel_index(int(pick(values)), values.shape))
            axes = [
                np.linspace(theta[max(k - 1, 0)], theta[min(k + 1, theta.size - 1)], _LOOK[dim])
                for theta, k in zip(axes, place, strict=True)
            ]
            values = symbol(axes)
        extremes.append(float(values.reshape(-1)[int(pick(values))]))
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
