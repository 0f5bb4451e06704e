"""The reference case, Fig. 2 and Sec. 4.1: exact and computed solutions at the peak and at the boundary."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from fracparticles.run.dataset import read_run
from fracparticles.special.stable import central_mass, green, mean_radius
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, spelled, statement, value
from scenes.lucchesi.lucchesi_figure_2.dvm_domain import lagrangian_domain

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["study"]

NEEDS = {
    "scheme": ["DD", "FPSE", "KPSE", "GPSE", "FD", "DVM"],
    "exterior": ["truncated", "open"],
    "remeshing": ["none"],
}

_SMALL = 0.01  # relative error that a plot does not show
_POINTS = 400  # of each curve in a window, at most
_PEAK, _DECAY = "relative error at x = 0", "largest relative error, |x| < 5"
_INSIDE, _LAST = "largest relative error, |x| < D/2", "relative error at |x| = D"
_ABSOLUTE = "largest absolute error / peak"
_ABSOLUTE_EDGE = "largest absolute error at the boundary / peak"


def study(
    inputs: Inputs,
    *,
    windows: list[list[float]],
    shown_spacing: float,
    printed_particles: int,
    mass_beta: list[float],
) -> Result:
    """Errors of each scheme at the peak, inside and at the boundary; the two `windows` of Fig. 2 as series.

    Every scheme is measured on its own lattice, |x| <= D: DVM's is the smaller one. For DVM, u is the field (7).
    Near the boundary is beyond that part of D at which the second window begins. Runs with another than
    `shown_spacing` are those about the domain of DVM. The paper prints the number of its particles; the mass within
    5 R_alpha is given for each of `mass_beta`.
    """
    main = replace(inputs, runs=tuple(inputs.select(spacing=shown_spacing)["run"]))
    first = main.open(scheme="KPSE", exterior="truncated")
    alpha, time, half = (
        1.0 + float(first["beta"]),
        float(first["t_final"]),
        float(first["half_width"]),
    )
    edge = windows[-1][0] / half
    rows, series = [], []
    for run in map(read_run, main.runs):
        scheme, exterior = _name(run), str(run["exterior"].values)
        rows.append({"scheme": scheme, "exterior": exterior, **_errors(run, edge)})
        series += _windows(scheme, exterior, run["x"].values, run["u"].values, windows)
    x = first["x"].values
    series += _windows("exact", "", x, np.asarray(green(x, time, alpha)), windows)
    table = pd.DataFrame(rows)
    start = np.asarray(green(half * np.array([0.5, 1.0]), float(first["t_initial"]), alpha))
    findings = [
        *_shape(main, table, alpha, float(np.log2(start[1] / start[0]))),
        *_setting(main, printed_particles),
        *(_mass(beta, time) for beta in mass_beta),
        *lagrangian_domain(inputs, main, table, windows[-1]),
    ]
    return Result(table, findings, pd.concat(series, ignore_index=True))


def _name(run: xr.Dataset) -> str:
    """The scheme, for DVM with its remeshing."""
    scheme = str(run["scheme"].values)
    return f"DVM, {run['remeshing'].values}" if scheme == "DVM" else scheme


def _errors(run: xr.Dataset, edge: float) -> dict[str, float]:
    x, u, width = run["x"].values, run["u"].values, float(run["half_width"])
    exact = np.asarray(green(x, float(run["t_final"]), 1.0 + float(run["beta"])))
    error = np.abs(u - exact)
    relative, near = error / exact, np.abs(x) >= edge * width
    return {
        _PEAK: relative[x.size // 2],
        _DECAY: relative[np.abs(x) < 5.0].max(),
        _INSIDE: relative[np.abs(x) < 0.5 * width].max(),
        "largest relative error, |x| < 0.9 D": relative[np.abs(x) < 0.9 * width].max(),
        f"median relative error, |x| > {edge:.3g} D": np.median(relative[near]),
        _ABSOLUTE: error.max() / exact.max(),
        _ABSOLUTE_EDGE: error[near].max() / exact.max(),
        _LAST: relative[-1],
        "error (48)": float(run["relative_l1_error"]),
    }


def _windows(scheme: str, exterior: str, x: np.ndarray, u: np.ndarray, windows: list) -> list:
    parts = []
    for panel, (low, high) in enumerate(windows):
        inside = np.flatnonzero((x >= low) & (x <= high))
        kept = inside[:: max(1, inside.size // _POINTS)]
        curve = {"panel": panel, "scheme": scheme, "exterior": exterior, "x": x[kept], "y": u[kept]}
        parts.append(pd.DataFrame(curve))
    return parts


def _shape(inputs: Inputs, table: pd.DataFrame, alpha: float, exponent: float) -> list[Finding]:
    """What the paper says of the errors at the peak, inside and at the boundary."""
    runs = inputs.scalars["run"]
    shown = table[table["scheme"] != "DVM, none"]  # the paper remeshes
    truncated = shown[shown["exterior"] == "truncated"].set_index("scheme")
    opened = table[table["exterior"] == "open"].set_index("scheme")
    boundary = next(name for name in table if name.startswith("median"))
    inside, last, edge = truncated[_INSIDE], truncated[_LAST], truncated[boundary]
    inside_, last_, edge_ = (spelled(errors, ".2g") for errors in (inside, last, edge))
    gpse = float(inputs.select(scheme="GPSE", exterior="truncated")["overlap"].iloc[0])
    # The ends of DVM's lattice are elsewhere, where the solution is a thousand times as large.
    here = truncated[~truncated.index.str.startswith("DVM")]
    ratio = (here[_ABSOLUTE_EDGE] / here[_ABSOLUTE_EDGE]["FD"]).drop("FD")
    gain = (edge[opened.index] / opened[boundary]).min()
    small = [
        ("L-F2.peak", _PEAK, "Relative error at x = 0"),
        ("L-F2.decay", _DECAY, "Largest relative error for |x| < 5, the window of the figure"),
        ("L-F2.absolute_error", _ABSOLUTE, "Largest point-wise error over the peak value"),
    ]
    findings = []
    for claim, column, words in small:
        error = truncated[column]
        evidence = f"{words}: {spelled(error, '.2g')}."
        holds = (error < _SMALL).all()
        findings.append(statement(claim, holds, evidence, "Not on this lattice.", runs))
    return [
        *findings,
        statement(
            "L-F2.interior",
            (inside < 0.1 * last).all(),
            f"Largest relative error for |x| < D/2: {inside_}; at |x| = D: {last_}.",
            "The error inside is not small against that near the boundary.",
            runs,
        ),
        statement(
            "L-F2.relative_error",
            ((edge > inside) & (last > edge)).all(),
            f"Largest relative error for |x| < D/2: {inside_}; median near the boundary: {edge_}; at "
            f"|x| = D: {last_}.",
            "The relative error does not grow towards the boundary.",
            runs,
        ),
        statement(
            "L-F2.initial_decay",
            abs(exponent + alpha) < 0.05,
            f"Between D/2 and D the initial condition falls like |x|^{exponent:.4f}; alpha = {alpha:g}.",
            "The fundamental solution falls like |x|^(-1-alpha), the leading term of (A.2); |x|^-alpha is the decay of "
            "its tail mass.",
        ),
        statement(
            "L-F2.gpse_epsilon",
            abs(gpse / 2.0 - 1.0) < 0.25,
            f"epsilon / h = {gpse:.3f} by (40), against 2.",
            "The printed step gives another overlap.",
        ),
        statement(
            "L-C2.dd_fpse_boundary",
            edge[["DD", "FPSE"]].min() > edge[["KPSE", "GPSE"]].max(),
            f"Median relative error near the boundary: {spelled(here[boundary], '.2g')}.",
            "Near the boundary the relative errors of the four methods are not separated like this.",
            runs,
        ),
        statement(
            "L-C2.fd_comparable",
            ((ratio < 10.0) & (ratio > 0.1)).all(),
            f"Largest absolute error near the boundary, over that of FD: {spelled(ratio, '.2g')}.",
            "FPSE has a layer at the ends of the lattice, a few smoothing lengths thick, where its error is orders of "
            "magnitude above that of the others.",
            runs,
        ),
        statement(
            "L-C2.not_instability",
            gain > 10.0,
            f"With the same step, the open exterior lowers the median error near the boundary {gain:.3g} times at "
            "least; every step is inside the stability interval.",
            "The open exterior leaves the boundary error.",
            runs,
        ),
    ]


def _setting(inputs: Inputs, printed: int) -> list[Finding]:
    run = inputs.select(scheme="KPSE", exterior="truncated").iloc[0]
    half, ours = (
        float(run["half_width"]),
        2 * round(run["half_width"] / run["particle_spacing"]) + 1,
    )
    rounded = "The print rounds R_alpha to three decimals (Table A.4) before it multiplies by 160."
    truncates = "2 D / (N - 1) with the printed N; the print truncates."
    return [
        value("L-C1.D", half, rounded, [run["run"]]),
        value("L-C1.h", 2.0 * half / (printed - 1), truncates, [run["run"]]),
        statement(
            "L-C1.odd_number",
            printed % 2 == 1,
            f"N = {printed} is printed; we use {ours}.",
            "64000 is even: no particle lies at x = 0 then. With one more, h is printed the same.",
        ),
    ]


def _mass(beta: float, time: float) -> Finding:
    alpha = 1.0 + beta
    mass = 100.0 * float(central_mass(5.0 * mean_radius(alpha), time, alpha))
    reason = f"The print says roughly, for every beta; at beta = {beta:g} it is {mass:.2f} %."
    return value(f"L-C1.mass.beta{beta:g}", mass, reason)
