"""Order of self-convergence in space, Eq. (49), Table 2."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.run.dataset import read_run
from fracparticles.special.stable import green, mean_radius
from fracstudy.claims import Finding
from fracstudy.inputs import ORDERS, Inputs, Result, observed_order, statement, value
from scenes.beyond.dvm_particles.study import lattice_strengths

__all__ = ["self_convergence_order", "study"]

# The print does not say which of the three levels its h is, nor over which particles (49) sums.
_READINGS = {"middle": 1, "coarse": 0, "fine": 2}
_NEAR = 0.3  # of the expected order

Levels = dict[float, tuple[np.ndarray, np.ndarray]]  # x and u by spacing


def self_convergence_order(levels: list[np.ndarray]) -> float:
    """Return p of Eq. (49) from the strengths of three nested lattices on their common points.

    p = log2( sum_i |u_i^l - u_i^{l+1}| / sum_i |u_i^{l+1} - u_i^{l+2}| ), i over the coarsest lattice.
    """
    coarse, middle, fine = levels
    return float(np.log2(np.abs(coarse - middle).sum() / np.abs(middle - fine).sum()))


def study(inputs: Inputs) -> Result:
    """Table 2: the printed orders, ours in the reading that comes nearest, and the other readings.

    Parameters: `schemes` on the lattice, `remeshings` of DVM, `spacing`, the printed h by beta. What the print
    leaves open is read alike for all: h is the middle level, (49) compares strengths, over |x| <= 5 R_alpha. DVM has
    strengths on common points after one last remeshing; its claims are judged by the first of `remeshings`.
    """
    target = {float(beta): h for beta, h in inputs.parameters["spacing"].items()}
    rows, findings = [], []
    for beta, scheme, order in product(target, inputs.parameters["schemes"], (2, 4)):
        runs = inputs.select(beta=beta, scheme=scheme, order=order)
        row, readings = _row(inputs, beta, _strengths(runs), scheme, order)
        rows.append(row)
        findings.append(_finding(row, readings, runs))
    names = list(inputs.parameters["remeshings"])
    for beta in target:
        dvm_rows: list[dict[str, Any]] = []
        every: dict[str, float] = {}
        for name in names:
            runs = inputs.select(beta=beta, scheme="DVM", order=2, remeshing=name)
            row, readings = _row(inputs, beta, _remeshed_strengths(runs), "DVM", 2)
            half = 5.0 * mean_radius(1.0 + beta)
            row["field (7)"] = _readings(_strengths(runs), target[beta], half)["middle"]
            dvm_rows.append(row)
            every |= {f"{reading} level and {name}": p for reading, p in readings.items()}
        runs = inputs.select(beta=beta, scheme="DVM", order=2)
        findings.append(
            _finding(dvm_rows[0], every, runs, " after a last remeshing by " + names[0])
        )
        rows += [
            {**row, "scheme": f"DVM, {name}"} for row, name in zip(dvm_rows, names, strict=True)
        ]
    table = pd.DataFrame(rows)
    judged = table[~table["scheme"].isin([f"DVM, {name}" for name in names[1:]])]
    deviation = judged.groupby("order")["ours"].agg(["min", "max"])
    expected = {"II": 2.0, "IV": 4.0}
    off = (judged["ours"] - judged["order"].map(expected)).abs()
    findings.append(
        statement(
            "L-T2.expected",
            bool((off < _NEAR).all()),
            "Ours: "
            + "; ".join(
                f"order {order}: {row['min']:.2f} to {row['max']:.2f}"
                for order, row in deviation.iterrows()
            )
            + ", |x| <= 5 R.",
            "At the printed h some fourth-order results are not yet, or no longer, in the asymptotic range.",
        )
    )
    return Result(table, [*findings, _dvm_rate(inputs, names)])


def _row(
    inputs: Inputs, beta: float, strengths: Levels, scheme: str, order: int
) -> tuple[dict[str, Any], dict[str, float]]:
    """One row of the table, and the order in each reading."""
    claim = f"L-T2.{scheme}.{ORDERS[order]}.beta{beta:g}"
    printed = float(inputs.printed[claim])
    target = float(inputs.parameters["spacing"][f"{beta:g}"])
    readings = _readings(strengths, target, 5.0 * mean_radius(1.0 + beta))
    row = {
        "beta": beta,
        "h": _nearest(strengths, target),
        "scheme": scheme,
        "order": ORDERS[order],
        "printed": printed,
        "ours": readings["middle"],
        "deviation": readings["middle"] - printed,
        "h as coarse level": readings["coarse"],
        "h as fine level": readings["fine"],
        "all particles": _readings(strengths, target, np.inf)["middle"],
    }
    return row, readings


def _finding(
    row: dict[str, Any], readings: dict[str, float], runs: pd.DataFrame, how: str = ""
) -> Finding:
    """Our order for a printed one, and which reading comes nearest."""
    off, nearest = min(
        (abs(number - row["printed"]), name)
        for name, number in readings.items()
        if not np.isnan(number)
    )
    nearest = nearest if "level" in nearest else f"{nearest} level"
    return value(
        f"L-T2.{row['scheme']}.{row['order']}.beta{row['beta']:g}",
        row["ours"],
        "The print names neither the level of its h nor the particles of (49); ours: h as middle level, raw "
        f"strengths{how}, |x| <= 5 R. The nearest reading, h as {nearest}, is {off:.3f} off.",
        list(runs["run"]),
    )


def _nearest(strengths: Levels, target: float) -> float:
    return min(strengths, key=lambda h: abs(np.log(h / target)))


def _readings(strengths: Levels, target: float, half_width: float) -> dict[str, float]:
    """The order with the printed h as each of the three levels, nan where there are not three."""
    h = sorted(strengths, reverse=True)
    place = h.index(_nearest(strengths, target))
    readings = {}
    for reading, shift in _READINGS.items():
        levels = [strengths[spacing] for spacing in h[max(place - shift, 0) : place - shift + 3]]
        readings[reading] = _order(levels, half_width) if len(levels) == 3 else np.nan
    return readings


def _dvm_rate(inputs: Inputs, names: list[str]) -> Finding:
    """Does the error of DVM fall with the order of its kernel, II? Between the two finest levels of each beta."""
    found: dict[tuple[str, str], list[float]] = {}
    for beta, name in product(map(float, inputs.parameters["spacing"]), names):
        runs = inputs.select(beta=beta, scheme="DVM", order=2, remeshing=name)
        for kind, levels in (
            ("field (7)", _strengths(runs)),
            ("strengths", _remeshed_strengths(runs)),
        ):
            h = np.array(sorted(levels, reverse=True)[-2:])
            error = [_exact_error(*levels[spacing], beta, inputs) for spacing in h]
            found.setdefault((name, kind), []).append(float(observed_order(h, np.array(error))[0]))
    spelled = "; ".join(
        f"{name}, {kind}: {min(orders):.2f} to {max(orders):.2f}"
        for (name, kind), orders in found.items()
    )
    first = [order for (name, _), orders in found.items() if name == names[0] for order in orders]
    return statement(
        "L-T2.DVM.rate",
        bool((np.abs(np.array(first) - 2.0) < _NEAR).all()),
        f"Order of the error against the exact solution, |x| <= 5 R, between the two finest levels: {spelled}. Lambda3 "
        "leaves a spike at x = 0 in the strengths, whatever their self-convergence says.",
        "The error does not fall like h^2.",
        inputs.select(scheme="DVM")["run"],
    )


def _exact_error(x: np.ndarray, u: np.ndarray, beta: float, inputs: Inputs) -> float:
    """Sum of |u - exact| over |x| <= 5 R_alpha, times h."""
    time = float(inputs.scalars["t_final"].iloc[0])
    inside = np.abs(x) <= 5.0 * mean_radius(1.0 + beta) * (1.0 + 1e-12)
    return float((x[1] - x[0]) * np.abs(u - green(x, time, 1.0 + beta))[inside].sum())


def _remeshed_strengths(runs: pd.DataFrame) -> Levels:
    """x and U_p / h of each run of DVM after a last remeshing, by its realised spacing."""
    found = {}
    for path in runs["run"]:
        run = read_run(path)
        found[float(run["particle_spacing"])] = (run["x"].values, lattice_strengths(run))
    return found


def _strengths(runs: pd.DataFrame) -> Levels:
    """x and u of each run by its realised spacing; u is the field (7) for DVM."""
    import netCDF4

    found = {}
    for path, h in zip(runs["run"], runs["particle_spacing"], strict=True):
        with netCDF4.Dataset(path) as file:
            found[float(h)] = (np.asarray(file["x"][:]), np.asarray(file["u"][:]))
    return found


def _order(levels: list[tuple[np.ndarray, np.ndarray]], half_width: float) -> float:
    """(49) over the points of the coarsest lattice with |x| <= half_width; every other point from level to level."""
    x, _ = levels[0]
    inside = np.abs(x) <= half_width
    return self_convergence_order([u[:: 2**level][inside] for level, (_, u) in enumerate(levels)])
