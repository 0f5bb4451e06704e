"""Estimates of accuracy from a solution: has it reached the ends of the lattice, and does the lattice resolve it?

They are those of `run.reliability` and some more, at each output time:

outside_share
    The share of int |u| beyond the lattice, if u goes on as c |x|^(-n-alpha) from the outermost particles.
far_field_error
    In an open exterior the powers that continue u miss it at particles that they need not meet. The estimate is this
    relative miss, times `outside_share`, times the share that travels from outside well into the lattice in the run.
resolution
    s theta, the overlap (but at least 1.1) times the wavenumber of u in units of 1 / h.
wave_error
    The error of a peak over the peak, sum |u^| |1 - exp(-T delta)| / sum |u^|. T is the time since t_initial. delta is
    the error of the symbols, with the means of D and of |a| weighted by |u|.
between_particles
    The part of initial data given as a function that is hidden between the particles.
coefficient_misfit
    sum |c - I| / sum (|c| + |I|) between the particles for the worst coefficient: the part that the particles do not
    see. I is the cubic through the four nearest particles, c the coefficient less its least value. For a source, c is
    the source itself, and the last sum is at least that of 2 |u| / (t_final - t_initial). For a diffusivity in a flux,
    1 / D counts as well: a barrier that no particle meets holds the flux back.
space_error
    The relative error that the particles leave, from the initial data, see `frozen`, and from runs on half and a
    quarter of the particles, see `fewer_particles`.
time_error
    The relative error that the steps in time leave, from runs with a tenth of the tolerance, see `tighter_steps`.
atol_share
    The errors of early steps over the greatest |u|, see `time.fading`; or the absolute tolerance, if one was asked for.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.fewer_particles import SPACE_ERROR
from fracparticles.problems.problem import Problem
from fracparticles.problems.rates import reaction_of
from fracparticles.problems.tighter_steps import TIME_ERROR
from fracparticles.problems.transport import Transport
from fracparticles.run.reliability import (
    LIMITS,
    PARTS,
    between_four,
    between_particles,
    outside_share,
    tail_misfit,
    wavenumber,
    waves,
)
from fracparticles.schemes import SCHEMES
from fracparticles.special.stable import central_mass
from fracparticles.time.fading import FADED, early_errors

__all__ = ["estimates", "warn_if_doubtful"]

Estimates = dict[str, tuple[list[float], str]]

_LEAST_SMOOTHING = 1.1  # the least overlap in `resolution`, as in `run.reliability`
# The value of each estimate above which there is a warning.
_LIMITS = LIMITS | {
    "coefficient_misfit": 0.1, "atol_share": FADED, "space_error": SPACE_ERROR, "time_error": TIME_ERROR,
}  # fmt: skip
_MOST = 2.0  # the greatest error of a wave over the wave
_BARRIER = 1e-4  # share of the greatest D that is added to D, before 1 / D is taken
_CONSTANT = 1e-9  # relative variation of a coefficient that is round-off


def estimates(problem: Problem, solutions: list[np.ndarray], initial: Any = None) -> Estimates:
    """Return each estimate by name: its meaning, and for each output time the worse of its value and that at t_initial.

    Parameters
    ----------
    problem : Problem
    solutions : list of arrays, shape (N, .., N)
        u at t_initial and at each output time.
    initial : any, optional
        The initial data as they were given.
    """
    case = problem.case
    smoothing = max(_LEAST_SMOOTHING, case.resolved_overlap)
    outside = [outside_share(case, u) for u in solutions]
    found = {
        "outside_share": (_since_start(outside), "estimated share of |u| beyond the lattice"),
        "resolution": (
            _since_start([smoothing * wavenumber(u) for u in solutions]),
            "epsilon times the wavenumber of u",
        ),
    }
    found["wave_error"] = (
        [
            _wave_error(problem, t, u)
            for t, u in zip(problem.output_times, solutions[1:], strict=True)
        ],
        "estimated error of a peak, from the symbols of the scheme and the waves of u",
    )
    if callable(initial):
        hidden = between_particles(case, solutions[0], initial)
        found["between_particles"] = (
            [hidden] * len(problem.output_times), "misfit of initial data between the particles",
        )  # fmt: skip
    varying = [one for one in problem.coefficients if one.depends_on & {"x", "y"}]
    if varying:
        times = (problem.t_initial, *problem.output_times)
        misfits = [
            max(_coefficient_misfit(problem, one, t, u, part) for one in varying for part in PARTS)
            for t, u in zip(times, solutions, strict=True)
        ]
        meaning = "misfit of a coefficient between the particles"
        found["coefficient_misfit"] = (_since_start(misfits), meaning)
    if problem.atol or problem.reaction is not None:
        times, least = (problem.t_initial, *problem.output_times), problem.atol or 0.0
        shares = early_errors(
            problem.rtol, times, solutions, reaction_of(problem), lambda: 0.0,
            lambda t: least / problem.rtol,
        )  # fmt: skip
        meaning = "errors of early steps, within their tolerance, over the greatest |u|"
        found["atol_share"] = (shares, meaning)
    if problem.exterior == "open":
        travels = 1.0 - float(
            central_mass(0.5 * case.reach, case.diffusivity * problem.span, case.alpha, case.dim)
        )
        misfits = [
            tail_misfit(case, u) * share * travels if np.any(u) else 0.0
            for u, share in zip(solutions, outside, strict=True)
        ]
        meaning = "estimated relative error of the far field"
        found["far_field_error"] = (_since_start(misfits), meaning)
    return found


def _wave_error(problem: Problem, t: float, u: np.ndarray) -> float:
    case, theta, span = problem.case, waves(u), t - problem.t_initial
    weight = np.abs(u)
    if not theta.size or not np.isfinite(weight).all():
        return 0.0
    weight = weight / weight.max()
    at = dict(zip(("x", "y"), case.positions, strict=False)) | {"t": np.array(t)}

    def mean(one: Coefficient) -> float:
        return float((np.abs(one(at)) * weight).sum() / weight.sum())

    along = theta if case.dim == 1 else theta[:, None] * np.eye(case.dim)[0]
    setting = case.setting
    symbol = SCHEMES[case.scheme].symbol(along, setting) + theta**case.alpha
    delta = mean(problem.diffusion) * (span * setting.rate / setting.diffusivity) * symbol
    speed = (
        float(np.hypot.reduce([mean(one) for one in problem.transport]))
        if problem.transport
        else 0.0
    )
    phase = np.zeros(1)
    if speed:
        phase = speed * span / setting.spacing * (Transport(setting).symbol(theta) - theta)
    with np.errstate(over="ignore"):
        return float(np.minimum(np.abs(1.0 - np.exp(-delta - 1j * phase)), _MOST).mean())


def _coefficient_misfit(
    problem: Problem, one: Coefficient, t: float, u: np.ndarray, part: float
) -> float:
    """Return the misfit between the particles along all axes at once, as far from the ends as the cubic needs."""
    case, h = problem.case, problem.case.particle_spacing
    at = dict(zip(("x", "y"), case.positions, strict=False))
    apart = np.meshgrid(*(case.x[1:-2] + part * h,) * case.dim, indexing="ij", sparse=True)
    there = dict(zip(("x", "y"), apart, strict=False))
    v = _between(u, part)
    every = {**at, "t": np.array(t), "u": u}, {**there, "t": np.array(t), "u": v}
    try:
        values, found = (one({name: each[name] for name in one.variables}) for each in every)
    except InvalidInput:  # a function that is valid only at the particles
        return 0.0
    values = np.broadcast_to(values, u.shape)
    if one.field == "source":
        return _missed(values, found, part, 0.0, 2.0 * float(np.abs(v).sum()) / problem.span)
    missed = _missed(values, found, part)
    floor = _BARRIER * float(max(values.max(), found.max()))
    if one.field == "diffusivity" and problem.form == "FPSE" and floor > 0.0:
        missed = max(missed, _missed(1.0 / (values + floor), 1.0 / (found + floor), part))
    return missed


def _missed(
    values: np.ndarray, found: np.ndarray, part: float, least: float | None = None, size: float = 0
) -> float:
    """Return sum |c - I| / sum (|c| + |I|), both less `least` or their least; the last sum is at least `size`."""
    guess = _between(values, part)
    if least is None:
        least = min(guess.min(), found.min())
    size = max(size, float((np.abs(found - least) + np.abs(guess - least)).sum()))
    greatest = float(np.abs(found).max()) * found.size
    if not _CONSTANT * greatest < size < np.inf:
        return 0.0
    return float(np.abs(found - guess).sum()) / size


def _between(values: np.ndarray, part: float) -> np.ndarray:
    for axis in range(values.ndim):
        values = between_four(values, axis, part)
    return values


def _since_start(values: list[float]) -> list[float]:
    return [float(max(values[0], value)) for value in values[1:]]


def warn_if_doubtful(problem: Problem, found: Estimates) -> None:
    """Warn of each estimate that is too large, with the first output time at which it is.

    Warns
    -----
    AccuracyWarning
        If an estimate is above its limit.
    """
    reach = f"|x| <= {problem.half_width:.4g}"
    says = {
        "outside_share": f"the solution has reached the ends of {reach}: about {{:.2g}} of it lies beyond, or has "
        "left. Take a wider lattice, or an earlier end",
        "resolution": f"particles of spacing {problem.case.spacing:.3g} do not resolve the solution: epsilon times its "
        "wavenumber is {:.2g}. Take a smaller spacing",
        "wave_error": "the waves that the solution holds may be wrong by {:.2g} of a peak. Take a smaller spacing, "
        "or a higher order",
        "between_particles": "the initial data differ between the particles by {:.2g} from what those at the particles "
        "say. Take a smaller spacing, or wider data",
        "coefficient_misfit": "a coefficient differs between the particles by {:.2g} from what they see of it. Take a "
        "smaller spacing, or a smoother coefficient",
        "atol_share": "the solution has fallen: errors of early steps, within rtol of what it was, or atol, are {:.2g} "
        "of its greatest value. Take a smaller rtol, or atol",
        "space_error": "the particles leave an error of about {:.1g} of u, as the waves of the data and runs on "
        "half and a quarter of them say. Take a smaller spacing, or smoother data and coefficients",
        "time_error": "the steps in time leave an error of about {:.1g} of u, as runs with a tenth of the tolerance "
        "say. Take a smaller rtol, or an earlier end",
        "far_field_error": "the far field leaves a relative error of about {:.1g}: the powers that continue u beyond "
        f"{reach} miss it inside. Take a wider lattice",
    }
    times = problem.output_times
    for name, (values, _) in found.items():
        late = [(t, value) for t, value in zip(times, values, strict=True) if value > _LIMITS[name]]
        if late:
            t, value = late[0]
            text = f"by t = {t:.4g} {says[name].format(value)}."
            warnings.warn(text, AccuracyWarning, stacklevel=3)
