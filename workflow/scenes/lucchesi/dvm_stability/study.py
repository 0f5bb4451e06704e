r"""Are GPSE and DVM stable whatever the step (Sec. 4.4)?

GPSE is an Euler step of a symmetric operator: stable if 1 + dt A(theta) lies in [-1, 1] for every wave.

The strengths of DVM do not change, but its particles move. In a uniform field a displacement wave xi exp(i k x) has
the rate -D |k|^alpha eta^(k epsilon) xi, which is DD's symbol: a midpoint step multiplies it by 1 + z + z^2 / 2,
z = dt A_DD(k h), and that exceeds one where D dt / h^alpha exceeds DD's limit a.
"""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import NonFiniteSolution, StabilityWarning
from fracparticles.moving.diffusion_velocity import DiffusionVelocity
from fracparticles.moving.growth import displacement_growth
from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import advect, compute, initial_strengths
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.stability import stability_limit, worst_wave
from fracstudy.errors import quiet
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import pick

_SEED = 1e-6  # relative perturbation of a run's strengths, far above round-off: the same on every machine
_RUINED = 10.0  # an error that has grown so many times is no longer that of the discretisation
_WEAK = 1e-3  # of the peak: a very small strength
_EVERY = 10  # states between two that are looked at
_WAVES = np.linspace(0.0, np.pi, 4001)
_BETAS = (0.1, 0.5, 0.9)
_RUNS: dict[str, dict[str, Any]] = {
    "DVM, no remeshing": {"scheme": "DVM", "remeshing": "none"},
    "DVM, M4'": {"scheme": "DVM", "remeshing": "M4'"},
    "GPSE, open exterior": {"scheme": "GPSE", "exterior": "open"},
}


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
    ends: list[dict[str, Any]],
    printed_spacing: dict[float, float],
    printed_step: float,
) -> Result:
    """Growth in a step, and errors of runs, against the step in units of DD's limit a h^alpha / D.

    A run is ruined if it stops or errs ten times as much as the one with the smallest step. The runs have steps of
    `factors` times the limit; GPSE's waves are taken for every beta and `overlap`, DVM's are measured at `growth` times
    the limit on 2 `half` + 1 particles; the velocity of the last particle is taken at each of the `spacings`; `ends`
    holds the fields of cases whose ends are looked at. The limit is set beside the paper's step by its h, by beta.
    """
    grid = {"beta": beta, "truncation": truncation}
    waves = _growth(1.0 + beta, growth, half)
    runs = pd.concat([_runs(name, {**grid, "spacing": spacing}, factors) for name in _RUNS])
    stopped, error = runs["stopped"].notna(), runs["error"]
    ruined = _ruined(runs) & ~stopped
    columns = {
        "run": runs["run"],
        "step / limit of DD": runs["factor"],
        "Δt": runs["dt"],
        # Saturated chaos: its size is a result, its digits are nobody's.
        "error (48)": error.where(~ruined, error.map(lambda e: float(f"{e:.0e}"))),
        "steps": runs["steps"],
        "outcome": np.where(stopped, "stopped", np.where(ruined, "ruined", "fine")),
        "after t": runs["stopped"],
        "growth of the worst wave in a step": runs["growth"],
    }
    table = pd.DataFrame(columns)

    def limit(beta: float) -> float:
        return stability_limit("DD", beta) * printed_spacing[beta] ** (1.0 + beta) / printed_step

    findings: list[Finding] = []
    if inputs.items:
        unseeded = _unseeded({**grid, "spacing": spacing}, runs)
        findings = [
            *_gpse(runs, overlap),
            *_dvm(runs, unseeded, waves, each(limit, beta=printed_spacing)),
            _bounded(grid, spacings),
            *_weak([Case(scheme="DVM", **fields) for fields in ends]),
        ]
    runs = runs.drop(columns="remeshed").assign(panel="error")
    series = pd.concat([waves.assign(panel="growth"), runs])
    return Result(table, findings, series.reset_index(drop=True))


def _midpoint(z: float) -> float:
    return 1.0 + z + 0.5 * z * z


