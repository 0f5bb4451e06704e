"""`fracparticles solve`: one flag for each field of `Case`, made from the model itself."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypedDict

from cyclopts import Parameter

from fracparticles.errors import InvalidInput, spelled
from fracparticles.files import replaceable
from fracparticles.run.case import Case
from fracparticles.run.cli import number_or_text
from fracparticles.run.complaints import choices_of, takes_numbers

__all__ = ["solve"]

_ALIASES = {"dt": "--time-step"}


def _flag(name: str) -> Any:
    field = Case.model_fields[name]
    choices = choices_of(field.annotation)
    notes = [
        f"[one of: {spelled(choices, ', ')}]" if choices else "",
        f"[default: {field.default}]" if field.default and not field.is_required() else "",
    ]
    return Annotated[
        str,
        Parameter(
            alias=_ALIASES.get(name),
            metavar="NUMBER" if takes_numbers(field.annotation) else "TEXT",
            help=" ".join(filter(None, [field.description, *notes])),
        ),
    ]


if TYPE_CHECKING:
    Flags = dict[str, Any]
else:
    Flags = TypedDict("Flags", {name: _flag(name) for name in Case.model_fields}, total=False)


def solve(
    *,
    flags: Annotated[Flags | None, Parameter(name="*")] = None,
    output: Annotated[str | None, Parameter(alias="-o")] = None,
) -> None:
    """Run a case, write its file and print its path.

    Parameters
    ----------
    output : str
        The NetCDF file to write.
    """
    target = _writable(output)
    numbers = {name for name, field in Case.model_fields.items() if takes_numbers(field.annotation)}
    case = Case(**{
        name: number_or_text(text) if name in numbers else text
        for name, text in (flags or {}).items()
    })  # fmt: skip

    from fracparticles.run.dataset import write
    from fracparticles.run.solver import solve as run

    write(run(case), target)
    print(target)


def _writable(output: str | None) -> Path:
    """Return the path of the output if it can be written, before any work is done."""
    if output is None:
        raise InvalidInput("output", None, "the path of the file to write", "Give -o run.nc.")
    folder, where = replaceable(output, "output").parent, "a file in a directory that"
    if not folder.is_dir():
        raise InvalidInput("output", output, f"{where} exists", f"Make {str(folder)!r} first.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InvalidInput("output", output, f"{where} can be written", "Choose another one.")
    return Path(output)
