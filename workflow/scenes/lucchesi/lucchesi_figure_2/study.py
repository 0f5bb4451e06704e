"""The reference case, Fig. 2 and Sec. 4.1: exact and computed solutions at the peak and at the boundary."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from fracparticles.run.dataset import read_run
from fracparticles.schemes.stability import stability_limit
from fracparticles.special.stable import central_mass, green, mean_radius
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels, pick
from scenes.lucchesi.lucchesi_figure_2.dvm_domain import lagrangian_domain

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
    edge = windows[-1][0] / float(first["half_width"])
    rows, panels = [], Panels()
    for run in map(read_run, main.runs):
        key = {"scheme": _name(run), "exterior": str(run["exterior"].values)}
        rows.append({**key, **_errors(run, edge)})
        _draw(panels, windows, key, run["x"].values, run["u"].values)
    x, exact = first["x"].values, _exact(first)
    _draw(panels, windows, {"scheme": "exact", "exterior": ""}, x, exact)
    table = pd.DataFrame(rows)
    start = np.asarray(green(x, float(first["t_initial"]), 1.0 + float(first["beta"])))
    findings = [
        *_errors_judged(main, table),
        *_truncation(main, edge),
        *_initial(first, start, main.runs),
        *_setting(main, table, printed_particles),
        *(_mass(beta, float(first["t_final"])) for beta in mass_beta),
        *lagrangian_domain(inputs, main, table, windows),
    ]
    return Result(table, findings, panels.frame)


def _name(run: xr.Dataset) -> str:
    """The scheme, for DVM with its remeshing."""
    scheme = str(run["scheme"].values)
    return f"DVM, {run['remeshing'].values}" if scheme == "DVM" else scheme


def _exact(run: xr.Dataset) -> np.ndarray:
    return np.asarray(green(run["x"].values, float(run["t_final"]), 1.0 + float(run["beta"])))


def _errors(run: xr.Dataset, edge: float) -> dict[str, float]:
    x, exact, width = run["x"].values, _exact(run), float(run["half_width"])
    error = np.abs(run["u"].values - exact)
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


def _draw(
    panels: Panels, windows: list[list[float]], key: dict[str, str], x: np.ndarray, u: np.ndarray
) -> None:
    for panel, (low, high) in enumerate(windows):
        inside = np.flatnonzero((x >= low) & (x <= high))
        kept = inside[:: max(1, inside.size // _POINTS)]
        panels.add(panel, **key, x=x[kept], y=u[kept])


def _readings(table: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """The truncated errors by scheme, once for each remeshing that the text can be read to mean."""
    shown = pick(table, exterior="truncated")
    moving = shown["scheme"].str.startswith("DVM")
    readings = {}
    for name in shown.loc[moving, "scheme"]:
        if name != "DVM, none":
            both = [shown[~moving], pick(shown, scheme=name).assign(scheme="DVM")]
            title = name.replace("DVM, ", "DVM remeshed by ")
            readings[title] = pd.concat(both).set_index("scheme")
    return readings


def _errors_judged(main: Inputs, table: pd.DataFrame) -> Iterator[Finding]:
    """What the paper says of the errors at the peak, inside and at the boundary."""
    boundary = next(name for name in table if name.startswith("median"))
    (_, judged), *others = _readings(table).items()

    def by_scheme(claim: str, numbers: Callable[[pd.DataFrame], dict[str, Any]]) -> Finding:
        rest = {name: numbers(errors) for name, errors in others}
        return measured(claim, runs=main.runs, others=rest, **numbers(judged))

    def inside(e: pd.DataFrame) -> dict[str, Any]:
        return {"inside": e[_INSIDE], "growth": e[_LAST] / e[_INSIDE]}

    def outwards(e: pd.DataFrame) -> dict[str, Any]:
        return {"outwards": e[boundary] / e[_INSIDE], "onwards": e[_LAST] / e[boundary]}

    yield by_scheme("L-F2.peak", lambda e: {"error": e[_PEAK]})
    yield by_scheme("L-F2.decay", lambda e: {"error": e[_DECAY]})
    yield by_scheme("L-F2.absolute_error", lambda e: {"error": e[_ABSOLUTE]})
    yield by_scheme("L-F2.interior", inside)
    yield by_scheme("L-F2.relative_error", outwards)

    def over_exchange(error: pd.Series) -> pd.Series:
        return error[["DD", "FPSE"]] / error[["KPSE", "GPSE"]].max()

    def against_fd(error: pd.Series) -> pd.Series:
        ratio = (error / error["FD"]).drop("FD")
        return ratio.where(ratio > 1.0, 1.0 / ratio)

    # The ends of DVM's lattice are elsewhere, where the solution is a thousand times as large.
    here, claims = judged.drop("DVM"), ("L-C2.dd_fpse_boundary", "L-C2.fd_comparable")
    for claim, ratio in zip(claims, (over_exchange, against_fd), strict=True):
        largest = ratio(here[_ABSOLUTE_EDGE])
        yield measured(
            claim,
            runs=main.runs,
            others={"the largest absolute error instead of the median relative one": {"ratio": largest}},
            ratio=ratio(here[boundary]),
            error=here[boundary],
            largest=largest,
        )  # fmt: skip
    beside = (here[boundary] / here.loc["FD", boundary]).drop("FD")
    yield measured("L-C2.far_field", runs=main.runs, ratio=beside)


def _truncation(main: Inputs, edge: float) -> list[Finding]:
    """What the truncation adds: the change of u from the open exterior, with everything else the same."""
    rows, files = {}, []
    for scheme in main.select(exterior="open")["scheme"]:
        cut, free = (main.open(scheme=scheme, exterior=e) for e in ("truncated", "open"))
        x, exact, width = np.abs(cut["x"].values), _exact(cut), float(cut["half_width"])
        change = np.abs(cut["u"].values - free["u"].values)
        near, inside = x >= edge * width, x < 0.5 * width
        rows[scheme] = {
            "edge": np.median((change / exact)[near]),
            "inside": (change / exact)[inside].max(),
            "largest": (change / exact).max(),
            "absolute": change[near].max() / change[inside].max(),
            "left": np.median(np.abs(free["u"].values / exact - 1.0)[near]),
        }
        files += list(main.select(scheme=scheme)["run"])
    found, of = pd.DataFrame(rows).T, partial(measured, runs=files)
    ratio, largest = found["edge"] / found["inside"], found["largest"]
    absolute = {"the absolute change": {"ratio": found["absolute"]}}
    explicit = main.select(exterior="truncated").set_index("scheme").loc[["DD", "FPSE", "KPSE"]]
    limit = [stability_limit(s, beta) for s, beta in explicit["beta"].items()]
    step = explicit["dt"] / explicit["particle_spacing"] ** (1.0 + explicit["beta"]) / limit
    return [
        of("L-C2.not_instability", step=step, gain=found["edge"] / found["left"]),
        of("L-C2.truncation_at_edge", others=absolute, ratio=ratio),
        of("L-F2.substantial", largest=largest.max(), each=largest),
        of("L-F2.mostly_boundaries", others=absolute, ratio=ratio),
    ]


def _initial(run: xr.Dataset, u: np.ndarray, runs: Sequence[str]) -> Iterator[Finding]:
    """The initial condition, the fundamental solution at t = 0.5, on the lattice and between D/2 and D."""
    x, start, alpha = run["x"].values, float(run["t_initial"]), 1.0 + float(run["beta"])
    near, far = np.asarray(green(x[-1] * np.array([0.5, 1.0]), start, alpha))
    asymmetry, step = np.abs(u - u[::-1]).max() / u.max(), np.diff(u[x >= 0.0]).max()
    yield measured("L-F2.initial_shape", runs=runs, asymmetry=asymmetry, step=step)
    yield measured("L-F2.initial_decay", runs=runs, exponent=np.log2(far / near))


def _setting(main: Inputs, table: pd.DataFrame, printed: int) -> list[Finding]:
    """The lattice and the step of GPSE: D, h, N and epsilon as Sec. 4.1 prints them."""
    run, gpse = (main.select(scheme=s, exterior="truncated").iloc[0] for s in ("KPSE", "GPSE"))
    half, alpha = float(run["half_width"]), 1.0 + float(run["beta"])
    spacing = 2.0 * half / (printed - printed % 2)  # of the next odd number of particles
    peak, beside = np.asarray(green(np.array([0.0, 0.5 * spacing]), float(run["t_final"]), alpha))
    error = table.set_index(["scheme", "exterior"])[_PEAK]
    ours = 2 * round(half / run["particle_spacing"]) + 1
    change = abs(spacing * (printed - 1) / (2.0 * half) - 1.0)
    of = partial(measured, runs=[run["run"]])
    return [
        of("L-C1.D", ours=half),
        of("L-C1.h", ours=2.0 * half / (printed - 1)),
        of(
            "L-C1.odd_number",
            printed=printed,
            spacing=change,
            ours=ours,
            missed=1.0 - beside / peak,
            share=(1.0 - beside / peak) / error["KPSE", "truncated"],
        ),
        of("L-C1.particles", printed=printed % 2, ours=ours % 2, spacing=change),
        measured(
            "L-F2.gpse_epsilon",
            runs=[gpse["run"]],
            overlap=gpse["overlap"],
            step=(2.0 * gpse["particle_spacing"]) ** alpha,
        ),
    ]


def _mass(beta: float, time: float) -> Finding:
    """The percentage of the mass within 5 R_alpha."""
    alpha = 1.0 + beta
    mass = 100.0 * float(central_mass(5.0 * mean_radius(alpha), time, alpha))
    return measured(f"L-C1.mass.beta{beta:g}", mass=mass, outside=100.0 - mass)
