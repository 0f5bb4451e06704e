"""The time step, and what perturbations of equally spaced markers do: -k^2 S^(k) against runs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES, shape_function
from fracparticles.markers.growth import largest_step, measured_rate
from fracparticles.markers.stability import extremes, lattice_rate, rate
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import SquareRuns

__all__ = ["study"]


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
    `shapes` and `supports` for which the largest step is sought, `steps` are dt / eps^2 for the square profile. The
    limit is of order one if it lies between 0.1 and 10, and proportional to eps^2 if eta is the same to a hundredth.
    """
    square = SquareRuns.model_validate(run)
    rates = pd.DataFrame([row for name in lattices for row in _rates(name, **lattices[name])])
    predicted = rates["of the lattice"].fillna(rates["-k² S^(k)"])
    table = rates.assign(deviation=rates["measured"] - predicted)
    eta = {name: extremes(shape_function(name)).eta for name in limits["shapes"]}
    found = pd.DataFrame(
        [
            {"S": name, "ε": e, "η": largest_step(SHAPES[name], e), "predicted": eta[name]}
            for name in eta
            for e in limits["supports"]
        ]
    )
    profile = pd.DataFrame([_profile(square, name, step) for name in eta for step in steps])
    panels, k = Panels(), np.linspace(0.0, wavenumbers, 301)
    for name in lattices:
        panels.add("rate", name, k, rate(shape_function(name), k))
    panels.add("rate", "exact", k, -k * k)
    panels.add("measured", rates["S"], rates["k = ε q"], rates["measured"])
    panels.add("step", profile["S"], profile["step"], profile["E"], t=square.t_final)
    panels.add("limit", list(eta), list(eta.values()), np.nan)
    findings = [_step(rates, found, profile), _finite_differences()]
    return Result(table, inputs.judged(findings), panels.frame)


def _rates(name: str, modes: list[int], **lattice: Any) -> list[dict[str, Any]]:
    shape = shape_function(name)
    rows: list[dict[str, Any]] = []
    spacing = lattice["period"] / round(lattice["period"] / lattice["spacing"])
    for mode in modes:
        k, measured = measured_rate(shape, mode, **lattice)
        row = {
            "S": name,
            "k = ε q": k,
            "-k² S^(k)": float(rate(shape, k)),
            "of the lattice": np.nan,
        }
        if shape.smoothness is None or shape.smoothness >= 2:
            row["of the lattice"] = float(lattice_rate(shape, k, spacing))
        rows.append({**row, "measured": measured})
    return rows


def _profile(square: SquareRuns, name: str, step: float) -> dict[str, Any]:
    """E at the end of the square profile, from midpoints."""
    run = square.having(dt=step * square.support**2)
    trace = run.trace(name, "midpoints", follow=False)
    return {"S": name, "step": step, "E": trace.error[-1] if trace.run else np.nan}


def _step(rates: pd.DataFrame, limits: pd.DataFrame, profile: pd.DataFrame) -> Finding:
    eta = limits.groupby("S")["η"]
    spread = float((eta.max() / eta.min() - 1.0).max())
    gap = float((limits["η"] / limits["predicted"] - 1.0).abs().max())
    names = ("S3", "S4", "S6", "S7", "S8")
    all_of = ", ".join(f"{extremes(SHAPES[name]).eta:.4f} ({name})" for name in names)
    measured = ", ".join(f"{v:.4f} ({s})" for s, v in eta.mean().items())
    first = profile.groupby("S")["E"].first()
    above = profile[profile["step"] > 1.4 * limits["predicted"].max()].groupby("S")["E"].first()
    worse = ", ".join(f"{above[s] / first[s]:.1f} ({s})" for s in above.index)
    growing = sorted(set(rates.loc[rates["measured"] > 0.0, "S"]))
    supports = " and ".join(f"{e:g}" for e in sorted(limits["ε"].unique()))
    return statement(
        "M-C1.step",
        limits["η"].between(0.1, 10.0).all() and spread <= 0.01,
        f"η = 2 / max k² S^(k) is {all_of}; measured {measured}, the same at ε = {supports} to {spread:.0e}, as "
        f"predicted to {gap:.1e}. Well above, E of the square profile is {worse} times that at a small step. No step "
        f"stops the growth of clusters with {', '.join(growing)}.",
        "The limit is not of order one, or not proportional to ε².",
    )


def _finite_differences() -> Finding:
    """Euler's method and second differences: eigenvalues of a periodic line of 64 points, (dx)^2 taken as 1."""
    points = 64
    unit = np.eye(points)
    laplacian = np.roll(unit, 1, axis=0) - 2.0 * unit + np.roll(unit, -1, axis=0)
    limit = -2.0 / np.linalg.eigvalsh(laplacian).min()  # |1 + dt lambda| <= 1
    return statement(
        "M-C1.finite_differences",
        abs(limit - 0.5) < 1e-12,
        f"The eigenvalues of the second difference on {points} points give dt < {limit:.12g} (Δx)² for Euler's method.",
        "The limit is another one.",
    )
