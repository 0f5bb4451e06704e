"""Warnings if an estimate of `reliability` is not small, each with its numbers and a remedy."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fracparticles.errors import AccuracyWarning
from fracparticles.run.reliability import LIMITS, ULPS, Estimates, growth, wavenumber

if TYPE_CHECKING:
    from fracparticles.run.case import Case

__all__ = ["warn_if_doubtful"]


def warn_if_doubtful(case: Case, u0: np.ndarray, u: np.ndarray, found: Estimates) -> None:
    """Warn if an estimate is not small, with its numbers and a remedy.

    Warns
    -----
    AccuracyWarning
        One for each estimate that is too large.
    """
    value = {name: number for name, (number, _) in found.items()}
    for complaint in _complaints(case, u0, u, value):
        warnings.warn(complaint, AccuracyWarning, stacklevel=4)


def _complaints(
    case: Case, u0: np.ndarray, u: np.ndarray, value: dict[str, float]
) -> Iterator[str]:
    """The messages for the estimates that are too large."""
    h = case.particle_spacing
    large = {name for name, limit in LIMITS.items() if value.get(name, 0.0) > limit}
    if not np.any(u0):
        yield (
            f"the initial strengths are zero at all particles, |x| <= {case.reach:.6g}. "
            "Move the data onto the lattice, or widen it."
        )
    if "resolution" in large:
        theta = wavenumber(u0)
        smoothing = value["resolution"] / theta * h
        yield (
            f"the initial data vary over the length {h / theta:.3g}, which particles of spacing h = {h:.3g} and "
            f"smoothing length {smoothing:.3g} do not resolve. Take spacing <= "
            f"{0.25 * h / value['resolution']:.2g} and see whether the result changes, or wider data."
        )
    if "between_particles" in large:
        yield (
            f"the initial data between the particles, of spacing h = {h:.3g}, differ by "
            f"{value['between_particles']:.2g} from what those at the particles say. Take a smaller spacing, or wider "
            "data."
        )
    if "wave_error" in large:
        yield (
            f"the waves that the initial data hold come out wrong by up to {value['wave_error']:.2g} of the peak that "
            f"they make. Take a smaller spacing, an overlap of about 2 (now {case.resolved_overlap:.3g}), a smaller "
            "time step, or another scheme."
        )
    if "table_error" in large:
        yield (
            f"the kernels interpolated in a table of step {case.kernel_table:.3g} leave a relative error of up to "
            f"{value['table_error']:.2g} over this run. Take a smaller kernel_table, or leave it out."
        )
    if "growth" in large:
        place = np.unravel_index(int(np.abs(u).argmax()), u.shape)
        where = ", ".join(f"{case.x[k]:.4g}" for k in place)
        which = "greatest |u|" if growth(u0, u) >= value["growth"] else "integral of |u|"
        yield (
            f"the {which} has grown by the factor {value['growth']:.4g}, which the equation does not allow; |u| is "
            f"greatest at x = {where} of |x| <= {case.reach:.4g}. At an end of the lattice it is a layer of the "
            "truncated scheme, or data that the open exterior continues wrongly: take a wider lattice. Elsewhere the "
            "scheme is unstable: take a larger overlap or a smaller step."
        )
    if "outside_share" in large:
        could_open = (
            case.exterior != "open" and "open" in case.kind.exteriors and not case.is_graded
        )
        remedy = "take a wider lattice" + (" or exterior='open'" if could_open else "")
        yield (
            f"the solution does not fit on |x| <= {case.reach:.4g}: about {value['outside_share']:.2g} of it lies "
            f"beyond, or has left. To solve on the whole space, {remedy}."
        )
    if "kept" in large:
        remedy = "the graded form 'interpolated'" if case.is_graded else "exterior='open'"
        yield (
            f"each particle keeps what it would have given to places beyond |x| = {case.reach:.4g}: of the first peak "
            f"that is {value['kept']:.2g} of the last one. Take a wider lattice, or {remedy}."
        )
    if "far_field_error" in large:
        yield (
            f"the far field leaves a relative error of about {value['far_field_error']:.1g}: the powers that continue "
            f"u beyond |x| = {case.reach:.4g} miss the strengths inside by {value['tail_misfit']:.1g}. "
            "Take a wider lattice."
        )
    if "decay" in large:
        yield (
            f"{case.scheme} of order {case.order} at overlap = {case.resolved_overlap:.4g} makes every constant decay, "
            f"by exp(-{value['decay']:.3g}) over this run. Take a larger overlap."
        )
    if "round_off" in large:
        yield (
            f"the round-off of the operator may add up to {value['round_off']:.1g} over this run: T |lambda| = "
            f"{value['round_off'] / ULPS * 2.0**52:.2g}. Take a larger spacing or a shorter time."
        )
