"""The right-hand side of a problem on its particles: du/dt = R(t, u), for integrators that see flat arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.problem import FORMS, Problem
from fracparticles.problems.transport import Transport
from fracparticles.schemes import SCHEMES

__all__ = ["Rates"]

Part = Callable[[float, np.ndarray], np.ndarray]


class Rates:
    """R(t, u) = div(D grad^beta u) - div(a u) + f, of a problem made ready.

    Parameters
    ----------
    problem : Problem

    Attributes
    ----------
    evaluations : int
        How often R has been asked for.

    Raises
    ------
    InvalidInput
        If a coefficient is not finite, or the diffusivity negative, at a point beyond the ends of the lattice.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem, self.shape, self.evaluations = problem, problem.case.shape, 0
        parts = (_diffusion(problem), _transport(problem), _reaction(problem))
        self._parts: list[Part] = [part for part in parts if part is not None]

    def __call__(self, t: float, u: np.ndarray) -> np.ndarray:
        """Return du/dt, flat as u; what overflows is infinite or nan in it."""
        self.evaluations += 1
        lattice = np.ascontiguousarray(u, dtype=float).reshape(self.shape)
        total = np.zeros(self.shape)
        with np.errstate(over="ignore", invalid="ignore"):
            for part in self._parts:
                total += part(t, lattice)
        return total.reshape(-1)


def _named(points: tuple[np.ndarray, ...] | list[np.ndarray]) -> dict[str, Any]:
    return dict(zip(("x", "y"), points, strict=False))


def _over_time(
    coefficient: Coefficient, points: Any, least: float | None = None, start: float = 0.0
) -> Callable[[float], Any]:
    """Return the values at some points as a function of time; evaluated once if they do not change."""
    named = _named(points)
    values = coefficient.checked({**named, "t": np.array(start)}, least)
    if "t" in coefficient.depends_on:
        return lambda t: coefficient.checked({**named, "t": np.array(t)}, least)
    constant = coefficient.constant
    fixed = np.ascontiguousarray(values) if constant is None else np.array(constant)
    return lambda t: fixed


def _diffusion(problem: Problem) -> Part | None:
    if problem.order_coefficient.constant is None or problem.diffusion.depends_on - {"t"}:
        return _variable(problem)
    d = problem.diffusion
    if d.constant == 0.0:
        return None
    case = problem.case
    of_unit = case.model_copy(update={"diffusivity": 1.0})
    operator = SCHEMES[FORMS[problem.form]].operator(of_unit.setting)
    fixed = d.constant

    def constant(t: float, u: np.ndarray) -> np.ndarray:
        now = fixed
        if now is None:
            nowhere = {name: np.array(0.0) for name in d.variables}
            now = float(d.checked({**nowhere, "t": np.array(t)}, 0.0))
        return now * operator.apply(u.reshape(-1)).reshape(u.shape)

    return constant


def _variable(problem: Problem) -> Part:
    raise InvalidInput(
        "diffusivity", problem.diffusivity, "a coefficient of t alone", "Make it constant in space."
    )


def _transport(problem: Problem) -> Part | None:
    if not problem.transport:
        return None
    transport = Transport(problem.case.setting)
    speeds = [
        _over_time(one, points, start=problem.t_initial)
        for one, points in zip(problem.transport, transport.points, strict=True)
    ]
    return lambda t, u: transport.apply(u, [speed(t) for speed in speeds])


def _reaction(problem: Problem) -> Part | None:
    f = problem.reaction
    if f is None:
        return None
    named = _named(problem.case.positions)
    if not f.depends_on & {"t", "u"}:
        fixed = f.checked(
            {**named, "t": np.array(problem.t_initial), "u": np.zeros(problem.case.shape)}
        )
        return lambda t, u: fixed
    return lambda t, u: f({**named, "t": np.array(t), "u": u})
