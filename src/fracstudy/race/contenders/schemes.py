"""Ours: the papers' schemes on a lattice with an open exterior, and the papers' way of running them."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from fracparticles.run.case import Case
from fracparticles.run.solver import advect, compute, prepare
from fracparticles.schemes import SCHEMES
from fracstudy.race.contender import Contender, Grids, Ready, Trials, sweep
from fracstudy.race.problem import Problem

_SPACINGS = (0.8, 0.56, 0.4, 0.28, 0.2, 0.14, 0.1, 0.05)
_TRUNCATIONS = {1: (4.1, 7.0, 20.0), 2: (2.3, 4.0, 8.0), 3: (2.3, 4.0)}
_MOST = {1: 20000, 2: 60000, 3: 100000}
_NAIVE_STEPS = 1


def _lattices(problem: Problem) -> Grids:
    grids = {
        (fine, wide): {"spacing": spacing, "truncation": truncation}
        for fine, spacing in enumerate(_SPACINGS)
        for wide, truncation in enumerate(_TRUNCATIONS[problem.dim])
        if (2.0 * truncation * problem.width / spacing) ** problem.dim <= _MOST[problem.dim]
    }
    return dict(sorted(grids.items(), key=lambda one: one[1]["truncation"] / one[1]["spacing"]))


_WAYS = tuple(
    (
        f"order {order}",
        {"order": order, "integrator": "exponential", "evaluation": "convolution"},
    )
    for order in (4, 12)
)


class _Scheme(Contender):
    """A scheme whose whole run is one sum, since a Chebyshev series of its operator takes longer."""

    group = "schemes"
    dims: tuple[int, ...] = (1, 2)
    ways: tuple[tuple[str, dict[str, Any]], ...] = _WAYS

    def __init_subclass__(cls, equation: int, place: int) -> None:
        """Name it after its class."""
        cls.name = cls.label = cls.__name__
        cls.reference, cls.place = f"Lucchesi et al. (2020), Eq. ({equation})", place
        cls.colour, cls.marker = SCHEMES[cls.name].colour, SCHEMES[cls.name].marker

    def trials(self, problem: Problem) -> Trials:
        """Yield the orders and evaluations on lattices."""
        open_one = {"exterior": "open", **({"far_terms": 3} if problem.dim == 1 else {})}
        for variant, fields in self.ways:
            yield from sweep(_lattices(problem), variant=variant, **open_one, **fields)

    def prepare(self, problem: Problem, variant: str, **fields: Any) -> Ready:
        """Return the case made ready; its span is 1, like that of the problem."""
        case = Case(scheme=self.name, beta=problem.beta, dim=problem.dim, **fields)
        points = np.meshgrid(*(case.x,) * case.dim, indexing="ij", sparse=True)
        return Ready(tuple(points), case.volumes, prepare(case).solve)


class DD(_Scheme, equation=10, place=20):
    """DD."""


class FPSE(_Scheme, equation=25, place=21):
    """FPSE."""

    dims = (1,)


class KPSE(_Scheme, equation=34, place=22):
    """KPSE."""


class GPSE(_Scheme, equation=41, place=23):
    """GPSE in one step."""

    dims = (1, 2, 3)
    ways = (
        ("one step", {"dt": 1.0}),
        ("one step, convolution", {"dt": 1.0, "evaluation": "convolution"}),
    )


class MovingParticles(Contender):
    """DVM, remeshed: its particles move with the diffusion velocity."""

    name = label = "DVM"
    reference = "Lucchesi et al. (2020), Sec. 3.3"
    group, place = "schemes", 24
    colour, marker = "#0072B2", "X"

    def takes(self, problem: Problem) -> bool:
        """Whether the data are positive everywhere, and resolved by a lattice."""
        return problem.dim == 1 and problem.name in ("fundamental", "mixture")

    def trials(self, problem: Problem) -> Trials:
        """Yield a few lattices and steps."""
        for spacing, steps in ((0.1788, 250), (0.0894, 1000)):
            fields = {"order": 4, "spacing": spacing, "dt": 1.0 / steps, "truncation": 10.0}
            yield {"variant": "order 4", **fields}

    def prepare(self, problem: Problem, variant: str, **fields: Any) -> Ready:
        """Return the run made ready; its solution is the field (7) where the particles began."""
        case = Case(scheme="DVM", beta=problem.beta, **fields)
        return Ready(
            (case.x,), case.volumes, lambda u0: advect(case, u0).field(case.x), linear=False
        )


class PapersWay(Contender):
    """Sums over all pairs and midpoint steps of 5e-5: one step is timed, and the run is extrapolated."""

    name = label = "papers' way"
    reference = "Lucchesi et al. (2020), Sec. 4.1"
    group, place = "papers", 30
    colour, marker = "#999999", "s"

    def takes(self, problem: Problem) -> bool:
        """Whether it is the papers' problem."""
        return problem.dim == 1 and problem.name == "fundamental"

    def trials(self, problem: Problem) -> Trials:
        """Yield the schemes of order IV on truncated lattices; a step of order II takes as long."""
        lattices = ((20.0, 0.2), (160.0, 0.1))
        for scheme, (truncation, spacing) in product(("DD", "FPSE", "KPSE"), lattices):
            fields = {"scheme": scheme, "order": 4, "spacing": spacing}
            yield {"variant": f"{scheme} 4", "truncation": truncation, **fields}

    def prepare(self, problem: Problem, variant: str, **fields: Any) -> Ready:
        """Return a step made ready, and the whole run by FFT for the error."""
        case = Case(beta=problem.beta, dt=5.0e-5, **fields)
        few = few_steps(case, _NAIVE_STEPS, "naive")
        ready = Ready((case.x,), case.volumes, prepare(few).solve, scale=case.steps / _NAIVE_STEPS)
        return replace(ready, result=lambda u0: compute(case, u0).u)


def few_steps(case: Case, steps: int, summation: str) -> Case:
    """Return the case with only `steps` of its time steps, one by one, and the given summation."""
    fields = case.model_dump(exclude_none=True, exclude={"truncation"})
    few = {
        "half_width": case.reach,  # C would follow from the final time
        "t_final": case.t_initial + steps * case.time_step,
        "summation": summation,
        "evaluation": "stepping",
    }
    return Case(**{**fields, **few})
