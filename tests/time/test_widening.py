"""A lattice that widens: six digits after any time, for the price of a few steps."""

from __future__ import annotations

import time
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fracparticles as fp
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.time.widening import evolve_long


def line(points: int, h: float) -> np.ndarray:
    return (np.arange(points) - points // 2) * h


def blob(points: int, h: float, t: float, alpha: float, dim: int, centre: float) -> np.ndarray:
    at = np.meshgrid(*(line(points, h),) * dim, indexing="ij", sparse=True)
    r = np.sqrt(sum((axis - centre) ** 2 for axis in at))
    return fp.green(r, t, alpha, dim)


@pytest.mark.parametrize("alpha", [1.05, 1.3, 1.5, 1.9])
@pytest.mark.parametrize("points", [800, 801])
@pytest.mark.parametrize("later", [1.0, 10.0, 1e3, 1e6, 1e12])
def test_six_digits_on_the_line(alpha, points, later):
    age = 0.3**alpha
    u, h = evolve_long(blob(points, 0.1, age, alpha, 1, 0.7), 0.1, alpha, later)
    exact = blob(points, h, age + later, alpha, 1, 0.7)
    assert u.shape == (points,)
    assert np.abs(u - exact).max() <= 1e-6 * exact.max()
    assert np.abs(u - exact).sum() <= 1e-6 * exact.sum()


@pytest.mark.parametrize("alpha", [1.1, 1.5])
def test_six_digits_in_the_plane(alpha):
    age, later = 0.3**alpha, 1e6
    u, h = evolve_long(blob(400, 0.1, age, alpha, 2, 0.05), 0.1, alpha, later)
    exact = blob(400, h, age + later, alpha, 2, 0.05)
    assert np.abs(u - exact).max() <= 1e-6 * exact.max()


@pytest.mark.parametrize(
    ("data", "tail"),
    [
        (lambda x: np.exp(-((x - 1.0) ** 2)), ()),
        (lambda x: np.maximum(1.0 - x * x, 0.0) ** 3, ()),
        (lambda x: np.where(np.abs(x - 0.05) < 2.0, 1.0, 0.0), ()),
        (lambda x: 1.0 / (1.0 + x * x) ** 2, None),
    ],
)
@pytest.mark.parametrize("alpha", [1.2, 1.5, 1.8])
def test_any_data_end_in_the_fundamental_solution_of_their_mass(data, tail, alpha):
    u0 = data(line(1000, 0.1))
    u, h = evolve_long(u0, 0.1, alpha, 1e9, tail=tail)
    exact = 0.1 * u0.sum() * fp.green(line(1000, h), 1e9, alpha)
    # The first moment moves the centre by about one in a width of a million.
    assert np.abs(u - exact).max() <= 1e-5 * exact.max()


def test_a_tail_heavier_than_that_of_the_solution():
    """u^ = pi exp(-k): by quadrature."""
    alpha, later = 1.5, 1e4
    u, h = evolve_long(1.0 / (1.0 + line(1000, 0.1) ** 2), 0.1, alpha, later, tail=(2.0, 4.0))
    k = np.geomspace(1e-12, 40.0, 400001) / later ** (1.0 / alpha)
    for i in (500, 510, 560):
        x = (i - 500) * h
        exact = np.trapezoid(np.cos(k * x) * np.exp(-k - later * k**alpha) * k, np.log(k))
        assert u[i] == pytest.approx(exact, rel=1e-6)


def test_a_short_time_is_that_of_evolve_and_leaves_the_lattice_alone():
    x = line(400, 0.1)
    u, h = evolve_long(np.exp(-x * x), 0.1, 1.5, 0.1, tail=())
    assert h == 0.1
    assert np.abs(u - fp.evolve(np.exp(-x * x), 0.1, 1.5, 0.1, tail=(), terms=5)).max() < 1e-9


@settings(max_examples=20)
@given(st.floats(1.1, 1.9), st.floats(1.0, 1e8), st.floats(0.01, 100.0), st.floats(0.01, 100.0))
def test_units_do_not_matter(alpha, later, length, diffusivity):
    u, h = evolve_long(blob(400, 0.1, 1.0, alpha, 1, 0.0), 0.1, alpha, later)
    scaled = length**alpha / diffusivity
    v, H = evolve_long(blob(400, 0.1, 1.0, alpha, 1, 0.0), 0.1 * length, alpha, later * scaled,
                       diffusivity=diffusivity)  # fmt: skip
    assert min(abs(H / (h * length) - ratio) for ratio in (0.5, 1.0, 2.0)) < 1e-9
    if abs(H / (h * length) - 1.0) < 1e-9:
        assert np.abs(u - v).max() <= 1e-9 * u.max()


@pytest.mark.parametrize("h", [1e-3, 1e3])
def test_the_lattice_widens_as_often_in_any_unit(h):
    u = blob(400, 1.0, 30.0, 1.5, 1, 0.0)
    in_spacings = evolve_long(u, 1.0, 1.5, 1e4)
    again = evolve_long(u, h, 1.5, 1e4 * h**1.5)
    assert again[1] == pytest.approx(h * in_spacings[1], rel=1e-15)
    assert again[0] == pytest.approx(in_spacings[0], rel=1e-9)


def test_a_million_units_of_time_cost_a_few_times_what_ten_do():
    """Doublings and not units of time are paid for. Side by side, the least of some repeats."""
    u0, least = blob(800, 0.1, 0.2, 1.5, 1, 0.0), {10.0: np.inf, 1e6: np.inf}
    for _ in range(7):
        for later in least:
            start = time.perf_counter()
            evolve_long(u0, 0.1, 1.5, later)
            least[later] = min(least[later], time.perf_counter() - start)
    assert least[1e6] <= 10.0 * least[10.0]


def test_a_lattice_of_few_points_is_warned_of():
    with pytest.warns(AccuracyWarning, match="Take [0-9]+, with the same spacing"):
        evolve_long(blob(100, 0.1, 0.2, 1.2, 1, 0.0), 0.1, 1.2, 1e6)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        evolve_long(blob(400, 0.1, 0.2, 1.2, 1, 0.0), 0.1, 1.2, 1e6)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"u": np.ones((20, 30))}, "u"),
        ({"u": 1.0}, "u"),
        ({"u": [np.nan] * 40}, "u"),
        ({"spacing": 0.0}, "spacing"),
        ({"alpha": 2.0}, "alpha"),
        ({"time": -1.0}, "time"),
        ({"diffusivity": 0.0}, "diffusivity"),
        ({"tail": (0.5,)}, "tail"),
    ],
)
def test_what_is_refused(changes, field):
    given_ = {"u": np.ones(400), "spacing": 0.1, "alpha": 1.5, "time": 1.0, **changes}
    with pytest.raises(InvalidInput) as refused:
        evolve_long(**given_)
    assert refused.value.field == field
