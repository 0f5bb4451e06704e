"""What the text leaves open about its sums, each choice changed in turn, and the equations that cannot be meant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.derivatives import correction, gradient
from fracparticles.sph.norms import relative_l2
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.ghorbani.operators import OPERATORS, Order, order_at
from scenes.ghorbani.sph_readings.sums import Reading, approximate

__all__ = ["CASES", "READINGS", "study"]

_LARGE = 0.5  # a relative error (39) from which nothing of the operator is left
_ROUNDOFF = 1e-9  # of a difference of terms as large as x / s


_OURS = Reading()
READINGS = {
    "that of the digits": _OURS,
    "no terms j > i": replace(_OURS, ahead="none"),
    "terms j > i with |x_i - x_j|": replace(_OURS, ahead="absolute"),
    "norms of the real part": replace(_OURS, real=True),
    "gradients not corrected": replace(_OURS, correction="none"),
    "gradients times L, (19) as printed": replace(_OURS, correction="multiplied"),
    "no virtual particles": replace(_OURS, virtual=False),
    "exact f', f''": replace(_OURS, exact=True),
    "η = 0.0001 / h², (37) as printed": replace(_OURS, eta="1/h^2"),
    "singular sums (23), (25), (26)": replace(_OURS, singular=True),
    "half volumes at the two ends": replace(_OURS, halved=True),
    "x = 0 judged for the RL derivative": replace(_OURS, first=True),
    "(20) with f' at the auxiliary particle": replace(_OURS, midpoint="itself"),
    "(20) with the average of f' times the power": replace(_OURS, midpoint="product"),
    "(20) with N auxiliary particles": replace(_OURS, last=True),
}
# Figure: operator, function, whether of variable order, whether by the modified sums.
CASES = {
    "Fig. 3, cos": ("caputo", "cos", False, False),
    "Fig. 4, sin": ("rl_derivative", "sin", False, False),
    "Fig. 5, sin": ("rl_integral", "sin", False, False),
    "Fig. 6, sin": ("rl_integral", "sin", False, True),
    "Fig. 7, cos": ("caputo", "cos", True, False),
    "Fig. 8, sin": ("rl_integral", "sin", True, False),
}


def study(
    inputs: Inputs,
    *,
    order: float,
    variable: dict[str, float],
    length: float,
    count: int,
    smoothing_ratio: float,
) -> Result:
    """Change one choice at a time, and look at the equations that as printed cannot be meant.

    A row of the table agrees in the figures whose six decimals it does not change. An equation is refuted if L2 is
    larger with it than without it, or above one half.
    """
    line = ParticleLine(0.0, length, count, smoothing_ratio)
    orders: list[Order] = [order, variable]
    errors = {name: _errors(line, orders, reading) for name, reading in READINGS.items()}
    # In whole millionths: six decimals are printed.
    table = 1e6 * pd.DataFrame.from_dict(errors, orient="index")
    table = table.round().astype(int).rename(columns="{}, L2 × 10⁶".format)
    table["figures with the same digits"] = (table == table.iloc[0]).sum(axis=1)
    table = table.reset_index(names="reading")
    findings = [*_gradients(line), _double_sum(line, order), *_orders(line, variable)]
    findings.append(_eta(line, errors))
    return Result(table, findings if "S-EQ" in inputs.items else ())


def _errors(line: ParticleLine, orders: list[Order], reading: Reading) -> dict[str, float]:
    errors = {}
    for case, (operator, name, varies, modified) in CASES.items():
        alpha, kind = order_at(orders[varies], line.x_all), OPERATORS[operator]
        judged = slice(0 if reading.first else kind.first, None)
        exact = kind.exact(FUNCTIONS[name], line.x, alpha[line.inside])[judged]
        ours = approximate(line, name, operator, alpha, modified, reading)[judged]
        errors[case] = relative_l2(exact, ours.real if reading.real else ours)
    return errors


def _gradients(line: ParticleLine) -> Iterator[Finding]:
    """(18), (19) on f = 1 and f = x."""
    x, volume, h = line.x_all, line.spacing, line.smoothing
    of_one, of_x = (
        gradient(line.x, x, volume, f, h, corrected=False) for f in (np.ones_like(x), x)
    )
    factor = correction(line.x, x, volume, h)
    zeroth = np.abs(of_one).max() * h
    first, plain, printed = (np.abs(g - 1.0).max() for g in (of_x / factor, of_x, of_x * factor))
    yield statement(
        "S-EQ.consistency",
        max(zeroth, first) <= _ROUNDOFF < plain,
        f"Of f = 1 the regular gradient is {zeroth:.0e} / h; of f = x it is 1 to {plain:.2e}, the corrected one "
        f"1 to {first:.0e}.",
        "Their orders of consistency are others.",
    )
    yield statement(
        "S-EQ.L_inverse",
        printed <= plain,
        f"With the sum of (19) as the factor of (18), the gradient of f = x is off by {printed:.2e}, against "
        f"{plain:.2e} without a correction and {first:.0e} if divided by it.",
        "The sum is L, not its inverse: as printed the correction doubles the error that it should remove.",
    )


def _double_sum(line: ParticleLine, order: float) -> Finding:
    """(25), (31): with the integral at x_i inside the sum over j, it is a factor of sum_j V_j dW_ij = 0."""
    alpha, ones = order_at(order, line.x_all), np.ones_like(line.x_all)
    exact = FUNCTIONS["sin"].rl(line.x, alpha[line.inside])
    inner = approximate(line, "sin", "rl_integral", 1.0 - alpha, False, _OURS)
    literal = inner * gradient(line.x, line.x_all, line.spacing, ones, line.smoothing)
    error = relative_l2(exact, literal)
    return statement(
        "S-EQ.double_sum",
        error < _LARGE,
        f"As printed the RL derivative of sin πx is at most {np.abs(literal).max():.0e}, L2 = {error:.6f}.",
        "The integral must be taken at x_j: at x_i it leaves the sum, and the sum of the gradients vanishes.",
    )


def _orders(line: ParticleLine, variable: dict[str, float]) -> Iterator[Finding]:
    """The left side of (32), and the range of alpha(x)."""
    alpha = order_at(variable, line.x_all)
    ours = approximate(line, "cos", "caputo", alpha, False, replace(_OURS, halved=True))
    order = alpha[line.inside]
    printed, meant = (
        relative_l2(FUNCTIONS["cos"].caputo(line.x, a), ours) for a in (1.0 - order, order)
    )
    low, high = order.min(), order.max()
    yield statement(
        "S-EQ.caputo_order",
        printed < meant,
        f"For cos πx, with half volumes at the ends, the sum is {meant:.6f} (L2) from the derivative of order α(x) "
        f"and {printed:.6f} from that of order 1 - α(x).",
        "The right side of (32) is the derivative of order α(x).",
    )
    yield statement(
        "S-EQ.order_range",
        low < 0.01 and high > 0.99,
        f"On the particles α(x) runs from {low:.4f} to {high:.4f}.",
        f"The amplitude of {variable['amplitude']:g} about the mean of {variable['mean']:g} does not reach 0 and 1.",
    )


def _eta(line: ParticleLine, errors: Mapping[str, Mapping[str, float]]) -> Finding:
    h, case = line.smoothing, "Fig. 3, cos"
    printed = errors["η = 0.0001 / h², (37) as printed"][case]
    ours = errors["that of the digits"][case]
    return statement(
        "S-EQ.eta",
        printed < _LARGE,
        f"η is {1e-4 / h**2:.3g} there, {1e-4 / h**3:.3g} h, and the Caputo derivative of cos πx has "
        f"L2 = {printed:.6f}, against {ours:.6f} with η = 0.0001 h².",
        "So large an η removes the second derivative; its dimension is not that of a distance either.",
    )
