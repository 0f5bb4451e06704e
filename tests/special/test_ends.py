"""The fundamental solution tends to the heat kernel as alpha nears 2, and to Cauchy's density as it nears 1."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.special.ends import cauchy, heat_kernel
from fracparticles.special.stable import green

NEAR = 1e-9


@pytest.mark.parametrize("t", [0.1, 1.0, 7.0])
@pytest.mark.parametrize(("law", "alpha"), [(heat_kernel, 2.0 - NEAR), (cauchy, 1.0 + NEAR)])
def test_the_fundamental_solution_tends_to_it(law, alpha, t):
    x = np.linspace(-4.0, 4.0, 81)
    exact = law(x, t)
    assert np.abs(green(x, t, alpha) - exact).max() < 10.0 * NEAR * exact.max()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("law", [heat_kernel, cauchy])
def test_a_number_gives_a_number_and_far_away_there_is_nothing(law):
    assert isinstance(law(0.5, 1.0), float)
    assert law(1e200, 1.0) == 0.0


@pytest.mark.parametrize("law", [heat_kernel, cauchy])
@pytest.mark.parametrize(("field", "bad"), [("x", np.nan), ("t", 0.0), ("t", -1.0)])
def test_bad_input_is_refused(law, field, bad):
    with pytest.raises(InvalidInput) as refusal:
        law(**{"x": 1.0, "t": 1.0, field: bad})
    assert refusal.value.field == field
