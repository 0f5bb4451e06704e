"""What public functions accept: one place where arguments are checked and shapes restored.

A check takes the name of an argument and what was given, and returns it as a number or an array of its own kind, or
raises `InvalidInput` with that name before any work starts. Nothing else is raised, whatever was given.

- One number: `finite_real`, `positive_real`, `real_between`, `scale`, `whole_number`, `positive_integer`, `dimension`,
  `fractional_order`.
- Arrays: `real_array` (infinite entries too), `finite_array`, `vector`, `places`, `positions`, and `within` for their
  range; `operand` for the arrays of an inner loop, whose entries are not looked at.
- Other things: `choice`, `flag`, `function`, `generator`, `instance`, `pair`.
- What comes back: `sampled` from a function of the caller's, `finite_result` from sums that may overflow.

`check_fields` puts the checks on the fields of a frozen dataclass.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from fracparticles.errors import InvalidInput

__all__ = [
    "MOST",
    "MOST_STEPS",
    "SIZES",
    "check_fields",
    "choice",
    "dimension",
    "elementwise",
    "finite_array",
    "finite_real",
    "finite_result",
    "flag",
    "fractional_order",
    "function",
    "generator",
    "instance",
    "operand",
    "pair",
    "places",
    "positions",
    "positive_integer",
    "positive_real",
    "real_array",
    "real_between",
    "sampled",
    "scale",
    "vector",
    "whole_number",
    "within",
]

FloatArray = NDArray[np.float64]
Kind = TypeVar("Kind")

SIZES = 1e-100, 1e100  # of lengths and times: their squares and quotients are numbers too
MOST = 2**28  # numbers in one array, 2 GiB
MOST_STEPS = 2**53  # more are not told apart in float64


# --- arrays ---------------------------------------------------------------------------------------


def real_array(field: str, value: Any) -> FloatArray:
    """Return `value` as a float64 array of its own shape.

    Raises
    ------
    InvalidInput
        If `value` is not real and numeric, or holds a nan or a masked entry.
    """
    array = _numbers(field, value, "iuf")
    if np.isnan(array).any():
        raise InvalidInput(field, value, "real numbers without nan", "Remove the nan entries.")
    return array


def finite_array(
    field: str, value: Any, shape: tuple[int, ...] | None = None, *, complex_too: bool = False
) -> NDArray[Any]:
    """Return `value` as a float64 array, or a complex128 one if it is complex and may be.

    Parameters
    ----------
    field, value
        Name of the argument, and what was given for it.
    shape : tuple of int, optional
        What the shape must be; any if None. A single number stands for an array of equal ones.
    complex_too : bool
        Whether complex numbers are allowed.

    Raises
    ------
    InvalidInput
        If it is no array of finite numbers of that kind and shape.
    """
    array = _numbers(field, value, "iufc" if complex_too else "iuf")
    if not np.isfinite(array).all():
        index = np.argwhere(~np.isfinite(array))[0].tolist()
        raise InvalidInput(
            field, f"{array[tuple(index)]} at index {index}", "finite numbers", "Mend the data."
        )
    if shape is None or array.shape == shape:
        return array
    if array.ndim == 0:
        return np.full(shape, array[()])
    raise InvalidInput(
        field,
        f"array of shape {array.shape}",
        f"a number for each of the others, of shape {shape}",
        "Give arrays that belong together.",
    )


def vector(
    field: str, value: Any, size: int | None = None, *, least: int = 1, complex_too: bool = False
) -> NDArray[Any]:
    """Return `value` as a contiguous array of one dimension, finite, of `least` entries or more.

    With a `size` it has that many; a single number does not stand for many here.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    array = finite_array(field, value, complex_too=complex_too)
    if array.ndim != 1 or array.size < least or size not in (None, array.size):
        wanted = (
            f"{least} or more"
            if size is None
            else f"one for each of the {size} others, in all {size}"
        )
        raise InvalidInput(
            field,
            f"array of shape {array.shape}",
            f"numbers in one dimension, {wanted}",
            "Give arrays of one dimension that belong together.",
        )
    return np.ascontiguousarray(array)


def places(field: str, value: Any) -> FloatArray:
    """Return points of any shape, none beyond 1e100.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    return within(field, finite_array(field, value), -SIZES[1], SIZES[1])


def positions(
    field: str, value: Any, *, least: int = 1, rising: bool = False, equal: bool = False
) -> FloatArray:
    """Return a `vector` of places, none beyond 1e100; `rising` ones in order, and `equal` neighbours if allowed.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    x = within(field, vector(field, value, least=least), -SIZES[1], SIZES[1])
    if rising:
        gap = np.diff(x)
        if not (gap >= 0.0 if equal else gap > 0.0).all():
            raise InvalidInput(
                field,
                value,
                "numbers in rising order" + ("" if equal else ", no two of them equal"),
                "Sort them, and what belongs to them.",
            )
    return x


