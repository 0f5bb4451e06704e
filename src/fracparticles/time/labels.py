"""The coordinates of labelled arrays: they must agree with a lattice that is given by its spacing."""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles.errors import InvalidInput

__all__ = ["check_labels"]

_OFF = 1e-6  # share of the spacing by which two neighbours may be misplaced, besides the round-off of the coordinates


def check_labels(u: Any, dim: int, spacing: float) -> None:
    """Refuse labelled data whose last `dim` coordinates do not rise or fall by the spacing.

    Coordinates that are whole numbers are taken as indices and not judged.

    Raises
    ------
    InvalidInput
        Names the first coordinate that does not agree.
    """
    for name, x in _coordinates(u)[-dim:]:
        if x.dtype.kind != "f" or x.size < 2:
            continue
        apart = np.diff(x.astype(float))
        rounded = 2.0 * float(np.finfo(x.dtype).eps) * float(np.abs(x).max())
        wrong = np.abs(np.abs(apart) - spacing) > _OFF * spacing + rounded
        if not wrong.any() and np.ptp(np.sign(apart)) == 0.0:
            continue
        k = int(wrong.argmax()) if wrong.any() else int(np.diff(np.sign(apart)).argmax())
        shown = f"data whose {name} go from {float(x[k])!r} to {float(x[k + 1])!r}"
        equal = f"values at points a spacing apart, {spacing:.9g}, in order"
        remedy = "Sort them, give the spacing that they have, or put them onto a lattice: fp.measured(data)."
        raise InvalidInput("u", shown, equal, remedy)


def _coordinates(u: Any) -> list[tuple[str, np.ndarray]]:
    """The names and coordinates of the axes of an xarray.DataArray or a pandas.Series; empty for other data."""
    if hasattr(u, "coords") and hasattr(u, "dims"):
        along = [(str(dim), u.coords[dim].values if dim in u.coords else ()) for dim in u.dims]
    elif hasattr(u, "index") and hasattr(u, "to_numpy"):
        along = [("index", u.index.to_numpy())]
    else:
        along = []
    return [(name, np.asarray(values)) for name, values in along]
