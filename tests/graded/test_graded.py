"""One Green step on graded particles."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import fracparticles as fp
from fracparticles.errors import AccuracyWarning, InvalidInput, StabilityWarning
from fracparticles.graded.particles import graded_particles, green_step
from fracparticles.run.solver import prepare
from fracstudy.race.problems.fundamental import Fundamental


def error(beta, count, reach, scale, form):
    problem = Fundamental(beta)
    x, volumes = graded_particles(count, reach, scale)
    u = green_step(x, volumes, problem.alpha, problem.time, form) @ problem.initial((x,))
    return problem.error((x,), volumes, u)


def test_particles_are_symmetric_and_their_volumes_fill_the_line():
    x, volumes = graded_particles(101, 50.0, 2.0)
    assert x[50] == 0.0
    assert np.array_equal(x, -x[::-1])
    assert x[-1] == pytest.approx(50.0, rel=1e-14)
    # The trapezoidal rule for the length: half a volume too much at each end, and ds^2 / 12 of the slope there.
    ds = volumes[50] / 2.0
    length = volumes.sum() - 0.5 * (volumes[0] + volumes[-1])
    assert length == pytest.approx(100.0, abs=1.1 * ds**2 / 12.0 * 2.0 * 50.0)


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("form", ["exchange", "quadrature"])
def test_a_matrix_of_unequal_volumes_is_the_sum_over_pairs(alpha, form):
    rng = np.random.default_rng(3)
    x, volumes, u = np.sort(rng.normal(size=12)), rng.uniform(0.1, 0.5, 12), rng.normal(size=12)
    expected = np.empty(12)
    for i in range(12):
        kernel = [fp.green(x[i] - x[j], 0.7, alpha) for j in range(12)]
        if form == "exchange":
            terms = [volumes[j] * (u[j] - u[i]) * kernel[j] for j in range(12)]
            expected[i] = u[i] + sum(terms)
        else:
            expected[i] = sum(volumes[j] * u[j] * kernel[j] for j in range(12))
    ours = green_step(x, volumes, alpha, 0.7, form) @ u
    assert ours == pytest.approx(expected, rel=1e-13, abs=1e-13)


def test_on_a_lattice_the_exchange_is_gpse():
    case = fp.Case(scheme="GPSE", beta=0.5, half_width=8.0, spacing=0.4, dt=1.0)
    u0 = np.random.default_rng(4).normal(size=case.shape)
    matrix = green_step(case.x, np.full(case.shape, case.particle_spacing), 1.5, 1.0)
    assert matrix @ u0 == pytest.approx(prepare(case).solve(u0), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_the_exchange_conserves_and_keeps_constants(alpha):
    x, volumes = graded_particles(61, 1000.0, 1.0)
    matrix = green_step(x, volumes, alpha, 1.0)
    assert matrix @ np.ones(61) == pytest.approx(1.0, abs=1e-13)
    # The total is sum V u: the largest volume is some hundred, its roundings count.
    assert volumes @ matrix == pytest.approx(volumes, rel=1e-12)


@pytest.mark.parametrize(("alpha", "reach", "time"), [
    (1.1, 1e17, 1.0), (1.1, 1e8, 1.0), (1.5, 1e30, 1.0), (1.9, 1e4, 1e-30), (1.01, 1e100, 1e-8),
])  # fmt: skip
def test_a_particle_far_wider_than_the_kernel_keeps_what_its_neighbours_leave(alpha, reach, time):
    """The diagonal is 1 less the others' weights: there V E(0) is up to 1e108, and would leave nothing of the 1."""
    x, volumes = graded_particles(201, reach, 1.0)
    matrix = green_step(x, volumes, alpha, time)
    for i in (0, 1, 150, 200):
        others = [volumes[j] * fp.green(x[i] - x[j], time, alpha) for j in range(201) if j != i]
        assert matrix[i, i] == pytest.approx(1.0 - sum(others), rel=1e-14)
    assert matrix[0, 0] > 0.9


@given(
    alpha=st.floats(1.0001, 1.9999),
    reach=st.floats(-3.0, 60.0),
    time=st.floats(-60.0, 60.0),
    half=st.integers(1, 40),
)
def test_every_column_keeps_its_strength(alpha, reach, time, half):
    """sum_i V_i M_ij = V_j: off the diagonal V_i V_j E is symmetric, so that only the sums of N terms round."""
    x, volumes = graded_particles(2 * half + 1, 10.0**reach, 1.0)
    matrix = green_step(x, volumes, alpha, 10.0**time)
    size = volumes @ np.abs(matrix)
    room = 2.0 * x.size * np.finfo(float).eps
    assert (np.abs(volumes @ matrix - volumes) <= room * (size + volumes)).all()
    assert np.abs(matrix.sum(axis=1) - 1.0).max() <= room * np.abs(matrix).sum(axis=1).max()


