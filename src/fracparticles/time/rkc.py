r"""The stabilised Runge-Kutta-Chebyshev scheme RKC2, for y' = f(y) with a spectrum near the negative real axis.

Sommeijer, Shampine & Verwer, J. Comput. Appl. Math. 88 (1998) 315. One step of s >= 2 stages, with y_0 = y(t),

    y_1 = y_0 + m~_1 dt f(y_0),
    y_j = (1 - m_j - n_j) y_0 + m_j y_(j-1) + n_j y_(j-2) + m~_j dt f(y_(j-1)) + g_j dt f(y_0),    y(t + dt) = y_s,

    m_j = 2 b_j w_0 / b_(j-1),   n_j = -b_j / b_(j-2),   m~_j = 2 b_j w_1 / b_(j-1),   g_j = -a_(j-1) m~_j,
    b_j = T_j''(w_0) / T_j'(w_0)^2 (b_0 = b_1 = b_2),   a_j = 1 - b_j T_j(w_0),   m~_1 = b_1 w_1,
    w_0 = 1 + (2/13) / s^2,   w_1 = T_s'(w_0) / T_s''(w_0).

The scheme is explicit and of second order. It is stable for -(w_0 + 1) / w_1 <= z <= 0, an interval of about 0.65 s^2.
With the same number of evaluations it goes 0.65 s times as far as the midpoint rule.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

from fracparticles.arguments import (
    MOST_STEPS,
    finite_array,
    finite_real,
    function,
    positive_integer,
    positive_real,
)
from fracparticles.errors import InvalidInput, NonFiniteSolution

__all__ = ["ChebyshevStep", "stages_for"]

_DAMPING = 2.0 / 13.0  # (w_0 - 1) s^2, as in the paper
_MOST_STAGES = 250  # of a step: the round-off of more, about s^2 ulp, is too large

Rate = Callable[[np.ndarray], np.ndarray]


class ChebyshevStep:
    """RKC2 with a given number of stages.

    Parameters
    ----------
    stages : int
        s, from 2 to 250.

    Attributes
    ----------
    stability_interval : float
        The step is stable for -stability_interval <= z <= 0, z = lambda dt.

    Raises
    ------
    InvalidInput
        If the number of stages is not allowed.
    """

    def __init__(self, stages: int) -> None:
        s = positive_integer("stages", stages)
        if not 2 <= s <= _MOST_STAGES:
            raise InvalidInput("stages", s, f"from 2 to {_MOST_STAGES}", "Take another dt.")
        w0 = 1.0 + _DAMPING / s**2
        t, t1, t2 = (
            np.asarray(chebyshev.chebval(w0, chebyshev.chebder(np.eye(s + 1), m))) for m in range(3)
        )
        w1 = t1[s] / t2[s]
        b = np.empty(s + 1)
        b[2:] = t2[2:] / t1[2:] ** 2
        b[:2] = b[2]
        self.stages = s
        self.stability_interval = float((w0 + 1.0) / w1)
        self._first = b[1] * w1
        j = np.arange(2, s + 1)
        m, n, rate = 2.0 * b[j] * w0 / b[j - 1], -b[j] / b[j - 2], 2.0 * b[j] * w1 / b[j - 1]
        initial_rate = -(1.0 - b[j - 1] * t[j - 1]) * rate
        self._coefficients = np.column_stack([1.0 - m - n, m, n, rate, initial_rate])

    def __call__(self, f: Rate, y: np.ndarray, dt: float) -> np.ndarray:
        """Return y after one step, a new array of any shape; if it overflows it is infinite or nan, without a warning.

        Raises
        ------
        InvalidInput
            If f(y) has another shape than y.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            f0 = f(y)
            if np.shape(f0) != np.shape(y):
                allowed = f"rates of the shape of y, {np.shape(y)}"
                raise InvalidInput("f", f"of shape {np.shape(f0)}", allowed, "Mend the function.")
            before, stage = y, y + self._first * dt * f0
            for initial, last, last_but_one, rate, initial_rate in self._coefficients:
                new = initial * y + last * stage + last_but_one * before
                new += dt * (rate * f(stage) + initial_rate * f0)
                before, stage = stage, new
        return stage

    def advance(
        self,
        f: Rate,
        y: np.ndarray,
        *,
        dt: float,
        steps: int,
        start: float = 0.0,
        observe: Callable[[float, np.ndarray], None] | None = None,
    ) -> np.ndarray:
        """Return y after `steps` steps; observe(t, y) is called at the start and after every step.

        Raises
        ------
        InvalidInput
            If dt or steps is not positive, y or start is not finite, or f is not a function to rates of the shape of y.
        NonFiniteSolution
            If y is no longer finite, or if f raises it; the message names the step and the time.
        """
        dt, steps = positive_real("dt", dt), positive_integer("steps", steps, most=MOST_STEPS)
        f, start = function("f", f), finite_real("start", start)
        y = np.array(finite_array("y", y))
        if observe is not None:
            observe(start, y)
        for n in range(1, steps + 1):
            time = start + n * dt
            place = f"step {n} of {steps}, from t = {time - dt:.6g} to {time:.6g}"
            try:
                y = self(f, y, dt)
            except NonFiniteSolution as error:
                raise type(error)(f"{place}: {error}") from error
            if not np.isfinite(y).all():
                raise NonFiniteSolution(f"{place}: the solution is not finite. Take a smaller dt.")
            if observe is not None:
                observe(time, y)
        return y


def stages_for(z: float) -> int:
    """Return the least number of stages with a stability interval of z or more.

    Raises
    ------
    InvalidInput
        If z is not positive, or if more than 250 stages would be needed.
    """
    z = positive_real("z", z)
    # The interval is a little less than 2/3 (s^2 - 1): start there.
    for stages in range(max(2, int(np.sqrt(1.5 * z + 1.0))), _MOST_STAGES + 1):
        if ChebyshevStep(stages).stability_interval >= z:
            return stages
    raise InvalidInput(
        "z", z, f"what {_MOST_STAGES} stages can do, about 4e4", "Take a smaller dt."
    )
