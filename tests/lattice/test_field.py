"""The field (7) of strengths on a lattice."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.lattice.field import smoothed_field


@pytest.mark.parametrize("dim", [1, 2])
def test_the_field_of_a_gaussian_is_the_wider_gaussian(dim):
    s, h, width = 2.0, 0.1, 0.6
    x = np.arange(-50, 51) * h
    r2 = x**2 if dim == 1 else x[:, None] ** 2 + x**2
    total = width**2 + (s * h) ** 2
    # Lattice sums of Gaussians this wide are integrals up to exp(-(pi width / h)^2) = 0.
    expected = (width**2 / total) ** (0.5 * dim) * np.exp(-r2 / total)
    field = smoothed_field(np.exp(-r2 / width**2), s)
    middle = (slice(30, 71),) * dim  # within reach of the particles
    np.testing.assert_allclose(field[middle], expected[middle], atol=1e-15)
