"""Order of self-convergence (49) in two dimensions, Sec. 5, in every reading of the printed numbers."""

from collections.abc import Iterator
from itertools import product

import numpy as np
import pandas as pd

from fracparticles.lattice.field import smoothed_field
from fracparticles.run.orders import self_convergence_order
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import pick
from scenes.plane import DISC, particles_per_side, stored_field

NEEDS = {"scheme": ["DD", "FPSE"]}

_OURS = "ours, h as middle level"  # of the three of (49)
# |x| up to which the sum runs; round-off must not leave out a particle.
_REGIONS = {"r <= 5": DISC * (1.0 + 1e-12), "all particles": np.inf}

# By N: h, |x|, and u of the field (7) and of the strengths.
_Levels = dict[int, tuple[float, np.ndarray, dict[str, np.ndarray]]]


def study(inputs: Inputs, *, particles: dict[str, int]) -> Result:
    """The printed orders, ours from the field (7) over the disc with h as middle level, and the other readings.

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
            row = {
                "scheme": scheme,
                "h": levels[count][0],
                "N": count,
                "compared": what,
                "summed over": region,
                "printed": printed,
                _OURS: ours,
                "deviation": ours - printed,
                "h as coarse level": coarse,
                "h as fine level": fine,
                "with kernel tables": _order(by_table, count, 1, what, region),
            }
            rows.append(row)
    table = pd.DataFrame(rows)
    findings = _findings(table, particles, list(runs["run"])) if rows else ()
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


def _findings(
    table: pd.DataFrame, particles: dict[str, int], files: list[str]
) -> Iterator[Finding]:
    for h, count in particles.items():
        here = pick(table, N=count)
        for scheme, part in here.groupby("scheme", sort=False):
            readings = part.set_index(["compared", "summed over"])
            yield measured(
                f"L-2D-ORD.{scheme}.h{h}",
                runs=files,
                ours=part[_OURS].iloc[0],
                nearest=", ".join(readings["deviation"].abs().fillna(np.inf).idxmin()),
                readings={" over ".join(key): order for key, order in readings[_OURS].items()},
            )
        for spacing in here["h"].head(1):
            yield measured(f"L-2D-ORD.spacing.h{h}", ours=spacing)
    order = pick(table, N=table["N"].max()).set_index(["compared", "summed over", "scheme"])[_OURS]
    order = order.sort_index()
    readings = (("field (7)", "r <= 5"), ("strengths", "r <= 5"), ("field (7)", "all particles"))
    ours, strengths, everywhere = ((order[reading] - 2.0).abs() for reading in readings)
    yield measured(
        "L-2D-ORD.second_order",
        runs=files,
        difference=ours,
        order=order["field (7)", "r <= 5"],
        others={
            "the strengths for the field (7)": {"difference": strengths},
            "all particles for the disc": {"difference": everywhere},
        },
    )
