r"""Are GPSE and DVM stable whatever the step (Sec. 4.4)?

GPSE is an Euler step of a symmetric operator: stable if 1 + dt A(theta) lies in [-1, 1] for every wave.

The strengths of DVM do not change, but its particles move. In a uniform field a displacement wave xi exp(i k x) has
the rate -D |k|^alpha eta^(k epsilon) xi, which is DD's symbol: a midpoint step multiplies it by 1 + z + z^2 / 2,
z = dt A_DD(k h), and that exceeds one where D dt / h^alpha exceeds DD's limit a.
"""

from __future__ import annotations

import warnings
from collections import deque
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import NonFiniteSolution, StabilityWarning
from fracparticles.moving import dvm
from fracparticles.moving.lagrangian import FieldNotPositive, advance
from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import advect, compute, initial_strengths
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.stability import stability_limit
from fracparticles.special.stable import mean_radius
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, listed, statement

__all__ = ["displacement_growth", "gpse_factors", "study", "worst_wave"]

_STEPS = 3  # of which a measured growth is the mean
_XI = 1e-5  # displacement of a wave, in spacings: its square is what linearity neglects
_SEED = 1e-6  # relative perturbation of a run's strengths, far above round-off: the same on every machine
_RUINED = 10.0  # an error that has grown so many times is no longer that of the discretisation
_ROUND_OFF = 1e-12
_WEAK = 1e-3  # of the peak: a particle of very small strength
_WAVES = np.linspace(0.0, np.pi, 4001)
_BETAS = (0.1, 0.5, 0.9)
_RUNS: dict[str, dict[str, Any]] = {
    "DVM, no remeshing": {"scheme": "DVM", "remeshing": "none"},
    "DVM, M4'": {"scheme": "DVM", "remeshing": "M4'"},
    "GPSE, open exterior": {"scheme": "GPSE", "exterior": "open"},
}


def worst_wave(alpha: float, order: int, overlap: float = 2.0) -> float:
    """Return k h of the wave that DD's operator damps the most."""
    setting = Setting(alpha=alpha, order=order, overlap=overlap)
    return float(_WAVES[np.argmin(SCHEMES["DD"].symbol(_WAVES, setting))])


def displacement_growth(
    alpha: float, order: int, step: float, theta: float, half: int, overlap: float = 2.0
) -> float:
    """Return what a midpoint step of DVM multiplies a displacement wave by, measured.

    A uniform field on 2 `half` + 1 particles, h = 1, moves with and without the wave xi cos(theta i); their
    distance in the middle, where the ends are not felt yet, against the wave. `step` is D dt / h^alpha.
    """
    x = np.arange(-half, half + 1.0)
    wave = np.cos(theta * x)
    velocity = dvm.DiffusionVelocity(alpha, order, overlap)
    move = partial(advance, strength=np.ones(x.size), velocity=velocity, dt=step, steps=_STEPS)
    change = (move(x + _XI * wave)[0] - move(x)[0]) / _XI
    middle = np.abs(x) <= half / 6.0
    ratio = float(change[middle] @ wave[middle] / (wave[middle] @ wave[middle]))
    return float(np.copysign(np.abs(ratio) ** (1.0 / _STEPS), ratio))


def gpse_factors(alpha: float, overlap: float) -> np.ndarray:
    """Return 1 + dt A(theta) of GPSE, dt = epsilon^alpha / D, over all waves."""
    setting = Setting(alpha=alpha, overlap=overlap)
    return 1.0 + overlap**alpha * SCHEMES["GPSE"].symbol(_WAVES, setting)


def study(
    inputs: Inputs,
    *,
    beta: float,
    truncation: float,
    spacing: float,
    factors: list[float],
    growth: list[float],
    half: int,
    overlap: list[float],
    spacings: list[float],
    stop: dict[str, Any],
) -> Result:
    """Growth in a step, and errors of runs, against the step in units of DD's limit a h^alpha / D.

    GPSE is called stable if |1 + dt A| <= 1 up to round-off, for every wave, beta and `overlap`. DVM is called stable
    if no run above the limit stops, or errs ten times as much as the one with the smallest step. The runs have steps of
    `factors` times the limit; waves are measured at `growth` times it on 2 `half` + 1 particles; the velocity of the
    last particle is taken at each of the `spacings`; `stop` holds the fields of a case that stops.
    """
    grid = {"beta": beta, "truncation": truncation}
    waves = _growth(1.0 + beta, growth, half)
    runs = pd.concat([_runs(name, {**grid, "spacing": spacing}, factors) for name in _RUNS])
    ruined, error = runs["ratio"] > _RUINED, runs["error"]
    # Saturated chaos: its size is a result, its digits are nobody's.
    shown = error.where(~ruined, error.map(lambda e: float(f"{e:.0e}")))
    outcome = np.where(runs["stopped"].notna(), "stopped", np.where(ruined, "ruined", "fine"))
    table = pd.DataFrame(
        {
            "run": runs["run"],
            "step / limit of DD": runs["factor"],
            "Δt": runs["dt"],
            "error (48)": shown,
            "steps": runs["steps"],
            "outcome": outcome,
            "after t": runs["stopped"],
            "growth of the worst wave in a step": runs["growth"],
        }
    )
    findings = []
    if inputs.items:
        findings = [
            _gpse_finding(runs, overlap),
            _dvm_finding(runs, waves, beta, min(spacings)),
            _bounded_finding(grid, spacings),
            _divergence_finding(Case(scheme="DVM", **stop)),
        ]
    series = pd.concat([waves.assign(panel="growth"), runs.assign(panel="error")])
    return Result(table, findings, series.reset_index(drop=True))


