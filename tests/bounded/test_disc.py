"""The disc: closed forms, the spectral method, invariants, orders, and what is refused."""

from __future__ import annotations

import warnings
from functools import cache
from math import gamma

import mpmath
import numpy as np
import pytest
from scipy.special import hyp2f1

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.disc_polynomials import AbsorbingDisc
from fracparticles.bounded.disc_rings import (
    Rings,
    exterior_rate,
    loss_along_a_line,
    plane_constant,
    ring_kernel,
)
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.special.tails import tail_constant
from known import in_the_whole_plane, orders
from sweeps import covering

ALPHAS = (1.2, 1.5, 1.8)


@cache
def disc(alpha, radial=64, angular=8, exterior="absorbing"):
    return Disc(alpha, radial, angular, exterior)


def depth(one):
    """1 - r^2 at the particles, to its own digits."""
    edge = 1.0 - np.hypot(one.x, one.y)
    return edge * (2.0 - edge)


def applied(r2, power, alpha):
    """(-Laplacian)^(alpha/2) (1 - r^2)_+^power: B. Dyda, Fract. Calc. Appl. Anal. 15 (2012) 536, Theorem 1."""
    s = 0.5 * alpha
    size = 2.0**alpha * gamma(s + 1.0) * gamma(power + 1.0) / gamma(power + 1.0 - s)
    return size * hyp2f1(s + 1.0, s - power, 1.0, r2)


def mean(one, u):
    return one.total(u) / one.volumes.sum()


# --- the kernels ----------------------------------------------------------------------------------


@pytest.mark.parametrize(("wave", "r", "other"), [(0, 0.3, 0.8), (1, 0.9, 0.85), (7, 0.5, 1.7)])
def test_the_kernel_of_a_ring_is_its_integral(wave, r, other):
    alpha = 1.5

    def integrand(phi):
        squared = r * r + other * other - 2.0 * r * other * mpmath.cos(phi)
        return mpmath.cos(wave * phi) * squared ** (-1.0 - 0.5 * alpha)

    exact = 2 * plane_constant(alpha) * mpmath.quad(integrand, [0, 0.1, 0.4, 1.2, mpmath.pi])
    ours = ring_kernel(np.array(r), np.array(other), np.array(abs(r - other)), alpha, wave)
    assert ours == pytest.approx(float(exact), rel=1e-11)


@pytest.mark.parametrize(("alpha", "q"), covering(ALPHAS, [0.15, 0.29, 0.31, 2.0, 20.0]))
def test_the_loss_along_a_line_is_what_other_lines_leave(alpha, q):
    # The exchange with a line at the distance k, c int (1 - cos q t) (k^2 + t^2)^(-1-alpha/2) dt, by Bessel functions
    # of 20 digits.
    with mpmath.workdps(20):
        nu = (1 + mpmath.mpf(alpha)) / 2

        def taken(k):
            z = q * k
            m = 2 ** (1 - nu) / mpmath.gamma(nu) * z**nu * mpmath.besselk(nu, z)
            return k ** (-2 * nu) * m

        last = int(40 / q) + 2
        correlated = mpmath.fsum(taken(mpmath.mpf(k)) for k in range(1, last))
        exact = mpmath.mpf(q) ** alpha - 2 * tail_constant(alpha) * (
            mpmath.zeta(2 * nu) - correlated
        )
    assert loss_along_a_line(np.array([q]), alpha)[0] == pytest.approx(float(exact), rel=3e-5)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_rate_to_the_outside_is_the_integral_over_the_angle(alpha):
    rings = Rings.graded(12)
    for r, ours in zip(rings.r[::3], rings.outward_rate(alpha)[::3], strict=True):

        def reach(phi, r=r):
            return (mpmath.sqrt(1 - (r * mpmath.sin(phi)) ** 2) - r * mpmath.cos(phi)) ** -alpha

        corners = [0, 1, 1.4, mpmath.pi / 2, 1.75, 2.2, mpmath.pi]
        exact = 2 * plane_constant(alpha) / alpha * mpmath.quad(reach, corners)
        assert ours == pytest.approx(float(exact), rel=1e-6)


def test_the_sum_over_rings_outside_is_that_rate():
    # The rule outside is of the same order as that inside; near the edge it is off by a share that scaling fixes.
    rings = Rings.graded(64)
    part = exterior_rate(rings, 1.5, 0).sum(axis=1) / rings.outward_rate(1.5)
    assert np.abs(part[:48] - 1.0).max() < 1e-4


