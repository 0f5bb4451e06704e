"""What is stated of the problems of this page, beside what their scenes measured."""

import math
from collections.abc import Mapping
from typing import Any

import pandas as pd

from fracparticles.errors import InvalidInput
from fracstudy.inputs import Inputs, Result


def study(inputs: Inputs, *, statements: list[dict[str, Any]]) -> Result:
    """One row a statement: what it says, what shall be, what is, and whether it holds."""
    return Result(pd.DataFrame([_judged(inputs.tables, **one) for one in statements]))


def _judged(
    tables: Mapping[str, pd.DataFrame],
    *,
    says: str,
    scene: str,
    column: str,
    where: dict[str, Any],
    least: float = -math.inf,
    most: float = math.inf,
) -> dict[str, Any]:
    """The value that is farthest on the wrong side, of all rows that the statement speaks of."""
    rows = tables[scene]
    for name in (column, *where):
        if name not in rows:
            remedy = f"Mend the statement {says!r}."
            raise InvalidInput("column", name, f"a column of the table of {scene}", remedy)
    for name, value in where.items():
        rows = rows[rows[name] == value]
    values = rows[column].dropna()
    if values.empty:
        found, verdict = math.nan, "not on this grid"
    else:
        found = values.min() if most == math.inf else values.max()
        verdict = "holds" if least <= values.min() and values.max() <= most else "does not hold"
    asked = [f"at least {least:g}"] * (least > -math.inf) + [f"at most {most:g}"] * (
        most < math.inf
    )
    return {
        "statement": says,
        "asked": ", ".join(asked),
        "measured": found,
        "verdict": verdict,
        "scene": scene,
    }
