"""Nonlinear diffusion by markers and by finite volumes, and the stabilised integrator, against known answers."""

from __future__ import annotations

import math
from inspect import signature

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracparticles.errors import InvalidInput, NonFiniteSolution, StabilityWarning
from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, run, uniform
from fracparticles.markers.fourier import FourierMarkerVelocity
from fracparticles.markers.nonlinear import Lines, NonlinearDiffusion
from fracparticles.markers.stability import extremes
from fracparticles.moving.lagrangian import FieldNotPositive
from fracparticles.time.rkc import ChebyshevStep, stages_for

PROBLEM = NonlinearDiffusion()


# --- RKC2 -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("stages", [2, 3, 4, 7, 20, 100])
def test_the_step_is_stable_on_its_interval(stages):
    step = ChebyshevStep(stages)
    inside = np.linspace(-step.stability_interval, 0.0, 2001)
    # The step polynomial itself: f(y) = z y from y = 1. Round-off of the stages, about s^2 ulp.
    slack = 1e-14 * stages**2
    assert np.abs(step(lambda y: inside * y, np.ones_like(inside), 1.0)).max() <= 1.0 + slack
    beyond = -1.02 * step.stability_interval
    # At its end T_s(-1) = (-1)^s: the polynomial goes on above 1 for even s, and on down from 1 - 2 b_s for odd.
    if stages % 2 == 0:
        assert abs(step(lambda y: beyond * y, np.ones(1), 1.0)[0]) > 1.0
    # Sommeijer et al.: the interval is about 2/3 (s^2 - 1) (1 - 2/15 * 2/13).
    near = 2.0 / 3.0 * (stages**2 - 1) * (1.0 - 2.0 / 15.0 * 2.0 / 13.0)
    assert step.stability_interval == pytest.approx(near, rel=0.02)


@pytest.mark.parametrize("stages", [2, 5, 30])
def test_second_order(stages):
    """y_1' = -y_1^2, y_2' = -y_2 + y_1 y_2 has the solution 1 / (1 + t), exp(-t) (1 + t)."""

    def rate(y):
        return np.array([-(y[0] ** 2), -y[1] + y[1] * y[0]])

    def error(steps):
        y = ChebyshevStep(stages).advance(rate, np.ones(2), dt=1.0 / steps, steps=steps)
        return np.abs(y - np.array([0.5, 2.0 * math.exp(-1.0)])).max()

    # Error c dt^2 (1 + O(dt)): the ratio at dt = 1/40 is 4 within a few dt.
    assert error(40) / error(80) == pytest.approx(4.0, rel=0.1)


@given(z=st.floats(0.1, 300.0))
def test_stages_for_is_the_least_number(z):
    stages = stages_for(z)
    assert ChebyshevStep(stages).stability_interval >= z
    assert stages == 2 or ChebyshevStep(stages - 1).stability_interval < z


@pytest.mark.parametrize("stages", [1, 0, 2.5, 251])
def test_stages_are_checked(stages):
    with pytest.raises(InvalidInput):
        ChebyshevStep(stages)


def test_too_stiff():
    with pytest.raises(InvalidInput, match="smaller dt"):
        stages_for(1e6)


def test_a_blow_up_names_the_step_and_keeps_its_kind():
    with (
        np.errstate(over="ignore", invalid="ignore"),
        pytest.raises(NonFiniteSolution, match=r"step \d+ of 100, from t = "),
    ):
        ChebyshevStep(2).advance(lambda y: y**3, np.full(1, 3.0), dt=1.0, steps=100)

    def refuse(y):
        raise FieldNotPositive("here")

    with pytest.raises(FieldNotPositive, match=r"step 1 of 2, from t = 5 to 6: here"):
        ChebyshevStep(2).advance(refuse, np.ones(1), dt=1.0, steps=2, start=5.0)


# --- the equation ---------------------------------------------------------------------------------


@given(x=st.floats(-3.0, 3.0), alpha=st.floats(0.5, 6.0), x0=st.floats(0.1, 1.0))
def test_the_source_is_the_derivative_of_its_integral(x, alpha, x0):
    p = NonlinearDiffusion(7.0, alpha, x0)
    step = 1e-4  # central difference: error step^2 times a third derivative of order D_0 alpha^2
    difference = (p.cumulative_source(x + step) - p.cumulative_source(x - step)) / (2.0 * step)
    assert difference == pytest.approx(float(p.source(np.float64(x))), abs=1e-4)


