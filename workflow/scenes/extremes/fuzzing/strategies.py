"""What cases are drawn from: the fields of a model by their types and bounds, and values that belong nowhere.

Nothing here names a field of `Case`: a new one is drawn from what its annotation and its constraints say.
"""

import datetime
import math
from collections.abc import Mapping
from copy import deepcopy
from decimal import Decimal
from fractions import Fraction
from functools import cache
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import numpy as np
from hypothesis import strategies as st
from pydantic import BaseModel
from pydantic.fields import FieldInfo

Strategy = st.SearchStrategy[Any]

_FINE = 2**32
_ORDINARY = (0.0, 0.01, 0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 10.0, 100.0)
_TINY, _HUGE = (5e-324, 2.3e-308, 1e-300, 1e-100, 1e-16, 1e-3), (1e6, 1e16, 1e100, 1e300)
_EXTREME = (*_TINY, *_HUGE, 1.7976931348623157e308)
_PLACED = ("../x", "x" * 3000, "{}", "%s")
_WORDS = ("", " ", "fundamental", "none", "nan", "1e-3", "1_0", "\0", "\n", "é\ud800", *_PLACED)


@cache
def chance(percent: int) -> st.SearchStrategy[bool]:
    """Draw whether something happens that happens so often."""
    return st.integers(0, 99).map(lambda number: number < percent)


def among(*values: Any) -> Strategy:
    """Draw one of these."""
    return st.sampled_from(values)


@cache
def between(low: float, high: float) -> st.SearchStrategy[float]:
    """Draw numbers that are spread evenly."""
    return st.integers(0, _FINE).map(lambda k: low + (high - low) * (k / _FINE))


@cache
def numbers(
    low: float = -math.inf, high: float = math.inf, *, inside: tuple[bool, bool] = (False, False)
) -> st.SearchStrategy[float]:
    """Draw numbers from low to high: ordinary ones, both ends or their neighbours, and of all sizes."""
    least = math.nextafter(low, math.inf) if inside[0] else low
    most = math.nextafter(high, -math.inf) if inside[1] else high

    def allowed(values: Any) -> list[float]:
        return [value for value in values if least <= value <= most]

    signed = [*_ORDINARY, *_EXTREME, *(-x for x in (*_ORDINARY, *_EXTREME))]
    ordinary = allowed([*_ORDINARY[1:], *(-x for x in _ORDINARY[1:])]) or [
        max(least, min(most, 1.0))
    ]
    kinds = [st.sampled_from(ordinary)] * 4
    kinds.append(st.sampled_from(allowed([least, most, *signed]) or ordinary))
    if math.isfinite(least) and math.isfinite(most):
        kinds.append(between(least, most).map(lambda x: min(max(x, least), most)))
    if most > 0.0:
        ends = math.log10(max(least, 1e-300)), math.log10(min(most, 1e300))
        kinds.append(between(*ends).map(lambda e: min(max(10.0**e, least), most)))
    return st.one_of(kinds)


@cache
def texts() -> st.SearchStrategy[str]:
    """Draw texts: words with a meaning somewhere, and any characters."""
    return st.one_of(st.sampled_from(_WORDS), st.text(max_size=12))


# --- values that belong nowhere -----------------------------------------------------------------------


class _Awkward:
    """An object whose every use fails."""

    def __array__(self, *_: object, **__: object) -> np.ndarray:
        raise RuntimeError("no array")

    def __float__(self) -> float:
        raise RuntimeError("no number")

    def __eq__(self, other: object) -> bool:
        raise RuntimeError("no comparison")

    def __repr__(self) -> str:
        return "awkward\nobject"

    __hash__ = object.__hash__


def _labelled() -> Any:
    import xarray as xr

    return xr.DataArray(np.ones(3), {"x": [0.0, 1.0, 2.0]}, "x", name="u")


