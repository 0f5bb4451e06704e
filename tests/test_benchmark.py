"""The benchmarks on tiny problems: their structure and their arithmetic, no run times."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.benchmark import (
    benchmark_table,
    peak_memory,
    reference_benchmark,
    transform_pairs,
)
from fracparticles.benchmark_sums import (
    box_benchmark,
    box_table,
    scattered_benchmark,
    scattered_table,
)
from fracparticles.case import Case
from fracparticles.dataset import write
from fracparticles.sums import NonuniformFourierSum
from fracparticles.sums.fourier import transform_length

TINY = {"truncation": 4.0, "spacing": 0.1, "dt": 5e-3, "green_dt": 0.05}


@pytest.fixture(scope="module")
def data():
    return reference_benchmark(
        **TINY, repeats=2, naive_seconds=0.05, memory=False, measured_plans=False
    )


def test_every_scheme_is_there(data):
    runs = list(zip(data["scheme"].values, data["order"].values, strict=True))
    one_pass = [(scheme, order) for scheme in ("DD", "FPSE", "KPSE") for order in (2, 4)]
    assert runs == [*one_pass, ("GPSE", 2)]
    assert {"FFTW", "FFTW, in place", "scipy.fft"} <= set(data["library"].values)


def test_times_are_positive_and_floor_and_ratios_follow_from_them(data):
    for name in ("setup_time", "solve_time", "pair_time"):
        assert (data[name] > 0.0).all(), name
    assert (data["solve_time_median"] >= data["solve_time"]).all()
    floor = data["operator_applications"] * data["pair_time"].min("library")
    assert data["floor_time"].values == pytest.approx(floor.values, rel=1e-14)
    assert data["floor_ratio"].values == pytest.approx((data["solve_time"] / floor).values)
    assert (data["own_ratio"] <= data["floor_ratio"]).all()
    assert (data["transform_length"] == transform_length(2 * int(data["particles"][0]) - 1)).all()


def test_stepping_and_naive_steps_are_those_of_the_schemes_asked_for(data):
    asked = (data["scheme"] == "KPSE") & (data["order"] == 2)
    for name in ("stepping_time", "naive_step_time", "naive_over_series", "stepping_over_series"):
        assert (np.isfinite(data[name]) == asked).all(), name
    run = data.isel(run=int(np.flatnonzero(asked)[0]))
    assert run["steps"] == round(1.0 / TINY["dt"])
    assert run["stepping_applications"] == 2 * run["steps"]
    assert run["naive_measured_steps"] >= 1
    assert run["naive_extrapolated_time"] == run["naive_step_time"] * run["steps"]
    # Series and stepping are one polynomial of A: 400 products, each with a rounding error of some ulp.
    assert run["stepping_deviation"] < 400 * 4 * np.finfo(float).eps


def test_the_data_say_what_they_were_measured_on(data):
    for fact in ("cpu", "cores", "threads_naive", "python", "numpy", "pyfftw", "repeats"):
        assert data.attrs[fact], fact
    for variable in data.data_vars.values():
        assert variable.attrs["long_name"]
        assert variable.attrs["units"]


def test_the_table_has_a_row_a_run_and_the_file_is_netcdf(data, tmp_path):
    table = benchmark_table(data)
    assert len(table) == data.sizes["run"]
    assert table["series, min / ms"].to_numpy() == pytest.approx(1e3 * data["solve_time"].values)
    write(data, tmp_path / "reference.nc")
    assert (tmp_path / "reference.nc").stat().st_size > 0


@pytest.mark.parametrize("length", [64, 250])
def test_a_transform_pair_can_be_repeated(length):
    for pair in transform_pairs(length, measured_plans=True).values():
        pair()
        pair()


def test_peak_memory_is_that_of_a_process_of_its_own():
    """An interpreter with numpy takes some tens of megabytes; the particles of this case almost nothing."""
    case = Case(scheme="DD", beta=0.5, truncation=4.0, spacing=0.5, dt=0.01)
    ballast = np.ones(50_000_000)  # 400 MB here, which must not count
    assert 2e7 < peak_memory(case) < ballast.nbytes


@pytest.fixture(scope="module")
def boxes():
    kinds = ("KPSE-4-truncated", "FPSE-2-truncated")
    return box_benchmark((33,), (21,), kinds, naive_particles=2000, repeats=1, memory=False)


def test_boxes_have_times_and_naive_sums_are_those_of_small_lattices(boxes, tmp_path):
    assert sorted(set(boxes["particles"].values)) == [33**2, 21**3]
    assert (boxes["setup_time"] > 0.0).all()
    assert (boxes["application_time"] > 0.0).all()
    assert (np.isfinite(boxes["naive_time"]) == (boxes["particles"] <= 2000)).all()
    table = box_table(boxes)
    assert set(table["N"]) == {"33^2", "21^3"}
    assert table["application / ms"].to_numpy() == pytest.approx(1e3 * boxes["application_time"])
    write(boxes, tmp_path / "boxes.nc")
    assert (tmp_path / "boxes.nc").stat().st_size > 0


def test_scattered_sums_agree_where_both_are_timed(tmp_path):
    data = scattered_benchmark(particles=(100, 3000), naive_particles=100, repeats=1)
    assert (data["transform_time"] > 0.0).all()
    assert np.isfinite(data["naive_time"].values).tolist() == [True, False]
    assert data["deviation"][0] < NonuniformFourierSum.accuracy
    assert scattered_table(data)["N"].tolist() == [100, 3000]
    write(data, tmp_path / "scattered.nc")
    assert (tmp_path / "scattered.nc").stat().st_size > 0


@pytest.mark.parametrize(("kind", "squares", "cubes"), [
    ("KPSE-2-truncated", (401, 801), (55, 87)),
    ("KPSE-2-open", (161, 321), (33, 49)),
])  # fmt: skip
def test_memory_is_proportional_to_the_particles(kind, squares, cubes):
    """Four times the particles take four times the memory, beyond what the programme itself takes.

    Within a factor of 1.5: transform lengths jump by a tenth in each coordinate, and the programme by some megabytes.
    """
    data = box_benchmark(squares, cubes, (kind,), naive_particles=0, repeats=1)
    for dim, sizes in ((2, squares), (3, cubes)):
        less, more = (
            data["memory_per_particle"].values[data["particles"].values == size**dim]
            for size in sizes
        )
        assert less / 1.5 < more < 1.5 * less