def within(
    field: str,
    array: NDArray[Any],
    low: float = -np.inf,
    high: float = np.inf,
    *,
    inside: bool = False,
) -> NDArray[Any]:
    """Return a real array whose entries lie between low and high; strictly between them with `inside`.

    Raises
    ------
    InvalidInput
        If one does not.
    """
    good = (array > low) & (array < high) if inside else (array >= low) & (array <= high)
    if not good.all():
        sign = "<" if inside else "<="
        left = "" if low == -np.inf else f"{low:.6g} {sign} "
        right = "" if high == np.inf else f" {sign} {high:.6g}"
        worst = np.asarray(array)[~good].flat[0]
        raise InvalidInput(
            field, float(worst), f"only numbers with {left}{field}{right}", "Mend the data."
        )
    return array


def operand(
    field: str, value: Any, shape: tuple[int, ...], *, complex_too: bool = False
) -> NDArray[Any]:
    """Return an array of an inner loop: of numbers, only the shape is checked, once.

    Raises
    ------
    InvalidInput
        If it has another shape, or is not numeric.
    """
    kinds = "fc" if complex_too else "f"
    if type(value) is np.ndarray and value.dtype.kind in kinds and value.shape == shape:
        return value
    array = finite_array(field, value, complex_too=complex_too)
    if array.shape != shape:
        raise InvalidInput(
            field,
            f"array of shape {array.shape}",
            f"a number for each particle, of shape {shape}",
            "Give arrays that belong together.",
        )
    return array


def elementwise(
    function: Callable[..., None], array: FloatArray, *parameters: Any
) -> FloatArray | float:
    """Apply a compiled ``function(flat, *parameters, out)``; scalars come back as Python floats."""
    flat = np.ascontiguousarray(array).reshape(-1)
    out = np.empty_like(flat)
    function(flat, *parameters, out)
    return float(out[0]) if array.ndim == 0 else out.reshape(array.shape)


def _numbers(field: str, value: Any, kinds: str) -> NDArray[Any]:
    """The array of `value`, float64 or, of a complex one that may be, complex128."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise InvalidInput(field, value, "numbers without a mask", "Fill the masked entries.")
    try:
        array = np.asarray(value)
    except Exception as error:  # a ragged list, or whatever an object of the caller's raises
        raise InvalidInput(
            field, value, "real numbers in an array of any shape", "Give rows of equal length."
        ) from error
    if array.dtype.kind not in kinds:
        named = "real or complex numbers" if "c" in kinds else "real numbers"
        raise InvalidInput(field, value, named, "Give a number or an array of numbers.")
    with np.errstate(over="ignore"):  # of a wider type; it is infinite then
        array = array.astype(np.complex128 if array.dtype.kind == "c" else np.float64, copy=False)
    return array


# --- one number -----------------------------------------------------------------------------------


def _real(value: Any) -> float:
    """The number as a float; nan if it is none."""
    if not isinstance(value, Real) or isinstance(value, bool | np.bool_):
        return np.nan
    try:
        with np.errstate(over="ignore"):
            return float(value)
    except OverflowError:  # a whole number beyond 1.8e308
        return np.inf if value > type(value)(0) else -np.inf  # type: ignore[call-arg]


def finite_real(field: str, value: Any) -> float:
    """Return a finite number as a float.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    number = _real(value)
    if not np.isfinite(number):
        raise InvalidInput(field, value, "a finite number", "Give a real number.")
    return number


def real_between(
    field: str, value: Any, low: float, high: float = np.inf, *, inside: bool = False
) -> float:
    """Return a finite number from low to high as a float; strictly between them with `inside`.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    number = _real(value)
    good = low < number < high if inside else low <= number <= high
    if not (good and np.isfinite(number)):
        sign = "<" if inside else "<="
        right = "" if high == np.inf else f" {sign} {high:g}"
        raise InvalidInput(
            field,
            value,
            f"a finite number with {low:g} {sign} {field}{right}",
            "Give one in range.",
        )
    return number


def positive_real(field: str, value: Any) -> float:
    """Return a positive finite number as a float.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    number = _real(value)
    if not 0.0 < number < np.inf:
        raise InvalidInput(field, value, "a positive finite number", "Give a value above zero.")
    return number


