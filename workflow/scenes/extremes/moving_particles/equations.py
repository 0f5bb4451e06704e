"""Markers of other equations: nonlinear diffusion to its end, Burgers' shocks, solitons, sources; exact solutions."""

import math
from collections.abc import Iterator, Sequence
from itertools import product

import mpmath
import numpy as np

from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, Square, run, uniform
from fracparticles.markers.burgers import PointSource, burgers
from fracparticles.markers.clusters import marker_spectrum
from fracparticles.markers.kdv import Soliton, kdv
from fracparticles.markers.nonlinear import Lines, NonlinearDiffusion
from fracparticles.markers.source import GaussianSource, advance_weights
from fracparticles.markers.stability import extremes
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe, off

_S8, _ETA = SHAPES["S8"], extremes(SHAPES["S8"]).eta
_WORD = ("within 10 %, or a word", 0.1)  # the error of a run that must be spoken of


def exact_solutions() -> Iterator[Probe]:
    """The point source of Burgers from R = 1e-100 to 1e8, and the square from t = 1e-30 to 1e10, with many digits."""
    right = Kind("exact", "f and its integral", source="mpmath")
    for reynolds in (1e-100, 1e-10, 1.0, 299.0, 301.0, 1e5, 1e8):
        bound = 1e-13 + 64.0 * EPS * reynolds  # the shock is R ulp wide
        yield right(f"point source, R = {reynolds:g}", _source_off, reynolds, bound=bound)
    for t in (1e-30, 1e-6, 1.0, 99.9, 100.1, 1e10):
        # The integral is known to some ulps of the total, over any stretch.
        yield right(f"square, t = {t:g}", _square_off, t, bound=64.0 * EPS)


def _source_off(reynolds: float) -> float:
    exact, wrong = PointSource(1.0, 2.0 * reynolds), []
    edge = 2.0 * math.sqrt(reynolds)
    with mpmath.workdps(260):
        rest = mpmath.exp(-mpmath.mpf(reynolds))
        for x in (-3.0, -1e-3, 0.0, 0.5 * edge, 0.99 * edge, edge + 1.0 / max(edge, 1.0)):
            z = mpmath.mpf(x) / 2
            phi = mpmath.erfc(z) / 2 + rest * mpmath.erfc(-z) / 2
            f = (1 - rest) * mpmath.exp(-z * z) / mpmath.sqrt(mpmath.pi) / phi
            g = -2 * mpmath.log(phi)
            wrong += [float(exact.value(x, 1.0)) / f - 1, float(exact.cumulative(x, 1.0)) / g - 1]
    return max(abs(float(one)) for one in wrong)


def _square_off(t: float) -> float:
    def integral(u: mpmath.mpf) -> mpmath.mpf:
        return mpmath.exp(-u * u) / mpmath.sqrt(mpmath.pi) - u * mpmath.erfc(u)

    square, wrong = Square(), []
    with mpmath.workdps(60):
        s = 2 * mpmath.sqrt(mpmath.mpf(t))
        for x in (-3.0, -1.0, -0.5, 0.0):
            near, far = -(mpmath.mpf(x) + 1) / s, -(mpmath.mpf(x) - 1) / s
            f = (mpmath.erfc(near) - mpmath.erfc(far)) / 2
            g = s / 2 * (integral(near) - integral(far))
            wrong += [square.value(x, t) - float(f), 0.5 * (square.cumulative(x, t) - float(g))]
    return max(abs(float(one)) for one in wrong)


def shocks(count: int, reynolds: Sequence[float]) -> Iterator[Probe]:
    """A point source to its triangle: Reynolds numbers from a Gaussian to a shock narrower than epsilon, any step."""
    word = Kind("Burgers", *_WORD, "Cole-Hopf")
    for number, factor in product(reynolds, (0.5, 1.1, 3.0)):
        case = f"Burgers, R = {number:g}, dt = {factor:g} η ε²/μ"
        yield word(case, _shock_error, number, factor, count)


def _shock_error(reynolds: float, factor: float, count: int) -> float:
    mu, total, time = 1.0 / reynolds, 2.0, 1.0
    exact = PointSource(mu, total)
    x = exact.quantile(total * (np.arange(count) + 0.5) / count, 1.0)
    epsilon = 4.0 * float(np.median(np.diff(x)))
    steps = max(4, math.ceil(time * mu / (factor * _ETA * epsilon**2)))
    velocity = MarkerVelocity(_S8, epsilon, burgers(mu))
    end = run(x, np.full(count, total / count), velocity, dt=time / steps, steps=steps)
    z = exact.quantile(total * np.linspace(0.02, 0.98, 97), 1.0 + time)
    return off(end.field(z), exact.value(z, 1.0 + time))


