"""The contenders of the race: each solves the problem, by an independent value; trials are judged and timed alike."""

from __future__ import annotations

import itertools
import time
from contextlib import suppress

import numpy as np
import pytest
from scipy.linalg import expm, toeplitz
from scipy.special import gamma

from fracparticles.special.tails import tail_constant
from fracstudy.race.contender import Contender, Ready, lattices, sweep
from fracstudy.race.contenders import CONTENDERS
from fracstudy.race.contenders.differences import DuoWykZhang, FractionalCentred, HuangOberman
from fracstudy.race.contenders.rational import _functions
from fracstudy.race.problems import PROBLEMS
from fracstudy.race.trial import LABELS, VARIABLES, run_trials
from sweeps import covering

# One choice for each on the mixture, beta 0.5, and the error that it must reach; of those of second order
# the constants are theirs.
CHOICES = {
    "exact symbol, periodic": ({"variant": "", "points": 4000, "half_width": 400.0}, 1e-5),
    "WholeSpace": ({"variant": "", "points": 96, "half_width": 20.0, "terms": 4}, 1e-7),
    "evolve": ({"variant": "", "points": 96, "half_width": 20.0, "terms": 4}, 1e-7),
    "rational functions": ({"variant": "", "points": 64, "scale": 6.0}, 1e-6),
    "mapped Fourier": ({"variant": "", "points": 65, "scale": 3.0}, 1e-4),
    "fractional centred": ({"variant": "tails lent", "points": 4000, "half_width": 40.0}, 1e-4),
    "Duo-van Wyk-Zhang": ({"variant": "tails lent", "points": 4000, "half_width": 40.0}, 1e-4),
    "Huang-Oberman": ({"variant": "tails lent", "points": 4000, "half_width": 40.0}, 1e-5),
    "graded": ({"variant": "", "count": 97, "reach": 200.0, "scale": 3.0}, 1e-6),
    "DD": ({"variant": "", "order": 12, "spacing": 0.2, "truncation": 10.0}, 1e-4),
    "FPSE": ({"variant": "", "order": 12, "spacing": 0.2, "truncation": 10.0}, 1e-4),
    "KPSE": ({"variant": "", "order": 12, "spacing": 0.2, "truncation": 10.0}, 1e-5),
    "GPSE": (
        {
            "variant": "",
            "dt": 1.0,
            "spacing": 0.4,
            "truncation": 10.0,
            "exterior": "open",
            "far_terms": 3,
        },
        1e-6,
    ),
    "DVM": ({"variant": "", "order": 4, "spacing": 0.2, "dt": 0.02, "truncation": 10.0}, 2e-2),
}
OPEN = {
    "exterior": "open",
    "far_terms": 3,
    "integrator": "exponential",
    "evaluation": "convolution",
}


def choice(name: str) -> dict:
    given = dict(CHOICES[name][0])
    return {**given, **OPEN} if name in ("DD", "FPSE", "KPSE") else given


@pytest.mark.parametrize("name", list(CHOICES))
def test_each_solves_the_problem(name):
    problem = PROBLEMS["mixture"](0.5)
    ready = CONTENDERS[name]().prepare(problem, **choice(name))
    u = ready.solve(problem.initial(ready.x))
    assert problem.error(ready.x, ready.volumes, u) <= CHOICES[name][1]


@pytest.mark.parametrize("name", [name for name in CHOICES if name != "DVM"])
def test_data_at_once_are_each_alone(name):
    problem = PROBLEMS["mixture"](0.5)
    ready = CONTENDERS[name]().prepare(problem, **choice(name))
    if ready.batched:
        u0 = problem.initial(ready.x)
        block = ready.solve(np.array([u0, 2.0 * u0]))
        assert block[1] == pytest.approx(2.0 * ready.solve(u0), abs=1e-12)


def test_all_have_a_choice_here_but_the_papers_way():
    assert set(CONTENDERS) - set(CHOICES) == {"papers' way"}


def centred_weights(alpha: float, count: int) -> np.ndarray:
    """Return a_1 .. a_count of the fractional centred differences, by their recursion."""
    m = np.arange(1.0, count + 1.0)
    return (
        -gamma(alpha + 1.0)
        / gamma(0.5 * alpha + 1.0) ** 2
        * np.cumprod((m - 1.0 - 0.5 * alpha) / (m + 0.5 * alpha))
    )


