"""Stepping, its Chebyshev series and the exponential, against each other and against known answers."""

from __future__ import annotations

from math import factorial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm, toeplitz
from scipy.special import ive

from combinations import case_of, combinations_without
from fracparticles.errors import NonFiniteSolution, StabilityWarning
from fracparticles.lattice.operators import ConvolutionOperator
from fracparticles.run.solver import prepare
from fracparticles.schemes import SCHEMES, Setting, dpse
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.special import green
from fracparticles.time import STEP_POLYNOMIALS, ChebyshevSeries, exponential, power, step
from sweeps import covering, few

INTEGRATORS = ["euler", "rk2", "rk4"]


def diagonal_operator(eigenvalues: np.ndarray) -> ConvolutionOperator:
    return ConvolutionOperator(np.zeros_like, np.asarray(eigenvalues, dtype=float), None)


# --- step polynomials -----------------------------------------------------------------------------


@pytest.mark.parametrize("name", INTEGRATORS)
@given(z=st.floats(-5.0, 1.0))
def test_the_step_polynomial_is_the_truncated_exponential(name, z):
    p = STEP_POLYNOMIALS[name]
    direct = sum(z**k / factorial(k) for k in range(p.stages + 1))
    assert p(z) == pytest.approx(direct, rel=1e-13, abs=1e-13)  # terms up to 5^4 / 24 = 26


@pytest.mark.parametrize("name", INTEGRATORS)
def test_the_stability_interval_is_where_the_polynomial_is_at_most_one(name):
    p = STEP_POLYNOMIALS[name]
    inside = np.linspace(-p.stability_interval, 0.0, 10001)
    assert np.abs(p(inside)).max() <= 1.0 + 1e-14
    assert abs(p(-p.stability_interval * (1.0 + 1e-9))) > 1.0


@pytest.mark.parametrize("name", INTEGRATORS)
@given(z=st.floats(-4.0, 0.0), steps=st.integers(1, 40))
def test_log_power_is_the_power(name, z, steps):
    p = STEP_POLYNOMIALS[name]
    sign, logarithm = p.log_power(np.array([z]), steps)
    direct = float(p(z)) ** steps
    # A step's p carries a few ulp of its largest term 4^4 / 24; the power multiplies them by `steps`.
    slack = 1e-13 * steps * max(abs(float(p(z))), 1.0) ** steps
    assert sign * np.exp(logarithm) == pytest.approx(direct, rel=1e-12, abs=slack)


def test_log_power_keeps_its_digits_for_many_tiny_steps():
    p = STEP_POLYNOMIALS["euler"]
    _, logarithm = p.log_power(np.array([-1e-12]), 10**9)
    assert logarithm[0] == pytest.approx(-1e-3, rel=1e-11)


# --- the series -----------------------------------------------------------------------------------


def test_coefficients_of_the_exponential_are_bessel_functions():
    """exp(z t) on [-2, 0] is exp(-t) exp(t x): c_k = (2 - [k = 0]) exp(-t) I_k(t)."""
    series = exponential(30.0, -2.0, 0.0)
    k = np.arange(series.degree + 1)
    expected = np.where(k == 0, 1.0, 2.0) * ive(k, 30.0)
    assert series.coefficients == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("name", INTEGRATORS)
def test_the_series_has_the_values_of_the_power(name):
    p = STEP_POLYNOMIALS[name]
    eigenvalues = np.linspace(-1.0, 0.0, 500)
    dt, steps = 1.9, 200
    series = power(p, dt, steps, -1.0, 0.0)
    out = series(diagonal_operator(eigenvalues), np.ones(500))
    sign, logarithm = p.log_power(eigenvalues * dt, steps)
    # A sum of `degree` terms of at most 1, in a recurrence whose round-off grows with the degree.
    assert out == pytest.approx(sign * np.exp(logarithm), abs=series.degree * 4e-16 * 4)


