"""The fractional operators by SPH, and the closed forms they are measured by."""

from __future__ import annotations

from dataclasses import FrozenInstanceError
from math import gamma, pi

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import roots_jacobi

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.sph import ParticleLine, caputo_derivative, rl_derivative, rl_integral
from fracparticles.sph.closed_forms import FUNCTIONS, Cosine, Exponential, ShiftedPower, Sine
from fracparticles.sph.norms import relative_l2
from fracparticles.sph.one_f_two import one_f_two
from fracparticles.sph.operators import singular_integral

ORDERS = (0.2, 0.5, 0.8)
POINTS = np.array([0.01, 0.5, 1.0, 1.27, 3.0, 5.0])
MORE = {
    "sin 2x": Sine(2.0),
    "cos x/2": Cosine(0.5),
    "exp -x": Exponential(-1.0),
    "(x+2)^4": ShiftedPower(2.0, 4),
    "(x-1)^7": ShiftedPower(-1.0, 7),  # by the recurrence
}
ALL = {**FUNCTIONS, **MORE}
FORMULAS = {
    "sin": lambda x: np.sin(np.pi * x),
    "cos": lambda x: np.cos(np.pi * x),
    "exp": np.exp,
    "cubic": lambda x: (x - 1.0) ** 3,
    "sin 2x": lambda x: np.sin(2.0 * x),
    "cos x/2": lambda x: np.cos(0.5 * x),
    "exp -x": lambda x: np.exp(-x),
    "(x+2)^4": lambda x: (x + 2.0) ** 4,
    "(x-1)^7": lambda x: (x - 1.0) ** 7,
}


def by_quadrature(f, order):
    """I^order f by Gauss's rule for the weight (x - t)^(order - 1).

    Of sin(pi t) over a length of 5 its 40 nodes leave (5 pi / 2)^80 / 80! = 1e-47, and of the others less.
    """
    nodes, weights = roots_jacobi(40, order - 1.0, 0.0)
    half = 0.5 * POINTS[:, None]
    return half[:, 0] ** order / gamma(order) * (f(half * (1.0 + nodes)) @ weights)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("order", ORDERS)
def test_closed_forms_against_quadrature(name, order):
    """(A1)-(A8) and the integrals, from the definitions (1), (3), (5); f' by a step into the complex plane."""
    function, f = ALL[name], FORMULAS[name]
    integral = by_quadrature(f, order)
    caputo = by_quadrature(lambda t: np.imag(f(t + 1e-30j)) / 1e-30, 1.0 - order)
    scale = np.abs(integral).max()
    assert function.rl(POINTS, -order) == pytest.approx(integral, rel=1e-12, abs=1e-12 * scale)
    scale = np.abs(caputo).max()
    assert function.caputo(POINTS, order) == pytest.approx(caputo, rel=1e-12, abs=1e-12 * scale)
    derivative = caputo + f(0.0) * POINTS**-order / gamma(1.0 - order)
    assert function.rl(POINTS, order) == pytest.approx(derivative, rel=1e-12, abs=1e-12 * scale)


@pytest.mark.parametrize("b", [0.05, 0.5, 1.0, 1.5, 2.2, 2.95])
def test_the_hypergeometric_function(b):
    y = np.array([0.0, 1e-3, 1.0, 3.999, 4.001, 7.0, 15.7, 40.0, 300.0])
    with mp.workdps(200):
        exact = [mp.hyp1f2(1, mp.mpf(b) / 2, (mp.mpf(b) + 1) / 2, -(mp.mpf(v) ** 2) / 4) for v in y]
    exact = np.array(exact, dtype=float)
    # The oscillation has the amplitude Gamma(b) y^(1-b), and a phase rounded to y times the unit round-off.
    amplitude = np.maximum(1.0, float(mp.gamma(b)) * np.maximum(1.0, y) ** (1.0 - b))
    allowed = (1e-14 + 4e-16 * y) * np.maximum(amplitude, np.abs(exact))
    assert np.all(np.abs(one_f_two(b, y) - exact) <= allowed)


def test_a8_as_printed_has_no_value_at_one():
    cubic = FUNCTIONS["cubic"]
    x = np.array([0.5, 1.0, 2.0])
    assert np.isnan(cubic.rl_as_printed(x, -0.75)[1])
    elsewhere = [0, 2]
    assert cubic.rl_as_printed(x, 0.75)[elsewhere] == pytest.approx(cubic.rl(x, 0.75)[elsewhere])


