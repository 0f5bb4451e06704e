"""What the library offers for particles anywhere: strength exchange, Green steps, SPH derivatives."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from functools import partial
from itertools import product

import numpy as np

from fracparticles.errors import StabilityWarning
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
from fracstudy.probe import EPS, HELD, REFUSED, WARNED, Kind, Probe

__all__ = ["probes"]

_N = 120


def probes(seeds: int) -> Iterator[Probe]:
    """All of them."""
    yield from _exchange()
    yield from _growth()
    yield from _steps()
    yield from _graded()
    yield from _gaps()
    yield from _refused()


def _scattered(jitter: float, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    h = 10.0 / _N
    dice = np.random.default_rng(seed)
    lattice = h * (np.arange(_N) + 0.5) - 5.0
    x = (
        dice.uniform(-5.0, 5.0, _N)
        if jitter > 1.0
        else lattice + jitter * h * dice.uniform(-1.0, 1.0, _N)
    )
    x = np.sort(x)
    return x, cell_volumes(x)


def _exchange() -> Iterator[Probe]:
    """Strength exchange (26) in one, two and three dimensions, on any places with any volumes: nothing is lost."""
    conservation = Kind("conservation", "Σ Q kept", 64.0 * EPS, "exact sums", HELD)
    for dim, order in product((1, 2, 3), (2, 4)):
        yield conservation(
            f"PSE, {dim}-D, order {order}, random, any volumes", _total_lost, dim, order
        )
    for ratio in (1e100, 1e300):
        yield conservation(f"PSE, volumes from 1 to {ratio:g}", _uneven_lost, ratio)
    growth = Kind("growth", "no eigenvalue above zero", 64.0 * EPS, "dense eigenvalues", HELD)
    for jitter in (0.2, 0.5, 2.0):
        # An eigenvalue is known to some ulps of the greatest.
        yield growth(
            f"PSE, kernel (20), {'random' if jitter > 1.0 else f'jitter {jitter:g} h'}",
            _greatest_eigenvalue,
            jitter,
        )


def _quiet(*arguments: object) -> StrengthExchange:
    """The exchange, without what it says of growth and gaps: it is asked for what it conserves."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return StrengthExchange(*arguments)  # type: ignore[arg-type]


def _total_lost(dim: int, order: int) -> float:
    dice = np.random.default_rng(dim)
    x, v = dice.uniform(0.0, 3.0, (60, dim)), dice.exponential(0.1, 60) + 1e-3
    return _lost(_quiet(x, v, 0.6, construct_laplacian(order, dim)), dice.normal(size=60))


def _uneven_lost(ratio: float) -> float:
    x, _ = _scattered(0.5)
    v = np.where(np.arange(_N) % 2, 1.0, ratio)
    return _lost(_quiet(x, v, 0.2, GAUSSIAN_20), v * np.cos(x))


def _lost(exchange: StrengthExchange, q: np.ndarray) -> float:
    terms = exchange.matrix.multiply(q / np.abs(q).max()).toarray()
    return float(abs(terms.sum()) / np.abs(terms).sum())


def _greatest_eigenvalue(jitter: float) -> float:
    x, v = _scattered(jitter)
    exchange = StrengthExchange(x, v, 0.2, GAUSSIAN_20)
    root = np.sqrt(v)
    symmetric = exchange.matrix.toarray() * root / root[:, None]
    return max(float(np.linalg.eigvalsh(symmetric).max()), 0.0) / exchange.rate


def _growth() -> Iterator[Probe]:
    """Kernels of higher order are negative somewhere: on irregular particles strengths may grow, and that is said."""
    growth = Kind("growth", bound=0.01, source="dense eigenvalues")
    for order, overlap, jitter in product((4, 6, 8), (1.0, 2.0, 4.0), (0.2, 0.5, 2.0)):
        x, v = _scattered(jitter)
        exchange = _quiet(x, v, overlap * 10.0 / _N, construct(2, order))
        greatest = float(np.linalg.eigvals(exchange.matrix.toarray()).real.max())
        grows = greatest > 1e-5 * exchange.rate
        run = partial(_growth_missed, x, v, order, overlap, greatest if grows else 0.0)
        words = "random" if jitter > 1.0 else f"jitter {jitter:g} h"
        yield growth(
            f"PSE, order {order}, ε = {overlap:g} h, {words}",
            run,
            expected="growth, at the rate said" if grows else "no growth, no word",
            must=WARNED if grows else HELD,
        )


