"""Probes of truncated lattices over long times, of the order of accuracy, of units, and of what is refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

import fracparticles as fp
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import dense_matrix
from fracstudy.probe import EPS, REFUSED, Kind, Probe

__all__ = ["probes"]

_SMALL: dict[str, Any] = {"half_width": 10.0, "spacing": 0.2}


def _run(**fields: Any) -> Any:
    return compute(fp.Case(store="metrics", **fields))


def _mean(scheme: str, beta: float, t: float) -> float:
    """A closed lattice comes to the mean of its strengths: conservative and symmetric, or a product of two such."""
    run = _run(scheme=scheme, beta=beta, t_final=t, integrator="exponential", **_SMALL)
    return float(np.abs(run.u / run.u0.mean() - 1.0).max())


def _modes(beta: float, t: float) -> float:
    """DD leaks as its modes decay."""
    run = _run(scheme="DD", beta=beta, t_final=t, integrator="exponential", **_SMALL)
    values, modes = np.linalg.eigh(dense_matrix(SCHEMES["DD"].operator(run.case.setting)))
    exact = modes @ (np.exp(run.case.span * values) * (modes.T @ run.u0))
    return float(np.abs(run.u - exact).max() / np.abs(exact).max())


def _truncated(betas: list[float]) -> Iterator[Probe]:
    """At 10^4 times the time of the slowest mode; the series rounds T |lambda|, some 10^5, of the first strengths."""
    truncated = Kind("truncated", "its modes, decayed", 1e-7, "dense eigenvalues")
    for beta in betas:
        for scheme in ("DPSE", "KPSE"):
            yield truncated(
                f"{scheme}, D = 10, beta = {beta:g}, t_f = 1e5",
                _mean,
                scheme,
                beta,
                1e5,
                expected="the mean of the data",
                source="conservation, symmetry",
            )
        for t in (10.5, 100.5):
            yield truncated(f"DD, D = 10, beta = {beta:g}, t_f = {t:g}", _modes, beta, t)


def _kept(ratio: float) -> float:
    """GPSE in one step, truncated: each particle keeps what it would have given to places beyond D = 4 widths."""
    half = 4.0 * ratio ** (1.0 / 1.9)
    run = _run(
        scheme="GPSE",
        beta=0.9,
        half_width=half,
        spacing=0.25,
        dt=ratio - 1.0,
        t_initial=1.0,
        t_final=ratio,
    )
    exact = np.asarray(fp.green(run.x, ratio, 1.9))
    return float(np.abs(run.u - exact).max() / exact.max())


def _fourfold(scheme: str, beta: float) -> float:
    fields = {
        "scheme": scheme,
        "beta": beta,
        "half_width": 60.0,
        "exterior": "open",
        "integrator": "exponential",
    }
    runs = [_run(spacing=h, **fields) for h in (0.1, 0.05)]
    errors = [relative_l1_error(run.case, run.u) for run in runs]
    return abs(errors[0] / errors[1] - 4.0)


def _scaled(scheme: str, beta: float, unit: float) -> float:
    """Lengths times c and times times c^alpha leave c u."""
    fields = {"scheme": scheme, "beta": beta, "exterior": "open", "integrator": "exponential"}
    length = unit ** (1.0 / (1.0 + beta))
    one = _run(half_width=20.0, spacing=0.2, t_initial=1.0, t_final=3.0, **fields).u
    other = _run(
        half_width=20.0 * length, spacing=0.2 * length, t_initial=unit, t_final=3.0 * unit, **fields
    ).u
    return float(np.abs(other * length - one).max() / one.max())


def _accepted(call: Callable[[], Any]) -> float:
    call()
    return np.inf


def _refused() -> Iterator[Probe]:
    """Times that no lattice holds, that are no times, and steps that no Green's function is resolved by."""
    x = np.linspace(-10.0, 10.0, 101)
    u = np.exp(-x * x)
    case = {
        "scheme": "KPSE",
        "beta": 0.5,
        "half_width": 10.0,
        "spacing": 0.2,
        "integrator": "exponential",
    }
    gpse = {"scheme": "GPSE", "beta": 0.5, "half_width": 10.0, "spacing": 0.2}
    calls: dict[str, Callable[[], Any]] = {
        "evolve, time 1e12 on |x| < 10": partial(fp.evolve, u, 0.2, 1.5, 1e12),
        "evolve, time 0": partial(fp.evolve, u, 0.2, 1.5, 0.0),
        "evolve, time -1": partial(fp.evolve, u, 0.2, 1.5, -1.0),
        "evolve, time 1e300": partial(fp.evolve, u, 0.2, 1.5, 1e300),
        "WholeSpace, scaled time 1e12, 101 points": partial(fp.WholeSpace, 101, 1, 1.5, 1e12),
        "WholeSpace, scaled time inf": partial(fp.WholeSpace, 101, 1, 1.5, np.inf),
        "green, t = 0": partial(fp.green, 1.0, 0.0, 1.5),
        "green, t = inf": partial(fp.green, 1.0, np.inf, 1.5),
        "KPSE, t_f = t_0": partial(fp.Case, t_initial=1.0, t_final=1.0, **case),
        "KPSE, t_f < t_0": partial(fp.Case, t_initial=2.0, t_final=1.0, **case),
        "KPSE, t_f = 1e101": partial(fp.Case, t_final=1e101, **case),
        "KPSE, series, t_f = 1e16": lambda: compute(fp.Case(t_final=1e16, **case)),
        "KPSE, t_0 = 0, no data": lambda: compute(fp.Case(t_initial=0.0, t_final=1.0, **case)),
        "GPSE, one step, epsilon / h = 1e6": partial(fp.Case, t_final=1e9, dt=1e9, **gpse),
        "graded, time 0": partial(fp.green_step_of_field, 101, 10.0, 1.0, 1.5, 0.0),
    }
    refused = Kind("refused", must=REFUSED)
    for name, call in calls.items():
        yield refused(name, _accepted, call)


def probes(betas: list[float], ratios: list[float]) -> Iterator[Probe]:
    """All of them."""
    yield from _truncated(betas)
    yield Kind("truncated", "spoken of: u_0 kept", 0.05, "the fundamental solution")(
        "GPSE, one step, D = 4 widths, beta = 0.9, t_f / t_0 = 1e+03", _kept, 1e3
    )
    order = Kind("order", "the error (48) falls 4 times", 0.4, "order of the kernels")
    for beta in (0.01, 0.99):
        for scheme in ("DD", "FPSE", "KPSE"):
            yield order(
                f"{scheme}, order 2, open, beta = {beta:g}, h = 0.1 and 0.05",
                _fourfold,
                scheme,
                beta,
            )
    units = Kind("units", "the run at t_0 = 1, scaled")
    for beta in betas:
        for unit in (1e-12, 1e12, 1e-75, 1e75):
            for scheme in ("DD", "FPSE", "KPSE"):
                # The units round ln t, as in t^(1/alpha), and the series 40 of T |lambda|.
                yield units(
                    f"{scheme}, open, beta = {beta:g}, t_0 = {unit:.0e}",
                    _scaled,
                    scheme,
                    beta,
                    unit,
                    bound=64.0 * EPS * (40.0 + abs(np.log(unit))),
                )
    yield from _refused()
