"""Every docstring of the library is one that the site can be built from."""

from __future__ import annotations

from pathlib import Path

import griffe

PACKAGE = Path(__file__).parents[1] / "src"


def test_docstrings_are_read_without_a_complaint(caplog):
    """The study stops at its site where one names a parameter that does not exist, say for want of a heading."""
    parse_all(griffe.load("fracparticles", search_paths=[PACKAGE], docstring_parser="numpy"))
    assert [record.getMessage() for record in caplog.records if record.name == "griffe"] == []


def parse_all(thing: griffe.Object) -> None:
    if thing.docstring is not None:
        assert thing.docstring.parsed
    for member in thing.members.values():
        if isinstance(member, griffe.Object):
            parse_all(member)