@pytest.mark.parametrize(
    ("kind", "alpha"), covering([HuangOberman, DuoWykZhang, FractionalCentred], [1.1, 1.5, 1.9])
)
def test_a_symbol_is_the_sum_of_its_weights(kind, alpha):
    """Against the exponential of the Toeplitz matrix, in the middle of a lattice: its ends are 400 points away."""
    count, tau = 801, 0.7
    centred = kind is FractionalCentred
    weights = centred_weights(alpha, count - 1) if centred else kind().weights(alpha, count - 1)
    far = tail_constant(alpha) / alpha * (count - 0.5) ** -alpha
    row = np.concatenate([[-2.0 * (weights.sum() + far)], weights])
    u0 = np.exp(-0.05 * np.square(np.arange(count) - count // 2))
    dense = expm(tau * toeplitz(row)) @ u0
    circle = np.zeros(8192)
    circle[:count] = u0
    symbol = kind().symbol(np.linspace(0.0, np.pi, 4097), alpha)
    ours = np.fft.irfft(np.fft.rfft(circle) * np.exp(tau * symbol))[:count]
    middle = slice(count // 2 - 50, count // 2 + 50)
    # The circle's images, and what the dense matrix leaves out: u0's mass times the kernel 400 and 8000 points away.
    bound = (
        tau
        * tail_constant(alpha)
        * u0.sum()
        * (8000.0 ** (-1.0 - alpha) * 2.0 + 350.0 ** (-1.0 - 2.0 * alpha))
    )
    assert np.abs(dense - ours)[middle].max() <= 2.0 * bound + 1e-7


def test_the_laguerre_functions_are_orthonormal():
    _, functions, weights = _functions(12, 40)
    assert (functions * weights) @ functions.T == pytest.approx(np.eye(12), abs=1e-12)


class Echo(Contender):
    """Gives back the exact solution with an error that is asked for."""

    name, label, group = "echo", "echo", "peers"

    def trials(self, problem):
        yield from ({"variant": "a", "size": size} for size in (0.0, 0.5))

    def prepare(self, problem, variant, size):
        x = (np.linspace(-6.0, 6.0, 41),)
        return Ready(x, 0.3, lambda u0: (1.0 + size) * problem.exact(x))


def test_rows_of_trials():
    rows = run_trials(PROBLEMS["fundamental"](0.5), [Echo()], rounds=2, repeats=3, seconds=1.0)
    assert [row["error"] for row in rows] == pytest.approx([0.0, 0.5], abs=1e-15)
    assert set(rows[0]) <= {*LABELS, *VARIABLES}
    # One that leads, and is short: once, and in twenty times as many rounds.
    assert rows[0]["setups"] == rows[0]["solves"] == 1 + 20 * 2 * 3
    assert rows[0]["block_time"] > 0.0
    assert rows[0]["peak_memory"] > 0.0
    assert rows[0]["points"] == 41


class Slow(Echo):
    """Takes 20 ms to be made ready."""

    name, follows = "slow", Echo.name

    def prepare(self, problem, variant, size):
        time.sleep(0.02)
        return super().prepare(problem, variant, size)


def test_what_takes_long_is_timed_at_fewer_moments():
    rows = run_trials(PROBLEMS["fundamental"](0.5), [Slow()], rounds=1, repeats=3, seconds=1.0)
    # After three moments no more: they have taken longer than 0.015 s.
    assert rows[0]["setups"] == rows[0]["solves"] == 1 + 3 * 3


def test_who_follows_tries_what_is_near_the_front_of_the_other():
    contenders = Echo(), Slow()
    rows = run_trials(PROBLEMS["fundamental"](0.5), contenders, rounds=1, repeats=1, seconds=1.0)
    errors = {
        name: [r["error"] for r in rows if r["contender"] == name] for name in ("echo", "slow")
    }
    assert len(errors["echo"]) == 2
    assert 0 < len(errors["slow"]) <= 2
    assert min(errors["slow"]) < 1e-15


def test_a_sweep_ends_with_an_error_that_is_small_enough():
    grids = {(fine, 0): {"points": 2**fine} for fine in range(6)}
    trials = sweep(grids, variant="a")
    tried = [next(trials)["points"]]
    with suppress(StopIteration):
        for error in (1e-3, 1e-9, 1e-11, 1e-13):
            tried.append(trials.send(error)["points"])
    assert tried == [1, 2, 4]


def test_a_sweep_leaves_out_what_gains_nothing():
    """Of errors h^4 + C^-3 that fall with h and C, each part by more than 1 / 0.9 a step: no better grid is missed."""
    places = list(itertools.product(range(8), range(6)))
    error = {(i, k): 2.0 ** (-4.0 * i) + 2.0 ** (-3.0 * k) for i, k in places}
    whole = list(sweep({place: {"place": place} for place in places}, variant="a"))
    assert [given["place"] for given in whole] == places  # nobody says an error
    trials = sweep({place: {"place": place} for place in places}, variant="a")
    tried, given = [], next(trials)
    with suppress(StopIteration):
        while True:
            tried.append(given["place"])
            given = trials.send(error[given["place"]])
    assert len(tried) < 0.8 * len(places)
    for i, k in set(places) - set(tried):
        least = min(error[a, b] for a, b in tried if a <= i and b <= k and (a, b) != (i, k))
        assert error[i, k] > 0.85 * least


def test_lattices_are_even_and_not_too_large():
    problem = PROBLEMS["fundamental"](0.5)
    given = list(lattices(problem).values())
    assert len(given) == len({(one["points"], one["half_width"]) for one in given}) > 40
    assert all(one["points"] % 2 == 0 and one["points"] <= 2**16 for one in given)