def _growth_missed(
    x: np.ndarray, v: np.ndarray, order: int, overlap: float, greatest: float
) -> tuple[float, str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        StrengthExchange(x, v, overlap * 10.0 / _N, construct(2, order))
    for one in caught:
        warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
    told = [str(w.message) for w in caught if issubclass(w.category, StabilityWarning)]
    said = float(told[0].split("exp(")[1].split()[0]) if told else 0.0
    return abs(said - greatest) / max(greatest, 1.0), f"said {said:.2g}, is {greatest:.2g}"


def _steps() -> Iterator[Probe]:
    """A Green step by exchange keeps the total on any particles; where it amplifies, it says so, and by how much."""
    h = 10.0 / _N
    conservation = Kind("conservation", "Σ V u kept", 64.0 * EPS, "exact sums", HELD)
    growth = Kind("growth", bound=1e-6, source="dense eigenvalues")
    for kind, right, overlap in product(
        ("jittered", "random", "clustered", "one place"), (True, False), (0.5, 2.0)
    ):
        if kind == "one place" and right:
            continue
        x, v = _crowd(kind)
        v = v if right else np.full(_N, h)
        run = partial(_columns_off, x, v, (overlap * h) ** 1.5)
        case = f"GPSE step, {kind}, {'right' if right else 'wrong'} volumes, ε = {overlap:g} h"
        yield conservation(case, run)
        greatest = _greatest_factor(x, v, (overlap * h) ** 1.5)
        grows = greatest > 1.0 + 1e-6
        yield growth(
            case,
            _factor_missed,
            x,
            v,
            (overlap * h) ** 1.5,
            greatest,
            expected="amplifies, and says so" if grows else "does not amplify",
            must=WARNED if grows else HELD,
        )


def _crowd(kind: str) -> tuple[np.ndarray, np.ndarray]:
    if kind == "one place":
        return np.zeros(_N), np.full(_N, 10.0 / _N)
    if kind != "clustered":
        return _scattered(0.5 if kind == "jittered" else 2.0)
    x = np.sort(np.random.default_rng(3).normal(size=_N))
    return x, cell_volumes(x)


def _columns_off(x: np.ndarray, v: np.ndarray, time: float) -> float:
    step = green_step(x, v, 1.5, time)
    return float(np.abs(v @ step - v).max() / (v @ np.abs(step)).max())


def _greatest_factor(x: np.ndarray, v: np.ndarray, time: float) -> float:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return float(np.abs(np.linalg.eigvals(green_step(x, v, 1.5, time))).max())


def _factor_missed(x: np.ndarray, v: np.ndarray, time: float, greatest: float) -> tuple[float, str]:
    """How much more is said than there is: the factor is a lower bound."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        green_step(x, v, 1.5, time)
    for one in caught:
        warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
    said = float(str(caught[0].message).split("factor ")[1].split()[0]) if caught else 1.0
    return max(said * (1.0 - 1e-3) / greatest - 1.0, 0.0), f"said {said:.3g}, is {greatest:.3g}"


def _graded() -> Iterator[Probe]:
    """Graded particles from 1e-100 to 1e100, steps from 1e-300 on: the exchange keeps constants."""
    graded = Kind("graded", "rows are 1", 1e-9, "limit")
    for reach, scale in ((1e100, 1e-100), (1e-100, 1e-100), (1e100, 1e100), (1e-60, 1e60)):
        yield graded(
            f"graded, reach {reach:g}, scale {scale:g}",
            _graded_off,
            reach,
            scale,
            bound=1e-12,
            source="exact sums",
            must=HELD,
        )
    for time in (1e-300, 1e-30):
        yield graded(
            f"field step, D T = {time:g}", _identity_off, time, expected="the identity inside"
        )


def _graded_off(reach: float, scale: float) -> float:
    x, v = graded_particles(41, reach, scale)
    return float(
        np.abs(green_step(x, v, 1.5, reach**1.5 if reach < 1e60 else 1.0).sum(axis=1) - 1.0).max()
    )


def _identity_off(time: float) -> float:
    step = green_step_of_field(41, 10.0, 1.0, 1.5, time)
    return float(np.abs(step - np.eye(41))[1:-1, 1:-1].max())


def _gaps() -> Iterator[Probe]:
    """Particles that do not reach one another, or whose volumes are not theirs: wrong by far only with a word."""
    lattice = np.linspace(-5.0, 5.0, 101)
    gaps = Kind("gaps", "f'' = 2, or a word", source="x²")
    for case, epsilon, volume in (
        ("ε = h / 100", 0.001, 0.1),
        ("volumes five times too large", 0.2, 0.5),
        ("volumes of h", 0.2, 0.1),
    ):
        yield gaps(f"PSE, {case}", _exchange_error, lattice, volume, epsilon, bound=0.1)
    for case, z, epsilon in (
        ("among the particles", 0.05, 0.2),
        ("far from all", 50.0, 0.2),
        ("ε = h / 100", 0.0, 0.001),
    ):
        yield gaps(f"derivative (21), {case}", _derivative_error, lattice, z, epsilon, bound=0.1)
    for case, x in (("neighbours", np.arange(-3.0, 4.0)), ("one at 1.999 h", np.array([1.999]))):
        yield gaps(
            f"SPH gradient, {case}",
            _slope_error,
            x,
            expected="0 of a constant, or a word",
            bound=1e-12,
            source="constants",
        )
        yield gaps(f"SPH second derivative, {case}", _curvature_error, x, bound=1e-6)
    for jitter in (0.2, 0.5):
        yield gaps(
            f"corrected SPH gradient, jitter {jitter:g} h",
            _line_error,
            jitter,
            expected="exact for lines",
            bound=1e-9,
            source="lines",
            must=HELD,
        )


def _exchange_error(x: np.ndarray, volume: float, epsilon: float) -> float:
    rate = StrengthExchange(x, volume, epsilon, GAUSSIAN_20).apply(volume * x * x) / volume
    return float(np.abs(rate[30:71] / 2.0 - 1.0).max())


def _derivative_error(x: np.ndarray, z: float, epsilon: float) -> float:
    return abs(
        float(derivative([z], [z * z], x, x * x, 0.1, epsilon, GAUSSIAN_20, 2)[0]) / 2.0 - 1.0
    )


def _slope_error(x: np.ndarray) -> float:
    return abs(float(gradient([0.0], x, 1.0, np.ones(x.size), 1.0)[0]))


def _curvature_error(x: np.ndarray) -> float:
    return abs(float(second_derivative([0.0], [0.0], x, 1.0, x * x, 1.0, 0.0)[0]) / 2.0 - 1.0)


def _line_error(jitter: float) -> float:
    x, v = _scattered(jitter)
    return max(
        abs(float(gradient([p], x, v, 3.0 * (x - p), 0.2)[0]) - 3.0)
        for p in np.linspace(-4.0, 4.0, 9)
    )


def _refused() -> Iterator[Probe]:
    """What means nothing."""
    x = np.arange(9.0)
    cases = {
        "two particles in one place, cells": lambda: float(cell_volumes([0.0, 0.0])[0]),
        "a volume of zero": lambda: StrengthExchange(x, 0.0, 1.0, GAUSSIAN_20).rate,
        "volumes of 5e-324": lambda: StrengthExchange(x, 5e-324, 1.0, GAUSSIAN_20).rate,
        "volumes of 1e307": lambda: StrengthExchange(x, 1e307, 1.0, GAUSSIAN_20).rate,
        "a gradient from one particle, in its place": lambda: float(
            gradient([0.0], [0.0], 1.0, [1.0], 1.0)[0]
        ),
        "a Green step of no time": lambda: float(green_step(x, np.ones(9), 1.5, 0.0)[0, 0]),
        "volumes of 1e200 for a step": lambda: float(
            green_step(x, np.full(9, 1e200), 1.5, 1.0)[0, 0]
        ),
    }
    refused = Kind("refused", must=REFUSED)
    for case, run in cases.items():
        yield refused(case, run)
