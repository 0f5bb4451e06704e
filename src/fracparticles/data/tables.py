"""Tables of numbers in text files: columns by name, and the units in their headings."""

from __future__ import annotations

import csv
import os
import re
from pathlib import Path

import numpy as np

from fracparticles.errors import InvalidInput, spelled

__all__ = ["is_table", "name_and_unit", "not_a_table", "read_table"]

_KNOWN = ("x", "y", "z", "u")  # names that are headings without a unit
_TABLES = (".csv", ".tsv", ".txt", ".dat")  # the ends of their file names


def is_table(path: str | os.PathLike[str]) -> bool:
    """Return whether a file is a table, by its name."""
    return Path(path).suffix.lower() in _TABLES


def not_a_table(path: str | os.PathLike[str], field: str) -> None:
    """Refuse the name of a table for a NetCDF file: it would be read as a table.

    Raises
    ------
    InvalidInput
        If the name ends like that of a table.
    """
    if is_table(path):
        allowed = f"a NetCDF file, and none that ends in {spelled(_TABLES)} like a table"
        raise InvalidInput(field, str(path), allowed, "Name it run.nc.")


def read_table(path: Path) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Return the columns of a table by name, and the units in their headings.

    Raises
    ------
    InvalidInput
        If there is no readable table of numbers with one name for each column.
    """
    lines, remark = _lines_of(path)
    separator = next((mark for mark in ";\t," if mark in lines[-1]), None)
    # The decimal mark is looked for in the rows of numbers: the first line may be names.
    comma = separator in (";", "\t") and any("," in line for line in lines[1:] or lines)
    if separator is None:
        rows = [line.split() for line in lines]
    else:
        rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=separator)]
    headings = None if _is_number(rows[0][0], comma) else rows.pop(0)
    if not rows:
        raise InvalidInput("file", str(path), "a table with numbers", "It has headings only.")
    count = len(rows[0])
    if headings is not None and separator is None:
        headings = _names_between_blanks(lines[0])
    if headings is None:
        headings = _names_in(remark, separator, count)
    if headings is None or (separator is not None and len(headings) == 1 < count):  # or a title
        headings = [f"column {k + 1}" for k in range(count)]
    elif len(headings) != count:
        one = f"a name for each of the {count} columns, and the first line is {lines[0].strip()!r}"
        raise InvalidInput("file", str(path), one, "Mend that line, or begin it with #.")
    numbers = _numbers_in(rows, comma, path)
    split = [name_and_unit(heading) for heading in headings]
    names = [name for name, _ in split]
    if len(set(names)) < len(names):
        raise InvalidInput(
            "file", str(path), "columns of different names", f"It has {spelled(names, ' and ')}."
        )
    return dict(zip(names, numbers.T, strict=True)), dict(split)


def _lines_of(path: Path) -> tuple[list[str], str]:
    """Return the lines of a text without blank ones and remarks, and the last remark before the first of them."""
    try:
        text = path.read_text("utf-8-sig")
    except FileNotFoundError:
        raise InvalidInput("file", str(path), "an existing file", "Check the path.") from None
    except (OSError, UnicodeDecodeError) as error:
        allowed, remedy = f"a readable table ({error})", "Write it as UTF-8."
        raise InvalidInput("file", str(path), allowed, remedy) from None
    lines: list[str] = []
    remark = ""
    for line in map(str.strip, text.splitlines()):
        if line.startswith("#"):
            remark = remark if lines else line.lstrip("# ")
        elif line:
            lines.append(line)
    if not lines:
        raise InvalidInput("file", str(path), "a table with numbers", "It is empty.")
    return lines, remark


def _numbers_in(rows: list[list[str]], comma: bool, path: Path) -> np.ndarray:
    """Return the numbers of the cells, shape (rows, columns); `comma`: that is the decimal mark."""
    count = len(rows[0])
    numbers = np.empty((len(rows), count))
    for number, row in enumerate(rows):
        if len(row) != count or not all(_is_number(cell, comma) for cell in row):
            shown = f"row {number + 1} of the numbers, {' '.join(row)!r}"
            allowed = f"a table of {count} numbers a row, and this is {shown}"
            raise InvalidInput("file", str(path), allowed, "Mend or remove the row.")
        numbers[number] = [float(cell.replace(",", ".") if comma else cell) for cell in row]
    if comma and any("." in cell for row in rows for cell in row):
        one = "one decimal mark, and it has commas and points in its numbers"
        raise InvalidInput("file", str(path), one, "Write thousands without a mark.")
    return numbers


def _names_between_blanks(line: str) -> list[str]:
    """Return the names in "c [mg/L]  x [m]"."""
    return re.findall(r"\S+(?:\s+[\[(][^\])]*[\])])?", line)


def _names_in(remark: str, separator: str | None, count: int) -> list[str] | None:
    """Return the headings in a remark above the numbers, like "# u x" of `numpy.savetxt`; None for another remark.

    Words are headings if there is one for each column, and one of them is x, y, z or u, or has a unit.
    """
    cells = _names_between_blanks(remark) if separator is None else remark.split(separator)
    found = [cell.strip() for cell in cells]
    split = [name_and_unit(one) for one in found]
    known = any(name.lower() in _KNOWN or unit for name, unit in split)
    return found if known and len(found) == count else None


def _is_number(text: str, comma: bool) -> bool:
    """Return whether a text is a number as tables have them: 1_0, which Python reads as ten, is not."""
    try:
        float(text.replace(",", ".") if comma else text)
    except ValueError:
        return False
    return "_" not in text


def name_and_unit(heading: str) -> tuple[str, str]:
    """Return "c", "mg/L" for "c [mg/L]" or "c (mg/L)", and "c", "" for "c"."""
    found = re.fullmatch(r"(.*?)\s*[\[(](.*)[\])]", heading.strip())
    return (found[1].strip(), found[2].strip()) if found else (heading.strip(), "")
