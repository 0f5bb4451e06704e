"""Particles that follow a solution of u_t = -D (-Laplacian)^(alpha/2) u on the line: placed, exchanged, placed again.

On one placement the exchange is solved exactly in time: with the symmetric S of d(V^(1/2) u)/dt = -D S V^(1/2) u,

    u(t) = V^(-1/2) Q exp(-D t diag(lambda)) Q^T V^(1/2) u(0),   S = Q diag(lambda) Q^T.

After the time l^alpha / D, l the shortest length, in which the narrowest part about doubles its width, particles are
placed again by the lengths of what u has become: many that were close are merged to few. Their strengths are those of a
spline of degree 7 in the variable of the map, in which the solution is smooth. Then sum V u and sum V x u are made what
they were,

    u_i <- u_i + |u_i| (a + b (x_i - c)),

c the middle of the particles. The first moment of a heavy tail is far out, where round-off is largest beside u: there b
mends it, and leaves the rest alone. The share of sum V |u| that a and b change is kept. The particles reach so far that
a share of 1e-7 is beyond; nothing leaves there.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.linalg import eigh

from fracparticles import arguments as check
from fracparticles.adaptive.exchange import exchange_matrix, rate_matrix
from fracparticles.adaptive.placement import (
    LengthField,
    LineParticles,
    place_particles,
    wanted_lengths,
)
from fracparticles.adaptive.samples import adapted_samples
from fracparticles.adaptive.weights import MOST_NEAR
from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.special import tail_constant

__all__ = ["Followed", "follow"]

_DEGREE = 7
_NEWTON = 8
_BEYOND = 1e-7
_UNRESOLVED = 1e-3  # of int |u|: what the particles may miss between them, or a placement be off
_MOST_CHANGE = (
    0.5  # of a strength far out, for the first moment; if it took more, the moment is let go
)
_MOST_TIMES = 1000


@dataclass(frozen=True)
class Followed:
    """The particles at one time.

    Attributes
    ----------
    time : float
    particles : LineParticles
    u : array, shape (N,)
        Strengths.
    placements : int
        How often particles have been placed.
    corrected : float
        The largest share of sum V |u| that a placement has changed to keep mass and first moment.
    """

    time: float
    particles: LineParticles
    u: FloatArray
    placements: int
    corrected: float

    @property
    def mass(self) -> float:
        """Sum V u."""
        return float(self.particles.volumes @ self.u)

    def at(self, x: Any) -> FloatArray:
        """Return u at other places, between the outermost particles.

        Raises
        ------
        InvalidInput
            If a place is beyond them.
        """
        x = check.finite_array("x", x)
        low, high = self.particles.x[[0, -1]]
        if x.size and not (low <= x.min() and x.max() <= high):
            raise InvalidInput("x", x, f"from {low:g} to {high:g}", "There are no particles.")
        return _between(self.particles.x, self.u, x.ravel()).reshape(x.shape)


def follow(
    initial: Callable[[FloatArray], FloatArray],
    times: Sequence[float] | float,
    *,
    alpha: float,
    window: tuple[float, float],
    where: Any = (),
    diffusivity: float = 1.0,
    step: float = 0.25,
    near: int = 6,
    reach: float | None = None,
    again: bool = True,
) -> list[Followed]:
    """Return the particles at these times, from `initial` at the time zero.

    Parameters
    ----------
    initial : callable
        u(x, 0).
    times : sequence of float
        In ascending order, from 0 on.
    alpha : float
        Fractional order, 1 < alpha < 2.
    window : (float, float)
        Where `initial` is sampled for its bends.
    where : array_like, optional
        Places that are sampled in any case: of what is narrower than some hundredth of the window.
    diffusivity : float
        D.
    step : float
        h, the distance of neighbours as a part of the length in which u changes. The error is like
        h^(2 near + 2 - alpha).
    near : int
        q, how many neighbours on either side have a weight, 0 to 6.
    reach : float, optional
        How far the particles go beyond the window; by itself to where a share of 1e-7 is beyond, at first or at the
        last time, at most (1e7)^(1/alpha) times the width of the window.
    again : bool
        Whether particles are placed again.

    Raises
    ------
    InvalidInput
        If an argument is outside its range, or more particles would be needed than a matrix is for.

    Warns
    -----
    AccuracyWarning
        If the particles do not resolve `initial`, a placement changed u, or u reaches the last of them.
    """
    alpha = check.fractional_order(alpha)
    low, high = check.pair("window", window, rising=True)
    seen = check.finite_array("where", where).ravel() if np.size(where) else np.zeros(0)
    diffusivity = check.scale("diffusivity", diffusivity)
    near = check.whole_number("near", near, 0, MOST_NEAR)
    again = check.flag("again", again)
    outputs = check.vector("times", np.atleast_1d(times))
    if outputs.size > _MOST_TIMES or outputs[0] < 0.0 or (np.diff(outputs) <= 0.0).any():
        allowed = f"up to {_MOST_TIMES} ascending times from 0 on"
        raise InvalidInput("times", times, allowed, "Sort them, without doubles.")
    samples = adapted_samples(check.function("initial", initial), low, high, seen)
    if reach is None:
        reach = _reach(initial, samples, alpha, diffusivity * float(outputs[-1]))
    reach = check.scale("reach", reach)
    ends = low - reach, high + reach

    field = LengthField(samples[0], wanted_lengths(*samples))
    particles = place_particles(field, *ends, step)
    u = check.sampled("initial", initial, particles.x)
    _warn(_missed(initial, particles, u), "between the particles is")
    state = Followed(0.0, particles, u, 1, 0.0)
    results = []
    left = outputs.tolist()
    while True:
        evolved = _Exact(state, alpha, diffusivity, near)
        until = state.time + evolved.shortest**alpha / diffusivity if again else np.inf
        while left and left[0] <= until:
            results.append(evolved.at(left.pop(0)))
        if not left:
            _warn(state.corrected, "the placements were off by")
            _warn(_at_the_ends(results[-1], alpha), "beyond the particles is", "Go farther out.")
            return results
        state = _placed_again(evolved.at(until), ends, step)


class _Exact:
    """The exchange on one placement, for any later time."""

    def __init__(self, state: Followed, alpha: float, diffusivity: float, near: int) -> None:
        self._state, self._diffusivity = state, diffusivity
        particles = state.particles
        self._root = np.sqrt(particles.volumes)
        rates = rate_matrix(exchange_matrix(particles, alpha, near), particles.volumes, None)
        form = -rates * self._root[:, None] / self._root
        self._rates, self._modes = eigh(0.5 * (form + form.T))
        self._start = self._root * state.u
        self.shortest = float(wanted_lengths(particles.x, state.u).min())

    def at(self, time: float) -> Followed:
        state, root = self._state, self._root
        if time == state.time:
            return state
        decay = np.exp(-self._diffusivity * (time - state.time) * np.maximum(self._rates, 0.0))
        y = self._modes @ (decay * (self._modes.T @ self._start))
        y += root * (root @ (self._start - y)) / (root @ root)  # sum V u to the last digit
        return Followed(time, state.particles, y / root, state.placements, state.corrected)


def _reach(
    initial: Callable[[FloatArray], FloatArray],
    samples: tuple[FloatArray, FloatArray],
    alpha: float,
    spread: float,
) -> float:
    """How far beyond the samples a share of 1e-7 is, of what is there at first and of what D t has spread there.

    A tail c |x|^(-1-alpha) holds |u| |x| / alpha beyond x, and D t has spread D t C |x|^(-alpha) / alpha. What falls
    more slowly is followed as far as a tail as wide as the samples would go.
    """
    x, u = samples
    width, mass = float(x[-1] - x[0]), float(np.trapezoid(np.abs(u), x))
    farthest = width * _BEYOND ** (-1.0 / alpha)
    out = np.geomspace(width / 16.0, farthest, 64)
    sides = np.abs(check.sampled("initial", initial, np.array([x[0] - out, x[-1] + out])))
    share = sides.max(axis=0) * (out + width) / (alpha * mass)
    still = np.flatnonzero(share > _BEYOND)
    at_first = out[min(still[-1] + 1, out.size - 1)] if still.size else out[0]
    return float(
        max(at_first, (spread * tail_constant(alpha) / (alpha * _BEYOND)) ** (1.0 / alpha))
    )


def _placed_again(state: Followed, ends: tuple[float, float], step: float) -> Followed:
    """The same u on particles that are placed by it."""
    old = state.particles
    field = LengthField(old.x, wanted_lengths(old.x, state.u))
    new = place_particles(field, *ends, step)
    u = _between(old.x, state.u, new.x)
    u, share = _conserving(new, u, state.mass, float(old.volumes * old.x @ state.u))
    return Followed(state.time, new, u, state.placements + 1, max(state.corrected, share))


def _between(x: FloatArray, u: FloatArray, at: FloatArray) -> FloatArray:
    """u at other places, by a spline in the variable of the map, whose places are found by Newton's method."""
    s = np.arange(x.size, dtype=float)
    place = make_interp_spline(s, x, _DEGREE)
    slope = place.derivative()
    found = np.interp(at, x, s)
    for _ in range(_NEWTON):
        found = np.clip(found - (place(found) - at) / slope(found), 0.0, s[-1])
    return np.asarray(make_interp_spline(s, u, _DEGREE)(found))


