"""Probes of runs over long times, t_f = 10^3 to 10^12 t_0, and over short ones, t_f - t_0 = 10^-6 to 10^-12 t_0."""

from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from typing import Any

import numpy as np

import fracparticles as fp
from fracparticles.run.solver import compute
from fracparticles.schemes import ALL_SCHEMES
from fracstudy.orders import fitted_power
from fracstudy.panels import Panels
from fracstudy.probe import EPS, REFUSED, Kind, Probe, off
from scenes.extremes.long_and_short_times.profile import rate, solution, tail_constant

_WIDTH = 4.0  # half-width in units of t_f^(1/alpha): the second term of the tail is 4^-alpha of the first there
_SPACING = {1: 0.5, 2: 0.5, 3: 0.6}  # in units of t_0^(1/alpha)
_UNITS = (1.0, 1e-12, 1e12)  # t_0
# The greatest lattice of a probe.
_MOST = {1: 30_000, 2: 300, 3: 60}


def run_of(**fields: Any) -> Any:
    """Run a case."""
    return compute(fp.Case(store="metrics", **fields))


# --- long times -------------------------------------------------------------------------------------------------------


def _lattice(beta: float, ratio: float, n: int, start: float) -> dict[str, Any] | None:
    """The lattice that resolves the initial data and holds the final ones; none if it is too large."""
    length = start ** (1.0 / (1.0 + beta))
    spacing, half = _SPACING[n] * length, _WIDTH * ratio ** (1.0 / (1.0 + beta)) * length
    if half / spacing > _MOST[n]:
        return None
    fields = {"beta": beta, "dim": n, "spacing": spacing, "half_width": half}
    return {**fields, "t_initial": start, "t_final": start * ratio}


def _methods(n: int) -> dict[str, dict[str, Any]]:
    """Runs with an open exterior: order 12 leaves the lattice and the far field."""
    series = {"integrator": "exponential", "exterior": "open", "order": 12}
    whole = {**series, "evaluation": "convolution"}
    of_series = ("DD", "FPSE", "KPSE") if n == 1 else ()
    methods = {f"{s}, order 12, convolution": {"scheme": s, **whole} for s in ("DD", "KPSE")}
    return methods | {f"{s}, order 12, series": {"scheme": s, **series} for s in of_series}


def _miss(u: np.ndarray, x: np.ndarray, t: float, alpha: float, n: int) -> float:
    """The error relative to the peak, where |x| is below half the half-width: beyond is the far field."""
    inner = x <= 0.5 * np.abs(x).max()
    return off(u[inner], solution(x[inner], t, alpha, n))


def _solved(fields: dict[str, Any]) -> float:
    run = run_of(**fields)
    return _miss(run.u, run.case.radius, run.case.t_final, run.case.alpha, run.case.dim)


def _evolved(fields: dict[str, Any]) -> float:
    case = fp.Case(scheme="KPSE", integrator="exponential", **fields)
    data = solution(case.radius, case.t_initial, case.alpha, case.dim)
    u = fp.evolve(data, case.particle_spacing, case.alpha, case.span)
    return _miss(u, case.radius, case.t_final, case.alpha, case.dim)


def long_probes(betas: list[float], ratios: list[float], dims: list[int]) -> Iterator[Probe]:
    """Open lattices over long times, in three units of time; then graded particles and what is kept and refused.

    The far field of a lattice of four widths leaves 4^(-1-2 alpha) of its edge, the second term of the tail, which
    reaches half the half-width with half of it: 0.02 at alpha = 1.1, 0.002 at 1.9. What resolves the data is
    exp(-pi / 0.5) of the peak at t_0, and decays at once.
    """
    for beta, ratio in product(betas, ratios):
        for n in dims:
            for start in _UNITS if n == 1 else _UNITS[:1]:
                yield from _on_lattices(beta, ratio, n, start)
        yield from _on_graded(beta, ratio)


