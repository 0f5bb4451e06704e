"""The moments of a decay, which the exponential integrator is made of, against mpmath."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from fracparticles.bounded.exponential import moments_of_decay


@pytest.mark.parametrize("z", [0.0, 1e-300, 1e-9, 0.3, 1.0, 1.0 + 1e-12, 1.5, 7.0, 300.0, 1e12])
def test_the_moments_are_the_integrals(z):
    """Of the closed forms at z = 1 terms of the size of 2 cancel to 0.16: some 13 ulp."""
    with mp.workdps(40):
        exact = [float(mp.hyp1f1(m + 1, m + 2, -mp.mpf(z)) / (m + 1)) for m in range(3)]
    found = moments_of_decay(np.array([[z]]), 2)[:, 0, 0]
    assert found == pytest.approx(exact, rel=16 * np.finfo(float).eps)
