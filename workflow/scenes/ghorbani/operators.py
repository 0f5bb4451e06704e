"""What the SPH scenes share: the operators, the order alpha(x), and how functions and sums are named and drawn."""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from fracparticles.sph import ParticleLine, caputo_derivative, rl_derivative, rl_integral
from fracparticles.sph.closed_forms import FUNCTIONS, Function

_STEP = 1e-4  # of differences: they keep some eight digits

Order = float | dict[str, float]  # a constant, or mean, amplitude and waves of alpha(x)

LABELS = {"sin": "sin πx", "cos": "cos πx", "exp": "exp x", "cubic": "(x − 1)³"}
TITLES = {"sin": r"$\sin \pi x$", "cos": r"$\cos \pi x$", "exp": r"$\exp x$", "cubic": "$(x-1)^3$"}
SLOPES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "sin": lambda x: pi * np.cos(pi * x),
    "cos": lambda x: -pi * np.sin(pi * x),
    "exp": np.exp,
    "cubic": lambda x: 3.0 * (x - 1.0) ** 2,
}
CURVATURES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "sin": lambda x: -(pi**2) * np.sin(pi * x),
    "cos": lambda x: -(pi**2) * np.cos(pi * x),
    "exp": np.exp,
    "cubic": lambda x: 6.0 * (x - 1.0),
}
SUMS = {  # label, colour and marker of each way to do the sum for the integral
    "standard": ("standard (17)", "#D55E00", "o"),
    "halved": ("half volumes at the ends", "#0072B2", "s"),
    "modified": ("modified (20)", "#009E73", "^"),
}


@dataclass(frozen=True)
class Operator:
    """A fractional operator: its names, its approximation, its closed form, and the first particle that is judged."""

    name: str
    axis: str
    approximate: Callable[..., np.ndarray]
    exact: Callable[[Function, np.ndarray, Any], np.ndarray]
    first: int = 0

    def compared(
        self,
        line: ParticleLine,
        name: str,
        order: Order,
        method: str = "standard",
        side: str = "left",
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the particles that are judged, the closed form there, and the approximation.

        That on [x, b] is of the mirror image of f about the middle, a sum of functions with closed forms.
        """
        function, alpha = FUNCTIONS[name], order_at(order, line.x_all)
        f, here = function.value(line.x_all), alpha[line.inside]
        ours = self.approximate(line, f, alpha, side=side, method=method)
        if side == "left":
            exact = self.exact(function, line.x, here)
        else:
            ours, here = ours[::-1], here[::-1]
            terms = [c * self.exact(g, line.x, here) for c, g in function.mirrored(line.b)]
            exact = np.sum(terms, axis=0)
        return line.x[self.first :], exact[self.first :], ours[self.first :]


OPERATORS = {
    "rl_integral": Operator(
        "RL integral", r"RL integral $I^{\alpha} f$", rl_integral, lambda f, x, a: f.rl(x, -a)
    ),
    "caputo": Operator(
        "Caputo derivative",
        r"Caputo derivative ${}^{C}D^{\alpha} f$",
        caputo_derivative,
        lambda f, x, a: f.caputo(x, a),
    ),
    # The derivative of Riemann and Liouville is infinite at x = a: the paper leaves that particle out.
    "rl_derivative": Operator(
        "RL derivative",
        r"RL derivative ${}^{RL}D^{\alpha} f$",
        rl_derivative,
        lambda f, x, a: f.rl(x, a),
        first=1,
    ),
}


def order_at(order: Order, x: np.ndarray) -> np.ndarray:
    """Return alpha at x: a constant, or mean + amplitude sin(waves pi x)."""
    if isinstance(order, dict):
        return order["mean"] + order["amplitude"] * np.sin(order["waves"] * pi * x)
    return np.full_like(x, order)


def central_slope(of: Callable[[np.ndarray], np.ndarray], x: np.ndarray) -> np.ndarray:
    """Return the derivative by central differences of fourth order."""
    near, far = (of(x + k * _STEP) - of(x - k * _STEP) for k in (1, 2))
    return (8.0 * near - far) / (12.0 * _STEP)
