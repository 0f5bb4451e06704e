"""One Green step of the field between graded particles."""

from __future__ import annotations

from itertools import pairwise
from math import fsum

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

import fracparticles as fp
from fracparticles.errors import InvalidInput
from fracparticles.graded.field import (
    _against_sincs,
    _mapped_distance,
    _panels_around,
    _panels_around_zero,
    green_step_of_field,
)
from fracparticles.graded.particles import graded_particles, green_step
from fracstudy.race.problems.fundamental import Fundamental
from sweeps import covering, few


def error(beta, count, reach, scale):
    problem = Fundamental(beta)
    x, volumes = graded_particles(count, reach, scale)
    matrix = green_step_of_field(count, reach, scale, problem.alpha, problem.time)
    return problem.error((x,), volumes, matrix @ problem.initial((x,)))


@pytest.mark.parametrize(
    ("alpha", "lattice"),
    covering([1.1, 1.5, 1.9], [(7, 5.0, 1.0, 0.7), (21, 40.0, 0.5, 1.0), (9, 30.0, 5.0, 0.01)]),
)
def test_an_entry_is_the_integral_of_kernel_and_sinc(alpha, lattice):
    count, reach, scale, time = lattice
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
    monkeypatch.setattr("fracparticles.graded.field._NODES", 40)
    room = 4.0 * np.finfo(float).eps * 2000.0
    assert np.abs(matrix - green_step_of_field(*settings)).max() < room


@pytest.mark.parametrize("x", [0.0, -1e-30, -3.0, -10.0])
@pytest.mark.parametrize(
    ("scale", "epsilon"), [(1.0, 0.5), (1.0, 1e-300), (1e-90, 1.0), (1e3, 1e3)]
)
def test_panels_fill_the_line_and_none_is_longer_than_its_distance(x, scale, epsilon):
    """Its distance from x or epsilon, and from zero or the scale."""
    down, up = _panels_around(x, 10.0, scale, epsilon)
    left, right = _panels_around_zero(x, 10.0, scale, epsilon)
    assert (down[-1], up[-1], left[-1], right[-1]) == (10.0 + x, -0.5 * x, -0.5 * x, 10.0)
    for sign, ends, anchor in ((-1, down, x), (1, up, x), (-1, left, 0.0), (1, right, 0.0)):
        assert ends[0] == 0.0
        lengths = np.diff(ends)
        assert (lengths > 0.0).all()
        for point, size in ((x, epsilon), (0.0, scale)):
            # As distances from the anchor, exact also where the panels are far below an ulp of it.
            starts, ends_at = (
                sign * ends[:-1] + (anchor - point),
                sign * ends[1:] + (anchor - point),
            )
            room = np.minimum(np.abs(starts), np.abs(ends_at))
            # At most a third more than the distance, where two of a doubling set would not fit.
            assert (lengths <= 4.0 / 3.0 * np.maximum(size, room)).all()


@given(
    exponent=st.floats(-100.0, 100.0), part=st.floats(-300.0, 300.0), side=st.sampled_from([-1, 1])
)
def test_the_mapped_distance_is_that_of_many_digits(exponent, part, side):
    b, ratio = -(10.0**exponent), 10.0**part
    difference = side * abs(b) * (min(ratio, 0.5) if side > 0 else min(ratio, 1e100 / abs(b)))
    ours = _mapped_distance(np.array([difference]), b)[0]
    with mp.workdps(700):
        exact = mp.asinh(mp.mpf(b) + mp.mpf(difference)) - mp.asinh(mp.mpf(b))
        # Each of some ten roundings counts once: the map has no condition number above 2.
        assert ours == pytest.approx(float(exact), rel=2e-15, abs=1e-307)


