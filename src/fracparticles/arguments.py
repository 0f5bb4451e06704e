"""Checks of the arguments of public functions, in one place.

A check takes the name of an argument and its value. It returns the value as a number or an array of one kind, or raises
`InvalidInput` with that name before any work starts. It raises nothing else, whatever the value is.

- One number: `finite_real`, `positive_real`, `real_between`, `scale`, `place`, `not_negative`, `whole_number`,
  `positive_integer`, `dimension`, `fractional_order`. An array without axes is the number that it holds, `plain`.
- Arrays: `real_array` (infinite entries too), `finite_array`, `vector`, `places`, `positions`, and `within` for their
  range; `of_shape` for arrays that belong to others, `together` for those that are broadcast, `operand` for the
  arrays of an inner loop, whose entries are not looked at.
- Other things: `choice`, `flag`, `function`, `generator`, `instance`, `pair`.
- Results: `sampled` for a function of the caller's, `finite_result` for sums that may overflow.

`fields` puts the checks on the fields of a frozen dataclass. Modules with many checks say
``from fracparticles import arguments as check``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from fracparticles.errors import InvalidInput, one_of

FloatArray = NDArray[np.float64]
Shape = tuple[int, ...]
Kind = TypeVar("Kind")

SIZES = 1e-100, 1e100  # the range of lengths and times: their squares and quotients do not overflow
_SIZED = f"a number from {SIZES[0]:g} to {SIZES[1]:g}"
MOST = 2**28  # numbers in one array, 2 GiB
MOST_STEPS = 2**53  # time steps: more are not told apart in float64

_VECTORISE = "Write it with numpy, or numpy.vectorize it."


# --- arrays ---------------------------------------------------------------------------------------


def real_array(field: str, value: Any) -> FloatArray:
    """Return real numbers, none of them nan or masked, as a float64 array of their own shape."""
    array = _numbers(field, value, "iuf")
    if np.isnan(array).any():
        raise InvalidInput(field, value, "real numbers without nan", "Remove the nan entries.")
    return array


def finite_array(
    field: str, value: Any, shape: Shape | None = None, *, complex_too: bool = False
) -> NDArray[Any]:
    """Return finite numbers as a float64 array, or a complex128 one if they are complex and may be.

    With a `shape` the array must have it; then a single number stands for an array of equal numbers.
    """
    array = _numbers(field, value, "iufc" if complex_too else "iuf")
    if not all_finite(array):
        index = np.argwhere(~np.isfinite(array))[0].tolist()
        shown = f"{array[tuple(index)]} at index {index}"
        raise InvalidInput(field, shown, "finite numbers", "Mend the data.")
    if shape is None:
        return array
    return np.full(shape, array[()]) if array.ndim == 0 else of_shape(field, array, shape)


def of_shape(
    field: str, array: NDArray[Any], shape: Shape, each: str = "a number for each of the others"
) -> NDArray[Any]:
    """Return an array that must have this shape; `each` says in the message what every entry is."""
    if array.shape != shape:
        raise _misfit(field, array, f"{each}, of shape {shape}")
    return array


def vector(
    field: str, value: Any, size: int | None = None, *, least: int = 1, complex_too: bool = False
) -> NDArray[Any]:
    """Return a contiguous array of one dimension, finite, of `least` entries or more.

    With a `size` it must have that many; here a single number does not stand for many.
    """
    array = finite_array(field, value, complex_too=complex_too)
    if array.ndim != 1 or array.size < least or size not in (None, array.size):
        each = f"one for each of the {size} others, in all {size}"
        count = f"{least} or more" if size is None else each
        raise _misfit(field, array, f"numbers in one dimension, {count}")
    return np.ascontiguousarray(array)


def places(field: str, value: Any) -> FloatArray:
    """Return points of any shape, none beyond 1e100."""
    return within(field, value, -SIZES[1], SIZES[1])


def positions(
    field: str, value: Any, *, least: int = 1, rising: bool = False, equal: bool = False
) -> FloatArray:
    """Return a `vector` of places, none beyond 1e100; `rising` asks for their order, `equal` allows equal ones."""
    x = within(field, vector(field, value, least=least), -SIZES[1], SIZES[1])
    if rising and not (np.diff(x) >= 0.0 if equal else np.diff(x) > 0.0).all():
        order = "numbers in rising order" + ("" if equal else ", no two of them equal")
        raise InvalidInput(field, value, order, "Sort them, and what belongs to them.")
    return x


def within(
    field: str,
    value: Any,
    low: float = -np.inf,
    high: float = np.inf,
    *,
    inside: bool = False,
    shape: Shape | None = None,
) -> NDArray[Any]:
    """Return a `finite_array` with real entries from low to high; strictly between them with `inside`."""
    array = finite_array(field, value, shape)
    good = (array > low) & (array < high) if inside else (array >= low) & (array <= high)
    if not good.all():
        worst = float(array[~good].flat[0])
        allowed = f"only numbers with {_interval(field, low, high, inside)}"
        raise InvalidInput(field, worst, allowed, "Mend the data.")
    return array


def together(**arrays: NDArray[Any]) -> list[NDArray[Any]]:
    """Return arrays broadcast against one another."""
    try:
        return list(np.broadcast_arrays(*arrays.values()))
    except ValueError as error:
        name, array = list(arrays.items())[-1]
        raise _misfit(name, array, f"shapes of {', '.join(arrays)} that fit together") from error


def operand(field: str, value: Any, shape: Shape, *, complex_too: bool = False) -> NDArray[Any]:
    """Return an array of an inner loop; of an array of numbers only the shape is checked."""
    kinds = "fc" if complex_too else "f"
    if type(value) is np.ndarray and value.dtype.kind in kinds and value.shape == shape:
        return value
    array = finite_array(field, value, complex_too=complex_too)
    return of_shape(field, array, shape, "a number for each particle")


def elementwise(
    function: Callable[..., None], array: FloatArray, *parameters: Any
) -> FloatArray | float:
    """Apply a compiled ``function(flat, *parameters, out)``; scalars come back as Python floats."""
    flat = np.ascontiguousarray(array).reshape(-1)
    out = np.empty_like(flat)
    function(flat, *parameters, out)
    return like(array, out.reshape(array.shape))


def like(array: FloatArray, value: Any) -> FloatArray | float:
    """Return the values of a function of an array; for an array without axes, a Python float."""
    return float(value) if array.ndim == 0 else value


def _numbers(field: str, value: Any, kinds: str) -> NDArray[Any]:
    """Return `value` as a float64 array, or a complex128 one if it is complex and may be."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise InvalidInput(field, value, "numbers without a mask", "Fill the masked entries.")
    try:
        array = np.asarray(value)
    except Exception as error:  # a ragged list, or whatever an object of the caller's raises
        allowed = "real numbers in an array of any shape"
        raise InvalidInput(field, value, allowed, "Give rows of equal length.") from error
    if array.dtype.kind not in kinds:
        named = "real or complex numbers" if "c" in kinds else "real numbers"
        raise InvalidInput(field, value, named, "Give a number or an array of numbers.")
    wanted = np.complex128 if array.dtype.kind == "c" else np.float64
    if array.dtype == wanted:
        return array
    with np.errstate(over="ignore"):  # a number of a wider type may become infinite
        return array.astype(wanted, copy=False)


