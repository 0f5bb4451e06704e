"""The stiff and extreme cases: every one must come out as expected."""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from scene_functions import figure, study
from scenes.beyond.stiff_extreme.study import UNEXPECTED

PARAMETERS = {
    "beta": 0.5,
    "half_width": 5.0,
    "spacing": 0.2,
    "factors": [0.9, 0.99, 1.01, 1.1],
}


@pytest.fixture(scope="module")
def result():
    return study("stiff_extreme")(Inputs("stiff_extreme"), **PARAMETERS)


def test_every_case_comes_out_as_expected(result):
    unexpected = result.table[result.table["verdict"] == UNEXPECTED]
    assert unexpected.empty, unexpected.to_markdown(index=False)


def test_what_must_blow_up_does(result):
    blown = result.table[result.table["verdict"] == "blows up as predicted"]
    assert set(blown["what"]) == {"stability limit", "overflow", "small overlap"}


def test_the_work_of_the_series_grows_like_the_root_of_the_stiffness(result):
    work = result.series[result.series["panel"] == "work"]
    exponential = work[work["series"] == "exponential"].set_index("x")["y"]
    # degree ~ sqrt(2 log(1 / eps) T |low|) once T |low| >> log(1 / eps) = 37
    assert exponential.loc[1e5] / exponential.loc[1e3] == pytest.approx(10.0, rel=0.05)


def test_the_figure_is_drawn(result):
    assert len(figure("stiff_extreme")(result.series, result.table, PARAMETERS).axes) == 2
