"""Clusters of known places, and what tells them from order."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.markers.clusters import cluster_centres, emptiness, marker_spectrum


def test_clusters_of_known_places():
    centres = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    x = (centres[:, None] + 0.01 * np.array([-1.0, 0.0, 1.0])).ravel()
    assert cluster_centres(x, 0.2, 3.0) == pytest.approx(centres, abs=1e-14)
    # The gaps: 4 of 0.98 between the clusters, 0.99 at each end of 6.
    assert emptiness(x, 0.2, 3.0) == pytest.approx((4 * 0.98 + 2 * 0.99) / 6.0, rel=1e-12)
    assert emptiness(np.linspace(-3.0, 3.0, 100), 0.2, 3.0) == 0.0
    assert cluster_centres(np.array([0.0, 1.0, 2.0]), 0.2, 3.0).size == 0


def test_the_spectrum_tells_clusters_from_order():
    q = np.linspace(3.0, 12.0, 91)
    clusters = np.repeat(np.arange(-8.0, 9.0), 5)
    peak = q[np.argmax(marker_spectrum(clusters, q, 8.0))]
    assert peak == pytest.approx(2.0 * np.pi, abs=0.1)  # the step of q
    even = np.linspace(-8.0, 8.0, 801)
    # sin(q w) / q terms of a smooth window: far below 1 once q times its width is large.
    assert marker_spectrum(even, q, 8.0).max() < 1e-3


def test_a_spectrum_needs_markers():
    with pytest.raises(InvalidInput, match="with markers"):
        marker_spectrum(np.array([5.0]), np.ones(1), 1.0)


@pytest.mark.parametrize("function", [cluster_centres, emptiness])
@pytest.mark.parametrize("lengths", [(0.0, 3.0), (0.2, np.nan)])
def test_lengths_are_positive(function, lengths):
    with pytest.raises(InvalidInput):
        function(np.arange(3.0), *lengths)
