"""The plane: three ways to its density, and what is outside a square."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute
from fracparticles.special import green, reduced_green
from fracparticles.special.plane import (
    planar_asymptotic,
    planar_integral,
    planar_series,
    square_exchange_error,
    square_tail_mass,
)

ALPHA = 1.5


def test_the_mass_outside_the_square_is_what_is_not_inside():
    x, weight = (3.0 * part for part in np.polynomial.legendre.leggauss(80))
    inside = weight @ green(np.hypot(x[:, None], x), 0.7, ALPHA, 2) @ weight
    # Both quadratures are exact to round-off: analytic integrands, with singularities far from the nodes.
    assert square_tail_mass(3.0, 0.7, ALPHA) == pytest.approx(1.0 - inside, abs=1e-12)


def test_far_away_the_mass_outside_and_the_exchange_error_are_the_same_integral():
    # u ~ t c |y|^(-2-alpha), whose next term is of relative size t D^-alpha.
    far, t = 1e4, 1.0
    error = square_exchange_error(far, ALPHA, t)
    assert square_tail_mass(far, t, ALPHA) == pytest.approx(error, rel=10.0 * far**-ALPHA)


def test_the_truncation_error_of_an_exchange_scheme_is_predicted():
    grid = {"beta": 0.5, "dim": 2, "truncation": 8.0, "spacing": 0.25, "order": 4}
    case = Case(scheme="KPSE", integrator="exponential", **grid)
    error = relative_l1_error(case, compute(case).u)
    # Beside it: its next term, a few times (T / D^alpha) = 1 % of it, and the spatial error, 2 to 3 % of it.
    assert error == pytest.approx(square_exchange_error(case.reach, ALPHA, 1.0), rel=0.1)


@pytest.mark.parametrize("alpha", [1.2, 1.5, 1.8])
def test_three_ways_to_the_planar_density(alpha):
    r = np.array([0.0, 0.3, 1.0, 2.0])
    exact = reduced_green(r, alpha, 2)
    # Round-off of a sum of 800 positive and negative terms of the size of the result at 0.
    np.testing.assert_allclose(planar_integral(r, alpha), exact, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(planar_series(r[:3], alpha, 100), exact[:3], rtol=1e-11)
    far = np.array([100.0, 1000.0])
    # After 8 terms the next one is of relative size 2^(8 alpha) r^(-8 alpha) times growing factors.
    exact = reduced_green(far, alpha, 2)
    np.testing.assert_allclose(planar_asymptotic(far, alpha, 8), exact, rtol=1e-9)
