"""The checks of a `Case` beyond the range of each field: first which fields go together, then the numbers."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import NamedTuple

from fracparticles.arguments import MOST_STEPS, SIZES
from fracparticles.errors import InvalidInput, one_of, spelled
from fracparticles.graded.particles import MOST
from fracparticles.run.derived import Derived
from fracparticles.run.parameters import OVERLAPS
from fracparticles.schemes import ALL_SCHEMES
from fracparticles.schemes.stability import stability_limit
from fracparticles.special.stable import central_mass

__all__ = ["check"]

# Bytes per particle at the peak, measured, by dimension: about 20 arrays of float64. The open exterior of a square or a
# cube takes more, for every point at which sums are wanted; some of these lie beyond the lattice.
_BYTES_PER_PARTICLE = {1: 200, 2: 220, 3: 260}
_OPEN_BYTES = {1: 300, 2: 800, 3: 800}
_BYTES_PER_PAIR = 60  # of graded particles, whose step is a matrix
_FEWEST = 8  # spacings from the middle of the lattice to its ends
# For more than one term of the exterior: the least half-width, in smoothing lengths, and the greatest T D / h^alpha.
_FAR_OVERLAPS, _FAR_STIFFEST = 10, 1e6
_STIFFEST = 1e12  # T D / h^alpha: a Chebyshev series takes the root of about 40 times as much
_NAIVE_OVERLAP = 20.0  # for naive sums with an open exterior: the work grows like its cube
_ROUNDED = 1e-9  # relative excess allowed of an overlap, which may be a rounded quotient
_OPEN = tuple(name for name, scheme in ALL_SCHEMES.items() if "open" in scheme.exteriors)
_MOVING = tuple(name for name, scheme in ALL_SCHEMES.items() if scheme.moving)
_ONE_SUM = tuple(name for name in _OPEN if name not in _MOVING)
_SELF_TIMED = tuple(name for name, scheme in ALL_SCHEMES.items() if scheme.self_timed)


def check(case: Derived) -> None:
    """Check a case whose fields are valid each by itself.

    Raises
    ------
    InvalidInput
        Names the field, the value, what is allowed and what to do.
    """
    _check_time(case)
    case.kind.check(case.dim, case.order, case.kernel_family, "kernel_family")
    for field, takes, whom, remedy in _rules(case):
        value = case.resolved_integrator if field == "integrator" else getattr(case, field)
        if value not in takes:
            raise one_of(field, value, takes, whom, remedy)
    _check_width(case)
    _check_size(case)
    _check_step(case)
    _check_far_field(case)
    _check_work(case)


class Rule(NamedTuple):
    """The values that a field takes (None for nothing), the sort of case for which this holds, and the remedy."""

    field: str
    takes: tuple[object, ...]
    whom: str
    remedy: str = "Leave it out."


def _rules(case: Derived) -> Iterator[Rule]:
    """The rules about fields that go together which hold for this case."""
    scheme, kind, nothing = case.scheme, case.kind, (None,)
    closure = f"The far-field closure exists for {spelled(_OPEN, ' and ')}."
    yield Rule("exterior", kind.exteriors, scheme, closure)
    if case.exterior != "open" or (case.dim != 1 and case.evaluation != "convolution"):
        whom = "any other than exterior='open', with dim=1 or evaluation='convolution'"
        yield Rule("far_terms", nothing, whom)
    if not kind.has_kernel:
        yield Rule("overlap", nothing, f"{scheme}, which has no kernel")
    if not kind.tabulated:
        yield Rule("kernel_table", nothing, scheme)
    if case.is_graded:
        yield from _graded_rules()
    else:
        lattice = "particles on a lattice"
        yield Rule("graded_form", nothing, lattice, "Leave it out, or give graded_scale.")
    if kind.moving:
        yield Rule("far_terms", nothing, f"{scheme}, whose far field has one term")
        yield Rule("integrator", (None, "rk2"), scheme)
        stepping = f"{scheme}, whose velocity is not linear"
        yield Rule("evaluation", (None, "stepping", "convolution"), stepping)
    else:
        resting = f"{scheme}, whose particles stay where they are"
        for name in ("remeshing", "remesh_above", "threshold"):
            yield Rule(name, nothing, resting, f"Leave it out, or take scheme={_MOVING[0]!r}.")
    if case.remeshing == "none":
        for name in ("remesh_above", "threshold"):
            yield Rule(name, nothing, "remeshing='none'")
    if case.resolved_integrator == "exponential":
        exponential = "integrator='exponential', which takes no steps"
        yield Rule("dt", nothing, exponential)
        yield Rule("evaluation", (None, "series", "convolution"), exponential)
    if case.evaluation == "convolution":
        yield from _convolution_rules(kind.self_timed)
    if kind.self_timed:
        own = f"{scheme}, whose step is part of the scheme"
        yield Rule("integrator", (None, "euler"), own)


def _graded_rules() -> Iterator[Rule]:
    """Particles of unequal volumes take one step as a matrix, and need no model of the exterior."""
    whom = "graded particles, which take one step over the whole time"
    yield Rule("scheme", _SELF_TIMED, whom, "Take it, or leave graded_scale out.")
    yield Rule("dim", (1,), whom)
    yield Rule("exterior", ("truncated",), whom, "Leave it out, and take a wider half-width.")
    yield Rule("summation", ("fft",), whom)
    for name in ("dt", "overlap", "kernel_table", "evaluation"):
        yield Rule(name, (None,), whom)


def _convolution_rules(self_timed: bool) -> Iterator[Rule]:
    """A run by convolution is one on the infinite lattice, with exact kernels and exponential in time except GPSE."""
    whom = "evaluation='convolution'"
    yield Rule("scheme", _ONE_SUM, whom, "Take one of these.")
    if self_timed:
        yield Rule("integrator", ("euler",), whom, "Leave integrator out.")
    else:
        yield Rule("integrator", ("exponential",), whom, "Take it.")
    yield Rule("exterior", ("open",), whom, "Take exterior='open', or evaluation='series'.")
    yield Rule("summation", ("fft",), whom)
    yield Rule("kernel_table", (None,), whom)


# --- numbers ----------------------------------------------------------------------------------------------


def _check_time(case: Derived) -> None:
    if not 1.0 < case.alpha < 2.0:
        differs = "a number that makes 1 + beta differ from 1 and 2"
        raise InvalidInput("beta", case.beta, differs, "Move it inward.")
    if case.t_final <= case.t_initial:
        later = f"a number > t_initial = {case.t_initial:g}"
        raise InvalidInput("t_final", case.t_final, later, "Give a later final time.")
    if case.times is not None and case.times[0] <= case.t_initial:
        later = f"numbers > t_initial = {case.t_initial:g}"
        raise InvalidInput(
            "times", case.times, later, "Leave out times up to it: u is given there."
        )


def _check_width(case: Derived) -> None:
    if (case.truncation is None) == (case.half_width is None):
        remedy = "Give the factor C of Eq. (46) or the half-width itself."
        exactly = "exactly one of truncation and half_width"
        raise InvalidInput("truncation", case.truncation, exactly, remedy)
    if case.is_graded and not SIZES[0] <= case.reach <= SIZES[1]:
        within = f"a factor that makes a half-width from {SIZES[0]:g} to {SIZES[1]:g}"
        raise InvalidInput("truncation", case.truncation, within, "Take another unit of length.")
    if case.spacing > case.extent / _FEWEST:
        what = "L arcsinh(D / L) of graded particles" if case.is_graded else "the half-width"
        most = f"at most an eighth of {what}, {case.extent / _FEWEST:.6g}"
        remedy = "Take a smaller spacing or a wider domain."
        raise InvalidInput("spacing", case.spacing, most, remedy)


def _check_size(case: Derived) -> None:
    """The arrays of a lattice must fit into half of the memory, and so must the matrix of graded particles."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    is_open = case.exterior == "open"
    bytes_each = (_OPEN_BYTES if is_open else _BYTES_PER_PARTICLE)[case.dim]
    beyond, power, most = 0, case.dim, float("inf")
    if is_open:
        kernels = case.order, case.overlap or 2.0, case.dim, case.kernel_family
        beyond = 2 * case.kind.padding(*kernels)
    if case.is_graded:
        bytes_each, power, most = _BYTES_PER_PAIR, 2, MOST
    side = min(2.0 * case.extent / case.spacing, 1e90)  # its cube is a number, too
    needed = bytes_each * (side + beyond) ** power
    if needed > 0.5 * memory or side > most:
        longest = max((0.5 * memory / bytes_each) ** (1.0 / power) - beyond, 1.0)
        raise InvalidInput(
            "spacing",
            case.spacing,
            f"at least {2.0 * case.extent / min(longest, most):.3g} on this domain and this machine: "
            f"{side**case.dim:.3g} particles would take {needed / 2**30:.3g} GiB, "
            f"half of the memory is {memory / 2**31:.3g} GiB",
            "Take a larger spacing or a narrower domain.",
        )