def _growth(alpha: float, factors: list[float], half: int) -> pd.DataFrame:
    """Factors of the worst displacement wave of DVM, measured and predicted; those of short waves of GPSE."""
    rows = []
    for order, factor in product((2, 4), factors):
        setting = Setting(alpha=alpha, order=order)
        theta = worst_wave("DD", setting)
        step = factor * stability_limit("DD", alpha - 1.0, order)
        lowest = float(SCHEMES["DD"].symbol(np.array([theta]), setting)[0])
        row = {"run": "DVM", "order": order, "factor": factor}
        velocity = DiffusionVelocity(alpha, order, setting.overlap)
        row["measured"] = displacement_growth(velocity, step, theta, half)
        rows.append({**row, "predicted": _midpoint(step * lowest)})
    limit = stability_limit("DD", alpha - 1.0)
    short = worst_wave("DD", Setting(alpha=alpha)) / 2.0 <= _WAVES
    for factor in np.geomspace(0.1 * min(factors), 1.5 * max(factors), 61):
        largest = np.abs(gpse_factors(alpha, (factor * limit) ** (1.0 / alpha))[short]).max()
        rows.append({"run": "GPSE", "order": 2, "factor": factor, "predicted": largest})
    return pd.DataFrame(rows)


def _runs(
    name: str, grid: dict[str, float], factors: list[float], seed: float = _SEED
) -> pd.DataFrame:
    """Runs with steps on both sides of the limit; a run that stops has no error, but the time of it."""
    of_dd = Case(**grid, scheme="DD", dt=1.0)
    limit, start = of_dd.largest_stable_step, of_dd.t_initial
    rows = []
    for factor in factors:
        case = Case(**grid, **_RUNS[name], dt=factor * limit, t_initial=start)
        # With a trace of the worst wave, so that round-off need not provide it.
        worst = worst_wave("DD", Setting(alpha=case.alpha)) / case.particle_spacing
        trace = seed * np.cos(worst * case.x)
        u, stopped, remeshings = _final_field(case, initial_strengths(case)[0] * (1.0 + trace))
        growth = _midpoint(-2.0 * case.time_step / limit) if case.scheme == "DVM" else np.nan
        row = {
            "run": name,
            "factor": case.time_step / limit,
            "dt": case.time_step,
            "steps": case.steps,
            "error": np.nan if u is None else relative_l1_error(case, u),
            "stopped": stopped,
            "growth": growth,
            "remeshed": remeshings / case.steps,
        }
        rows.append(row)
    runs = pd.DataFrame(rows)
    return runs.assign(ratio=runs["error"] / runs["error"].iloc[runs["dt"].argmin()])


def _ruined(runs: pd.DataFrame) -> pd.Series:
    return runs["stopped"].notna() | (runs["ratio"] > _RUINED)


def _unseeded(grid: dict[str, float], runs: pd.DataFrame) -> pd.DataFrame:
    """The runs of DVM above the limit once more without a trace of the worst wave, beside that of the smallest step."""
    factors = pick(runs, run="DVM, M4'")["factor"]
    chosen = [factors.min(), *factors[factors > 1.0]]
    return pd.concat([_runs(name, grid, chosen, 0.0) for name in _RUNS if name.startswith("DVM")])


def _final_field(case: Case, u0: np.ndarray) -> tuple[np.ndarray | None, float, int]:
    """The field at the end, nan and the number of remeshings, or None and the time after which the run stopped."""
    times: list[float] = []
    with quiet(StabilityWarning):
        if case.scheme != "DVM":
            return compute(case, u0).u, np.nan, 0
        try:
            run = advect(case, u0, lambda time, *_: times.append(time))
        except NonFiniteSolution:
            return None, times[-1], 0
    return run.field(case.x), np.nan, run.history.remeshings


def _gpse(runs: pd.DataFrame, overlaps: list[float]) -> Iterator[Finding]:
    """The factors of a step over all waves, and the errors of runs with steps on both sides of DD's limit."""
    factors = [gpse_factors(1.0 + beta, s) for beta, s in product(_BETAS, overlaps)]
    here = runs[runs["run"].str.startswith("GPSE")]
    error, change = here["error"], here["error"].max() / here["error"].min() - 1.0
    ends = {"lowest": np.min(factors), "excess": np.max(factors) - 1.0}
    yield measured("L-C11.GPSE", **ends, change=change, factor=here["factor"].max())
    apart = here["dt"].max() / here["dt"].min()
    yield measured("L-C11.GPSE_exact", change=change, apart=apart, error=error.max())


