"""DVM and its remeshing: error (48) of the field (7) and of the strengths, against h, against x and against dt.

"Piecewise cubic, preserving the four first moments" (Sec. 4.1) can be read as M4', the usual one, which keeps
three, or as the four-moment Lambda_3: both are run, and none at all.
"""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from fracparticles.run.dataset import read_run
from fracparticles.run.orders import observed_order
from fracparticles.run.strengths import lattice_strengths
from fracparticles.special.stable import central_mass, green, mean_radius
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.panels import Panels, pick

NEEDS = {"scheme": ["DVM"]}

_NEAR = 1.5  # |x| of the profile that the figure shows
_SMALL = 1e-3  # of the spatial error: what the error in time may be
_KINDS = {"field": "u", "strengths": "U"}  # what the errors are of
_IN_TIME = "in time / error"
# Column of the table: what it holds of a run.
_COLUMNS = {
    "order": "order",
    "remeshing": "remeshing",
    "h": "h",
    "Δt": "dt",
    "error, field (7)": "field",
    "order, field": "order, field",
    "error, strengths": "strengths",
    "order, strengths": "order, strengths",
    "strength at x = 0, relative error": "spike",
    _IN_TIME: _IN_TIME,
    f"below {_SMALL:g}": "small",
    "remeshings": "remeshings",
    "steps": "steps",
    "largest spacing / h": "largest",
}


def study(inputs: Inputs, *, shown: float) -> Result:
    """One row a run; the profiles are those with the spacing nearest to `shown`.

    The step is that which all spacings have in common; runs with other steps are the study of the step: the error
    in time of a run is its distance from the one with the smallest step of that spacing, over |x| <= 5 R_alpha and
    relative to the error (48) of the latter.
    """
    runs = pd.DataFrame([_measure(read_run(path)) for path in inputs.scalars["run"]])
    # The step that every spacing was run with.
    step = min(set.intersection(*[set(part["dt"]) for _, part in runs.groupby("h")]))
    runs[_IN_TIME] = np.nan
    panels, key = Panels(), ["order", "remeshing"]
    for (order, name), part in runs.groupby(key):
        main = pick(part, dt=step).sort_values("h", ascending=False)
        for kind in _KINDS:
            orders = observed_order(main["h"], main[kind])
            runs.loc[main.index, f"order, {kind}"] = [np.nan, *orders]
        for _, same in part.groupby("h"):
            finest = same.loc[same["dt"].idxmin()]
            for index, row in same.drop(finest.name).iterrows():
                apart = np.abs(row["u"] - finest["u"]).sum() * row["h"] / row["mass"]
                runs.loc[index, _IN_TIME] = apart / finest["field"]
        nearest = main.iloc[np.argmin(np.abs(main["h"] - shown))]
        near = np.abs(nearest["x"]) <= _NEAR
        for kind, u in _KINDS.items():
            y = (nearest[u] / nearest["exact"] - 1.0)[near]
            where = {"panel": "profile", "order": order, "remeshing": name, "kind": kind}
            panels.add(**where, x=nearest["x"][near], y=y)
    runs = runs.sort_values(["order", "remeshing", "h", "dt"], ascending=[True, True, False, False])
    small = np.where(runs[_IN_TIME] < _SMALL, "yes", "no")
    verdicts = runs.assign(small=np.where(runs[_IN_TIME].isna(), "", small))
    table = verdicts.assign(order=runs["order"].map(ORDERS))[list(_COLUMNS.values())]
    table = table.set_axis(list(_COLUMNS), axis=1)
    main = pick(runs, dt=step)
    for kind in _KINDS:
        panels.add("spacing", kind=kind, x=main["h"], y=main[kind], **main[key])
    panels.add("time", kind="field", x=runs["dt"], y=runs[_IN_TIME], **runs[[*key, "h"]])
    return Result(table, (), panels.frame.dropna(subset=["y"]).reset_index(drop=True))


def _measure(run: xr.Dataset) -> dict[str, Any]:
    """Errors of one run over |x| <= 5 R_alpha, and its fields there."""
    alpha, time, h = 1.0 + float(run["beta"]), float(run["t_final"]), float(run["particle_spacing"])
    name, x = str(run["remeshing"].values), run["x"].values
    half = 5.0 * mean_radius(alpha)
    inside = np.abs(x) <= half * (1.0 + 1e-12)
    exact = np.asarray(green(x[inside], time, alpha))
    mass = float(central_mass(half, time, alpha))
    field = run["u"].values[inside]
    # Without remeshing the particles lie two spacings apart at last: a lattice of h would have holes.
    strengths = np.full(exact.size, np.nan) if name == "none" else lattice_strengths(run)[inside]
    middle = exact.size // 2
    return {
        "order": int(run["order"]),
        "remeshing": name,
        "h": h,
        "dt": float(run["dt"]),
        "field": float(h * np.abs(field - exact).sum() / mass),
        "strengths": float(h * np.abs(strengths - exact).sum() / mass),
        "spike": float(strengths[middle] / exact[middle] - 1.0),
        "remeshings": int(run["remeshings"]),
        "steps": int(run["operator_applications"]) // 2,
        "largest": float(run["largest_spacing"]) / h,
        "mass": mass,
        "x": x[inside],
        "u": field,
        "U": strengths,
        "exact": exact,
    }
