"""What the library offers for particles anywhere: strength exchange, Green steps, SPH derivatives."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np

from fracparticles.graded.field import green_step_of_field
from fracparticles.graded.particles import graded_particles, green_step
from fracparticles.pse import (
    GAUSSIAN_20,
    StrengthExchange,
    cell_volumes,
    construct,
    construct_laplacian,
    derivative,
)
from fracparticles.sph.derivatives import gradient, second_derivative
from fracstudy.probe import EPS, HELD, REFUSED, WARNED, Kind, Probe, off, overheard, quiet
from scenes.extremes.irregular_particles.theory import volumes

_N = 120
_H = 10.0 / _N


def _words(jitter: float) -> str:
    return "random" if jitter > 1.0 else f"jitter {jitter:g} h"


def _scattered(jitter: float) -> tuple[np.ndarray, np.ndarray]:
    """Particles in |x| < 5 with their volumes: of a lattice, each moved by up to `jitter` h, or anywhere."""
    dice = np.random.default_rng(1)
    if jitter > 1.0:
        x = dice.uniform(-5.0, 5.0, _N)
    else:
        x = _H * (np.arange(_N) + 0.5) - 5.0 + jitter * _H * dice.uniform(-1.0, 1.0, _N)
    x = np.sort(x)
    return x, cell_volumes(x)


def exchange() -> Iterator[Probe]:
    """Strength exchange (26) in one, two and three dimensions, on any places with any volumes: nothing is lost."""
    kept = Kind("conservation", "Σ Q kept", 64.0 * EPS, "exact sums", HELD)
    for dim, order in product((1, 2, 3), (2, 4)):
        yield kept(f"PSE, {dim}-D, order {order}, random, any volumes", _total_lost, dim, order)
    for ratio in (1e100, 1e300):
        yield kept(f"PSE, volumes from 1 to {ratio:g}", _uneven_lost, ratio)
    # An eigenvalue is known to some ulps of the greatest.
    stays = Kind("growth", "no eigenvalue above zero", 64.0 * EPS, "dense eigenvalues", HELD)
    for jitter in (0.2, 0.5, 2.0):
        yield stays(f"PSE, kernel (20), {_words(jitter)}", _greatest_eigenvalue, jitter)


def _total_lost(dim: int, order: int) -> float:
    dice = np.random.default_rng(dim)
    x, v = dice.uniform(0.0, 3.0, (60, dim)), dice.exponential(0.1, 60) + 1e-3
    with quiet(Warning):  # of growth and gaps
        exchange = StrengthExchange(x, v, 0.6, construct_laplacian(order, dim))
    return _lost(exchange, dice.normal(size=60))


def _uneven_lost(ratio: float) -> float:
    x, _ = _scattered(0.5)
    v = np.where(np.arange(_N) % 2, 1.0, ratio)
    with quiet(Warning):
        return _lost(StrengthExchange(x, v, 0.2, GAUSSIAN_20), v * np.cos(x))


def _lost(exchange: StrengthExchange, q: np.ndarray) -> float:
    terms = exchange.matrix.multiply(q / np.abs(q).max()).toarray()
    return float(abs(terms.sum()) / np.abs(terms).sum())


def _greatest_eigenvalue(jitter: float) -> float:
    x, v = _scattered(jitter)
    exchange = StrengthExchange(x, v, 0.2, GAUSSIAN_20)
    root = np.sqrt(v)
    symmetric = exchange.matrix.toarray() * root / root[:, None]
    return max(float(np.linalg.eigvalsh(symmetric).max()), 0.0) / exchange.rate


def growth() -> Iterator[Probe]:
    """Kernels of higher order are negative somewhere: on irregular particles strengths may grow, and that is said."""
    stays = Kind("growth", "no growth, no word", 0.01, "dense eigenvalues", HELD)
    grows = replace(stays, expected="growth, at the rate said", must=WARNED)
    for order, overlap, jitter in product((4, 6, 8), (1.0, 2.0, 4.0), (0.2, 0.5, 2.0)):
        makes = partial(StrengthExchange, *_scattered(jitter), overlap * _H, construct(2, order))
        with quiet(Warning):
            exchange = makes()
        greatest = float(np.linalg.eigvals(exchange.matrix.toarray()).real.max())
        greatest = greatest if greatest > 1e-5 * exchange.rate else 0.0
        name = f"PSE, order {order}, ε = {overlap:g} h, {_words(jitter)}"
        yield (grows if greatest else stays)(name, _growth_missed, makes, greatest)


def _growth_missed(makes: Callable[[], object], greatest: float) -> tuple[float, str]:
    with overheard() as words:
        makes()
    rates = [word.split("exp(")[1].split()[0] for word in words if "exp(" in word]
    said = float(rates[0]) if rates else 0.0
    return abs(said - greatest) / max(greatest, 1.0), f"said {said:.2g}, is {greatest:.2g}"


def steps() -> Iterator[Probe]:
    """A Green step by exchange keeps the total on any particles; where it amplifies, it says so, and by how much."""
    kept = Kind("conservation", "Σ V u kept", 64.0 * EPS, "exact sums", HELD)
    stays = Kind("growth", "does not amplify", 1e-6, "dense eigenvalues", HELD)
    grows = replace(stays, expected="amplifies, and says so", must=WARNED)
    kinds = ("jittered", "random", "clustered", "one place")
    for kind, right, overlap in product(kinds, (True, False), (0.5, 2.0)):
        if kind == "one place" and right:
            continue
        x, v = _crowd(kind)
        v = v if right else np.full(_N, _H)
        makes = partial(green_step, x, v, 1.5, (overlap * _H) ** 1.5)
        name = f"GPSE step, {kind}, {volumes(right)}, ε = {overlap:g} h"
        yield kept(name, _columns_off, v, makes)
        with quiet(Warning):
            greatest = float(np.abs(np.linalg.eigvals(makes())).max())
        yield (grows if greatest > 1.0 + 1e-6 else stays)(name, _factor_missed, makes, greatest)


def _crowd(kind: str) -> tuple[np.ndarray, np.ndarray]:
    if kind == "one place":
        return np.zeros(_N), np.full(_N, _H)
    if kind != "clustered":
        return _scattered(0.5 if kind == "jittered" else 2.0)
    x = np.sort(np.random.default_rng(3).normal(size=_N))
    return x, cell_volumes(x)


def _columns_off(v: np.ndarray, makes: Callable[[], np.ndarray]) -> float:
    step = makes()
    return float(np.abs(v @ step - v).max() / (v @ np.abs(step)).max())


def _factor_missed(makes: Callable[[], np.ndarray], greatest: float) -> tuple[float, str]:
    """How much more is said than there is: the factor is a lower bound."""
    with overheard() as words:
        makes()
    said = float(words[0].split("factor ")[1].split()[0]) if words else 1.0
    return max(said * (1.0 - 1e-3) / greatest - 1.0, 0.0), f"said {said:.3g}, is {greatest:.3g}"


def graded() -> Iterator[Probe]:
    """Graded particles from 1e-100 to 1e100, steps from 1e-300 on: the exchange keeps constants."""
    kept = Kind("graded", "rows are 1", 1e-12, "exact sums", HELD)
    for reach, scale in ((1e100, 1e-100), (1e-100, 1e-100), (1e100, 1e100), (1e-60, 1e60)):
        yield kept(f"graded, reach {reach:g}, scale {scale:g}", _graded_off, reach, scale)
    still = Kind("graded", "the identity inside", 1e-9, "limit")
    for time in (1e-300, 1e-30):
        step = partial(green_step_of_field, 41, 10.0, 1.0, 1.5, time)
        yield still(f"field step, D T = {time:g}", lambda: off(step()[1:-1, 1:-1], np.eye(39)))


def _graded_off(reach: float, scale: float) -> float:
    x, v = graded_particles(41, reach, scale)
    return off(green_step(x, v, 1.5, reach**1.5 if reach < 1e60 else 1.0).sum(axis=1), 1.0)


def gaps() -> Iterator[Probe]:
    """Particles that do not reach one another, or whose volumes are not theirs: wrong by far only with a word."""
    lattice = np.linspace(-5.0, 5.0, 101)
    curvature = Kind("gaps", "f'' = 2, or a word", 0.1, "x²")
    cases = {
        "PSE, ε = h / 100": (lattice, 0.1, 0.001),
        "PSE, volumes five times too large": (lattice, 0.5, 0.2),
        "PSE, volumes of h": (lattice, 0.1, 0.2),
    }
    yield from curvature.over(_exchange_error, cases)
    places = {"among the particles": (0.05, 0.2), "far from all": (50.0, 0.2)}
    for case, (z, epsilon) in (places | {"ε = h / 100": (0.0, 0.001)}).items():
        second = partial(derivative, [z], [z * z], lattice, lattice**2, 0.1, epsilon)
        name = f"derivative (21), {case}"
        yield curvature(name, lambda: abs(float(second(GAUSSIAN_20, 2)[0]) / 2.0 - 1.0))
    slope = Kind("gaps", "0 of a constant, or a word", 1e-12, "constants")
    for case, x in (("neighbours", np.arange(-3.0, 4.0)), ("one at 1.999 h", np.array([1.999]))):
        yield slope(
            f"SPH gradient, {case}",
            lambda: abs(float(gradient([0.0], x, 1.0, np.ones(x.size), 1.0)[0])),
        )
        second = partial(second_derivative, [0.0], [0.0], x, 1.0, x * x, 1.0, 0.0)
        name = f"SPH second derivative, {case}"
        yield curvature(name, lambda: abs(float(second()[0]) / 2.0 - 1.0), bound=1e-6)
    exact = Kind("gaps", "exact for lines", 1e-9, "lines", HELD)
    for jitter in (0.2, 0.5):
        yield exact(f"corrected SPH gradient, jitter {jitter:g} h", _line_error, jitter)


def _exchange_error(x: np.ndarray, volume: float, epsilon: float) -> float:
    rate = StrengthExchange(x, volume, epsilon, GAUSSIAN_20).apply(volume * x * x) / volume
    return off(rate[30:71] / 2.0, 1.0)


def _line_error(jitter: float) -> float:
    x, v = _scattered(jitter)
    slopes = [gradient([p], x, v, 3.0 * (x - p), 0.2)[0] for p in np.linspace(-4.0, 4.0, 9)]
    return max(abs(float(slope) - 3.0) for slope in slopes)


def refused() -> Iterator[Probe]:
    """What means nothing."""
    x = np.arange(9.0)
    yield from Kind("refused", must=REFUSED).of(
        {
            "two particles in one place, cells": lambda: cell_volumes([0.0, 0.0]),
            "a volume of zero": lambda: StrengthExchange(x, 0.0, 1.0, GAUSSIAN_20),
            "volumes of 5e-324": lambda: StrengthExchange(x, 5e-324, 1.0, GAUSSIAN_20),
            "volumes of 1e307": lambda: StrengthExchange(x, 1e307, 1.0, GAUSSIAN_20),
            "a gradient from one particle, in its place": lambda: gradient(
                [0.0], [0.0], 1.0, [1.0], 1.0
            ),
            "a Green step of no time": lambda: green_step(x, np.ones(9), 1.5, 0.0),
            "volumes of 1e200 for a step": lambda: green_step(x, np.full(9, 1e200), 1.5, 1.0),
        }
    )
