"""DVM in the reference case, Secs. 4.1 and 4.2: its domain, and what its lattice needs remeshing for."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.errors import FracparticlesError
from fracparticles.run.dataset import read_run
from fracparticles.special.stable import mean_radius
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, listed, spelled, statement

__all__ = ["lagrangian_domain", "truncation_effect"]

_NEGLIGIBLE = 0.05  # of the error (48): what the truncation may change
_ALIKE = 0.25  # the effects of the truncation on two schemes differ by no more, relative
_SPOILED = 2.0  # the error without remeshing over that with it


def lagrangian_domain(
    inputs: Inputs, main: Inputs, table: pd.DataFrame, window: list[float]
) -> list[Finding]:
    """Judge what the paper says on DVM's domain and remeshing.

    `main` are the runs of Fig. 2. The others have a coarser lattice and several half-widths: DVM with and without
    remeshing, DD and KPSE, whose lattices stay where they are. The truncation at DVM's C matters if it changes u by
    more than 5 % of the error (48); the adaptation of the lattice would be what makes that small if it changed DD
    more.
    """
    return [*_lattice(main, table, window), *_truncation(inputs, main)]


def _lattice(main: Inputs, table: pd.DataFrame, window: list[float]) -> list[Finding]:
    moving = main.select(scheme="DVM")
    half = float(moving["half_width"].max())
    errors = table.set_index("scheme")["error (48)"]
    errors = errors[errors.index.str.startswith("DVM")]
    free = main.open(scheme="DVM", remeshing="none")
    gap = np.diff(np.sort(free["particle_position"].values))
    overlap = float(free["overlap"] * free["particle_spacing"] / np.median(gap))
    return [
        statement(
            "L-F2.DVM_window",
            half >= window[0],
            f"The lattice of DVM, remeshed onto the initial one, ends at |x| = {half:.4g}; the right plot begins at "
            f"x = {window[0]:g}.",
            "With D = 10 t_f^(1/alpha) R_alpha (Sec. 4.1) DVM has no particles there; the caption counts four methods.",
            moving["run"],
        ),
        statement(
            "L-F2.DVM_remeshing",
            errors["DVM, none"] > _SPOILED * errors.drop("DVM, none").max(),
            f"Error (48): {spelled(errors)}. Without remeshing the overlap of half of the particles has fallen to "
            f"{overlap:.2g} or less.",
            "The error without remeshing is not larger.",
            moving["run"],
        ),
    ]


def _truncation(inputs: Inputs, main: Inputs) -> list[Finding]:
    others = inputs.scalars[~inputs.scalars["run"].isin(main.runs)]
    effect, error = truncation_effect(others)
    asked = float(main.select(scheme="DVM")["truncation"].iloc[0])
    chosen = min(effect.columns, key=lambda c: abs(c - asked))
    each = "; ".join(f"{name}: {listed(changes, '.1e')}" for name, *changes in effect.itertuples())
    at = effect[chosen]
    remeshed = [name for name in effect.index if name.startswith("DVM") and name != "DVM, none"]
    still = at["DD"] / at[remeshed]
    return [
        statement(
            "L-C1.DVM_domain",
            (still > 1.0 + _ALIKE).all(),
            f"Change of u over |x| <= 5 R, relative, from the widest domain to C = {listed(effect)}: {each}.",
            "DD changes by as much, on a lattice that stays where it is, and so does remeshed DVM, which keeps to the "
            "initial lattice: both find u and its flux from the particles inside, where a missing tail is hardly felt. "
            "KPSE exchanges strength with it.",
            others["run"],
        ),
        statement(
            "L-C1.DVM_truncation",
            (at[remeshed] < _NEGLIGIBLE * error[remeshed]).all(),
            f"From the widest domain to C = {chosen:g}, u of DVM changes by {at[remeshed].max():.1e} with remeshing "
            f"and {at['DVM, none']:.1e} without; its error (48) is {error[remeshed].min():.1e}, h = "
            f"{others['particle_spacing'].iloc[0]:.3g}.",
            "The truncation changes the error.",
            others["run"],
        ),
    ]


def truncation_effect(runs: pd.DataFrame) -> tuple[pd.DataFrame, pd.Series]:
    """Return the relative L1 distance of u from that on the widest domain, over |x| <= 5 R_alpha, and the error (48).

    The former by scheme (rows) and truncation factor C (columns), the latter by scheme on the widest domain. The
    runs hold u for |x| <= 5 R_alpha at least.

    Raises
    ------
    FracparticlesError
        If the lattices of the runs differ in their spacing: then u has no common points.
    """
    spacing = runs["particle_spacing"]
    if spacing.max() > spacing.min() * (1.0 + 1e-6):
        raise FracparticlesError(
            f"the runs on the domain of DVM have spacings from {spacing.min():.9g} to {spacing.max():.9g}; "
            "choose half-widths that are multiples of one spacing"
        )
    half = 5.0 * mean_radius(1.0 + float(runs["beta"].iloc[0])) * (1.0 + 1e-12)
    rows, errors = {}, {}
    # Schemes on the lattice have no remeshing.
    for (scheme, remeshing), part in runs.groupby(["scheme", "remeshing"], dropna=False):
        name = f"{scheme}, {remeshing}" if scheme == "DVM" else str(scheme)
        part = part.sort_values("truncation", ascending=False)
        widest, *fields = (_within(path, half) for path in part["run"])
        changes = [float(np.abs(u - widest).sum() / widest.sum()) for u in fields]
        rows[name] = dict(zip(part["truncation"].iloc[1:].round(6), changes, strict=True))
        errors[name] = float(part["relative_l1_error"].iloc[0])
    return pd.DataFrame(rows).T, pd.Series(errors)


def _within(path: str, half: float) -> np.ndarray:
    """The field u of a run over |x| <= half."""
    run = read_run(path)
    return run["u"].values[np.abs(run["x"].values) <= half]
