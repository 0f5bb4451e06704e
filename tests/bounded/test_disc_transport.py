"""Transport on a disc: skew but for div a, so that no wave grows; the order of errors at centre, edge and between."""

from __future__ import annotations

import numpy as np
import pytest

from flows import PRESSED, constant, fastest, inward, mean, shear, transport, whole
from fracparticles.bounded.disc import Disc
from sweeps import covering, few

EPS = np.finfo(float).eps
ALPHAS = (1.05, 1.3, 1.9)


def eddies(x, y):
    """Along the edge: a = (-psi_y, psi_x), psi = 5 (1 - r^2) sin(2 x) cos(2 y)."""
    depth, s, c = 1.0 - x**2 - y**2, np.sin(2.0 * x), np.cos(2.0 * x)
    across, along = np.cos(2.0 * y), np.sin(2.0 * y)
    return (
        10.0 * s * (y * across + depth * along),
        10.0 * across * (depth * c - x * s),
    )


def side(x, y):
    """Zero at the edge, and not without divergence."""
    return 5.0 * (1.0 - x**2 - y**2), 0.0 * x


# --- what is skew ---------------------------------------------------------------------------------


@pytest.mark.parametrize("angles", [1, 2, 7, 8])
@pytest.mark.parametrize("exterior", ["absorbing", "reflecting", "given"])
def test_all_but_half_of_the_divergence_is_skew(exterior, angles):
    one, rng = Disc(1.5, 12, angles, exterior, radius=2.0), np.random.default_rng(angles)
    velocity = rng.standard_normal((2, *one.x.shape))
    v = one.volumes.reshape(-1, 1) * transport(one, velocity)
    rest = np.diag(one.volumes.ravel() * one.divergence(velocity).ravel())
    # Seven rings and all angles are summed up in an entry.
    most = 2.0 * (7 + angles) * EPS * np.abs(v).max()
    assert np.abs(v + v.T + rest).max() < most
    assert np.abs(rest).max() > 1e6 * most


def test_the_divergence_is_of_order_six():
    errors = []
    for count in (16, 32):
        one = Disc(1.5, count, 24)
        x, y = one.points
        found = one.divergence((np.sin(x + 0.5 * y), np.cos(x) * y))
        errors.append(mean(one, found - np.cos(x + 0.5 * y) - np.cos(x)))
    assert np.log2(errors[0] / errors[1]) > 5.5


@pytest.mark.parametrize("angles", [6, 7])
@pytest.mark.parametrize("flow", PRESSED)
def test_the_divergence_of_a_linear_velocity_is_right_to_round_off(flow, angles):
    one = Disc(1.5, 12, angles)
    found = one.divergence(flow(*one.points))
    # Differences of a_r, at most |a|, over the distance of the outermost rings.
    assert np.abs(found + PRESSED[flow]).max() < 10.0 * EPS * 5.4 / one._rings.slope.min()


def test_what_the_edge_keeps_is_kept():
    for angles in (1, 6, 7):
        one, rng = Disc(1.5, 12, angles, "reflecting"), np.random.default_rng(5)
        v = one.volumes.reshape(-1, 1) * transport(one, rng.standard_normal((2, *one.x.shape)))
        assert np.abs(v.sum(axis=0)).max() < 10.0 * EPS * np.abs(v).sum(axis=0).max()


# --- what does not grow ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("exterior", "flow", "alpha", "rings"),
    covering(["absorbing", "given"], PRESSED, ALPHAS, [8, 20]),
)
def test_the_square_sum_grows_no_faster_than_it_is_pressed_together(flow, alpha, rings, exterior):
    """d/dt sum V v^2 / 2 <= (max(-div a) / 2 - lambda_1) sum V v^2; one-sided differences made it 1e2 to 1e4."""
    one = Disc(alpha, rings, 8, exterior)
    rate, round_off = fastest(one, flow)
    assert rate < 0.5 * PRESSED[flow] - one.eigenvalues(1)[0] + round_off


@pytest.mark.parametrize("flow", [eddies, side])
@pytest.mark.parametrize("rings", [8, 14])
def test_no_wave_grows_where_nothing_leaves(flow, rings):
    """One-sided differences and what the mean is off by made eddies grow at a rate of 48."""
    rates = np.linalg.eigvals(whole(Disc(1.05, rings, 12, "reflecting"), flow))
    assert rates.real.max() < 100.0 * EPS * np.abs(rates).max()


