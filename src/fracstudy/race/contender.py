"""The interface of the contenders of the race, and the grids that they try."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from scipy.fft import next_fast_len

from fracstudy.race.problem import Points, Problem

__all__ = [
    "ENOUGH",
    "Contender",
    "Grids",
    "Mapped",
    "Ready",
    "Solve",
    "Trials",
    "lattices",
    "sweep",
]

Trials = Generator[dict[str, Any], float | None, None]
"""Keywords of `prepare` to try; the error of each may be sent back."""
Solve = Callable[[np.ndarray], np.ndarray]
"""From the data at the points to the solution there."""
Grids = Mapping[tuple[int, int], dict[str, Any]]
"""Keywords of grids, by the numbers of their spacing and of their width: 0, 1, .."""

SPACINGS = (0.8, 0.56, 0.4, 0.28, 0.2, 0.14, 0.1, 0.05)  # in units of the finest detail of the data
TRUNCATIONS = (3.0, 5.0, 8.0, 12.0, 20.0, 40.0, 160.0, 640.0)  # C = D / (R_alpha t_f^(1/alpha))
ENOUGH = 1e-10
"""An error that is small enough: finer grids are not tried."""
_LEFT = 0.9  # share of an error: if two refinements leave more, it is not due to what was refined
_MOST = {1: 2**16, 2: 2**20, 3: 2**19}  # points of a grid, by dimension


@dataclass(frozen=True)
class Ready:
    """A contender made ready for one grid: all that does not depend on the data is done.

    Attributes
    ----------
    x : tuple of array
        Its points, one array for each coordinate.
    volumes : array or float
        The volume of each point.
    solve : Solve
    batched : bool
        Whether `solve` takes several data at once, along a first axis.
    linear : bool
        Whether a solve is linear in the data.
    scale : float
        The time of a run over that of `solve`: more than 1 where only some of the time steps are taken.
    result : callable, optional
        The solution, where `solve` takes only some of the steps.
    """

    x: Points
    volumes: np.ndarray | float
    solve: Solve
    batched: bool = False
    linear: bool = True
    scale: float = 1.0
    result: Solve | None = None

    @property
    def points(self) -> int:
        """The number of unknowns."""
        return int(np.prod(np.broadcast_shapes(*(line.shape for line in self.x))))


class Contender:
    """A method with a `name`, in a module of the folder: `trials` yields its trials, and `prepare` makes one ready.

    A contender that `follows` another has the same errors, and tries only the trials near the front of the other.
    """

    name: str
    label: str  # in figures
    reference: str  # where it was published
    group = "peers"  # or "ours", "schemes" (of the papers, as this library runs them), "papers" (as the papers do)
    place = 100
    follows: str | None = None
    colour, marker = "#000000", "o"
    dims: tuple[int, ...] = (1,)

    def takes(self, problem: Problem) -> bool:
        """Whether it can solve the problem."""
        return problem.dim in self.dims

    def trials(self, problem: Problem) -> Trials:
        """Yield the keywords of `prepare` to try; `variant` is always among them."""
        raise NotImplementedError

    def prepare(self, problem: Problem, *args: Any, **parameters: Any) -> Ready:
        """Return the method made ready."""
        raise NotImplementedError


class Mapped(Contender):
    """A method on a map of the line, which has a `scale`."""

    counts: tuple[int, ...]
    scales: tuple[float, ...]  # in units of R_alpha t_f^(1/alpha)

    def trials(self, problem: Problem) -> Trials:
        """Yield numbers of points, each with every scale."""
        for points, scale in product(self.counts, self.scales):
            yield {"variant": "", "points": points, "scale": scale * problem.width}


def lattices(
    problem: Problem,
    spacings: Iterable[float] | None = None,
    truncations: Iterable[float] = TRUNCATIONS,
) -> Grids:
    """Return grids of every spacing with every truncation factor C, those of few points first.

    A grid has `points` along each axis and the `half_width` D = C R_alpha t_f^(1/alpha). Spacings are in units of the
    finest detail of the problem. The number of points is the next even one whose transforms are fast; the spacing is
    then a little smaller.
    """
    grids: dict[tuple[int, int], dict[str, Any]] = {}
    for (fine, spacing), (wide, truncation) in product(
        enumerate(spacings or SPACINGS), enumerate(truncations)
    ):
        half_width = truncation * problem.width
        points = 2 * next_fast_len(int(np.ceil(half_width / (spacing * problem.finest))), real=True)
        grid = {"points": points, "half_width": half_width}
        if points**problem.dim <= _MOST[problem.dim] and grid not in grids.values():
            grids[fine, wide] = grid
    return dict(sorted(grids.items(), key=lambda one: one[1]["points"]))


def sweep(grids: Grids, **fields: Any) -> Trials:
    """Yield the fields with each grid, those of few points first, without grids that gain nothing.

    Once an error is small enough, no more grids are tried. If two widenings at a spacing have left nine tenths of the
    error, it is not due to the width, and wider grids of this spacing are not tried. The same holds for two refinements
    at a width. One widening or refinement is not enough to judge by, since errors may cross zero.
    """
    errors: dict[tuple[int, int], float] = {}
    for (fine, wide), grid in grids.items():
        narrower = [errors.get((fine, wide - k)) for k in (1, 3)]
        coarser = [errors.get((fine - k, wide)) for k in (1, 3)]
        if idle := [
            one for one, before in (narrower, coarser) if one and before and one > _LEFT * before
        ]:
            errors[fine, wide] = min(idle)
        elif (error := (yield {**fields, **grid})) is not None:
            errors[fine, wide] = error
            if error < ENOUGH:
                return
