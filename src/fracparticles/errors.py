"""The errors and the warnings of the package, each with one clear line."""

from __future__ import annotations

from collections.abc import Iterable
from types import FunctionType, MethodType
from typing import Any

__all__ = [
    "AccuracyWarning",
    "FracparticlesError",
    "FracparticlesWarning",
    "InvalidInput",
    "NonFiniteSolution",
    "StabilityWarning",
    "closest",
    "one_of",
    "reason_of",
    "shown",
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
        The value that was given; None if none was.
    allowed : str
        What is allowed, in words.
    remedy : str
        What to do about it.
    """

    def __init__(self, field: str, value: object, allowed: str, remedy: str) -> None:
        super().__init__(field, value, allowed, remedy)
        self.field, self.value, self.allowed, self.remedy = field, value, allowed, remedy

    def __str__(self) -> str:
        value = " ".join(shown(self.value).split())
        value = value if len(value) <= _LONGEST else f"{value[:_LONGEST]}..."
        what = "is missing" if self.value is None else f"= {value} is not allowed"
        line = f"{self.field} {what}. Allowed: {self.allowed}. {self.remedy}"
        return " ".join(line.split())  # a name may hold a line feed, too


def shown(value: Any) -> str:
    """Return the value as text: an array of many numbers as its shape and type, a function as its name."""
    if isinstance(value, FunctionType | MethodType):
        return f"the function {value.__name__}"
    if (
        type(value).__module__ == "numpy" and getattr(value, "shape", None) == ()
    ):  # none of masked arrays
        value = value.item()
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


def closest(value: object, choices: Iterable[object]) -> str | None:
    """Return the question whether the choice nearest to `value` was meant; None if none is near."""
    import difflib

    if not isinstance(value, str):
        return None
    names = {str(choice).casefold(): choice for choice in choices}
    close = difflib.get_close_matches(value[:100].casefold(), names, n=1)
    return f"Did you mean {names[close[0]]!r}?" if close else None


def one_of(
    field: str,
    value: object,
    choices: Iterable[object],
    where: str = "",
    remedy: str = "",
) -> InvalidInput:
    """Return the error for a value that is none of the choices; `where` names what has only these."""
    choices = list(choices)
    remedy = remedy or closest(value, choices) or "Choose one of these."
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
