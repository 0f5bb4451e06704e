"""Error against run time: who is ahead follows from the trials."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracstudy.inputs import Inputs
from fracstudy.style import save
from scenes.run_times.contests import best, front, trials_of
from scenes.run_times.reference_times.study import study as reference_times
from scenes.run_times.run_time_goals.study import off_the_front
from scenes.run_times.run_time_goals.study import study as run_time_goals
from scenes.run_times.scattered_sums.study import study as scattered_sums
from scenes.run_times.time_to_accuracy.figure import figure as draw_bars
from scenes.run_times.time_to_accuracy.study import study as time_to_accuracy
from scenes.run_times.which_method.study import study as which_method
from scenes.run_times.work_precision.figure import figure as draw_fronts
from scenes.run_times.work_precision.study import study as work_precision

NAN = float("nan")
# contender, variant, group, error, set-up, solve, extrapolated
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
    columns = ["contender", "variant", "group", "error", "setup_time", "solve_time", "extrapolated"]
    data = pd.DataFrame(TRIALS, columns=columns).assign(beta=beta, particles=57.0, solves=9)
    data["failure"] = np.where(np.isfinite(data["error"]), "", "it blew up")
    data.attrs = {"cpu": "a processor", "repeats": 9}
    return data


def inputs(**benchmarks) -> Inputs:
    return Inputs(scene="s", benchmarks=benchmarks)


def test_the_best_is_the_fastest_that_is_good_enough():
    trials = trials_of(frame())
    assert best(trials, 1e-4, "solve_time")["contender"] == "sinc-lattice"
    assert best(trials, 1e-9, "solve_time")["contender"] == "GPSE"
    assert best(trials, 1e-9, "total_time")["contender"] == "sinc-lattice"
    none = best(trials, 1e-11, "solve_time")
    assert none["name"] == "none"
    assert np.isnan(none["solve_time"])
    assert trials["failed"].sum() == 1


def test_nothing_is_faster_and_better_than_the_front():
    trials = trials_of(frame())
    on_front = trials[front(trials, "solve_time")]
    assert list(zip(on_front["contender"], on_front["error"], strict=True)) == [
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
    result = work_precision(inputs(b=both), errors=[1e-3, 1e-4, 1e-9])
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
    save(draw_fronts(result.series, result.table, ylabel="error"), tmp_path / "fronts")
    assert (tmp_path / "fronts.svg").stat().st_size > 0


def test_bars_and_a_row_for_each_variant(tmp_path):
    result = time_to_accuracy(inputs(b=frame()), errors=[1e-3, 1e-9], beta=0.5)
    table = result.table.set_index("contender")
    assert table.loc["DVM", "failed"] == 1
    assert table.loc["GPSE", "trials"] == 2
    assert table.loc["GPSE", "least error"] == 1e-10
    assert table.loc["sinc-lattice", "1e-09 in / ms"] == pytest.approx(8e-3)
    assert np.isnan(table.loc["exact-symbol", "1e-09 in / ms"])
    bars = result.series.set_index(["error", "contender", "group"])
    assert bars.loc[(1e-3, "KPSE", "papers"), "extrapolated"] > 1.0
    assert np.isnan(bars.loc[(1e-9, "DVM", "ours"), "solve_time"])
    save(draw_bars(result.series, result.table), tmp_path / "bars")
    assert (tmp_path / "bars.png").stat().st_size > 0


def situation(**changes):
    given = {
        "situation": "s", "take": "t", "benchmark": "work_precision", "beta": 0.5, "error": 1e-4,
        "time": "solve_time", "contender": "GPSE", "variant": "convolution", **changes,
    }  # fmt: skip
    return given


@pytest.mark.parametrize(("changes", "ahead"), [
    ({}, "the peer"),
    ({"error": 1e-9}, "ours"),
    ({"error": 1e-10}, "ours"),
    ({"error": 1e-12}, "neither gets there"),
    ({"contender": "DVM", "variant": "M4'"}, "the peer"),
    ({"contender": "DVM", "variant": "M4", "against": "particles"}, "no rival"),
    ({"contender": "GPSS"}, "not measured"),
    ({"against": "periodic, exact"}, "ours"),
    ({"error": 1e-9, "time": "total_time"}, "the peer"),
    ({"beta": 0.1}, "not measured"),
])  # fmt: skip
def test_who_is_ahead_follows_from_the_times(changes, ahead):
    given = inputs(work_precision=frame())
    table = which_method(given, situations=[situation(**changes)]).table
    assert table["ahead"][0] == ahead


def test_two_times_within_a_fifth_are_a_tie():
    data = frame()
    data.loc[data["contender"] == "sinc-lattice", "solve_time"] = 2.6e-6
    table = which_method(inputs(work_precision=data), situations=[situation()]).table
    assert table["ahead"][0] == "a tie"


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
    given = inputs(work_precision=frame(), reference_times=reference())
    table = run_time_goals(given, goals=goals, errors=errors).table
    assert list(table["measured"]) == pytest.approx([4e-3, 4e-3, 2.0, 2.0, 2.0, 0.1, 2e4, 1.5])
    assert list(table["met"]) == ["yes", "no", "yes", "no", "yes", "yes", "yes", "no"]


def test_a_goal_that_nobody_reaches_is_not_met():
    goals = {
        name: 1e9 for name in ("error 1e-8", "error 1e-9", "set-up", "printed lattice", "front")
    }
    peers_only = frame()[lambda data: data["group"] == "peers"]
    peers_only.attrs = frame().attrs
    given = inputs(work_precision=peers_only, reference_times=reference())
    met = run_time_goals(given, goals=goals | {"naive": 0.0}, errors=[1e-4]).table["met"]
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
    assert off_the_front(trials.assign(failed=False), [1e-3, 1e-9]) == pytest.approx(ratio)


def test_tables_of_the_reference_problem_and_of_scattered_sums():
    table = reference_times(inputs(reference_times=reference())).table
    assert list(table["order"]) == ["IV", "II"]
    assert list(table["series, min / ms"]) == [100.0, 500.0]
    sums = pd.DataFrame(
        {"particles": [100, 200], "transform_time": [1e-3, 2e-3], "naive_time": [2e-3, NAN], "deviation": [1e-12, NAN]}
    )  # fmt: skip
    table = scattered_sums(inputs(scattered_sums=sums)).table
    assert table["naive / FFT"][0] == pytest.approx(2.0)
    assert table["ns a particle"][1] == pytest.approx(1e4)
