"""Runs on the whole space by one pair of transforms: exact solutions, invariants, and the order of the tails."""

from __future__ import annotations

import re
import warnings
from functools import lru_cache
from itertools import product

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import fracparticles as fp
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.time.whole_space import WholeSpace, evolve, tail_exponents
from sweeps import at_once, covering


def line(points: int, half_width: float) -> tuple[np.ndarray, float]:
    h = 2.0 * half_width / points
    return (np.arange(points) - points // 2) * h, h


def mixture(x: np.ndarray, t: float, alpha: float) -> np.ndarray:
    return 0.6 * fp.green(np.abs(x - 1.5), t, alpha) + 0.4 * fp.green(
        np.abs(x + 1.0), t + 0.2, alpha
    )


@pytest.mark.parametrize("alpha", [1.2, 1.5, 1.9])
def test_off_centre_data_become_the_exact_solution(alpha):
    x, h = line(1024, 64.0)
    u = evolve(mixture(x, 0.5, alpha), h, alpha, 1.0, terms=5)
    assert_allclose(u, mixture(x, 1.5, alpha), rtol=1e-5, atol=1e-9)
    near = np.abs(x) < 10.0
    assert_allclose(u[near], mixture(x, 1.5, alpha)[near], rtol=1e-9)


@pytest.mark.parametrize("alpha", [1.5, 1.8])
@pytest.mark.parametrize("terms", [1, 2, 4])
def test_the_error_falls_with_the_power_of_the_first_term_left_out(alpha, terms):
    """Twice the width: u ~ D^-gamma relative to its own tail D^-1, near the ends; the exponents say which gamma."""
    gamma = tail_exponents(alpha, terms + 1)[-1]
    errors = []
    for half_width in (32.0, 64.0):
        x, h = line(int(16 * half_width), half_width)
        u = evolve(mixture(x, 0.5, alpha), h, alpha, 1.0, terms=terms)
        errors.append(np.abs(u - mixture(x, 1.5, alpha)).max())
    assert errors[1] <= errors[0] * 2.0 ** (-gamma) + 1e-15


def test_the_first_exponents():
    assert tail_exponents(1.5, 5) == pytest.approx([1.5, 3.0, 3.5, 4.5, 5.0])
    assert tail_exponents(1.1, 4) == pytest.approx([1.1, 2.2, 3.1, 3.3])


def test_without_terms_it_is_the_periodic_exact_symbol():
    _, h = line(96, 10.0)
    u0 = np.random.default_rng(1).standard_normal(96)
    k = np.fft.fftfreq(96, h) * 2.0 * np.pi
    exact = np.fft.ifft(np.fft.fft(u0) * np.exp(-0.3 * np.abs(k) ** 1.4)).real
    assert_allclose(evolve(u0, h, 1.4, 0.3, terms=0), exact, atol=1e-14)


@pytest.mark.parametrize(
    ("dim", "points", "half_width", "tolerance"), [(2, 96, 16.0, 2e-6), (3, 40, 10.0, 1e-4)]
)
def test_in_the_plane_and_in_space(dim, points, half_width, tolerance):
    alpha = 1.5
    x, h = line(points, half_width)
    at = np.meshgrid(*(x,) * dim, indexing="ij", sparse=True)

    def exact(t: float) -> np.ndarray:
        shifted = np.sqrt(
            sum((line - c) ** 2 for line, c in zip(at, (1.0, -0.5, 0.2), strict=False))
        )
        return fp.green(shifted, t, alpha, dim=dim)

    u = evolve(exact(0.5), h, alpha, 1.0, terms=2)
    assert np.abs(u - exact(1.5)).max() <= tolerance * exact(1.5).max()


def test_data_that_fall_by_powers_of_their_own():
    """u^ = pi exp(-|k|) at first; at x = 0 the solution is int_0^inf exp(-k - t k^alpha) dk."""
    x, h = line(1024, 64.0)
    k, weight = np.polynomial.laguerre.laggauss(120)
    alpha, time = 1.5, 1.0
    u = evolve(1.0 / (1.0 + x * x), h, alpha, time, terms=4, tail=(2.0, 4.0))
    assert u[512] == pytest.approx(weight @ np.exp(-time * k**alpha), rel=1e-5)
    own = evolve(1.0 / (1.0 + x * x), h, alpha, time, terms=4)
    assert own[512] == pytest.approx(u[512], rel=1e-4)


def test_data_that_end_conserve_their_mass():
    """Beyond D lies 2 c D^-alpha / alpha, 4e-4, but for terms smaller by D^-alpha and h / D, 1e-3 each."""
    x, h = line(2048, 100.0)
    u0 = np.maximum(1.0 - x * x, 0.0) ** 3
    u = evolve(u0, h, 1.5, 1.0, terms=4, tail=())
    beyond = 2.0 * u[-1] * 100.0 / 1.5
    assert h * u.sum() + beyond == pytest.approx(h * u0.sum(), rel=3e-6)


def test_two_halves_of_the_time_are_the_whole():
    x, h = line(512, 40.0)
    u0 = mixture(x, 0.5, 1.6)
    once = evolve(u0, h, 1.6, 1.0, terms=4)
    twice = evolve(evolve(u0, h, 1.6, 0.4, terms=4), h, 1.6, 0.6, terms=4)
    assert np.abs(once - twice).max() <= 1e-7 * once.max()


@settings(max_examples=settings.default.max_examples * 2 // 3)
@given(
    alpha=st.floats(1.05, 1.95),
    time=st.floats(1e-3, 2.0),
    scale=st.floats(1e-3, 1e3),
    points=st.integers(16, 80),
    terms=st.integers(0, 4),
)
def test_linear_symmetric_and_the_same_in_other_units(alpha, time, scale, points, terms):
    rng = np.random.default_rng(points)
    u, v = rng.standard_normal((2, points))
    warnings.simplefilter("ignore", AccuracyWarning)

    def run(w: np.ndarray, h: float = 0.3, t: float = time) -> np.ndarray:
        return evolve(w, h, alpha, t, terms=terms)

    size = np.abs(run(u)).max() + np.abs(run(v)).max() + np.abs(u).max()
    assert np.abs(run(2.0 * u - v) - 2.0 * run(u) + run(v)).max() <= 1e-8 * size
    assert np.abs(run(u, 0.3 * scale, time * scale**alpha) - run(u)).max() <= 1e-6 * size
    if points % 2:
        assert np.abs(run(u[::-1])[::-1] - run(u)).max() <= 1e-8 * size


@pytest.mark.parametrize("dim", [1, 2])
def test_many_data_at_once_are_each_alone(dim):
    run = WholeSpace(24, dim, 1.5, 2.0, terms=2)
    many = np.random.default_rng(0).standard_normal((3, 2, *(24,) * dim))
    at_once = run.solve(many)
    for index in np.ndindex(3, 2):
        assert_allclose(at_once[index], run.solve(many[index]), atol=1e-13)


def test_the_data_stay_as_they_are():
    u0 = np.ones(32)
    evolve(u0, 0.1, 1.5, 1.0)
    assert (u0 == 1.0).all()


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"alpha": 2.0}, "alpha"),
        ({"spacing": 0.0}, "spacing"),
        ({"time": -1.0}, "time"),
        ({"time": 1000.0}, "lattice"),
        ({"u": np.ones(7)}, "points"),
        ({"u": np.float64(1.0), "dim": 1}, "u"),
        ({"u": 1.0}, "u"),
        ({"u": np.ones((2, 16))}, "u"),
        ({"u": np.ones((16, 1))}, "u"),
        ({"diffusivity": float("nan")}, "diffusivity"),
        ({"dim": 4}, "dim"),
        ({"terms": 7}, "terms"),
        ({"terms": 1.5}, "terms"),
        ({"stretch": 0.5}, "stretch"),
        ({"tail": (1.0,)}, "tail"),
        ({"tail": (3.0,)}, "tail"),
        ({"u": np.ones((9, 10)), "dim": 2}, "u"),
        ({"u": [1.0] * 9 + [float("nan")]}, "u"),
        ({"spacing": 1e-300}, "spacing"),
        ({"time": 1e300}, "time"),
        ({"diffusivity": 1e100, "time": 1e100}, "lattice"),
        ({"u": np.full(16, 1e308)}, "u"),
        ({"u": np.full(16, np.inf)}, "u"),
        ({"terms": 2.0}, "terms"),
        ({"terms": True}, "terms"),
        ({"stretch": np.inf}, "stretch"),
        ({"stretch": 1e12}, "stretch"),
        ({"stretch": "3"}, "stretch"),
        ({"tail": 5.0}, "tail"),
        ({"tail": (1e300,)}, "tail"),
        ({"tail": (2.0,) * 7}, "tail"),
        ({"dim": 1.0}, "dim"),
        ({"dim": True}, "dim"),
    ],
)
def test_bad_arguments_are_named(change, field):
    given = {"u": np.ones(16), "spacing": 1.0, "alpha": 1.5, "time": 1.0} | change
    with pytest.raises(InvalidInput) as error:
        evolve(**given)
    assert error.value.field == field


