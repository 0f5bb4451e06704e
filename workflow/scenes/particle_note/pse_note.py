"""The lecture note "Particle Approximations": point and smooth particles, kernels from moment conditions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.pse import (
    GAUSSIAN_20,
    GaussianKernel,
    Kernel,
    construct,
    construct_laplacian,
    derivative,
    lattice,
    moment,
    reconstruct,
    required_moments,
)
from fracparticles.pse.construction import taylor_constant
from fracparticles.pse.moments import absolute_moment
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, observed_order, statement

__all__ = ["note_kernels", "note_particles", "second_derivative_error", "wave"]

FloatArray = np.ndarray
_EPS = float(np.finfo(float).eps)
_HIGHEST = 12  # the moments that "for all k > 3" is checked up to


def wave(x: FloatArray, kappa: float = 1.0, order: int = 0) -> FloatArray:
    """The derivative of cos(kappa x) of that order; its maximum is kappa^order."""
    return kappa**order * np.cos(kappa * x + 0.5 * np.pi * order)


# --- Fig. 1 ---------------------------------------------------------------------------------------


def two_bumps(x: FloatArray) -> FloatArray:
    """A smooth function with no symmetry, so that f(y) and f(-y) differ."""
    return np.exp(-((x - 1.0) ** 2)) + 0.6 * np.exp(-2.0 * (x + 1.2) ** 2)


def note_particles(inputs: Inputs) -> Result:
    """Point particles (8) and smooth particles (9) with the Gaussian of Fig. 1, unit mass and as (10) prints it.

    The kernel (10) has unit mass with 1/(sqrt(2 pi) eps); 1/sqrt(2 pi eps) makes it sqrt(eps), and the sum with it
    sqrt(eps) f. Point particles: (9) with eps = h/20, and the sums of the particles against the integral.
    """
    h, width = float(inputs.parameters["spacing"]), float(inputs.parameters["half_width"])
    particles = lattice(-width, width, h)
    x = np.linspace(-0.6 * width, 0.6 * width, 601)
    rows, series = [], []
    # (10) is exp(-x^2 / (2 eps^2)): the Gaussian exp(-z^2) of radius sqrt(2) eps.
    unit = GaussianKernel((Fraction(1),))
    for ratio in inputs.parameters["overlap"]:
        epsilon = ratio * h
        smooth = reconstruct(x, particles, two_bumps(particles), h, np.sqrt(2.0) * epsilon, unit)
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
    exact = pd.DataFrame({"panel": "exact", "x": x, "y": two_bumps(x)})
    points = pd.DataFrame({"panel": "points", "x": particles, "y": two_bumps(particles)})
    table = pd.DataFrame(rows)
    return Result(
        table,
        _particle_findings(h, particles, table),
        pd.concat([points, exact, *series], ignore_index=True),
    )


def _particle_findings(h: float, particles: FloatArray, table: pd.DataFrame) -> list[Finding]:
    values = two_bumps(particles)
    unit = GaussianKernel((Fraction(1),))
    between = 0.5 * (particles[1:] + particles[:-1])
    thin = reconstruct(between, particles, values, h, h / 20.0, unit)
    peak = reconstruct(particles, particles, values, h, h / 20.0, unit).max()
    mass = (1.0 + 0.6 / np.sqrt(2.0)) * np.sqrt(np.pi)
    missed = abs(h * values.sum() / mass - 1.0)
    best = table.loc[table["largest error, unit mass"].idxmin()]
    printed = table.iloc[-1]
    y = 1.0
    z, w = np.polynomial.hermite.hermgauss(40)
    limit = float(two_bumps(1e-4 * z - y) @ w) / np.sqrt(np.pi)
    norm = _mass_as_printed(printed["ε"])
    return [
        statement(
            "P-F1.points",
            bool(np.abs(thin).max() < 1e-12 * peak and missed < 1e-6),
            f"With eps = h/20 the sum (9) is {np.abs(thin).max():.1g} half-way between the particles and "
            f"{peak:.3g} at the greatest; the particles still carry the integral of f, to {max(missed, _EPS):.1g}.",
            "The sum does not vanish between the particles, or misses the integral.",
        ),
        statement(
            "P-F1.smooth",
            bool(best["largest error, unit mass"] < 0.1 * two_bumps(between).max()),
            f"Sum (9) with the Gaussian of unit mass: largest error {best['largest error, unit mass']:.2g} at "
            f"eps = {best['ε/h']:g} h, of a maximum of {two_bumps(between).max():.3g}.",
            "The error exceeds a tenth of the maximum of f.",
        ),
        statement(
            "P-F1.kernel",
            abs(norm - 1.0) < 1e-12,
            f"The kernel as printed has mass {norm:.6f} = sqrt(eps) at eps = {printed['ε']:g}, and the sum is off by "
            f"{printed['largest error, as printed']:.3g}; with 1/(sqrt(2 pi) eps) by "
            f"{printed['largest error, unit mass']:.2g}.",
            "eps belongs outside the root: 1/(sqrt(2 pi) eps); else (5) holds for eps = 1 only.",
        ),
        statement(
            "P-F1.sifting",
            abs(limit - two_bumps(np.array(y))) < 1e-6,
            f"At y = {y:g}, with a Gaussian of radius 1e-4 for delta: int f(x - y) delta(x) dx = {limit:.6f}; "
            f"f(y) = {two_bumps(np.array(y)):.6f}, f(-y) = {two_bumps(np.array(-y)):.6f}.",
            "At x = 0 the integrand is f(-y); f(y) takes f(y - x) in the integral.",
        ),
    ]


def _mass_as_printed(epsilon: float) -> float:
    """The integral of exp(-x^2 / (2 eps^2)) / sqrt(2 pi eps), by the trapezoidal rule (exact to round-off)."""
    x = epsilon * np.linspace(-10.0, 10.0, 201)
    kernel = np.exp(-(x**2) / (2.0 * epsilon**2)) / np.sqrt(2.0 * np.pi * epsilon)
    return float(kernel.sum() * (x[1] - x[0]))


# --- Sec. 2.2, 2.3 --------------------------------------------------------------------------------


def note_kernels(inputs: Inputs) -> Result:
    """Kernels for derivatives beta with accuracy r from the moment conditions, and Laplacians in 2-D and 3-D.

    A kernel meets its conditions if every M_k, by quadrature, is the one required to 1e-9 of int |z^k eta| dz.
    (21) is second order if its error on a lattice, the overlap large enough to make the quadrature exact, falls
    with a power of eps between 1.95 and 2.05 and with the constant M_4 / 4! to 1 %.
    """
    rows, series = [], []
    z = np.linspace(-4.0, 4.0, 401)
    for beta in inputs.parameters["derivative"]:
        for r in inputs.parameters["accuracy"]:
            kernel = construct(beta, r)
            rows.append({"derivative": f"order {beta}", "r": r, **_quality(kernel, beta, r)})
            series.append(
                pd.DataFrame({"beta": beta, "r": r, "x": z, "y": kernel(z)}),
            )
    for dim in (2, 3):
        for r in inputs.parameters["accuracy"]:
            kernel = construct_laplacian(r, dim)
            rows.append({"derivative": f"Laplacian, {dim}-D", "r": r, **_quality(kernel)})
    table = pd.DataFrame(rows)
    return Result(table, _kernel_findings(inputs, table), pd.concat(series, ignore_index=True))


def _quality(kernel: GaussianKernel, beta: int = 2, accuracy: int = 2) -> dict[str, Any]:
    """What the table says of a kernel; moments by quadrature in one dimension only."""
    known: dict[str, Any] = {
        "η · π^(d/2) exp(z²)": _polynomial(kernel),
        "conditions solved": len(kernel.coefficients),
        "condition number": kernel.condition,
    }
    if kernel.dim > 1:
        return known
    worst = max(
        abs(moment(kernel, k) - wanted) / absolute_moment(kernel, k)
        for k, wanted in required_moments(beta, accuracy).items()
    )
    return {
        **known,
        "largest error of a moment": worst,
        "C₁ = |M_(β+r)| / (β+r)!": abs(float(taylor_constant(kernel, beta, accuracy))),
    }


def _polynomial(kernel: GaussianKernel) -> str:
    terms = []
    for j, c in enumerate(kernel.coefficients):
        power = kernel.parity + 2 * j
        factor = {0: "", 1: " z"}.get(power, f" z^{power}")
        sign = "-" if c < 0 else "+"
        terms.append(f"{sign} {abs(c)}{factor}")
    return " ".join(terms).removeprefix("+ ")


def _kernel_findings(inputs: Inputs, table: pd.DataFrame) -> list[Finding]:
    errors = {
        k: abs(moment(GAUSSIAN_20, k) - wanted) for k, wanted in required_moments(2, 2).items()
    }
    highest = max(absolute_moment(GAUSSIAN_20, k) for k in range(4, _HIGHEST + 1))
    h = np.array(inputs.parameters["spacing"], dtype=float)
    overlap = float(inputs.parameters["overlap"])
    error = np.array([second_derivative_error(GAUSSIAN_20, s, overlap) for s in h])
    order = observed_order(h, error)[-1]
    constant = error[-1] / (overlap * h[-1]) ** 2
    expected = float(taylor_constant(GAUSSIAN_20, 2, 2))
    line = table[~table["derivative"].str.contains("Lap")]
    worst = line["largest error of a moment"].max()
    hardest = line.loc[line["condition number"].idxmax()]
    same = construct(2, 2).coefficients == GAUSSIAN_20.coefficients
    return [
        statement(
            "P-C2.moments",
            max(errors.values()) < 1e-13 and bool(np.isfinite(highest)),
            f"By quadrature M_1 = {moment(GAUSSIAN_20, 1):.1g}, M_2 = {moment(GAUSSIAN_20, 2):.15g}, "
            f"M_3 = {moment(GAUSSIAN_20, 3):.1g}; all M_k up to k = {_HIGHEST} are finite, |M_k| <= {highest:.4g}.",
            "A moment is not the one required.",
        ),
        statement(
            "P-C2.order",
            bool(abs(order - 2.0) < 0.05 and abs(constant / expected - 1.0) < 0.01),
            f"Error of (21) for cos x on lattices with eps = {overlap:g} h: order {order:.3f} between the two finest; "
            f"error / eps^2 = {constant:.5f}, M_4 / 4! = {expected:g}.",
            "The error does not fall with the second power of eps.",
        ),
        statement(
            "P-C2.construction",
            bool(worst < 1e-9) and same,
            f"{len(line)} kernels for {line['derivative'].nunique()} derivatives, solved in fractions, meet every "
            f"condition to {worst:.1g} of the absolute moment; {hardest['derivative']} with r = {hardest['r']} has the "
            f"largest condition number, {hardest['condition number']:.2g}. beta = 2, r = 2 gives (20).",
            "A kernel misses a moment condition, or (20) is not the one found.",
        ),
    ]


def second_derivative_error(kernel: Kernel, h: float, overlap: float) -> float:
    """The largest error of (21) for cos x at particles of the lattice."""
    epsilon = overlap * h
    x = h * np.round(np.linspace(0.0, 2.0 * np.pi, 17) / h)
    margin = kernel.reach * epsilon
    particles = lattice(-margin, 2.0 * np.pi + margin, h)
    found = derivative(x, wave(x), particles, wave(particles), h, epsilon, kernel, 2)
    return float(np.abs(found - wave(x, order=2)).max())
