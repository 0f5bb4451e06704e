"""The limit a itself: against symbols from scipy, in boxes, where it is zero, and what it refuses."""

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from fracparticles.schemes import SCHEMES
from fracparticles.schemes.stability import stability_limit
from fracstudy.probe import HELD, REFUSED, Kind, Probe
from scenes.extremes.stability_limit.independent import symbol

_POINTS = 4001


def against_an_independent_symbol(orders: list[int], overlaps: list[float]) -> Iterator[Probe]:
    """a = 2 / -min A(theta), and zero where A(theta) > 0 somewhere; by scipy's minimiser on scipy's functions."""
    # The minimiser: the root of eps in theta, whose square counts; at a small overlap the digits that an exchange loses
    # to K^(0), s^-alpha over the range.
    right = Kind("limit a", bound=1e-9, source="scipy", must=HELD)
    for scheme, order, s, beta in product(("DD", "FPSE", "KPSE"), orders, overlaps, (0.1, 0.9)):
        a = _limit(scheme, beta, order, s)
        expected = f"{a:.3g}" if a else "zero: the symbol is positive"
        name = f"{scheme}, order {order}, beta = {beta:g}, s = {s:g}"
        yield right(name, _deviation, a, scheme, beta, order, s, expected=expected)
    for scheme, beta in product(("DD", "FPSE", "KPSE"), (1e-6, 0.5, 1.0 - 1e-6)):
        a = SCHEMES[scheme].closed_form_limit(beta, 1000.0)
        # The aliases that the closed form leaves out are zero here.
        right = Kind("limit a", f"{a:.3g}", 1e-9, "closed form", HELD)
        name = f"{scheme}, order 2, beta = {beta:g}, s = 1000"
        yield right(name, _deviation, a, scheme, beta, 2, 1000.0)
    for order, s in product((2, 4), (0.6, 1.25, 2.0)):
        positive = Kind("limit a", "positive: no wave grows")
        yield positive(f"DPSE, order {order}, beta = 0.1, s = {s:g}", _not_positive, order, s)


def _not_positive(order: int, s: float) -> tuple[float, str]:
    a = stability_limit("DPSE", 0.1, order, s)
    return float(a <= 0.0), f"{a:.2g}"


def in_boxes(overlaps: list[float]) -> Iterator[Probe]:
    """The same in the plane and in space, on grids of wave vectors: the limit is no higher there, nor much lower."""
    # The points are 0.05 (0.2) apart or closer: a quadratic minimum is missed by the square of it.
    missed, counts = {2: 0.01, 3: 0.05}, {2: 61, 3: 17}
    right = Kind("limit a", "that of scipy's symbol", source="scipy", must=HELD)
    for (scheme, order), dim, s in product((("DD", 2), ("DD", 12), ("KPSE", 4)), (2, 3), overlaps):
        if s < {2: 0.75, 3: 1.5}[dim]:
            continue  # so many aliases take scipy too long
        axis = np.linspace(0.0, np.pi, counts[dim])
        near = np.linspace(0.0, min(np.pi, 4.0 / s), counts[dim])
        theta = np.stack(np.meshgrid(*[np.union1d(axis, near)] * dim, indexing="ij"), axis=-1)
        theta = theta.reshape(-1, dim)
        theta = theta[(np.diff(theta, axis=1) >= 0.0).all(axis=1)]
        name = f"{scheme}, order {order}, beta = 0.5, s = {s:g}, n = {dim}"
        yield right(name, _below, scheme, order, s, theta, bound=missed[dim])


def refused() -> Iterator[Probe]:
    """Arguments that mean nothing."""
    cases: dict[str, tuple[Any, ...]] = {
        "overlap 0.2": ("KPSE", 0.5, 2, 0.2),
        "overlap 1001": ("KPSE", 0.5, 2, 1001.0),
        "overlap nan": ("KPSE", 0.5, 2, float("nan")),
        "beta = 0": ("KPSE", 0.0),
        "beta = 1": ("KPSE", 1.0),
        "1 + beta = 1": ("KPSE", 1e-17),
        "order 3": ("KPSE", 0.5, 3),
        "order 4 of GPSE": ("GPSE", 0.5, 4),
        "FD in the plane": ("FD", 0.5, 2, 2.0, 2),
        "no scheme": ("XPSE", 0.5),
    }
    yield from Kind("refused", "an error of ours", must=REFUSED).over(stability_limit, cases)


def _limit(scheme: str, beta: float, order: int, s: float) -> float:
    alpha = 1.0 + beta
    values = lambda t: symbol(scheme, np.atleast_1d(t)[:, None], alpha, order, s)
    # Where theta is smaller than 1e-3, A ~ -theta^alpha of an exchange is lost in the round-off of its parts.
    first = 1e-3 if scheme == "KPSE" else 0.0
    far, near = (np.linspace(first, min(np.pi, end), _POINTS) for end in (np.pi, 16.0 / s))
    theta = np.union1d(far, near)
    if scheme == "FPSE":  # whose factors may change sign next to zero
        theta = np.union1d(theta, np.geomspace(1e-6, 1e-2, 200))
    found = values(theta)
    # Next to a greatest value the symbol may rise above zero between two samples.
    peaks = np.flatnonzero((found[1:-1] > found[:-2]) & (found[1:-1] >= found[2:])) + 1
    peaks = peaks[np.argsort(-found[peaks])[:12]]
    highest = max([found.max(), *(-_least(lambda t: -values(t), theta, int(k)) for k in peaks)])
    if highest > 1e-12 * s**-alpha:
        return 0.0
    k = int(found.argmin())
    return -2.0 / min(_least(values, theta, k), float(found[k]))


def _least(f: Callable[[np.ndarray], np.ndarray], theta: np.ndarray, k: int) -> float:
    """The least value near theta_k by scipy's minimiser."""
    around = theta[max(k - 1, 0)], theta[min(k + 1, theta.size - 1)]
    how: dict[str, Any] = {"bounds": around, "method": "bounded", "options": {"xatol": 1e-10}}
    return float(minimize_scalar(lambda t: float(f(t)[0]), **how).fun)


def _deviation(expected: float, *arguments: Any) -> tuple[float, str]:
    found = stability_limit(*arguments)
    if expected == 0.0 or found == 0.0:
        return abs(found - expected), f"{found:.3g}"
    return abs(found / expected - 1.0), f"{found:.3g}"


def _below(scheme: str, order: int, s: float, theta: np.ndarray) -> tuple[float, str]:
    found = stability_limit(scheme, 0.5, order, s, theta.shape[1])
    values = symbol(scheme, theta, 1.5, order, s)
    if values.max() > 1e-9 * -values.min():
        return found, f"{found:.3g}"
    expected = -2.0 / values.min()
    # A limit above the samples' is wrong in any case.
    high = max(0.0, found / expected - 1.0 - 1e-9) * 1e9
    return max(high, 1.0 - found / expected), f"{found:.3g}"
