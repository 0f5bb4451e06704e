"""One Green step of the field between graded particles."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import fracparticles as fp
from fracparticles.benchmarks.problem import Problem
from fracparticles.errors import InvalidInput
from fracparticles.graded import graded_particles, green_step
from fracparticles.graded_field import _against_sincs, _panels, green_step_of_field


def error(beta, count, reach, scale):
    problem = Problem(beta)
    x, volumes = graded_particles(count, reach, scale)
    matrix = green_step_of_field(count, reach, scale, problem.alpha, problem.time)
    return problem.error(np.abs(x), volumes, matrix @ problem.initial(np.abs(x)))


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize(("count", "reach", "scale", "time"), [
    (7, 5.0, 1.0, 0.7),
    (21, 40.0, 0.5, 1.0),
    (9, 30.0, 5.0, 0.01),
])  # fmt: skip
def test_an_entry_is_the_integral_of_kernel_and_sinc(alpha, count, reach, scale, time):
    x, volumes = graded_particles(count, reach, scale)
    ds = volumes[count // 2] / scale
    matrix = green_step_of_field(count, reach, scale, alpha, time)
    epsilon = time ** (1.0 / alpha)
    for i, j in ((0, 0), (0, 3), (2, 4), (count // 2, count // 2), (count - 1, 1)):

        def integrand(y, i=i, j=j):
            place = np.arcsinh(y / scale) / ds - (j - count // 2)
            return float(fp.green(x[i] - y, time, alpha)) * np.sinc(place)

        # Adaptive quadrature between every sign change of the sinc, and close to the kernel.
        ends = np.unique(np.clip([*x, *(x[i] + epsilon * np.linspace(-8, 8, 17))], -reach, reach))
        parts = [quad(integrand, a, b, epsabs=1e-14)[0] for a, b in pairwise(ends)]
        # x - y rounds by ulps of the reach, against the width of the kernel.
        room = 1e-14 + 4.0 * np.finfo(float).eps * reach / epsilon
        assert matrix[i, j] == pytest.approx(sum(parts), abs=room)


def test_more_nodes_change_nothing(monkeypatch):
    """Fine particles, whose sincs oscillate within a panel."""
    settings = 161, 2000.0, 0.5, 1.1, 1.0
    matrix = green_step_of_field(*settings)
    monkeypatch.setattr("fracparticles.graded_field._NODES", 40)
    room = 4.0 * np.finfo(float).eps * 2000.0
    assert np.abs(matrix - green_step_of_field(*settings)).max() < room


def test_panels_double_away_from_the_particle_and_from_the_middle():
    ends = _panels(3.0, 0.5, 1.0, 10.0)
    assert ends[0] == -10.0
    assert ends[-1] == 10.0
    assert {0.0, 1.0, -1.0, 2.0, 3.0, 3.5, 2.5, 4.0, 5.0, 7.0}.issubset(ends)
    assert (np.diff(ends) > 0.0).all()
    near = np.diff(ends) <= np.maximum(0.5, np.minimum(np.abs(ends[1:] - 3.0), np.abs(ends[:-1] - 3.0)))  # fmt: skip
    assert near.all()


def test_sincs_are_those_of_numpy_and_one_at_their_own_particle():
    t = np.array([-2.0, 0.0, 1.0, 0.3, -1.7, 5.25])
    for value in np.eye(t.size):
        expected = value @ np.sinc(t[:, None] - np.arange(-2, 3))
        assert _against_sincs(value, t, 2) == pytest.approx(expected, abs=1e-15)


def test_the_matrix_is_symmetric_about_the_middle():
    matrix = green_step_of_field(21, 100.0, 1.0, 1.3, 1.0)
    assert matrix == pytest.approx(matrix[::-1, ::-1], abs=1e-15)


def test_two_steps_are_one_of_twice_the_time():
    """Up to the solution at the outermost particle: what comes from beyond is missing."""
    x, _ = graded_particles(113, 5000.0, 0.5)
    u0 = fp.green(x, 0.5, 1.1)
    half, whole = (green_step_of_field(113, 5000.0, 0.5, 1.1, time) for time in (0.5, 1.0))
    assert half @ (half @ u0) == pytest.approx(whole @ u0, abs=fp.green(x[0], 1.5, 1.1))


@pytest.mark.parametrize(("beta", "scale"), [(0.1, 0.5), (0.5, 1.5)])
def test_the_error_falls_exponentially(beta, scale):
    """The order between two numbers of particles is above eight, and rises, for volumes up to a thousand epsilon."""
    counts = 41, 57, 81
    errors = [error(beta, count, 20000.0, scale) for count in counts]
    orders = np.log(np.divide(errors[:-1], errors[1:])) / np.log(np.divide(counts[1:], counts[:-1]))
    assert (orders > 8.0).all()
    assert orders[1] > orders[0]


def test_where_the_sums_have_lost_it_the_field_has_ten_digits():
    problem = Problem(0.1)
    x, volumes = graded_particles(113, 5000.0, 0.5)
    sums = green_step(x, volumes, problem.alpha, 1.0, "quadrature") @ problem.initial(np.abs(x))
    assert problem.error(np.abs(x), volumes, sums) > 1e-3
    assert error(0.1, 113, 5000.0, 0.5) < 1e-10


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: green_step_of_field(10, 5.0, 1.0, 1.5, 1.0), "count"),
        (lambda: green_step_of_field(11, -5.0, 1.0, 1.5, 1.0), "reach"),
        (lambda: green_step_of_field(11, 5.0, 0.0, 1.5, 1.0), "scale"),
        (lambda: green_step_of_field(11, 5.0, 1.0, 2.5, 1.0), "alpha"),
        (lambda: green_step_of_field(11, 5.0, 1.0, 1.5, 0.0), "time"),
    ],
)
def test_bad_input_is_refused(call, field):
    with pytest.raises(InvalidInput, match=f"^{field} = "):
        call()