def _check_step(case: Derived) -> None:
    if case.kind.self_timed and not case.is_graded:
        _check_own_step(case)
    elif case.kind.moving and case.dt is None:
        raise InvalidInput("dt", None, f"a number > 0 for {case.scheme}", "Give the time step.")
    elif case.dt is None and not case.is_graded and case.resolved_integrator != "exponential":
        limit = stability_limit(
            case.scheme, case.beta, case.order, case.resolved_overlap, case.dim, case.kernel_family
        )
        largest = limit * case.particle_spacing**case.alpha / case.diffusivity
        whom = f"integrator={case.resolved_integrator!r}"
        stable = f"a number > 0 for {whom}, stable up to {largest:.4g}"
        remedy = "Give dt, or integrator='exponential', which needs none."
        raise InvalidInput("dt", None, stable, remedy)


def _check_own_step(case: Derived) -> None:
    """The step of GPSE is its smoothing length, within what a lattice can sum."""
    if case.dt is not None and case.overlap is not None:
        one = f"one of dt and overlap for {case.scheme}, since epsilon = (D dt)^(1/alpha), Eq. (40)"
        raise InvalidInput("overlap", case.overlap, one, "Leave one of them out.")
    low, high = OVERLAPS[0] * (1.0 - _ROUNDED), OVERLAPS[1] * (1.0 + _ROUNDED)
    if not low <= case.resolved_overlap <= high:
        least, most = (
            (s * case.particle_spacing) ** case.alpha / case.diffusivity for s in OVERLAPS
        )
        given = "overlap" if case.dt is None else "dt"
        raise InvalidInput(
            given,
            getattr(case, given),
            f"for {case.scheme} a step from {least:.4g} to {most:.4g}, so that epsilon / h is from {OVERLAPS[0]:g} to "
            f"{OVERLAPS[1]:g}; that of this run is {case.time_step:.4g}",
            "Change it, the spacing, or the time of the run.",
        )


