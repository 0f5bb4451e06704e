"""The fractional order by either of its names: beta, as the papers have it, or alpha = 1 + beta."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

from fracparticles.arguments import real_between
from fracparticles.errors import InvalidInput

__all__ = ["ALPHA", "with_beta"]

ALPHA = "Order alpha = 1 + beta of the equation. Instead of beta; between 1 and 2 (exclusive)."


def with_beta(fields: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of a case with beta = alpha - 1 for alpha.

    The difference is taken of the decimals: alpha = 1.3 gives beta = 0.3 exactly, so that both are the same case.

    Raises
    ------
    InvalidInput
        If both are given, or alpha is not between 1 and 2.
    """
    if fields.get("alpha") is None:
        return {name: value for name, value in fields.items() if name != "alpha"}
    others = dict(fields)
    alpha = others.pop("alpha")
    if others.get("beta") is not None:
        one = f"nothing beside beta = {others['beta']}, since alpha = 1 + beta"
        raise InvalidInput("alpha", alpha, one, "Leave one of them out.")
    remedy = "Give alpha = 1 + beta, 0 < beta < 1."
    exact = real_between(
        "alpha", alpha, 1.0, 2.0, inside=True, remedy=remedy, allowed="a number with 1 < alpha < 2"
    )
    return {**others, "beta": float(Decimal(repr(exact)) - 1)}
