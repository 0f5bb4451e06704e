"""The Fickian limit, on small lattices."""

from __future__ import annotations

from math import gamma, log, pi, sqrt

import numpy as np
import pytest

from fracparticles.kernels.families import kernel
from fracparticles.special.ends import heat_kernel
from fracstudy.inputs import Inputs
from scenes.lucchesi.fickian_limit.figure import figure
from scenes.lucchesi.fickian_limit.study import (
    decade_moments,
    fickian_error,
    kernel_distance,
    study,
)


def test_second_order_error_of_the_fickian_sum():
    """The leading error: the symbol is -k^2 (1 - (epsilon k)^2 / 8), so u gains (1/8) epsilon^2 T u_xxxx."""
    h, t = 0.05, 1.5
    x = np.linspace(-5.0 * 2.0 / sqrt(pi), 5.0 * 2.0 / sqrt(pi), 4001)
    z = x * x / (2.0 * t)
    fourth = heat_kernel(x, t) * (3.0 - 6.0 * z + z * z) / (4.0 * t * t)
    leading = (2.0 * h) ** 2 / 8.0 * 1.0 * np.abs(fourth).sum() * (x[1] - x[0])
    # The next terms are smaller by epsilon^2 k^2, with k of order 1: 1 %.
    assert fickian_error(15.0, h, 2, 2.0, 0.5, t) == pytest.approx(leading, rel=0.02)


def test_fickian_order_four():
    errors = [fickian_error(15.0, h, 4, 2.0, 0.5, 1.5) for h in (0.2, 0.1)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.1)


def test_moments_in_closed_form():
    """Mass and first moment: K^(0) = 2^beta Gamma(alpha/2) and 2 kappa(0), since r K = -kappa'."""
    alpha = 1.9
    beyond = 1e6 ** (1.0 - alpha)  # the first moment leaves out a share of that order
    inside = 2e-2 * kernel("K", 0.0, alpha)  # int over |r| < 1e-2 of the mass
    mass = decade_moments("K", alpha, 0).sum() + inside
    assert mass == pytest.approx(2.0 ** (alpha - 1.0) * gamma(alpha / 2.0), rel=1e-5)
    first = decade_moments("K", alpha, 1).sum() + 1e-4 * kernel("K", 0.0, alpha)
    assert first == pytest.approx(2.0 * kernel("kappa", 0.0, alpha), rel=beyond)
    assert decade_moments("Phi", 1.5, 2).sum() == pytest.approx(1.0, abs=1e-5)


def test_distance_of_the_kernels_is_of_first_order():
    ratio = kernel_distance(1.99) / kernel_distance(1.999)
    assert log(ratio) / log(10.0) == pytest.approx(1.0, abs=0.01)


def test_fickian_limit(computed):
    lattice = {"half_width": 15.0, "spacing": [0.2, 0.1], "overlap": 2.0, "exterior": "open"}
    block = {"scheme": "KPSE", "order": [2, 4], "beta": [0.9, 0.99], **lattice}
    files = computed([{**block, "integrator": "exponential", "store": "metrics"}])
    result = study(Inputs("fickian_limit", ["L-C17"], runs=files))
    assert list(result.table["alpha"]) == [1.9, 1.99, 2.0]
    found = {finding.claim: finding.numbers for finding in result.findings}
    assert max(found["L-C17.single_expression"]["difference"].values()) < 0.1
    phi = found["L-C17.phi_moments"]
    assert max(phi["beyond"].values()) == 0.0
    # Between 0 and 0.01 the mass is that of a constant but for the share r^2 / 3 of 1 %.
    assert max(phi["exact"].values()) < 1e-6
    moments = found["L-C17.K_moments"]
    assert max(moments["first"].values()) < 1.0 < min(moments["second"].values())
    singular = found["L-C17.singular_limit"]
    np.testing.assert_allclose(singular["order"], 1.0, atol=0.05)
    assert min(singular["growth"].values()) > 0.0 == singular["at_two"]
    figure(result.series).draw_without_rendering()
