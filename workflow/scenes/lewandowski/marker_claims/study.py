"""Sections 2.1, 2.3 and 2.4: markers per eps, the error law (19), position errors, and the denominator of (7)."""

from itertools import product

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.lewandowski.marker_claims import denominator, error_law, numbers, positions
from scenes.lewandowski.square_profile import SquareRuns

_COLUMNS = ["what", "S", "loading", "at", "ours", "predicted"]


def study(
    inputs: Inputs,
    *,
    run: SquareRuns,
    shapes: list[str],
    counts: list[int],
    law: list[str],
    spacings: list[float],
    times: list[float],
    watched: float,
    small_dt: float,
    seed: int,
    seeds: int,
) -> Result:
    """Measure what Sections 2.1, 2.3 and 2.4 say of the accuracy: one row a measurement.

    `counts` are numbers of markers, `law` the shape functions of the error law and `spacings` those of its optimum.
    Positions are compared at `times`. Until `watched`, runs from random positions may meet a field that turns negative.
    """
    square = SquareRuns.model_validate(run)
    starts = list(product(shapes, ("midpoints", "random")))
    rows = [*error_law.rows(law, spacings)]
    rows += [row for start in starts for row in numbers.rows(square, *start, seed, counts)]
    rows += [row for start in starts for row in positions.rows(square, *start, seed, times)]
    found = pd.DataFrame(rows)
    of = dict(tuple(found.groupby("what")))
    long = square.having(t_final=watched)
    stops = denominator.traces(long, small_dt, range(seed, seed + seeds))
    findings = [
        *numbers.findings(of["E"], square, range(seed, seed + (seeds + 1) // 2)),
        *error_law.findings(of, law),
        *positions.findings(of["position error"], of["representation error"]),
        *denominator.findings(long, stops, seed),
    ]
    drawn, panels = found.dropna(subset=["x"]), Panels()
    named = {"predicted": drawn["predicted"], "loading": drawn["loading"]}
    panels.add(drawn["what"], drawn["S"], drawn["x"], drawn["ours"], **named)
    denominator.draw_last_field(panels, stops, square.support)
    early = found["what"].str.endswith(" error") & (found["x"] < max(times))
    table = found.loc[~early, _COLUMNS].dropna(subset=["ours"])
    return Result(table, inputs.judged(findings), panels.frame)
