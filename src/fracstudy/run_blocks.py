"""The runs of a scene: blocks of fields of a case, each with one value or a list, and the cases that they stand for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import product
from typing import Any, Union

from pydantic import BaseModel, ConfigDict, Field, create_model

from fracparticles.run.case import Case
from fracparticles.run.complaints import takes_lists

__all__ = ["RunBlock", "expand"]


def _value_or_list(annotation: Any) -> Any:
    return Union[annotation, list[annotation], None]  # noqa: UP007  (an annotation known at run time only)


# Output times are a list themselves, which is one value.
_FIELDS: dict[str, Any] = {
    name: (
        list[float] | None if takes_lists(field.annotation) else _value_or_list(field.annotation),
        Field(default=None),
    )
    for name, field in Case.model_fields.items()
}
_FIELDS["alpha"] = (_value_or_list(float), Field(default=None))  # instead of beta
RunBlock: type[BaseModel] = create_model(
    "RunBlock",
    __config__=ConfigDict(extra="forbid", strict=True, frozen=True),
    __doc__="Fields of a case, each with one value or a list of values.",
    **_FIELDS,
)


def expand(blocks: Iterable[BaseModel | Mapping[str, Any]]) -> list[Case]:
    """Return the cases of run blocks, in order, without repeats."""
    cases: dict[str, Case] = {}
    for block in blocks:
        fields = block.model_dump(exclude_none=True) if isinstance(block, BaseModel) else block
        choices = [
            value if isinstance(value, list) and name != "times" else [value]
            for name, value in fields.items()
        ]
        for combination in product(*choices):
            case = Case(**dict(zip(fields, combination, strict=True)))
            case.refuse_point_mass()
            cases.setdefault(case.path, case)
    return list(cases.values())
