r"""Diffusion with a source, f_t = f_xx + Q(x), Sec. 2.1, in two ways.

- As in the paper: the source is part of the velocity, and the weights are constant,

      V = -(f_x + S^(x)) / f,     S^(x) = int_-inf^x Q dx'.

  It keeps sum_j W_j, but the equation gains int Q dx per unit of time: it can serve only a source of no total.
- The source changes the weights, the velocity stays (3):

      dx_j/dt = -F_x / F,     dW_j/dt = W_j Q(x_j) / F(x_j),

  for any source where there are markers: sum_j dW_j/dt g(x_j) is int Q g dx for markers of volume W_j / F.

`GaussianSource` has Q = q exp(-x^2) or q exp(-x^2)'', with the solutions from f_0 = exp(-x^2).
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import erf, erfc

from fracparticles import arguments as check
from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution
from fracparticles.markers.edges import warn_of_edges
from fracparticles.markers.profiles import Gaussian
from fracparticles.markers.reliability import Steps, warn_of_waves
from fracparticles.markers.resolution import warn_of_resolution
from fracparticles.markers.solver import Flux, MarkerVelocity
from fracparticles.moving.lagrangian import quotient_velocity
from fracparticles.moving.reliability import warn_of_round_off
from fracparticles.time.rkc import ChebyshevStep

__all__ = ["GaussianSource", "advance_weights", "source_flux"]

_AROUND = 1  # the source is looked for so far beyond the markers, in units of their span
_BETWEEN = 4  # half the points of that search from a marker to the next, on the mean
_MISSED = 0.1  # of int |Q|: what the markers may miss
_FAR = 10.0  # |x| beyond which both brackets of the solution go without the term that they share

Function = Callable[[np.ndarray], np.ndarray]


def source_flux(cumulative: Function) -> Flux:
    """Return the paper's flux V F = -F_x - S^(x).

    Raises `InvalidInput` if S^ is not a function.
    """
    cumulative = check.function("cumulative", cumulative)

    def flux(x: np.ndarray, fields: np.ndarray) -> np.ndarray:
        return -fields[1] - cumulative(x)

    return flux


def advance_weights(
    x: Any,
    weights: Any,
    velocity: MarkerVelocity,
    source: Function,
    *,
    dt: float,
    steps: int,
    stages: int = 2,
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and weights after `steps` steps of RKC2, with weights that the source changes; shape (N,) each.

    Parameters
    ----------
    x, weights : array_like, shape (N,)
        Positions x_j and weights W_j at the start.
    velocity : MarkerVelocity
        That of (3), without the source.
    source : callable
        Q(x).
    dt, steps : float, int
    stages : int
        Of a step of RKC2: more allow a larger dt.

    Raises
    ------
    InvalidInput
        If an argument cannot be worked with.
    FieldNotPositive
        If F is not positive at a marker; says when and where.
    NonFiniteSolution
        If a weight changes its sign, which no weight of the equation does; says when and where.

    Warns
    -----
    StabilityWarning
        If dt is too large for these stages, or waves of the markers' places grow: see `reliability`.
    AccuracyWarning
        If the markers are too far apart for epsilon, or epsilon is too large for the field or for a jump at their ends;
        or if the weights do not gain int |Q| dx: the source is where no markers are, or narrower than their distance.
    """
    check.instance("velocity", velocity, MarkerVelocity)
    x, source = check.positions("x", x), check.function("source", source)
    weights, dt = check.vector("weights", weights, x.size), check.scale("dt", dt)
    steps = check.positive_integer("steps", steps, most=check.MOST_STEPS)
    step = ChebyshevStep(stages)
    taken = Steps(dt, steps, np.exp, step.stability_interval)
    warn_of_waves(velocity, x, weights, taken)
    warn_of_round_off(x, steps, velocity.epsilon)
    sign = np.sign(weights)

    def rate(state: np.ndarray) -> np.ndarray:
        x, w = state
        fields = velocity.fields(x, w)
        v = quotient_velocity(velocity.flux(x, fields), fields[0], x)
        return np.stack([v, w * check.operand("source", source(x), x.shape) / fields[0]])

    def observe(t: float, state: np.ndarray) -> None:
        turned = np.sign(state[1]) != sign
        if turned.any():
            raise NonFiniteSolution(
                f"t = {t:.6g}: the weight of the marker at x = {state[0][turned][0]:.6g} changes its sign, "
                "which dW/dt = W Q / F never does. Take a smaller dt."
            )

    _warn_of_what_is_missed(velocity, x, weights, source)
    state = step.advance(rate, np.stack([x, weights]), dt=dt, steps=steps, observe=observe)
    warn_of_resolution(velocity, taken, (x, weights), (state[0], state[1]))
    warn_of_edges(velocity, x, weights, taken)
    return state[0], state[1]


