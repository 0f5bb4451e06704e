"""Fig. 1 of the lecture note "Particle Approximations": point and smooth particles."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import pandas as pd

from fracparticles.pse import GaussianKernel, cell_volumes, lattice, reconstruct
from fracparticles.run.orders import observed_order
from fracstudy.errors import off
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

_SMALL = 1e-4  # a radius that stands for zero
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
    rows, panels = [], Panels()
    panels.add("points", x=particles, y=two_bumps(particles))
    panels.add("exact", x=x, y=two_bumps(x))
    for ratio in overlap:
        epsilon = ratio * spacing
        # (10) is exp(-x^2 / (2 eps^2)): the Gaussian exp(-z^2) of radius sqrt(2) eps.
        radius = np.sqrt(2.0) * epsilon
        smooth = reconstruct(x, particles, two_bumps(particles), spacing, radius, _UNIT)
        row = {
            "ε/h": ratio,
            "ε": epsilon,
            "mass of (10) as printed": _mass_as_printed(epsilon),
            "largest error, unit mass": np.abs(smooth - two_bumps(x)).max(),
            "largest error, as printed": np.abs(np.sqrt(epsilon) * smooth - two_bumps(x)).max(),
        }
        rows.append(row)
        panels.add("smooth", overlap=ratio, x=x, y=smooth)
    table = pd.DataFrame(rows)
    findings = [
        *_delta(),
        _points(spacing, particles),
        _superposed(spacing, half_width),
        _kernel(table),
        measured("P-F1.volumes", deviation=np.abs(cell_volumes(particles) / spacing - 1.0).max()),
    ]
    return Result(table, inputs.judged(findings), panels.frame)


def _delta() -> Iterator[Finding]:
    """(4), (5), (6) with a Gaussian of small radius for the delta function."""
    z, w = np.polynomial.hermite.hermgauss(40)
    w, x, y = w / np.sqrt(np.pi), _SMALL * z, np.array([[-1.2], [-0.3], [1.0]])
    printed, meant = (two_bumps(sign * (x - y)) @ w - two_bumps(y[:, 0]) for sign in (1.0, -1.0))
    yield measured(
        "P-F1.sifting",
        printed=np.abs(printed).max(),
        meant=np.abs(meant).max(),
        mirrored=np.abs(printed + two_bumps(y[:, 0]) - two_bumps(-y[:, 0])).max(),
    )
    moments = {f"m = {m}": abs(float(x**m @ w)) for m in range(1, 7)}
    yield measured("P-F1.delta", mass=abs(w.sum() - 1.0), moments=moments)


def _points(h: float, particles: np.ndarray) -> Finding:
    """The sum (9) for ever smaller kernels: between the particles, at them, and its integral."""
    values = two_bumps(particles)
    between = 0.5 * (particles[1:] + particles[:-1])

    def largest(x: np.ndarray, epsilon: float) -> float:
        return float(np.abs(reconstruct(x, particles, values, h, epsilon, _UNIT)).max())

    peak = largest(particles, h / 20.0)
    mass = (1.0 + 0.6 / np.sqrt(2.0)) * np.sqrt(np.pi)
    return measured(
        "P-F1.points",
        between=largest(between, h / 20.0) / peak,
        missed=abs(h * values.sum() / mass - 1.0),
        growth=largest(particles, h / 40.0) / peak,
    )


def _superposed(spacing: float, half_width: float) -> Finding:
    """The largest error of the sum (9) with the Gaussian of Fig. 1 and eps = h, on three lattices."""
    errors, spacings = [], spacing / 2.0 ** np.arange(3.0)
    x = np.linspace(-0.6 * half_width, 0.6 * half_width, 601)
    for h in spacings:
        particles = lattice(-half_width, half_width, h)
        found = reconstruct(x, particles, two_bumps(particles), h, np.sqrt(2.0) * h, _UNIT)
        errors.append(off(found, two_bumps(x)))
    order = observed_order(spacings, errors)[-1]
    return measured("P-F1.smooth", order=order, error=errors[-1])


def _kernel(table: pd.DataFrame) -> Finding:
    """The mass of (10) as printed, and with the radius outside the root; the radii are those of the table."""
    last = table.iloc[-1]
    return measured(
        "P-F1.kernel",
        printed=np.abs(table["mass of (10) as printed"] - 1.0).max(),
        meant=max(abs(_mass_as_printed(e) / np.sqrt(e) - 1.0) for e in table["ε"]),
        epsilon=last["ε"],
        mass=last["mass of (10) as printed"],
        off=last["largest error, as printed"],
        off_meant=last["largest error, unit mass"],
    )


def _mass_as_printed(epsilon: float) -> float:
    """The integral of exp(-x^2 / (2 eps^2)) / sqrt(2 pi eps), by the trapezoidal rule (exact to round-off)."""
    x = epsilon * np.linspace(-10.0, 10.0, 201)
    kernel = np.exp(-(x**2) / (2.0 * epsilon**2)) / np.sqrt(2.0 * np.pi * epsilon)
    return float(kernel.sum() * (x[1] - x[0]))
