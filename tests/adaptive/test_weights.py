"""The weights of near particles: the sums that they mend, and the order on any map."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from fracparticles.adaptive.exchange import exchange_matrix, rate_matrix
from fracparticles.adaptive.maps import graded_on_interval
from fracparticles.adaptive.placement import LineParticles
from fracparticles.adaptive.weights import near_weights, order_of
from fracparticles.errors import InvalidInput
from sweeps import covering


@pytest.mark.parametrize("alpha", [1.05, 1.5, 1.95])
@pytest.mark.parametrize("near", [1, 3, 6])
def test_the_weights_solve_their_equations(alpha, near):
    omega = near_weights(alpha, near)
    for k in range(2, 2 * near + 1, 2):
        moment = sum((w - 1) * mp.mpf(m) ** (k - 1 - alpha) for m, w in enumerate(omega, 1))
        size = sum(abs(w - 1) * mp.mpf(m) ** (k - 1 - alpha) for m, w in enumerate(omega, 1))
        assert abs(moment + mp.zeta(1 + alpha - k)) < 1e-12 * max(size, 1)


def test_one_neighbour_exchanges_more_by_a_value_of_zeta():
    assert near_weights(1.5, 1) == pytest.approx([1 - float(mp.zeta(0.5))], rel=1e-14)
    assert near_weights(1.5, 0).size == 0


@pytest.mark.parametrize(("alpha", "near"), covering([1.2, 1.5, 1.8], [0, 1, 2, 3]))
def test_the_sum_has_the_order_of_its_weights_on_a_map(alpha, near):
    """-(-Laplacian)^(alpha/2) of 1 / (1 + x^2), whose closed form is known, on x = sinh(s) + s / 4."""
    errors = []
    for h in (0.1, 0.05) if near < 3 else (0.05, 0.025):  # where its order shows
        s = h * np.arange(-round(26 / h), round(26 / h) + 1)
        particles = LineParticles(np.sinh(s) + s / 4, h * (np.cosh(s) + 0.25))
        x = particles.x
        rates = rate_matrix(exchange_matrix(particles, alpha, near), particles.volumes, None)
        middle = np.abs(x) < 3.0
        power = 1.0 + alpha
        exact = -float(mp.gamma(power)) * (1 + x**2) ** (-power / 2) * np.cos(power * np.arctan(x))
        errors.append(np.abs(rates @ (1 / (1 + x**2)) - exact)[middle].max())
    # The places of the maximum are not the same; without weights the next order is 2 more.
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order_of(alpha, near), abs=0.1)


def test_an_exchange_is_symmetric_and_conserves():
    particles = graded_on_interval(60, 5.0)
    exchange = exchange_matrix(particles, 1.7, 4)
    assert (exchange == exchange.T).all()
    u = np.random.default_rng(1).standard_normal(60)
    gained = particles.volumes * (rate_matrix(exchange, particles.volumes, None) @ u)
    assert abs(gained.sum()) < 1e-13 * np.abs(gained).sum()


def test_distances_keep_their_digits_at_the_ends():
    particles = graded_on_interval(50, 8.0)
    with mp.workdps(60):
        sides = zip(particles.left, particles.right, strict=True)
        x = [mp.mpf(a) - 1 if a < 1 else 1 - mp.mpf(b) for a, b in sides]
        for i, j in ((0, 1), (3, 2), (48, 49), (49, 20), (0, 49), (24, 25)):
            exact = float(abs(x[i] - x[j]))
            assert particles.distances[i, j] == pytest.approx(exact, rel=1e-13)
    assert particles.volumes.sum() == pytest.approx(2.0, rel=1e-10)  # the rule has the order p


def test_what_is_refused():
    for field, call in {
        "near": lambda: near_weights(1.5, 7),
        "alpha": lambda: near_weights(1.0, 2),
        "particles": lambda: graded_on_interval(2),
        "degree": lambda: graded_on_interval(20, 13.0),
    }.items():
        with pytest.raises(InvalidInput, match=f"^{field} = "):
            call()
