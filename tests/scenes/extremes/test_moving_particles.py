"""Moving particles and markers: every probe right, warned or refused."""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from fracstudy.probe import BAD, Verdict
from scene_functions import figure, study

PARAMETERS = {
    "particles": 50,
    "orders": [2, 4],
    "half_width": 10.0,
    "spacing": 0.1,
    "walkers": 5000,
    "shapes": ["S1", "S2", "S4", "S8"],
    "markers_in_a_run": 120,
    "supports": [0.5, 2.0, 50.0],
    "reynolds": [1.0, 1e3],
}


@pytest.fixture(scope="module")
def result():
    return study("moving_particles")(Inputs("moving_particles"), **PARAMETERS)


def test_nothing_is_wrong_without_a_word(result):
    bad = result.table[result.table["verdict"].isin(BAD)]
    assert bad.empty, bad[["kind", "case", "found", "deviation", "bound"]].to_markdown(index=False)


def test_steps_beyond_the_limit_are_warned_of(result):
    steps = result.table[result.table["kind"] == "step"].set_index("case")["verdict"]
    beyond = steps[steps.index.str.contains(r"dt = 1\.")]
    assert len(beyond) == 15
    assert set(beyond) == {Verdict.WARNED}
    assert set(steps[steps.index.str.contains(r"dt = 0\.")]) == {Verdict.HELD}


def test_what_means_nothing_is_refused(result):
    refused = result.table[result.table["expected"] == "refused"]
    assert len(refused) > 25
    assert set(refused["verdict"]) == {Verdict.REFUSED}


def test_most_are_held_against_something_independent(result):
    assert (result.table["source"] != "").mean() > 0.5


def test_errors_above_the_line_speak(result):
    errors = result.series[result.series["panel"] == "error"]
    assert errors.loc[errors["y"] > 0.05, "spoke"].all()
    assert len(figure("moving_particles")(result.series, result.table, PARAMETERS).axes) == 2
