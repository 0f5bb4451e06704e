"""The error of DVM in the plane and on the line at the same h, with remeshing and without."""

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.moving import dvm
from fracparticles.moving.dvm_plane import run_in_plane
from fracparticles.special.stable import green
from fracstudy.errors import off, power_of_ten, quiet
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import observed
from fracstudy.panels import Panels

_STEP = 0.5  # D dt / h^alpha
_WAYS = (
    ("none", "open"),
    ("Lambda3", "open"),
    ("M4'", "truncated"),
    ("Lambda6,4", "truncated"),
    ("Lambda6,4", "open"),
)


def study(
    inputs: Inputs,
    *,
    alpha: float,
    start: float,
    time: float,
    half_width: float,
    spacings: list[float],
    orders: list[int],
) -> Result:
    """A row for each run: the greatest error for |x| <= 2, of the peak, and the drift of the total."""
    panels = Panels()
    rows: list[dict[str, Any]] = []
    for remeshing, exterior in _WAYS:
        way = {"remeshing": remeshing, "exterior": exterior}
        for order in orders:
            found = [
                _run(dim, alpha, start, time, half_width, h, order=order, **way)
                for dim in (2, 1)
                for h in spacings
            ]
            for part in (found[: len(spacings)], found[len(spacings) :]):
                errors, dim = [row["error"] for row in part], part[0]["dim"]
                name = f"{'plane' if dim == 2 else 'line'}, order {order}"
                panels.add(f"{remeshing}, {exterior}", name, spacings, errors, dim=dim, order=order)
                slopes = observed(spacings, errors)
                rows += [{**row, "observed order": s} for row, s in zip(part, slopes, strict=True)]
    return Result(pd.DataFrame(rows), (), panels.frame)


def _run(
    dim: int, alpha: float, start: float, time: float, half_width: float, h: float, **way: Any
) -> dict[str, Any]:
    lattice = h * np.arange(-round(half_width / h), round(half_width / h) + 1.0)
    steps = int(np.ceil(time / (_STEP * h**alpha)))
    common = {"spacing": h, "alpha": alpha, "dt": time / steps, "steps": steps, **way}
    z = np.linspace(-2.0, 2.0, 41)
    exact = np.asarray(green(np.abs(z), start + time, alpha, dim))
    with quiet():  # coarse ones are to be seen
        if dim == 1:
            error = off(
                dvm.run(lattice, np.asarray(green(lattice, start, alpha)), **common).field(z), exact
            )
            drift = np.nan
        else:
            r = np.hypot(lattice[:, None], lattice)
            plane = run_in_plane(np.asarray(green(r, start, alpha, 2)), **common)
            error = off(plane.field(z, 0.0 * z), exact)
            drift = power_of_ten(plane.total_final + plane.lost - plane.total_initial)
    return {
        "dim": dim, "order": way["order"], "remeshing": way["remeshing"], "h": h,
        "exterior": way["exterior"], "error": error, "drift below": drift,
    }  # fmt: skip
