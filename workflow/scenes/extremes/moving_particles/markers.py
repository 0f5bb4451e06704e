"""Markers: shape functions, support, steps, signs, units and loads."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from fracparticles.errors import FracparticlesWarning
from fracparticles.markers import (
    SHAPES,
    Gaussian,
    MarkerVelocity,
    Square,
    equal_weight,
    random,
    run,
    uniform,
)
from fracparticles.markers.accuracy import optimal_support
from fracparticles.markers.fourier import FourierMarkerVelocity
from fracparticles.markers.growth import largest_step, measured_rate
from fracparticles.markers.stability import extremes, lattice_rate
from fracstudy.probe import EPS, HELD, REFUSED, WARNED, Kind, Probe

__all__ = ["probes", "support_errors", "wave_growth"]

_SPOKEN = 0.05  # error of a run that must be spoken of
_FACTORS = (0.9, 0.99, 1.01, 1.1, 1.5)  # of the limit of a step
_SMOOTH = ("S4", "S6", "S8")  # with a second derivative, so that markers on a lattice have a rate
_XI, _STEPS = 1e-6, 5  # height of a wave, in epsilon
_WIDE, _NARROW = (
    5.0,
    2.5,
)  # half-widths of a Gaussian; S8, of both signs, needs a field that is not too weak


def probes(shapes: Sequence[str], count: int, supports: Sequence[float]) -> Iterator[Probe]:
    """All of them; `count` markers a run, epsilon / h of some from `supports`."""
    yield from _solutions(shapes, count)
    yield from _growth()
    yield from _clusters()
    yield from _supports(count, supports)
    yield from _signs(count)
    yield from _units(count)
    yield from _tools()


def _gaussian(count: int, shape: str) -> tuple[np.ndarray, np.ndarray]:
    end = _NARROW if shape == "S8" else _WIDE
    return uniform(Gaussian().value, (-end, end), count)


def _solutions(shapes: Sequence[str], count: int) -> Iterator[Probe]:
    """The Gaussian, smoothed: variances s^2 of the markers and s^2 + m eps^2 of F, m = int S x^2, obey

        s^2 + m eps^2 log(s^2 / s_0^2) = s_0^2 + 2 t,

    as V = x / (s^2 + m eps^2). What is left is of the order eps^4, and the ripple between markers.
    """
    solution = Kind("solution")
    for name in shapes:
        shape = SHAPES[name]
        if shape.smoothness == 0:
            yield solution(f"{name}, whose F jumps", _smoothed_off, name, count, 0.3, must=REFUSED)
            continue
        many, epsilon = 5 * count, 0.2 if name == "S8" else 0.3
        spacing = (_NARROW if name == "S8" else _WIDE) * 2.0 / many
        # The fourth moment over 24 times the fourth derivative, 12 at the peak; the markers as (h / eps)^M, twice.
        fourth = 0.5 * epsilon**4 * abs(_moment(name, 4))
        order = 6 if shape.smoothness is None else shape.smoothness + 1
        yield solution(
            f"{name}, ε = {epsilon / spacing:g} h",
            _smoothed_off,
            name,
            many,
            epsilon,
            expected="the smoothed Gaussian",
            bound=fourth + 8.0 * (spacing / epsilon) ** order,
            source="closed form",
        )


def _moment(name: str, m: int) -> float:
    """int S x^m dx, from the transform: 1 - m2 k^2/2 + m4 k^4/24."""
    k = 0.05
    t1, t2 = (float(SHAPES[name].transform(f * k)) for f in (1.0, 2.0))
    second = -((16.0 * t1 - t2 - 15.0) / 12.0) * 2.0 / k**2
    if m == 2:
        return second
    return (t2 - 1.0 + 2.0 * second * k**2) * 24.0 / (2.0 * k) ** 4


def _smoothed_off(name: str, count: int, epsilon: float) -> float:
    x, w = _gaussian(count, name)
    limit = extremes(SHAPES[name]).eta * epsilon**2
    time = 0.1
    steps = math.ceil(4.0 * time / limit) + 4
    velocity = MarkerVelocity(SHAPES[name], epsilon)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FracparticlesWarning)  # clusters have no time to grow
        end = run(x, w, velocity, dt=time / steps, steps=steps)
    m, start = _moment(name, 2) * epsilon**2, 0.5
    variance = brentq(
        lambda s: s + m * math.log(s / start) - start - 2.0 * time, start, start + 2.0 * time
    )
    z = np.linspace(-1.0, 1.0, 81)
    exact = math.sqrt(0.5 / (variance + m)) * np.exp(-0.5 * z * z / (variance + m))
    return float(np.abs(end.field(z) - exact).max() / exact.max())


def _growth() -> Iterator[Probe]:
    """The wave that decays fastest, at steps about the limit of the lattice: 1 + z + z^2/2, and a word beyond."""
    step = Kind("step", "grows by 1 + z + z²/2", 1e-3, "lattice sum")
    for name, factor in product(_SMOOTH, _FACTORS):
        # Linear to the height of the wave; places are rounded to 1e-16 of 10, the wave is 1e-6.
        yield step(
            f"{name}, dt = {factor:g} η ε²",
            _wave_missed,
            name,
            factor,
            must=WARNED if factor > 1.0 else HELD,
        )


def _wave_missed(name: str, factor: float) -> tuple[float, str]:
    found, predicted = wave_growth(name, factor)
    return abs(found - predicted), f"{found:.3f}, predicted {predicted:.3f}"


def wave_growth(
    name: str, factor: float, steps: int = _STEPS, growing: bool = False
) -> tuple[float, float]:
    """Return what a step of `factor` times the limit multiplies a wave by, and 1 + z + z^2/2 of the lattice's rate."""
    shape = SHAPES[name]
    found = extremes(shape)
    k = found.k_growth if growing else found.k_decay
    wavelength, per = 2.0 * math.pi / k, 48
    waves = math.ceil((2.0 * shape.reach + 1.0) / wavelength)
    period, h = waves * wavelength, wavelength / per
    # A neighbour at epsilon, where S'' jumps, is inside as often as outside: none is there.
    lattice = h * (np.arange(waves * per) + 0.5)
    wave = np.cos(k * lattice)
    rate = float(lattice_rate(shape, k, h))
    dt = factor * found.eta
    velocity = MarkerVelocity(shape, 1.0, period=period)
    end = run(lattice + _XI * wave, np.full(lattice.size, h), velocity, dt=dt, steps=steps)
    left = float((end.x - lattice) @ wave / (wave @ wave) / _XI)
    z = dt * rate
    return float(np.copysign(abs(left) ** (1.0 / steps), left)), 1.0 + z + 0.5 * z * z


