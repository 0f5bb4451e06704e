"""What a peer is, what it is asked for, what it gives, and the number of its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Lock
from typing import Any, Protocol

import numpy as np

from fracparticles.arguments import (
    fractional_order,
    positive_integer,
    positive_real,
    real_array,
)
from fracparticles.errors import InvalidInput

__all__ = ["Peer", "PlaneSolver", "Solver", "Task", "half_intervals"]


class Solver(Protocol):
    """A peer made ready for one grid, one alpha and one time."""

    @property
    def x(self) -> np.ndarray:
        """Positions in ascending order, shape (N,)."""

    @property
    def volumes(self) -> np.ndarray:
        """The length that each stands for, shape (N,): sum_i volumes_i f(x_i) is the integral of f."""

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return the approximation of -(-Laplacian)^(alpha/2) u at x, shape (N,)."""

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return u at the time prepared for from u0 at time 0, shape (N,)."""


@dataclass(frozen=True)
class PlaneSolver:
    """A peer made ready for one square lattice, one alpha and one time. Threads may share it: they take turns.

    Attributes
    ----------
    x : array, shape (N,)
        The coordinates along either axis, in ascending order.
    volumes : float
        The area that each point stands for.
    advance : callable
        u(0) -> u(t), unchecked.
    """

    x: np.ndarray
    volumes: float
    advance: Callable[[np.ndarray], np.ndarray]
    _lock: Lock = field(init=False, repr=False, default_factory=Lock)

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return u at the time prepared for from u0 at time 0, both of shape (N, N).

        Raises
        ------
        InvalidInput
            If u0 is not of that shape, not real, or holds a nan.
        """
        u0, size = real_array("u0", u0), self.x.size
        if u0.shape != (size, size):
            allowed = f"the shape ({size}, {size})"
            raise InvalidInput("u0", u0.shape, allowed, "Give a value at each lattice point.")
        with self._lock:
            return self.advance(u0)


@dataclass(frozen=True)
class Task:
    """What a peer is asked for.

    Attributes
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    half_width : float
        Half the width of the grid; for a grid without ends its scale.
    time : float
        The time to go.
    spacing, count : float or int
        The distance of the points, or their number: just one of the two.
    exterior, propagation : str
        One of the peer's; the first if left out.

    Raises
    ------
    InvalidInput
        If one is outside its range.
    """

    alpha: float
    half_width: float
    time: float
    spacing: float | None = None
    count: int | None = None
    exterior: str = ""
    propagation: str = ""

    def __post_init__(self) -> None:
        fractional_order(self.alpha)
        positive_real("half_width", self.half_width)
        positive_real("time", self.time)


@dataclass(frozen=True)
class Peer:
    """A method of the literature.

    Attributes
    ----------
    name, label, reference : str
        Its name, the name in figures, and where it was published.
    place : int
        Where it stands among the others.
    colour, marker : str
        Of its lines in figures.
    exteriors, propagations : tuple of str
        What there is beyond the half-width; how the solution gets from 0 to t.
    make : callable
        From the task to the solver on the line.
    make_plane : callable, optional
        From the task to the solver in the plane.
    group : {"peers", "limit"}
        What it is compared as.
    scaled : bool
        Whether the half-width is the scale of a grid without ends.
    """

    name: str
    label: str
    reference: str
    place: int
    colour: str
    marker: str
    exteriors: tuple[str, ...]
    propagations: tuple[str, ...]
    make: Callable[[Task], Solver]
    make_plane: Callable[[Task], PlaneSolver] | None = None
    group: str = "peers"
    scaled: bool = False

    def prepare(self, **asked: Any) -> Solver:
        """Return the peer made ready for a `Task`: all that does not depend on the initial data is done.

        Raises
        ------
        InvalidInput
            If an argument is outside its range.
        """
        for name, choices in (("exterior", self.exteriors), ("propagation", self.propagations)):
            if asked.setdefault(name, choices[0]) not in choices:
                allowed = f"one of {', '.join(choices)} for this peer"
                raise InvalidInput(name, asked[name], allowed, "Choose one.")
        return self.make(Task(**asked))

    def prepare_plane(self, *, spacing: float, **asked: Any) -> PlaneSolver:
        """Return the peer made ready in the plane, on a square of the half-width.

        The realised spacing is half_width / n; that of a periodic square may be smaller.

        Raises
        ------
        InvalidInput
            If an argument is outside its range, or the peer does not exist in the plane.
        """
        if self.make_plane is None:
            raise InvalidInput("peer", self.name, "one that exists in the plane", "Take another.")
        return self.make_plane(Task(spacing=positive_real("spacing", spacing), **asked))


def half_intervals(task: Task, points: int = 1, stretch: float = 1.0) -> int:
    """Return n for a grid of 2 n + `points` positions, 2 n intervals or as many positions as `task.count` says.

    A grid whose points lie apart at its middle by 1 / `stretch` of their mean distance has as many more.

    Raises
    ------
    InvalidInput
        If not just one of spacing and count is given, or it is outside its range.
    """
    spacing, count = task.spacing, task.count
    if (spacing is None) == (count is None):
        raise InvalidInput(
            "spacing and count", (spacing, count), "just one of the two", "Leave the other out."
        )
    if spacing is not None:
        return max(1, round(stretch * task.half_width / positive_real("spacing", spacing)))
    given = positive_integer("count", count)
    if given < 2 or (given - points) % 2:
        parity = "odd" if points % 2 else "even"
        raise InvalidInput("count", given, f"an {parity} number > 1", "Add one point.")
    return (given - points) // 2
