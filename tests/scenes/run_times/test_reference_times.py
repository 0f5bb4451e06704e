"""The reference problem's run times: structure and arithmetic, no run times."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.lattice.fourier import complex_length
from scenes.run_times.reference_times.benchmark import benchmark as reference
from scenes.run_times.reference_times.benchmark import transform_pairs


@pytest.fixture(scope="module")
def data():
    return reference(
        repeats=2, truncation=4.0, spacing=0.1, dt=5e-3, green_dt=0.05, stepped=["KPSE"],
        timed_steps={"fft": 1000, "naive": 2}, measured_plans=False,
    )  # fmt: skip


def test_every_scheme_is_there(data):
    runs = list(zip(data["scheme"].values, data["order"].values, strict=True))
    one_pass = [(scheme, order) for scheme in ("DD", "FPSE", "KPSE") for order in (2, 4)]
    assert runs == [*one_pass, ("GPSE", 2)]


def test_ratios_follow_from_the_times(data):
    pairs = data["operator_applications"] * data["fastest_pair_time"]
    assert data["floor_ratio"].values == pytest.approx((data["solve_time"] / pairs).values)
    assert (data["own_ratio"] <= data["floor_ratio"]).all()
    assert (data["transform_length"] == 2 * complex_length(int(data["particles"][0]))).all()
    for name in ("setup_time", "single_pair_time", "cosine_pair_time"):
        assert (data[name] > 0.0).all(), name


def test_stepping_and_naive_steps_are_those_of_the_schemes_asked_for(data):
    asked = (data["scheme"] == "KPSE") & (data["order"] == 2)
    for name in ("stepping_time", "naive_step_time", "naive_over_series", "stepping_over_series"):
        assert (np.isfinite(data[name]) == asked).all(), name
    run = data.isel(run=int(np.flatnonzero(asked)[0]))
    assert run["stepping_applications"] == 2 * run["steps"] == 400
    assert run["stepping_measured_steps"] == 200  # all that there are
    assert run["naive_measured_steps"] == 2
    assert run["naive_time"] == pytest.approx(float(run["naive_step_time"] * run["steps"]))
    # Series and stepping are one polynomial of A: 400 products, each with a rounding error of some ulp.
    assert run["stepping_deviation"] < 400 * 4 * np.finfo(float).eps


@pytest.mark.parametrize("length", [64, 250])
def test_a_transform_pair_can_be_repeated(length):
    for pair in transform_pairs(length, measured_plans=True).values():
        pair()
        pair()
