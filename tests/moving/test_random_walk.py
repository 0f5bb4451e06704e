"""The random walk: exact increments, exact laws, and what is refused."""

from __future__ import annotations

import math
import warnings
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import kolmogorov

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.moving.random_walk import (
    cell_counts,
    cell_masses,
    distribution,
    expected_deviation,
    kolmogorov_smirnov,
    stable_variates,
    walk,
)
from fracparticles.special.stable import central_mass, green, tail_mass

ALPHAS = [1.05, 1.5, 1.95]
# Fixed seeds: a p-value below this comes of a wrong law, not of chance.
UNLIKELY = 1e-3


@pytest.fixture
def generator() -> np.random.Generator:
    return np.random.default_rng(1976)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_variates_have_the_stable_law(alpha, generator):
    s = stable_variates(alpha, 200_000, generator)
    assert kolmogorov(math.sqrt(s.size) * kolmogorov_smirnov(s, 1.0, alpha)) > UNLIKELY


@pytest.mark.parametrize("alpha", ALPHAS)
def test_characteristic_function(alpha, generator):
    s = stable_variates(alpha, 200_000, generator)
    for k in (0.3, 1.0, 3.0):
        wave = np.cos(k * s)
        assert abs(wave.mean() - math.exp(-(k**alpha))) < 4.0 * wave.std() / math.sqrt(s.size)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_tails_hold_as_many_as_they_must(alpha, generator):
    """Kolmogorov-Smirnov does not see the tails: count there; the count is binomial."""
    s = np.abs(stable_variates(alpha, 1_000_000, generator))
    for far in (5.0, 20.0, 100.0):
        p = tail_mass(far, 1.0, alpha)
        assert abs((s > far).sum() - s.size * p) < 4.0 * math.sqrt(s.size * p)


@pytest.mark.parametrize("steps", [1, 2, 7, 50])
def test_splitting_the_time_in_steps_leaves_the_law(steps, generator):
    alpha, diffusivity = 1.5, 0.7
    x = walk(np.zeros(50_000), alpha, 0.5, generator, diffusivity=diffusivity)
    x = walk(x, alpha, 1.0, generator, steps, diffusivity)
    t = diffusivity * 1.5
    assert kolmogorov(math.sqrt(x.size) * kolmogorov_smirnov(x, t, alpha)) > UNLIKELY
    far = 10.0
    p = tail_mass(far, t, alpha)
    assert abs((np.abs(x) > far).sum() - x.size * p) < 4.0 * math.sqrt(x.size * p)


def test_a_wrong_law_is_found(generator):
    """F moves by (0.2 / alpha) max x G = 0.028, six times the 1 / n^(1/2) of a right law."""
    x = walk(np.zeros(50_000), 1.5, 1.0, generator)
    assert kolmogorov(math.sqrt(x.size) * kolmogorov_smirnov(x, 1.2, 1.5)) < UNLIKELY


def test_same_seed_same_walk():
    first, again = (walk(np.zeros(40_000), 1.5, 1.0, np.random.default_rng(3), 2) for _ in "ab")
    assert_array_equal(first, again)


def test_the_start_is_left_as_it_is_and_shifts_the_end(generator):
    start = np.linspace(-1.0, 1.0, 5)
    kept = start.copy()
    moved = walk(start, 1.5, 1.0, np.random.default_rng(3))
    assert_array_equal(start, kept)
    assert_allclose(moved - start, walk(np.zeros(5), 1.5, 1.0, np.random.default_rng(3)))


def test_places_that_hold_no_digits_of_the_walk_are_warned_of():
    """An ulp of 1e17 is 16; from 1e12 the increments of many steps are still those from zero, rounded once."""
    near = walk(np.zeros(500), 1.5, 1.0, np.random.default_rng(3), 1000)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        far = walk(np.full(500, 1e12), 1.5, 1.0, np.random.default_rng(3), 1000) - 1e12
        walk(np.full(5, 1e17), 1.5, 1e30, np.random.default_rng(3))
    off = np.abs(far - near) / np.spacing(np.maximum(np.abs(near + 1e12), 1e12))
    assert off.max() <= 0.5
    with pytest.warns(AccuracyWarning, match="rounded by up to 8, beside the 1 that they go"):
        walk(np.full(500, 1e17), 1.5, 1.0, np.random.default_rng(3))