def solitons(count: int) -> Iterator[Probe]:
    """Solitons, the shocks of this equation, from wide to narrower than epsilon; steps up to a hundredth."""
    word = Kind("KdV", *_WORD, "soliton")
    widths = ((1.0, 0.1), (4.0, 1.0), (16.0, 1.0), (100.0, 1.0))
    for (c, background), dt in product(widths, (1e-4, 1e-3, 1e-2)):
        case = f"soliton c = {c:g} on {background:g}, dt = {dt:g}"
        yield word(case, _soliton_error, c, background, dt, 0.3, count)
    yield word("soliton narrower than ε", _soliton_error, 16.0, 1.0, 1e-3, 1.5, count)
    refused = Kind("KdV", must=REFUSED)
    yield refused("a soliton on nothing", _soliton_error, 16.0, 0.0, 1e-3, 0.1, count)


def _soliton_error(c: float, background: float, dt: float, epsilon: float, count: int) -> float:
    soliton, steps = Soliton(c, background), math.ceil(0.02 / dt)
    x, w = uniform(soliton.value, (-8.0, 8.0), 2 * count)
    end = run(x, w, MarkerVelocity(_S8, epsilon, kdv, 2), dt=dt, steps=steps)
    z = soliton.speed * dt * steps + np.linspace(-1.0, 1.0, 81)
    return off(end.field(z), soliton.value(z, dt * steps))


def nonlinear(count: int) -> Iterator[Probe]:
    """The steady state of nonlinear diffusion at steps about the limit; beyond the time where f vanishes."""
    problem, strong = NonlinearDiffusion(), NonlinearDiffusion(1e100, 1.0, 1.0)
    word = Kind("nonlinear", *_WORD, "closed form")
    for factor in (0.5, 0.9, 1.2, 3.0):
        case = f"steady state, dt = {factor:g} of the limit"
        yield word(case, _steady_error, problem, factor, count)
    lines, refused = Lines(problem, 6.0, 60, 2.5), Kind("nonlinear", must=REFUSED)
    start = Gaussian().value(lines.x)
    yield refused("lines beyond the time where f vanishes", lines.solve, start, [1e3])
    yield refused("D(f) of f = -10000, D₀ = 1e100", strong.diffusivity, [-1e4])
    zero = Kind("nonlinear", "zero", must=HELD)
    yield zero("D(f) of f = 1e+300, D₀ = 1e100", lambda: float(strong.diffusivity([1e300])[0]))


def _steady_error(problem: NonlinearDiffusion, factor: float, count: int) -> float:
    dt = factor * problem.step_limit(0.15, _ETA)
    velocity = MarkerVelocity(_S8, 0.15, problem.flux)
    x, w = uniform(problem.steady, (-1.3, 1.3), count)
    end, z = (
        run(x, w, velocity, dt=dt, steps=max(3, math.ceil(0.05 / dt))),
        np.linspace(-0.6, 0.6, 61),
    )
    return off(end.field(z), problem.steady(z))


def sources(count: int) -> Iterator[Probe]:
    """Sources that feed, drain, or take more in a step than there is; strengths beyond the numbers."""
    word, refused = Kind("source", *_WORD, "closed form"), Kind("source", must=REFUSED)
    for q, dt in ((1.0, 0.005), (-0.5, 0.005), (1.0, 0.1)):
        yield word(f"q = {q:g}, dt = {dt:g}", _fed_error, q, dt, count)
    yield refused("a sink of 30 times f", _fed_error, -30.0, 0.02, count)
    zero, far = Kind("source", "zero", must=HELD), GaussianSource(1e300, 2)
    yield zero("q = 1e300 far out", lambda: float(abs(far.rate([1e100])[0])))
    yield refused("q = 1e300 for 1e100", GaussianSource(1e300).solution, [0.0], 1e100)


def _fed_error(q: float, dt: float, count: int) -> float:
    source, steps = GaussianSource(q), max(1, math.ceil(0.1 / dt))
    x, w = uniform(Gaussian().value, (-2.5, 2.5), count)
    velocity, z = MarkerVelocity(_S8, 0.2), np.linspace(-1.0, 1.0, 41)
    x, w = advance_weights(x, w, velocity, source.rate, dt=dt, steps=steps)
    return off(velocity.fields(x, w, z)[0], source.solution(z, dt * steps))


def nothing() -> Iterator[Probe]:
    """What looks at markers needs some."""
    refused = Kind("marker tools", must=REFUSED)
    yield refused("a spectrum of no markers", marker_spectrum, np.array([5.0]), [1.0], 1.0)