_STRUCTURED = np.zeros(3, dtype=[("a", float)])
_MASKED = np.ma.masked_array([1.0, 2.0], [True, False])
_ODD: tuple[Any, ...] = (
    *(None, True, False, math.nan, math.inf, -math.inf, -0.0, 0, -1, 2, 10**400, -(2**63), 1j),
    *(Fraction(1, 2), Decimal("0.5"), Decimal("nan")),
    *(np.float32(0.5), np.float16(0.5), np.longdouble("1e400"), np.int8(2), np.uint64(2**64 - 1)),
    *(np.bool_(True), np.str_("KPSE"), np.datetime64("2020-01-01")),
    *(np.array(0.5), np.array([0.5]), np.array([]), np.zeros((2, 0)), np.array([1.0, math.nan])),
    *(np.array([1e308, 1e308]), np.array(["a", "b"]), np.array([None, 1.0])),
    *(np.array([1.0 + 1.0j]), np.array([True, False]), _MASKED, np.ma.masked, _STRUCTURED),
    *(np.ones((3, 3)), [], [1.0, [2.0]], [0.5, 1.5], (2, 4), {}, {"beta": 0.5}, {0.5}, range(3)),
    *(b"KPSE", bytearray(b"\0"), object(), float, len, lambda *_: 1.0, iter([1.0])),
    *(Path("run.nc"), datetime.date(2020, 1, 1), NotImplemented, ..., ValueError("x")),
    *(_Awkward(), _labelled),
)


def _odd(place: int) -> Any:
    """A value of its own, which may be changed."""
    value = _ODD[place]
    return _labelled() if value is _labelled else deepcopy(value)


@cache
def anything() -> Strategy:
    """Draw values of all kinds, most of which mean nothing where they are given."""
    return st.one_of(
        st.integers(0, len(_ODD) - 1).map(_odd), numbers(), texts(), st.integers(-(10**6), 10**6)
    )


# --- fields of a model ----------------------------------------------------------------------------------


def value_of(annotation: Any, constraints: Any = ()) -> Strategy:
    """Draw values that an annotation with constraints allows, each by itself; anything if it says nothing."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if isinstance(annotation, FieldInfo):
        return value_of(annotation.annotation, annotation.metadata)
    if origin is Annotated:
        return value_of(arguments[0], [*constraints, *arguments[1:]])
    if origin is Literal:
        return st.sampled_from(arguments)
    if origin in (Union, UnionType):
        kinds = [kind for kind in arguments if kind is not NoneType]
        drawn = [value_of(kind, constraints) for kind in kinds]
        return (
            st.one_of(*drawn) if len(kinds) == len(arguments) else st.one_of(*drawn * 3, st.none())
        )
    if origin in (list, tuple, set, frozenset):
        each = st.lists(value_of(arguments[0] if arguments else Any, constraints), max_size=4)
        return each if origin is list else each.map(origin)
    if origin in (dict, Mapping):
        return st.dictionaries(value_of(arguments[0]), value_of(arguments[1]), max_size=3)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return given_fields(annotation)
    if annotation is float:
        return numbers(**_bounds(constraints))
    if annotation is int:
        low, high = _bounds(constraints)["low"], _bounds(constraints)["high"]
        least = None if low == -math.inf else math.ceil(low)
        return st.one_of(
            st.integers(least, None if high == math.inf else math.floor(high)),
            st.integers(least or 0, (least or 0) + 12),
        )
    if annotation is bool:
        return st.booleans()
    if annotation is NoneType:
        return st.none()
    if annotation is str:
        return texts()
    if annotation is Path:
        return texts().map(Path)
    return anything()


def _bounds(constraints: Any) -> dict[str, Any]:
    """Low and high of pydantic's constraints, and which of them are excluded."""
    said = {
        name: getattr(one, name)
        for one in constraints
        for name in ("gt", "ge", "lt", "le")
        if getattr(one, name, None) is not None
    }
    return {
        "low": said.get("gt", said.get("ge", -math.inf)),
        "high": said.get("lt", said.get("le", math.inf)),
        "inside": ("gt" in said, "lt" in said),
    }


@cache
def fields_of(model: type[BaseModel]) -> dict[str, Strategy]:
    """Return what draws each field of a model."""
    return {name: value_of(field) for name, field in model.model_fields.items()}


@st.composite
def given_fields(
    draw: st.DrawFn, model: type[BaseModel], *, share: int = 20, wrong: int = 50
) -> dict[str, Any]:
    """Draw fields for a model: those that it needs, others in `share` per cent, in `wrong` per cent with mistakes."""
    given = {
        name: draw(values)
        for name, values in fields_of(model).items()
        if model.model_fields[name].is_required() or draw(chance(share))
    }
    if draw(chance(wrong)):
        names = list(model.model_fields)
        for name in draw(st.lists(st.sampled_from(names), min_size=1, max_size=2)):
            given[name] = draw(anything())
        mistake = draw(st.integers(0, 9))
        if mistake == 0:
            given.pop(draw(st.sampled_from(names)), None)
        elif mistake == 1:
            given[draw(texts())] = draw(anything())
    return given
