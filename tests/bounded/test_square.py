"""The square: closed forms, sums over all pairs, invariants, orders, and what is refused."""

from __future__ import annotations

import warnings
from functools import cache
from math import gamma, pi

import mpmath
import numpy as np
import pytest
from scipy.special import hyp2f1

from fracparticles.bounded.disc_rings import plane_constant
from fracparticles.bounded.square import Square
from fracparticles.bounded.square_lattice import (
    edge_exchange,
    edge_fit,
    edge_volumes,
    epstein_zeta,
    harmonic_zeta,
    line_weights,
    neighbours,
    rate_of_all,
    weights,
)
from fracparticles.bounded.square_outside import Outside, outward_rate
from fracparticles.errors import AccuracyWarning, InvalidInput
from known import in_the_whole_plane, orders
from sweeps import few

ALPHAS = (1.2, 1.5, 1.8)


@cache
def square(alpha, side=32, exterior="absorbing"):
    return Square(alpha, side, exterior)


def bump(one, power=4):
    """(1 - r^2)_+^power, which is zero at the edge of the square and beyond."""
    return np.maximum(1.0 - one.x**2 - one.y**2, 0.0) ** power


def applied(one, alpha, power=4):
    """Its (-Laplacian)^(alpha/2): B. Dyda (2012), Theorem 1, in the disc; -c times the integral outside."""
    s, r2 = 0.5 * alpha, one.x**2 + one.y**2
    size = 2.0**alpha * gamma(s + 1.0) * gamma(power + 1.0) / gamma(power + 1.0 - s)
    inside = size * hyp2f1(s + 1.0, s - power, 1.0, np.minimum(r2, 1.0))
    far = np.maximum(r2, 1.0)
    outside = -plane_constant(alpha) * pi / (power + 1.0) * far ** (-1.0 - s)
    return np.where(r2 < 1.0, inside, outside * hyp2f1(1.0 + s, 1.0 + s, power + 2.0, 1.0 / far))


# --- the lattice ----------------------------------------------------------------------------------


@pytest.mark.parametrize("s", [1.2, 1.9, 3.5])
def test_epsteins_zeta_function_is_a_product(s):
    half, quarter = mpmath.mpf(s) / 2, mpmath.mpf(1) / 4
    beta = 4**-half * (mpmath.zeta(half, quarter) - mpmath.zeta(half, 3 * quarter))
    assert epstein_zeta(s) == pytest.approx(float(4 * mpmath.zeta(half) * beta), rel=1e-13)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_symbol_is_the_power_to_the_order_of_three_neighbours(alpha):
    # A sum over the square |m| <= M and the integral beyond, where cos k.m has no mean: k is a wave of 2 M + 1 points.
    m = np.arange(-200.0, 201.0)
    wide = np.zeros((401, 401))
    w = weights(alpha, 201)
    wide[200:, 200:] = w
    wide[200:, :200], wide[:200, 200:] = w[:, :0:-1], w[:0:-1, :]
    wide[:200, :200] = w[:0:-1, :0:-1]
    beyond = outward_rate(np.zeros(1), np.zeros(1), 200.5, alpha)[0]
    errors = []
    for wave in (32, 16):
        k = 2.0 * pi / 401.0 * np.array([wave, 0.5 * wave])
        symbol = (wide * (1.0 - np.cos(k[0] * m[:, None] + k[1] * m))).sum() + beyond
        errors.append(abs(symbol / np.hypot(*k) ** alpha - 1.0))
    assert errors[0] < 5e-4
    assert orders(errors)[0] > 3.5  # 6 - alpha, until what the cosine has beyond is seen


def test_the_harmonic_sum_where_it_converges():
    # alpha = 5: cos 4 theta / |m|^3, in shells.
    m = np.arange(-600.0, 601.0)
    x, y = np.meshgrid(m, m)
    r = np.hypot(x, y)
    r[600, 600] = np.inf
    inside = r < 600.0
    direct = (np.cos(4.0 * np.arctan2(y, x)) * r**-3.0)[inside].sum()
    assert harmonic_zeta(5.0) == pytest.approx(direct, rel=1e-4)


