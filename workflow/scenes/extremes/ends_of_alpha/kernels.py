"""Probes of the kernels of every name, order and kernel family, exact and interpolated, and of their transforms."""

from collections.abc import Iterator
from functools import cache
from itertools import product
from typing import Any

import mpmath as mp
import numpy as np

from fracparticles.kernels.families import PAPER_ORDERS, kernel, kernel_transform
from fracparticles.kernels.tabulated import tabulated
from fracstudy.probe import HELD, Kind, Probe
from scenes.extremes.ends_of_alpha.references import written

RADII = (0.0, 0.3, 1.7, 7.0, 100.0)
WAVES = (0.01, 0.7, 3.0)
STEP = 1e-3
NAMES = ("kappa", "F", "G", "K")  # eta, eta1 and Phi do not know alpha


def forms_of(orders: list[int]) -> list[tuple[int, str]]:
    """Orders and kernel families that differ."""
    both = [(order, "printed") for order in orders if order in PAPER_ORDERS]
    return both + [(order, "gamma") for order in orders if order > 2]


@cache
def exact(
    name: str, r: float, alpha: float, n: int, order: int, family: str
) -> tuple[mp.mpf, mp.mpf]:
    """Return the kernel by its 1F1, (11) to (32) or `kernels.high_order`, and the moduli of the parts that cancel."""
    if name == "F":
        value, size = exact("K", r, alpha, n, order, family)
        return -r * value, r * size
    with mp.workdps(40):
        alpha, half, x = mp.mpf(alpha), mp.mpf(n) / 2, mp.mpf(r) ** 2
        power, more = alpha - (2 if name == "kappa" else 0), 2 if name == "K" else 0
        a, b = (power + n) / 2, half + mp.mpf(more) / 2
        constant = 2**power * mp.gamma(a) / (mp.pi**half * mp.gamma(b) * mp.factorial(more))
        parts = [mp.hyp1f1(a, b, -x)]
        if family == "gamma":
            each = range(order // 2)
            parts = [mp.rf(a, j) / mp.factorial(j) * mp.hyp1f1(a + j, b, -x) for j in each]
        elif order == 4:
            parts = [2 * parts[0], -(2 ** (-a)) * mp.hyp1f1(a, b, -x / 2)]
        # G of order II is exp(-x) and a rest that cancel next to its zero.
        size = mp.fsum(map(abs, parts)) + (mp.exp(-x) if name == "G" else 0)
        return (-1 if name == "G" else 1) * constant * mp.fsum(parts), constant * size


def exact_transform(name: str, k: float, alpha: float, order: int, family: str) -> mp.mpf:
    """Return the transform: a power of k times eta^, of K its integral from k on; the same for every n."""
    with mp.workdps(25):
        alpha, terms = mp.mpf(alpha), order // 2

        def eta(q):
            z = q * q / 4
            if family == "gamma":
                return mp.exp(-z) * mp.fsum(z**j / mp.factorial(j) for j in range(terms))
            return mp.exp(-z) if order == 2 else 2 * mp.exp(-z) - mp.exp(-2 * z)

        k = mp.mpf(k)
        if name == "K":
            ends = [k + far for far in (0, 1, 3, 7, 15, 40)]
            return mp.quad(lambda q: q ** (alpha - 1) * eta(q), ends)
        power = {"kappa": alpha - 2, "F": alpha - 1, "G": alpha}[name]
        return (-1 if name == "G" else 1) * k**power * eta(k)


def worst(name: str, beta: float, n: int, form: tuple[int, str]) -> float:
    """Return the greatest error of a kernel at some radii, relative to the parts that cancel."""
    order, family = form
    ours = np.asarray(kernel(name, np.array(RADII), 1.0 + beta, dim=n, order=order, family=family))
    parts = [exact(name, r, 1.0 + beta, n, order, family) for r in RADII]
    misses = [abs(u - v) / size for u, (v, size) in zip(ours, parts, strict=True) if size > 0]
    return float(max(misses, default=0.0))


def probes(betas: list[float], orders: list[int], dims: list[int]) -> Iterator[Probe]:
    """One probe for a kernel in a dimension: the worst of all orders, kernel families and radii.

    Documented is 1e-11, next to a zero relative to what cancels there; measured 1e-12. Interpolation adds step^2 / 8 of
    the second derivative.
    """
    forms = forms_of(orders)
    right = Kind("kernel", "its 1F1, r up to 100", 1e-12, "mpmath 1F1", HELD)
    table = Kind("table", "the kernel within step^2 max|K''| / 8", 1.0 + 1e-6, "mpmath 1F1", HELD)
    transform = Kind("transform", "a power of k times eta^", 1e-12, "mpmath", HELD)
    for beta, name in product(betas, NAMES):
        every = f"order {orders[0]} to {orders[-1]}, {written(beta)}"
        most = lambda of, *more: max(of(name, beta, *more, form) for form in forms)
        for n in dims:
            yield right(f"{name}, n = {n}, {every}", most, worst, n)
        yield table(f"{name}, step {STEP:g}, {written(beta)}", most, _table_error)
        yield transform(f"{name}, {every}", most, _transform_error)


def _table_error(name: str, beta: float, form: tuple[int, str]) -> float:
    """The error between points of the table, over its bound; 1e-12 of the kernel is round-off."""
    order, family = form
    alpha, r = 1.0 + beta, np.array([0.5004, 1.2345])
    ours = tabulated(STEP, family)(name, np.concatenate([-r, r]), alpha, order=order)
    near = r[:, None] + STEP * np.arange(-2, 3)
    values = np.asarray(kernel(name, near, alpha, order=order, family=family))
    curvature = np.abs(np.diff(values, 2, axis=1)).max(axis=1)  # step^2 |K''|
    ratio = 0.0
    for value, other, at, bend in zip(ours[2:], ours[:2], r, curvature, strict=True):
        expected, size = exact(name, at, alpha, 1, order, family)
        sign = -1.0 if name == "F" else 1.0
        miss = max(abs(value - expected), abs(sign * other - expected))
        ratio = max(ratio, float(miss / (1.1 * bend / 8.0 + 1e-12 * size)))
    return ratio


def _transform_error(name: str, beta: float, form: tuple[int, str]) -> float:
    order, family = form
    how: dict[str, Any] = {"order": order, "family": family}
    ours = np.asarray(kernel_transform(name, np.array(WAVES), 1.0 + beta, **how)).tolist()
    exact = [exact_transform(name, k, 1.0 + beta, **how) for k in WAVES]
    return max(float(abs(u / v - 1)) for u, v in zip(ours, exact, strict=True))
