"""Runs on lattices that do not suit the solution, against the exact one: what is right, spoken of, refused."""

import math
from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

import fracparticles as fp
from fracparticles.run.reliability import LIMITS
from fracparticles.run.solver import compute
from fracparticles.schemes import ALL_SCHEMES
from fracstudy.panels import Panels
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe, off, overheard
from fracstudy.race.problem import distance

_START, _SPAN = 0.5, 1.0
# A share d of the strength that is where it must not be is missed elsewhere: 2 d in the 1-norm. Nothing is said of
# waves wrong by 0.05, of 0.05 beyond the lattice, nor, of data that are a function, of 0.05 between the particles.
_ALLOWED = 2.0 * (LIMITS["wave_error"] + LIMITS["outside_share"])
OF_A_FUNCTION = _ALLOWED + 2.0 * LIMITS["between_particles"]
_TAIL = 1e-3  # of the maximum: what `evolve` does not speak of
_REFUSED = Kind("refused", must=REFUSED)


class Errors(Panels):
    """The points of the figure: the true error of each run over the estimate that is worst for its limit."""

    def of_run(self, kind: str, case: fp.Case, centre: float | None = None) -> float:
        """Run a case, and return sum V |u - exact| / sum V |exact|."""

        def solution(time: float) -> Any:
            """The fundamental solution about (centre, 0, ..) at a time, as a function of the coordinates."""

            def u(*x: np.ndarray) -> np.ndarray:
                r, t = distance(x, [centre or 0.0]), case.diffusivity * time
                return np.asarray(fp.green(r, t, case.alpha, case.dim))

            return u

        with overheard() as words:
            run = compute(case, None if centre is None else solution(case.t_initial))
        exact = solution(case.t_final)(*case.positions)
        error = case.integral(np.abs(run.u - exact)) / case.integral(exact)
        worst = max(_over(name, value) for name, (value, _) in run.estimates.items())
        said = "warned" if words else "silent"
        self.add(kind, said, min(max(worst, 1e-3), 1e3), min(max(error, 1e-4), 1e2))
        return float(error)


def _over(name: str, value: float) -> float:
    """An estimate over its limit; of growth, which is one for what does not grow, the part above one."""
    if name == "growth":
        return max(0.0, value - 1.0) / (LIMITS[name] - 1.0)
    return value / LIMITS[name] if name in LIMITS else 0.0


def _case(scheme: str, beta: float, **given: Any) -> fp.Case:
    kind, fields = ALL_SCHEMES[scheme], {"t_initial": _START, "t_final": _START + _SPAN, **given}
    if kind.moving:
        fields |= {"dt": _SPAN / 50.0, "threshold": 1e-5}
    elif not kind.self_timed:
        fields["integrator"] = "exponential"
    if "overlap" not in fields and not (kind.self_timed or not kind.has_kernel):
        fields["overlap"] = 2.0
    if kind.self_timed and not {"overlap", "graded_scale"} & set(fields):
        fields["dt"] = _SPAN
    return fp.Case(scheme=scheme, beta=beta, store="metrics", **fields)


