"""What a peer is, and the number of its points."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from fracparticles.arguments import positive_integer, positive_real
from fracparticles.errors import InvalidInput

__all__ = ["Peer", "Solver", "check_choice", "half_intervals"]


class Solver(Protocol):
    """A peer made ready for one grid, one alpha and one time.

    Attributes
    ----------
    x : array, shape (N,)
        Positions, in ascending order.
    volumes : array, shape (N,)
        The length that each position stands for: sum_i volumes_i f(x_i) is the integral of f.
    """

    @property
    def x(self) -> np.ndarray:
        """Positions, shape (N,)."""

    @property
    def volumes(self) -> np.ndarray:
        """Quadrature weights, shape (N,)."""

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return the approximation of -(-Laplacian)^(alpha/2) u at x, shape (N,)."""

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return u at the time prepared for from u0 at time 0, shape (N,)."""


class Preparation(Protocol):
    """The call of `prepare`, the same for all peers."""

    def __call__(
        self,
        *,
        alpha: float,
        half_width: float,
        time: float,
        spacing: float | None = None,
        count: int | None = None,
        exterior: str = ...,
        propagation: str = ...,
    ) -> Solver:
        """Return the peer made ready.

        Parameters
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
            One of the peer's EXTERIORS and PROPAGATIONS; the first if left out.

        Raises
        ------
        InvalidInput
            If an argument is outside its range.
        """


class Peer(Protocol):
    """The names that every peer module defines."""

    NAME: str
    TITLE: str
    REFERENCE: str
    EXTERIORS: tuple[str, ...]  # what there is beyond the half-width
    PROPAGATIONS: tuple[str, ...]  # how the solution gets from 0 to t

    @property
    def prepare(self) -> Preparation:
        """Set-up, all that does not depend on the initial data."""


def check_choice(field: str, value: str, allowed: tuple[str, ...]) -> None:
    """Refuse what a peer does not have.

    Raises
    ------
    InvalidInput
        If value is not one of those allowed.
    """
    if value not in allowed:
        raise InvalidInput(
            field, value, f"one of {', '.join(allowed)} for this peer", "Choose one."
        )


def half_intervals(
    half_width: float, spacing: float | None, count: int | None, points: int = 1
) -> int:
    """Return n for a grid of 2 n + `points` positions, 2 n intervals or as many positions as `count` says.

    Raises
    ------
    InvalidInput
        If not just one of spacing and count is given, or it is outside its range.
    """
    if (spacing is None) == (count is None):
        raise InvalidInput(
            "spacing and count", (spacing, count), "just one of the two", "Leave the other out."
        )
    if spacing is not None:
        return max(1, round(half_width / positive_real("spacing", spacing)))
    given = positive_integer("count", count)
    if given < 2 or (given - points) % 2:
        parity = "odd" if points % 2 else "even"
        raise InvalidInput("count", given, f"an {parity} number > 1", "Add one point.")
    return (given - points) // 2
