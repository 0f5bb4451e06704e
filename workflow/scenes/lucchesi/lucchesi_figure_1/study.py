"""Fig. 1: the kernels of the schemes, and what the paper says of their shape."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import pandas as pd

from fracparticles.kernels.families import kernel
from fracstudy.claims import Finding
from fracstudy.inputs import ORDERS, Inputs, Result, statement

__all__ = ["study", "tail_exponent"]

_NEAREST, _FARTHEST = 1e-4, 1e6
_TAIL = (1e5, 1e6)  # the exponent is taken between these; what it lacks there is of order 1e-10
_EXPONENT_TOLERANCE = 1e-6
_SMALL = np.array([1e-2, 1e-3])  # where the slope at 0 is taken
_SHOWN = [("kappa", 2), ("kappa", 4), ("E", 2), ("K", 2), ("K", 4)]
Exponent = Callable[[pd.Series], pd.Series]
_NAMES = {"kappa": "κ", "E": "L", "K": "K"}


def tail_exponent(name: str, alpha: float, order: int) -> float:
    """Return d log|K| / d log r far out, n = 1."""
    near, far = np.abs(kernel(name, np.array(_TAIL), alpha, order=order))
    return float(np.log(far / near) / np.log(_TAIL[1] / _TAIL[0]))


def study(inputs: Inputs) -> Result:
    """Sample kappa, L_alpha^0 and K, and judge sign, monotonicity and tails.

    Parameters of the scene: `beta` (a list) and `points`, the number of radii from 1e-4 to 1e6, spaced evenly in
    log r, besides r = 0. Positive and monotone mean on all of them.
    """
    betas = [float(beta) for beta in inputs.parameters["beta"]]
    r = np.concatenate([[0.0], np.geomspace(_NEAREST, _FARTHEST, int(inputs.parameters["points"]))])
    sampled = {
        (name, order, beta): np.asarray(kernel(name, r, 1.0 + beta, order=order))
        for name, order in _SHOWN
        for beta in betas
    }
    table = pd.DataFrame(
        _row(name, order, beta, r, values) for (name, order, beta), values in sampled.items()
    )
    findings = [
        *_potential(table, betas),
        *_green(table),
        *(_positive(table, order) for order in (2, 4)),
        _tail("L-F1.K_decay", table, "K", lambda beta: -2.0 - beta, "-1-alpha"),
    ]
    return Result(table, findings, _series(betas))


def _row(
    name: str, order: int, beta: float, r: np.ndarray, values: np.ndarray
) -> dict[str, object]:
    lowest = int(values.argmin())
    negative = r[values < 0.0]
    exponent = tail_exponent(name, 1.0 + beta, order)
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
        "tail exponent": exponent,
        "expected exponent": -beta if name == "kappa" else -2.0 - beta,
    }


def _of(table: pd.DataFrame, name: str, order: int) -> pd.DataFrame:
    return table[(table["kernel"] == _NAMES[name]) & (table["order"] == ORDERS[order])]


def _potential(table: pd.DataFrame, betas: list[float]) -> list[Finding]:
    two, four = _of(table, "kappa", 2), _of(table, "kappa", 4)
    not_four = list(four.loc[four["decreasing"] == "no", "beta"])
    remark = (
        f" Order IV (15) is not at beta = {', '.join(f'{b:g}' for b in not_four)}."
        if not_four
        else ""
    )
    at_zero = [kernel("kappa", 0.0, 1.0 + beta) for beta in betas]
    slopes = np.array(
        [
            np.abs(kernel("kappa", _SMALL, 1.0 + beta) - zero) / (zero * _SMALL)
            for beta, zero in zip(betas, at_zero, strict=True)
        ]
    ).max(axis=0)
    # kappa is smooth and even: the slope from 0 to r is proportional to r.
    vanishes = abs(slopes[0] / slopes[1] / (_SMALL[0] / _SMALL[1]) - 1.0) < 0.01
    return [
        statement(
            "L-F1.kappa_monotone",
            bool((two["decreasing"] == "yes").all()),
            f"Order II (14) decreases from r to r over all radii from 0 to {_FARTHEST:g} at beta = "
            f"{_list(betas)}.{remark}",
            "The kernel rises somewhere.",
        ),
        statement(
            "L-F1.kappa_flat",
            bool(vanishes),
            f"The relative slope from 0 to r is {slopes[0]:.2e} at r = {_SMALL[0]:g} and {slopes[1]:.2e} at r = "
            f"{_SMALL[1]:g}: it vanishes like r.",
            "The slope at 0 does not vanish.",
        ),
        _tail("L-F1.kappa_decay", table, "kappa", lambda beta: -beta, "-beta"),
    ]


def _green(table: pd.DataFrame) -> list[Finding]:
    rows = _of(table, "E", 2)
    return [
        statement(
            "L-F1.green_positive",
            bool((rows["least value"] > 0.0).all()),
            f"The least value for r up to {_FARTHEST:g} is {rows['least value'].min():.2e}, at the last r.",
            "The function is negative somewhere.",
        ),
        statement(
            "L-F1.green_monotone",
            bool((rows["decreasing"] == "yes").all() and _exponents_hold(rows, lambda b: -2.0 - b)),
            f"It decreases over all radii from 0 to {_FARTHEST:g}, with the exponents "
            f"{_list(rows['tail exponent'], '.4f')} "
            f"at beta = {_list(rows['beta'])}.",
            "The function rises somewhere, or does not fall to 0.",
        ),
    ]


def _positive(table: pd.DataFrame, order: int) -> Finding:
    rows = _of(table, "K", order)
    lowest = rows.loc[rows["least value"].idxmin()]
    negative = rows[rows["least value"] < 0.0]
    return statement(
        f"L-F1.K_positive.{ORDERS[order]}",
        negative.empty,
        f"The least value over r up to {_FARTHEST:g} is {lowest['least value']:.2e}, at beta = "
        f"{lowest['beta']:g} and r = "
        f"{lowest['at r']:.3g}.",
        "The order-IV kernel is 2 M(r^2) - 2^-a M(r^2/2), a difference: it is negative "
        + "; ".join(
            f"for {row['negative from r']:.2f} < r < {row['to r']:.2f} at beta = {row['beta']:g}"
            for _, row in negative.iterrows()
        )
        + ".",
    )


def _exponents_hold(rows: pd.DataFrame, expected: Exponent) -> bool:
    return bool(
        np.allclose(
            rows["tail exponent"], expected(rows["beta"]), rtol=0.0, atol=_EXPONENT_TOLERANCE
        )
    )


def _tail(claim: str, table: pd.DataFrame, name: str, expected: Exponent, words: str) -> Finding:
    rows = pd.concat([_of(table, name, 2), _of(table, name, 4)])
    return statement(
        claim,
        _exponents_hold(rows, expected),
        f"Between r = {_TAIL[0]:g} and {_TAIL[1]:g} the exponents of orders II and IV are {words} within "
        f"{_EXPONENT_TOLERANCE:g} at beta = {_list(sorted(set(rows['beta'])))}.",
        "The tail falls with another exponent.",
    )


def _series(betas: list[float]) -> pd.DataFrame:
    """Panel "kernel": log radii; panel "near": K around its change of sign, evenly spaced."""
    rows = []
    far, near = np.geomspace(0.03, 100.0, 141), np.linspace(0.0, 6.0, 241)
    for panel, r in (("kernel", far), ("near", near)):
        for name, order in _SHOWN:
            for beta in betas:
                values = np.asarray(kernel(name, r, 1.0 + beta, order=order))
                rows += [
                    {"panel": panel, "kernel": name, "order": order, "beta": beta, "x": x, "y": y}
                    for x, y in zip(r, values, strict=True)
                ]
    return pd.DataFrame(rows)


def _list(values: Iterable[float], form: str = "g") -> str:
    return ", ".join(f"{v:{form}}" for v in values)
