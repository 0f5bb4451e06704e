"""Shape functions, profiles and loading against mpmath, closed forms and each other."""

from __future__ import annotations

from dataclasses import FrozenInstanceError

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import spherical_jn

from fracparticles.errors import InvalidInput
from fracparticles.markers import (
    SHAPES,
    Gaussian,
    Ramp,
    Square,
    equal_weight,
    random,
    shape_function,
    uniform,
)
from fracparticles.markers.stability import extremes, rate

ROUND_OFF = 1e-13  # of sums of terms of size one


# S_j / constant, in the words of the paper.
FORMULAS = {
    "S1": lambda x: mp.mpf(1),
    "S2": lambda x: 1 - abs(x),
    "S3": lambda x: 1 - x**2,
    "S4": lambda x: (1 - x**2) ** 2,
    "S5": lambda x: (1 - abs(x)) * mp.exp(-(x**2)),
    "S6": lambda x: (1 - x**2) ** 2 * mp.exp(-(x**2)),
    "S7": lambda x: (1 - x**2) * mp.exp(-(x**2)),
    "S8": lambda x: (mp.mpf(3) / 2 - x**2) * mp.exp(-(x**2)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_the_constant_normalises(name):
    with mp.workdps(25):
        points = [0, 1] if SHAPES[name].finite else [0, 2, 4, 12]
        constant = float(1 / (2 * mp.quad(FORMULAS[name], points)))
    # Round-off of erf(1), exp(-1) and a few operations.
    assert SHAPES[name].constant == pytest.approx(constant, rel=1e-15, abs=0.0)


@pytest.mark.parametrize("name", SHAPES)
def test_values_are_those_of_the_formula(name):
    x = np.array([-1.5, -0.9, -0.3, 0.0, 0.5, 0.99, 2.5])
    shape = SHAPES[name]
    exact = [shape.constant * float(FORMULAS[name](v)) if abs(v) <= shape.reach else 0.0 for v in x]
    assert shape(x) == pytest.approx(exact, rel=1e-14, abs=1e-16)


def test_the_printed_constants():
    wrong = {name for name, s in SHAPES.items() if not np.isclose(s.printed, s.constant)}
    assert wrong == {"S6", "S7"}
    for shape in SHAPES.values():
        assert shape.as_printed()(0.2) == pytest.approx(
            shape(0.2) * shape.printed / shape.constant, rel=1e-15
        )


@pytest.mark.parametrize("name", SHAPES)
def test_derivatives_are_those_of_the_function(name):
    shape = SHAPES[name]
    x = np.array([-0.83, -0.31, 0.27, 0.64])
    for m in range(1, 4 if shape.smoothness is None else shape.smoothness + 1):
        step = 1e-5
        slope = (shape(x + step, m - 1) - shape(x - step, m - 1)) / (2.0 * step)
        # Truncation step^2 / 6 times the third derivative (below 200), round-off 1e-16 / step.
        assert shape(x, m) == pytest.approx(slope, abs=1e-8)


@pytest.mark.parametrize("name", SHAPES)
def test_a_derivative_that_is_no_function_is_refused(name):
    smoothness = SHAPES[name].smoothness
    if smoothness is None:
        SHAPES[name](0.0, 7)
    else:
        with pytest.raises(InvalidInput, match=name):
            SHAPES[name](0.0, smoothness + 1)


def test_an_unknown_shape_function_is_refused():
    with pytest.raises(InvalidInput, match="S9"):
        shape_function("S9")


@pytest.mark.parametrize("name", SHAPES)
def test_kernels_are_the_derivatives(name):
    shape = SHAPES[name]
    x = np.linspace(-1.2, 1.2, 49) * shape.reach
    for m in range((2 if shape.smoothness is None else shape.smoothness) + 1):
        assert shape.kernel(m).profile(x) == pytest.approx(shape(x, m), rel=1e-13, abs=1e-16)
    assert shape.kernel().reach == shape.reach


def test_transforms_in_closed_form():
    k = np.array([0.3, 2.0, 7.3, 19.0, 61.0])
    known = {
        "S1": np.sin(k) / k,
        "S2": (np.sin(0.5 * k) / (0.5 * k)) ** 2,
        "S3": 3.0 * spherical_jn(1, k) / k,
        "S4": 15.0 * spherical_jn(2, k) / k**2,
    }
    for name, exact in known.items():
        assert SHAPES[name].transform(k) == pytest.approx(exact, abs=ROUND_OFF)


@pytest.mark.parametrize("name", ["S5", "S6", "S7", "S8"])
def test_transforms_by_quadrature(name):
    shape = SHAPES[name]
    for k in (0.0, 1.3, 6.8, 24.0):
        with mp.workdps(25):
            points = np.linspace(0.0, 1.0 if shape.finite else 9.0, 25).tolist()
            whole = 2 * mp.quad(lambda x, k=k: FORMULAS[name](x) * mp.cos(k * x), points)
        assert float(shape.transform(k)) == pytest.approx(
            shape.constant * float(whole), abs=ROUND_OFF
        )


def test_a_transform_at_infinity_is_refused():
    with pytest.raises(InvalidInput, match="wavenumber"):
        SHAPES["S4"].transform(np.inf)


@pytest.mark.parametrize("t", [0.1, 5.0, 1e3, 1e6, 1e12])
def test_the_square_profile_diffuses(t):
    square = Square()
    for x in (-2.0, 0.3, 1.7, 3.0 * np.sqrt(t)):
        with mp.workdps(25):
            exact = mp.quad(
                lambda s, x=x: mp.exp(-((x - s) ** 2) / (4 * t)) / mp.sqrt(4 * mp.pi * t), [-1, x, 1]
                if -1 < x < 1
                else [-1, 1],
            )  # fmt: skip
        assert square.value(x, t) == pytest.approx(float(exact), rel=1e-12, abs=0.0)
        with mp.workdps(25):
            ends = [mp.exp(-((x + end) ** 2) / (4 * mp.mpf(t))) for end in (1, -1)]
            slope = (ends[0] - ends[1]) / mp.sqrt(4 * mp.pi * t)
        assert square.slope(x, t) == pytest.approx(float(slope), rel=1e-12, abs=0.0)
        step = 1e-5
        part = (square.cumulative(x + step, t) - square.cumulative(x - step, t)) / (2.0 * step)
        assert part == pytest.approx(float(square.value(x, t)), abs=1e-9)


@given(part=st.floats(1e-6, 1.0 - 1e-6), t=st.floats(0.0, 50.0))
def test_quantiles_invert_the_cumulative(part, t):
    if 0.0 < t < 1e-3:
        t = 0.0
    for profile in (Square(), Gaussian()):
        g = np.array([part * profile.total])
        # Round-off of the cumulative, whose terms are of the size of x.
        assert profile.cumulative(profile.quantile(g, t), t) == pytest.approx(g, abs=1e-13)


@pytest.mark.parametrize("t", [1.0, 1e3, 1e6, 1e12])
@pytest.mark.parametrize("g", [1e-200, 1e-12, 1e-3, 0.5])
def test_quantiles_of_a_square_that_has_spread_far(g, t):
    """The cumulative at them, in digits enough for the difference of its terms."""
    x = float(Square().quantile(np.array([g]), t)[0])
    with mp.workdps(300):
        s = 2 * mp.sqrt(mp.mpf(t))

        def antiderivative(y):
            return y * mp.erf(y / s) + s / mp.sqrt(mp.pi) * mp.exp(-((y / s) ** 2))

        exact = 1 + (antiderivative(mp.mpf(x) + 1) - antiderivative(mp.mpf(x) - 1)) / 2
    # An ulp of x changes g by x f / g, some 1 + x^2 / (2 t) ulp.
    room = 2.0**-52 * (8.0 + 4.0 * (x * x / t))
    assert float(exact) == pytest.approx(g, rel=8.0 * room)


def test_the_exact_markers_move_with_the_exact_velocity():
    # dx/dt = -f_x / f along quantile(g, t).
    square, g, t, step = Square(), np.array([0.1, 0.7, 1.5]), 2.0, 1e-4
    speed = (square.quantile(g, t + step) - square.quantile(g, t - step)) / (2.0 * step)
    x = square.quantile(g, t)
    assert speed == pytest.approx(-square.slope(x, t) / square.value(x, t), abs=1e-7)


@given(end=st.floats(0.2, 5.0), count=st.integers(1, 60))
def test_loading_shares_the_total(end, count):
    ramp = Ramp(end)
    x, weights = equal_weight(ramp, count)
    assert weights.sum() == pytest.approx(ramp.total, rel=1e-13)
    assert (np.diff(x) > 0.0).all()
    assert 0.0 < x[0] <= x[-1] < end
    # (11): the part to the left of marker j is (j - 1/2) / N of the total.
    left = -0.5 * np.expm1(-x * x)
    assert left == pytest.approx(ramp.total * (np.arange(count) + 0.5) / count, abs=1e-13)


def test_uniform_loading_is_the_midpoint_rule():
    x, weights = uniform(Gaussian().value, (-6.0, 6.0), 48)
    assert np.diff(x) == pytest.approx(np.full(47, 0.25), rel=1e-13)
    assert weights.sum() == pytest.approx(Gaussian().total, rel=1e-14)  # spectral accuracy


def test_random_loading_repeats_and_follows_f():
    x, weights = random(Square(), 4000, np.random.default_rng(7))
    again = random(Square(), 4000, np.random.default_rng(7))[0]
    assert (x == again).all()
    assert (np.diff(x) >= 0.0).all()
    assert weights.sum() == pytest.approx(2.0, rel=1e-12)
    # The Kolmogorov-Smirnov distance exceeds 1.95 / sqrt(N) once in a thousand.
    empirical = (np.arange(4000) + 0.5) / 4000
    assert np.abs(empirical - 0.5 * (x + 1.0)).max() < 1.95 / np.sqrt(4000)


@pytest.mark.parametrize(
    "call",
    [
        lambda: uniform(Gaussian().value, (1.0, 0.0), 4),
        lambda: uniform(Gaussian().value, (0.0, 1.0), 0),
        lambda: equal_weight(Square(), -1),
        lambda: Square().quantile(np.array([2.0])),
        lambda: Ramp(0.0),
        lambda: Square().value(0.0, -1.0),
    ],
)
def test_what_cannot_be_is_refused(call):
    with pytest.raises(InvalidInput):
        call()


def test_shape_functions_and_profiles_stay_what_they_are():
    for one, field in ((SHAPES["S8"], "reach"), (Square(), "total"), (Gaussian(), "total")):
        before = (one if one is SHAPES["S8"] else one.value)(0.5)
        with pytest.raises(FrozenInstanceError):
            setattr(one, field, 2.0)
        assert (one if one is SHAPES["S8"] else one.value)(0.5) == before


def test_the_least_range_of_wavenumbers_is_one():
    """Up to k = 1 the rate of S8 falls all the way, so that the fastest decay is that of the end."""
    found = extremes(SHAPES["S8"], 1.0)
    assert found.k_decay == 1.0
    assert found.decay == pytest.approx(-float(rate(SHAPES["S8"], np.array([1.0]))[0]))
    with pytest.raises(InvalidInput, match="largest"):
        extremes(SHAPES["S8"], 0.999)
