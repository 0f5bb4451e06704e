"""Total strength over time, Eq. (18): which schemes keep it, and what the others lose."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.claims import Finding
from fracparticles.schemes import dd, dpse, fd, fpse, gpse, kpse
from fracparticles.special.stable import central_mass
from fracparticles.studies.common import ORDERS, Inputs, Result, statement
from fracparticles.sums import BandedConvolution

__all__ = ["conservation", "weight_sum"]

_EPS = float(np.finfo(float).eps)
_TABLE_TIME = 1.5  # the papers' final time


def conservation(inputs: Inputs) -> Result:
    """The change M(t_f) / M(t_0) - 1 of the total strength, beside round-off and the exact outflow.

    A rate du_i/dt is a sum whose terms add up to S |u|, S the sum of the absolute weights. By transforms of length L
    it carries a round-off of about eps log2(L) S |u|, which adds up over the time T: the strength is called invariant
    if |M / M0 - 1| < 4 eps log2(L) S T in every run of the scheme, and DD's is said to change if it exceeds a thousand
    times that bound in every run. What leaves [-D, D] in the exact solution is m(D, t_0) - m(D, t_f), in closed form.
    """
    runs = inputs.scalars.copy()
    runs["change"] = runs["mass_final"] / runs["mass_initial"] - 1.0
    runs["bound"] = [_round_off(run) for run in runs.itertuples()]
    runs["outflow"] = [
        central_mass(run.half_width, run.t_initial, 1.0 + run.beta)
        - central_mass(run.half_width, run.t_final, 1.0 + run.beta)
        for run in runs.itertuples()
    ] / runs["mass_initial"]
    shown = runs[np.isclose(runs["t_final"], _TABLE_TIME)]
    table = pd.DataFrame(
        {
            "scheme": shown["scheme"],
            "order": shown["order"].map(ORDERS).where(~shown["scheme"].isin(["GPSE", "FD"]), "-"),
            "beta": shown["beta"],
            "exterior": shown["exterior"],
            "M(t_f) / M(t_0) - 1": shown["change"],
            "in ulp": (shown["change"] / _EPS).round(),
            "round-off, bound": shown["bound"],
            "exact outflow / M(t_0)": shown["outflow"],
            "change + exact outflow": shown["change"] + shown["outflow"],
        }
    ).sort_values(["exterior", "scheme", "beta", "order"], ascending=[False, True, True, True])
    series = runs[np.isclose(runs["beta"], inputs.parameters["beta"]) & (runs["order"] == 2)]
    series = series.assign(x=series["t_final"] - series["t_initial"], y=series["change"].abs())
    return Result(
        table, _findings(runs), series[["scheme", "exterior", "x", "y", "outflow", "bound"]]
    )


def weight_sum(
    scheme: str, n: int, spacing: float, alpha: float, order: int, overlap: float
) -> float:
    """Return S, a bound of sum_j |a_ij| over the lattice for D = 1, the diagonal of an exchange included.

    For two passes the product of their sums: the terms of the first do cancel, but not those of its round-off.
    """
    m = np.arange(2.0 * n + 1.0)
    near = m[: BandedConvolution.reach(overlap, order) + 1]
    rate = spacing**-alpha
    if scheme == "FD":
        return rate * _both_sides(fd.weights(m, alpha))
    if scheme == "GPSE":
        return 2.0 * rate * _both_sides(gpse.weights(m, alpha, overlap))
    if scheme in ("DD", "KPSE"):
        weights, passes = {"DD": (dd.weights, 1.0), "KPSE": (kpse.weights, 2.0)}[scheme]
        return passes * rate * _both_sides(weights(m, alpha, order, overlap))
    first, second = {
        "DPSE": (dpse.potential_weights, dpse.laplacian_weights),
        "FPSE": (fpse.flux_weights, fpse.divergence_weights),
    }[scheme]
    return (
        2.0
        * rate
        * _both_sides(first(m, alpha, order, overlap))
        * _both_sides(second(near, alpha, order, overlap))
    )


def _both_sides(weights: np.ndarray) -> float:
    return float(abs(weights[0]) + 2.0 * np.abs(weights[1:]).sum())


def _round_off(run: Any) -> float:
    n = round(run.half_width / run.particle_spacing)
    total = weight_sum(
        run.scheme, n, run.particle_spacing, 1.0 + run.beta, int(run.order), run.overlap
    )
    time = run.diffusivity * (run.t_final - run.t_initial)
    return 4.0 * _EPS * np.log2(4.0 * n) * total * time


def _findings(runs: pd.DataFrame) -> list[Finding]:
    findings = []
    truncated = runs[runs["exterior"] == "truncated"]
    for scheme in ("DPSE", "FPSE", "KPSE", "GPSE"):
        here = truncated[truncated["scheme"] == scheme]
        part = here["change"].abs() / here["bound"]
        worst = here.loc[here["change"].abs().idxmax()]
        findings.append(
            statement(
                f"L-C18.{scheme}",
                bool((part < 1.0).all()),
                f"Largest |M / M0 - 1| of {len(here)} runs: {abs(worst['change']):.2g} (beta = {worst['beta']:g}), "
                f"at most {part.max():.2g} of the bound of round-off; the exact solution carries up to "
                f"{here['outflow'].max():.2g} out of [-D, D] meanwhile.",
                "The change exceeds round-off.",
                here["run"],
            )
        )
    leak = truncated[truncated["scheme"] == "DD"]
    opened = runs[runs["exterior"] == "open"]
    surplus = -leak["change"] / leak["outflow"] - 1.0
    missed = (opened["change"] + opened["outflow"]).abs().max()
    findings.append(
        statement(
            "L-C18.DD",
            bool((leak["change"].abs() > 1000.0 * leak["bound"]).all()),
            f"M / M0 - 1 of DD: {leak['change'].max():.2e} to {leak['change'].min():.2e}; that is what the exact "
            f"solution carries out of [-D, D] and {100.0 * surplus.min():.1f} to {100.0 * surplus.max():.1f} % more. "
            f"With the open exterior the change of DD, FPSE and KPSE is the exact outflow to {missed:.1g}.",
            "The change does not exceed round-off.",
            leak["run"],
        )
    )
    return findings
