"""The SPH approximation of fractional operators: Figs. 3 to 9, and the repair of the integral."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Literal

import numpy as np
import pandas as pd

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.integrals import METHODS
from fracparticles.sph.norms import r2_score, relative_l2
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement, value
from scenes.ghorbani.operators import LABELS, OPERATORS, Order, order_at

__all__ = ["study"]

_MARGIN = 5  # particles within 4 h, 4.4 s, of an end: their sums of sums see it
_EFFECTIVE = 0.1  # the modified form has at most this share of the standard form's error


def study(
    inputs: Inputs,
    *,
    operator: Literal["caputo", "rl_derivative", "rl_integral"],
    order: Order,
    length: float,
    count: int,
    smoothing_ratio: float,
) -> Result:
    """Apply one operator to the four functions, by the standard, the halved and the modified sums.

    `length`, `count` and `smoothing_ratio` are those of the particles. The first item of the scene is the figure of the
    standard form, the second, if any, that of the modified form.

    That a function is the worst holds if its error (39) is the largest of the four and its score (40) the smallest; the
    modified form is effective if it has at most a tenth of the standard form's error.
    """
    kind = OPERATORS[operator]
    line = ParticleLine(0.0, length, count, smoothing_ratio)
    alpha = order_at(order, line.x_all)
    judged, inner = slice(kind.first, None), slice(_MARGIN, -_MARGIN)
    item = dict(zip(("standard", "modified"), inputs.items, strict=False))
    rows, curves = [], []
    for (name, function), method in product(FUNCTIONS.items(), METHODS):
        exact = kind.exact(function, line.x, alpha[line.inside])[judged]
        ours = kind.approximate(line, function.value(line.x_all), alpha, method=method)[judged]
        error, figure = np.abs(ours - exact), item.get(method)
        columns = {"x": line.x[judged], "exact": exact, "sph": ours.real, "error": error}
        curves.append(pd.DataFrame({"function": name, "method": method, **columns}))
        away = relative_l2(exact[inner], ours[inner])
        rows.append(
            {
                "function": name,
                "sums": method,
                "L2, printed": inputs.printed.get(f"{figure}.{name}.L2"),
                "L2": relative_l2(exact, ours),
                "R2, printed": inputs.printed.get(f"{figure}.{name}.R2"),
                "R2": r2_score(exact, ours),
                "L2 of the real part": relative_l2(exact, ours.real),
                f"L2 more than {_MARGIN} particles from the ends": away,
                "largest error": float(error.max()),
            }
        )
    table = pd.DataFrame(rows)
    findings = list(_findings(table.set_index(["function", "sums"]), inputs.printed, item))
    shown = table.replace({"function": LABELS})
    return Result(shown, findings, pd.concat(curves, ignore_index=True))


def _findings(
    table: pd.DataFrame, printed: Mapping[str, str], item: Mapping[str, str]
) -> Iterator[Finding]:
    """Our number for each printed one, <item>.<function>.L2 or R2; the worst function; the modified form."""
    reason = "Another reading than ours stands behind the printed digits."
    for (method, figure), name, measure in product(item.items(), FUNCTIONS, ("L2", "R2")):
        claim = f"{figure}.{name}.{measure}"
        if claim in printed:
            yield value(claim, table.loc[(name, method), measure], reason)
    l2, r2 = (table[measure].unstack("sums").loc[list(FUNCTIONS)] for measure in ("L2", "R2"))
    if "standard" in item:
        figure, worst = item["standard"], l2["standard"].idxmax()
        claimed = next(name for name in FUNCTIONS if f"{figure}.{name}.L2" in printed)
        listed = ", ".join(f"{error:.6f} ({name})" for name, error in l2["standard"].items())
        yield statement(
            f"{figure}.worst",
            worst == claimed == r2["standard"].idxmin(),
            f"L2 of the standard form is {listed}; with half volumes at the two ends that of {claimed} is "
            f"{l2.loc[claimed, 'halved']:.6f}.",
            f"The largest L2 is that of {worst}.",
        )
    if "modified" in item:
        sine = l2.loc["sin"]
        yield statement(
            f"{item['modified']}.effective",
            sine["modified"] <= _EFFECTIVE * sine["standard"],
            f"L2 for sin falls from {sine['standard']:.6f} to {sine['modified']:.6f} with the auxiliary particles, and "
            f"to {sine['halved']:.6f} with half volumes at the two ends and no auxiliary particle.",
            "The modified form keeps more than a tenth of the error.",
        )