def counts(beta: float) -> Iterator[Probe]:
    """Spacings that do not divide the width; the fewest particles; odd and prime numbers of them; refused ones.

    The lattice ends at the half-width D exactly, h = D / round(D / h). A point of the same lattice is right whatever
    their number is: the runs are held against the exact solution, within twice the error at h = 1/8, D = 30.
    """
    usual = Errors().of_run("", _case("KPSE", beta, half_width=30.0, spacing=0.125))
    right = Kind("spacing", "as with h = 1/8, D = 30", 1.0, "closed form", HELD)
    pairs = ((30.0, 0.1249), (30.0, 0.13), (29.9, 0.125), (math.pi * 10.0, 0.125), (31.375, 0.125))
    for half, h in pairs:
        case = _case("KPSE", beta, half_width=half, spacing=h)
        at_the_end = abs(case.x[-1] / case.reach - 1.0) / 1e-15
        yield right(
            f"D = {half:.4g}, h = {h:g}: N = {case.particles}, ends at D",
            lambda: max(Errors().of_run("", case) / (2.0 * usual), at_the_end),
        )
    bad: dict[str, dict[str, float]] = {
        "N = 15": {"spacing": 30.0 / 7.0},
        "N = 3": {"spacing": 30.0},
        "N = 1": {"spacing": 100.0},
        "h = 0": {"spacing": 0.0},
        "h = nan": {"spacing": math.nan},
        "h < 0": {"spacing": -0.1},
        "D = 0": {"half_width": 0.0},
        "D = inf": {"half_width": math.inf},
        "overlap 0.2": {"overlap": 0.2},
        "overlap 1001": {"overlap": 1001.0},
        "1e12 particles": {"spacing": 1e-11},
        "half-width 1e-101": {"half_width": 1e-101, "spacing": 1e-103},
    }
    for name, given in bad.items():
        fields = {"half_width": 30.0, "spacing": 0.1, **given}
        yield _REFUSED(name, lambda: compute(_case("KPSE", beta, **fields)))


def unsuitable(
    errors: Errors, beta: float, schemes: dict[int, list[str]], half_widths: dict[int, float]
) -> Iterator[Probe]:
    """One parameter of the lattice at a time goes to its ends; the rest is that of a run that is right.

    The data are the fundamental solution; off centre, and between the particles, it is given as a function.
    """
    for dim, names in schemes.items():
        for scheme in names:
            for kind, words, given, *centre in _unsuitable(scheme, dim, half_widths[dim]):
                bound = OF_A_FUNCTION if centre else _ALLOWED
                yield Kind(kind, "the exact solution", bound, "closed form")(
                    f"{scheme}, n = {dim}, {words}",
                    lambda: errors.of_run(kind, _case(scheme, beta, **given), *centre),
                )


def _unsuitable(scheme: str, dim: int, wide: float) -> Iterator[tuple[Any, ...]]:
    """Kind, words, fields, and where the data lie, if not in the middle."""
    one, h = ALL_SCHEMES[scheme], {1: 0.1, 2: 0.25, 3: 0.5}[dim]
    base: dict[str, Any] = {"dim": dim, "half_width": wide, "spacing": h}
    if one.has_kernel and not one.self_timed:
        for overlap in (0.25, 0.5, 0.8, 8.0, 20.0) if dim < 3 else (0.5, 4.0):
            yield "overlap", f"overlap {overlap:g}", {**base, "overlap": overlap}
    if dim == 1 and len(one.orders) > 2:
        for order, overlap in product((4, one.orders[-1]), (0.4, 8.0)):
            fields = {**base, "overlap": overlap, "order": order}
            yield "overlap", f"order {order}, overlap {overlap:g}", fields
    for coarse in (0.5, 1.0, 2.0, wide / 8.0):
        if h < coarse <= wide / 8.0:
            yield "too coarse", f"h = {coarse:g}", {**base, "spacing": coarse}
    for exterior in one.exteriors:
        usual = {**base, "exterior": exterior}
        for narrow in (0.5, 1.0, 4.0):
            fields = {**usual, "half_width": narrow, "spacing": min(h, narrow / 8.0)}
            yield "too narrow", f"half-width {narrow:g}, {exterior}", fields
        for share in (0.5, 0.9, 1.0, 3.0):
            where = f"data at {share:g} of the half-width, {exterior}"
            yield "off centre", where, usual, share * wide
        if dim == 1:
            fields = {**usual, "half_width": 40.0, "spacing": 4.0}
            fields |= {"t_initial": 0.01, "t_final": 0.02}
            yield "hidden", f"a peak half-way between particles, {exterior}", fields, 6.0


