"""Effect of the smoothing length: error (48) against epsilon / h at fixed h, Sec. 4.3 (not shown there)."""

import numpy as np
import pandas as pd

from fracparticles.run.orders import observed_order
from fracstudy.findings import Finding, measured
from fracstudy.inputs import NUMERALS, ORDERS, Inputs, Result
from scenes.lucchesi.levels import order_of_runs

NEEDS = {"exterior": ["truncated", "open"]}

_SMOOTH = 2.0  # epsilon / h from which on the quadrature error no longer counts (order IV: 1e-8)
_KEY = ["beta", "exterior", "scheme", "order"]
_SORTED = ["exterior", "beta", "scheme", "order"]


def study(inputs: Inputs, *, shown_beta: float, claimed_from: float) -> Result:
    """Errors against epsilon / h, truncated as the paper has them and with the open exterior.

    The smoothing error grows like epsilon^2 (order II) or epsilon^4 (order IV); the quadrature error of the
    lattice, of the order exp(-(pi epsilon / h)^2), counts for epsilon < h; the truncation error, zero with the open
    exterior, does not depend on epsilon. What is measured is how much the truncated error at `shown_beta` changes over
    all epsilon > `claimed_from` h, and how much the observed order does.
    """
    runs = inputs.scalars
    asked = np.sort(runs.loc[runs["scheme"] != "GPSE", "overlap"].unique())
    # GPSE takes a whole number of steps: its realised overlap is next to the one asked for.
    runs = runs.assign(s=runs["overlap"].map(lambda s: asked[np.abs(np.log(asked / s)).argmin()]))
    shown = np.sort(runs.loc[runs["exterior"] == "truncated", "s"].unique())
    ratio = f"largest / smallest, ε > {claimed_from:g} h"
    power = f"power of ε, ε ≥ {_SMOOTH:g} h"
    rows = []
    for (beta, exterior, scheme, order), part in runs.groupby(_KEY):
        error = part.set_index("s")["relative_l1_error"].sort_index()
        above, smooth = error[error.index > claimed_from], error[error.index >= _SMOOTH]
        ends = smooth.iloc[[-1, 0]]
        row = {
            "beta": beta,
            "exterior": exterior,
            "scheme": scheme,
            "order": "-" if scheme == "GPSE" else NUMERALS[order],
            **{f"error, ε = {s:g} h": error.get(s, np.nan) for s in shown},
            ratio: above.max() / above.min(),
            power: np.nan if scheme == "GPSE" else observed_order(ends.index, ends)[0],
        }
        rows.append(row)
    table = pd.DataFrame(rows).sort_values(_SORTED, ascending=[False, True, True, True])
    series = runs.rename(columns={"relative_l1_error": "y"}).assign(x=runs["overlap"])
    here = table[table["beta"] == shown_beta].set_index(_SORTED[:1] + _SORTED[2:]).sort_index()
    judged = runs[(runs["beta"] == shown_beta) & runs["scheme"].isin(["DD", "FPSE", "KPSE"])]
    overlaps = asked[asked > claimed_from]
    findings = [
        _finding(s, here[ratio]["truncated", s], here[power]["open", s], part, overlaps)
        for s, part in judged.groupby("scheme")
        if inputs.items
    ]
    return Result(table, findings, series[[*_KEY, "x", "y"]])


def _finding(
    scheme: str, ratio: pd.Series, power: pd.Series, runs: pd.DataFrame, overlaps: np.ndarray
) -> Finding:
    """The change of the error over all overlaps; in another reading that of the order, which needs a coarser h."""
    grid = {"scheme": scheme, "beta": float(runs["beta"].iloc[0])}
    grid |= {"truncation": 20.0, "integrator": "exponential", "exterior": "open"}
    h = float(runs["particle_spacing"].min()) * np.array([4.0, 2.0])
    change = {
        name: np.ptp([order_of_runs(h, order=p, overlap=s, **grid) for s in overlaps]) / p
        for p, name in ORDERS.items()
    }
    of_order = {"the order of convergence in h instead of the error": {"change": change}}
    numbers = {"change": ratio - 1.0, "power": power, "order": change}
    return measured(f"L-C9.{scheme}", runs=runs["run"], others=of_order, **numbers)
