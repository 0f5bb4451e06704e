"""Product integration, the operators by it, and the warning of what differs."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.special import gamma, roots_jacobi

from fracparticles.errors import AccuracyWarning
from fracparticles.sph import (
    ParticleLine,
    caputo_derivative,
    comparison,
    rl_derivative,
    rl_integral,
)
from fracparticles.sph.product_integration import fractional_integral
from sweeps import covering

OPERATORS = {"caputo": caputo_derivative, "rl": rl_derivative, "integral": rl_integral}


@pytest.mark.parametrize("order", [0.0, 1e-17, 0.1, 0.7, 1.0, 1.5, 2.7])
def test_a_straight_line_is_integrated_exactly(order):
    """I^q (2 - 3 x) = 2 x^q / Gamma(q+1) - 3 x^(q+1) / Gamma(q+2); the weights lose i^2 round-off."""
    x = np.linspace(0.0, 2.0, 101)
    found = fractional_integral(2.0 - 3.0 * x, 0.02, np.full(x.size, order))
    exact = 2.0 * x**order / gamma(order + 1.0) - 3.0 * x ** (order + 1.0) / gamma(order + 2.0)
    assert found[1:] == pytest.approx(exact[1:], rel=0.0, abs=1e-11)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("name", "method", "scale"),
    covering(["caputo", "integral"], ["halved", "completed"], [1e-30, 1.0, 1e3]),
)
def test_what_is_zero_but_for_round_off_is_no_error(name, method, scale):
    line = ParticleLine(0.0, scale, 101)
    x = line.x_all / scale
    for f in (np.full_like(x, 3.0), np.cos(x) ** 2 + np.sin(x) ** 2, np.zeros_like(x)):
        OPERATORS[name](line, f, 0.5, method=method)


@pytest.mark.filterwarnings("error", "ignore::fracparticles.errors.AccuracyWarning")
def test_orders_near_the_ends_of_their_range():
    line = ParticleLine(0.0, 1.0, 201)
    f = line.x_all**2
    rl_integral(line, f, 1e-17, method="completed")
    rl_derivative(line, f, 0.3 + 0.6999 * np.clip(line.x_all, 0.0, 1.0) ** 4, method="completed")


def of_a_power(q: float, x: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """I^alpha x^q; that of -alpha is the derivative, where the order is constant."""
    return gamma(q + 1.0) / gamma(q + 1.0 + alpha) * x ** (q + alpha)


@pytest.mark.parametrize("alpha", [0.2, 0.5, 0.8])
def test_the_errors_of_the_comparison_are_of_second_order(alpha):
    """Of x^3.5, which begins smoothly enough: the broken line errs like s^2, and the order comes up to 2 from below."""
    errors = {name: [] for name in ("rl_integral", "caputo_derivative", "rl_derivative")}
    for count in (51, 101, 201):
        line = ParticleLine(0.0, 1.0, count)
        f, order = np.maximum(line.x_all, 0.0) ** 3.5, np.full_like(line.x_all, alpha)
        for name, found in errors.items():
            exact = of_a_power(3.5, line.x, alpha if name == "rl_integral" else -alpha)
            found.append(np.abs(getattr(comparison, name)(line, f, order) - exact).max())
    for name, (coarse, middle, fine) in errors.items():
        assert np.log2(coarse / middle) == pytest.approx(2.0, abs=0.1), name
        assert np.log2(middle / fine) == pytest.approx(2.0, abs=0.1), name


def test_a_variable_order_has_its_own_slope_in_the_derivative():
    """d/dx of I^(1-alpha(x)) x^2 by central differences of the closed form."""
    line = ParticleLine(0.0, 1.0, 401)

    def order(x: np.ndarray) -> np.ndarray:
        return 0.5 + 0.2 * np.sin(2.0 * x)

    def integral(x: np.ndarray) -> np.ndarray:
        return of_a_power(2.0, x, 1.0 - order(x))

    x = line.x[20:]
    exact = (integral(x + 1e-5) - integral(x - 1e-5)) / 2e-5
    found = comparison.rl_derivative(line, line.x_all**2, order(line.x_all))[20:]
    assert found == pytest.approx(exact, rel=1e-4)


def of_a_wave(name: str, x: np.ndarray, k: float, phase: float, alpha: float) -> np.ndarray:
    """The operator of sin(k x + phase) by Gauss-Jacobi quadrature, which knows the power."""

    def integral(g, power):
        z, weights = roots_jacobi(80, power, 0.0)
        return (0.5 * x) ** (1.0 + power) * (g(0.5 * x[:, None] * (1.0 + z)) @ weights)

    if name == "integral":
        return integral(lambda t: np.sin(k * t + phase), alpha - 1.0) / gamma(alpha)
    result = integral(lambda t: k * np.cos(k * t + phase), -alpha) / gamma(1.0 - alpha)
    return (
        result + np.sin(phase) * x**-alpha / gamma(1.0 - alpha)
        if name == "rl" and phase
        else result
    )


RESOLVED = [  # three particles a period, or more
    (count, k)
    for count in (3, 4, 5, 6, 11, 51)
    for k in (0.5, 2.0, 4.0, 5.0, 20.0)
    if k <= 2.0 * (count - 1)
]
WAVES = covering(RESOLVED, [0.0, 0.7], [0.1, 0.5, 0.9], together=2)


@pytest.mark.parametrize("name", list(OPERATORS))
@pytest.mark.parametrize("method", ["standard", "halved", "modified", "completed"])
def test_what_is_wrong_is_warned_of_and_what_is_right_is_not(name, method):
    """Waves from one that 51 particles see as a line to one with three particles a period.

    Of three to five particles the comparison on these alone was silent about a fifth, and warned of what is right.
    """
    warned = right = 0
    for (count, k), phase, alpha in WAVES:
        line = ParticleLine(0.0, 1.0, count)
        with np.errstate(divide="ignore"):
            exact = of_a_wave(name, line.x, k, phase, alpha)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", AccuracyWarning)
            found = OPERATORS[name](line, np.sin(k * line.x_all + phase), alpha, method=method).real
        finite = np.isfinite(exact)
        error = np.abs(found[finite] - exact[finite]).max() / np.abs(exact[finite]).max()
        if error > 0.1:  # twice the limit
            assert caught, (count, k, phase, alpha, error)
            warned += 1
        if error < 0.025:  # half of it
            assert not caught, (count, k, phase, alpha, error, str(caught[0].message))
            right += 1
    assert warned > 2
    assert right > 2