@pytest.mark.parametrize("name", ALL)
@given(x=st.floats(0.0, 5.0))
def test_mirror_images(name, x):
    terms = ALL[name].mirrored(5.0)
    mirrored = sum(factor * f.value(np.array(x)) for factor, f in terms)
    assert mirrored == pytest.approx(ALL[name].value(np.array(5.0 - x)), rel=1e-11, abs=1e-13)


@pytest.mark.parametrize(
    "impossible", [lambda: Sine(-1.0), lambda: Cosine(0.0), lambda: ShiftedPower(0.0, 3)]
)
def test_impossible_functions_are_refused(impossible):
    with pytest.raises(InvalidInput):
        impossible()


def test_powers_up_to_a_thousand_and_they_stay_what_they_are():
    power = ShiftedPower(1.0, 1000)
    assert power.value(np.array(0.0)) == 1.0
    with pytest.raises(InvalidInput, match="1000"):
        ShiftedPower(1.0, 1001)
    for function in (Sine(1.0), Exponential(1.0), power):
        with pytest.raises(FrozenInstanceError):
            function.beta = 2.0


OPERATORS = {
    "integral": (rl_integral, lambda f, x, a: f.rl(x, -a)),
    "caputo": (caputo_derivative, lambda f, x, a: f.caputo(x, a)),
    "derivative": (rl_derivative, lambda f, x, a: f.rl(x, a)),
}


def error(operator, name, count, order=0.75, **options):
    approximate, exact = OPERATORS[operator]
    line, f = ParticleLine(0.0, 5.0, count), FUNCTIONS[name]
    ours = approximate(line, f.value(line.x_all), order, **options)[1:]
    return relative_l2(exact(f, line.x, order)[1:], ours)


@pytest.mark.parametrize(
    ("operator", "name", "missing"),
    [("integral", "sin", lambda x: pi * x**0.75), ("caputo", "cos", lambda x: -(pi**2) * x**0.25)],
)
def test_the_standard_error_is_the_half_volume_at_the_end(operator, name, missing):
    """The first particle counts s/2 too much: s/2 g(a) (x-a)^p / Gamma(1+p) more than the halved form."""
    line, f = ParticleLine(0.0, 5.0, 401), FUNCTIONS[name]
    power = {"integral": 0.75, "caputo": 0.25}[operator]
    approximate, _ = OPERATORS[operator]
    whole, half = (
        approximate(line, f.value(line.x_all), 0.75, method=method)
        for method in ("standard", "halved")
    )
    # The last particle's half volume is seen from within 2 h only; the SPH derivative is within 1e-3 of g.
    here = slice(5, -5)
    share = 0.5 * line.spacing * missing(line.x) / float(mp.gamma(1 + power))
    assert (whole - half).real[here] == pytest.approx(share[here], rel=3e-3)
    assert error(operator, name, 401, method="halved") < 0.15 * error(operator, name, 401)


@pytest.mark.parametrize(
    ("operator", "name", "method", "expected"),
    [
        ("integral", "sin", "standard", 1.0),
        ("integral", "sin", "halved", 1.75),
        ("integral", "sin", "modified", 1.75),
        ("caputo", "cos", "standard", 1.0),
        ("caputo", "cos", "halved", 1.25),
        ("caputo", "cos", "modified", 1.25),
    ],
)
def test_observed_orders(operator, name, method, expected):
    """1 with an end volume too many, else 1 + p from the kernel's bend at x' = x, the next term being of order 2."""
    coarse, fine = (error(operator, name, count, method=method) for count in (401, 801))
    assert np.log2(coarse / fine) == pytest.approx(expected, abs=0.1)


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_operator_converges(operator, name):
    assert error(operator, name, 401) < 0.12
    assert error(operator, name, 401) < 0.6 * error(operator, name, 201)


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_right_handed_operators(operator, name):
    """Against the closed forms of the mirror image; 0.0125 apart, as accurate as the left-handed ones."""
    approximate, exact = OPERATORS[operator]
    line, f = ParticleLine(0.0, 5.0, 401), FUNCTIONS[name]
    ours = approximate(line, f.value(line.x_all), 0.75, side="right")[::-1]
    terms = [factor * exact(g, line.x, 0.75) for factor, g in f.mirrored(5.0)]
    assert relative_l2(np.sum(terms, axis=0)[1:], ours[1:]) < 0.12


