"""Section 5 carried to n = 3, a study of our own: error and cost against h on a cube.

The schemes are those of the paper with the kernels for n = 3; the error is (59) over the ball |x| <= 5. Cost is
counted, not timed, so that the same runs give the same table; for times see the benchmark.
"""

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.schemes.cost import bytes_kept, operations
from fracparticles.schemes.setting import Setting
from fracparticles.special import green
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.orders import orders_by
from scenes.plane import particles_per_side

_KEY = ["scheme", "order", "exterior"]


def study(inputs: Inputs) -> Result:
    """Return the errors with their orders, what each run cost, and its mass beside the exact mass in the cube."""
    runs = inputs.scalars.rename(columns={"particle_spacing": "h", "relative_l1_error": "error"})
    runs["N"] = particles_per_side(inputs.scalars)
    runs = runs.sort_values([*_KEY, "h"], ascending=[True, True, False, False], ignore_index=True)
    counted = [_counted(run) for run in runs.itertuples()]
    applications, memory, exact = (np.array(part) for part in zip(*counted, strict=True))
    runs["work"] = runs["operator_applications"] * applications
    columns = {
        "scheme": runs["scheme"],
        "order": runs["order"].map(ORDERS).where(runs["scheme"] != "GPSE", "-"),
        "exterior": runs["exterior"],
        "N": runs["N"].astype(str) + "^" + runs["dim"].astype(str),
        "h": runs["h"],
        "error (59)": runs["error"],
        "order from the h above": orders_by(runs, _KEY, "error"),
        "operator applications": runs["operator_applications"],
        "work / 10^9 operations": 1e-9 * runs["work"],
        "kept / bytes a particle": (memory / runs["N"] ** runs["dim"]).round().astype(int),
        "mass at t0": runs["mass_initial"],
        "mass at tf": runs["mass_final"],
        "mass at tf, exact": exact,
    }
    return Result(pd.DataFrame(columns), series=runs[[*_KEY, "N", "h", "error", "work"]])


def _counted(run: Any) -> tuple[float, float, float]:
    """Operations of one application, bytes kept, and h^n sum_i G(x_i, t_f), the mass of the solution on the lattice."""
    n, alpha = run.N // 2, 1.0 + run.beta
    how = {"order": run.order, "overlap": run.overlap, "exterior": run.exterior}
    setting = Setting(alpha=alpha, dim=run.dim, n=n, spacing=run.h, **how)
    squares = sum(np.square(part) for part in setting.positions)
    u = green(np.sqrt(squares), run.diffusivity * run.t_final, alpha, run.dim)
    mass = float(run.h**run.dim * np.sum(u))
    return operations(run.scheme, setting), bytes_kept(run.scheme, setting), mass
