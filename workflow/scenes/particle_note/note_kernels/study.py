"""Kernels from moment conditions (Sec. 2.2, 2.3 of the lecture note)."""

from collections.abc import Iterator
from itertools import product
from math import factorial
from typing import Any

import numpy as np
import pandas as pd

from fracparticles import pse
from fracparticles.pse import GAUSSIAN_20, GaussianKernel, construct, moment, required_moments
from fracparticles.pse.construction import taylor_constant
from fracparticles.pse.moments import absolute_moment
from fracparticles.run.orders import observed_order
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.particle_note.waves import Skewed, second_derivative_error

_HIGHEST = 12  # the moments that "for all k > 3" is checked up to
_DEGREE = 8  # of the polynomials that (15) is tried on
_FAR, _REACH = 20.0, 6.0


def study(
    inputs: Inputs,
    *,
    derivative: list[int],
    accuracy: list[int],
    spacing: list[float],
    overlap: float,
) -> Result:
    """Kernels for derivatives beta with accuracy r from the moment conditions, and Laplacians in 2-D and 3-D.

    Moments are by quadrature; their errors are in parts of int |z^k eta| dz. The error of (21) is that on lattices of
    the spacings, the overlap large enough to make the quadrature exact.
    """
    rows, panels, z = [], Panels(), np.linspace(-4.0, 4.0, 401)
    for beta, r in product(derivative, accuracy):
        kernel = construct(beta, r)
        panels.add(beta=beta, r=r, x=z, y=kernel(z))
        row = {"derivative": f"order {beta}", "r": r, **_solved(kernel)}
        row["largest error of a moment"] = max(
            abs(moment(kernel, k) - wanted) / absolute_moment(kernel, k)
            for k, wanted in required_moments(beta, r).items()
        )
        row["C₁ = |M_(β+r)| / (β+r)!"] = abs(float(taylor_constant(kernel, beta, r)))
        rows.append(row)
    line = pd.DataFrame(rows)
    for dim, r in product((2, 3), accuracy):
        name = f"Laplacian, {dim}-D"
        rows.append({"derivative": name, "r": r, **_solved(pse.construct_laplacian(r, dim))})
    decay = GAUSSIAN_20(_REACH) / GAUSSIAN_20(0.0)
    findings = [
        _gaussian(),
        _order(spacing, overlap),
        *_construction(line, derivative, accuracy),
        _taylor(),
        _exact(derivative, accuracy),
        measured("P-C2.support", far=GAUSSIAN_20(_FAR), decay=decay),
    ]
    return Result(pd.DataFrame(rows), inputs.judged(findings), panels.frame)


def _solved(kernel: GaussianKernel) -> dict[str, Any]:
    return {
        "η · π^(d/2) exp(z²)": _polynomial(kernel),
        "conditions solved": len(kernel.coefficients),
        "condition number": kernel.condition,
    }


def _polynomial(kernel: GaussianKernel) -> str:
    terms = []
    for j, c in enumerate(kernel.coefficients):
        power = kernel.parity + 2 * j
        factor = {0: "", 1: " z"}.get(power, f" z^{power}")
        terms.append(f"{'-' if c < 0 else '+'} {abs(c)}{factor}")
    return " ".join(terms).removeprefix("+ ")


def _gaussian() -> Finding:
    """The moments of (20), the higher ones against 4 (1/2) (3/2) ... (k/2 - 1/2)."""
    required = required_moments(2, 2)
    higher = {k: moment(GAUSSIAN_20, k) for k in range(4, _HIGHEST + 1)}
    off = {k: abs(m - 4.0 * float(pse.gaussian_moment(k))) for k, m in higher.items()}
    return measured(
        "P-C2.moments",
        error={f"M_{k}": abs(moment(GAUSSIAN_20, k) - wanted) for k, wanted in required.items()},
        higher=max(gap / absolute_moment(GAUSSIAN_20, k) for k, gap in off.items()),
        greatest=max(higher.values()),
        highest=_HIGHEST,
    )


def _order(spacing: list[float], overlap: float) -> Finding:
    error = [second_derivative_error(GAUSSIAN_20, h, overlap) for h in spacing]
    power = observed_order(spacing, error)[-1]
    expected = float(taylor_constant(GAUSSIAN_20, 2, 2))
    constant = error[-1] / (overlap * spacing[-1]) ** 2 / expected
    numbers = {"power": power, "constant": constant, "expected": expected}
    return measured("P-C2.order", off=abs(power - 2.0), **numbers)


def _construction(
    line: pd.DataFrame, derivative: list[int], accuracy: list[int]
) -> Iterator[Finding]:
    """What the constructed kernels miss; and n^3, the work of n conditions, of all and of those that (19) leaves."""
    hardest = line.loc[line["condition number"].idxmax()]
    found, printed = (np.array(k.coefficients, dtype=float) for k in (construct(2, 2), GAUSSIAN_20))
    yield measured(
        "P-C2.construction",
        error=line["largest error of a moment"].max(),
        coefficient=np.abs(found - printed).max() if found.shape == printed.shape else 1.0,
        kernels=len(line),
        condition=hardest["condition number"],
        hardest=f"{hardest['derivative']}, r = {hardest['r']}",
    )
    every = each(lambda beta, r: len(required_moments(beta, r)), beta=derivative, r=accuracy)
    left = line["conditions solved"].to_numpy()
    yield measured("P-C2.symmetry", work=(every / left) ** 3, every=every.sum() / left.sum())


def _taylor() -> Finding:
    """(15) for polynomials and a kernel without symmetry: the integral against the sum over moments."""
    kernel, x, epsilon = Skewed(), np.array([0.3]), 0.7
    gaps = []
    for n in range(1, _DEGREE + 1):
        f = np.polynomial.Polynomial.basis(n)
        integral = epsilon * pse.regularised(f, x, epsilon, kernel, 1)[0]
        factors = {k: f.deriv(k)(x[0]) / factorial(k) * (-epsilon) ** k for k in range(1, n + 1)}
        total = sum(c * moment(kernel, k) for k, c in factors.items())
        size = sum(abs(c) * absolute_moment(kernel, k) for k, c in factors.items())
        gaps.append(abs(integral - total) / size)
    return measured("P-C2.taylor", deviation=max(gaps), degree=_DEGREE)


def _exact(derivative: list[int], accuracy: list[int]) -> Finding:
    """(18) at 0 for z^k: up to the degree beta + r - 1, whose moments are met, and for z^(beta+r), whose is not."""
    x, epsilon = np.array([0.0]), 0.7
    met: list[float] = []
    unmet: list[float] = []
    for beta, r in product(derivative, accuracy):
        if beta == 0:  # (18) is for derivatives
            continue
        kernel = construct(beta, r)
        for k in range(1, beta + r + 1):
            f = np.polynomial.Polynomial.basis(k)
            off = abs(pse.regularised(f, x, epsilon, kernel, beta)[0] - f.deriv(beta)(0.0))
            off /= absolute_moment(kernel, k) * epsilon ** (k - beta)
            (met if k < beta + r else unmet).append(off)
    return measured("P-C2.exact", met=max(met), unmet=min(unmet))