def test_time_scales_increments(generator):
    """(D dt)^(1/alpha): the same random numbers, 8 times the time, 4 times the way at alpha = 3/2."""
    near, far = (walk(np.zeros(100), 1.5, t, np.random.default_rng(5)) for t in (1.0, 8.0))
    assert_allclose(far, 4.0 * near, rtol=1e-14)


@given(alpha=st.floats(1.0 + 1e-9, 2.0 - 1e-9), seed=st.integers(0, 2**32))
def test_variates_are_finite(alpha, seed):
    assert np.isfinite(stable_variates(alpha, 1000, np.random.default_rng(seed))).all()


class _Extremes(np.random.Generator):
    """Draws the ends of the range of each distribution."""

    def random(self, out):
        out[:] = np.resize([0.0, 0.0, 1.0 - 2.0**-53, 0.5], out.shape)

    def standard_exponential(self, out):
        out[:] = np.resize([0.0, 40.0, 40.0, 1.0], out.shape)


@pytest.mark.parametrize("alpha", [1.0 + 1e-9, 1.5, 2.0 - 1e-9])
def test_extreme_draws_give_finite_variates(alpha):
    s = stable_variates(alpha, 4, _Extremes(np.random.PCG64(0)))
    assert np.isfinite(s).all()
    assert s[0] == 0.0
    assert s[1] < 0.0 < s[2]
    assert s[3] == 0.0


# --- cells and laws -------------------------------------------------------------------------------


def test_counts_of_cells_and_ensembles():
    x = [-1.0, -0.6, 0.0, 0.99, 1.0, 7.0, -1.01, 0.5, 0.2]
    assert_array_equal(cell_counts(x, 1.0, 4), [[2, 0, 2, 2]])
    # x + 1 and its multiple by 3/2 are rounded up to the end here.
    assert_array_equal(cell_counts([np.nextafter(1.0, 0.0)], 1.0, 3), [[0, 0, 1]])
    # Nine walkers make two ensembles of four.
    assert_array_equal(cell_counts(x, 1.0, 4, 2), [[2, 0, 1, 1], [0, 0, 0, 1]])


def test_cell_masses_add_up():
    edges = np.array([-np.inf, -30.0, -2.0, -0.5, 0.3, 4.0, 50.0, np.inf])
    masses = cell_masses(edges, 1.5, 1.5)
    assert masses.sum() == pytest.approx(1.0, abs=1e-15)
    assert masses[0] == pytest.approx(0.5 * tail_mass(30.0, 1.5, 1.5), rel=1e-14)
    assert cell_masses([-2.0, 2.0], 1.5, 1.5)[0] == pytest.approx(central_mass(2.0, 1.5, 1.5))
    assert_allclose(cell_masses([-9.0, -8.0], 1.5, 1.5), cell_masses([8.0, 9.0], 1.5, 1.5))


@pytest.mark.parametrize("low", [-1e-3, 0.0, 0.7, 50.0])
@pytest.mark.parametrize("width", [1e-300, 1e-12, 1e-6, 0.99e-3])
def test_the_mass_of_a_narrow_cell_keeps_its_digits(low, width):
    """Next to alpha = 1 Cauchy's law: the tangent of a difference of angles."""
    high = low + width
    if high == low:
        return
    exact = math.atan((high - low) / (1.0 + low * high)) / math.pi
    mass = cell_masses([low, high], 1.0, 1.0 + 1e-13)[0]
    assert mass == pytest.approx(exact, rel=1e-11)


@pytest.mark.parametrize("x", [0.0, 3.0, 1e3])
def test_a_small_cell_holds_density_times_width(x):
    """The midpoint rule: relative error width^2 G''/(24 G), at most width^2 / 24 (1 + (1 + alpha)(2 + alpha)/x^2)."""
    width = 1e-3
    (mass,) = cell_masses([x - width / 2.0, x + width / 2.0], 1.0, 1.5)
    # Far out the difference of the tails keeps the digits that x / width leaves of 1e-13.
    assert mass == pytest.approx(width * green(x, 1.0, 1.5), rel=1e-6)


def test_distribution_is_symmetric_and_rises():
    x = np.linspace(-50.0, 50.0, 201)
    f = distribution(x, 1.5, 1.5)
    assert_allclose(f + f[::-1], 1.0, atol=1e-15)
    assert (np.diff(f) > 0.0).all()


def test_kolmogorov_smirnov_of_one_walker():
    assert kolmogorov_smirnov([0.0], 1.0, 1.5) == 0.5
    assert kolmogorov_smirnov([-1e9], 1.0, 1.5) == pytest.approx(1.0)


