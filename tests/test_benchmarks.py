"""The benchmarks on tiny problems: their structure and their arithmetic, no run times."""

from __future__ import annotations

import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pyfftw
import pytest
from threadpoolctl import threadpool_limits

import fracparticles as fp
from fracparticles.errors import NonFiniteSolution
from fracparticles.lattice.fourier import transform_length
from fracparticles.moving.random_walk import cell_masses
from fracparticles.run.dataset import read_benchmark, write
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute
from fracparticles.schemes.stability import _symbol_range, stability_limit
from fracstudy.benchmarks import clock
from fracstudy.benchmarks.problem import Problem
from fracstudy.benchmarks.sweeps import (
    graded_trials,
    lent_exterior_trials,
    matrix_trials,
    naive_trials,
    one_step_trials,
    particle_trials,
    peer_trials,
    plane_peer_trials,
    scheme_trials,
    stepped_trials,
    tied_step_trials,
    walk_trials,
)
from fracstudy.benchmarks.trial import Ready, Trial, run_trials
from fracstudy.peers import PEERS
from scene_functions import scenes
from scenes.run_times.reference_times.benchmark import benchmark as reference
from scenes.run_times.reference_times.benchmark import transform_pairs

LINE, PLANE = Problem(0.5), Problem(0.5, dim=2)
GRID = {"spacings": [0.4], "truncations": [5.0], "most": 1000}
OPEN = {"exterior": "open", "far_terms": 3}
PEER_GRID = {**GRID, "scales": [2.5], "scaled_spacings": [0.4]}


def solved(trial: Trial, problem: Problem = LINE):
    contender = trial.prepare()
    u0 = contender.start(problem)
    u = contender.solve(u0)
    return contender, u, contender.error(problem, u)


# --- the clock ------------------------------------------------------------------------------------


def test_an_action_is_repeated_until_the_time_is_up():
    timing, result = clock.measure(lambda: 7, repeats=5)
    assert result == 7
    assert len(timing.times) == 5
    assert timing.minimum <= timing.median <= max(timing.times)
    short, _ = clock.measure(lambda: None, repeats=100, seconds=0.0)
    assert len(short.times) == 1
    assert len((timing + short).times) == 6


def test_tables_are_forgotten():
    stability_limit("KPSE", 0.5)
    assert _symbol_range.cache_info().currsize > 0
    clock.forget_tables()
    forgotten = pyfftw.export_wisdom()[0]
    assert _symbol_range.cache_info().currsize == 0
    pyfftw.FFTW(pyfftw.zeros_aligned(346), pyfftw.zeros_aligned(174, dtype=complex))
    assert len(pyfftw.export_wisdom()[0]) > len(forgotten)


def test_a_benchmark_takes_one_thread_of_blas():
    with threadpool_limits(2):
        assert clock.machine()["threads_blas"] == 2
        clock.one_core()
        assert clock.machine()["threads_blas"] == 1


def test_peak_memory_is_that_of_a_process_of_its_own():
    """An interpreter with numpy and numba takes some hundred megabytes; what is here must not count."""
    here = np.ones(100_000_000)
    assert 2e7 < clock.in_fresh_process(clock.peak_so_far) < here.nbytes


def test_rows_become_a_data_set_and_a_frame(tmp_path):
    rows = [{"name": "a", "x": 1.0, "what": ""}, {"name": "b", "what": "broken"}]
    data = clock.timings_dataset(
        "row", rows, {"name": "a name"}, {"x": ("a number", "s"), "what": ("a text", "1")}, "t", {"repeats": 3}
    )  # fmt: skip
    write(data, tmp_path / "rows.nc")
    frame = read_benchmark(tmp_path / "rows.nc")
    assert list(frame["name"]) == ["a", "b"]
    assert list(frame["what"]) == ["", "broken"]
    assert frame["x"][0] == 1.0
    assert np.isnan(frame["x"][1])
    assert frame.attrs["repeats"] == 3
    for fact in (
        "cpu",
        "cores",
        "threads_numba",
        "threads_blas",
        "python",
        "numpy",
        "pyfftw",
        "load_average",
        "other_load",
    ):
        assert fact in frame.attrs, fact


