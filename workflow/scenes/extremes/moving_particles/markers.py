"""Markers: shape functions, support, steps, signs, units and loads."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Sequence
from functools import partial
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
from fracstudy.probe import Probe, Verdict, probe

__all__ = ["probes", "support_errors", "wave_growth"]

_EPS = float(np.finfo(float).eps)
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
    for name in shapes:
        shape = SHAPES[name]
        if shape.smoothness == 0:
            run_ = partial(_smoothed_off, name, count, 0.3)
            yield probe(
                "solution", f"{name}, whose F jumps", "refused", run_, 0.0, must=Verdict.REFUSED
            )
            continue
        many, epsilon = 5 * count, 0.2 if name == "S8" else 0.3
        spacing = (_NARROW if name == "S8" else _WIDE) * 2.0 / many
        # The fourth moment over 24 times the fourth derivative, 12 at the peak; the markers as (h / eps)^M, twice.
        fourth = 0.5 * epsilon**4 * abs(_moment(name, 4))
        order = 6 if shape.smoothness is None else shape.smoothness + 1
        bound = fourth + 8.0 * (spacing / epsilon) ** order
        run_ = partial(_smoothed_off, name, many, epsilon)
        yield probe(
            "solution",
            f"{name}, ε = {epsilon / spacing:g} h",
            "the smoothed Gaussian",
            run_,
            bound,
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
    for name, factor in product(_SMOOTH, _FACTORS):
        verdict = Verdict.WARNED if factor > 1.0 else Verdict.HELD
        run_ = partial(_wave_missed, name, factor)
        # Linear to the height of the wave; places are rounded to 1e-16 of 10, the wave is 1e-6.
        case = f"{name}, dt = {factor:g} η ε²"
        yield probe(
            "step", case, "grows by 1 + z + z²/2", run_, 1e-3, source="lattice sum", must=verdict
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
    for name in ("S4", "S6"):
        found = extremes(SHAPES[name])
        factor = 0.1
        steps = math.ceil(3.0 / (factor * found.eta * found.growth))
        run_ = partial(_cluster_missed, name, factor, steps)
        case = f"{name}, waves of {2.0 * math.pi / found.k_growth:.2f} ε"
        yield probe(
            "step", case, "grow at any step", run_, 1e-3, source="lattice sum", must=Verdict.WARNED
        )


def _cluster_missed(name: str, factor: float, steps: int) -> tuple[float, str]:
    found, predicted = wave_growth(name, factor, steps, growing=True)
    return abs(found - predicted), f"{found:.3f}, predicted {predicted:.3f}"


def _supports(count: int, supports: Sequence[float]) -> Iterator[Probe]:
    """Support parameters from a tenth of the spacing to fifty times: wrong by more than 5 % only with a word."""
    for name, support in product(("S4", "S8"), supports):
        run_ = partial(_support_error, name, support, count)
        case = f"{name}, ε = {support:g} h"
        yield probe("support", case, "within 5 %, or a word", run_, _SPOKEN, source="closed form")
    for name, load in product(("S4", "S8"), ("quiet start", "random")):
        run_ = partial(_load_error, name, load, count)
        yield probe(
            "support",
            f"{name}, {load}",
            "within 5 %, or a word",
            run_,
            _SPOKEN,
            source="closed form",
        )


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
    run_ = partial(_sign_seen, count)
    case = "weights all negative"
    yield probe("marker signs", case, "the same paths, bit for bit", run_, 0.0, must=Verdict.HELD)
    run_ = partial(_zero_seen, count)
    yield probe(
        "marker signs", "weights of zero between", "the others' paths", run_, 0.0, must=Verdict.HELD
    )
    x, w = _gaussian(count, "S4")
    refused: dict[str, tuple[np.ndarray, np.ndarray, str]] = {
        "weights of both signs": (x, w * np.sign(x), "S4"),
        "all weights zero": (x, 0.0 * w, "S4"),
        "S8 in a far tail": (*_gaussian(200, "S4"), "S8"),
        "a weight of nan": (x, np.where(x > 2.0, np.nan, w), "S4"),
    }
    for case, (places, weights, name) in refused.items():
        run_ = partial(_run_once, places, weights, name)
        yield probe("marker signs", case, "refused", run_, 0.0, must=Verdict.REFUSED)
    fast = FourierMarkerVelocity(0.2)
    run_ = partial(_fourier_once, fast, *uniform(Gaussian().value, (-7.0, 7.0), count))
    yield probe(
        "marker signs",
        "S8 by transforms, F below 1e-11",
        "refused",
        run_,
        0.0,
        must=Verdict.REFUSED,
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
    for power in (-150, 150):
        run_ = partial(_other_units, count, 2.0**power)
        case = f"lengths times 2^{power}"
        yield probe(
            "marker units", case, "no bit changes", run_, 0.0, source="scaling", must=Verdict.HELD
        )
    for scale in (1e-290, 1e290):
        run_ = partial(_other_weights, count, scale)
        case = f"weights times {scale:g}"
        # F and F_x are rounded alike, their quotient once more.
        yield probe("marker units", case, "the same paths", run_, 1e-12, source="scaling")
    yield probe(
        "marker units",
        "weights of 1e308",
        "refused",
        partial(_other_weights, count, 1e309),
        0.0,
        must=Verdict.REFUSED,
    )
    for periods in (1, 10**6):
        run_ = partial(_periods_off, periods)
        case = f"periodic, {periods:g} periods away"
        bound = 64.0 * _EPS * periods * 4.0
        yield probe("marker units", case, "the same velocity", run_, bound, source="scaling")


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
    for case, run_ in refused.items():
        yield probe("marker tools", case, "refused", run_, 0.0, must=Verdict.REFUSED)
    for name in SHAPES:
        run_ = partial(_end_off, name)
        case = f"{name}, fastest wave with k < 1"
        # -k^2 S^ falls there; S^ by another rule.
        yield probe("marker tools", case, "k² Ŝ at k = 1", run_, 1e-13, source="quadrature")


def _end_off(name: str) -> float:
    nodes, weights = np.polynomial.legendre.leggauss(80)
    reach = SHAPES[name].reach
    x = 0.5 * reach * (nodes + 1.0)
    exact = reach * float(weights @ (SHAPES[name](x) * np.cos(x)))
    return abs(extremes(SHAPES[name], 1.0).decay - exact)
