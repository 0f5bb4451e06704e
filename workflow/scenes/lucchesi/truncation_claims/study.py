"""What Sec. 4.2 concludes from Figs. 3a, 4a and 5a, all beta together."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd

from fracparticles.run.orders import observed_order
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["study"]

_NEGLIGIBLE = 0.1  # of the error: what the truncation may add and still be called negligible
_NAMES = {
    "error, truncated": "truncated",
    "error, open exterior": "open",
    "truncation error, predicted": "predicted",
}


def study(inputs: Inputs) -> Result:
    """Give slopes in C, plateaus and variations of the tables of the three figures, and judge the statements."""
    errors = pd.concat(inputs.tables.values(), ignore_index=True).rename(columns=_NAMES)
    summary = pd.DataFrame(
        _summary(part.sort_values("C"), *key)
        for key, part in errors.groupby(["scheme", "order", "beta"])
    )
    key = ["beta", "scheme", "order", "C"]
    series = errors.melt(id_vars=key, value_vars=list(_NAMES.values())).dropna()
    findings = [*_direct(errors, summary), *_kpse(errors, summary), *_gpse(errors, summary)]
    return Result(summary, findings, series)


def _summary(part: pd.DataFrame, scheme: str, order: str, beta: float) -> dict[str, object]:
    c, e = part["C"].to_numpy(), part["truncated"].to_numpy()
    slopes = observed_order(c[::-1], e[::-1])[::-1]
    beyond = part[part["C"] > 20.0]
    floor = float(part["open"].iloc[-1])
    row: dict[str, object] = {
        "scheme": scheme,
        "order": order,
        "beta": beta,
        "first slope in C": slopes[0],
        "last slope in C": slopes[-1],
        "- alpha": -(1.0 + beta),
        "error at the least C": e[0],
        "error at the greatest C": e[-1],
        "open error": floor,
        "variation for C > 20": float(beyond["truncated"].max() / beyond["truncated"].min() - 1.0),
        "truncated / open for C > 20": float((beyond["truncated"] / beyond["open"]).max()),
    }
    if part["predicted"].notna().any():
        # C at which the predicted truncation error has fallen to the discretisation error.
        ratio = part["predicted"].iloc[-1] / floor
        row["C of the plateau"] = c[-1] * ratio ** (1.0 / (1.0 + beta))
    return row


def _pick(summary: pd.DataFrame, column: str, scheme: str, order: str | None = None) -> pd.Series:
    """A column of a scheme, by order and beta; by beta, rising, for one order."""
    found = summary[summary["scheme"] == scheme].set_index(["order", "beta"])[column]
    return found if order is None else found[order].sort_index()


def _spell(values: pd.Series, form: str = ".3g") -> str:
    """The values with their keys: 'II, beta 0.1: 0.02; ...'."""

    def name(key: object) -> str:
        return f"{key[0]}, beta {key[1]:g}" if isinstance(key, tuple) else f"beta {key:g}"

    return "; ".join(f"{name(key)}: {v:{form}}" for key, v in values.items())


def _range(values: pd.Series, form: str = ".3g") -> str:
    return f"{values.min():{form}} to {values.max():{form}}"


def _falling(values: Iterable[float]) -> bool:
    """Whether the values fall along the last axis."""
    return bool((np.diff(np.asarray(values), axis=-1) < 0.0).all())


def _direct(errors: pd.DataFrame, summary: pd.DataFrame) -> list[Finding]:
    """DD and FPSE, L-C4."""
    findings = []
    for scheme in ("DD", "FPSE"):
        variation = _pick(summary, "variation for C > 20", scheme)
        findings.append(
            statement(
                f"L-C4.independent.{scheme}",
                (variation < _NEGLIGIBLE).all(),
                f"Variation of the error of {scheme} for C > 20: {_spell(variation, '.1%')}.",
                "True of order II; the discretisation error of order IV is so small that the truncation shows.",
            )
        )
    direct = summary[summary["scheme"].isin(["DD", "FPSE"])]
    worst = direct.groupby(["order", "beta"])["truncated / open for C > 20"].max()
    at = {s: _pick(summary, "error at the greatest C", s, "II") for s in ("DD", "FPSE")}
    h = errors.groupby("beta")["h"].first()
    errors_at = "; ".join(f"{scheme} {_spell(values)}" for scheme, values in at.items())
    over_h2 = "; ".join(f"{scheme} {_spell(values / h**2)}" for scheme, values in at.items())
    wide = errors[errors["C"] > 20.0].pivot(
        index=["beta", "order", "C"], columns="scheme", values=["truncated", "open"]
    )
    ratio, spatial = (wide[kind]["FPSE"] / wide[kind]["DD"] for kind in ("truncated", "open"))
    return [
        *findings,
        statement(
            "L-C4.dominated",
            (worst < 1.0 + _NEGLIGIBLE).all(),
            f"Largest truncated over open error of DD and FPSE for C > 20: {_spell(worst)}.",
            "True of order II; at order IV the discretisation error is smaller than the truncation error until C is "
            "larger.",
        ),
        statement(
            "L-C4.grows",
            all(_falling(values) for values in at.values()),
            f"At the printed h, order II: {errors_at}. Divided by h^2: {over_h2}.",
            "The printed h differ between the beta and hide the trend: it is there at equal h, in the error over h^2.",
        ),
        statement(
            "L-C4.dd_better",
            (ratio.dropna() > 1.0).all(),
            f"Error of FPSE over that of DD for C > 20: {_range(ratio)}; with the open exterior {_range(spatial)}.",
            "True of the discretisation error; at order IV and small C truncation is most of the error, and that of DD "
            "is the larger one.",
        ),
    ]


def _kpse(errors: pd.DataFrame, summary: pd.DataFrame) -> list[Finding]:
    """KPSE, L-C5."""
    first = _pick(summary, "first slope in C", "KPSE")
    last = _pick(summary, "last slope in C", "KPSE")
    alpha = -_pick(summary, "- alpha", "KPSE")
    plateau = _pick(summary, "C of the plateau", "KPSE", "II")
    findings = [
        statement(
            "L-C5.falls",
            (first < -0.5).all(),
            f"Slope of log error in log C at the least C: {_spell(first)}.",
            "Not at the least C of these grids.",
        ),
        statement(
            "L-C5.levels_off",
            (last > -0.5 * alpha).all(),
            f"Slope at C = {errors['C'].max():g}: {_spell(last)}.",
            "Only order II at large beta levels off by C = 160. Elsewhere the error still falls like C^-alpha: "
            "truncation is nearly all of it, as the open exterior shows.",
        ),
        statement(
            "L-C5.later_for_small_beta",
            _falling(plateau),
            f"C at which the truncation error falls to the discretisation error, order II: {_spell(plateau)}.",
            "The discretisation errors at the printed h outweigh the trend.",
        ),
    ]
    for scheme in ("KPSE", "GPSE"):
        rows = errors[(errors["scheme"] == scheme) & (errors["predicted"] > 10.0 * errors["open"])]
        ratio = rows["truncated"] / rows["predicted"]
        slope = _pick(summary, "first slope in C", scheme) / _pick(summary, "- alpha", scheme)
        findings.append(
            statement(
                f"L-C5.power.{scheme}",
                (abs(slope - 1.0) < 0.15).all(),
                f"First slope over -alpha: {_range(slope)}; the error is {_range(ratio)} times "
                "T (2/alpha) Gamma(1+alpha) sin(pi alpha/2) / pi D^-alpha.",
                "The discretisation error is not small against the truncation error at the least C.",
            )
        )
    four = errors[(errors["scheme"] == "KPSE") & (errors["order"] == "IV")]
    gain = four["truncated"] / four["open"]
    evidence = f"At the same h and step the open exterior lowers the error of KPSE IV {_range(gain)} times."
    reason = "The open exterior leaves part of the error."
    return [*findings, statement("L-C5.origin", (gain > 10.0).all(), evidence, reason)]


def _gpse(errors: pd.DataFrame, summary: pd.DataFrame) -> list[Finding]:
    """GPSE, L-C6."""
    gpse = errors[errors["scheme"] == "GPSE"]
    short = gpse[gpse["C"] <= 30.0].pivot(index="C", columns="beta", values="truncated")
    rows = "; ".join(
        f"C = {c:g}: " + ", ".join(f"{v:.3g}" for v in row) for c, *row in short.itertuples()
    )
    last = _pick(summary, "last slope in C", "GPSE", "II")
    plateau = _pick(summary, "error at the greatest C", "GPSE", "II")
    key = ["beta", "C"]
    four = errors[(errors["scheme"] == "KPSE") & (errors["order"] == "IV")].set_index(key)
    ratio = (gpse.set_index(key)["truncated"] / four["truncated"]).dropna()
    return [
        statement(
            "L-C6.small_domains",
            _falling(short),
            f"Error of GPSE at C <= 30, from the least beta to the greatest: {rows}.",
            "The error of GPSE at C <= 30 is not ordered like this.",
        ),
        statement(
            "L-C6.levels_off",
            (last > 0.5 * _pick(summary, "- alpha", "GPSE", "II")).all(),
            f"Slope of log error in log C at the greatest C: {_spell(last)}.",
            "It still falls like C^-alpha at C = 160: a step of GPSE is exact but for the truncation.",
        ),
        statement(
            "L-C6.higher_for_low_beta",
            _falling(plateau),
            f"Error of GPSE at the greatest C: {_spell(plateau)}.",
            "The errors at the greatest C are not ordered like this.",
        ),
        statement(
            "L-C6.different_mechanism",
            (abs(ratio - 1.0) > 0.2).any(),
            f"Error of GPSE over that of KPSE IV, all beta and C: {_range(ratio, '.4g')}.",
            "The two have the same truncation error at every beta and C, that of the closed form: the mechanism is the "
            "same, the exchange with the particles left out.",
        ),
    ]
