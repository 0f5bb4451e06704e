"""The error of the particles with frozen coefficients: the scheme beside the equation, both from the initial data.

If D and a are the same everywhere, both solutions are known wave by wave. In a time t a wave k is multiplied

    by the scheme with exp(t (D A^(k) - i a T^(k))),    by the equation with exp(-t (D |k|^alpha + i a k)).

A^ and T^ are the symbols of the diffusion and the transport. The equation starts from the data on a finer lattice
between the particles, so that a kink or a jump has its error from the first moment on. Half of the particles cannot
tell that error: for a time of about h^alpha they miss as much of the kink as all of them do, and the difference is
small. Before a jump has spread over a sample of this lattice, a particle beside it seems to feel it. So a function of x
with a kink or a jump has as many samples as the first output time needs.

Each place has the error for the nearest of five values of D. The velocity a is its mean weighted by |u|, and alpha is
the greatest order. The data are continued beyond the ends as in a mirror.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fracparticles.arguments import FloatArray
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.fewer_particles import among, halved
from fracparticles.problems.interpolants import interpolants, is_rough
from fracparticles.problems.problem import Problem
from fracparticles.problems.transport import Transport
from fracparticles.schemes import SCHEMES

__all__ = ["frozen_errors"]

_FINER = {1: 16, 2: 2}  # samples between two particles, the least number
_SAMPLES = 2**18  # on the line, the most of all
_LEVELS = 5  # values of D, from its least to its greatest
_LOOKS = 9  # times over which a coefficient that changes is averaged
_LEAST = 1e-3  # the least value of D over the greatest
_STEEPEST = 100.0  # the greatest exponent of a wave that grows
_MOST = 2**23  # places of the finer lattice; about ten arrays of its waves are held at a time


class _Waves(NamedTuple):
    """The transform of the data, and by how much a unit of D t and of a t / h lowers the exponent of each wave."""

    data: Any
    spread: FloatArray
    carried: list[FloatArray]

    def after(self, spread: float, carried: list[float]) -> Any:
        """Return the transform at a time."""
        moved = sum((a * k for a, k in zip(carried, self.carried, strict=False)), 0.0)
        return self.data * np.exp(np.minimum(-spread * self.spread, _STEEPEST) - 1j * moved)


def frozen_errors(
    problem: Problem, initial: Any, u0: np.ndarray, fields: list[np.ndarray]
) -> list[list[np.ndarray]]:
    """Return at each output time the errors at the particles, one for each form of the data; none if none is known.

    Parameters
    ----------
    problem : Problem
        A problem on the whole space. On a large lattice the error is half of that on half of the particles, as it is
        for a jump; if the data are smooth there, nothing is known.
    initial : callable or any
        The initial data. An array has one form for each entry of `interpolants`, the smoothest first. None stands for
        the fundamental solution, which is smooth.
    u0 : array
        The initial data at the particles.
    fields : list of arrays
        u at each output time; the errors are scaled to its size.
    """
    size = float(np.abs(u0).max())
    m = _FINER[problem.dim]
    places = (2 * m * u0.shape[0]) ** problem.dim
    if not 0.0 < size < np.inf:
        return [[]] * len(fields)
    if places > _MOST:
        return _by_half(problem, initial, u0, fields)
    if problem.dim == 1 and callable(initial) and is_rough(u0):
        m = max(m, _samples(problem))
    scheme = _of_the_scheme(problem, u0 / size)
    equations = [_of_the_equation(problem, u / size, m) for u in _between(problem, initial, u0, m)]
    errors: list[list[np.ndarray]] = []
    for t, u in zip(problem.output_times, fields, strict=True):
        found = [_error(problem, t, u0, scheme, one) for one in equations]
        # Whatever makes u grow or fall does the same to its error, except a source that adds to u.
        now = float(np.abs(u).max())
        errors.append([(size if problem.adds else now / greatest) * off for off, greatest in found])
    return errors


def _samples(problem: Problem) -> int:
    """Return 2^k samples between two particles of a line, one for (D t)^(1/alpha) at the first output time."""
    t, h = problem.output_times[0], problem.case.particle_spacing
    spread = float(np.max(_mean(problem, problem.diffusion, t))) * (t - problem.t_initial)
    wanted = min(h * spread ** (-1.0 / problem.case.alpha), _SAMPLES / problem.case.x.size)
    return 2 ** int(np.log2(max(1.0, wanted)))


def _by_half(
    problem: Problem, initial: Any, u0: np.ndarray, fields: list[np.ndarray]
) -> list[list[np.ndarray]]:
    if not is_rough(u0):  # half of the particles may not see how smooth it is
        return [[]] * len(fields)
    half = halved(problem)
    errors = frozen_errors(half, initial, among(problem, half, u0), fields)
    return [[0.5 * among(half, problem, off) for off in each] for each in errors]


def _error(
    problem: Problem, t: float, u0: np.ndarray, scheme: _Waves, equation: _Waves
) -> tuple[np.ndarray, float]:
    """Return the error at each particle with its own D, and the greatest |u| from data whose greatest |u| is 1."""
    h, span = problem.case.particle_spacing, t - problem.t_initial
    weight = np.abs(u0) / np.abs(u0).sum()
    carried = [span / h * float((_mean(problem, a, t) * weight).sum()) for a in problem.transport]
    d = np.broadcast_to(_mean(problem, problem.diffusion, t), u0.shape)
    levels = _levels(d)
    nearest = np.abs(d[..., None] - levels).argmin(axis=-1)
    inside = tuple(slice(0, n) for n in u0.shape)
    off, greatest = np.zeros(u0.shape), 0.0
    for n, level in enumerate(levels):
        spread = level * span * h**-problem.case.alpha
        seen = _folded(equation.after(spread, carried), scheme.data.shape)
        exact, made = (
            np.fft.ifftn(one).real[inside] for one in (seen, scheme.after(spread, carried))
        )
        here = nearest == n
        off[here] = (made - exact)[here]
        greatest = max(greatest, float(np.abs(made[here]).max(initial=0.0)))
    return off, greatest or 1.0


def _of_the_scheme(problem: Problem, u: np.ndarray) -> _Waves:
    data = np.fft.fftn(np.pad(u, [(0, n - 2) for n in u.shape], "reflect"))
    theta = _wavenumbers(data.shape, 1)
    setting = problem.case.setting
    grid = np.stack(np.broadcast_arrays(*theta), axis=-1)
    each = np.abs(grid[..., 0]) if problem.dim == 1 else grid.reshape(-1, problem.dim)
    symbol = np.asarray(SCHEMES[problem.case.scheme].symbol(each, setting)).reshape(data.shape)
    carried = []
    if problem.transport:
        of_a = Transport(setting).symbol
        carried = [np.sign(k) * of_a(np.abs(k).ravel()).reshape(k.shape) for k in theta]
    return _Waves(data, -symbol, carried)


def _of_the_equation(problem: Problem, u: np.ndarray, m: int) -> _Waves:
    data = np.fft.fftn(np.pad(u, [(0, n) for n in u.shape], "symmetric"))
    waves = _wavenumbers(data.shape, m)
    for k in waves:  # the first place lies half of a finer spacing behind the first particle
        data *= np.exp(-0.5j * k / m) / m
    return _Waves(data, sum(k * k for k in waves) ** (0.5 * problem.case.alpha), waves)


def _wavenumbers(shape: tuple[int, ...], finer: int) -> list[FloatArray]:
    """Return k h along each axis, with the spacing h of the particles."""
    every = (2.0 * np.pi * finer * np.fft.fftfreq(n) for n in shape)
    return list(np.meshgrid(*every, indexing="ij", sparse=True))


def _levels(d: np.ndarray) -> np.ndarray:
    least, most = float(d.min()), float(d.max())
    if least > 0.99 * most or not most > 0.0:
        return np.array([most])
    return np.geomspace(max(least, _LEAST * most), most, _LEVELS)


def _mean(problem: Problem, one: Coefficient, t: float) -> Any:
    """Return the mean of a coefficient in time up to t, at the particles."""
    times = np.linspace(problem.t_initial, t, _LOOKS) if "t" in one.depends_on else [t]
    return sum(one(problem.places | {"t": np.array(time)}) for time in times) / len(times)


def _between(problem: Problem, initial: Any, u0: np.ndarray, m: int) -> list[np.ndarray]:
    """Return each form of the data at m equally spaced places between two particles, none of them at a particle."""
    dim = problem.dim
    part = (np.arange((u0.shape[0] - 1) * m) + 0.5) / m
    x = problem.case.x[0] + part * problem.case.particle_spacing
    if callable(initial):
        try:
            values = np.asarray(
                initial(*np.meshgrid(*(x,) * dim, indexing="ij", sparse=True)), float
            )
            values = np.broadcast_to(values, (x.size,) * dim)
        except Exception:  # a function that is valid only at its own particles may raise anything
            values = np.array(np.nan)
        if np.isfinite(values).all():
            return [values]
    found = interpolants(u0, *(part,) * dim)
    return found[:1] if initial is None else found


def _folded(fine: Any, shape: tuple[int, ...]) -> Any:
    """Return the waves of the finer lattice as the particles see them: waves that differ by 2 pi / h are one."""
    for axis, n in enumerate(shape):
        fine = fine.reshape(*fine.shape[:axis], -1, n, *fine.shape[axis + 1 :]).sum(axis)
    return fine
