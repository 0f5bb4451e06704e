"""Piecewise polynomials: what the pieces give back exactly."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Chebyshev
from numpy.testing import assert_allclose

from fracparticles.special import chebyshev

WIDTH, PIECES = 0.75, 3


@pytest.mark.parametrize("degree", range(chebyshev.DEGREE + 1))
def test_polynomials_up_to_the_degree_are_their_own_pieces(degree):
    """T_k on all pieces: the values of the pieces are its own, up to rounding times the Lebesgue constant, 3 here."""
    polynomial = Chebyshev.basis(degree, domain=[0.0, WIDTH * PIECES])
    coefficients = chebyshev.fit(polynomial(chebyshev.sample_points(WIDTH, PIECES)))
    x = np.linspace(0.0, WIDTH * PIECES, 100, endpoint=False)
    values = [chebyshev.horner(at / WIDTH, coefficients) for at in x]
    # In powers of t the largest coefficient of T_17 is 1.6e5, and its rounding the largest error.
    assert_allclose(values, polynomial(x), rtol=0.0, atol=1.6e5 * 18 * np.finfo(float).eps)


@pytest.mark.parametrize("degree", range(chebyshev.DEGREE + 1))
def test_the_coefficients_are_those_of_the_powers(degree):
    """T_k on a piece of width 2: numpy's conversion, whose coefficients are whole numbers."""
    samples = Chebyshev.basis(degree)(chebyshev.sample_points(2.0, 1) - 1.0)
    expected = np.zeros(chebyshev.DEGREE + 1)
    expected[: degree + 1] = np.polynomial.chebyshev.cheb2poly(np.eye(degree + 1)[degree])
    found = chebyshev.fit(samples)[0]
    # The samples carry a rounding of k^2 eps (T_k' <= k^2), and powers of t amplify it by 2^17 at most.
    assert_allclose(found, expected, rtol=0.0, atol=18**2 * 2**17 * np.finfo(float).eps)