def test_potential():
    f = np.array([1e-9, 1e-3, 0.5, 3.0])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    integral = [0.5 * b * weights @ PROBLEM.diffusivity(0.5 * b * (1.0 + nodes)) for b in f]
    assert PROBLEM.potential(f) == pytest.approx(integral, rel=1e-6)
    assert PROBLEM.diffusivity(1.0) == pytest.approx(PROBLEM.largest_diffusivity)


def test_the_steady_state_stays():
    """Finite volumes keep f_inf, to round-off; and they keep the total of anything."""
    lines = Lines(PROBLEM, 2.5, 200, 2.5)
    f = PROBLEM.steady(lines.x)
    # Differences of potentials of order 10, over h^2.
    assert np.abs(lines.rate(0.0, f)).max() < 10.0 * 2.0**-50 / lines.h**2
    g = Gaussian().value(lines.x)
    assert abs(lines.rate(0.0, g).sum()) < 200 * 10.0 * 2.0**-50 / lines.h**2


def test_what_the_steady_state_has_beyond():
    problem = NonlinearDiffusion(10.0, 4.0, 0.5)
    x, w = np.polynomial.legendre.leggauss(60)
    right = 2.0 * (w @ problem.steady(1.7 + 2.0 * (1.0 + x)))  # to 5.7, where f_inf is 1e-47
    assert problem.steady_beyond(1.7) == pytest.approx(2.0 * right, rel=1e-12)
    assert problem.steady_beyond(0.0) == pytest.approx(2.0 * math.sqrt(math.pi / 4.0), rel=1e-14)


def test_jacobian():
    lines = Lines(PROBLEM, 2.0, 12, 2.0)
    f, step = Gaussian().value(lines.x), 1e-6
    numeric = np.column_stack(
        [
            (lines.rate(0.0, f + e) - lines.rate(0.0, f - e)) / (2.0 * step)
            for e in step * np.eye(12)
        ]
    )
    scale = np.abs(numeric).max()
    assert np.abs(lines.jacobian(0.0, f).toarray() - numeric).max() < 1e-8 * scale


def test_positivity_is_lost_in_the_flank():
    """The time is the same for two lattices; a profile that stays above f_inf never vanishes."""
    found = []
    for cells in (400, 800):
        lines = Lines(PROBLEM, 4.0, cells, 3.0)
        found.append(lines.positivity_lost(Gaussian().value(lines.x), 1.0))
    (coarse, _), (fine, place) = found
    assert fine == pytest.approx(coarse, rel=0.02)
    assert PROBLEM.source(np.array(place)) < 0.0
    with pytest.raises(NonFiniteSolution, match="does not stay positive"):
        lines.solve(Gaussian().value(lines.x), [0.1, 1.0])
    assert lines.positivity_lost(PROBLEM.steady(lines.x) + 0.1, 1.0)[0] == math.inf


# --- the markers ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def markers():
    x, weights = uniform(Gaussian().value, (-2.5, 2.5), 128)
    return x, weights, math.sqrt(5.0 / 128)


def test_the_fourier_sums_are_the_sums_over_neighbours(markers):
    x, weights, epsilon = markers
    fast = FourierMarkerVelocity(epsilon, PROBLEM.flux, derivatives=2)
    slow = MarkerVelocity(SHAPES["S8"], epsilon, PROBLEM.flux, derivatives=2)
    scale = np.abs(slow.fields(x, weights)).max(axis=1, keepdims=True)
    assert (
        np.abs((fast.fields(x, weights) - slow.fields(x, weights)) / scale).max()
        < fast._sums.accuracy
    )
    z = np.linspace(-1.0, 1.0, 7)
    assert fast.fields(x, weights, z)[0] == pytest.approx(slow.fields(x, weights, z)[0], abs=1e-11)
    # An error of F relative to its maximum grows by the smallest F, which is 2e-3 of it.
    assert fast(x, weights) == pytest.approx(slow(x, weights), rel=1e-7, abs=1e-7)


