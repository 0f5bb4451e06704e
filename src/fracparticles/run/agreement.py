"""A data set says twice what was run: in its scalars, and in the case or the problem in its attributes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.run.checked import stored_fields

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["refuse_contradiction", "stored_in"]

# Fields whose scalar is the value that was asked for; other scalars are the values that were taken.
_AS_ASKED = (
    "scheme", "form", "order", "beta", "dim", "diffusivity", "half_width", "spacing", "exterior", "t_initial",
    "t_final",
)  # fmt: skip
_SAME = 1e-9  # relative difference of numbers that are the same


def stored_in(data: xr.Dataset) -> dict[str, Any] | None:
    """Return the fields of the case or the problem in the attributes; None if there are none."""
    return stored_fields(data.attrs.get("case", data.attrs.get("problem")))


def refuse_contradiction(field: str, data: xr.Dataset, name: str) -> None:
    """Refuse a data set whose scalars are not those of its case or problem.

    Parameters
    ----------
    field, name : str
        The argument and the data set, as the message names them.
    data : xarray.Dataset

    Raises
    ------
    InvalidInput
        If a scalar is another; names the first one.
    """
    stored = stored_in(data) or {}
    for one in _AS_ASKED:
        if one not in stored or one not in data.variables or data.variables[one].size != 1:
            continue
        asked, scalar = stored[one], data.variables[one].values
        if not _same(asked, scalar):
            attribute = "case" if "case" in data.attrs else "problem"
            raise InvalidInput(
                field,
                name,
                f"a run that says one thing of itself: its {one} is {scalar.item()!r}, and that in its attribute "
                f"{attribute!r} is {asked!r}",
                f"Mend the one that is wrong; of data with another meaning drop the attribute {attribute!r}.",
            )


def _same(asked: Any, scalar: np.ndarray) -> bool:
    """Return whether both are equal to the digits of the type. A text and a number do not contradict each other."""
    value = scalar.item()
    if isinstance(asked, str) or isinstance(value, str):
        return asked == value or type(asked) is not type(value)
    if not isinstance(asked, int | float) or not isinstance(value, int | float):
        return True
    digits = float(np.finfo(scalar.dtype).eps) if scalar.dtype.kind == "f" else 0.0
    return math.isclose(asked, value, rel_tol=max(_SAME, digits))
