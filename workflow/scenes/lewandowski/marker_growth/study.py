"""The time step, and what perturbations of equally spaced markers do: -k^2 S^(k) against runs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES, MarkerVelocity, run, shape_function
from fracparticles.markers.stability import extremes, lattice_rate, rate
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.lewandowski.marker_runs import trace

__all__ = ["largest_step", "measured_rate", "study"]

_HALVINGS = 12
_STEPS = 24


def study(inputs: Inputs) -> Result:
    """Perturb equally spaced markers on a periodic line, x_j = j h + a cos(q j h), and follow the perturbation.

    Parameters of the scene: `lattices` (by shape function, in units of eps: `spacing`, `period`, `amplitude`, `modes`),
    `wavenumbers`, `limits` (the shape functions and support parameters for which the largest stable step is sought),
    `steps` (a list of dt / eps^2 for the square profile), and those of its run. The limit is of order one if it lies
    between 0.1 and 10, and proportional to eps^2 if eta is the same to a hundredth.
    """
    parameters = inputs.parameters
    rates = pd.concat(
        [_rates(name, lattice) for name, lattice in parameters["lattices"].items()],
        ignore_index=True,
    )
    limits = _limits(parameters["limits"])
    profile = _profile(parameters)
    predicted = rates["of the lattice"].fillna(rates["-k² S^(k)"])
    table = rates.assign(deviation=rates["measured"] - predicted)
    return Result(
        table, [_step(rates, limits, profile), _finite_differences()],
        _series(parameters, rates, limits, profile),
    )  # fmt: skip


def measured_rate(
    name: str, mode: int, spacing: float, period: float, amplitude: float, dt: float, steps: int,
    support: float = 1.0,
) -> tuple[float, float]:  # fmt: skip
    """Return k = eps q and the rate of log amplitude per eps^2 / t; lengths and dt in units of eps and eps^2."""
    count = round(period / spacing)
    h = support * period / count
    k = 2.0 * math.pi * mode / period
    lattice = h * (np.arange(count) + 0.5)
    wave = np.cos(k / support * lattice)
    velocity = MarkerVelocity(shape_function(name), support, period=support * period)
    x = lattice + amplitude * support * wave
    end = run(x, np.full(count, h), velocity, dt=dt * support**2, steps=steps)
    left = 2.0 * np.mean((end.x - lattice) * wave) / (amplitude * support)
    return k, math.log(abs(left)) / (dt * steps)


def largest_step(name: str, support: float) -> float:
    """Return the largest dt / eps^2 at which the mode that decays fastest does not grow, by bisection."""
    shape = shape_function(name)
    wavelength = 2.0 * math.pi / extremes(shape).k_decay
    waves = math.floor(2.0 * shape.reach / wavelength) + 1
    # Where S'' jumps, at eps, neighbours half a spacing off on either side make the smallest lattice error.
    counts = waves * np.arange(24, 64)
    off = np.abs(np.mod(shape.reach * counts / (waves * wavelength), 1.0) - 0.5)
    spacing = waves * wavelength / counts[int(np.argmin(off))]
    low, high = 0.05, 2.0
    for _ in range(_HALVINGS):
        dt = 0.5 * (low + high)
        _, growth = measured_rate(
            name, waves, spacing, waves * wavelength, 1e-6, dt, _STEPS, support
        )
        low, high = (dt, high) if growth <= 0.0 else (low, dt)
    return 0.5 * (low + high)


def _rates(name: str, lattice: Mapping[str, Any]) -> pd.DataFrame:
    shape, rows = shape_function(name), []
    spacing, period = float(lattice["spacing"]), float(lattice["period"])
    for mode in lattice["modes"]:
        k, measured = measured_rate(
            name, int(mode), spacing, period, float(lattice["amplitude"]), 0.005, 10
        )
        exact = float("nan")
        if shape.smoothness is None or shape.smoothness >= 2:
            exact = float(lattice_rate(shape, np.array([k]), period / round(period / spacing))[0])
        rows.append(
            {
                "S": name,
                "k = ε q": k,
                "-k² S^(k)": float(rate(shape, np.array(k))),
                "of the lattice": exact,
                "measured": measured,
            }
        )
    return pd.DataFrame(rows)


def _limits(limits: Mapping[str, Any]) -> pd.DataFrame:
    rows = []
    for name in limits["shapes"]:
        eta = extremes(shape_function(name)).eta
        rows += [
            {"S": name, "ε": e, "η": largest_step(name, float(e)), "predicted": eta}
            for e in limits["supports"]
        ]
    return pd.DataFrame(rows)


def _profile(parameters: Mapping[str, Any]) -> pd.DataFrame:
    """E at the end of the square profile against dt / eps^2, by the smallest."""
    rows = []
    for name in parameters["limits"]["shapes"]:
        for step in parameters["steps"]:
            dt = float(step) * float(parameters["support"]) ** 2
            found = trace(parameters, name, "midpoints", dt=dt, follow=False)
            rows.append({"S": name, "step": step, "E": found.error[-1] if found.run else np.nan})
    return pd.DataFrame(rows)


def _step(rates: pd.DataFrame, limits: pd.DataFrame, profile: pd.DataFrame) -> Finding:
    eta = limits.groupby("S")["η"]
    spread = float((eta.max() / eta.min() - 1.0).max())
    gap = float((limits["η"] / limits["predicted"] - 1.0).abs().max())
    all_of = ", ".join(
        f"{extremes(SHAPES[name]).eta:.4f} ({name})" for name in ("S3", "S4", "S6", "S7", "S8")
    )
    first = profile.groupby("S")["E"].first()
    worst = profile[profile["step"] > 1.4 * limits["predicted"].max()].groupby("S")["E"].first()
    growing = sorted(set(rates.loc[rates["measured"] > 0.0, "S"]))
    return statement(
        "M-C1.step",
        bool(limits["η"].between(0.1, 10.0).all() and spread <= 0.01),
        f"η = 2 / max k² S^(k) is {all_of}; measured {', '.join(f'{v:.4f} ({s})' for s, v in eta.mean().items())}, "
        f"the same at ε = {' and '.join(f'{e:g}' for e in sorted(limits['ε'].unique()))} to {spread:.0e}, as predicted "
        f"to {gap:.1e}. Well above, E of the square profile is "
        f"{', '.join(f'{worst[s] / first[s]:.1f} ({s})' for s in worst.index)} times that at a small step. No "
        f"step stops the growth of clusters with {', '.join(growing)}.",
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
        bool(abs(limit - 0.5) < 1e-12),
        f"The eigenvalues of the second difference on {points} points give dt < {limit:.12g} (Δx)² for Euler's method.",
        "The limit is another one.",
    )


def _series(
    parameters: Mapping[str, Any], rates: pd.DataFrame, limits: pd.DataFrame, profile: pd.DataFrame
) -> pd.DataFrame:
    """Panels "rate" (curves), "measured" (points), "step" (E by dt / eps^2), "limit" (eta)."""
    k = np.linspace(0.0, float(parameters["wavenumbers"]), 301)
    parts = [
        pd.DataFrame({"panel": "rate", "series": name, "x": k, "y": rate(shape_function(name), k)})
        for name in parameters["lattices"]
    ]
    parts.append(pd.DataFrame({"panel": "rate", "series": "exact", "x": k, "y": -k * k}))
    for panel, frame, x, y in (
        ("measured", rates, "k = ε q", "measured"),
        ("step", profile, "step", "E"),
        ("limit", limits, "predicted", "η"),
    ):
        parts.append(
            pd.DataFrame({"panel": panel, "series": frame["S"], "x": frame[x], "y": frame[y]})
        )
    return pd.concat(parts, ignore_index=True)
