"""How many walkers a density takes."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.moving.random_walk import cell_masses, expected_deviation
from fracparticles.moving.walkers import few_walkers_beyond, walkers_to_equal
from fracparticles.special.stable import green


def test_walkers_to_equal_an_error():
    """Inverse of the expected deviation, up to 1 / (n p)."""
    masses = cell_masses(np.linspace(-8.0, 8.0, 33), 1.5, 1.5)
    error = expected_deviation(masses, 10**7).sum() / masses.sum()
    assert walkers_to_equal(masses, error) == pytest.approx(1e7, rel=1e-4)


def test_few_walkers():
    x = few_walkers_beyond(10**6, 0.25, 1.5, 1.5)
    assert 10**6 * 0.25 * green(x, 1.5, 1.5) == pytest.approx(10.0, rel=1e-9)
    assert few_walkers_beyond(10, 0.25, 1.5, 1.5) == 0.0


@pytest.mark.parametrize("unit", [1e-40, 1e-12, 1e-6, 1e40])
def test_the_unit_of_length_does_not_matter(unit):
    """All lengths times a unit, the time its power alpha."""
    x = few_walkers_beyond(10**6, 0.25, 1.5, 1.5)
    scaled = few_walkers_beyond(10**6, 0.25 * unit, 1.5 * unit**1.5, 1.5)
    assert scaled == pytest.approx(x * unit, rel=1e-12)


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("masses", lambda: walkers_to_equal([0.5, 1.5], 0.1)),
        ("error", lambda: walkers_to_equal([0.5], 0.0)),
        ("walkers", lambda: few_walkers_beyond(0, 0.25, 1.5, 1.5)),
        ("width", lambda: few_walkers_beyond(10, -1.0, 1.5, 1.5)),
        ("masses", lambda: walkers_to_equal([0.0, 0.0], 0.1)),
        ("masses", lambda: walkers_to_equal([], 0.1)),
        ("masses", lambda: walkers_to_equal([1e-320], 1e-100)),
        ("walkers", lambda: few_walkers_beyond(10**400, 1.0, 1.0, 1.5)),
        ("t", lambda: few_walkers_beyond(10, 1.0, 1e-200, 1.5)),
        ("alpha", lambda: few_walkers_beyond(10, 1.0, 1.0, 2.0)),
    ],
)
def test_what_is_refused(field, call):
    with pytest.raises(InvalidInput, match=field):
        call()