def variable(x):
    return 0.5 + 0.3 * np.sin(4.0 * pi * x)


def test_a_constant_order_may_be_given_as_an_array():
    line = ParticleLine(0.0, 5.0, 101)
    f = np.sin(line.x_all)
    for approximate, _ in OPERATORS.values():
        whole = approximate(line, f, np.full_like(line.x_all, 0.3))
        assert np.array_equal(whole, approximate(line, f, 0.3))


def test_the_derivative_of_variable_order_differentiates_the_integral():
    """(34) against d/dx of the closed form of I^(1-alpha(x)), by mpmath's derivative."""
    line = ParticleLine(0.0, 2.0, 641)
    ours = rl_derivative(line, np.sin(pi * line.x_all), variable(line.x_all), method="modified")

    def integral(x):
        power = mp.mpf("0.5") - mp.mpf("0.3") * mp.sin(4 * mp.pi * x)
        series = mp.hyp1f2(1, 1 + power / 2, 1.5 + power / 2, -((mp.pi * x) ** 2) / 4)
        return mp.pi * x ** (1 + power) / mp.gamma(2 + power) * series

    at = [64, 160, 288, 480, 600]
    exact = np.array([float(mp.diff(integral, mp.mpf(line.x[i]))) for i in at])
    # First order, s = 1/320, on a derivative as large as 10.
    assert ours.real[at] == pytest.approx(exact, abs=0.03)


def test_the_singular_sum_is_far_worse():
    line, f = ParticleLine(0.0, 5.0, 401), FUNCTIONS["exp"]
    singular = singular_integral(line, f.value(line.x_all), 0.75)
    exact = f.rl(line.x, -0.75)
    assert relative_l2(exact, singular) > 20.0 * error("integral", "exp", 401)


def test_a_derivative_is_infinite_at_the_end_only_if_f_is_not_zero_there():
    line = ParticleLine(0.0, 5.0, 101)
    assert np.isinf(rl_derivative(line, np.cos(line.x_all), 0.5)[0].real)
    assert np.all(np.isfinite(rl_derivative(line, np.sin(line.x_all), 0.5)))


def test_linearity():
    line = ParticleLine(0.0, 1.0, 51)
    rng = np.random.default_rng(2)
    f, g = rng.normal(size=(2, line.x_all.size))
    for approximate, _ in OPERATORS.values():
        together = approximate(line, 2.0 * f - g, 0.4)[1:]
        apart = 2.0 * approximate(line, f, 0.4)[1:] - approximate(line, g, 0.4)[1:]
        assert together == pytest.approx(apart, rel=1e-9, abs=1e-9 * np.abs(apart).max())


@pytest.mark.parametrize(
    ("f", "order", "options", "field"),
    [
        (np.zeros(3), 0.5, {}, "f"),
        (np.full(27, np.nan), 0.5, {}, "f"),
        (np.zeros(27), 1.0, {}, "order"),
        (np.zeros(27), np.linspace(0.0, 0.5, 27), {}, "order"),
        (np.zeros(27), np.full(21, 0.5), {}, "order"),
        (np.zeros(27), 0.5, {"side": "both"}, "side"),
        (np.zeros(27), 0.5, {"method": "best"}, "method"),
    ],
)
def test_what_is_not_allowed_is_refused(f, order, options, field):
    line = ParticleLine(0.0, 1.0, 21)
    for approximate, _ in OPERATORS.values():
        with pytest.raises(InvalidInput) as raised:
            approximate(line, f, order, **options)
        assert raised.value.field == field


@pytest.mark.parametrize(("side", "at"), [("left", 5), ("right", 0)])
def test_a_derivative_that_hardly_converges_is_warned_of_at_the_end_of_the_integral(side, at):
    """h / (b - a) = 0.055: of half of f' there, 0.055^(1-alpha) is left."""
    line = ParticleLine(0.0, 5.0, 21)
    f = (line.x_all if side == "left" else 5.0 - line.x_all) ** 2
    with pytest.warns(AccuracyWarning, match=rf"most at x = {at}\. .*, or method='completed'\."):
        rl_derivative(line, f, 0.97, side=side)
