r"""Diffusion with a source, f_t = f_xx + Q(x), Sec. 2.1, in two ways.

- As the paper has it: the source is a part of the velocity, the weights are constant,

      V = -(f_x + S^(x)) / f,     S^(x) = int_-inf^x Q dx'.

  It keeps sum_j W_j, but the equation gains int Q dx a unit of time: it can serve only a source of no total.
- The source changes the weights, the velocity stays (3):

      dx_j/dt = -F_x / F,     dW_j/dt = W_j Q(x_j) / F(x_j),

  for any source where there are markers: sum_j dW_j/dt g(x_j) is int Q g dx for markers of volume W_j / F.

`GaussianSource` has Q = q exp(-x^2) or q exp(-x^2)'', with the solutions from f_0 = exp(-x^2).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from fracparticles.integrators.rkc import ChebyshevStep
from fracparticles.lagrangian import quotient_velocity
from fracparticles.markers.profiles import Gaussian
from fracparticles.markers.solver import Flux, MarkerVelocity

__all__ = ["GaussianSource", "advance_weights", "source_flux"]

Function = Callable[[np.ndarray], np.ndarray]


def source_flux(cumulative: Function) -> Flux:
    """Return the paper's flux V F = -F_x - S^(x)."""

    def flux(x: np.ndarray, fields: np.ndarray) -> np.ndarray:
        return -fields[1] - cumulative(x)

    return flux


def advance_weights(
    x: np.ndarray,
    weights: np.ndarray,
    velocity: MarkerVelocity,
    source: Function,
    *,
    dt: float,
    steps: int,
    stages: int = 2,
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and weights after `steps` steps of RKC2, with weights that the source changes.

    Raises
    ------
    InvalidInput
        If dt, steps or stages does not do.
    FieldNotPositive
        If F is not positive at a marker; says when and where.
    """

    def rate(state: np.ndarray) -> np.ndarray:
        x, w = state
        fields = velocity.fields(x, w)
        v = quotient_velocity(velocity.flux(x, fields), fields[0], x)
        return np.stack([v, w * source(x) / fields[0]])

    state = ChebyshevStep(stages).advance(rate, np.stack([x, weights]), dt=dt, steps=steps)
    return state[0], state[1]


@dataclass(frozen=True)
class GaussianSource:
    """Q = q exp(-x^2), or its second derivative.

    Attributes
    ----------
    q : float
    derivative : int
        0 or 2. A source of derivative 2 has no total.
    """

    q: float
    derivative: int = 0

    @property
    def total(self) -> float:
        """int Q dx."""
        return self.q * math.sqrt(math.pi) if self.derivative == 0 else 0.0

    def rate(self, x: np.ndarray) -> np.ndarray:
        """Q(x)."""
        factor = 1.0 if self.derivative == 0 else 4.0 * x * x - 2.0
        return self.q * factor * np.exp(-x * x)

    def cumulative(self, x: np.ndarray) -> np.ndarray:
        """S^(x)."""
        if self.derivative == 0:
            return 0.5 * self.total * (1.0 + erf(x))
        return -2.0 * self.q * x * np.exp(-x * x)

    def solution(self, x: np.ndarray, t: float) -> np.ndarray:
        r"""f(x, t), from g(x, 0) = exp(-x^2) with the solution g(x, t) of the equation without a source.

        Derivative 2: f = g(x, t) + q (g(x, t) - g(x, 0)), as int_0^t g_xx ds = g(x, t) - g(x, 0). Derivative 0:
        f = g + q int_0^t g(x, s) ds, with w = 1 + 4 t and

            2 int_0^t g ds = [sqrt(w) exp(-x^2 / w) + sqrt(pi) |x| erf(|x| / sqrt(w))] - [the same at w = 1].
        """
        x = np.asarray(x, dtype=float)
        g, g0 = Gaussian().value(x, t), Gaussian().value(x, 0.0)
        if self.derivative == 2:
            return g + self.q * (g - g0)

        def antiderivative(w: float) -> np.ndarray:
            r = math.sqrt(w)
            return r * np.exp(-x * x / w) + math.sqrt(math.pi) * np.abs(x) * erf(np.abs(x) / r)

        return g + 0.5 * self.q * (antiderivative(1.0 + 4.0 * t) - antiderivative(1.0))
