"""The error of DVM in the plane and on the line at the same h, with remeshing and without."""

import warnings
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import AccuracyWarning
from fracparticles.moving import dvm
from fracparticles.moving.dvm_plane import run_in_plane
from fracparticles.run.orders import observed_order
from fracparticles.special.stable import green
from fracstudy.inputs import Inputs, Result
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
    panels, rows = Panels(), []
    for remeshing, exterior in _WAYS:
        for order in orders:
            found: list[dict[str, Any]] = []
            for h in spacings:
                lattice = h * np.arange(-round(half_width / h), round(half_width / h) + 1.0)
                steps = int(np.ceil(time / (_STEP * h**alpha)))
                common: dict[str, Any] = {
                    "spacing": h, "alpha": alpha, "dt": time / steps, "steps": steps,
                    "order": order, "remeshing": remeshing, "exterior": exterior,
                }  # fmt: skip
                r = np.hypot(lattice[:, None], lattice)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", AccuracyWarning)  # coarse ones are to be seen
                    plane = run_in_plane(np.asarray(green(r, start, alpha, 2)), **common)
                    line = dvm.run(lattice, np.asarray(green(lattice, start, alpha)), **common)
                z = np.linspace(-2.0, 2.0, 41)
                fields = plane.field(z, 0.0 * z), line.field(z)
                drift = plane.total_final + plane.lost - plane.total_initial
                for dim, field in zip((2, 1), fields, strict=True):
                    exact = np.asarray(green(np.abs(z), start + time, alpha, dim))
                    error = float(np.abs(field - exact).max() / exact.max())
                    found.append({"dim": dim, "order": order, "remeshing": remeshing, "h": h,
                                  "exterior": exterior, "error": error,
                                  "drift below": _power_of_ten(abs(drift)) if dim == 2 else np.nan})  # fmt: skip
            for dim in (2, 1):
                part = [row for row in found if row["dim"] == dim]
                errors = [row["error"] for row in part]
                slopes = [np.nan, *observed_order(spacings, errors)]
                name = f"{'plane' if dim == 2 else 'line'}, order {order}"
                panels.add(f"{remeshing}, {exterior}", name, spacings, errors, dim=dim, order=order)
                rows += [{**row, "observed order": s} for row, s in zip(part, slopes, strict=True)]
    return Result(pd.DataFrame(rows), (), panels.frame)


def _power_of_ten(drift: float) -> float:
    """The next power of ten: of round-off only the size is reproducible."""
    return float(10.0 ** np.ceil(np.log10(max(drift, 2.0**-53))))
