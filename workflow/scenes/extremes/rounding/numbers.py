"""What a number goes through: kinds of input, sums, files, tables, the arithmetic itself."""

from collections.abc import Callable, Iterator
from math import fsum, log2
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import mpmath
import numpy as np
import pandas as pd

import fracparticles as fp
from fracparticles.arguments import operand, real_array
from fracparticles.run.case import Case
from fracparticles.run.solver import compute, prepare
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.inputs import write_table
from fracstudy.probe import EPS, HELD, REFUSED, Kind, Probe, off
from scenes.extremes.dense import whole

_FIELDS: dict[str, Any] = {"beta": 0.5, "half_width": 5.0, "t_initial": 0.5}
_FIELDS["integrator"] = "exponential"
_SAME = Kind("type", "the bits of float64", must=HELD)


def kinds() -> Iterator[Probe]:
    """Strengths of other types and layouts: widened, the same bits as those of their values in float64; or refused."""
    case = Case(scheme="KPSE", spacing=0.25, **_FIELDS)
    u0 = np.random.default_rng(3).uniform(-1.0, 1.0, case.shape)
    for name, given in {
        "float32": u0.astype(np.float32),
        "float16": u0.astype(np.float16),
        "longdouble": u0.astype(np.longdouble),
        "int8": np.rint(100 * u0).astype(np.int8),
        "uint64": np.rint(100 * np.abs(u0)).astype(np.uint64),
        "big-endian float64": u0.astype(">f8"),
        "a stride of three": np.repeat(u0, 3)[::3],
        "a negative stride": u0[::-1].copy()[::-1],
        "read-only": np.frombuffer(u0.tobytes()),
    }.items():
        yield _SAME(f"strengths of {name}", _other_bits, case, given)
    refused = Kind("type", must=REFUSED)
    for name, given in {
        "complex": np.ones(case.shape, complex),
        "bool": np.ones(case.shape, bool),
        "text": np.ones(case.shape, str),
        "object": np.ones(case.shape, object),
        "a longdouble beyond float64": u0.astype(np.longdouble) * np.longdouble("1e4000"),
    }.items():
        yield refused(f"strengths of {name}", fp.solve, case, given)


def _other_bits(case: Case, given: np.ndarray) -> float:
    """Zero if all that takes strengths gives the bits that it gives for their values, and leaves them as they are."""
    before, ready = given.copy(), prepare(case)
    assert ready.operator is not None
    takers = [lambda u: fp.solve(case, u).u.values, ready.solve, ready.operator.apply]
    right = np.array(given, dtype=float)
    same = all(taker(given).tobytes() == taker(right).tobytes() for taker in takers)
    return float(not (same and given.tobytes() == before.tobytes()))


def functions() -> Iterator[Probe]:
    """Public functions of float32: the value at the number in float64, not one of single precision."""
    x = np.linspace(-3.0, 3.0, 31).astype(np.float32)
    narrow = x, np.float32(0.7), np.float32(1.3)
    wide = x.astype(float), float(narrow[1]), float(narrow[2])
    functions: dict[str, Callable[..., Any]] = {
        "green": lambda x, t, a: fp.green(x, t, a),
        "green_flux": lambda x, t, a: fp.green_flux(x, t, a),
        "green_rate": lambda x, t, a: fp.green_rate(x, t, a),
        "kernel eta": lambda x, t, a: fp.kernel("eta", x, a),
        "kernel G": lambda x, t, a: fp.kernel("G", x, a),
        "evolve": lambda x, t, a: fp.evolve(np.exp(-(x.astype(float) ** 2)), 0.2, a, t),
    }
    for name, function in functions.items():
        other = lambda: float(not np.array_equal(function(*narrow), function(*wide)))
        yield _SAME(f"{name} of float32", other)
    third = np.array([1.0 / 3.0], dtype=np.float32)
    # The number in single precision next to a third is 11184811 / 2^25.
    exact = Kind("type", "11184811 / 2^25", 0.0, "IEEE 754", HELD)
    for kept in (real_array("x", third), operand("x", third, (1,))):
        yield exact("a third as float32", off, kept, 11184811.0 / 2.0**25, 1.0)


def sums(particles: int) -> Iterator[Probe]:
    """Sums of terms of both signs: round-off is eps N sum |w u| by loops, eps 8 log2(N) |w| |u| by transforms."""
    fields = {"spacing": 10.0 / (particles - 1), **_FIELDS}
    rng, count = np.random.default_rng(5), np.arange(particles)
    data = {"one size": rng.uniform(-1.0, 1.0, particles)}
    signs = rng.choice([-1.0, 1.0], particles)
    data["sizes 1e-8 to 1e8"] = signs * 10.0 ** rng.uniform(-8.0, 8.0, particles)
    data["cancelling"] = np.where(count % 2, -1.0, 1.0) * (1.0 + 1e-12 * count)
    rows = rng.choice(particles, 5, replace=False)
    within = Kind("sum", "mpmath.fdot, in units of its bound", 1.0, "mpmath", HELD)
    for scheme in ("DD", "KPSE"):
        case = Case(scheme=scheme, **fields)
        sums = {
            name: SCHEMES[scheme].operator(Case(scheme=scheme, summation=name, **fields).setting)
            for name in ("fft", "naive")
        }
        weights = np.array([sums["naive"].apply(unit)[rows] for unit in np.eye(particles)]).T
        for what, u in data.items():
            exact = np.array([float(mpmath.fdot(row, u)) for row in weights.tolist()])
            largest = np.linalg.norm(weights, axis=1) * np.linalg.norm(u)
            scales = {
                "fft": EPS * (largest * 8.0 * log2(particles)),
                "naive": EPS * (np.abs(weights) @ np.abs(u) * particles),
            }
            for name, operator in sums.items():
                yield within(
                    f"{scheme}, {case.particles} particles, {what}, {name}",
                    lambda: float(np.max(np.abs(operator.apply(u)[rows] - exact) / scales[name])),
                )
    case = Case(scheme="KPSE", **fields)
    h = case.particle_spacing
    for what, u in data.items():
        bound = EPS * (16.0 + log2(particles)) * float(np.abs(u).sum()) * h
        right = Kind("sum", "math.fsum, pairwise", bound, "math.fsum", HELD)
        name = f"mass of {particles} particles, {what}"
        yield right(name, lambda: abs(case.integral(u) - h * fsum(u)))


