"""Sec. 5: the forms (33)-(36) without a singular kernel, and the two lines of (4) and (6), against the definitions."""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from scipy.special import gamma

from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.definition import defining_integral
from fracstudy.findings import Finding, measured
from fracstudy.orders import fitted_power
from scenes.ghorbani.operators import CURVATURES, LABELS, SLOPES, Order, central_slope, order_at
from scenes.ghorbani.sph_closed_forms import definitions as by

_NEAR = np.array([1e-8, 1e-6])  # points next to x = a
_CELLS = 400
_NODES = 400  # of quadrature where the order varies within the integral
_CLUSTER = 10  # x - x' = x t^10 makes the integrand smooth, for orders of 0.1 and more

_Form = Callable[[str, np.ndarray, Any], np.ndarray]


def integral(name: str, x: np.ndarray, order: Order) -> np.ndarray:
    """(33): f(0) x^alpha / Gamma(1+alpha) + I^(1+alpha) f'."""
    alpha = order_at(order, x)
    boundary = by.at_zero(name) * x**alpha / gamma(1.0 + alpha)
    return boundary + defining_integral(SLOPES[name], x, 1.0 + alpha)


def derivative(name: str, x: np.ndarray, alpha: float) -> np.ndarray:
    """(35): f(0) x^-alpha / Gamma(1-alpha) + d/dx I^(2-alpha) f'."""
    order = np.full_like(x, 2.0 - alpha)
    outer = central_slope(lambda at: defining_integral(SLOPES[name], at, order), x)
    return outer + by.at_zero(name) * x**-alpha / gamma(1.0 - alpha)


def caputo(name: str, x: np.ndarray, order: Order) -> np.ndarray:
    """(36): f'(0) x^(1-alpha) / Gamma(2-alpha) + I^(2-alpha) f''."""
    alpha = order_at(order, x)
    boundary = SLOPES[name](np.zeros(1)) * x ** (1.0 - alpha) / gamma(2.0 - alpha)
    return boundary + defining_integral(CURVATURES[name], x, 2.0 - alpha)


def findings(x: np.ndarray, orders: list[float], variable: dict[str, float]) -> Iterator[Finding]:
    """What Sec. 5 says of the forms, at the points x, for constant orders and a variable one of Type I."""

    def worst(ours: _Form, definition: _Form, name: str, some: list) -> float:
        return max(by.deviation(ours(name, x, o), definition(name, x, o)) for o in some)

    for claim, ours, definition, some in (
        ("S-DEF.33", integral, by.integral, orders),
        ("S-DEF.33_type_one", integral, by.integral, [variable]),
        ("S-DEF.35", derivative, by.derivative, orders),
        ("S-DEF.36", caputo, by.caputo, orders),
        ("S-DEF.36_type_one", caputo, by.caputo, [variable]),
    ):
        gaps = {LABELS[name]: worst(ours, definition, name, some) for name in FUNCTIONS}
        yield measured(claim, deviation=gaps)

    def slope(form: _Form, name: str, x: np.ndarray, order: Any) -> np.ndarray:
        """(34) with the form of its inner integral."""
        return central_slope(lambda at: form(name, at, 1.0 - order_at(order, at)), x)

    ours, theirs = partial(slope, integral), partial(slope, by.integral)
    constant = max(worst(ours, by.derivative, name, orders) for name in FUNCTIONS)
    type_one = max(worst(ours, theirs, name, [variable]) for name in FUNCTIONS)
    yield measured("S-DEF.34", deviation={"constant order": constant, "Type I": type_one})
    yield _at_the_end(orders)
    yield _readily(float(x[-1]), orders)
    yield _memory(x, variable)
    yield from _right_handed(x, orders)


def _at_the_end(orders: list[float]) -> Finding:
    """The power of x with which (35) grows towards x = a."""
    powers = {
        (name, o): fitted_power(_NEAR, np.abs(by.derivative(name, _NEAR, o)))
        for name, o in product(FUNCTIONS, orders)
    }
    infinite = [name for name in FUNCTIONS if by.at_zero(name)]
    excess = {LABELS[s]: max(abs(powers[s, o] + o) for o in orders) for s in infinite}
    bounded = min(power for (name, _), power in powers.items() if name not in infinite)
    return measured("S-DEF.35_end", excess=excess, bounded=bounded)


def _readily(x: float, orders: list[float]) -> Finding:
    """The midpoint rule on the integrals (1) and (33): the larger error over the four functions, one over the other."""
    cells = x * (np.arange(_CELLS) + 0.5) / _CELLS
    ratio = {}
    for order in orders:
        power = (x - cells) ** order * x / _CELLS
        errors = []
        for name, function in FUNCTIONS.items():
            exact = by.integral(name, np.array([x]), order)[0]
            singular = (power / (x - cells)) @ function.value(cells) / gamma(order)
            parts = by.at_zero(name) * x**order + power @ SLOPES[name](cells)
            errors.append([abs(singular - exact), abs(parts / gamma(1.0 + order) - exact)])
        first, second = np.max(errors, axis=0)
        ratio[f"α = {order:g}"] = first / second
    return measured("S-DEF.33_readily", ratio=ratio, cells=_CELLS)


def _memory(x: np.ndarray, variable: dict[str, float]) -> Finding:
    """(33) with an order that depends on x', against the integral (1) with the same order."""
    t, weights = np.polynomial.legendre.leggauss(_NODES)
    t = 0.5 * (t + 1.0)
    distance = np.outer(x, t**_CLUSTER)  # x - x'
    measure = np.outer(x, 0.5 * weights * _CLUSTER * t ** (_CLUSTER - 1))
    at = x[:, None] - distance
    gaps = {}
    # The order under the integral, and at x' = a.
    kinds = {"Type II, α(x′)": (at, np.zeros_like(x)), "Type III, α(x − x′)": (distance, x)}
    for kind, (argument, end) in kinds.items():
        alpha, first = order_at(variable, argument), order_at(variable, end)
        weight = measure * distance ** (alpha - 1.0) / gamma(alpha)
        part = measure * distance**alpha / gamma(1.0 + alpha)
        boundary = x**first / gamma(1.0 + first)
        gaps[kind] = min(
            by.deviation(
                by.at_zero(name) * boundary + (part * SLOPES[name](at)).sum(axis=1),
                (weight * function.value(at)).sum(axis=1),
            )
            for name, function in FUNCTIONS.items()
        )
    return measured("S-DEF.33_memory", deviation=gaps)


def _right_handed(x: np.ndarray, orders: list[float]) -> Iterator[Finding]:
    """The two lines of (4) and of (6), n = 1, x being the distance from b.

    Both derivatives of (b - x)^2 are 2 (b - x)^(2-alpha) / Gamma(3-alpha).
    """
    gaps: dict[tuple[str, str], list[float]] = {}
    for order in orders:
        power = np.full_like(x, 1.0 - order)
        exact = 2.0 * x ** (2.0 - order) / gamma(3.0 - order)
        # d/dx is minus the derivative by the distance.
        outer = -central_slope(partial(defining_integral, np.square, alpha=power), x)
        inner = defining_integral(lambda at: -2.0 * at, x, power)
        for claim, line in (("S-DEF.4", outer), ("S-DEF.6", inner)):
            gaps.setdefault((claim, "first line"), []).append(by.deviation(line, exact))
            gaps.setdefault((claim, "second line"), []).append(by.deviation(-line, exact))
    for claim in ("S-DEF.4", "S-DEF.6"):
        lines = {line: max(found) for (c, line), found in gaps.items() if c == claim}
        yield measured(claim, deviation=lines, meant=lines["second line"])
