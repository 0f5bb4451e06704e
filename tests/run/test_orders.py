"""Observed orders of synthetic levels."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.run.orders import observed_order, self_convergence_order


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_an_exact_power_has_its_order(order):
    x = np.linspace(-1.0, 1.0, 41)
    levels = [np.cos(x) + np.sin(3.0 * x) * 0.5 ** (order * level) for level in range(3)]
    # Subtracting neighbouring levels loses log10(2^order) digits of 16.
    assert self_convergence_order(levels) == pytest.approx(order, abs=1e-12)
    h = 0.5 ** np.arange(5)
    np.testing.assert_allclose(observed_order(h, 3.0 * h**order), order, rtol=1e-12)


@pytest.mark.parametrize("levels", [[np.ones(3)] * 2, [np.ones(3), np.ones(3), np.ones(2)]])
def test_levels_that_do_not_match_are_refused(levels):
    with pytest.raises(InvalidInput, match="three arrays of one shape"):
        self_convergence_order(levels)


def test_an_error_is_needed_for_each_level():
    with pytest.raises(InvalidInput, match="one for each"):
        observed_order([1.0, 0.5], [1.0])