def _clusters() -> Iterator[Probe]:
    """Waves whose transform is negative grow at any step, at the predicted rate, and the run says so."""
    step = Kind("step", "grow at any step", 1e-3, "lattice sum", WARNED)
    for name in ("S4", "S6"):
        found = extremes(SHAPES[name])
        factor = 0.1
        steps = math.ceil(3.0 / (factor * found.eta * found.growth))
        yield step(
            f"{name}, waves of {2.0 * math.pi / found.k_growth:.2f} ε",
            _cluster_missed,
            name,
            factor,
            steps,
        )


def _cluster_missed(name: str, factor: float, steps: int) -> tuple[float, str]:
    found, predicted = wave_growth(name, factor, steps, growing=True)
    return abs(found - predicted), f"{found:.3f}, predicted {predicted:.3f}"


def _supports(count: int, supports: Sequence[float]) -> Iterator[Probe]:
    """Support parameters from a tenth of the spacing to fifty times: wrong by more than 5 % only with a word."""
    row = Kind("support", "within 5 %, or a word", _SPOKEN, "closed form")
    for name, support in product(("S4", "S8"), supports):
        yield row(f"{name}, ε = {support:g} h", _support_error, name, support, count)
    for name, load in product(("S4", "S8"), ("quiet start", "random")):
        yield row(f"{name}, {load}", _load_error, name, load, count)


