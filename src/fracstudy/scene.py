"""A scene: one folder `workflow/scenes/<document>/<scene>/`, found by its path.

    scene.yaml     title, runs, and what else the fields of `Scene` say
    study.py       study(inputs, **parameters) -> Result, and NEEDS, the values that fields of its runs must have;
                   without it the table of the runs
    figure.py      figure(series, table, **parameters) -> Figure; without it there is no figure
    benchmark.py   benchmark(**parameters) -> data set of run times, if the scene measures any
    caption.md     what is shown, how to read it, what follows

What a smoke run changes stands beside the full value: any mapping may hold `smoke`, which is laid over it, and
`smoke: null` leaves it out. A folder with `variants` stands for several scenes: the common part, and over it its own.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from importlib import import_module
from itertools import product
from pathlib import Path
from typing import Any, Union

import yaml
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError, create_model

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracparticles.run.complaints import closest, takes_lists
from fracstudy.read_yaml import read_yaml

__all__ = [
    "RunBlock",
    "Scene",
    "call",
    "check_parameters",
    "complaint",
    "expand",
    "merged",
    "read_scenes",
    "resolved",
]

_Tree = Any  # of mappings, lists and values, as YAML gives it


def _value_or_list(annotation: Any) -> Any:
    return Union[annotation, list[annotation], None]  # noqa: UP007  (an annotation known at run time only)


# Output times are a list themselves, taken whole.
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


class Scene(BaseModel):
    """One figure, table or study.

    Attributes
    ----------
    name : str
        Its name: that of the folder, or of the variant. It is the target, and the name of its results.
    folder : Path
        Where its files are.
    title : str
        Heading in the report; `{beta}` in it is what all runs have, or a parameter, of that name.
    place : int
        Where in its document it stands: smaller numbers first, then by name.
    items : list of str
        Items of the inventory whose claims it judges; empty for a study of our own.
    study : str, optional
        `<document>/<folder>` of another scene, whose study and figure it takes.
    parameters : dict
        What the study and the figure need beyond the runs: the keywords of their functions.
    runs : list of RunBlock
        The cases.
    tables : list of str
        Scenes whose tables it reads.
    benchmarks : list of str
        Scenes whose benchmarks it reads; its own, if it has one, is always among them.
    benchmark : dict, optional
        The keywords of its own benchmark.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    name: str
    folder: Path = Field(strict=False)
    title: str = Field(min_length=1)
    place: int = 100
    items: list[str] = []
    study: str | None = None
    parameters: dict[str, Any] = {}
    runs: list[RunBlock] = []
    tables: list[str] = []
    benchmarks: list[str] = []
    benchmark: dict[str, Any] | None = None

    def packed(self, runs: bool = False) -> dict[str, Any]:
        """Return what `Scene(**packed)` makes the scene of, in another process; its runs are left out unless asked for.

        Not as JSON, in which the numbers that are keys of a parameter would become text.
        """
        fields = self.model_dump(exclude=None if runs else {"runs"}, exclude_none=True)
        return {**fields, "folder": str(self.folder)}

    def where(self, key: str) -> str:
        """Return the place of a key, for complaints: its file, and the key."""
        return f"{self.folder / 'scene.yaml'}: {key}"

    @property
    def document(self) -> str:
        """The name of the document's folder."""
        return self.folder.parent.name

    def file(self, kind: str) -> Path | None:
        """Return the file "study.py", "figure.py", "benchmark.py" or "caption.md" of the scene, None without it."""
        own = self.study is None or kind in ("benchmark.py", "caption.md")
        folder = self.folder if own else self.folder.parents[1] / str(self.study)
        return folder / kind if (folder / kind).is_file() else None

    @cached_property
    def cases(self) -> list[Case]:
        """The cases of its runs, in order, without repeats.

        Raises
        ------
        InvalidInput
            For a case that is not allowed, with the scene's file.
        """
        try:
            return expand(self.runs)
        except InvalidInput as error:
            where = self.where(f"runs: {error.field}")
            raise InvalidInput(where, error.value, error.allowed, error.remedy) from None

    @property
    def heading(self) -> str:
        """The title, with the values that it asks for.

        Raises
        ------
        InvalidInput
            If it asks for what is no parameter, and not the same in all runs.
        """
        known = dict(self.parameters)
        for name in Case.model_fields.keys() - known.keys() if self.cases else ():
            first, *others = {getattr(case, name) for case in self.cases}
            if not others:
                known[name] = first
        try:
            return self.title.format(**known)
        except (KeyError, IndexError, ValueError) as error:
            allowed = f"text with {{}} around {', '.join(sorted(known))}"
            raise InvalidInput(self.where("title"), self.title, allowed, str(error)) from None

    @property
    def needs(self) -> dict[str, list[Any]]:
        """What the runs must hold for the study: values of fields of a case, `NEEDS` of study.py."""
        return getattr(sys.modules[self.function("study").__module__], "NEEDS", {})

    def function(self, kind: str) -> Callable[..., Any]:
        """Return the function `kind` of `<kind>.py`; without a study, the table of the runs."""
        file = self.file(f"{kind}.py")
        if file is None:
            if kind != "study":
                raise InvalidInput(kind, self.name, f"a scene with {kind}.py", f"Write {kind}.py.")
            from fracstudy.run_table import study

            return study
        root = str(file.parents[3])  # of the package `scenes`
        if root not in sys.path:
            sys.path.insert(0, root)
        return getattr(import_module(".".join([*file.parts[-4:-1], kind])), kind)

    @cached_property
    def all_benchmarks(self) -> list[str]:
        """The scenes whose benchmarks it reads, its own included."""
        own = [] if self.benchmark is None else [self.name]
        return own + [name for name in self.benchmarks if name != self.name]


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
    # Also what is not UTF-8, no such date, or too deep.
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        problem = " ".join(str(error).split())
        raise InvalidInput(str(file), problem, "YAML", "Mend the file.") from None
    if not isinstance(tree, dict):
        raise InvalidInput(str(file), tree, "a mapping with title and runs", "Fill it in.")
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


