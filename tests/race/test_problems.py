"""The problems of the race: each solution against another way to it."""

from __future__ import annotations

from functools import cache

import mpmath as mp
import numpy as np
import pytest

from fracparticles.time.whole_space import evolve
from fracstudy.race.problem import distance, lattice
from fracstudy.race.problems import PROBLEMS

CASES = [
    (name, dim, beta)
    for name, kind in PROBLEMS.items()
    for dim in kind.dims
    for beta in (0.1, 0.5, 0.9)
    if (dim == 1 or beta == 0.5) and not (name == "two scales" and (dim > 1 or beta == 0.1))
]


@pytest.mark.parametrize(("name", "dim", "beta"), CASES)
def test_the_solution_is_that_of_the_exact_symbol(name, dim, beta):
    """On lattices that resolve the data: h^4 of compact data, and h = 0.005 for the blob of width 0.01."""
    problem = PROBLEMS[name](beta, dim)
    points, half_width = {1: (4096, 8.0 * problem.width), 2: (192, 16.0), 3: (64, 10.0)}[dim]
    if name == "two scales":
        points = 16384
    x, h = lattice(points, half_width, dim), 2.0 * half_width / points
    u = evolve(
        problem.initial(x), h, problem.alpha, 1.0, terms=4 if dim == 1 else 2, tail=problem.tail
    )
    coarse = name == "compact"
    bound = {1: 1e-6 if coarse else 2e-8, 2: 1e-3 if coarse else 1e-6, 3: 5e-3 if coarse else 1e-5}[
        dim
    ]
    assert problem.error(x, h**dim, u) <= bound


@pytest.mark.parametrize(
    ("name", "transform"), [("other tail", lambda k: mp.pi * mp.exp(-k)), ("compact", None)]
)
def test_the_quadrature_is_that_of_mpmath(name, transform):
    problem = PROBLEMS[name](0.5, 1)
    if transform is None:

        @cache  # the nodes are the same at every place
        def transform(k):
            return 2 * mp.quad(lambda y: (1 - y * y) ** 3 * mp.cos(k * y), [0, 1])

    for at in (0.0, 1.3, 4.0):
        exact = mp.quad(
            lambda k, at=at: transform(k) * mp.exp(-(k**1.5)) * mp.cos(k * at) / mp.pi,
            [0, 1, 2, 4, 8, 12],
        )
        found = problem.exact((np.array([at]),))[0]
        assert found == pytest.approx(float(exact), rel=1e-7)


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_the_transform_of_compact_data_at_zero_is_their_mass(dim):
    """int (1 - r^2)^3 dx = pi^(n/2) 3! / Gamma(n/2 + 4)."""
    mass = float(mp.pi ** (dim / 2) * 6 / mp.gamma(dim / 2 + 4))
    problem = PROBLEMS["compact"](0.5, dim)
    assert problem.transform(np.array([0.0, 1e-4]))[0] == pytest.approx(mass)
    assert problem.transform(np.array([2e-3])) == pytest.approx(mass, rel=1e-6)


def test_errors_are_weighted_by_volumes():
    problem = PROBLEMS["fundamental"](0.5)
    x = (np.array([-1.0, 0.0, 2.0]),)
    exact = problem.exact(x)
    volumes = np.array([1.0, 2.0, 3.0])
    error = problem.error(x, volumes, exact + np.array([0.1, 0.0, 0.2]))
    assert error == pytest.approx((0.1 + 0.6) / (volumes * exact).sum())
    assert np.isnan(problem.error((np.array([0.0]),), 1.0, np.ones(1)))
    assert np.isnan(problem.tail_error(x, exact))


def test_lattices_and_distances():
    x = lattice(6, 3.0, 2)
    assert x[0].shape == (6, 1)
    assert x[1][0].tolist() == [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0]
    assert distance(x, (1.0,))[4, 3] == 0.0
    assert distance(x)[0, 0] == pytest.approx(np.sqrt(18.0))
