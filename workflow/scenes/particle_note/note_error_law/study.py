"""The error law of the lecture note, C_1 eps^r + C_2 (h/eps)^m (Sec. 2.2), its two terms measured one by one."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.pse import (
    GAUSSIAN_20,
    GaussianKernel,
    Kernel,
    SplineKernel,
    construct,
    derivative,
    lattice,
    lattice_moment,
    moment,
    reconstruct,
    regularised,
    required_moments,
)
from fracparticles.pse.construction import taylor_constant
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.particle_note.pse_note import wave

__all__ = ["study"]

_ROUND_POWER = 0.1  # how far a measured power may be from the one it is held against


def study(inputs: Inputs) -> Result:
    """Powers and constants of the two terms for cos(kappa x), whose norms are powers of kappa.

    The integral (18), by a Gauss rule, against the derivative is the error of regularisation; the sum (21) at
    particles of a lattice against the integral is the error of quadrature. Powers of eps, h / eps and kappa are
    those between neighbouring levels; for h / eps the power is fitted through the maxima, for the error swings.
    A power counts as met within 0.1, a constant within 5 %. Predicted are C_1 = |M_(beta+r)| / (beta+r)! with
    kappa^(beta+r), and for beta = 2 the relative error of the discrete moment, |M^_2 - 2| / 2 with kappa^2.
    """
    first, lines = _regularisation(inputs)
    second, waves = _quadrature(inputs)
    third = _prefactor(inputs)
    total = _total(inputs)
    table = pd.concat([first, second, third], ignore_index=True)
    findings = [
        *_findings_of_regularisation(first),
        *_findings_of_quadrature(inputs, second),
        _finding_of_law(inputs, third),
        _finding_of_overlap(inputs),
    ]
    return Result(table, findings, pd.concat([lines, waves, total], ignore_index=True))


# --- C_1 eps^r ------------------------------------------------------------------------------------


def _regularisation(inputs: Inputs) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Rows and lines of the error of the integral (18), for each beta and r."""
    radii = np.array(inputs.parameters["epsilon"], dtype=float)
    rows, lines = [], []
    for beta in inputs.parameters["derivative"]:
        for r in inputs.parameters["accuracy"]:
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
            lines.append(
                pd.DataFrame({"panel": "regularisation", "beta": beta, "r": r, "x": radii}).assign(
                    y=error / constant
                )
            )
    return pd.DataFrame(rows), pd.concat(lines)


def _integral_error(kernel: Kernel, epsilon: float, beta: int, kappa: float = 1.0) -> float:
    """The largest error of the integral (18), or (9) for beta = 0, for cos(kappa x) over a period."""
    x = np.linspace(0.0, 2.0 * np.pi, 17) / kappa
    found = regularised(lambda y: wave(y, kappa), x, epsilon, kernel, beta)
    return float(np.abs(found - wave(x, kappa, beta)).max())


def _findings_of_regularisation(rows: pd.DataFrame) -> list[Finding]:
    off = (rows["power"] - rows["predicted power"]).abs().max()
    ratio = (rows["constant"] / rows["predicted constant"] - 1.0).abs().max()
    printed = rows["power of κ"] - rows["power of κ, printed"]
    ours = (printed - rows["derivative"]).abs().max()
    derivatives = rows["derivative"] > 0
    example = rows[derivatives].iloc[-1]
    return [
        statement(
            "P-C1.regularisation",
            bool(off < _ROUND_POWER and ratio < 0.05),
            f"{len(rows)} kernels, beta = {rows['derivative'].min()} to {rows['derivative'].max()}: the power of eps "
            f"is r within {off:.2g}, and the constant is |M_(beta+r)| / (beta+r)! within {100.0 * ratio:.2g} %.",
            "A power or a constant is another.",
        ),
        statement(
            "P-C1.regularisation_norm",
            bool(printed[derivatives].abs().max() < _ROUND_POWER),
            f"For cos(kappa x) the error grows as kappa^(beta+r), within {ours:.2g} in the exponent for all "
            f"{len(rows)} kernels: kappa^{example['power of κ']:.2f} for beta = {example['derivative']}, "
            f"r = {example['predicted power']:g}.",
            "The first term left over in (17) has f^(beta+r), so that the norm is that of f^(beta+r); f^(r) is right "
            "for the function itself, beta = 0, only.",
        ),
    ]


# --- C_2 (h/eps)^m --------------------------------------------------------------------------------