def test_the_weights_of_a_line_are_the_sums_along_it():
    alpha, k = 1.5, np.arange(1.0, 4.0)
    m = np.arange(-200000.0, 200001.0)
    sums = [(plane_constant(alpha) * (j * j + m * m) ** (-1.0 - 0.5 * alpha)).sum() for j in k]
    next_to, across, second = neighbours(alpha)
    sums[0] += next_to + 2.0 * across
    sums[1] += second
    assert line_weights(alpha, 3) == pytest.approx(sums, rel=1e-10)
    w = weights(alpha, 400)
    # The rest: 400^-1.5.
    assert (4.0 * w[1:, :].sum()) == pytest.approx(rate_of_all(alpha), rel=2e-4)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_fitted_volumes_integrate_the_power_at_the_edge(alpha):
    # int_0^1 d^s cos(d) dd with the far end mended by the trapezoidal end terms: smooth there, so take a window.
    s, errors = 0.5 * alpha, []
    for n in (40, 80):
        d = (np.arange(n) + 0.5) / n
        window = (1.0 - d) ** 4
        exact = float(mpmath.beta(s + 1.0, 5.0))
        errors.append(abs((edge_volumes(alpha, n) * d**s * window).sum() / n - exact))
    # d^s and d^(s+1) are met, d^(s+2) is not.
    assert orders(errors)[0] == pytest.approx(s + 3.0, abs=0.3)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_fitted_half_plane_holds_its_harmonic_power(alpha):
    # The sum over lines as it stands, to 4e5 lines and the integral beyond by its leading term.
    s, far, lines = 0.5 * alpha, 400000, 3
    d = np.arange(far) + 0.5
    values = edge_volumes(alpha, far) * d**s
    w = np.concatenate([[0.0], line_weights(alpha, 200)])
    k = np.arange(200.0, far)
    w = np.concatenate([w[:200], w[200] * (k / 200.0) ** (-1.0 - alpha)])
    own = rate_of_all(alpha) - 2.0 * w.sum() - 2.0 * w[-1] * far / alpha
    for line in range(lines):
        gained = w[np.abs(np.arange(far) - line)] @ values + w[-1] * far ** (1.0 + s) / s
        lost = (rate_of_all(alpha) + edge_fit(alpha, lines)[line]) * d[line] ** s
        gained += own * values[line]
        assert gained == pytest.approx(lost, rel=1e-6)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_what_neighbours_on_an_edge_line_exchange_is_what_lines_beyond_leave(alpha):
    total = float(mpmath.zeta(alpha - 1.0))
    lines = np.arange(1, 6)
    found = edge_exchange(alpha, 5)
    found[0] -= neighbours(alpha)[1]
    unit = found[0] / (total + 1.0 / (3.0 - alpha) / (2.0 - alpha))
    for k, ours in zip(lines, found, strict=True):
        mean = (k ** (3.0 - alpha) - (k - 1.0) ** (3.0 - alpha)) / (3.0 - alpha)
        hurwitz = float(mpmath.zeta(alpha - 1.0, int(k)))
        assert ours == pytest.approx(unit * (hurwitz + mean / (2.0 - alpha)), rel=1e-9)


def test_the_sums_are_those_over_all_pairs():
    one, alpha = square(1.5, 8, "reflecting"), 1.5
    u = np.random.default_rng(2).random((8, 8))
    w, along = weights(alpha, 8), edge_exchange(alpha, 8)
    along = along + along[::-1]
    dense = np.zeros((8, 8))
    for i, j, k, m in np.ndindex(8, 8, 8, 8):
        weight = w[abs(i - k), abs(j - m)]
        weight += along[i] * (i == k and abs(j - m) == 1) + along[j] * (j == m and abs(i - k) == 1)
        dense[i, j] += weight * (u[k, m] - u[i, j])
    # A unit of the lattice is h = 1/4. The exchange along the edges is symmetric: its loss is that of neighbours.
    assert one.rate(u) == pytest.approx(dense * 4.0**alpha, rel=1e-10)


# --- outside --------------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_rate_to_the_outside_of_the_middle(alpha):
    # Eight right triangles: (c / alpha) 8 int_0^(pi/4) cos^alpha.
    exact = (
        8
        * plane_constant(alpha)
        / alpha
        * mpmath.quad(lambda t: mpmath.cos(t) ** alpha, [0, mpmath.pi / 4])
    )
    found = outward_rate(np.zeros(1), np.zeros(1), 1.0, alpha)
    assert found[0] == pytest.approx(float(exact), rel=1e-12)
    d = 1e-5  # near a side it is that of the half-plane, c_1 / alpha d^-alpha
    near = outward_rate(np.array([1.0 - d]), np.zeros(1), 1.0, alpha)[0]
    half = line_weights(alpha, 100)[-1] * 100.0 ** (1.0 + alpha) / alpha * d**-alpha
    assert near == pytest.approx(half, rel=1e-4)


