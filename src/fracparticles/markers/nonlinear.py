r"""Nonlinear diffusion with a source, Sec. 3:

    f_t = (D f_x)_x + Q(x),     D = D_0 f exp(-f),                                                (20)
    Q = -D_0 exp(-F) (F F_xx + (1 - F) F_x^2),     F = f_inf,                                      (21)
    V = -(D f_x + S^) / f,     S^(x) = int_-inf^x Q dx',                                      (22), (23)
    f_inf = exp(-a (x + x_0)^2) + exp(-a (x - x_0)^2),     f_0 = exp(-x^2).                   (24), (25)

(21) is -(D(f_inf) f_inf')', so that the integral (23) is -D(f_inf) f_inf': it takes no table.
With Phi(f) = int_0^f D df' = D_0 (1 - (1 + f) exp(-f)), (20) reads

    f_t = (Phi(f) - Phi(f_inf))_xx.

Where f = 0, D is nil and f_t = Q + D_0 f_x^2. In the flanks of f_inf, Q < 0: nothing in (20) keeps f positive there,
and for f < 0 the diffusion coefficient is negative. `positivity_lost` finds where and when that happens.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.sparse import diags

from fracparticles.errors import NonFiniteSolution
from fracparticles.special.arguments import positive_integer, positive_real

__all__ = ["Lines", "NonlinearDiffusion"]


@dataclass(frozen=True)
class NonlinearDiffusion:
    """Equations (20)-(24).

    Attributes
    ----------
    d0, alpha, x0 : float
        D_0, a and x_0.
    """

    d0: float = 10.0
    alpha: float = 4.0
    x0: float = 0.5

    def __post_init__(self) -> None:
        for name in ("d0", "alpha", "x0"):
            positive_real(name, getattr(self, name))

    @property
    def largest_diffusivity(self) -> float:
        """D_0 / e, the maximum of D, at f = 1."""
        return self.d0 / math.e

    def diffusivity(self, f: np.ndarray) -> np.ndarray:
        """D(f)."""
        return self.d0 * f * np.exp(-f)

    def potential(self, f: np.ndarray) -> np.ndarray:
        """Phi(f), without cancellation for small f."""
        return self.d0 * (-np.expm1(-f) - f * np.exp(-f))

    def steady(self, x: np.ndarray, derivative: int = 0) -> np.ndarray:
        """f_inf (24), or its first or second derivative."""
        total = np.zeros_like(np.asarray(x, dtype=float))
        for y in (x + self.x0, x - self.x0):
            factor = (1.0, -2.0 * self.alpha * y, (2.0 * self.alpha * y) ** 2 - 2.0 * self.alpha)
            total = total + factor[derivative] * np.exp(-self.alpha * y * y)
        return total

    def source(self, x: np.ndarray) -> np.ndarray:
        """Q (21)."""
        f, slope, curvature = (self.steady(x, m) for m in range(3))
        return -self.d0 * np.exp(-f) * (f * curvature + (1.0 - f) * slope * slope)

    def cumulative_source(self, x: np.ndarray) -> np.ndarray:
        """S^ (23)."""
        f = self.steady(x)
        return -self.diffusivity(f) * self.steady(x, 1)

    def flux(self, x: np.ndarray, fields: np.ndarray) -> np.ndarray:
        """V F by (22), for `markers.solver.MarkerVelocity`."""
        return -self.diffusivity(fields[0]) * fields[1] - self.cumulative_source(x)

    def step_limit(self, epsilon: float, eta: float) -> float:
        """eta epsilon^2 / max D: the limit of the linear equation (`stability.Extremes.eta`) at the largest D."""
        return eta * positive_real("epsilon", epsilon) ** 2 / self.largest_diffusivity


class Lines:
    """(20) by finite volumes on |x| < L and scipy's BDF formulae: a reference without markers.

        df_i/dt = (g_(i+1) - 2 g_i + g_(i-1)) / h^2,     g = Phi(f) - Phi(f_inf),     no flux through the ends.

    Parameters
    ----------
    problem : NonlinearDiffusion
    half_width : float
        L.
    cells : int
    within : float
        Where f is watched: |x| < within. It may be less than L, since f is round-off in the far tail.
    """

    def __init__(
        self, problem: NonlinearDiffusion, half_width: float, cells: int, within: float
    ) -> None:
        self.problem = problem
        n, half = positive_integer("cells", cells), positive_real("half_width", half_width)
        self.h = 2.0 * half / n
        self.x = -half + self.h * (np.arange(n) + 0.5)
        self._steady = problem.potential(problem.steady(self.x))
        self._inside = np.abs(self.x) < within

    def rate(self, t: float, f: np.ndarray) -> np.ndarray:
        """df/dt."""
        jump = np.diff(self.problem.potential(f) - self._steady, prepend=np.nan, append=np.nan)
        jump[[0, -1]] = 0.0
        return np.diff(jump) / self.h**2

    def jacobian(self, t: float, f: np.ndarray) -> Any:
        """The tridiagonal derivative of `rate`."""
        d = self.problem.diffusivity(f) / self.h**2
        inner = np.full(f.size, -2.0)
        inner[[0, -1]] = -1.0
        return diags([d[:-1], inner * d, d[1:]], [-1, 0, 1], format="csc")

    def solve(self, f: np.ndarray, times: Sequence[float]) -> np.ndarray:
        """Return f at the times, shape (times, cells), from t = 0.

        Raises
        ------
        NonFiniteSolution
            If f does not stay positive so long.
        """
        found = self._integrate(f, max(times), times)
        if found.t_events[0].size or not found.success:
            t = found.t_events[0][0] if found.t_events[0].size else found.t[-1]
            raise NonFiniteSolution(
                f"f does not stay positive: it vanishes at t = {t:.6g}, and (20) has no meaning beyond. "
                "Ask for earlier times."
            )
        return found.y.T

    def positivity_lost(self, f: np.ndarray, until: float) -> tuple[float, float]:
        """Return t and |x| where f first vanishes; infinite and nan if it does not before `until`."""
        found = self._integrate(f, until, None)
        if not found.t_events[0].size:
            return math.inf, math.nan
        last = found.y_events[0][0]
        inside = np.flatnonzero(self._inside)
        return float(found.t_events[0][0]), float(abs(self.x[inside[np.argmin(last[inside])]]))

    def _integrate(self, f: np.ndarray, until: float, times: Sequence[float] | None) -> Any:
        def lowest(t: float, f: np.ndarray) -> float:
            return f[self._inside].min()

        lowest.terminal = True  # type: ignore[attr-defined]
        return solve_ivp(
            self.rate, (0.0, until), f, method="BDF", t_eval=times, jac=self.jacobian,
            events=lowest, rtol=1e-8, atol=1e-11,
        )  # fmt: skip
