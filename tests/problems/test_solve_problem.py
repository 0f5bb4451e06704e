"""Problems with exact solutions: errors, orders, mass, warnings, and what the data set says."""

from __future__ import annotations

import json
import warnings
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import gamma, hyp1f1

from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution
from fracparticles.problems import Problem, solve_problem
from fracparticles.run.dataset import write
from fracparticles.special import green
from fracparticles.variable.closed_forms import Gaussian
from known import error_of
from sweeps import covering, few

# The error is measured: to estimate it, too, takes as long again.
solved = partial(solve_problem, estimate=False)

LINE = {
    "alpha": 1.5, "half_width": 50.0, "spacing": 0.1, "order": 12, "far_terms": 3, "t_initial": 1.0, "t_final": 2.0,
    "rtol": 1e-8,
}  # fmt: skip


def laplacian_of_gaussian(x: np.ndarray, alpha: float, dim: int = 1) -> np.ndarray:
    """(-Laplacian)^(alpha/2) exp(-r^2)."""
    half = 0.5 * (dim + alpha)
    return 2.0**alpha * gamma(half) / gamma(0.5 * dim) * hyp1f1(half, 0.5 * dim, -x * x)


@pytest.mark.parametrize("alpha", [1.2, 1.5, 1.8])
@pytest.mark.parametrize("form", ["FPSE", "DD", "exchange"])
def test_a_uniform_field_shifts_the_solution(alpha, form):
    run = solved(Problem(**{**LINE, "alpha": alpha}, form=form, velocity=1.0))
    assert error_of(run, green(run.x.values - 1.0, 2.0, alpha)) < 1e-6
    assert run.integrator == "exponential"


@pytest.mark.parametrize("integrator", ["auto", "dop853"])
def test_a_linear_field_keeps_the_stable_law(integrator):
    """The scale of the stable law: scale^alpha = e^(-alpha theta t) + D (1 - e^(-alpha theta t)) / (alpha theta)."""
    theta, d, alpha = 0.8, 0.5, 1.5
    run = solved(
        Problem(
            **LINE, velocity="-0.8*x" if integrator == "auto" else "-0.8*x + 0*t", diffusivity=d, integrator=integrator,
            times=(1.3, 2.0),
        ),
        lambda x: green(x, 1.0, alpha),
    )  # fmt: skip
    for time in (0.3, 1.0):
        falls = np.exp(-alpha * theta * time)
        exact = green(run.x.values, falls + d * (1.0 - falls) / (alpha * theta), alpha)
        assert error_of(run.sel(t=1.0 + time, method="nearest"), exact) < 1e-6


def test_the_order_in_the_spacing_is_that_of_the_kernel():
    for order in (2, 4, 6):
        errors = []
        for h in (0.2, 0.1):
            one = {**LINE, "order": order, "spacing": h, "half_width": 30.0}
            run = solved(Problem(**one, velocity=1.0))
            errors.append(error_of(run, green(run.x.values - 1.0, 2.0, 1.5)))
        assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.2)


def test_a_shear_in_time_is_the_integral_of_its_speed():
    run = solved(Problem(**LINE, velocity="cos(3*t)"))
    moved = (np.sin(6.0) - np.sin(3.0)) / 3.0
    assert error_of(run, green(run.x.values - moved, 2.0, 1.5)) < 1e-6
    assert run.integrator == "dop853"


def test_diffusion_in_time_is_its_integral():
    run = solved(Problem(**LINE, diffusivity="t"), lambda x: green(x, 1.0, 1.5))
    assert error_of(run, green(run.x.values, 2.5, 1.5)) < 1e-6


@pytest.mark.parametrize("form", ["FPSE", "exchange"])
def test_on_a_truncated_lattice_mass_is_conserved_to_round_off(form):
    fields = {"half_width": 10.0, "far_terms": None, "exterior": "truncated", "order": 4}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the lattice is narrow
        run = solved(Problem(**{**LINE, **fields}, form=form, velocity="-x + sin(t)"))
    assert abs(float(run.mass_final / run.mass_initial) - 1.0) < 1e-12


def test_what_decays_at_a_rate_has_the_exact_factor():
    run = solved(Problem(**LINE, source="-0.7*u"))
    assert error_of(run, np.exp(-0.7) * green(run.x.values, 2.0, 1.5)) < 1e-6


