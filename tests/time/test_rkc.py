"""The stabilised steps: what they refuse, and how they overflow."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.time.rkc import ChebyshevStep


@pytest.mark.parametrize(
    "rate", [lambda y: -1e10 * y, lambda y: 10.0 * y * y, lambda y: np.full(3, np.inf)]
)
def test_what_overflows_does_so_by_our_error_alone(rate):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(NonFiniteSolution, match=r"step .* of 1000"):
            ChebyshevStep(5).advance(rate, np.ones(3), dt=1.0, steps=1000)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"y": [1.0, np.nan]}, "y"),
        ({"y": ["a"]}, "y"),
        ({"y": np.array([1j])}, "y"),
        ({"f": None}, "f"),
        ({"f": lambda y: y[:-1]}, "f"),
        ({"f": lambda y: 0.0}, "f"),
        ({"start": "now"}, "start"),
        ({"dt": -1.0}, "dt"),
        ({"steps": 0}, "steps"),
    ],
)
def test_refused(change, field):
    given = {"f": np.negative, "y": np.ones(2), "dt": 0.1, "steps": 1, **change}
    with pytest.raises(InvalidInput) as refused:
        ChebyshevStep(3).advance(given.pop("f"), given.pop("y"), **given)
    assert refused.value.field == field


@pytest.mark.parametrize("stages", [2, 3, 10, 250])
def test_stable_to_the_end_of_the_interval(stages):
    step = ChebyshevStep(stages)
    z = -np.linspace(0.0, step.stability_interval, 5001)
    # The round-off of the stages, some s^2 ulps.
    assert np.abs(step(lambda y: z * y, np.ones(z.size), 1.0)).max() <= 1.0 + 1e-15 * stages**2
