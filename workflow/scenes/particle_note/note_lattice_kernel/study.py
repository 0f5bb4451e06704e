"""The lattice kernel (27) of the lecture note (Sec. 3.1), and the finite differences that discrete moments give."""

from __future__ import annotations

from fractions import Fraction

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
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, observed_order, statement
from scenes.particle_note.pse_note import second_derivative_error

__all__ = ["study"]

_EPS = float(np.finfo(float).eps)


def study(inputs: Inputs) -> Result:
    """The kernel (27): its moments over the line and on the lattice, and the exchange (26) that it gives.

    On a lattice the sum with a kernel of second moment M^_2 (28) approximates (M^_2 / 2) f'': the table has
    M^_2 / 2 against eps / h. Centred differences: the matrix of (26) inside the lattice against (1, -2, 1) / h^2,
    exact but for round-off. Stencils: the kernels on eps = h for f'' with accuracy r, of order r within 0.1.
    """
    overlap = np.array(inputs.parameters["overlap"], dtype=float)
    kernels: dict[str, Kernel] = {
        "(27)": TENT_27,
        "tent, M₂ = 2": SplineKernel(1),
        "Gaussian (20)": GAUSSIAN_20,
    }
    wanted = required_moments(2, 2)[2]
    table = pd.DataFrame(
        {"ε/h": overlap}
        | {f"M̂₂/2, {name}": lattice_moment(k, 2, overlap) / wanted for name, k in kernels.items()}
    )
    fine = np.linspace(0.5, overlap.max(), 20 * int(overlap.max()) + 1)
    z = np.linspace(-3.0, 3.0, 241)
    i = np.arange(-3.0, 4.0)
    parts = [
        pd.DataFrame({"panel": panel, "series": name, "x": x, "y": y})
        for name, k in kernels.items()
        for panel, x, y in (
            ("shape", z, k(z)),
            ("points", i, k(i)),
            ("moment", fine, lattice_moment(k, 2, fine) / wanted),
        )
    ]
    h = np.array(inputs.parameters["spacing"], dtype=float)
    orders = {}
    for r in inputs.parameters["accuracy"]:
        stencil = construct_stencil(2, r)
        error = np.array([second_derivative_error(stencil, s, 1.0) for s in h])
        orders[r] = float(observed_order(h, error)[-1])
        parts.append(pd.DataFrame({"panel": "error", "series": str(r), "x": h, "y": error}))
    return Result(table, _lattice_findings(inputs, orders), pd.concat(parts, ignore_index=True))


def _lattice_findings(inputs: Inputs, orders: dict[int, float]) -> list[Finding]:
    numerator, denominator = map(int, inputs.parameters["claimed_moment"])
    second, discrete = moment(TENT_27, 2), float(lattice_moment(TENT_27, 2))
    wanted = required_moments(2, 2)[2]
    h, n = 0.125, 41  # distances without round-off
    matrix = StrengthExchange(h * np.arange(n), h, h, TENT_27).matrix.toarray()[1:-1] * h * h
    centred = sum(c * np.eye(n - 2, n, j) for j, c in enumerate((1.0, -2.0, 1.0)))
    off = float(np.abs(matrix - centred).max())
    finest = np.array(inputs.parameters["spacing"], dtype=float)[-2:]
    error = [second_derivative_error(TENT_27, s, 1.0) for s in finest]
    order = float(observed_order(finest, np.array(error))[0])
    wrong = [second_derivative_error(TENT_27, s, 3.0) for s in 0.125 * finest]
    narrower = {r: _misfit_of_narrower_stencil(r) for r in orders}
    return [
        statement(
            "P-F2.shape",
            bool(
                (np.abs(TENT_27(np.array([-2.0, 2.0, 2.5]))) < _EPS).all()
                and TENT_27(0.0) == TENT_27(np.linspace(-3.0, 3.0, 601)).max()
            ),
            f"eta(0) = {TENT_27(0.0):g}, eta(1) = {TENT_27(1.0):g}, eta(2) = {TENT_27(2.0):g}, nil beyond; unlike a "
            f"delta its mass is M_0 = {moment(TENT_27, 0):g}, which (18) does not need.",
            "The kernel has another shape.",
        ),
        statement(
            "P-C4.second_moment",
            abs(second - numerator / denominator) < 1e-14 and abs(second - wanted) > 0.1,
            f"By quadrature M_2 = {second:.15g}; the condition is M_2 = {wanted}.",
            "The second moment is another.",
        ),
        statement(
            "P-C4.discrete_moment",
            abs(discrete - wanted) < 1e-14,
            f"Sum over the lattice with eps = h: M^_2 = {discrete:.15g}; the condition is {wanted}.",
            "The discrete moment is another.",
        ),
        statement(
            "P-C4.lattice_only",
            bool(wrong[-1] > 0.9 * wrong[0] and wrong[-1] > 0.1),
            f"On the same lattice with eps = 3 h the error for cos x stays at {wrong[-1]:.3f} under refinement: the "
            f"diffusivity is off by M^_2 / 2 = {float(lattice_moment(TENT_27, 2, 3.0)) / wanted:.4f}, which tends to "
            f"M_2 / 2 = {second / wanted:.4f}.",
            "The kernel converges with eps = 3 h as well.",
        ),
        statement(
            "P-C4.centred_differences",
            off < 8.0 * _EPS and abs(order - 2.0) < 0.05,
            f"The rows of (26) with (27) and eps = h differ from (1, -2, 1) D / h^2 by {off:.1g} of D / h^2; order of "
            f"the error for cos x: {order:.3f}.",
            "The matrix is not that of the centred difference.",
        ),
        statement(
            "P-C4.any_stencil",
            all(abs(p - r) < 0.1 for r, p in orders.items()),
            "Kernels for the second derivative from the discrete moments, order of the error for cos x: "
            + ", ".join(f"r = {r}: {p:.2f}" for r, p in orders.items())
            + f"; for r = 4 the values are {_values(construct_stencil(2, 4).values)}, those of the textbooks.",
            "A stencil has not the order asked for.",
        ),
        statement(
            "P-C4.smallest",
            all(misfit > 1e-6 for misfit in narrower.values()),
            "With one point less on either side the discrete moment conditions have no solution; least residual of "
            + ", ".join(f"r = {r}: {misfit:.2g}" for r, misfit in narrower.items())
            + ".",
            "A narrower stencil meets the conditions.",
        ),
    ]


def _misfit_of_narrower_stencil(accuracy: int) -> float:
    """The least residual of the conditions (28) for f'' with one point less a side, over |M_2| = 2."""
    conditions = [k for k in required_moments(2, accuracy) if k % 2 == 0]
    right = np.array([float(required_moments(2, accuracy)[k]) for k in conditions])
    points = np.arange(1.0, len(conditions))
    matrix = 2.0 * points ** np.array(conditions)[:, None]
    solution = np.linalg.lstsq(matrix, right)[0] if points.size else np.zeros(0)
    return float(np.linalg.norm(matrix @ solution - right) / np.linalg.norm(right))


def _values(values: tuple[Fraction, ...]) -> str:
    middle = len(values) // 2
    return ", ".join(f"eta({i - middle}) = {v}" for i, v in enumerate(values) if i > middle)