def _dvm(
    runs: pd.DataFrame, unseeded: pd.DataFrame, waves: pd.DataFrame, limits: pd.Series
) -> Iterator[Finding]:
    """Which runs of DVM are ruined above DD's limit, and how a displacement wave grows."""
    waves, runs = waves[waves["run"] == "DVM"], runs[runs["run"].str.startswith("DVM")]

    def share(runs: pd.DataFrame, above: bool = True) -> pd.Series:
        here = (runs["factor"] > 1.0) == above
        return _ruined(runs)[here].groupby(runs["run"][here]).mean()

    yield measured(
        "L-C11.DVM",
        others={"no trace of the worst wave at the start": {"ruined": share(unseeded)}},
        ruined=share(runs),
        below=share(runs, above=False).max(),
        first=runs.loc[_ruined(runs), "factor"].min() if _ruined(runs).any() else 0.0,
        miss=(waves["measured"] - waves["predicted"]).abs().max(),
        limit=limits,
        trace=_SEED,
    )
    least = runs.sort_values("dt").groupby("run")["remeshed"].first()
    yield measured("L-C11.DVM_invariant", remeshed=least)


def _velocity(case: Case) -> DiffusionVelocity:
    epsilon = case.resolved_overlap * case.particle_spacing
    return DiffusionVelocity(case.alpha, case.order, epsilon)


def _bounded(grid: dict[str, float], spacings: list[float]) -> Finding:
    """The last particle's velocity at the start, over the exact x / (alpha t), against h."""
    cases = [Case(scheme="DVM", **grid, spacing=h, dt=1.0) for h in spacings]
    h = np.array([case.particle_spacing for case in cases])

    def velocity(case: Case) -> float:
        strength = case.particle_spacing * initial_strengths(case)[0]
        return float(_velocity(case)(case.x, strength)[-1])

    last = np.array([velocity(case) for case in cases])
    # With h halved from level to level, a power of h keeps its exponent in the differences.
    gain = np.diff(last)
    return measured(
        "L-C11.DVM_bounded",
        power=np.log(gain[-1] / gain[-2]) / np.log(h[-1] / h[-2]),
        velocity={f"h = {spacing:.3g}": v for spacing, v in zip(h, last, strict=True)},
        exact=cases[0].reach / (cases[0].alpha * cases[0].t_initial),
    )


def _weak(cases: list[Case]) -> Iterator[Finding]:
    """How strong the weakest particles are, and where the velocity is more than the exact x / (alpha t)."""
    least, ratios, stopped = {}, {}, 0
    for case in cases:
        name, u0 = f"beta = {case.beta:g}", initial_strengths(case)[0]
        least[name] = u0.min() / u0.max()
        states: list[Any] = []
        with quiet(StabilityWarning):
            try:
                advect(case, u0, lambda *state, kept=states: kept.append(state))
            except NonFiniteSolution:
                stopped += 1
        ratios[name] = np.max([_speeds(case, *s) for s in [*states[::_EVERY], states[-1]]], axis=0)
    excess = {name: strong - 1.0 for name, (strong, _) in ratios.items()}
    weak = {name: weak for name, (_, weak) in ratios.items()}
    yield measured("L-C11.DVM_divergence", excess=excess, weak=weak, stopped=stopped)
    yield measured("L-C11.small_strengths", least=least)


def _speeds(case: Case, time: float, x: np.ndarray, strength: np.ndarray) -> tuple[float, float]:
    """The largest speed over the exact one, where u is more than a thousandth of its peak, and elsewhere."""
    u, flux = _velocity(case).field_and_flux(x, strength)
    here = np.abs(x) > 2.0 * case.particle_spacing
    ratio = np.abs(flux / u)[here] / (np.abs(x) / (case.alpha * time))[here]
    strong = (u > _WEAK * u.max())[here]
    return ratio[strong].max(), ratio[~strong].max(initial=0.0)
