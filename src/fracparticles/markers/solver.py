r"""The marker method: dx_j/dt = V(x_j, t), W_j constant, Eqs. (5)-(7), for any velocity V = flux / F:

    F(x, t) = sum_j W_j S_eps(x - x_j),     f_t + (V f)_x = 0.                                   (6), (2)

The flux V F is a function of x and of F and its derivatives there. `diffusion` is that of (1), V = -F_x / F (3), with
which V is Eq. (7). It is the classical cousin of the diffusion velocity method (`moving.dvm`), and moves by the same
midpoint steps, the second-order Runge-Kutta method of the paper (`moving.lagrangian`). A run whose F is not positive
at a marker ends with `FieldNotPositive`, which says when and where.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import FracparticlesError, InvalidInput, StabilityWarning
from fracparticles.markers.derivatives import warn_of_derivatives
from fracparticles.markers.edges import warn_of_edges
from fracparticles.markers.reliability import Steps, warn_of_waves
from fracparticles.markers.resolution import warn_of_resolution
from fracparticles.markers.shapes import Shape
from fracparticles.moving.lagrangian import History, Observer, advance, quotient_velocity
from fracparticles.moving.reliability import warn_of_round_off
from fracparticles.moving.scattered import NeighbourSum, ScatteredSum

__all__ = ["Flux", "MarkerRun", "MarkerVelocity", "diffusion", "run"]

# flux(x, fields), shape (N,): fields[m] is the m-th derivative of F at x.
Flux = Callable[[np.ndarray, np.ndarray], np.ndarray]


def diffusion(x: np.ndarray, fields: np.ndarray) -> np.ndarray:
    """-F_x, the flux of f_t = f_xx (1)."""
    return -fields[1]


class MarkerVelocity:
    """V(x_j) = flux / F, with F by (6).

    Raises `InvalidInput` if the shape function does not have these derivatives, the flux is not a function, or
    epsilon or the period is not allowed.

    Parameters
    ----------
    shape : Shape
    epsilon : float
        Support parameter.
    flux : callable
        flux(x, fields), shape (N,), with fields[m] = d^m F / dx^m at x for m = 0 to `derivatives`.
    derivatives : int
        The highest derivative that the flux needs.
    period : float or None
        If given, the markers are continued periodically; it must exceed twice the reach of the shape function.
    """

    def __init__(
        self,
        shape: Shape,
        epsilon: float,
        flux: Flux = diffusion,
        derivatives: int = 1,
        period: float | None = None,
    ) -> None:
        self.shape = check.instance("shape", shape, Shape)
        self.epsilon = check.scale("epsilon", epsilon)
        self.flux = check.function("flux", flux)
        self.period = None if period is None else check.scale("period", period)
        derivatives = check.whole_number("derivatives", derivatives)
        self._reach = shape.reach * self.epsilon
        if self.period is not None and not 2.0 * self._reach < self.period:
            allowed = f"a length above {2.0 * self._reach:g}"
            raise InvalidInput("period", period, allowed, "Take a longer period.")
        kernels = [shape.kernel(m) for m in range(derivatives + 1)]
        self._sums: ScatteredSum = NeighbourSum(kernels, self.epsilon)
        with np.errstate(over="ignore"):
            self._scale = self.epsilon ** -np.arange(derivatives + 1.0)[:, None]
        if not np.isfinite(self._scale / self.epsilon).all():
            allowed = "one whose powers do not overflow"
            raise InvalidInput("epsilon", epsilon, allowed, "Change the units.")

    def fields(self, x: Any, weights: Any, z: Any = None) -> np.ndarray:
        """Return F and its derivatives, shape (derivatives + 1, M), at z or at the markers themselves.

        Raises `InvalidInput` if the arrays do not fit together or are not finite.
        """
        if self.period is not None:
            x = check.positions("x", x)
            weights = check.vector("weights", weights, x.size)
            z = x if z is None else check.positions("z", z, least=0)
            x, weights = self._continued(x, weights)
            z = np.mod(z, self.period)
        return self._scale * self._sums(x, weights, z)

    def __call__(self, x: Any, weights: Any) -> np.ndarray:
        """Return V at the markers.

        Raises
        ------
        InvalidInput
            As `fields`; or if there are no markers.
        FieldNotPositive
            If F vanishes or changes sign at a marker.
        """
        fields = self.fields(x, weights)
        return quotient_velocity(self.flux(x, fields), fields[0], x, self._sums.accuracy)

    def field_alone(self, epsilon: float) -> MarkerVelocity:
        """Return the same with another epsilon, without derivatives: it says how much F depends on epsilon."""
        return MarkerVelocity(self.shape, epsilon, self.flux, 0, self.period)

    def _continued(self, x: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The markers of one period, and those that reach into it from the next."""
        assert self.period is not None
        x = np.mod(x, self.period)
        left, right = x > self.period - self._reach, x < self._reach
        return (
            np.concatenate([x, x[left] - self.period, x[right] + self.period]),
            np.concatenate([weights, weights[left], weights[right]]),
        )


