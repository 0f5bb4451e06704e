"""Fractional orders: how far from an end, how they are written in a table; and errors in many digits."""

from typing import Any

import mpmath as mp


def distance(beta: float) -> float:
    """Return the distance of alpha = 1 + beta, as the double that it is, to the nearer end."""
    alpha = 1.0 + beta
    return min(alpha - 1.0, 2.0 - alpha)


def written(beta: float) -> str:
    """Return beta, or 1 minus it where it is above a half, with one digit."""
    return f"beta = {beta:.0e}" if beta < 0.5 else f"beta = 1 - {2.0 - (1.0 + beta):.0e}"


def relative(found: Any, exact: Any) -> float:
    """Return |found / exact - 1|."""
    return float(abs(mp.mpf(found) / exact - 1))
