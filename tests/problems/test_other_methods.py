"""Problems whose solution other methods know: Fourier series, and Jacobi and Zernike polynomials (`spectral`)."""

from __future__ import annotations

import warnings
from functools import partial

import numpy as np
import pytest
import spectral
from spectral import Jacobi, Zernike, circle

from fracparticles.errors import AccuracyWarning
from fracparticles.problems import Problem, solve_problem
from known import error_of
from sweeps import covering

IN_TIME = 1e-4  # of the greatest |u|: some hundred steps of the default tolerance, 1e-6

LINES = {
    "moving layers": (
        {"diffusivity": lambda x, t: 0.6 + 0.5 * np.tanh(x - t), "spacing": 0.1, "order": 4},
        {"velocity": lambda x, t: np.sin(x + 3.0 * t) * np.exp(-x * x / 30.0)},
        {"source": lambda x, t, u: u * (1.0 - u)},
    ),
    "a contrast of fifty": (
        {"diffusivity": lambda x, t: 0.02 + np.exp(-x * x / 4.0), "spacing": 0.1, "order": 8},
        {"velocity": lambda x, t: 0.0 * x},
        {"source": lambda x, t, u: -5.0 * u * u},
    ),
    "a stiff decay": (
        {"diffusivity": lambda x, t: 1.0 - 0.98 * np.exp(-x * x), "spacing": 0.1, "order": 4},
        {"velocity": lambda x, t: -x / (1.0 + x * x / 25.0)},
        {"source": lambda x, t, u: -20.0 * u},
    ),
}


def bell(*place, width=1.0, at=0.5):
    return np.exp(-(((place[0] - at) / width) ** 2) - sum((y / width) ** 2 for y in place[1:]))


@pytest.fixture
def short_circle(monkeypatch):
    """A quarter of the length: the next turn is 70 and more away, and t C_alpha / 70^2.1 of int u is 2e-5 of u."""
    monkeypatch.setattr(spectral, "_LENGTH", 100.0)
    monkeypatch.setattr(spectral, "_POINTS", 2**11)


@pytest.mark.usefixtures("short_circle")
@pytest.mark.parametrize(("kind", "alpha"), covering(LINES, [1.1, 1.8]))
def test_the_line(kind, alpha):
    d, a, f = LINES[kind]
    fields = {"alpha": alpha, "half_width": 30.0, "far_terms": 2, "t_final": 0.3}
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        run = solve_problem(Problem(**fields, **d, **a, **f), bell)
    exact = circle(alpha, bell, 0.3, d["diffusivity"], a["velocity"], f["source"])(run.x.values)
    assert error_of(run, exact) < 2.0 * float(run.space_error) + IN_TIME


def test_a_barrier_between_the_particles_warns():
    """A fifth of the spacing wide, with a tenth of D: u is off by a fifth of its greatest value."""

    def d(x, t=0.0):
        return 1.0 - 0.9 * np.exp(-(((x - 0.33) / 0.02) ** 2))

    fields = {"alpha": 1.1, "half_width": 15.0, "spacing": 0.1, "t_final": 0.2, "diffusivity": d}
    with pytest.warns(AccuracyWarning, match="coefficient differs between the particles"):
        solve_problem(Problem(**fields), bell)


@pytest.mark.usefixtures("short_circle")
@pytest.mark.parametrize("alpha", [1.1, 1.6])
def test_the_exchange_across_a_layer_that_two_particles_span(alpha):
    """e = 0.11: what a flux would have to warn of leaves an error of a fifth of one per cent here."""

    def d(x, t=0.0):
        return 1.0 + 0.8 * np.tanh((x - 0.33) / 0.2)

    fields = {"alpha": alpha, "half_width": 15.0, "spacing": 0.1, "t_final": 0.2}
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        run = solve_problem(Problem(**fields, diffusivity=d, form="exchange"), bell)
    exact = circle(alpha, bell, 0.2, d, lambda x, t: 0.0 * x, lambda x, t, u: 0.0 * x, pairs=True)
    assert error_of(run, exact(run.x.values)) < 2.0 * float(run.space_error)


@pytest.mark.parametrize(("rate", "alpha"), covering([1.0, 10.0], [1.4, 1.8]))
def test_the_interval(alpha, rate):
    def d(x, t):
        return 1.0 + 0.5 * x * np.cos(5.0 * t)

    def a(x, t):
        return 2.0 + np.sin(3.0 * x)

    def f(x, t, u):
        return rate * u * (1.0 - u)

    initial = partial(bell, width=0.4, at=0.2)
    fields = {"alpha": alpha, "half_width": 1.0, "exterior": "absorbing", "t_final": 0.2}
    fields["particles"] = 32
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        run = solve_problem(Problem(**fields, diffusivity=d, velocity=a, source=f), initial)
    exact = Jacobi(alpha, d, a, count=30).solve(initial, 0.2, f)(run.x.values)
    # By int |error|: beside the end that u is carried to polynomials have a greater one than particles.
    off, size = (float((run.volume * np.abs(u)).sum()) for u in (run.u - exact, exact))
    assert off < (2.0 * float(run.space_error) + IN_TIME) * size


MOTIONS = {
    "turned": lambda x, y: (-20.0 * y, 20.0 * x),
    "carried to the edge": lambda x, y: (5.0 + 0.0 * x, -2.0 * x),
}


@pytest.mark.parametrize(("motion", "alpha"), covering(MOTIONS, [1.5, 1.8]))
def test_the_disc(motion, alpha):
    """Turned by a radian, or carried by half the radius."""
    velocity = MOTIONS[motion]
    a = (lambda x, y: velocity(x, y)[0], lambda x, y: velocity(x, y)[1])
    initial = partial(bell, width=0.5, at=0.2)
    fields = {"alpha": alpha, "half_width": 1.0, "exterior": "absorbing", "domain": "disc"}
    problem = Problem(
        **fields, t_final=0.05, particles=24, velocity=a, source=lambda x, y, t, u: -u * u
    )
    run = solve_problem(problem, initial)
    exact = Zernike(alpha, velocity).solve(initial, 0.05, lambda x, y, t, u: -u * u)
    off = error_of(run, exact(run.x.values, run.y.values))
    assert off < 2.0 * float(run.space_error) + 10.0 * IN_TIME


def test_a_disc_where_u_is_carried_faster_than_it_spreads():
    """By int |error|, as on the interval: 20 polynomials of a wave leave a half of what 16 do, 1.2 per cent of it."""

    def velocity(x, y):
        return 5.0 + 0.0 * x, -2.0 * x

    a = (lambda x, y: velocity(x, y)[0], lambda x, y: velocity(x, y)[1])
    initial = partial(bell, width=0.5, at=0.2)
    fields = {"alpha": 1.2, "half_width": 1.0, "exterior": "absorbing", "domain": "disc"}
    run = solve_problem(Problem(**fields, t_final=0.05, particles=24, velocity=a), initial)
    exact = Zernike(1.2, velocity, radial=20, turns=12)
    exact = exact.solve(initial, 0.05, None)(run.x.values, run.y.values)
    off, size = (float((run.volume * np.abs(u)).sum()) for u in (run.u - exact, exact))
    assert off < (float(run.space_error) + 10.0 * IN_TIME) * size < 0.03 * size
