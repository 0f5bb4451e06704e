"""DPSE, which the paper rejects without showing why: a potential that ends at the lattice's edge."""

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.fourier import valid_convolution
from fracparticles.run.dataset import read_run
from fracparticles.schemes import SCHEMES, Setting, dpse, riesz
from fracparticles.special.stable import central_mass, green, green_flux
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

NEEDS = {"scheme": ["DPSE", "FPSE", "KPSE"]}

_LAYER = 0.1  # relative error that ends the layer at the edge
_RATIO, _RATE, _TAIL = "u / exact at |x| = D", "error of du/dt at D", "predicted from the tail of κ"
_WIDTH, _INSIDE = "error above 10 % within, in ε", "relative error at 0.9 D"
_CONTINUED, _FPSE = "with v continued", "error of du/dt, FPSE"


def study(inputs: Inputs) -> Result:
    """DPSE at the ends of the lattice: the solution, the rate of change, and where its error comes from.

    The second sum of DPSE runs over the particles present: at x = D it is one-sided and sees the slope of the
    potential v. The kernel's tail, kappa^beta ~ c |r|^(-beta), sets that slope: v'(D) = -M beta c D^(-alpha), M the
    total strength. With c_m the weights of (16), the error of the rate of change is then

        e = M beta c D^(-alpha) (1 / h) sum_{m >= 1} m c_m.

    It is measured as it is, and with v computed at the particles next to the ends as well ("a different particle grid
    to represent v").
    """
    runs, panels, rows = inputs.scalars, Panels(), []
    for run in runs.itertuples():
        data = read_run(run.run)
        x, u = data["x"].values, data["u"].values
        exact = np.asarray(green(x, run.t_final, 1.0 + run.beta))
        error, right = np.abs(u - exact) / exact, x > 0.0
        distance = (run.half_width - x) / (run.overlap * run.particle_spacing)
        row = {
            "scheme": run.scheme,
            "beta": run.beta,
            "C": run.truncation,
            _RATIO: u[-1] / exact[-1],
            "|error| at |x| = D / peak": abs(u[-1] - exact[-1]) / exact.max(),
            _WIDTH: distance[right & (error > _LAYER)].max(initial=0.0),
            _INSIDE: float(np.interp(0.9 * run.half_width, x, error)),
            "error (48)": run.relative_l1_error,
        }
        rows.append(row | (_rate_at_the_edge(run) if run.scheme == "DPSE" else {}))
        if np.isclose(run.truncation, runs["truncation"].max()):
            # The last thirty smoothing lengths, and 150 points of log distance.
            last = np.flatnonzero((distance <= 30.0) & right)
            panels.add("profile", run.scheme, distance[last], u[last], exact=exact[last])
            wanted = np.geomspace(distance[-2], distance[right].max(), 150)
            spread = np.unique(x.size - 1 - np.searchsorted(distance[::-1], wanted))
            panels.add("relative", run.scheme, distance[spread], error[spread])
    table = pd.DataFrame(rows).sort_values(["beta", "C", "scheme"])
    return Result(table, inputs.judged(_findings(table, list(runs["run"]))), panels.frame)


def _rate_at_the_edge(run: Any) -> dict[str, float]:
    """du/dt of the exact initial data at x = D less its exact value, four ways."""
    alpha, n = 1.0 + run.beta, round(run.half_width / run.particle_spacing)
    h, s, order = run.particle_spacing, run.overlap, int(run.order)
    setting = Setting(n=n, spacing=h, alpha=alpha, order=order, overlap=s)
    u = np.asarray(green(setting.x, run.t_initial, alpha))
    # u_t = -Q_x at the end, from the exact flux one spacing to either side
    sides = np.asarray(green_flux(run.half_width + np.array([-h, h]), run.t_initial, alpha))
    exact = -(sides[1] - sides[0]) / (2.0 * h)

    m = np.arange(BandedConvolution.reach(s, order) + 1.0)
    c = dpse.laplacian_weights(m, setting)
    mass = central_mass(run.half_width, run.t_initial, alpha)
    slope = mass * run.beta * riesz.potential_constant(alpha) * run.half_width**-alpha
    rate = {name: SCHEMES[name].operator(setting).apply(u)[-1] - exact for name in ("DPSE", "FPSE")}
    return {
        _RATE: rate["DPSE"],
        _TAIL: slope / h * (m @ c),
        _CONTINUED: _rate_with_continued_potential(setting, u, c) - exact,
        _FPSE: rate["FPSE"],
    }


def _rate_with_continued_potential(setting: Setting, u: np.ndarray, c: np.ndarray) -> float:
    """(16) at x = D with v of (13) on `reach` particles beyond the end as well."""
    reach, h = c.size - 1, setting.spacing
    offsets = np.arange(-2 * setting.n - reach, 2 * setting.n + reach + 1.0)
    b = dpse.potential_weights(offsets, setting)
    v = h ** (2.0 - setting.alpha) * valid_convolution(u, b)[-2 * reach - 1 :]
    stencil = np.concatenate([c[:0:-1], c])
    return float(stencil @ (v - v[reach])) / h**2


def _findings(table: pd.DataFrame, files: list[str]) -> list[Finding]:
    by_case = {name: part.set_index(["beta", "C"]) for name, part in table.groupby("scheme")}
    ours, error = by_case["DPSE"], by_case["DPSE"][_RATE]
    edge = {name: (part[_RATIO] - 1.0).abs() for name, part in by_case.items()}
    return [
        measured("L-C14.edges", runs=files, error=edge["DPSE"], kpse=edge["KPSE"]),
        measured(
            "L-C14.cause",
            runs=files,
            difference=(ours[_TAIL] / error - 1.0).abs(),
            fpse=(ours[_FPSE] / error - 1.0).abs(),
        ),
        measured(
            "L-C14.mitigation",
            runs=files,
            ratio=edge["FPSE"] / edge["DPSE"],
            inside=by_case["FPSE"][_INSIDE] / ours[_INSIDE],
            width=by_case["FPSE"][_WIDTH] / ours[_WIDTH],
        ),
        measured("L-C14.remedy", runs=files, gain=(error / ours[_CONTINUED]).abs()),
    ]