def _on_lattices(beta: float, ratio: float, n: int, start: float) -> Iterator[Probe]:
    fields = _lattice(beta, ratio, n, start)
    if fields is None:
        return
    where = f"n = {n}, beta = {beta:g}, t_f / t_0 = {ratio:.0e}, t_0 = {start:.0e}"
    bound = 0.5 * _WIDTH ** (-1.0 - 2.0 * (1.0 + beta)) * n
    cheap = fields["half_width"] / fields["spacing"] < 1000.0
    right = Kind("long time", "the profile for |x| < D / 2", bound, "quadrature, series")
    for name, method in _methods(n).items():
        if cheap or "evaluation" in method:
            yield right(f"{name}, {where}", _solved, {**fields, **method})
    yield right(f"evolve, {where}", _evolved, fields)


@lru_cache(maxsize=4)
def _graded(beta: float, ratio: float, form: str = "interpolated") -> Any:
    """Particles to a tenth of t_0^(1/alpha), out to 10^4 t_f^(1/alpha)."""
    reach = 1e4 * ratio ** (1.0 / (1.0 + beta))
    fields = {"half_width": reach, "spacing": 0.1, "graded_scale": 1.0, "graded_form": form}
    return run_of(scheme="GPSE", beta=beta, t_initial=1.0, t_final=ratio, **fields)


def _graded_error(beta: float, ratio: float, form: str) -> float:
    run = _graded(beta, ratio, form)
    return off(run.u, solution(run.x, ratio, 1.0 + beta, 1))


def _graded_tail(beta: float, ratio: float) -> float:
    """The exponent of the tail, from 30 to 1000 widths, by a straight line through its logarithms."""
    run = _graded(beta, ratio)
    r = run.x / ratio ** (1.0 / (1.0 + beta))
    part = (r > 30.0) & (r < 1000.0)
    slope = fitted_power(r[part], np.maximum(run.u[part], 1e-300))
    return float(abs(slope + 2.0 + beta))


def _graded_mass(beta: float, ratio: float) -> float:
    """Sum V u is the mass inside: what lies beyond 10^4 widths is 2 c r^-alpha / alpha."""
    run = _graded(beta, ratio)
    alpha, reach = 1.0 + beta, run.case.reach / ratio ** (1.0 / (1.0 + beta))
    inside = 1.0 - 2.0 * tail_constant(alpha, 1) * reach**-alpha / alpha
    return abs(run.case.integral(run.u) - inside)


def _graded_least(beta: float, ratio: float) -> float:
    run = _graded(beta, ratio)
    return float(max(0.0, -run.u.min() / run.u.max()))


def _on_graded(beta: float, ratio: float) -> Iterator[Probe]:
    """The field between graded particles over any time.

    The sincs leave exp(-pi^2 / 2 ds) or so, ds = 0.1; the product with the matrix rounds the initial peak, which is
    ratio^(1/alpha) times the final one. The outermost particles, where the field ends, keep a half of a 10^-4 (2+beta)
    of the peak, their mass a tenth of what lies beyond.
    """
    where = f"beta = {beta:g}, t_f / t_0 = {ratio:.0e}"
    alpha = 1.0 + beta
    rounded = 1e3 * EPS * ratio ** (1.0 / alpha)
    beyond = 2.0 * tail_constant(alpha, 1) * 1e4**-alpha / alpha
    right = Kind("long time", "the profile", source="quadrature, series")
    for form, bound in (("interpolated", 1e-6 + rounded), ("exchange", 0.05)):
        name = f"GPSE, graded, {form}, {where}"
        yield right(name, _graded_error, beta, ratio, form, bound=bound)
    # At 1000 widths u is 10^-3 (2 + beta) of the peak: the line is straight where round-off is far below.
    if rounded < 1e-2 * 1e3 ** -(2.0 + beta):
        tail = Kind("long time", "-1 - alpha", 0.02, "series")
        name = f"GPSE, graded, tail exponent, 30 to 1000 widths, {where}"
        yield tail(name, _graded_tail, beta, ratio)
    mass = Kind("long time", "1 less the tail beyond", 0.5 * beyond + rounded, "series")
    yield mass(f"GPSE, graded, mass, {where}", _graded_mass, beta, ratio)
    positive = Kind("long time", "no strength below round-off", rounded)
    yield positive(f"GPSE, graded, positivity, {where}", _graded_least, beta, ratio)


