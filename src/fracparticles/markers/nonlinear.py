r"""Nonlinear diffusion with a source, Sec. 3:

    f_t = (D f_x)_x + Q(x),     D = D_0 f exp(-f),                                                (20)
    Q = -D_0 exp(-F) (F F_xx + (1 - F) F_x^2),     F = f_inf,                                      (21)
    V = -(D f_x + S^) / f,     S^(x) = int_-inf^x Q dx',                                      (22), (23)
    f_inf = exp(-a (x + x_0)^2) + exp(-a (x - x_0)^2),     f_0 = exp(-x^2).                   (24), (25)

(21) is -(D(f_inf) f_inf')', so that the integral (23) is -D(f_inf) f_inf': it takes no table.
With Phi(f) = int_0^f D df' = D_0 (1 - (1 + f) exp(-f)), (20) reads

    f_t = (Phi(f) - Phi(f_inf))_xx.

Where f = 0, D is zero and f_t = Q + D_0 f_x^2. In the flanks of f_inf, Q < 0: nothing in (20) keeps f positive there,
and for f < 0 the diffusion coefficient is negative. `positivity_lost` finds where and when this happens.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import polynomial
from scipy.integrate import solve_ivp
from scipy.sparse import diags

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput, NonFiniteSolution

__all__ = ["Lines", "NonlinearDiffusion"]


_SMALL = 0.5  # f: below, the two terms of Phi cancel
# Phi / (D_0 f^2) = sum_k (-f)^k / (k! (k + 2)): 16 terms leave 2e-19 at f = 1/2.
_SERIES = np.array([(-1.0) ** k / (math.factorial(k) * (k + 2)) for k in range(16)])
_UNDERFLOW = 800.0  # exp(-800) is 0
_MOST_CELLS = 10**6


@dataclass(frozen=True)
class NonlinearDiffusion:
    """Equations (20)-(24).

    Raises `InvalidInput` if a value is outside its range; so do the methods; they take arrays of any shape.

    Attributes
    ----------
    d0, alpha, x0 : float
        D_0, a and x_0, positive.
    """

    d0: float = 10.0
    alpha: float = 4.0
    x0: float = 0.5

    def __post_init__(self) -> None:
        check.fields(self, d0=check.scale, alpha=check.scale, x0=check.scale)

    @property
    def largest_diffusivity(self) -> float:
        """D_0 / e, the maximum of D, at f = 1."""
        return self.d0 / math.e

    def diffusivity(self, f: Any) -> np.ndarray:
        """D(f)."""
        f = check.finite_array("f", f)
        with np.errstate(over="ignore"):
            return check.finite_result("f", self._diffusivity(f))

    def potential(self, f: Any) -> np.ndarray:
        """Phi(f), without cancellation for small f."""
        f = check.finite_array("f", f)
        small = np.clip(f, -_SMALL, _SMALL)
        with np.errstate(over="ignore", invalid="ignore"):
            series = self.d0 * (small * small * polynomial.polyval(small, _SERIES))
            return check.finite_result(
                "f", np.where(np.abs(f) < _SMALL, series, self._potential(f))
            )

    def steady(self, x: Any, derivative: int = 0) -> np.ndarray:
        """f_inf (24), or its first or second derivative."""
        return self._steady(
            check.places("x", x), check.whole_number("derivative", derivative, most=2)
        )

    def steady_beyond(self, x: float) -> float:
        """Return int f_inf over |x'| > x, for x >= 0."""
        x, root = check.not_negative("x", x), math.sqrt(self.alpha)
        both = sum(math.erfc(root * (x + side * self.x0)) for side in (1, -1))
        return math.sqrt(math.pi) / root * both

    def source(self, x: Any) -> np.ndarray:
        """Q (21)."""
        x = check.places("x", x)
        f, slope, curvature = (self._steady(x, m) for m in range(3))
        return -self.d0 * np.exp(-f) * (f * curvature + (1.0 - f) * slope * slope)

    def cumulative_source(self, x: Any) -> np.ndarray:
        """S^ (23)."""
        return self._cumulative_source(check.places("x", x))

    def _diffusivity(self, f: np.ndarray) -> np.ndarray:
        return self.d0 * (f * np.exp(-f))

    def _potential(self, f: np.ndarray) -> np.ndarray:
        """Phi to round-off of its largest values, which is what its differences have."""
        return self.d0 * (-np.expm1(-f) - f * np.exp(-f))

    def _steady(self, x: np.ndarray, derivative: int) -> np.ndarray:
        total = np.zeros_like(x)
        farthest = math.sqrt(_UNDERFLOW / self.alpha)
        for y in (x + self.x0, x - self.x0):
            y = np.clip(y, -farthest, farthest)
            factor = (1.0, -2.0 * self.alpha * y, (2.0 * self.alpha * y) ** 2 - 2.0 * self.alpha)
            total = total + factor[derivative] * np.exp(-self.alpha * y * y)
        return total

    def _cumulative_source(self, x: np.ndarray) -> np.ndarray:
        f = self._steady(x, 0)
        return -self._diffusivity(f) * self._steady(x, 1)

    def flux(self, x: np.ndarray, fields: np.ndarray) -> np.ndarray:
        """V F by (22), for `markers.solver.MarkerVelocity`, which has checked the arrays."""
        return -self._diffusivity(fields[0]) * fields[1] - self._cumulative_source(x)

    def step_limit(self, epsilon: float, eta: float) -> float:
        """eta epsilon^2 / max D: the limit of the linear equation (`stability.Extremes.eta`) at the largest D."""
        eta, epsilon = check.positive_real("eta", eta), check.scale("epsilon", epsilon)
        return eta * epsilon**2 / self.largest_diffusivity