def test_markers_at_the_steady_state_stay(markers):
    """V is zero where F = f_inf, up to what smoothing by S8 changes: eps^4 f^(4) / 32 of f, eps = 0.1."""
    x, _, _ = markers
    x = np.linspace(-1.5, 1.5, 400)
    weights = PROBLEM.steady(x) * (x[1] - x[0])
    v = FourierMarkerVelocity(0.1, PROBLEM.flux)(x, weights)
    start = FourierMarkerVelocity(0.1, PROBLEM.flux)(x, Gaussian().value(x) * (x[1] - x[0]))
    core = np.abs(x) < 0.9
    assert np.abs(v[core]).max() < 0.02 * np.abs(start[core]).max()


def test_the_markers_follow_the_equation(markers):
    x, weights, epsilon = markers
    velocity = FourierMarkerVelocity(epsilon, PROBLEM.flux)
    end = ChebyshevStep(4).advance(lambda x: velocity(x, weights), x, dt=0.01, steps=10)
    lines = Lines(PROBLEM, 4.0, 400, 3.0)
    exact = np.interp(end, lines.x, lines.solve(Gaussian().value(lines.x), [0.1])[0])
    gap = np.abs(velocity.fields(end, weights)[0] - exact)
    # Smoothing: eps^4 max |f^(4)| / 32, where f is no rougher than f_inf, whose fourth derivative is 12 alpha^2.
    core = np.abs(end) < 1.2
    assert gap[core].max() < epsilon**4 * 12.0 * PROBLEM.alpha**2 / 32.0
    assert np.abs(exact - Gaussian().value(end))[core].max() > 0.1


def test_the_limit_of_the_step(markers):
    x, weights, epsilon = markers
    limit = PROBLEM.step_limit(epsilon, extremes(SHAPES["S8"]).eta)
    velocity = FourierMarkerVelocity(epsilon, PROBLEM.flux)

    def deviation(dt):
        end = run(x, weights, velocity, dt=dt, steps=round(1.0 / dt))
        core = np.abs(end.x) < 1.2
        return np.abs(velocity.fields(end.x, weights)[0] - PROBLEM.steady(end.x))[core].max()

    assert deviation(0.9 * limit) < 0.02
    with pytest.warns(StabilityWarning, match="times the limit of stability, 0.00632"):
        assert deviation(1.2 * limit) > 0.1


def test_the_coefficient_of_a_large_f_is_zero():
    assert NonlinearDiffusion(1e100, 1.0, 1.0).diffusivity([1e300]).tolist() == [0.0]


@pytest.mark.parametrize("derivative", [0, 1, 2])
@pytest.mark.parametrize("alpha", [1e-3, 0.25, 4.0, 1e3])
def test_the_steady_state_is_that_of_two_gaussians_of_any_width(alpha, derivative):
    """(24) and its derivatives, a standard deviation, five and ten from the middle of either one."""
    problem = NonlinearDiffusion(alpha=alpha)
    x = np.outer([-10.0, -5.0, -1.0, 0.0, 1.0, 5.0, 10.0], [1.0, 1.0]) / math.sqrt(2.0 * alpha)
    x += [-0.5, 0.5]
    expected = sum(
        np.exp(-alpha * y * y)
        * (1.0, -2.0 * alpha * y, (2.0 * alpha * y) ** 2 - 2.0 * alpha)[derivative]
        for y in (x - 0.5, x + 0.5)
    )
    assert problem.steady(x, derivative) == pytest.approx(expected, rel=1e-12, abs=0.0)


def test_the_fourier_sums_take_what_the_sums_over_neighbours_take():
    fourier, neighbours = (signature(one) for one in (FourierMarkerVelocity, MarkerVelocity))
    for name, parameter in fourier.parameters.items():
        assert parameter.default == neighbours.parameters[name].default


@pytest.mark.parametrize(("place", "value"), [(0, -0.5), (-1, -1e-9), (50, 0.0)])
def test_a_field_below_zero_is_refused_where_it_is_not_watched_and_zero_where_it_is(place, value):
    lines = Lines(PROBLEM, 4.0, 100, 1.0)
    f = np.ones(100)
    f[place] = value
    with pytest.raises(InvalidInput, match="f = "):
        lines.solve(f, [0.0, 1e-3])


def test_the_stabilised_steps_are_observed_from_zero_on():
    seen: list[float] = []
    ChebyshevStep(3).advance(
        lambda y: -y, np.ones(1), dt=0.25, steps=3, observe=lambda t, _: seen.append(t)
    )
    assert seen == [0.0, 0.25, 0.5, 0.75]
