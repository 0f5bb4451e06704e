"""Particles that follow a solution on the line: placed, moved and exchanged, placed again.

    u_t + (a u)_x = C int (D(x) + D(y)) / 2 (u(y) - u(x)) |x - y|^(-1-alpha) dy + f(x, t, u),

which is u_t = -D (-Laplacian)^(alpha/2) u for a constant D and nothing else. Between placements the exchange is solved
exactly in time (`flow`), and split from what else acts (`splitting`). When the narrowest part has about doubled its
width by diffusion, the velocity has stretched the particles by half, or the source has made half of what was there,
particles are placed again by the lengths of what u has become: many that were close are merged to few. Their strengths
are those of a spline in the variable of the map, in which the solution is smooth, and sum V u and sum V x u are kept
(`transfer`). Coefficients that vary have their lengths, too: the particles resolve them as they resolve u. The
particles reach so far that a share of 1e-7 is beyond; nothing leaves there.
"""

from __future__ import annotations

import warnings
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.adaptive.placement import LineParticles
from fracparticles.adaptive.placing import Place, reach_of
from fracparticles.adaptive.samples import adapted_samples
from fracparticles.adaptive.splitting import Physics, Splitting
from fracparticles.adaptive.transfer import among, between, conserving, uncertain
from fracparticles.adaptive.weights import MOST_NEAR, order_of
from fracparticles.arguments import FloatArray
from fracparticles.called import Called
from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution
from fracparticles.time.sudden import LOOKS, changes_of_what_comes, pulses_at, sudden_times

__all__ = ["Followed", "follow"]

_EXCHANGE = 0.05  # the error of an exchange over h^order
_BENT = 0.1  # of initial data beyond the window: what the particles may miss there
_NOTHING = 1e-7  # of int |u|: |u| times the distance from the window counts as zero below this
_UNRESOLVED = 1e-3  # of int |u|: what particles may miss, or a placement may change
_MOST_PLACEMENTS = 5000
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
        The share of sum V |u| that placements have changed, all together, to keep mass and first moment.
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
            raise InvalidInput(
                "x", x, f"from {low:g} to {high:g}", "Beyond there are no particles."
            )
        return between(self.particles.x, self.u, x.ravel()).reshape(x.shape)


