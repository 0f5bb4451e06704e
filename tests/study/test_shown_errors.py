"""Errors as tables show them: what is round-off is no number."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning
from fracstudy.errors import off, power_of_ten, quiet, three_digits
from fracstudy.orders import observed


def test_an_error_is_the_greatest_over_a_size():
    exact = np.array([1.0, -4.0])
    assert off([1.0, -3.0], exact) == 0.25
    assert off([1.0, -3.0], exact, 1.0) == 1.0
    assert np.isnan(off([np.nan, 0.0], exact))


@pytest.mark.parametrize(
    ("error", "digits", "power"),
    [(1.23456e-5, 1.23e-5, 1e-4), (-3e-7, 3e-7, 1e-6), (1e-3, 1e-3, 1e-3), (1e-17, 1e-13, 1e-15)],
)
def test_an_error_is_shown_to_what_is_reproducible(error, digits, power):
    assert three_digits(error) == digits
    assert power_of_ten(error) == pytest.approx(power, rel=1e-12)


def test_the_first_level_has_no_order():
    first, *others = observed([0.4, 0.2, 0.1], [16.0, 4.0, 0.5])
    assert np.isnan(first)
    assert others == pytest.approx([2.0, 3.0])


def test_a_block_is_quiet_of_what_is_asked_for():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with quiet():
            warnings.warn("coarse", AccuracyWarning, stacklevel=1)
        with quiet(UserWarning):
            warnings.warn("coarse", DeprecationWarning, stacklevel=1)
    assert [warning.category for warning in caught] == [DeprecationWarning]
