"""1F1(a; b; -z) against mpmath, closed forms, and what must be refused."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from scipy.special import erf, i0e

from fracparticles.errors import InvalidInput
from fracparticles.special import kummer, kummer_order_four, kummer_transformed

# Horner's rule with 18 coefficients, or a sum of at most 40 terms and one power: about 40 roundings
# of 1.1e-16, doubled where the power z^-a (|a log z| up to 90) adds its own.
TOLERANCE = 1e-14

Z = np.concatenate(
    [
        [0.0, 1e-300, 1e-8, 0.3, 1.0, 1.9999999, 2.0],
        np.linspace(3.1, 63.9, 23),
        [np.nextafter(64.0, 0.0), 64.0, 65.3, 127.9, 128.0, 1e3, 1e6, 1e10, 1e16],
    ]
)
ALPHAS = (1.001, 1.1, 1.5, 1.9, 1.999, 1.9999999)
# (b - a, b) of kappa, of F and K, and of G, with n the number of dimensions.
KERNEL_PARAMETERS = {
    "kappa": lambda alpha, n: (0.5 * (2.0 - alpha), 0.5 * n),
    "F": lambda alpha, n: (0.5 * (2.0 - alpha), 0.5 * n + 1.0),
    "G": lambda alpha, n: (-0.5 * alpha, 0.5 * n),
}


def exact(c: float, b: float, z: float) -> mp.mpf:
    with mp.workdps(40):
        return mp.hyp1f1(mp.mpf(b) - mp.mpf(c), mp.mpf(b), -mp.mpf(z))


def envelope(c: float, value: mp.mpf, z: float) -> mp.mpf:
    """Size of the larger of the two parts whose difference has a zero if c < 0."""
    with mp.workdps(40):
        core = mp.exp(-mp.mpf(z))
        return max(core, abs(value - core)) if c < 0 else abs(value)


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("name", KERNEL_PARAMETERS)
def test_agrees_with_mpmath(name, alpha, n):
    c, b = KERNEL_PARAMETERS[name](alpha, n)
    value = kummer_transformed(c, b, Z)
    for z, v in zip(Z, value, strict=True):
        reference = exact(c, b, z)
        assert abs(v - reference) <= TOLERANCE * envelope(c, reference, z)


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("name", KERNEL_PARAMETERS)
def test_order_four_is_the_difference_of_two_gaussians(name, alpha):
    c, b = KERNEL_PARAMETERS[name](alpha, 1)
    value = kummer_order_four(c, b, Z)
    with mp.workdps(40):
        weight = mp.mpf(2) ** (mp.mpf(c) - mp.mpf(b))
        for z, v in zip(Z, value, strict=True):
            wide, narrow = exact(c, b, 0.5 * z), exact(c, b, z)
            size = 2 * envelope(c, narrow, z) + weight * envelope(c, wide, 0.5 * z)
            assert abs(v - (2 * narrow - weight * wide)) <= TOLERANCE * size


def test_closed_forms():
    z = np.linspace(0.01, 200.0, 3001)
    root = np.sqrt(z)
    # Both sides carry a few roundings each.
    np.testing.assert_allclose(
        kummer(0.5, 1.5, z), 0.5 * np.sqrt(np.pi) * erf(root) / root, rtol=TOLERANCE
    )
    np.testing.assert_allclose(kummer(0.5, 1.0, z), i0e(0.5 * z), rtol=TOLERANCE)


def test_shapes_and_types():
    assert type(kummer(0.75, 0.5, 1)) is float
    assert type(kummer(0.75, 0.5, np.array(1.0))) is float
    assert kummer(0.75, 0.5, []).shape == (0,)
    z = np.arange(24.0).reshape(2, 3, 4)
    assert kummer(0.75, 0.5, z).shape == z.shape
    np.testing.assert_array_equal(kummer(0.75, 0.5, z[:, ::2].T), kummer(0.75, 0.5, z)[:, ::2].T)
    assert kummer(0.75, 0.5, np.float32([1.0])).dtype == np.float64


def test_no_overflow():
    assert kummer(0.75, 0.5, np.inf) == 0.0
    assert kummer(2.4, 1.5, 1e300) == 0.0  # 1e-720
    assert 0.0 < kummer(0.25, 0.5, 1e308) < 1e-76


@pytest.mark.parametrize(
    ("a", "b", "z"),
    [
        (0.5, 0.5, 1.0),  # a = b: exp(-z), not a kernel
        (1.6, 0.5, 1.0),  # b - a < -1
        (0.0, 0.5, 1.0),
        (4.5, 4.0, 1.0),
        (0.5, 4.5, 1.0),
        (np.nan, 0.5, 1.0),
        (0.75, 0.5, -1e-9),
        (0.75, 0.5, np.nan),
        (0.75, 0.5, "1"),
        (0.75, 0.5, 1j),
        (0.75, 0.5, None),
        (0.75, 0.5, True),
        (0.75, 0.5, [[1.0], [2.0, 3.0]]),
    ],
)
def test_refuses(a, b, z):
    with pytest.raises(InvalidInput):
        kummer(a, b, z)
