"""Particles that move, exchange with a diffusivity that varies, and have a source: exact and manufactured solutions."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

import fracparticles as fp
from fracparticles.adaptive.exchange import exchange_matrix, rate_matrix
from fracparticles.adaptive.flow import ExchangeFlow
from fracparticles.adaptive.follow import follow
from fracparticles.adaptive.placement import place_particles
from fracparticles.adaptive.splitting import Physics, Splitting
from fracparticles.errors import AccuracyWarning, NonFiniteSolution
from fracparticles.special import green
from fracparticles.variable.closed_forms import exchange_limit
from known import blobs
from sweeps import few

WINDOW = (-20.0, 80.0)
TIMES = (1e-3, 0.1, 1.0)


def error(state, exact):
    """Sum V |u - exact| over sum V |exact|."""
    there, volumes = exact(state.particles.x, state.time), state.particles.volumes
    return float(volumes @ np.abs(state.u - there) / (volumes @ np.abs(there)))


def sinh_particles(count=60):
    return place_particles(lambda x: np.sqrt(1.0 + x * x), -200.0, 200.0, 12.0 / count)


@pytest.mark.parametrize("time", [0.01, 3.0])  # by a series, by eigenvectors
def test_the_flow_is_the_exponential_of_the_rates(time):
    particles = sinh_particles()
    d = 1.0 + 0.5 / (1.0 + particles.x**2)
    u = np.exp(-((particles.x - 0.3) ** 2))
    rates = rate_matrix(
        exchange_matrix(particles, 1.6, 3) * 0.5 * (d[:, None] + d), particles.volumes, None
    )
    found = ExchangeFlow(particles, 1.6, 3, d)(u, time)
    assert found == pytest.approx(expm(time * rates) @ u, abs=1e-11)
    assert particles.volumes @ found == pytest.approx(particles.volumes @ u, rel=1e-14)


@pytest.mark.parametrize("alpha", [1.2, 1.8])
def test_a_uniform_velocity_carries_particles_and_solution(alpha):
    def exact(x, t):
        return blobs(x - 2.0 * t, t, alpha)

    still = follow(lambda x: exact(x, 0.0), TIMES, alpha=alpha, window=WINDOW)
    moved = follow(
        lambda x: exact(x, 0.0), TIMES, alpha=alpha, window=WINDOW,
        velocity=lambda x, t: np.full(x.size, 2.0),
    )  # fmt: skip
    for one, other in zip(still, moved, strict=True):
        assert other.particles.x == pytest.approx(one.particles.x + 2.0 * one.time, abs=1e-6)
        assert other.u == pytest.approx(one.u, abs=1e-7 * one.u.max())
        assert error(other, exact) < 2e-5


@pytest.mark.parametrize("alpha", [1.2, 1.8])
def test_a_linear_velocity_is_that_of_ornstein_and_uhlenbeck(alpha):
    """u_t = (x u)_x - (-Laplacian)^(alpha/2) u: (1 - exp(-alpha t)) / alpha is the time of the blobs."""

    def exact(x, t):
        past, shrunk = -np.expm1(-alpha * t) / alpha, np.exp(-alpha * t)
        narrow = green(x, 0.01**alpha * shrunk + past, alpha)
        return 0.5 * narrow + 0.5 * green(x - 50.0 * np.exp(-t), shrunk + past, alpha)

    states = follow(
        lambda x: exact(x, 0.0), TIMES, alpha=alpha, window=WINDOW, velocity=lambda x, t: -x
    )
    assert max(error(state, exact) for state in states) < 2e-5
    masses = np.array([state.mass for state in states])
    assert np.abs(masses / masses[0] - 1.0).max() < 1e-12


def test_a_source_that_depends_on_time_and_on_u():
    """(1 + t) exp(-2 t) times the blobs: f = blobs exp(-2 t) - 2 u."""
    alpha = 1.5

    def exact(x, t):
        return (1.0 + t) * np.exp(-2.0 * t) * blobs(x, t, alpha)

    states = follow(
        lambda x: exact(x, 0.0), TIMES, alpha=alpha, window=WINDOW, step=0.2,
        source=lambda x, t, u: np.exp(-2.0 * t) * blobs(x, t, alpha) - 2.0 * u,
    )  # fmt: skip
    assert max(error(state, exact) for state in states) < 5e-6


def test_logistic_growth_without_diffusion_to_speak_of():
    """u' = u (1 - u) at each particle."""
    state = follow(
        lambda x: 0.5 * np.exp(-x * x), 2.0, alpha=1.5, window=(-5.0, 5.0), diffusivity=1e-9,
        source=lambda x, t, u: u * (1.0 - u), step=0.15,
    )[0]  # fmt: skip
    x = np.linspace(-1.0, 1.0, 21)
    start = 0.5 * np.exp(-x * x)
    exact = start * np.exp(2.0) / (1.0 + start * np.expm1(2.0))
    assert state.at(x) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("alpha", few([1.2, 1.6], 1))
