"""The configuration of the study: validated scenes, their cases, and the batches that compute them.

A scene is one figure, table or study. Its run blocks are fields of `Case`, each with a value or a list of
values; a block stands for the Cartesian product. Cases that several scenes need are computed once.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable, Mapping
from itertools import product
from typing import Any, Union

from pydantic import BaseModel, ConfigDict, Field, ValidationError, create_model

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracparticles.run.complaints import closest

__all__ = [
    "RunBlock",
    "Scene",
    "StudyConfig",
    "batches",
    "cases_of",
    "config_schema",
    "expand",
    "read_config",
]

_STORES = ("metrics", "profile", "field")  # each holds what the one before it holds
_BATCH_SECONDS = 8.0
_OPENING = {1: 0.0, 2: 3e-6, 3: 1e-5}  # seconds a particle to set up the open exterior


def _value_or_list(annotation: Any) -> Any:
    return Union[annotation, list[annotation], None]  # noqa: UP007  (an annotation known at run time only)


_FIELDS: dict[str, Any] = {
    name: (_value_or_list(field.annotation), Field(default=None))
    for name, field in Case.model_fields.items()
}
RunBlock: type[BaseModel] = create_model(
    "RunBlock",
    __config__=ConfigDict(extra="forbid", strict=True, frozen=True),
    __doc__="Fields of a case, each with one value or a list of values.",
    **_FIELDS,
)


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Scene(_Strict):
    """One figure, table or study.

    Attributes
    ----------
    title : str
        Heading in the report.
    items : list of str
        Items of the inventory whose claims it judges; empty for a study of our own.
    study : str
        The function of `studies` that turns runs into a table and findings.
    figure : str, optional
        The function of `figures` that draws it.
    parameters : dict
        What the study and the figure need beyond the runs.
    runs : list of RunBlock
        The cases.
    tables : list of str
        Scenes whose tables it reads.
    benchmarks : list of str
        Benchmarks whose data it reads.
    """

    title: str = Field(min_length=1)
    items: list[str] = []
    study: str
    figure: str | None = None
    parameters: dict[str, Any] = {}
    runs: list[RunBlock] = []
    tables: list[str] = []
    benchmarks: list[str] = []


class StudyConfig(_Strict):
    """The whole configuration.

    Attributes
    ----------
    results_dir : str
        Where runs, tables and figures go.
    report_dir : str
        Where the report goes.
    smoke : bool
        Whether these are the tiny grids, too coarse to judge the claims.
    dvm_dt : float, optional
        Time step of every run of DVM, whatever the scenes say, but for studies of the step.
    benchmarks : dict
        The benchmarks by name, with their parameters: those of the function of that name in `benchmarks`.
    scenes : dict
        The scenes by name, in the order of the report.
    """

    results_dir: str = Field(min_length=1)
    report_dir: str = Field(min_length=1)
    smoke: bool = False
    dvm_dt: float | None = Field(default=None, gt=0.0)
    benchmarks: dict[str, dict[str, Any]] = {}
    scenes: dict[str, Scene] = Field(min_length=1)


def read_config(config: Mapping[str, Any]) -> StudyConfig:
    """Validate a configuration, its cases included.

    A parameter of a scene that has the name of a field of its runs says what they are, in a title or a selection: it
    must be a value of theirs, or several (but for `studies.OWN_PARAMETERS`).

    Raises
    ------
    InvalidInput
        Naming the key, the value, what is allowed and what to do.
    """
    from fracstudy.benchmarks import BENCHMARKS, benchmark
    from fracstudy.figures import FIGURES
    from fracstudy.studies import STUDIES

    try:
        study = StudyConfig(**config)
    except ValidationError as error:
        raise _complaint(error) from None
    for name, parameters in study.benchmarks.items():
        _check_name(f"benchmarks.{name}", name, BENCHMARKS)
        _check_parameters(f"benchmarks.{name}", benchmark(name), parameters)
    for name, scene in study.scenes.items():
        _check_name(f"scenes.{name}.study", scene.study, STUDIES)
        if scene.figure is not None:
            _check_name(f"scenes.{name}.figure", scene.figure, FIGURES)
        for other in scene.tables:
            _check_name(f"scenes.{name}.tables", other, study.scenes)
        for other in scene.benchmarks:
            _check_name(f"scenes.{name}.benchmarks", other, study.benchmarks)
        _check_against_runs(name, scene, cases_of(name, scene))
    if study.dvm_dt is None:
        return study
    stepped = {name: _with_dvm_step(scene, study.dvm_dt) for name, scene in study.scenes.items()}
    return study.model_copy(update={"scenes": stepped})


def _with_dvm_step(scene: Scene, dt: float) -> Scene:
    """Return the scene with that step for DVM; a block with a list of steps is a study of the step and stays."""
    blocks = []
    for block in scene.runs:
        fields = block.model_dump(exclude_none=True)
        schemes = fields["scheme"] if isinstance(fields["scheme"], list) else [fields["scheme"]]
        if "DVM" not in schemes or isinstance(fields.get("dt"), list):
            blocks.append(block)
            continue
        others = [name for name in schemes if name != "DVM"]
        blocks += [RunBlock(**{**fields, "scheme": others})] if others else []
        blocks.append(RunBlock(**{**fields, "scheme": "DVM", "dt": dt}))
    return scene.model_copy(update={"runs": blocks})


def config_schema() -> dict[str, Any]:
    """Return the JSON schema of the configuration (draft 2020-12), as `workflow/schemas` holds it."""
    schema = StudyConfig.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


def expand(blocks: Iterable[BaseModel | Mapping[str, Any]]) -> list[Case]:
    """Return the cases of run blocks, in order, without repeats."""
    cases: dict[str, Case] = {}
    for block in blocks:
        fields = block.model_dump(exclude_none=True) if isinstance(block, BaseModel) else block
        names = list(fields)
        choices = [value if isinstance(value, list) else [value] for value in fields.values()]
        for combination in product(*choices):
            case = Case(**dict(zip(names, combination, strict=True)))
            case.refuse_point_mass()
            cases.setdefault(case.path, case)
    return list(cases.values())


def cases_of(name: str, scene: Scene) -> list[Case]:
    """Return the cases of a scene; a case that is not allowed is reported with the scene's name."""
    try:
        return expand(scene.runs)
    except InvalidInput as error:
        raise InvalidInput(
            f"scenes.{name}.runs: {error.field}", error.value, error.allowed, error.remedy
        ) from None


