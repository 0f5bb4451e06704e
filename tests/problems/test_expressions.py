"""Coefficients: what a text may hold, what it evaluates to, and how it is refused."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.data.measured import measured
from fracparticles.errors import InvalidInput
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.formulas import FUNCTIONS

X = np.linspace(-2.0, 3.0, 7)
T = np.array(0.5)
XT = ("x", "t")

VALUES = {
    "1 + 0.5*sin(x)*exp(-t)": 1.0 + 0.5 * np.sin(X) * np.exp(-0.5),
    "-x**2 / (1 + abs(x))": -(X**2) / (1.0 + np.abs(X)),
    "where((x > 0) & (x <= 1), t, 2*pi)": np.where((X > 0) & (X <= 1), 0.5, 2 * np.pi),
    "where((x < 0) | (x >= 2), 1, 0)": 1.0 * ((X < 0) | (X >= 2)),
    "maximum(x, 0) - minimum(x, e)": np.maximum(X, 0.0) - np.minimum(X, np.e),
    "gamma(2.5) * arctan2(x, 1)": 1.329340388179137 * np.arctan(X),
    "  x +\n t ": X + 0.5,
    "2**100": np.full(7, 2.0**100),  # no whole number: int64 would give 0
    "7/2": np.full(7, 3.5),
    "+x": X,
    "x > 0": 1.0 * (X > 0),
}


@pytest.mark.parametrize("text", VALUES)
def test_a_text_is_what_numpy_makes_of_it(text):
    np.testing.assert_allclose(Coefficient("source", text, XT)({"x": X, "t": T}), VALUES[text])


def test_every_function_can_be_called():
    counts = {"where": 3, "arctan2": 2, "minimum": 2, "maximum": 2}
    for name in FUNCTIONS:
        text = f"{name}({', '.join(['0.5'] * counts.get(name, 1))})"
        assert np.isfinite(Coefficient("source", text, XT)({"x": X, "t": T})).all()


REFUSED = {
    "1 + 2*z": ("position 7", "'z'", "x, t"),
    "sine(x)": ("position 1", "'sin'", "functions"),
    "x.real": ("position 1", "nothing else"),
    "np.exp(x)": ("position 1", "name of the function alone"),
    "().__class__": ("position 1", "nothing else"),
    "__import__('os')": ("position 1", "functions"),
    "x if t > 0 else 1": ("position 1", "where(condition"),
    "x > 0 and t > 0": ("position 1", "& and |"),
    "x^2": ("position 1", "** for a power"),
    "0 < x < 1": ("position 1", "(0 < x) & (x < 1)"),
    "'text'": ("position 1", "nothing else"),
    "[x]": ("position 1", "nothing else"),
    "x[0]": ("position 1", "nothing else"),
    "lambda: x": ("position 1", "nothing else"),
    "[x for x in x]": ("position 1", "nothing else"),
    "x := 2": ("invalid syntax",),
    "1 +": ("position", "invalid syntax"),
    "(1": ("position 1", "never closed"),
    "True": ("position 1", "1 or 0"),
    "1j": ("position 1", "nothing else"),
    "exp(x, t)": ("position 1", "1 value(s)"),
    "where(x)": ("position 1", "3 value(s)"),
    "exp(x=1)": ("position 1", "1 value(s)"),
    "exp(*x)": ("position 5", "nothing else"),
    "9" * 400: ("below 1e308",),
    "": ("1 to 2000 characters",),
    "x + " * 600 + "x": ("1 to 2000 characters",),
    "-" * 150 + "x": ("fewer operations",),
    "x\x00": ("expression",),
    "x // 2": ("position 1",),
    "import os": ("invalid syntax",),
    "x; t": ("invalid syntax",),
}


@pytest.mark.parametrize("text", REFUSED, ids=lambda text: text[:20])
def test_a_mistake_is_refused_in_one_line_that_says_where(text):
    with pytest.raises(InvalidInput) as caught:
        Coefficient("source", text, XT)
    said = str(caught.value)
    assert said.startswith("source = ")
    assert "\n" not in said
    assert all(part in said for part in REFUSED[text]), said


def test_a_tower_of_powers_costs_nothing_and_is_infinite():
    big = Coefficient("source", "9**9**9**9", XT)({"x": X, "t": T})
    assert np.isinf(big).all()
    with pytest.raises(InvalidInput, match=r"inf at x = -2"):
        Coefficient("source", "9**9**9**9", XT).checked({"x": X})


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        (lambda x: x * x, X * X),
        (lambda x, t: x * t, X * 0.5),
        (lambda *a: a[0] + a[1], X + 0.5),
        (np.tanh, np.tanh(X)),
        (lambda x, t: 3.0, np.full(7, 3.0)),
        (lambda x, scale=2.0, *, more=1.0: x * scale * more, 2.0 * X),
        (lambda t, x: x - t, X - 0.5),
    ],
)
def test_a_function_is_called_with_the_variables_that_it_takes(function, expected):
    np.testing.assert_allclose(Coefficient("diffusivity", function, XT)({"x": X, "t": T}), expected)


def test_what_a_coefficient_depends_on():
    assert Coefficient("source", "x + exp(-t)", XT).depends_on == {"x", "t"}
    assert Coefficient("source", lambda x: x, XT).depends_on == {"x"}
    assert Coefficient("source", "2*pi", XT).constant == 2.0 * np.pi
    assert Coefficient("source", np.float64(2.0), XT).constant == 2.0
    assert Coefficient("source", "x - x", XT).constant is None
    assert not Coefficient("source", lambda x: x, XT).reproducible


BAD_FUNCTIONS = {
    "no arguments": (lambda: 1.0, "or of several of these"),
    "too many": (lambda x, t, u, v: 1.0, "or of several of these"),
    "shape": (lambda x, t: np.ones(3), "one number for each of the points"),
    "kind": (lambda x, t: "text", "one number for each of the points"),
    "raises": (lambda x, t: x[99], "out of bounds"),
    "scalar only": (lambda x, t: 1.0 if x > 0 else 2.0, "a function of arrays"),
}


@pytest.mark.parametrize("case", BAD_FUNCTIONS)
def test_a_function_that_is_none_of_these_is_refused(case):
    function, said = BAD_FUNCTIONS[case]
    with pytest.raises(InvalidInput, match=said):
        Coefficient("diffusivity", function, XT)({"x": X, "t": T})


def test_measured_data_are_no_coefficient():
    """They are zero beyond their points: a diffusivity would end there."""
    with pytest.raises(InvalidInput, match="PchipInterpolator"):
        Coefficient("diffusivity", measured((X, 1.0 + X * X)), XT)


@pytest.mark.parametrize("given", [None, True, [1.0], np.ones(3), np.nan, np.inf, {}, b"x"])
def test_other_things_are_refused(given):
    with pytest.raises(InvalidInput, match="velocity"):
        Coefficient("velocity", given, XT)


def test_what_is_not_finite_or_too_small_is_named_with_place_and_time():
    with pytest.raises(InvalidInput, match=r"-0\.5 at x = -1\.5, t = 0\.5"):
        Coefficient("diffusivity", "1 + x", XT).checked({"x": np.array([0.0, -1.5]), "t": T}, 0.0)
    with pytest.raises(InvalidInput, match=r"nan at x = -2, t = 0\.5"):
        Coefficient("velocity", "sqrt(x)", XT).checked({"x": X, "t": T})


@pytest.mark.parametrize("given", ["x", "x*t", 2.0, lambda x: x])
def test_values_cannot_be_changed(given):
    """They may be the lattice itself."""
    found = Coefficient("velocity", given, XT)({"x": X, "t": T})
    assert found.shape == X.shape
    with pytest.raises(ValueError, match="read-only"):
        found += 1.0
