"""The files of the printed claims, and of the meanings of their words; the records are in `claims`."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import yaml
from pydantic import TypeAdapter, ValidationError

from fracstudy.claims import Sentence, Statement, Table, Value
from fracstudy.criteria import CONVENTIONS, Convention
from fracstudy.read_yaml import read_yaml
from fracstudy.verdicts import LedgerError

__all__ = ["read_claims", "read_conventions", "read_printed", "refuse_repeats"]


def read_printed(*paths: str | os.PathLike[str]) -> list[Value | Sentence]:
    """Read the printed claims of documents, each from one YAML file, or from those of a folder in the order of names.

    Two files may hold one sentence, each with statements of its own.

    Raises
    ------
    LedgerError
        If a file is not a list of valid records; if an id occurs twice; if a sentence occurs twice in a file, or in two
        files in different words.
    """
    found: list[Value | Sentence] = []
    quotes: dict[str, str] = {}
    for path in _files(paths):
        try:
            tree = read_yaml(path)
            trees = TypeAdapter(list[dict]).validate_python(tree)
            records = [record for tree in trees for record in _records(tree)]
        except (yaml.YAMLError, ValueError, KeyError) as error:  # not YAML, or not such a record
            raise LedgerError(f"{path}: {error}") from error
        found += records
        ids = [claim.id for record in found for claim in record.claims]
        refuse_repeats(ids, f"{path}: claimed twice")
        sentences = {record.name: record.words for record in records if record.name}
        refuse_repeats([r.name for r in records if r.name], f"{path}: named twice")
        for name, words in sentences.items():
            if quotes.setdefault(name, words) != words:
                raise LedgerError(f"{path}: {name} is quoted in other words elsewhere")
    return found


def _files(paths: Iterable[str | os.PathLike[str]]) -> Iterator[Path]:
    for path in map(Path, paths):
        yield from sorted(path.glob("*.yaml")) if path.is_dir() else [path]


def _records(record: dict[str, Any]) -> list[Value] | list[Sentence]:
    if "table" in record:
        return Table.model_validate(record).values()
    if "sentence" in record:
        return [Sentence.model_validate(record)]
    return [Value.model_validate(record)]


def read_claims(*paths: str | os.PathLike[str]) -> list[Value | Statement]:
    """Read the values and statements of documents, without the sentences that hold them."""
    return [claim for record in read_printed(*paths) for claim in record.claims]


def read_conventions(path: str | os.PathLike[str] = CONVENTIONS) -> dict[str, Convention]:
    """Read the meanings of the documents' words, which are the same in every row.

    Raises
    ------
    LedgerError
        If the file is not a mapping of words to valid conventions.
    """
    try:
        tree = read_yaml(Path(path))
        return TypeAdapter(dict[str, Convention]).validate_python(tree)
    except (yaml.YAMLError, ValidationError) as error:
        raise LedgerError(f"{path}: {error}") from error


def refuse_repeats(ids: Iterable[str], complaint: str) -> None:
    """Raise LedgerError, with the complaint and the names, if some occur twice."""
    if repeated := sorted(name for name, count in Counter(ids).items() if count > 1):
        raise LedgerError(f"{complaint}: {', '.join(repeated)}")
