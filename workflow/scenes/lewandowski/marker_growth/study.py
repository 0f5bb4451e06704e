"""The time step, and what perturbations of equally spaced markers do: -k^2 S^(k) against runs."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES, shape_function
from fracparticles.markers.growth import largest_step, measured_rate
from fracparticles.markers.stability import extremes, lattice_rate, rate
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import INFINITE, SquareRuns


def study(
    inputs: Inputs,
    *,
    lattices: dict[str, dict[str, Any]],
    wavenumbers: float,
    limits: dict[str, list[Any]],
    run: SquareRuns,
    steps: list[float],
) -> Result:
    """Perturb equally spaced markers on a periodic line, and look for the largest stable step.

    `lattices` (by shape function, in units of eps) have `spacing`, `period`, `amplitude` and `modes`, `limits` the
    `shapes` and `supports` for which the largest step is sought, `steps` are dt / eps^2 for the square profile.
    """
    square = SquareRuns.model_validate(run)
    rates = pd.DataFrame(row for name in lattices for row in _rates(name, **lattices[name]))
    predicted = rates["of the lattice"].fillna(rates["-k² S^(k)"])
    table = rates.assign(deviation=rates["measured"] - predicted)
    eta = {name: extremes(shape_function(name)).eta for name in limits["shapes"]}
    found = pd.DataFrame(
        {"S": name, "ε": e, "η": largest_step(SHAPES[name], e), "predicted": eta[name]}
        for name, e in product(eta, limits["supports"])
    )
    profile = pd.DataFrame(_profile(square, *case) for case in product(eta, steps))
    panels, k = Panels(), np.linspace(0.0, wavenumbers, 301)
    for name in lattices:
        panels.add("rate", name, k, rate(shape_function(name), k))
    panels.add("rate", "exact", k, -k * k)
    panels.add("measured", rates["S"], rates["k = ε q"], rates["measured"])
    panels.add("step", profile["S"], profile["step"], profile["E"], t=square.t_final)
    panels.add("limit", list(eta), list(eta.values()), np.nan)
    findings = [*_step(rates, found, profile), _finite_differences()]
    return Result(table, inputs.judged(findings), panels.frame)


def _rates(name: str, modes: list[int], **lattice: Any) -> Iterator[dict[str, Any]]:
    shape = shape_function(name)
    spacing = lattice["period"] / round(lattice["period"] / lattice["spacing"])
    for mode in modes:
        k, ours = measured_rate(shape, mode, **lattice)
        smooth = shape.smoothness is None or shape.smoothness >= 2
        predicted = float(lattice_rate(shape, k, spacing)) if smooth else np.nan
        row = {"S": name, "k = ε q": k, "-k² S^(k)": float(rate(shape, k))}
        yield {**row, "of the lattice": predicted, "measured": ours}


def _profile(square: SquareRuns, name: str, step: float) -> dict[str, Any]:
    """E at the end of the square profile, from midpoints."""
    run = square.having(dt=step * square.support**2)
    trace = run.trace(name, "midpoints", follow=False)
    return {"S": name, "step": step, "E": trace.error[-1] if trace.run else np.nan}


def _step(rates: pd.DataFrame, limits: pd.DataFrame, profile: pd.DataFrame) -> Iterator[Finding]:
    eta = limits.groupby("S")["η"]
    of_all = {name: extremes(SHAPES[name]).eta for name in ("S3", "S4", "S6", "S7", "S8")}
    yield measured(
        "M-C1.step",
        factor={name: max(e, 1.0 / e) for name, e in of_all.items()},
        spread=(eta.max() / eta.min() - 1.0).max(),
        eta=of_all,
        measured=eta.mean(),
        off=(limits["η"] / limits["predicted"] - 1.0).abs().max(),
    )
    growth = rates.groupby("S")["measured"].max()
    lattice: dict[str, Any] = {"spacing": 0.0625, "period": 16.0}
    _, growth[INFINITE.name] = measured_rate(INFINITE, 8, amplitude=1e-4, **lattice)
    yield measured("M-C1.ensures", growth=growth, predicted=extremes(INFINITE).growth)
    first, last = (getattr(profile.dropna().groupby("S")["E"], end)() for end in ("first", "last"))
    yield measured("M-C1.classical", ratio=last / first, step=profile.dropna()["step"].max())


def _finite_differences() -> Finding:
    """Euler's method with second differences on a periodic line: what 2000 steps make of noise."""

    def growth(step: float) -> float:
        f = np.random.default_rng(0).standard_normal(64)
        start = np.abs(f).max()
        for _ in range(2000):
            f = f + step * (np.roll(f, 1) - 2.0 * f + np.roll(f, -1))
        return float(np.abs(f).max() / start)

    return measured("M-C1.finite_differences", below=growth(0.49), above=growth(0.51))