@given(p=st.floats(0.0, 1.0), n=st.integers(1, 60))
def test_mean_absolute_deviation_term_by_term(p, n):
    k = np.arange(n + 1)
    weights = np.array([math.comb(n, j) * p**j * (1.0 - p) ** (n - j) for j in k])
    # Round-off of gammaln(61) = 188 in the exponent: 1e-13. Absolutely, where n p rounds to a whole number.
    expected = np.abs(k / n - p) @ weights
    assert float(expected_deviation(p, n)) == pytest.approx(expected, rel=1e-11, abs=1e-15)


def test_mean_absolute_deviation_of_many_walkers():
    """The limit (2 p (1 - p) / (pi n))^(1/2); its relative error is of the order 1 / (n p)."""
    p, n = np.array([1e-3, 0.2, 0.5, 0.9]), 10**8
    assert_allclose(
        expected_deviation(p, n), np.sqrt(2.0 * p * (1.0 - p) / (math.pi * n)), rtol=1e-5
    )


def test_error_of_counts_is_the_expected_one(generator):
    alpha, n, ensembles = 1.5, 2000, 200
    masses = cell_masses(np.linspace(-8.0, 8.0, 41), 1.0, alpha)
    x = stable_variates(alpha, n * ensembles, generator)
    errors = np.abs(cell_counts(x, 8.0, 40, ensembles) / n - masses).sum(axis=1)
    spread = errors.std() / math.sqrt(ensembles)
    assert abs(errors.mean() - expected_deviation(masses, n).sum()) < 4.0 * spread


@pytest.mark.parametrize("alpha", ALPHAS)
def test_error_falls_with_the_root_of_the_number(alpha):
    masses = cell_masses(np.linspace(-8.0, 8.0, 41), 1.0, alpha)
    errors = [expected_deviation(masses, n).sum() for n in (10**6, 10**7, 10**8)]
    for fewer, more in pairwise(errors):
        assert fewer / more == pytest.approx(math.sqrt(10.0), rel=1e-2)


# --- what is refused ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("x", {"x": []}),
        ("x", {"x": [[0.0]]}),
        ("x", {"x": [np.nan]}),
        ("x", {"x": [np.inf]}),
        ("x", {"x": ["a"]}),
        ("alpha", {"alpha": 1.0}),
        ("alpha", {"alpha": 2.0}),
        ("time", {"time": 0.0}),
        ("time", {"time": np.inf}),
        ("time", {"time": 1e300}),
        ("time", {"time": 1e-300}),
        ("time", {"time": 1e308, "diffusivity": 1e308}),
        ("generator", {"generator": 7}),
        ("generator", {"generator": np.random.RandomState(7)}),
        ("steps", {"steps": 0}),
        ("steps", {"steps": 1.5}),
        ("diffusivity", {"diffusivity": -1.0}),
    ],
)
def test_bad_walks_are_refused(field, arguments, generator):
    good = {"x": [0.0], "alpha": 1.5, "time": 1.0, "generator": generator}
    with pytest.raises(InvalidInput) as refused:
        walk(**{**good, **arguments})
    assert refused.value.field == field


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("size", lambda g: stable_variates(1.5, 0, g)),
        ("half_width", lambda _: cell_counts([0.0], 0.0, 4)),
        ("cells", lambda _: cell_counts([0.0], 1.0, 0)),
        ("ensembles", lambda _: cell_counts([0.0], 1.0, 4, 2)),
        ("edges", lambda _: cell_masses([0.0], 1.0, 1.5)),
        ("edges", lambda _: cell_masses([0.0, 0.0], 1.0, 1.5)),
        ("edges", lambda _: cell_masses([[0.0, 1.0]], 1.0, 1.5)),
        ("t", lambda _: cell_masses([0.0, 1.0], 0.0, 1.5)),
        ("alpha", lambda _: distribution([0.0], 1.0, 2.5)),
        ("x", lambda _: kolmogorov_smirnov([], 1.0, 1.5)),
        ("masses", lambda _: expected_deviation([1.1], 10)),
        ("masses", lambda _: expected_deviation([-0.1], 10)),
        ("walkers", lambda _: expected_deviation([0.5], 0)),
        ("walkers", lambda _: expected_deviation([0.5], 10**9 + 1)),
    ],
)
def test_bad_arguments_are_refused(field, call, generator):
    with pytest.raises(InvalidInput) as refused:
        call(generator)
    assert refused.value.field == field
