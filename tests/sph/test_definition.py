"""The definition of the fractional integral, by quadrature."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.sph.definition import defining_integral


def test_the_defining_integral_of_a_power():
    # I^alpha x^2 = 2 x^(2+alpha) / Gamma(3+alpha); Gamma(3.5) = 15 sqrt(pi) / 8.
    x = np.array([0.5, 2.0])
    ours = defining_integral(lambda t: t * t, x, np.full(2, 0.5))
    assert ours == pytest.approx(16.0 * x**2.5 / (15.0 * np.sqrt(np.pi)), rel=1e-13)


@pytest.mark.parametrize(("x", "alpha"), [([-1.0], [0.5]), ([1.0], [0.0]), ([1.0, 2.0], [0.5])])
def test_what_is_refused(x, alpha):
    with pytest.raises(InvalidInput):
        defining_integral(np.cos, x, alpha)