def reference(count, reach, scale, alpha, time, i, columns):
    """Entries of a row by panels that double away from x_i, mapped with 60 digits; the kernel alone is ours.

    The 16 nodes of a panel leave (3 + 8^(1/2))^-32 = 3e-25: it is as far from x_i, or from i times the scale, as long.
    """
    x, volumes = graded_particles(count, reach, scale)
    ds = volumes[count // 2] / scale
    epsilon = time ** (1.0 / alpha)
    # Close to zero on the scale's length, too: as distances from x_i these are exact enough for x_i = O(scale).
    ends = epsilon * 2.0 ** np.arange(-1.0, np.log2(2.0 * reach / epsilon))
    ends = np.concatenate(
        [-ends[::-1], [0.0], ends, scale * np.linspace(-8, 8, 33) - x[i], -x[i] + x]
    )
    ends = np.unique(np.clip(ends, x[0] - x[i], x[-1] - x[i]))
    nodes, weights = np.polynomial.legendre.leggauss(16)
    halves = 0.5 * np.diff(ends)
    d = ((0.5 * (ends[1:] + ends[:-1]))[:, None] + halves[:, None] * nodes).ravel()
    kernel = fp.green(d, time, alpha) * np.outer(halves, weights).ravel()
    with mp.workdps(60):
        start = mp.asinh(mp.mpf(x[i]) / mp.mpf(scale))
        places = [
            (mp.asinh((mp.mpf(x[i]) + mp.mpf(at)) / mp.mpf(scale)) - start) / mp.mpf(ds) + i
            for at in d
        ]
        from_columns = [np.array([float(place - j) for place in places]) for j in columns]
    return [fsum(kernel * np.sinc(place)) for place in from_columns]


@pytest.mark.parametrize(("reach", "scale", "alpha", "time"), few([
    (1e4, 1.0, 1.5, 1e-21),
    (1e4, 1.0, 1.5, 1e-18),
    (5.0, 2.0, 1.9, 1e-40),
    (30.0, 1.0, 1.1, 1e-30),
    (1e4, 1.0, 1.5, 1e-6),
    (3e4, 1e3, 1.9, 30.0),  # wider than one, and narrower than its panels are long if not told
]))  # fmt: skip
def test_a_kernel_narrower_than_an_ulp_of_its_place_is_resolved(reach, scale, alpha, time):
    count = 21
    matrix = green_step_of_field(count, reach, scale, alpha, time)
    for i, *columns in ((0, 0), (1, 1, 2), (7, 7), (10, 10, 9), (9, 12)):
        # Both are sums of a kernel of weight one, known to 1e-13 each.
        exact = reference(count, reach, scale, alpha, time, i, columns)
        assert matrix[i, columns] == pytest.approx(exact, abs=2e-13)


@pytest.mark.parametrize("time", [1e-30, 1e-60, 1e-300])
def test_as_time_goes_to_zero_the_step_is_the_identity(time):
    """Less than the mass beyond a volume moves; the outermost keep the half that lies inside."""
    matrix = green_step_of_field(41, 1e4, 1.0, 1.5, time)
    identity = np.eye(41)
    identity[0, 0] = identity[-1, -1] = 0.5
    assert np.abs(matrix - identity).max() < 1e-13


@pytest.mark.parametrize(("count", "reach", "scale", "time"), [
    (9, 1e-9, 1.0, 1e-14),
    (9, 1e-3, 1e20, 1e-4),
    (41, 2.0, 1e100, 1.0),
    (201, 1e-3, 1.0, 1.0),
])  # fmt: skip
def test_reach_far_below_scale_is_an_evenly_spaced_lattice(count, reach, scale, time):
    """Against sinc functions of y / h on that lattice, by Gauss's rule with nodes enough for all."""
    matrix = green_step_of_field(count, reach, scale, 1.5, time)
    h = 2.0 * reach / (count - 1)
    epsilon = time ** (1.0 / 1.5)
    nodes, weights = np.polynomial.legendre.leggauss(40 + count)
    j = np.arange(count) - count // 2
    for i in (0, count // 3, count // 2):
        x = j[i] * h
        ends = np.unique(np.clip(
            [-reach, *(x + epsilon * np.linspace(-60.0, 60.0, 241)), reach], -reach, reach
        ))  # fmt: skip
        halves = 0.5 * np.diff(ends)
        y = ((0.5 * (ends[1:] + ends[:-1]))[:, None] + halves[:, None] * nodes).ravel()
        kernel = fp.green(y - x, time, 1.5) * np.outer(halves, weights).ravel()
        # The field's second order in reach / scale is what the lattice leaves out.
        room = 1e-12 + (reach / scale) ** 2
        assert matrix[i] == pytest.approx(kernel @ np.sinc(y[:, None] / h - j), abs=room)


def test_sincs_are_those_of_numpy_and_one_at_their_own_particle():
    t = np.array([-2.0, 0.0, 1.0, 0.3, -1.7, 5.25])
    for value in np.eye(t.size):
        expected = value @ np.sinc(t[:, None] - np.arange(-2, 3))
        assert _against_sincs(value, t, np.arange(-2, 3)) == pytest.approx(expected, abs=1e-15)


@given(
    unit=st.integers(-60, 60),
    alpha=st.floats(1.05, 1.95),
    reach=st.floats(-2.0, 6.0),
    time=st.floats(-25.0, 3.0),
)
def test_another_unit_of_length_changes_nothing(unit, alpha, reach, time):
    unit, reach, time = 2.0**unit, 10.0**reach, 10.0**time
    one = green_step_of_field(11, reach, 1.0, alpha, time)
    other = green_step_of_field(11, reach * unit, unit, alpha, time * unit**alpha)
    # unit^alpha rounds its exponent: epsilon by 60 log(2) ulp, which moves no entry by more than that.
    assert other == pytest.approx(one, abs=2e-13)


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
    problem = Fundamental(0.1)
    x, volumes = graded_particles(113, 5000.0, 0.5)
    sums = green_step(x, volumes, problem.alpha, 1.0, "quadrature") @ problem.initial((x,))
    assert problem.error((x,), volumes, sums) > 1e-3
    assert error(0.1, 113, 5000.0, 0.5) < 1e-10


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: green_step_of_field(10, 5.0, 1.0, 1.5, 1.0), "count"),
        (lambda: green_step_of_field(11, -5.0, 1.0, 1.5, 1.0), "reach"),
        (lambda: green_step_of_field(10003, 5.0, 1.0, 1.5, 1.0), "count"),
        (lambda: green_step_of_field(11, 5.0, 0.0, 1.5, 1.0), "scale"),
        (lambda: green_step_of_field(11, 5.0, 1.0, 2.5, 1.0), "alpha"),
        (lambda: green_step_of_field(11, 5.0, 1.0, 1.5, 0.0), "time"),
    ],
)
def test_bad_input_is_refused(call, field):
    with pytest.raises(InvalidInput, match=f"^{field} = "):
        call()
