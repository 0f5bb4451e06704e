"""`fracparticles solve` and `limit`: the flags are fields of `Case`, made from the model itself."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from decimal import ROUND_FLOOR, Context
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Required, TypedDict

from cyclopts import Parameter

from fracparticles.arguments import positive_real
from fracparticles.data.tables import not_a_table
from fracparticles.errors import InvalidInput, spelled
from fracparticles.files import replaceable
from fracparticles.run.case import Case
from fracparticles.run.complaints import choices_of, takes_lists, takes_numbers
from fracparticles.run.fractional_order import ALPHA, with_beta
from fracparticles.schemes import scheme as find_scheme
from fracparticles.schemes.stability import stability_limit

__all__ = ["limit", "number_or_text", "solve"]

_ALIASES = {"dt": "--time-step"}
_NEEDED = ("scheme",)  # flags that `limit` needs; for `solve`, `Case` refuses what is missing
_OF_A_LIMIT = (
    *_NEEDED,
    "beta",
    "order",
    "overlap",
    "dim",
    "kernel_family",
    "spacing",
    "diffusivity",
)
_NUMBERS = {name for name, field in Case.model_fields.items() if takes_numbers(field.annotation)}
_LISTS = {name for name, field in Case.model_fields.items() if takes_lists(field.annotation)}


def _flag(name: str, kind: Any = str) -> Any:
    field = Case.model_fields[name]
    choices = choices_of(field.annotation)
    notes = [
        f"[one of: {spelled(choices, ', ')}]" if choices else "",
        f"[default: {field.default}]" if field.default and not field.is_required() else "",
    ]
    return Annotated[
        kind,
        Parameter(
            alias=_ALIASES.get(name),
            metavar="NUMBER" if name in _NUMBERS else "NUMBERS" if name in _LISTS else "TEXT",
            help=" ".join(filter(None, [field.description, *notes])),
        ),
    ]


if TYPE_CHECKING:
    Flags = dict[str, Any]
    LimitFlags = dict[str, Any]
else:
    _ALPHA = {"alpha": Annotated[str, Parameter(metavar="NUMBER", help=ALPHA)]}
    _CASE = {name: _flag(name) for name in Case.model_fields}
    Flags = TypedDict("Flags", _ALPHA | _CASE, total=False)
    _LIMIT = _ALPHA | {name: _flag(name) for name in _OF_A_LIMIT}
    _LIMIT |= {name: _flag(name, Required[str]) for name in _NEEDED}
    LimitFlags = TypedDict("LimitFlags", _LIMIT, total=False)


def solve(
    *,
    flags: Annotated[Flags | None, Parameter(name="*")] = None,
    output: Annotated[str | None, Parameter(alias="-o")] = None,
    estimate: Annotated[bool, Parameter(negative="")] = False,
    units: str | None = None,
) -> None:
    """Run a case, write its file and print its path.

    Parameters
    ----------
    output : str
        The NetCDF file to write.
    estimate : bool
        Estimate the error against the whole space, store it with its parts, and print it.
    units : str
        Names of the units of length, time and concentration, for the file and the axes of plots: m,d,mg/L.
    """
    target = _writable(output)
    case = Case(**_values(flags or {}))

    from fracparticles.command_line.progress import on_terminal
    from fracparticles.run.dataset import write
    from fracparticles.run.solve import solve as run
    from fracparticles.run.units import Units

    named = None if units is None else Units.read(units)
    with on_terminal("solving") as progress:
        result = run(case, estimate=estimate, units=named, progress=progress)
    write(result, target)
    print(target)
    if estimate:
        errors = result.estimated_error.values.reshape(-1)
        at = f" at t = {spelled((f'{t:g}' for t in case.times), ', ')}" if case.times else ""
        _note(f"estimated relative error {spelled((f'{e:.1e}' for e in errors), ', ')}{at}")


_DOWN = Context(prec=6, rounding=ROUND_FLOOR)  # downwards, so that the printed step is stable, too


def limit(*, flags: Annotated[LimitFlags, Parameter(name="*")]) -> None:
    """Print the stability limit a of Eq. (55), and with --spacing the largest stable time step.

    Explicit Euler and the midpoint rule are stable for D dt / h^alpha <= a, Eq. (56). A single step of GPSE, over the
    whole time, has no limit.
    """
    given = with_beta(_values(flags))
    if "beta" not in given:
        raise InvalidInput("beta", None, "a number between 0 and 1", "Give --beta, or --alpha.")
    scheme = find_scheme(given["scheme"])
    if "overlap" in given and not scheme.has_kernel:
        without = f"nothing for {scheme.name}, which has no kernel"
        raise InvalidInput("overlap", given["overlap"], without, "Leave it out.")
    kernels = {name: given[name] for name in ("order", "overlap", "dim") if name in given}
    a = stability_limit(scheme.name, given["beta"], family=given.get("kernel_family"), **kernels)
    rate = positive_real("diffusivity", given.get("diffusivity", 1.0))
    lines = [f"a = {a:.6g}"]
    if "spacing" in given:
        h = positive_real("spacing", given["spacing"])
        dt = a * h ** (1.0 + given["beta"]) / rate
        lines.append(f"dt = {float(_DOWN.create_decimal(dt)):.6g}")
    print("\n".join(lines))
    if scheme.self_timed:
        whole = f"a single step of {scheme.name}, over the whole time, has no limit"
        _note(f"this limits repeated steps; {whole}")
    if a == 0.0:
        _note("no step is stable, some wave grows: take a larger overlap or a lower order")


def number_or_text(text: str) -> Any:
    """Return the number that the text stands for, or the text if it is no number.

    1_0, which Python reads as ten, is taken as text, since it may be a slip of 1.0.
    """
    for number in (int, float) if "_" not in text else ():
        try:
            return number(text)
        except ValueError:
            continue
    return text


def _values(flags: Mapping[str, str]) -> dict[str, Any]:
    """The values of the flags, numbers where they can be read. Other text is refused by the fields, as in Python."""
    return {name: _value(name, text) for name, text in flags.items()}


def _value(name: str, text: str) -> Any:
    if name in _LISTS:  # "0.6,1,1.5"
        return [number_or_text(part) for part in text.split(",")]
    return number_or_text(text) if name in _NUMBERS or name == "alpha" else text


def _note(text: str) -> None:
    print(f"note: {text}", file=sys.stderr)


def _writable(output: str | None) -> Path:
    """Return the path of the output, and refuse one that cannot be written before any work is done."""
    if output is None:
        raise InvalidInput("output", None, "the path of the file to write", "Give -o run.nc.")
    folder, where = replaceable(output, "output").parent, "a file in a directory that"
    not_a_table(output, "output")
    if not folder.is_dir():
        raise InvalidInput("output", output, f"{where} exists", f"Make {str(folder)!r} first.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InvalidInput("output", output, f"{where} can be written", "Choose another one.")
    return Path(output)
