"""Effect of the domain truncation: error (48) against C, Figs. 3a, 4a, 5a and Sec. 4.2."""

from __future__ import annotations

from math import gamma, pi, sin

import numpy as np
import pandas as pd

from fracstudy.inputs import ORDERS, Inputs, Result, statement, value

__all__ = ["exchange_truncation_error", "truncation", "truncation_claims"]

_NEGLIGIBLE = 0.1  # of the error: what the truncation may add and still be called negligible


def exchange_truncation_error(half_width: np.ndarray, alpha: float, time: float) -> np.ndarray:
    """Return the relative error that truncation causes in an exchange scheme, time (2 c / alpha) D^(-alpha).

    The sum over |y| > D of (u(y) - u(x)) c |y - x|^(-1-alpha), c = Gamma(1+alpha) sin(pi alpha / 2) / pi, is left
    out. Near the origin what matters of it is the loss - u(x) 2 c D^(-alpha) / alpha.
    """
    c = gamma(1.0 + alpha) * sin(0.5 * pi * alpha) / pi
    return time * 2.0 * c / alpha * np.asarray(half_width) ** -alpha


def truncation(inputs: Inputs) -> Result:
    """One beta: the table of errors, truncated and open, and whether truncation is negligible at the largest C."""
    runs = inputs.scalars
    alpha = 1.0 + runs["beta"].iloc[0]
    runs = runs.assign(C=runs["truncation"].round(6))
    table = runs.pivot_table(
        index=["scheme", "order", "C"], columns="exterior", values="relative_l1_error"
    ).reset_index()
    widths = runs.groupby("C")["half_width"].first()
    time = float((runs["t_final"] - runs["t_initial"]).iloc[0])
    exchange = table["scheme"].isin(["KPSE", "GPSE"])
    predicted = exchange_truncation_error(table["C"].map(widths).to_numpy(), alpha, time)
    table = pd.DataFrame(
        {
            "beta": runs["beta"].iloc[0],
            "scheme": table["scheme"],
            "order": table["order"].map(ORDERS),
            "C": table["C"],
            "h": float(runs.groupby("C")["particle_spacing"].first().iloc[-1]),
            "error, truncated": table["truncated"],
            "truncation error, predicted": np.where(exchange, predicted, np.nan),
            "error, open exterior": table["open"],
        }
    )
    series = runs[["scheme", "order", "exterior", "C", "relative_l1_error"]].rename(
        columns={"C": "x", "relative_l1_error": "y"}
    )
    return Result(table, _findings(inputs, runs, table), series)


def _findings(inputs: Inputs, runs: pd.DataFrame, table: pd.DataFrame) -> list:
    item = inputs.items[0]
    widest = table[table["C"] == table["C"].max()]
    ratio = widest["error, truncated"] / widest["error, open exterior"]
    names = widest["scheme"] + " " + widest["order"]
    worst = ratio.idxmax()
    holds = bool((ratio < 1.0 + _NEGLIGIBLE).all())
    h = float(inputs.select(scheme="GPSE")["spacing"].iloc[0])
    alpha = 1.0 + float(runs["beta"].iloc[0])
    step = (2.0 * h) ** alpha
    overlap = float(inputs.select(scheme="GPSE")["overlap"].iloc[0])
    where = [f"{r:.3g} for {n}" for r, n in zip(ratio, names, strict=True)]
    files = list(runs[runs["C"] == runs["C"].max()]["run"])
    return [
        statement(
            f"{item}.negligible",
            holds,
            f"Truncated over open error at C = {widest['C'].max():g}: {', '.join(where)}.",
            f"The truncation is nearly the whole error of {names[worst]} there: the open exterior, which changes "
            f"nothing else, lowers it {ratio[worst]:.0e} times.",
            files,
        ),
        value(
            f"{item}.gpse_dt",
            step,
            f"(40) with epsilon = 2 h gives {step:.3g}; the printed step, which we use, means epsilon/h = "
            f"{overlap:.3g}.",
            list(inputs.select(scheme="GPSE")["run"])[:1],
        ),
    ]


