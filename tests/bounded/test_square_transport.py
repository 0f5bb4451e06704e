"""Transport on a square: skew but for div a and what is carried out, so that no wave grows; the order of errors."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, gmres

from flows import PRESSED, constant, fastest, inward, mean, outward, shear, transport, whole
from fracparticles.bounded.square import Square
from sweeps import covering, few

EPS = np.finfo(float).eps
ALPHAS = (1.05, 1.3, 1.5, 1.9)
# At either end of a line the differences of five particles are fitted: they overlap, and do not.
COUNTS = (8, 13)


def cells(x, y):
    """a = (-psi_y, psi_x), psi = 5/pi sin(pi x) sin(pi y): four eddies, along the edges."""
    s, t = np.pi * x, np.pi * y
    return -5.0 * np.sin(s) * np.cos(t), 5.0 * np.cos(s) * np.sin(t)


def side(x, y):
    """Zero at the edges it points to, and not without divergence."""
    return 5.0 * (1.0 - x**2) * np.exp(y), 0.0 * x


# --- what is skew ---------------------------------------------------------------------------------


def through_edges(one, velocity):
    """sum max(a_n, 0) (value of each line at its end)^2 over the edges, as a matrix: what is carried out."""
    count = one.particles
    end = np.zeros((2, count))
    end[0, :3] = end[1, : count - 4 : -1] = 15.0 / 8.0, -5.0 / 4.0, 3.0 / 8.0
    line = np.sqrt(np.diag(one.volumes))
    a_x, a_y = velocity
    form = np.zeros((count, count, count, count))
    for k, (e, sign) in enumerate(zip(end, (-1.0, 1.0), strict=True)):
        out_x, out_y = np.maximum(sign * a_x[-k], 0.0), np.maximum(sign * a_y[:, -k], 0.0)
        for m in range(count):
            form[:, m, :, m] += out_x[m] * line[m] * np.multiply.outer(e, e)
            form[m, :, m, :] += out_y[m] * line[m] * np.multiply.outer(e, e)
    return form.reshape(count**2, count**2)


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("exterior", ["absorbing", "reflecting", "given"])
def test_all_is_skew_but_half_of_the_divergence_and_what_is_carried_out(exterior, count):
    one, rng = Square(1.3, count, exterior, half_width=2.0), np.random.default_rng(count)
    velocity = rng.standard_normal((2, *one.x.shape))
    v = one.volumes.reshape(-1, 1) * transport(one, velocity)
    rest = np.diag(one.volumes.ravel() * one.divergence(velocity).ravel())
    if exterior != "reflecting":
        rest += through_edges(one, velocity)
    # Eleven differences along either axis are summed up in an entry.
    most = 2.0 * 22.0 * EPS * np.abs(v).max()
    assert np.abs(v + v.T + rest).max() < most
    assert np.abs(rest).max() > 1e6 * most


def test_the_divergence_is_of_order_six():
    errors = []
    for count in (16, 32):
        one = Square(1.5, count)
        x, y = one.points
        found = one.divergence((np.sin(x + 0.5 * y), np.cos(x) * y))
        errors.append(mean(one, found - np.cos(x + 0.5 * y) - np.cos(x)))
    assert np.log2(errors[0] / errors[1]) > 5.5


@pytest.mark.parametrize("exterior", ["absorbing", "given"])
@pytest.mark.parametrize("flow", PRESSED)
def test_the_divergence_of_a_linear_velocity_is_right_to_round_off(flow, exterior):
    one = Square(1.5, 12, exterior)
    # Differences of at most |a| = 5 over the spacing, by weights whose sizes sum up to 16 at an edge.
    most = 2.0 * 7.0 * EPS * 16.0 * 5.0 * 6.0
    assert np.abs(one.divergence(flow(*one.points)) + PRESSED[flow]).max() < most


def test_what_the_edges_keep_is_kept():
    one, rng = Square(1.5, 12, "reflecting"), np.random.default_rng(5)
    v = transport(one, rng.standard_normal((2, *one.x.shape)))
    assert np.abs(v.sum(axis=0)).max() < 10.0 * EPS * np.abs(v).sum(axis=0).max()


# --- what does not grow ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("exterior", "flow", "alpha", "count"),
    covering(["absorbing", "given"], PRESSED, ALPHAS, [8, 16]),
)
def test_the_square_sum_grows_no_faster_than_it_is_pressed_together(flow, alpha, count, exterior):
    """d/dt sum V v^2 / 2 <= (max(-div a) / 2 - lambda_1) sum V v^2; one-sided differences made waves that grow."""
    one = Square(alpha, count, exterior)
    rate, round_off = fastest(one, flow)
    assert rate < 0.5 * PRESSED[flow] - one.eigenvalues(1)[0] + round_off


@pytest.mark.parametrize("flow", [cells, side])
@pytest.mark.parametrize("count", [8, 14])
def test_no_wave_grows_where_nothing_leaves(flow, count):
    """One-sided differences and what the mean is off by made cells grow at a rate of 14."""
    rates = np.linalg.eigvals(whole(Square(1.05, count, "reflecting"), flow))
    assert rates.real.max() < 100.0 * EPS * np.abs(rates).max()


# --- how large errors are -------------------------------------------------------------------------


def third(one, fine):
    """Values on a third of the lines along either axis, which are among them."""
    step = fine.shape[0] // one.particles
    return fine[step // 2 :: step, step // 2 :: step]


def solved(one, flow):
    """u - 0.2 (A u - div(a u)) = e^(x + y/2), a fifth of the velocity: |a| is 1.4 or less, and no layer is thin."""
    velocity = [0.2 * a for a in flow(*one.points)]

    def left(u):
        u = u.reshape(one.x.shape)
        return (u - 0.2 * (one.applied(u) + one.carried(u, 0.0 * u, velocity))).reshape(-1)

    size = one.x.size
    right = np.exp(one.x + 0.5 * one.y).reshape(-1)
    u, state = gmres(LinearOperator((size, size), left), right, rtol=1e-8, restart=400, maxiter=2)
    assert state == 0
    return u.reshape(one.x.shape)


@pytest.mark.parametrize(
    ("exterior", "flow", "alpha"),
    [
        *(("absorbing", *each) for each in covering([constant, inward, outward, shear], ALPHAS)),
        *(("reflecting", *each) for each in covering([cells, side], few(ALPHAS))),
    ],
)
def test_the_order_is_alpha_or_where_nothing_leaves_two(exterior, flow, alpha):
    """Against three and nine times as many lines."""
    every = [Square(alpha, count, exterior) for count in (8, 24, 72)]
    coarse, middle, fine = (solved(one, flow) for one in every)
    errors = [
        mean(one, u - third(one, fine)) for one, u in zip(every[:2], (coarse, middle), strict=True)
    ]
    order = alpha if exterior == "absorbing" else 2.0
    assert np.log(errors[0] / errors[1]) / np.log(3.0) > order - 0.3


@pytest.mark.parametrize("alpha", ALPHAS)
def test_transport_of_what_vanishes_at_the_edges(alpha):
    """u = w e^x, w = depth^(alpha/2), a = (1, 0): -u_x, by what the exterior leaves of it inside, w.

    At the edge it is off by a share of w / h, which w and a line's volume make h^alpha.
    """
    errors = []
    for count in (16, 32, 64):
        one = Square(alpha, count)
        x, y = one.points
        w = ((1.0 - x**2) * (1.0 - y**2)) ** (0.5 * alpha)
        u = w * np.exp(x)
        ours = one.carried(u, 0.0 * u, (np.ones_like(x), np.zeros_like(x)))
        errors.append(mean(one, w * (ours + u * (1.0 - alpha * x / (1.0 - x**2)))))
    assert np.log2(errors[1] / errors[2]) > alpha - 0.3


def test_transport_of_what_is_given():
    """u = sin(2 x + y), a = (1, 0): differences of order 6."""
    errors = []
    for count in (16, 32):
        one = Square(1.5, count, "given")
        x, y = one.points
        ours = one.carried(0.0 * x, np.sin(2.0 * x + y), (np.ones_like(x), np.zeros_like(x)))
        errors.append(np.abs(ours + 2.0 * np.cos(2.0 * x + y)).max())
    assert np.log2(errors[0] / errors[1]) > 5.5


@pytest.mark.parametrize("alpha", ALPHAS)
def test_a_layer_thinner_than_the_spacing_makes_no_waves(alpha):
    """u = 1, a = (1, 0), where it is carried out: a fifth of what differences make of the jump to zero there, or less.

    On the last three lines that is 37/60, -8/60 and 1/60.
    """
    one = Square(alpha, 16)
    u = np.ones_like(one.x)
    ours = one.carried(u, 0.0 * u, (u, 0.0 * u)) * 2.0 / one.particles
    assert np.abs(ours[-5:]).max() < 37.0 / 60.0 / 5.0
