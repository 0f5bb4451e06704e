"""The scheme of Eq. (29), which the paper rejects for its instability: eigenvalues above zero, runs that grow."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles import time as integrators
from fracparticles.errors import NonFiniteSolution
from fracparticles.kernels.families import kernel
from fracparticles.run.case import Case
from fracparticles.run.dataset import read_run
from fracparticles.run.solver import compute, initial_strengths
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import scheme_matrix
from fracparticles.special.stable import green
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

NEEDS = {"scheme": ["PSE29", "DD"]}

_NODES = np.linspace(0.0, 20.0, 4001)  # r; G is smooth on the scale 1
_OVERLAP = 2.0
_SHOWN = 5  # of the steps, one
_EDGE = "|u| / exact at |x| = D"


def study(inputs: Inputs, *, shown_beta: float, dense: int, history: dict[str, Any]) -> Result:
    """Scheme (29): the kernel, the spectrum, the growth and the errors.

    On a bounded lattice -sum_j G_(i-j) > 0 stays on the diagonal near the ends, where half of the negative middle of G
    is left alone with the positive tail. The greatest eigenvalue is a number of the kernel alone, lambda h^alpha / D,
    and its mode a layer a few epsilon thick: in time T the solution grows by exp(lambda T), without bound as h -> 0.

    `dense` is the number of particles of the spectrum; `history` are the half-width and the spacings of the runs whose
    growth is followed, and by how many powers of e.
    """
    runs, near = inputs.scalars, _NODES <= 4.0
    betas, panels = sorted(runs["beta"].unique()), Panels()
    kernels = each(lambda b: np.asarray(kernel("G", _NODES, 1.0 + b)), beta=betas)
    greatest = each(lambda b: float(_spectrum("PSE29", b, dense)[-1]), beta=betas)
    for beta, G in kernels.items():
        panels.add("kernel", f"{beta:g}", _NODES[near], G[near])
    spectra = {name: _spectrum(name, shown_beta, dense) for name in ("PSE29", "DD")}
    for name, values in spectra.items():
        panels.add("spectrum", name, np.arange(1, dense + 1) / dense, values)
    table = _table(runs, greatest)
    deviation = _follow(panels, shown_beta, spectra["PSE29"][-1], history)
    predicted, message = _blow_up(shown_beta)
    findings = [
        _kernel(kernels),
        _errors(table, list(runs["run"])),
        measured(
            "L-C15.instability",
            eigenvalue=greatest,
            deviation=deviation,
            predicted=predicted,
            message=message,
        ),
    ]
    return Result(table, inputs.judged(findings), panels.frame)


def _spectrum(name: str, beta: float, size: int) -> np.ndarray:
    """The eigenvalues of A h^alpha / D, ascending; A is symmetric."""
    setting = Setting(n=size // 2, spacing=1.0, alpha=1.0 + beta, overlap=_OVERLAP)
    return np.linalg.eigvalsh(scheme_matrix(name, setting))


def _follow(panels: Panels, beta: float, growth: float, history: Mapping[str, Any]) -> float:
    """Draw |u(D, t)| of RK2 in time until it must have grown by exp(`foldings`), and the predicted growth.

    The step is a fiftieth of the growth time: p(lambda dt) is then exp(lambda dt) to 1e-6. Returns the largest
    relative deviation of the measured rates.
    """
    deviations, half_width = [], history["half_width"]
    rk2 = integrators.STEP_POLYNOMIALS["rk2"]
    for h in history["spacing"]:
        n = round(half_width / h)
        setting = Setting(n=n, spacing=half_width / n, alpha=1.0 + beta, overlap=_OVERLAP)
        rate, steps = growth * setting.rate, round(50.0 * history["foldings"])
        operator = SCHEMES["PSE29"].operator(setting)
        u = np.asarray(green(setting.x, 0.5, 1.0 + beta))
        edge = [u[-1]]
        for _ in range(steps):
            u = integrators.step(operator, rk2, 0.02 / rate, 1, u)
            edge.append(u[-1])
        time, y = 0.5 + 0.02 / rate * np.arange(steps + 1), np.abs(edge)
        predicted = y[-1] * np.exp(rate * (time - time[-1]))
        late = time > time[0] + 0.75 * (time[-1] - time[0])
        deviations.append(np.polyfit(time[late], np.log(y[late]), 1)[0] / rate - 1.0)
        shown = slice(None, None, _SHOWN)
        panels.add("history", f"{h:.3g}", time[shown], y[shown], predicted=predicted[shown])
    return float(np.abs(deviations).max())


def _blow_up(beta: float) -> tuple[float, str]:
    """Run (29) on a small lattice until it overflows: the step predicted from the growing modes, and the message."""
    case = Case(
        scheme="PSE29", beta=beta, half_width=10.0, spacing=0.2, overlap=_OVERLAP, dt=0.02, t_final=1000.0,
        evaluation="stepping", store="metrics",
    )  # fmt: skip
    values, modes = np.linalg.eigh(scheme_matrix("PSE29", case.setting))
    amplitudes = modes.T @ initial_strengths(case)[0]
    factor = np.log(integrators.STEP_POLYNOMIALS["rk2"](values * case.time_step))
    largest = np.log(np.abs(amplitudes) * np.abs(modes).max(axis=0) + np.finfo(float).tiny)
    growing = factor > 0.0
    steps = (np.log(np.finfo(float).max) - largest[growing]) / factor[growing]
    try:
        compute(case)
        message = "no overflow"
    except NonFiniteSolution as error:
        message = str(error).split(":")[1].strip()
    return float(steps.min()), message


def _table(runs: pd.DataFrame, greatest: pd.Series) -> pd.DataFrame:
    rows = []
    for (beta, h), pair in runs.groupby(["beta", "particle_spacing"]):
        pair = pair.set_index("scheme")
        run = pair.loc["PSE29"]
        exact = float(green(run["half_width"], run["t_final"], 1.0 + beta))
        rate = greatest[beta] * run["diffusivity"] / h ** (1.0 + beta)
        time = run["t_final"] - run["t_initial"]
        ours, dd = pair["relative_l1_error"][["PSE29", "DD"]]
        row = {
            "beta": beta,
            "h": h,
            "greatest eigenvalue, λ h^α / D": greatest[beta],
            "λ": rate,
            "log10 of the growth exp(λ T)": rate * time / np.log(10.0),
            _EDGE: abs(read_run(run["run"])["u"].values[-1]) / exact,
            "error (48) of (29)": ours,
            "error (48) of DD": dd,
            "ratio": ours / dd,
        }
        rows.append(row)
    return pd.DataFrame(rows).sort_values(["beta", "h"], ascending=[True, False])


def _kernel(kernels: pd.Series) -> Finding:
    """G(0), the greatest value, where it lies, and how often G turns."""
    return measured(
        "L-C15.kernel",
        origin=kernels.map(lambda G: G[0]),
        greatest=kernels.map(np.max),
        turns=kernels.map(lambda G: np.count_nonzero(np.diff(np.sign(np.diff(G))))),
        place=kernels.map(lambda G: _NODES[G.argmax()]),
    )


def _errors(table: pd.DataFrame, files: list[str]) -> Finding:
    coarsest, finest = (table.groupby("beta").agg(which) for which in ("first", "last"))
    numbers = {"ratio": finest["ratio"], "edge": finest[_EDGE]}
    numbers |= {"coarse": coarsest["ratio"], "h": finest["h"]}
    return measured("L-C15.errors", runs=files, **numbers)