_GRADED: tuple[tuple[Any, ...], ...] = (
    ("fitting", {}),
    ("17 particles", {"spacing": 0.95}),
    ("L = 100", {"graded_scale": 100.0, "spacing": 20.0}),
    ("L = 1e-3", {"graded_scale": 1e-3, "spacing": 2.5e-4}),
    ("D = 2", {"half_width": 2.0, "spacing": 0.1}),
    ("D = 1e12", {"half_width": 1e12}),
    ("data at 0.01 D", {}, 10.0),
    ("data at 0.5 D", {}, 500.0),
    ("data at D", {}, 1e3),
    ("data at 10 D", {}, 1e4),
)


def graded(errors: Errors, beta: float) -> Iterator[Probe]:
    """Particles x_j = L sinh(s_j), few or many, narrow or wide, with data in the middle and where gaps are wide."""
    forms = ("exchange", "quadrature", "interpolated")
    for form, (words, given, *centre) in product(forms, _GRADED):
        fields = {"half_width": 1e3, "graded_scale": 1.0, "spacing": 0.25, "graded_form": form}
        bound = OF_A_FUNCTION if centre else _ALLOWED
        yield Kind("graded", "the exact solution", bound, "closed form")(
            f"{form}, {words}",
            lambda: errors.of_run("graded", _case("GPSE", beta, **fields | given), *centre),
        )
    few = {"2 particles": (2, 1.0, 1.0), "1 particle": (1, 1.0, 1.0), "4 particles": (4, 1.0, 1.0)}
    few |= {"reach 0": (3, 0.0, 1.0), "scale nan": (3, 1.0, math.nan)}
    named = {f"graded, {words}": particles for words, particles in few.items()}
    yield from _REFUSED.over(fp.graded_particles, named)
    # N roundings of the greatest term, that of the outer particles: V u to some ulp each.
    kept = Kind("graded", "the sum before", 16.0 * EPS, "closed form", HELD)
    yield kept("3 particles, exchange: sum V u is kept", _of_three, 1.0 + beta)


def _of_three(alpha: float) -> float:
    x, volumes = fp.graded_particles(3, 10.0, 1.0)
    u = np.array([1.0, 2.0, 4.0])
    after = fp.green_step(x, volumes, alpha, 1.0) @ u
    return float(abs(volumes @ after / (volumes @ u) - 1.0))


def evolved(beta: float, points: dict[int, list[int]]) -> Iterator[Probe]:
    """`evolve` on lattices of any number of points, with data in the middle, off it, and at the edge.

    It warns where the tail misses the solution at the ends by a thousandth of the maximum, or where the data are not
    resolved: the greatest error is to be within some thousandths, where it is silent.
    """
    right = Kind("evolve", "the exact solution", 5.0 * _TAIL, "closed form")
    for dim, count in ((dim, count) for dim, some in points.items() for count in some):
        name, must = f"n = {dim}, {count} points an axis", REFUSED if count < 8 else None
        yield right(name, _of_evolve, 1.0 + beta, dim, count, 0.0, must=must)
    for dim, count in ((1, 401), (2, 41)):
        for share in (0.3, 0.5, 0.9, 1.0, 1.1, 3.0, 1e6) if dim in points else ():
            name = f"n = {dim}, data at {share:g} of the half-width"
            yield right(name, _of_evolve, 1.0 + beta, dim, count, share)


def _of_evolve(alpha: float, dim: int, count: int, share: float) -> float:
    half = {1: 20.0, 2: 10.0, 3: 6.0}[dim]
    x = np.linspace(-half, half, count) if count > 1 else np.zeros(count)
    r = distance(np.meshgrid(*(x,) * dim, indexing="ij", sparse=True), [share * half])
    h = 2.0 * half / max(count - 1, 1)
    u = fp.evolve(np.asarray(fp.green(r, 1.0, alpha, dim)), h, alpha, 1.0)
    return off(u, np.asarray(fp.green(r, 2.0, alpha, dim)))