def _misfit(field: str, array: NDArray[Any], wanted: str) -> InvalidInput:
    shown = f"array of shape {array.shape}"
    return InvalidInput(field, shown, wanted, "Give arrays that belong together.")


def _interval(field: str, low: float, high: float, inside: bool) -> str:
    sign = "<" if inside else "<="
    left = "" if low == -np.inf else f"{low:.6g} {sign} "
    return f"{left}{field}" + ("" if high == np.inf else f" {sign} {high:.6g}")


# --- one number -----------------------------------------------------------------------------------


def plain(value: Any) -> Any:
    """Return the number in an array without axes, labelled or not, or in a NumPy scalar; anything else as it is."""
    bare = getattr(value, "shape", None) == () and hasattr(value, "dtype")
    return value.item() if bare and not isinstance(value, np.ma.MaskedArray) else value


def _real(value: Any) -> float:
    """Return the value as a float; nan if it is not a number."""
    if type(value) is float:
        return value
    value = plain(value)
    if not isinstance(value, Real) or isinstance(value, bool):
        return np.nan
    try:
        with np.errstate(over="ignore"):
            return float(value)
    except OverflowError:  # a whole number beyond 1.8e308
        return np.inf if value > type(value)(0) else -np.inf  # type: ignore[call-arg]