def test_the_mean_outside_is_that_of_the_integral():
    alpha, x, y = 1.5, 0.4, -0.3

    # In polar coordinates about the place: t from corner to corner, s = rho(t) / v to the edge and beyond.
    corners = sorted(np.arctan2(b - y, a - x) % (2 * pi) for a in (-1, 1) for b in (-1, 1))
    node, weight = np.polynomial.legendre.leggauss(100)
    first = np.array(corners)
    arcs = np.diff([*corners, corners[0] + 2 * pi])
    t = (first[:, None] + 0.5 * arcs[:, None] * (1.0 + node)).ravel()
    sides = [(np.sign(e) - at) / e for e, at in ((np.cos(t), x), (np.sin(t), y))]
    rho = np.minimum(*sides)[:, None]
    v = (0.5 * (1.0 + node)) ** 2  # of v^(alpha - 1) dv the root goes
    s = rho / v
    share = np.outer((arcs[:, None] * weight).ravel(), weight * np.sqrt(v))
    share *= s ** (-1 - alpha) * rho / v**2
    exact = (share * np.exp(-((x + s * np.cos(t)[:, None]) ** 2) / 4.0)).sum() / share.sum()
    outside = Outside(np.array([x]), np.array([y]), 1.0, alpha)
    found = outside.mean(lambda x, y: np.exp(-(x**2) / 4.0))
    assert found[0] == pytest.approx(exact, rel=1e-4)


# --- against closed forms -------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("exterior", ["absorbing", "reflecting"])
def test_a_manufactured_solution(alpha, exterior):
    errors = []
    for side in (32, 64):
        one = square(alpha, side, exterior)
        u, source = bump(one), applied(one, alpha)
        if exterior == "reflecting":
            source = source - outward_rate(one.x, one.y, 1.0, alpha) * u
        errors.append(np.abs(one.evolve(u, 0.3, source) - u).max())
    # At edges that nothing leaves the order is 2; the fourth power at r = 1 does not let it be 6 - alpha inside.
    assert errors[-1] < (1e-5 if exterior == "absorbing" else 6e-5)
    assert orders(errors)[-1] > (3.3 if exterior == "absorbing" else 1.9)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_a_field_given_outside_is_continued_inside(alpha):
    (u, source), errors = in_the_whole_plane(alpha), []
    for side in (16, 32):
        one = Square(alpha, side, "given")
        errors.append(np.abs(one.stationary(source, u) - u(one.x, one.y)).max())
    # Of order 6 - alpha by the lattice, of order 2 by the end of the wider one, far away.
    assert errors[-1] < 3e-5
    assert orders(errors)[-1] > 1.9


@pytest.mark.parametrize("alpha", few(ALPHAS))
def test_the_fitted_lattice_wins_the_order_back(alpha):
    # Against itself at N = 64; the error of the plain lattice is of the first order in h.
    reference = square(alpha, 64).eigenvalues(1)[0]
    fitted = [abs(square(alpha, n).eigenvalues(1)[0] - reference) for n in (8, 16, 32)]
    plain = [abs(Square(alpha, n, fitted=False).eigenvalues(1)[0] - reference) for n in (20, 40)]
    assert orders(fitted)[1] > 1.0 + alpha - 0.2
    assert fitted[-1] < 2e-5 * reference
    assert fitted[-1] < 0.002 * plain[-1]
    assert orders(plain)[0] == pytest.approx(1.0, abs=0.35)  # alpha = 1.8 is on its way there


def test_the_square_lies_between_its_discs():
    # Domain monotonicity: the disc inscribed has the greater eigenvalue, that around the square the smaller.
    from fracparticles.bounded.disc_polynomials import AbsorbingDisc

    for alpha in ALPHAS:
        inscribed = AbsorbingDisc(alpha).eigenvalues[0]
        found = square(alpha, 32).eigenvalues(1)[0]
        assert inscribed * 2.0 ** (-0.5 * alpha) < found < inscribed


@pytest.mark.parametrize("exterior", ["absorbing", "reflecting"])
def test_near_alpha_2_the_eigenvalues_are_those_of_the_laplacian(exterior):
    # pi^2 / 2 and pi^2 / 4; they change by some 1.3 times 2 - alpha of themselves (values of alpha = 1.99 and 1.999).
    absorbing = exterior == "absorbing"
    exact = 0.5 * pi**2 if absorbing else 0.25 * pi**2
    found = square(1.999, 32, exterior).eigenvalues(2)[0 if absorbing else 1]
    assert found == pytest.approx(exact, rel=3e-3)


