"""The probes counted: every family is there, and nothing tracked is silent or failed."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from fracstudy.inputs import Inputs
from fracstudy.probe import BAD, Kind, frame
from scene_functions import scenes, study

ROOT = Path(__file__).resolve().parents[3]
FAMILIES = [name for name, s in scenes().items() if s.document == "extremes" and s.place > 0]


def test_every_family_is_counted():
    scene = scenes()["what_can_go_wrong"]
    assert sorted(scene.tables) == sorted(FAMILIES)
    assert list(scene.parameters["families"]) == scene.tables


def test_the_counts_are_those_of_the_tables():
    kind = Kind("k", "e", 1.0)
    probes = [kind("c", float, 0.5, source="closed form"), kind("c", float, 1.5)]
    words = {"what may go wrong": "a", "what tells you": "b"}
    result = study("what_can_go_wrong")(
        Inputs("x", tables={"one": frame(probes)}), families={"one": words}
    )
    row = result.table.iloc[0]
    assert (row["probes"], row["held"], row["silent"]) == (2, 1, 1)
    assert result.table.iloc[-1]["probes"] == 2


@pytest.mark.parametrize("name", FAMILIES)
def test_no_tracked_probe_is_silent_or_failed(name):
    table = pd.read_csv(ROOT / f"results/tables/{name}.csv")
    bad = table[table["verdict"].isin([str(verdict) for verdict in BAD])]
    assert bad.empty, bad[["kind", "case", "found"]].to_string()


def test_at_least_half_of_the_families_have_independent_values():
    tables = [pd.read_csv(ROOT / f"results/tables/{name}.csv") for name in FAMILIES]
    independent = [(table["source"].fillna("") != "").mean() > 0.5 for table in tables]
    assert sum(independent) >= len(FAMILIES) / 2
