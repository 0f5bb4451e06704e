"""The cubic spline, the particles, SPH gradients and SPH integrals."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.sph import ParticleLine
from fracparticles.sph.cubic_spline import spline, spline_gradient, spline_integral
from fracparticles.sph.derivatives import correction, gradient, second_derivative
from fracparticles.sph.integrals import METHODS, power_integral, power_sum
from fracparticles.sph.norms import r2_score, relative_l2

ROUND_OFF = 1e-12


def test_the_spline_has_the_values_of_the_print():
    # (22): 2/3 at 0, 1/6 at 1, 0 from 2 on, times 1/h.
    assert spline(np.array([0.0, 0.3, -0.3, 0.6, 9.0]), 0.3) == pytest.approx(
        np.array([2 / 3, 1 / 6, 1 / 6, 0.0, 0.0]) / 0.3, abs=1e-15
    )


@given(st.floats(-3.0, 3.0), st.floats(0.01, 10.0))
def test_parity_and_scaling(q, h):
    assert spline(h * q, h) == pytest.approx(spline(-h * q, h), rel=1e-13)
    assert spline_gradient(h * q, h) == pytest.approx(-spline_gradient(-h * q, h), rel=1e-13)
    assert spline_integral(h * q, h) + spline_integral(-h * q, h) == pytest.approx(1.0, rel=1e-13)


@pytest.mark.parametrize(("low", "high"), [(-2.0, -1.0), (-1.0, 0.0), (0.0, 1.0), (1.0, 2.0)])
def test_gradient_and_integral_belong_to_the_spline(low, high):
    # Polynomials of degree 3 at most between the knots: four nodes are exact.
    nodes, weights = np.polynomial.legendre.leggauss(4)
    x = low + 0.5 * (nodes + 1.0) * (high - low)
    for integrand, whole in ((spline_gradient, spline), (spline, spline_integral)):
        assert 0.5 * integrand(x, 1.0) @ weights == pytest.approx(
            whole(high, 1.0) - whole(low, 1.0), abs=1e-15
        )


def test_the_particles_of_the_paper():
    line = ParticleLine(0.0, 5.0, 401)
    assert line.spacing == 0.0125
    assert line.smoothing == pytest.approx(1.1 * 0.0125)
    assert line.x[0] == 0.0
    assert line.x[-1] == pytest.approx(5.0)
    # Every real particle has all neighbours within 2 h = 2.2 s.
    assert line.margin == 3
    assert line.x_all.size == 407
    assert np.diff(line.midpoints) == pytest.approx(line.spacing)


@pytest.mark.parametrize(
    "values",
    [
        {"b": -1.0},
        {"b": np.inf},
        {"count": 2},
        {"count": 10.5},
        {"smoothing_ratio": 0.5},
        {"smoothing_ratio": -1.0},
    ],
)
def test_impossible_particles_are_refused(values):
    with pytest.raises(InvalidInput):
        ParticleLine(**{"a": 0.0, "b": 1.0, "count": 10, **values})


@given(
    st.lists(st.floats(0.4, 1.6), min_size=12, max_size=30),
    st.floats(-3.0, 3.0),
    st.floats(1.1, 2.5),
)
def test_the_corrected_gradient_is_exact_for_lines_on_any_particles(gaps, slope, ratio):
    """(18), (19): consistent to first order wherever the gradient of a constant vanishes, here by a difference."""
    x = np.cumsum(gaps)
    volumes = np.gradient(x)
    h = ratio * np.mean(gaps)
    z = x[3:-3]
    factor = correction(z, x, volumes, h)
    at_z = np.array([gradient(p, x, volumes, slope * (x - p), h)[0] for p in z[:, None]])
    # Where L is small the neighbours are on the edge of the support, and nothing is left to divide by.
    usable = factor > 0.1
    assert at_z[usable] == pytest.approx(slope, abs=1e-9)


def test_as_printed_the_correction_makes_things_worse():
    line = ParticleLine(0.0, 1.0, 21)
    volumes = np.full(line.x_all.size, line.spacing)
    plain = gradient(line.x, line.x_all, volumes, line.x_all, line.smoothing, corrected=False)
    factor = correction(line.x, line.x_all, volumes, line.smoothing)
    assert plain == pytest.approx(factor, rel=1e-10)
    assert np.abs(plain * factor - 1.0).min() > 1.9 * np.abs(plain - 1.0).max()


def test_brookshaw_is_exact_for_parabolas():
    line = ParticleLine(-1.0, 1.0, 21)
    volumes = np.full(line.x_all.size, line.spacing)
    f = 3.0 * line.x_all**2 - line.x_all + 2.0
    ours = second_derivative(line.x, f[line.inside], line.x_all, volumes, f, line.smoothing, 0.0)
    assert ours == pytest.approx(6.0, rel=1e-9)
    # eta^2 / s^2 = 1e-8 (1.1)^4 h^2 is what the regularisation costs.
    regular = second_derivative(line.x, f[line.inside], line.x_all, volumes, f, line.smoothing)
    assert regular == pytest.approx(6.0, rel=1e-8)
    # The printed eta removes it: eta / s = 4e-3 / s^3.
    h = 0.0125 * 1.1
    fine = ParticleLine(-1.0, 1.0, 161)
    f, volumes = fine.x_all**2, np.full(fine.x_all.size, fine.spacing)
    lost = second_derivative(fine.x, f[fine.inside], fine.x_all, volumes, f, h, 1e-4 / h**2)
    assert np.abs(lost).max() < 0.01


def test_the_sum_of_powers_is_the_sum_written_out():
    rng = np.random.default_rng(1)
    x, q = np.sort(rng.uniform(0.0, 1.0, 30)), rng.normal(size=30)
    z = np.append(rng.uniform(-0.1, 1.1, 7), x[4])
    power = rng.uniform(0.1, 0.9, 8)
    distance = z[:, None] - x
    terms = (distance + 0j) ** power[:, None] * spline_integral(distance, 0.08)
    assert power_sum(z, x, q, power, 0.08) == pytest.approx(terms @ q, abs=ROUND_OFF)


@pytest.mark.parametrize("method", METHODS)
def test_the_plain_integral_of_a_constant(method):
    """(17), (20): power 0. Far behind z every particle counts in full."""
    line = ParticleLine(0.0, 2.0, 81)
    z = np.array([10.0])
    ours = power_integral(line, np.ones(line.count), z, np.zeros(1), method)[0]
    extra = line.spacing if method == "standard" else 0.0  # two half volumes outside [0, 2]
    assert ours == pytest.approx(2.0 + extra, rel=1e-13)


def test_a_method_that_does_not_exist_is_refused():
    line = ParticleLine(0.0, 1.0, 5)
    with pytest.raises(InvalidInput, match="halved"):
        power_integral(line, np.ones(5), line.x, np.zeros(5), "half")


def test_the_norms():
    exact = np.array([1.0, 2.0, 3.0])
    ours = exact + np.array([0.3j, 0.0, 0.4])
    assert relative_l2(exact, ours) == pytest.approx(0.5 / np.sqrt(14.0))
    assert r2_score(exact, ours) == pytest.approx(1.0 - 0.25 / 2.0)


def test_a_point_with_next_to_no_neighbours_is_warned_of():
    """One particle on the edge of the support makes f / (x - x_j) of a constant f, whose gradient is zero."""
    with pytest.warns(AccuracyWarning, match="at 1 of 1 points"):
        assert gradient([0.0], [1.999], 1.0, [1.0], 1.0) == pytest.approx(1.0 / 1.999)
    with pytest.warns(AccuracyWarning, match="L of"):
        second_derivative([0.0], [1.0], [1.999], 1.0, [1.0], 1.0)
    with pytest.warns(AccuracyWarning, match="L of"):
        gradient([0.0], np.arange(-3.0, 4.0), 10.0, np.ones(7), 1.1, corrected=False)


@pytest.mark.filterwarnings("error")
def test_the_end_of_a_line_is_not():
    x = np.arange(-3.0, 4.0)
    assert gradient(x, x, 1.0, x - 3.0, 1.1)[-1] == pytest.approx(1.0)


@pytest.mark.parametrize("exponent", [-1073, -600, 600, 1020])
def test_measures_of_error_do_not_depend_on_the_unit(exponent):
    """Times a power of 2, to the last bit; far from zero the spread keeps its digits."""
    exact, ours = np.ldexp([1.0, 2.0, 1.0], exponent), np.ldexp([1.0, 2.0, 2.0], exponent)
    assert relative_l2(exact, ours) == relative_l2([1.0, 2.0, 1.0], [1.0, 2.0, 2.0])
    assert r2_score(exact, ours) == r2_score([1.0, 2.0, 1.0], [1.0, 2.0, 2.0])
    assert r2_score([1e9, 1e9 + 1.0], [1e9, 1e9 + 1.5]) == 0.5
    with pytest.raises(InvalidInput, match="ours"):
        relative_l2([1e-310], [1.0])


@pytest.mark.parametrize(
    ("measure", "exact"),
    [(relative_l2, [0.0, 0.0]), (r2_score, [2.0, 2.0])],
)
def test_what_has_no_size_is_not_compared_with(measure, exact):
    with pytest.raises(InvalidInput, match="a size to compare with"):
        measure(exact, [1.0, 2.0])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_errors_do_not_depend_on_the_unit(scale):
    exact, ours = scale * np.array([1.0, 3.0]), scale * np.array([1.0, 2.0])
    assert relative_l2(exact, ours) == pytest.approx(10.0**-0.5)
    assert r2_score(exact, ours) == pytest.approx(0.5)


@pytest.mark.parametrize("unit", [1e-60, 1e-3, 1.0, 1e3, 1e4, 1e8, 1e60])
def test_an_eta_that_takes_the_second_derivative_is_told(unit):
    """The default, 0.0001 h^2, is no length: with spacings of 1e4 it leaves 0.4 of x^2'' / 2, in others nothing."""
    x = unit * np.arange(-50.0, 51.0)
    arguments = [0.0], [0.0], x, unit, 0.5 * x * x / unit**2, 1.1 * unit
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = float(second_derivative(*arguments)[0] * unit**2)
        assert float(second_derivative(*arguments, eta=1e-4 * unit)[0] * unit**2) == (
            pytest.approx(1.0, rel=1e-7)
        )
    told = ["eta" in str(one.message) for one in caught]
    assert told == ([True] if unit > 1e3 else [])
    assert abs(found - 1.0) < 0.02 or told
