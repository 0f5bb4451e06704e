"""Error against run time: who is ahead follows from the trials."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracstudy.inputs import Inputs
from fracstudy.style import save
from scenes.run_times.run_times import reference_times, scattered_sums
from scenes.run_times.which_method_shared import _off_the_front, run_time_goals, which_method
from scenes.run_times.work_precision_figures import time_to_accuracy as draw_bars
from scenes.run_times.work_precision_figures import work_precision as draw_fronts
from scenes.run_times.work_precision_shared import (
    best,
    front,
    time_to_accuracy,
    trials_of,
    work_precision,
)

NAN = float("nan")
# family, variant, group, error, set-up, solve, extrapolated
TRIALS = [
    ("GPSE", "one step, open, 3 terms, convolution", "ours", 1e-4, 1e-3, 3e-6, 1.0),
    ("GPSE", "one step, open, 3 terms, convolution", "ours", 1e-10, 2e-3, 4e-6, 1.0),
    ("KPSE", "order 12, open, 3 terms, series", "ours", 1e-9, 5e-3, 2e-3, 1.0),
    ("KPSE", "order 2, naive sums, RK2 steps", "papers", 1e-4, 1e-3, 30.0, 1e4),
    ("sinc-lattice", "open, convolution", "peers", 1e-4, 1e-4, 2e-6, 1.0),
    ("sinc-lattice", "open, convolution", "peers", 1e-9, 2e-4, 8e-6, 1.0),
    ("exact-symbol", "periodic, exact", "limit", 1e-3, 1e-4, 1e-6, 1.0),
    ("DVM", "order 4, M4' remeshing", "ours", NAN, 1e-3, NAN, NAN),
]


def frame(beta: float = 0.5) -> pd.DataFrame:
    columns = ["family", "variant", "group", "error", "setup_time", "solve_time", "extrapolated"]
    data = pd.DataFrame(TRIALS, columns=columns).assign(beta=beta, particles=57.0, solves=9)
    data["failure"] = np.where(np.isfinite(data["error"]), "", "it blew up")
    data.attrs = {"cpu": "a processor", "repeats": 9}
    return data


def inputs(parameters, **benchmarks) -> Inputs:
    return Inputs(scene="s", parameters=parameters, benchmarks=benchmarks)


def test_the_best_is_the_fastest_that_is_good_enough():
    trials = trials_of(inputs({}, b=frame()))
    assert best(trials, 1e-4, "solve_time")["family"] == "sinc-lattice"
    assert best(trials, 1e-9, "solve_time")["family"] == "GPSE"
    assert best(trials, 1e-9, "total_time")["family"] == "sinc-lattice"
    assert best(trials, 1e-11, "solve_time") is None
    assert trials["failed"].sum() == 1


def test_nothing_is_faster_and_better_than_the_front():
    trials = trials_of(inputs({}, b=frame()))
    on_front = trials[front(trials, "solve_time")]
    assert list(zip(on_front["family"], on_front["error"], strict=True)) == [
        ("GPSE", 1e-10), ("sinc-lattice", 1e-4), ("exact-symbol", 1e-3)
    ]  # fmt: skip
    random = np.random.default_rng(0)
    many = pd.DataFrame(
        {"error": random.random(300), "solve_time": random.random(300), "failed": False}
    )
    chosen = front(many, "solve_time")
    for place, row in many.iterrows():
        better = (many["error"] <= row["error"]) & (many["solve_time"] <= row["solve_time"])
        assert chosen[place] == (better.sum() == 1)


def test_a_row_for_each_beta_and_error(tmp_path):
    both = pd.concat([frame(0.5), frame(0.9)], ignore_index=True)
    both.attrs = frame().attrs
    given = inputs({"errors": [1e-3, 1e-4, 1e-9], "ylabel": "error"}, b=both)
    result = work_precision(given)
    assert len(result.table) == 6
    row = result.table.iloc[1]
    assert row["ours"] == "GPSE, one step, open, 3 terms, convolution"
    assert row["peer"] == "sinc-lattice, open, convolution"
    assert row["ours / peer"] == pytest.approx(1.5)
    assert row["ours / ms"] == pytest.approx(3e-3)
    assert row["the papers' way / ours"] == pytest.approx(1e7)
    assert np.isnan(row["limit / ms"])
    assert row["ours / peer, with set-up"] == pytest.approx(1.003e-3 / 1.02e-4)
    assert result.table["limit / ms"][0] == pytest.approx(1e-3)
    assert set(result.series["note"]) == {"a processor, one core; minimum of up to 9 repeats"}
    assert result.series["on front of solve_time"].sum() == 6
    save(draw_fronts(result.series, result.table, given.parameters), tmp_path / "fronts")
    assert (tmp_path / "fronts.svg").stat().st_size > 0


def test_bars_and_a_row_for_each_variant(tmp_path):
    given = inputs({"errors": [1e-3, 1e-9], "beta": 0.5}, b=frame())
    result = time_to_accuracy(given)
    table = result.table.set_index("method")
    assert table.loc["DVM", "failed"] == 1
    assert table.loc["GPSE", "trials"] == 2
    assert table.loc["GPSE", "least error"] == 1e-10
    assert table.loc["sinc-lattice", "1e-09 in / ms"] == pytest.approx(8e-3)
    assert np.isnan(table.loc["exact-symbol", "1e-09 in / ms"])
    bars = result.series.set_index(["error", "family", "group"])
    assert bool(bars.loc[(1e-3, "KPSE", "papers"), "extrapolated"])
    assert np.isnan(bars.loc[(1e-9, "DVM", "ours"), "solve_time"])
    save(draw_bars(result.series, result.table, given.parameters), tmp_path / "bars")
    assert (tmp_path / "bars.png").stat().st_size > 0


def situation(**changes):
    given = {
        "situation": "s", "take": "t", "benchmark": "work_precision", "beta": 0.5, "error": 1e-4,
        "time": "solve_time", "family": "GPSE", "variant": "convolution", **changes,
    }  # fmt: skip
    return given


@pytest.mark.parametrize(("changes", "ahead"), [
    ({}, "the peer"),
    ({"error": 1e-9}, "ours"),
    ({"error": 1e-10}, "ours"),
    ({"error": 1e-12}, "neither gets there"),
    ({"family": "DVM", "variant": "M4'"}, "the peer"),
    ({"family": "DVM", "variant": "M4", "against": "particles"}, "no rival"),
    ({"family": "GPSS"}, "not measured"),
    ({"against": "periodic, exact"}, "ours"),
    ({"error": 1e-9, "time": "total_time"}, "the peer"),
    ({"beta": 0.1}, "not measured"),
])  # fmt: skip
def test_who_is_ahead_follows_from_the_times(changes, ahead):
    given = inputs({"situations": [situation(**changes)]}, work_precision=frame())
    assert which_method(given).table["ahead"][0] == ahead


def test_two_times_within_a_fifth_are_a_tie():
    data = frame()
    data.loc[data["family"] == "sinc-lattice", "solve_time"] = 2.6e-6
    given = inputs({"situations": [situation()]}, work_precision=data)
    assert which_method(given).table["ahead"][0] == "a tie"


def reference() -> pd.DataFrame:
    names = [
        "particles", "steps", "operator_applications", "setup_time", "solve_time_median",
        "own_ratio", "floor_ratio", "own_pair_time", "fastest_pair_time", "single_pair_time",
        "cosine_pair_time", "peak_memory", "stepping_time", "stepping_deviation",
        "stepping_over_series", "naive_measured_steps", "naive_time",
    ]  # fmt: skip
    data = pd.DataFrame({name: [1.0, 1.0] for name in names})
    return data.assign(
        scheme=["KPSE", "KPSE"], order=[4, 2], solve_time=[0.1, 0.5],
        naive_over_series=[NAN, 2e4], fastest_pair="FFTW",
    )  # fmt: skip


def test_goals_are_met_or_not():
    goals = {"error 1e-8": 5.0, "error 1e-9": 1e-3, "set-up": 30.0, "printed lattice": 0.3}
    goals |= {"naive": 1e4, "front": 1.2}
    errors = [1e-4, 1e-9]
    given = inputs(
        {"goals": goals, "errors": errors}, work_precision=frame(), reference=reference()
    )
    table = run_time_goals(given).table
    assert list(table["measured"]) == pytest.approx([4e-3, 4e-3, 2.0, 2.0, 2.0, 0.1, 2e4, 1.5])
    assert list(table["met"]) == ["yes", "no", "yes", "no", "yes", "yes", "yes", "no"]


def test_a_goal_that_nobody_reaches_is_not_met():
    goals = {
        name: 1e9 for name in ("error 1e-8", "error 1e-9", "set-up", "printed lattice", "front")
    }
    peers_only = frame()[lambda data: data["group"] == "peers"]
    peers_only.attrs = frame().attrs
    given = inputs(
        {"goals": goals | {"naive": 0.0}, "errors": [1e-4]},
        work_precision=peers_only, reference=reference(),
    )  # fmt: skip
    met = run_time_goals(given).table["met"]
    assert list(met) == ["no"] * 5 + ["yes", "yes", "no"]


@pytest.mark.parametrize(("error", "ratio"), [(1e-9 * (1.0 + 1e-8), 1.0), (1e-9 * 1.1, 1.5)])
def test_errors_that_agree_are_one(error, ratio):
    """A peer and a trial of ours, of the same time: whether the error of ours is that of the peer, or larger."""
    data = frame()
    ours, peer = data.iloc[[0]], data[data["group"] == "peers"].iloc[[0]]
    same = {"failure": "", "setup_time": 0.0, "solve_time": 2.0}
    trials = pd.concat([
        peer.assign(error=1e-9, **same),
        ours.assign(error=error, **same),
        ours.assign(error=1e-10, **same | {"solve_time": 3.0}),
    ])  # fmt: skip
    assert _off_the_front(trials.assign(failed=False), [1e-3, 1e-9]) == pytest.approx(ratio)


def test_tables_of_the_reference_problem_and_of_scattered_sums():
    table = reference_times(inputs({}, reference=reference())).table
    assert list(table["order"]) == ["IV", "II"]
    assert list(table["series, min / ms"]) == [100.0, 500.0]
    sums = pd.DataFrame(
        {"particles": [100, 200], "transform_time": [1e-3, 2e-3], "naive_time": [2e-3, NAN], "deviation": [1e-12, NAN]}
    )  # fmt: skip
    table = scattered_sums(inputs({}, scattered=sums)).table
    assert table["naive / FFT"][0] == pytest.approx(2.0)
    assert table["ns a particle"][1] == pytest.approx(1e4)
