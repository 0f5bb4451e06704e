"""The statements about problems: each is judged by the worst of the rows that it speaks of."""

from __future__ import annotations

import math
from pathlib import Path

import pandas as pd
import pytest
import yaml

from fracstudy.inputs import Inputs
from scenes.problems.what_is_stated.study import study

ROOT = Path(__file__).parents[3]
SCENE = yaml.safe_load(
    (ROOT / "workflow/scenes/problems/what_is_stated/scene.yaml").read_text("utf-8")
)
TABLE = pd.DataFrame({"case": ["a", "a", "b"], "error": [0.1, 0.3, math.nan]})


def judged(tables, *statements):
    inputs = Inputs(scene="", items=(), printed={}, runs=(), tables=tables, benchmarks={})
    return study(inputs, statements=list(statements)).table


@pytest.mark.parametrize(
    ("limits", "measured", "verdict"),
    [
        ({"most": 0.3}, 0.3, "holds"),
        ({"most": 0.2}, 0.3, "does not hold"),
        ({"least": 0.1}, 0.1, "holds"),
        ({"least": 0.2}, 0.1, "does not hold"),
        ({"least": 0.0, "most": 1.0}, 0.3, "holds"),
        ({"least": 0.2, "most": 1.0}, 0.3, "does not hold"),
    ],
)
def test_the_worst_row_decides(limits, measured, verdict):
    says = {"says": "s", "scene": "t", "column": "error", "where": {"case": "a"}, **limits}
    (row,) = judged({"t": TABLE}, says).to_dict("records")
    assert (row["measured"], row["verdict"]) == (measured, verdict)


def test_what_a_grid_does_not_have_is_not_judged():
    says = {"says": "s", "scene": "t", "column": "error", "where": {"case": "b"}, "most": 1.0}
    assert judged({"t": TABLE}, says)["verdict"].tolist() == ["not on this grid"]


def test_every_statement_speaks_of_rows_that_the_study_made():
    tables = {name: pd.read_csv(ROOT / f"results/tables/{name}.csv") for name in SCENE["tables"]}
    table = judged(tables, *SCENE["parameters"]["statements"])
    assert set(table["verdict"]) <= {"holds", "does not hold"}
    tracked = pd.read_csv(ROOT / "results/tables/what_is_stated.csv")
    assert tracked["verdict"].tolist() == table["verdict"].tolist()
