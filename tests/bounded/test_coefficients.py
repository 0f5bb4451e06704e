"""The gradient, transport, and a diffusivity that varies on bounded domains: closed forms, orders, pairs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import eval_jacobi, gammaln

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.interval_differences import differences
from fracparticles.bounded.plane_differences import one_sided_differences
from fracparticles.bounded.square import Square
from known import orders

ALPHAS = (1.1, 1.5, 1.9)


def eigenvalue(n, alpha):
    """mu_n of (-Laplacian)^(alpha/2) (1 - x^2)^(alpha/2) P_n = mu_n P_n (Dyda et al. 2017)."""
    return np.exp(gammaln(alpha + n + 1.0) - gammaln(n + 1.0))


# --- the interval ---------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_the_gradient_is_a_polynomial(alpha, n):
    """grad^beta w P_n^(a, a) = -2 mu_n / (n + 2 a) P_(n+1)^(a-1, a-1), w = (1 - x^2)^a, of slope -mu_n P_n^(a, a)."""
    a, errors = 0.5 * alpha, []
    for particles in (100, 200):
        line = Interval(alpha=alpha, particles=particles)
        w = (line._unit.left * line._unit.right) ** a
        primitive = 2.0 / (n + 2.0 * a) * eval_jacobi(n + 1, a - 1.0, a - 1.0, line.x)
        exact = -eigenvalue(n, alpha) * primitive
        errors.append(line.total(np.abs(line.gradient(w * eval_jacobi(n, a, a, line.x)) - exact)))
    assert errors[-1] < 1e-6
    # min(2 q + 2 - alpha, p), q = 3: that of the exchange, whose weights it has.
    assert orders(errors)[0] == pytest.approx(8.0 - alpha, abs=0.9)


def test_the_gradient_of_what_is_given_outside_goes_on():
    """1 / (1 + x^2): grad^beta is -Gamma(alpha) (1 + x^2)^(-alpha/2) sin(alpha arctan x), on any interval."""
    for alpha in ALPHAS:
        line = Interval(alpha=alpha, particles=200, exterior="given", ends=(-0.5, 2.0))
        lift = line.lifted(lambda y: 1.0 / (1.0 + y * y))
        x = line.x
        v = 1.0 / (1.0 + x * x) - lift.base
        exact = -np.exp(gammaln(alpha)) * (1.0 + x * x) ** (-0.5 * alpha)
        exact *= np.sin(alpha * np.arctan(x))
        assert line.total(np.abs(line.gradient(v) + lift.flux - exact)) < 1e-6


def test_the_flux_of_a_constant_is_zero():
    line = Interval(alpha=1.5, particles=50, exterior="given")
    lift = line.lifted(lambda y: 0.0 * y + 3.0)
    assert (lift.base == 3.0).all()
    assert (lift.flux == 0.0).all()


def test_differences_have_the_order_eight_and_conserve():
    errors = []
    for particles in (50, 100):
        line = Interval(alpha=1.5, particles=particles, ends=(0.0, 3.0))
        errors.append(line.total(np.abs(line.slope(np.sin(2 * line.x)) - 2 * np.cos(2 * line.x))))
    assert orders(errors)[0] > 7.5
    f = np.random.default_rng(1).random(30)
    # What goes in at the ends, where f goes on as its last value.
    weights = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])
    ends = [
        sum(w * (m * e[0] + e[:m].sum()) for m, w in enumerate(weights, 1)) for e in (f[::-1], f)
    ]
    assert differences(f).sum() == pytest.approx(ends[0] - ends[1], rel=1e-12)


@pytest.mark.parametrize("exterior", ["absorbing", "given"])
def test_transport_is_skew_but_for_half_of_the_slope_and_what_is_carried_out(exterior):
    line = Interval(alpha=1.5, particles=20, exterior=exterior, ends=(0.0, 3.0))
    a = np.random.default_rng(3).standard_normal(20)
    v = np.stack([line.volumes * line.carried(u, 0.0 * u, [a]) for u in np.eye(20)], axis=1)
    rest = np.diag(line.volumes * line.slope(a))
    rest[0, 0] += max(-a[0], 0.0)
    rest[-1, -1] += max(a[-1], 0.0)
    # Nine differences are summed up in an entry.
    assert np.abs(v + v.T + rest).max() < 2.0 * 9.0 * np.finfo(float).eps * np.abs(v).max()


@pytest.mark.parametrize("alpha", [1.05, 1.2, 1.9])
@pytest.mark.parametrize("speed", [10.0, 100.0])
@pytest.mark.parametrize(
    ("flow", "pressed"), [(np.ones_like, 0.0), (np.positive, -1.0), (np.negative, 1.0)]
)
def test_no_wave_grows_faster_than_it_is_pressed_together(flow, pressed, speed, alpha):
    """d/dt sum V u^2 / 2 <= (max(-a') / 2 - lambda_1) sum V u^2; as a flux it was 1e9 for |a| = 100, alpha = 1.05."""
    # With degree 8 round-off would hide the bound.
    line = Interval(alpha=alpha, particles=40, degree=4.0)
    a, root = speed * flow(line.x), np.sqrt(line.volumes)
    moved = np.stack([line.carried(u, 0.0 * u, [a]) for u in np.eye(40)], axis=1)
    form = root[:, None] * (line.matrix() + moved) / root
    fastest = np.linalg.eigvalsh(0.5 * (form + form.T))[-1]
    bound = 0.5 * pressed * speed - line.eigenvalues(1)[0]
    assert fastest < bound + 100.0 * np.finfo(float).eps * np.abs(form).max()


@pytest.mark.parametrize("exterior", ["absorbing", "reflecting"])
def test_the_exchange_of_the_mean_of_a_pair_is_that_sum(exterior):
    line = Interval(alpha=1.5, particles=20, exterior=exterior, degree=2.0)
    rng = np.random.default_rng(2)
    u, d, k = rng.random(20), 0.5 + rng.random(20), line._exchange
    v = line._unit.volumes
    naive = np.zeros(20)
    for i in range(20):
        for j in range(20):
            naive[i] += k[i, j] * v[j] * 0.5 * (d[i] + d[j]) * (u[j] - u[i])
        if line._loss is not None:
            naive[i] -= line._loss[i] * d[i] * u[i]
    assert line.spread(u, d) == pytest.approx(naive, rel=1e-12)
    # And as the three sums, which serve for the disc and the square.
    three = super(Interval, line).spread(u, d)
    assert three == pytest.approx(naive, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_regional_exchange_of_powers(alpha):
    """(D L u + L(D u) - u L D) / 2 of D = 1 + x, u = x: (x L x + L x^2) / 2 - x L x / 2 + L x = L x^2 / 2 + L x."""
    line = Interval(alpha=alpha, particles=200, exterior="reflecting")
    x = line.x
    exact = line.applied(x) + 0.5 * line.applied(x * x)
    inside = np.abs(x) < 0.9
    assert line.spread(x, 1.0 + x)[inside] == pytest.approx(exact[inside], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("kind", "form"), [("interval", "FPSE"), ("interval", "exchange"), ("disc", "exchange")]
)
@pytest.mark.parametrize("exterior", ["absorbing", "reflecting"])
def test_the_modes_are_those_of_the_operator(kind, exterior, form):
    one = (
        Interval(alpha=1.5, particles=60, exterior=exterior)
        if kind == "interval"
        else Disc(1.5, 16, 8, exterior)
    )
    d = 1.0 + 0.4 * one.points[0] * np.cos(one.points[-1])
    modes = one.modes_with(d, form)
    u, dt = modes.back(np.exp(-0.1 * modes.rates) * modes.into(1.0 + one.points[0])), 1e-6
    later, last = (modes.back(np.exp(-modes.rates * t) * modes.into(u)) for t in (dt, 2.0 * dt))
    rate = one.spread(later, d) if form == "exchange" else d * one.applied(later)
    assert one.total(np.abs((last - u) / (2.0 * dt) - rate)) < 1e-5
    if form == "exchange" and exterior == "reflecting":
        assert one.total(last) == pytest.approx(one.total(u), rel=1e-13)


# --- the plane ------------------------------------------------------------------------------------


def test_one_sided_differences_are_exact_for_the_sixth_power():
    x = np.arange(12.0)
    d = one_sided_differences(12)
    for power in range(1, 7):
        assert d @ x**power == pytest.approx(power * x ** (power - 1), rel=1e-8, abs=1e-8)


@pytest.mark.parametrize("one", [Disc(1.5, 12, 8, "reflecting"), Square(1.5, 12, "reflecting")])
def test_where_nothing_leaves_transport_and_exchange_keep_the_total(one):
    rng = np.random.default_rng(3)
    u, d = rng.random(one.volumes.shape), 0.5 + rng.random(one.volumes.shape)
    moved = one.carried(u, 0.0 * u, (rng.random(u.shape), rng.random(u.shape)))
    assert one.total(moved) == pytest.approx(0.0, abs=1e-11)
    spread = one.spread(u, d)
    assert one.total(spread) == pytest.approx(0.0, abs=1e-12 * one.total(np.abs(spread)))


def test_the_exchange_of_the_square_is_a_sum_over_pairs():
    from fracparticles.bounded.square_lattice import edge_exchange, weights

    one, rng = Square(1.5, 8, "reflecting"), np.random.default_rng(4)
    u, d, w = rng.random((8, 8)), 0.5 + rng.random((8, 8)), weights(1.5, 8)
    along = edge_exchange(1.5, 8)
    along, naive = along + along[::-1], np.zeros((8, 8))
    for i, j, k, m in np.ndindex(8, 8, 8, 8):
        weight = w[abs(i - k), abs(j - m)]
        weight += along[i] * (i == k and abs(j - m) == 1) + along[j] * (j == m and abs(i - k) == 1)
        naive[i, j] += weight * 0.5 * (d[i, j] + d[k, m]) * (u[k, m] - u[i, j])
    assert one.spread(u, d) == pytest.approx(naive * 4.0**1.5, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_powers_in_the_ball(alpha):
    """Getoor's; and outside the integral over the ball, by a quadrature, or far away by its mass."""
    from scipy.integrate import quad
    from scipy.special import gamma

    from fracparticles.bounded.closed_forms import power_in_ball, riesz_of_power
    from fracparticles.bounded.disc_rings import plane_constant
    from fracparticles.special.tails import tail_constant

    inside = riesz_of_power(np.array([0.0, 0.5]), alpha, 0.5 * alpha, 1)
    assert inside == pytest.approx(gamma(1.0 + alpha), rel=1e-12)
    exact = quad(lambda y: (1.0 - y * y) ** 2.2 * (1.5 - y) ** (-1.0 - alpha), -1.0, 1.0)[0]
    ours = riesz_of_power(np.array(2.25), alpha, 2.2, 1)
    assert ours == pytest.approx(-tail_constant(alpha) * exact, rel=1e-9)
    far = riesz_of_power(np.array(1e8), alpha, 2.0, 2)
    mass = np.pi / 3.0
    assert far == pytest.approx(-plane_constant(alpha) * mass * 1e-4 ** (2.0 + alpha), rel=1e-6)
    assert power_in_ball(np.array([0.5, 2.0]), 2.0) == pytest.approx([0.25, 0.0])
