"""An operator in its modes, and the common part of all steps between their amplitudes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from fracparticles.arguments import FloatArray
from fracparticles.time.steps import norm

__all__ = ["Held", "ModalSteps", "Modes", "Rest", "size_of"]

Rest = Callable[[float, FloatArray], FloatArray]
"""N(t, u), between fields."""

Held = Callable[[float], FloatArray]
"""From a time to the size of the field that is added to that of the steps; the tolerance is relative to it at least."""


def size_of(y: Any) -> float:
    """Return the 2-norm of amplitudes, real or complex, of any size."""
    return norm(np.abs(y))


class Modes(NamedTuple):
    """The rates of the modes of an operator, and the maps from fields to amplitudes and back; |y|^2 = int u^2."""

    rates: FloatArray
    into: Callable[[FloatArray], Any]
    back: Callable[[Any], FloatArray]


class ModalSteps:
    """Steps of u' = A u + N(t, u), with A in its modes: y' = -lambda y + N(y, t).

    Parameters
    ----------
    modes : Modes
        The modes of -A.
    rest : callable
        N.
    tolerance : float
        The error of each step, relative to the norm of u, or to that of `held` at the time if this is larger.
    held : callable, optional
        See `Held`.

    Attributes
    ----------
    accepted : int
        Steps taken.
    rejected : int or None
        Steps thrown away; None if they are not counted.
    largest : float
        The greatest |lambda|; zero where no eigenvalue limits the steps.
    """

    rejected: int | None = None

    def __init__(
        self, modes: Modes, rest: Rest, tolerance: float, held: Held | None = None
    ) -> None:
        self._modes, self._rest, self._tolerance, self._held = modes, rest, tolerance, held
        self.accepted, self.largest = 0, 0.0
        self._h: float | None = None

    def _size(self, t: float, y: Any) -> float:
        """Return the size to which the tolerance is relative."""
        held = 0.0 if self._held is None else size_of(self._modes.into(self._held(t)))
        return max(size_of(y), held)

    def field(self, amplitudes: Any) -> FloatArray:
        """Return the field of some amplitudes."""
        return self._modes.back(amplitudes)

    def forget(self) -> None:
        """Let the next step find its length anew."""
        self._h = None
