"""What a linear equation does to any data: strengths of any size, sums, mirrors, shifts, other units."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from fracparticles.run.solver import prepare
from fracparticles.schemes import ALL_SCHEMES
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe, off
from scenes.extremes.dense import whole
from scenes.extremes.rough_data.cases import case_of, cases_of, deviation, run

# A run is some hundred roundings of the largest strength: of each particle the sum of N, of a series a term a degree.
_SAME = 1e-12
Advance = Callable[[np.ndarray], np.ndarray]
_DENSE = 500  # particles, up to which the run is done as one matrix, too


def _shapes(x: np.ndarray) -> dict[str, np.ndarray]:
    """Data of every roughness on the particles of the line."""
    rng, middle = np.random.default_rng(3), x.size // 2
    smooth, pulse = np.exp(-x * x), np.zeros(x.size)
    pulse[middle] = 1.0
    return {
        "point": pulse,
        "pulse at the end": np.roll(pulse, middle),
        "step": np.where(x > 0.0, 1.0, 0.0),
        "both signs": x * smooth,
        "noise": rng.standard_normal(x.size),
        "smooth on a background": 1.0 + 1e-8 * smooth,
        "spike beside smooth": smooth + 1e8 * np.roll(pulse, 20),
        "alternating": (-1.0) ** np.arange(x.size),
        "600 decades": np.where(pulse > 0.0, 1e300, 1e-300 * smooth),
    }


def exact(beta: float, schemes: list[str]) -> Iterator[Probe]:
    """exp(A T) u0, of GPSE (1 + A T) u0, by scipy from the dense matrix; whatever the data are, if they are finite.

    The estimates may warn of the data, but that excuses nothing: the discrete problem is solved.
    """
    right = Kind("exact", "exp(A T) u0", source="scipy, dense")
    for case in cases_of(beta, schemes):
        matrix = whole(case)
        # The series rounds T |lambda| 2^-52 of its terms some 64 times, which an open exterior may make larger than
        # their sum.
        size = np.abs(scheme_matrix(case.scheme, case.setting)).sum(axis=1).max()
        stiffness = case.span * float(size)
        bound = max(_SAME, 64.0 * EPS * stiffness)
        for words, u0 in _shapes(case.x).items():
            name = f"{case.scheme}, {case.exterior}, {words}"
            yield right(name, lambda: deviation(run(case, u0), matrix @ u0), bound=bound)


def sizes(beta: float, schemes: list[str], dims: list[int]) -> Iterator[Probe]:
    """Strengths of any size that float64 has: c u0 gives c u. Denormal numbers have the digits that they have.

    Sums of strengths near 1.8e308 overflow: refused. Zero stays zero.
    """
    same = Kind("size", "the solution times the same", must=HELD)
    for scheme in schemes:
        for dim in [d for d in dims if d in ALL_SCHEMES[scheme].dims]:
            small = {} if dim == 1 else {"half_width": 3.0, "spacing": 0.375}
            for case in cases_of(beta, [scheme], dim=dim, **small):
                u0 = np.exp(-sum(np.square(part) for part in case.positions))
                dense = case.particles < _DENSE
                by_matrix = (whole(case) @ u0.ravel()).reshape(u0.shape) if dense else None
                usual = prepare(case).solve(u0) if by_matrix is None else by_matrix
                for size in (1e-300, 1e-320, 1e306, -1.0):
                    lost = max(1.0, math.ulp(abs(size)) / abs(size) / EPS)  # to denormal numbers
                    yield same(
                        f"{scheme}, n = {dim}, {case.exterior}, data times {size:g}",
                        lambda: deviation(_scaled_back(run(case, size * u0), size), usual),
                        bound=10.0 * _SAME * lost,
                        source="scipy, dense" if dense else "",
                    )
    bounded = Kind("size", "at most what was given", source="maximum principle")
    overflows = replace(bounded, expected="refused", must=REFUSED)
    for scheme in schemes:
        case = case_of(scheme, beta)
        for words, u0, kind in (
            ("1.7e308 everywhere", np.full(case.shape, 1.7e308), overflows),
            ("1e308, both signs", 1e308 * (-1.0) ** np.arange(case.particles), overflows),
            ("zero", np.zeros(case.shape), bounded),
            ("-0.0", -np.zeros(case.shape), bounded),
            ("5e-324 on one particle", np.where(case.x == 0.0, 5e-324, 0.0), bounded),
        ):
            grows = lambda: float(np.abs(run(case, u0)).max() > np.abs(u0).max())
            yield kind(f"{scheme}, {words}", grows)


def _scaled_back(u: np.ndarray, size: float) -> np.ndarray:
    """u / size, where 1 / size may be no number."""
    exponent = math.frexp(size)[1]
    return np.ldexp(u, -exponent) / math.ldexp(size, -exponent)


def symmetries(beta: float, schemes: list[str]) -> Iterator[Probe]:
    """Sums of data, mirrored data, and on the infinite lattice shifted data: of noise on particles in the middle."""
    rng = np.random.default_rng(5)
    linear = Kind("sum of data", "S(3 u - 2 v) = 3 S u - 2 S v", 10.0 * _SAME)
    mirror = Kind("mirror", "the mirrored solution", 10.0 * _SAME)
    # What comes back from an end at 400 after T = 1/2: twice T 400^-(1+alpha), and the ends move by 37 h.
    shift = Kind("shift", "the moved solution", 2.0 * 0.5 * 390.0 ** -(2.0 + beta) * 17.0)
    for scheme in schemes:
        for case in cases_of(beta, [scheme]):
            u, v = rng.standard_normal((2, case.particles))
            solve, name = prepare(case).solve, f"{scheme}, {case.exterior}, noise"
            size = float(np.abs(solve(u)).max() + np.abs(solve(v)).max())
            both = lambda: off(solve(3.0 * u - 2.0 * v), 3.0 * solve(u) - 2.0 * solve(v), size)
            yield linear(name, both)
            yield mirror(name, lambda: off(solve(u[::-1].copy()), solve(u)[::-1], size))
        if scheme == "DPSE":  # whose truncated potential reaches everywhere
            continue
        wide = case_of(scheme, beta, half_width=400.0)
        noise = np.where(np.abs(wide.x) <= 2.0, rng.standard_normal(wide.particles), 0.0)
        name = f"{scheme}, noise on |x| <= 2, moved by 37 h, |x| <= 20 of 400"
        yield shift(name, _of_shift, prepare(wide).solve, noise, np.abs(wide.x) <= 20.0)


def _of_shift(solve: Advance, u: np.ndarray, middle: np.ndarray) -> float:
    here, there = solve(u), np.roll(solve(np.roll(u, 37)), -37)
    return off(there[middle], here[middle], float(np.abs(here).max()))


def units(beta: float, schemes: list[str], dims: list[int]) -> Iterator[Probe]:
    """Similarity: lengths times c and times times c^alpha / D leave c^n u unchanged, for units of any size.

    h = D / n and the time of the run are rounded anew: some ulp of each, of which T |lambda| are seen.
    """
    same = Kind("units", "the same in other units", 1e-10, must=HELD)
    # Whose sums are exact to 1e-11 of the peak, a step.
    moving = replace(same, bound=1e-6, must=None)
    others = ((1e-6, 1.0), (1.0, 1e6), (1e-30, 1.0), (1e30, 1e-10), (1e40, 1e60))
    for scheme in schemes:
        kind = moving if ALL_SCHEMES[scheme].moving else same
        for dim in [d for d in dims if d in ALL_SCHEMES[scheme].dims]:
            plain: dict[str, Any] = {"half_width": 8.0, "spacing": 0.5} if dim > 1 else {}
            usual = case_of(scheme, beta, dim=dim, **plain, t_initial=0.5, t_final=1.0)
            for c, d in others:
                time = c ** (1.0 + beta) / d
                fields = {"half_width": c * usual.reach, "spacing": c * usual.spacing}
                fields |= {"t_initial": 0.5 * time, "t_final": time, "diffusivity": d, "dim": dim}
                scaled = lambda: c**dim * run(case_of(scheme, beta, **fields), None)
                yield kind(
                    f"{scheme}, n = {dim}, lengths times {c:g}, D = {d:g}",
                    lambda: deviation(scaled(), run(usual, None)),
                )
