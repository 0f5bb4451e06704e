"""The stability limit a of Eqs. (54)-(56), D dt / h^alpha <= a, from the Fourier symbol of a scheme."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.schemes.base import is_number
from fracparticles.schemes.discovery import scheme
from fracparticles.schemes.setting import Setting

__all__ = ["grows", "range_in", "stability_limit", "symbol_range"]

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
        Family of the kernels, where there is a choice, see `kernels.kernel`.

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
    one = scheme(name)
    if not (is_number(beta) and 1.0 < 1.0 + beta < 2.0):
        raise InvalidInput(
            "beta", beta, "a number between 0 and 1 (exclusive)", "Give such a value."
        )
    if not (is_number(overlap) and 0.25 * (1.0 - _SLACK) <= overlap <= 1000.0 * (1.0 + _SLACK)):
        raise InvalidInput("overlap", overlap, "a number from 0.25 to 1000", "Give such a value.")
    one.check(dim, order, family)
    alpha, order, dim = 1.0 + float(beta), int(order), int(dim)
    kernels = Setting(alpha=alpha, order=order, overlap=float(overlap), dim=dim, family=family)
    return _symbol_range(name, kernels)


def range_in(name: str, setting: Setting) -> tuple[float, float]:
    """Return the `symbol_range` of a scheme in a setting, whose lattice does not matter."""
    kernels = Setting(alpha=setting.alpha, overlap=setting.overlap, **setting.kernels)
    return _symbol_range(name, kernels)


@lru_cache(maxsize=256)
def _symbol_range(name: str, setting: Setting) -> tuple[float, float]:
    one, dim = scheme(name), setting.dim

    def symbol(axes: Sequence[np.ndarray]) -> np.ndarray:
        theta = axes[0] if dim == 1 else np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        return one.symbol(theta, setting)

    # The extremes lie near theta ~ 2 / s: sample evenly in theta as well as in theta s.
    samples = _SAMPLES[dim]
    near = np.linspace(0.0, min(np.pi, 16.0 / setting.overlap), samples)
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
