"""Periodic images of powers: against sums over many images, exact constants, and the transform of a power."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from scipy.special import zeta

from fracparticles.special.images import (
    image_series,
    image_sum,
    outside_integrals,
    power_transform,
    series_derivatives,
    square_basis,
)

EXPONENTS = [1.1, 1.5, 1.9, 2.2, 3.3]


def outside_integral(exponent: float, dim: int) -> float:
    """That of |x|^(-n-gamma)."""
    power = -dim - exponent
    return float(outside_integrals(lambda x: (x * x).sum(axis=0) ** (0.5 * power), power, dim))


def direct_sum(x: np.ndarray, exponent: float, count: int) -> float:
    """All images with |m|_inf <= count, and the integral beyond: the error is that of the midpoint rule there."""
    lines = [np.square(np.arange(-count, count + 1.0) + part) for part in x]
    square = sum(np.meshgrid(*lines, indexing="ij", sparse=True)).ravel()
    others = np.delete(square, square.size // 2)
    power = -0.5 * (x.size + exponent)
    beyond = outside_integral(exponent, x.size) * (2.0 * count + 1.0) ** -exponent
    return float((others**power).sum() + beyond)


@pytest.mark.parametrize("exponent", EXPONENTS)
@pytest.mark.parametrize(("dim", "count"), [(1, 20000), (2, 300), (3, 40)])
def test_the_sum_is_that_of_the_images(dim, count, exponent):
    """Beyond the cube by the midpoint rule: its error is some s^2 / 24 (2 count)^-2 of what is there."""
    x = np.array([0.31, -0.45, 0.12])[:dim]
    expected = direct_sum(x, exponent, count)
    s = dim + exponent
    beyond = outside_integral(exponent, dim) * (2.0 * count) ** -exponent
    bound = 4.0 * s * s * beyond / count**2 + 3e-9 * expected
    assert abs(image_sum(x, exponent) - expected) <= bound


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_the_lattice_sum_of_the_plane_at_the_origin_is_a_product_of_zeta_functions(exponent):
    """sum' |m|^-s = 4 zeta(s/2) beta(s/2), Dirichlet's beta by Hurwitz' zeta at 1/4 and 3/4."""
    s = 2.0 + exponent
    beta = 4.0 ** (-0.5 * s) * (mp.zeta(0.5 * s, 0.25) - mp.zeta(0.5 * s, 0.75))
    exact = float(4.0 * mp.zeta(0.5 * s) * beta)
    assert image_sum(np.zeros(2), exponent) == pytest.approx(exact, rel=3e-9)


@pytest.mark.parametrize(("dim", "tolerance"), [(1, 1e-7), (2, 1e-4), (3, 1e-3)])
@pytest.mark.parametrize("exponent", EXPONENTS)
def test_the_series_is_the_sum(dim, exponent, tolerance):
    """The error falls by 14 with each degree: 14^-10, 14^-7 and 14^-6 times what grows with the exponent."""
    rng = np.random.default_rng(dim)
    for x in rng.uniform(-0.5, 0.5, (20, dim)):
        series = image_series(np.array([exponent]), dim)[0]
        for part in x:
            series = np.tensordot(square_basis(np.array([part]), dim)[:, 0], series, axes=(0, 0))
        assert series == pytest.approx(image_sum(x, exponent), rel=tolerance)


def test_derivatives_of_a_series():
    """Of exp(x^2) and x exp(x^2): the series to T_17 is exact to round-off, which a derivative magnifies by 17^2."""
    count, x = 18, np.linspace(-0.5, 0.5, 9)
    series = np.polynomial.chebyshev.chebinterpolate(lambda s: np.exp((s + 1.0) / 8.0), count - 1)
    first, second = series_derivatives(count)

    def value(c):
        return np.polynomial.chebyshev.chebval(8.0 * x * x - 1.0, c)

    assert x * value(first @ series) == pytest.approx(2.0 * x * np.exp(x * x), abs=1e-10)
    assert value(second @ series) == pytest.approx((1.0 + 2.0 * x * x) * np.exp(x * x), rel=1e-10)


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_the_integral_outside_the_cube(dim):
    """What a cube twice as large leaves out is 2^-gamma of it, and the shell between is an integral of its own.

    The singularity is a length of two pieces away from each: twelve nodes leave 1e-13.
    """
    exponent, nodes = 1.4, np.polynomial.legendre.leggauss(12)
    x = np.concatenate([0.25 * (nodes[0] + c) for c in (-3.0, -1.0, 1.0, 3.0)])
    weights = np.tile(0.25 * nodes[1], 4)
    square = sum(np.meshgrid(*(x * x,) * dim, indexing="ij", sparse=True))
    inside = np.meshgrid(*(np.abs(x) < 0.5,) * dim, indexing="ij", sparse=True)
    values = np.where(
        np.logical_and.reduce(np.broadcast_arrays(*inside)),
        0.0,
        square ** (-0.5 * (dim + exponent)),
    )
    for _ in range(dim):
        values = values @ weights
    assert outside_integral(exponent, dim) * (1.0 - 2.0**-exponent) == pytest.approx(
        values, rel=1e-6
    )


def test_the_finite_part_on_the_line():
    """int_{|x|>1/2} |x|^(-1-gamma) dx, and its continuation to gamma < 0."""
    assert outside_integral(1.5, 1) == pytest.approx(2.0 * 0.5**-1.5 / 1.5)
    assert outside_integral(-0.5, 1) == pytest.approx(-2.0 * 0.5**0.5 / 0.5)


def test_the_transform_of_a_power_on_the_line():
    """1 / (1 + x^2) has the transform pi (1 - |k| + ..), and falls like |x|^-2: kappa(1) = -1 / pi."""
    assert power_transform(np.array([1.0]), 1)[0] == pytest.approx(-1.0 / np.pi)
    alpha = 1.5
    constant = -np.sin(0.5 * np.pi * alpha) * float(mp.gamma(1.0 + alpha)) / np.pi
    assert power_transform(np.array([alpha]), 1)[0] == pytest.approx(constant)


def test_on_the_line_they_are_hurwitz_zeta_functions():
    x = np.linspace(-0.5, 0.5, 11)
    assert image_sum(x[:, None], 1.5) == pytest.approx(zeta(2.5, 1.0 + x) + zeta(2.5, 1.0 - x))
