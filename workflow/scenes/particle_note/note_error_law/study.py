"""The error law of the lecture note, C_1 eps^r + C_2 (h/eps)^m (Sec. 2.2), its two terms measured one by one."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.pse import (
    GAUSSIAN_20,
    Kernel,
    SplineKernel,
    construct,
    lattice,
    lattice_moment,
    moment,
    reconstruct,
    regularised,
    required_moments,
)
from fracparticles.pse import derivative as derivative_by_sum
from fracparticles.pse.construction import taylor_constant
from fracparticles.run.orders import observed_order
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.particle_note.waves import wave

__all__ = ["study"]

_ROUND_POWER = 0.1  # how far a measured power may be from the one it is held against
_ROUND_CONSTANT = 0.05


def study(
    inputs: Inputs,
    *,
    derivative: list[int],
    accuracy: list[int],
    epsilon: list[float],
    degree: list[int],
    radius: float,
    overlap: list[float],
    coarse: float,
    ratio: list[float],
    spacing: list[float],
    radii: list[float],
) -> Result:
    """Powers and constants of the two terms for cos(kappa x), whose norms are powers of kappa.

    The integral (18), by a Gauss rule, against the derivative is the error of regularisation; the sum (21) at
    particles of a lattice against the integral is the error of quadrature. Powers of eps, h / eps and kappa are
    those between neighbouring levels; for h / eps the power is fitted through the maxima, for the error swings.
    A power counts as met within 0.1, a constant within 5 %. Predicted are C_1 = |M_(beta+r)| / (beta+r)! with
    kappa^(beta+r), and for beta = 2 the relative error of the discrete moment, |M^_2 - 2| / 2 with kappa^2.

    The regularisation is measured for the orders `derivative`, the accuracies and the radii `epsilon`; the quadrature
    for splines of the degrees at one `radius`, with `overlap` the largest eps / h and the number of them; both
    together for the `radii` (first, last, number) and each `spacing`. `coarse` is an eps / h without overlap, and
    `ratio` holds those h / eps at which h and eps are refined together.
    """
    first, lines = _regularisation(derivative, accuracy, epsilon)
    second, waves = _quadrature(degree, radius, np.linspace(1.0, overlap[0], int(overlap[1])))
    third = _prefactor([beta for beta in derivative if beta > 0], epsilon, coarse)
    total = _total(np.geomspace(radii[0], radii[1], int(radii[2])), spacing, coarse)
    table = pd.concat([first, second, third], ignore_index=True)
    series = pd.concat([*lines, *waves, *total], ignore_index=True)
    if not inputs.items:
        return Result(table, (), series)
    findings = [
        *_findings_of_regularisation(first),
        *_findings_of_quadrature(second, radius),
        _finding_of_law(third, coarse),
        _finding_of_overlap(0.125 * np.array(epsilon), ratio, coarse),
    ]
    return Result(table, findings, series)


def _line(panel: str, x: Any, y: Any, **more: Any) -> pd.DataFrame:
    return pd.DataFrame({"panel": panel, **more, "x": x, "y": y})


def _power(x: Any, error: Any) -> float:
    """The power of x between the two finest levels."""
    return float(observed_order(x, error)[-1])


# --- C_1 eps^r ------------------------------------------------------------------------------------


def _regularisation(
    derivative: list[int], accuracy: list[int], radii: list[float]
) -> tuple[pd.DataFrame, list[pd.DataFrame]]:
    """Rows and lines of the error of the integral (18), for each beta and r."""
    rows, lines = [], []
    for beta, r in product(derivative, accuracy):
        kernel = construct(beta, r)
        constant = abs(float(taylor_constant(kernel, beta, r)))
        error = np.array([_integral_error(kernel, epsilon, beta) for epsilon in radii])
        doubled = _integral_error(kernel, radii[-1], beta, kappa=2.0)
        rows.append(
            {
                "term": "regularisation",
                "derivative": beta,
                "kernel": f"Gaussian, r = {r}",
                "power of": "ε",
                "predicted power": float(r),
                "power": _power(radii, error),
                "predicted constant": constant,
                "constant": error[-1] / radii[-1] ** r,
                "power of κ, printed": float(r),
                "power of κ": float(np.log2(doubled / error[-1])),
            }
        )
        lines.append(_line("regularisation", radii, error / constant, beta=beta, r=r))
    return pd.DataFrame(rows), lines


def _integral_error(kernel: Kernel, epsilon: float, beta: int, kappa: float = 1.0) -> float:
    """The largest error of the integral (18), or (9) for beta = 0, for cos(kappa x) over a period."""
    x = np.linspace(0.0, 2.0 * np.pi, 17) / kappa
    found = regularised(lambda y: wave(y, kappa), x, epsilon, kernel, beta)
    return float(np.abs(found - wave(x, kappa, beta)).max())


def _misses(rows: pd.DataFrame) -> tuple[float, float, bool]:
    """How far powers and constants are from the predicted ones, and whether that is near enough."""
    off = (rows["power"] - rows["predicted power"]).abs().max()
    ratio = (rows["constant"] / rows["predicted constant"] - 1.0).abs().max()
    return off, 100.0 * ratio, bool(off < _ROUND_POWER and ratio < _ROUND_CONSTANT)


def _findings_of_regularisation(rows: pd.DataFrame) -> Iterator[Finding]:
    off, percent, met = _misses(rows)
    yield statement(
        "P-C1.regularisation",
        met,
        f"{len(rows)} kernels, beta = {rows['derivative'].min()} to {rows['derivative'].max()}: the power of eps "
        f"is r within {off:.2g}, and the constant is |M_(beta+r)| / (beta+r)! within {percent:.2g} %.",
        "A power or a constant is another.",
    )
    printed = rows["power of κ"] - rows["power of κ, printed"]
    ours = (printed - rows["derivative"]).abs().max()
    derivatives = rows["derivative"] > 0
    example = rows[derivatives].iloc[-1]
    yield statement(
        "P-C1.regularisation_norm",
        printed[derivatives].abs().max() < _ROUND_POWER,
        f"For cos(kappa x) the error grows as kappa^(beta+r), within {ours:.2g} in the exponent for all "
        f"{len(rows)} kernels: kappa^{example['power of κ']:.2f} for beta = {example['derivative']}, "
        f"r = {example['predicted power']:g}.",
        "The first term left over in (17) has f^(beta+r), so that the norm is that of f^(beta+r); f^(r) is right "
        "for the function itself, beta = 0, only.",
    )


# --- C_2 (h/eps)^m --------------------------------------------------------------------------------


def _quadrature(
    degree: list[int], epsilon: float, overlap: np.ndarray
) -> tuple[pd.DataFrame, list[pd.DataFrame]]:
    """Rows and lines of the error of the sum (21) against the integral (18), for f'' at a fixed radius."""
    kernels: dict[str, Kernel] = {f"spline, degree {q}": SplineKernel(q) for q in degree}
    rows, lines = [], []
    for name, kernel in [*kernels.items(), ("Gaussian (20)", GAUSSIAN_20)]:
        error = np.array([_sum_error(kernel, epsilon, epsilon / s, 2) for s in overlap])
        relative = np.abs(lattice_moment(kernel, 2, overlap) - 2.0) / 2.0
        row: dict[str, Any] = {
            "term": "quadrature",
            "derivative": 2,
            "kernel": name,
            "power of": "h/ε",
        }
        row["power of κ"] = _kappa_power(kernel, epsilon, 2)
        if isinstance(kernel, SplineKernel):
            m = kernel.degree + 1.0
            row["power of κ, printed"] = row["predicted power"] = m
            row["power"] = -_power_of_maxima(overlap, error)
            row["predicted constant"] = float((overlap**m * relative).max())
            row["constant"] = float((overlap**m * error).max())
            bound = row["constant"] * overlap**-m
            lines.append(_line("bound", 1.0 / overlap, bound, series=name))
        else:
            # Any power: what is left of the error from one overlap to the next is no power.
            finer = _sum_error(kernel, epsilon, epsilon / 2.0, 2)
            row["power"] = float(np.log2(error[0] / finer))
        rows.append(row)
        lines.append(_line("quadrature", 1.0 / overlap, error, series=name))
    return pd.DataFrame(rows), lines


def _sum(
    kernel: Kernel, epsilon: float, h: float, beta: int, kappa: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Particles over a period of cos(kappa x), and the sum of (18) there."""
    # A third of an h off, lest the particles lie on the extrema of all lattices.
    shift = h / 3.0
    x = shift + h * np.round(np.linspace(0.0, 2.0 * np.pi, 17) / kappa / h)
    margin = kernel.reach * epsilon + h
    particles = shift + lattice(-margin, x.max() + margin, h)
    f, at = wave(particles, kappa), wave(x, kappa)
    return x, derivative_by_sum(x, at, particles, f, h, epsilon, kernel, beta)


