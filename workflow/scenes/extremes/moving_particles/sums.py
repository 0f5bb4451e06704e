"""Sums over scattered particles and their remeshing, at the ends of the numbers."""

import math
from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np

from fracparticles.moving.remeshing import eliminate, remesh
from fracparticles.moving.scattered import (
    NaiveScatteredSum,
    NeighbourSum,
    NonuniformFourierSum,
    smooth_kernel,
)
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe

_WIDTH, _EPSILON, _H = 5.0, 0.1, 0.1
_REMESHED = 1000  # times
_MOMENTS = {"M4'": 3, "Lambda3": 4}
_REACH = 6.5  # of the neighbours, in epsilon


def particles_of(count: int) -> dict[str, np.ndarray]:
    """Return so many places and strengths."""
    random = np.random.default_rng(1)
    return {"x": random.uniform(-_WIDTH, _WIDTH, count), "q": random.normal(size=count)}


def transforms(x: np.ndarray, q: np.ndarray) -> Iterator[Probe]:
    """Transforms against the sum over pairs, to the accuracy they state: 1e-11 of the greatest, or ulps of the box."""
    clusters = np.concatenate([x, x + 1e4]), np.concatenate([q, -q])
    cases: dict[str, tuple[Any, ...]] = {
        "strengths 1e-300": (x, 1e-300 * q),
        "strengths 1e290": (x, 1e290 * q),
        "lengths 1e-90": (1e-90 * x, q, 1e-90 * _EPSILON),
        "lengths 1e90": (1e90 * x, q, 1e90 * _EPSILON),
        "1e6 from the origin": (1e6 + x, q),
        "1e12 from the origin": (1e12 + x, q),
        "a lattice at 1e6": (1e6 + _H * np.arange(x.size), q),
        "ε = 1e-3": (x, q, 1e-3),
        "ε = 1e3": (x, q, 1e3),
        "two clusters 1e4 apart": clusters,
        "α = 1 + 1e-12": (x, q, _EPSILON, 1.0 + 1e-12),
        "α = 2 - 1e-12": (x, q, _EPSILON, 2.0 - 1e-12),
    }
    yield from Kind("sums", "the sum over pairs", 1.0, "all pairs").over(_off, cases)


def _off(x: np.ndarray, q: np.ndarray, epsilon: float = _EPSILON, alpha: float = 1.5) -> float:
    """The greatest difference of transforms and pairs, in units of the accuracy that the transforms state."""
    kernels = [smooth_kernel(name, alpha) for name in ("eta", "F")]
    fast = NonuniformFourierSum(kernels, epsilon)
    ours, exact = fast(x, q), NaiveScatteredSum(kernels, epsilon)(x, q)
    apart, size = np.abs(ours - exact).max(axis=1), np.abs(exact).max(axis=1)
    return float((apart / size).max() / fast.accuracy)


def far_tails() -> Iterator[Probe]:
    """Neighbours where the sum is tiny: relative to its own terms, exp(-d^2), but for those beyond 6.5 epsilon."""
    for distance in (1.0, 3.0, 5.0):
        bound = 64.0 * EPS + 21 * math.exp(distance**2 - _REACH**2)
        right = Kind("sums", "the sum of the terms", bound, "mpmath")
        yield right(f"{distance:g} ε beyond the particles", _far_tail, distance)


def _far_tail(z: float) -> float:
    x = np.linspace(-2.0, 0.0, 21)
    ours = NeighbourSum([smooth_kernel("eta", 1.5)], 1.0)(x, np.ones(21), np.array([z]))
    terms = (mpmath.exp(-((mpmath.mpf(z) - mpmath.mpf(p)) ** 2)) for p in x)
    return abs(float(ours[0, 0] * mpmath.sqrt(mpmath.pi) / sum(terms) - 1))


def without_a_sum(x: np.ndarray, q: np.ndarray) -> Iterator[Probe]:
    """What has no sum, or none that memory holds."""
    cases = {
        "strengths 1e308": (x, np.full(x.size, 1e308)),
        "one particle at 1e9": (np.append(x, 1e9), np.append(q, 1.0)),
        "one particle at nan": (np.append(x, np.nan), np.append(q, 1.0)),
        "a strength too many": (x, np.append(q, 1.0)),
    }
    sums = NonuniformFourierSum([smooth_kernel("eta", 1.5)], _EPSILON)
    yield from Kind("sums", must=REFUSED).over(sums, cases)


def remeshing(x: np.ndarray, q: np.ndarray) -> Iterator[Probe]:
    """Moments of the strengths are kept to the ulps of the positions; a lattice stays as it is."""
    for name, count in _MOMENTS.items():
        for offset in (0.0, 1e6, 1e8):
            # A position is rounded to an ulp of it, some 50 spacings from where moments are taken.
            bound = 16.0 * EPS * (1.0 + (offset + _WIDTH) / _H)
            kept = Kind("remeshing", f"{count} moments kept", bound, "exact sums")
            yield kept(f"{name}, particles at {offset:g}", _moments_lost, x, q, name, offset)
        still = Kind("remeshing", "no bit changes", must=HELD)
        yield still(f"{name}, {_REMESHED} times", _moved, x, q, name)
        far = np.append(x, 1e12), np.append(q, 1.0), _H, name
        yield Kind("remeshing", must=REFUSED)(f"{name}, a particle at 1e12", remesh, *far)


def _moments_lost(x: np.ndarray, q: np.ndarray, name: str, offset: float) -> float:
    places, strengths = remesh(offset + x, q, _H, name)
    return max(
        abs(math.fsum(q * x**m) - math.fsum(strengths * (places - offset) ** m))
        / math.fsum(np.abs(q * x**m))
        for m in range(_MOMENTS[name])
    )


def _moved(x: np.ndarray, q: np.ndarray, name: str) -> float:
    def remeshed(x: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        x, q = remesh(x, q, _H, name)
        return x[q != 0.0], q[q != 0.0]  # without the points at the ends, of no strength

    once = again = remeshed(x, q)
    for _ in range(_REMESHED):
        again = remeshed(*again)
    return float(np.abs(np.array(again) - np.array(once)).max())


def elimination(x: np.ndarray, q: np.ndarray) -> Iterator[Probe]:
    """What is kept and what is left out make the whole, whatever the threshold."""
    found = Kind("threshold", "every strength is found", EPS * float(np.abs(q).sum()), "exact sums")
    for threshold in (0.0, 1e-300, 0.5, float(np.nextafter(1.0, 0.0))):
        yield found(f"threshold {threshold:.3g}", _unaccounted, x, q, threshold)
    huge = np.append(1.7e308, np.full(q.size - 1, 1e308))
    cases = {
        "threshold 1": (x, q, 1.0),
        "strengths of zero": (x, 0.0 * q, 0.0),
        "a total beyond 1e308": (x, huge, 0.6),
    }
    yield from Kind("threshold", must=REFUSED).over(eliminate, cases)


def _unaccounted(x: np.ndarray, q: np.ndarray, threshold: float) -> float:
    kept = eliminate(x, q, threshold)
    return abs(math.fsum(kept.strength) + kept.eliminated - math.fsum(q))