def test_a_lattice_too_narrow_is_warned_of():
    """The tail misses the solution at the ends."""
    x, h = line(64, 2.0)
    with pytest.warns(AccuracyWarning, match="wider lattice"):
        narrow = evolve(mixture(x, 0.5, 1.5), h, 1.5, 1.0)
    assert np.abs(narrow - mixture(x, 1.5, 1.5)).max() > 1e-3 * narrow.max()


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("half_width", [3.0, 6.0, 12.0, 24.0])
def test_no_silent_error(alpha, half_width):
    """Where nothing is said, the error is less than what the tail may miss unnoticed."""
    x, h = line(512, half_width)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        u = evolve(mixture(x, 0.5, alpha), h, alpha, 1.0)
    error = np.abs(u - mixture(x, 1.5, alpha)).max() / u.max()
    assert said or error <= 1e-3


def of_waves(transform, x, t, alpha):
    """Return int_0^inf u^(k) cos(k x) e^(-t k^alpha) dk / pi; the trapezium rule is exact but for waves beyond 60."""
    k = np.linspace(0.0, 60.0, 12001)
    waves = transform(k) * np.exp(-t * k**alpha)
    return np.array([np.trapezoid(waves * np.cos(k * at), k) for at in x]) / np.pi


@pytest.mark.parametrize("t", [3.0, 10.0, 30.0])
def test_a_tail_that_the_solution_misses_is_no_error_by_itself(t):
    """0.17 was said of 5e-4 at t = 30: there the powers of the solution have no meaning yet where the lattice ends."""
    x, h = line(400, 20.0)
    u0, exact = 1.0 / (1.0 + x * x) / np.pi, of_waves(lambda k: np.exp(-k), x, t, 1.5)
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        u = evolve(u0, h, 1.5, t)
    assert np.abs(u - exact).max() < 1e-3 * u.max()


