"""Gauss quadrature: against scipy's rule, and the moments in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import roots_jacobi

from fracparticles.special.quadrature import gauss_jacobi, gauss_legendre

POWERS = (0.05, 1.0, 2.002, 4.5, 7.99)


@pytest.mark.parametrize("power", POWERS)
@pytest.mark.parametrize("count", [1, 2, 9, 24])
def test_the_rule_is_that_of_scipy(count, power):
    nodes, weights = gauss_jacobi(count, power)
    at, weight = roots_jacobi(count, 0.0, power)
    np.testing.assert_allclose(nodes, 0.5 * (1.0 + at), rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(weights, weight / 2.0 ** (power + 1.0), rtol=1e-10, atol=1e-16)


@pytest.mark.parametrize("power", POWERS)
def test_the_rule_is_exact_for_polynomials(power):
    nodes, weights = gauss_jacobi(12, power)
    degree = np.arange(24)
    moments = weights @ nodes[:, None] ** degree
    np.testing.assert_allclose(moments, 1.0 / (power + degree + 1.0), rtol=2e-14)


@pytest.mark.parametrize(("low", "high"), [(-1.0, 1.0), (0.0, 0.25), (2.0, 5.0)])
def test_the_rule_of_legendre_is_exact_for_polynomials(low, high):
    nodes, weights = gauss_legendre(12, low, high)
    degree = np.arange(24)
    moments = (high ** (degree + 1.0) - low ** (degree + 1.0)) / (degree + 1.0)
    found = weights @ nodes[:, None] ** degree
    # Some ulp of int |v|^degree: odd powers cancel on (-1, 1).
    scale = weights @ np.abs(nodes[:, None]) ** degree
    assert (np.abs(found - moments) <= 2e-14 * scale).all()