def batches(
    scenes: Mapping[str, Scene], smoke: bool = False
) -> tuple[dict[str, list[Case]], dict[str, list[Case]]]:
    """Return the cases of each scene and the batches of cases that one job computes.

    Two scenes that need the same run share it; it stores the more that either needs. A batch holds only cases
    that are needed by the same scenes, so that one scene never computes a run that it does not need. But on the
    tiny grids of the smoke configuration, where the start-up of a job outweighs its runs, there are two batches.
    """
    needed_by: dict[str, list[str]] = {}
    widest: dict[str, Case] = {}
    wanted: dict[str, list[str]] = {name: [] for name in scenes}
    for name, scene in scenes.items():
        for case in cases_of(name, scene):
            key = case.model_copy(update={"store": _STORES[0]}).path
            if key not in wanted[name]:
                needed_by.setdefault(key, []).append(name)
                wanted[name].append(key)
            known = widest.setdefault(key, case)
            if _STORES.index(case.store) > _STORES.index(known.store):
                widest[key] = case

    groups: dict[tuple[str, ...], list[Case]] = {}
    for key, names in needed_by.items():
        groups.setdefault(tuple(names), []).append(widest[key])
    named: dict[str, list[Case]] = {}
    if smoke:
        every = list(widest.values())
        named = {"smoke_1": every[::2], "smoke_2": every[1::2]}
        groups.clear()
    for group, cases in groups.items():
        for chunk in _chunks(cases):
            number = sum(batch.rsplit("_", 1)[0] == group[0] for batch in named) + 1
            named[f"{group[0]}_{number}"] = chunk
    return {name: [widest[key] for key in keys] for name, keys in wanted.items()}, named