def _sum_error(kernel: Kernel, epsilon: float, h: float, beta: int, kappa: float = 1.0) -> float:
    """The largest difference of the sum and the integral (18) for cos(kappa x), at particles of the lattice."""
    x, found = _sum(kernel, epsilon, h, beta, kappa)
    integral = regularised(lambda y: wave(y, kappa), x, epsilon, kernel, beta)
    return float(np.abs(found - integral).max())


def _kappa_power(kernel: Kernel, epsilon: float, beta: int, overlap: float = 1.5) -> float:
    single, double = (
        _sum_error(kernel, epsilon, epsilon / overlap, beta, kappa) for kappa in (0.5, 1.0)
    )
    return float(np.log2(double / single))


def _power_of_maxima(x: np.ndarray, y: np.ndarray) -> float:
    """The power of x >= 2 fitted through the maxima of y in [2, 3), [3, 4), ...; through all points if there are few.

    The error of a spline is a function of the period 1 in x = eps / h, times that power.
    """
    whole = range(2, int(x[-1]))
    chosen = [int(np.argmax(np.where((x >= n) & (x < n + 1.0), y, -np.inf))) for n in whole]
    if len(chosen) < 3:
        chosen = list(range(x.size))
    return float(np.polyfit(np.log(x[chosen]), np.log(y[chosen]), 1)[0])


