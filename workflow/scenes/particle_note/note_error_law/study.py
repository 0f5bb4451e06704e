"""The error law of the lecture note, C_1 eps^r + C_2 (h/eps)^m (Sec. 2.2), its two terms measured one by one."""

from collections.abc import Iterator
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles import pse
from fracparticles.pse import GAUSSIAN_20, Kernel, SplineKernel, construct, lattice, regularised
from fracparticles.pse import derivative as derivative_by_sum
from fracparticles.pse.construction import taylor_constant
from fracparticles.run.orders import observed_order
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import fitted_power
from fracstudy.panels import Panels
from scenes.particle_note.waves import wave


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
    Predicted are C_1 = |M_(beta+r)| / (beta+r)! with kappa^(beta+r), and for beta = 2 the relative error of the
    discrete moment, |M^_2 - 2| / 2 with kappa^2.

    The regularisation is measured for the orders `derivative`, the accuracies and the radii `epsilon`; the quadrature
    for splines of the degrees at one `radius`, with `overlap` the largest eps / h and the number of them; both
    together for the `radii` (first, last, number) and each `spacing`. `coarse` is an eps / h without overlap, and
    `ratio` holds those h / eps at which h and eps are refined together.
    """
    panels = Panels()
    first = _regularisation(panels, derivative, accuracy, epsilon)
    overlaps = np.linspace(1.0, overlap[0], int(overlap[1]))
    second = _quadrature(panels, degree, radius, overlaps)
    third = _prefactor([beta for beta in derivative if beta > 0], epsilon, coarse)
    _total(panels, np.geomspace(radii[0], radii[1], int(radii[2])), spacing, coarse)
    table = pd.concat([first, second, third], ignore_index=True)
    findings = [
        *_of_regularisation(first),
        *_of_quadrature(second, radius),
        _of_law(third, coarse),
        _of_overlap(0.125 * np.array(epsilon), ratio, coarse),
    ]
    return Result(table, inputs.judged(findings), panels.frame)


def _power(x: Any, error: Any) -> float:
    """The power of x between the two finest levels."""
    return float(observed_order(x, error)[-1])


# --- C_1 eps^r ------------------------------------------------------------------------------------


def _regularisation(
    panels: Panels, derivative: list[int], accuracy: list[int], radii: list[float]
) -> pd.DataFrame:
    """Rows and lines of the error of the integral (18), for each beta and r."""
    rows = []
    for beta, r in product(derivative, accuracy):
        kernel = construct(beta, r)
        constant = abs(float(taylor_constant(kernel, beta, r)))
        error = np.array([_integral_error(kernel, epsilon, beta) for epsilon in radii])
        doubled = _integral_error(kernel, radii[-1], beta, kappa=2.0)
        row = {
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
        rows.append(row)
        panels.add("regularisation", beta=beta, r=r, x=radii, y=error / constant)
    return pd.DataFrame(rows)


def _integral_error(kernel: Kernel, epsilon: float, beta: int, kappa: float = 1.0) -> float:
    """The largest error of the integral (18), or (9) for beta = 0, for cos(kappa x) over a period."""
    x = np.linspace(0.0, 2.0 * np.pi, 17) / kappa
    found = regularised(lambda y: wave(y, kappa), x, epsilon, kernel, beta)
    return float(np.abs(found - wave(x, kappa, beta)).max())


def _off(rows: pd.DataFrame) -> tuple[pd.Series, pd.Series]:
    """How far powers are from the predicted ones, and constants, relatively."""
    power = (rows["power"] - rows["predicted power"]).abs()
    return power, (rows["constant"] / rows["predicted constant"] - 1.0).abs()


def _of_regularisation(rows: pd.DataFrame) -> Iterator[Finding]:
    rows = rows.assign(beta=rows["derivative"], r=rows["predicted power"].astype(int))
    rows = rows.set_index(["beta", "r"])
    power, constant = _off(rows)
    yield measured("P-C1.regularisation", power=power, constant=constant)
    off, beta = (rows["power of κ"] - rows["power of κ, printed"]).abs(), rows["derivative"]
    numbers = {"printed": off[beta > 0], "meant": (off - beta).abs()[beta > 0]}
    yield measured("P-C1.regularisation_norm", **numbers, function=off[beta == 0].max())


# --- C_2 (h/eps)^m --------------------------------------------------------------------------------


def _quadrature(
    panels: Panels, degree: list[int], epsilon: float, overlap: np.ndarray
) -> pd.DataFrame:
    """Rows and lines of the error of the sum (21) against the integral (18), for f'' at a fixed radius."""
    kernels: dict[str, Kernel] = {f"spline, degree {q}": SplineKernel(q) for q in degree}
    rows = []
    for name, kernel in [*kernels.items(), ("Gaussian (20)", GAUSSIAN_20)]:
        error = np.array([_sum_error(kernel, epsilon, epsilon / s, 2) for s in overlap])
        relative = np.abs(pse.lattice_moment(kernel, 2, overlap) - 2.0) / 2.0
        row: dict[str, Any] = {"term": "quadrature", "derivative": 2, "kernel": name}
        row["power of"] = "h/ε"
        row["power of κ"] = _kappa_power(kernel, epsilon, 2)
        if isinstance(kernel, SplineKernel):
            m = kernel.degree + 1.0
            row["power of κ, printed"] = row["predicted power"] = m
            row["power"] = -_power_of_maxima(overlap, error)
            row["predicted constant"] = float((overlap**m * relative).max())
            row["constant"] = float((overlap**m * error).max())
            panels.add("bound", name, 1.0 / overlap, row["constant"] * overlap**-m)
        else:
            # Any power: what is left of the error from one overlap to the next is no power.
            finer = _sum_error(kernel, epsilon, epsilon / 2.0, 2)
            row["power"] = float(np.log2(error[0] / finer))
        rows.append(row)
        panels.add("quadrature", name, 1.0 / overlap, error)
    return pd.DataFrame(rows)


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
    single, double = (_sum_error(kernel, epsilon, epsilon / overlap, beta, k) for k in (0.5, 1.0))
    return float(np.log2(double / single))


def _power_of_maxima(x: np.ndarray, y: np.ndarray) -> float:
    """The power of x >= 2 fitted through the maxima of y in [2, 3), [3, 4), ...; through all points if there are few.

    The error of a spline is a function of the period 1 in x = eps / h, times that power.
    """
    whole = range(2, int(x[-1]))
    chosen = [int(np.argmax(np.where((x >= n) & (x < n + 1.0), y, -np.inf))) for n in whole]
    if len(chosen) < 3:
        chosen = list(range(x.size))
    return fitted_power(x[chosen], y[chosen])


def _of_quadrature(rows: pd.DataFrame, epsilon: float) -> Iterator[Finding]:
    splines = rows.dropna(subset="predicted power")
    splines = splines.set_index(splines["predicted power"].rename("m"))
    power, constant = _off(splines)
    gauss = round(float(rows.loc[rows["predicted power"].isna(), "power"].iloc[0]))
    numbers = {"power": splines["power"], "constant": constant, "gauss": gauss}
    yield measured("P-C1.quadrature", off=power, **numbers)

    def residual(m: float) -> float:
        """The largest error for a power of x below the m-th, whose m-th derivative is zero."""
        kernel = SplineKernel(int(m) - 1)
        return max(_error_of_power(kernel, epsilon, k) for k in range(1, int(m)))

    norms = {"kappa": splines["power of κ"], "one": _error_of_one(epsilon)}
    yield measured("P-C1.quadrature_norm", residual=each(residual, m=splines.index), **norms)


def _error_of_power(kernel: Kernel, epsilon: float, k: int) -> float:
    """The sum (21) against the integral (18) for x^k at x = eps, eps = 1.5 h, over eps^(k-2)."""
    h = epsilon / 1.5
    reach = kernel.reach * epsilon + h
    x, particles = np.array([epsilon]), epsilon + lattice(-reach, reach, h)
    found = derivative_by_sum(x, x**k, particles, particles**k, h, epsilon, kernel, 2)
    integral = regularised(lambda y: y**k, x, epsilon, kernel, 2)
    return float(np.abs(found - integral)[0]) / epsilon ** (k - 2)


def _error_of_one(epsilon: float) -> float:
    """The largest error of (9) for f = 1, by the spline of degree 1 at eps = 1.5 h."""
    h, kernel = epsilon / 1.5, SplineKernel(1)
    particles = lattice(-2.0 * epsilon, 2.0 * epsilon + h, h)
    x = np.linspace(0.0, h, 21)
    mass = pse.moment(kernel, 0)
    found = pse.reconstruct(x, particles, np.ones_like(particles), h, epsilon, kernel) / mass
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
        row = {
            "term": f"quadrature, h = {1.0 / overlap:.3g} ε",
            "derivative": beta,
            "kernel": "Gaussian, r = 2",
            "power of": "ε",
            "predicted power": float(lowest - beta),
            "power": _power(radii, error),
            "power of κ": _kappa_power(kernel, radii[-1], beta, overlap),
        }
        rows.append(row)
    return pd.DataFrame(rows)


def _of_law(rows: pd.DataFrame, coarse: float) -> Finding:
    power = rows.set_index(rows["derivative"].rename("beta"))["power"]
    return measured("P-C1.law", off=power.abs(), power=power, ratio=1.0 / coarse)


def _total(panels: Panels, radii: np.ndarray, spacing: list[float], coarse: float) -> None:
    """The error of (21) with (20), and with the moments met on the lattice, for several h."""
    for h in spacing:
        error = [_sum_against_derivative(GAUSSIAN_20, epsilon, h) for epsilon in radii]
        panels.add("total", str(h), radii, error)
    corrected = construct(2, 2, coarse)
    error = [_sum_against_derivative(corrected, coarse * h, h) for h in spacing]
    panels.add("total", "lattice", coarse * np.array(spacing), error)


def _sum_against_derivative(kernel: Kernel, epsilon: float, h: float) -> float:
    x, found = _sum(kernel, epsilon, h, 2)
    return float(np.abs(found - wave(x, order=2)).max())


def _of_overlap(radii: np.ndarray, ratios: list[float], coarse: float) -> Finding:
    """Errors of (21) with (20) at a fixed h / eps on ever finer lattices, until the error of quadrature is left."""

    def of_ratio(ratio: float) -> list[float]:
        return [_sum_against_derivative(GAUSSIAN_20, e, ratio * e) for e in radii]

    errors = each(of_ratio, **{"h/eps": ratios})
    power = errors.map(partial(_power, radii))
    corrected = construct(2, 2, coarse)
    wanted = pse.required_moments(2, 2)[2]
    return measured(
        "P-C1.overlap",
        apart=power[power.index >= 1.0],
        close=(power[power.index <= 0.5] - 2.0).abs(),
        power=power,
        last=errors.str[-1],
        floor=abs(float(pse.lattice_moment(GAUSSIAN_20, 2)) - wanted) / wanted,
        ratio=1.0 / coarse,
        corrected=_power(radii, [_sum_against_derivative(corrected, e, e / coarse) for e in radii]),
    )
