"""Probes of truncated lattices over long times, of the order of accuracy, of units, and of what is refused."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

import fracparticles as fp
from fracparticles.run.solution import relative_l1_error
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.probe import EPS, REFUSED, Kind, Probe, off
from scenes.extremes.long_and_short_times.runs import run_of

_SMALL: dict[str, Any] = {"half_width": 10.0, "spacing": 0.2}
_SERIES: dict[str, Any] = {"integrator": "exponential"}
_OPEN: dict[str, Any] = {"exterior": "open", **_SERIES}


def probes(betas: list[float]) -> Iterator[Probe]:
    """All of them."""
    yield from _truncated(betas)
    kept = Kind("truncated", "spoken of: u_0 kept", 0.05, "the fundamental solution")
    yield kept("GPSE, one step, D = 4 widths, beta = 0.9, t_f / t_0 = 1e+03", _kept, 1e3)
    falls = Kind("order", "the error (48) falls 4 times", 0.4, "order of the kernels")
    for beta, scheme in product((0.01, 0.99), ("DD", "FPSE", "KPSE")):
        name = f"{scheme}, order 2, open, beta = {beta:g}, h = 0.1 and 0.05"
        yield falls(name, _fourfold, scheme, beta)
    for beta, unit, scheme in product(betas, (1e-12, 1e12, 1e-75, 1e75), ("DD", "FPSE", "KPSE")):
        # The units round ln t, as in t^(1/alpha), and the series 40 of T |lambda|.
        rounded = 64.0 * EPS * (40.0 + abs(np.log(unit)))
        name = f"{scheme}, open, beta = {beta:g}, t_0 = {unit:.0e}"
        same = Kind("units", "the run at t_0 = 1, scaled", rounded)
        yield same(name, _scaled, scheme, beta, unit)
    yield from _refused()


def _truncated(betas: list[float]) -> Iterator[Probe]:
    """At 10^4 times the time of the slowest mode; the series rounds T |lambda|, some 10^5, of the first strengths."""
    mean = Kind("truncated", "the mean of the data", 1e-7, "conservation, symmetry")
    decayed = Kind("truncated", "its modes, decayed", 1e-7, "dense eigenvalues")
    for beta in betas:
        for scheme in ("DPSE", "KPSE"):
            yield mean(f"{scheme}, D = 10, beta = {beta:g}, t_f = 1e5", _mean, scheme, beta, 1e5)
        for t in (10.5, 100.5):
            yield decayed(f"DD, D = 10, beta = {beta:g}, t_f = {t:g}", _modes, beta, t)


def _mean(scheme: str, beta: float, t: float) -> float:
    """A closed lattice comes to the mean of its strengths: conservative and symmetric, or a product of two such."""
    run = run_of(scheme=scheme, beta=beta, t_final=t, **_SERIES, **_SMALL)
    return off(run.u / run.u0.mean(), 1.0)


def _modes(beta: float, t: float) -> float:
    """DD leaks as its modes decay."""
    run = run_of(scheme="DD", beta=beta, t_final=t, **_SERIES, **_SMALL)
    values, modes = np.linalg.eigh(scheme_matrix("DD", run.case.setting))
    return off(run.u, modes @ (np.exp(run.case.span * values) * (modes.T @ run.u0)))


def _kept(ratio: float) -> float:
    """GPSE in one step, truncated: each particle keeps what it would have given to places beyond D = 4 widths."""
    lattice = {"half_width": 4.0 * ratio ** (1.0 / 1.9), "spacing": 0.25}
    times = {"dt": ratio - 1.0, "t_initial": 1.0, "t_final": ratio}
    run = run_of(scheme="GPSE", beta=0.9, **lattice, **times)
    return off(run.u, fp.green(run.x, ratio, 1.9))


def _fourfold(scheme: str, beta: float) -> float:
    fields = {"scheme": scheme, "beta": beta, "half_width": 60.0, **_OPEN}
    runs = (run_of(spacing=h, **fields) for h in (0.1, 0.05))
    coarse, fine = (relative_l1_error(run.case, run.u) for run in runs)
    return abs(coarse / fine - 4.0)


def _scaled(scheme: str, beta: float, unit: float) -> float:
    """Lengths times c and times times c^alpha leave c u."""

    def final(length: float, time: float) -> np.ndarray:
        fields = {"half_width": 20.0 * length, "spacing": 0.2 * length}
        fields |= {"t_initial": time, "t_final": 3.0 * time}
        return run_of(scheme=scheme, beta=beta, **_OPEN, **fields).u

    length = unit ** (1.0 / (1.0 + beta))
    return off(final(length, unit) * length, final(1.0, 1.0))


def _refused() -> Iterator[Probe]:
    """Times that no lattice holds, times that are none, and steps that no Green's function is resolved by."""
    x = np.linspace(-10.0, 10.0, 101)
    u = np.exp(-x * x)
    kpse: dict[str, Any] = {"scheme": "KPSE", "beta": 0.5, **_SMALL, **_SERIES}
    gpse: dict[str, Any] = {"scheme": "GPSE", "beta": 0.5, **_SMALL}
    yield from Kind("refused", must=REFUSED).of(
        {
            "evolve, time 1e12 on |x| < 10": lambda: fp.evolve(u, 0.2, 1.5, 1e12),
            "evolve, time 1e-300": lambda: fp.evolve(u, 0.2, 1.5, 1e-300),
            "evolve, time -1": lambda: fp.evolve(u, 0.2, 1.5, -1.0),
            "evolve, time 1e300": lambda: fp.evolve(u, 0.2, 1.5, 1e300),
            "WholeSpace, scaled time 1e12, 101 points": lambda: fp.WholeSpace(101, 1, 1.5, 1e12),
            "WholeSpace, scaled time inf": lambda: fp.WholeSpace(101, 1, 1.5, np.inf),
            "green, t = 0": lambda: fp.green(1.0, 0.0, 1.5),
            "green, t = inf": lambda: fp.green(1.0, np.inf, 1.5),
            "KPSE, t_f = t_0": lambda: fp.Case(t_initial=1.0, t_final=1.0, **kpse),
            "KPSE, t_f < t_0": lambda: fp.Case(t_initial=2.0, t_final=1.0, **kpse),
            "KPSE, t_f = 1e101": lambda: fp.Case(t_final=1e101, **kpse),
            "KPSE, series, t_f = 1e16": lambda: run_of(t_final=1e16, **kpse),
            "KPSE, t_0 = 0, no data": lambda: run_of(t_initial=0.0, t_final=1.0, **kpse),
            "GPSE, one step, epsilon / h = 1e6": lambda: fp.Case(t_final=1e9, dt=1e9, **gpse),
            "graded, time 0": lambda: fp.green_step_of_field(101, 10.0, 1.0, 1.5, 0.0),
        }
    )
