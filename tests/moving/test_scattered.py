"""Sums over scattered particles against the definition, term by term."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import kernel
from fracparticles.moving.scattered import (
    NaiveScatteredSum,
    NeighbourSum,
    NonuniformFourierSum,
    ScatteredKernel,
    scattered_sum,
    smooth_kernel,
)
from sweeps import covering

EPSILON = 0.3
# Asked for: 1e-9 of the maximum. The transforms are made with 1e-12; the kernels cancel a little.
CLOSE = NonuniformFourierSum.accuracy * 10.0


def pair(alpha=1.5, order=2):
    return [smooth_kernel(name, alpha, order) for name in ("eta", "F")]


def scattered(n, seed=0, half_width=20.0):
    generator = np.random.default_rng(seed)
    return generator.uniform(-half_width, half_width, n), generator.standard_normal(n)


def closeness(fast, exact):
    return (np.abs(fast - exact).max(axis=1) / np.abs(exact).max(axis=1)).max()


@pytest.mark.parametrize("order", [2, 4])
def test_the_naive_sum_is_its_definition(order):
    x, q = scattered(40)
    z = np.linspace(-25.0, 25.0, 7)
    y = NaiveScatteredSum(pair(1.3, order), EPSILON)(x, q, z)
    for row, name in zip(y, ("eta", "F"), strict=True):
        expected = [
            sum(
                qj * kernel(name, (zi - xj) / EPSILON, 1.3, order=order) / EPSILON
                for xj, qj in zip(x, q, strict=True)
            )
            for zi in z
        ]
        assert row == pytest.approx(expected, rel=1e-13, abs=1e-13)


@pytest.mark.parametrize(("alpha", "order"), covering([1.05, 1.5, 1.95], [2, 4]))
def test_the_transform_is_the_naive_sum(alpha, order):
    x, q = scattered(1500)
    z = np.linspace(-45.0, 30.0, 101)
    fast = scattered_sum("fft", pair(alpha, order), EPSILON)
    slow = scattered_sum("naive", pair(alpha, order), EPSILON)
    assert closeness(fast(x, q), slow(x, q)) < CLOSE
    assert closeness(fast(x, q, z), slow(x, q, z)) < CLOSE


@pytest.mark.parametrize(
    ("name", "order"),
    [*((name, 4) for name in ("eta1", "Phi", "G", "K", "kappa")), ("G", 12), ("eta", 12)],
)
def test_other_kernels_by_the_transform(name, order):
    x, q = scattered(300)
    kernels = [smooth_kernel(name, 1.5, order)]
    exact = NaiveScatteredSum(kernels, EPSILON)(x, q)
    assert closeness(NonuniformFourierSum(kernels, EPSILON)(x, q), exact) < CLOSE


def test_three_kernels_at_once():
    x, q = scattered(300)
    kernels = [*pair(), smooth_kernel("K", 1.5)]
    exact = NaiveScatteredSum(kernels, EPSILON)(x, q)
    assert closeness(NonuniformFourierSum(kernels, EPSILON)(x, q), exact) < CLOSE


@given(
    n=st.integers(1, 12),
    seed=st.integers(0, 2**32 - 1),
    scale=st.sampled_from([0.0, 1e-3, 1.0, 1e3]),
    shift=st.sampled_from([0.0, -1e4, 1e5]),
)
def test_few_particles_also_coincident_or_far_from_the_origin(n, seed, scale, shift):
    generator = np.random.default_rng(seed)
    x, q = shift + scale * generator.standard_normal(n), generator.uniform(0.5, 1.0, n)
    fast, slow = scattered_sum("fft", pair(), EPSILON), scattered_sum("naive", pair(), EPSILON)
    # u is at least one particle's own 0.28 q / epsilon; F is odd and may cancel: relative to the larger of the two.
    exact = slow(x, q)
    # Angles lose the digits that x / epsilon has before the point.
    lost = np.finfo(float).eps * (abs(shift) + 10.0 * scale) / EPSILON * n
    assert np.abs(fast(x, q) - exact).max() <= (CLOSE + lost) * np.abs(exact).max()


def test_the_box_grows_with_the_set():
    sums, exact = NonuniformFourierSum(pair(), EPSILON), NaiveScatteredSum(pair(), EPSILON)
    x, q = scattered(100)
    for stretch in (1.0, 1.05, 3.0, 0.2):
        assert closeness(sums(stretch * x, q), exact(stretch * x, q)) < CLOSE


def test_neighbours_keep_relative_accuracy_where_the_sum_is_small():
    x = np.arange(-200, 201) * 0.1
    q = np.exp(-x * x)
    kernels = [smooth_kernel("eta", 1.5), smooth_kernel("eta1", 1.5)]
    near = scattered_sum("fft", kernels, 0.2)
    assert isinstance(near, NeighbourSum)
    z = np.linspace(-19.0, 19.0, 77)
    fast, exact = near(x, q, z), NaiveScatteredSum(kernels, 0.2)(x, q, z)
    # At |x| = 19 the sum is 1e-150. What the reach leaves out is 4e-19 of a strength, but the strengths fall
    # by exp(2 x reach) over it: test where that is below the round-off.
    assert np.abs(fast[0] / exact[0] - 1.0)[np.abs(z) < 2.0].max() < 1e-13
    assert np.abs(fast[0]).min() > 0.0
    assert np.abs(fast - exact).max() < 1e-15


@given(n=st.integers(0, 30), seed=st.integers(0, 99))
def test_neighbours_in_any_order(n, seed):
    x, q = scattered(n, seed, half_width=2.0)
    hat = [ScatteredKernel(lambda r: np.maximum(0.0, 1.0 - np.abs(r)), reach=1.0)]
    near, exact = NeighbourSum(hat, EPSILON), NaiveScatteredSum(hat, EPSILON)
    z = np.linspace(-3.0, 3.0, 17)
    assert near(x, q) == pytest.approx(exact(x, q), rel=1e-13, abs=1e-13)
    assert near(x, q, z) == pytest.approx(exact(x, q, z), rel=1e-13, abs=1e-13)


@pytest.mark.parametrize("summation", ["fft", "naive"])
@pytest.mark.parametrize("exponent", [-1000, -600, 600, 1000])
def test_sums_of_strengths_of_any_size(summation, exponent):
    """Times a power of 2 they are the same, to the last bit."""
    rng = np.random.default_rng(5)
    x, q = rng.normal(size=100), rng.uniform(0.5, 1.0, 100)
    sums = scattered_sum(summation, pair(), EPSILON)
    assert np.array_equal(np.ldexp(sums(x, np.ldexp(q, exponent)), -exponent), sums(x, q))


@pytest.mark.parametrize("summation", ["fft", "naive"])
def test_nothing_gives_nothing(summation):
    sums = scattered_sum(summation, pair(), EPSILON)
    nothing = np.empty(0)
    assert sums(nothing, nothing).shape == (2, 0)
    assert (sums(nothing, nothing, np.zeros(3)) == 0.0).all()
    assert sums(np.zeros(2), np.ones(2), nothing).shape == (2, 0)


def test_the_same_sums_give_the_same_bytes():
    x, q = scattered(2000)
    first, second = (scattered_sum("fft", pair(), EPSILON)(x, q) for _ in range(2))
    assert first.tobytes() == second.tobytes()


def test_the_input_is_left_alone():
    x, q = scattered(50)
    before = x.copy(), q.copy()
    for summation in ("fft", "naive"):
        scattered_sum(summation, pair(), EPSILON)(x, q)
    assert np.array_equal(x, before[0])
    assert np.array_equal(q, before[1])


@pytest.mark.parametrize("summation", ["fft", "naive"])
@pytest.mark.parametrize(
    ("x", "q", "z", "field"),
    [
        ([0.0, math.nan], [1.0, 1.0], None, "x"),
        ([0.0, math.inf], [1.0, 1.0], None, "x"),
        ([0.0, 1.0], [1.0, math.inf], None, "q"),
        ([0.0, 1.0], [1.0, 1.0], [math.nan], "z"),
        ([0.0, 1.0], [1.0], None, "q"),
        ([[0.0, 1.0]], [[1.0, 1.0]], None, "x"),
        ([0.0, 1.0], [1.0, 1.0], [[0.0]], "z"),
    ],
)
def test_what_cannot_be_summed_is_refused(summation, x, q, z, field):
    sums = scattered_sum(summation, pair(), EPSILON)
    with pytest.raises(InvalidInput) as error:
        sums(np.array(x), np.array(q), None if z is None else np.array(z))
    assert error.value.field == field


def test_a_particle_that_ran_away_is_named():
    sums = scattered_sum("fft", pair(), EPSILON)
    with pytest.raises(InvalidInput, match="1e\\+12"):
        sums(np.array([0.0, 1e12]), np.ones(2))


def test_choices_are_checked():
    with pytest.raises(InvalidInput, match="summation"):
        scattered_sum("tree", pair(), EPSILON)
    with pytest.raises(InvalidInput, match="epsilon"):
        scattered_sum("fft", pair(), 0.0)
    with pytest.raises(InvalidInput, match="name"):
        smooth_kernel("E", 1.5)
    with pytest.raises(InvalidInput, match="order"):
        smooth_kernel("F", 1.5, 3)
    with pytest.raises(InvalidInput, match="bandwidth"):
        scattered_sum("fft", [ScatteredKernel(np.sign)], EPSILON)
    with pytest.raises(InvalidInput, match="reach"):
        NeighbourSum(pair(), EPSILON)


# --- the ends of the numbers ----------------------------------------------------------------------


@pytest.mark.parametrize("summation", ["fft", "naive"])
def test_sums_that_overflow_are_refused(summation):
    x, q = scattered(50)
    with pytest.raises(InvalidInput, match="do not overflow"):
        scattered_sum(summation, pair(), EPSILON)(x, np.full(50, 1e308))
    large = scattered_sum(summation, pair(), EPSILON)(x, 1e290 * q)
    assert large == pytest.approx(1e290 * scattered_sum(summation, pair(), EPSILON)(x, q), rel=1e-9)


def test_the_accuracy_is_that_of_the_positions_in_a_wide_box():
    x, q = scattered(60)
    x, q = np.concatenate([x, x + 3e4]), np.concatenate([q, q])
    fast, exact = NonuniformFourierSum(pair(), EPSILON), NaiveScatteredSum(pair(), EPSILON)
    off = closeness(fast(x, q), exact(x, q))
    assert NonuniformFourierSum.accuracy < off < fast.accuracy


def test_a_lattice_far_from_the_origin_is_summed_where_it_is():
    """Its places are rounded to 1e-10 there: not to be taken for equally spaced."""
    x = 1e6 + 0.1 * np.arange(100)
    _, q = scattered(100)
    off = closeness(NonuniformFourierSum(pair(), 0.1)(x, q), NaiveScatteredSum(pair(), 0.1)(x, q))
    assert off < CLOSE


def test_a_kernel_stays_what_it_is():
    gaussian = ScatteredKernel(lambda r: np.exp(-r * r), reach=6.5)
    with pytest.raises(FrozenInstanceError):
        gaussian.reach = 1.0  # type: ignore[misc]
