"""What the special functions accept: one place where arguments are checked and shapes restored."""

from __future__ import annotations

from collections.abc import Callable
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fracparticles.errors import InvalidInput

__all__ = [
    "dimension",
    "elementwise",
    "fractional_order",
    "positive_integer",
    "positive_real",
    "real_array",
]

FloatArray = NDArray[np.float64]


def real_array(field: str, value: Any) -> FloatArray:
    """Return `value` as a float64 array of its own shape.

    Raises
    ------
    InvalidInput
        If `value` is not real and numeric, or holds a nan.
    """
    try:
        array = np.asarray(value)
    except ValueError as error:  # a ragged list
        raise InvalidInput(
            field, value, "real numbers in an array of any shape", "Give rows of equal length."
        ) from error
    if array.dtype.kind not in "iuf":
        raise InvalidInput(field, value, "real numbers", "Give a number or an array of numbers.")
    array = array.astype(np.float64, copy=False)
    if np.isnan(array).any():
        raise InvalidInput(field, value, "real numbers without nan", "Remove the nan entries.")
    return array


def elementwise(
    function: Callable[..., None], array: FloatArray, *parameters: Any
) -> FloatArray | float:
    """Apply a compiled ``function(flat, *parameters, out)``; scalars come back as Python floats."""
    flat = np.ascontiguousarray(array).reshape(-1)
    out = np.empty_like(flat)
    function(flat, *parameters, out)
    return float(out[0]) if array.ndim == 0 else out.reshape(array.shape)


def _real(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool | np.bool_)


def fractional_order(alpha: Any) -> float:
    """Return the order alpha as a float.

    Raises
    ------
    InvalidInput
        If alpha is not a real number with 1 < alpha < 2.
    """
    if not (_real(alpha) and 1.0 < alpha < 2.0):
        raise InvalidInput(
            "alpha", alpha, "a number with 1 < alpha < 2", "Give alpha = 1 + beta, 0 < beta < 1."
        )
    return float(alpha)


def positive_real(field: str, value: Any) -> float:
    """Return a positive finite number as a float.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    if not (_real(value) and 0.0 < value < np.inf):
        raise InvalidInput(field, value, "a positive finite number", "Give a value above zero.")
    return float(value)


def positive_integer(field: str, value: Any) -> int:
    """Return a positive whole number as an int.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    if not (isinstance(value, int | np.integer) and not isinstance(value, bool) and value > 0):
        raise InvalidInput(field, value, "a whole number above zero", "Give 1, 2, 3, ...")
    return int(value)


def dimension(dim: Any) -> int:
    """Return the number of dimensions, 1 to 3, as an int.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    if not (isinstance(dim, int | np.integer) and not isinstance(dim, bool) and 1 <= dim <= 3):
        raise InvalidInput("dim", dim, "1, 2 or 3", "Give the number of space dimensions.")
    return int(dim)
