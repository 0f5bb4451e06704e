"""Total strength over time, Eq. (18): which schemes keep it, and what the others lose."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.moving.remeshing import remesh
from fracparticles.schemes import SCHEMES, Setting, Sum, dpse, fpse
from fracparticles.schemes.base import OnePass
from fracparticles.special.stable import central_mass
from fracstudy.errors import EPS
from fracstudy.findings import Finding, measured
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.panels import pick

_REMESHINGS = "M4'", "Lambda3"  # the interpolation functions of the paper's time

NEEDS: dict[str, list[Any]] = {
    "scheme": ["DD", "DPSE", "FPSE", "KPSE", "GPSE", "DVM"],
    "exterior": ["truncated", "open"],
    "remeshing": ["none", "M4'"],
}

_CLAIMED = ("DD", "DPSE", "FPSE", "GPSE", "KPSE")
_TWO_PASSES = {
    "DPSE": (dpse.potential_weights, dpse.laplacian_weights),
    "FPSE": (fpse.flux_weights, fpse.divergence_weights),
}


def study(inputs: Inputs, *, shown_beta: float) -> Result:
    """The change M(t_f) / M(t_0) - 1 of the total strength, beside round-off and the exact outflow.

    A rate du_i/dt is a sum whose terms add up to S |u|, S the sum of the absolute weights. By transforms of length L
    it carries a round-off of about eps log2(L) S |u|, which adds up over the time T: 4 eps log2(L) S T is taken as its
    bound. What leaves [-D, D] in the exact solution is m(D, t_0) - m(D, t_f), in closed form.

    The strengths of DVM are constant. The round-off of their total is that of one sum of N terms, and of one more for
    every remeshing.

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
    columns = {
        "scheme": shown["scheme"],
        "order": shown["order"].map(ORDERS).where(~shown["scheme"].isin(["GPSE", "FD"]), "-"),
        "beta": shown["beta"],
        "exterior": shown["exterior"],
        "M(t_f) / M(t_0) - 1": shown["change"],
        "in ulp": (shown["change"] / EPS).round(),
        "round-off, bound": shown["bound"],
        "exact outflow / M(t_0)": shown["outflow"],
        "change + exact outflow": shown["change"] + shown["outflow"],
        "put beyond ±D by remeshing / M(t_0)": shown["lost"],
        "left out as too weak / M(t_0)": shown["left out"],
    }
    key = ["exterior", "scheme", "beta", "order"]
    table = pd.DataFrame(columns).sort_values(key, ascending=[False, True, True, True])
    series = runs[np.isclose(runs["beta"], shown_beta) & (runs["order"] == 2) & ~weak]
    series = series.assign(x=series["t_final"] - series["t_initial"], y=series["change"].abs())
    findings = [*_lattice(runs), *_moving(runs[moving]), _moments()]
    series = series[["scheme", "exterior", "x", "y", "outflow", "bound"]]
    return Result(table, inputs.judged(findings), series)


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
        return 4.0 * EPS * np.log2(2.0 * n) * (1.0 + run.remeshings)
    lattice = (n, run.particle_spacing, 1.0 + run.beta, int(run.order), run.overlap)
    time = run.diffusivity * (run.t_final - run.t_initial)
    return 4.0 * EPS * np.log2(4.0 * n) * weight_sum(run.scheme, *lattice) * time


def _lattice(runs: pd.DataFrame) -> Iterator[Finding]:
    """The exchange schemes and DD, truncated: the change over the bound of its round-off, and the exact outflow."""
    opened, truncated = (pick(runs, exterior=name) for name in ("open", "truncated"))
    for scheme in _CLAIMED:
        here = pick(truncated, scheme=scheme).set_index("beta")
        change = here["change"].abs()
        share = (change / here["bound"]).groupby("beta")
        more = {"outflow": here["outflow"].max(), "share": share.max()}
        if scheme == "DD":
            least = (change / here["outflow"]).groupby("beta")
            missed = (opened["change"] + opened["outflow"]).abs().max()
            more = {"outflow": least.min(), "missed": missed, "share": share.min()}
        numbers = {"change": change.groupby("beta").max(), "count": len(here), **more}
        yield measured(f"L-C18.{scheme}", runs=here["run"], **numbers)


def _moving(runs: pd.DataFrame) -> Iterator[Finding]:
    """DVM without remeshing, and with it: what is missing must be what remeshing put beyond the ends, or left out."""
    by_beta = runs.set_index("beta")
    free, remeshed = (by_beta[(by_beta["remeshing"] == "none") == alone] for alone in (True, False))
    gone = remeshed["lost"] + remeshed["left out"]
    full = remeshed[remeshed["usual"] & (remeshed["threshold"] == 0.0)]
    usual = free[free["usual"]]
    stretch = (usual["largest_spacing"] / usual["particle_spacing"]).groupby("beta").min()
    yield measured(
        "L-C18.DVM",
        runs=free["run"],
        change=free["change"].abs().groupby("beta").max(),
        share=(free["change"].abs() / free["bound"]).groupby("beta").max(),
        count=len(free),
    )
    yield measured(
        "L-C18.DVM_remeshed",
        runs=remeshed["run"],
        share=(remeshed["change"].abs() / remeshed["bound"]).groupby("beta").min(),
        lost=(-full["change"]).groupby("beta").max(),
        outflow=full["outflow"].groupby("beta").max(),
        rest=((remeshed["change"] + gone).abs() / remeshed["bound"]).max(),
        weak=remeshed["left out"].abs().max(),
    )
    yield measured("L-C18.DVM_distortion", runs=usual["run"], stretch=stretch)
    overlap = usual["overlap"].iloc[0] / stretch
    yield measured("L-C18.DVM_overlap", runs=usual["run"], overlap=overlap)


def _moments() -> Finding:
    """How many sums of U x^m, m = 0, 1, .., remeshing keeps, from particles anywhere onto the lattice."""
    random = np.random.default_rng(1)
    x, strength = random.uniform(-1.0, 1.0, 200), random.uniform(0.5, 1.5, 200)
    kept = {}
    for name in _REMESHINGS:
        z, moved = remesh(x, strength, 0.1, name)
        scale = [(strength * np.abs(x) ** m).sum() for m in range(6)]
        off = [(moved * z**m).sum() - (strength * x**m).sum() for m in range(6)]
        # Sums of some hundred terms of modulus one.
        kept[name] = int(np.argmax(np.abs(off) > 1e-12 * np.array(scale)))
    return measured("L-C18.DVM_moments", kept=kept)
