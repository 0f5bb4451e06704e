"""The measured growth of perturbations, and the largest stable step, against the Fourier transforms."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.markers import SHAPES
from fracparticles.markers.growth import largest_step, measured_rate
from fracparticles.markers.stability import extremes

WAVE = {"spacing": 0.25, "period": 16.0, "amplitude": 1e-6}


@pytest.mark.parametrize("epsilon", [1.0, 0.3])
def test_measured_rates_are_the_predicted_ones(epsilon):
    k, growth = measured_rate(SHAPES["S8"], 4, **WAVE, steps=4, epsilon=epsilon)
    # -k^2 S^ of S8; the midpoint rule errs by (rate dt)^2 / 6 relative.
    expected = -k * k * (1.0 + 0.25 * k * k) * np.exp(-0.25 * k * k)
    assert growth == pytest.approx(expected, rel=(expected * 0.005) ** 2)


def test_the_largest_step_is_that_of_the_transform():
    # 12 halvings of [0.05, 2]: 5e-4.
    assert largest_step(SHAPES["S8"]) == pytest.approx(0.5952649, abs=5e-4)
    assert largest_step(SHAPES["S4"], 0.3) == pytest.approx(extremes(SHAPES["S4"]).eta, rel=3e-3)


def test_all_markers_moved_alike_stay_so():
    """A wave of one marker's length is none."""
    _, rate = measured_rate(SHAPES["S8"], 64, **WAVE, steps=4)
    assert abs(rate) < 1e-6


@pytest.mark.parametrize("name", ["S2", "S3"])
def test_no_limit_within_the_range_is_said(name):
    with pytest.raises(InvalidInput, match="a limit between"):
        largest_step(SHAPES[name])


@pytest.mark.parametrize(
    ("shape", "changes"),
    [
        ("S8", {"amplitude": 0.0}),
        ("S8", {"period": np.nan}),
        ("S8", {"mode": 65}),
        ("S1", {}),
        ("S8", {"amplitude": 1e-100}),
        ("S8", {"mode": 32}),  # cos(pi (j + 1/2)) = 0
    ],
)
def test_what_cannot_be_is_refused(shape, changes):
    with pytest.raises(InvalidInput):
        measured_rate(SHAPES[shape], **{"mode": 4, **WAVE, **changes})