def test_where_reach_is_far_below_scale_the_particles_are_a_lattice():
    for reach, scale in ((1e-9, 1.0), (1e-100, 1e100), (3.0, 1e30)):
        x, volumes = graded_particles(11, reach, scale)
        assert x == pytest.approx(reach * np.linspace(-1.0, 1.0, 11), rel=1e-14)
        assert volumes == pytest.approx(np.full(11, 0.2 * reach), rel=1e-14)


@pytest.mark.parametrize(("beta", "reach", "counts"), [
    (0.5, 1000.0, (65, 81, 101)),
    (0.9, 200.0, (41, 51, 65)),
])  # fmt: skip
def test_the_quadrature_converges_faster_than_any_power(beta, reach, counts):
    """The order between two numbers of particles is above eight, and rises."""
    errors = [error(beta, count, reach, 5.0, "quadrature") for count in counts]
    orders = np.log(np.divide(errors[:-1], errors[1:])) / np.log(np.divide(counts[1:], counts[:-1]))
    assert (orders > 8.0).all()
    assert orders[1] > orders[0]


def test_where_the_volumes_are_wide_the_exchange_is_right_to_leading_order():
    """beta = 0.1: forty particles reach to 1000; by quadrature the far ones are lost."""
    assert error(0.1, 41, 1000.0, 1.0, "exchange") < 1e-3
    assert error(0.1, 41, 1000.0, 1.0, "quadrature") > 1e-2


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: graded_particles(10, 5.0, 1.0), "count"),
        (lambda: graded_particles(1, 5.0, 1.0), "count"),
        (lambda: graded_particles(11, -5.0, 1.0), "reach"),
        (lambda: graded_particles(11, 1e300, 1.0), "reach"),
        (lambda: graded_particles(11, 5.0, 0.0), "scale"),
        (lambda: graded_particles(11, 5.0, 1e-300), "scale"),
        (lambda: green_step(np.zeros(0), np.ones(0), 1.5, 1.0), "volumes"),
        (lambda: green_step(np.zeros(3), np.array([1.0, np.inf, 1.0]), 1.5, 1.0), "volumes"),
        (lambda: green_step(np.zeros(10003), np.ones(10003), 1.5, 1.0), "x"),
        (lambda: green_step(np.zeros(3), np.ones(2), 1.5, 1.0), "volumes"),
        (lambda: green_step(np.zeros(3), np.array([1.0, 0.0, 1.0]), 1.5, 1.0), "volumes"),
        (lambda: green_step(np.array([0.0, np.inf]), np.ones(2), 1.5, 1.0), "x"),
        (lambda: green_step(np.zeros(3), np.ones(3), 2.5, 1.0), "alpha"),
        (lambda: green_step(np.zeros(3), np.ones(3), 1.5, 0.0), "time"),
        (lambda: green_step(np.zeros(3), np.ones(3), 1.5, 1.0, "other"), "form"),
    ],
)
def test_bad_input_is_refused(call, field):
    with pytest.raises(InvalidInput, match=f"^{field} = "):
        call()


# --- particles whose volumes do not belong to them ------------------------------------------------


def crowd(kind, n):
    random = np.random.default_rng(5)
    if kind == "one place":
        return np.zeros(n), np.full(n, 0.1)
    return np.sort(0.02 * n / 10.0 * random.normal(size=n)), np.full(n, 0.05)


@pytest.mark.parametrize(("kind", "n"), [("one place", 40), ("cluster", 60), ("cluster", 200)])
def test_an_exchange_that_amplifies_is_warned_of(kind, n):
    x, volumes = crowd(kind, n)
    with pytest.warns(StabilityWarning, match="amplifies, by the factor") as caught:
        matrix = green_step(x, volumes, 1.5, 0.02)
    greatest = np.abs(np.linalg.eigvals(matrix)).max()
    said = float(str(caught[0].message).split("factor ")[1].split()[0])
    assert 1.0 < said <= greatest * 1.001
    assert np.abs(volumes @ matrix - volumes).max() < 1e-12 * np.abs(matrix).max()


def test_just_unstable_particles_are_told_from_stable_ones():
    """Two particles of weight w each: the eigenvalues are 1 and 1 - 2 w."""
    peak = float(fp.green(0.0, 1.0, 1.5))
    for w, grows in ((0.999, False), (1.001, True)):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            matrix = green_step(np.zeros(2), np.full(2, w / peak), 1.5, 1.0)
        assert np.linalg.eigvals(matrix).min() == pytest.approx(1.0 - 2.0 * w)
        assert bool(caught) is grows


def test_graded_particles_do_not_amplify(recwarn):
    green_step(*graded_particles(101, 100.0, 0.5), 1.2, 0.5)
    assert not recwarn.list


def test_a_quadrature_that_makes_more_of_a_constant_is_warned_of():
    with pytest.warns(AccuracyWarning, match=r"makes 2\.83e\+03 of a constant"):
        green_step(*graded_particles(41, 1e4, 0.5), 1.2, 0.5, "quadrature")
