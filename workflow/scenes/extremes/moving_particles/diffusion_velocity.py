"""The diffusion velocity method where it may go wrong: weak and negative fields, crossing, remeshing, steps, ends."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from scipy.special import gamma

from fracparticles.errors import FracparticlesWarning
from fracparticles.moving import dvm
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.stability import stability_limit
from fracparticles.special.stable import green
from fracparticles.special.tails import tail_constant
from fracstudy.probe import EPS, HELD, REFUSED, WARNED, Kind, Probe
from scenes.lucchesi.dvm_stability.study import worst_wave

__all__ = ["growth_of_a_wave", "overlap_errors", "probes"]

_START, _TIME, _ALPHA = 0.5, 0.5, 1.5
_FACTORS = (0.9, 0.99, 1.01, 1.1, 1.5)  # of the limit of a step
_HALF, _STEPS, _XI = (
    300,
    3,
    1e-5,
)  # particles on either side of a wave, steps, and its height in spacings
_SPOKEN = 0.05  # error of a run that must be spoken of
_OVERLAPS = (0.25, 0.4, 0.5, 0.6, 0.8, 1.0, 2.0, 4.0, 20.0)


def probes(orders: Sequence[int], half_width: float, spacing: float) -> Iterator[Probe]:
    """All of them; half-width and spacing are those of runs."""
    cloud = _Cloud(half_width, spacing)
    yield from _weak(cloud)
    yield from _signs(cloud)
    yield from _crossing(cloud)
    yield from _remeshed(cloud, orders)
    yield from _growth(orders)
    yield from _overlaps(cloud, orders)
    yield from _ends(cloud)
    yield from _orders_of_the_equation(cloud)
    yield from _few(cloud)


class _Cloud:
    """Runs from the fundamental solution on a lattice, and their errors."""

    def __init__(self, half_width: float, spacing: float) -> None:
        self.h, self.half_width = spacing, half_width
        n = round(half_width / spacing)
        self.x = spacing * np.arange(-n, n + 1.0)

    def u(self, alpha: float = _ALPHA, start: float = _START) -> np.ndarray:
        return np.asarray(green(self.x, start, alpha))

    def run(self, u: np.ndarray | None = None, **options: Any) -> dvm.ParticleRun:
        """To `_TIME` after the start, by steps of half the limit unless told otherwise."""
        alpha, order = options.get("alpha", _ALPHA), options.get("order", 2)
        time = options.pop("time", _TIME)
        limit = stability_limit("DD", alpha - 1.0, order, options.get("overlap", 2.0))
        dt = options.pop("factor", 0.5) * limit * self.h**alpha
        steps = options.pop("steps", max(1, math.ceil(time / dt)))
        how = {"spacing": self.h, "alpha": alpha, "dt": time / steps, "start": _START, **options}
        x = options.pop("x", self.x)
        how.pop("x", None)
        return dvm.run(x, self.u(alpha) if u is None else u, steps=steps, **how)

    def error(self, exact: Any = None, **options: Any) -> float:
        """The error of the field in |x| < L/2, relative to its peak."""
        time, alpha = options.get("time", _TIME), options.get("alpha", _ALPHA)
        z = np.linspace(-0.5, 0.5, 101) * self.half_width
        end = np.asarray(
            green(z, _START + time, alpha) if exact is None else exact(z, _START + time)
        )
        return float(np.abs(self.run(**options).field(z) - end).max() / end.max())

    def smoothing(self, alpha: float = _ALPHA, overlap: float = 2.0) -> float:
        """epsilon^2 |u''(0)| / (4 u(0)) at the start: what a kernel of order II takes from the peak, the most ever."""
        curvature = gamma(3.0 / alpha) / gamma(1.0 / alpha) * _START ** (-2.0 / alpha)
        return float(0.25 * (overlap * self.h) ** 2 * curvature)


def _weak(cloud: _Cloud) -> Iterator[Probe]:
    """A field below the round-off of the sums at the ends, beta near one; pairs, or a threshold, carry it."""
    wide = _Cloud(20.0, 2.0 * cloud.h)
    gaussian: dict[str, Any] = {"alpha": 2.0 - 1e-9, "exact": _gaussian}
    bound = wide.smoothing(2.0)
    expected = "the Gaussian"
    case = "β = 1 - 1e-9, tail 1e-14 of the peak"
    weak_field = Kind("weak field")
    yield weak_field(f"{case}, transforms", partial(wide.error, **gaussian), must=REFUSED)
    for how, options in (
        ("pairs", {"summation": "naive", "remeshing": "none"}),
        ("threshold 1e-8", {"threshold": 1e-8}),
    ):
        yield weak_field(
            f"{case}, {how}",
            partial(wide.error, **gaussian, **options),
            expected=expected,
            bound=bound,
            source="closed form",
            must=HELD,
        )
    for unit in (1e-30, 1e30):
        # The sums state 1e-11 of the peak; a velocity is a quotient of two of them, where u is 1e-3 of it.
        yield weak_field(
            f"lengths times {unit:g}, times times {unit:g}^α",
            _other_units,
            cloud,
            unit,
            expected="the same particles",
            bound=1e-7,
            source="scaling",
        )
    yield weak_field(
        "strengths of zero at the ends", _kept, cloud, 0.0, expected="left out", must=HELD
    )
    yield weak_field("strengths of 1e-320 at the ends", _kept, cloud, 1e-320, must=REFUSED)
    yield weak_field(
        "strengths that all underflow",
        lambda: float(cloud.run(1e-320 * cloud.u()).x.size),
        must=REFUSED,
    )


def _gaussian(z: np.ndarray, t: float) -> np.ndarray:
    return np.exp(-z * z / (4.0 * t)) / math.sqrt(4.0 * math.pi * t)


def _other_units(cloud: _Cloud, unit: float) -> float:
    plain = cloud.run(exterior="open", steps=20)
    dt = _TIME / 20 * unit**_ALPHA
    other = dvm.run(
        unit * cloud.x, cloud.u() / unit, spacing=unit * cloud.h, alpha=_ALPHA, dt=dt, steps=20,
        start=_START * unit**_ALPHA, exterior="open",
    )  # fmt: skip
    return float(np.abs(other.x / unit - plain.x).max() / cloud.h)


def _kept(cloud: _Cloud, ends: float) -> float:
    u = cloud.u()
    u[:3] = u[-3:] = ends
    return float(cloud.run(u, time=0.01, remeshing="none").x.size - (cloud.x.size - 6))


def _signs(cloud: _Cloud) -> Iterator[Probe]:
    """A velocity Q / u has no meaning where u is zero, and does not know the sign of u."""
    sign = Kind("sign")
    yield sign(
        "a field that is negative everywhere",
        lambda: float(np.abs(cloud.run(-cloud.u()).x - cloud.run().x).max()),
        expected="the same paths, bit for bit",
        must=HELD,
    )
    dipole = np.sin(cloud.x) * cloud.u()
    step = np.where(np.abs(cloud.x) < 1.0, 1.0, 0.0)
    for case, u in {
        "a field of both signs": dipole,
        "zero but for the middle, order IV": step,
    }.items():
        order = 4 if "IV" in case else 2
        yield sign(case, partial(cloud.error, u=u, order=order), must=REFUSED)
    # The flux of what is cut off at a distance r is A r^(1-alpha) / (alpha - 1); that of the other end goes against it.
    a = tail_constant(_ALPHA) / _ALPHA
    bound = _TIME * a * (0.5 * cloud.half_width) ** (1.0 - _ALPHA) / (_ALPHA - 1.0)
    yield sign(
        "a uniform field between its ends",
        _uniform_moves,
        cloud,
        expected="no motion but for the ends",
        bound=float(bound),
        source="closed form",
    )


def _uniform_moves(cloud: _Cloud) -> float:
    run = cloud.run(np.ones(cloud.x.size), remeshing="none")
    middle = np.abs(cloud.x) < 0.5 * cloud.half_width
    return float(np.abs(run.x - cloud.x)[middle].max())


def _crossing(cloud: _Cloud) -> Iterator[Probe]:
    """Particles in any order, in one place, or nearly; and those that cross since the step is too large."""
    half = {"remeshing": "none", "steps": 10}
    shuffled = np.random.default_rng(3).permutation(cloud.x.size)
    twice = np.repeat(np.arange(cloud.x.size), 2)
    # The sums state 1e-11 of the peak, and u at the ends is 1e-3 of it.
    crossing = Kind("crossing", "the same paths", _SPOKEN, "fundamental solution")
    for case, places, shift in (
        ("in any order", shuffled, 0.0),
        ("each in two halves, in one place", twice, 0.0),
        ("each in two halves, 1e-14 apart", twice, 1e-14),
    ):
        yield crossing(
            f"particles {case}",
            _same_paths,
            cloud,
            places,
            shift,
            half,
            bound=1e-7,
            source="the plain run",
        )
    yield crossing(
        "steps of three times the limit",
        partial(cloud.error, factor=3.0),
        expected="within 5 %, or a word",
    )


def _same_paths(cloud: _Cloud, places: np.ndarray, shift: float, how: dict[str, Any]) -> float:
    count = np.bincount(places)
    x = cloud.x[places] + shift * (np.arange(places.size) % 2)
    other = cloud.run((cloud.u() / count)[places], x=x, **how)
    plain = cloud.run(**how)
    return float(np.abs(other.x - plain.x[places]).max() / cloud.h)


def _remeshed(cloud: _Cloud, orders: Sequence[int]) -> Iterator[Probe]:
    """Remeshing at every step, when asked for, and never, onto either exterior."""
    bound = cloud.smoothing()
    when = {"every step": 1.0 + 1e-9, "by itself": None, "gaps of 5 h": 5.0}
    remeshing_runs = Kind("remeshing runs", "the solution", source="fundamental solution")
    for order, exterior in product(orders, dvm.EXTERIORS):
        for name, (often, above) in product(("M4'", "Lambda3"), when.items()):
            options = {
                "order": order,
                "exterior": exterior,
                "remeshing": name,
                "remesh_above": above,
            }
            yield remeshing_runs(
                f"order {order}, {exterior}, {name}, {often}",
                partial(cloud.error, **options),
                bound=bound,
                must=HELD,
            )
        yield remeshing_runs(
            f"order {order}, {exterior}, never",
            partial(cloud.error, order=order, exterior=exterior, remeshing="none"),
            bound=bound,
            must=HELD,
        )
    for name in ("M4'", "Lambda3"):
        # Each of some fifty remeshings rounds every strength some ten times.
        yield remeshing_runs(
            f"{name}, extended lattice",
            _unaccounted,
            cloud,
            name,
            expected="every strength is found",
            bound=500.0 * EPS,
            source="exact sums",
        )


def _unaccounted(cloud: _Cloud, name: str) -> float:
    often: dict[str, Any] = {"remeshing": name, "remesh_above": 1.0 + 1e-9, "factor": 0.1}
    run = cloud.run(**often, lattice="extended", threshold=1e-4)
    found = math.fsum(run.strength) + run.history.eliminated_strength
    return abs(found / math.fsum(cloud.h * cloud.u()) - 1.0)


def _growth(orders: Sequence[int]) -> Iterator[Probe]:
    """A displacement wave on a uniform field: 1 + z + z^2/2 a step, z = dt A(k) of DD; beyond the limit it is told."""
    row = Kind("step", "grows by 1 + z + z²/2", source="Fourier symbol")
    for order, factor in product(orders, _FACTORS):
        verdict = WARNED if factor > 1.0 else HELD
        run = partial(_wave_missed, order, factor)
        # The ends stretch the middle by 2 A r^-alpha t, and z = -2 dt / a changes by as much.
        dt = factor * stability_limit("DD", _ALPHA - 1.0, order)
        stretch = 2.0 * tail_constant(_ALPHA) / _ALPHA * _HALF**-_ALPHA * _STEPS * dt
        yield row(
            f"order {order}, dt = {factor:g} a",
            run,
            bound=2.0 * factor * abs(2.0 * factor - 1.0) * stretch,
            must=verdict,
        )


def _wave_missed(order: int, factor: float) -> tuple[float, str]:
    found, predicted = growth_of_a_wave(order, factor)
    return abs(found - predicted), f"{found:.3f}, predicted {predicted:.3f}"


def growth_of_a_wave(order: int, factor: float) -> tuple[float, float]:
    """Return what a step of `factor` times the limit multiplies the fastest wave by, and the prediction."""
    theta = worst_wave(_ALPHA, order)
    dt = factor * stability_limit("DD", _ALPHA - 1.0, order)
    x = np.arange(-_HALF, _HALF + 1.0)
    wave = np.cos(theta * x)

    def moved(places: np.ndarray) -> np.ndarray:
        how: dict[str, Any] = {"spacing": 1.0, "alpha": _ALPHA, "order": order, "remeshing": "none"}
        return dvm.run(places, np.ones(x.size), dt=dt, steps=_STEPS, **how).x

    change = (moved(x + _XI * wave) - moved(x)) / _XI
    middle = np.abs(x) < _HALF / 6.0
    ratio = float(change[middle] @ wave[middle] / (wave[middle] @ wave[middle]))
    z = dt * float(SCHEMES["DD"].symbol(np.array([theta]), Setting(alpha=_ALPHA, order=order))[0])
    return float(np.copysign(abs(ratio) ** (1.0 / _STEPS), ratio)), 1.0 + z + 0.5 * z * z


def _overlaps(cloud: _Cloud, orders: Sequence[int]) -> Iterator[Probe]:
    """Smoothing lengths from a quarter of the spacing to twenty times: wrong by more than 5 % only with a word."""
    row = Kind("overlap", "within 5 %, or a word", _SPOKEN, "fundamental solution")
    for order, overlap in product(orders, _OVERLAPS):
        yield row(
            f"order {order}, ε = {overlap:g} h",
            partial(_case_error, cloud, order=order, overlap=overlap),
        )


def _case_error(cloud: _Cloud, **fields: Any) -> float:
    """The error (48) of a run of the public function, which says more than `dvm.run`."""
    from fracparticles.run.case import Case
    from fracparticles.run.solution import relative_l1_error
    from fracparticles.run.solver import compute

    grid = {"beta": _ALPHA - 1.0, "half_width": cloud.half_width, "spacing": cloud.h}
    times = {"t_initial": _START, "t_final": _START + _TIME}
    limit = stability_limit("DD", _ALPHA - 1.0, fields["order"], fields["overlap"])
    dt = 0.5 * max(limit, 0.01) * cloud.h**_ALPHA
    run = compute(Case(scheme="DVM", **grid, **times, dt=dt, **fields))
    return float(relative_l1_error(run.case, run.u))


def overlap_errors(half_width: float, spacing: float, orders: Sequence[int]) -> pd.DataFrame:
    """Return the error of runs against the overlap, and whether they spoke."""
    import warnings

    cloud, rows = _Cloud(half_width, spacing), []
    for order, overlap in product(orders, _OVERLAPS):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                error = _case_error(cloud, order=order, overlap=overlap)
            except ArithmeticError:
                error = np.nan
        spoke = any(issubclass(w.category, FracparticlesWarning) for w in caught)
        rows.append({"series": f"DVM {order}", "x": overlap, "y": error, "spoke": spoke})
    return pd.DataFrame(rows)


def _ends(cloud: _Cloud) -> Iterator[Probe]:
    """Lattices too narrow, thresholds too large, data off the centre: wrong by more than 5 % only with a word."""
    source = "fundamental solution"
    row = Kind("ends", "within 5 %, or a word", _SPOKEN)
    for exterior, threshold in product(dvm.EXTERIORS, (1e-300, 1e-6, 1e-3, 0.02, 0.2, 0.9)):
        yield row(
            f"{exterior}, threshold {threshold:g}",
            partial(cloud.error, exterior=exterior, threshold=threshold),
            source=source,
        )
    for exterior, width, time in product(dvm.EXTERIORS, (1.0, 2.0, 5.0), (0.5, 10.0)):
        narrow = _Cloud(width, cloud.h)
        yield row(
            f"{exterior}, |x| < {width:g}, T = {time:g}",
            partial(narrow.error, exterior=exterior, time=time),
            source=source,
        )
    for centre in (3.0, 8.0):
        yield row(
            f"open, data at {centre / 10:g} of the half-width",
            _off_centre,
            cloud,
            centre * 0.1 * cloud.half_width,
            source=source,
        )
    yield row(
        "open, data beyond the lattice", _off_centre, cloud, 3.0 * cloud.half_width, source=source
    )


def _off_centre(cloud: _Cloud, centre: float) -> float:
    run = cloud.run(np.asarray(green(cloud.x - centre, _START, _ALPHA)), exterior="open")
    z = np.linspace(-0.9, 0.9, 101) * cloud.half_width
    exact = np.asarray(green(z - centre, _START + _TIME, _ALPHA))
    return float(np.abs(run.field(z) - exact).max() / exact.max())


def _orders_of_the_equation(cloud: _Cloud) -> Iterator[Probe]:
    """Orders next to 1 and 2 against the Cauchy and the Gaussian density; between, 1 - alpha of the difference."""
    cases = ((1.0 + 1e-9, _cauchy), (1.001, _cauchy), (1.999, _gaussian), (2.0 - 1e-9, _gaussian))
    row = Kind("order", "the limit", source="closed form", must=HELD)
    for exterior, (alpha, exact) in product(dvm.EXTERIORS, cases):
        nearest = round(alpha)
        bound = cloud.smoothing(float(nearest)) + 2.0 * abs(alpha - nearest)
        # Transforms end at 1e-11 of the peak, where the Gaussian is below.
        narrow = _Cloud(min(cloud.half_width, 6.0), cloud.h) if nearest == 2 else cloud
        yield row(
            f"{exterior}, β = {_near(alpha - 1.0)}",
            partial(narrow.error, exact=exact, alpha=alpha, exterior=exterior, steps=20),
            bound=bound,
        )


def _near(beta: float) -> str:
    return f"{beta:.0e}" if beta < 0.5 else f"1 - {1.0 - beta:.0e}"


def _cauchy(z: np.ndarray, t: float) -> np.ndarray:
    return t / (math.pi * (z * z + t * t))


def _few(cloud: _Cloud) -> Iterator[Probe]:
    """One particle does not move, two move apart alike; the tails of an open exterior ask for sixteen."""
    few = Kind("few")
    yield few(
        "one particle", _few_moved, cloud, 1, expected="stays", bound=1e-12, source="symmetry"
    )
    yield few(
        "two particles",
        _few_moved,
        cloud,
        2,
        expected="move apart alike",
        bound=1e-12,
        source="symmetry",
    )
    yield few("15 particles, open", partial(_few_moved, cloud, 15, exterior="open"), must=REFUSED)
    yield few(
        "17 particles, open",
        partial(_few_moved, cloud, 17, exterior="open"),
        expected="move apart alike",
        bound=1e-10,
        source="symmetry",
    )


def _few_moved(cloud: _Cloud, count: int, **options: Any) -> float:
    x = cloud.h * (np.arange(count) - 0.5 * (count - 1))
    run = cloud.run(np.ones(count), x=x, steps=3, time=0.01, remeshing="none", **options)
    return float(np.abs(run.x + run.x[::-1]).max())
