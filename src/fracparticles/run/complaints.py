"""The fields of a model of pydantic in words: in a complaint of one line, as a label, in a table."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Literal, get_args, get_origin

import numpy as np
from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from fracparticles.errors import InvalidInput, closest, spelled

__all__ = [
    "allowed",
    "choices_of",
    "field_table",
    "first_complaint",
    "label_of",
    "takes_lists",
    "takes_numbers",
]


def first_complaint(
    error: ValidationError, model: type[BaseModel], elsewhere: Mapping[str, str]
) -> InvalidInput:
    """Turn one complaint of pydantic into one line of ours; `elsewhere` says where other names belong.

    It is the first, or that of an unknown name: a misspelt field is missing, too.
    """
    complaints = error.errors()
    unknown = (one for one in complaints if one["type"] == "extra_forbidden")
    first = next(unknown, complaints[0])
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, InvalidInput):  # one of our own checks
        return cause
    value, fields = first["input"], model.model_fields
    # A name that is not UTF-8 has no place: there the value is the name.
    name = str(first["loc"][0] if first["loc"] else value)
    if first["type"] in ("extra_forbidden", "string_unicode") and name not in fields:
        names = [*fields, "alpha"]  # every model has beta, for which alpha may be given
        remedy = elsewhere.get(name) or closest(name, names) or "Leave it out."
        return InvalidInput(name, value, f"only the fields {spelled(names, ' and ')}", remedy)
    if first["type"] == "missing":
        remedy = _remedy(fields[name]) or f"Give {name}."
        return InvalidInput(name, None, allowed(fields[name]), remedy)
    remedy = closest(value, choices_of(fields[name].annotation)) or _remedy(fields[name])
    several = isinstance(value, list | tuple | np.ndarray)
    if several and takes_numbers(kind := fields[name].annotation) and not takes_lists(kind):
        times = " Output times are given by times=." if name == "t_final" else ""
        remedy = f"Give one number, not several.{times}"
    return InvalidInput(name, value, allowed(fields[name]), remedy or "Give such a value.")


def _remedy(field: FieldInfo) -> str:
    """The remedy that is stored with the field, or an empty text."""
    extra = field.json_schema_extra
    return str(extra.get("remedy", "")) if isinstance(extra, dict) else ""


def allowed(field: FieldInfo) -> str:
    """Return the allowed values of a field in words: its choices, the bounds of a number, or its description."""
    choices = choices_of(field.annotation)
    if choices:
        return f"one of {spelled(choices, ', ')}"
    if field.annotation is str:
        return "text"
    if takes_lists(field.annotation):
        return "a list of numbers"
    bounds = {
        name: getattr(bound, name)
        for bound in field.metadata
        for name in ("gt", "ge", "lt", "le")
        if hasattr(bound, name)
    }
    low, high = bounds.get("gt", bounds.get("ge")), bounds.get("lt", bounds.get("le"))
    if low is None or high is None:
        # A coefficient: the second sentence of its description says what is allowed.
        _, *said = (field.description or "").split(". ")
        return said[0].rstrip(".")[:1].lower() + said[0].rstrip(".")[1:] if said else "a value"
    return f"a number between {low:g} and {high:g}{' (exclusive)' if 'lt' in bounds else ''}"


def choices_of(annotation: Any) -> tuple[Any, ...]:
    """Return the values of the Literal in the annotation of a field, () if there is none."""
    if get_origin(annotation) is Literal:
        return get_args(annotation)
    return next(filter(None, map(choices_of, get_args(annotation))), ())


def takes_numbers(annotation: Any) -> bool:
    """Return whether a field with this annotation takes numbers."""
    kinds = {annotation, *get_args(annotation), *map(type, choices_of(annotation))}
    return not kinds.isdisjoint((int, float))


def takes_lists(annotation: Any) -> bool:
    """Return whether a field with this annotation takes several numbers."""
    return tuple in (get_origin(annotation), *map(get_origin, get_args(annotation)))


def label_of(field: FieldInfo) -> str:
    """Return the first sentence of the description of a field, as a label: "time step"."""
    words = " ".join((field.description or "").split())
    first = re.split(r"\.(?= [^(]|$)", words)[0]  # "Eq. (46)" ends no sentence
    return first[0].lower() + first[1:] if first[1:2].islower() else first


def field_table(model: type[BaseModel]) -> str:
    """Return a table of the fields of a model in Markdown: the meaning, the choices and the default of each."""
    lines = ["| field | meaning | default |", "|---|---|---|"]
    for name, field in model.model_fields.items():
        meaning = " ".join((field.description or "").split()).replace("|", r"\|")
        choices = spelled(f"`{choice}`" for choice in choices_of(field.annotation))
        given = not field.is_required() and field.default is not None
        default = f"`{field.default}`" if given else ""
        lines.append(
            f"| `{name}` | {meaning}{f' One of {choices}.' if choices else ''} | {default} |"
        )
    return "\n".join(lines)
