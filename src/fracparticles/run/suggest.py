"""From a problem and an accuracy to a run: scheme, order, spacing, half-width, evaluation.

The fastest of the schemes is GPSE in one step over the whole time, on an open lattice, by one pair of transforms
(`results/tables/time_to_accuracy`). KPSE of order 12, exact in time, takes its place if the kernel of GPSE would be
wider than a lattice can sum, a thousand spacings, or so narrow that it needs more particles than the data. The search
starts on a coarse and narrow lattice. The estimate of the error says which of the two, spacing or half-width, leaves
the larger error, and this one is improved until the error is the one asked for. Then both are taken back as far as the
error allows.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from fracparticles.arguments import dimension, positive_real, real_between, scale
from fracparticles.data.interpolated import Measured
from fracparticles.errors import AccuracyWarning, FracparticlesWarning, InvalidInput
from fracparticles.run.case import FUNDAMENTAL, Case
from fracparticles.run.estimate import estimate_of
from fracparticles.run.initial import Initial, of_places, resolved
from fracparticles.run.radius import radius_of
from fracparticles.run.reliability import LIMITS
from fracparticles.run.solver import compute
from fracparticles.schemes import ALL_SCHEMES
from fracparticles.special.stable import central_mass

__all__ = ["suggest"]

_SELF_TIMED = next(name for name, one in ALL_SCHEMES.items() if one.self_timed)
_ORDER = 12  # of KPSE
_EXCHANGE = next(
    name for name, one in ALL_SCHEMES.items() if _ORDER in one.box_orders and one.conservative
)
_OPEN = {"exterior": "open", "evaluation": "auto"}
_WAYS: tuple[dict[str, Any], ...] = (
    {"scheme": _SELF_TIMED, **_OPEN},
    {"scheme": _EXCHANGE, "order": _ORDER, "integrator": "exponential", **_OPEN},
)
_FINER, _WIDER = 0.7, 1.4  # factors of spacing and half-width in a step of the search
_FAR = 10.0  # error over the one asked for: from here the search takes two steps at once
_BACK = 1.2  # the factor by which spacing and half-width are taken back at a time
_SAFE = 0.7  # share of the error asked for that a case must meet
_CERTAIN = 0.03  # share of the error asked for by which the estimates may be uncertain
# What a run warns of if the particles do not resolve the data. The estimate may not see it: data that fall very slowly
# are nearly constant from one of the far particles to the next, and have their peak at one of them.
_OF_THE_DATA = "resolution", "between_particles"
_MOST_TRIALS, _MOST_WIDENINGS = 60, 8
# A trial that leaves more than this part of the lowest error is in vain; so many of them in a row end the search.
_LOWER, _MOST_IN_VAIN = 0.9, 5
_HELD = 0.97  # share of the mass of a point that the lattice must hold if no radius is given
# Radius of interest over (D T)^(1/alpha): beyond it the kernel of GPSE needs more particles than the data.
_WIDE = 100.0
# (D T)^(1/alpha) over the radius, to the power of the dimension: some 2e6 particles, two minutes.
_MOST_SPREAD = 1e4
_MOST_PARTICLES = (
    4_000_000  # with more, a run takes minutes and ten gigabytes, and so does each trial
)
# The most points of an estimate, by dimension: many estimates are made.
_POINTS = {1: 1_000_000, 2: 5_000_000, 3: 5_000_000}
_TERMS = {1: 3, 2: 3, 3: 2}  # of the tail beyond the lattice, by dimension
_SMALLEST = 1e-11  # error that may be asked for
_START = 6.0  # spacings within the radius of interest, at first
_FEWEST = 8.0  # spacings on either side of the lattice, at first


def suggest(
    initial: Initial = FUNDAMENTAL,
    *,
    error: float,
    alpha: float | None = None,
    beta: float | None = None,
    t_initial: float = 0.0,
    t_final: float | None = None,
    times: Sequence[float] | None = None,
    diffusivity: float = 1.0,
    dim: int = 1,
    within: float | None = None,
) -> Case:
    """Return a case whose relative error, as estimated by `estimate_error`, is at most `error`.

    Parameters
    ----------
    initial : callable, measured data, or "fundamental"
        Data that are known everywhere; a bare array has a lattice already.
    error : float
        The relative error in the 1-norm over |x| <= within, from 1e-11 to 0.5.
    alpha, beta : float
        The fractional order, one of them.
    t_initial, t_final, times, diffusivity, dim
        As for `Case`. With several times, the first and the last must meet the error; the others lie between.
    within : float, optional
        The radius of interest. Left out, it is the radius that holds nine tenths of the data plus 2 (D T)^(1/alpha);
        the lattice then holds nearly all of the solution, and the error is met on all of it.

    Raises
    ------
    InvalidInput
        If the problem is not valid, or the error cannot be reached on this machine; if the data are so narrow, and
        spread so far, that they need other particles than those of a lattice.

    Warns
    -----
    AccuracyWarning
        If measured data leave a larger error open; if the error is not met on all of the lattice.

    Examples
    --------
    >>> case = suggest(lambda x: np.exp(-x * x), error=1e-6, alpha=1.5, t_final=1.0)
    """
    error = real_between("error", error, _SMALLEST, 0.5)
    dim = dimension(dim)
    initial = of_places(initial, dim)
    if not (callable(initial) or (isinstance(initial, str) and initial == FUNDAMENTAL)):
        known = "a function, measured data (fp.measured) or 'fundamental': what is known everywhere"
        raise InvalidInput("initial", type(initial).__name__, known, "Give one of these.")
    given: dict[str, Any] = {
        "alpha": alpha, "beta": beta, "t_initial": t_initial, "t_final": t_final, "times": times,
        "diffusivity": diffusivity, "dim": dim,
    }  # fmt: skip
    fields = {name: value for name, value in given.items() if value is not None}
    if t_final is None and times is None:
        raise InvalidInput("t_final", None, "a number > t_initial", "Give it, or times.")
    unit = _unit(fields)
    problem = Case(scheme=_EXCHANGE, integrator="exponential", half_width=unit, spacing=0.1 * unit,
                   **(fields | {"dim": 1}))  # fmt: skip
    if isinstance(initial, str):
        problem.refuse_point_mass()
    spread = (problem.diffusivity * problem.span) ** (1.0 / problem.alpha)
    least = 0.0
    if within is None:
        radius = radius_of(initial, problem, dim)
        _refuse_narrow(initial, radius, spread, dim)
        within = radius + 2.0 * spread
        least = radius + spread  # and more, until the lattice holds the solution
        while central_mass(least, spread**problem.alpha, problem.alpha, dim) < _HELD:
            least *= 1.1
    within = positive_real("within", within)
    if isinstance(initial, Measured) and initial.error > error:
        warnings.warn(
            f"the data leave a relative error of {initial.error:.2g} open, more than {error:.2g}: no run mends that",
            AccuracyWarning,
            stacklevel=2,
        )
    more = {"far_terms": _TERMS[dim]}
    reached = [np.inf]
    for way in _WAYS if within < _WIDE * spread else reversed(_WAYS):
        wanted = _Wanted(way | fields | more, initial, within, least, spread, error)
        case = _search(wanted, reached)
        if case is not None:
            if least == 0.0:
                return case
            whole = _met_everywhere(case, initial, way | fields | more, spread, error)
            return _widened(whole, initial, way | fields | more, spread)
    best = f"an error that can be reached: the best found is {min(reached):.2g}"
    raise InvalidInput("error", error, best, "Ask for less, or for less of the space.")


def _refuse_narrow(initial: Initial, radius: float, spread: float, dim: int) -> None:
    """Refuse data so narrow for their spread that a lattice which holds both takes minutes to find, or hours."""
    most = _MOST_SPREAD ** (1.0 / dim)
    if spread > most * radius:
        allowed = (
            f"data that spread to at most {most:.3g} times their radius on a lattice: they hold "
            f"within {radius:.2g} and spread over (D T)^(1/alpha) = {spread:.2g}"
        )
        remedy = "Take fp.follow, whose particles are placed by the data; or fp.green times their integral."
        raise InvalidInput("initial", initial, allowed, remedy)


class _Wanted(NamedTuple):
    """What a case must hold: its fields, the data and where they count, the least half-width, (D T)^(1/alpha)."""

    fields: dict[str, Any]
    initial: Initial
    within: float
    least: float
    spread: float
    error: float


def _search(wanted: _Wanted, reached: list[float]) -> Case | None:
    """Refine and widen until the error is met, then take back what is not needed; None if it cannot be met.

    The errors of all trials are added to `reached`.
    """
    fields, initial, within, least, spread, error = wanted
    half = max(1.2 * within, 1.5 * spread, least)
    h = min(within / _START, half / _FEWEST)
    lowest, in_vain = np.inf, 0
    for _ in range(_MOST_TRIALS):
        trial = _trial(fields, h, half, spread)
        if isinstance(trial, InvalidInput):
            if trial.field in ("half_width", "truncation", "lattice"):
                half *= _WIDER
            elif trial.field == "overlap" and h > spread:
                h *= _FINER  # the lattice does not resolve the kernel
            else:  # too many particles, or a kernel wider than can be summed
                return None
            continue
        if trial.particles > _MOST_PARTICLES:
            return None
        total, spacing, domain = _errors(trial, initial, within, error)
        reached.append(total)
        in_vain = in_vain + 1 if total > _LOWER * lowest and np.isfinite(total) else 0
        lowest = min(lowest, total)
        if in_vain > _MOST_IN_VAIN:
            return None
        if total <= _SAFE * error:
            return _taken_back(trial, wanted)
        far = total > _FAR * error
        if domain > spacing:
            half *= _WIDER**2 if far else _WIDER
        else:
            h *= _FINER**2 if far else _FINER
    return None


def _taken_back(best: Case, wanted: _Wanted) -> Case:
    """Return the case on a lattice as narrow, then as coarse, as the error allows."""
    fields, initial, within, least, spread, error = wanted
    for narrower in (True, False):
        h, half = best.spacing, best.reach
        while True:
            h, half = (h, half / _BACK) if narrower else (h * _BACK, half)
            trial = _trial(fields, h, half, spread)
            if half < max(within, least) or isinstance(trial, InvalidInput):
                break
            if _errors(trial, initial, within, error)[0] > _SAFE * error:
                break
            best = trial
    return best


def _widened(case: Case, initial: Initial, fields: dict[str, Any], spread: float) -> Case:
    """Return the case on a lattice so wide that the run warns of nothing, or on the widest one that was tried."""
    for _ in range(_MOST_WIDENINGS):
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            compute(case, initial)
        wider = _trial(fields, case.spacing, _WIDER * case.reach, spread)
        if not any(issubclass(one.category, AccuracyWarning) for one in said) or isinstance(
            wider, InvalidInput
        ):
            break
        case = wider
    return case


def _met_everywhere(
    case: Case, initial: Initial, fields: dict[str, Any], spread: float, error: float
) -> Case:
    """Return the case on a lattice on all of which the error is met, since data far out may be finer than the rest.

    Warns
    -----
    AccuracyWarning
        If no such lattice is found.
    """
    h, half = case.spacing, case.reach
    for _ in range(_MOST_WIDENINGS):
        total, spacing, domain = _errors(case, initial, None, error)
        if total <= error:
            return case
        h, half = (h, _WIDER * half) if domain > spacing else (_FINER * h, half)
        trial = _trial(fields, h, half, spread)
        if isinstance(trial, InvalidInput):
            break
        case = trial
    warnings.warn(
        f"over the whole lattice the error is {total:.2g}, more than {error:.2g}: the data hold something far out that "
        "is finer than the rest. Give within, or a case of your own.",
        AccuracyWarning,
        stacklevel=3,
    )
    return case


def _trial(fields: dict[str, Any], h: float, half: float, spread: float) -> Case | InvalidInput:
    """Return the case on this lattice, or why there is none."""
    own = (
        {"dt": spread ** _alpha(fields) / fields.get("diffusivity", 1.0)}
        if fields["scheme"] == _SELF_TIMED
        else {}
    )
    try:
        return Case(**fields, **own, half_width=half, spacing=h)
    except InvalidInput as refused:
        return refused if refused.field != "dt" else InvalidInput("overlap", *refused.args[1:])


def _unit(fields: dict[str, Any]) -> float:
    """Return (D T)^(1/alpha) of fields that nobody has checked yet, 1 if it is no length."""
    try:
        last = fields["t_final"] if "t_final" in fields else max(fields["times"])
        power = fields.get("diffusivity", 1.0) * (last - fields["t_initial"])
        return scale("spread", power ** (1.0 / _alpha(fields)))
    except (InvalidInput, ArithmeticError, LookupError, TypeError, ValueError):
        return 1.0


def _alpha(fields: dict[str, Any]) -> float:
    return float(fields["alpha"] if "alpha" in fields else 1.0 + fields["beta"])


def _errors(
    case: Case, initial: Initial, within: float | None, asked: float
) -> tuple[float, float, float]:
    """Return the error and its parts by spacing and half-width, at the worse one of the first and the last time.

    They are as certain as the error that is `asked` for wants them.
    """
    times = {case.t_final} if case.times is None else {case.times[0], case.times[-1]}
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FracparticlesWarning)
        for time in times:
            try:
                source = resolved(case, initial)
                run = compute(case.until(time), source)
                if any(run.estimates.get(name, (0.0,))[0] > LIMITS[name] for name in _OF_THE_DATA):
                    return np.inf, 1.0, 0.0
                one = estimate_of(run, source, within, _POINTS[case.dim], _CERTAIN * asked)
            except InvalidInput as refused:
                if refused.field != "initial":
                    raise
                return np.inf, 1.0, 0.0  # a lattice too coarse for the data
            found.append((one.total - one.data, one.spacing, one.domain))
    return max(found)
