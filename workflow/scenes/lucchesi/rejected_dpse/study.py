"""DPSE, which the paper rejects without showing why: a potential that ends at the lattice's edge."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.fourier import valid_convolution
from fracparticles.run.dataset import read_run
from fracparticles.schemes import SCHEMES, Setting, dpse, riesz
from fracparticles.special.stable import central_mass, green, green_flux
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["study"]

_LARGE = 10.0  # an error this many times the exact value is large
# Relative; what (A.2) and the tail of the kernel leave out is of the order D^(-alpha).
_PREDICTED = 0.2
_LAYER = 0.1  # relative error that ends the layer at the edge


def study(inputs: Inputs) -> Result:
    """DPSE at the ends of the lattice: the solution, the rate of change, and where its error comes from.

    The second sum of DPSE runs over the particles present: at x = D it is one-sided and sees the slope of the
    potential v. The kernel's tail, kappa^beta ~ c |r|^(-beta), sets that slope: v'(D) = -M beta c D^(-alpha), M the
    total strength. With c_m the weights of (16), the error of the rate of change is then

        e = M beta c D^(-alpha) (1 / h) sum_{m >= 1} m c_m.

    The errors are called large if u is more than ten times the exact solution at |x| = D for every run of DPSE. The
    slow decay is called their cause if the error of the rate agrees with e to 20 % and falls at least tenfold when v
    is also computed at the particles next to the ends ("a different particle grid to represent v").
    """
    runs = inputs.scalars
    rows, series = [], []
    for run in runs.itertuples():
        data = read_run(run.run)
        x, u = data["x"].values, data["u"].values
        exact = np.asarray(green(x, run.t_final, 1.0 + run.beta))
        relative = np.abs(u - exact) / exact
        distance = (run.half_width - x) / (run.overlap * run.particle_spacing)
        row = {
            "scheme": run.scheme,
            "beta": run.beta,
            "C": run.truncation,
            "u / exact at |x| = D": u[-1] / exact[-1],
            "|error| at |x| = D / peak": abs(u[-1] - exact[-1]) / exact.max(),
            "error above 10 % within, in ε": distance[(x > 0.0) & (relative > _LAYER)].max(
                initial=0.0
            ),
            "relative error at 0.9 D": float(np.interp(0.9 * run.half_width, x, relative)),
            "error (48)": run.relative_l1_error,
        }
        if run.scheme == "DPSE":
            row |= _rate_at_the_edge(run)
        rows.append(row)
        if np.isclose(run.beta, inputs.parameters["beta"]) and np.isclose(
            run.truncation, inputs.parameters["truncation"]
        ):
            series.append(_edge(run.scheme, x, u, exact, distance))
    table = pd.DataFrame(rows).sort_values(["beta", "C", "scheme"])
    findings = _dpse_findings(table, list(runs["run"]))
    return Result(table, findings, pd.concat(series, ignore_index=True))


def _rate_at_the_edge(run: Any) -> dict[str, float]:
    """du/dt of the exact initial data at x = D less its exact value, four ways."""
    alpha, n = 1.0 + run.beta, round(run.half_width / run.particle_spacing)
    h, s, order = run.particle_spacing, run.overlap, int(run.order)
    setting = Setting(n=n, spacing=h, alpha=alpha, order=order, overlap=s)
    x = np.arange(-n, n + 1) * h
    u = np.asarray(green(x, run.t_initial, alpha))
    # u_t = -Q_x at the end, from the exact flux one spacing to either side
    sides = np.asarray(green_flux(run.half_width + np.array([-h, h]), run.t_initial, alpha))
    exact = -(sides[1] - sides[0]) / (2.0 * h)

    reach = BandedConvolution.reach(s, order)
    c = dpse.laplacian_weights(np.arange(reach + 1.0), setting)
    mass = central_mass(run.half_width, run.t_initial, alpha)
    slope = mass * run.beta * riesz.potential_constant(alpha) * run.half_width**-alpha
    return {
        "error of du/dt at D": SCHEMES["DPSE"].operator(setting).apply(u)[-1] - exact,
        "the same, from the tail of κ": slope / h * (np.arange(reach + 1.0) @ c),
        "the same, v continued": _rate_with_continued_potential(setting, u, c) - exact,
        "the same, FPSE": SCHEMES["FPSE"].operator(setting).apply(u)[-1] - exact,
    }


def _rate_with_continued_potential(setting: Setting, u: np.ndarray, c: np.ndarray) -> float:
    """(16) at x = D with v of (13) on `reach` particles beyond the end as well."""
    reach, h = c.size - 1, setting.spacing
    offsets = np.arange(-2 * setting.n - reach, 2 * setting.n + reach + 1.0)
    b = dpse.potential_weights(offsets, setting)
    v = h ** (2.0 - setting.alpha) * valid_convolution(u, b)[-2 * reach - 1 :]
    stencil = np.concatenate([c[:0:-1], c])
    return float(stencil @ (v - v[reach])) / h**2


def _edge(
    scheme: str, x: np.ndarray, u: np.ndarray, exact: np.ndarray, distance: np.ndarray
) -> pd.DataFrame:
    """The profile of the last thirty smoothing lengths, and the relative error at 150 points of log distance."""
    last = np.flatnonzero((distance <= 30.0) & (x > 0.0))
    wanted = np.geomspace(distance[-2], distance[x > 0.0].max(), 150)
    spread = np.unique(x.size - 1 - np.searchsorted(distance[::-1], wanted))
    relative = np.abs(u - exact) / exact
    parts = [
        {"panel": "profile", "x": distance[last], "y": u[last], "exact": exact[last]},
        {"panel": "relative", "x": distance[spread], "y": relative[spread], "exact": exact[spread]},
    ]
    return pd.concat([pd.DataFrame(part).assign(scheme=scheme) for part in parts])


def _dpse_findings(table: pd.DataFrame, files: list[str]) -> list[Finding]:
    ours = table[table["scheme"] == "DPSE"]
    kpse = table[table["scheme"] == "KPSE"]
    ratio, other = ours["u / exact at |x| = D"], kpse["u / exact at |x| = D"]
    error, tail = ours["error of du/dt at D"], ours["the same, from the tail of κ"]
    gain = (error / ours["the same, v continued"]).abs()
    agreement = (tail / error - 1.0).abs()
    fpse_deviation = (ours["the same, FPSE"] / error - 1.0).abs()
    return [
        statement(
            "L-C14.edges",
            bool((ratio > _LARGE).all()),
            f"At |x| = D, u of DPSE is {ratio.min():.3g} to {ratio.max():.3g} times the exact solution, that of KPSE "
            f"{other.min():.4g} to {other.max():.4g} times.",
            "The errors at the edge stay below ten times the solution there.",
            files,
        ),
        statement(
            "L-C14.cause",
            bool((agreement < _PREDICTED).all() and (gain > 10.0).all()),
            f"The tail of kappa predicts the error of du/dt at the edge to {100.0 * agreement.max():.2g} % at worst; "
            f"with v computed at the particles next to the ends as well it falls {gain.min():.3g} to {gain.max():.3g} "
            f"times. FPSE, whose F is the gradient of kappa, has the same to {100.0 * fpse_deviation.max():.2g} %.",
            "The tail of the kernel does not account for the error at the edge.",
            files,
        ),
    ]