# --- invariants -----------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_reflecting_total_stays(alpha):
    one = square(alpha, 32, "reflecting")
    u = np.exp(-8.0 * ((one.x - 0.5) ** 2 + one.y**2))
    for t in (1e-3, 1.0):
        assert one.total(one.evolve(u, t)) == pytest.approx(one.total(u), rel=1e-13)
    assert np.ptp(one.evolve(u, 10.0)) < 3.0 * np.exp(-10.0 * one.eigenvalues(2)[1])
    assert one.eigenvalues(1)[0] == 0.0
    assert one.total(one.evolve(0.0, 2.0, 3.0)) == pytest.approx(24.0, rel=1e-13)


def test_a_constant_stays_if_it_is_given():
    one = Square(1.8, 16, "given")
    assert np.abs(one.evolve(2.0, 5.0, outside=2.0) - 2.0).max() < 1e-14
    assert np.abs(one.evolve(0.0, 60.0, outside=lambda x, y: 0.0 * x + 2.0) - 2.0).max() < 1e-9


@pytest.mark.parametrize("exterior", ["absorbing", "reflecting"])
def test_the_symmetries_of_the_square(exterior):
    one = square(1.5, 16, exterior)
    u = np.random.default_rng(3).random((16, 16))
    for turned in (np.rot90, np.transpose, np.flipud):
        assert one.evolve(turned(u), 0.1) == pytest.approx(turned(one.evolve(u, 0.1)), abs=1e-11)
    assert np.ptp(one.eigenvalues(3)[1:]) < 1e-9  # x and y


def test_a_long_decay_is_that_of_the_first_eigenvalue():
    one = square(1.5, 16)
    first = one.total(one.evolve(1.0, 6.0)) / one.total(one.evolve(1.0, 7.0))
    assert np.log(first) == pytest.approx(one.eigenvalues(1)[0], rel=1e-8)
    assert one.evolve(1.0, 1.0).min() > 0.0


def test_half_width_and_diffusivity_are_units():
    small, large = square(1.5, 16), Square(1.5, 16, half_width=3.0, diffusivity=2.0)
    factor = 2.0 * 3.0**-1.5
    assert large.eigenvalues(2) == pytest.approx(factor * small.eigenvalues(2), rel=1e-10)
    u = bump(small)
    assert large.evolve(u, 0.5) == pytest.approx(small.evolve(u, 0.5 * factor), rel=1e-9)
    assert large.stationary(1.0) == pytest.approx(small.stationary(1.0 / factor), rel=1e-9)
    assert large.rate(u) == pytest.approx(factor * small.rate(u), rel=1e-9)


def test_a_field_that_the_particles_do_not_see_is_said():
    with pytest.warns(AccuracyWarning, match="the particles do not resolve initial"):
        square(1.5, 8).evolve(lambda x, y: 1.0 + np.cos(8.0 * pi * x), 1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        square(1.5, 32).evolve(lambda x, y: 1.0 + np.cos(8.0 * pi * x), 1.0)


# --- what is refused ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bad", "field"),
    [
        ({"alpha": 1.0}, "alpha"),
        ({"particles": 7}, "particles"),
        ({"particles": 513}, "particles"),
        ({"exterior": "open"}, "exterior"),
        ({"half_width": 0.0}, "half_width"),
        ({"diffusivity": -1.0}, "diffusivity"),
        ({"fitted": 1}, "fitted"),
    ],
)
def test_bad_squares_are_refused(bad, field):
    with pytest.raises(InvalidInput, match=rf"^{field} = ") as error:
        Square(**{"alpha": 1.5, "particles": 8, **bad})
    assert "\n" not in str(error.value)


def test_bad_fields_are_refused():
    one = square(1.5, 8)
    for name, call in {
        "initial": lambda: one.evolve(np.ones(3), 1.0),
        "time": lambda: one.evolve(1.0, np.nan),
        "source": lambda: one.evolve(1.0, 1.0, lambda x, y: x / 0.0),
        "u": lambda: one.total(np.full((8, 8), np.inf)),
        "count": lambda: one.eigenvalues(21),
    }.items():
        with pytest.raises(InvalidInput, match=rf"^{name} = "):
            call()
    with pytest.raises(InvalidInput, match=r"^source = .* total 0"):
        square(1.5, 8, "reflecting").stationary(1.0)
