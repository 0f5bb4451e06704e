"""What can go wrong, each with one clear line."""

from __future__ import annotations

__all__ = ["FracparticlesError", "InvalidInput", "NonFiniteSolution", "StabilityWarning"]

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


class StabilityWarning(UserWarning):
    """The time step lies outside the stability interval: the run will blow up."""
