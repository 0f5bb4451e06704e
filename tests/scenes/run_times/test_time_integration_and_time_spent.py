"""The scenes on the time integration and on where the time goes: synthetic times, and tiny real ones."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracparticles.lattice.fourier import FourierConvolution
from fracparticles.lattice.operators import ConvolutionOperator
from fracparticles.time import STEP_POLYNOMIALS
from fracparticles.time.rkc import stages_for
from fracstudy.figure_files import save
from fracstudy.inputs import Inputs
from scene_functions import measured
from scenes.run_times.time_integration import benchmark as integration_benchmark
from scenes.run_times.time_integration.figure import figure as draw_integrations
from scenes.run_times.time_integration.study import study as time_integration
from scenes.run_times.time_spent.benchmark import benchmark as take_apart
from scenes.run_times.time_spent.figure import figure as draw_parts
from scenes.run_times.time_spent.study import PARTS
from scenes.run_times.time_spent.study import study as time_spent

NAMES = {"euler": "RK1", "rk2": "RK2", "rk4": "RK4"}
CASES = {
    "truncated": {
        "scheme": "FPSE", "order": 4, "beta": 0.5, "truncation": 4.0, "spacing": 0.2, "dt": 0.01,
    },
    "open": {
        "scheme": "KPSE", "order": 4, "beta": 0.5, "truncation": 4.0, "spacing": 0.2,
        "integrator": "exponential", "exterior": "open",
    },
    "at once": {
        "scheme": "GPSE", "beta": 0.5, "truncation": 4.0, "spacing": 0.4, "dt": 1.0,
        "exterior": "open", "evaluation": "convolution",
    },
    "plane": {
        "scheme": "FPSE", "order": 2, "beta": 0.5, "dim": 2, "truncation": 1.0, "spacing": 0.2,
        "integrator": "exponential",
    },
}  # fmt: skip


def inputs(name, frame):
    return Inputs(name, benchmarks={name: frame})


@pytest.fixture(scope="module")
def integrations():
    data = integration_benchmark.benchmark(
        beta=0.5, truncation=5.0, spacing=0.2, schemes={"KPSE": 4, "FPSE": 4}, factors=[1, 2, 4, 8],
        repeats=2, seconds=0.1,
    )  # fmt: skip
    return measured(data)


@pytest.fixture(scope="module")
def parts():
    return measured(take_apart(CASES, repeats=2))


# --- synthetic ------------------------------------------------------------------------------------


def synthetic_integrations():
    frame = pd.DataFrame(
        [
            ("KPSE 12", "rk4", 10, 40, 1e-6, 6e-3),
            ("KPSE 12", "Chebyshev series", 1, 30, 1e-14, 2e-3),
            ("FPSE 4", "euler", 8, 8, 1e-2, 1e-3),
            ("FPSE 4", "Chebyshev series", 1, 20, 1e-14, 4e-3),
        ],
        columns=["operator", "integrator", "steps", "applications", "error", "solve_time"],
    )
    frame.attrs = {"cpu": "a processor", "repeats": 7}
    return frame


def test_the_times_of_the_integrators_are_in_units_of_the_series_of_their_operator():
    result = time_integration(inputs("time_integration", synthetic_integrations()))
    assert result.findings == ()
    assert list(result.table["operator"]) == ["KPSE 12"] * 2 + ["FPSE 4"] * 2
    assert list(result.table["integrator"]) == [
        "RK4", "Chebyshev series", "RK1", "Chebyshev series",
    ]  # fmt: skip
    assert np.allclose(result.table["solve / ms"], [6.0, 2.0, 1.0, 4.0])
    assert np.allclose(result.table["time / that of the series"], [3.0, 1.0, 0.25, 1.0])
    assert list(result.table["operator applications"]) == [40, 30, 8, 20]
    (note,) = result.series["note"].unique()
    assert "a processor" in note
    assert "7 repeats" in note


def synthetic_parts():
    fields = {"run": "one", "particles": 9, "applications": 3, "setup_time": 0.010}
    fields |= dict(zip(PARTS["setup_time"], (0.001, 0.002, 0.003, 0.0, 0.004), strict=True))
    first = {**fields, "solve_time": 0.004, "lattice sums": 0.003, "rest of the solve": 0.001}
    # One sum, times three, came out above the solve.
    second = {
        **fields, "run": "two", "solve_time": 0.004, "lattice sums": 0.005,
        "rest of the solve": -0.001,
    }  # fmt: skip
    frame = pd.DataFrame([first, second])
    frame.attrs = {"cpu": "a processor", "repeats": 7}
    return frame


def test_the_parts_are_listed_in_milliseconds_and_drawn_as_shares():
    result = time_spent(inputs("time_spent", synthetic_parts()))
    assert result.findings == ()
    one = result.table.set_index("case").loc["one"]
    assert (one["N"], one["applications"]) == (9, 3)
    assert one["set-up / ms"] == pytest.approx(10.0)
    assert one["range of the symbol / ms"] == pytest.approx(3.0)
    assert one["rest of the solve / ms"] == pytest.approx(1.0)
    assert one["set-up / solve"] == pytest.approx(2.5)
    share = result.series.set_index(["case", "part"])["share"]
    assert share["one", "plans and the rest"] == pytest.approx(0.4)
    assert share["one", "lattice sums"] == pytest.approx(0.75)
    assert share["two", "lattice sums"] == 1.0
    assert np.allclose(result.series.groupby(["case", "panel"])["share"].sum(), 1.0)


# --- tiny real ones -------------------------------------------------------------------------------


def test_what_is_exact_in_time_has_errors_of_round_off_and_the_steps_those_of_their_order(
    integrations,
):
    for _, runs in integrations.groupby("operator"):
        error = runs.set_index("integrator")["error"]
        assert error["Chebyshev series"] < 1e-12
        assert error["expm_multiply"] < 1e-12
        for name, polynomial in STEP_POLYNOMIALS.items():
            halved = error[name].to_numpy()
            assert np.log2(halved[-2] / halved[-1]) == pytest.approx(polynomial.stages, abs=0.3)


def test_applications_are_steps_times_stages(integrations):
    for name, polynomial in STEP_POLYNOMIALS.items():
        runs = integrations[integrations["integrator"] == name]
        assert (runs["applications"] == polynomial.stages * runs["steps"]).all()
    stabilised = integrations[integrations["integrator"] == "RKC2"]
    assert (stabilised["applications"] >= 2 * stabilised["steps"]).all()
    assert (stabilised["applications"] % stabilised["steps"] == 0).all()


def test_every_integrator_applies_the_operator_as_often_as_it_says():
    size, low, time = 33, -4.0, 5.0
    counted = []

    class Counting(ConvolutionOperator):
        def combine(self, *arguments, **options):
            counted.append(1)
            super().combine(*arguments, **options)

    # Second differences: eigenvalues between -4 and 0.
    weights = np.zeros(size)
    weights[:2] = -2.0, 1.0
    operator = Counting(FourierConvolution(weights, size), np.zeros(size), None)
    u0 = np.exp(-(np.linspace(-4.0, 4.0, size) ** 2))
    # expm_multiply estimates norms from random vectors, and how many products that takes depends on them.
    np.random.seed(1)  # noqa: NPY002
    ways = list(
        integration_benchmark._ways(operator, (low, 0.0), time, u0, [1, 2], trace=-2.0 * size)
    )
    assert {way[0] for way in ways} == {*NAMES, "RKC2", "expm_multiply", "Chebyshev series"}
    for name, steps, applications, run in ways:
        counted.clear()
        np.random.seed(1)  # noqa: NPY002
        assert np.isfinite(run()).all()
        assert len(counted) == applications, name
        if name == "RKC2":
            assert applications == steps * stages_for(-low * time / steps)


def test_the_parts_of_a_real_set_up_and_solve_add_up(parts):
    for whole, names in PARTS.items():
        assert np.allclose(parts[list(names)].sum(axis="columns"), parts[whole], rtol=1e-9)
    assert (parts[list(PARTS["setup_time"])] >= 0.0).all(axis=None)
    assert set(parts.columns) - {name for names in PARTS.values() for name in names} == {
        "case", "run", "particles", "applications", "setup_time", "solve_time",
    }  # fmt: skip


def test_a_set_up_has_the_parts_that_its_case_needs(parts):
    part = parts.set_index("run")
    assert (part["far field"] > 0.0).to_dict() == {
        "truncated": False, "open": True, "at once": False, "plane": False,
    }  # fmt: skip
    summed = part.loc["at once"]
    assert summed["applications"] == 1
    for name in ("kernel values", "range of the symbol", "time series"):
        assert summed[name] == 0.0
        assert (part[name].drop("at once") > 0.0).all()


def test_the_figures_are_drawn_from_the_results(integrations, parts, tmp_path):
    for name, study, frame, draw in (
        ("time_integration", time_integration, integrations, draw_integrations),
        ("time_spent", time_spent, parts, draw_parts),
    ):
        result = study(inputs(name, frame))
        file = tmp_path / f"{name}.csv"
        result.series.to_csv(file, index=False)  # figures are drawn from files
        figure = draw(pd.read_csv(file))
        save(figure, tmp_path / name)
        assert len(figure.axes) == 2
        assert (tmp_path / f"{name}.svg").stat().st_size > 0
