"""What the strengths of a run say of its accuracy: estimates for the data set; `doubts` warns where they are not small.

No estimate knows the exact solution. Each looks at one assumption of the schemes:

resolution
    s theta, s = epsilon / h but at least 1.1, with the wavenumber of the initial data from sin(theta / 2) =
    |delta u| / (2 |u|), delta the difference of neighbours, |.| the 2-norm. A kernel of order r damps a wave like
    (s theta / 2)^r. A peak in the middle between two particles, of which they see the tails |x|^-2, has theta = 0.92.
between_particles
    int |I - u| / int (|I| + |u|) of initial data that are a function u, where I interpolates its values at the
    particles. u and I are compared at two places between each two particles, since waves of period h may be zero at one
    of them, too; the larger value counts. No other estimate can see what lies between the particles.
wave_error
    sum |u^| |p(A dt)^n - exp(-T D |k|^alpha)| / sum |u^| exp(-T D |k|^alpha), with p from the symbol of A and the
    transform u^ of the initial data: the error of a peak, where all waves are in phase, over the peak. It is large if
    the lattice or the time step is too coarse, the overlap too small, or the order low. For DVM it is what the field
    (7) lacks. For several output times it is the largest: waves that are wrong at an early time have decayed at the
    last.
growth
    max |u(t_f)| / max |u(t_i)|, or int |u(t_f)| / int |u(t_i)| on the lattice less the share of u(t_i) that lies beyond
    it: both are at most 1 for the equation.
table_error
    T |(A - A') u| / |u|, A' with interpolated kernels, A with exact ones, |.| the 1-norm.
outside_share
    The share of int |u| beyond the lattice, if u goes on as c |x|^(-n-alpha), c from the outermost particles. On a
    truncated lattice it is at least the share of a point mass that leaves it during the run: where the ends absorb,
    the outermost particles hold too little to show it.
kept
    (int_{|x| > L} of the fundamental solution for a step)^n times max |u(t_i)| / max |u|, of n exchanges by GPSE on a
    truncated lattice; of several output times the largest.
tail_misfit
    How far the powers that continue u in an open exterior are from strengths that they were not made to meet.
far_field_error
    tail_misfit x outside_share x the share that travels from the outside well into the lattice, int_{|x| > L/2} of the
    fundamental solution for the time of the run.
decay
    T |A(0)|, the exponent by which a constant decays on the infinite lattice, where it should stay: the scheme DD at an
    overlap too small.
round_off
    64 T |lambda| 2^-52: an application of A is exact to some 2^-53 |lambda|, and the recurrence of a series adds to it.

The estimates cost a few passes over the strengths. Graded particles, whose operator has no symbol, have the first two,
`growth`, `outside_share` and `kept`; their wavenumber is that in the mapped variable, in which they are equally spaced.
DVM, whose particles spread with the solution, has the first two, `wave_error`, `growth`, and `outside_share` of u(t_i);
see also `moving.dvm`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.graded.particles import graded_particles
from fracparticles.kernels.families import kernel_transform
from fracparticles.lattice.exterior import continuation
from fracparticles.lattice.exterior_box import box_continuation
from fracparticles.schemes import SCHEMES
from fracparticles.special.stable import central_mass
from fracparticles.time import STEP_POLYNOMIALS

if TYPE_CHECKING:
    from fracparticles.run.case import Case

__all__ = ["LIMITS", "PARTS", "ULPS", "Estimates", "between_four", "estimates", "growth"]

Estimates = dict[str, tuple[float, str]]

PARTS = 0.5, 0.381966  # of the spacing: where data and coefficients are looked at between particles

# Above these a warning is given.
LIMITS = {
    "resolution": 1.0,  # an error of a quarter in the operator, at order II
    "between_particles": 0.05,  # of the mass
    "growth": 1.1,
    "wave_error": 0.05,
    "table_error": 0.05,
    "outside_share": 0.05,  # of the mass
    "kept": 0.05,  # of the peak
    "far_field_error": 5e-5,
    "round_off": 1e-6,
    "decay": 0.01,
}
_LEAST_SMOOTHING = 1.1  # so that theta = 0.92, of a peak between two particles, is above the limit
ULPS = 64.0  # in T |lambda| 2^-52: measured of a Chebyshev series, for sums by transforms and by a matrix alike
_WAVES = 64  # of the strengths, of equal shares, at which the symbol is looked at
_SURFACE = {1: 2.0, 2: 2.0 * np.pi, 3: 4.0 * np.pi}  # of the unit sphere


def estimates(
    case: Case,
    u0: np.ndarray,
    u: np.ndarray,
    initial: Any = None,
    outputs: Iterable[np.ndarray] | None = None,
) -> Estimates:
    """Return each estimate by name, with what it is in words.

    Parameters
    ----------
    case : Case
    u0, u : array, shape `case.shape`
        Initial and final strengths.
    initial : optional
        What the initial strengths were given as: if it is a function, it is asked between the particles, too.
    outputs : optional
        The strengths at each of the `times`.
    """
    kept = _kept(case, u0, [u] if outputs is None else outputs) if _keeps(case) else None
    greatest, hidden = growth(u0, u), between_particles(case, u0, initial)
    u0, u = _unit(u0), _unit(u)  # sums of them do not overflow
    outside = outside_share(case, u0)
    left = greatest * _ratio(_inside(case, u), _inside(case, u0))  # of int |u|, on the lattice
    smooths = case.kind.has_kernel and not case.kind.self_timed
    smoothing = max(_LEAST_SMOOTHING, case.resolved_overlap if smooths else 0.0)
    resolution = smoothing * wavenumber(u0)
    found = {
        "resolution": (resolution, "epsilon times the wavenumber of the initial data"),
        "growth": (
            max(greatest, left * (1.0 - outside)),
            "greatest |u|, or int |u|, over that at t_initial",
        ),
    }
    if callable(initial):
        found["between_particles"] = (hidden, "misfit of initial data between the particles")
    if not case.is_graded:  # whose operator has no symbol
        found["wave_error"] = (wave_error(case, u0), "error of the waves of a peak, over the peak")
    if case.kind.moving:  # its particles spread with the solution
        found["outside_share"] = (outside, "estimated share of |u| beyond the lattice at t_initial")
        return found
    if not case.is_graded:
        found |= _of_the_operator(case, u0, u)
    outside = max(outside, outside_share(case, u))
    if case.exterior == "truncated":
        outside = max(outside, _beyond(case, case.reach))
    found["outside_share"] = (outside, "estimated share of |u| beyond the lattice")
    if kept is not None:
        found["kept"] = (kept, "what each particle keeps for places beyond the lattice")
    if case.exterior == "open":
        misfit = max(tail_misfit(case, u0), tail_misfit(case, u))
        # Data that vanish at the ends miss their powers by all of nothing.
        worst = max(tail_misfit(case, one) * outside_share(case, one) for one in (u0, u))
        error = worst * _beyond(case, 0.5 * case.reach)
        found["tail_misfit"] = (misfit, "relative misfit of the powers that continue u")
        found["far_field_error"] = (error, "estimated relative error of the far field")
    return found


def _keeps(case: Case) -> bool:
    """Whether the steps are exchanges, in which a particle keeps what it would give beyond the ends."""
    form = "exchange" if not case.is_graded else case.graded_form
    return case.kind.self_timed and case.exterior == "truncated" and form == "exchange"


def _kept(case: Case, u0: np.ndarray, outputs: Iterable[np.ndarray]) -> float:
    return max(
        _ratio(_beyond(one, one.reach, one.time_step) ** one.steps, growth(u0, u))
        for one, u in zip(outputs_of(case), outputs, strict=True)
    )


def _of_the_operator(case: Case, u0: np.ndarray, u: np.ndarray) -> Estimates:
    """What the symbol of the operator says, and its kernel table."""
    low, high = (case.span * case.setting.rate * value for value in case.symbol_range)
    round_off = -ULPS * 2.0**-52 * low
    found = {
        "decay": (max(0.0, -high), "exponent by which a constant decays on the infinite lattice"),
        "round_off": (round_off, "what the round-off of the operator may add up to"),
    }
    if case.kernel_table is not None:
        error = table_error(case, u0, u)
        found["table_error"] = (error, "error of the interpolated kernels over the run")
    return found


def growth(u0: np.ndarray, u: np.ndarray) -> float:
    """Return max |u| / max |u0|."""
    return _ratio(np.abs(u).max(), np.abs(u0).max())


def wavenumber(u: np.ndarray) -> float:
    """Return theta = k h of sin(theta / 2) = |delta u| / (2 |u|), the greatest over the axes; 0 for u = 0."""
    u = _unit(u)
    norm = np.sqrt(np.sum(u * u))
    if norm == 0.0:
        return 0.0
    slopes = [np.diff(u, axis=axis) for axis in range(u.ndim)]
    half_sine = max(float(np.sqrt(np.sum(slope * slope))) for slope in slopes) / (2.0 * norm)
    return 2.0 * float(np.arcsin(min(half_sine, 1.0)))


def table_error(case: Case, *strengths: np.ndarray) -> float:
    """Return the most that the interpolation of the kernels may make of the strengths over the run; see the module."""
    scheme, setting = SCHEMES[case.scheme], case.setting
    exact, table = (
        scheme.operator(replace(setting, kernel_table=step)) for step in (None, case.kernel_table)
    )
    flat = [u.reshape(-1) for u in strengths]
    return case.span * max(
        _ratio(np.abs(table.apply(u) - exact.apply(u)).sum(), np.abs(u).sum()) for u in flat
    )


def between_particles(case: Case, u0: np.ndarray, initial: Any) -> float:
    """Return int |I - u| / int (|I| + |u|), see the module; 0 if the data cannot be asked for at other points."""
    if not callable(initial):
        return 0.0
    parts = PARTS if case.graded_scale is None else PARTS[:1]
    return max(_hidden(case, u0, initial, part) for part in parts)


def _hidden(case: Case, u0: np.ndarray, initial: Any, part: float) -> float:
    x, volumes = _between(case, part)
    try:
        with np.errstate(all="ignore"):
            values = initial(*np.meshgrid(*(x,) * case.dim, indexing="ij", sparse=True))
        u = np.broadcast_to(np.asarray(values, dtype=float), (x.size,) * case.dim)
    except Exception:  # whatever it may raise: at the particles it has given numbers
        return 0.0
    greatest = max(np.abs(u0).max(), np.abs(u).max())
    if not 0.0 < greatest < np.inf:
        return 0.0
    interpolated, u = u0 / greatest, u / greatest
    for axis in range(case.dim):
        interpolated = between_four(interpolated, axis, part)
    difference, size = np.abs(interpolated - u), np.abs(interpolated) + np.abs(u)
    return _ratio((volumes * difference).sum(), (volumes * size).sum())


def _between(case: Case, part: float) -> tuple[np.ndarray, np.ndarray | float]:
    """The points between neighbours, of graded particles half-way in s, and what they stand for; not the outermost."""
    if case.graded_scale is None:
        return case.x[1:-2] + part * case.particle_spacing, 1.0
    x, volumes = graded_particles(2 * case.particles - 1, case.reach, case.graded_scale)
    return x[3:-3:2], volumes[3:-3:2] / case.reach


def between_four(u: np.ndarray, axis: int, part: float = 0.5) -> np.ndarray:
    """Return the values a part of the way from each to the next along an axis, of a cubic through four."""
    offsets = np.arange(-1.0, 3.0)
    others = [np.delete(offsets, k) for k in range(4)]
    weights = [np.prod((part - o) / (offsets[k] - o)) for k, o in enumerate(others)]
    count = u.shape[axis] - 3
    return np.asarray(sum(w * u.take(range(k, count + k), axis) for k, w in enumerate(weights)))


def outside_share(case: Case, u: np.ndarray) -> float:
    """Return the share of int |u| that lies beyond the lattice, if |u| goes on as c |x|^(-n-alpha)."""
    dim, alpha, half = case.dim, case.alpha, case.reach
    lattice = np.abs(u)
    edges = [
        (np.take(lattice, k, axis), np.take(case.radius, k, axis) / half)
        for axis in range(dim)
        for k in (0, -1)
    ]
    # The unit of length is the half-width; c is the mean over the boundary.
    c = np.mean([np.mean(strength * radius ** (dim + alpha)) for strength, radius in edges])
    beyond = float(c) * _SURFACE[dim] / alpha
    return _ratio(beyond, beyond + _inside(case, u))


def tail_misfit(case: Case, u: np.ndarray) -> float:
    """Return sum |v - u| / sum |u| over particles at which the continuation v of u was not made to meet it."""
    if case.dim == 1:
        places, continued = continuation(u, case.n, case.alpha, case.far_terms or 1)
    else:
        places, continued = box_continuation(u, case.n, case.alpha)
    given = u.reshape(-1)[places]
    return _ratio(np.abs(continued - given).sum(), np.abs(given).sum())


def wave_error(case: Case, u: np.ndarray) -> float:
    """Return how much of a peak the errors in the amplitudes of its waves may make; see the module."""
    theta = waves(u)
    if not theta.size:
        return 0.0
    return max(_wave_error_at_the_end(one, theta) for one in outputs_of(case))


def outputs_of(case: Case) -> list[Case]:
    """Return the run to each of its output times: an early one may hold waves that have decayed at the last."""
    return [case] if case.times is None else [case.until(time) for time in case.times]


def _wave_error_at_the_end(case: Case, theta: np.ndarray) -> float:
    tau = case.setting.rate * case.span
    exact = np.exp(-tau * theta**case.alpha)
    if case.kind.moving:
        wrong = np.abs(1.0 - _of_the_field(case, theta)) * exact
        return _ratio(wrong.sum(), exact.sum())
    along = theta if case.dim == 1 else theta[:, None] * np.eye(case.dim)[0]
    symbol = SCHEMES[case.scheme].symbol(along, case.setting)
    with np.errstate(over="ignore"):
        if case.steps:
            polynomial = STEP_POLYNOMIALS[case.resolved_integrator]
            sign, exponent = polynomial.log_power(symbol * tau / case.steps, case.steps)
            amplitude = sign * np.exp(exponent)
        else:
            amplitude = np.exp(tau * symbol)
    return _ratio(np.abs(amplitude - exact).sum(), exact.sum())


def waves(u: np.ndarray) -> np.ndarray:
    """Return wavenumbers theta = k h <= pi, to each of which an equal share of sum |u^| belongs; none for u = 0."""
    size = np.abs(np.fft.rfftn(u))
    size[..., 1 : (u.shape[-1] + 1) // 2] *= 2.0  # and its conjugate
    axes = [np.fft.fftfreq(n) for n in u.shape[:-1]] + [np.fft.rfftfreq(u.shape[-1])]
    square = sum(np.square(axis) for axis in np.meshgrid(*axes, indexing="ij", sparse=True))
    theta = np.minimum(2.0 * np.pi * np.sqrt(square), np.pi).reshape(-1)
    order = np.argsort(theta, kind="stable")
    share = np.cumsum(size.reshape(-1)[order])
    if not share[-1] > 0.0:
        return np.zeros(0)
    middles = share[-1] * (np.arange(_WAVES) + 0.5) / _WAVES
    return np.asarray(theta[order[np.searchsorted(share, middles)]])


def _of_the_field(case: Case, theta: np.ndarray) -> np.ndarray:
    """eta^(s theta): what the field (7) has of a wave that the strengths hold."""
    k = case.resolved_overlap * theta
    return np.asarray(kernel_transform("eta", k, case.alpha, order=case.order))


def _beyond(case: Case, radius: float, span: float | None = None) -> float:
    """int_{|x| > radius} of the fundamental solution for a time, that of the run if left out."""
    time = case.diffusivity * (case.span if span is None else span)
    return 1.0 - float(central_mass(radius, time, case.alpha, case.dim))


def _inside(case: Case, u: np.ndarray) -> float:
    """int |u| over the lattice, whose half-width is the unit of length."""
    return float((case.volumes / case.reach**case.dim * np.abs(u)).sum())


def _unit(u: np.ndarray) -> np.ndarray:
    """u over its greatest |u|, where that is not zero."""
    size = np.abs(u).max()
    return u / size if size > 0.0 else u


def _ratio(part: float, whole: float) -> float:
    return float(part) / float(whole) if whole > 0.0 else 0.0
