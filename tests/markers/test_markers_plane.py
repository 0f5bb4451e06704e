"""Loading in the plane: marginals, conditionals, reconstruction."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracparticles.errors import InvalidInput
from fracparticles.markers import SHAPES
from fracparticles.markers.plane import TwoBlobs, decoupled, reconstruct, sequential, weighted


def gauss(half, count=120):
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return half * nodes, half * weights


@given(a=st.floats(0.0, 2.5), x=st.floats(-4.0, 4.0))
def test_marginal_and_conditional(a, x):
    density = TwoBlobs(a)
    y, w = gauss(10.0)
    column = density.value(x, y)
    assert w @ column == pytest.approx(float(density.marginal(np.float64(x))), rel=1e-12)
    right = w @ np.exp(-((x - a) ** 2) - (y - a) ** 2) / (w @ column)
    assert float(density.right(np.float64(x))) == pytest.approx(right, rel=1e-9, abs=1e-12)


@given(a=st.floats(0.0, 2.0), xi=st.floats(1e-6, 1.0 - 1e-6), right=st.floats(0.0, 1.0))
def test_the_quantile_is_the_inverse(a, xi, right):
    x = float(TwoBlobs(a).quantile(np.array(xi), right))
    below = 0.5 * (right * (1.0 + math.erf(x - a)) + (1.0 - right) * (1.0 + math.erf(x + a)))
    assert below == pytest.approx(xi, abs=1e-14)


def test_a_product_is_one():
    x, y = np.linspace(-2.0, 2.0, 5), np.linspace(-1.0, 3.0, 5)
    assert TwoBlobs(0.0).product(x, y) == pytest.approx(TwoBlobs(0.0).value(x, y), rel=1e-14)
    assert not np.allclose(TwoBlobs(1.0).product(x, y), TwoBlobs(1.0).value(x, y))


@pytest.mark.parametrize("a", [0.0, 1.0])
def test_totals_and_moments(a):
    """The mixed moment int x y f = a^2 sigma is what decoupled marginals lose."""
    density, n = TwoBlobs(a), 64
    loadings = {
        "decoupled": decoupled(density.quantile, density.total, (n, n)),
        "weighted": weighted(density, (n, n)),
        "sequential": sequential(density, (n, n)),
    }
    for name, (x, y, w) in loadings.items():
        assert x.shape == y.shape == w.shape == (n * n,)
        # Midpoints: the weighted sum is the midpoint rule in xi, error of order 1 / n^2 for a bounded integrand.
        assert w.sum() == pytest.approx(density.total, rel=2.0 / n**2)
        mixed = float(w @ (x * y)) / density.total
        # What the outermost half cells lack of the second moment is of order log(n) / n.
        expected = 0.0 if name == "decoupled" else a * a
        assert mixed == pytest.approx(expected, abs=0.05 * (1.0 + a * a))


def test_reconstruction_is_the_double_sum():
    generator = np.random.default_rng(7)
    x, y, w = generator.normal(size=(3, 11))
    gx, gy = np.linspace(-1.0, 1.0, 3), np.linspace(-0.5, 2.0, 4)
    s8, epsilon = SHAPES["S8"], 0.7
    expected = [
        [
            sum(
                w[j] * float(s8((p - x[j]) / epsilon)) * float(s8((q - y[j]) / epsilon))
                for j in range(11)
            )
            / epsilon**2
            for q in gy
        ]
        for p in gx
    ]
    assert reconstruct(s8, epsilon, (x, y, w), gx, gy) == pytest.approx(
        np.array(expected), rel=1e-12
    )


@pytest.mark.parametrize("counts", [(0, 4), (4, 2.5)])
def test_counts_are_checked(counts):
    density = TwoBlobs(1.0)
    with pytest.raises(InvalidInput):
        decoupled(density.quantile, density.total, counts)


@given(a=st.floats(0.0, 2.0), k=st.integers(34, 52), right=st.floats(0.0, 1.0))
def test_the_quantile_keeps_its_digits_at_both_ends(a, k, right):
    """1 - 2^-k is a number of its own: what lies to the right of it mirrors what lies to the left of 2^-k."""
    density, part = TwoBlobs(a), 2.0**-k
    left, above = density.quantile(part, right), density.quantile(1.0 - part, 1.0 - right)
    # 1 - right is rounded; the part that it stands for moves x by as much, relative.
    assert float(above) == pytest.approx(-float(left), rel=1e-13, abs=1e-13)
    below = 0.5 * (right * math.erfc(a - left) + (1.0 - right) * math.erfc(-a - left))
    # Of erfc(-x) the relative error is 2 x^2 times that of x, which bisection knows to an ulp of its bracket.
    assert below == pytest.approx(part, rel=1e-11)


def test_the_blobs_stay_where_they_are():
    density = TwoBlobs(1.0)
    with pytest.raises(FrozenInstanceError):
        density.a = 2.0  # type: ignore[misc]
