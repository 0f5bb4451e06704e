"""Markers: shape functions, support, steps, signs, units and loads."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from scipy.optimize import brentq

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
from fracstudy.probe import EPS, HELD, REFUSED, WARNED, Kind, Probe, off, quiet
from scenes.extremes.moving_particles.cloud import FACTORS, missed

SMOOTH = ("S4", "S6", "S8")  # with a second derivative, so that markers on a lattice have a rate
SUPPORTED = ("S4", "S8")
_XI, _STEPS = 1e-6, 5  # height of a wave, in epsilon
# Half-widths of a Gaussian; S8, of both signs, needs a field that is not too weak.
_WIDE, _NARROW = 5.0, 2.5


def _gaussian(count: int, shape: str = "S4") -> tuple[np.ndarray, np.ndarray]:
    end = _NARROW if shape == "S8" else _WIDE
    return uniform(Gaussian().value, (-end, end), count)


def solutions(shapes: Sequence[str], count: int) -> Iterator[Probe]:
    """The Gaussian, smoothed: variances s^2 of the markers and s^2 + m eps^2 of F, m = int S x^2, obey

        s^2 + m eps^2 log(s^2 / s_0^2) = s_0^2 + 2 t,

    as V = x / (s^2 + m eps^2). What is left is of the order eps^4, and the ripple between markers.
    """
    for name in shapes:
        shape = SHAPES[name]
        if shape.smoothness == 0:
            refused = Kind("solution", must=REFUSED)
            yield refused(f"{name}, whose F jumps", _smoothed_off, name, count, 0.3)
            continue
        many, epsilon = 5 * count, 0.2 if name == "S8" else 0.3
        spacing = (_NARROW if name == "S8" else _WIDE) * 2.0 / many
        # The fourth moment over 24 times the fourth derivative, 12 at the peak; the markers as (h / eps)^M, twice.
        fourth = 0.5 * epsilon**4 * abs(_moments(name)[1])
        order = 6 if shape.smoothness is None else shape.smoothness + 1
        bound = fourth + 8.0 * (spacing / epsilon) ** order
        right = Kind("solution", "the smoothed Gaussian", bound, "closed form")
        yield right(f"{name}, ε = {epsilon / spacing:g} h", _smoothed_off, name, many, epsilon)


def _moments(name: str) -> tuple[float, float]:
    """int S x^2 dx and int S x^4 dx, from the transform: 1 - m2 k^2/2 + m4 k^4/24."""
    k = 0.05
    t1, t2 = (float(SHAPES[name].transform(f * k)) for f in (1.0, 2.0))
    second = -((16.0 * t1 - t2 - 15.0) / 12.0) * 2.0 / k**2
    return second, (t2 - 1.0 + 2.0 * second * k**2) * 24.0 / (2.0 * k) ** 4


def _smoothed_off(name: str, count: int, epsilon: float) -> float:
    limit, time = extremes(SHAPES[name]).eta * epsilon**2, 0.1
    steps = math.ceil(4.0 * time / limit) + 4
    velocity = MarkerVelocity(SHAPES[name], epsilon)
    with quiet():  # clusters have no time to grow
        end = run(*_gaussian(count, name), velocity, dt=time / steps, steps=steps)
    m, start = _moments(name)[0] * epsilon**2, 0.5
    left = lambda s: s + m * math.log(s / start) - start - 2.0 * time
    variance = brentq(left, start, start + 2.0 * time)
    z = np.linspace(-1.0, 1.0, 81)
    exact = math.sqrt(0.5 / (variance + m)) * np.exp(-0.5 * z * z / (variance + m))
    return off(end.field(z), exact)


def growth() -> Iterator[Probe]:
    """The wave that decays fastest, at steps about the limit of the lattice: 1 + z + z^2/2, and a word beyond.

    Linear to the height of the wave; places are rounded to 1e-16 of 10, the wave is 1e-6. Waves whose transform is
    negative grow at any step, at the predicted rate, and the run says so.
    """
    grows = Kind("step", "grows by 1 + z + z²/2", 1e-3, "lattice sum")
    for name, factor in product(SMOOTH, FACTORS):
        must = WARNED if factor > 1.0 else HELD
        yield grows(f"{name}, dt = {factor:g} η ε²", missed, wave_growth, name, factor, must=must)
    for name in ("S4", "S6"):
        found, how = extremes(SHAPES[name]), {"expected": "grow at any step", "must": WARNED}
        steps = math.ceil(3.0 / (0.1 * found.eta * found.growth))
        words = f"{name}, waves of {2.0 * math.pi / found.k_growth:.2f} ε"
        yield grows(words, missed, wave_growth, name, 0.1, steps, True, **how)


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
    wave, dt = np.cos(k * lattice), factor * found.eta
    velocity = MarkerVelocity(shape, 1.0, period=period)
    end = run(lattice + _XI * wave, np.full(lattice.size, h), velocity, dt=dt, steps=steps)
    left = float((end.x - lattice) @ wave / (wave @ wave) / _XI)
    z = dt * float(lattice_rate(shape, k, h))
    return float(np.copysign(abs(left) ** (1.0 / steps), left)), 1.0 + z + 0.5 * z * z


def support(count: int, supports: Sequence[float]) -> Iterator[Probe]:
    """Support parameters from a tenth of the spacing to fifty times: wrong by more than 5 % only with a word."""
    word = Kind("support", "within 5 %, or a word", 0.05, "closed form")
    for name, ratio in product(SUPPORTED, supports):
        yield word(f"{name}, ε = {ratio:g} h", support_error, count, name, ratio)
    for name in SUPPORTED:
        quiet_start = equal_weight(Gaussian(), count)
        yield word(f"{name}, quiet start", _error, name, *quiet_start, 0.1)
        drawn = random(Gaussian(), count, np.random.default_rng(4))
        yield word(f"{name}, random", _error, name, *drawn, 0.1)


def support_error(count: int, name: str, support: float) -> float:
    """Return the error of a run with that epsilon / h."""
    x, w = _gaussian(count, name)
    return _error(name, x, w, support * float(x[1] - x[0]))


def _error(name: str, x: np.ndarray, w: np.ndarray, epsilon: float) -> float:
    limit, time = extremes(SHAPES[name]).eta * epsilon**2, 0.1
    # Of a smaller epsilon the first steps are enough.
    steps = min(math.ceil(2.0 * time / limit), 400)
    dt = min(0.5 * limit, time / steps)
    end = run(x, w, MarkerVelocity(SHAPES[name], epsilon), dt=dt, steps=steps)
    z = np.linspace(-1.5, 1.5, 151)
    return off(end.field(z), Gaussian().value(z, dt * steps))


def signs(count: int) -> Iterator[Probe]:
    """F of one sign, whichever; a weight of zero counts for nothing."""
    x, w = _gaussian(count)
    more = np.sort(np.concatenate([x, 0.5 * (x[1:] + x[:-1])]))
    weights = np.zeros(more.size)
    weights[::2] = w
    same = Kind("marker signs", "the same paths, bit for bit", must=HELD)
    yield same("weights all negative", _apart, x, w, x, -w)
    yield same("weights of zero between", _apart, x, w, more, weights, expected="the others' paths")
    refused, step = Kind("marker signs", must=REFUSED), partial(run, dt=1e-3, steps=3)
    s4, s8 = (MarkerVelocity(SHAPES[name], 0.2) for name in ("S4", "S8"))
    cases: dict[str, tuple[Any, ...]] = {
        "weights of both signs": (x, w * np.sign(x), s4),
        "all weights zero": (x, 0.0 * w, s4),
        "S8 in a far tail": (*_gaussian(200), s8),
        "a weight of nan": (x, np.where(x > 2.0, np.nan, w), s4),
    }
    wide = uniform(Gaussian().value, (-7.0, 7.0), count)
    cases["S8 by transforms, F below 1e-11"] = (*wide, FourierMarkerVelocity(0.2))
    yield from refused.over(step, cases)


def _five_steps(x: np.ndarray, w: np.ndarray, unit: float = 1.0, dt: float = 0.01) -> np.ndarray:
    velocity = MarkerVelocity(SHAPES["S4"], 0.5 * unit)
    return run(unit * x, w, velocity, dt=dt * unit**2, steps=5).x / unit


def _apart(x: np.ndarray, w: np.ndarray, y: np.ndarray, v: np.ndarray) -> float:
    return float(np.abs(_five_steps(y, v) - _five_steps(x, w)).max())


def units(count: int) -> Iterator[Probe]:
    """Lengths times a power of two change no bit; a total in other units neither; periods do not count."""
    x, w = _gaussian(count)
    no_bit = Kind("marker units", "no bit changes", 0.0, "scaling", HELD)
    for power in (-150, 150):
        yield no_bit(
            f"lengths times 2^{power}",
            lambda: off(_five_steps(x, w, 2.0**power, 2.0**-7), _five_steps(x, w, dt=2.0**-7), 1.0),
        )
    # F and F_x are rounded alike, their quotient once more.
    same = Kind("marker units", "the same paths", 1e-12, "scaling")
    for scale in (1e-290, 1e290):
        yield same(f"weights times {scale:g}", _apart, x, w, x, scale * w)
    with np.errstate(over="ignore"):
        infinite = 1e309 * w
    yield Kind("marker units", must=REFUSED)("weights of 1e308", _five_steps, x, infinite)
    for periods in (1, 10**6):
        same = Kind("marker units", "the same velocity", 64.0 * EPS * periods * 4.0, "scaling")
        yield same(f"periodic, {periods:g} periods away", _periods_off, periods)


def _periods_off(periods: int) -> float:
    x = 4.0 * (np.arange(40) + 0.3 * np.sin(np.arange(40))) / 40.0
    velocity = MarkerVelocity(SHAPES["S8"], 0.2, period=4.0)
    w = 1.0 + 0.1 * np.cos(0.5 * np.pi * x)
    # The places lose 1e6 periods' digits, and V' is 1 / eps^2 at most.
    return float(np.abs(velocity(x + 4.0 * periods, w) - velocity(x, w)).max()) * 0.2**2


def tools() -> Iterator[Probe]:
    """What measures rates, limits and supports says where there is nothing to measure."""
    s3, s8 = SHAPES["S3"], SHAPES["S8"]
    wave: dict[str, Any] = {"spacing": 0.25, "period": 16.0, "amplitude": 1e-6}
    yield from Kind("marker tools", must=REFUSED).of(
        {
            "a wave of 1e-100": lambda: measured_rate(s8, 4, **wave | {"amplitude": 1e-100}),
            "a wave of two markers": lambda: measured_rate(s8, 32, **wave),
            "a limit of S3, whose slope has kinks": lambda: largest_step(s3),
            "the best ε of S3 at h = 1e-3": lambda: optimal_support(s3, 1e-3),
            "the best ε at h = 1e-9": lambda: optimal_support(s8, 1e-9),
            "the best ε at h = 5": lambda: optimal_support(s8, 5.0),
            "a square of no markers": lambda: equal_weight(Square(), 0),
        }
    )
    # -k^2 S^ falls there; S^ by another rule.
    right = Kind("marker tools", "k² Ŝ at k = 1", 1e-13, "quadrature")
    for name in SHAPES:
        yield right(f"{name}, fastest wave with k < 1", _end_off, name)


def _end_off(name: str) -> float:
    nodes, weights = np.polynomial.legendre.leggauss(80)
    reach = SHAPES[name].reach
    x = 0.5 * reach * (nodes + 1.0)
    exact = reach * float(weights @ (SHAPES[name](x) * np.cos(x)))
    return abs(extremes(SHAPES[name], 1.0).decay - exact)
