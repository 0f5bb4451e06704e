r"""The share of the errors of early steps in a solution that fades.

A step at the time s is accurate to the tolerance times |u(s)|. Two solutions of u_t = A u + f(x, t, u) come closer at
least at the rate r = lambda_1 - max df/du, where lambda_1 >= 0 is the least eigenvalue of -A. The errors at t over
|u(t)| are therefore

    tolerance max_s |u(s)| e^(-r (t - s)) / |u(t)|.

Where the exterior values are zero and f(x, t, 0) = 0, zero is a solution and u the difference of two solutions. Then no
error outlasts u, and the share is the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

__all__ = ["FADED", "early_errors", "slope_of"]

FADED = 0.01  # share of u: larger errors are warned of
_SMALL = 1e-8  # relative change of u in the difference for df/du

Source = Callable[[float, np.ndarray], np.ndarray]
"""f(t, u), between fields."""


def slope_of(f: Source, t: float, u: np.ndarray) -> np.ndarray:
    """Return df/du, by a difference."""
    small = _SMALL * (float(np.abs(u).max()) or 1.0)
    return np.asarray((f(t, u + small) - f(t, u)) / small)


def early_errors(
    tolerance: float,
    times: Sequence[float],
    fields: Sequence[np.ndarray],
    f: Source | None,
    slowest: Callable[[], float],
    held: Callable[[float], float] | None = None,
) -> list[float]:
    """Return the share of the errors in u at each time but the first, from u at this time and at the times before.

    Parameters
    ----------
    tolerance : float
        The relative error of a step.
    times, fields : sequences
        The times, and u at each of them.
    f : callable or None
        The source.
    slowest : callable
        It returns lambda_1, and is called only if u has faded.
    held : callable, optional
        The largest exterior value as a function of time; the errors are then at least the tolerance times it.
    """
    t, sizes = np.asarray(times), np.array([float(np.abs(u).max()) for u in fields])
    least = np.array([0.0 if held is None else held(time) for time in times])
    early, rate = np.maximum(sizes, least), 0.0

    def shares() -> list[float]:
        found = []
        for n in range(1, t.size):
            left = float((early[: n + 1] * np.exp(-rate * (t[n] - t[: n + 1]))).max())
            found.append(tolerance * (left / sizes[n]) if left else 0.0)
        return found

    with np.errstate(all="ignore"):
        if max(shares()) <= FADED:
            return shares()
        nothing = np.zeros_like(fields[0])
        if not least.any() and (f is None or not any(f(time, nothing).any() for time in times)):
            return [tolerance] * (t.size - 1)
        slopes = [slope_of(f, *at).max() for at in zip(times, fields, strict=True)] if f else [0.0]
        rate = float(slowest() - max(slopes))
        return shares() if np.isfinite(rate) else [np.inf] * (t.size - 1)
