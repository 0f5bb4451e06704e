"""DVM in the reference case, Secs. 3.3, 4.1, 4.2 and 6: its domain, and what its lattice needs remeshing for."""

from collections.abc import Iterator
from functools import partial

import numpy as np
import pandas as pd

from fracparticles.errors import FracparticlesError
from fracparticles.run.dataset import read_run
from fracparticles.special.stable import mean_radius
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs

_FREE, _REMESHED = "without remeshing", "remeshed"


def lagrangian_domain(
    inputs: Inputs, main: Inputs, table: pd.DataFrame, windows: list[list[float]]
) -> Iterator[Finding]:
    """Measure what the paper says on DVM's domain and remeshing.

    `main` are the runs of Fig. 2. The others have a coarser lattice and several half-widths: DVM with and without
    remeshing, DD and KPSE, whose lattices stay where they are.
    """
    moving = main.select(scheme="DVM")
    first, *others = (name for name in moving["remeshing"] if name != "none")
    errors = table.set_index("scheme")["error (48)"]
    ratio = {name: errors["DVM, none"] / errors[f"DVM, {name}"] for name in (first, *others)}
    kept, free = (_lattice(main, name) for name in (first, "none"))
    found, end = partial(measured, runs=moving["run"]), kept["reach"]
    reach = {f"x in [{low:g}, {high:g}]": end / (low or high) for low, high in windows}
    yield found("L-F2.DVM_window", reach=reach, end=end)
    yield found("L-F2.DVM_distortion", gap=free["gap"])
    yield found("L-F2.DVM_overlap", overlap=free["overlap"])
    yield found(
        "L-F2.DVM_remeshing",
        others={f"remeshing by {name}": {"ratio": ratio[name]} for name in others},
        ratio=ratio[first],
        free=errors["DVM, none"],
        remeshed=errors[f"DVM, {first}"],
    )
    overlap = kept["overlap"]
    yield found("L-C1.redistribution_resolution", overlap=overlap, free=free["overlap"])
    yield found("L-C1.redistribution_domain", ratio=free["reach"] / kept["reach"])
    stretch = {_FREE: free["stretch"], _REMESHED: kept["stretch"]}
    away = {case: abs(by - 1.0) for case, by in stretch.items()}
    yield found("L-C1.DVM_stretching", away=away, stretch=stretch)
    yield from _truncation(inputs, main, errors)


def _lattice(main: Inputs, remeshing: str) -> dict[str, float]:
    """Where the particles of a run are at the end, whose half have a gap and an overlap no better than these."""
    run = main.open(scheme="DVM", remeshing=remeshing)
    x = np.sort(run["particle_position"].values)
    gap = float(np.median(np.diff(x)) / run["particle_spacing"])
    similarity = float(run["t_final"] / run["t_initial"]) ** (1.0 / (1.0 + float(run["beta"])))
    return {
        "reach": float(x[-1]),
        "gap": gap,
        "overlap": float(run["overlap"]) / gap,
        "stretch": float(np.median(np.abs(x)) / (0.5 * run["half_width"])) / similarity,
    }


def _truncation(inputs: Inputs, main: Inputs, errors: pd.Series) -> Iterator[Finding]:
    """The change of u from the widest domain to DVM's C, beside that of DD and beside the error (48) of Fig. 2."""
    others = inputs.scalars[~inputs.scalars["run"].isin(main.runs)]
    effect = truncation_effect(others)
    asked = float(main.select(scheme="DVM")["truncation"].iloc[0])
    at = effect[min(effect.columns, key=lambda c: abs(c - asked))]
    remeshed = next(name for name in at.index if name.startswith("DVM") and name != "DVM, none")
    names = {_REMESHED: remeshed, _FREE: "DVM, none"}
    ratio = {case: at["DD"] / at[name] for case, name in names.items()}
    yield measured("L-C1.DVM_domain", runs=others["run"], ratio=ratio, change=at)
    runs = [*others["run"], *main.select(scheme="DVM")["run"]]
    share = {case: at[name] / errors[name] for case, name in names.items()}
    change = {case: at[name] for case, name in names.items()}
    yield measured("L-C1.DVM_truncation", runs=runs, share=share, change=change)


def truncation_effect(runs: pd.DataFrame) -> pd.DataFrame:
    """Return the relative L1 distance of u from that on the widest domain, over |x| <= 5 R_alpha.

    It is by scheme (rows) and truncation factor C (columns). The runs hold u for |x| <= 5 R_alpha at least, on
    lattices of one spacing: without common points it is refused.
    """
    spacing = runs["particle_spacing"]
    if spacing.max() > spacing.min() * (1.0 + 1e-6):
        raise FracparticlesError(
            f"the runs on the domain of DVM have spacings from {spacing.min():.9g} to {spacing.max():.9g}; "
            "choose half-widths that are multiples of one spacing"
        )
    half = 5.0 * mean_radius(1.0 + float(runs["beta"].iloc[0])) * (1.0 + 1e-12)
    rows = {}
    # Schemes on the lattice have no remeshing.
    for (scheme, remeshing), part in runs.groupby(["scheme", "remeshing"], dropna=False):
        name = f"{scheme}, {remeshing}" if scheme == "DVM" else str(scheme)
        part = part.sort_values("truncation", ascending=False)
        widest, *fields = (_within(path, half) for path in part["run"])
        changes = [float(np.abs(u - widest).sum() / widest.sum()) for u in fields]
        rows[name] = dict(zip(part["truncation"].iloc[1:].round(6), changes, strict=True))
    return pd.DataFrame(rows).T


def _within(path: str, half: float) -> np.ndarray:
    """The field u of a run over |x| <= half."""
    run = read_run(path)
    return run["u"].values[np.abs(run["x"].values) <= half]
