"""The lattice kernel (27) of the lecture note (Sec. 3.1), and the finite differences that discrete moments give."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from fracparticles.pse import (
    GAUSSIAN_20,
    TENT_27,
    Kernel,
    SplineKernel,
    StrengthExchange,
    construct_stencil,
    lattice_moment,
    moment,
    required_moments,
)
from fracparticles.run.orders import observed_order
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.particle_note.waves import second_derivative_error

__all__ = ["study"]

_EPS = float(np.finfo(float).eps)
_WANTED = required_moments(2, 2)[2]
_KERNELS: dict[str, Kernel] = {
    "(27)": TENT_27,
    "tent, M₂ = 2": SplineKernel(1),
    "Gaussian (20)": GAUSSIAN_20,
}


def study(
    inputs: Inputs,
    *,
    claimed_moment: list[int],
    overlap: list[float],
    spacing: list[float],
    accuracy: list[int],
) -> Result:
    """The kernel (27): its moments over the line and on the lattice, and the exchange (26) that it gives.

    On a lattice the sum with a kernel of second moment M^_2 (28) approximates (M^_2 / 2) f'': the table has
    M^_2 / 2 against eps / h. Centred differences: the matrix of (26) inside the lattice against (1, -2, 1) / h^2,
    exact but for round-off. Stencils: the kernels on eps = h for f'' with accuracy r, of order r within 0.1.
    """
    widest = max(overlap)
    fine = np.linspace(0.5, widest, 20 * int(widest) + 1)
    z, i = np.linspace(-3.0, 3.0, 241), np.arange(-3.0, 4.0)
    columns, parts = {"ε/h": np.array(overlap)}, []
    for name, kernel in _KERNELS.items():
        columns[f"M̂₂/2, {name}"] = lattice_moment(kernel, 2, overlap) / _WANTED
        curves = {"shape": (z, kernel(z)), "points": (i, kernel(i))}
        curves["moment"] = (fine, lattice_moment(kernel, 2, fine) / _WANTED)
        for panel, (x, y) in curves.items():
            parts.append(pd.DataFrame({"panel": panel, "series": name, "x": x, "y": y}))
    orders = {}
    for r in accuracy:
        error = [second_derivative_error(construct_stencil(2, r), h, 1.0) for h in spacing]
        orders[r] = float(observed_order(spacing, error)[-1])
        parts.append(pd.DataFrame({"panel": "error", "series": str(r), "x": spacing, "y": error}))
    numerator, denominator = claimed_moment
    findings = [
        finding
        for finding in _findings(numerator / denominator, spacing, orders)
        if finding.claim.split(".")[0] in inputs.items
    ]
    return Result(pd.DataFrame(columns), findings, pd.concat(parts, ignore_index=True))


def _findings(claimed: float, spacing: list[float], orders: dict[int, float]) -> Iterator[Finding]:
    z = np.linspace(-3.0, 3.0, 601)
    top, edge, beyond = TENT_27(0.0), TENT_27(1.0), TENT_27(np.array([-2.0, 2.0, 2.5]))
    yield statement(
        "P-F2.shape",
        bool((np.abs(beyond) < _EPS).all()) and top == TENT_27(z).max(),
        f"eta(0) = {top:g}, eta(1) = {edge:g}, eta(2) = {TENT_27(2.0):g}, zero beyond; unlike a delta its mass is "
        f"M_0 = {moment(TENT_27, 0):g}, which (18) does not need.",
        "The kernel has another shape.",
    )
    second, discrete = moment(TENT_27, 2), float(lattice_moment(TENT_27, 2))
    yield statement(
        "P-C4.second_moment",
        abs(second - claimed) < 1e-14 and abs(second - _WANTED) > 0.1,
        f"By quadrature M_2 = {second:.15g}; the condition is M_2 = {_WANTED}.",
        "The second moment is another.",
    )
    yield statement(
        "P-C4.discrete_moment",
        abs(discrete - _WANTED) < 1e-14,
        f"Sum over the lattice with eps = h: M^_2 = {discrete:.15g}; the condition is {_WANTED}.",
        "The discrete moment is another.",
    )
    wrong = [second_derivative_error(TENT_27, 0.125 * h, 3.0) for h in spacing[-2:]]
    multiplied = float(lattice_moment(TENT_27, 2, 3.0)) / _WANTED
    yield statement(
        "P-C4.lattice_only",
        wrong[-1] > 0.9 * wrong[0] and wrong[-1] > 0.1,
        f"On the same lattice with eps = 3 h the error for cos x stays at {wrong[-1]:.3f} under refinement: the "
        f"diffusivity is off by M^_2 / 2 = {multiplied:.4f}, which tends to M_2 / 2 = {second / _WANTED:.4f}.",
        "The kernel converges with eps = 3 h as well.",
    )
    h, n = 0.125, 41  # distances without round-off
    matrix = StrengthExchange(h * np.arange(n), h, h, TENT_27).matrix.toarray()[1:-1] * h * h
    centred = sum(c * np.eye(n - 2, n, j) for j, c in enumerate((1.0, -2.0, 1.0)))
    off = float(np.abs(matrix - centred).max())
    error = [second_derivative_error(TENT_27, h, 1.0) for h in spacing[-2:]]
    order = float(observed_order(spacing[-2:], error)[0])
    yield statement(
        "P-C4.centred_differences",
        off < 8.0 * _EPS and abs(order - 2.0) < 0.05,
        f"The rows of (26) with (27) and eps = h differ from (1, -2, 1) D / h^2 by {off:.1g} of D / h^2; order of "
        f"the error for cos x: {order:.3f}.",
        "The matrix is not that of the centred difference.",
    )
    found = ", ".join(f"r = {r}: {p:.2f}" for r, p in orders.items())
    stencil = construct_stencil(2, 4).values
    right = enumerate(stencil[len(stencil) // 2 + 1 :], start=1)
    values = ", ".join(f"eta({i}) = {eta}" for i, eta in right)
    yield statement(
        "P-C4.any_stencil",
        all(abs(p - r) < 0.1 for r, p in orders.items()),
        f"Kernels for the second derivative from the discrete moments, order of the error for cos x: {found}; for "
        f"r = 4 the values are {values}, those of the textbooks.",
        "A stencil has not the order asked for.",
    )
    narrower = {r: _misfit_of_narrower_stencil(r) for r in orders}
    residuals = ", ".join(f"r = {r}: {misfit:.2g}" for r, misfit in narrower.items())
    yield statement(
        "P-C4.smallest",
        all(misfit > 1e-6 for misfit in narrower.values()),
        "With one point less on either side the discrete moment conditions have no solution; least residual of "
        f"{residuals}.",
        "A narrower stencil meets the conditions.",
    )


def _misfit_of_narrower_stencil(accuracy: int) -> float:
    """The least residual of the conditions (28) for f'' with one point less a side, over |M_2| = 2."""
    required = required_moments(2, accuracy)
    conditions = [k for k in required if k % 2 == 0]
    right = np.array([float(required[k]) for k in conditions])
    points = np.arange(1.0, len(conditions))
    matrix = 2.0 * points ** np.array(conditions)[:, None]
    solution = np.linalg.lstsq(matrix, right)[0] if points.size else np.zeros(0)
    return float(np.linalg.norm(matrix @ solution - right) / np.linalg.norm(right))
