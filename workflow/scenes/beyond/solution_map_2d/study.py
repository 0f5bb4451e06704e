"""The solution of the two-dimensional problem of Sec. 5 and its errors, over the whole square."""

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import FracparticlesError
from fracparticles.special.plane import square_exchange_error, square_tail_mass
from fracparticles.special.stable import green
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.panels import Panels
from scenes.plane import DISC, particles_per_side

NEEDS = {"exterior": ["truncated", "open"]}

_OUTER = 0.8  # of the half-width: beyond it, what the tables call the outer fifth of the square


def study(inputs: Inputs, *, maps: list[list[str | int]]) -> Result:
    """Maps of u and of its relative error at t_f, truncated and open; a table of the errors in the disc and outside.

    Each of the `maps` is a scheme, its order, and what is shown, "u" or "error". Only the quadrant x, y >= 0 goes into
    the series: the rest is its mirror image.
    """
    runs = inputs.scalars
    rows, panels = [], Panels()
    for run in runs.assign(N=particles_per_side(runs)).itertuples():
        stored = inputs.open(scheme=run.scheme, order=run.order, exterior=run.exterior)
        if "u" not in stored:
            raise FracparticlesError(f"{inputs.scene}: a run without u; its runs must store: field")
        x, u = stored["x"].values, stored["u"].values
        r = np.hypot(x[:, None], x[None, :])
        exact = np.asarray(green(r, run.t_final, 1.0 + run.beta, 2))
        error = np.abs(u / exact - 1.0)
        rows.append(_row(run, x, u, r, error))
        for panel, (scheme, order, what) in enumerate(maps):
            if (scheme, order) == (run.scheme, run.order):
                n = x.size // 2
                quadrant = (u if what == "u" else error)[n:, n:]
                points = {"x": np.repeat(x[n:], n + 1), "y": np.tile(x[n:], n + 1)}
                where = {"exterior": run.exterior, "quantity": what}
                panels.add(panel, **where, **points, value=quadrant.reshape(-1))
    return Result(pd.DataFrame(rows), series=panels.frame)


def _row(
    run: Any, x: np.ndarray, u: np.ndarray, r: np.ndarray, error: np.ndarray
) -> dict[str, Any]:
    outer = np.maximum(np.abs(x[:, None]), np.abs(x[None, :])) > _OUTER * x[-1]
    alpha, half = 1.0 + run.beta, float(run.half_width)
    exchange = run.scheme in ("KPSE", "GPSE") and run.exterior == "truncated"
    predicted = square_exchange_error(half, alpha, run.t_final - run.t_initial)
    return {
        "scheme": run.scheme,
        "order": ORDERS[run.order],
        "exterior": run.exterior,
        "N": run.N,
        "error (59)": run.relative_l1_error,
        "truncation error, predicted": predicted if exchange else np.nan,
        "largest relative error, r <= 5": error[r <= DISC * (1.0 + 1e-12)].max(),
        "median relative error, outer fifth": np.median(error[outer]),
        "largest relative error": error.max(),
        "least u / largest u": u.min() / u.max(),
        "mass at t_f": run.mass_final,
        "mass at t_f, exact": 1.0 - square_tail_mass(half, run.t_final, alpha),
    }
