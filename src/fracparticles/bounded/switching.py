"""Steps that are explicit beside the modes until they are too many, and implicit from there on.

A source may be slow at first and fast later, as where a mixture ignites, and a flux form may have a D that is steep.
The explicit steps of `exponential` then follow the fastest rate of N, those of `implicit` do not.
"""

from __future__ import annotations

from collections.abc import Callable

from fracparticles.arguments import FloatArray
from fracparticles.bounded.exponential import ExponentialSteps, TooManySteps
from fracparticles.bounded.implicit import ImplicitSteps

__all__ = ["SwitchingSteps"]

_MOST = 2000  # explicit steps to one time


class SwitchingSteps:
    """Steps of u' = A u + N(t, u).

    Parameters
    ----------
    explicit : ExponentialSteps
        It takes the first steps.
    implicit : callable
        Makes the steps that go on.
    """

    def __init__(self, explicit: ExponentialSteps, implicit: Callable[[], ImplicitSteps]) -> None:
        self._explicit, self._make = explicit, implicit
        self._implicit: ImplicitSteps | None = None
        explicit.most = _MOST

    @property
    def accepted(self) -> int:
        """Steps taken."""
        return self._explicit.accepted + (self._implicit.accepted if self._implicit else 0)

    @property
    def rejected(self) -> int | None:
        """Steps thrown away; None if they are not counted."""
        return None if self._implicit else self._explicit.rejected

    @property
    def largest(self) -> float:
        """The greatest |lambda|; zero as long as the steps are explicit."""
        return self._implicit.largest if self._implicit else 0.0

    def advance(self, u: FloatArray, span: float, start: float = 0.0) -> FloatArray:
        """Return u after the time `span`; raises `NonFiniteSolution` as both kinds of steps do."""
        if self._implicit is None:
            try:
                return self._explicit.advance(u, span, start)
            except TooManySteps as stopped:
                self._implicit = self._make()
                u = self._explicit.field(stopped.amplitudes)
                span, start = start + span - stopped.time, stopped.time
        return self._implicit.advance(u, span, start)

    def forget(self) -> None:
        """Let the next step find its length anew."""
        for steps in (self._explicit, self._implicit):
            if steps is not None:
                steps.forget()
