"""Fig. 1 of the lecture note "Particle Approximations": point and smooth particles."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import pandas as pd

from fracparticles.pse import GaussianKernel, lattice, reconstruct
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["study"]

_EPS = float(np.finfo(float).eps)
_UNIT = GaussianKernel((Fraction(1),))  # exp(-z^2), of unit mass


def two_bumps(x: np.ndarray) -> np.ndarray:
    """A smooth function with no symmetry, so that f(y) and f(-y) differ."""
    return np.exp(-((x - 1.0) ** 2)) + 0.6 * np.exp(-2.0 * (x + 1.2) ** 2)


def study(inputs: Inputs, *, spacing: float, half_width: float, overlap: list[float]) -> Result:
    """Point particles (8) and smooth particles (9) with the Gaussian of Fig. 1, unit mass and as (10) prints it.

    The kernel (10) has unit mass with 1/(sqrt(2 pi) eps); 1/sqrt(2 pi eps) makes it sqrt(eps), and the sum with it
    sqrt(eps) f. Point particles: (9) with eps = h/20, and the sums of the particles against the integral.
    """
    particles = lattice(-half_width, half_width, spacing)
    x = np.linspace(-0.6 * half_width, 0.6 * half_width, 601)
    points = {"panel": "points", "x": particles, "y": two_bumps(particles)}
    exact = {"panel": "exact", "x": x, "y": two_bumps(x)}
    rows, series = [], [pd.DataFrame(points), pd.DataFrame(exact)]
    for ratio in overlap:
        epsilon = ratio * spacing
        # (10) is exp(-x^2 / (2 eps^2)): the Gaussian exp(-z^2) of radius sqrt(2) eps.
        radius = np.sqrt(2.0) * epsilon
        smooth = reconstruct(x, particles, two_bumps(particles), spacing, radius, _UNIT)
        rows.append(
            {
                "ε/h": ratio,
                "ε": epsilon,
                "mass of (10) as printed": _mass_as_printed(epsilon),
                "largest error, unit mass": np.abs(smooth - two_bumps(x)).max(),
                "largest error, as printed": np.abs(np.sqrt(epsilon) * smooth - two_bumps(x)).max(),
            }
        )
        series.append(pd.DataFrame({"panel": "smooth", "overlap": ratio, "x": x, "y": smooth}))
    table = pd.DataFrame(rows)
    findings = list(_findings(spacing, particles, table)) if inputs.items else []
    return Result(table, findings, pd.concat(series, ignore_index=True))


def _findings(h: float, particles: np.ndarray, table: pd.DataFrame) -> Iterator[Finding]:
    values = two_bumps(particles)
    between = 0.5 * (particles[1:] + particles[:-1])
    gap, peak = (
        np.abs(reconstruct(x, particles, values, h, h / 20.0, _UNIT)).max()
        for x in (between, particles)
    )
    mass = (1.0 + 0.6 / np.sqrt(2.0)) * np.sqrt(np.pi)
    missed = abs(h * values.sum() / mass - 1.0)
    yield statement(
        "P-F1.points",
        gap < 1e-12 * peak and missed < 1e-6,
        f"With eps = h/20 the sum (9) is {gap:.1g} half-way between the particles and {peak:.3g} at the greatest; the "
        f"particles still carry the integral of f, to {max(missed, _EPS):.1g}.",
        "The sum does not vanish between the particles, or misses the integral.",
    )
    best, top = table.loc[table["largest error, unit mass"].idxmin()], two_bumps(between).max()
    yield statement(
        "P-F1.smooth",
        best["largest error, unit mass"] < 0.1 * top,
        f"Sum (9) with the Gaussian of unit mass: largest error {best['largest error, unit mass']:.2g} at "
        f"eps = {best['ε/h']:g} h, of a maximum of {top:.3g}.",
        "The error exceeds a tenth of the maximum of f.",
    )
    printed = table.iloc[-1]
    norm = printed["mass of (10) as printed"]
    yield statement(
        "P-F1.kernel",
        abs(norm - 1.0) < 1e-12,
        f"The kernel as printed has mass {norm:.6f} = sqrt(eps) at eps = {printed['ε']:g}, and the sum is off by "
        f"{printed['largest error, as printed']:.3g}; with 1/(sqrt(2 pi) eps) by "
        f"{printed['largest error, unit mass']:.2g}.",
        "eps belongs outside the root: 1/(sqrt(2 pi) eps); else (5) holds for eps = 1 only.",
    )
    y = np.array(1.0)
    z, w = np.polynomial.hermite.hermgauss(40)
    limit = float(two_bumps(1e-4 * z - y) @ w) / np.sqrt(np.pi)
    yield statement(
        "P-F1.sifting",
        abs(limit - two_bumps(y)) < 1e-6,
        f"At y = {y:g}, with a Gaussian of radius 1e-4 for delta: int f(x - y) delta(x) dx = {limit:.6f}; "
        f"f(y) = {two_bumps(y):.6f}, f(-y) = {two_bumps(-y):.6f}.",
        "At x = 0 the integrand is f(-y); f(y) takes f(y - x) in the integral.",
    )


def _mass_as_printed(epsilon: float) -> float:
    """The integral of exp(-x^2 / (2 eps^2)) / sqrt(2 pi eps), by the trapezoidal rule (exact to round-off)."""
    x = epsilon * np.linspace(-10.0, 10.0, 201)
    kernel = np.exp(-(x**2) / (2.0 * epsilon**2)) / np.sqrt(2.0 * np.pi * epsilon)
    return float(kernel.sum() * (x[1] - x[0]))