def scale(field: str, value: Any) -> float:
    """Return a length, a time or another positive size from 1e-100 to 1e100 as a float.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    number = positive_real(field, value)
    if not SIZES[0] <= number <= SIZES[1]:
        raise InvalidInput(
            field, value, f"a number from {SIZES[0]:g} to {SIZES[1]:g}", "Change the units."
        )
    return number


def fractional_order(alpha: Any) -> float:
    """Return the order alpha as a float.

    Raises
    ------
    InvalidInput
        If alpha is not a real number with 1 < alpha < 2.
    """
    number = _real(alpha)
    if not 1.0 < number < 2.0:
        raise InvalidInput(
            "alpha", alpha, "a number with 1 < alpha < 2", "Give alpha = 1 + beta, 0 < beta < 1."
        )
    return number


def whole_number(field: str, value: Any, least: int = 0, most: int | None = None) -> int:
    """Return a whole number from `least` on, to `most` if given, as an int.

    Raises
    ------
    InvalidInput
        If it is anything else; 2.0 and True are no whole numbers.
    """
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not (whole and least <= value and (most is None or value <= most)):
        raise InvalidInput(
            field,
            value,
            f"a whole number from {least} " + ("on" if most is None else f"to {most}"),
            "Give such a number.",
        )
    return int(value)


def positive_integer(field: str, value: Any, most: int | None = None) -> int:
    """Return a positive whole number, at most `most` if given, as an int.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not (whole and value > 0):
        raise InvalidInput(field, value, "a whole number above zero", "Give 1, 2, 3, ...")
    if most is not None and value > most:
        raise InvalidInput(field, value, f"at most {most}", "Give a smaller number.")
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


# --- other things ---------------------------------------------------------------------------------


def flag(field: str, value: Any) -> bool:
    """Return True or False.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    return bool(instance(field, value, (bool, np.bool_), "True or False"))


def choice(field: str, value: Any, names: Sequence[str]) -> str:
    """Return one of these names.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    if not isinstance(value, str) or value not in names:
        raise InvalidInput(field, value, f"one of {', '.join(names)}", "Choose one of these.")
    return value


def instance(
    field: str,
    value: Any,
    kind: type[Kind] | tuple[type, ...],
    allowed: str = "",
    remedy: str = "Make one first.",
) -> Kind:
    """Return an object of that kind.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    if not isinstance(value, kind):
        named = allowed or f"of the kind {getattr(kind, '__name__', kind)}"
        raise InvalidInput(field, value, named, remedy)
    return value  # type: ignore[return-value]


def function(field: str, value: Any) -> Callable[..., Any]:
    """Return something that can be called.

    Raises
    ------
    InvalidInput
        If it cannot.
    """
    if not callable(value):
        raise InvalidInput(field, value, "a function", "Give one that takes an array.")
    return value


def generator(field: str, value: Any) -> np.random.Generator:
    """Return a source of random numbers.

    Raises
    ------
    InvalidInput
        If it is anything else.
    """
    made = "Make one with numpy.random.default_rng(seed)."
    return instance(field, value, np.random.Generator, "a numpy.random.Generator", made)


def pair(field: str, value: Any) -> tuple[Any, Any]:
    """Return the two entries of a tuple, a list or an array.

    Raises
    ------
    InvalidInput
        If there are not two.
    """
    listed = isinstance(value, tuple | list) or (isinstance(value, np.ndarray) and value.ndim == 1)
    if not (listed and len(value) == 2):
        raise InvalidInput(field, value, "two values", "Give a tuple of two.")
    return value[0], value[1]


def check_fields(record: Any, **checks: Callable[[str, Any], Any]) -> None:
    """Put each field of a frozen dataclass through its check, and keep what that returns.

    Raises
    ------
    InvalidInput
        If a field does not pass.
    """
    for name, check in checks.items():
        object.__setattr__(record, name, check(name, getattr(record, name)))


# --- what comes back ------------------------------------------------------------------------------


def sampled(
    field: str, f: Any, *points: NDArray[Any], shape: tuple[int, ...] | None = None
) -> NDArray[Any]:
    """Return f(*points), the values of a function of the caller's, finite and of the shape of the points.

    Raises
    ------
    InvalidInput
        If f is no function, does not take arrays, or returns anything else.
    """
    try:
        with np.errstate(all="ignore"):
            values = function(field, f)(*points)
    except InvalidInput:
        raise
    except (TypeError, ValueError) as error:
        raise InvalidInput(
            field,
            f,
            f"a function of arrays ({error})",
            "Write it with numpy, or numpy.vectorize it.",
        ) from error
    shape = points[0].shape if shape is None else shape
    values = finite_array(field, values)
    if values.shape != shape:
        raise InvalidInput(
            field,
            f"values of shape {values.shape}",
            f"one value for each of the points, of shape {shape}",
            "Write it with numpy, or numpy.vectorize it.",
        )
    return values


def finite_result(field: str, result: Any) -> Any:
    """Return sums of what was given for `field`, which may have overflowed.

    Raises
    ------
    InvalidInput
        If they did.
    """
    if not np.isfinite(result).all():
        raise InvalidInput(
            field, "numbers of this size", "numbers whose sums do not overflow", "Change the units."
        )
    return result
