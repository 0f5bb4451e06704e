"""What the particles make of the initial data, and what the equation makes of them, where the coefficients are frozen.

With the D and the a of one place everywhere both are known, wave by wave. Of a wave k in a time t

    the scheme makes exp(t (D A^(k) - i a T^(k))),    the equation exp(-t (D |k|^alpha + i a k)),

A^ and T^ the symbols of the diffusion and the transport. The equation is given the data on a finer lattice, between the
particles: so a kink or a jump has its error from the first moment on. Half of the particles cannot tell that error. For
a time of some h^alpha they see as little of the kink as all of them do, and the difference is small.

Each place has the error of the nearest of five D; a is the mean over |u|, alpha the greatest. The data go on beyond the
ends as in a mirror.
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

_FINER = {1: 16, 2: 2}  # samples between two particles
_LEVELS = 5  # of D, from its least to its greatest
_LOOKS = 9  # in time, at a coefficient that changes
_LEAST = 1e-3  # of the greatest D, the least that is told from nothing
_STEEPEST = 100.0  # the exponent of a wave that grows
_MOST = 2**23  # places of the finer lattice, of whose waves some ten arrays are held at a time


class _Waves(NamedTuple):
    """The transform of the data, and what a unit of D t and of a t / h takes from the exponent of each wave."""

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
    """Return at each output time the error at the particles, for all that the data may be; none where nothing is known.

    Parameters
    ----------
    problem : Problem
        Of the whole space. On a large lattice it is half of what half of the particles say, as that of a jump is; and
        of data that are smooth there nothing is known.
    initial : callable or any
        The initial data; if they are no function, each of what an array may be between the particles, the smoothest
        first, see `interpolants`. Nothing is the fundamental solution, which is smooth.
    u0 : array
        Their values at the particles.
    fields : list of arrays
        u at each output time, in whose size the errors are.
    """
    size = float(np.abs(u0).max())
    places = (2 * _FINER[problem.dim] * u0.shape[0]) ** problem.dim
    if not 0.0 < size < np.inf:
        return [[]] * len(fields)
    if places > _MOST:
        return _by_half(problem, initial, u0, fields)
    scheme = _of_the_scheme(problem, u0 / size)
    equations = [_of_the_equation(problem, u / size) for u in _between(problem, initial, u0)]
    errors: list[list[np.ndarray]] = []
    for t, u in zip(problem.output_times, fields, strict=True):
        found = [_error(problem, t, u0, scheme, one) for one in equations]
        # Whatever else than a source that adds to it makes u grow or fall does so with its error.
        now = float(np.abs(u).max())
        errors.append([(size if problem.adds else now / greatest) * off for off, greatest in found])
    return errors


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
    """The error at each particle with its own D, and the greatest |u| made of data whose greatest |u| is 1."""
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


def _of_the_equation(problem: Problem, u: np.ndarray) -> _Waves:
    m = _FINER[problem.dim]
    data = np.fft.fftn(np.pad(u, [(0, n) for n in u.shape], "symmetric"))
    waves = _wavenumbers(data.shape, m)
    for k in waves:  # the first place lies half of a finer spacing behind the first particle
        data *= np.exp(-0.5j * k / m) / m
    return _Waves(data, sum(k * k for k in waves) ** (0.5 * problem.case.alpha), waves)


def _wavenumbers(shape: tuple[int, ...], finer: int) -> list[FloatArray]:
    """K h along each axis, h the spacing of the particles."""
    every = (2.0 * np.pi * finer * np.fft.fftfreq(n) for n in shape)
    return list(np.meshgrid(*every, indexing="ij", sparse=True))


def _levels(d: np.ndarray) -> np.ndarray:
    least, most = float(d.min()), float(d.max())
    if least > 0.99 * most or not most > 0.0:
        return np.array([most])
    return np.geomspace(max(least, _LEAST * most), most, _LEVELS)


def _mean(problem: Problem, one: Coefficient, t: float) -> Any:
    """The mean in time up to t, at the particles."""
    times = np.linspace(problem.t_initial, t, _LOOKS) if "t" in one.depends_on else [t]
    return sum(one(problem.places | {"t": np.array(time)}) for time in times) / len(times)


def _between(problem: Problem, initial: Any, u0: np.ndarray) -> list[np.ndarray]:
    """What the data may be at m places between each two particles, equally spaced, none of them at a particle."""
    m, dim = _FINER[problem.dim], problem.dim
    part = (np.arange((u0.shape[0] - 1) * m) + 0.5) / m
    x = problem.case.x[0] + part * problem.case.particle_spacing
    if callable(initial):
        try:
            values = np.asarray(
                initial(*np.meshgrid(*(x,) * dim, indexing="ij", sparse=True)), float
            )
            values = np.broadcast_to(values, (x.size,) * dim)
        except Exception:  # whatever a function may raise that knows its own particles alone
            values = np.array(np.nan)
        if np.isfinite(values).all():
            return [values]
    found = interpolants(u0, *(part,) * dim)
    return found[:1] if initial is None else found


def _folded(fine: Any, shape: tuple[int, ...]) -> Any:
    """The waves of the finer lattice as the particles see them: those that differ by 2 pi / h are one."""
    for axis, n in enumerate(shape):
        fine = fine.reshape(*fine.shape[:axis], -1, n, *fine.shape[axis + 1 :]).sum(axis)
    return fine
