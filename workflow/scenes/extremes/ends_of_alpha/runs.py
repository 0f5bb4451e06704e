"""Probes of runs: on the whole space, and with the open exterior of the lattice."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import fracparticles as fp
from fracparticles.run.solver import compute
from fracstudy.probe import HELD, Kind, Probe
from scenes.extremes.ends_of_alpha.names import distance, written

__all__ = ["closed", "evolved", "probes"]

_TIME = 0.5

_LATTICES = {1: (1024, 64.0), 2: (128, 16.0), 3: (48, 8.0)}


def lattice(dim: int) -> tuple[np.ndarray, float]:
    """Return |x| at the points, the centre off them, and the spacing."""
    points, half_width = _LATTICES[dim]
    h = 2.0 * half_width / points
    x = (np.arange(points) - points // 2) * h
    shifts = (0.3 * h, -0.4 * h, 0.2 * h)[:dim]
    axes = np.meshgrid(*(x,) * dim, indexing="ij", sparse=True)
    return np.sqrt(sum((axis - shift) ** 2 for axis, shift in zip(axes, shifts, strict=True))), h


def closed(r: np.ndarray, t: float, beta: float, dim: int) -> np.ndarray:
    """Return the solution of Cauchy, or of Gauss, at time t."""
    if beta < 0.5:
        constant = {1: 1.0 / np.pi, 2: 0.5 / np.pi, 3: 1.0 / np.pi**2}[dim]
        return constant * t * (t * t + r * r) ** (-0.5 * (dim + 1))
    return (4.0 * np.pi * t) ** (-0.5 * dim) * np.exp(-0.25 * r * r / t)


def evolved(beta: float, dim: int, terms: int) -> float:
    """Return the error of a run on the whole space from the limit at t = 1, relative to the peak of the limit."""
    r, h = lattice(dim)
    start, end = (closed(r, t, beta, dim) for t in (1.0, 2.0))
    u = fp.evolve(start, h, 1.0 + beta, 1.0, terms=terms)
    return float(np.abs(u - end).max() / end.max())


def _whole_space(betas: list[float], dims: list[int]) -> Iterator[Probe]:
    """The limits themselves are the data and the solution: they differ from those of alpha by its distance, times 5.

    Near 1 the terms that are left out fall like (t / D)^(3 + n) on the line, 1e-7 of the peak and less, and the lattice
    does not hold waves of pi / h, exp(-pi / h) each. Near 2 the Gaussian at the ends, exp(-D^2 / 8), is 3e-4 in space.
    """
    whole_space = Kind("whole space", source="closed form", must=HELD)
    for beta in betas:
        for dim in dims:
            points, half_width = _LATTICES[dim]
            h = 2.0 * half_width / points
            near = 4.0 * (2.0 / half_width) ** (3.0 + dim) + 40.0 * dim * np.exp(-2.0 * np.pi / h)
            bound = near if beta < 0.5 else 4.0 * np.exp(-(half_width**2) / 8.0)
            for terms in (1, 2, 6):
                yield whole_space(
                    f"evolve, n = {dim}, {terms} terms, {written(beta)}",
                    evolved,
                    beta,
                    dim,
                    terms,
                    expected="the solution of Cauchy" if beta < 0.5 else "the Gaussian",
                    bound=bound + 5.0 * distance(beta) + 1e-13,
                )


def _one_step(beta: float, dim: int, half_width: float, spacing: float) -> float:
    run = compute_at(
        beta,
        scheme="GPSE",
        dim=dim,
        half_width=half_width,
        spacing=spacing,
        dt=_TIME,
        exterior="open",
    )
    exact = closed(run.case.radius, 0.5 + _TIME, beta, dim)
    return float(np.abs(run.u - exact).max() / exact.max())


def _open(betas: list[float], dims: list[int]) -> Iterator[Probe]:
    """GPSE in one step, open: exact but for its quadrature, exp(-pi t / h), and the far field, (t / D)^3 of its own."""
    open_exterior = Kind("open exterior", source="closed form")
    for beta in betas:
        for dim, half_width, spacing in ((1, 40.0, 0.1), (2, 12.0, 0.15)):
            if dim not in dims:
                continue
            yield open_exterior(
                f"GPSE, one step, n = {dim}, {written(beta)}",
                _one_step,
                beta,
                dim,
                half_width,
                spacing,
                expected="the solution of Cauchy" if beta < 0.5 else "the Gaussian",
                bound=5.0 * distance(beta)
                + 8.0 * half_width**-3.0
                + 4.0 * dim * np.exp(-0.5 * np.pi / spacing),
            )


def _continuous(betas: list[float], dims: list[int]) -> Iterator[Probe]:
    """Nothing happens at the end itself: the run at 10^-4 from it differs by that, times what a run differs by."""
    open_exterior = Kind("open exterior", bound=1e-3)
    for beta in betas:
        other = 1e-4 if beta < 0.5 else 1.0 - 1e-4
        if distance(beta) > 1e-14:
            continue
        for scheme in ("DD", "FPSE", "KPSE"):
            for dim in dims:
                # d ln u / d alpha is 6 at the peak in space
                yield open_exterior(
                    f"{scheme}, order 2, n = {dim}, {written(beta)}",
                    _difference,
                    scheme,
                    dim,
                    beta,
                    other,
                    expected=f"the run at {written(other)}",
                )


def _difference(scheme: str, dim: int, beta: float, other: float) -> float:
    fields = {"scheme": scheme, "dim": dim, "half_width": 4.0, "spacing": 0.5, "exterior": "open"}
    u, v = (compute_at(b, integrator="exponential", **fields).u for b in (beta, other))
    return float(np.abs(u - v).max() / np.abs(v).max())


def compute_at(beta: float, **fields: Any) -> Any:
    """Run a case over the time of these probes."""
    return compute(fp.Case(beta=beta, store="metrics", t_final=0.5 + _TIME, **fields))


def probes(betas: list[float], dims: list[int]) -> Iterator[Probe]:
    """All of them, next to the ends."""
    betas = [beta for beta in betas if distance(beta) < 1e-4]
    yield from _whole_space(betas, dims)
    yield from _open(betas, dims)
    yield from _continuous(betas, dims)
