"""The constant of the tail, and the error that leaving the tail out causes."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute
from fracparticles.special.stable import reduced_green
from fracparticles.special.tails import exchange_truncation_error, tail_constant

EPS = np.finfo(float).eps


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_the_green_function_falls_with_the_constant(alpha):
    """(A.2): the next term is smaller by x^-alpha, 1e-11 at x = 1e10 and alpha = 1.1."""
    x = 1e10
    assert float(reduced_green(x, alpha)) * x ** (1.0 + alpha) == pytest.approx(
        tail_constant(alpha), rel=1e-9
    )


@pytest.mark.parametrize(("beta", "spacing"), [(0.1, 0.1), (0.5, 0.05), (0.9, 0.04)])
def test_the_closed_form_is_the_truncation_error_of_an_exchange_scheme(beta, spacing):
    # Beside it: the next term in 1/D, of relative size D^-alpha <= 3 %, and a spatial error below 1 % of it.
    case = Case(
        scheme="KPSE",
        order=4,
        beta=beta,
        truncation=40.0,
        spacing=spacing,
        integrator="exponential",
    )
    error = relative_l1_error(case, compute(case).u)
    assert error == pytest.approx(exchange_truncation_error(case.reach, 1 + beta, 1.0), rel=0.05)


@pytest.mark.parametrize("distance", [1e-3, 1e-9, 1e-12, EPS])
def test_the_constant_keeps_its_digits_near_two(distance):
    alpha = 2.0 - distance
    with mp.workdps(40):
        exact = mp.gamma(1 + mp.mpf(alpha)) * mp.sin(mp.pi * mp.mpf(alpha) / 2) / mp.pi
    assert tail_constant(alpha) == pytest.approx(float(exact), rel=1e-14)


def test_the_constant_is_that_of_an_order():
    with pytest.raises(InvalidInput, match=r"^alpha = "):
        tail_constant(2.0)


@pytest.mark.parametrize(
    ("field", "arguments"),
    [("half_width", ([10.0, 0.0], 1.5, 1.0)), ("half_width", (-1.0, 1.5, 1.0)),
     ("alpha", (10.0, 2.0, 1.0)), ("time", (10.0, 1.5, -1.0)), ("time", (10.0, 1.5, np.nan))],
)  # fmt: skip
def test_truncations_that_are_none_are_refused(field, arguments):
    with pytest.raises(InvalidInput, match=field):
        exchange_truncation_error(*arguments)
