"""Fig. 1: the kernels of the schemes, and what the paper says of their shape."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.kernels.families import kernel
from fracstudy.claims import Finding
from fracstudy.inputs import ORDERS, Inputs, Result, listed, statement

__all__ = ["study", "tail_exponent"]

_NEAREST, _FARTHEST = 1e-4, 1e6
_TAIL = (1e5, 1e6)  # the exponent is taken between these; what it lacks there is of order 1e-10
_EXPONENT_TOLERANCE = 1e-6
_SMALL = np.array([1e-2, 1e-3])  # where the slope at 0 is taken
_SHOWN = [("kappa", 2), ("kappa", 4), ("E", 2), ("K", 2), ("K", 4)]
_NAMES = {"kappa": "κ", "E": "L", "K": "K"}
# The radii of the panels: evenly spaced in log r, and around the change of sign of K.
_PANELS = {"kernel": np.geomspace(0.03, 100.0, 141), "near": np.linspace(0.0, 6.0, 241)}


def tail_exponent(name: str, alpha: float, order: int) -> float:
    """Return d log|K| / d log r far out, n = 1."""
    near, far = np.abs(kernel(name, np.array(_TAIL), alpha, order=order))
    return float(np.log(far / near) / np.log(_TAIL[1] / _TAIL[0]))


def study(inputs: Inputs, *, beta: list[float], points: int) -> Result:
    """Sample kappa, L_alpha^0 and K, and judge sign, monotonicity and tails.

    `points` is the number of radii from 1e-4 to 1e6, spaced evenly in log r, besides r = 0. Positive and monotone
    mean on all of them.
    """
    r = np.concatenate([[0.0], np.geomspace(_NEAREST, _FARTHEST, points)])
    table = pd.DataFrame(_row(name, order, b, r) for name, order in _SHOWN for b in beta)
    curves = [
        {
            "panel": panel,
            "kernel": name,
            "order": order,
            "beta": b,
            "x": x,
            "y": _values(name, x, b, order),
        }
        for panel, x in _PANELS.items()
        for name, order in _SHOWN
        for b in beta
    ]
    findings = [*_potential(table), *_green(table), *_of_k(table)]
    series = pd.concat(map(pd.DataFrame, curves), ignore_index=True)
    return Result(table, findings, series)


def _values(name: str, r: np.ndarray, beta: float, order: int = 2) -> np.ndarray:
    return np.asarray(kernel(name, r, 1.0 + beta, order=order))


def _row(name: str, order: int, beta: float, r: np.ndarray) -> dict[str, object]:
    values = _values(name, r, beta, order)
    lowest = int(values.argmin())
    negative = r[values < 0.0]
    return {
        "kernel": _NAMES[name],
        "order": ORDERS[order],
        "beta": beta,
        "at r = 0": values[0],
        "least value": values[lowest],
        "at r": r[lowest],
        "negative from r": negative.min() if negative.size else np.nan,
        "to r": negative.max() if negative.size else np.nan,
        "decreasing": "yes" if (np.diff(values) < 0.0).all() else "no",
        "tail exponent": tail_exponent(name, 1.0 + beta, order),
        "expected exponent": -beta if name == "kappa" else -2.0 - beta,
    }


def _of(table: pd.DataFrame, name: str, order: str) -> pd.DataFrame:
    return table[(table["kernel"] == _NAMES[name]) & (table["order"] == order)]


def _potential(table: pd.DataFrame) -> list[Finding]:
    two, four = _of(table, "kappa", "II"), _of(table, "kappa", "IV")
    rising = listed(four.loc[four["decreasing"] == "no", "beta"])
    remark = f" Order IV (15) is not at beta = {rising}." if rising else ""
    slopes = np.max(
        [
            np.abs(_values("kappa", _SMALL, b) - zero) / (zero * _SMALL)
            for b, zero in zip(two["beta"], two["at r = 0"], strict=True)
        ],
        axis=0,
    )
    # kappa is smooth and even: the slope from 0 to r is proportional to r.
    vanishes = abs(slopes[0] / slopes[1] / (_SMALL[0] / _SMALL[1]) - 1.0) < 0.01
    return [
        statement(
            "L-F1.kappa_monotone",
            (two["decreasing"] == "yes").all(),
            f"Order II (14) decreases from r to r over all radii from 0 to {_FARTHEST:g} at beta = "
            f"{listed(two['beta'])}.{remark}",
            "The kernel rises somewhere.",
        ),
        statement(
            "L-F1.kappa_flat",
            vanishes,
            f"The relative slope from 0 to r is {slopes[0]:.2e} at r = {_SMALL[0]:g} and {slopes[1]:.2e} at r = "
            f"{_SMALL[1]:g}: it vanishes like r.",
            "The slope at 0 does not vanish.",
        ),
        _tail("L-F1.kappa_decay", pd.concat([two, four]), "-beta"),
    ]


def _green(table: pd.DataFrame) -> list[Finding]:
    rows = _of(table, "E", "II")
    least, exponents = rows["least value"], listed(rows["tail exponent"], ".4f")
    return [
        statement(
            "L-F1.green_positive",
            (least > 0.0).all(),
            f"The least value for r up to {_FARTHEST:g} is {least.min():.2e}, at the last r.",
            "The function is negative somewhere.",
        ),
        statement(
            "L-F1.green_monotone",
            (rows["decreasing"] == "yes").all() and _exponents_hold(rows),
            f"It decreases over all radii from 0 to {_FARTHEST:g}, with the exponents {exponents} at beta = "
            f"{listed(rows['beta'])}.",
            "The function rises somewhere, or does not fall to 0.",
        ),
    ]


def _of_k(table: pd.DataFrame) -> list[Finding]:
    both = [_of(table, "K", order) for order in ("II", "IV")]
    return [*map(_positive, both), _tail("L-F1.K_decay", pd.concat(both), "-1-alpha")]


def _positive(rows: pd.DataFrame) -> Finding:
    lowest = rows.loc[rows["least value"].idxmin()]
    negative = rows[rows["least value"] < 0.0]
    where = "; ".join(
        f"for {row['negative from r']:.2f} < r < {row['to r']:.2f} at beta = {row['beta']:g}"
        for _, row in negative.iterrows()
    )
    return statement(
        f"L-F1.K_positive.{lowest['order']}",
        negative.empty,
        f"The least value over r up to {_FARTHEST:g} is {lowest['least value']:.2e}, at beta = "
        f"{lowest['beta']:g} and r = {lowest['at r']:.3g}.",
        f"The order-IV kernel is 2 M(r^2) - 2^-a M(r^2/2), a difference: it is negative {where}.",
    )


def _exponents_hold(rows: pd.DataFrame) -> bool:
    off = (rows["tail exponent"] - rows["expected exponent"]).abs()
    return bool((off <= _EXPONENT_TOLERANCE).all())


def _tail(claim: str, rows: pd.DataFrame, words: str) -> Finding:
    return statement(
        claim,
        _exponents_hold(rows),
        f"Between r = {_TAIL[0]:g} and {_TAIL[1]:g} the exponents of orders II and IV are {words} within "
        f"{_EXPONENT_TOLERANCE:g} at beta = {listed(sorted(set(rows['beta'])))}.",
        "The tail falls with another exponent.",
    )
