"""Probes next to both ends of alpha: nothing silent, nothing failed; what is no order is refused."""

from __future__ import annotations

import matplotlib.pyplot as plt

PARAMETERS = {
    "betas": [2.3e-16, 1.0 - 2.3e-16],
    "radii": [1.1],
    "orders": [2, 12],
    "dims": [1],
}


def test_no_probe_is_bad(bad):
    assert bad == ""


def test_most_are_held_against_something_independent(table):
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


def test_what_is_no_order_is_refused(table):
    refused = table[table["kind"] == "no such alpha"]
    assert len(refused) == 42
    assert (refused["verdict"] == "refused").all()


def test_the_figure_draws_a_line_a_function(drawn):
    assert [len(ax.get_lines()) for ax in drawn.axes] == [8, 9]
    plt.close("all")