def follow(
    initial: Callable[[FloatArray], FloatArray],
    times: Sequence[float] | float,
    *,
    alpha: float,
    window: tuple[float, float],
    where: Any = (),
    diffusivity: float | Callable[[FloatArray], FloatArray] = 1.0,
    velocity: Callable[..., Any] | None = None,
    source: Callable[..., Any] | None = None,
    step: float = 0.25,
    near: int = 6,
    reach: float | None = None,
    again: bool = True,
    tolerance: float = 1e-8,
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
        Where `initial` is sampled for its bends; beyond, it should fall off without any.
    where : array_like, optional
        Places that are sampled in any case. Name those of parts narrower than about a hundredth of the window.
    diffusivity : float or callable
        D, or D(x), which is not negative.
    velocity : callable, optional
        a(x, t), or a function of x or t alone, with which the particles move.
    source : callable, optional
        f(x, t, u), or a function of some of these. A pulse of a or f that is short in time is noticed only near its
        time: let one of `times` be there.
    step : float
        h, the distance of neighbours as a part of the length in which u changes. The error is like
        h^(2 near + 2 - alpha).
    near : int
        q, how many neighbours on either side have a weight, 1 to 6.
    reach : float, optional
        How far the particles go beyond the window. Left out: so far that at the first and at the last time a share of
        1e-7 lies beyond them, but at most (1e7)^(1/alpha) times the width of the window.
    again : bool
        Whether particles are placed again.
    tolerance : float
        Of the splitting from one placement to the next, a share of sum V |u|. Without velocity and source nothing is
        split, and it has no effect.

    Raises
    ------
    InvalidInput
        If an argument is outside its range, or more particles would be needed than a matrix can hold.
    NonFiniteSolution
        If u becomes infinite, or particles meet.

    Warns
    -----
    AccuracyWarning
        If the particles do not resolve `initial`, u or a coefficient; if the step is too long for the exchange; if
        placements changed u; or if u reaches the outermost particles.
    """
    low, high = check.pair("window", window, rising=True)
    seen = check.finite_array("where", where).ravel() if np.size(where) else np.zeros(0)
    physics = Physics(
        check.fractional_order(alpha),
        check.whole_number("near", near, 1, MOST_NEAR),
        Called("diffusivity", diffusivity, ("x",))
        if callable(diffusivity)
        else check.scale("diffusivity", diffusivity),
        None if velocity is None else Called("velocity", velocity, ("x", "t")),
        None if source is None else Called("source", source, ("x", "t", "u")),
    )
    tolerance = check.real_between("tolerance", tolerance, 1e-13, 1e-2)
    again = check.flag("again", again)
    outputs = _output_times(times)
    samples = adapted_samples(Called("initial", initial, ("x",)), low, high, seen)
    if reach is None:
        most = float(physics.diffusivity_at(samples[0]).max())
        reach = reach_of(initial, samples, physics.alpha, most * float(outputs[-1]))
    reach = check.scale("reach", reach)

    place = Place(physics, (low, high), seen, step)
    particles = place(samples, (low - reach, high + reach), 0.0)
    u = check.sampled("initial", initial, particles.x)
    _warn(_missed(initial, particles, u), "between the particles is")
    _warn_of_bends(_beyond(initial, particles, u, (low, high)))
    _warn(_EXCHANGE * step ** order_of(physics.alpha, physics.near), "the exchange is off by some")
    start, unheld = Followed(0.0, particles, u, 1, 0.0), _Unheld()
    advance = Splitting(physics, tolerance)
    cuts = _sudden(physics, particles.x, u, float(outputs[-1]))
    results = list(_onward(start, outputs.tolist(), place, advance, again, unheld, cuts))
    for name, share in unheld.of_coefficients.items():
        _warn(share, f"of the {name} the particles miss", what="it")
    _warn(unheld.of_u, "later, between the particles is")
    _warn(results[-1].corrected, "the placements were off by")
    _warn(_at_the_ends(results[-1], physics.alpha), "beyond the particles is", "Go farther out.")
    return results


def _output_times(times: Sequence[float] | float) -> FloatArray:
    outputs = check.vector("times", np.atleast_1d(times))
    if outputs.size > _MOST_TIMES or outputs[0] < 0.0 or (np.diff(outputs) <= 0.0).any():
        allowed = f"up to {_MOST_TIMES} ascending times from 0 on"
        raise InvalidInput("times", times, allowed, "Sort them, without doubles.")
    return outputs


@dataclass
class _Unheld:
    """The largest shares of u and of the coefficients that particles have not held between them, over a run."""

    of_u: float = 0.0
    of_coefficients: dict[str, float] = field(default_factory=dict)

    def note_coefficients(self, found: dict[str, float]) -> None:
        for name, share in found.items():
            self.of_coefficients[name] = max(self.of_coefficients.get(name, 0.0), share)


def _onward(
    state: Followed,
    outputs: list[float],
    place: Place,
    advance: Splitting,
    again: bool,
    unheld: _Unheld,
    cuts: list[float],
) -> Iterator[Followed]:
    """The particles at each output time: advanced to the next cut, or as long as their places are valid."""
    until = place.valid_until(state.particles, state.u, state.time) if again else np.inf
    unheld.note_coefficients(place.missed(state.particles, state.u, state.time))
    for output in outputs:
        while state.time < output:
            if until <= state.time:
                state = _placed_again(state, place)
                until = place.valid_until(state.particles, state.u, state.time)
                unheld.note_coefficients(place.missed(state.particles, state.u, state.time))
                if not until > state.time or state.placements > _MOST_PLACEMENTS:
                    raise NonFiniteSolution(
                        f"u, its source or the velocity change so fast at t = {state.time:.6g} that particles would be "
                        f"placed again every {until - state.time:.2g}. Smooth them, or take a shorter time."
                    )
            later = bisect_right(cuts, state.time)
            time = min(until, output, *cuts[later : later + 1])
            moved, u = advance(state.particles, state.u, state.time, time)
            state = replace(state, time=time, particles=moved, u=u)
            unheld.of_u = max(unheld.of_u, uncertain(moved.x, u))
        yield state


def _sudden(physics: Physics, x: FloatArray, u: FloatArray, end: float) -> list[float]:
    """Return the times before and after each sudden change of the source, for u at first and what the source makes."""
    source = physics.source
    if source is None or end == 0.0:
        return []
    most = [int(np.abs(u).argmax())]

    def changes(u: FloatArray, looks: int = LOOKS // 4) -> list[float]:
        known = pulses_at(lambda x, u, t: source(x, t, u), (x[most], u[most]), 0.0, end)
        try:
            return sudden_times(lambda t: rate(t, u), 0.0, end, known=known, looks=looks)
        except InvalidInput:  # later u may be where the source is finite
            return sorted(t for t in known if 0.0 < t < end)

    def rate(t: float, u: FloatArray) -> FloatArray:
        return physics.source_at(x, t, u)

    with np.errstate(all="ignore"):
        return sorted({*changes(u, LOOKS), *changes_of_what_comes(changes, rate, u, 0.0, end)})


def _placed_again(state: Followed, place: Place) -> Followed:
    """The same u on particles that are placed by it, between the same ends."""
    old = state.particles
    new = place((old.x, state.u), (float(old.x[0]), float(old.x[-1])), state.time)
    u = between(old.x, state.u, new.x)
    u, share = conserving(new, u, state.mass, float(old.volumes * old.x @ state.u))
    return Followed(state.time, new, u, state.placements + 1, state.corrected + share)


def _missed(
    initial: Callable[[FloatArray], FloatArray], particles: LineParticles, u: FloatArray
) -> float:
    """The share of int |u| that a spline misses between the particles."""
    x = particles.x
    middles = 0.5 * (x[1:] + x[:-1])
    exact = check.sampled("initial", initial, middles)
    return float(np.diff(x) @ np.abs(between(x, u, middles) - exact) / (np.diff(x) @ np.abs(exact)))


def _beyond(
    initial: Callable[[FloatArray], FloatArray],
    particles: LineParticles,
    u: FloatArray,
    window: tuple[float, float],
) -> float:
    """The share by which a spline misses `initial` beyond the window, at the worst of many places.

    The wings of a narrow bump, where it falls on no place, are seen. Nothing is where |u| times the distance from the
    window is less than 1e-7 of int |u|.
    """
    places, held = among(particles.x, u)
    far = np.maximum(window[0] - places, places - window[1])
    places, held, far = places[far > 0.0], held[far > 0.0], far[far > 0.0]
    exact = check.sampled("initial", initial, places)
    there = np.abs(exact) * far > _NOTHING * (particles.volumes @ np.abs(u))
    return float((np.abs(exact - held)[there] / np.abs(exact[there])).max(initial=0.0))


def _at_the_ends(state: Followed, alpha: float) -> float:
    """The share of int |u| beyond the particles, if u goes on as |x|^(-1-alpha)."""
    x, u = state.particles.x, np.abs(state.u)
    beyond = 0.5 * (x[-1] - x[0]) / alpha * (u[0] + u[-1])
    return float(beyond / (beyond + state.particles.volumes @ u))


def _warn(
    share: float,
    text: str,
    advice: str = "Take a shorter step, or name `where` the narrow parts are.",
    what: str = "int |u|",
) -> None:
    if not share < _UNRESOLVED:
        warnings.warn(f"{text} {share:.1g} of {what}. {advice}", AccuracyWarning, stacklevel=3)


def _warn_of_bends(share: float) -> None:
    if not share < _BENT:
        warnings.warn(
            f"beyond the window `initial` is not what the particles hold, by {share:.1g} of it. Widen the window: what "
            "lies beyond is not searched for bends.",
            AccuracyWarning,
            stacklevel=3,
        )
