"""A scene: one folder `workflow/scenes/<document>/<scene>/`, found by its path.

Its files:

    scene.yaml     title, runs, and what else the fields of `Scene` say
    study.py       study(inputs, **parameters) -> Result, and NEEDS, the values that fields of its runs must have;
                   without it the table of the runs
    figure.py      figure(series, **parameters) -> Figure, of the parameters and the scene's `table`; without it there
                   is no figure
    benchmark.py   benchmark(**parameters) -> data set of run times, if the scene measures any
    caption.md     what is shown, how to read it, what follows
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Mapping
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from fracparticles.errors import InvalidInput, closest
from fracparticles.run.case import Case
from fracstudy.run_blocks import RunBlock, expand

__all__ = ["Scene", "call", "check_parameters"]


class Scene(BaseModel):
    """One figure, table or study.

    Attributes
    ----------
    name : str
        Its name: that of the folder, or of the variant. It is the target, and the name of its results.
    folder : Path
        The folder of its files.
    title : str
        Heading in the report; `{beta}` in it stands for the value that all runs have, or for a parameter.
    place : int
        Its place in its document: smaller numbers come first, and equal ones by name.
    items : list of str
        Items of the inventory whose claims it judges; empty for a study of our own.
    study : str, optional
        `<document>/<folder>` of another scene, whose study and figure it takes.
    parameters : dict
        The keywords of the functions of the study and the figure.
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
        """Return the fields from which `Scene(**packed)` makes the scene in another process, without or with its runs.

        They are not JSON, in which numbers that are keys of a parameter would become text.
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
        """Return the file "study.py", "figure.py", "benchmark.py" or "caption.md" of the scene, or None without it."""
        own = self.study is None or kind in ("benchmark.py", "caption.md")
        folder = self.folder if own else self.folder.parents[1] / str(self.study)
        return folder / kind if (folder / kind).is_file() else None

    @cached_property
    def cases(self) -> list[Case]:
        """The cases of its runs, in order, without repeats.

        Raises
        ------
        InvalidInput
            If a case is not allowed; names the file of the scene.
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
            If it asks for a name that is neither a parameter nor a field with the same value in all runs.
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
        """The values of fields of a case that the runs must have for the study, `NEEDS` of study.py."""
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


def call(function: Callable[..., Any], *arguments: Any, **parameters: Any) -> Any:
    """Call a study, figure or benchmark with the parameters that it takes; the others are left out."""
    taken = inspect.signature(function).parameters
    return function(*arguments, **{k: v for k, v in parameters.items() if k in taken})


def check_parameters(scene: Scene) -> None:
    """Check the parameters of a scene against the functions that take them: names, and types where they are given.

    Raises
    ------
    InvalidInput
        If none of them takes a parameter, a needed one is left out, or one has the wrong type.
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
                raise InvalidInput(
                    f"{where}.{name}", None, "a value, which the study needs", "Add it."
                )
        elif parameter.annotation is not parameter.empty:
            try:
                written = parameter.annotation
                kind = eval(written, names) if isinstance(written, str) else written
                TypeAdapter(kind).validate_python(given[name], strict=True)
            except ValidationError as error:
                allowed = error.errors()[0]["msg"].removeprefix("Input should be ")
                place = f"{where}.{name}"
                raise InvalidInput(place, given[name], allowed, "Mend the value.") from None
