"""Two blobs: what is said to be exact solves its equation."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.special.stable import green_rate
from fracstudy.blobs import Blobs

X, T = np.array([-3.0, -0.1, 0.02, 0.3, 15.0, 18.0, 19.5, 60.0]), 0.9
STEP = 1e-4  # of central differences, whose error is its square times a third derivative


@pytest.fixture(params=[1.1, 1.9])
def blobs(request):
    return Blobs(request.param, (0.1, 1.0))


def spread(blobs, ages, places):
    """-(-Laplacian)^(alpha/2) of both, by the slope of the fundamental solution."""
    return sum(0.5 * green_rate(x, t, blobs.alpha) for x, t in zip(places, ages, strict=True))


def slope(f, at):
    return (f(at + STEP) - f(at - STEP)) / (2.0 * STEP)


def test_blobs_spread(blobs):
    ages = [width**blobs.alpha + T for width in blobs.widths]
    found = slope(lambda t: blobs(X, t), T)
    assert found == pytest.approx(spread(blobs, ages, (X, X - 50.0)), abs=1e-7)
    assert blobs(X, T, (0,)) + blobs(X, T, (1,)) == pytest.approx(blobs(X, T), rel=1e-15)


def test_blobs_are_drawn_together(blobs):
    """u_t = (x u)_x + the diffusion."""
    past, shrunk = (1.0 - np.exp(-blobs.alpha * T)) / blobs.alpha, np.exp(-blobs.alpha * T)
    ages = [width**blobs.alpha * shrunk + past for width in blobs.widths]
    diffusion = spread(blobs, ages, (X, X - 50.0 * np.exp(-T)))
    carried = slope(lambda x: x * blobs.drawn_together(x, T), X)
    found = slope(lambda t: blobs.drawn_together(X, t), T)
    # The third derivative in time is 20^3 that in x where the second blob passes with a speed of 20: h^2 / 6 of it.
    assert found == pytest.approx(carried + diffusion, abs=2e-5)


def test_blobs_compete(blobs):
    """u_t = the diffusion + f(x, t, u); of another u, f is quadratic."""
    ages, u = [width**blobs.alpha + T for width in blobs.widths], blobs.competing(X, T)
    diffusion = np.exp(-T) * spread(blobs, ages, (X, X - 50.0))
    source = blobs.competition(X, T, u)
    found = slope(lambda t: blobs.competing(X, t), T)
    assert found == pytest.approx(diffusion + source, abs=1e-7)
    assert blobs.competition(X, T, 2.0 * u) == pytest.approx(-2.0 * u - 20.0 * u * u, rel=1e-12)