@pytest.mark.parametrize("t", [0.1, 1.0])
def test_powers_that_swing_between_the_places_where_they_meet_the_data_are_warned_of(t):
    """The data are one up to four fifths of the way, then zero: an error of 0.015 was silent."""
    x, h = line(200, 10.0)
    box = 1.0 * (np.abs(x) < 8.05)  # 161 spacings
    exact = of_waves(lambda k: 16.1 * np.sinc(16.1 * k / (2.0 * np.pi)), x, t, 1.95)
    with pytest.warns(AccuracyWarning, match="fewer or more of them") as caught:
        u = evolve(box, h, 1.95, t)
    said = float(re.search(r"by ([\d.e-]+) of its", str(caught[0].message))[1])
    error = np.abs(u - exact).max() / u.max()
    assert 1e-3 < error < said


def test_a_prepared_run_is_refused_alike():
    with pytest.raises(InvalidInput, match="lattice") as error:
        WholeSpace(16, 1, 1.5, 1e4)
    assert "= 417.7 spacings" in str(error.value)  # 0.9 (1e4)^(2/3)


@at_once(product(range(8, 17), range(7)))
def test_few_points_will_do(points, terms):
    assert np.isfinite(WholeSpace(points, 1, 1.5, 0.5, terms=terms).solve(np.ones(points))).all()