def _check_far_field(case: Derived) -> None:
    """The lattice must end in the tail of the solution. More than one term in many applications asks for more.

    This was found by computation (tests/lattice/test_exterior.py). From n = 10 epsilon / h on, no eigenvalue leaves the
    range of the symbol by more than 2e-6 of it, nor lies above zero by more than 4e-7. On narrower lattices the fit to
    strengths at n / 2 makes modes that grow.
    """
    if case.exterior == "open":
        _check_spread(case)
    if case.far_terms in (None, 1) or case.evaluation == "convolution" or case.is_one_step:
        return
    if case.n < _FAR_OVERLAPS * case.resolved_overlap:
        least = _FAR_OVERLAPS * case.resolved_overlap * case.particle_spacing
        short = f"a lattice of half-width {case.reach:.4g}, less than {_FAR_OVERLAPS} smoothing lengths, {least:.4g}"
        remedy = "Leave it out, or take a wider lattice or a smaller spacing."
        raise InvalidInput("far_terms", case.far_terms, f"nothing or 1 on {short}", remedy)
    stiffness = case.span * case.setting.rate
    if stiffness > _FAR_STIFFEST:
        stiff = f"nothing or 1 where T D / h^alpha = {stiffness:.3g}, more than {_FAR_STIFFEST:g}"
        remedy = "Leave it out, or take a shorter run or a larger spacing."
        raise InvalidInput("far_terms", case.far_terms, stiff, remedy)


def _check_spread(case: Derived) -> None:
    """A point mass must not spread beyond the lattice: no power of |x| continues a solution that is flat there."""
    time = case.diffusivity * case.span
    inside = float(central_mass(case.reach, time, case.alpha, case.dim))
    if inside < 0.5:
        given = "half_width" if case.truncation is None else "truncation"
        raise InvalidInput(
            given,
            getattr(case, given),
            "a lattice that is wider than the solution for exterior='open', and of a point mass only the share "
            f"{inside:.2g} stays on |x| <= {case.reach:.4g} for the time of this run; half is asked for, 0.95 is good",
            f"The solution spreads over about (D T)^(1/alpha) = {time ** (1.0 / case.alpha):.4g}: take a half-width of "
            "several times that, or a shorter run.",
        )


def _check_work(case: Derived) -> None:
    one_by_one = case.kind.moving and case.exterior == "open" and case.summation == "naive"
    if one_by_one and case.resolved_overlap > _NAIVE_OVERLAP:  # a step takes a second there
        most = f"at most {_NAIVE_OVERLAP:g} for naive sums with an open exterior"
        raise InvalidInput("overlap", case.overlap, most, "Leave summation out.")
    if not case.steps_taken and case.span * case.setting.rate > _STIFFEST:
        latest = case.t_initial + _STIFFEST / case.setting.rate
        most = f"at most {latest:.6g} with this spacing and diffusivity"
        raise InvalidInput("t_final", case.t_final, most, "Take a shorter run or a larger spacing.")
    if case.resolved_integrator != "exponential" and case.span / case.resolved_dt > MOST_STEPS:
        least = f"at least {case.span / MOST_STEPS:.3g}: 2^53 steps"
        raise InvalidInput("dt", case.dt, least, "Take a larger step.")
