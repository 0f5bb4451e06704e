"""Kernels of order 2 to 12: the order in h, and the floor where it ends.

With the exterior in three terms and exact in time, the error at a given order falls like h^order until one of three
things ends it: the model of the exterior, the alias of the lattice, or rounding. GPSE in one step has no smoothing
error and shows what the first and the last leave.
"""

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.run.orders import observed_order
from fracstudy.inputs import Inputs, Result

_KEY = ["scheme", "overlap", "order"]


def study(inputs: Inputs) -> Result:
    """List the errors against h, with the orders observed, and the least error of each kernel.

    The order of a kernel is taken from the step of h where it is largest: before, h does not resolve the kernel's
    epsilon = s h; after, the floor.
    """
    runs = inputs.scalars.rename(columns={"relative_l1_error": "error", "particle_spacing": "h"})
    runs["overlap"] = runs["overlap"].where(runs["scheme"] != "GPSE", np.nan).round(6)
    rows = []
    for (scheme, overlap, order), part in runs.groupby(_KEY, dropna=False):
        h, error = part.sort_values("h", ascending=False)[["h", "error"]].to_numpy().T
        between: Any = [] if scheme == "GPSE" else observed_order(h, error)
        row = {
            "scheme": scheme,
            "overlap": overlap,
            "order": "one step" if scheme == "GPSE" else order,
            "largest order in h": max(between, default=np.nan),
            "least error": error.min(),
            "at h": h[np.argmin(error)],
        }
        rows.append(row | {f"h = {one:.3g}": e for one, e in zip(h, error, strict=True)})
    series = runs[[*_KEY, "h", "error"]].sort_values([*_KEY, "h"])
    return Result(pd.DataFrame(rows), (), series.reset_index(drop=True))
