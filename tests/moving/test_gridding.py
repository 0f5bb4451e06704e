"""The window of the non-uniform transforms against its definition."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.moving.gridding import (
    WIDTH,
    interpolate,
    spread,
    window,
    window_transform,
    window_weights,
)
from fracparticles.moving.polynomials import fitted, horner

POSITIONS = 20.0 + np.random.default_rng(0).uniform(0.0, 30.0, 53)


def integral(k):
    """phi^ by a Gauss rule."""
    nodes, weights = np.polynomial.legendre.leggauss(400)
    half = 0.5 * WIDTH
    return np.cos(np.outer(k, half * nodes)) @ (window(half * nodes) * weights) * half


def test_the_transform_of_the_window():
    k = np.linspace(0.0, np.pi, 11)
    assert window_transform(k) == pytest.approx(integral(k), rel=1e-12)


def test_aliases_under_a_gaussian():
    k = np.linspace(0.0, np.pi, 50)
    aliases = sum(np.abs(integral(k + 2.0 * np.pi * m)) for m in (-2, -1, 1, 2))
    assert (np.exp(-((12.0 * k / np.pi) ** 2) / 4.0) * aliases / integral(k)).max() < 2e-13


def test_the_weights_are_those_of_the_window():
    cell = np.concatenate([POSITIONS, [30.0, 31.0, 30.5, np.nextafter(30.0, 31.0)]])
    first, weights = window_weights(cell)
    distance = first[:, None] + np.arange(WIDTH) - cell[:, None]
    assert np.abs(distance).max() <= 0.5 * WIDTH
    assert weights == pytest.approx(window(distance), abs=5e-15)


def test_spreading_is_its_definition_and_interpolation_its_transpose():
    generator = np.random.default_rng(1)
    q, values = generator.standard_normal(POSITIONS.size), generator.standard_normal(80)
    places = window_weights(POSITIONS)
    lattice, both = np.full(80, np.nan), np.empty((2, POSITIONS.size))
    spread(*places, q, lattice)
    interpolate(*places, np.stack([np.ones(80), values]), both)
    y = both[1]
    distance = POSITIONS[:, None] - np.arange(80)
    matrix = np.where(np.abs(distance) < 0.5 * WIDTH, window(distance), 0.0)
    assert lattice == pytest.approx(q @ matrix, abs=1e-13)
    assert y == pytest.approx(matrix @ values, abs=1e-13)
    assert both[0] == pytest.approx(matrix.sum(axis=1), abs=1e-13)
    assert lattice @ values == pytest.approx(q @ y, rel=1e-12)


def test_a_smooth_function_as_two_polynomials():
    even, odd = fitted(lambda y: np.stack([np.exp(y), np.sin(y)], axis=1))
    y = 0.3
    for k, exact in enumerate((np.exp(y), np.sin(y))):
        value = horner(even[k], y * y) + y * horner(odd[k], y * y)
        assert value == pytest.approx(exact, rel=1e-14)
