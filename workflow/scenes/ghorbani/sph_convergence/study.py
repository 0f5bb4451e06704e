"""Convergence of the SPH operators with the particle spacing: what the half volumes and the midpoints repair."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from scenes.ghorbani.sph_operators.study import LABELS, OPERATORS, order_at, particles

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.integrals import METHODS
from fracparticles.sph.norms import relative_l2
from fracstudy.inputs import Inputs, Result, observed_order

__all__ = ["study"]

# Operator, its worst function, and the order: constant or variable.
_CURVES = (
    ("rl_integral", "sin", "constant"),
    ("caputo", "cos", "constant"),
    ("rl_derivative", "sin", "constant"),
    ("rl_integral", "sin", "variable"),
    ("caputo", "cos", "variable"),
)
_MIRRORED = ("rl_integral", "caputo", "rl_derivative")  # right-handed, of exp
_NAMES = {
    "rl_integral": "RL integral",
    "caputo": "Caputo derivative",
    "rl_derivative": "RL derivative",
}


def study(inputs: Inputs) -> Result:
    """Follow the error (39) over several spacings, for each way to place the volumes.

    Parameters of the scene: `counts` (particles, each level twice as fine), `shown` (the count whose error the table
    has), `order`, `variable`, `length`, `smoothing_ratio`. No claims: it is a study of our own.
    """
    parameters = inputs.parameters
    lines = [particles(parameters, count) for count in parameters["counts"]]
    shown = list(parameters["counts"]).index(parameters["shown"])
    spacing = np.array([line.spacing for line in lines])
    rows, curves = [], []
    settings = [("left", *curve) for curve in _CURVES]
    settings += [("right", operator, "exp", "constant") for operator in _MIRRORED]
    for side, operator, name, order in settings:
        for method in METHODS:
            errors = np.array(
                [_errors(line, parameters, side, operator, name, order, method) for line in lines]
            )
            whole, real = errors.T
            key = {"operator": operator, "function": name, "side": side, "order": order}
            rows.append(
                {
                    "operator": _NAMES[operator],
                    "side": side,
                    "function": LABELS[name],
                    "α": order,
                    "sums": method,
                    f"L2, s = {spacing[shown]:g}": whole[shown],
                    "order": observed_order(spacing, whole)[-1],
                    "L2 of the real part": real[shown],
                    "its order": observed_order(spacing, real)[-1],
                }
            )
            curves.append(
                pd.DataFrame({**key, "method": method, "x": spacing, "y": whole, "real": real})
            )
    return Result(pd.DataFrame(rows), (), pd.concat(curves, ignore_index=True))


def _errors(
    line: ParticleLine,
    parameters: Mapping[str, Any],
    side: str,
    operator: str,
    name: str,
    order: str,
    method: str,
) -> tuple[float, float]:
    """(39) of the complex values and of their real part."""
    kind, function = OPERATORS[operator], FUNCTIONS[name]
    alpha = order_at(parameters["order" if order == "constant" else "variable"], line.x_all)
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
