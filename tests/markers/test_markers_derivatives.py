"""What the gaps between the markers leave on even derivatives: against the sums, and a soliton that goes wrong."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning
from fracparticles.markers import SHAPES, MarkerVelocity, diffusion, run, uniform
from fracparticles.markers.derivatives import flux_ripple
from fracparticles.markers.kdv import Soliton, kdv
from sweeps import covering


def with_second_derivative(x, fields):
    """A flux of the size 1000, that is known."""
    return fields[2] + 1000.0


def ripple_of(velocity, d):
    """F'' of F = 1 on a lattice, which should be 0, by the sums; and what is said of it."""
    x = d * np.arange(-60, 61.0)
    w = np.full(x.size, d)
    seen = float(np.abs(velocity.fields(x, w)[2][40:-40]).max())  # 20 particles are two epsilon
    return seen, 1000.0 * flux_ripple(velocity, x, w)


@pytest.mark.parametrize(("shape", "per_epsilon"), covering(["S4", "S6"], [3.3, 5.7, 9.2]))
def test_on_a_lattice_the_ripple_is_that_of_the_sums(shape, per_epsilon):
    """No less than half of it, and no more than twice what closer markers have, whose waves are shorter."""
    velocity = MarkerVelocity(SHAPES[shape], 0.7, with_second_derivative, 2)
    seen, said = ripple_of(velocity, 0.7 / per_epsilon)
    closer = [ripple_of(velocity, 0.7 / (per_epsilon + k / 20.0))[0] for k in range(21)]
    assert 0.5 * seen <= said <= 2.0 * max(closer)


def test_a_flux_without_even_derivatives_has_none():
    x, w = uniform(lambda x: np.exp(-x * x), (-3.0, 3.0), 50)
    assert flux_ripple(MarkerVelocity(SHAPES["S4"], 0.3, diffusion, 1), x, w) == 0.0


@pytest.mark.parametrize(("shape", "warned"), [("S4", True), ("S8", False)])
def test_a_soliton_on_a_shape_with_a_bent_second_derivative_is_warned_of(shape, warned):
    """S4'' jumps at the ends of its support: F is right to three digits at the start, and the run is off by a third."""
    soliton, steps = Soliton(1.0, 0.5), 200
    x, w = uniform(lambda x: soliton.value(x, 0.0), (-10.0, 10.0), 400)
    velocity = MarkerVelocity(SHAPES[shape], 0.4, kdv, 2)
    inner = slice(80, -80)
    assert np.abs(velocity.fields(x, w)[0] - soliton.value(x, 0.0))[inner].max() < 0.003
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        end = run(x, w, velocity, dt=1e-3, steps=steps if warned else 20)
    told = [str(one.message) for one in caught if one.category is AccuracyWarning]
    error = np.abs(end.field() - soliton.value(end.x, 1e-3 * (steps if warned else 20)))[
        inner
    ].max()
    assert any("on the derivatives of F" in text for text in told) == warned
    assert (error > 0.1) == warned
