"""Sums on square and cubic lattices: the transform against the double loop, and the products along the axes."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.box import BoxConvolution, NaiveBoxConvolution

EPS = np.finfo(float).eps


def some_weights(dim: int, reach: int, seed: int) -> tuple[list[np.ndarray], list[int | None]]:
    """One even weight, and one odd in each coordinate."""
    rng = np.random.default_rng(seed)
    weights = [rng.standard_normal((reach,) * dim) for _ in range(dim + 1)]
    for axis in range(dim):
        np.moveaxis(weights[axis + 1], axis, 0)[0] = 0.0
    return weights, [None, *range(dim)]


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(("sources", "targets"), [(9, 9), (9, 13), (17, 9), (11, 11)])
def test_transform_against_pairs(dim, sources, targets):
    weights, odd = some_weights(dim, (sources + targets) // 2, seed=sources)
    u = np.random.default_rng(1).standard_normal((sources,) * dim)
    fast = BoxConvolution(weights, odd, sources, targets)
    slow = NaiveBoxConvolution(weights, odd, sources, targets)(u)
    # A transform's error is a few log2(L^n) ulp of the root of the sum of squares.
    scale = np.sqrt(np.square(u).sum()) * max(np.sqrt(np.square(w).sum()) for w in weights)
    for _ in range(2):  # the buffers are used again
        assert np.abs(fast(u) - slow).max() <= 20.0 * EPS * 2**dim * scale


@pytest.mark.parametrize("dim", [2, 3])
def test_pairs_against_the_definition(dim):
    weights, odd = some_weights(dim, 5, seed=3)
    u = np.random.default_rng(2).standard_normal((5,) * dim)
    sums = NaiveBoxConvolution(weights, odd, 5, 5)(u)
    i = (3, 0, 4)[:dim]
    for w, axis, ours in zip(weights, odd, sums, strict=True):
        expected = 0.0
        for j in np.ndindex(u.shape):
            offset = np.subtract(i, j)
            sign = 1.0 if axis is None or offset[axis] >= 0 else -1.0
            expected += sign * w[tuple(np.abs(offset))] * u[j]
        assert ours[i] == pytest.approx(expected, abs=1e-13)


def test_the_same_sum_gives_the_same_bytes():
    weights, odd = some_weights(2, 41, seed=5)
    u = np.random.default_rng(3).standard_normal((41, 41))
    first = BoxConvolution(weights, odd, 41, 41)(u).tobytes()
    assert first == BoxConvolution(weights, odd, 41, 41)(u).tobytes()


@pytest.mark.parametrize("parity", [1, -1])
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("extra", [0, 8])
def test_sums_along_an_axis(parity, axis, extra):
    rng = np.random.default_rng(7)
    w = rng.standard_normal(6)
    w[0] *= parity > 0
    v = rng.standard_normal((9, 10, 11))
    count = v.shape[axis] - extra
    ours = BandedConvolution(w, parity).along(v, axis, count)
    whole = np.concatenate([parity * w[:0:-1], w])
    expected = np.apply_along_axis(lambda line: np.convolve(line, whole)[5:-5], axis, v)
    kept = np.moveaxis(expected, axis, 0)[extra // 2 : extra // 2 + count]
    assert np.abs(np.moveaxis(ours, axis, 0) - kept).max() <= 50.0 * EPS * np.abs(w).sum()


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("odd", [None, 0, 1])
def test_a_box_of_one_particle(dim, odd):
    w = np.full((1,) * dim, 0.0 if odd is not None else 2.0)
    (found,) = BoxConvolution([w], [odd], 1, 1)(np.full((1,) * dim, 3.0))
    assert found.flat[0] == pytest.approx(0.0 if odd is not None else 6.0, abs=1e-15)