def series() -> Iterator[Probe]:
    """exp(A T) u0 of 17 particles against 50 digits: round-off T |A| eps times the condition of the modes of A."""
    within = Kind("series", "exp(A T) u0, in units of (10 + T |A|) eps", 1.0, "mpmath", HELD)
    fields = {"beta": 0.5, "half_width": 4.0, "spacing": 0.5, "integrator": "exponential"}
    for scheme in ("DD", "FPSE", "KPSE"):
        cases = [Case(scheme=scheme, t_final=0.5 + span, **fields) for span in (1.0, 1e3, 1e6)]
        flows = _exponentials(scheme_matrix(scheme, cases[0].setting))
        for case, flow in zip(cases, flows, strict=True):
            name = f"{scheme}, 17 particles, T = {case.span:.0e}"
            yield within(name, _of_series, case, flow)


def _exponentials(matrix: np.ndarray) -> list[mpmath.matrix]:
    """exp(A), exp(A)^1000 and that^1000 with 60 digits, of which the powers lose six."""
    with mpmath.workdps(60):
        flow = mpmath.expm(mpmath.matrix(matrix.tolist()))
        longer = flow**1000
        return [flow, longer, longer**1000]


def _of_series(case: Case, flow: mpmath.matrix) -> float:
    u0, matrix = np.linspace(1.0, 2.0, 17), scheme_matrix(case.scheme, case.setting)
    with mpmath.workdps(50):
        exact = np.array([float(one) for one in flow * mpmath.matrix(u0.tolist())])
    condition = float(np.linalg.cond(np.linalg.eig(matrix)[1]))  # 1 if A is symmetric
    stiffness = case.span * float(np.abs(matrix).sum(axis=1).max()) * condition
    return off(prepare(case).solve(u0), exact, np.abs(u0).max()) / (EPS * (10.0 + stiffness))


def kept() -> Iterator[Probe]:
    """Numbers at the ends of the range, written and read: the same bits."""
    ends = [5e-324, 2.2250738585072014e-308, 1.7976931348623157e308]
    numbers = np.array([0.1, -0.0, *ends, 1.0 + EPS, np.pi])
    same = Kind("kept", "the same bits", must=HELD)
    lattice = {"half_width": 5.0 + 1e-15, "spacing": 0.25, "integrator": "exponential"}
    case = Case(scheme="KPSE", beta=0.1 + 0.2, **lattice)
    with TemporaryDirectory() as name:
        folder = Path(name)
        run = fp.solve(case).assign(odd=("i", numbers))

        def file() -> float:
            fp.write(run, folder / "run.nc")
            read = fp.read_run(folder / "run.nc")
            return float(read.odd.values.tobytes() != numbers.tobytes() or not read.identical(run))

        def table() -> float:
            write_table(pd.DataFrame({"x": numbers}), folder / "x.csv")
            read = pd.read_csv(folder / "x.csv", float_precision="round_trip")["x"].to_numpy()
            return float(read.tobytes() != numbers.tobytes())

        yield same("a NetCDF file, 5e-324 to 1.8e308, -0", file)
        yield same("a table, 5e-324 to 1.8e308, -0", table)
    again = Kind("kept", "the same case", must=HELD)
    yield again("a case as JSON", lambda: float(Case.from_json(case.to_json()) != case))


def arithmetic() -> Iterator[Probe]:
    """What a library that is loaded may switch off for all: numbers below the normal ones, and rounding to nearest."""
    compute(Case(scheme="DVM", beta=0.5, half_width=5.0, spacing=0.5, dt=0.05, t_final=0.6))
    least, one = np.float64(2.2250738585072014e-308), np.float64(1.0)
    normal = Kind("arithmetic", "not flushed to zero", 0.0, "IEEE 754", HELD)
    yield normal("half of the least normal number", lambda: float(least / 2.0 * 2.0 != least))
    wrong = lambda: float(one + EPS / 2.0 != 1.0 or one + 1.5 * EPS != 1.0 + 2.0 * EPS)
    yield normal("1 + eps / 2 and 1 + 3 eps / 2", wrong, expected="rounded to even")
    case = Case(scheme="KPSE", spacing=0.25, **_FIELDS)
    u0 = np.full(case.shape, 3e-310)
    exact = whole(case) @ np.full(u0.size, 3.0)
    bound, expected = 5e-324 * 1e300 * 1e10 + 1e-12, "to the 5e-324 that they have"
    yield Kind("arithmetic", expected, bound, "scipy", HELD)(
        "strengths of 3e-310", lambda: off(compute(case, u0).u * 1e300 * 1e10, exact, 1.0)
    )
