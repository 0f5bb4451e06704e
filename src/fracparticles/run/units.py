"""Names of the units of a run. They are stored in the data set, and shown on the axes of its plots.

The equation has no scale of its own: its numbers hold for any units, and nothing is converted. The diffusivity is in
length^alpha / time, and the mass in concentration times length^dim.
"""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fracparticles.data.interpolated import Measured
from fracparticles.errors import InvalidInput
from fracparticles.files import load_netcdf
from fracparticles.run.case import FUNDAMENTAL

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Units", "units_of", "with_units"]

_LONGEST = 40  # characters of a name
_NONE = "1"  # the name of no unit
# The powers of length, time and concentration in the unit of each variable; "alpha" and "dim" are those of the run.
_DIMENSIONS: dict[str, tuple[float | str, float, float]] = {
    **dict.fromkeys(("x", "y", "z", "half_width", "spacing", "particle_spacing"), (1, 0, 0)),
    **dict.fromkeys(("graded_scale", "particle_position"), (1, 0, 0)),
    "volume": ("dim", 0, 0),
    **dict.fromkeys(("largest_spacing", "spacing_before", "spacing_where"), (1, 0, 0)),
    **dict.fromkeys(("t", "t_initial", "t_final", "dt", "remeshing_time"), (0, 1, 0)),
    **dict.fromkeys(("u", "u_axis", "u_diagonal"), (0, 0, 1)),
    **dict.fromkeys(("mass", "mass_initial", "mass_final", "particle_strength"), ("dim", 0, 1)),
    **dict.fromkeys(("eliminated_strength", "lost_strength"), ("dim", 0, 1)),
    "diffusivity": ("alpha", -1, 0),
}


@dataclass(frozen=True)
class Units:
    """Names of units, each as it is shown on an axis; "1" for none.

    Attributes
    ----------
    length, time, concentration : str
        "m", "d", "mg/L".

    Raises
    ------
    InvalidInput
        If a name is not a text of one line and at most 40 characters.
    """

    length: str = _NONE
    time: str = _NONE
    concentration: str = _NONE

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            good = isinstance(value, str) and value.strip() and value.isprintable()
            if not good or len(value) > _LONGEST:
                short = f"the name of a unit, of at most {_LONGEST} characters"
                raise InvalidInput(name, value, short, "Give it as text, or leave it out.")

    @classmethod
    def read(cls, text: str) -> Units:
        """Return the units of a flag, "m,d,mg/L": length, time and concentration.

        Raises
        ------
        InvalidInput
            If there are not three.
        """
        names = [name.strip() for name in text.split(",")]
        if len(names) != 3:
            three = "three names, of length, time and concentration: m,d,mg/L"
            raise InvalidInput("units", text, three, "Write 1 where there is none.")
        return cls(*names)

    def of(self, name: str, alpha: float | None, dim: int) -> str | None:
        """Return the unit of a variable of a data set; None for a variable that has none.

        Nor has the diffusivity one if alpha is None: an order that varies.
        """
        powers = _DIMENSIONS.get(name)
        if powers is None or (alpha is None and "alpha" in powers):
            return None
        of_length, time, concentration = powers
        own = {"alpha": alpha or 0.0, "dim": float(dim)}
        length = own[of_length] if isinstance(of_length, str) else of_length
        pairs = zip(
            (self.concentration, self.length, self.time), (concentration, length, time), strict=True
        )
        parts = [unit if power == 1.0 else f"{unit}^{power:g}" for unit, power in pairs
                 if power != 0.0 and unit != _NONE]  # fmt: skip
        return " ".join(parts) or _NONE


def units_of(source: Any, given: Units | None = None) -> Units | None:
    """Return the units that were given, or those that the initial data name; None without either.

    Raises
    ------
    InvalidInput
        If the data name other units than those given.
    """
    if given is not None and not isinstance(given, Units):
        named = "fp.Units(length=..., time=..., concentration=...)"
        raise InvalidInput("units", given, named, "Give these.")
    told = _told(source)
    if given is None:
        return told
    for name, value in vars(told or Units()).items():
        if value not in (_NONE, getattr(given, name)):
            allowed = f"the {name} of the data, {value!r}"
            raise InvalidInput("units", getattr(given, name), allowed, "Convert the data first.")
    return given


def _told(source: Any) -> Units | None:
    """The units of x, t_final and u that the data name; None if they name none."""
    if isinstance(source, Measured):
        length, concentration = (name or _NONE for name in source.units)
        found = Units(length, _NONE, concentration)
        return None if found == Units() else found
    if isinstance(source, str | os.PathLike):
        path = Path(os.fspath(source))
        if source == FUNDAMENTAL or not path.is_file():  # a missing file is refused when it is read
            return None
        source = load_netcdf(path, ("u", "x", "t_final"))
    xarray = sys.modules.get("xarray")
    if xarray is None or not isinstance(source, xarray.DataArray | xarray.Dataset):
        return None
    values = source if isinstance(source, xarray.DataArray) else source.get("u")
    variables = [source.coords.get("x"), source.coords.get("t_final"), values]
    names = ["" if one is None else str(one.attrs.get("units", "")) for one in variables]
    found = Units(*(name or _NONE for name in names))
    return None if found == Units() else found


def with_units(data: xr.Dataset, units: Units | None) -> xr.Dataset:
    """Name the units of each variable of a run's data set, if there are any, in place; return it."""
    if units is None:
        return data
    alpha = 1.0 + float(data.beta) if "beta" in data.coords else None  # an order that varies
    for name, variable in data.variables.items():
        unit = units.of(str(name), alpha, int(data.dim))
        for attributes in (data[name].attrs, variable.attrs):  # of a coordinate, two
            if unit is not None:
                attributes["units"] = unit
            elif name in _DIMENSIONS:
                attributes.pop("units", None)
    return data
