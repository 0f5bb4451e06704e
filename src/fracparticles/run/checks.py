"""What a `Case` must fulfil beyond the range of each field: one function a subject, each with a clear complaint."""

from __future__ import annotations

import os

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import family_of
from fracparticles.lattice.banded import BandedConvolution
from fracparticles.run.parameters import OVERLAPS, Parameters
from fracparticles.schemes import METHODS
from fracparticles.schemes.stability import stability_limit
from fracparticles.special.stable import central_mass

__all__ = ["check"]

# Measured, by dimension: about 20 arrays of float64 at the peak. The open exterior of a square or a cube takes its
# own for every point where the sums are wanted, which for FPSE go beyond the lattice.
_BYTES_PER_PARTICLE = {1: 200, 2: 220, 3: 260}
_OPEN_BYTES = {1: 300, 2: 800, 3: 800}
_MOST_STEPS = 2**53  # more are not told apart in float64
_FAR_OVERLAPS = 10  # half the lattice in smoothing lengths, at least, and
_FAR_STIFFEST = 1e6  # T D / h^alpha, at most, for more than one term of the exterior
_STIFFEST = 1e12  # T D / h^alpha; a Chebyshev series takes about the square root of 40 times this
_ROUNDED = 1e-9  # of an overlap that is a quotient


def check(case: Parameters) -> None:
    """Check a case whose fields are valid each by itself.

    Raises
    ------
    InvalidInput
        With the field, the value, what is allowed and what to do.
    """
    _check_time(case)
    _check_scheme(case)
    _check_domain(case)
    _check_particles(case)
    _check_integrator(case)
    _check_far_field(case)
    _check_work(case)


def _check_time(case: Parameters) -> None:
    if not 1.0 < case.alpha < 2.0:
        raise InvalidInput(
            "beta", case.beta, "a number that makes 1 + beta differ from 1 and 2", "Move it inward."
        )
    if case.t_final <= case.t_initial:
        raise InvalidInput(
            "t_final",
            case.t_final,
            f"a number > t_initial = {case.t_initial:g}",
            "Give a later final time.",
        )


def _check_domain(case: Parameters) -> None:
    if (case.truncation is None) == (case.half_width is None):
        raise InvalidInput(
            "truncation",
            case.truncation,
            "exactly one of truncation and half_width",
            "Give the factor C of Eq. (46) or the half-width itself.",
        )
    if case.spacing > case.domain / 8.0:
        raise InvalidInput(
            "spacing",
            case.spacing,
            f"at most an eighth of the half-width, {case.domain / 8.0:.6g}",
            "Take a smaller spacing or a wider domain.",
        )
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    is_open = case.exterior == "open"
    bytes_each = (_OPEN_BYTES if is_open else _BYTES_PER_PARTICLE)[case.dim]
    beyond = 0
    if is_open and case.scheme == "FPSE":
        beyond = 2 * BandedConvolution.reach(case.epsilon_over_h, case.order, case.kernel_family)
    side = 2.0 * case.domain / case.spacing
    particles = side**case.dim
    needed = bytes_each * (side + beyond) ** case.dim
    if needed > 0.5 * memory:
        longest = max((0.5 * memory / bytes_each) ** (1.0 / case.dim) - beyond, 1.0)
        raise InvalidInput(
            "spacing",
            case.spacing,
            f"at least {2.0 * case.domain / longest:.3g} on this domain and this machine: "
            f"{particles:.3g} particles would take {needed / 2**30:.3g} GiB, "
            f"half of the memory is {memory / 2**31:.3g} GiB",
            "Take a larger spacing or a narrower domain.",
        )


def _check_work(case: Parameters) -> None:
    span = case.t_final - case.t_initial
    if not case.steps_taken and span * case.setting.rate > _STIFFEST:
        raise InvalidInput(
            "t_final",
            case.t_final,
            f"at most {case.t_initial + _STIFFEST / case.setting.rate:.6g} with this spacing and diffusivity",
            "Take a shorter run or a larger spacing.",
        )
    if case.method != "exponential" and span / case.asked_step > _MOST_STEPS:
        raise InvalidInput(
            "dt", case.dt, f"at least {span / _MOST_STEPS:.3g}: 2^53 steps", "Take a larger step."
        )


