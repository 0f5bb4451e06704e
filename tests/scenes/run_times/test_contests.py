"""Error against run time: who is ahead follows from the trials."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracparticles.errors import FracparticlesError
from fracstudy.figure_files import save
from fracstudy.inputs import Inputs
from scene_functions import figure, measured, study
from scenes.run_times.contests import best, columns, duration, front, trials_of
from scenes.run_times.first_call import benchmark as programs
from scenes.run_times.run_time_goals.study import behind
from scenes.run_times.step_times.benchmark import benchmark as step_times

NAN = float("nan")
# contender, variant, group, error, set-up, solve, block
TRIALS = [
    ("evolve", "2 terms", "ours", 1e-4, 1e-4, 1e-5, 1e-6),
    ("evolve", "4 terms", "ours", 1e-10, 2e-4, 1e-5, 4e-6),
    ("KPSE", "order 12, series", "schemes", 1e-9, 5e-3, 2e-3, NAN),
    ("papers' way", "DD 2", "papers", 1e-4, 1e-3, 30.0, NAN),
    ("rational functions", "", "peers", 1e-4, 5e-5, 5e-6, 5e-7),
    ("rational functions", "", "peers", 1e-9, 3e-4, 3e-5, 1e-6),
    ("DVM", "order 4", "schemes", NAN, 1e-3, NAN, NAN),
]


def frame(problem: str = "mixture", beta: float = 0.5) -> pd.DataFrame:
    columns = ["contender", "variant", "group", "error", "setup_time", "solve_time", "block_time"]
    data = pd.DataFrame(TRIALS, columns=columns)
    data = data.assign(problem=problem, beta=beta, points=57.0, peak_memory=2e4, tail_error=0.1)
    data["failure"] = np.where(np.isfinite(data["error"]), "", "it blew up")
    data.attrs = {"cpu": "a processor", "repeats": 9, "dim": 1}
    return data


def inputs(**benchmarks) -> Inputs:
    return Inputs(scene="s", benchmarks=benchmarks)


def test_a_heading_says_its_unit():
    data = pd.DataFrame({"t": [2e-3], "m": [3e6], "who": ["a"]})
    names = {
        "who": "who",
        "set-up / ms": "t",
        "set-up / s": "t",
        "memory / MB": "m",
        "a / its own": "m",
    }
    (row,) = columns(data, names).to_dict("records")
    assert row == {
        "who": "a",
        "set-up / ms": 2.0,
        "set-up / s": 2e-3,
        "memory / MB": 3.0,
        "a / its own": 3e6,
    }


def test_the_best_is_the_fastest_that_is_good_enough():
    trials = trials_of(frame())
    assert best(trials, 1e-4)["name"] == "rational functions"
    assert best(trials, 1e-9)["name"] == "evolve, 4 terms"
    assert best(trials, 1e-9, "block_time")["name"] == "rational functions"
    none = best(trials, 1e-11)
    assert none["name"] == "none"
    assert np.isnan(none["total_time"])
    assert trials["failed"].sum() == 1


def test_nothing_is_faster_and_better_than_the_front():
    trials = trials_of(frame())
    on_front = trials[front(trials, "total_time")]
    assert list(zip(on_front["contender"], on_front["error"], strict=True)) == [
        ("evolve", 1e-10), ("rational functions", 1e-4)
    ]  # fmt: skip
    random = np.random.default_rng(0)
    many = pd.DataFrame(
        {"error": random.random(300), "solve_time": random.random(300), "failed": False}
    )
    chosen = front(many, "solve_time")
    for place, row in many.iterrows():
        better = (many["error"] <= row["error"]) & (many["solve_time"] <= row["solve_time"])
        assert chosen[place] == (better.sum() == 1)


@pytest.mark.parametrize("betas", [(0.5,), (0.5, 0.9)])
def test_a_row_for_each_problem_beta_and_error(tmp_path, betas):
    both = pd.concat(
        [frame(name, b) for name in ("mixture", "compact") for b in betas], ignore_index=True
    )
    both.attrs = frame().attrs
    result = study("work_precision")(inputs(b=both), errors=[1e-4, 1e-9], time="total_time")
    assert len(result.table) == 4 * len(betas)
    first, second = result.table.iloc[0], result.table.iloc[1]
    assert first["ours"] == "evolve, 2 terms"
    assert first["ours / ms"] == pytest.approx(0.11)
    assert first["ours / peer"] == pytest.approx(2.0)
    assert second["scheme of the papers"] == "KPSE, order 12, series"
    assert second["ours / peer"] == pytest.approx(0.21 / 0.33)
    blocks = study("work_precision")(inputs(b=both), errors=[1e-9], time="block_time").table
    assert blocks["ours / peer"][0] == pytest.approx(4.0)
    assert blocks["scheme of the papers"][0] == "none"
    parameters = {"time": "total_time", "ylabel": "error"}
    drawn = figure("work_precision")(result.series, result.table, parameters)
    save(drawn, tmp_path / "fronts", ["svg"])
    assert (tmp_path / "fronts.svg").stat().st_size > 0


def test_the_first_three():
    table = study("time_to_accuracy")(inputs(b=frame()), errors=[1e-3, 1e-9]).table
    assert table["first"].tolist() == ["rational functions", "evolve, 4 terms"]
    assert table["second"].tolist() == ["evolve, 2 terms", "rational functions"]
    assert table["third"].tolist() == ["KPSE, order 12, series"] * 2
    assert table["memory / kB"].tolist() == [20.0, 20.0]


def situation(**changes):
    return {"situation": "s", "take": "t", "code": "c", "contender": "evolve", **changes}


@pytest.mark.parametrize(("changes", "faster"), [
    ({"error": 1e-4}, "rational functions (2 times)"),
    ({"error": 1e-9}, "nobody (rational functions: 1.6 times as long)"),
    ({"error": 1e-10}, "nobody (no other gets there)"),
    ({"error": 1e-12}, "nobody gets there"),
    ({"error": 1e-10, "contender": "DVM"}, "nobody gets there"),
    ({"error": 1e-9, "contender": "DVM"}, "rational functions (this does not get there)"),
    ({"error": 1e-9, "time": "block_time"}, "rational functions (4 times)"),
])  # fmt: skip
def test_who_is_faster_follows_from_the_times(changes, faster):
    table = study("which_method")(
        inputs(work_precision=frame()), situations=[situation(**changes)]
    ).table
    assert table["faster"][0] == faster


def test_two_times_within_a_fifth_are_a_tie():
    data = frame()
    data.loc[data["contender"] == "rational functions", "setup_time"] = 1e-4
    table = study("which_method")(
        inputs(work_precision=data), situations=[situation(error=1e-4)]
    ).table
    assert table["faster"][0] == "nobody (rational functions: a tie)"


def test_a_situation_may_be_timed_by_a_table():
    rows = [("a", "ours", 3.0), ("b", "peer", 4000.0), ("c", "peer", 2.0), ("d", "peer", NAN)]
    table = pd.DataFrame(rows, columns=["contender", "group", "to 1e-06 / ms"]).assign(problem="p")
    given = Inputs(scene="s", tables={"least": table})
    where = {"measured": "least", "problem": "p"}
    both = [situation(contender=name, **where) for name in "ab"]
    found = study("which_method")(given, situations=both).table
    assert found["cost"].tolist() == ["3.0 ms to 1e-06", "4.0 s to 1e-06"]
    assert found["faster"][0] == "c (1.5 times)"
    with pytest.raises(FracparticlesError, match="no trial of e in least"):
        study("which_method")(given, situations=[situation(contender="e", **where)])


@pytest.mark.parametrize(("seconds", "text"), [
    (3.0, "3.0 s"), (0.0125, "12 ms"), (9.97e-5, "100 µs"), (9.2e-8, "92 ns"),
])  # fmt: skip
def test_a_time_has_two_digits_and_a_unit(seconds, text):
    assert duration(seconds) == text


def test_a_contender_that_was_not_measured_is_named():
    with pytest.raises(FracparticlesError, match="GPSS"):
        study("which_method")(
            inputs(work_precision=frame()), situations=[situation(contender="GPSS")]
        )


def reference() -> pd.DataFrame:
    names = [
        "particles", "steps", "operator_applications", "setup_time", "solve_time_median",
        "own_ratio", "floor_ratio", "own_pair_time", "fastest_pair_time", "single_pair_time",
        "cosine_pair_time", "stepping_time", "stepping_deviation",
        "stepping_over_series", "stepping_measured_steps", "naive_measured_steps", "naive_time",
    ]  # fmt: skip
    data = pd.DataFrame({name: [1.0, 1.0] for name in names})
    return data.assign(
        scheme=["KPSE", "KPSE"], order=[4, 2], solve_time=[0.1, 0.5],
        naive_over_series=[NAN, 2e4], fastest_pair="FFTW",
    )  # fmt: skip


def test_goals_are_met_or_not():
    goals = {
        "ahead": 1.2,
        "transforms": 1.15,
        "printed lattice": 0.3,
        "naive": 1e4,
        "first call": 0.7,
        "growth": 1.1,
        "memory truncated": 12.0,
        "memory open": 40.0,
    }
    races = {f"work_precision{where}": frame() for where in ("", "_plane", "_space")}
    calls = pd.DataFrame({"call": ["an empty program", "fp.evolve"], "run_time": [0.01, 0.8]})
    growth = pd.DataFrame(
        [
            (1, kind, n, 1e-8 * n, 1e-9 * n**power, memory * (1.0 + 1e3 / n))
            for kind, power, memory in (("KPSE-2-truncated", 1.0, 80.0), ("KPSE-12-open", 1.2, 400.0))
            for n in (1e6, 1e4)
        ],
        columns=["dim", "kind", "particles", "setup_time", "application_time", "memory_per_particle"],
    )  # fmt: skip
    given = inputs(**races, reference_times=reference(), first_call=calls, cost_growth=growth)
    table = study("run_time_goals")(given, goals=goals, errors=[1e-4, 1e-9]).table
    grown = [1.0, 1.2, 10.01, 50.05]
    assert list(table["measured"]) == pytest.approx([2.0, 2.0] * 3 + [1.0, 0.1, 2e4, 0.8, *grown])
    assert list(table["met"]) == ["no"] * 6 + ["yes", "yes", "yes", "no"] + ["yes", "no"] * 2


def test_who_does_not_get_there_is_infinitely_behind():
    trials = trials_of(frame())
    ours = trials["group"] == "ours"
    assert behind(trials, [1e-4], ours) == pytest.approx(2.0)
    assert behind(trials, [1e-9], trials["contender"] == "KPSE") == pytest.approx(7.0 / 0.21)
    assert behind(trials[~ours], [1e-9], ours[~ours]) == np.inf
    assert np.isnan(behind(trials, [1e-12], ours))


def test_tables_of_the_reference_problem_and_of_scattered_sums():
    table = study("reference_times")(inputs(reference_times=reference())).table
    assert list(table["order"]) == ["IV", "II"]
    assert list(table["series, min / ms"]) == [100.0, 500.0]
    sums = pd.DataFrame(
        {"particles": [100, 200], "transform_time": [1e-3, 2e-3], "naive_time": [2e-3, NAN], "deviation": [1e-12, NAN]}
    )  # fmt: skip
    table = study("scattered_sums")(inputs(scattered_sums=sums)).table
    assert table["naive / FFT"][0] == pytest.approx(2.0)
    assert table["ns a particle"][1] == pytest.approx(1e4)


def test_a_first_call_and_a_step_are_timed(monkeypatch):
    """The benchmarks themselves, as small as they can be; every program of the first is in each smoke run."""
    few = dict(list(programs._CALLS.items())[:3])
    monkeypatch.setattr(programs, "_CALLS", few)
    calls = measured(programs.benchmark(repeats=1))
    table = study("first_call")(inputs(first_call=calls)).table
    assert (table["process, min / s"] > 0.0).all()
    assert table["beyond an empty program / s"].iloc[0] == 0.0
    data = measured(step_times(line=201, plane=21, repeats=1))
    found = study("step_times")(inputs(step_times=data)).table
    assert set(found["dim"]) == {1, 2}
    exact = found[found["method"].str.startswith("exact")]
    assert exact["time / exact symbol"].tolist() == [1.0, 1.0]
