"""The benchmarks against the number of particles, and their study: structure and arithmetic, no run times."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pandas as pd
import pytest

from fracparticles.moving.scattered import NonuniformFourierSum
from fracparticles.run.dataset import read_benchmark, write
from fracparticles.run.solver import prepare
from fracstudy.figure_files import save
from fracstudy.inputs import Inputs
from scene_functions import measured
from scenes.run_times.cost_growth.benchmark import _SHORT, _START, _case, _strengths
from scenes.run_times.cost_growth.benchmark import benchmark as measure_growth
from scenes.run_times.cost_growth.figure import _range as ranged
from scenes.run_times.cost_growth.figure import figure as draw
from scenes.run_times.cost_growth.study import exponent, extrapolate
from scenes.run_times.cost_growth.study import study as cost_growth
from scenes.run_times.scattered_sums.benchmark import benchmark as scattered
from sweeps import covering

KINDS = {
    "line": ["KPSE-12-open", "FPSE-4-truncated"],
    "square": ["KPSE-2-truncated"],
    "cube": ["KPSE-2-truncated"],
}
LIMITS = {"naive_particles": 500, "most_solved": 4000, "repeats": 2, "seconds": 0.1}
TARGET = 1e9
YEAR = 365.25 * 86400.0


@pytest.fixture(scope="module")
def growth():
    return measure_growth(
        lines=(301, 101), squares=(17, 33), cubes=(17,), kinds=KINDS, memory=False, **LIMITS
    )


def test_there_is_a_run_for_every_dimension_kind_and_size_in_ascending_order(growth):
    assert growth.to_dataframe()[["dim", "kind", "particles"]].to_records(index=False).tolist() == [
        (1, "KPSE-12-open", 101),
        (1, "KPSE-12-open", 301),
        (1, "FPSE-4-truncated", 101),
        (1, "FPSE-4-truncated", 301),
        (2, "KPSE-2-truncated", 17**2),
        (2, "KPSE-2-truncated", 33**2),
        (3, "KPSE-2-truncated", 17**3),
    ]


def test_what_is_not_measured_is_nan(growth):
    particles, truncated = growth["particles"], growth["kind"] != "KPSE-12-open"
    for name in ("setup_time", "application_time"):
        assert (growth[name] > 0.0).all(), name
    assert (np.isfinite(growth["solve_time"]) == (particles <= 4000)).all()
    assert (np.isfinite(growth["naive_time"]) == (truncated & (particles <= 500))).all()
    for name in ("peak_memory", "memory_per_particle"):
        assert np.isnan(growth[name]).all(), name


def test_the_number_of_applications_does_not_depend_on_the_size(growth):
    for _, runs in growth.to_dataframe().groupby(["dim", "kind"]):
        assert runs["applications"].nunique() == 1
        assert runs["applications"].iloc[0] > 10


def test_a_data_set_of_growth_is_netcdf_and_says_what_it_was_measured_on(growth, tmp_path):
    for fact in ("cpu", "cores", "python", "numpy", "pyfftw", "repeats"):
        assert growth.attrs[fact], fact
    for variable in growth.data_vars.values():
        assert variable.attrs["long_name"]
        assert variable.attrs["units"]
    write(growth, tmp_path / "growth.nc")
    read = read_benchmark(tmp_path / "growth.nc")
    assert read["kind"].tolist() == growth["kind"].values.tolist()


def test_study_and_figure_take_what_was_measured_without_memory(growth, tmp_path):
    frame = measured(growth)
    given = Inputs("cost_growth", benchmarks={"cost_growth": frame})
    result = cost_growth(given, extrapolate_to=TARGET)
    assert len(result.table) == len(frame) + 2 * 4
    assert result.table["peak memory / GB"].isna().all()
    save(draw(result.series), tmp_path / "growth", ["svg"])
    assert (tmp_path / "growth.svg").stat().st_size > 0


SIDES = {
    ("KPSE-2-truncated", 2): (401, 801),
    ("KPSE-2-open", 2): (161, 321),
    ("KPSE-2-truncated", 3): (55, 87),
    ("KPSE-2-open", 3): (33, 49),
}


@pytest.mark.parametrize(("kind", "dim"), covering(["KPSE-2-truncated", "KPSE-2-open"], [2, 3]))
def test_memory_is_proportional_to_the_particles(kind, dim):
    """Four times the particles take four times the memory, beyond what the programme itself takes.

    Within a factor of 1.5: transform lengths jump by a tenth in each coordinate, and the programme by some megabytes.
    """
    squares, cubes = (SIDES[kind, dim] if dim == other else () for other in (2, 3))
    limits = {**LIMITS, "naive_particles": 0, "repeats": 1}
    kinds = {"square": [kind], "cube": [kind]}
    data = measure_growth((), squares, cubes, kinds, memory=True, **limits)
    less, more = data["memory_per_particle"].values
    assert data["particles"].values.tolist() == [side**dim for side in SIDES[kind, dim]]
    assert less / 1.5 < more < 1.5 * less


@pytest.mark.parametrize(("dim", "size"), [(1, 200_001), (2, 401), (3, 101)])
def test_a_truncated_run_takes_at_most_twelve_doubles_a_particle(dim, size):
    """What numpy allocates for the data, the run and the solution; FFTW and the program take more."""
    case = _case("KPSE-2-truncated", dim, size, _START + _SHORT)
    tracemalloc.start()
    try:
        prepare(case).solve(_strengths(case))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak <= 12.0 * 8.0 * case.particles


@pytest.mark.parametrize("memory", [False, True])
def test_the_threads_are_those_of_the_process_that_measures(memory, monkeypatch):
    """The one that collects has as many as it likes, here seven."""
    mine = {"threads_numba": 7, "threads_blas": 7, "other_load": 0.0}
    monkeypatch.setattr("fracstudy.race.clock.conditions", lambda: mine)
    if not memory:  # then it is the one that measures
        mine |= {"threads_numba": 1, "threads_blas": 1}
    kinds, limits = {"square": ["KPSE-2-truncated"]}, {**LIMITS, "naive_particles": 0}
    data = measure_growth((), (17,), (), kinds, memory=memory, **{**limits, "repeats": 1})
    assert (data.attrs["threads_numba"], data.attrs["threads_blas"]) == (1, 1)


def synthetic() -> pd.DataFrame:
    """A line and a cube whose every quantity is a power of N; the sums over all pairs of small sizes only."""
    parts = []
    for dim, kind, n in (
        (1, "KPSE-2-truncated", np.array([1e3, 1e4, 1e5, 1e6, 1e7])),
        (3, "KPSE-12-open", np.array([17.0, 33.0, 65.0, 129.0]) ** 3),
    ):
        naive = np.where((n <= 1e5) & ("truncated" in kind), 1e-9 * n**2, np.nan)
        solve = np.where(n <= 2e6, 24.0 * 5e-9 * n**1.1, np.nan)
        part = {
            "particles": n,
            "setup_time": 3e-8 * n**0.9,
            "application_time": 5e-9 * n**1.1,
            "applications": 24,
            "solve_time": solve,
            "naive_time": naive,
            "peak_memory": 2e8 + 120.0 * n,
            "memory_per_particle": 120.0,
            "machine_memory": 25e9,
            "dim": dim,
            "kind": kind,
        }
        parts.append(pd.DataFrame(part).iloc[::-1])  # in whatever order
    frame = pd.concat(parts, ignore_index=True)
    frame.attrs = {"cpu": "a processor", "repeats": 3}
    return frame


@pytest.fixture(scope="module")
def result():
    given = Inputs("cost_growth", benchmarks={"cost_growth": synthetic()})
    return cost_growth(given, extrapolate_to=TARGET)


def rows(result, dim: int, size: str) -> pd.Series:
    """The row of a dimension and a size."""
    table = result.table
    (row,) = table[(table["dim"] == dim) & (table["N"] == size)].to_dict("records")
    return pd.Series(row)


def test_the_table_has_a_row_a_size_then_the_exponents_and_what_is_extrapolated(result):
    table = result.table
    assert table[table["dim"] == 1]["N"].tolist() == [
        "1000", "10000", "100000", "1000000", "10000000", "exponent", "10^9, extrapolated",
    ]  # fmt: skip
    assert table[table["dim"] == 3]["N"].tolist() == [
        "17^3", "33^3", "65^3", "129^3", "exponent", "10^9, extrapolated",
    ]  # fmt: skip
    measured = rows(result, 1, "10000")
    assert measured["naive / fast"] == pytest.approx(0.1 / (5e-9 * 1e4**1.1), rel=1e-14)
    assert measured["peak memory / GB"] == pytest.approx(0.2 + 120e-5, rel=1e-14)


@pytest.mark.parametrize("dim", [1, 3])
def test_exponents_of_power_laws_are_recovered(result, dim):
    exponents = rows(result, dim, "exponent")
    assert exponents["set-up / s"] == pytest.approx(0.9, rel=1e-12)
    assert exponents["application / s"] == pytest.approx(1.1, rel=1e-12)
    assert exponents["peak memory / GB"] == pytest.approx(1.0, rel=1e-12)
    naive = exponents["naive application / s"]
    assert np.isnan(naive) if dim == 3 else naive == pytest.approx(2.0, rel=1e-12)


def test_exponents_are_those_of_the_upper_half():
    n = 10.0 ** np.arange(1, 7)
    values = np.where(n < 5e3, 1.0, 1e-4 * n)  # flat, then linear
    assert exponent(n, values) == pytest.approx(1.0, rel=1e-12)
    assert np.isnan(exponent(n[3:4], values[3:4]))
    values[0] = values[-1] = np.nan  # four are left, of which two are the upper half
    assert exponent(n, values) == pytest.approx(1.0, rel=1e-12)


def test_a_law_goes_through_the_largest_size_that_has_a_value():
    n, values = np.array([10.0, 100.0, 1000.0]), np.array([7.0, 2.0, np.nan])
    assert extrapolate(n, values, lambda size: 3.0 * size**2, 1e4) == pytest.approx(2e4, rel=1e-14)
    assert np.isnan(extrapolate(n, np.full(3, np.nan), lambda size: size, 1e4))


def test_what_more_particles_take_follows_from_the_largest_size(result):
    beyond = rows(result, 1, "10^9, extrapolated")
    growth = 1e9 * np.log(1e9) / (1e7 * np.log(1e7))
    application = 5e-9 * 1e7**1.1 * growth
    assert beyond["set-up / s"] == pytest.approx(3e-8 * 1e7**0.9 * growth, rel=1e-12)
    assert beyond["application / s"] == pytest.approx(application, rel=1e-12)
    assert beyond["solve / s"] == pytest.approx(24 * application, rel=1e-12)
    assert beyond["naive application / s"] == pytest.approx(1e9, rel=1e-12)
    assert beyond["naive solve / years"] == pytest.approx(24e9 / YEAR, rel=1e-12)
    assert beyond["naive / fast"] == pytest.approx(1e9 / application, rel=1e-12)
    assert beyond["peak memory / GB"] == pytest.approx(120.0, rel=1e-12)
    open_exterior = rows(result, 3, "10^9, extrapolated")
    assert np.isnan(open_exterior["naive application / s"])
    assert open_exterior["peak memory / GB"] == pytest.approx(120.0, rel=1e-12)


def test_the_series_holds_what_was_measured_and_one_point_more(result):
    series = result.series
    fast = series[(series["series"] == "fast") & (series["dim"] == 1)]
    assert fast["x"].tolist() == [1e3, 1e4, 1e5, 1e6, 1e7, TARGET]
    assert fast["extrapolated"].tolist() == [False] * 5 + [True]
    naive = series[series["series"] == "naive"]
    assert naive["x"].tolist() == [1e3, 1e4, 1e5, TARGET]
    assert naive["y"].to_numpy() == pytest.approx([1e-3, 0.1, 10.0, 1e9], rel=1e-12)
    assert "a processor" in series["note"].iloc[0]


def test_the_figure_draws_a_column_a_dimension(result, tmp_path):
    figure = draw(result.series)
    assert len(figure.axes) == 4
    save(figure, tmp_path / "growth", ["png"])
    assert (tmp_path / "growth.png").stat().st_size > 0


def test_scattered_sums_agree_where_both_are_timed(tmp_path):
    data = scattered(particles=(100, 3000), naive_particles=100, repeats=1, seconds=0.1)
    assert data["particles"].values.tolist() == [100, 3000]
    assert (data["transform_time"] > 0.0).all()
    assert np.isfinite(data["naive_time"].values).tolist() == [True, False]
    assert np.isfinite(data["deviation"].values).tolist() == [True, False]
    assert data["deviation"][0] < NonuniformFourierSum.accuracy
    write(data, tmp_path / "scattered.nc")
    assert (tmp_path / "scattered.nc").stat().st_size > 0


def test_a_range_has_no_power_of_ten():
    assert ranged(89.9, 99.6, "GB") == "90 to 99.6 GB"
    assert ranged(99.4, 123.4, "GB") == "99 to 123 GB"
    assert ranged(5.41, 5.42, "min") == "5.4 min"