def _quadrature(inputs: Inputs) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Rows and lines of the error of the sum (21) against the integral (18), for f'' at a fixed radius."""
    epsilon = float(inputs.parameters["radius"])
    last, count = inputs.parameters["overlap"]
    overlap = np.linspace(1.0, last, count)
    kernels: dict[str, Kernel] = {
        f"spline, degree {q}": SplineKernel(q) for q in inputs.parameters["degree"]
    }
    rows, lines = [], []
    for name, kernel in [*kernels.items(), ("Gaussian (20)", GAUSSIAN_20)]:
        error = np.array([_sum_error(kernel, epsilon, epsilon / s, 2) for s in overlap])
        relative = np.abs(lattice_moment(kernel, 2, overlap) - 2.0) / 2.0
        known = {"term": "quadrature", "derivative": 2, "kernel": name, "power of": "h/ε"}
        known |= {"power of κ": _kappa_power(kernel, epsilon, 2)}
        if isinstance(kernel, SplineKernel):
            m = kernel.degree + 1.0
            constant = float((overlap**m * error).max())
            known |= {
                "predicted power": m,
                "power": -_power_of_maxima(overlap, error),
                "predicted constant": float((overlap**m * relative).max()),
                "constant": constant,
                "power of κ, printed": m,
            }
            bound = pd.DataFrame({"panel": "bound", "series": name, "x": 1.0 / overlap})
            lines.append(bound.assign(y=constant * overlap**-m))
        else:
            # Any power: what is left of the error from one overlap to the next is no power.
            known |= {
                "power": float(np.log2(error[0] / _sum_error(kernel, epsilon, epsilon / 2.0, 2)))
            }
        rows.append(known)
        lines.append(
            pd.DataFrame({"panel": "quadrature", "series": name, "x": 1.0 / overlap, "y": error})
        )
    return pd.DataFrame(rows), pd.concat(lines)


def _sum_error(kernel: Kernel, epsilon: float, h: float, beta: int, kappa: float = 1.0) -> float:
    """The largest difference of the sum and the integral (18) for cos(kappa x), at particles of the lattice."""
    x, found = _sum(kernel, epsilon, h, beta, kappa)
    integral = regularised(lambda y: wave(y, kappa), x, epsilon, kernel, beta)
    return float(np.abs(found - integral).max())


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
    return x, derivative(x, at, particles, f, h, epsilon, kernel, beta)


def _kappa_power(kernel: Kernel, epsilon: float, beta: int, overlap: float = 1.5) -> float:
    single, double = (
        _sum_error(kernel, epsilon, epsilon / overlap, beta, kappa) for kappa in (0.5, 1.0)
    )
    return float(np.log2(double / single))


def _findings_of_quadrature(inputs: Inputs, rows: pd.DataFrame) -> list[Finding]:
    splines = rows.dropna(subset="predicted power")
    gauss = rows[rows["predicted power"].isna()].iloc[0]
    off = (splines["power"] - splines["predicted power"]).abs().max()
    ratio = (splines["constant"] / splines["predicted constant"] - 1.0).abs().max()
    powers = ", ".join(
        f"{p:.2f} (degree {p0 - 1:g})"
        for p, p0 in zip(splines["power"], splines["predicted power"], strict=True)
    )
    misses = (splines["power of κ"] - splines["power of κ, printed"]).abs().max()
    ones = _error_of_one(inputs)
    return [
        statement(
            "P-C1.quadrature",
            bool(off < _ROUND_POWER and ratio < 0.05),
            f"Powers of h/eps for B-splines: {powers}: m = degree + 1, as smooth as the kernel is; the constant is "
            f"that of the discrete moment M^_2 within {100.0 * ratio:.2g} %. The Gaussian (20) falls faster than any "
            f"power: by 2^{gauss['power']:.0f} from eps = h to 2 h.",
            "A power or a constant is another.",
        ),
        statement(
            "P-C1.quadrature_norm",
            bool(misses < _ROUND_POWER),
            f"At fixed eps and h the error for cos(kappa x) grows as kappa^{splines['power of κ'].min():.2f} to "
            f"kappa^{splines['power of κ'].max():.2f} whatever m is "
            f"({', '.join(f'{m:g}' for m in splines['predicted power'])}); for f = 1, where f^(m) = 0, the sum (9) "
            f"with the spline of degree 1 is off by {ones:.2g} at eps = 1.5 h.",
            "The lattice sees a wrong moment of the kernel, so that the error is proportional to the function or to "
            "its derivative of order beta; the norm must hold all derivatives up to m, not the m-th alone.",
        ),
    ]


def _error_of_one(inputs: Inputs) -> float:
    """The largest error of (9) for f = 1, by the spline of degree 1 at eps = 1.5 h."""
    epsilon = float(inputs.parameters["radius"])
    h, kernel = epsilon / 1.5, SplineKernel(1)
    particles = lattice(-2.0 * epsilon, 2.0 * epsilon + h, h)
    x = np.linspace(0.0, h, 21)
    mass = moment(kernel, 0)
    found = reconstruct(x, particles, np.ones_like(particles), h, epsilon, kernel) / mass
    return float(np.abs(found - 1.0).max())


# --- both -----------------------------------------------------------------------------------------


def _prefactor(inputs: Inputs) -> pd.DataFrame:
    """The error of quadrature at a fixed h / eps, as a power of eps: nil says the law, for every beta."""
    radii = np.array(inputs.parameters["epsilon"], dtype=float)
    overlap = float(inputs.parameters["coarse"])
    rows = []
    for beta in inputs.parameters["derivative"]:
        if beta == 0:
            continue
        kernel = construct(beta, 2)
        error = np.array([_sum_error(kernel, e, e / overlap, beta) for e in radii])
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
                "power of κ": _kappa_power(kernel, float(radii[-1]), beta, overlap),
            }
        )
    return pd.DataFrame(rows)


def _finding_of_law(inputs: Inputs, rows: pd.DataFrame) -> Finding:
    powers = ", ".join(
        f"{p:.2f} (beta = {beta})"
        for p, beta in zip(rows["power"], rows["derivative"], strict=True)
    )
    return statement(
        "P-C1.law",
        bool(rows["power"].abs().max() < _ROUND_POWER),
        f"The error of quadrature at fixed h/eps = {1.0 / float(inputs.parameters['coarse']):.3g} goes with eps to "
        f"the power {powers}: the law holds for beta <= 2.",
        "The factor eps^-beta in (18) multiplies the quadrature error too: from beta = 3 on, a wrong discrete moment "
        "of order 1 or 2 leaves a term with eps^(1-beta) or eps^(2-beta), and the sum diverges at fixed h/eps.",
    )


def _total(inputs: Inputs) -> pd.DataFrame:
    """The error of (21) with (20), and with the moments met on the lattice, for several h."""
    parts = []
    radii = np.geomspace(*inputs.parameters["radii"])
    for h in inputs.parameters["spacing"]:
        error = [_sum_against_derivative(GAUSSIAN_20, epsilon, h) for epsilon in radii]
        parts.append(pd.DataFrame({"panel": "total", "series": str(h), "x": radii, "y": error}))
    overlap = float(inputs.parameters["coarse"])
    corrected = construct(2, 2, overlap)
    spacing = np.array(inputs.parameters["spacing"], dtype=float)
    error = [_sum_against_derivative(corrected, overlap * h, h) for h in spacing]
    parts.append(
        pd.DataFrame({"panel": "total", "series": "lattice", "x": overlap * spacing, "y": error})
    )
    return pd.concat(parts, ignore_index=True)


def _sum_against_derivative(kernel: GaussianKernel, epsilon: float, h: float) -> float:
    x, found = _sum(kernel, epsilon, h, 2)
    return float(np.abs(found - wave(x, order=2)).max())


def _finding_of_overlap(inputs: Inputs) -> Finding:
    """Errors of (21) with (20) at a fixed h / eps on ever finer lattices, until the error of quadrature is left."""
    radii = 0.125 * np.array(inputs.parameters["epsilon"], dtype=float)
    power, last = {}, {}
    for ratio in inputs.parameters["ratio"]:
        error = np.array([_sum_against_derivative(GAUSSIAN_20, e, ratio * e) for e in radii])
        power[ratio], last[ratio] = _power(radii, error), error[-1]
    apart = [ratio for ratio in power if ratio >= 1.0]
    close = [ratio for ratio in power if ratio <= 0.5]
    coarse = float(inputs.parameters["coarse"])
    kernel = construct(2, 2, coarse)
    error = np.array([_sum_against_derivative(kernel, e, e / coarse) for e in radii])
    wanted = required_moments(2, 2)[2]
    floor = abs(float(lattice_moment(GAUSSIAN_20, 2)) - wanted) / wanted
    return statement(
        "P-C1.overlap",
        bool(
            all(power[ratio] < 0.5 for ratio in apart)
            and all(abs(power[ratio] - 2.0) < _ROUND_POWER for ratio in close)
        ),
        "Gaussian (20), h and eps refined together, power of eps (and error at the finest): "
        + ", ".join(f"h/eps = {ratio:g}: {power[ratio]:.2f} ({last[ratio]:.2g})" for ratio in power)
        + f". At h = eps the error ends at {floor:.1e} of f''. A kernel whose moments are met on the lattice converges "
        f"with h/eps = {1.0 / coarse:.3g} too, order {_power(radii, error):.2f}: as (27) does, the exception of "
        "Sec. 3.1.",
        "The sum converges without overlap, or does not with it.",
    )


def _power(x: np.ndarray, error: np.ndarray) -> float:
    """The power of x between the two finest levels."""
    return float(np.log(error[-2] / error[-1]) / np.log(x[-2] / x[-1]))


def _power_of_maxima(x: np.ndarray, y: np.ndarray) -> float:
    """The power of x >= 2 fitted through the maxima of y in [2, 3), [3, 4), ...; through all points if there are few.

    The error of a spline is a function of the period 1 in x = eps / h, times that power.
    """
    chosen = [
        int(np.argmax(np.where((x >= n) & (x < n + 1.0), y, -np.inf))) for n in range(2, int(x[-1]))
    ]
    if len(chosen) < 3:
        chosen = list(range(x.size))
    return float(np.polyfit(np.log(x[chosen]), np.log(y[chosen]), 1)[0])
