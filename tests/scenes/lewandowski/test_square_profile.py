"""The runs of the square profile that the marker scenes share."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError

from fracparticles.markers import Square
from fracparticles.moving.lagrangian import FieldNotPositive
from scenes.lewandowski.square_profile import SquareRuns, Starts, delay, load

RUNS = SquareRuns(dt=0.05, t_final=0.5, markers=48, half_width=14.0, grid=120)


def test_a_delayed_solution_is_recognised():
    grid = np.linspace(-12.0, 12.0, 201)
    tau, left = delay(grid, Square().value(grid, 3.7), 4.0)
    assert tau == pytest.approx(0.3, abs=1e-4)  # the tolerance of the minimisation, 1e-5
    assert left < 1e-3


def test_the_readings_of_the_start():
    x, weights = load("midpoints", 8)
    assert x == pytest.approx(np.arange(-7.0, 8.0, 2.0) / 8.0, abs=1e-15)
    assert weights == pytest.approx(np.full(8, 0.25))
    x, weights = load("wide", 256, half_width=14.0)
    assert x.size == 18  # 2 / (28 / 256), cells whose middle lies inside
    assert np.abs(x).max() <= 1.0


def test_a_run_can_be_judged_at_its_end_only():
    followed = RUNS.trace("S8", "midpoints")
    end = RUNS.trace("S8", "midpoints", follow=False)
    assert followed.t.size == 11
    assert end.t == pytest.approx([0.5])
    assert end.error[-1] == followed.error[-1]
    assert end.last[0] == pytest.approx(0.5)
    assert (end.last[1] == end.end.x).all()


def test_a_run_that_stops_says_so():
    # A marker far ahead of the others comes to where S8 of all the rest is negative.
    runs = RUNS.having(dt=0.0125, t_final=1.0, markers=256, grid=10)
    found = runs.trace("S8", "random", 2005)
    assert found.run is None
    assert "step 75 of 80, from t = 0.925 to 0.9375: the field is" in found.stopped
    assert found.t[-1] == found.last[0] == pytest.approx(0.925)
    with pytest.raises(FieldNotPositive, match="random"):
        _ = found.end


def test_the_starts_are_one_each_but_the_random_one():
    starts = Starts(RUNS, ["S4"], range(3, 5))
    assert list(starts.measured["loading"]) == ["midpoints", "random", "random", "wide"]
    assert [trace.seed for trace in starts.first] == [3, 3, 3]
    assert len(starts.table(["maxima"])) == 3


def test_a_misspelt_parameter_is_refused():
    with pytest.raises(ValidationError):
        RUNS.having(marker=12)
