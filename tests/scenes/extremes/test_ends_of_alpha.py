"""Probes next to both ends of alpha: nothing silent, nothing failed; what is no order is refused."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pytest

from fracstudy.inputs import Inputs
from fracstudy.probe import BAD
from scene_functions import figure, study

PARAMETERS = {
    "betas": [2.3e-16, 1e-12, 1.0 - 2.3e-16],
    "radii": [1.1],
    "orders": [2, 12],
    "dims": [1],
}


@pytest.fixture(scope="module")
def result():
    return study("ends_of_alpha")(Inputs("ends_of_alpha"), **PARAMETERS)


def test_no_probe_is_bad(result):
    bad = result.table[result.table["verdict"].isin(BAD)]
    assert bad.empty, bad[["kind", "case", "found", "bound"]].to_string()


def test_most_are_held_against_something_independent(result):
    table = result.table
    assert (table["source"] != "").mean() > 0.5
    assert set(table["kind"]) >= {
        "density",
        "far tail",
        "kernel",
        "table",
        "scheme",
        "limit",
        "whole space",
    }


def test_what_is_no_order_is_refused(result):
    refused = result.table[result.table["kind"] == "no such alpha"]
    assert len(refused) == 42
    assert (refused["verdict"] == "refused").all()


def test_the_figure_draws_a_line_a_function(result):
    drawn = figure("ends_of_alpha")(result.series, result.table, PARAMETERS)
    assert [len(ax.get_lines()) for ax in drawn.axes] == [8, 9]
    plt.close("all")
