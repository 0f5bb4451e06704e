"""Order of self-convergence (49) in two dimensions, Sec. 5, in every reading of the printed numbers."""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd

from fracparticles.lattice.field import smoothed_field
from fracparticles.run.orders import self_convergence_order
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement, value
from scenes.plane import DISK, particles_per_side, stored_field

__all__ = ["study"]

NEEDS = {"scheme": ["DD", "FPSE"]}

_SECOND = 0.1  # how far from 2 the order on the finest lattices may be
_OURS = "ours, h as middle level"  # of the three of (49)
# |x| up to which the sum runs; round-off must not leave out a particle.
_REGIONS = {"r <= 5": DISK * (1.0 + 1e-12), "all particles": np.inf}

# By N: h, |x|, and u of the field (7) and of the strengths.
_Levels = dict[int, tuple[float, np.ndarray, dict[str, np.ndarray]]]


def study(inputs: Inputs, *, particles: dict[str, int]) -> Result:
    """The printed orders, ours from the field (7) over the disk with h as middle level, and the other readings.

    `particles` has the N that each printed h belongs to.
    """
    runs = inputs.scalars
    runs = runs.assign(N=particles_per_side(runs))
    runs["tabulated"] = runs["kernel_table"].notna() if "kernel_table" in runs else False
    fields = {key: _read(part) for key, part in runs.groupby(["scheme", "tabulated"])}
    rows = []
    for scheme, (h, count) in product(NEEDS["scheme"], particles.items()):
        levels, by_table = (fields.get((scheme, tabulated), {}) for tabulated in (False, True))
        if count not in levels:
            continue
        printed = float(inputs.printed.get(f"L-2D-ORD.{scheme}.h{h}", "nan"))
        for what, region in product(("field (7)", "strengths"), _REGIONS):
            ours, coarse, fine = (_order(levels, count, k, what, region) for k in (1, 0, 2))
            rows.append(
                {
                    "scheme": scheme,
                    "h": levels[count][0],
                    "N": count,
                    "of the": what,
                    "over": region,
                    "printed": printed,
                    _OURS: ours,
                    "deviation": ours - printed,
                    "h as coarse level": coarse,
                    "h as fine level": fine,
                    "with kernel tables": _order(by_table, count, 1, what, region),
                }
            )
    table = pd.DataFrame(rows)
    findings = _findings(table, particles, list(runs["run"])) if rows else []
    return Result(table, inputs.judged(findings))


def _read(runs: pd.DataFrame) -> _Levels:
    levels: _Levels = {}
    for run in runs.itertuples():
        stored = stored_field(run.run)
        if stored is not None:
            _, r, u = stored
            both = {"field (7)": smoothed_field(u, run.overlap), "strengths": u}
            levels[run.N] = (float(run.particle_spacing), r, both)
    return levels


def _order(levels: _Levels, count: int, place: int, what: str, region: str) -> float:
    """(49) of three lattices, that of `count` particles a side at `place` among them; nan if one is missing."""
    counts = [round((count - 1) * 2.0 ** (level - place)) + 1 for level in range(3)]
    if not set(counts) <= set(levels):
        return np.nan
    inside = levels[counts[0]][1] <= _REGIONS[region]
    common = [levels[n][2][what][:: 2**k, :: 2**k] for k, n in enumerate(counts)]
    return self_convergence_order([u[inside] for u in common])


def _findings(table: pd.DataFrame, particles: dict[str, int], files: list[str]) -> list[Finding]:
    findings = []
    for (scheme, count), part in table.groupby(["scheme", "N"], sort=False):
        h = next(h for h, n in particles.items() if n == count)
        nearest = part.loc[part["deviation"].abs().fillna(np.inf).idxmin()]
        findings.append(
            value(
                f"L-2D-ORD.{scheme}.h{h}",
                part[_OURS].iloc[0],
                "Ours: field (7) over r <= 5, h as middle level, exact kernels; the print does not name the reading. "
                f"Of the readings with h as middle level the nearest is the {nearest['of the']}, {nearest['over']}, "
                f"{abs(nearest['deviation']):.3f} off.",
                files,
            )
        )
    for h, count in particles.items():
        spacing = table.loc[table["N"] == count, "h"].head(1)
        where = f"2 D / (N - 1) at N = {count}."
        findings += [value(f"L-2D-ORD.spacing.h{h}", ours, where) for ours in spacing]
    finest = table[table["N"] == table["N"].max()].set_index(["over", "of the", "scheme"])[_OURS]
    orders, least = finest["r <= 5"], finest["all particles"].min()
    found = "; ".join(f"{p:.3f} ({scheme}, {what})" for (what, scheme), p in orders.items())
    return [
        *findings,
        statement(
            "L-2D-ORD.second_order",
            ((orders - 2.0).abs() < _SECOND).all(),
            f"On the finest three lattices, over r <= 5: {found}. Over all particles it is down to {least:.2f}: as in "
            "one dimension, the layer of FPSE at the edge does not converge.",
            "On the finest three lattices the order is not near 2.",
            files,
        ),
    ]