class Lines:
    """(20) by finite volumes on |x| < L and scipy's BDF formulae: a reference without markers.

        df_i/dt = (g_(i+1) - 2 g_i + g_(i-1)) / h^2,     g = Phi(f) - Phi(f_inf),     no flux through the ends.

    Raises `InvalidInput` if a value is outside its range, or no cell is watched.

    Parameters
    ----------
    problem : NonlinearDiffusion
    half_width : float
        L.
    cells : int
        From 3 to 1e6.
    within : float
        Where f is watched: |x| < within. It may be less than L, since f is round-off in the far tail.
    """

    def __init__(
        self, problem: NonlinearDiffusion, half_width: float, cells: int, within: float
    ) -> None:
        self.problem = check.instance("problem", problem, NonlinearDiffusion)
        n = check.whole_number("cells", cells, 3, _MOST_CELLS)
        half = check.scale("half_width", half_width)
        self.h = 2.0 * half / n
        self.x = -half + self.h * (np.arange(n) + 0.5)
        self._steady = problem._potential(problem.steady(self.x))
        self._inside = np.abs(self.x) < check.positive_real("within", within)
        if not self._inside.any():
            raise InvalidInput("within", within, f"above {np.abs(self.x).min():g}", "Watch a cell.")

    def rate(self, t: float, f: Any) -> np.ndarray:
        """df/dt, for f of shape (cells,)."""
        f = check.operand("f", f, self.x.shape)
        jump = np.diff(self.problem._potential(f) - self._steady, prepend=np.nan, append=np.nan)
        jump[[0, -1]] = 0.0
        return np.diff(jump) / self.h**2

    def jacobian(self, t: float, f: Any) -> Any:
        """The tridiagonal derivative of `rate`."""
        f = check.operand("f", f, self.x.shape)
        d = self.problem._diffusivity(f) / self.h**2
        inner = np.full(f.size, -2.0)
        inner[[0, -1]] = -1.0
        return diags([d[:-1], inner * d, d[1:]], [-1, 0, 1], format="csc")

    def solve(self, f: Any, times: Any) -> np.ndarray:
        """Return f at the times, shape (times, cells), from t = 0.

        Parameters
        ----------
        f : array_like, shape (cells,)
            At t = 0; zero or more, and positive where it is watched.
        times : array_like, shape (times,)
            Rising, zero or more, the last above zero.

        Raises
        ------
        InvalidInput
            If f or the times are not of this kind.
        NonFiniteSolution
            If f does not stay positive so long.
        """
        times = check.within("times", check.vector("times", times), 0.0, 1e100)
        if not ((np.diff(times) > 0.0).all() and times[-1] > 0.0):
            raise InvalidInput("times", times, "rising ones, the last above zero", "Sort them.")
        found = self._integrate(self._initial(f), float(times[-1]), times)
        if found.t_events[0].size or not found.success:
            t = found.t_events[0][0] if found.t_events[0].size else found.t[-1]
            raise NonFiniteSolution(
                f"f does not stay positive: it vanishes at t = {t:.6g}, and (20) has no meaning beyond. "
                "Ask for earlier times."
            )
        return found.y.T

    def positivity_lost(self, f: Any, until: float) -> tuple[float, float]:
        """Return t and |x| where f first vanishes; infinite and nan if it does not before `until`.

        Raises
        ------
        InvalidInput
            If `solve` would refuse f, or `until` is not positive.
        NonFiniteSolution
            If the integration ends before.
        """
        found = self._integrate(self._initial(f), check.scale("until", until), None)
        if not found.success:
            end = found.t[-1]
            raise NonFiniteSolution(f"the integration ends at t = {end:.6g}: {found.message}")
        if not found.t_events[0].size:
            return math.inf, math.nan
        last = found.y_events[0][0]
        inside = np.flatnonzero(self._inside)
        return float(found.t_events[0][0]), float(abs(self.x[inside[np.argmin(last[inside])]]))

    def _initial(self, f: Any) -> np.ndarray:
        f = check.within("f", check.vector("f", f, self.x.size), 0.0)
        check.within("f", f[self._inside], 0.0, inside=True)
        return f

    def _integrate(self, f: np.ndarray, until: float, times: np.ndarray | None) -> Any:
        def lowest(t: float, f: np.ndarray) -> float:
            return f[self._inside].min()

        lowest.terminal = True  # type: ignore[attr-defined]
        with np.errstate(all="ignore"):  # scipy works on numbers that it has not set yet
            return solve_ivp(
                self.rate, (0.0, until), f, method="BDF", t_eval=times, jac=self.jacobian,
                events=lowest, rtol=1e-8, atol=1e-11,
            )  # fmt: skip