def test_a_source_alone_is_an_ordinary_equation_at_each_particle():
    fields = {**LINE, "half_width": 5.0, "t_initial": 0.0, "t_final": 1.0}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # it does not fall
        run = solved(
            Problem(**fields, diffusivity=0.0, source="u*(1 - u)*2*t"),
            lambda x: 0.1 + 0.05 * np.sin(x),
        )
    start = 0.1 + 0.05 * np.sin(run.x.values)
    assert_allclose(run.u, start * np.e / (1.0 - start + start * np.e), rtol=1e-7)


def test_a_manufactured_source_in_text_with_a_tail_of_another_power():
    """u = exp(-t) / (1 + x^2): its tail x^-2 is not that of the closure, which leaves some 1e-8 at this width."""
    source = "exp(-t)*(gamma(2.5)*(1 + x**2)**(-1.25)*cos(2.5*arctan(x)) - 1/(1 + x**2))"
    fields = {"half_width": 100.0, "spacing": 0.05, "t_initial": 0.0, "t_final": 1.0}
    run = solved(Problem(**{**LINE, **fields}, source=source), lambda x: 1.0 / (1.0 + x * x))
    assert error_of(run, np.exp(-1.0) / (1.0 + run.x.values**2)) < 1e-6
    assert run.attrs["reproducible"] == "yes"


@pytest.mark.parametrize(
    ("dim", "form", "order", "bound"), [(1, "FPSE", 12, 1e-6), (2, "DD", 12, 1e-4)]
)
def test_a_manufactured_source_by_a_function(dim, form, order, bound):
    """u = cos(t) exp(-r^2), f = -sin(t) exp(-r^2) + cos(t) (-Laplacian)^(alpha/2) exp(-r^2) + transport."""
    half, h = (30.0, 0.1) if dim == 1 else (10.0, 0.2)
    axis = np.arange(-round(half / h), round(half / h) + 1) * half / round(half / h)
    grid = np.meshgrid(*(axis,) * dim, indexing="ij")
    r = np.sqrt(sum(part * part for part in grid))
    rate, bell = laplacian_of_gaussian(r, 1.5, dim), np.exp(-r * r)
    slope = -2.0 * grid[0] * bell  # of transport along x with speed 0.3

    def source(*arguments):
        t = arguments[dim]
        return -np.sin(t) * bell + np.cos(t) * (rate + 0.3 * slope)

    problem = Problem(
        alpha=1.5, dim=dim, form=form, order=order, half_width=half, spacing=h, t_final=1.0, rtol=1e-8,
        velocity=0.3 if dim == 1 else (0.3, 0.0),
        source=(lambda x, t: source(x, t)) if dim == 1 else (lambda x, y, t: source(x, y, t)),
    )  # fmt: skip
    run = solved(problem, bell)
    assert error_of(run, np.cos(1.0) * bell) < bound
    assert run.attrs["reproducible"].startswith("no")


def test_a_rotation_carries_a_blob_about_the_origin():
    problem = Problem(
        alpha=1.5, dim=2, form="DD", order=12, half_width=12.0, spacing=0.25, velocity=("-y", "x"), diffusivity=0.2,
        t_final=np.pi / 2.0,
    )  # fmt: skip
    run = solved(problem, lambda x, y: green(np.hypot(x - 1.5, y), 1.0, 1.5, 2))
    x, y = run.x.values[:, None], run.y.values
    exact = green(np.hypot(x, y - 1.5), 1.0 + 0.1 * np.pi, 1.5, 2)
    assert error_of(run, exact) < 1e-4


@pytest.mark.parametrize("fields", [{"velocity": "-x"}, {"source": "sin(x)*exp(-x*x)"}])
def test_a_linear_problem_is_linear(fields):
    problem = Problem(**{**LINE, "half_width": 20.0}, **fields)
    rng = np.random.default_rng(1)
    bells = [lambda x, c=c: np.exp(-((x - c) ** 2)) for c in rng.normal(size=2)]
    zero, one, two, both = (
        solved(problem, given).u.values
        for given in (lambda x: 0.0 * x, *bells, lambda x: bells[0](x) - 2.0 * bells[1](x))
    )
    assert_allclose(both - zero, (one - zero) - 2.0 * (two - zero), atol=1e-7)


@pytest.mark.parametrize("fields", [{"source": "u*(1-u)"}, {"diffusivity": "1 + t"}])
def test_the_ways_of_time_integration_agree(fields):
    every = [
        solved(
            Problem(**{**LINE, "half_width": 20.0, "rtol": 1e-5}, **fields, integrator=one),
            lambda x: green(x, 1.0, 1.5),
        ).u.values
        for one in ("rkc2", "dop853")
    ]
    assert_allclose(*every, atol=1e-4)


