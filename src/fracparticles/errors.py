"""The errors and the warnings of the package, each with one clear line."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

__all__ = [
    "AccuracyWarning",
    "FracparticlesError",
    "FracparticlesWarning",
    "InvalidInput",
    "NonFiniteSolution",
    "StabilityWarning",
    "one_of",
    "reason_of",
    "spelled",
]

_LONGEST = 200  # characters of a value that a message shows
_MOST_NUMBERS = 12  # numbers of an array that a message shows; of more it shows the shape


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
        value = " ".join(_shown(self.value).split())
        shown = value if len(value) <= _LONGEST else f"{value[:_LONGEST]}..."
        line = f"{self.field} = {shown} is not allowed: {self.allowed}. {self.remedy}"
        return " ".join(line.split())  # a name may hold a line feed, too


def _shown(value: Any) -> str:
    """Return the value as text; for an array of many numbers its shape and type, since the first numbers say little."""
    if getattr(value, "size", 0) > _MOST_NUMBERS and hasattr(value, "dtype"):
        return f"array of shape {value.shape} and type {value.dtype}"
    return repr(value)


def spelled(values: Iterable[object], last: str = " or ") -> str:
    """Return a list in words: "2, 4 or 6"; None is "nothing" there, and texts beside it are in quotes."""
    values = list(values)
    words = [str(one) for one in values]
    if None in values:
        words = ["nothing" if one is None else repr(one) for one in values]
    return last.join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def one_of(
    field: str,
    value: object,
    choices: Iterable[object],
    where: str = "",
    remedy: str = "Choose one of these.",
) -> InvalidInput:
    """Return the error for a value that is none of the choices; `where` names what has only these."""
    allowed = f"{spelled(choices)} for {where}" if where else f"one of {spelled(choices, ', ')}"
    return InvalidInput(field, value, allowed, remedy)


def reason_of(error: Exception) -> str:
    """Return what an error of a library says, in one short line, or its name if it says nothing."""
    return str(error).splitlines()[0][:120] if str(error) else type(error).__name__


class NonFiniteSolution(FracparticlesError, ArithmeticError):
    """The particle strengths overflowed or became nan; says when and why."""


class FracparticlesWarning(UserWarning):
    """Base class of every warning of the package: the run is computed as it is, and may not be what is wanted."""


class StabilityWarning(FracparticlesWarning):
    """The discrete problem grows: the time step is too large, or the scheme amplifies some wave at any step."""


class AccuracyWarning(FracparticlesWarning):
    """The numbers may be far from the solution: names the quantity that says so and what would mend it."""