# --- short times ------------------------------------------------------------------------------------------------------


def _shift(fields: dict[str, Any], share: float) -> float:
    """How far the change of u is from T dG/dt, over the greatest of it, where |x| is below half the half-width."""
    run = run_of(t_initial=1.0, t_final=1.0 + share, **fields)
    case = run.case
    inner = case.radius <= 0.5 * case.reach
    return off((run.u - run.u0)[inner], case.span * rate(case.radius[inner], case.alpha, case.dim))


def _short(beta: float, n: int) -> dict[str, Any]:
    half, h = {1: (20.0, 0.2), 2: (8.0, 0.4), 3: (4.0, 0.5)}[n]
    lattice = {"dim": n, "half_width": half, "spacing": h}
    return {"beta": beta, "integrator": "exponential", **lattice}


def _whole_shift(beta: float, n: int, share: float) -> float:
    case = fp.Case(scheme="KPSE", **_short(beta, n))
    u0 = solution(case.radius, 1.0, case.alpha, n)
    u = fp.evolve(u0, case.particle_spacing, case.alpha, share)
    inner = case.radius <= 0.5 * case.half_width
    return off((u - u0)[inner], share * rate(case.radius[inner], case.alpha, n))


def short_probes(betas: list[float], shares: list[float], dims: list[int]) -> Iterator[Probe]:
    """u - u_0 = T dG/dt, whose round-off is some eps / T of u. Not DVM, which gives the smoothed field, not a change.

    Of order 2 the operator is wrong by (epsilon k / 2)^2 of each wave: a third of the rate on the line, where epsilon =
    0.4 and the rate is made of k = 2 to 3, nearly all of it in space. The step itself leaves T.
    """
    right = Kind("short time", "u - u_0 is T dG/dt", source="quadrature")
    for beta, share, n in product(betas, shares, dims):
        rounded, where = 40.0 * EPS / share, f"n = {n}, beta = {beta:g}, T / t_0 = {share:.0e}"
        for scheme in ("DD", "DPSE", "FPSE", "KPSE"):
            kind = ALL_SCHEMES[scheme]
            for exterior in kind.exteriors if n in kind.dims else ():
                fields = {"scheme": scheme, "exterior": exterior, **_short(beta, n)}
                bound = (0.35 if n == 1 else 0.9) + rounded
                name = f"{scheme}, order 2, {exterior}, {where}"
                yield right(name, _shift, fields, share, bound=bound)
        yield right(f"evolve, {where}", _whole_shift, beta, n, share, bound=0.05 + rounded)
    refused = Kind("short time", "refused: epsilon / h below 1/4", must=REFUSED)
    lattice = {"scheme": "GPSE", "beta": 0.5, "half_width": 20.0, "spacing": 0.2}
    for share in shares:
        times = {"dt": share, "t_initial": 1.0, "t_final": 1.0 + share}
        yield refused(f"GPSE, T / t_0 = {share:.0e}, h = 0.2", lambda: run_of(**lattice, **times))


# --- the figure -------------------------------------------------------------------------------------------------------


def add_profiles(panels: Panels, beta: float, ratios: list[float]) -> None:
    """Add t^(1/alpha) u against |x| t^(-1/alpha) of the graded particles, and their relative error."""
    alpha = 1.0 + beta
    for ratio in ratios:
        run = _graded(beta, ratio)
        right = run.x > 0.0
        exact = solution(run.x[right], ratio, alpha, 1)
        r, scale = run.x[right] * ratio ** (-1.0 / alpha), ratio ** (1.0 / alpha)
        panels.add("profile", ratio, r, scale * run.u[right], exact=scale * exact)
        panels.add("error", ratio, r, np.abs(run.u[right] - exact) / exact.max() + 1e-18)
