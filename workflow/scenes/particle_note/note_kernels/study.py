"""Kernels from moment conditions (Sec. 2.2, 2.3 of the lecture note)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.pse import (
    GAUSSIAN_20,
    GaussianKernel,
    construct,
    construct_laplacian,
    moment,
    required_moments,
)
from fracparticles.pse.construction import taylor_constant
from fracparticles.pse.moments import absolute_moment
from fracparticles.run.orders import observed_order
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.particle_note.waves import second_derivative_error

__all__ = ["study"]

_HIGHEST = 12  # the moments that "for all k > 3" is checked up to


def study(
    inputs: Inputs,
    *,
    derivative: list[int],
    accuracy: list[int],
    spacing: list[float],
    overlap: float,
) -> Result:
    """Kernels for derivatives beta with accuracy r from the moment conditions, and Laplacians in 2-D and 3-D.

    A kernel meets its conditions if every M_k, by quadrature, is the one required to 1e-9 of int |z^k eta| dz.
    (21) is second order if its error on a lattice, the overlap large enough to make the quadrature exact, falls
    with a power of eps between 1.95 and 2.05 and with the constant M_4 / 4! to 1 %.
    """
    rows, series = [], []
    z = np.linspace(-4.0, 4.0, 401)
    for beta, r in product(derivative, accuracy):
        kernel = construct(beta, r)
        series.append(pd.DataFrame({"beta": beta, "r": r, "x": z, "y": kernel(z)}))
        errors = _moment_errors(kernel, beta, r)
        row = {"derivative": f"order {beta}", "r": r, **_solved(kernel)}
        row["largest error of a moment"] = max(
            error / absolute_moment(kernel, k) for k, error in errors.items()
        )
        row["C₁ = |M_(β+r)| / (β+r)!"] = abs(float(taylor_constant(kernel, beta, r)))
        rows.append(row)
    line = pd.DataFrame(rows)
    for dim, r in product((2, 3), accuracy):
        name = f"Laplacian, {dim}-D"
        rows.append({"derivative": name, "r": r, **_solved(construct_laplacian(r, dim))})
    findings = list(_findings(line, spacing, overlap)) if inputs.items else []
    return Result(pd.DataFrame(rows), findings, pd.concat(series, ignore_index=True))


def _solved(kernel: GaussianKernel) -> dict[str, Any]:
    return {
        "η · π^(d/2) exp(z²)": _polynomial(kernel),
        "conditions solved": len(kernel.coefficients),
        "condition number": kernel.condition,
    }


def _moment_errors(kernel: GaussianKernel, beta: int, accuracy: int) -> dict[int, float]:
    required = required_moments(beta, accuracy)
    return {k: abs(moment(kernel, k) - wanted) for k, wanted in required.items()}


def _polynomial(kernel: GaussianKernel) -> str:
    terms = []
    for j, c in enumerate(kernel.coefficients):
        power = kernel.parity + 2 * j
        factor = {0: "", 1: " z"}.get(power, f" z^{power}")
        terms.append(f"{'-' if c < 0 else '+'} {abs(c)}{factor}")
    return " ".join(terms).removeprefix("+ ")


def _findings(line: pd.DataFrame, spacing: list[float], overlap: float) -> Iterator[Finding]:
    worst = max(_moment_errors(GAUSSIAN_20, 2, 2).values())
    highest = max(absolute_moment(GAUSSIAN_20, k) for k in range(4, _HIGHEST + 1))
    yield statement(
        "P-C2.moments",
        worst < 1e-13 and np.isfinite(highest),
        f"By quadrature M_1 = {moment(GAUSSIAN_20, 1):.1g}, M_2 = {moment(GAUSSIAN_20, 2):.15g}, "
        f"M_3 = {moment(GAUSSIAN_20, 3):.1g}; all M_k up to k = {_HIGHEST} are finite, |M_k| <= {highest:.4g}.",
        "A moment is not the one required.",
    )
    error = [second_derivative_error(GAUSSIAN_20, h, overlap) for h in spacing]
    order = observed_order(spacing, error)[-1]
    constant = error[-1] / (overlap * spacing[-1]) ** 2
    expected = float(taylor_constant(GAUSSIAN_20, 2, 2))
    yield statement(
        "P-C2.order",
        abs(order - 2.0) < 0.05 and abs(constant / expected - 1.0) < 0.01,
        f"Error of (21) for cos x on lattices with eps = {overlap:g} h: order {order:.3f} between the two finest; "
        f"error / eps^2 = {constant:.5f}, M_4 / 4! = {expected:g}.",
        "The error does not fall with the second power of eps.",
    )
    worst = line["largest error of a moment"].max()
    hardest = line.loc[line["condition number"].idxmax()]
    same = construct(2, 2).coefficients == GAUSSIAN_20.coefficients
    yield statement(
        "P-C2.construction",
        worst < 1e-9 and same,
        f"{len(line)} kernels for {line['derivative'].nunique()} derivatives, solved in fractions, meet every "
        f"condition to {worst:.1g} of the absolute moment; {hardest['derivative']} with r = {hardest['r']} has the "
        f"largest condition number, {hardest['condition number']:.2g}. beta = 2, r = 2 gives (20).",
        "A kernel misses a moment condition, or (20) is not the one found.",
    )