def test_a_diffusivity_that_varies_is_that_of_the_exchange(alpha):
    """1 / (1 + x^2) stays as it is if f = -(D L u + L(D u) - u L D) / 2, D = 1 + u / 2."""

    def exact(x, t):
        return 1.0 / (1.0 + x * x)

    errors = []
    for step in (0.25, 0.18):
        states = follow(
            lambda x: exact(x, 0.0), (0.1, 0.5), alpha=alpha, window=(-10.0, 10.0), step=step,
            diffusivity=lambda x: 1.0 + 0.5 / (1.0 + x * x),
            source=lambda x, t, u: -exchange_limit(x, alpha, 0.5),
        )  # fmt: skip
        errors.append(max(error(state, exact) for state in states))
    assert errors[0] < 1e-6
    assert errors[1] < 0.2 * errors[0]


def test_a_diffusivity_and_a_velocity_that_vary_keep_the_mass():
    """And the result does not depend on the step of the placement or on the tolerance."""

    def run(step, tolerance):
        return follow(
            lambda x: blobs(x, 0.0, 1.5), (0.01, 0.3), alpha=1.5, window=WINDOW, step=step, tolerance=tolerance,
            diffusivity=lambda x: 1.0 + 0.5 * np.tanh(x - 1.0), velocity=lambda x, t: np.cos(t) / (1.0 + x * x),
        )  # fmt: skip

    coarse, fine = run(0.25, 1e-7), run(0.15, 1e-10)
    for one, other in zip(coarse, fine, strict=True):
        assert one.mass == pytest.approx(0.0 + coarse[0].mass, rel=1e-12)
        at = np.concatenate([np.linspace(-2.0, 4.0, 61), np.linspace(45.0, 55.0, 41)])
        assert one.at(at) == pytest.approx(other.at(at), abs=2e-5 * other.u.max())


def test_the_extrapolated_splitting_meets_its_tolerance():
    """Against the exponential of all: a source -k(x) u on particles that stay."""
    particles = sinh_particles()
    k = 2.0 / (1.0 + particles.x**2)
    rates = rate_matrix(exchange_matrix(particles, 1.4, 2), particles.volumes, None)
    u = np.exp(-(particles.x**2))
    exact = expm(0.4 * (rates - np.diag(k))) @ u
    physics = Physics(1.4, 2, 1.0, source=lambda x, t, u: -2.0 * u / (1.0 + x * x))
    for tolerance in (1e-4, 1e-8):
        _, found = Splitting(physics, tolerance)(particles, u, 0.0, 0.4)
        missed = particles.volumes @ np.abs(found - exact) / (particles.volumes @ np.abs(exact))
        assert missed < tolerance


def bell(x):
    return np.exp(-x * x)


def test_a_source_that_the_particles_miss_is_said():
    with pytest.warns(AccuracyWarning, match="of the source the particles miss"):
        follow(
            bell, 1e-3, alpha=1.5, window=(-5.0, 5.0),
            source=lambda x, t, u: bell((x - 33.3) / 0.2),  # beyond the window
        )  # fmt: skip


