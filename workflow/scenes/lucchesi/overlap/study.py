"""Effect of the smoothing length: error (48) against epsilon / h at fixed h, Sec. 4.3 (not shown there)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracstudy.claims import Finding
from fracstudy.inputs import ORDERS, Inputs, Result, statement

__all__ = ["study"]

_INSENSITIVE = 2.0  # the error changes by less than this factor
_SMOOTH = 2.0  # epsilon / h from which on the quadrature error no longer counts (order IV: 1e-8)
_KEY = ["beta", "exterior", "scheme", "order"]


def study(inputs: Inputs) -> Result:
    """Errors against epsilon / h, truncated as the paper has them and with the open exterior.

    The smoothing error grows like epsilon^2 (order II) or epsilon^4 (order IV); the quadrature error of the
    lattice, of the order exp(-(pi epsilon / h)^2), counts for epsilon < h; the truncation error, nil with the open
    exterior, does not depend on epsilon. A scheme is called insensitive if its truncated error at the `beta` of the
    scene, in either order, changes by less than a factor of 2 over all epsilon > `claimed_from` h.
    """
    runs = inputs.scalars
    asked = np.sort(runs.loc[runs["scheme"] != "GPSE", "overlap"].unique())
    # GPSE takes a whole number of steps: its realised overlap is next to the one asked for.
    runs = runs.assign(s=runs["overlap"].map(lambda s: asked[np.abs(np.log(asked / s)).argmin()]))
    shown = np.sort(runs.loc[runs["exterior"] == "truncated", "s"].unique())
    least = float(inputs.parameters["claimed_from"])
    rows = []
    for key, part in runs.groupby(_KEY):
        error = part.set_index("s")["relative_l1_error"].sort_index()
        above = error[error.index > least]
        rows.append(
            {
                **dict(zip(_KEY, key, strict=True)),
                "order": "-" if key[2] == "GPSE" else ORDERS[key[3]],
                **{f"error, ε = {s:g} h": error.get(s, np.nan) for s in shown},
                f"largest / smallest, ε > {least:g} h": above.max() / above.min(),
                f"power of ε, ε ≥ {_SMOOTH:g} h": np.nan
                if key[2] == "GPSE"
                else _power(error[error.index >= _SMOOTH]),
            }
        )
    table = pd.DataFrame(rows).sort_values(
        ["exterior", "beta", "scheme", "order"], ascending=[False, True, True, True]
    )
    series = runs.rename(columns={"relative_l1_error": "y"}).assign(x=runs["overlap"])
    findings = [_finding(scheme, inputs, table, runs) for scheme in ("DD", "FPSE", "KPSE")]
    return Result(table, findings, series[[*_KEY, "x", "y"]])


def _finding(scheme: str, inputs: Inputs, table: pd.DataFrame, runs: pd.DataFrame) -> Finding:
    here = table[(table["scheme"] == scheme) & (table["beta"] == inputs.parameters["beta"])]
    ratio_name, power_name = table.columns[-2:]
    printed = here[here["exterior"] == "truncated"].set_index("order")
    opened = here[here["exterior"] == "open"].set_index("order")
    ratio, power = printed[ratio_name], opened[power_name]
    files = runs[(runs["scheme"] == scheme) & (runs["beta"] == inputs.parameters["beta"])]["run"]
    flat = [order for order in ratio.index if ratio[order] < _INSENSITIVE]
    exception = (
        f" Only order {' and '.join(flat)} is flat, where the truncation error, which does not depend on epsilon, "
        "is larger."
        if flat
        else ""
    )
    return statement(
        f"L-C9.{scheme}",
        bool((ratio < _INSENSITIVE).all()),
        f"Largest over smallest error for epsilon > h in the paper's setting, orders II and IV: {ratio['II']:.3g} and "
        f"{ratio['IV']:.3g}; with the open exterior the error grows like epsilon^{power['II']:.2f} and "
        f"epsilon^{power['IV']:.2f}.",
        f"At fixed h the error for epsilon > h is the smoothing error, which the open exterior shows to follow "
        f"epsilon^2 and epsilon^4.{exception}",
        files,
    )


def _power(error: pd.Series) -> float:
    """The exponent p of error ~ epsilon^p between the first and the last epsilon."""
    first, last = error.index[[0, -1]]
    return float(np.log(error[last] / error[first]) / np.log(last / first))
