"""Values outside an interval in closed form; and what is not resolved, outside or at the start, warns."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.special import betainc

from fracparticles.bounded.interval import Interval
from fracparticles.errors import AccuracyWarning


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_one_on_one_side_gives_the_probability_of_leaving_there(alpha):
    """I_((1+x)/2)(alpha/2, alpha/2) of the stable process from x (Blumenthal, Getoor & Ray 1961)."""
    line = Interval(alpha=alpha, particles=200, exterior="given")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        u = line.stationary(outside=lambda y: np.where(y > 0.0, 1.0, 0.0))
    exact = betainc(0.5 * alpha, 0.5 * alpha, 0.5 * line._unit.left)
    assert u == pytest.approx(exact, abs=1e-7)


@pytest.mark.parametrize("g", [np.cos, lambda y: np.where(np.abs(y - 1.5) < 0.4, 1.0, 0.0)])
def test_values_that_swing_for_ever_or_jump_warn(g):
    line = Interval(alpha=1.5, particles=50, exterior="given")
    with pytest.warns(AccuracyWarning, match="not smooth"):
        line.stationary(outside=g)


def test_smooth_values_do_not_warn():
    line = Interval(alpha=1.5, particles=50, exterior="given")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        line.stationary(outside=lambda y: 1.0 / (1.0 + y * y))
        line.stationary(outside=0.0)


@pytest.mark.parametrize("particles", [50, 100, 200])
def test_a_start_that_falls_between_the_particles_warns(particles):
    """A bell of width 0.005 has none, one or two particles."""
    line = Interval(alpha=1.5, particles=particles, exterior="reflecting")
    with pytest.warns(AccuracyWarning, match="do not resolve the initial data"):
        line.evolve(lambda x: np.exp(-(((x - 0.1) / 0.005) ** 2)), 0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        line.evolve(lambda x: np.exp(-(((x - 0.1) / 0.2) ** 2)), 0.1)