def _support_error(name: str, support: float, count: int) -> float:
    x, w = _gaussian(count, name)
    return _error(name, x, w, support * float(x[1] - x[0]))


def _load_error(name: str, load: str, count: int) -> float:
    profile = Gaussian()
    if load == "random":
        x, w = random(profile, count, np.random.default_rng(4))
    else:
        x, w = equal_weight(profile, count)
    return _error(name, x, w, 0.1)


def _error(name: str, x: np.ndarray, w: np.ndarray, epsilon: float, time: float = 0.1) -> float:
    limit = extremes(SHAPES[name]).eta * epsilon**2
    steps = min(
        math.ceil(2.0 * time / limit), 400
    )  # of a smaller epsilon the first steps are enough
    dt = min(0.5 * limit, time / steps)
    end = run(x, w, MarkerVelocity(SHAPES[name], epsilon), dt=dt, steps=steps)
    z = np.linspace(-1.5, 1.5, 151)
    exact = Gaussian().value(z, dt * steps)
    return float(np.abs(end.field(z) - exact).max() / exact.max())


def support_errors(count: int, supports: Sequence[float]) -> pd.DataFrame:
    """Return the error of runs against epsilon / h, and whether they spoke."""
    rows = []
    for name, support in product(("S4", "S8"), supports):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                error = _support_error(name, support, count)
            except ArithmeticError:
                error = np.nan
        spoke = any(issubclass(one.category, FracparticlesWarning) for one in caught)
        rows.append({"series": name, "x": support, "y": error, "spoke": spoke})
    return pd.DataFrame(rows)


def _signs(count: int) -> Iterator[Probe]:
    """F of one sign, whichever; a weight of zero counts for nothing."""
    marker_signs = Kind("marker signs", must=HELD)
    yield marker_signs(
        "weights all negative", _sign_seen, count, expected="the same paths, bit for bit"
    )
    yield marker_signs("weights of zero between", _zero_seen, count, expected="the others' paths")
    x, w = _gaussian(count, "S4")
    refused: dict[str, tuple[np.ndarray, np.ndarray, str]] = {
        "weights of both signs": (x, w * np.sign(x), "S4"),
        "all weights zero": (x, 0.0 * w, "S4"),
        "S8 in a far tail": (*_gaussian(200, "S4"), "S8"),
        "a weight of nan": (x, np.where(x > 2.0, np.nan, w), "S4"),
    }
    for case, (places, weights, name) in refused.items():
        yield marker_signs(case, _run_once, places, weights, name, must=REFUSED)
    fast = FourierMarkerVelocity(0.2)
    yield marker_signs(
        "S8 by transforms, F below 1e-11",
        _fourier_once,
        fast,
        *uniform(Gaussian().value, (-7.0, 7.0), count),
        must=REFUSED,
    )


def _run_once(x: np.ndarray, w: np.ndarray, name: str) -> float:
    return float(run(x, w, MarkerVelocity(SHAPES[name], 0.2), dt=1e-3, steps=3).x.size)


def _fourier_once(velocity: MarkerVelocity, x: np.ndarray, w: np.ndarray) -> float:
    return float(run(x, w, velocity, dt=1e-3, steps=3).x.size)


def _sign_seen(count: int) -> float:
    x, w = _gaussian(count, "S4")
    velocity = MarkerVelocity(SHAPES["S4"], 0.5)
    one, other = (run(x, s * w, velocity, dt=0.01, steps=5).x for s in (1.0, -1.0))
    return float(np.abs(one - other).max())


def _zero_seen(count: int) -> float:
    x, w = _gaussian(count, "S4")
    velocity = MarkerVelocity(SHAPES["S4"], 0.5)
    plain = run(x, w, velocity, dt=0.01, steps=5).x
    more = np.sort(np.concatenate([x, 0.5 * (x[1:] + x[:-1])]))
    weights = np.zeros(more.size)
    weights[::2] = w
    return float(np.abs(run(more, weights, velocity, dt=0.01, steps=5).x - plain).max())


