"""The right-hand side of a problem on its particles: du/dt = R(t, u), for integrators that see flat arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.problem import FORMS, Problem
from fracparticles.problems.transport import Transport
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.variable import VariableDiffusivity, VariableOrder

__all__ = ["Rates", "over_time", "probe_source", "reaction_of"]

Part = Callable[[float, np.ndarray], np.ndarray]


class Rates:
    """R(t, u) = div(D grad^beta u) - div(a u) + f of a problem, made ready.

    Parameters
    ----------
    problem : Problem

    Attributes
    ----------
    evaluations : int
        How often R has been evaluated.

    Raises
    ------
    InvalidInput
        If a coefficient is not finite, or the diffusivity negative, at a point beyond the ends of the lattice.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem, self.shape, self.evaluations = problem, problem.case.shape, 0
        parts = (_diffusion(problem), _transport(problem), reaction_of(problem))
        self._parts: list[Part] = [part for part in parts if part is not None]

    def __call__(self, t: float, u: np.ndarray) -> np.ndarray:
        """Return du/dt, flat like u; values that overflow are infinite or nan."""
        self.evaluations += 1
        lattice = np.ascontiguousarray(u, dtype=float).reshape(self.shape)
        total = np.zeros(self.shape)
        with np.errstate(over="ignore", invalid="ignore"):
            for part in self._parts:
                total += part(t, lattice)
        return total.reshape(-1)


def _named(points: tuple[np.ndarray, ...] | list[np.ndarray]) -> dict[str, Any]:
    return dict(zip(("x", "y"), points, strict=False))


def over_time(
    coefficient: Coefficient, points: Any, least: float | None = None, start: float = 0.0
) -> Callable[[float], Any]:
    """Return a function of time to the values of a coefficient at some points; they are computed once if constant."""
    named = _named(points)
    values = coefficient.checked({**named, "t": np.array(start)}, least)
    if "t" in coefficient.depends_on:
        return lambda t: coefficient.checked({**named, "t": np.array(t)}, least)
    constant = coefficient.constant
    fixed = np.ascontiguousarray(values) if constant is None else np.array(constant)
    return lambda t: fixed


def _diffusion(problem: Problem) -> Part | None:
    if problem.diffusion.constant == 0.0:
        return None
    setting = replace(problem.case.setting, diffusivity=1.0)
    if problem.diffusion.depends_on - {"t"}:
        varying = VariableDiffusivity(problem.form, setting)
        d = over_time(problem.diffusion, varying.points, 0.0, problem.t_initial)
        return lambda t, u: varying.apply(u, d(t))
    apply = _of_unit_diffusivity(problem, setting)
    everywhere = over_time(
        problem.diffusion, (np.array(0.0),) * problem.dim, 0.0, problem.t_initial
    )
    return lambda t, u: everywhere(t) * apply(u)


def _of_unit_diffusivity(problem: Problem, setting: Setting) -> Callable[[np.ndarray], np.ndarray]:
    beta = problem.order_coefficient
    if beta.constant is None:
        return VariableOrder(setting, 1.0 + beta(_named(problem.case.positions))).apply
    operator = SCHEMES[FORMS[problem.form]].operator(setting)
    return lambda u: operator.apply(u.reshape(-1)).reshape(u.shape)


def _transport(problem: Problem) -> Part | None:
    if not problem.transport:
        return None
    transport = Transport(problem.case.setting)
    speeds = [
        over_time(one, points, start=problem.t_initial)
        for one, points in zip(problem.transport, transport.points, strict=True)
    ]
    return lambda t, u: transport.apply(u, [speed(t) for speed in speeds])


def reaction_of(problem: Problem) -> Part | None:
    """Return f as a function of t and u at the particles, or None."""
    f, named = problem.reaction, problem.places
    if f is None:
        return None
    if not f.depends_on & {"t", "u"}:
        nothing = np.zeros(np.broadcast_shapes(*(np.shape(at) for at in named.values())))
        fixed = f.checked({**named, "t": np.array(problem.t_initial), "u": nothing})
        return lambda t, u: fixed
    return lambda t, u: f({**named, "t": np.array(t), "u": u})


def probe_source(problem: Problem, u0: np.ndarray) -> None:
    """Refuse a source that is not a finite number at each particle, for the initial data, at each output time.

    Raises
    ------
    InvalidInput
        If it is not; names the place and the time.
    """
    if problem.reaction is None:
        return
    for time in (problem.t_initial, *problem.output_times):
        problem.reaction.checked({**problem.places, "t": np.array(time), "u": u0})
