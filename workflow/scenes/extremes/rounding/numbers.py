"""What a number goes through: kinds of input, sums, files, tables, the arithmetic itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import fsum, log2
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import mpmath
import numpy as np
import pandas as pd
from scipy.linalg import expm

import fracparticles as fp
from fracparticles.arguments import operand, real_array
from fracparticles.run.case import Case
from fracparticles.run.solver import compute, prepare
from fracparticles.schemes import SCHEMES
from fracstudy.inputs import write_table
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe

__all__ = ["probes"]

_FIELDS: dict[str, Any] = {
    "beta": 0.5,
    "half_width": 5.0,
    "integrator": "exponential",
    "t_initial": 0.5,
}
HELD, REFUSED = HELD, REFUSED


def probes(particles: int) -> Iterator[Probe]:
    """All of them; the lattices of sums have so many particles."""
    yield from _kinds()
    yield from _functions()
    yield from _sums(particles)
    yield from _series()
    yield from _kept()
    yield from _arithmetic()


def _kinds() -> Iterator[Probe]:
    """Strengths of other types and layouts: widened, the same bits as those of their values in float64; or refused."""
    case = Case(scheme="KPSE", spacing=0.25, **_FIELDS)
    u0 = np.random.default_rng(3).uniform(-1.0, 1.0, case.shape)
    spaced = np.repeat(u0, 3)[::3]
    written = u0.copy()
    written.flags.writeable = False
    rows_type = Kind("type", must=HELD)
    for name, given in {
        "float32": u0.astype(np.float32),
        "float16": u0.astype(np.float16),
        "longdouble": u0.astype(np.longdouble),
        "int8": np.rint(100 * u0).astype(np.int8),
        "uint64": np.rint(100 * np.abs(u0)).astype(np.uint64),
        "big-endian float64": u0.astype(">f8"),
        "a stride of three": spaced,
        "a negative stride": u0[::-1].copy()[::-1],
        "read-only": written,
    }.items():
        yield rows_type(
            f"strengths of {name}", _other_bits, case, given, expected="the bits of float64"
        )
    bad = {
        "complex": np.ones(case.shape, complex),
        "bool": np.ones(case.shape, bool),
        "text": np.ones(case.shape, str),
        "object": np.ones(case.shape, object),
        "a longdouble beyond float64": u0.astype(np.longdouble) * np.longdouble("1e4000"),
    }
    for name, given in bad.items():
        yield rows_type(f"strengths of {name}", _solved, case, given, must=REFUSED)


def _solved(case: Case, given: np.ndarray) -> float:
    fp.solve(case, given)
    return np.nan


def _other_bits(case: Case, given: np.ndarray) -> float:
    """Zero if all that takes strengths gives the bits that it gives for their values, and leaves them as they are."""
    before, ready = given.copy(), prepare(case)
    assert ready.operator is not None
    takers = [lambda u: fp.solve(case, u).u.values, ready.solve, ready.operator.apply]
    right = np.array(given, dtype=float)
    same = all(taker(given).tobytes() == taker(right).tobytes() for taker in takers)
    return float(not (same and given.tobytes() == before.tobytes()))


def _functions() -> Iterator[Probe]:
    """Public functions of float32: the value at the number in float64, not one of single precision."""
    x = np.linspace(-3.0, 3.0, 31).astype(np.float32)
    time, alpha = np.float32(0.7), np.float32(1.3)
    functions: dict[str, Callable[..., Any]] = {
        "green": lambda x, t, a: fp.green(x, t, a),
        "green_flux": lambda x, t, a: fp.green_flux(x, t, a),
        "green_rate": lambda x, t, a: fp.green_rate(x, t, a),
        "kernel eta": lambda x, t, a: fp.kernel("eta", x, a),
        "kernel G": lambda x, t, a: fp.kernel("G", x, a),
        "evolve": lambda x, t, a: fp.evolve(np.exp(-(x.astype(float) ** 2)), 0.2, a, t),
    }
    narrow, wide = (x, time, alpha), (x.astype(float), float(time), float(alpha))
    rows_type = Kind("type", "11184811 / 2^25", must=HELD)
    for name, function in functions.items():
        yield rows_type(
            f"{name} of float32", _unlike, function, narrow, wide, expected="the bits of float64"
        )
    third = np.array([1.0 / 3.0], dtype=np.float32)
    for kept in (real_array("x", third), operand("x", third, (1,))):
        # The number in single precision next to a third is 11184811 / 2^25.
        yield rows_type(
            "a third as float32",
            _apart,
            kept,
            np.array([11184811.0 / 2.0**25]),
            np.ones(1),
            source="IEEE 754",
        )


def _unlike(function: Callable[..., Any], narrow: Any, wide: Any) -> float:
    return float(not np.array_equal(function(*narrow), function(*wide)))


def _apart(found: Any, exact: Any, scale: Any) -> float:
    """The greatest difference, in units of a scale."""
    return float(np.max(np.abs(found - exact) / scale))


def _sums(particles: int) -> Iterator[Probe]:
    """Sums of terms of both signs: round-off is eps N sum |w u| by loops, eps 8 log2(N) |w| |u| by transforms."""
    half, h = particles // 2, 10.0 / (particles - 1)
    rng = np.random.default_rng(5)
    data = {
        "one size": rng.uniform(-1.0, 1.0, particles),
        "sizes 1e-8 to 1e8": rng.choice([-1.0, 1.0], particles)
        * 10.0 ** rng.uniform(-8.0, 8.0, particles),
        "cancelling": np.tile([1.0, -1.0], half + 1)[:particles]
        * (1.0 + 1e-12 * np.arange(particles)),
    }
    rows = rng.choice(particles, 5, replace=False)
    rows_sum = Kind("sum", "mpmath.fdot, in units of its bound", source="math.fsum", must=HELD)
    for scheme in ("DD", "KPSE"):
        case = Case(scheme=scheme, spacing=h, **_FIELDS)
        sums = {
            name: SCHEMES[scheme].operator(
                Case(scheme=scheme, spacing=h, summation=name, **_FIELDS).setting
            )
            for name in ("fft", "naive")
        }
        weights = np.array([sums["naive"].apply(unit)[rows] for unit in np.eye(particles)]).T
        for what, u in data.items():
            exact = np.array(
                [float(mpmath.fdot(map(mpmath.mpf, row), map(mpmath.mpf, u))) for row in weights]
            )
            size = np.abs(weights) @ np.abs(u)
            largest = np.linalg.norm(weights, axis=1) * np.linalg.norm(u)
            for name, operator in sums.items():
                scale = largest * 8.0 * log2(particles) if name == "fft" else size * particles
                yield rows_sum(
                    f"{scheme}, {case.particles} particles, {what}, {name}",
                    _apart,
                    operator.apply(u)[rows],
                    exact,
                    EPS * scale,
                    bound=1.0,
                    source="mpmath",
                )
    for what, u in data.items():
        case = Case(scheme="KPSE", spacing=h, **_FIELDS)
        bound = EPS * (16.0 + log2(particles)) * float(np.abs(u).sum()) * case.particle_spacing
        whole = case.particle_spacing * fsum(u)
        yield rows_sum(
            f"mass of {particles} particles, {what}",
            _apart,
            case.integral(u),
            whole,
            1.0,
            expected="math.fsum, pairwise",
            bound=bound,
        )


def _series() -> Iterator[Probe]:
    """exp(A T) u0 of 17 particles against 50 digits: round-off T |A| eps times the condition of the modes of A."""
    series = Kind("series", "exp(A T) u0, in units of (10 + T |A|) eps", 1.0, "mpmath", HELD)
    for scheme in ("DD", "FPSE", "KPSE"):
        for span in (1.0, 1e3, 1e6):
            case = Case(
                scheme=scheme,
                beta=0.5,
                half_width=4.0,
                spacing=0.5,
                integrator="exponential",
                t_final=0.5 + span,
            )
            u0 = np.linspace(1.0, 2.0, 17)

            def run(case: Case = case, u0: np.ndarray = u0) -> float:
                ready = prepare(case)
                assert ready.operator is not None
                matrix = np.array([ready.operator.apply(unit) for unit in np.eye(17)]).T
                with mpmath.workdps(50):
                    exact = mpmath.expm(
                        mpmath.matrix(matrix.tolist()) * mpmath.mpf(case.span)
                    ) * mpmath.matrix(u0.tolist())
                    exact = np.array([float(one) for one in exact])
                condition = float(np.linalg.cond(np.linalg.eig(matrix)[1]))  # 1 if A is symmetric
                stiffness = case.span * float(np.abs(matrix).sum(axis=1).max()) * condition
                return float(
                    np.abs(ready.solve(u0) - exact).max()
                    / np.abs(u0).max()
                    / (EPS * (10.0 + stiffness))
                )

            yield series(f"{scheme}, 17 particles, T = {span:.0e}", run)


def _kept() -> Iterator[Probe]:
    """Numbers at the ends of the range, written and read: the same bits."""
    numbers = np.array(
        [0.1, -0.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 1.0 + EPS, np.pi]
    )
    rows_kept = Kind("kept", "the same bits", must=HELD)
    with TemporaryDirectory() as name:
        folder = Path(name)
        case = Case(
            scheme="KPSE",
            beta=0.1 + 0.2,
            half_width=5.0 + 1e-15,
            spacing=0.25,
            integrator="exponential",
        )
        run = fp.solve(case)
        run = run.assign(odd=("i", numbers))

        def file() -> float:
            fp.write(run, folder / "run.nc")
            read = fp.read_run(folder / "run.nc")
            return float(read.odd.values.tobytes() != numbers.tobytes() or not read.identical(run))

        def table() -> float:
            write_table(pd.DataFrame({"x": numbers}), folder / "x.csv")
            read = pd.read_csv(folder / "x.csv", float_precision="round_trip")["x"].to_numpy()
            return float(read.tobytes() != numbers.tobytes())

        ends = "5e-324 to 1.8e308, -0"
        yield rows_kept(f"a NetCDF file, {ends}", file)
        yield rows_kept(f"a table, {ends}", table)
        yield rows_kept(
            "a case as JSON",
            lambda: float(Case.from_json(case.to_json()) != case),
            expected="the same case",
        )


def _arithmetic() -> Iterator[Probe]:
    """What a library that is loaded may switch off for all: numbers below the normal ones, and rounding to nearest."""
    compute(Case(scheme="DVM", beta=0.5, half_width=5.0, spacing=0.5, dt=0.05, t_final=0.6))
    least = np.float64(2.2250738585072014e-308)
    arithmetic = Kind("arithmetic", source="IEEE 754", must=HELD)
    yield arithmetic(
        "half of the least normal number",
        float,
        least / 2.0 * 2.0 != least,
        expected="not flushed to zero",
    )
    yield arithmetic(
        "1 + eps / 2 and 1 + 3 eps / 2",
        float,
        (1.0 + EPS / 2.0 != 1.0) or (1.0 + 1.5 * EPS != 1.0 + 2.0 * EPS),
        expected="rounded to even",
    )
    case = Case(scheme="KPSE", spacing=0.25, **_FIELDS)
    u0 = np.full(case.shape, 3e-310)
    operator = prepare(case).operator
    assert operator is not None
    matrix = np.array([operator.apply(unit) for unit in np.eye(u0.size)]).T
    exact = expm(matrix * case.span) @ np.full(u0.size, 3.0)
    yield arithmetic(
        "strengths of 3e-310",
        lambda: float(np.abs(compute(case, u0).u * 1e300 * 1e10 - exact).max()),
        expected="to the 5e-324 that they have",
        bound=5e-324 * 1e300 * 1e10 + 1e-12,
        source="scipy",
    )