def test_small_data_beside_large_ones_are_warned_of():
    x, h = line(128, 3.0)
    narrow, wide = mixture(x, 0.5, 1.5), 1e6 * np.exp(-((x / 0.1) ** 2))
    run = WholeSpace(128, 1, 1.5, h**-1.5)
    alone, both = (run.solve_and_judge(data)[1] for data in (narrow, np.array([narrow, wide])))
    assert both >= alone * (1.0 - 1e-9)


# --- the ends of alpha -----------------------------------------------------------------------------


@lru_cache(maxsize=6)
def bump(dim: int, alpha: float, t: float) -> tuple[np.ndarray, float]:
    """The fundamental solution on a lattice that holds and resolves it."""
    points, half_width = {1: (1024, 64.0), 2: (96, 16.0), 3: (40, 10.0)}[dim]
    x, h = line(points, half_width)
    r = np.sqrt(
        sum(np.square(axis) for axis in np.meshgrid(*(x,) * dim, indexing="ij", sparse=True))
    )
    return np.asarray(fp.green(r, t, alpha, dim)), h


@pytest.mark.parametrize(
    ("terms", "distance", "dim"),
    covering(range(7), [1e-3, 1e-6, 1e-9, 1e-12, np.finfo(float).eps], [1, 2, 3]),
)
def test_the_tails_near_alpha_two(dim, terms, distance):
    """1 / kappa has a pole at each exponent, of which nothing may be left. The second term is 1e-4 of the first."""
    alpha = 2.0 - distance
    (start, h), (end, _) = bump(dim, alpha, 1.0), bump(dim, alpha, 2.0)
    # Without terms there are the periodic images of the tail, and of the Gaussian: exp(-10^2 / 8) at the ends in space.
    bound = 1e-8 + 1e-4 * distance if terms else 1e-5 + distance
    assert np.abs(evolve(start, h, alpha, 1.0, terms=terms) - end).max() <= bound * end.max()


@pytest.mark.parametrize(
    ("dim", "alpha"), covering([1, 2, 3], [1.0 + 1e-9, 1.0 + 1e-6, 1.33333333, 1.5 + 1e-8])
)
def test_terms_that_nearly_belong_to_no_tail_cost_no_digits(dim, alpha):
    """More terms are no worse than the first alone: they do not magnify the round-off, 1e-16 over their distance."""
    (start, h), (end, _) = bump(dim, alpha, 1.0), bump(dim, alpha, 2.0)

    def error(terms: int) -> float:
        return float(np.abs(evolve(start, h, alpha, 1.0, terms=terms) - end).max() / end.max())

    most = 1.1 * error(1) + 1e-9
    for terms in range(2, 7):
        assert error(terms) <= most, terms


def test_no_exponent_is_nearly_even_but_alpha():
    assert tail_exponents(2.0 - 1e-6, 6) == pytest.approx([2.0 - 1e-6])
    assert tail_exponents(2.0 - 1e-12, 6).size == 0
    assert tail_exponents(1.0 + 1e-9, 4) == pytest.approx([1.0, 3.0, 5.0, 7.0])
    assert tail_exponents(4.0 / 3.0 + 1e-9, 5) == pytest.approx(np.array([4, 8, 10, 14, 16]) / 3)


@pytest.mark.parametrize("tail", [(), (2.5,), (2.0, 4.0)])
def test_data_of_their_own_near_alpha_two(tail):
    """The heat equation to 1e-12 and what the images of the tail leave."""
    x, h = line(512, 40.0)
    u = evolve(np.exp(-x * x), h, 2.0 - 1e-12, 1.0, tail=tail)
    assert np.abs(u - np.exp(-x * x / 5.0) / np.sqrt(5.0)).max() <= 1e-11


# --- what is said, and what is refused ---------------------------------------------------------------