def _check_far_field(case: Parameters) -> None:
    """The lattice must end in the tail of the solution; more than one term, used again and again, ask for more.

    Found by computation (tests/test_exterior.py): from n = 10 epsilon / h on, no eigenvalue leaves the range of the
    symbol by more than 2e-6 of it, nor lies above zero by more than 4e-7, but nearer the ends the fit to strengths at
    n / 2 makes modes that grow.
    """
    if case.exterior == "open":
        _check_width(case)
    if case.far_terms in (None, 1) or case.evaluation == "convolution":
        return
    if case.method == "euler" and case.steps == 1:
        return
    if case.n < _FAR_OVERLAPS * case.epsilon_over_h:
        least = _FAR_OVERLAPS * case.epsilon_over_h * case.particle_spacing
        raise InvalidInput(
            "far_terms",
            case.far_terms,
            f"nothing or 1 on a lattice of half-width {case.domain:.4g}, less than {_FAR_OVERLAPS} smoothing lengths, "
            f"{least:.4g}",
            "Leave it out, or take a wider lattice or a smaller spacing.",
        )
    stiffness = (case.t_final - case.t_initial) * case.setting.rate
    if stiffness > _FAR_STIFFEST:
        raise InvalidInput(
            "far_terms",
            case.far_terms,
            f"nothing or 1 where T D / h^alpha = {stiffness:.3g}, more than {_FAR_STIFFEST:g}",
            "Leave it out, or take a shorter run or a larger spacing.",
        )


def _check_width(case: Parameters) -> None:
    """A point mass must not spread beyond the lattice: no power of |x| continues a solution that is flat there."""
    time = case.diffusivity * (case.t_final - case.t_initial)
    inside = float(central_mass(case.domain, time, case.alpha, case.dim))
    if inside < 0.5:
        given = "half_width" if case.truncation is None else "truncation"
        raise InvalidInput(
            given,
            getattr(case, given),
            "a lattice that is wider than the solution for exterior='open', and of a point mass only the share "
            f"{inside:.2g} stays on |x| <= {case.domain:.4g} for the time of this run; half is asked for, 0.95 is good",
            f"The solution spreads over about (D T)^(1/alpha) = {time ** (1.0 / case.alpha):.4g}: take a half-width of "
            "several times that, or a shorter run.",
        )


def _check_scheme(case: Parameters) -> None:
    scheme = METHODS[case.scheme]
    if case.dim not in scheme.DIMS:
        raise InvalidInput(
            "dim",
            case.dim,
            f"{' or '.join(map(str, scheme.DIMS))} for {case.scheme}",
            "DD, FPSE, KPSE and GPSE exist for 1, 2 and 3 dimensions.",
        )
    orders = scheme.ORDERS if case.dim == 1 else scheme.BOX_ORDERS
    if case.order not in orders:
        where = "" if case.dim == 1 else f" in {case.dim} dimensions"
        raise InvalidInput(
            "order",
            case.order,
            f"{' or '.join(map(str, orders))} for {case.scheme}{where}",
            "Choose one of these.",
        )
    if case.kernel_family is not None:
        if not scheme.FAMILIES:
            raise InvalidInput(
                "kernel_family", case.kernel_family, f"nothing for {case.scheme}", "Leave it out."
            )
        family_of(case.order, case.kernel_family, field="kernel_family")
    if case.exterior not in scheme.EXTERIORS:
        raise InvalidInput(
            "exterior",
            case.exterior,
            f"{' or '.join(scheme.EXTERIORS)} for {case.scheme}",
            "The far-field closure exists for DD, FPSE, KPSE and GPSE.",
        )
    if case.far_terms is not None and (case.exterior != "open" or case.dim != 1):
        raise InvalidInput(
            "far_terms",
            case.far_terms,
            "nothing, but for exterior='open' and dim=1",
            "Leave it out.",
        )
    if case.scheme == "FD":
        for name in ("overlap", "kernel_table"):
            if getattr(case, name) is not None:
                raise InvalidInput(
                    name,
                    getattr(case, name),
                    "nothing for FD, which has no kernel",
                    "Leave it out.",
                )
    if case.kernel_table is not None and case.scheme not in ("DD", "FPSE", "KPSE", "GPSE"):
        raise InvalidInput(
            "kernel_table", case.kernel_table, f"nothing for {case.scheme}", "Leave it out."
        )


