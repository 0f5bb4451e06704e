"""Order of self-convergence in time, Eq. (49), Sec. 4.3 (not shown there)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.run.dataset import read_run
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, observed_order, statement
from scenes.lucchesi.lucchesi_table_2.study import self_convergence_order

__all__ = ["study"]

_EXPECTED = {"euler": 1.0, "rk2": 2.0, "rk4": 4.0}
_NAMES = {"euler": "RK1", "rk2": "RK2", "rk4": "RK4"}
_NEAR = 0.1  # an observed order is consistent with p if it lies this close
# n steps and a sum over N particles leave differences of about n eps |u|; below a hundred times that of 2000 steps
# the difference of two solutions is noise.
_NOISE = 100.0 * 2000.0 * np.finfo(float).eps


def study(inputs: Inputs) -> Result:
    """Self-convergence (49) with the time step halved, and errors against the exponential, exact in time.

    Norms run over |x| <= 5 R_alpha. The last order whose differences lie above round-off counts; it is consistent
    with an integrator of order p if it lies within 0.1 of p, for every beta.
    """
    runs = inputs.scalars
    rows, series = [], []
    for (beta, scheme), part in runs.groupby(["beta", "scheme"]):
        part = part.assign(u=[read_run(run)["u"].values for run in part["run"]])
        exact = part.loc[part["integrator"] == "exponential", "u"].iloc[0]
        size = np.abs(exact).sum()
        for integrator, levels in part.groupby("integrator"):
            if integrator == "exponential":
                continue
            levels = levels.sort_values("dt", ascending=False)
            dt, u = levels["dt"].to_numpy(), np.stack(list(levels["u"]))
            error = np.abs(u - exact).sum(axis=1) / size
            order = [self_convergence_order(list(u[k : k + 3])) for k in range(len(u) - 2)]
            change = np.abs(np.diff(u, axis=0)).sum(axis=1)
            settled = np.flatnonzero(change[1:] / size > _NOISE)
            last = int(settled[-1]) if settled.size else 0
            clear = error > _NOISE
            rows.append(
                {
                    "beta": beta,
                    "scheme": scheme,
                    "integrator": _NAMES[integrator],
                    "expected order": _EXPECTED[integrator],
                    "order (49), largest dt": order[0],
                    "order (49), smallest dt above round-off": order[last],
                    "at dt": dt[last],
                    "order against exact in time": observed_order(dt[clear], error[clear])[-1],
                    "error at the largest dt": error[0],
                    "error at the smallest dt": error[-1],
                }
            )
            series.append(
                pd.DataFrame(
                    {"beta": beta, "scheme": scheme, "integrator": integrator, "x": dt, "y": error}
                )
            )
    table = pd.DataFrame(rows)
    findings = [
        _finding(table, runs, scheme, name)
        for scheme in ("DD", "FPSE", "KPSE")
        for name in ("RK1", "RK2")
    ]
    return Result(table, findings, pd.concat(series, ignore_index=True))


def _finding(table: pd.DataFrame, runs: pd.DataFrame, scheme: str, name: str) -> Finding:
    here = table[(table["scheme"] == scheme) & (table["integrator"] == name)]
    order = here["order (49), smallest dt above round-off"]
    files = runs[(runs["scheme"] == scheme) & (runs["integrator"].map(_NAMES.get) == name)]["run"]
    spelled = ", ".join(f"{p:.3f} (beta = {b:g})" for p, b in zip(order, here["beta"], strict=True))
    return statement(
        f"L-C10.{scheme}.{name}",
        bool(((order - here["expected order"]).abs() < _NEAR).all()),
        f"Order of self-convergence (49), time step halved: {spelled}.",
        "Not in the asymptotic range above round-off.",
        files,
    )