def test_a_benchmark_says_the_commit_as_a_run_does():
    """Package, version and, in a checkout, the commit."""
    case = fp.Case(scheme="KPSE", beta=0.5, half_width=8.0, spacing=0.5, integrator="exponential")
    data = clock.timings_dataset("row", [{"x": 1.0}], {}, {"x": ("a number", "s")}, "t", {})
    assert data.attrs["source"] == fp.solve(case).attrs["source"]
    assert data.attrs["source"].startswith(f"fracparticles {fp.__version__}")


def test_what_was_measured_elsewhere_says_its_own_facts():
    data = clock.timings_dataset("row", [], {}, {}, "t", {"threads_numba": 3})
    assert data.attrs["threads_numba"] == 3
    assert data.attrs["threads_blas"] == clock.conditions()["threads_blas"]


def test_the_load_of_others_is_that_beside_the_clock():
    """Another process that counts takes a core, or its share of one; what this process takes does not count."""
    busy = [sys.executable, "-c", "while True: pass"]
    clock.one_core()
    assert np.isnan(clock.other_load())
    with subprocess.Popen(busy) as other:
        time.sleep(0.2)  # until it has begun
        clock.measure(lambda: time.sleep(0.5))
        other.kill()
    assert clock.other_load() > 0.4
    before = clock.other_load()
    clock.one_core()
    clock.measure(lambda: sum(range(10_000_000)))
    assert clock.other_load() < before + 0.5


def test_every_benchmark_is_found():
    measured = [scene for scene in scenes().values() if scene.benchmark is not None]
    assert {"work_precision", "reference_times"} <= {scene.name for scene in measured}
    for scene in measured:
        assert callable(scene.function("benchmark"))


# --- the problem and the contenders ---------------------------------------------------------------


@pytest.mark.parametrize(("dim", "spacing"), [(1, 0.1), (2, 0.4)])
def test_the_error_is_that_of_the_runs(dim, spacing):
    case = fp.Case(
        scheme="KPSE", beta=0.5, dim=dim, truncation=4.0, spacing=spacing, integrator="exponential"
    )
    problem, run = Problem(0.5, dim=dim), compute(case)
    radius = np.abs(case.x) if dim == 1 else case.radius
    ours = problem.error(radius, case.particle_spacing**dim, run.u)
    assert ours == pytest.approx(relative_l1_error(case, run.u), rel=1e-13)
    assert problem.half_width(4.0) == case.reach


def test_unequal_volumes_count():
    x = np.array([-1.0, 0.0, 2.0])
    exact = fp.green(x, 1.5, 1.5)
    u = exact + np.array([0.1, 0.0, 0.2])
    one, two = (LINE.error(np.abs(x), v, u) for v in (np.array([1.0, 1.0, 3.0]), 1.0))
    assert one / two == pytest.approx(0.7 / 0.3)


def test_every_trial_solves_the_problem():
    """To a few per cent on a lattice of half the width of the initial data, whoever it is."""
    grid = {"spacings": [0.25], "truncations": [8.0], "most": 1000}
    trials = [
        *scheme_trials(LINE, ("DD", "FPSE", "KPSE"), [4], {**OPEN, "evaluation": "series"}, **grid),
        *scheme_trials(LINE, ("KPSE",), [12], {**OPEN, "evaluation": "convolution"}, **grid),
        *one_step_trials(LINE, OPEN, **grid),
        *one_step_trials(LINE, {**OPEN, "evaluation": "convolution"}, **grid),
        *tied_step_trials(LINE, OPEN, **grid),
        *peer_trials(LINE, **{**PEER_GRID, **grid}),
        *lent_exterior_trials(LINE, **grid),
        *graded_trials(LINE, [81], [80.0], [3.0]),
        *particle_trials(LINE, [4], 8.0, [0.25], [100]),
        *naive_trials(LINE, ["KPSE", "FD"], [2, 4], 1e-3, 1, **grid),
    ]
    assert {trial.contender for trial in trials} == {
        "DD", "FPSE", "KPSE", "GPSE", "DVM", "FD", *PEERS
    }  # fmt: skip
    for trial in trials:
        _, _, error = solved(trial)
        assert error < 0.06, trial


