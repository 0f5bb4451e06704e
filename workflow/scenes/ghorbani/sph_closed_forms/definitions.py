"""The operators by quadrature of their definitions, for the four functions by name, and deviations from them."""

import numpy as np
from scipy.special import gamma

from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.definition import defining_integral
from scenes.ghorbani.operators import SLOPES, Order, order_at


def integral(name: str, x: np.ndarray, order: Order) -> np.ndarray:
    """I^alpha f (1), (7)."""
    return defining_integral(FUNCTIONS[name].value, x, order_at(order, x))


def caputo(name: str, x: np.ndarray, order: Order) -> np.ndarray:
    """C D^alpha f = I^(1-alpha) f' (5), (9)."""
    return defining_integral(SLOPES[name], x, 1.0 - order_at(order, x))


def derivative(name: str, x: np.ndarray, order: Order) -> np.ndarray:
    """RL D^alpha f (3) of a constant order: f(0) x^-alpha / Gamma(1-alpha) + I^(1-alpha) f'."""
    alpha = order_at(order, x)
    return caputo(name, x, order) + at_zero(name) * x**-alpha / gamma(1.0 - alpha)


def at_zero(name: str) -> float:
    """f(0)."""
    return float(FUNCTIONS[name].value(0.0))


def deviation(ours: np.ndarray, exact: np.ndarray) -> float:
    """The largest one, over the largest value; points where ours has none are left out."""
    return float(np.nanmax(np.abs(ours - exact)) / np.abs(exact).max())