def _midpoint(z: float) -> float:
    return 1.0 + z + 0.5 * z * z


def _growth(alpha: float, factors: list[float], half: int) -> pd.DataFrame:
    """Factors of the worst displacement wave of DVM, measured and predicted; those of short waves of GPSE."""
    rows = []
    for order, factor in product((2, 4), factors):
        theta = worst_wave(alpha, order)
        step = factor * stability_limit("DD", alpha - 1.0, order)
        setting = Setting(alpha=alpha, order=order)
        lowest = float(SCHEMES["DD"].symbol(np.array([theta]), setting)[0])
        row = {"run": "DVM", "order": order, "factor": factor}
        row["measured"] = displacement_growth(alpha, order, step, theta, half)
        rows.append({**row, "predicted": _midpoint(step * lowest)})
    limit = stability_limit("DD", alpha - 1.0)
    short = worst_wave(alpha, 2) / 2.0 <= _WAVES
    for factor in np.geomspace(0.1 * min(factors), 1.5 * max(factors), 61):
        largest = np.abs(gpse_factors(alpha, (factor * limit) ** (1.0 / alpha))[short]).max()
        rows.append({"run": "GPSE", "order": 2, "factor": factor, "predicted": largest})
    return pd.DataFrame(rows)


def _runs(name: str, grid: dict[str, float], factors: list[float]) -> pd.DataFrame:
    """Runs with steps on both sides of the limit; a run that stops has no error, but the time of it."""
    of_dd = Case(**grid, scheme="DD", dt=1.0)
    limit, start = of_dd.largest_stable_step, of_dd.t_initial
    rows = []
    for factor in factors:
        case = Case(**grid, **_RUNS[name], dt=factor * limit, t_initial=start)
        # With a trace of the worst wave, so that round-off need not provide it.
        k = worst_wave(case.alpha, 2) / case.particle_spacing
        seeded = initial_strengths(case)[0] * (1.0 + _SEED * np.cos(k * case.x))
        u, stopped = _final_field(case, seeded)
        growth = _midpoint(-2.0 * case.time_step / limit) if case.scheme == "DVM" else np.nan
        rows.append(
            {
                "run": name,
                "factor": case.time_step / limit,
                "dt": case.time_step,
                "steps": case.steps,
                "error": np.nan if u is None else relative_l1_error(case, u),
                "stopped": stopped,
                "growth": growth,
            }
        )
    runs = pd.DataFrame(rows)
    return runs.assign(ratio=runs["error"] / runs["error"].iloc[runs["dt"].argmin()])


def _final_field(case: Case, u0: np.ndarray) -> tuple[np.ndarray | None, float]:
    """The field at the end and nan, or None and the time after which the run could not go on."""
    if case.scheme != "DVM":
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", StabilityWarning)
            return compute(case, u0).u, np.nan
    states: deque[Any] = deque(maxlen=1)
    try:
        return advect(case, u0, lambda *state: states.append(state)).field(case.x), np.nan
    except NonFiniteSolution:
        return None, states[-1][0]


def _gpse_finding(runs: pd.DataFrame, overlaps: list[float]) -> Finding:
    factors = [gpse_factors(1.0 + beta, s) for beta, s in product(_BETAS, overlaps)]
    low, high = min(f.min() for f in factors), max(f.max() for f in factors)
    here = runs[runs["run"].str.startswith("GPSE")]
    return statement(
        "L-C11.GPSE",
        low >= -1.0 and high <= 1.0 + _ROUND_OFF and here["ratio"].max() < _RUINED,
        f"A step multiplies waves by {round(low, 12) + 0.0:g} to {round(high, 12):g}, for beta = {listed(_BETAS)} "
        f"and epsilon / h from {min(overlaps):g} to {max(overlaps):g}; runs with steps up to "
        f"{here['factor'].max():.3g} times the limit of DD err by {here['error'].min():.1e} to "
        f"{here['error'].max():.1e}.",
        "A step amplifies a wave.",
    )