# --- the operator against closed forms ------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
def test_getoors_solution_with_the_order_four_less_alpha(alpha):
    errors = []
    for radial in (16, 32, 64):
        one = disc(alpha, radial, 1)
        exact = depth(one) ** (0.5 * alpha)
        found = one.stationary(2.0**alpha * gamma(1.0 + 0.5 * alpha) ** 2)
        errors.append(mean(one, np.abs(found - exact)))
    # The outermost ring has its own error, of the size of u there: N^(-3 alpha / 2), seen in the maximum only.
    assert np.abs(found - exact).max() < 2e-4
    assert errors[-1] < 1e-4
    assert orders(errors)[-1] > 4.0 - alpha - 0.3


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("wave", [1, 3])
def test_a_polynomial_with_an_angle(alpha, wave):
    # (1 - r^2)^s r^l cos(l theta), n = 0: its Laplacian is Gamma(1+s) Gamma(1+s+l) / l! 2^alpha r^l cos(l theta).
    errors = []
    for radial in (32, 64):
        one = disc(alpha, radial, 8)
        solid = np.real((one.x + 1j * one.y) ** wave)
        s = 0.5 * alpha
        size = 2.0**alpha * gamma(1.0 + s) * gamma(1.0 + s + wave) / gamma(1.0 + wave)
        errors.append(mean(one, np.abs(one.stationary(size * solid) - depth(one) ** s * solid)))
    assert errors[-1] < 1e-4
    assert orders(errors)[-1] > 4.0 - alpha - 0.3


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_reflecting_disc_keeps_a_manufactured_solution(alpha):
    # The regional operator is the restricted one and the rate to the outside; u = (1 - r^2)^2 has no flux at the edge.
    errors = []
    for radial in (32, 64):
        one = disc(alpha, radial, 1, "reflecting")
        u = depth(one) ** 2
        outward = Rings.graded(radial).outward_rate(alpha)[:, None]
        source = applied(one.x**2 + one.y**2, 2.0, alpha) - outward * u
        errors.append(np.abs(one.evolve(u, 0.3, source) - u).max())
        level = one.total(u) / one.volumes.sum()
        assert one.stationary(source) == pytest.approx(u - level, abs=2.0 * errors[-1])
    assert errors[-1] < 3e-4
    assert orders(errors)[-1] > 4.0 - alpha - 0.2


@pytest.mark.parametrize("alpha", ALPHAS)
def test_a_field_given_outside_is_continued_inside(alpha):
    (u, source), errors = in_the_whole_plane(alpha), []
    for radial in (32, 64):
        one = Disc(alpha, radial, 24, "given")
        exact = u(one.x, one.y)
        errors.append(np.abs(one.stationary(source, u) - exact).max())
        assert np.abs(one.evolve(u, 0.5, source, u) - exact).max() < 1.1 * errors[-1]
    assert errors[-1] < 2e-4
    assert orders(errors)[-1] > 2.0


# --- eigenvalues and decay against the spectral method --------------------------------------------


def test_the_spectral_method_has_the_printed_eigenvalue():
    # Dyda, Kuznetsov & Kwasnicki (2017), Table 1: alpha = 1 in the plane.
    assert AbsorbingDisc(1.0).eigenvalues[0] == pytest.approx(2.0061190, abs=1e-7)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_eigenvalues_with_their_multiplicities(alpha):
    exact = [AbsorbingDisc(alpha, wave).eigenvalues[:2] for wave in range(5)]
    every = np.sort(np.concatenate([exact[0], *(np.repeat(one, 2) for one in exact[1:])]))
    found = disc(alpha, 64, 8).eigenvalues(6)
    assert found == pytest.approx(every[:6], rel=5e-4)
    errors = [abs(disc(alpha, n, 1).eigenvalues(1)[0] / exact[0][0] - 1.0) for n in (16, 32, 64)]
    assert errors[-1] < 1e-4
    assert orders(errors)[-1] == pytest.approx(4.0 - alpha, abs=0.3)


def test_decay_is_that_of_the_spectral_method():
    one, t = disc(1.5, 64, 4), 0.4
    r = np.hypot(one.x, one.y)
    start = depth(one) ** 0.75
    spectral = AbsorbingDisc(1.5).evolve(np.ones_like, t, r[:, 0])
    assert np.abs(one.evolve(start, t)[:, 0] - spectral).max() < 1e-4 * start.max()
    rate = np.log(one.total(one.evolve(start, 4.0)) / one.total(one.evolve(start, 4.5))) / 0.5
    assert rate == pytest.approx(one.eigenvalues(1)[0], rel=1e-10)


def test_the_spectral_solution_starts_as_it_should():
    r = np.linspace(0.0, 0.99, 12)
    start = AbsorbingDisc(1.5, 2).evolve(lambda r: 1.0 + r**2, 0.0, r)
    assert start == pytest.approx((1.0 - r**2) ** 0.75 * r**2 * (1.0 + r**2), abs=1e-11)


# --- invariants -----------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_reflecting_total_stays(alpha):
    one = disc(alpha, 64, 8, "reflecting")
    u = np.exp(-8.0 * ((one.x - 0.5) ** 2 + one.y**2))
    for t in (1e-3, 1.0, 100.0):
        assert one.total(one.evolve(u, t)) == pytest.approx(one.total(u), rel=1e-13)
    assert np.ptp(one.evolve(u, 100.0)) < 1e-12
    assert one.eigenvalues(2)[0] == 0.0 < one.eigenvalues(2)[1]


