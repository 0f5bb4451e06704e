"""Convergence of the SPH operators with the particle spacing: what the half volumes and the midpoints repair."""

from itertools import product

import numpy as np
import pandas as pd

from fracparticles.run.orders import observed_order
from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.integrals import METHODS
from fracparticles.sph.norms import relative_l2
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.ghorbani.operators import LABELS, OPERATORS, Order, order_at

# Side, operator, function and order: of the left-handed ones the worst functions, of the right-handed exp.
_CASES = (
    ("left", "rl_integral", "sin", "constant"),
    ("left", "caputo", "cos", "constant"),
    ("left", "rl_derivative", "sin", "constant"),
    ("left", "rl_integral", "sin", "variable"),
    ("left", "caputo", "cos", "variable"),
    *(("right", operator, "exp", "constant") for operator in OPERATORS),
)


def study(
    inputs: Inputs,
    *,
    counts: list[int],
    shown: int,
    order: float,
    variable: dict[str, float],
    length: float,
    smoothing_ratio: float,
) -> Result:
    """Follow the error (39) over several spacings, for each way to place the volumes.

    The lines have `counts` particles, each level twice as fine; the table has the error of that with `shown` of them.
    No claims: it is a study of our own.
    """
    lines = [ParticleLine(0.0, length, count, smoothing_ratio) for count in counts]
    orders: dict[str, Order] = {"constant": order, "variable": variable}
    spacing = np.array([line.spacing for line in lines])
    at = counts.index(shown)
    rows, panels = [], Panels()
    for (side, operator, name, varies), method in product(_CASES, METHODS):
        errors = [_errors(line, side, operator, name, orders[varies], method) for line in lines]
        whole, real = np.array(errors).T
        row = {
            "operator": OPERATORS[operator].name,
            "side": side,
            "function": LABELS[name],
            "α": varies,
            "sums": method,
            f"L2, s = {spacing[at]:g}": whole[at],
            "order": observed_order(spacing, whole)[-1],
            "L2 of the real part": real[at],
            "order of the real part": observed_order(spacing, real)[-1],
        }
        rows.append(row)
        key = {"operator": operator, "function": name, "side": side, "order": varies}
        panels.add(**key, method=method, x=spacing, y=whole, real=real)
    return Result(pd.DataFrame(rows), (), panels.frame)


def _errors(
    line: ParticleLine, side: str, operator: str, name: str, order: Order, method: str
) -> tuple[float, float]:
    """(39) of the complex values and of their real part."""
    kind, function = OPERATORS[operator], FUNCTIONS[name]
    alpha = order_at(order, line.x_all)
    ours = kind.approximate(line, function.value(line.x_all), alpha, side=side, method=method)
    here = alpha[line.inside]
    if side == "left":
        exact = kind.exact(function, line.x, here)
    else:  # f is the mirror image, about the middle, of a sum of functions with closed forms
        ours, here = ours[::-1], here[::-1]
        terms = [c * kind.exact(g, line.x, here) for c, g in function.mirrored(line.b)]
        exact = np.sum(terms, axis=0)
    exact, ours = exact[kind.first :], ours[kind.first :]
    return relative_l2(exact, ours), relative_l2(exact, ours.real)