def test_a_solution_that_the_particles_do_not_resolve_is_said():
    """A steep front, which the velocity makes of smooth data between two placements that are not asked for."""
    with pytest.warns(AccuracyWarning, match="later, between the particles is"):
        follow(
            bell, 1.0, alpha=1.9, window=(-5.0, 5.0), step=0.3, again=False, diffusivity=1e-3,
            source=lambda x, t, u: 20.0 * u * (1.0 - u) * (u - 0.5),
        )  # fmt: skip


def test_a_diffusivity_of_zero_leaves_all_as_it_is():
    state = follow(bell, 1.0, alpha=1.5, window=(-5.0, 5.0), diffusivity=lambda x: 0.0 * x)[0]
    assert state.u == pytest.approx(bell(state.particles.x), abs=1e-15)
    assert state.placements == 1


def test_particles_that_run_into_each_other_are_an_error():
    with pytest.raises(NonFiniteSolution, match=r"near t = |before t = |after t = |at t = "):
        follow(bell, 1.0, alpha=1.5, window=(-5.0, 5.0), velocity=lambda x, t: -np.sign(x))


def test_what_blows_up_is_an_error_with_its_time():
    with pytest.raises(NonFiniteSolution, match=r"near t = |after t = |at t = "):
        follow(
            lambda x: 5.0 * np.exp(-x * x), 1.0, alpha=1.5, window=(-5.0, 5.0), diffusivity=1e-3,
            source=lambda x, t, u: u * u,
        )  # fmt: skip


def test_a_source_that_overflows_on_the_way_blows_up():
    """u' = exp(u) from 1 ends at 1 / e; exp(u) is infinite before u is."""
    with pytest.raises(NonFiniteSolution, match=r"near t = 0\.3[67]"):
        follow(
            bell, 1.0, alpha=1.9, window=(-5.0, 5.0), diffusivity=1e-6,
            source=lambda x, t, u: bell(x / 3.0) * np.exp(u),
        )  # fmt: skip


@pytest.mark.parametrize("unit", few([1e-9, 1e7], 1))
def test_units_do_not_matter(unit):
    """x in another unit, and t in that of the diffusion: the same particles and strengths."""
    alpha, power = 1.5, unit**1.5

    def run(length, time):
        return follow(
            lambda x: blobs(x / length, 0.0, alpha), 0.3 * time, alpha=alpha, window=(-20.0 * length, 80.0 * length),
            velocity=lambda x, t: length / time * np.sin(0.1 * x / length) * np.cos(t / time),
            diffusivity=lambda x: 1.0 + 0.5 * np.tanh(x / length),
            source=lambda x, t, u: (0.2 - u) * u / time, step=0.3,
        )[0]  # fmt: skip

    one, other = run(1.0, 1.0), run(unit, power)
    assert other.particles.x == pytest.approx(unit * one.particles.x, rel=1e-6, abs=1e-6 * unit)
    assert other.u == pytest.approx(one.u, abs=1e-6 * one.u.max())
    assert other.placements == one.placements


def test_the_front_of_fisher_and_kpp_is_where_a_lattice_has_it():
    """u_t = L u + u (1 - u), whose tail runs ahead exponentially: two methods that have nothing in common."""
    state = follow(
        lambda x: np.exp(-x * x / 8.0), 9.0, alpha=1.5, window=(-15.0, 15.0), step=0.2,
        source=lambda x, t, u: u * (1.0 - u),
    )[0]  # fmt: skip
    problem = fp.Problem(
        alpha=1.5, half_width=1000.0, spacing=0.25, source="u*(1 - u)", t_final=9.0, order=6, rtol=1e-8
    )  # fmt: skip
    run = fp.solve_problem(problem, lambda x: np.exp(-x * x / 8.0), estimate=False)
    x = run["x"].sel(x=slice(-200.0, 200.0)).values
    # The kernels of order 6 at half the width of the first bell leave some 1e-6 in the place of the front.
    assert state.at(x) == pytest.approx(run["u"].sel(x=x).values, abs=2e-5)
    tail = np.array([150.0, 200.0])
    assert state.at(tail) == pytest.approx(run["u"].sel(x=tail).values, rel=1e-4)