def _findings_of_quadrature(rows: pd.DataFrame, epsilon: float) -> Iterator[Finding]:
    splines = rows.dropna(subset="predicted power")
    gauss = rows[rows["predicted power"].isna()].iloc[0]
    _, percent, met = _misses(splines)
    smooth = splines["predicted power"]
    pairs = zip(splines["power"], smooth, strict=True)
    powers = ", ".join(f"{p:.2f} (degree {m - 1:g})" for p, m in pairs)
    yield statement(
        "P-C1.quadrature",
        met,
        f"Powers of h/eps for B-splines: {powers}: m = degree + 1, as smooth as the kernel is; the constant is "
        f"that of the discrete moment M^_2 within {percent:.2g} %. The Gaussian (20) falls faster than any "
        f"power: by 2^{gauss['power']:.0f} from eps = h to 2 h.",
        "A power or a constant is another.",
    )
    kappa = splines["power of κ"]
    yield statement(
        "P-C1.quadrature_norm",
        (kappa - splines["power of κ, printed"]).abs().max() < _ROUND_POWER,
        f"At fixed eps and h the error for cos(kappa x) grows as kappa^{kappa.min():.2f} to "
        f"kappa^{kappa.max():.2f} whatever m is ({', '.join(f'{m:g}' for m in smooth)}); for f = 1, where "
        f"f^(m) = 0, the sum (9) with the spline of degree 1 is off by {_error_of_one(epsilon):.2g} at eps = 1.5 h.",
        "The lattice sees a wrong moment of the kernel, so that the error is proportional to the function or to "
        "its derivative of order beta; the norm must hold all derivatives up to m, not the m-th alone.",
    )


def _error_of_one(epsilon: float) -> float:
    """The largest error of (9) for f = 1, by the spline of degree 1 at eps = 1.5 h."""
    h, kernel = epsilon / 1.5, SplineKernel(1)
    particles = lattice(-2.0 * epsilon, 2.0 * epsilon + h, h)
    x = np.linspace(0.0, h, 21)
    mass = moment(kernel, 0)
    found = reconstruct(x, particles, np.ones_like(particles), h, epsilon, kernel) / mass
    return float(np.abs(found - 1.0).max())


