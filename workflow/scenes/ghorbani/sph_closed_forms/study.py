"""The closed forms of the Appendix and the non-singular ones of Sec. 5, against the definitions."""

from collections.abc import Callable, Iterator
from math import pi, sqrt
from typing import Any

import numpy as np
import pandas as pd
from scipy.special import gamma, gammaincc, hyp2f1

from fracparticles.sph.closed_forms import FUNCTIONS, ShiftedPower
from fracparticles.sph.one_f_two import one_f_two
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from scenes.ghorbani.operators import LABELS, Order, central_slope, order_at
from scenes.ghorbani.sph_closed_forms import definitions as by
from scenes.ghorbani.sph_closed_forms import non_singular
from scenes.ghorbani.sph_closed_forms.definitions import deviation

_EQUATIONS = {name: (f"A{k}", f"A{k + 4}") for k, name in enumerate(LABELS, start=1)}


def _upper(s: float | np.ndarray, x: np.ndarray) -> np.ndarray:
    """Gamma(s, x) / Gamma(s), for s of -1 to 1, by its recurrence."""
    return gammaincc(1.0 + s, x) - x**s * np.exp(-x) / gamma(1.0 + s)


_CUBIC = FUNCTIONS["cubic"]
assert isinstance(_CUBIC, ShiftedPower)
PRINTED: dict[str, Callable[[np.ndarray, Any], np.ndarray]] = {
    "A1": lambda x, a: pi * x ** (1 - a) / gamma(2 - a) * one_f_two(2 - a, pi * x),
    "A2": lambda x, a: -(pi**2) * x ** (2 - a) / gamma(3 - a) * one_f_two(3 - a, pi * x),
    "A3": lambda x, a: np.exp(x) * (1.0 - gammaincc(1 - a, x)),
    "A4": lambda x, a: x ** (1 - a) * 3.0 / gamma(2 - a) * hyp2f1(1, -2, 2 - a, x),
    "A5": lambda x, a: (
        (pi * x ** (1 - a) * 2 ** (a - 1) * sqrt(pi) / (gamma(1 - a / 2) * gamma(1.5 - a / 2)))
        * one_f_two(2 - a, pi * x)
    ),
    "A6": lambda x, a: (
        (x**-a * 2**a * sqrt(pi) / (gamma(0.5 - a / 2) * gamma(1 - a / 2)))
        * one_f_two(1 - a, pi * x)
    ),
    "A7": lambda x, a: np.exp(x) * (1.0 - _upper(-a, x)),
    "A8": _CUBIC.rl_as_printed,
}
"""(A1)-(A8) as they are printed, for the four functions: beta is pi, pi, 1 and -1 with n = 3."""


def study(
    inputs: Inputs, *, orders: list[float], variable: dict[str, float], length: float, count: int
) -> Result:
    """Compare (A1)-(A8), the integrals and the forms (33)-(36) with the definitions.

    There are `count` points in (0, length], constant `orders` and a `variable` one of Type I. Quadrature with 40 nodes
    is exact to degree 79, beyond round-off for the four functions up to x = 5.
    """
    x = length * np.arange(1, count + 1) / count

    def worst(gap: Callable[[str, np.ndarray, Order], float], name: str) -> float:
        return max(gap(name, x, order) for order in orders)

    rows = [
        {
            "function": LABELS[name],
            "Caputo": caputo,
            "Caputo, deviation": worst(_caputo_gap, name),
            "Caputo, deviation, Type I": _caputo_gap(name, x, variable),
            "RL derivative": derivative,
            "RL derivative, deviation": worst(_derivative_gap, name),
            "RL derivative, deviation, Type I": _variable_gap(name, x, variable),
            "RL integral, deviation": worst(_integral_gap, name),
            "RL integral, deviation, Type I": _integral_gap(name, x, variable),
        }
        for name, (caputo, derivative) in _EQUATIONS.items()
    ]
    table = pd.DataFrame(rows)
    found = _closed_forms(x, orders, variable, table)
    findings = [*found, *non_singular.findings(x, orders, variable)]
    return Result(table, inputs.judged(findings))


def _caputo_gap(name: str, x: np.ndarray, order: Order) -> float:
    return deviation(FUNCTIONS[name].caputo(x, order_at(order, x)), by.caputo(name, x, order))


def _integral_gap(name: str, x: np.ndarray, order: Order) -> float:
    return deviation(FUNCTIONS[name].rl(x, -order_at(order, x)), by.integral(name, x, order))


def _derivative_gap(name: str, x: np.ndarray, order: Order) -> float:
    return deviation(FUNCTIONS[name].rl(x, order_at(order, x)), by.derivative(name, x, order))


def _variable_gap(name: str, x: np.ndarray, order: Order) -> float:
    """RL D^alpha(x) f of the constant order's form, against d/dx I^(1-alpha(x)) f (8)."""
    exact = central_slope(lambda at: FUNCTIONS[name].rl(at, order_at(order, at) - 1.0), x)
    return deviation(FUNCTIONS[name].rl(x, order_at(order, x)), exact)


def _closed_forms(
    x: np.ndarray, orders: list[float], variable: dict[str, float], table: pd.DataFrame
) -> Iterator[Finding]:
    """(A1)-(A8) as printed, beside our way to write them; the integrals; and both of variable order."""
    rows = table.set_index(pd.Index(list(_EQUATIONS)))
    forms = (("Caputo, deviation", by.caputo), ("RL derivative, deviation", by.derivative))
    for name, equations in _EQUATIONS.items():
        for equation, (column, definition) in zip(equations, forms, strict=True):
            values = [PRINTED[equation](x, a) for a in orders]
            exact = [definition(name, x, a) for a in orders]
            yield measured(
                f"S-APP.{equation}",
                deviation=max(map(deviation, values, exact)),
                missing=max(np.count_nonzero(~np.isfinite(v)) for v in values),
                rewritten=rows.loc[name, column],
            )

    def integral_gap(name: str, order: Order) -> float:
        ours = PRINTED[_EQUATIONS[name][1]](x, -order_at(order, x))
        return deviation(ours, by.integral(name, x, order))

    def caputo_gap(name: str) -> float:
        ours = PRINTED[_EQUATIONS[name][0]](x, order_at(variable, x))
        return deviation(ours, by.caputo(name, x, variable))

    gaps = {e: max(integral_gap(s, a) for a in orders) for s, (_, e) in _EQUATIONS.items()}
    yield measured("S-APP.integral", deviation=gaps)
    valid = {"Caputo derivative": max(map(caputo_gap, _EQUATIONS))}
    valid["RL integral"] = max(integral_gap(name, variable) for name in _EQUATIONS)
    yield measured("S-APP.type_one", deviation=valid)
    invalid = table.set_index("function")["RL derivative, deviation, Type I"]
    yield measured("S-APP.type_one_derivative", deviation=dict(invalid))
