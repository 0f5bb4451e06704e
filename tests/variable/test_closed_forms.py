"""The closed forms against integrals over wave numbers, by mpmath, and the sign of the fractional gradient."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from fracparticles.variable.closed_forms import Cauchy, exchange_limit

ALPHA = 1.4
PLACES = (0.0, 0.3, 1.0, 4.0)


def over_waves(f):
    """The integral of f(k) exp(-k), k = q^5 to take away the power at k = 0."""
    return mp.quad(lambda q: 5 * q**4 * f(q**5) * mp.exp(-(q**5)), [0, 0.5, 1, 1.5, 2, 2.3])


@pytest.mark.parametrize("s", [ALPHA - 2.0, ALPHA])
@pytest.mark.parametrize("x", PLACES)
def test_laplacian_is_the_integral_over_wave_numbers(s, x):
    line = over_waves(lambda k: k**s * mp.cos(k * x))
    plane = over_waves(lambda k: k ** (s + 1) * mp.besselj(0, k * x))
    assert -Cauchy.laplacian([np.array(x)], s) == pytest.approx(float(line), rel=1e-12, abs=1e-13)
    assert -Cauchy.laplacian([np.array(x), np.array(0.0)], s) == pytest.approx(
        float(plane), rel=1e-12, abs=1e-13
    )


@pytest.mark.parametrize("x", PLACES)
def test_gradient_has_the_transform_i_k_over_k_to_the_beta(x):
    # u = (1 / pi) int u^(k) cos(k x) dk on the line, u^ = pi exp(-k): i sign(k) |k|^beta makes -sin(k x) of cos(k x).
    beta = ALPHA - 1.0
    line = -over_waves(lambda k: k**beta * mp.sin(k * x))
    plane = -over_waves(lambda k: k**ALPHA * mp.besselj(1, k * x))
    (ours,) = Cauchy.gradient([np.array(x)], ALPHA)
    assert ours == pytest.approx(float(line), rel=1e-12, abs=1e-13)
    ours, across = Cauchy.gradient([np.array(x), np.array(0.0)], ALPHA)
    assert ours == pytest.approx(float(plane), rel=1e-12, abs=1e-13)
    assert across == 0.0


def test_divergence_of_the_gradient_is_the_laplacian():
    place, step = np.array([0.7, -0.4]), 1e-4
    divergence = 0.0
    for axis, shift in enumerate(step * np.eye(2)):
        ahead, behind = (
            Cauchy.gradient(list(at), ALPHA)[axis] for at in (place + shift, place - shift)
        )
        divergence += (ahead - behind) / (2.0 * step)
    # Central differences: step^2 / 6 of third derivatives of order one to ten, and rounding of 1e-16 / step.
    assert divergence == pytest.approx(Cauchy.laplacian(list(place), ALPHA), abs=1e-7)


def test_limit_of_the_exchange_is_the_nonlocal_integral():
    # (D_i + D_j) / 2 (u_j - u_i) C / |x - y|^(1 + alpha) over pairs at distance z, symmetrised.
    c, x = 0.5, mp.mpf(0.6)
    scale = 2**ALPHA * mp.gamma((1 + ALPHA) / 2) / (mp.sqrt(mp.pi) * abs(mp.gamma(-ALPHA / 2)))

    def p(y):
        return 1 / (1 + y * y)

    def pairs(q):
        z = mp.exp(q)
        jumps = sum(
            (1 + c * (p(x) + p(x + sign * z)) / 2) * (p(x + sign * z) - p(x)) for sign in (1, -1)
        )
        return jumps / z**ALPHA

    with mp.workdps(40):
        integral = scale * mp.quad(pairs, range(-36, 31, 6))
    # Beyond are a share exp(-36 (2 - alpha)) = 4e-10 of a second derivative and exp(-30 alpha).
    ours = exchange_limit(np.array(0.6), ALPHA, c)
    assert ours == pytest.approx(float(integral), rel=1e-8)


def test_the_two_equations_meet_where_alpha_is_two():
    x = np.linspace(-4.0, 4.0, 81)
    u = Cauchy.value([x])
    gaps = [
        np.abs(
            exchange_limit(x, alpha, 0.5)
            - Cauchy.flux_divergence([x], alpha, 1.0 + 0.5 * u, [-x * u * u])
        ).max()
        for alpha in (1.5, 1.9, 1.999)
    ]
    assert gaps[0] > 0.05
    assert gaps[2] == pytest.approx(0.01 * gaps[1], rel=0.3)  # linear in 2 - alpha close to it