def test_the_degree_grows_like_a_square_root():
    degrees = np.array([exponential(t, -1.0, 0.0).degree for t in (1e2, 1e4, 1e6)])
    assert degrees[1:] / degrees[:-1] == pytest.approx(10.0, rel=0.15)
    assert degrees[-1] < np.sqrt(40.0 * 1e6)  # sqrt(2 T |low| / 2 * log(2^54))


def test_a_series_of_a_constant_applies_nothing():
    series = ChebyshevSeries.of(lambda z: np.full_like(z, 3.0), -1.0, 0.0)
    assert series.degree == 0
    assert np.array_equal(
        series(diagonal_operator(np.zeros(4)), np.arange(4.0)), 3.0 * np.arange(4)
    )


# --- against each other, for every scheme ---------------------------------------------------------


def initial_data(kind: str, case) -> np.ndarray:
    if kind == "smooth":
        return green(case.x, (0.2 * case.n) ** case.alpha, case.alpha)
    if kind == "point":
        return (case.x == 0.0).astype(float)
    return np.random.default_rng(3).standard_normal(case.particles)


def both(combination, beta, integrator, courant, steps, kind, overlap=2.0, n=60):
    """Stepping and series, with dt = courant times the largest stable step.

    An open lattice must be wider than what a point mass spreads over: five times the width, a tenth of the steps.
    """
    scheme = combination[0]
    if combination[2] == "open":
        n, steps = 5 * n, max(steps // 10, 40)
    if scheme == "GPSE":
        dt = overlap ** (1.0 + beta)
    else:
        probe = case_of(combination, beta, overlap, n, integrator=integrator, dt=1.0)
        dt = courant * probe.largest_stable_step
    results = []
    for evaluation in ("stepping", "series"):
        case = case_of(
            combination,
            beta,
            overlap,
            n,
            integrator=integrator,
            evaluation=evaluation,
            dt=dt,
            t_initial=0.0,
            t_final=steps * dt,
            initial="own",
        )
        operator = SCHEMES[scheme].operator(case.setting)
        results.append(prepare(case, operator).solve(initial_data(kind, case)))
    return (*results, np.abs(initial_data(kind, case)).max())


def non_normality(beta, order, n=60) -> float:
    """Bound of |f(A)| / max |f| for DPSE: A = L B with L and B symmetric and B, the potential, positive.

    A is similar to B^(1/2) L B^(1/2): the bound is the root of the condition number of B, and so much more does
    round-off weigh.
    """
    b = dpse.potential_weights(np.arange(2.0 * n + 1.0), Setting(alpha=1.0 + beta, order=order))
    return float(np.sqrt(np.linalg.cond(toeplitz(b))))


# A step of GPSE is an Euler step, and the solutions of (29) grow: they are in the next test.
@pytest.mark.parametrize(
    ("scheme", "kind"),
    covering(
        [
            (parameter.values[0], integrator)
            for parameter in combinations_without("PSE29")
            for integrator in INTEGRATORS
            if parameter.values[0][0] != "GPSE" or integrator == "euler"
        ],
        ["smooth", "random"],
    ),
)
def test_series_and_stepping_give_the_same(scheme, kind):
    combination, integrator = scheme
    for beta in few((0.1, 0.5, 0.9)):
        stepping, series, start = both(combination, beta, integrator, 0.9, 400, kind)
        room = 1e-12 * (non_normality(beta, combination[1]) if combination[0] == "DPSE" else 1.0)
        assert np.abs(series - stepping).max() <= room * start, beta


# The step of GPSE is tied to the smoothing length and cannot be unstable here.
@pytest.mark.parametrize(
    ("combination", "integrator", "kind"),
    covering(
        [parameter.values[0] for parameter in combinations_without("GPSE")],
        INTEGRATORS,
        ["point", "random"],
        together=2,
    ),
)
def test_they_blow_up_alike(combination, integrator, kind):
    """Beyond the limit the shortest waves grow; relative to them the two agree."""
    with pytest.warns(StabilityWarning):
        stepping, series, _ = both(combination, 0.5, integrator, 1.3, 40, kind)
    assert np.abs(stepping).max() > 1e3
    assert np.abs(series - stepping).max() <= 1e-12 * np.abs(stepping).max()


@pytest.mark.parametrize("overlap", [2.9, 4.0])
def test_they_agree_where_an_eigenvalue_lies_below_the_symbol(overlap):
    stepping, series, start = both(
        ("KPSE", 4, "truncated"), 0.95, "rk2", 0.9, 2000, "random", overlap=overlap
    )
    assert np.abs(series - stepping).max() <= 1e-12 * start


def test_they_agree_on_the_growing_solutions_of_scheme_29():
    for order in (2, 4):
        with pytest.warns(StabilityWarning, match="amplifies"):
            stepping, series, _ = both(
                ("PSE29", order, "truncated"), 0.5, "rk2", 0.5, 200, "random"
            )
        assert np.abs(series - stepping).max() <= 1e-12 * np.abs(stepping).max()


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_overflow_is_reported_by_both(integrator):
    operator = diagonal_operator(np.array([-1.0, -0.5]))
    p = STEP_POLYNOMIALS[integrator]
    with pytest.raises(NonFiniteSolution, match=r"after step \d+ of 5000, .*unstable here\. Take"):
        step(operator, p, 4.0, 5000, np.ones(2))
    with pytest.raises(NonFiniteSolution, match=r"overflows near step \d+ of 5000, .*outside the"):
        power(p, 4.0, 5000, -1.0, 0.0)


def test_a_series_of_huge_data_reports_overflow():
    series = exponential(1.0, -1.0, 0.0)
    operator = diagonal_operator(np.array([-3.0, -0.5]))
    with pytest.raises(NonFiniteSolution, match="overflow"), np.errstate(all="ignore"):
        series(operator, np.full(2, 1e308))


@pytest.mark.parametrize("name", INTEGRATORS)
def test_stepping_leaves_its_input_alone(name):
    u = np.ones(3)
    out = step(diagonal_operator(-np.ones(3)), STEP_POLYNOMIALS[name], 0.1, 3, u)
    assert np.array_equal(u, np.ones(3))
    assert out == pytest.approx(np.full(3, float(STEP_POLYNOMIALS[name](-0.1)) ** 3), rel=1e-15)


# --- against the exponential of the matrix --------------------------------------------------------


@pytest.mark.parametrize("combination", combinations_without("GPSE", "PSE29"))
def test_the_exponential_is_that_of_the_matrix(combination):
    scheme = combination[0]
    case = case_of(combination, 0.5, 2.0, 30, t_initial=0.0, t_final=20.0, initial="own")
    operator = SCHEMES[scheme].operator(case.setting)
    u0 = initial_data("random", case)
    u = prepare(case, operator).solve(u0)
    exact = expm(20.0 * dense_matrix(operator)) @ u0
    assert np.abs(u - exact).max() <= 1e-12 * np.abs(u0).max()


@pytest.mark.parametrize("name", INTEGRATORS)
@pytest.mark.parametrize("scheme", ["DD", "FPSE", "KPSE"])
def test_order_of_convergence_in_time(name, scheme):
    operator = SCHEMES[scheme].operator(Setting(n=40, spacing=1.0, alpha=1.5))
    x = np.arange(-40.0, 41.0)
    u0 = green(x, 8.0, 1.5)
    exact = exponential(8.0, -1.0, 0.0)(operator, u0)
    p = STEP_POLYNOMIALS[name]
    steps = np.array([16, 32, 64])
    errors = [np.abs(step(operator, p, 8.0 / k, k, u0) - exact).max() for k in steps]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(p.stages, abs=0.1)
