"""The law of the error (19): its exponents, and the best support parameter."""

from __future__ import annotations

import math

import pytest

from fracparticles.errors import InvalidInput
from fracparticles.markers import SHAPES
from fracparticles.markers.accuracy import (
    optimal_support,
    predicted_support,
    quadrature_exponent,
    quadrature_order,
    smoothing_exponent,
)


@pytest.mark.parametrize(("name", "k", "m"), [("S1", 2, 1), ("S3", 2, 2), ("S8", 4, None)])
def test_exponents_of_the_error_law(name, k, m):
    # eps^2 corrections: eps = 0.2 against a width of 1.
    assert smoothing_exponent(SHAPES[name]) == pytest.approx(k, abs=0.05)
    if m is not None:
        assert quadrature_exponent(SHAPES[name]) == pytest.approx(m, abs=0.1)
        assert quadrature_order(SHAPES[name]) == m


def test_the_best_support():
    # S3: k = M = 2, so that eps_best = h^(1/2).
    assert predicted_support(SHAPES["S3"], 0.04) == pytest.approx(0.2, rel=1e-14)
    assert math.isnan(predicted_support(SHAPES["S8"], 0.04))
    # Both terms of (19) equal at most: within a factor of 2, in whole steps of the ratio.
    plain, robust = optimal_support(SHAPES["S3"], 0.1)
    assert 1.0 <= plain / 0.1 <= 14.0
    assert 0.5 < robust / predicted_support(SHAPES["S3"], 0.1) < 2.0


def test_what_cannot_be_is_refused():
    with pytest.raises(InvalidInput):
        smoothing_exponent("S8")
    with pytest.raises(InvalidInput):
        optimal_support(SHAPES["S8"], 0.0)
    for h in (1e-9, 2.0):
        with pytest.raises(InvalidInput, match="h <= 1"):
            optimal_support(SHAPES["S8"], h)
    # h^(1/2) is 31 h.
    with pytest.raises(InvalidInput, match="at most 14 h"):
        optimal_support(SHAPES["S3"], 1e-3)
