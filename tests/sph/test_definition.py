"""The definition of the fractional integral, by quadrature."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.special import gamma

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.sph.closed_forms import Cosine
from fracparticles.sph.definition import defining_integral


def test_the_defining_integral_of_a_power():
    # I^alpha x^2 = 2 x^(2+alpha) / Gamma(3+alpha); Gamma(3.5) = 15 sqrt(pi) / 8.
    x = np.array([0.5, 2.0])
    ours = defining_integral(lambda t: t * t, x, np.full(2, 0.5))
    assert ours == pytest.approx(16.0 * x**2.5 / (15.0 * np.sqrt(np.pi)), rel=1e-13)


@pytest.mark.parametrize("alpha", [1e-12, 1e-8, 0.5, 150.0])
def test_orders_next_to_zero_and_far_from_it(alpha):
    """I^alpha 1 = x^alpha / Gamma(1 + alpha): for alpha = 1e-8 the weights alone were off by 6e-9."""
    x = np.array([0.5, 2.0])
    ours = defining_integral(np.ones_like, x, np.full(2, alpha))
    assert ours == pytest.approx(x**alpha / gamma(1.0 + alpha), rel=1e-13)


@pytest.mark.parametrize(
    ("f", "x", "alpha"),
    [
        (np.cos, [-1.0], [0.5]), (np.cos, [1.0], [0.0]), (np.cos, [1.0, 2.0], [0.5]),
        (np.cos, [1.0], [1e-14]), (np.cos, [1.0], [1e6]), (np.cos, [1e100], [100.0]),
        (lambda x: np.inf * x, [1.0], [0.5]), (lambda x: 1.0, [1.0], [0.5]), (1.0, [1.0], [0.5]),
    ],
)  # fmt: skip
def test_what_is_refused(f, x, alpha):
    with pytest.raises(InvalidInput):
        defining_integral(f, x, alpha)


def test_waves_that_the_nodes_do_not_resolve_are_told():
    """cos 200 x has 64 half waves from 0 to 1: forty nodes give five times too much, four times as many are right."""
    exact = float(Cosine(200.0).rl([1.0], -0.5)[0])
    with pytest.warns(AccuracyWarning, match="do not resolve"):
        few = defining_integral(lambda x: np.cos(200.0 * x), [1.0], [0.5])
    assert abs(few[0]) > 5.0 * abs(exact)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        many = defining_integral(lambda x: np.cos(200.0 * x), [1.0], [0.5], nodes=160)
    assert many[0] == pytest.approx(exact, rel=1e-9)