def _dvm_finding(runs: pd.DataFrame, growth: pd.DataFrame, beta: float, h: float) -> Finding:
    longest = stability_limit("DD", beta) * h ** (1.0 + beta)
    waves = growth[growth["run"] == "DVM"]
    miss = (waves["measured"] - waves["predicted"]).abs().max()
    here = runs[runs["run"].str.startswith("DVM")]
    bad = here["stopped"].notna() | (here["ratio"] > _RUINED)
    above, below = here["factor"] > 1.0, here["factor"] <= 1.0
    first = here.loc[bad, "factor"].min()
    limits = ", ".join(f"{stability_limit('DD', beta):.2f} (beta = {beta:g})" for beta in _BETAS)
    return statement(
        "L-C11.DVM",
        not (bad & above).any(),
        f"Of {above.sum()} runs with steps above the limit of DD {(bad & above).sum()} stop or err more than "
        f"{_RUINED:g} times as much as with the smallest step, the first at {first:.3g} times that limit; of "
        f"{below.sum()} runs below it {(bad & below).sum()}. A displacement wave grows as DD's symbol says, to "
        f"{miss:.1g}.",
        "The strengths are invariant, the positions are not: a displacement wave has the rate of DD's symbol, so that "
        f"the midpoint rule has DD's limit, D dt / h^alpha <= {limits} at order II: dt <= {longest:.3g} for beta = "
        f"{beta:g}, h = {h:.3g}.",
    )


def _velocity(case: Case) -> dvm.DiffusionVelocity:
    epsilon = case.resolved_overlap * case.particle_spacing
    return dvm.DiffusionVelocity(case.alpha, case.order, epsilon)


def _bounded_finding(grid: dict[str, float], spacings: list[float]) -> Finding:
    """The last particle's velocity at the start, over the exact x / (alpha t), against h."""
    cases = [Case(scheme="DVM", **grid, spacing=h, dt=1.0) for h in spacings]
    exact = cases[0].reach / (cases[0].alpha * cases[0].t_initial)
    h = np.array([case.particle_spacing for case in cases])
    strengths = [case.particle_spacing * initial_strengths(case)[0] for case in cases]
    pairs = zip(cases, strengths, strict=True)
    last = np.array([float(_velocity(case)(case.x, strength)[-1]) for case, strength in pairs])
    # With h halved from level to level, a power of h keeps its exponent in the differences.
    gain = np.diff(last)
    power = float(np.log(gain[-1] / gain[-2]) / np.log(h[-1] / h[-2]))
    return statement(
        "L-C11.DVM_bounded",
        power > -0.1,
        f"Velocity of the last particle at the start, beta = {grid['beta']:g}: {last[0]:.3g} at h = {h[0]:.3g}, "
        f"{last[-1]:.3g} at h = {h[-1]:.3g}, exactly {exact:.3g}; what a halved h adds grows like h^{power:.2f}.",
        "At an end the field jumps to zero and the flux there grows like epsilon^-beta: no bound holds as h falls. For "
        "the solution itself the velocity is x / (alpha t), which no bound holds either.",
    )


def _divergence_finding(case: Case) -> Finding:
    """A run that stops below the limit: where, and how weak the particle there is."""
    states: deque[Any] = deque(maxlen=1)
    stopped, weak, place = "does not stop", 0.0, case.reach
    try:
        advect(case, initial_strengths(case)[0], lambda *state: states.append(state))
    except FieldNotPositive:
        time, x, strength = states[-1]
        u = _velocity(case).field_and_flux(x, strength)[0]
        least = int(np.argmin(u))
        stopped = f"stops after t = {time:g}"
        weak, place = float(u[least] / u.max()), float(abs(x[least]))
    return statement(
        "L-C11.DVM_divergence",
        weak < _WEAK and place > 5.0 * mean_radius(case.alpha),
        f"At beta = {case.beta:g}, h = {case.particle_spacing:.3g}, dt = {case.time_step:g}, "
        f"{case.time_step / case.largest_stable_step:.2g} of the limit of DD, the run {stopped}: the field changes "
        f"sign; the weakest particle of the step before is at {place / case.reach:.2f} D with {weak:.1e} of the peak. "
        "It is weak because it is an end of the lattice, which remeshing rings about.",
        "A run stops where the field is not small.",
    )
