"""Which variables a function of the caller's is called with."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import fracparticles as fp
from fracparticles.called import Called

XTU = ("x", "t", "u")
X, T, U = np.linspace(-1.0, 1.0, 5), 0.5, np.linspace(2.0, 3.0, 5)
LINE = np.linspace(-40.0, 40.0, 161)
CUBE = CubicSpline(LINE, LINE**3)


class Slope:
    """An object with a method, and one that can be called."""

    def of_u(self, u, share=0.5):
        return share * u

    def __call__(self, t):
        return 3.0 * t


TAKEN = {
    "all": (lambda x, t, u: x + t * u, X + T * U),
    "the time alone": (lambda t: 2.0 * t, 2.0 * T),
    "u alone": (lambda u: u, U),
    "another order": (lambda u, x: u - x, U - X),
    "the time first": (lambda t, x: t - x, T - X),
    "capital letters": (lambda X, U: X - U, X - U),
    "a word": (lambda time: time, T),
    "another name": (lambda s: s, X),
    "other names": (lambda s, tau: s - tau, X - T),
    "a default is kept": (lambda x, k=2.0: k * x, 2.0 * X),
    "defaults are kept": (lambda s, k=2.0, m=3.0: k * s + m, 2.0 * X + 3.0),
    "a default named after a variable": (lambda x, k=2.0, t=9.0: k * x * t, 2.0 * X * T),
    "by name only": (lambda x, *, u, k=2.0: k * x * u, 2.0 * X * U),
    "any number": (lambda *values: values[0] - values[2], X - U),
    "any names beside": (lambda x, **more: x + len(more), X),
    "a part is given": (partial(lambda x, k: k * x, k=4.0), 4.0 * X),
    "a spline": (CUBE, X**3),
    "vectorised": (np.vectorize(lambda x: 1.0 if x > 0 else 0.0), 1.0 * (X > 0)),
    "a method": (Slope().of_u, 0.5 * U),
    "an object": (Slope(), 3.0 * T),
    "a ufunc": (np.sin, np.sin(X)),
}


@pytest.mark.parametrize("case", TAKEN)
def test_names_say_which_variables_a_function_takes(case):
    function, expected = TAKEN[case]
    np.testing.assert_allclose(Called("source", function, XTU)(X, T, U), expected, atol=1e-14)


def test_a_place_may_have_another_letter_but_not_that_of_something_else():
    np.testing.assert_array_equal(Called("outside", lambda y, t: y * t, ("x", "t"))(X, T), X * T)
    swapped = Called("velocity", lambda y, x: x - y, ("x", "y", "t"))
    np.testing.assert_array_equal(swapped(X, U, T), X - U)


REFUSED = {
    "a place for the time": (lambda x, y: x, ("x", "t")),
    "u where there is none": (lambda u: u, ("x", "t")),
    "the time where there is none": (lambda t: t, ("x",)),
    "one more": (lambda x, t, u, v: x, XTU),
    "named at another place": (lambda s, x: s, ("x", "t")),
    "none": (lambda: 1.0, XTU),
    "only a default": (lambda k=1.0: k, XTU),
    "another by name": (lambda x, *, k: x, XTU),
    "a ufunc of two": (np.add, ("x",)),
    "no function": (1.0, ("x", "t")),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_would_get_another_variable_than_its_name_says_is_refused(case):
    function, variables = REFUSED[case]
    with pytest.raises(fp.InvalidInput, match=r"^velocity = .* a function of .*default\.$"):
        Called("velocity", function, variables)


def test_a_message_shows_the_function_of_the_caller():
    assert repr(Called("source", Slope().of_u, XTU)) == "the function of_u"
    with pytest.raises(fp.InvalidInput, match=r"^source = the function <lambda> is not allowed\."):
        Called("source", lambda v, w, x, y: v, XTU)


def test_a_problem_and_followed_particles_take_functions_by_their_names():
    def solved(**given):
        problem = fp.Problem(alpha=1.5, half_width=20.0, spacing=0.5, t_final=0.2, **given)
        return fp.solve_problem(problem, lambda x: np.exp(-0.2 * x * x), estimate=False).u.values

    text = solved(diffusivity="1 + 0.1*x**2/(1 + x**2)", source="-0.1*u*t")
    bump = CubicSpline(LINE, LINE**2 / (1.0 + LINE**2))
    # A cubic spline of knots 0.5 apart misses a function of fourth derivative 24 by 5/384 0.5^4 24 = 0.02 at most.
    splined = solved(
        diffusivity=lambda x, k=0.1: 1.0 + k * bump(x), source=lambda u, t: -0.1 * u * t
    )
    assert np.abs(splined - text).max() < 0.1 * 0.02 * np.abs(text).max()
    exact = solved(
        diffusivity=lambda x, k=0.1: 1.0 + k * x**2 / (1.0 + x**2), source=lambda u, t: -0.1 * u * t
    )
    np.testing.assert_allclose(exact, text, rtol=0.0, atol=1e-12)

    def followed(**given):
        (end,) = fp.follow(
            lambda x: np.exp(-x * x), 0.2, alpha=1.5, window=(-6.0, 6.0), step=0.4, **given
        )
        return end.u

    np.testing.assert_array_equal(
        followed(velocity=lambda x: -x, source=lambda u: -u),
        followed(velocity=lambda x, t: -x, source=lambda x, t, u: -u),
    )
