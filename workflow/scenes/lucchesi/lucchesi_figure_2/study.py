"""The reference case, Fig. 2 and Sec. 4.1: exact and computed solutions at the peak and at the boundary."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from fracparticles.run.dataset import read_run
from fracparticles.schemes.stability import stability_limit
from fracparticles.special.stable import central_mass, green, mean_radius
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from scenes.lucchesi.lucchesi_figure_2.dvm_domain import lagrangian_domain

if TYPE_CHECKING:
    import xarray as xr

NEEDS = {
    "scheme": ["DD", "FPSE", "KPSE", "GPSE", "FD", "DVM"],
    "exterior": ["truncated", "open"],
    "remeshing": ["none"],
}

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
    """Measure the errors of each scheme at the peak, inside and at the boundary; give the two `windows` of Fig. 2.

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
    findings = [
        *_errors_judged(main, table),
        *_truncation(main, edge),
        *_initial(x, float(first["t_initial"]), alpha, main.runs),
        *_setting(main, table, printed_particles),
        *(_mass(beta, time) for beta in mass_beta),
        *lagrangian_domain(inputs, main, table, windows),
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


def _readings(table: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """The truncated errors by scheme, once for each remeshing that the text can be read to mean."""
    shown = table[table["exterior"] == "truncated"]
    moving = shown["scheme"].str.startswith("DVM")
    names = [name for name in shown.loc[moving, "scheme"] if name != "DVM, none"]
    return {
        f"DVM remeshed by {name.removeprefix('DVM, ')}": pd.concat(
            [shown[~moving], shown[shown["scheme"] == name].assign(scheme="DVM")]
        ).set_index("scheme")
        for name in names
    }


def _errors_judged(main: Inputs, table: pd.DataFrame) -> Iterator[Finding]:
    """What the paper says of the errors at the peak, inside and at the boundary."""
    boundary = next(name for name in table if name.startswith("median"))
    (_, judged), *others = _readings(table).items()

    def by_scheme(claim: str, numbers: Callable[[pd.DataFrame], dict[str, Any]]) -> Finding:
        rest = {name: numbers(errors) for name, errors in others}
        return measured(claim, runs=main.runs, others=rest, **numbers(judged))

    yield by_scheme("L-F2.peak", lambda errors: {"error": errors[_PEAK]})
    yield by_scheme("L-F2.decay", lambda errors: {"error": errors[_DECAY]})
    yield by_scheme("L-F2.absolute_error", lambda errors: {"error": errors[_ABSOLUTE]})
    yield by_scheme(
        "L-F2.interior",
        lambda errors: {"inside": errors[_INSIDE], "growth": errors[_LAST] / errors[_INSIDE]},
    )
    yield by_scheme(
        "L-F2.relative_error",
        lambda errors: {
            "outwards": errors[boundary] / errors[_INSIDE],
            "onwards": errors[_LAST] / errors[boundary],
        },
    )

    # The ends of DVM's lattice are elsewhere, where the solution is a thousand times as large.
    here = judged.drop("DVM")

    def over_exchange(error: pd.Series) -> pd.Series:
        return error[["DD", "FPSE"]] / error[["KPSE", "GPSE"]].max()

    def against_fd(error: pd.Series) -> pd.Series:
        ratio = (error / error["FD"]).drop("FD")
        return ratio.where(ratio > 1.0, 1.0 / ratio)

    for claim, ratio in (
        ("L-C2.dd_fpse_boundary", over_exchange),
        ("L-C2.fd_comparable", against_fd),
    ):
        largest = {"ratio": ratio(here[_ABSOLUTE_EDGE])}
        yield measured(
            claim,
            runs=main.runs,
            others={"the largest absolute error instead of the median relative one": largest},
            ratio=ratio(here[boundary]),
            error=here[boundary],
            largest=largest["ratio"],
        )


def _truncation(main: Inputs, edge: float) -> list[Finding]:
    """What the truncation adds: the change of u from the open exterior, with everything else the same."""
    opened = main.select(exterior="open")["scheme"]
    rows, files = {}, []
    for scheme in opened:
        cut, free = (main.open(scheme=scheme, exterior=e) for e in ("truncated", "open"))
        x, t, width = cut["x"].values, float(cut["t_final"]), float(cut["half_width"])
        exact = np.asarray(green(x, t, 1.0 + float(cut["beta"])))
        change = np.abs(cut["u"].values - free["u"].values)
        near, inside = np.abs(x) >= edge * width, np.abs(x) < 0.5 * width
        rows[scheme] = {
            "edge": np.median((change / exact)[near]),
            "inside": (change / exact)[inside].max(),
            "largest": (change / exact).max(),
            "absolute": change[near].max() / change[inside].max(),
            "left": np.median(np.abs(free["u"].values / exact - 1.0)[near]),
        }
        files += list(main.select(scheme=scheme)["run"])
    found = pd.DataFrame(rows).T
    ratio = found["edge"] / found["inside"]
    absolute = {"the absolute change": {"ratio": found["absolute"]}}
    explicit = main.select(exterior="truncated").set_index("scheme").loc[["DD", "FPSE", "KPSE"]]
    limit = [stability_limit(s, beta) for s, beta in explicit["beta"].items()]
    step = explicit["dt"] / explicit["particle_spacing"] ** (1.0 + explicit["beta"]) / limit
    return [
        measured("L-C2.not_instability", runs=files, step=step, gain=found["edge"] / found["left"]),
        measured("L-C2.truncation_at_edge", runs=files, others=absolute, ratio=ratio),
        measured(
            "L-F2.substantial", runs=files, largest=found["largest"].max(), each=found["largest"]
        ),
        measured("L-F2.mostly_boundaries", runs=files, others=absolute, ratio=ratio),
    ]


def _initial(x: np.ndarray, start: float, alpha: float, runs: Sequence[str]) -> list[Finding]:
    """The initial condition, the fundamental solution at t = 0.5, on the lattice and between D/2 and D."""
    u = np.asarray(green(x, start, alpha))
    far = np.asarray(green(x[-1] * np.array([0.5, 1.0]), start, alpha))
    return [
        measured(
            "L-F2.initial_shape",
            runs=runs,
            asymmetry=np.abs(u - u[::-1]).max() / u.max(),
            step=np.diff(u[x >= 0.0]).max(),
        ),
        measured("L-F2.initial_decay", runs=runs, exponent=np.log2(far[1] / far[0])),
    ]


def _setting(main: Inputs, table: pd.DataFrame, printed: int) -> list[Finding]:
    """The lattice and the step of GPSE: D, h, N and epsilon as Sec. 4.1 prints them."""
    run = main.select(scheme="KPSE", exterior="truncated").iloc[0]
    gpse = main.select(scheme="GPSE", exterior="truncated").iloc[0]
    half, alpha = float(run["half_width"]), 1.0 + float(run["beta"])
    odd = printed + 1 - printed % 2
    spacing = 2.0 * half / (odd - 1)
    peak, beside = np.asarray(green(np.array([0.0, 0.5 * spacing]), float(run["t_final"]), alpha))
    error = table.set_index(["scheme", "exterior"])[_PEAK]
    return [
        measured("L-C1.D", runs=[run["run"]], ours=half),
        measured("L-C1.h", runs=[run["run"]], ours=2.0 * half / (printed - 1)),
        measured(
            "L-C1.odd_number",
            runs=[run["run"]],
            printed=printed,
            spacing=abs(spacing * (printed - 1) / (2.0 * half) - 1.0),
            ours=2 * round(half / run["particle_spacing"]) + 1,
            missed=1.0 - beside / peak,
            share=(1.0 - beside / peak) / error["KPSE", "truncated"],
        ),
        measured(
            "L-F2.gpse_epsilon",
            runs=[gpse["run"]],
            away=abs(gpse["overlap"] / 2.0 - 1.0),
            overlap=gpse["overlap"],
            step=(2.0 * gpse["particle_spacing"]) ** alpha,
        ),
    ]


def _mass(beta: float, time: float) -> Finding:
    """The share of the mass within 5 R_alpha, and how far it is from the printed 97 %."""
    alpha = 1.0 + beta
    mass = 100.0 * float(central_mass(5.0 * mean_radius(alpha), time, alpha))
    return measured(
        f"L-C1.mass.beta{beta:g}", away=abs(mass / 97.0 - 1.0), mass=mass, outside=100.0 - mass
    )
