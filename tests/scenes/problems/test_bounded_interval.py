"""The interval: what the scene says of its numbers, on the smoke grid."""

from __future__ import annotations

import pytest

from fracstudy.panels import pick


def test_the_first_eigenvalue_has_six_digits_with_a_hundred_particles(result):
    rows = pick(result.table, quantity="first eigenvalue")
    assert sorted(rows["alpha"]) == [1.1, 1.5, 1.9]
    assert (rows["particles"] == 100).all()
    assert (rows["error"] < 1e-6).all()


def test_orders_are_those_of_theory(result):
    rows = result.table.dropna(subset="of theory").set_index("quantity")
    for way in ("equal volumes, q = 3", "p = 8, q = 0", "p = 8, q = 1"):
        row = rows.loc[f"first eigenvalue, {way}"]
        assert row["order"] == pytest.approx(row["of theory"], abs=0.1)


def test_what_is_conserved_is_conserved_to_round_off(result):
    rows = result.table[result.table["quantity"].isin(["mass at t = 0.1", "a constant at t = 0.1"])]
    assert len(rows) == 9
    assert (rows["error"] <= 1e-12).all()


def test_closed_forms_and_the_decay_to_five_digits(result):
    rows = result.table[result.table["alpha"].notna() & result.table["order"].isna()]
    assert (rows["error"] < 1e-5).all()


def test_truncated_schemes_come_to_solve_the_problems_that_are_said(result):
    order = {"DD": 1.0, "KPSE": 2.0, "DPSE": 1.0, "FPSE": 1.0}
    for name, ends in {
        "DD": "absorbing", "KPSE": "reflecting", "DPSE": "no flux", "FPSE": "no flux",
    }.items():  # fmt: skip
        row = result.table[result.table["quantity"].str.startswith(f"{name}, ")].iloc[0]
        assert row["ends"] == ends
        assert row["error"] < 0.05
        assert row["order"] == pytest.approx(order[name], abs=0.3)  # the smoke lattices are coarse


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 3
