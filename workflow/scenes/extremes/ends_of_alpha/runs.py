"""Probes of runs: on the whole space, and with the open exterior of the lattice."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

import fracparticles as fp
from fracparticles.run.solver import compute
from fracstudy.probe import HELD, Kind, Probe, off
from scenes.extremes.ends_of_alpha.references import distance, written

TIME = 0.5

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
    return off(fp.evolve(start, h, 1.0 + beta, 1.0, terms=terms), end)


def compute_at(beta: float, **fields: Any) -> Any:
    """Run a case over the time of these probes."""
    return compute(fp.Case(beta=beta, store="metrics", t_final=0.5 + TIME, **fields))


def _limit(beta: float) -> str:
    return "the solution of Cauchy" if beta < 0.5 else "the Gaussian"


def whole_space(near: list[float], dims: list[int]) -> Iterator[Probe]:
    """The limits themselves are the data and the solution: they differ from those of alpha by its distance, times 5.

    Near 1 the terms that are left out fall like (t / D)^(3 + n) on the line, 1e-7 of the peak and less, and the lattice
    does not hold waves of pi / h, exp(-pi / h) each. Near 2 the Gaussian at the ends, exp(-D^2 / 8), is 3e-4 in space.
    """
    for beta, dim in product(near, dims):
        points, half_width = _LATTICES[dim]
        h = 2.0 * half_width / points
        bound = 4.0 * (2.0 / half_width) ** (3.0 + dim) + 40.0 * dim * np.exp(-2.0 * np.pi / h)
        bound = bound if beta < 0.5 else 4.0 * np.exp(-(half_width**2) / 8.0)
        bound = bound + 5.0 * distance(beta) + 1e-13
        right = Kind("whole space", _limit(beta), bound, "closed form", HELD)
        for terms in (1, 2, 6):
            name = f"evolve, n = {dim}, {terms} terms, {written(beta)}"
            yield right(name, evolved, beta, dim, terms)


def open_exterior(near: list[float], dims: list[int]) -> Iterator[Probe]:
    """GPSE in one step, open: exact but for its quadrature, exp(-pi t / h), and the far field, (t / D)^3 of its own."""
    lattices = [one for one in ((1, 40.0, 0.1), (2, 12.0, 0.15)) if one[0] in dims]
    for beta, (dim, half_width, h) in product(near, lattices):
        far, waves = 8.0 * half_width**-3.0, 4.0 * dim * np.exp(-0.5 * np.pi / h)
        bound = 5.0 * distance(beta) + far + waves
        right = Kind("open exterior", _limit(beta), bound, "closed form")
        case = f"GPSE, one step, n = {dim}, {written(beta)}"
        yield right(case, _one_step, beta, dim, half_width, h)


def _one_step(beta: float, dim: int, half_width: float, h: float) -> float:
    lattice = {"dim": dim, "half_width": half_width, "spacing": h, "exterior": "open"}
    run = compute_at(beta, scheme="GPSE", dt=TIME, **lattice)
    return off(run.u, closed(run.case.radius, 0.5 + TIME, beta, dim))


def continuous(near: list[float], dims: list[int]) -> Iterator[Probe]:
    """Nothing happens at the end itself: the run at 10^-4 from it differs by that, times what a run differs by."""
    for beta, scheme, dim in product(near, ("DD", "FPSE", "KPSE"), dims):
        if distance(beta) > 1e-14:
            continue
        other = 1e-4 if beta < 0.5 else 1.0 - 1e-4
        # d ln u / d alpha is 6 at the peak in space
        same = Kind("open exterior", f"the run at {written(other)}", 1e-3)
        fields = {"scheme": scheme, "dim": dim, "exterior": "open", "integrator": "exponential"}
        fields |= {"half_width": 4.0, "spacing": 0.5}
        yield same(
            f"{scheme}, order 2, n = {dim}, {written(beta)}",
            lambda: off(compute_at(beta, **fields).u, compute_at(other, **fields).u),
        )
