"""The SPH approximation of fractional operators: Figs. 3 to 9, and the repair of the integral."""

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any, Literal

import numpy as np
import pandas as pd

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.integrals import METHODS
from fracparticles.sph.norms import r2_score, relative_l2
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.ghorbani.operators import LABELS, OPERATORS, Order

_MARGIN = 5  # particles within 4 h, 4.4 s, of an end: their sums of sums see it
_INNER = slice(_MARGIN, -_MARGIN)


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
    """
    line = ParticleLine(0.0, length, count, smoothing_ratio)
    item = dict(zip(("standard", "modified"), inputs.items, strict=False))
    rows, panels = [], Panels()
    for name, method in product(FUNCTIONS, METHODS):
        x, exact, ours = OPERATORS[operator].compared(line, name, order, method)
        error, figure = np.abs(ours - exact), item.get(method)
        curve = {"x": x, "exact": exact, "sph": ours.real, "error": error}
        panels.add(function=name, method=method, **curve)
        away = relative_l2(exact[_INNER], ours[_INNER])
        row = {
            "function": name,
            "sums": method,
            "L2, printed": inputs.printed.get(f"{figure}.{name}.L2"),
            "L2": relative_l2(exact, ours),
            "R2, printed": inputs.printed.get(f"{figure}.{name}.R2"),
            "R2": r2_score(exact, ours),
            "L2 of the real part": relative_l2(exact, ours.real),
            f"L2 more than {_MARGIN} particles from the ends": away,
            "largest error": float(error.max()),
            "range": float(np.ptp(exact)),
        }
        rows.append(row)
    table = pd.DataFrame(rows)
    findings = list(_findings(table.set_index(["function", "sums"]), inputs.printed, item))
    if "modified" in item and not isinstance(order, dict):
        findings += _others(line, order, **item)
    shown = table.drop(columns="range").replace({"function": LABELS})
    return Result(shown, findings, panels.frame)


def _findings(
    table: pd.DataFrame, printed: Mapping[str, str], item: Mapping[str, str]
) -> Iterator[Finding]:
    """Our number for each printed one, <item>.<function>.L2 or R2; the worst function; the modified form."""
    for (method, figure), name, measure in product(item.items(), FUNCTIONS, ("L2", "R2")):
        claim = f"{figure}.{name}.{measure}"
        if claim in printed:
            yield measured(claim, ours=table.loc[(name, method), measure])
    table["short"] = 1.0 - table["R2"]
    table["deviation"] = table["largest error"] / table["range"]
    if "standard" in item:
        figure, standard = item["standard"], table.xs("standard", level="sums")
        claimed = next(name for name in FUNCTIONS if f"{figure}.{name}.L2" in printed)
        others = standard.drop(claimed)
        yield measured(
            f"{figure}.worst",
            l2_over_next=standard.loc[claimed, "L2"] / others["L2"].max(),
            short_over_next=standard.loc[claimed, "short"] / others["short"].max(),
            l2=dict(standard["L2"].rename(LABELS)),
            halved=table.loc[(claimed, "halved"), "L2"],
        )
        of_l2 = {"the error L2 (39) instead": _deviations(standard["L2"], claimed)}
        agreement = _deviations(standard["deviation"], claimed)
        yield measured(f"{figure}.agreement", **agreement, others=of_l2)
    if "modified" in item:
        sine = table.loc["sin"]
        ratio = sine.loc["modified", ["L2", "short"]] / sine.loc["standard", ["L2", "short"]]
        numbers = {"l2_ratio": ratio["L2"], "short_ratio": ratio["short"], "l2": dict(sine["L2"])}
        yield measured(f"{item['modified']}.effective", **numbers)


def _deviations(by_function: pd.Series, claimed: str) -> dict[str, Any]:
    """Of all functions, of the one that is claimed to be the worst, of the others."""
    every, others = (dict(part.rename(LABELS)) for part in (by_function, by_function.drop(claimed)))
    return {"deviation": every, "worst": by_function[claimed], "rest": others}


def _others(line: ParticleLine, order: float, standard: str, modified: str) -> Iterator[Finding]:
    """The integral's errors beside those of the two derivatives, and what the modified form does to all three."""
    l2, inner, real = {}, {}, {}
    for operator, name, method in product(OPERATORS.values(), FUNCTIONS, ("standard", "modified")):
        _, exact, ours = operator.compared(line, name, order, method)
        case = operator.name, LABELS[name], method
        l2[case], real[case] = relative_l2(exact, ours), relative_l2(exact, ours.real)
        inner[case] = relative_l2(exact[_INNER], ours[_INNER])
    l2, inner, real = (pd.Series(errors).unstack(sort=False) for errors in (l2, inner, real))
    worst = l2["standard"].groupby(level=0, sort=False).max()
    integral = worst.pop(OPERATORS["rl_integral"].name)
    yield measured(f"{standard}.contrast", ratio=dict(integral / worst), l2=dict(worst))
    ratio, away, of_real = (
        dict(errors["modified"] / errors["standard"]) for errors in (l2, inner, real)
    )
    others = {"the real part alone": {"ratio": of_real}}
    others[f"the particles more than {_MARGIN} from the ends"] = {"ratio": away}
    yield measured(
        f"{modified}.all_operators", ratio=ratio, inner=max(away.values()), others=others
    )
