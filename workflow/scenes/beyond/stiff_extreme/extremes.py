"""Extreme parameters: orders, overlaps, units, sizes, times and data."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from math import ceil
from typing import Any

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.run.case import Case
from fracparticles.run.solution import Solution, relative_l1_error
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.stability import symbol_range
from fracparticles.special.stable import green
from scenes.beyond.stiff_extreme.checks import (
    BLOWS_UP,
    OK,
    SAME,
    SCHEMES_SHOWN,
    Base,
    Check,
    computed,
    falls_four_times,
    matrix_of,
    same,
    stable_step,
)

__all__ = ["CHECKS"]


def _extreme_orders(base: Base) -> Iterator[Check]:
    """Second order in h survives next to beta = 0 and beta = 1."""
    fields = {"half_width": 60.0, "integrator": "exponential", "exterior": "open"}
    for beta, scheme in product((0.01, 0.99), SCHEMES_SHOWN):
        runs = [computed(scheme=scheme, beta=beta, spacing=h, **fields) for h in (0.1, 0.05)]
        case = f"{scheme}, beta = {beta:g}, open exterior, h = 0.1 and 0.05"
        errors = [relative_l1_error(run.case, run.u) for run in runs]
        yield falls_four_times(case, "error (48) falls 4 times", errors)


def _small_overlap(base: Base) -> Iterator[Check]:
    """Overlap 1/2: for order IV the symbol of FPSE is positive, so that it grows however small the step."""
    alpha, h = 1.0 + base["beta"], base["spacing"]
    lattice: dict[str, Any] = {
        "n": round(base["half_width"] / h),
        "spacing": h,
        "alpha": alpha,
        "overlap": 0.5,
    }
    for scheme, order in (("FPSE", 2), ("FPSE", 4), ("KPSE", 2)):
        setting = Setting(order=order, **lattice)
        matrix = matrix_of(setting, scheme) / setting.rate
        greatest = float(np.linalg.eigvals(matrix).real.max())
        predicted = symbol_range(scheme, base["beta"], order, 0.5)[1]
        yield (
            f"{scheme}, order {order}, epsilon = h / 2",
            f"greatest eigenvalue {round(predicted, 3) + 0.0:.3f} D / h^alpha, from the symbol",
            f"{round(greatest, 3) + 0.0:.3f} on {setting.size} particles",
            abs(greatest - predicted) < 0.02,
            BLOWS_UP if predicted > 1e-3 else OK,
        )


def _scaling(base: Base) -> Iterator[Check]:
    """Similarity: lengths times c and times times c^alpha / D leave c u unchanged."""
    expected = f"the scaled solution of h = {base['spacing']:g}, D = 1"
    for scheme in SCHEMES_SHOWN:
        dt = 0.5 * stable_step(scheme, **base)
        reference = computed(scheme=scheme, dt=dt, **base).u
        for c, diffusivity in ((1e-6, 1.0), (1e6, 1.0), (1.0, 1e-6), (1.0, 1e6)):
            time = c ** (1.0 + base["beta"]) / diffusivity
            lengths = {name: c * base[name] for name in ("half_width", "spacing")}
            times = {"t_initial": 0.5 * time, "t_final": 1.5 * time, "dt": dt * time}
            fields = {"beta": base["beta"], "diffusivity": diffusivity, **lengths, **times}
            run = computed(scheme=scheme, **fields)
            case = f"{scheme}, h = {run.case.spacing:.0e}, D = {diffusivity:.0e}"
            yield same(case, expected, c * run.u, reference)


def _linearity(base: Base) -> Iterator[Check]:
    """Strengths near the ends of the range of float64."""
    for scheme in SCHEMES_SHOWN:
        fields = {**base, "scheme": scheme, "integrator": "exponential"}
        reference = computed(**fields)
        for size in (1e-300, 1e300):
            u = computed(size * reference.u0, **fields).u / size
            case = f"{scheme}, strengths times {size:.0e}"
            yield same(case, "the solution times the same", u, reference.u)


def _field(run: Solution) -> np.ndarray:
    """u_eps(x_i) = sum_j V_j u_j eta_eps(x_i - x_j), Eq. (7), with eta of (8)."""
    s = run.case.resolved_overlap
    m = np.arange(-ceil(7.0 * s), ceil(7.0 * s) + 1)  # exp(-49) is below round-off
    return np.convolve(run.u, np.asarray(kernel("eta", m / s, run.case.alpha)) / s, mode="same")


def _long_times(base: Base) -> Iterator[Check]:
    """t_f = 10^6 t_0: with the open exterior the exact solution, on a closed lattice the mean or nothing."""
    fields = {"beta": 0.9, "half_width": 4000.0, "spacing": 1.0, "t_initial": 1.0, "t_final": 1e6}
    for scheme in SCHEMES_SHOWN:
        run = computed(scheme=scheme, integrator="exponential", exterior="open", **fields)
        exact = green(run.x, 1e6, 1.9)
        near = np.abs(run.x) <= 2000.0
        difference = float(np.abs(_field(run) / exact - 1.0)[near].max())
        yield (
            f"{scheme}, beta = 0.9, t_f / t_0 = 10^6, open exterior",
            "field (7) is the exact solution, relative error below 10^-2 for |x| < D / 2",
            f"largest relative error {difference:.1e}",
            difference < 1e-2,
        )
    closed = {"beta": 0.5, "half_width": 10.0, "spacing": 0.1, "integrator": "exponential"}
    run = computed(scheme="KPSE", t_final=1e3, **closed)
    case = "KPSE, truncated, D = 10, t_f = 10^3"
    expected = "the mean of the initial strengths: conservative and symmetric"
    yield same(case, expected, run.u, np.full_like(run.u, run.u0.mean()), "mean")
    run = computed(scheme="DD", t_final=100.5, **closed)
    values, modes = np.linalg.eigh(matrix_of(run.case.setting, "DD"))
    predicted = modes @ (np.exp(100.0 * values) * (modes.T @ run.u0))
    left, found = predicted.sum() / run.u0.sum(), run.u.sum() / run.u0.sum()
    yield (
        "DD, truncated, D = 10, t_f = 100",
        f"leaks as its {values.size} modes decay: {left:.6e} of the total strength is left",
        f"{found:.6e}",
        abs(found / left - 1.0) < SAME,
    )


def _point_data(base: Base) -> Iterator[Check]:
    """All strength on one particle: the wave of two particles, and order.

    The transforms of G, F and eta1 are almost zero or zero at theta = k h = pi: DD and FPSE hardly damp the wave
    (-1)^i, and from rough data it is their strengths, not the scheme's smooth part, that stay wrong.
    """
    fields = {**base, "half_width": 20.0, "integrator": "exponential"}
    for scheme in SCHEMES_SHOWN:
        run = computed(_point, **{**fields, "spacing": 0.05}, scheme=scheme)
        setting = run.case.setting
        symbol = float(SCHEMES[scheme].symbol(np.array([np.pi]), setting)[0])
        predicted = float(np.exp(symbol * setting.rate))
        wave = (-1.0) ** np.arange(run.x.size)
        found = float(wave @ run.u / (wave @ run.u0))
        yield (
            f"{scheme}, one particle of strength 1 / h, T = 1, h = 0.05",
            f"wave of two particles keeps {predicted:.4f} of its amplitude, from the symbol",
            f"{found:.4f}",
            abs(found - predicted) < 0.02,
        )
    errors = []
    for h in (0.1, 0.05):
        run = computed(_point, **{**fields, "spacing": h}, scheme="KPSE", exterior="open")
        exact = np.asarray(green(run.x, 1.0, 1.0 + base["beta"]))
        errors.append(float(np.abs(run.u - exact).sum() / exact.sum()))
    case = "KPSE, one particle of strength 1 / h, T = 1, h = 0.1 and 0.05"
    expected = "the fundamental solution, error falls 4 times"
    yield falls_four_times(case, expected, errors)


def _signs(base: Base) -> Iterator[Check]:
    """One particle: the sign of the weights."""
    fields = {**base, "integrator": "exponential"}
    kernels = (("KPSE", 2, 0.5, True), ("KPSE", 4, 0.5, True), ("KPSE", 4, 0.9, False))
    for scheme, order, beta, positive in (*kernels, ("DD", 2, 0.5, False)):
        fields |= {"beta": beta, "scheme": scheme, "order": order}
        # Short enough to see the weights themselves: u = u0 + A u0 T + ...
        setting = Case(**fields).setting
        matrix = matrix_of(setting, scheme)
        off_diagonal = matrix[~np.eye(setting.size, dtype=bool)].min() / setting.rate
        run = computed(_point, t_final=0.5 + 0.01 / setting.rate, **fields)
        least, becomes = (
            float(run.u.min() / run.u.max()),
            "stays positive" if positive else "turns negative",
        )
        yield (
            f"{scheme}, order {order}, beta = {beta:g}, one particle, T D = 0.01 h^alpha",
            f"least weight {off_diagonal:.1e} D / h^alpha: u {becomes}",
            f"least u {least:.1e} of the peak",
            (off_diagonal >= 0.0) == positive and (least >= -SAME) == positive,
        )


def _rough_data(base: Base) -> Iterator[Check]:
    fields = {**base, "scheme": "KPSE", "integrator": "exponential"}
    run = computed(lambda x: np.random.default_rng(1).uniform(-1.0, 1.0, x.size), **fields)
    yield (
        "KPSE, order 2, random strengths in [-1, 1]",
        "stays within the initial bounds",
        f"{run.u.min():.3f} to {run.u.max():.3f}",
        run.u.min() >= run.u0.min() and run.u.max() <= run.u0.max(),
    )


def _point(x: np.ndarray) -> np.ndarray:
    u = np.zeros_like(x)
    u[x.size // 2] = 1.0 / (x[1] - x[0])
    return u


CHECKS: dict[str, Callable[[Base], Iterator[Check]]] = {
    "extreme order": _extreme_orders,
    "small overlap": _small_overlap,
    "scaling": _scaling,
    "linearity": _linearity,
    "long time": _long_times,
    "point data": _point_data,
    "sign": _signs,
    "rough data": _rough_data,
}