# --- how large errors are -------------------------------------------------------------------------


def third(one, fine):
    """Values on a third of the rings, which are among them."""
    step = fine.shape[0] // one.rings
    return fine[step // 2 :: step]


@pytest.mark.parametrize(
    ("exterior", "flow", "alpha"),
    [
        *(("absorbing", *each) for each in covering([constant, inward, shear], ALPHAS)),
        *(("reflecting", *each) for each in covering([eddies, side], few(ALPHAS))),
    ],
)
def test_the_order_is_that_of_the_diffusion(exterior, flow, alpha):
    """u - 0.2 (A u - div(a u)) = e^(x + y/2), against three and nine times as many rings at the same angles."""
    every = [Disc(alpha, rings, 6, exterior) for rings in (14, 42, 126)]
    coarse, middle, fine = (
        np.linalg.solve(
            np.eye(one.x.size) - 0.2 * whole(one, flow), np.exp(one.x + 0.5 * one.y).ravel()
        ).reshape(one.x.shape)
        for one in every
    )
    errors = [
        mean(one, u - third(one, fine)) for one, u in zip(every[:2], (coarse, middle), strict=True)
    ]
    assert np.log(errors[0] / errors[1]) / np.log(3.0) > 4.0 - alpha - 0.3


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_transport_of_what_vanishes_at_the_edge(alpha):
    """u = d^(alpha/2) e^x, d = 1 - r^2, a = (1, 0): -u_x, by what the exterior leaves of it inside, d^(alpha/2)."""
    errors = []
    for count in (16, 32, 64):
        one = Disc(alpha, count, 24)
        x = one.x
        d = one._rings.edge[:, None] * (1.0 + one._rings.r[:, None])
        u = d ** (0.5 * alpha) * np.exp(x)
        off = one.carried(u, 0.0 * u, (np.ones_like(x), np.zeros_like(x))) + u * (
            1.0 - alpha * x / d
        )
        errors.append(mean(one, d ** (0.5 * alpha) * off))
    assert np.log2(errors[1] / errors[2]) > min(3.0 * alpha, 4.0) - 0.3


def test_transport_across_the_centre():
    """u = (1 - r^2)^3 e^y, a = (1, 0), at the three innermost rings: an error of 1.4 N without what makes M r = 1.

    What is left is that P r is not 1 there: a share of |grad u| = 1.
    """
    for count in (24, 48, 96):
        one = Disc(1.5, count, 12)
        x, y = one.points
        d = 1.0 - x**2 - y**2
        ours = one.carried(d**3 * np.exp(y), 0.0 * x, (np.ones_like(x), np.zeros_like(x)))
        assert np.abs(ours - 6.0 * x * d**2 * np.exp(y))[:3].max() < 0.5


@pytest.mark.parametrize("angles", [15, 16])
def test_transport_across_the_centre_of_what_is_given(angles):
    """u = sin(2 x + y), a = (1, 0), at the three innermost rings: seven radii that reach to 6 xi^2, a polynomial each.

    Its error in f' is r^6 f^(7) / 7! or so, f = cos(angle) u: 2^6 for each 2 of xi^2.
    """
    errors = []
    for count in (24, 48):
        one = Disc(1.5, count, angles, "given")
        x, y = one.points
        ours = one.carried(0.0 * x, np.sin(2.0 * x + y), (np.ones_like(x), np.zeros_like(x)))
        errors.append(np.abs(ours + 2.0 * np.cos(2.0 * x + y))[:3].max())
    assert errors[-1] < 1e-7
    assert np.log2(errors[0] / errors[1]) > 6.0


@pytest.mark.parametrize("exterior", ["absorbing", "reflecting"])
def test_a_rotation_is_the_derivative_along_the_rings(exterior):
    one = Disc(1.5, 12, 8, exterior)
    x, y = one.points
    u = x * x * y
    ours = one.carried(u, 0.0 * u, (-y, x))
    assert ours == pytest.approx(-(x**3 - 2.0 * x * y * y), abs=1e-13)
