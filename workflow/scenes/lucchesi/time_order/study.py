"""Order of self-convergence in time, Eq. (49), Sec. 4.3 (not shown there)."""

import numpy as np
import pandas as pd

from fracparticles.run.dataset import read_run
from fracparticles.run.orders import observed_order, self_convergence_order
from fracstudy.errors import EPS
from fracstudy.findings import measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

NEEDS = {"integrator": ["exponential"]}

# The name and the order of each integrator.
_INTEGRATORS = {"euler": ("RK1", 1.0), "rk2": ("RK2", 2.0), "rk4": ("RK4", 4.0)}
# n steps and a sum over N particles leave differences of about n eps |u|; below a hundred times that of 2000 steps
# the difference of two solutions is noise.
_NOISE = 100.0 * 2000.0 * EPS
_SETTLED = "order (49), smallest dt above round-off"


def study(inputs: Inputs) -> Result:
    """Self-convergence (49) with the time step halved, and errors against the exponential, exact in time.

    Norms run over |x| <= 5 R_alpha. The last order whose differences lie above round-off counts.
    """
    rows: list[dict[str, object]] = []
    panels = Panels()
    for (beta, scheme), part in inputs.scalars.groupby(["beta", "scheme"]):
        fields = part["run"].map(lambda run: read_run(run)["u"].values)
        exact = fields[part["integrator"] == "exponential"].iloc[0]
        stepped = part[part["integrator"].isin(_INTEGRATORS)].sort_values("dt", ascending=False)
        for integrator, levels in stepped.groupby("integrator"):
            name, order = _INTEGRATORS[integrator]
            key = {"beta": beta, "scheme": scheme, "integrator": name, "expected order": order}
            dt, u = levels["dt"].to_numpy(), np.stack(list(fields[levels.index]))
            error = np.abs(u - exact).sum(axis=1) / np.abs(exact).sum()
            change = np.abs(np.diff(u, axis=0)).sum(axis=1) / np.abs(exact).sum()
            orders = [self_convergence_order(u[k : k + 3]) for k in range(len(u) - 2)]
            settled = np.flatnonzero(change[1:] > _NOISE)
            last = int(settled[-1]) if settled.size else 0
            clear = error > _NOISE
            row = {
                **key,
                "order (49), largest dt": orders[0],
                _SETTLED: orders[last],
                "at dt": dt[last],
                "order against exact in time": observed_order(dt[clear], error[clear])[-1],
                "error at the largest dt": error[0],
                "error at the smallest dt": error[-1],
                "runs": levels["run"],
            }
            rows.append(row)
            panels.add(beta=beta, scheme=scheme, integrator=integrator, x=dt, y=error)
    table = pd.DataFrame(rows)
    judged = table[table["integrator"].isin(["RK1", "RK2"])] if inputs.items else table[:0]
    findings = []
    for (scheme, name), part in judged.groupby(["scheme", "integrator"]):
        order = part.set_index("beta")[_SETTLED]
        away = (order - part["expected order"].iloc[0]).abs()
        files = pd.concat(list(part["runs"]))
        findings.append(measured(f"L-C10.{scheme}.{name}", runs=files, away=away, order=order))
    return Result(table.drop(columns="runs"), findings, panels.frame)