def test_a_source_adds_its_total():
    one = disc(1.5, 32, 4, "reflecting")
    assert one.total(one.evolve(0.0, 2.0, 3.0)) == pytest.approx(6.0 * one.volumes.sum(), rel=1e-13)


def test_a_constant_stays_if_it_is_given():
    one = Disc(1.8, 32, 4, "given")
    assert np.abs(one.evolve(2.0, 5.0, outside=2.0) - 2.0).max() < 1e-13
    assert np.abs(one.rate(np.full(one.x.shape, 2.0), outside=2.0)).max() == 0.0
    # And what starts elsewhere goes there.
    assert np.abs(one.evolve(0.0, 60.0, outside=lambda x, y: 0.0 * x + 2.0) - 2.0).max() < 1e-9


def test_no_exchange_is_negative_so_that_a_positive_field_stays_so():
    for alpha in ALPHAS:
        rings = Rings.graded(32)
        assert rings.exchange(alpha, 0).min() == 0.0  # on the diagonal only
        assert rings.exchange(alpha, 0) == pytest.approx(rings.exchange(alpha, 0).T, rel=1e-12)
    one = disc(1.5, 32, 1)
    assert one.evolve(np.where(np.abs(one.x - 0.5) < 0.1, 1.0, 0.0), 1e-2).min() > 0.0


def test_a_turned_field_gives_the_turned_solution():
    one = disc(1.5, 24, 8)
    u = np.random.default_rng(1).random(one.x.shape)
    turned = np.roll(u, 3, axis=1)
    assert one.evolve(turned, 0.1) == pytest.approx(
        np.roll(one.evolve(u, 0.1), 3, axis=1), abs=1e-12
    )


@pytest.mark.parametrize("exterior", ["absorbing", "reflecting"])
def test_the_rate_of_what_is_steady_is_the_source_that_keeps_it(exterior):
    one = disc(1.5, 24, 8, exterior)
    source = one.x * np.exp(one.y)
    assert one.rate(one.stationary(source)) == pytest.approx(-source, abs=1e-7)
    assert one.evolve(one.stationary(source), 1.0, source) == pytest.approx(
        one.stationary(source), abs=1e-9
    )


def test_radius_and_diffusivity_are_units():
    small, large = disc(1.5, 24, 4), Disc(1.5, 24, 4, radius=3.0, diffusivity=2.0)
    factor = 2.0 * 3.0**-1.5
    assert large.eigenvalues(3) == pytest.approx(factor * small.eigenvalues(3), rel=1e-13)
    u = depth(small)
    assert large.evolve(u, 0.5) == pytest.approx(small.evolve(u, 0.5 * factor), rel=1e-9)
    assert large.volumes.sum() == pytest.approx(9.0 * np.pi, rel=1e-5)
    assert large.stationary(1.0) == pytest.approx(small.stationary(1.0 / factor), rel=1e-9)


def test_a_field_that_the_particles_do_not_see_is_said():
    with pytest.warns(AccuracyWarning, match="the particles do not resolve initial"):
        disc(1.5, 64, 1).evolve(lambda x, y: np.exp(-4.0 * (x - 0.5) ** 2), 1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        disc(1.5, 64, 16).evolve(lambda x, y: np.exp(-4.0 * (x - 0.5) ** 2), 1.0)


# --- what is refused ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bad", "field"),
    [
        ({"alpha": 2.0}, "alpha"),
        ({"alpha": np.nan}, "alpha"),
        ({"rings": 7}, "rings"),
        ({"rings": 129}, "rings"),
        ({"angles": 0}, "angles"),
        ({"exterior": "open"}, "exterior"),
        ({"radius": -1.0}, "radius"),
        ({"diffusivity": 0.0}, "diffusivity"),
    ],
)
def test_bad_discs_are_refused(bad, field):
    with pytest.raises(InvalidInput, match=rf"^{field} = ") as error:
        Disc(**{"alpha": 1.5, "rings": 8, "angles": 4, **bad})
    assert "\n" not in str(error.value)


def test_bad_fields_are_refused():
    one = disc(1.5, 8, 4)
    for name, call in {
        "initial": lambda: one.evolve(np.ones(3), 1.0),
        "time": lambda: one.evolve(1.0, -1.0),
        "source": lambda: one.evolve(1.0, 1.0, lambda x, y: x / 0.0),
        "u": lambda: one.total(np.full((8, 4), np.inf)),
        "count": lambda: one.eigenvalues(33),
    }.items():
        with pytest.raises(InvalidInput, match=rf"^{name} = "):
            call()
    with pytest.raises(InvalidInput, match=r"^source = .* total 0"):
        disc(1.5, 8, 4, "reflecting").stationary(1.0)