def _warn_of_what_is_missed(
    velocity: MarkerVelocity, x: np.ndarray, weights: np.ndarray, source: Function
) -> None:
    """Warn if sum_j |W_j Q_j / F_j| is not int |Q| dx, around the markers and by some points from one to the next."""
    field = velocity.fields(x, weights)[0]
    if not (field > 0.0).all():
        return  # the run will say so
    low, high = float(x.min()), float(x.max())
    around = (high - low) * _AROUND
    if velocity.period is not None:
        low, high, around = 0.0, velocity.period, 0.0
    line = np.linspace(low - around, high + around, 2 * x.size * (1 + 2 * _AROUND) * _BETWEEN + 1)
    with np.errstate(all="ignore"):
        q = np.nan_to_num(np.broadcast_to(np.abs(source(line)), line.shape), posinf=0.0)
        given = float(np.sum(np.abs(weights * source(x)) / field))
    total = float(np.trapezoid(q, line))
    missed = abs(given - total) / max(given, total) if max(given, total) > 0.0 else 0.0
    if missed > _MISSED:
        warnings.warn(
            f"the weights gain {given:.3g} a unit of time of the {total:.3g} that the source has in and around the "
            "markers: it is where they are not, or narrower than their distance. Take markers there, or more.",
            AccuracyWarning,
            stacklevel=3,
        )


@dataclass(frozen=True)
class GaussianSource:
    """Q = q exp(-x^2), or its second derivative.

    Raises `InvalidInput` if q is not finite, or the derivative another; so do the methods, of x and t outside their
    range.

    Attributes
    ----------
    q : float
    derivative : int
        0 or 2. A source of derivative 2 has no total.
    """

    q: float
    derivative: int = 0

    def __post_init__(self) -> None:
        check.fields(self, q=check.finite_real, derivative=_zero_or_two)

    @property
    def total(self) -> float:
        """int Q dx."""
        return self.q * math.sqrt(math.pi) if self.derivative == 0 else 0.0

    def rate(self, x: Any) -> np.ndarray:
        """Q(x)."""
        x = check.places("x", x)
        factor = 1.0 if self.derivative == 0 else 4.0 * x * x - 2.0
        with np.errstate(over="ignore"):
            return check.finite_result("q", self.q * (factor * np.exp(-x * x)))

    def cumulative(self, x: Any) -> np.ndarray:
        """S^(x)."""
        x = check.places("x", x)
        if self.derivative == 0:
            return 0.5 * self.total * erfc(-x)
        with np.errstate(over="ignore"):
            return check.finite_result("q", self.q * (-2.0 * x * np.exp(-x * x)))

    def solution(self, x: Any, t: float) -> np.ndarray:
        r"""f(x, t), from g(x, 0) = exp(-x^2) with the solution g(x, t) of the equation without a source.

        Derivative 2: f = g(x, t) + q (g(x, t) - g(x, 0)), as int_0^t g_xx ds = g(x, t) - g(x, 0). Derivative 0:
        f = g + q int_0^t g(x, s) ds, with w = 1 + 4 t and

            2 int_0^t g ds = [sqrt(w) exp(-x^2 / w) + sqrt(pi) |x| erf(|x| / sqrt(w))] - [the same at w = 1].
        """
        x, t = check.places("x", x), check.not_negative("t", t)
        g, g0 = Gaussian().value(x, t), Gaussian().value(x, 0.0)
        if self.derivative == 2:
            with np.errstate(over="ignore"):
                return check.finite_result("q", g + self.q * (g - g0))

        def antiderivative(w: float) -> np.ndarray:
            r = math.sqrt(w)
            z = np.abs(x) / r
            # Far out the two brackets share sqrt(pi) |x|, which leaves no digit of their difference.
            part = np.where(np.abs(x) > _FAR, -erfc(z), erf(z))
            return r * np.exp(-x * x / w) + math.sqrt(math.pi) * np.abs(x) * part

        gained = antiderivative(1.0 + 4.0 * t) - antiderivative(1.0)
        with np.errstate(over="ignore"):
            return check.finite_result("q", g + 0.5 * self.q * gained)


def _zero_or_two(field: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value not in (0, 2):
        raise InvalidInput(field, value, "0 or 2", "Give q exp(-x^2) or its second derivative.")
    return int(value)
