"""The estimate of a run's error: within a factor of three of the true one, wherever that is known."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fracparticles as fp
from fracparticles.command_line.cli import main
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.run.estimate import ErrorEstimate, estimate_of
from fracparticles.run.solver import compute
from fracstudy.race.problems import PROBLEMS
from sweeps import covering

LINE = {
    "KPSE, order 4": {"scheme": "KPSE", "order": 4, "integrator": "exponential", "exterior": "open"},
    "KPSE, order 12": {"scheme": "KPSE", "order": 12, "integrator": "exponential", "exterior": "open"},
    "KPSE, truncated": {"scheme": "KPSE", "dt": 0.01},
    "Euler": {"scheme": "FPSE", "order": 4, "dt": 0.05, "integrator": "euler", "exterior": "open"},
    "GPSE": {"scheme": "GPSE", "dt": 1.0, "exterior": "open"},
    "graded": {"scheme": "GPSE", "graded_scale": 2.0},
    "FD": {"scheme": "FD", "integrator": "exponential"},
    "DPSE": {"scheme": "DPSE", "integrator": "exponential"},
}  # fmt: skip
PLANE = {name: LINE[name] for name in ("KPSE, order 4", "GPSE")} | {
    "FPSE": {"scheme": "FPSE", "dt": 0.05}
}
SETTLED = 1e-11  # below it round-off has its say
# The others are mixtures of stable densities, any of which hypothesis finds below.
ROUGH = [name for name in PROBLEMS if name not in ("fundamental", "mixture")]


def estimated_and_true(problem, half_width, spacing, **given):
    def data(*x):
        return problem.initial(x)

    case = fp.Case(beta=problem.beta, dim=problem.dim, half_width=half_width, spacing=spacing, t_initial=0.0,
                   t_final=1.0, **given)  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = compute(case, data)
        estimate = estimate_of(run, data, min(problem.error_radius, case.reach))
    return estimate, problem.error(tuple(case.positions), case.volumes, run.u)


# In the plane beta is 0.5, of mixtures any.
@pytest.mark.parametrize(
    ("name", "way", "beta", "lattice"),
    covering(ROUGH, LINE, [0.1, 0.9], [(4.0, 0.2), (20.0, 0.1)]),
)
def test_on_the_line_it_is_within_a_factor_of_three(name, way, beta, lattice):
    problem, (widths, spacing) = PROBLEMS[name](beta), lattice
    estimate, true = estimated_and_true(problem, widths * problem.width, spacing, **LINE[way])
    assert true / 3.0 <= estimate.total <= 3.0 * true + SETTLED


@pytest.mark.parametrize(("name", "way"), covering(ROUGH, PLANE))
def test_in_the_plane_too(name, way):
    problem = PROBLEMS[name](0.5, 2)
    widths, spacing = (3.0, 0.24) if name == "two scales" else (6.0, problem.width / 8.0)
    estimate, true = estimated_and_true(problem, widths * problem.width, spacing, **PLANE[way])
    assert true / 3.0 <= estimate.total <= 3.0 * true + SETTLED


class Mixture:
    """Shifted stable densities of several widths, and their solution."""

    def __init__(self, beta, dim, blobs):
        self.beta, self.dim, self.blobs = beta, dim, blobs

    def at(self, later, x):
        total = 0.0
        for share, centre, age in self.blobs:
            r = np.sqrt(sum((line - c) ** 2 for line, c in zip(x, centre, strict=False)))
            total = total + share * fp.green(r, age + later, 1.0 + self.beta, self.dim)
        return np.asarray(total)

    def initial(self, x):
        return self.at(0.0, x)

    error_radius = 4.0

    def error(self, x, volume, u):
        inside = np.sqrt(sum(line**2 for line in x)) <= self.error_radius
        exact = self.at(1.0, x)[inside]
        return float(np.abs(u[inside] - exact).sum() / np.abs(exact).sum())


BLOBS = st.lists(
    st.tuples(st.floats(0.1, 1.0), st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)), st.floats(0.05, 1.0)),
    min_size=1, max_size=3,
)  # fmt: skip


@given(
    st.floats(0.05, 0.95),
    BLOBS,
    st.sampled_from(sorted(LINE)),
    st.floats(8.0, 60.0),
    st.floats(0.1, 0.4),
)
def test_any_mixture_on_the_line(beta, blobs, way, half_width, spacing):
    problem = Mixture(beta, 1, blobs)
    estimate, true = estimated_and_true(problem, half_width, spacing, **LINE[way])
    assert true / 3.0 <= estimate.total <= 3.0 * true + SETTLED


@settings(max_examples=settings.default.max_examples // 3)
@given(
    st.floats(0.05, 0.95),
    BLOBS,
    st.sampled_from(sorted(PLANE)),
    st.floats(8.0, 14.0),
    st.floats(0.3, 0.5),
)
def test_any_mixture_in_the_plane(beta, blobs, way, half_width, spacing):
    problem = Mixture(beta, 2, blobs)
    estimate, true = estimated_and_true(problem, half_width, spacing, **PLANE[way])
    assert true / 3.0 <= estimate.total <= 3.0 * true + SETTLED


# --- the parts ------------------------------------------------------------------------------------

GIVEN = {"scheme": "KPSE", "order": 4, "beta": 0.5, "half_width": 20.0, "spacing": 0.2, "t_initial": 0.0,
         "t_final": 1.0, "integrator": "exponential", "exterior": "open"}  # fmt: skip


def bump(x):
    return np.exp(-((x - 1.0) ** 2))


@pytest.mark.parametrize(
    ("changes", "largest"),
    [
        ({"spacing": 0.4}, "spacing"),
        ({"exterior": "truncated", "half_width": 10.0, "spacing": 0.1}, "domain"),
        ({"integrator": "euler", "dt": 0.02, "half_width": 40.0, "spacing": 0.1}, "time"),
    ],
)
def test_the_parts_say_what_to_do(changes, largest):
    estimate = fp.estimate_error(fp.Case(**{**GIVEN, **changes}), bump)
    assert next(iter(estimate.parts)) == largest
    assert estimate.total <= 1.01 * sum(estimate.parts.values())
    assert estimate.total == pytest.approx(getattr(estimate, largest), rel=0.2)
    assert largest in str(estimate)
    mended = {"spacing": {"spacing": 0.2}, "domain": {"exterior": "open"}, "time": {"dt": 0.005}}[
        largest
    ]
    after = fp.estimate_error(fp.Case(**{**GIVEN, **changes, **mended}), bump)
    assert after.total < 0.5 * estimate.total
    assert estimate.remedy


def test_measured_data_have_their_part():
    x = np.linspace(-6.0, 8.0, 30)
    data = fp.measured((x, bump(x)))
    estimate = fp.estimate_error(fp.Case(**GIVEN), data)
    assert estimate.data == data.error
    assert estimate.total >= data.error


def test_bare_arrays_are_continued():
    case = fp.Case(**GIVEN)
    by_function, by_array = (fp.estimate_error(case, data) for data in (bump, bump(case.x)))
    assert by_array.total == pytest.approx(by_function.total, rel=0.05)
    square = fp.Case(**{**GIVEN, "half_width": 8.0, "spacing": 0.25}, dim=2)
    data = fp.green(square.radius, 0.5, 1.5, 2)
    by_array = fp.estimate_error(square, data, within=5.0)
    by_function = fp.estimate_error(
        square, lambda x, y: fp.green(np.sqrt(x * x + y * y), 0.5, 1.5, 2), within=5.0
    )
    assert by_array.total == pytest.approx(by_function.total, rel=0.2)


def test_a_function_of_single_numbers():
    case = fp.Case(**{**GIVEN, "spacing": 0.5})
    single = fp.estimate_error(case, lambda x: float(np.exp(-((x - 1.0) ** 2))) if x > -50 else 0.0)
    assert single.total == pytest.approx(fp.estimate_error(case, bump).total, rel=0.01)


def test_dvm():
    case = fp.Case(scheme="DVM", beta=0.5, half_width=12.0, spacing=0.1, dt=0.02)
    run = compute(case)
    exact = fp.green(case.radius, 1.5, 1.5)
    inside = case.radius <= case.error_radius
    true = np.abs(run.u - exact)[inside].sum() / exact[inside].sum()
    estimate = fp.estimate_error(case)
    assert true / 3.0 <= estimate.total <= 3.0 * true


def test_what_cannot_be_resolved_is_said():
    """Also with fewer points than the five millions that it may take."""
    case = fp.Case(**{**GIVEN, "half_width": 100.0, "spacing": 2.0})

    def narrow(x):
        return fp.green(x, 1e-9, 1.5)

    with pytest.warns(AccuracyWarning, match="the estimate of the error"):
        estimate_of(compute(case, narrow), narrow, most=200_000)


def test_a_radius_without_particles_is_refused():
    with pytest.raises(InvalidInput, match="within"):
        fp.estimate_error(fp.Case(**GIVEN), bump, within=-1.0)


# --- beside the result ----------------------------------------------------------------------------


def test_solve_stores_it_and_the_command_line_says_it(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    case = fp.Case(**{**GIVEN, "t_initial": 0.5, "t_final": 1.5})
    run = fp.solve(case, estimate=True)
    assert float(run.estimated_error) == pytest.approx(float(run.relative_l1_error), rel=0.02)
    assert "estimated_error" not in fp.solve(case)
    flags = [
        f"--{name.replace('_', '-')}={value}"
        for name, value in case.model_dump(exclude_defaults=True).items()
    ]
    assert main(["solve", *flags, "--estimate", "-o", "run.nc"]) == 0
    out, err = capsys.readouterr()
    assert out == "run.nc\n"
    assert err.startswith("note: estimated relative error ")
    assert fp.read_run("run.nc").identical(run)


def test_of_several_times_each_has_one():
    fields = {**GIVEN, "t_initial": 0.5}
    fields.pop("t_final")
    run = fp.solve(fp.Case(**fields, times=[0.75, 1.0, 1.5]), estimate=True)
    assert run.estimated_error.dims == ("t",)
    assert run.estimated_error.values == pytest.approx(run.relative_l1_error.values, rel=0.05)
    assert isinstance(fp.estimate_error(fp.Case(**fields, times=[0.75, 1.0])), ErrorEstimate)
