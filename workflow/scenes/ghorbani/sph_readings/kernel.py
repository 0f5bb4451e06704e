"""Secs. 3.1, 3.2: the kernel approximation of a function, its gradient and its integral, and their sums."""

from collections.abc import Callable, Iterator
from math import sin

import numpy as np

from fracparticles.sph import ParticleLine
from fracparticles.sph.closed_forms import FUNCTIONS
from fracparticles.sph.cubic_spline import spline, spline_gradient, spline_integral
from fracstudy.findings import Finding, measured
from scenes.ghorbani.operators import LABELS

_H, _POINT = 0.1, 0.7  # smoothing length, and the point where (11) and (13) are tried on cos x
_PIECES = _H * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])  # the spline is a polynomial between these
_BETWEEN = np.linspace(0.0, 1.0, 21)  # of the way from a particle to the next
_FINER = 4


def findings(line: ParticleLine) -> Iterator[Finding]:
    """What the text says of (11), (13) and (15)."""
    near, exact = _POINT + _PIECES, -sin(_POINT)
    by_other = -_quadrature(lambda y: np.cos(y) * -spline_gradient(_POINT - y, _H), near)
    by_x = {"the gradient taken by x": {"deviation": _off(-by_other, exact)}}
    yield measured("S-EQ.gradient", deviation=_off(by_other, exact), others=by_x)
    # Of cos the kernel makes a multiple, so that the integral of (12) over [0, x] is one of sin.
    factor = _quadrature(lambda z: np.cos(z) * spline(z, _H), _PIECES)
    single = _quadrature(
        lambda y: np.cos(y) * (spline_integral(_POINT - y, _H) - spline_integral(-y, _H)),
        np.sort([*_PIECES, *near]),
    )
    deviation, smoothing = (_off(single, -f * exact) for f in (factor, 1.0))
    yield measured("S-EQ.exchange", deviation=deviation, smoothing=smoothing)
    yield _any_point(line)
    yield from _truncated(line)


def _off(ours: float, exact: float) -> float:
    return abs(ours / exact - 1.0)


def _quadrature(f: Callable[[np.ndarray], np.ndarray], edges: np.ndarray) -> float:
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = 0.5 * np.diff(edges)[:, None]
    x = 0.5 * (edges[1:] + edges[:-1])[:, None] + half * nodes
    return float(np.sum(half * weights * f(x)))


def _sum(line: ParticleLine, x: np.ndarray, f: np.ndarray, virtual: bool = True) -> np.ndarray:
    """(15) at the points x, with or without the virtual particles."""
    here = slice(None) if virtual else line.inside
    return line.spacing * spline(x[:, None] - line.x_all[here], line.smoothing) @ f[here]


def _any_point(line: ParticleLine) -> Finding:
    x = (line.x[:-1, None] + line.spacing * _BETWEEN).ravel()
    error = {}
    for name, function in FUNCTIONS.items():
        exact = function.value(x)
        off = np.abs(_sum(line, x, function.value(line.x_all)) - exact).max()
        error[LABELS[name]] = off / np.ptp(exact)
    return measured("S-EQ.any_point", error=error)


def _truncated(line: ParticleLine) -> Iterator[Finding]:
    """(15) for f = 1 at the two ends and in the middle, and at the ends on a finer line."""

    def errors(line: ParticleLine, virtual: bool) -> np.ndarray:
        x = np.array([line.a, line.x[line.count // 2], line.b])
        return np.abs(_sum(line, x, np.ones_like(line.x_all), virtual) - 1.0)

    finer = ParticleLine(line.a, line.b, _FINER * (line.count - 1) + 1, line.smoothing_ratio)
    bare, full = errors(line, virtual=False), errors(line, virtual=True)
    ratio, remaining = bare[[0, 2]].min() / bare[1], errors(finer, virtual=False)[0] / bare[0]
    yield measured("S-EQ.truncated", ratio=ratio, remaining=remaining, end=bare[0])
    yield measured("S-EQ.virtual", ratio=full[[0, 2]].max() / full[1], end=full[0])