@dataclass(frozen=True)
class MarkerRun:
    """The markers at the end of a run.

    Attributes
    ----------
    x, weights : array, shape (N,)
    history : History
    velocity : MarkerVelocity
    """

    x: np.ndarray
    weights: np.ndarray
    history: History
    velocity: MarkerVelocity

    def field(self, z: Any = None) -> np.ndarray:
        """Return F on a fixed grid z, or on the moving grid of the markers."""
        return self.velocity.fields(self.x, self.weights, z)[0]


def run(
    x: Any,
    weights: Any,
    velocity: MarkerVelocity,
    *,
    dt: float,
    steps: int,
    start: float = 0.0,
    observe: Observer | None = None,
) -> MarkerRun:
    """Advance the markers by `steps` midpoint steps: x* = x + dt/2 V(x), x <- x + dt V(x*).

    Parameters
    ----------
    x, weights : array_like, shape (N,)
        Positions x_j and weights W_j at the start.
    velocity : MarkerVelocity
        V, with its shape function and epsilon.
    dt, steps : float, int
    start : float
        The time at the start, for the history, the observer and messages.
    observe : callable, optional
        observe(t, x, weights), called at the start and after every step.

    Raises
    ------
    InvalidInput
        If the arguments cannot be worked with.
    FieldNotPositive
        If F vanishes or changes sign at a marker; says when and where.
    NonFiniteSolution
        If the run cannot go on for another reason.

    Warns
    -----
    StabilityWarning
        If waves of the markers' places grow, because of dt or of the shape function (`reliability`); or if a half step
        takes most of the markers farther from all others than the shape function reaches. F at such a marker is its
        own only.
    AccuracyWarning
        If the markers are too far apart for epsilon or for the derivatives of the flux, or lie too irregularly; if
        epsilon or dt is too large for the field, or epsilon for a jump at their ends; or if the markers are so far from
        zero that their places lose digits.
    """
    check.instance("velocity", velocity, MarkerVelocity)
    x = check.positions("x", x)
    weights, dt = check.vector("weights", weights, x.size), check.scale("dt", dt)
    steps = check.positive_integer("steps", steps, most=check.MOST_STEPS)
    warn_of_waves(velocity, x, weights, Steps(dt, steps))
    warn_of_round_off(x, steps, velocity.epsilon)
    _warn_of_tearing(x, weights, velocity, dt)
    at_start = x, weights
    x, weights, history = advance(
        x, weights, velocity, dt=dt, steps=steps, start=start, observe=observe
    )
    warn_of_resolution(velocity, Steps(dt, steps), at_start, (x, weights))
    warn_of_derivatives(velocity, *at_start)
    warn_of_edges(velocity, *at_start, Steps(dt, steps))
    return MarkerRun(x, weights, history, velocity)


def _warn_of_tearing(x: np.ndarray, weights: np.ndarray, velocity: Any, dt: float) -> None:
    try:
        with np.errstate(over="ignore", invalid="ignore"):
            halfway = x + 0.5 * dt * velocity(x, weights)
    except FracparticlesError:
        return  # the run will say so, with the step
    reach = velocity.shape.reach * velocity.epsilon
    alone = _alone(halfway, reach)
    if alone > 0.5 * x.size >= _alone(x, reach):
        warnings.warn(
            f"dt = {dt:g}: half a step takes {alone} of {x.size} markers out of the reach {reach:.3g} of all others, "
            "where they stand still or move at random. Take a smaller dt, or a larger epsilon.",
            StabilityWarning,
            stacklevel=3,
        )


def _alone(x: np.ndarray, reach: float) -> int:
    """How many markers have no other within reach."""
    gap = np.concatenate([[np.inf], np.diff(np.sort(x)), [np.inf]])
    return int(np.count_nonzero((gap[1:] > reach) & (gap[:-1] > reach)))
