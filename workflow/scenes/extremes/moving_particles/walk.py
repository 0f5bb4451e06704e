"""The random walk at the ends of the order and of the numbers."""

import math
from collections.abc import Iterator
from itertools import pairwise, product

import mpmath
import numpy as np
from scipy.special import ndtr
from scipy.stats import binom

from fracparticles.moving.random_walk import (
    cell_counts,
    cell_masses,
    expected_deviation,
    stable_variates,
    walk,
)
from fracparticles.moving.walkers import few_walkers_beyond, walkers_to_equal
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe

# sqrt(n) max |F_n - F| is above with a probability of 2 exp(-2 2.3^2) = 5e-5 (Kolmogorov).
_SURE = 2.3
_SEED = 7


def laws(walkers: int) -> Iterator[Probe]:
    """Increments next to alpha = 1 and 2: Cauchy's law and the normal one of variance 2; in many steps as in one."""
    next_to = float(np.nextafter(1.0, 2.0)), float(np.nextafter(2.0, 1.0))
    for alpha, steps in product((next_to[0], 1.0 + 1e-6, 2.0 - 1e-6, next_to[1]), (1, 10)):
        right = Kind("walk", f"the law of α = {round(alpha)}", _SURE, "closed form", HELD)
        near = f"1 + {alpha - 1.0:.0e}" if alpha < 1.5 else f"2 - {2.0 - alpha:.0e}"
        name = f"α = {near}, {steps} step{'s' if steps > 1 else ''}"
        yield right(name, _distance, alpha, walkers, steps)


def _distance(alpha: float, walkers: int, steps: int) -> float:
    """Kolmogorov's sqrt(n) max |F_n - F|."""
    x = np.sort(walk(np.zeros(walkers), alpha, 1.0, np.random.default_rng(_SEED), steps=steps))
    f = 0.5 + np.arctan(x) / math.pi if alpha < 1.5 else ndtr(x / math.sqrt(2.0))
    edges = np.arange(walkers + 1) / walkers
    return math.sqrt(walkers) * float(max((edges[1:] - f).max(), (f - edges[:-1]).max()))


def units() -> Iterator[Probe]:
    """The same numbers in other units, to the end of what is a length; beyond, the walk says so."""
    same = Kind("walk", "the same walk", 64.0 * EPS, "scaling")
    for alpha, unit in ((1.5, 1e-60), (1.5, 1e60), (1.001, 1e95)):
        yield same(f"α = {alpha:g}, lengths times {unit:g}", _other_units, alpha, unit)
    cases = {"(D dt)^(1/α) = 1e-120": (1e-100,), "(D dt)^(1/α) = 1e120": (1e100,)}
    dice = np.random.default_rng(_SEED)
    yield from Kind("walk", must=REFUSED).over(
        lambda time: walk([0.0], 1.2, time, dice, diffusivity=time**0.44), cases
    )


def _other_units(alpha: float, unit: float) -> float:
    plain, other = (
        walk(np.zeros(100), alpha, t, np.random.default_rng(_SEED), diffusivity=d)
        for t, d in ((1.0, 1.0), (unit ** (0.5 * alpha), unit ** (0.5 * alpha)))
    )
    # Exponents of 1e60 are logarithms of 138, of which an ulp is lost.
    return float(np.abs(other / unit / plain - 1.0).max()) / math.log(max(unit, 1.0 / unit))


def cells() -> Iterator[Probe]:
    """Every walker inside is counted, also next to the end; masses of cells near and far are those of Cauchy's law."""
    ends = np.array([-1.0, np.nextafter(-1.0, -2.0), np.nextafter(1.0, 0.0), 1.0])
    inside = Kind("cells", "two are inside", must=HELD)
    for cells in (3, 7, 10, 1000):
        yield inside(f"walkers at the ends of {cells} cells", _miscounted, ends, cells)
    edges = np.array([-np.inf, -1e100, -1e8, -1.0, 0.0, 1e-8, 1.0, 1e8, 1e100, np.inf])
    for k, (low, high) in enumerate(pairwise(edges)):
        # Of a tail x^-alpha the small part of alpha is seen as its logarithm.
        nearest = min(max(abs(low), 1.0), max(abs(high), 1.0))
        bound = 2e-12 * (1.0 + math.log(nearest))
        right = Kind("cells", "its mass, relative", bound, "closed form")
        yield right(f"cell from {low:g} to {high:g}, α = 1 + 1e-12", _mass_off, edges, k)
    yield Kind("cells", must=REFUSED)("cells that fall", cell_masses, edges[::-1], 1.0, 1.0 + 1e-12)


def _miscounted(ends: np.ndarray, cells: int) -> float:
    counts = cell_counts(ends, 1.0, cells)[0]
    return float(abs(counts[0] - 1) + abs(counts[-1] - 1) + abs(counts.sum() - 2))


def _mass_off(edges: np.ndarray, k: int) -> float:
    with mpmath.workdps(250):
        low, high = (mpmath.atan(mpmath.mpf(float(e))) for e in edges[k : k + 2])
        exact = (high - low) / mpmath.pi
        return abs(float(cell_masses(edges, 1.0, 1.0 + 1e-12)[k] / exact - 1))


def numbers() -> Iterator[Probe]:
    """Deviations of counts and numbers of walkers for masses from 1e-300 to one."""
    # Logarithms of up to 1000 log 1000 are rounded.
    mean = Kind("cells", "E |N/n - p|", 1e-11, "scipy")
    for p, n in ((1e-300, 10), (1e-9, 1000), (0.5, 1), (0.3, 1000), (1.0 - 1e-12, 1000)):
        yield mean(f"{n} walkers, p = {p:.3g}", _deviation_off, p, n)
    few = Kind("cells", "where few are left", 1e-10, "closed form")
    for count in (1, 10**4, 10**12):
        yield few(f"{count:.0e} walkers, α = 1 + 1e-12", _few_off, count)
    dice = np.random.default_rng()
    yield from Kind("cells", must=REFUSED).of(
        {
            "no mass to equal": lambda: walkers_to_equal([0.0, 0.0], 0.1),
            "masses of 1e-320": lambda: walkers_to_equal([1e-320], 0.1),
            "10^400 walkers": lambda: few_walkers_beyond(10**400, 1.0, 1.0, 1.5),
            "2.5 walkers": lambda: stable_variates(1.5, 2.5, dice),  # type: ignore[arg-type]
        }
    )


def _deviation_off(p: float, n: int) -> float:
    m = np.arange(n + 1)
    exact = float(binom.pmf(m, n, p) @ np.abs(m / n - p)) if p > 1e-200 else 2.0 * p
    return abs(float(expected_deviation(p, n)) / exact - 1.0)


def _few_off(count: int) -> float:
    """n w G(x, 1) = 10 for Cauchy's G and w = 1: x = sqrt(n / (10 pi) - 1)."""
    exact = math.sqrt(max(count / (10.0 * math.pi) - 1.0, 0.0))
    found = few_walkers_beyond(count, 1.0, 1.0, 1.0 + 1e-12)
    return abs(found - exact) / max(exact, 1.0)