def _conserving(
    particles: LineParticles, u: FloatArray, mass: float, moment: float
) -> tuple[FloatArray, float]:
    """Return u with this mass and first moment, and the share of it that has changed."""
    x, weights = particles.x, particles.volumes * np.abs(u)
    r = (2.0 * x - x[0] - x[-1]) / (x[-1] - x[0])
    rows = np.array([[weights.sum(), weights @ r], [weights @ x, weights @ (x * r)]])
    missing = mass - particles.volumes @ u, moment - particles.volumes * x @ u
    a, b = np.linalg.solve(rows, missing)
    if abs(b) > _MOST_CHANGE:
        a, b = missing[0] / weights.sum(), 0.0
    change = a + b * r
    return u + np.abs(u) * change, float(weights @ np.abs(change) / weights.sum())


def _missed(
    initial: Callable[[FloatArray], FloatArray], particles: LineParticles, u: FloatArray
) -> float:
    """The share of int |u| that a spline misses between the particles."""
    x = particles.x
    middles = 0.5 * (x[1:] + x[:-1])
    exact = check.sampled("initial", initial, middles)
    return float(
        np.diff(x) @ np.abs(_between(x, u, middles) - exact) / (np.diff(x) @ np.abs(exact))
    )


def _at_the_ends(state: Followed, alpha: float) -> float:
    """The share of int |u| beyond the particles, if u goes on as |x|^(-1-alpha)."""
    x, u = state.particles.x, np.abs(state.u)
    beyond = 0.5 * (x[-1] - x[0]) / alpha * (u[0] + u[-1])
    return float(beyond / (beyond + state.particles.volumes @ u))


def _warn(
    share: float,
    text: str,
    advice: str = "Take a shorter step, or name `where` the narrow parts are.",
) -> None:
    if not share < _UNRESOLVED:
        warnings.warn(f"{text} {share:.1g} of int |u|. {advice}", AccuracyWarning, stacklevel=3)
