"""Round-off of derivatives: the terms are like f / eps^beta, and nearly all of them cancels."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

from fracparticles import pse
from fracparticles.errors import AccuracyWarning

POINTS = slice(30, 131)


def fourth_derivative(h, origin=0.0):
    """That of exp(-x^2) about the origin, its greatest error over 12, and what is said of round-off."""
    x = h * np.arange(-80.0, 81.0)
    f, some = np.exp(-(x**2)), x[POINTS]
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        found = pse.derivative(
            some + origin, f[POINTS], x + origin, f, h, 3.0 * h, pse.construct(4, 2), 4
        )
    exact = (16.0 * some**4 - 48.0 * some**2 + 12.0) * f[POINTS]
    shares = [
        float(re.search(r"by about (\S+) of", str(one.message)).group(1))
        for one in said
        if "round-off" in str(one.message)
    ]
    return np.abs(found - exact).max() / 12.0, shares


@pytest.mark.parametrize(("h", "origin"), [(7e-5, 0.0), (5e-5, 0.0), (0.05, 1e12)])
def test_what_is_wrong_is_said(h, origin):
    """Of a sum of roundings the root mean square is said; the greatest of 101 is some three times as large."""
    error, shares = fourth_derivative(h, origin)
    smoothing = fourth_derivative(h)[0] if origin else 0.0
    assert shares, error
    # A value just below 1 has half the ulp that is counted.
    assert 0.25 * (error - smoothing) < shares[0] < 4.0 * (error - smoothing)


def test_no_digit_is_left():
    error, (share,) = fourth_derivative(1e-5)
    assert error > 10.0
    assert share == 1.0


@pytest.mark.parametrize(("h", "origin"), [(0.05, 0.0), (1e-3, 0.0), (0.05, 1e9)])
def test_what_is_right_is_not(h, origin):
    assert fourth_derivative(h, origin)[1] == []


@pytest.mark.filterwarnings("error")
def test_a_result_may_be_zero_where_it_is_asked_for():
    x = 0.05 * np.arange(-80.0, 81.0)
    found = pse.derivative([0.0], [1.0], x, np.exp(-x * x), 0.05, 0.15, pse.construct(1, 2), 1)
    assert abs(found[0]) < 1e-15


def test_of_a_straight_line_nothing_but_round_off_is_left():
    """On few and close particles this is as large as the derivative of another f: it is said."""
    x = 1e-5 * np.arange(-80.0, 81.0)
    with pytest.warns(AccuracyWarning, match="round-off"):
        pse.derivative([0.0], [1.0], x, 1.0 + x, 1e-5, 3e-5, pse.construct(4, 2), 4)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("unit", "size"), [(1e-60, 1e60), (1e60, 1e-60), (1e-60, 1e-200)])
def test_no_unit_is_too_small_or_too_large(unit, size):
    x = 0.05 * np.arange(-80.0, 81.0)
    f, h = size * np.exp(-x * x), 0.05 * unit
    kernel = pse.construct(4, 2)
    pse.derivative(x[POINTS] * unit, f[POINTS], x * unit, f, h, 3.0 * h, kernel, 4)


@pytest.mark.filterwarnings("ignore::fracparticles.errors.AccuracyWarning")
def test_particles_in_one_place_have_no_extent():
    kernel = pse.construct(2, 2)
    found = pse.derivative([0.0], [0.0], [1.0, 1.0], [0.0, 1.0], 1.0, 1.0, kernel, 2)
    assert found == pytest.approx(kernel(np.array([-1.0])))
