"""What a model of pydantic complains about, in one line of ours: field, value, what is allowed, what to do."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from fracparticles.errors import InvalidInput

__all__ = ["allowed", "choices_of", "closest", "first_complaint", "takes_numbers"]


def first_complaint(error: ValidationError, model: type[BaseModel]) -> InvalidInput:
    """Turn the first complaint of pydantic into one line of ours."""
    first = error.errors()[0]
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, InvalidInput):  # one of our own checks
        return cause
    name, value = str(first["loc"][0]), first["input"]
    fields = model.model_fields
    if first["type"] == "extra_forbidden":
        return InvalidInput(
            name, value, f"one of {', '.join(fields)}", closest(name, fields) or "Leave it out."
        )
    if first["type"] == "missing":
        return InvalidInput(name, None, allowed(fields[name]), f"Give {name}.")
    remedy = closest(value, choices_of(fields[name].annotation)) or "Give such a value."
    return InvalidInput(name, value, allowed(fields[name]), remedy)


def allowed(field: FieldInfo) -> str:
    """Return in words what a field takes: its choices, or a number and its bounds."""
    choices = choices_of(field.annotation)
    if choices:
        return f"one of {', '.join(map(str, choices))}"
    if field.annotation is str:
        return "text"
    bounds = {
        name: getattr(bound, name)
        for bound in field.metadata
        for name in ("gt", "ge", "lt", "le")
        if hasattr(bound, name)
    }
    low, high = bounds.get("gt", bounds.get("ge")), bounds.get("lt", bounds.get("le"))
    return f"a number between {low:g} and {high:g}{' (exclusive)' if 'lt' in bounds else ''}"


def choices_of(annotation: Any) -> tuple[Any, ...]:
    """Return the values of the Literal in the annotation of a field, () if there is none."""
    if get_origin(annotation) is Literal:
        return get_args(annotation)
    return next(filter(None, map(choices_of, get_args(annotation))), ())


def takes_numbers(annotation: Any) -> bool:
    """Say whether a field with this annotation takes numbers."""
    kinds = {annotation, *get_args(annotation), *map(type, choices_of(annotation))}
    return not kinds.isdisjoint((int, float))


def closest(value: object, choices: Iterable[object]) -> str | None:
    """Return the question whether the choice nearest to `value` was meant."""
    import difflib

    if not isinstance(value, str):
        return None
    names = {str(choice).casefold(): choice for choice in choices}
    close = difflib.get_close_matches(value[:100].casefold(), names, n=1)
    return f"Did you mean {names[close[0]]!r}?" if close else None