def real_between(
    field: str,
    value: Any,
    low: float = -np.inf,
    high: float = np.inf,
    *,
    inside: bool = False,
    allowed: str = "",
    remedy: str = "Give one in range.",
) -> float:
    """Return a finite number from low to high as a float; strictly between them with `inside`."""
    number = _real(value)
    good = low < number < high if inside else low <= number <= high
    if not (good and math.isfinite(number)):
        allowed = allowed or f"a finite number with {_interval(field, low, high, inside)}"
        if isinstance(value, list | tuple | np.ndarray):
            remedy = "Give one number, not several."
        raise InvalidInput(field, value, allowed, remedy)
    return number


def finite_real(field: str, value: Any) -> float:
    """Return a finite number as a float."""
    return real_between(field, value, allowed="a finite number", remedy="Give a real number.")


def positive_real(field: str, value: Any) -> float:
    """Return a positive finite number as a float."""
    allowed, remedy = "a positive finite number", "Give a value above zero."
    return real_between(field, value, 0.0, inside=True, allowed=allowed, remedy=remedy)


def scale(field: str, value: Any) -> float:
    """Return a length, a time or another positive size from 1e-100 to 1e100 as a float."""
    return real_between(field, value, *SIZES, allowed=_SIZED, remedy="Change the value or units.")


def time_to_go(time: Any) -> float:
    """Return zero, or a time from 1e-100 to 1e100, as a float."""
    return real_between("time", time, *SIZES, allowed=f"zero, or {_SIZED}") if _real(time) else 0.0


def place(field: str, value: Any) -> float:
    """Return a point, none beyond 1e100, as a float."""
    return real_between(field, value, -SIZES[1], SIZES[1])


def not_negative(field: str, value: Any) -> float:
    """Return a size that may be zero, up to 1e100, as a float."""
    return real_between(field, value, 0.0, SIZES[1])


def fractional_order(alpha: Any) -> float:
    """Return the order alpha, 1 < alpha < 2, as a float."""
    allowed, remedy = "a number with 1 < alpha < 2", "Give alpha = 1 + beta, 0 < beta < 1."
    return real_between("alpha", alpha, 1.0, 2.0, inside=True, allowed=allowed, remedy=remedy)


def whole_number(field: str, value: Any, least: int = 0, most: int | None = None) -> int:
    """Return a whole number from `least` on, to `most` if given, as an int; 2.0 and True are refused."""
    value = plain(value)
    whole = isinstance(value, int) and not isinstance(value, bool)
    if not (whole and least <= value and (most is None or value <= most)):
        allowed = f"a whole number from {least} " + ("on" if most is None else f"to {most}")
        raise InvalidInput(field, value, allowed, "Give such a number.")
    return int(value)


def positive_integer(field: str, value: Any, most: int | None = None) -> int:
    """Return a positive whole number, at most `most` if given, as an int."""
    return whole_number(field, value, 1, most)


def dimension(dim: Any) -> int:
    """Return the number of space dimensions, 1 to 3, as an int."""
    return whole_number("dim", dim, 1, 3)


