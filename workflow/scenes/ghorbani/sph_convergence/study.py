"""Convergence of the SPH operators with the particle spacing: what the half volumes and the midpoints repair."""

from itertools import product

import numpy as np
import pandas as pd

from fracparticles.run.orders import observed_order
from fracparticles.sph import ParticleLine
from fracparticles.sph.integrals import METHODS
from fracparticles.sph.norms import relative_l2
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.ghorbani.operators import LABELS, OPERATORS, Order

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
        kind, case = OPERATORS[operator], (name, orders[varies], method, side)
        values = [kind.compared(line, *case)[1:] for line in lines]
        whole = np.array([relative_l2(exact, ours) for exact, ours in values])
        real = np.array([relative_l2(exact, ours.real) for exact, ours in values])
        row = {
            "operator": kind.name,
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