def _units(count: int) -> Iterator[Probe]:
    """Lengths times a power of two change no bit; a total in other units neither; periods do not count."""
    marker_units = Kind("marker units")
    for power in (-150, 150):
        yield marker_units(
            f"lengths times 2^{power}",
            _other_units,
            count,
            2.0**power,
            expected="no bit changes",
            source="scaling",
            must=HELD,
        )
    for scale in (1e-290, 1e290):
        # F and F_x are rounded alike, their quotient once more.
        yield marker_units(
            f"weights times {scale:g}",
            _other_weights,
            count,
            scale,
            expected="the same paths",
            bound=1e-12,
            source="scaling",
        )
    yield marker_units("weights of 1e308", _other_weights, count, 1e309, must=REFUSED)
    for periods in (1, 10**6):
        yield marker_units(
            f"periodic, {periods:g} periods away",
            _periods_off,
            periods,
            expected="the same velocity",
            bound=64.0 * EPS * periods * 4.0,
            source="scaling",
        )


def _other_units(count: int, unit: float) -> float:
    x, w = _gaussian(count, "S4")
    plain = run(x, w, MarkerVelocity(SHAPES["S4"], 0.5), dt=2.0**-7, steps=5)
    velocity = MarkerVelocity(SHAPES["S4"], 0.5 * unit)
    other = run(unit * x, w, velocity, dt=2.0**-7 * unit**2, steps=5)
    return float(np.abs(other.x / unit - plain.x).max())


def _other_weights(count: int, scale: float) -> float:
    x, w = _gaussian(count, "S4")
    with np.errstate(over="ignore"):
        scaled = scale * w
    velocity = MarkerVelocity(SHAPES["S4"], 0.5)
    one, other = (run(x, q, velocity, dt=0.01, steps=5).x for q in (w, scaled))
    return float(np.abs(one - other).max())


def _periods_off(periods: int) -> float:
    x = 4.0 * (np.arange(40) + 0.3 * np.sin(np.arange(40))) / 40.0
    velocity = MarkerVelocity(SHAPES["S8"], 0.2, period=4.0)
    w = 1.0 + 0.1 * np.cos(0.5 * np.pi * x)
    # The places lose 1e6 periods' digits, and V' is 1 / eps^2 at most.
    return float(np.abs(velocity(x + 4.0 * periods, w) - velocity(x, w)).max()) * 0.2**2


def _tools() -> Iterator[Probe]:
    """What measures rates, limits and supports says where there is nothing to measure."""
    wave: dict[str, Any] = {"spacing": 0.25, "period": 16.0, "amplitude": 1e-6}
    refused = {
        "a wave of 1e-100": lambda: measured_rate(SHAPES["S8"], 4, **{**wave, "amplitude": 1e-100})[
            1
        ],
        "a wave of two markers": lambda: measured_rate(SHAPES["S8"], 32, **wave)[1],
        "a limit of S3, whose slope has kinks": lambda: largest_step(SHAPES["S3"]),
        "the best ε of S3 at h = 1e-3": lambda: optimal_support(SHAPES["S3"], 1e-3)[1],
        "the best ε at h = 1e-9": lambda: optimal_support(SHAPES["S8"], 1e-9)[1],
        "the best ε at h = 5": lambda: optimal_support(SHAPES["S8"], 5.0)[1],
        "a square of no markers": lambda: float(equal_weight(Square(), 0)[0].size),
    }
    marker_tools = Kind("marker tools")
    for case, run_ in refused.items():
        yield marker_tools(case, run_, must=REFUSED)
    for name in SHAPES:
        # -k^2 S^ falls there; S^ by another rule.
        yield marker_tools(
            f"{name}, fastest wave with k < 1",
            _end_off,
            name,
            expected="k² Ŝ at k = 1",
            bound=1e-13,
            source="quadrature",
        )


def _end_off(name: str) -> float:
    nodes, weights = np.polynomial.legendre.leggauss(80)
    reach = SHAPES[name].reach
    x = 0.5 * reach * (nodes + 1.0)
    exact = reach * float(weights @ (SHAPES[name](x) * np.cos(x)))
    return abs(extremes(SHAPES[name], 1.0).decay - exact)
