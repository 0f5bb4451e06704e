"""Remeshing: the interpolation functions, and what they conserve."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracparticles.errors import InvalidInput
from fracparticles.moving import remeshing
from fracparticles.moving.remeshing import REMESHINGS, eliminate, interpolation_function, remesh

MOMENTS = {"M4'": 3, "Lambda3": 4, "Lambda6,4": 7}  # how many, from m = 0


@pytest.mark.parametrize("name", ["M4'", "Lambda3"])
def test_known_values(name):
    r = np.array([-2.5, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0])
    expected = [0.0, 0.0, -1 / 16, 0.0, 9 / 16, 1.0, 9 / 16, 0.0, -1 / 16, 0.0]
    assert interpolation_function(name, r) == pytest.approx(expected, abs=1e-15)


def test_the_derivatives_of_lambda_6_4_are_central_differences_of_seven_points():
    # Up to the fourth, from either side of each knot, by differences of a polynomial of degree 9.
    grid = np.linspace(0.0, 1.0, 10)
    for k in range(4):
        piece = np.polynomial.Polynomial.fit(grid, interpolation_function("Lambda6,4", k + grid), 9)
        for knot, at in ((k, 0.0), (k + 1, 1.0)):
            nodes = np.arange(-3.0, 4.0)
            weights = np.linalg.solve(
                np.vander(nodes, increasing=True).T, np.diag([1, 1, 2, 6, 24, 0, 0])
            )
            # The m-th derivative of x^m through the seven points takes W^(m)(k) = (-1)^m w_k.
            for m in range(5):
                expected = (-1) ** m * weights[3 + knot, m] if knot <= 3 else 0.0
                assert piece.deriv(m)(at) == pytest.approx(expected, abs=1e-7)
    assert interpolation_function("Lambda6,4", np.array([-4.0, 4.0, 5.5])).tolist() == [
        0.0,
        0.0,
        0.0,
    ]


@pytest.mark.parametrize(
    ("name", "below"), [("M4'", 0.035), ("Lambda3", 0.045), ("Lambda6,4", 1e-5)]
)
def test_what_remeshing_makes_of_a_constant(name, below):
    # The series of the module: the Fourier integral of W by Gauss's rule between the knots.
    rho, reach = 1.05, remeshing.REACH[name]
    x, new = remesh(rho * np.arange(-60, 61), np.ones(121), 1.0, name)
    inside = np.abs(x) < 20.0
    nodes, weights = np.polynomial.legendre.leggauss(160)
    r = (np.arange(reach)[:, None] + 0.5 * (nodes + 1.0)).ravel()
    w = np.tile(0.5 * weights, reach) * interpolation_function(name, r)
    k = 2.0 * np.pi / rho * np.arange(1, 41)
    transform = 2.0 * np.cos(np.outer(k, r)) @ w
    waves = 1.0 + 2.0 * np.cos(np.outer(x[inside], k)) @ transform
    left_out = {"M4'": 1e-4, "Lambda3": 2e-3, "Lambda6,4": 1e-9}[name]  # like m^-3, m^-2 and m^-6
    assert np.abs(rho * new[inside] - waves).max() < left_out
    assert np.abs(rho * new[inside] - 1.0).max() < below


def test_slopes_at_the_knots():
    step = 1e-6

    def jump(name, r):
        left, middle, right = interpolation_function(name, np.array([r - step, r, r + step]))
        return (right - 2.0 * middle + left) / step

    for knot in (1.0, 2.0):
        assert abs(jump("M4'", knot)) < 1e-5  # second derivatives of up to 5, times the step
    # One-sided slopes -1 and -1/3.
    assert jump("Lambda3", 1.0) == pytest.approx(2.0 / 3.0, abs=1e-5)


@pytest.mark.parametrize("name", REMESHINGS)
@given(shift=st.floats(0.0, 1.0))
def test_polynomials_are_reproduced(name, shift):
    p = np.arange(-4, 6)
    weights = interpolation_function(name, p - shift)
    for m in range(MOMENTS[name]):
        assert weights @ p.astype(float) ** m == pytest.approx(shift**m, abs=1e-13)


def test_the_third_moment_tells_them_apart():
    p = np.arange(-3, 5)
    weights = interpolation_function("M4'", p - 0.3)
    assert abs(weights @ p.astype(float) ** 3 - 0.3**3) > 0.01


@pytest.mark.parametrize("name", REMESHINGS)
@given(
    seed=st.integers(0, 2**32 - 1), n=st.integers(1, 50), spread=st.sampled_from([0.0, 1.0, 9.0])
)
def test_moments_are_conserved_whatever_the_positions(name, seed, n, spread):
    generator = np.random.default_rng(seed)
    x, strength = spread * generator.standard_normal(n), generator.standard_normal(n)
    lattice, new = remesh(x, strength, 0.25, name)
    assert np.allclose(lattice / 0.25, np.round(lattice / 0.25), atol=1e-12)
    scale = np.abs(strength).sum()
    reach = np.abs(x).max() + 0.25 * remeshing.REACH[name]
    for m in range(MOMENTS[name]):
        # Round-off: of each of the 4 n or 8 n terms of at most 1.3 in all, and of their sum.
        tolerance = 16 * n * np.finfo(float).eps * 1.5 * scale * reach**m
        assert abs(new @ lattice**m - strength @ x**m) <= tolerance


@pytest.mark.parametrize("name", REMESHINGS)
def test_particles_on_the_lattice_stay_as_they_are(name):
    h = 0.125  # positions without round-off
    x = np.arange(-5, 6) * h
    strength = np.random.default_rng(3).standard_normal(11)
    lattice, new = remesh(x, strength, h, name)
    kept = eliminate(lattice, new, 0.0)
    assert np.array_equal(kept.x, x)
    assert np.array_equal(kept.strength, strength)
    assert kept.count == 0


@pytest.mark.parametrize("name", REMESHINGS)
@pytest.mark.parametrize("h", [0.1, 0.011173958378129449, 1e-50])
def test_remeshing_again_changes_no_bit(name, h):
    strength = np.random.default_rng(2).normal(size=401)
    x, again = h * np.arange(-200, 201), strength
    for _ in range(20):
        places, all_of_them = remesh(x, again, h, name)
        kept = all_of_them != 0.0  # those added at the ends are
        again = all_of_them[kept]
        assert np.array_equal(places[kept], x)
    assert np.array_equal(again, strength)


@pytest.mark.parametrize("name", REMESHINGS)
def test_order_does_not_matter_and_coincident_particles_add_up(name):
    x, strength = np.array([0.3, -1.2, 0.3]), np.array([1.0, 2.0, 3.0])
    one = remesh(x, strength, 1.0, name)
    other = remesh(np.array([-1.2, 0.3]), np.array([2.0, 4.0]), 1.0, name)
    assert one[0] == pytest.approx(other[0])
    assert one[1] == pytest.approx(other[1], abs=1e-15)


def test_elimination_reports_what_is_gone():
    x = np.arange(5.0)
    kept = eliminate(x, np.array([1e-3, -2e-3, 1.0, 0.0, 0.5]), 1e-2)
    assert np.array_equal(kept.x, [2.0, 4.0])
    assert kept.count == 2
    assert kept.eliminated == pytest.approx(-1e-3)


def test_without_a_threshold_only_nothing_is_left_out():
    kept = eliminate(np.arange(3.0), np.array([1.0, 0.0, 5e-324]), 0.0)
    assert np.array_equal(kept.strength, [1.0, 5e-324])
    assert kept.eliminated == 0.0


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: remesh(np.zeros(1), np.ones(1), 1.0, "M5"), "remeshing"),
        (lambda: remesh(np.zeros(1), np.ones(1), 0.0, "M4'"), "spacing"),
        (lambda: remesh(np.array([0.0, 1e30]), np.ones(2), 1.0, "M4'"), "x"),
        (lambda: remesh(np.array([0.0, np.nan]), np.ones(2), 1.0, "M4'"), "x"),
        (lambda: interpolation_function("M5", np.zeros(1)), "remeshing"),
        (lambda: eliminate(np.zeros(1), np.zeros(1), 0.0), "strength"),
        (lambda: eliminate(np.zeros(0), np.zeros(0), 0.0), "strength"),
        (lambda: eliminate(np.zeros(1), np.ones(1), 1.0), "threshold"),
        (lambda: eliminate(np.zeros(1), np.ones(1), -0.1), "threshold"),
        (lambda: eliminate(np.zeros(3), np.array([1e308, 9e307, 9e307]), 0.99), "strength"),
    ],
)
def test_bad_input_is_refused(call, field):
    with pytest.raises(InvalidInput) as error:
        call()
    assert error.value.field == field


@pytest.mark.parametrize("x", [[0.0, 200.0], [-200.0, 0.0], [-100.0, 100.0], [300.0, 500.0]])
def test_particles_too_far_apart_are_refused_wherever_they_lie(monkeypatch, x):
    monkeypatch.setattr(remeshing, "_MOST_POINTS", 150)
    with pytest.raises(InvalidInput, match="150 apart"):
        remesh(np.array(x), np.ones(2), 1.0, "M4'")
    x, strength = remesh(np.array([300.0, 449.0]), np.ones(2), 1.0, "M4'")
    assert strength.sum() == 2.0
