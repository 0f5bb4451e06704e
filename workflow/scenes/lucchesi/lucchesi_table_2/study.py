"""Order of self-convergence in space, Eq. (49), Table 2."""

from collections import defaultdict
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.run.dataset import read_run
from fracparticles.run.orders import observed_order, self_convergence_order
from fracparticles.run.strengths import lattice_strengths
from fracparticles.special.stable import green, mean_radius
from fracstudy.findings import Finding, measured
from fracstudy.inputs import NUMERALS, Inputs, Result
from fracstudy.orders import orders_of

# The print does not say which of the three levels its h is, nor over which particles (49) sums.
_READINGS = {"middle": 1, "coarse": 0, "fine": 2}

Levels = dict[float, tuple[np.ndarray, np.ndarray]]  # x and u by spacing


def study(inputs: Inputs, *, judged_remeshing: str, printed_spacing: dict[float, float]) -> Result:
    """Table 2: the printed orders, ours in the reading that comes nearest, and the other readings.

    What the print leaves open is read alike for all: `printed_spacing`, the printed h by beta, is the middle level,
    (49) compares strengths, over |x| <= 5 R_alpha. DVM has strengths on common points after one last remeshing; its
    printed orders are held against those with `judged_remeshing`.
    """
    runs = inputs.scalars.assign(remeshing=inputs.scalars.get("remeshing"))  # of DVM only
    # DVM comes last, and of its rows the judged ones first.
    runs = runs.assign(moving=runs["scheme"] == "DVM", other=runs["remeshing"] != judged_remeshing)
    runs["claim"] = [
        f"L-T2.{run.scheme}.{NUMERALS[run.order]}.beta{run.beta:g}" for run in runs.itertuples()
    ]
    key = ["moving", "beta", "scheme", "order", "other", "remeshing", "claim"]
    rows: list[dict[str, Any]] = []
    rates: dict[tuple[str, str], dict[float, float]] = defaultdict(dict)
    readings: dict[str, dict[str, float]] = defaultdict(dict)
    for (moving, beta, scheme, order, _, remeshing, claim), part in runs.groupby(key, dropna=False):
        levels = _strengths(part, remeshed=moving)
        target, half = printed_spacing.get(beta, np.nan), 5.0 * mean_radius(1.0 + beta)
        ours = _readings(levels, target, half)
        printed = float(inputs.printed.get(claim, np.nan))
        row = {
            "beta": beta,
            "h": _nearest(levels, target),
            "scheme": f"DVM, {remeshing}" if moving else scheme,
            "order": NUMERALS[order],
            "printed": printed,
            "ours": ours["middle"],
            "deviation": ours["middle"] - printed,
            "h as coarse level": ours["coarse"],
            "h as fine level": ours["fine"],
            "all particles": _readings(levels, target, np.inf)["middle"],
        }
        if moving:
            field = _strengths(part)
            row["field (7)"] = _readings(field, target, half)["middle"]
            for kind, of_kind in (("field (7)", field), ("strengths", levels)):
                time = float(part["t_final"].iloc[0])
                rates[remeshing, kind][beta] = _rate(of_kind, beta, time)
        rows.append(row | {"claim": claim})
        level = f"level and {remeshing}" if moving else "level"
        readings[claim] |= {f"{name} {level}": p for name, p in ours.items()}
    table = pd.DataFrame(rows)
    judged = table.drop_duplicates("claim").set_index("claim")
    table = table.drop(columns="claim")
    if not inputs.items:
        return Result(table)
    files = {claim: part["run"] for claim, part in runs.groupby("claim", sort=False)}
    findings = [_finding(c, row, readings[c], files[c]) for c, row in judged.iterrows()]
    findings.append(_expected(judged, runs["run"]))
    if rates:
        findings.append(_dvm_rate(rates, runs.loc[runs["moving"], "run"]))
    return Result(table, findings)


