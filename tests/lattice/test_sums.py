"""Lattice sums against the definition, term by term."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.direct import MatrixConvolution, NaiveConvolution
from fracparticles.lattice.fourier import FourierConvolution, complex_length, transform_length
from fracparticles.lattice.sums import SUMMATIONS, fast_convolution


def direct(weights, parity, u, pad=0):
    """y_i = sum_j w_{i-j} u_j, i = -pad .. N-1+pad, from the formula."""

    def w(m):
        return weights[m] if m >= 0 else parity * weights[-m]

    return np.array(
        [sum(w(i - j) * u[j] for j in range(u.size)) for i in range(-pad, u.size + pad)]
    )


def bound(weights, u):
    """Round-off of a transform: eps log2(L) |w| |u|, here with a factor of 4 to spare."""
    length = 4 * weights.size
    return (
        4
        * np.finfo(float).eps
        * np.log2(length)
        * 2.0
        * np.linalg.norm(weights)
        * np.linalg.norm(u)
    )


@pytest.mark.parametrize(("parity", "pad"), [(1, 0), (-1, 7)])
def test_a_sum_so_long_that_it_shares_its_memory(parity, pad):
    """Three particles on a long lattice: the sum is three shifted weights."""
    size = 600_001
    m = np.arange(size + pad)
    w = 1.0 / (1.0 + m) ** 2 * (1.0 if parity > 0 else m > 0)
    convolve = SUMMATIONS["fft"](w, size, parity=parity, pad=pad)
    u, expected = np.zeros(size), np.zeros(size + 2 * pad)
    i = np.arange(-pad, size + pad)
    for place, strength in ((0, 1.0), (1234, -2.0), (size - 1, 3.0)):
        u[place] = strength
        expected += strength * np.where(i >= place, 1.0, parity) * w[np.abs(i - place)]
    # A circular convolution by transforms of length L: some log2(L) ulp of the largest sum.
    assert np.abs(convolve(u) - expected).max() <= 21 * 3.0 * np.finfo(float).eps


@pytest.mark.parametrize("kind", [FourierConvolution, MatrixConvolution, NaiveConvolution])
@pytest.mark.parametrize("parity", [1, -1])
@given(size=st.integers(1, 40), pad=st.integers(0, 9), seed=st.integers(0, 2**32 - 1))
def test_sums_are_what_they_say(kind, parity, size, pad, seed):
    generator = np.random.default_rng(seed)
    weights, u = generator.standard_normal(size + pad), generator.standard_normal(size)
    if parity < 0:
        weights[0] = 0.0
    convolve = kind(weights, size, parity, pad)
    for data in (u, 2.0 * u):  # the buffers are used again
        assert np.abs(convolve(data) - direct(weights, parity, data, pad)).max() <= bound(
            weights, data
        )


def test_fft_and_naive_agree_on_a_long_lattice():
    size = 3001
    weights = 1.0 / (1.0 + np.arange(size)) ** 1.5
    u = np.random.default_rng(1).standard_normal(size)
    fast = SUMMATIONS["fft"](weights, size)(u).copy()
    slow = SUMMATIONS["naive"](weights, size)(u)
    assert np.abs(fast - slow).max() <= 1e-12 * np.abs(slow).max()


@pytest.mark.parametrize("kind", [FourierConvolution, MatrixConvolution, NaiveConvolution])
def test_the_sum_leaves_its_input_alone(kind):
    u = np.arange(5.0)
    kind(np.ones(5), 5)(u)
    assert np.array_equal(u, np.arange(5.0))


def test_few_particles_take_a_matrix_and_many_transforms():
    assert isinstance(fast_convolution(np.ones(57), 57), MatrixConvolution)
    assert isinstance(fast_convolution(np.ones(1001), 1001), FourierConvolution)


@pytest.mark.parametrize("parity", [1, -1])
@given(
    half=st.integers(0, 12), size=st.integers(1, 30), pad=st.integers(0, 5), seed=st.integers(0, 99)
)
def test_the_banded_sum_is_what_it_says(parity, half, size, pad, seed):
    generator = np.random.default_rng(seed)
    weights, v = generator.standard_normal(half + 1), generator.standard_normal(size + 2 * pad)
    if parity < 0:
        weights[0] = 0.0
    full = np.zeros(v.size + half)
    full[: half + 1] = weights
    expected = direct(full, parity, v)[pad : pad + size]
    out = np.full(size, np.nan)
    assert BandedConvolution(weights, parity)(v, out) is out
    assert np.abs(out - expected).max() <= bound(full, v)


def test_the_banded_sum_crosses_its_blocks():
    v = np.random.default_rng(2).standard_normal(2000)
    weights = np.array([0.5, 0.3, -0.2, 0.1])
    out = BandedConvolution(weights, 1)(v, np.empty(2000))
    assert out == pytest.approx(
        np.convolve(v, [0.1, -0.2, 0.3, 0.5, 0.3, -0.2, 0.1], "same"), abs=1e-14
    )


@pytest.mark.parametrize(
    ("order", "kernel"), [(2, lambda r: np.exp(-r * r)), (4, lambda r: np.exp(-0.5 * r * r))]
)
@given(overlap=st.floats(0.25, 50.0))
def test_beyond_the_reach_a_gaussian_is_round_off(order, kernel, overlap):
    assert kernel(BandedConvolution.reach(overlap, order) / overlap) < 1e-18


@given(st.integers(1, 10**6))
def test_transform_lengths_are_even_smooth_and_close(least):
    length = transform_length(least)
    assert length >= least
    assert length % 2 == 0
    rest = length
    for prime in (2, 3, 5, 7):
        while rest % prime == 0:
            rest //= prime
    assert rest == 1
    assert length <= max(2 * least, 2)  # there is a power of two


@given(st.integers(1, 10**6))
def test_complex_lengths_are_multiples_of_128_and_close(least):
    length = complex_length(least)
    assert least <= length <= max(2 * least, 128)
    assert length % 128 == 0
    assert max(prime_factors(length)) <= 7


def prime_factors(number):
    """The prime factors of a number, by trial division."""
    factor, found = 2, {1}
    while number > 1:
        while number % factor == 0:
            number //= factor
            found.add(factor)
        factor += 1
    return found


def test_the_same_sum_gives_the_same_bits():
    u = np.random.default_rng(4).standard_normal(700)
    weights = 1.0 / (1.0 + np.arange(700.0)) ** 2
    first, second = (SUMMATIONS["fft"](weights, 700)(u).copy() for _ in range(2))
    assert np.array_equal(first, second)
