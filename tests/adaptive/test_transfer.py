"""From one placement to another: splines reproduce polynomials, and the mass and the first moment stay."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from fracparticles.adaptive.follow import _UNRESOLVED
from fracparticles.adaptive.placement import LineParticles
from fracparticles.adaptive.transfer import among, between, conserving, slopes, uncertain

COUNT = 40
S = np.arange(float(COUNT))
CENTRE = 0.5 * (COUNT - 1)
SEVENTH = Polynomial([0.3, -1.0, 0.5, 2.0, -1.5, 0.7, -2.0, 1.0])(
    Polynomial([-1.0, 1.0 / CENTRE])  # of s, from -1 to 1
)
# The spline solves a banded system whose condition number, at degree 7, is below a thousand.
ROUND_OFF = 1e3 * COUNT * np.finfo(float).eps


def particles(h=0.2):
    s = h * (S - CENTRE)
    return LineParticles(np.sinh(s), h * np.cosh(s))


def test_a_polynomial_of_the_seventh_degree_is_that_between_the_particles():
    x = -3.0 + 0.5 * S  # s is linear in x
    at = np.linspace(-3.0, x[-1], 333)
    found = between(x, SEVENTH(S), at)
    assert found == pytest.approx(
        SEVENTH(2.0 * (at + 3.0)), abs=ROUND_OFF * np.abs(SEVENTH(S)).max()
    )


def test_the_error_between_particles_on_a_map_has_the_eighth_order():
    errors = []
    for h in (0.1, 0.05):
        s = np.arange(-3.0, 3.0 + 0.5 * h, h)
        x = np.sinh(s)
        at = np.sinh(s[4:-5] + 0.37 * h)  # away from the ends, where the splines are another kind
        errors.append(np.abs(between(x, 1.0 / (1.0 + x**2), at) - 1.0 / (1.0 + at**2)).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(8.0, abs=0.5)


def test_among_the_particles_are_eight_places_to_each_gap():
    x = particles().x
    places, values = among(x, SEVENTH(S))
    assert np.histogram(places, x)[0].tolist() == [8] * (COUNT - 1)
    # x is no polynomial of s, so that the s of a place is found anew.
    s = np.arcsinh(places) / 0.2 + CENTRE
    assert values == pytest.approx(SEVENTH(s), rel=1e-6, abs=1e-6)


def test_slopes_are_those_of_the_polynomial():
    # A derivative at the end of a gap of one loses a digit.
    assert slopes(SEVENTH(S)) == pytest.approx(SEVENTH.deriv()(S), abs=10.0 * ROUND_OFF)


def test_nothing_is_uncertain_of_a_polynomial_of_the_fifth_degree():
    x, u = particles().x, SEVENTH.cutdeg(5)(S)
    assert uncertain(x, u) < ROUND_OFF
    assert uncertain(x, 0.0 * u) == 0.0


def test_what_is_uncertain_does_not_depend_on_the_side():
    x, u = particles().x, np.exp(-((S - 30.0) ** 2))
    assert uncertain(x, u) == pytest.approx(uncertain(-x[::-1], u[::-1]), rel=1e-9)
    assert uncertain(x, 7.0 * u) == pytest.approx(uncertain(x, u), rel=1e-12)


@pytest.mark.parametrize("width", [0.6, 0.8, 1.0, 1.2, 1.4, 2.0, 3.0])
def test_what_is_uncertain_is_said_wherever_much_is_missed(width):
    """exp(-(s / width)^2): of narrow data the particles miss nearly all that lies between them."""
    pairs = []
    for aside in (0.0, 0.25, 0.5):
        x, fine = S - 20.0 + aside, np.linspace(-10.0, 10.0, 4001)
        u, exact = (np.exp(-((z / width) ** 2)) for z in (x, fine))
        missed = np.abs(between(x, u, fine) - exact).mean() * 20.0 / (np.sqrt(np.pi) * width)
        pairs.append((missed, uncertain(x, u)))
    assert all(said > _UNRESOLVED or missed < _UNRESOLVED for missed, said in pairs)
    # Of a wave of length 2 pi / k a spline of degree 5 misses (2 pi / k - 1)^2 times as much as one of degree 7. What
    # counts most has k^6 exp(-(k width / 2)^2) greatest: there k width = sqrt(12).
    k = min(np.sqrt(12.0) / width, np.pi)
    missed, said = np.max(pairs, axis=0)
    assert said < 1.5 * (2.0 * np.pi / k - 1.0) ** 2 * missed


def test_the_mass_and_the_first_moment_are_what_they_were():
    line = particles()
    u = np.exp(-((line.x - 0.3) ** 2))
    mass, moment = line.volumes @ u, (line.volumes * line.x) @ u
    mended, share = conserving(line, u * (1.0 + 0.01 * np.sin(S)), mass, moment)
    assert line.volumes @ mended == pytest.approx(mass, rel=1e-14)
    assert (line.volumes * line.x) @ mended == pytest.approx(moment, abs=1e-14 * mass)
    assert 0.0 < share < 0.01
    same, nothing = conserving(line, u, mass, moment)
    assert same == pytest.approx(u, rel=1e-13)
    assert nothing < 1e-14


def test_a_moment_that_would_change_u_by_half_is_let_go():
    line = particles()
    u = np.exp(-(line.x**2))
    mass = 1.01 * float(line.volumes @ u)
    mended, share = conserving(line, u, mass, 1e4 * mass)
    # One factor for all, with which the mass is right.
    assert mended == pytest.approx(1.01 * u, rel=1e-13)
    assert share == pytest.approx(0.01, rel=1e-12)