def _finding(claim: str, row: pd.Series, readings: dict[str, float], files: pd.Series) -> Finding:
    """Our order for a printed one, and which reading comes nearest."""
    known = {name: p for name, p in readings.items() if not np.isnan(p)}
    away, nearest = min((abs(p - row["printed"]), name) for name, p in known.items())
    return measured(claim, runs=files, ours=row["ours"], nearest=nearest, away=away)


def _expected(judged: pd.DataFrame, files: pd.Series) -> Finding:
    """How far our orders are from those of the kernels, and the printed ones."""
    orders = judged.assign(scheme=judged["scheme"].str.partition(",")[0])
    orders = orders.set_index(["scheme", "order", "beta"])

    def away(column: str) -> dict[str, pd.Series]:
        return {"away": (orders[column] - orders_of(orders.index)).abs().dropna()}

    others = {"the printed orders": away("printed")}
    others["sums over all particles"] = away("all particles")
    return measured("L-T2.expected", runs=files, others=others, **away("ours"))


def _dvm_rate(rates: dict[tuple[str, str], dict[float, float]], files: pd.Series) -> Finding:
    """The order of DVM's error against the exact solution, in space, less that of its kernel, II.

    It is that of the strengths, as in the table, by remeshing and beta; in another reading, of the field (7).
    """

    def away(kind: str) -> pd.Series:
        order = {
            (name, b): p for (name, k), of in rates.items() if k == kind for b, p in of.items()
        }
        return (pd.Series(order).rename_axis(["remeshing", "beta"]).dropna() - 2.0).abs()

    others = {"the field (7) for the strengths": {"away": away("field (7)")}}
    return measured("L-T2.DVM.rate", runs=files, others=others, away=away("strengths"))


def _rate(levels: Levels, beta: float, time: float) -> float:
    """The order of the sum of |u - exact| over |x| <= 5 R_alpha, times h, between the two finest levels."""
    half = 5.0 * mean_radius(1.0 + beta) * (1.0 + 1e-12)
    h = sorted(levels, reverse=True)[-2:]
    error = []
    for x, u in (levels[spacing] for spacing in h):
        off = np.abs(u - green(x, time, 1.0 + beta))
        error.append((x[1] - x[0]) * off[np.abs(x) <= half].sum())
    return float(observed_order(h, error)[0]) if len(h) > 1 else np.nan


def _nearest(levels: Levels, target: float) -> float:
    """The spacing nearest to the printed one; without a print the middle one."""
    if np.isnan(target):
        return sorted(levels)[len(levels) // 2]
    return min(levels, key=lambda h: abs(np.log(h / target)))


def _readings(levels: Levels, target: float, half_width: float) -> dict[str, float]:
    """The order (49) with the printed h as each of the three levels, nan where there are not three nested ones.

    It sums over the points of the coarsest lattice with |x| <= half_width: every other point from level to level.
    """
    h = sorted(levels, reverse=True)
    place = h.index(_nearest(levels, target))
    readings = {}
    for reading, shift in _READINGS.items():
        three = [levels[spacing] for spacing in h[max(place - shift, 0) : place - shift + 3]]
        x = three[0][0]
        inside = np.abs(x) <= half_width
        common = [u[:: 2**level] for level, (_, u) in enumerate(three)]
        nested = len(common) == 3 and {len(u) for u in common} == {len(x)}
        order = self_convergence_order([u[inside] for u in common]) if nested else np.nan
        readings[reading] = order
    return readings


def _strengths(runs: pd.DataFrame, remeshed: bool = False) -> Levels:
    """x and u of each run by its realised spacing; for DVM u is the field (7), or U_p / h after a last remeshing."""
    found = {}
    for path in runs["run"]:
        run: Any = read_run(path)
        u = lattice_strengths(run) if remeshed else run["u"].values
        found[float(run["particle_spacing"])] = (run["x"].values, u)
    return found