def truncation_claims(inputs: Inputs) -> Result:
    """All beta together: the statements of Sec. 4.2."""
    errors = pd.concat(inputs.tables.values(), ignore_index=True).rename(
        columns={
            "error, truncated": "truncated",
            "error, open exterior": "open",
            "truncation error, predicted": "predicted",
        }
    )
    summary = pd.DataFrame(
        _summary(part, *key) for key, part in errors.groupby(["scheme", "order", "beta"])
    )
    findings = [*_direct_schemes(errors, summary), *_kpse(errors, summary), *_gpse(errors, summary)]
    series = errors.melt(
        id_vars=["beta", "scheme", "order", "C"], value_vars=["truncated", "open", "predicted"]
    ).dropna()
    return Result(summary, findings, series)


def _summary(part: pd.DataFrame, scheme: str, order: str, beta: float) -> dict[str, object]:
    part = part.sort_values("C")
    c, e = part["C"].to_numpy(), part["truncated"].to_numpy()
    slopes = np.log(e[1:] / e[:-1]) / np.log(c[1:] / c[:-1])
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
    if not part["predicted"].isna().all():
        # C at which the predicted truncation error has fallen to the discretisation error.
        row["C of the plateau"] = c[-1] * (part["predicted"].iloc[-1] / floor) ** (
            1.0 / (1.0 + beta)
        )
    return row


def _pick(summary: pd.DataFrame, column: str, scheme: str, order: str | None = None) -> pd.Series:
    rows = summary[summary["scheme"] == scheme]
    if order is not None:
        rows = rows[rows["order"] == order]
    return rows.set_index("beta")[column] if order else rows.set_index(["order", "beta"])[column]


def _spell(values: pd.Series, form: str = "{:.3g}") -> str:
    """The values with their keys: 'II, beta 0.1: 0.02; ...'."""

    def name(key: object) -> str:
        return f"{key[0]}, beta {key[1]:g}" if isinstance(key, tuple) else f"beta {key:g}"

    return "; ".join(f"{name(key)}: {form.format(v)}" for key, v in values.items())


def _direct_schemes(errors: pd.DataFrame, summary: pd.DataFrame) -> list:
    findings = []
    for scheme in ("DD", "FPSE"):
        variation = _pick(summary, "variation for C > 20", scheme)
        findings.append(
            statement(
                f"L-C4.independent.{scheme}",
                bool((variation < _NEGLIGIBLE).all()),
                f"Variation of the error of {scheme} for C > 20: {_spell(variation, '{:.1%}')}.",
                "True of order II; the discretisation error of order IV is so small that the truncation shows.",
            )
        )
    excess = summary[summary["scheme"].isin(["DD", "FPSE"])].set_index(["order", "beta"])[
        "truncated / open for C > 20"
    ]
    worst = excess.groupby(level=[0, 1]).max()
    findings.append(
        statement(
            "L-C4.dominated",
            bool((worst < 1.0 + _NEGLIGIBLE).all()),
            f"Largest truncated over open error of DD and FPSE for C > 20: {_spell(worst)}.",
            "True of order II; at order IV the discretisation error is smaller than the truncation error until C is "
            "larger.",
        )
    )
    at = {
        scheme: _pick(summary, "error at the greatest C", scheme, "II").sort_index()
        for scheme in ("DD", "FPSE")
    }
    h = errors.groupby("beta")["h"].first().sort_index()
    falls = all(bool((np.diff(values) < 0.0).all()) for values in at.values())
    findings.append(
        statement(
            "L-C4.grows",
            falls,
            "At the printed h, order II: "
            + "; ".join(f"{scheme} {_spell(values)}" for scheme, values in at.items())
            + ". Divided by h^2: "
            + "; ".join(f"{scheme} {_spell(values / h**2)}" for scheme, values in at.items())
            + ".",
            "The printed h differ between the beta and hide the trend: it is there at equal h, in the error over h^2.",
        )
    )
    wide = errors[errors["C"] > 20.0].pivot_table(
        index=["beta", "order", "C"], columns="scheme", values=["truncated", "open"]
    )
    ratio = wide["truncated"]["FPSE"] / wide["truncated"]["DD"]
    spatial = wide["open"]["FPSE"] / wide["open"]["DD"]
    findings.append(
        statement(
            "L-C4.dd_better",
            bool((ratio > 1.0).all()),
            f"Error of FPSE over that of DD for C > 20: {ratio.min():.3g} to {ratio.max():.3g}; with the open exterior "
            f"{spatial.min():.3g} to {spatial.max():.3g}.",
            "True of the discretisation error; at order IV and small C truncation is most of the error, and that of DD "
            "is the larger one.",
        )
    )
    return findings