def test_the_lent_exterior_is_that_of_gpse():
    """At epsilon / h = 5 the aliases of GPSE, at most exp(-(pi epsilon / h)^alpha), are zero: the sums are the same."""
    grid = {"spacings": [0.2], "truncations": [5.0], "most": 1000}
    way = {**OPEN, "evaluation": "convolution"}
    (lent,), (ours,) = lent_exterior_trials(LINE, **grid), one_step_trials(LINE, way, **grid)
    assert solved(lent)[1] == pytest.approx(solved(ours)[1], rel=1e-12)
    (own,) = (
        trial
        for trial in peer_trials(LINE, **{**PEER_GRID, **grid})
        if trial.contender == "sinc-lattice" and trial.variant == "open, convolution"
    )
    assert solved(own)[2] > 100.0 * solved(lent)[2]


def test_walkers_are_compared_with_the_mass_of_each_cell():
    (trial,) = walk_trials(LINE, [40_000], 50)
    contender, u, error = solved(trial)
    half = LINE.error_radius
    masses = cell_masses(np.linspace(-half, half, 51), 1.5, 1.5)
    assert contender.radius.size == 40_000
    assert u.sum() == pytest.approx(masses.sum(), abs=4.0 / np.sqrt(40_000))
    # The mean of |N_k / n - p_k| is sqrt(2 p_k / (pi n)); summed over 50 cells, its spread is a seventh of that.
    expected = np.sqrt(2.0 * masses / (np.pi * 40_000)).sum() / masses.sum()
    assert error == pytest.approx(expected, rel=0.5)


def test_a_naive_trial_takes_a_few_steps_and_counts_all():
    (trial,) = naive_trials(LINE, ["KPSE"], [2], 1e-3, 4, **GRID)
    contender, u, error = solved(trial)
    assert contender.scale == 250.0
    assert contender.applications == 2000
    case = fp.Case(scheme="KPSE", beta=0.5, truncation=5.0, spacing=0.4, dt=1e-3)
    assert error == pytest.approx(relative_l1_error(case, compute(case).u), rel=1e-12)
    four = fp.Case(
        scheme="KPSE", beta=0.5, half_width=case.reach, spacing=0.4, dt=1e-3, t_final=0.504
    )
    assert u == pytest.approx(compute(four).u, rel=1e-12)


def test_only_stable_steps_are_taken():
    fields = {"scheme": "KPSE", "order": 4, "exterior": "open", "truncation": 5.0, "spacing": 0.2}
    trials = list(stepped_trials(LINE, ["rk2", "rk4"], ["series"], [1, 4, 16, 64, 256], **fields))
    limit = stability_limit("KPSE", 0.5, 4) * 0.2**1.5
    assert 0 < len(trials) < 10
    assert max(trial.dt for trial in trials if "rk2" in trial.variant) <= limit * 1.001


@pytest.mark.parametrize("problem", [LINE, PLANE])
def test_a_matrix_is_the_run_itself(problem):
    grid = {"spacings": [0.8], "truncations": [5.0], "most": 1000}
    way = OPEN if problem is LINE else {"exterior": "open"}
    (trial,) = one_step_trials(problem, way, **grid)
    (matrix,) = matrix_trials([trial], 1000)
    assert matrix.variant == f"{trial.variant}, matrix"
    _, u, _ = solved(trial, problem)
    _, v, _ = solved(matrix, problem)
    assert v == pytest.approx(u, rel=1e-12, abs=1e-15)
    assert not list(matrix_trials([trial], 10))


def test_peers_of_the_plane_solve_the_problem():
    trials = list(plane_peer_trials(PLANE, spacings=[0.4], truncations=[4.0], most=5000))
    assert {trial.group for trial in trials} == {"peers", "limit"}
    for trial in trials:
        assert solved(trial, PLANE)[2] < 0.02, trial


def test_nothing_is_judged_on_less_than_the_whole_norm():
    """Neither a lattice nor graded particles that end within |x| <= 5 R_alpha."""
    half = LINE.error_radius / LINE.half_width(1.0)
    grid = {"spacings": [0.1], "truncations": [0.9 * half, 1.1 * half], "most": 1000}
    assert [trial.truncation for trial in one_step_trials(LINE, OPEN, **grid)] == [1.1 * half]
    reaches = [0.9 * LINE.error_radius, 1.1 * LINE.error_radius]
    assert len(list(graded_trials(LINE, [21], reaches, [1.0]))) == 3  # the three forms


