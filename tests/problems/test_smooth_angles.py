"""An array on a disc of few angles: what is a short wave of the angle, and what is rough."""

from __future__ import annotations

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.problems.interpolants import holds_no_short_waves

ANGLES = (8, 12, 32)


@pytest.mark.parametrize("angles", ANGLES)
def test_waves_of_four_spacings_and_more_are_smooth_and_corners_and_jumps_are_not(angles):
    theta = 2.0 * np.pi * np.arange(angles) / angles
    waves = 1.0 + sum(np.cos(k * theta + k) / k for k in range(1, angles // 4 + 1))
    assert holds_no_short_waves(waves[None], 1)
    for rough in (np.cos((angles // 4 + 1) * theta), np.abs(theta - np.pi), theta > np.pi):
        assert not holds_no_short_waves(waves[None] + rough, 1)


def test_eight_angles_tell_the_error_of_a_wave_that_they_hold():
    """Of cos 2 theta the cubic through eight angles misses a third: ten times the error of the function was said."""

    def wave(x, y):
        return (1.0 - x * x - y * y) * (1.0 + x * x - y * y + 0.5 * x)

    problem = fp.Problem(
        alpha=1.5,
        domain="disc",
        dim=2,
        half_width=1.0,
        exterior="absorbing",
        particles=16,
        t_final=0.1,
    )
    disc = problem.bounded_domain
    assert disc.volumes.shape == (16, 8)
    array, function = (
        float(fp.solve_problem(problem, u0).space_error)
        for u0 in (disc.values("initial", wave), wave)
    )
    # Along the rings both are the same cubic, up to its own error: a tenth of h^4 / h^(4 - alpha).
    assert array == pytest.approx(function, rel=0.1)
