"""Sums over equally spaced particles against those over all pairs, and which sets count as such."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.moving.equally_spaced import EquallySpacedSum, equal_spacing
from fracparticles.moving.remeshing import remesh
from fracparticles.moving.scattered import NaiveScatteredSum, NonuniformFourierSum, smooth_kernel

KERNELS = [smooth_kernel(name, 1.5, 2) for name in ("eta", "F", "K")]


def test_the_convolution_is_the_naive_sum():
    x, h = np.arange(-50, 71) * 0.1 + 3.7, 0.1
    q = np.random.default_rng(0).standard_normal(x.size)
    sums = EquallySpacedSum([k.profile for k in KERNELS], 0.2, h, 130)
    for n in (121, 60, 121):  # fewer than fit, and what the last call left
        out = np.empty((3, n))
        sums.add_to(out, q[:n])
        exact = NaiveScatteredSum(KERNELS, 0.2)(x[:n], q[:n])
        assert np.abs(out - exact).max() < 1e-13 * np.abs(exact).max()
    assert sums.holds(h, 130)
    assert not sums.holds(h, 131)
    assert not sums.holds(h * (1.0 + 1e-12), 130)


@pytest.mark.parametrize("h", [0.1, 0.011173958378129449, 1e7])
def test_what_remeshing_leaves_is_equally_spaced(h):
    x, _ = remesh(np.linspace(-700.3, 1200.2, 2000) * h, np.ones(2000), h, "M4'")
    assert equal_spacing(x) == pytest.approx(h, rel=1e-14)
    assert equal_spacing(x + 0.3 * h) == pytest.approx(h, rel=1e-12)


def test_what_is_not_equally_spaced():
    x = np.arange(100) * 0.1
    one_off, crowded = x.copy(), np.zeros(100)
    one_off[30] += 1e-13
    for other in (x[:31], x[::-1], one_off, crowded, np.delete(x, 20), x + 1e14, 1.0 + 1e-15 * x):
        assert equal_spacing(other) is None


def test_the_transform_takes_either_way():
    """The same sums, whether the particles lie on a lattice or one of them does not, one after the other."""
    x = np.arange(-60, 61) * 0.1
    q = np.random.default_rng(1).standard_normal(x.size)
    fast, slow = NonuniformFourierSum(KERNELS, 0.2), NaiveScatteredSum(KERNELS, 0.2)
    moved = x.copy()
    moved[17] += 0.03
    for points in (x, moved, x, moved[:80], 1.5 * x, x):
        exact = slow(points, q[: points.size])
        error = np.abs(fast(points, q[: points.size]) - exact).max(axis=1)
        assert (error < fast.accuracy * np.abs(exact).max(axis=1)).all()