def test_lattices_too_small_or_too_large_are_left_out():
    grid = {"spacings": [0.1, 0.4, 4.0], "truncations": [5.0], "most": 100}
    assert [trial.spacing for trial in one_step_trials(LINE, OPEN, **grid)] == [0.4]


# --- trials ---------------------------------------------------------------------------------------


def failing() -> Ready:
    def solve(u0):
        raise NonFiniteSolution("it blew up\nas it should")

    return Ready(np.zeros(3), 1.0, solve)


def test_rows_of_trials():
    good = next(one_step_trials(LINE, OPEN, **GRID))
    bad = Trial("KPSE", "none", "ours", failing, points=3.0)
    rows = run_trials(LINE, [good, bad, replace(good)], rounds=2, repeats=3, seconds=1.0)
    assert [row["failure"] for row in rows] == ["", "it blew up", ""]
    assert "solve_time" not in rows[1]
    for row in (rows[0], rows[2]):
        assert row["setups"] == 3
        assert row["solves"] == 7
        assert row["solve_time_median"] >= row["solve_time"] > 0.0
        assert row["error"] == rows[0]["error"]
        assert row["particles"] == 57


def test_trials_off_the_front_are_timed_once():
    """A narrow lattice has a larger error, and with a hundred times the particles it is slower, too."""
    wide = one_step_trials(LINE, OPEN, spacings=[0.2], truncations=[7.0], most=1e5)
    narrow = one_step_trials(LINE, OPEN, spacings=[0.001], truncations=[4.0], most=1e5)
    rows = run_trials(LINE, [*wide, *narrow], rounds=2, repeats=2, seconds=1.0)
    assert [row["setups"] for row in rows] == [3, 1]


# --- the reference problem ------------------------------------------------------------------------


@pytest.fixture(scope="module")
def data():
    return reference(
        repeats=2, truncation=4.0, spacing=0.1, dt=5e-3, green_dt=0.05, stepping=["KPSE"],
        naive=["KPSE"], naive_steps=2, memory=False, measured_plans=False,
    )  # fmt: skip


def test_every_scheme_is_there(data):
    runs = list(zip(data["scheme"].values, data["order"].values, strict=True))
    one_pass = [(scheme, order) for scheme in ("DD", "FPSE", "KPSE") for order in (2, 4)]
    assert runs == [*one_pass, ("GPSE", 2)]


def test_ratios_follow_from_the_times(data):
    pairs = data["operator_applications"] * data["fastest_pair_time"]
    assert data["floor_ratio"].values == pytest.approx((data["solve_time"] / pairs).values)
    assert (data["own_ratio"] <= data["floor_ratio"]).all()
    assert (data["transform_length"] == transform_length(2 * int(data["particles"][0]) - 1)).all()
    for name in ("setup_time", "single_pair_time", "cosine_pair_time"):
        assert (data[name] > 0.0).all(), name


def test_stepping_and_naive_steps_are_those_of_the_schemes_asked_for(data):
    asked = (data["scheme"] == "KPSE") & (data["order"] == 2)
    for name in ("stepping_time", "naive_step_time", "naive_over_series", "stepping_over_series"):
        assert (np.isfinite(data[name]) == asked).all(), name
    run = data.isel(run=int(np.flatnonzero(asked)[0]))
    assert run["stepping_applications"] == 2 * run["steps"] == 400
    assert run["naive_measured_steps"] == 2
    assert run["naive_time"] == pytest.approx(float(run["naive_step_time"] * run["steps"]))
    # Series and stepping are one polynomial of A: 400 products, each with a rounding error of some ulp.
    assert run["stepping_deviation"] < 400 * 4 * np.finfo(float).eps


@pytest.mark.parametrize("length", [64, 250])
def test_a_transform_pair_can_be_repeated(length):
    for pair in transform_pairs(length, measured_plans=True).values():
        pair()
        pair()
