r"""The common part of an interval, a disc and a square: particles, and the equation that is solved on them,

    u_t = D A u + f(x, t, u),    A u(x) = c int (u(y) - u(x)) |x - y|^(-n-alpha) dy,

with one of three exteriors:

absorbing
    u = 0 outside: the restricted operator -(-Laplacian)^(alpha/2).
reflecting
    Nothing is outside: the integral is over the domain alone, the regional operator (Guan & Ma, Probab. Theory Relat.
    Fields 134 (2006) 649), which conserves.
given
    u = g outside; g is taken off as in `given`.

A domain defines A between its particles, the steady field under a load, and the decay towards it. If nothing depends on
time, u is the steady field and the decayed distance from it. Otherwise steps are taken.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Collection
from itertools import pairwise
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.bounded.given import Outside, given_outside
from fracparticles.bounded.modes import Rest
from fracparticles.bounded.operator import LOOKS, DomainOperator
from fracparticles.called import AXES, Called
from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution
from fracparticles.time.fading import FADED, early_errors
from fracparticles.time.sudden import changes_of_what_comes, instant, pulses_at, sudden_times

__all__ = ["EXTERIORS", "Domain"]

_FEW = 9  # times in a piece of the run at which a source is evaluated for the size that it may make

EXTERIORS = ("absorbing", "reflecting", "given")
"""The three exteriors of a bounded domain."""


class Domain(DomainOperator):
    """Particles in a bounded domain, and the problems that can be solved on them."""

    def __repr__(self) -> str:
        """Return its kind, exterior, order and number of particles in a line."""
        count = self.volumes.size
        return (
            f"<{type(self).__name__}: {self.exterior}, alpha = {self.alpha:.6g}, {count} particles>"
        )

    def stationary(self, source: Any = 0.0, outside: Any = None) -> FloatArray:
        """Return the u with D A u + f = 0; for reflecting edges the one of total 0.

        Parameters
        ----------
        source : callable, array or number
            f as a function of places, or its values at the particles.
        outside : callable or number, optional
            g as a function of places, if the exterior is given.

        Raises
        ------
        InvalidInput
            If they are not finite, `outside` is missing or superfluous, or the total of f is not zero between
            reflecting edges.

        Warns
        -----
        AccuracyWarning
            If the particles do not resolve the source.
        """
        lift = self._lift_at(given_outside(self.exterior, outside, len(self.points)), 0.0)
        f = self.seen("source", source)
        if self.exterior == "reflecting":
            whole, size = self.total(f), self.total(np.abs(f))
            if abs(whole) > self.balance * size:
                shown = f"int f = {whole:.3g}"
                allowed = "a source of total 0, where nothing leaves"
                raise InvalidInput("source", shown, allowed, "Take its mean off.")
            f = f - self._mean(f)
        return lift.base + self.at_rest(f + lift.load)

    def evolve(
        self,
        initial: Any,
        time: float,
        source: Any = None,
        outside: Any = None,
        tolerance: float = 1e-10,
    ) -> FloatArray:
        """Return u at the particles a time after `initial`: exact in time if nothing depends on time.

        Parameters
        ----------
        initial : callable, array or number
            u at the time 0: a function of places, or its values at the particles.
        time : float
            The time from `initial` on.
        source : callable, array or number, optional
            f as a function of places and time, or of some of these (`called` says which), or values that do not
            change.
        outside : callable or number, optional
            g as a function of places and time, or of some of these, if the exterior is given.
        tolerance : float
            The error of each step in time, relative to u or to the values outside, if steps are taken. A pulse of less
            than a millionth of the time may not be seen, nor one of less than a 513th if the source cannot be evaluated
            at a few places and many times at once.

        Raises
        ------
        InvalidInput
            If they are not finite, `outside` is missing or superfluous, or the time is outside its range.
        NonFiniteSolution
            If g varies too fast in time, or numbers overflow.

        Warns
        -----
        AccuracyWarning
            If the particles do not resolve the data or the source, or little of u is left beside the errors of early
            steps.
        """
        dim = len(self.points)
        time = self._lasting(time)
        tolerance = check.real_between("tolerance", tolerance, 1e-13, 1e-2)
        g = given_outside(self.exterior, outside, dim)
        given = Called("source", source, (*AXES[:dim], "t")) if callable(source) else None
        if given is not None and "t" in given.takes:

            def forced(t: float, u: FloatArray) -> FloatArray:
                return self.values("source", lambda *place: given(*place, t))

            start = self.seen("initial", initial)
            known = self._pulses(lambda u, *at: given(*at), start, time)
            return self._moved(start, time, forced, g, tolerance, known)
        f = self.seen("source", 0.0 if source is None else source)
        start = self.seen("initial", initial)
        if g is not None and g.varies:
            return self._moved(start, time, lambda t, u: f, g, tolerance)
        with np.errstate(over="ignore", invalid="ignore"):
            return self._finite(self._relaxed(start, time, f, g), time)

    def react(
        self,
        initial: Any,
        time: float,
        source: Callable[..., Any],
        outside: Any = None,
        tolerance: float = 1e-8,
    ) -> FloatArray:
        """Return u at the particles a time after `initial`, with a source f of places, time and u.

        Parameters
        ----------
        initial, time, outside, tolerance
            As those of `evolve`.
        source : callable
            f as a function of places, time and u, or of some of these: `called` says which.

        Raises
        ------
        InvalidInput
            If an argument is outside its range.
        NonFiniteSolution
            If u becomes infinite, or the steps too short or too many; says when.

        Warns
        -----
        AccuracyWarning
            As `evolve`.
        """
        axes = AXES[: len(self.points)]
        f = Called("source", source, (*axes, "t", "u"))
        time = self._lasting(check.positive_real("time", time))
        tolerance = check.real_between("tolerance", tolerance, 1e-12, 1e-2)
        g = given_outside(self.exterior, outside, len(self.points))
        start = self.seen("initial", initial)

        def reaction(t: float, u: FloatArray) -> FloatArray:
            with np.errstate(over="ignore", invalid="ignore"):
                rates = np.asarray(f(*self.points, t, u), dtype=float)
            return np.broadcast_to(rates, u.shape)

        def changes(u: FloatArray) -> set[float]:
            found = sudden_times(lambda t: reaction(t, u).reshape(-1), 0.0, time, looks=LOOKS)
            return set(found) | self._pulses(lambda one, *at: f(*at, one), u, time)

        self.values("source", lambda *place: f(*place, 0.0, start) + 0.0 * place[0])
        known = self._pulses(lambda u, *at: f(*at, u), start, time)
        if "u" in f.takes:
            with np.errstate(all="ignore"):
                known |= changes_of_what_comes(changes, reaction, start, 0.0, time)
        return self._moved(start, time, reaction, g, tolerance, known)

    # --- how -----------------------------------------------------------------------------------------

    def _relaxed(
        self, start: FloatArray, time: float, f: FloatArray, g: Outside | None
    ) -> FloatArray:
        """Return the steady field and the decayed distance from it; where nothing leaves, the mean of f adds up."""
        lift = self._lift_at(g, 0.0)
        mean = self._mean(f) if self.exterior == "reflecting" else 0.0
        steady = self.at_rest(f - mean + lift.load)
        left = self.decayed(start - lift.base - steady, time)
        return np.asarray(lift.base + steady + time * mean + left)

    def _pulses(self, f: Callable[..., Any], start: FloatArray, time: float) -> set[float]:
        """Return the pulses of f(u, *place, t) at two particles: near the middle, and where |start| is greatest."""
        places = [x.reshape(-1) for x in self.points]
        off = sum((x - x.mean()) ** 2 for x in places)
        two = [int(np.argmin(off)), int(np.abs(start).argmax())]
        with np.errstate(all="ignore"):
            return pulses_at(f, [start.reshape(-1)[two], *(x[two] for x in places)], 0.0, time)

    def _moved(
        self,
        start: FloatArray,
        time: float,
        f: Rest,
        g: Outside | None,
        tolerance: float,
        known: Collection[float] = (),
    ) -> FloatArray:
        lift = self.lift_in_time(g, 0.0, time)

        def rest(t: float, v: FloatArray) -> FloatArray:
            now = lift(t)
            return f(t, v + now.base) + now.load - now.slope

        if time == 0.0:
            return start
        sudden = sudden_times(
            lambda t: f(t, start).reshape(-1), 0.0, time, known=known, looks=LOOKS
        )
        changes, pieces, made = set(sudden), list(pairwise((0.0, *sudden, time))), 0.0
        if not start.any() and not lift(0.0).base.any():  # the size that the source may make
            # An end of a piece may be the flank of a pulse, which is no measure of the whole piece.
            made = sum(
                (b - a) * float(np.abs(rest(a + share * (b - a), start)).max()) / _FEW
                for a, b in pieces
                for share in (np.arange(_FEW) + 0.5) / _FEW
            )
            made = made or 1.0

        def held(t: float) -> FloatArray:
            return np.maximum(np.abs(lift(t).base), made)

        v, steps = start - lift(0.0).base, self.steps(rest, tolerance, held)
        for before, after in pieces:
            if before in changes and after in changes and after - before <= instant(0.0, time):
                continue  # within a jump
            v = steps.advance(v, after - before, before)
            steps.forget()
        u = self._finite(lift(time).base + v, time)
        (share,) = early_errors(
            tolerance, (0.0, time), (start, u), f, lambda: float(self.eigenvalues(1)[0]),
            lambda t: float(held(t).max()),
        )  # fmt: skip
        if share > FADED:
            text = f"u has fallen: errors of early steps, within the tolerance, are {share:.2g} of what is left. Take a"
            warnings.warn(
                f"{text} smaller tolerance, or go in shorter times.", AccuracyWarning, stacklevel=3
            )
        return u

    def _lasting(self, time: float) -> float:
        return check.not_negative("time", time)

    def _finite(self, u: FloatArray, time: float) -> FloatArray:
        if not np.isfinite(u).all():
            text = f"u is not finite at t = {time:g}: data or source are near the largest number. Take other units."
            raise NonFiniteSolution(text)
        return u
