r"""The marker method: dx_j/dt = V(x_j, t), W_j constant, Eqs. (5)-(7), for any velocity V = flux / F:

    F(x, t) = sum_j W_j S_eps(x - x_j),     f_t + (V f)_x = 0.                                   (6), (2)

The flux V F is a function of x and of F and its derivatives there. `diffusion` is that of (1), V = -F_x / F (3), with
which V is Eq. (7). It is the classical cousin of the diffusion velocity method (`schemes.dvm`), and moves by the same
midpoint steps, the second-order Runge-Kutta method of the paper (`lagrangian`). A run whose F is not positive at a
marker ends with `FieldNotPositive`, which says when and where.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.lagrangian import History, Observer, advance, quotient_velocity
from fracparticles.markers.shapes import Shape
from fracparticles.special.arguments import positive_real
from fracparticles.sums.scattered import NeighbourSum

__all__ = ["Flux", "MarkerRun", "MarkerVelocity", "diffusion", "run"]

# flux(x, fields), shape (N,): fields[m] is the m-th derivative of F at x.
Flux = Callable[[np.ndarray, np.ndarray], np.ndarray]


def diffusion(x: np.ndarray, fields: np.ndarray) -> np.ndarray:
    """-F_x, the flux of f_t = f_xx (1)."""
    return -fields[1]


class MarkerVelocity:
    """V(x_j) = flux / F, with F by (6).

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

    Raises
    ------
    InvalidInput
        If the shape function does not have these derivatives, or epsilon or the period does not do.
    """

    def __init__(
        self,
        shape: Shape,
        epsilon: float,
        flux: Flux = diffusion,
        derivatives: int = 1,
        period: float | None = None,
    ) -> None:
        self.shape, self.epsilon = shape, positive_real("epsilon", epsilon)
        self.flux, self.period = flux, period
        self._reach = shape.reach * self.epsilon
        if period is not None and not 2.0 * self._reach < positive_real("period", period):
            raise InvalidInput(
                "period", period, f"a length above {2.0 * self._reach:g}", "Take a longer period."
            )
        kernels = [shape.kernel(m) for m in range(derivatives + 1)]
        self._sums = NeighbourSum(kernels, self.epsilon)
        self._scale = self.epsilon ** -np.arange(derivatives + 1.0)[:, None]

    def fields(self, x: np.ndarray, weights: np.ndarray, z: np.ndarray | None = None) -> np.ndarray:
        """Return F and its derivatives, shape (derivatives + 1, M), at z or at the markers themselves."""
        if self.period is not None:
            z = x if z is None else z
            x, weights = self._continued(x, weights)
            z = np.mod(z, self.period)
        return self._scale * self._sums(x, weights, z)

    def __call__(self, x: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Return V at the markers.

        Raises
        ------
        FieldNotPositive
            If F vanishes or changes sign at a marker.
        """
        fields = self.fields(x, weights)
        return quotient_velocity(self.flux(x, fields), fields[0], x, self._sums.accuracy)

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

    def field(self, z: np.ndarray | None = None) -> np.ndarray:
        """Return F on a fixed grid z, or on the moving grid of the markers."""
        return self.velocity.fields(self.x, self.weights, z)[0]


def run(
    x: np.ndarray,
    weights: np.ndarray,
    velocity: MarkerVelocity,
    *,
    dt: float,
    steps: int,
    start: float = 0.0,
    observe: Observer | None = None,
) -> MarkerRun:
    """Advance the markers by `steps` midpoint steps.

    Raises
    ------
    InvalidInput
        If the arguments cannot be worked with.
    FieldNotPositive
        If F vanishes or changes sign at a marker; says when and where.
    NonFiniteSolution
        If the run cannot go on for another reason.
    """
    x, weights, history = advance(
        x, weights, velocity, dt=dt, steps=steps, start=start, observe=observe
    )
    return MarkerRun(x, weights, history, velocity)