@pytest.mark.parametrize(
    ("dim", "points", "half_width"), [(1, 64, 32.0), (2, 64, 16.0), (3, 40, 10.0)]
)
@pytest.mark.parametrize("shift", [0.0, 0.5])
def test_data_that_the_lattice_does_not_resolve_are_spoken_of(dim, points, half_width, shift):
    x, h = line(points, half_width)
    at = np.meshgrid(*(x - shift * h,) * dim, indexing="ij", sparse=True)
    r = np.sqrt(sum(np.square(axis) for axis in at))
    with pytest.warns(AccuracyWarning, match="does not resolve"):
        u = evolve(fp.green(r, 0.5, 1.05, dim), h, 1.05, 1.0)
    exact = fp.green(r, 1.5, 1.05, dim)
    assert np.abs(u - exact).max() > 1e-3 * exact.max()


def test_data_that_it_resolves_are_not():
    x, h = line(256, 32.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        evolve(fp.green(x, 0.5, 1.5), h, 1.5, 1.0)
        evolve(np.exp(-x * x), h, 1.5, 1.0, tail=())
        evolve(np.zeros(256), h, 1.5, 1.0)


def test_a_time_that_is_no_time_at_all_leaves_the_data():
    u = np.exp(-(np.linspace(-5.0, 5.0, 33) ** 2))
    assert_allclose(evolve(u, 1e100, 1.9, 1e-100, diffusivity=1e-100), u, atol=1e-15)


def test_a_list_will_do_and_complex_numbers_will_not():
    run = WholeSpace(16, 1, 1.5, 1.0)
    assert (run.solve([1.0] * 16) == run.solve(np.ones(16))).all()
    with pytest.raises(InvalidInput, match="real numbers"):
        run.solve(np.ones(16) * 1j)


def test_no_data_at_all():
    assert evolve(np.ones((0, 16)), 1.0, 1.5, 1.0, dim=1).shape == (0, 16)


# --- a short solve, judged --------------------------------------------------------------------------


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("points", [9, 12])
def test_one_side_of_the_waves_is_the_mirror_of_the_other(dim, points):
    """The decay of every wave from its own wavenumber: what a point mass becomes is its transform."""
    alpha, tau = 1.3, 0.7
    theta = np.fft.fftfreq(points) * 2.0 * np.pi
    square = sum(np.square(one) for one in np.meshgrid(*(theta,) * dim, indexing="ij"))
    mass = np.zeros((points,) * dim)
    mass[(0,) * dim] = 1.0
    u = WholeSpace(points, dim, alpha, tau, terms=0).solve(mass)
    assert_allclose(np.fft.fftn(u), np.exp(-tau * square ** (0.5 * alpha)), atol=1e-15 * u.size)


@pytest.mark.parametrize("dim", [1, 2])
@pytest.mark.parametrize("stretch", [None, 1.5])
@pytest.mark.parametrize("terms", [0, 2])
def test_the_doubts_of_many_data_are_the_greatest_of_each(dim, stretch, terms):
    run = WholeSpace(24, dim, 1.5, 2.0, terms=terms, stretch=stretch)
    x = np.arange(24) - 12.0
    at = np.meshgrid(*(x,) * dim, indexing="ij", sparse=True)
    r2 = sum(np.square(one - 0.5) for one in at)
    many = np.array([np.exp(-r2 / 4.0), np.exp(-r2), 1.0 / (1.0 + r2) ** 2, np.zeros_like(r2)])
    result, miss, lacking = run.solve_and_judge(many)
    each = [run.solve_and_judge(one) for one in many]
    assert_allclose(result, [one[0] for one in each], atol=1e-15)
    assert lacking == pytest.approx(max(one[2] for one in each), rel=1e-9)
    worst = max(one[1] for one in each)  # of one datum it may be a bound above, below a thousandth
    assert miss == pytest.approx(worst, rel=1e-9) if miss > 1e-3 else miss <= worst <= 1e-3


def test_without_a_tail_the_miss_is_the_value_at_the_ends_over_the_greatest():
    x, h = line(64, 4.0)
    u, miss, _ = WholeSpace(64, 1, 1.5, h**-1.5, terms=0).solve_and_judge(mixture(x, 0.5, 1.5))
    assert miss == pytest.approx(max(abs(u[0]), abs(u[-1])) / u.max(), rel=1e-14)
    assert miss > 1e-3


# --- data with labels ---------------------------------------------------------------------------------


def labelled(x, u):
    return xr.DataArray(u, dims="x", coords={"x": x})


@pytest.mark.parametrize("of", ["rising", "falling", "single precision", "no places", "numbered"])
def test_labelled_data_are_their_values(of):
    x, h = line(200, 10.0)
    u = np.exp(-np.square(x - 1.0))
    given = {
        "rising": labelled(x, u),
        "falling": labelled(x[::-1], u),
        "single precision": labelled((x + 500.0).astype(np.float32), u),
        "no places": xr.DataArray(u, dims="x"),
        "numbered": pd.Series(u),
    }[of]
    assert np.array_equal(evolve(given, h, 1.5, 0.5), evolve(u, h, 1.5, 0.5))


@pytest.mark.parametrize("run", [evolve, fp.evolve_long])
@pytest.mark.parametrize(
    "places",
    [
        lambda x: 2.0 * x,
        lambda x: x + 1e-4 * np.sin(x),
        lambda x: np.roll(x, 50),
        lambda x: np.resize(x[:2], x.size),
        lambda x: 0.0 * x,
    ],
)
def test_labels_that_are_not_a_spacing_apart_are_refused(run, places):
    x, h = line(200, 10.0)
    u = np.exp(-np.square(x))
    for data in (labelled(places(x), u), pd.Series(u, index=places(x))):
        with pytest.raises(
            InvalidInput, match=r"^u = .* values at points a spacing apart, 0.1, in order"
        ):
            run(data, h, 1.5, 0.5)


def test_numbers_that_a_run_holds_are_taken():
    """A scalar coordinate of a data set is an array without axes."""
    x, h = line(200, 10.0)
    u = labelled(x, np.exp(-np.square(x)))
    found = evolve(u, u.x[1] - u.x[0], xr.DataArray(1.5), np.array(0.5), dim=np.array(1))
    assert_allclose(found, evolve(u.values, h, 1.5, 0.5), rtol=1e-12)


@pytest.mark.parametrize(
    "wrong", [3.0, lambda theta: np.ones(3), lambda theta: np.log(theta) if theta.any() else theta]
)
@pytest.mark.parametrize("terms", [0, 2])
def test_an_amplification_is_a_number_for_each_wave(wrong, terms):
    with np.errstate(divide="ignore"), pytest.raises(InvalidInput, match=r"^amplification = "):
        WholeSpace(20, 1, 1.5, 3.0, amplification=wrong, terms=terms)


def test_a_run_made_ready_says_what_it_was_made_with():
    assert repr(WholeSpace(400, 2, 1.5, 3.0)) == "WholeSpace(400, 2, 1.5, 3)"


@pytest.mark.parametrize("terms", [0, 2])
@pytest.mark.parametrize("kind", [np.float16, np.float32, np.int8, ">f8", np.longdouble])
def test_a_run_made_ready_has_all_digits_of_data_of_any_type(kind, terms):
    u = np.zeros(64)
    u[24:40] = np.arange(16.0)  # a number of each type
    run = WholeSpace(64, 1, 1.5, 2.0, terms=terms)
    result = run.solve(u.astype(kind))
    assert result.dtype == np.float64
    assert (result == run.solve(u)).all()


def test_after_no_time_the_solution_is_the_data():
    # No tail continues a cosine, and the lattice does not resolve it: neither matters here.
    u = np.cos(np.arange(64.0))
    for time in (0, 0.0, np.float64(0.0)):
        still = evolve(u, 0.1, 1.5, time)
        long, spacing = fp.evolve_long(u, 0.1, 1.5, time)
        assert (still == u).all()
        assert (long == u).all()
        assert spacing == 0.1
        assert not np.shares_memory(still, u)
        assert not np.shares_memory(long, u)
    with pytest.raises(InvalidInput, match="alpha"):
        evolve(u, 0.1, 2.5, 0.0)
