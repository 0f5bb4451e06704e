"""What can go wrong, each with one clear line."""

from __future__ import annotations

__all__ = [
    "AccuracyWarning",
    "FracparticlesError",
    "FracparticlesWarning",
    "InvalidInput",
    "NonFiniteSolution",
    "StabilityWarning",
]

_LONGEST = 200  # characters of a value that a message shows


class FracparticlesError(Exception):
    """Base class of every error that the package raises on purpose."""


class InvalidInput(FracparticlesError, ValueError):
    """A value that cannot be worked with, refused before any work starts.

    Parameters
    ----------
    field : str
        Name of the offending field or argument.
    value : object
        The value that was given.
    allowed : str
        What is allowed, in words.
    remedy : str
        What to do about it.
    """

    def __init__(self, field: str, value: object, allowed: str, remedy: str) -> None:
        super().__init__(field, value, allowed, remedy)
        self.field, self.value, self.allowed, self.remedy = field, value, allowed, remedy

    def __str__(self) -> str:
        value = " ".join(repr(self.value).split())
        shown = value if len(value) <= _LONGEST else f"{value[:_LONGEST]}..."
        return f"{self.field} = {shown} is not allowed: {self.allowed}. {self.remedy}"


class NonFiniteSolution(FracparticlesError, ArithmeticError):
    """The particle strengths overflowed or became nan; says when and why."""


class FracparticlesWarning(UserWarning):
    """Base class of every warning of the package: the run is computed as it is, and may not be what is wanted."""


class StabilityWarning(FracparticlesWarning):
    """The discrete problem grows: the time step is too large, or the scheme amplifies some wave at any step."""


class AccuracyWarning(FracparticlesWarning):
    """The numbers may be far from the solution: names the quantity that says so and what would mend it."""
