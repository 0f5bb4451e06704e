"""The files of the scenes, `workflow/scenes/<document>/<scene>/scene.yaml`.

The changes of a smoke run stand beside the full values: any mapping may hold `smoke`, which is laid over it, and
`smoke: null` leaves the mapping out. A folder with `variants` stands for several scenes: each is the common part, with
its own part laid over it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml
from pydantic import BaseModel, ValidationError

from fracparticles.errors import InvalidInput, closest
from fracstudy.read_yaml import read_yaml
from fracstudy.run_blocks import RunBlock
from fracstudy.scene import Scene

__all__ = ["complaint", "merged", "read_scenes", "resolved"]

_Tree = Any  # of mappings, lists and values, as YAML gives it


def read_scenes(root: Path, documents: list[str], smoke: bool) -> dict[str, Scene]:
    """Return the scenes of the documents' folders below `root`, by name, in the order of the report.

    Raises
    ------
    InvalidInput
        Naming the file, the key, the value, what is allowed and what to do.
    """
    found: dict[str, Scene] = {}
    for document in documents:
        if not (root / document).is_dir():
            raise InvalidInput("documents", document, f"a folder of {root}", "Make it.")
        scenes = [
            scene
            for file in (root / document).glob("*/scene.yaml")
            for scene in _scenes_of(file, smoke)
        ]
        for scene in sorted(scenes, key=lambda scene: (scene.place, _natural(scene.name))):
            if scene.name in found:
                unique = "a name that no other scene has"
                raise InvalidInput("scene", scene.name, unique, "Rename one.")
            found[scene.name] = scene
    return found


def _natural(name: str) -> list[tuple[bool, int, str]]:
    """Sort `figure_2` before `figure_10`."""
    parts = re.split(r"(\d+)", name)
    return [(not part.isdigit(), int(part) if part.isdigit() else 0, part) for part in parts]


def _scenes_of(file: Path, smoke: bool) -> Iterator[Scene]:
    try:
        tree = read_yaml(file)
    # Also if it is not UTF-8, has a date that does not exist, or is too deep.
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        problem = " ".join(str(error).split())
        raise InvalidInput(str(file), problem, "YAML", "Mend the file.") from None
    if not isinstance(tree, dict):
        found = "an empty file" if tree is None else tree
        raise InvalidInput(str(file), found, "a mapping with title and runs", "Fill it in.")
    variants = tree.pop("variants", {file.parent.name: {}})
    if not (isinstance(variants, dict) and all(isinstance(own, dict) for own in variants.values())):
        raise InvalidInput(f"{file}: variants", variants, "mappings by name", "Mend them.")
    for name, own in variants.items():
        fields = resolved(merged(tree, own), smoke)
        for key in {"name", "folder"} & fields.keys():
            said = "left out: paths say it"
            raise InvalidInput(f"{file}: {key}", fields[key], said, "Remove it.")
        try:
            yield Scene.model_validate({**fields, "name": name, "folder": file.parent})
        except ValidationError as error:
            raise complaint(error, f"{file}: ", Scene) from None


def merged(base: _Tree, own: _Tree) -> _Tree:
    """Lay one tree over another: mappings by key, where null removes the key, lists of mappings item by item."""
    if isinstance(base, Mapping) and isinstance(own, Mapping):
        result = {**base}
        for key, value in own.items():
            if value is None and key != "smoke":
                result.pop(key, None)
            else:
                result[key] = merged(base[key], value) if key in base else value
        return result
    if _of_mappings(base) and _of_mappings(own):
        pairs = [merged(one, other) for one, other in zip(base, own, strict=False)]
        return pairs + base[len(own) :] + own[len(base) :]
    return own


def _of_mappings(tree: _Tree) -> bool:
    return isinstance(tree, list) and bool(tree) and all(isinstance(x, Mapping) for x in tree)


_DROPPED = object()


def resolved(tree: _Tree, smoke: bool) -> _Tree:
    """Return a tree without `smoke`: laid over the mapping that holds it in a smoke run, left out otherwise."""
    if isinstance(tree, Mapping):
        changes = tree.get("smoke", {})
        if smoke and changes is None:
            return _DROPPED
        own = {key: value for key, value in tree.items() if key != "smoke"}
        own = merged(own, changes) if smoke else own
        values = {key: resolved(value, smoke) for key, value in own.items()}
        return {key: value for key, value in values.items() if value is not _DROPPED}
    if isinstance(tree, list):
        values_ = [resolved(value, smoke) for value in tree]
        return [value for value in values_ if value is not _DROPPED]
    return tree


def complaint(error: ValidationError, where: str, model: type[BaseModel]) -> InvalidInput:
    """Return one mistake that pydantic found, in our words; `where` begins the name of the field.

    It is the first, or an unknown name: a misspelt key is missing, too.
    """
    unknown = (one for one in error.errors() if one["type"] == "extra_forbidden")
    first = next(unknown, error.errors()[0])
    # A field of a run block may be a value or a list. Pydantic complains about both, and names the kind of the value;
    # the first complaint is enough.
    kinds = ("float", "int", "str", "bool")
    parts = [str(part) for part in first["loc"]]
    place = [part for part in parts if "[" not in part and part not in kinds]
    field = where + (".".join(place) or "configuration")
    if first["type"] == "extra_forbidden":
        fields = (RunBlock if place[0] == "runs" else model).model_fields
        names = [name for name in fields if name not in ("name", "folder")]
        remedy = closest(place[-1], names) or "Remove it."
        return InvalidInput(field, first["input"], f"one of {', '.join(names)}", remedy)
    if first["type"] == "missing":
        return InvalidInput(field, None, "a value, which is needed", "Add it.")
    number = isinstance(first["input"], str) and "number" in first["msg"]
    hint = " YAML reads 1e-4 as text: write 1.0e-4." if number else ""
    if first["type"] == "list_type":
        hint = " Begin each item of a list with a dash."
    allowed = first["msg"].removeprefix("Input should be ")
    return InvalidInput(field, first["input"], allowed, f"Mend the value.{hint}")