def test_stiff_and_coarse_in_time_is_stabilised():
    problem = Problem(
        alpha=1.9,
        half_width=2.0,
        spacing=0.005,
        t_final=1.0,
        rtol=1e-3,
        source="-u**3",
        exterior="truncated",
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        run = solved(problem, lambda x: np.exp(-x * x))
    assert run.integrator == "rkc2"
    assert float(run.evaluations) < 0.2 * float(run.stiffness)


def test_blow_up_says_when():
    problem = Problem(
        alpha=1.5, half_width=5.0, spacing=0.1, diffusivity=0.0, source="u**2", t_final=2.0
    )
    with pytest.raises(NonFiniteSolution, match=r"near t = 0\.5(:|0000)"):
        solve_problem(problem, np.full(101, 2.0))


def test_a_solution_that_has_reached_the_ends_is_told():
    problem = Problem(
        alpha=1.5, half_width=20.0, spacing=0.25, source="u*(1-u)", times=(2.0, 6.0, 12.0)
    )
    with pytest.warns(AccuracyWarning, match=r"by t = (6|12) the solution has reached the ends"):
        run = solve_problem(problem, lambda x: np.exp(-x * x))
    assert (np.diff(run.outside_share) >= 0.0).all()
    with pytest.warns(AccuracyWarning, match="do not resolve"):
        solve_problem(Problem(**{**LINE, "spacing": 1.0}), lambda x: np.exp(-4.0 * x * x))


def test_what_is_well_inside_says_nothing():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solve_problem(Problem(**LINE, velocity=1.0))


REFUSED = {
    "no data": ({"diffusivity": "1 + t"}, None, "data of your own"),
    "a point mass": ({"t_initial": 0.0}, None, "point mass"),
    "shape": ({}, np.ones(3), "initial"),
    "nan": ({}, np.full(1001, np.nan), "initial"),
    "nan in the source": ({"source": "log(u - 1)"}, np.zeros(1001), r"nan at x = -50, t = 1, u = 0"),
    "velocity beyond the end": ({"velocity": "sqrt(50 - x)"}, np.zeros(1001), r"nan at x = 50\.1, t = 1"),
    "digits": ({"integrator": "rkc2", "rtol": 1e-10}, np.ones(1001), "at least 1e-09 for rkc2"),
    "exponential": ({"source": "-u", "integrator": "exponential"}, np.ones(1001), "auto, rkc2 or dop853"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_does_not_fit_is_refused(case):
    fields, data, said = REFUSED[case]
    with pytest.raises(InvalidInput, match=said) as caught:
        solve_problem(Problem(**{**LINE, **fields}), data)
    assert "\n" not in str(caught.value)
    with pytest.raises(InvalidInput, match="problem"):
        solve_problem({}, data)


def test_the_data_set_holds_the_problem_and_can_be_written(tmp_path):
    import xarray as xr

    problem = Problem(**{**LINE, "spacing": 0.5, "order": 4}, velocity="-x", times=(1.5, 2.0))
    run = solve_problem(problem)
    write(run, tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc", decode_times=False) as again:
        assert Problem.from_json(again.attrs["problem"]) == problem
        assert_allclose(again.u, run.u)
        assert again.u.dims == ("t", "x")
    for name, variable in run.variables.items():
        assert {"long_name", "units"} <= set(variable.attrs), name
    for name in ("accepted_steps", "rejected_steps", "evaluations", "stiffness", "mass_initial"):
        assert run[name].ndim == 0
    assert run.mass.dims == ("t",)
    assert solve_problem(problem).identical(run)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # its own
def test_the_checker_of_the_convention_finds_nothing(tmp_path):
    from compliance_checker.runner import CheckSuite, ComplianceChecker

    problem = Problem(
        alpha=1.5, dim=2, half_width=4.0, spacing=0.5, times=(0.5, 1.0), source=lambda x: 0.0 * x
    )
    path, report = tmp_path / "run.nc", tmp_path / "report.json"
    write(solve_problem(problem, lambda x, y: np.exp(-x * x - y * y)), path)
    CheckSuite.load_all_available_checkers()
    ComplianceChecker.run_checker(
        str(path), ["cf:1.11"], 0, "normal", output_filename=str(report), output_format="json"
    )
    verdict = json.loads(report.read_text())["cf:1.11"]
    assert [
        m for level in ("high", "medium") for c in verdict[f"{level}_priorities"] for m in c["msgs"]
    ] == []


def test_a_linear_field_ends_in_the_stationary_law():
    """After a long time the scale is (D / (alpha theta))^(1/alpha), and stays: nothing grows at the ends."""
    run = solved(
        Problem(
            **{**LINE, "half_width": 25.0, "spacing": 0.2, "times": (11.0, 21.0), "t_final": 21.0},
            velocity="-x",
        )
    )
    exact = green(run.x.values, 1.0 / 1.5, 1.5)
    assert error_of(run.isel(t=0), exact) < 1e-6
    assert error_of(run.isel(t=1), exact) < 1e-6


@pytest.mark.parametrize(("form", "source_of_time"), covering(["FPSE", "DD"], [False, True]))
def test_a_diffusivity_that_varies_in_space_and_time(form, source_of_time):
    """u = exp(-t) / (1 + x^2): D' grad^beta u + D div grad^beta u from the closed forms, as the source in text."""
    d = "(1 + 0.5*exp(-x**2/4)*cos(t))" if source_of_time else "(1 + 0.5*exp(-x**2/4))"
    slope = "(-0.25*x*exp(-x**2/4)*cos(t))" if source_of_time else "(-0.25*x*exp(-x**2/4))"
    flux = "(gamma(1.5)*(1 + x**2)**(-0.75)*sin(1.5*arctan(x)))"
    rate = "(gamma(2.5)*(1 + x**2)**(-1.25)*cos(2.5*arctan(x)))"
    source = f"exp(-t)*({d}*{rate} + {slope}*{flux} - 1/(1 + x**2))"
    fields = {
        "half_width": 100.0,
        "spacing": 0.1,
        "t_initial": 0.0,
        "t_final": 1.0,
        "far_terms": None,
    }
    problem = Problem(**{**LINE, **fields}, form=form, diffusivity=d, source=source)
    run = solved(problem, lambda x: 1.0 / (1.0 + x * x))
    assert error_of(run, np.exp(-1.0) / (1.0 + run.x.values**2)) < 1e-6


def test_mass_is_conserved_with_all_that_varies():
    problem = Problem(
        alpha=1.5, half_width=20.0, spacing=0.2, t_final=1.0, exterior="truncated",
        diffusivity="1 + 0.5*sin(x)*exp(-t)", velocity="-x*cos(t)",
    )  # fmt: skip
    run = solved(problem, lambda x: np.exp(-x * x))
    assert abs(float(run.mass_final / run.mass_initial) - 1.0) < 1e-12


def test_a_variable_order_that_is_constant_is_the_constant_one():
    fields = {**LINE, "form": "DD", "far_terms": None, "velocity": "-x", "half_width": 10.0}
    constant = solved(Problem(**fields), lambda x: np.exp(-x * x))
    del fields["alpha"]
    for text, most in (("1.5 + 0*x", 1e-12), ("1.5 + 1e-9*tanh(x)", 1e-9)):
        variable = solved(Problem(alpha=text, **fields), lambda x: np.exp(-x * x))
        assert_allclose(variable.u, constant.u, atol=most)
    assert variable.attrs["title"].endswith("-D (-Laplacian)^(alpha(x)/2) u + f")


@pytest.mark.parametrize("form", few(["FPSE", "DD"], 1))
def test_a_diffusivity_that_varies_in_the_plane(form):
    """u = exp(-|x|^2) (1 + t) of a source made for it: of order 12, for FPSE, too, whose printed kernels end at 4."""
    alpha, rise = 1.5, 0.5

    def exact(x, y, t):
        return (1.0 + t) * Gaussian.value((x, y))

    def source(x, y, t, u):
        bump = rise * Gaussian.value((x, y))
        slopes = Gaussian.gradient((x, y), alpha)
        along = sum(-2.0 * part * bump * slope for part, slope in zip((x, y), slopes, strict=True))
        spread = -(1.0 + bump) * Gaussian.riesz((x, y), alpha) + along
        return Gaussian.value((x, y)) - (1.0 + t) * spread

    problem = Problem(
        alpha=alpha, dim=2, form=form, order=12, diffusivity=f"1 + {rise}*exp(-x**2 - y**2)",
        source=source, half_width=8.0, spacing=0.2, t_final=0.5, rtol=1e-6,
    )  # fmt: skip
    run = solved(problem, lambda x, y: exact(x, y, 0.0))
    x, y = np.meshgrid(run.x, run.y, indexing="ij")
    assert np.abs(run.u.values - exact(x, y, 0.5)).max() < 1e-4 * 1.5
