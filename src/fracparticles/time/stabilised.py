"""RKC2 with an error-controlled step, for u' = R(t, u), stiff and with a spectrum near the negative real axis.

Sommeijer, Shampine & Verwer, J. Comput. Appl. Math. 88 (1998) 315, Section 3. The step of `time.rkc` has the error
estimate

    Est = 0.8 (u_n - u_(n+1)) + 0.4 dt (R_n + R_(n+1)),

and 1 + sqrt(1 + 1.54 dt rho) stages. rho is the spectral radius of the Jacobian, from a power iteration with
differences of R. Time is one more unknown, t' = 1, so that each stage knows its time. The error allowed in a step is
sqrt(rtol) times that of the paper. The error of a step is of third order in dt, and that of the run of second order;
with this factor the error of the run is about rtol, whatever the number of steps.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fracparticles.time.rkc import ChebyshevStep
from fracparticles.time.steps import (
    Absolute,
    ControlledStep,
    Pace,
    Rate,
    absolute,
    blown_up,
    norm,
)

__all__ = ["StabilisedStep", "spectral_radius"]

State = tuple[np.ndarray, np.ndarray]
"""u and R(u)."""

_MOST_STAGES = 200  # of a step
_RENEW = 25  # steps after which rho is estimated again
_SAFETY = 1.2  # factor by which rho is taken too large
_ITERATIONS = 50  # of the power iteration for rho, at most
_CONVERGED = 0.01  # share of rho: a smaller change ends the iteration
_SHORTEST = 16.0 * 2.0**-52  # the shortest step, relative to t


class StabilisedStep(ControlledStep):
    """Steps of RKC2; the root mean square of Est / (atol + rtol |u|) is at most sqrt(rtol) in each."""

    def __init__(self, rate: Rate, rtol: float, atol: Absolute) -> None:
        super().__init__(rate, rtol, atol)
        self._rho = 0.0
        self._before: tuple[float, float] | None = None  # length and error of the last step
        self._mode: np.ndarray | None = None

    def advance(self, u: np.ndarray, span: float, start: float = 0.0) -> np.ndarray:
        """Return u after the time `span`, shape (N,); raises `NonFiniteSolution` as `EighthOrderStep.advance`."""
        # The time is counted from the start: beside a large one, no step is short.
        done, pace = 0.0, Pace(start, span)
        t, r = start, self._rate(start, u)
        self._look(t, u, r)
        dt = min(span, self._dt or self._first(t, u, r, span))
        since = 0
        while done < span:
            dt = min(dt, span - done)
            most = (_MOST_STAGES - 1) ** 2 / (1.54 * self._rho) if self._rho > 0.0 else np.inf
            dt = min(dt, most)
            if dt < _SHORTEST * span:
                raise blown_up(t, u)
            stages = max(2, 1 + int(np.sqrt(1.0 + 1.54 * dt * self._rho)))
            new = _one_step(self._rate, stages, t, u, r, dt)
            after = self._rate(t + dt, new)
            error = self._error(t, (u, r), (new, after), dt)
            if not error <= 1.0:
                self.rejected += 1
                dt *= max(0.1, 0.8 * error ** (-1.0 / 3.0)) if np.isfinite(error) else 0.1
                if since:  # rho was estimated at an earlier time
                    self._look(t, u, r)
                    since = 0
                continue
            self.accepted += 1
            done = done + dt if span - done - dt > 1e-14 * span else span
            t = start + done
            pace.stepped(t)
            u, r = new, after
            self._dt, dt = dt, dt * self._growth(dt, max(error, 1e-10))
            since += 1
            if since >= _RENEW and done < span:
                self._look(t, u, r)
                since = 0
        self._dt = max(self._dt or 0.0, dt)
        return u

    def forget(self) -> None:
        """Let the next step find its length anew."""
        super().forget()
        self._before = None

    def _growth(self, dt: float, error: float) -> float:
        """The ratio of the next step to this one, by a controller that remembers one step."""
        factor = 0.8 * error ** (-1.0 / 3.0)
        if self._before is not None:
            last, was = self._before
            factor = min(factor, 0.8 * was ** (1.0 / 3.0) / error ** (2.0 / 3.0) * dt / last)
        self._before = dt, error
        return float(min(5.0, max(0.1, factor)))

    def _error(self, t: float, before: State, after: State, dt: float) -> float:
        (u, r), (new, r_new) = before, after
        with np.errstate(over="ignore", invalid="ignore"):
            estimate = 0.8 * (u - new) + 0.4 * dt * (r + r_new)
            return self._norm(estimate, t, u, new)

    def _norm(self, what: np.ndarray, t: float, *of: np.ndarray) -> float:
        scale = absolute(self._atol, t, of[0]) + self._rtol * np.max(np.abs(of), axis=0)
        return float(np.sqrt(np.mean(np.square(what / scale)) / self._rtol))

    def _first(self, t: float, u: np.ndarray, r: np.ndarray, span: float) -> float:
        """A first step whose error is about a tenth of the tolerance, from the change of R over a short step."""
        dt = min(span, 1.0 / self._rho if self._rho > 0.0 else span)
        with np.errstate(over="ignore", invalid="ignore"):
            change = dt * self._norm(self._rate(t + dt, u + dt * r) - r, t, u)
        if not np.isfinite(change):
            return dt * 1e-3
        return min(span, 0.1 * dt / np.sqrt(change)) if change > 0.01 else dt

    def _look(self, t: float, u: np.ndarray, r: np.ndarray) -> None:
        rho, self._mode = spectral_radius(self._rate, t, u, r, self._mode)
        self._rho = _SAFETY * rho
        self.largest = max(self.largest, rho)


def spectral_radius(
    rate: Rate, t: float, u: np.ndarray, r: np.ndarray, mode: np.ndarray | None = None
) -> tuple[float, np.ndarray]:
    """Return an estimate of the largest |lambda| of dR/du at u, R(u) = r, and its eigenvector.

    This is a power iteration with (R(u + v) - R(u)) / |v|, |v| small against |u|. It starts from `mode`, or else from
    the shortest wave of the lattice.
    """
    if mode is None:
        mode = np.where(np.arange(u.size) % 2, -1.0, 1.0) * (1.0 + 0.1 * np.cos(np.arange(u.size)))
    small = np.sqrt(2.0**-52) * max(norm(u), float(np.sqrt(u.size)) * 1e-100)
    rho = 0.0
    for _ in range(_ITERATIONS):
        size = norm(mode)
        if not 0.0 < size < np.inf:
            break
        step = mode * (small / size)
        with np.errstate(over="ignore", invalid="ignore"):
            image = rate(t, u + step) - r
            now = norm(image) / small
        if not np.isfinite(now):
            break
        done = abs(now - rho) <= _CONVERGED * now
        rho, mode = now, image
        if done:
            break
    return rho, mode


def _one_step(
    rate: Rate, stages: int, t: float, u: np.ndarray, r: np.ndarray, dt: float
) -> np.ndarray:
    """One step of RKC2 from u, where R(t, u) = r, with the time as one more unknown."""
    start = np.append(u, t)

    def with_time(y: np.ndarray) -> np.ndarray:
        return np.append(r if y is start else rate(float(y[-1]), y[:-1]), 1.0)

    return _step_of(stages)(with_time, start, dt)[:-1]


@lru_cache(maxsize=256)
def _step_of(stages: int) -> ChebyshevStep:
    return ChebyshevStep(stages)
