"""Transport by particles that move with the field, on the line: another method, to compare with `transport`.

One step of length dt, Strang's splitting with the exact diffusion of the whole space S (`time.whole_space`),

    u <- S(dt / 2) u,    dx_p/dt = a(x_p, t), U_p = h u_p constant,    remesh,    u <- S(dt / 2) u.

The particles start on the lattice, move for one step by the classical Runge-Kutta scheme, and their strengths are put
back on the lattice (`moving.remeshing`). Beyond each end there are as many more as may move in; their u falls like
|x|^(-1-alpha) from the last. Mass is conserved except for the strengths that pass the ends, which are counted. The
splitting has an error of second order in dt. Each remeshing adds an error of some order in h, so that more steps have
more of it. A run with half as many steps tells how large the error is.
"""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import ArrayLike

from fracparticles import arguments as check
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.moving.remeshing import REMESHINGS, remesh
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.problem import Problem
from fracparticles.time.whole_space import WholeSpace

__all__ = ["solve_with_moving_particles"]


_NOTICED = 0.05  # share of the peak by which half as many steps may differ; share of sum |U| that may leave
_ROOM = 8  # particles beyond each end, besides the spacings by which the ends move


def solve_with_moving_particles(
    problem: Problem, initial: ArrayLike, steps: int, remeshing: str = "Lambda3"
) -> np.ndarray:
    """Return u at `t_final` on the lattice of the problem, shape (N,).

    Parameters
    ----------
    problem : Problem
        On the line, with a velocity, a constant order and diffusivity, no source, an open exterior.
    initial : array, shape (N,)
        Initial strengths u.
    steps : int
        The number of steps, of equal length.
    remeshing : {"Lambda3", "M4'", "Lambda6,4"}
        Interpolation function.

    Raises
    ------
    InvalidInput
        If the problem is not such a one, or a particle runs away.

    Warns
    -----
    AccuracyWarning
        If the solution in half as many steps (two instead of one) differs by a twentieth of the peak, or a twentieth
        of the strengths has left the lattice.
    """
    problem = check.instance("problem", problem, Problem)
    steps = check.positive_integer("steps", steps)
    check.choice("remeshing", remeshing, REMESHINGS)
    d, case = problem.diffusion.constant, problem.case
    plain = d is not None and d > 0.0 and problem.order_coefficient.constant is not None
    if not (plain and problem.dim == 1 and len(problem.transport) == 1 and not problem.reaction):
        what = "one on the line with a velocity, a constant order and diffusivity, and no source"
        raise InvalidInput("problem", problem.to_json(), what, "Use solve_problem.")
    assert d is not None
    u0 = check.vector("initial", initial, case.particles)
    u, left = _run(problem, u0, steps, d, remeshing)
    other, _ = _run(problem, u0, steps // 2 or 2, d, remeshing)
    peak = float(np.abs(u).max())
    if (off := float(np.abs(u - other).max())) > _NOTICED * peak:
        text = f"another number of steps gives another solution, by {off / peak:.2g} of its peak. Take more."
        warnings.warn(text, AccuracyWarning, stacklevel=2)
    if left > _NOTICED:
        text = f"{left:.2g} of the strengths have left the lattice. Take a wider one."
        warnings.warn(text, AccuracyWarning, stacklevel=2)
    return np.asarray(check.finite_result("u", u))


def _run(
    problem: Problem, u: np.ndarray, steps: int, d: float, remeshing: str
) -> tuple[np.ndarray, float]:
    """Return u at t_final, and the share of sum |U| that has left."""
    case, h, dt = problem.case, problem.case.particle_spacing, problem.span / steps
    left, start = 0.0, float(np.abs(u).sum()) or 1.0
    half = WholeSpace(case.particles, 1, case.alpha, 0.5 * d * dt * h**-case.alpha)
    velocity = problem.transport[0]
    for n in range(steps):
        t = problem.t_initial + n * dt
        pad = _ROOM + int(np.abs(_moved(velocity, case.x, t, dt) - case.x).max() / h)
        x = np.arange(-case.n - pad, case.n + pad + 1) * h
        places = _moved(velocity, x, t, dt)
        strength = h * _continued(half.solve(u), pad, case.n, case.alpha)
        moved, beyond = _on_lattice(*remesh(places, strength, h, remeshing), h, case.n)
        left, u = left + beyond / start, half.solve(moved)
    return u, left


def _continued(u: np.ndarray, pad: int, n: int, alpha: float) -> np.ndarray:
    """Return u with `pad` more particles at either end."""
    fall = (n / np.arange(n + 1.0, n + pad + 1.0)) ** (1.0 + alpha)
    return np.concatenate([u[0] * fall[::-1], u, u[-1] * fall])


def _moved(velocity: Coefficient, x: np.ndarray, t: float, dt: float) -> np.ndarray:
    """Return the positions of the particles after dt, by the classical Runge-Kutta scheme."""

    def a(x: np.ndarray, t: float) -> np.ndarray:
        return velocity.checked({"x": x, "t": np.array(t)})

    first = a(x, t)
    second = a(x + 0.5 * dt * first, t + 0.5 * dt)
    third = a(x + 0.5 * dt * second, t + 0.5 * dt)
    fourth = a(x + dt * third, t + dt)
    return x + dt / 6.0 * (first + 2.0 * (second + third) + fourth)


def _on_lattice(
    places: np.ndarray, strength: np.ndarray, h: float, n: int
) -> tuple[np.ndarray, float]:
    """Return u on -n .. n, and the sum of |u| beyond, which has left."""
    u, index = np.zeros(2 * n + 1), np.rint(places / h).astype(int) + n
    inside = (index >= 0) & (index < u.size)
    u[index[inside]] = strength[inside] / h
    return u, float(np.abs(strength[~inside]).sum()) / h
