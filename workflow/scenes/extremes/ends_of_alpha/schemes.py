"""Probes of the schemes, of their limits, and of what is no order at all."""

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

import mpmath as mp
import numpy as np
from scipy.linalg import expm, toeplitz

import fracparticles as fp
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe, off
from scenes.extremes.dense import exchange
from scenes.extremes.ends_of_alpha import kernels
from scenes.extremes.ends_of_alpha.references import written
from scenes.extremes.ends_of_alpha.runs import TIME, compute_at

_N, _H, _OVERLAP = 20, 0.25, 2.0  # 41 particles
_ROUND_OFF = 64.0 * EPS  # of T |lambda|, measured, see `run.reliability`


def _matrix(scheme: str, beta: float, order: int) -> np.ndarray:
    """Return A h^alpha of DD (10), KPSE (34), or DPSE (13), (16), truncated."""
    alpha, s, family = 1.0 + beta, _OVERLAP, "printed" if order in (2, 4) else "gamma"
    r, name = np.arange(2 * _N + 1) / s, {"KPSE": "K", "DD": "G", "DPSE": "kappa"}[scheme]
    at = [kernels.exact(name, float(x), alpha, 1, order, family)[0] for x in r]
    values = np.array(at, dtype=float)
    if scheme == "KPSE":
        return exchange(toeplitz(alpha * s ** (-1.0 - alpha) * values))
    if scheme == "DD":
        return toeplitz(s ** (-1.0 - alpha) * values)
    # Only differences of the potential enter: the constant 1 / beta is taken off where there are digits for it.
    with mp.workdps(40):
        potential = np.array([float(value - at[0]) for value in at]) * s ** (1.0 - alpha)
    laplacian = 2.0 * s**-3.0 * 2.0 / np.sqrt(np.pi) * np.exp(-r * r)  # (16), (17)
    return exchange(toeplitz(laplacian)) @ toeplitz(potential)


def _against_matrix(scheme: str, beta: float, order: int) -> float:
    lattice: dict[str, Any] = {"half_width": _N * _H, "spacing": _H}
    run = compute_at(beta, scheme=scheme, order=order, integrator="exponential", **lattice)
    exact = expm(TIME * _H ** -(1.0 + beta) * _matrix(scheme, beta, order)) @ run.u0
    return off(run.u, exact)


def dense(betas: list[float]) -> Iterator[Probe]:
    """exp(A T) u0 with A element by element from mpmath: round-off of T |lambda| = 40, of DPSE over beta."""
    right = Kind("scheme", "exp(A T) of its matrix", source="mpmath kernels, scipy expm", must=HELD)
    schemes = (("DD", 2), ("DD", 12), ("KPSE", 2), ("KPSE", 12), ("DPSE", 2))
    for beta, (scheme, order) in product(betas, schemes):
        kept = 1.0 / beta if scheme == "DPSE" and beta > 5e-3 else 1.0
        name = f"{scheme}, order {order}, 41 particles, {written(beta)}"
        bound = _ROUND_OFF * 40.0 * kept
        yield right(name, _against_matrix, scheme, beta, order, bound=bound)


def limits(betas: list[float]) -> Iterator[Probe]:
    """a = 2 / |lambda_min|, of DD and FPSE of order II from k^alpha exp(-k^2/4) and k^alpha exp(-k^2/2).

    The transform is greatest at k^2 = 2 alpha and alpha; the aliases, exp(-(2 pi s - k)^2 / 4), are below 1e-22.
    GPSE: 1 - exp(-k^alpha) and its aliases, at theta = pi.
    """
    # The extreme is looked for among samples, to 1 / 256 of their distance: the square of it.
    right = Kind("limit", "a from the transform", 1e-9, "closed form, mpmath", HELD)
    for beta in betas:
        alpha, s = mp.mpf(1.0 + beta), mp.mpf(_OVERLAP)
        exact = {
            "DD": (2 * alpha) ** (alpha / 2) * mp.exp(-alpha / 2),
            "FPSE": alpha ** (alpha / 2) * mp.exp(-alpha / 2),
            "GPSE": _green_range(alpha, s),
        }
        for scheme, value in exact.items():
            a = 2 * s**alpha / value
            yield right(
                f"{scheme}, order 2, {written(beta)}",
                lambda: float(abs(fp.stability_limit(scheme, beta) / a - 1)),
            )


def _green_range(alpha: mp.mpf, s: mp.mpf) -> mp.mpf:
    """sum_l [exp(-|2 pi l s|^alpha) - exp(-|s (pi + 2 pi l)|^alpha)]."""
    aliases = range(-12, 13)
    zero = mp.fsum(mp.exp(-(abs(2 * mp.pi * m * s) ** alpha)) for m in aliases)
    return zero - mp.fsum(mp.exp(-(abs(s * mp.pi * (2 * m + 1)) ** alpha)) for m in aliases)


def beyond() -> Iterator[Probe]:
    """beta below half an ulp of 1 makes alpha 1, or 2 from the other side: there is no such equation here."""
    x = np.linspace(-4.0, 4.0, 33)
    refused = Kind("no such alpha", must=REFUSED)
    for beta in (0.0, 5e-324, 1e-17, 1e-16, 1.0 - 1e-16, 1.0, float(np.nextafter(1.0, 0.0))):
        alpha = 1.0 + beta
        case = {"scheme": "KPSE", "beta": beta, "half_width": 4.0, "spacing": 0.25, "dt": 1e-3}
        calls: dict[str, Callable[[], Any]] = {
            "Case": lambda: fp.Case(**case),
            "green": lambda: fp.green(1.0, 1.0, alpha),
            "kernel": lambda: fp.kernel("K", 1.0, alpha),
            "evolve": lambda: fp.evolve(np.exp(-x * x), 0.25, alpha, 0.1),
            "mean_radius": lambda: fp.mean_radius(alpha),
            "stability_limit": lambda: fp.stability_limit("KPSE", beta),
        }
        yield from refused.of({f"{name}, beta = {beta!r}": call for name, call in calls.items()})