# --- both -----------------------------------------------------------------------------------------


def _prefactor(derivative: list[int], radii: list[float], overlap: float) -> pd.DataFrame:
    """The error of quadrature at a fixed h / eps, as a power of eps: zero says the law, for every beta."""
    rows = []
    for beta in derivative:
        kernel = construct(beta, 2)
        error = [_sum_error(kernel, e, e / overlap, beta) for e in radii]
        # The lowest moment of the parity of the kernel that f(y) - f(x) leaves.
        lowest = 2 - beta % 2
        rows.append(
            {
                "term": f"quadrature, h = {1.0 / overlap:.3g} ε",
                "derivative": beta,
                "kernel": "Gaussian, r = 2",
                "power of": "ε",
                "predicted power": float(lowest - beta),
                "power": _power(radii, error),
                "power of κ": _kappa_power(kernel, radii[-1], beta, overlap),
            }
        )
    return pd.DataFrame(rows)


def _finding_of_law(rows: pd.DataFrame, coarse: float) -> Finding:
    pairs = zip(rows["power"], rows["derivative"], strict=True)
    powers = ", ".join(f"{p:.2f} (beta = {beta})" for p, beta in pairs)
    return statement(
        "P-C1.law",
        rows["power"].abs().max() < _ROUND_POWER,
        f"The error of quadrature at fixed h/eps = {1.0 / coarse:.3g} goes with eps to the power {powers}: the law "
        "holds for beta <= 2.",
        "The factor eps^-beta in (18) multiplies the quadrature error too: from beta = 3 on, a wrong discrete moment "
        "of order 1 or 2 leaves a term with eps^(1-beta) or eps^(2-beta), and the sum diverges at fixed h/eps.",
    )


def _total(radii: np.ndarray, spacing: list[float], coarse: float) -> list[pd.DataFrame]:
    """The error of (21) with (20), and with the moments met on the lattice, for several h."""
    lines = []
    for h in spacing:
        error = [_sum_against_derivative(GAUSSIAN_20, epsilon, h) for epsilon in radii]
        lines.append(_line("total", radii, error, series=str(h)))
    corrected = construct(2, 2, coarse)
    error = [_sum_against_derivative(corrected, coarse * h, h) for h in spacing]
    return [*lines, _line("total", coarse * np.array(spacing), error, series="lattice")]


def _sum_against_derivative(kernel: Kernel, epsilon: float, h: float) -> float:
    x, found = _sum(kernel, epsilon, h, 2)
    return float(np.abs(found - wave(x, order=2)).max())


def _finding_of_overlap(radii: np.ndarray, ratios: list[float], coarse: float) -> Finding:
    """Errors of (21) with (20) at a fixed h / eps on ever finer lattices, until the error of quadrature is left."""
    power, last = {}, {}
    for ratio in ratios:
        error = [_sum_against_derivative(GAUSSIAN_20, e, ratio * e) for e in radii]
        power[ratio], last[ratio] = _power(radii, error), error[-1]
    apart = all(p < 0.5 for ratio, p in power.items() if ratio >= 1.0)
    close = all(abs(p - 2.0) < _ROUND_POWER for ratio, p in power.items() if ratio <= 0.5)
    kernel = construct(2, 2, coarse)
    order = _power(radii, [_sum_against_derivative(kernel, e, e / coarse) for e in radii])
    wanted = required_moments(2, 2)[2]
    floor = abs(float(lattice_moment(GAUSSIAN_20, 2)) - wanted) / wanted
    found = ", ".join(f"h/eps = {q:g}: {power[q]:.2f} ({last[q]:.2g})" for q in power)
    return statement(
        "P-C1.overlap",
        apart and close,
        f"Gaussian (20), h and eps refined together, power of eps (and error at the finest): {found}. At h = eps the "
        f"error ends at {floor:.1e} of f''. A kernel whose moments are met on the lattice converges with "
        f"h/eps = {1.0 / coarse:.3g} too, order {order:.2f}: as (27) does, the exception of Sec. 3.1.",
        "The sum converges without overlap, or does not with it.",
    )
