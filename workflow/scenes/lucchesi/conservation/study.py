"""Total strength over time, Eq. (18): which schemes keep it, and what the others lose."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.moving.remeshing import REMESHINGS, remesh
from fracparticles.schemes import SCHEMES, Setting, Sum, dpse, fpse
from fracparticles.schemes.base import OnePass
from fracparticles.special.stable import central_mass
from fracstudy.claims import Finding
from fracstudy.inputs import ORDERS, Inputs, Result, statement

__all__ = ["study", "weight_sum"]

NEEDS: dict[str, list[Any]] = {
    "scheme": ["DD", "DPSE", "FPSE", "KPSE", "GPSE", "DVM"],
    "exterior": ["truncated", "open"],
    "remeshing": ["none", "M4'"],
}

_EPS = float(np.finfo(float).eps)
_NOT_ROUND_OFF = 1000.0  # times the bound of round-off
_CHANGED = "The change exceeds round-off."
_TWO_PASSES = {
    "DPSE": (dpse.potential_weights, dpse.laplacian_weights),
    "FPSE": (fpse.flux_weights, fpse.divergence_weights),
}


def study(inputs: Inputs, *, shown_beta: float) -> Result:
    """The change M(t_f) / M(t_0) - 1 of the total strength, beside round-off and the exact outflow.

    A rate du_i/dt is a sum whose terms add up to S |u|, S the sum of the absolute weights. By transforms of length L
    it carries a round-off of about eps log2(L) S |u|, which adds up over the time T: the strength is called invariant
    if |M / M0 - 1| < 4 eps log2(L) S T in every run of the scheme, and DD's is said to change if it exceeds a thousand
    times that bound in every run. What leaves [-D, D] in the exact solution is m(D, t_0) - m(D, t_f), in closed form.

    The strengths of DVM are constant, their sum is one of N terms; every remeshing sums anew what it splits.

    The table has the final time that most of the runs have; the figure, the runs of `shown_beta`.
    """
    runs = inputs.scalars.copy()
    moving = runs["scheme"] == "DVM"
    weak = moving & (runs["threshold"] > 0.0)
    runs.loc[moving, "exterior"] = "remeshing " + runs.loc[moving, "remeshing"]
    runs.loc[weak, "exterior"] += ", threshold"
    runs["change"] = runs["mass_final"] / runs["mass_initial"] - 1.0
    runs["bound"] = [_round_off(run) for run in runs.itertuples()]
    runs["outflow"] = [_outflow(run) for run in runs.itertuples()]
    runs["lost"] = runs["lost_strength"] / runs["mass_initial"]
    runs["left out"] = runs["eliminated_strength"] / runs["mass_initial"]
    runs["usual"] = np.isclose(runs["t_final"], runs["t_final"].mode()[0])
    shown = runs[runs["usual"]]
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
            "put beyond ±D by remeshing / M(t_0)": shown["lost"],
            "left out as too weak / M(t_0)": shown["left out"],
        }
    ).sort_values(["exterior", "scheme", "beta", "order"], ascending=[False, True, True, True])
    series = runs[np.isclose(runs["beta"], shown_beta) & (runs["order"] == 2) & ~weak]
    series = series.assign(x=series["t_final"] - series["t_initial"], y=series["change"].abs())
    findings = [*_lattice(runs), *_moving(runs[moving]), _moments()]
    columns = ["scheme", "exterior", "x", "y", "outflow", "bound"]
    return Result(table, inputs.judged(findings), series[columns])


def _outflow(run: Any) -> float:
    """What the exact solution carries out of [-D, D], over M(t_0)."""
    times = (run.t_initial, run.t_final)
    before, after = (central_mass(run.half_width, t, 1.0 + run.beta) for t in times)
    return float((before - after) / run.mass_initial)


def weight_sum(
    scheme: str, n: int, spacing: float, alpha: float, order: int, overlap: float
) -> float:
    """Return S, a bound of sum_j |a_ij| over the lattice for D = 1, the diagonal of an exchange included.

    For two passes the product of their sums: the terms of the first do cancel, but not those of its round-off.
    """
    m = np.arange(2.0 * n + 1.0)
    kind, setting = SCHEMES[scheme], Setting(alpha=alpha, order=order, overlap=overlap)
    if isinstance(kind, OnePass):
        passes = 1.0 if isinstance(kind, Sum) else 2.0
        return passes * spacing**-alpha * _both_sides(kind.weights(m, setting))
    first, second = _TWO_PASSES[scheme]
    near = m[: BandedConvolution.reach(overlap, order) + 1]
    rate = 2.0 * spacing**-alpha
    return rate * _both_sides(first(m, setting)) * _both_sides(second(near, setting))


def _both_sides(weights: np.ndarray) -> float:
    return float(abs(weights[0]) + 2.0 * np.abs(weights[1:]).sum())


def _round_off(run: Any) -> float:
    n = round(run.half_width / run.particle_spacing)
    if run.scheme == "DVM":
        return 4.0 * _EPS * np.log2(2.0 * n) * (1.0 + run.remeshings)
    lattice = (n, run.particle_spacing, 1.0 + run.beta, int(run.order), run.overlap)
    time = run.diffusivity * (run.t_final - run.t_initial)
    return 4.0 * _EPS * np.log2(4.0 * n) * weight_sum(run.scheme, *lattice) * time


def _lattice(runs: pd.DataFrame) -> list[Finding]:
    """The exchange schemes, truncated, must keep the strength; DD must not."""
    findings = []
    truncated = dict(iter(runs[runs["exterior"] == "truncated"].groupby("scheme")))
    for scheme in ("DPSE", "FPSE", "KPSE", "GPSE"):
        here = truncated[scheme]
        part = here["change"].abs() / here["bound"]
        worst = here.loc[here["change"].abs().idxmax()]
        findings.append(
            statement(
                f"L-C18.{scheme}",
                (part < 1.0).all(),
                f"Largest |M / M0 - 1| of {len(here)} runs: {abs(worst['change']):.2g} (beta = {worst['beta']:g}), "
                f"at most {part.max():.2g} of the bound of round-off; the exact solution carries up to "
                f"{here['outflow'].max():.2g} out of [-D, D] meanwhile.",
                _CHANGED,
                here["run"],
            )
        )
    leak, opened = truncated["DD"], runs[runs["exterior"] == "open"]
    surplus = 100.0 * (-leak["change"] / leak["outflow"] - 1.0)
    missed = (opened["change"] + opened["outflow"]).abs().max()
    findings.append(
        statement(
            "L-C18.DD",
            (leak["change"].abs() > _NOT_ROUND_OFF * leak["bound"]).all(),
            f"M / M0 - 1 of DD: {leak['change'].max():.2e} to {leak['change'].min():.2e}; that is what the exact "
            f"solution carries out of [-D, D] and {surplus.min():.1f} to {surplus.max():.1f} % more. "
            f"With the open exterior the change of DD, FPSE and KPSE is the exact outflow to {missed:.1g}.",
            "The change does not exceed round-off.",
            leak["run"],
        )
    )
    return findings


def _moving(runs: pd.DataFrame) -> list[Finding]:
    """DVM without remeshing, and with it: what is missing must be what remeshing put beyond the ends, or left out."""
    free, remeshed = runs[runs["remeshing"] == "none"], runs[runs["remeshing"] != "none"]
    part = free["change"].abs() / free["bound"]
    gone = remeshed["lost"] + remeshed["left out"]
    rest = ((remeshed["change"] + gone).abs() / remeshed["bound"]).max()
    full = remeshed[remeshed["usual"] & (remeshed["threshold"] == 0.0)]
    lost, outflow, time = -full["change"], full["outflow"], full["t_final"].max()
    weak = remeshed[remeshed["left out"] != 0.0]
    threshold = (
        f" A threshold of {weak['threshold'].max():g} leaves out particles of a total of "
        f"{weak['left out'].abs().max():.1e}."
        if len(weak)
        else ""
    )
    return [
        statement(
            "L-C18.DVM",
            (part < 1.0).all(),
            f"Largest |M / M0 - 1| of {len(free)} runs without remeshing: {free['change'].abs().max():.2g}, at most "
            f"{part.max():.2g} of the bound of round-off.",
            _CHANGED,
            free["run"],
        ),
        statement(
            "L-C18.DVM_remeshed",
            (remeshed["change"].abs() > _NOT_ROUND_OFF * remeshed["bound"]).all() and rest < 1.0,
            f"Remeshed onto the initial lattice, DVM loses {lost.min():.2e} to {lost.max():.2e} of its strength until "
            f"t = {time:g}; the exact solution carries {outflow.min():.2e} to {outflow.max():.2e} out of "
            f"[-D, D]. All of it is what remeshing put beyond +-D, to {rest:.2g} of the bound of round-off: the "
            f"interpolation itself conserves.{threshold}",
            "Remeshing keeps the strength, or loses it elsewhere.",
            remeshed["run"],
        ),
    ]


def _moments() -> Finding:
    """The sums of U x^m before and after remeshing particles anywhere onto the lattice."""
    random = np.random.default_rng(1)
    x, strength = random.uniform(-1.0, 1.0, 200), random.uniform(0.5, 1.5, 200)
    kept = {}
    for name in REMESHINGS:
        z, moved = remesh(x, strength, 0.1, name)
        scale = [(strength * np.abs(x) ** m).sum() for m in range(6)]
        off = [(moved * z**m).sum() - (strength * x**m).sum() for m in range(6)]
        # Sums of some hundred terms of modulus one.
        kept[name] = int(np.argmax(np.abs(off) > 1e-12 * np.array(scale)))
    found = ", ".join(f"{name}: {count}" for name, count in kept.items())
    return statement(
        "L-C18.DVM_moments",
        max(kept.values()) >= 4,
        f"First moments (from the total strength on) that remeshing keeps, 200 random particles: {found}. The usual "
        "M4' keeps three; the four-moment function has a kink at every lattice point.",
        "None keeps four.",
    )