def _kpse(errors: pd.DataFrame, summary: pd.DataFrame) -> list:
    first = _pick(summary, "first slope in C", "KPSE")
    last = _pick(summary, "last slope in C", "KPSE")
    alpha = -_pick(summary, "- alpha", "KPSE")
    plateau = _pick(summary, "C of the plateau", "KPSE", "II").sort_index()
    widest = float(errors["C"].max())
    findings = [
        statement(
            "L-C5.falls",
            bool((first < -0.5).all()),
            f"Slope of log error in log C at the least C: {_spell(first)}.",
            "Not at the least C of these grids.",
        ),
        statement(
            "L-C5.levels_off",
            bool((last > -0.5 * alpha).all()),
            f"Slope at C = {widest:g}: {_spell(last)}.",
            "Only order II at large beta levels off by C = 160. Elsewhere the error still falls like C^-alpha: "
            "truncation is nearly all of it, as the open exterior shows.",
        ),
        statement(
            "L-C5.later_for_small_beta",
            bool((np.diff(plateau) < 0.0).all()),
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
                bool((abs(slope - 1.0) < 0.15).all()),
                f"First slope over -alpha: {slope.min():.3g} to {slope.max():.3g}; the error is {ratio.min():.3g} to "
                f"{ratio.max():.3g} times T (2/alpha) Gamma(1+alpha) sin(pi alpha/2) / pi D^-alpha.",
                "The discretisation error is not small against the truncation error at the least C.",
            )
        )
    drop = errors[(errors["scheme"] == "KPSE") & (errors["order"] == "IV")]
    ratio = drop["truncated"] / drop["open"]
    findings.append(
        statement(
            "L-C5.origin",
            bool((ratio > 10.0).all()),
            f"At the same h and step the open exterior lowers the error of KPSE IV {ratio.min():.3g} to "
            f"{ratio.max():.3g} times.",
            "The open exterior leaves part of the error.",
        )
    )
    return findings


def _gpse(errors: pd.DataFrame, summary: pd.DataFrame) -> list:
    gpse = errors[errors["scheme"] == "GPSE"]
    short = gpse[gpse["C"] <= 30.0].pivot_table(index="C", columns="beta", values="truncated")
    last = _pick(summary, "last slope in C", "GPSE", "II").sort_index()
    plateau = _pick(summary, "error at the greatest C", "GPSE", "II").sort_index()
    both = errors[errors["order"] != "II"].pivot_table(
        index=["beta", "C"], columns="scheme", values="truncated"
    )
    kpse = both["KPSE"]
    gpse_error = gpse.set_index(["beta", "C"])["truncated"]
    ratio = (gpse_error / kpse).dropna()
    return [
        statement(
            "L-C6.small_domains",
            bool((np.diff(short.to_numpy(), axis=1) < 0.0).all()),
            "Error of GPSE at C <= 30, from the least beta to the greatest: "
            + "; ".join(
                f"C = {c:g}: " + ", ".join(f"{v:.3g}" for v in row)
                for c, row in zip(short.index, short.to_numpy(), strict=True)
            )
            + ".",
            "The error of GPSE at C <= 30 is not ordered like this.",
        ),
        statement(
            "L-C6.levels_off",
            bool((last > 0.5 * _pick(summary, "- alpha", "GPSE", "II").sort_index()).all()),
            f"Slope of log error in log C at the greatest C: {_spell(last)}.",
            "It still falls like C^-alpha at C = 160: a step of GPSE is exact but for the truncation.",
        ),
        statement(
            "L-C6.higher_for_low_beta",
            bool((np.diff(plateau) < 0.0).all()),
            f"Error of GPSE at the greatest C: {_spell(plateau)}.",
            "The errors at the greatest C are not ordered like this.",
        ),
        statement(
            "L-C6.different_mechanism",
            bool((abs(ratio - 1.0) > 0.2).any()),
            f"Error of GPSE over that of KPSE IV, all beta and C: {ratio.min():.4g} to {ratio.max():.4g}.",
            "The two have the same truncation error at every beta and C, that of the closed form: the mechanism is the "
            "same, the exchange with the particles left out.",
        ),
    ]
