"""A pulse that multiplies u, where u = 0 at first and the source is not valid for the u that a guess of it says."""

from __future__ import annotations

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.time.sudden import changes_of_what_comes

AT, WIDTH, RATE, LARGEST = 0.31, 4e-5, 3e4, 0.3
BEYOND = {"raises": lambda: 1 / 0, "is no number": lambda: np.nan}


def source_that(beyond):
    """0.4 exp(-x^2) until t = 0.1, and a pulse: u would be 0.4 if the first went on, and is 0.05 at most."""

    def source(x, t, u):
        wrong = BEYOND[beyond]() if np.any(u > LARGEST) else 0.0
        pulse = np.abs(t - AT) < 0.5 * WIDTH
        return np.exp(-x * x) * np.where(pulse, RATE * u, 0.4 * (t < 0.1)) + wrong

    return source


def on_an_interval(u0, time, source):
    return fp.Interval(1.5, 41, "absorbing").react(u0, time=time, source=source)


def on_the_line(u0, time, source):
    problem = fp.Problem(alpha=1.5, half_width=20.0, spacing=0.25, t_final=time, source=source)
    return fp.solve_problem(problem, u0).u.values


@pytest.mark.filterwarnings("ignore::fracparticles.AccuracyWarning")
@pytest.mark.parametrize("beyond", BEYOND)
@pytest.mark.parametrize(
    ("solve", "x"),
    [(on_an_interval, fp.Interval(1.5, 41, "absorbing").x), (on_the_line, np.arange(-80, 81) / 4)],
    ids=["interval", "line"],
)
def test_the_pulse_is_found(solve, x, beyond):
    u = solve(np.zeros(x.size), 1.0, source_that(beyond))
    before = solve(np.zeros(x.size), AT - WIDTH, source_that(beyond))
    after = before * np.exp(RATE * WIDTH * np.exp(-x * x))
    # The pulse alone. What spreads meanwhile is a share WIDTH k^1.5 of a wave: 1e-3 of k = 9, and u is of longer ones.
    expected = solve(after, 1.0 - AT, lambda x, t: 0.0 * x)
    np.testing.assert_allclose(u, expected, atol=2e-3 * expected.max())


def test_a_smaller_u_is_tried_where_the_source_is_not_valid():
    asked = []

    def changes(u):
        asked.append(u.max())
        return [0.5]

    def rate(t, u):
        return np.array([5.0]) if u.max() <= 1.0 else np.array([np.inf])

    assert changes_of_what_comes(changes, rate, np.zeros(1), 0.0, 1.0) == {0.5}
    assert asked == [0.5]  # 5 is the guess
    assert (
        changes_of_what_comes(changes, rate, np.full(1, 0.6), 0.0, 1.0) == set()
    )  # 0.65: no other u
