"""The base of `Case` and `Problem`: a model of pydantic that refuses wrong fields with one line of ours."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, ValidationError

from fracparticles.arguments import plain
from fracparticles.errors import InvalidInput
from fracparticles.run.complaints import allowed, first_complaint

__all__ = ["Checked", "stored_fields"]


class Checked(BaseModel):
    """A model whose fields are keyword only, are checked when it is made, and do not change.

    Raises
    ------
    InvalidInput
        Names the field, the value, what is allowed and what to do.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    elsewhere: ClassVar[Mapping[str, str]] = {}
    """Names that are no field of this model, and where they belong."""

    def __init__(self, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise first_complaint(error, type(self), self.elsewhere) from None

    @classmethod
    def _plain_values(cls, data: dict[str, Any]) -> dict[str, Any]:
        """Return the fields with scalars of NumPy and xarray as Python numbers; True is not a number."""
        data = {name: plain(value) for name, value in data.items()}
        for name, field in cls.model_fields.items():
            truth = isinstance(data.get(name), bool)  # True == 1, which Literal takes
            if truth and field.annotation is not Any:
                raise InvalidInput(name, data[name], allowed(field), "Give such a value.")
        return data

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a new model with other values of some fields, checked like any new one.

        Pydantic's own method copies cached properties, too, such as the time step of the old dt.
        """
        return type(self)(**{**self.model_dump(exclude_unset=True), **(update or {})})

    @classmethod
    def _read(cls, text: str) -> dict[str, Any]:
        """Return the fields that `to_json` wrote."""
        fields = stored_fields(text)
        if fields is None:
            name = cls.__name__
            remedy = f"Give what {name}.to_json returns."
            raise InvalidInput(name.lower(), text, "a JSON object", remedy)
        return fields


def stored_fields(text: Any) -> dict[str, Any] | None:
    """Return the fields of a JSON object, as a file holds them; None if the text is not one."""
    try:
        fields = json.loads(text)
    except (TypeError, ValueError, RecursionError):
        return None
    return fields if isinstance(fields, dict) else None
