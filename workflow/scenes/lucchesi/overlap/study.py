"""Effect of the smoothing length: error (48) against epsilon / h at fixed h, Sec. 4.3 (not shown there)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.run.orders import observed_order
from fracstudy.claims import Finding
from fracstudy.inputs import NUMERALS, Inputs, Result, statement

__all__ = ["study"]

NEEDS = {"exterior": ["truncated", "open"]}

_INSENSITIVE = 2.0  # the error changes by less than this factor
_SMOOTH = 2.0  # epsilon / h from which on the quadrature error no longer counts (order IV: 1e-8)
_KEY = ["beta", "exterior", "scheme", "order"]
_SORTED = ["exterior", "beta", "scheme", "order"]


def study(inputs: Inputs, *, shown_beta: float, claimed_from: float) -> Result:
    """Errors against epsilon / h, truncated as the paper has them and with the open exterior.

    The smoothing error grows like epsilon^2 (order II) or epsilon^4 (order IV); the quadrature error of the
    lattice, of the order exp(-(pi epsilon / h)^2), counts for epsilon < h; the truncation error, zero with the open
    exterior, does not depend on epsilon. A scheme is called insensitive if its truncated error at `shown_beta`, in
    either order, changes by less than a factor of 2 over all epsilon > `claimed_from` h.
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
        rows.append(
            {
                "beta": beta,
                "exterior": exterior,
                "scheme": scheme,
                "order": "-" if scheme == "GPSE" else NUMERALS[order],
                **{f"error, ε = {s:g} h": error.get(s, np.nan) for s in shown},
                ratio: above.max() / above.min(),
                power: np.nan if scheme == "GPSE" else observed_order(ends.index, ends)[0],
            }
        )
    table = pd.DataFrame(rows).sort_values(_SORTED, ascending=[False, True, True, True])
    series = runs.rename(columns={"relative_l1_error": "y"}).assign(x=runs["overlap"])
    here = table[table["beta"] == shown_beta].set_index(_SORTED[:1] + _SORTED[2:]).sort_index()
    files = runs[runs["beta"] == shown_beta].groupby("scheme")["run"]
    findings = [
        _finding(s, here[ratio]["truncated", s], here[power]["open", s], files.get_group(s))
        for s in ("DD", "FPSE", "KPSE")
        if inputs.items
    ]
    return Result(table, findings, series[[*_KEY, "x", "y"]])


def _finding(scheme: str, ratio: pd.Series, power: pd.Series, files: pd.Series) -> Finding:
    flat = " and ".join(order for order in ratio.index if ratio[order] < _INSENSITIVE)
    exception = (
        f" Only order {flat} is flat, where the truncation error, which does not depend on epsilon, is larger."
        if flat
        else ""
    )
    return statement(
        f"L-C9.{scheme}",
        (ratio < _INSENSITIVE).all(),
        f"Largest over smallest error for epsilon > h in the paper's setting, orders II and IV: {ratio['II']:.3g} and "
        f"{ratio['IV']:.3g}; with the open exterior the error grows like epsilon^{power['II']:.2f} and "
        f"epsilon^{power['IV']:.2f}.",
        "At fixed h the error for epsilon > h is the smoothing error, which the open exterior shows to follow "
        f"epsilon^2 and epsilon^4.{exception}",
        files,
    )
