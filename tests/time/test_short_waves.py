"""What a lattice does not hold: from the data and from their transform it is the same, and it is what it says."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.fft import rfft, rfftn

from fracparticles.time.short_waves import unresolved, unresolved_of


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("points", [9, 16])
def test_the_spectrum_says_what_the_data_say(dim, points):
    u = np.random.default_rng(dim).standard_normal((3, *(points,) * dim))
    axes = tuple(range(1, dim + 1))
    assert unresolved_of(rfftn(u, axes=axes), dim) == pytest.approx(unresolved(u), rel=1e-12)
    alone = max(unresolved_of(rfftn(one), dim) for one in u)
    assert alone == pytest.approx(unresolved(u), rel=1e-12)


@pytest.mark.parametrize("dim", [1, 2])
def test_a_spectrum_that_falls_like_an_exponential_is_continued(dim):
    """u^ = exp(-q |k|) along each axis: of the waves from 0.8 K on the first is the greatest, and it is squared."""
    points, q = 101, 0.05
    line = np.fft.irfft(np.exp(-q * np.arange(points // 2 + 1)), points)
    u = line if dim == 1 else np.multiply.outer(line, line)
    expected = 2.0 * dim * np.exp(-2.0 * q * int(0.8 * (points // 2)))
    assert unresolved(u[None]) == pytest.approx(expected, rel=1e-9)


def test_nothing_lacks_nothing_and_one_point_lacks_all():
    assert unresolved(np.zeros((2, 16))) == 0.0
    assert unresolved_of(rfft(np.zeros(16)), 1) == 0.0
    assert unresolved(np.eye(16)[:1]) == 1.0
