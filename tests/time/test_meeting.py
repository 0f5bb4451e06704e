"""What a fit of the tail leaves open beyond the lattice: the integrals of its terms outside a square."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fracparticles.time.meeting import Meeting
from fracparticles.time.multipoles import HARMONICS, terms_of, values_of

ALPHA = 1.5
TERMS = terms_of(np.array([1.0, 2.0, 3.0]) * ALPHA, 2)
POINTS, LATTICE = 64, 32


@pytest.fixture(scope="module")
def meeting() -> Meeting:
    x = (np.arange(POINTS) - POINTS // 2) / POINTS
    inside = (slice(POINTS // 2 - LATTICE // 2, POINTS // 2 + LATTICE // 2 + 1),) * 2
    return Meeting(TERMS, x, np.where(x == -0.5, 0.0, x), inside, outer=True)


@pytest.mark.parametrize("moment", [h for h in HARMONICS[2] if h.degree < 2])
def test_each_term_counts_beyond_a_square(meeting, moment):
    """In polar coordinates a term of the degree s is s-homogeneous: r^(s+1) dr is integrated by hand.

    An eighth of the circle at a time the rest is smooth, and 32 nodes are exact to round-off. Beyond a circle the terms
    of l = 3 have no first moment, and those of l = 4 no integral: they were left out.
    """
    nodes, weights = np.polynomial.legendre.leggauss(32)
    angle = 0.25 * np.pi * (np.arange(8)[:, None] + 0.5 * (1.0 + nodes)).ravel()
    weight = np.tile(0.125 * np.pi * weights, 8)
    way = np.array([np.cos(angle), np.sin(angle)])
    edge = 0.5 * LATTICE / POINTS / np.abs(way).max(axis=0)
    degrees = np.array([moment.degree - 2.0 - gamma - h.degree for h, gamma in TERMS])
    f = moment.moment_at(0, way) * values_of(TERMS, way, way)
    outside = (f * edge ** (degrees[:, None] + 2.0)) @ weight / -(degrees + 2.0)
    found = meeting._beyond(moment)
    # The library has 16 nodes on an edge; the pole of order up to 4 leaves (1 + 2^(1/2))^-32 32^4 of it.
    assert_allclose(found, outside, rtol=1e-6, atol=1e-12 * np.abs(outside).max())
    high = [v for (h, _), v in zip(TERMS, found, strict=True) if h.degree == 4 - moment.degree]
    assert np.abs(high).max() > 0.01 * np.abs(outside).max()