def call(function: Callable[..., Any], *arguments: Any, **parameters: Any) -> Any:
    """Call a study, figure or benchmark with those of the parameters that it takes."""
    taken = inspect.signature(function).parameters
    return function(*arguments, **{k: v for k, v in parameters.items() if k in taken})


def complaint(error: ValidationError, where: str, model: type[BaseModel]) -> InvalidInput:
    """Return the first mistake that pydantic found, in our words."""
    first = error.errors()[0]
    # A run block's field may be a value or a list: pydantic complains about both; the first will do.
    place = [str(part) for part in first["loc"] if not (isinstance(part, str) and "[" in part)]
    field = where + (".".join(place) or "configuration")
    if first["type"] == "extra_forbidden":
        fields = (RunBlock if place[0] == "runs" else model).model_fields
        names = [name for name in fields if name not in ("name", "folder")]
        remedy = closest(place[-1], names) or "Remove it."
        return InvalidInput(field, first["input"], f"one of {', '.join(names)}", remedy)
    if first["type"] == "missing":
        return InvalidInput(field, None, "needed", "Add it.")
    number = isinstance(first["input"], str) and "number" in first["msg"]
    hint = " YAML reads 1e-4 as text: write 1.0e-4." if number else ""
    allowed = first["msg"].removeprefix("Input should be ")
    return InvalidInput(field, first["input"], allowed, f"Mend the value.{hint}")


def check_parameters(scene: Scene) -> None:
    """Check the parameters of a scene against the functions that take them: names, and types where they are given.

    Raises
    ------
    InvalidInput
        For a parameter that none of them takes, one that is needed and left out, or one of the wrong type.
    """
    kinds = [kind for kind in ("study", "figure") if kind == "study" or scene.file("figure.py")]
    functions = [scene.function(kind) for kind in kinds]
    _check_keywords(scene, "parameters", scene.parameters, functions)
    if scene.benchmark is not None:
        _check_keywords(scene, "benchmark", scene.benchmark, [scene.function("benchmark")])


def _check_keywords(
    scene: Scene, key: str, given: Mapping[str, Any], functions: list[Callable[..., Any]]
) -> None:
    where = scene.where(key)
    keywords = {
        name: (parameter, function.__globals__)
        for function in functions
        for name, parameter in inspect.signature(function).parameters.items()
        if name not in ("inputs", "series", "table")
    }
    for name in given:
        if name not in keywords:
            remedy = closest(name, keywords) or "Remove it."
            taken = f"one of {', '.join(keywords)}" if keywords else "none: the study takes none"
            raise InvalidInput(f"{where}.{name}", given[name], taken, remedy)
    for name, (parameter, names) in keywords.items():
        if name not in given:
            if parameter.default is parameter.empty:
                raise InvalidInput(f"{where}.{name}", None, "needed by the study", "Add it.")
        elif parameter.annotation is not parameter.empty:
            try:
                written = parameter.annotation
                kind = eval(written, names) if isinstance(written, str) else written
                TypeAdapter(kind).validate_python(given[name], strict=True)
            except ValidationError as error:
                allowed = error.errors()[0]["msg"].removeprefix("Input should be ")
                place = f"{where}.{name}"
                raise InvalidInput(place, given[name], allowed, "Mend the value.") from None