# --- other things ---------------------------------------------------------------------------------


def flag(field: str, value: Any) -> bool:
    """Return True or False."""
    return bool(instance(field, value, (bool, np.bool_), "True or False"))


def choice(field: str, value: Any, names: Sequence[str]) -> str:
    """Return one of these names."""
    if not isinstance(value, str) or value not in names:
        raise one_of(field, value, names)
    return value


def instance(
    field: str,
    value: Any,
    kind: type[Kind] | tuple[type, ...],
    allowed: str = "",
    remedy: str = "Make one first.",
) -> Kind:
    """Return an object of that kind."""
    if not isinstance(value, kind):
        named = allowed or f"of the kind {getattr(kind, '__name__', kind)}"
        raise InvalidInput(field, value, named, remedy)
    return value  # type: ignore[return-value]


def function(field: str, value: Any) -> Callable[..., Any]:
    """Return something that can be called."""
    if not callable(value):
        raise InvalidInput(field, value, "a function", "Give one that takes an array.")
    return value


def generator(field: str, value: Any) -> np.random.Generator:
    """Return a source of random numbers."""
    made = "Make one with numpy.random.default_rng(seed)."
    return instance(field, value, np.random.Generator, "a numpy.random.Generator", made)


def pair(field: str, value: Any, *, rising: bool = False) -> tuple[Any, Any]:
    """Return the two entries of a tuple, a list or an array; with `rising` they must be places in order."""
    listed = isinstance(value, tuple | list) or (isinstance(value, np.ndarray) and value.ndim == 1)
    if not (listed and len(value) == 2):
        raise InvalidInput(field, value, "two values", "Give a tuple of two.")
    low, high = value
    if rising:
        low, high = place(field, low), place(field, high)
        if not low < high:
            raise InvalidInput(field, value, "two increasing numbers", "Mend their order.")
        told_apart(field, value, low, high)
    return low, high


def told_apart(field: str, value: Any, low: float, high: float) -> None:
    """Refuse two numbers so far from zero that float64 does not resolve a millionth of what is between them."""
    if not high - 1e-6 * (high - low) < high:
        closest = float(np.spacing(abs(high)))
        allowed = (
            f"numbers that differ by a million times {closest:.2g}, which float64 tells apart there"
        )
        raise InvalidInput(field, value, allowed, "Count from an origin that is nearer.")


def fields(record: Any, **checks: Callable[[str, Any], Any]) -> None:
    """Put each field of a frozen dataclass through its check, and keep the result."""
    for name, check in checks.items():
        object.__setattr__(record, name, check(name, getattr(record, name)))


# --- results --------------------------------------------------------------------------------------


def all_finite(array: NDArray[Any]) -> bool:
    """Return whether no entry is infinite or nan. A finite sum of squares shows this in one pass."""
    return math.isfinite(np.vdot(array, array).real) or bool(np.isfinite(array).all())


def sampled(field: str, f: Any, *points: NDArray[Any]) -> NDArray[Any]:
    """Return f(*points), the values of a function of the caller's, finite and of the shape of the points."""
    try:
        with np.errstate(all="ignore"):
            values = function(field, f)(*points)
    except InvalidInput:
        raise
    except (TypeError, ValueError) as error:
        raise InvalidInput(field, f, f"a function of arrays ({error})", _VECTORISE) from error
    values, shape = finite_array(field, values), points[0].shape
    if values.shape != shape:
        allowed = f"one value for each of the points, of shape {shape}"
        raise InvalidInput(field, f"values of shape {values.shape}", allowed, _VECTORISE)
    return values


def finite_result(field: str, result: Any) -> Any:
    """Return sums of the numbers given for `field`, if they have not overflowed."""
    if not all_finite(np.asarray(result)):
        allowed = "numbers whose sums do not overflow"
        raise InvalidInput(field, "numbers of this size", allowed, "Change the units.")
    return result
