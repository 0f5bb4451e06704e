"""The order of a problem, given as alpha or as beta, by any kind of coefficient."""

from __future__ import annotations

from functools import wraps
from typing import Any

import numpy as np

from fracparticles.run.fractional_order import with_beta

__all__ = ["with_any_order"]


def with_any_order(fields: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of a problem with beta = alpha - 1 in place of alpha, for any kind of coefficient."""
    alpha, beta = fields.get("alpha"), fields.get("beta")
    if beta is not None or not (isinstance(alpha, str) or callable(alpha)):
        return with_beta(fields)
    others = {name: value for name, value in fields.items() if name not in ("alpha", "beta")}
    if isinstance(alpha, str):
        return {**others, "beta": f"({alpha}) - 1"}
    return {**others, "beta": _less_one(alpha)}


def _less_one(alpha: Any) -> Any:
    @wraps(alpha)
    def beta(*points: np.ndarray) -> Any:
        return np.asarray(alpha(*points)) - 1.0

    return beta