def _check_particles(case: Parameters) -> None:
    """What only DVM takes, whose particles move, and what it does not."""
    if case.scheme != "DVM":
        for name in ("remeshing", "remesh_above", "threshold"):
            if getattr(case, name) is not None:
                raise InvalidInput(
                    name,
                    getattr(case, name),
                    f"nothing for {case.scheme}, whose particles stay where they are",
                    "Leave it out, or take scheme='DVM'.",
                )
        return
    if case.method != "rk2":
        raise InvalidInput("integrator", case.method, "nothing or 'rk2' for DVM", "Leave it out.")
    if case.evaluation == "series":
        raise InvalidInput(
            "evaluation",
            case.evaluation,
            "nothing or 'stepping' for DVM, whose velocity is not linear",
            "Leave it out.",
        )
    if case.remeshing == "none":
        for name in ("remesh_above", "threshold"):
            if getattr(case, name) is not None:
                raise InvalidInput(
                    name, getattr(case, name), "nothing for remeshing='none'", "Leave it out."
                )


def _check_integrator(case: Parameters) -> None:
    if case.method == "exponential":
        if case.dt is not None:
            raise InvalidInput(
                "dt", case.dt, "nothing for integrator='exponential'", "Leave dt out."
            )
        if case.evaluation == "stepping":
            raise InvalidInput(
                "evaluation",
                case.evaluation,
                "'series' or 'convolution' for integrator='exponential', which takes no steps",
                "Leave it out.",
            )
    if case.evaluation == "convolution":
        _check_convolution(case)
    if case.scheme == "GPSE":
        if case.method != "euler":
            raise InvalidInput(
                "integrator",
                case.method,
                "nothing or 'euler' for GPSE, whose step is part of the scheme",
                "Leave it out.",
            )
        if case.dt is not None and case.overlap is not None:
            raise InvalidInput(
                "overlap",
                case.overlap,
                "one of dt and overlap for GPSE, since epsilon = (D dt)^(1/alpha), Eq. (40)",
                "Leave one of them out.",
            )
        low, high = OVERLAPS[0] * (1.0 - _ROUNDED), OVERLAPS[1] * (1.0 + _ROUNDED)
        if not low <= case.epsilon_over_h <= high:
            least, most = (
                (s * case.particle_spacing) ** case.alpha / case.diffusivity for s in OVERLAPS
            )
            given = "overlap" if case.dt is None else "dt"
            raise InvalidInput(
                given,
                getattr(case, given),
                f"for GPSE a step from {least:.4g} to {most:.4g}, so that epsilon / h is from {OVERLAPS[0]:g} to "
                f"{OVERLAPS[1]:g}; this run takes {case.steps} steps of {case.time_step:.4g}",
                "Change it, the spacing, or the time of the run.",
            )
    elif case.scheme == "DVM" and case.dt is None:
        raise InvalidInput("dt", None, "a number > 0 for DVM", "Give the time step.")
    elif case.dt is None and case.method != "exponential":
        limit = stability_limit(
            case.scheme, case.beta, case.order, case.epsilon_over_h, case.dim, case.kernel_family
        )
        largest = limit * case.particle_spacing**case.alpha / case.diffusivity
        raise InvalidInput(
            "dt",
            None,
            f"a number > 0 for integrator={case.method!r}, stable up to {largest:.4g}",
            "Give dt, or integrator='exponential', which needs none.",
        )


def _check_convolution(case: Parameters) -> None:
    """One lattice sum is that of the infinite lattice, of exact kernels; GPSE's steps are exponentials themselves."""
    methods = ("euler",) if case.scheme == "GPSE" else ("exponential",)
    needed = {
        "scheme": (case.scheme, ("DD", "FPSE", "KPSE", "GPSE"), "Take one of these."),
        "integrator": (
            case.method,
            methods,
            "Leave integrator out." if case.scheme == "GPSE" else "Take it.",
        ),
        "exterior": (case.exterior, ("open",), "Take exterior='open', or evaluation='series'."),
        "dim": (case.dim, (1,), "Take evaluation='series', or GPSE in one step."),
        "summation": (case.summation, ("fft",), "Leave it out."),
        "kernel_table": (case.kernel_table, (None,), "Leave it out."),
    }
    for name, (value, allowed, remedy) in needed.items():
        if value not in allowed:
            choice = " or ".join("nothing" if one is None else str(one) for one in allowed)
            raise InvalidInput(name, value, f"{choice} for evaluation='convolution'", remedy)
