"""Moving particles and markers: every probe right, warned or refused."""

from __future__ import annotations

from fracstudy.probe import Verdict
from sweeps import few

ORDERS = few([4, 2], 1)

PARAMETERS = {
    "particles": 50,
    "orders": ORDERS,
    "half_width": 6.0,
    "spacing": 0.15,
    "walkers": 2000,
    "shapes": few(["S1", "S4", "S8"]),
    "markers_in_a_run": 60,
    "supports": [0.5, 50.0],
    "reynolds": [1e3],
}


def test_nothing_is_wrong_without_a_word(bad):
    assert bad == ""


def test_steps_beyond_the_limit_are_warned_of(table):
    steps = table[table["kind"] == "step"].set_index("case")["verdict"]
    beyond = steps[steps.index.str.contains(r"dt = 1\.")]
    assert len(beyond) == 3 * (len(ORDERS) + 3)  # of DVM and of three markers
    assert set(beyond) == {Verdict.WARNED}
    assert set(steps[steps.index.str.contains(r"dt = 0\.")]) == {Verdict.HELD}


def test_what_means_nothing_is_refused(table):
    refused = table[table["expected"] == "refused"]
    assert len(refused) > 25
    assert set(refused["verdict"]) == {Verdict.REFUSED}


def test_most_are_held_against_something_independent(table):
    assert (table["source"] != "").mean() > 0.5


def test_errors_above_the_line_speak(result, drawn):
    errors = result.series[result.series["panel"] == "error"]
    assert errors.loc[errors["y"] > 0.05, "spoke"].all()
    assert len(drawn.axes) == 2
