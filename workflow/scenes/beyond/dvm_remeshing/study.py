"""DVM and its remeshing: error (48) of the field (7) and of the strengths, against h, against x and against dt.

"Piecewise cubic, preserving the four first moments" (Sec. 4.1) can be read as M4', the usual one, which keeps
three, or as the four-moment Lambda_3: both are run, and none at all.
"""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.run.dataset import read_run
from fracparticles.special.stable import central_mass, green, mean_radius
from fracstudy.inputs import ORDERS, Inputs, Result, observed_order
from scenes.beyond.dvm_particles.study import lattice_strengths

__all__ = ["study"]

_NEAR = 1.5  # |x| of the profile that the figure shows
_SMALL = 1e-3  # of the spatial error: what the error in time may be


def study(inputs: Inputs) -> Result:
    """One row a run. Parameters: `shown`, the spacing of the profiles.

    The step is that which all spacings have in common; runs with other steps are the study of the step: the error
    in time of a run is its distance from the one with the smallest step of that spacing, over |x| <= 5 R_alpha and
    relative to the error (48) of the latter.
    """
    rows = [_measure(run) for run in inputs.scalars["run"]]
    runs = pd.DataFrame(rows)
    step = _common_step(runs)
    runs["in time / error"] = np.nan
    parts = []
    for (order, name), part in runs.groupby(["order", "remeshing"], sort=True):
        main = part[part["dt"] == step].sort_values("h", ascending=False)
        for column in ("field", "strengths"):
            orders = [np.nan, *observed_order(main["h"].to_numpy(), main[column].to_numpy())]
            runs.loc[main.index, f"order, {column}"] = orders
        for _, same in part.groupby("h"):
            finest = same.loc[same["dt"].idxmin()]
            for index, row in same.drop(finest.name).iterrows():
                apart = np.abs(row["u"] - finest["u"]).sum() * row["h"] / row["mass"]
                runs.loc[index, "in time / error"] = apart / finest["field"]
        profile = main.iloc[np.argmin(np.abs(main["h"] - inputs.parameters["shown"]))]
        parts += _profiles(profile, order, name)
    runs = runs.sort_values(["order", "remeshing", "h", "dt"], ascending=[True, True, False, False])
    table = pd.DataFrame(
        {
            "order": runs["order"].map(ORDERS),
            "remeshing": runs["remeshing"],
            "h": runs["h"],
            "Δt": runs["dt"],
            "error, field (7)": runs["field"],
            "order, field": runs["order, field"],
            "error, strengths": runs["strengths"],
            "order, strengths": runs["order, strengths"],
            "strength at x = 0, relative error": runs["spike"],
            "in time / error": runs["in time / error"],
            f"below {_SMALL:g}": runs["in time / error"].map(
                lambda ratio: "" if np.isnan(ratio) else "yes" if ratio < _SMALL else "no"
            ),
            "remeshings": runs["remeshings"],
            "steps": runs["steps"],
            "largest spacing / h": runs["largest"],
        }
    )
    lines = runs.assign(main=runs["dt"] == step)
    return Result(table, [], _series(lines, parts))


def _measure(path: str) -> dict[str, object]:
    """Errors of one run over |x| <= 5 R_alpha, and its fields there."""
    run = read_run(path)
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


def _common_step(runs: pd.DataFrame) -> float:
    """The step that every spacing was run with."""
    steps = [set(part["dt"]) for _, part in runs.groupby("h")]
    return min(set.intersection(*steps))


def _profiles(run: pd.Series, order: int, name: str) -> list[pd.DataFrame]:
    """Relative deviations of the field and of the strengths along x, near the peak."""
    near = np.abs(run["x"]) <= _NEAR
    parts = []
    for kind, values in (("field", run["u"]), ("strengths", run["U"])):
        part = {"x": run["x"][near], "y": (values / run["exact"] - 1.0)[near]}
        parts.append(
            pd.DataFrame(
                {"panel": "profile", "kind": kind, "order": order, "remeshing": name, **part}
            )
        )
    return parts


def _series(runs: pd.DataFrame, profiles: list[pd.DataFrame]) -> pd.DataFrame:
    parts = [*profiles]
    for kind in ("field", "strengths"):
        main = runs[runs["main"]]
        parts.append(
            main[["order", "remeshing"]].assign(
                panel="spacing", kind=kind, x=main["h"], y=main[kind]
            )
        )
    timed = runs[runs["in time / error"].notna()]
    parts.append(
        timed[["order", "remeshing", "h"]].assign(
            panel="time", kind="field", x=timed["dt"], y=timed["in time / error"]
        )
    )
    return pd.concat(parts, ignore_index=True).dropna(subset=["y"])