def _chunks(cases: list[Case]) -> Iterable[list[Case]]:
    chunk: list[Case] = []
    seconds = 0.0
    for case in cases:
        if chunk and seconds + _seconds(case) > _BATCH_SECONDS:
            yield chunk
            chunk, seconds = [], 0.0
        chunk.append(case)
        seconds += _seconds(case)
    if chunk:
        yield chunk


def _seconds(case: Case) -> float:
    """A rough estimate of the cost of a run: N times the number of operator applications."""
    if case.scheme == "DVM":
        return 8e-7 * case.particles * case.steps
    if case.steps_taken:
        return 2e-8 * case.particles * case.steps
    applications = (case.setting.rate * (case.t_final - case.t_initial)) ** 0.5
    opening = _OPENING[case.dim] * case.particles if case.exterior == "open" else 0.0
    return 0.01 + opening + 1.2e-7 * case.particles * applications


def _check_against_runs(name: str, scene: Scene, cases: Iterable[Case]) -> None:
    """Refuse a parameter that says what the runs of the scene do not."""
    from fracstudy.studies import OWN_PARAMETERS

    cases = list(cases)
    for parameter, given in scene.parameters.items():
        if parameter not in Case.model_fields or parameter in OWN_PARAMETERS.get(scene.study, ()):
            continue
        found = dict.fromkeys(getattr(case, parameter) for case in cases)
        found.pop(None, None)
        if not found or isinstance(
            given, dict
        ):  # nothing the runs give, or a word of the study's own
            continue
        for one in given if isinstance(given, list) else [given]:
            if not any(_same(one, other) for other in found):
                raise InvalidInput(
                    f"scenes.{name}.parameters.{parameter}",
                    given,
                    f"what the runs of the scene have, {' or '.join(map(str, found))}",
                    "Change the runs, too: they are what is shown.",
                )


def _same(one: Any, other: Any) -> bool:
    """Equal, numbers to six digits, as `Inputs.select` compares them."""
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=1e-6)
    return bool(one == other)


def _check_name(field: str, value: str, allowed: Iterable[str]) -> None:
    if value not in allowed:
        raise InvalidInput(field, value, f"one of {', '.join(allowed)}", "Choose one of these.")


def _check_parameters(
    field: str, function: Callable[..., Any], parameters: Mapping[str, Any]
) -> None:
    signature = inspect.signature(function)
    try:
        signature.bind(**parameters)
    except TypeError as error:
        raise InvalidInput(
            field,
            ", ".join(parameters),
            f"the parameters {', '.join(signature.parameters)}",
            f"Mend the block: {error}.",
        ) from None


def _complaint(error: ValidationError) -> InvalidInput:
    # A run block's field may be a value or a list: pydantic complains about both; the first will do.
    first = error.errors()[0]
    place = [str(part) for part in first["loc"] if not (isinstance(part, str) and "[" in part)]
    field = ".".join(place) or "configuration"
    if first["type"] == "extra_forbidden":
        models: dict[int, type[BaseModel]] = {1: StudyConfig, 3: Scene}
        model = models.get(len(place), RunBlock)
        names = model.model_fields
        remedy = closest(place[-1], names) or "Remove it."
        return InvalidInput(field, first["input"], f"one of {', '.join(names)}", remedy)
    if first["type"] == "missing":
        return InvalidInput(field, None, "needed", "Add it to the configuration.")
    hint = ""
    if isinstance(first["input"], str) and "number" in first["msg"]:
        hint = " YAML reads 1e-4 as text: write 1.0e-4."
    return InvalidInput(
        field,
        first["input"],
        first["msg"].removeprefix("Input should be "),
        f"Mend the value.{hint}",
    )
