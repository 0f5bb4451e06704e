"""The configuration of the study: the global settings, the scenes, their cases, and batches of cases.

The run blocks of a scene are fields of `Case`, each with a value or a list of values. A block stands for the Cartesian
product of its lists. Cases that several scenes need are computed once.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracstudy.read_yaml import read_yaml
from fracstudy.run_blocks import RunBlock
from fracstudy.scene import Scene, check_parameters
from fracstudy.scene_files import complaint, read_scenes

__all__ = [
    "CONFIG",
    "Document",
    "StudyConfig",
    "batches",
    "benchmark_jobs",
    "jobs",
    "read_config",
    "read_project",
    "targets",
]

CONFIG = Path("config/study.yaml")
"""The configuration, below the folder of the project."""
_STORES = ("metrics", "profile", "field")  # each holds what the one before it holds
# Runs of a job by dimension: the start of a job takes as long as a few runs. Runs with moving particles take a hundred
# times as long.
_AT_ONCE = {1: 120, 2: 24, 3: 8}
_MOVING_AT_ONCE = 6
_SMOKE_JOBS = 2  # jobs of a smoke run, where the start of a job takes longer than all its runs


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Document(_Strict):
    """A folder of scenes, a part of the report.

    Attributes
    ----------
    title : str
        Heading in the report.
    printed : str, optional
        The folder of the printed numbers and sentences, with one file for each folder of scenes; left out for studies
        of our own.
    """

    title: str = Field(min_length=1)
    printed: str | None = None


class StudyConfig(_Strict):
    """The global settings.

    Attributes
    ----------
    results_dir : str
        The folder of runs, tables and figures.
    report_dir : str
        The folder of the report.
    site_dir : str
        The folder of the site.
    site_api : bool
        Whether the site has the pages of the library's API, which do not depend on the study.
    scenes_dir : str
        The folder of the scenes, `<document>/<scene>/scene.yaml`.
    documents : dict
        The documents by the name of their folder, in the order of the report.
    grids : str, optional
        The file that says on which grids the claims of an item can be judged.
    figure_formats : list of str
        The formats of each figure: "svg", "png" or both. The report shows the first one that exists.
    smoke : bool
        Whether the scenes take their `smoke` values: tiny grids, too coarse to judge the claims.
    dvm_dt : float, optional
        The time step of every run of DVM, instead of those of the scenes; studies of the step keep theirs.
    """

    results_dir: str = Field(min_length=1)
    report_dir: str = Field(min_length=1)
    site_dir: str = "site"
    site_api: bool = True
    scenes_dir: str = "workflow/scenes"
    documents: dict[str, Document] = Field(min_length=1)
    grids: str | None = None
    figure_formats: list[Literal["svg", "png"]] = Field(default=["svg", "png"], min_length=1)
    smoke: bool = False
    dvm_dt: float | None = Field(default=None, gt=0.0)

    def printed(self, scene: Scene) -> Path | None:
        """Return the file of the printed claims that a scene judges; None for a study of our own."""
        folder = self.documents[scene.document].printed
        return Path(folder) / f"{scene.folder.name}.yaml" if folder and scene.items else None

    def all_printed(self, scenes: Iterable[Scene]) -> list[Path]:
        """Return the printed files of several scenes, in their order, each once."""
        files = (self.printed(scene) for scene in scenes)
        return list(dict.fromkeys(file for file in files if file is not None))


def read_config(config: Mapping[str, Any]) -> tuple[StudyConfig, dict[str, Scene]]:
    """Validate a configuration and find its scenes; their parameters and cases are validated, too.

    Raises
    ------
    InvalidInput
        Naming the key, the value, what is allowed and what to do.
    """
    try:
        study = StudyConfig(**config)
    except ValidationError as error:
        raise complaint(error, "", StudyConfig) from None
    scenes = read_scenes(Path(study.scenes_dir), list(study.documents), study.smoke)
    if study.dvm_dt is not None:
        scenes = {name: _with_dvm_step(scene, study.dvm_dt) for name, scene in scenes.items()}
    timed = [name for name, scene in scenes.items() if scene.benchmark is not None]
    # In a smoke run every claim that cannot be judged has the reason that its grids are too coarse.
    grids = {}
    if study.grids is not None and not study.smoke:
        grids = read_yaml(Path(study.grids))
    for scene in scenes.values():
        for key, names in (("tables", scenes), ("benchmarks", timed)):
            for other in getattr(scene, key):
                if other not in names:
                    allowed = f"of {', '.join(names)}"
                    raise InvalidInput(scene.where(key), other, allowed, "Choose of these.")
        check_parameters(scene)
        _check_runs(scene)
        _check_grid(scene, grids)
    _check_order(scenes)
    return study, scenes


def read_project(project: Path) -> tuple[StudyConfig, dict[str, Scene]]:
    """Return `read_config` of the project in a folder, which need not be the working directory."""
    config = read_yaml(project / CONFIG)
    folder = config.get("scenes_dir", StudyConfig.model_fields["scenes_dir"].default)
    return read_config({**config, "scenes_dir": str(project / folder)})


def _check_order(scenes: Mapping[str, Scene]) -> None:
    """Refuse scenes that wait for each other's tables."""
    try:
        TopologicalSorter({name: scene.tables for name, scene in scenes.items()}).prepare()
    except CycleError as error:
        circle = error.args[1]
        raise InvalidInput(
            scenes[circle[0]].where("tables"),
            " of ".join(reversed(circle)),
            "tables of scenes that can be made before this one",
            "Take what they share into a scene of its own.",
        ) from None


def _check_runs(scene: Scene) -> None:
    """Refuse parameters that repeat fields of the runs, and runs that lack values that the study compares."""
    cases, _ = scene.cases, scene.heading
    for name in Case.model_fields.keys() & scene.parameters.keys():
        if all(getattr(case, name) is None for case in cases):
            continue
        raise InvalidInput(
            scene.where(f"parameters.{name}"),
            scene.parameters[name],
            "nothing that the runs say themselves",
            "Leave it out, or give it a name of its own.",
        )
    for name, needed in scene.needs.items():
        found = {getattr(case, name) for case in cases}
        if missing := [value for value in needed if value not in found]:
            raise InvalidInput(
                scene.where(f"runs: {name}"),
                " and ".join(map(str, found)) or None,
                f"{' and '.join(map(str, needed))}, all of which the study compares",
                f"Add runs with {name}: {missing[0]}.",
            )


def _check_grid(scene: Scene, grids: Mapping[str, Mapping[str, list[Any]]]) -> None:
    """Refuse to judge a claim on a grid without the values that it speaks of."""
    for item in scene.items if scene.runs else ():
        for name, values in grids.get(item, {}).items():
            found = dict.fromkeys(getattr(case, name) for case in scene.cases)
            if any(value not in found for value in values):
                raise InvalidInput(
                    scene.where("items"),
                    item,
                    f"an item whose claims speak of the runs; it speaks of {name} = "
                    f"{', '.join(map(str, values))}, and the runs have {', '.join(map(str, found))}",
                    "Leave the item out, or add the runs.",
                )


def _with_dvm_step(scene: Scene, dt: float) -> Scene:
    """Return the scene with another step for DVM; a block with a list of steps is a study of the step and is kept."""
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


def targets(scenes: Mapping[str, Scene]) -> dict[str, list[str]]:
    """Return the scenes by each name that can be asked for: that of a scene, or that of a folder for all its scenes."""
    folders: dict[str, list[str]] = {}
    for name, scene in scenes.items():
        folders.setdefault(scene.folder.name, []).append(name)
    return folders | {name: [name] for name in scenes}


def jobs(scenes: Mapping[str, Scene], smoke: bool = False) -> dict[str, list[str]]:
    """Return the scenes that each job makes. It is one scene, so that nothing is made that was not asked for.

    On the tiny grids of a smoke run the start of a job takes longer than its work. There scenes share a job if they
    wait for the same: for runs only, for benchmarks, or for tables of other scenes.
    """
    if not smoke:
        return {name: [name] for name in scenes}
    waves: dict[tuple[int, bool], list[str]] = {}
    for name, scene in scenes.items():
        waves.setdefault((_depth(name, scenes), bool(scene.all_benchmarks)), []).append(name)
    return _parts(waves[wave] for wave in sorted(waves))


def benchmark_jobs(scenes: Mapping[str, Scene], smoke: bool = False) -> dict[str, list[str]]:
    """Return the scenes whose benchmarks each job runs: one, but half of all in a smoke run, whose times are no use."""
    timed = [name for name, scene in scenes.items() if scene.benchmark is not None]
    return _parts([timed]) if smoke else {name: [name] for name in timed}


def _parts(waves: Iterable[list[str]]) -> dict[str, list[str]]:
    parts = [names[k::_SMOKE_JOBS] for names in waves for k in range(_SMOKE_JOBS)]
    return {f"part_{k}": names for k, names in enumerate(filter(None, parts), start=1)}


def _depth(name: str, scenes: Mapping[str, Scene]) -> int:
    """The number of scenes that must be made before this one, one after the other."""
    return max((1 + _depth(other, scenes) for other in scenes[name].tables), default=0)


def batches(
    scenes: Mapping[str, Scene], smoke: bool = False
) -> tuple[dict[str, list[Case]], dict[str, list[Case]]]:
    """Return the cases of each scene and the batches of cases that one job computes.

    Scenes that need the same run share it, and it stores as much as any of them needs. A batch holds only cases
    that are needed by the same scenes, so that one scene never computes a run that it does not need.
    """
    needed_by: dict[str, list[str]] = {}
    widest: dict[str, Case] = {}
    wanted: dict[str, list[str]] = {name: [] for name in scenes}
    for name, scene in scenes.items():
        for case in scene.cases:
            key = case.model_copy(update={"store": _STORES[0]}).path
            if key not in wanted[name]:
                needed_by.setdefault(key, []).append(name)
                wanted[name].append(key)
            known = widest.setdefault(key, case)
            if _STORES.index(case.store) > _STORES.index(known.store):
                widest[key] = case
    named: dict[str, list[Case]] = {}
    groups: dict[tuple[Any, ...], list[Case]] = {}
    if smoke:
        every = list(widest.values())
        named = {
            f"part_{k + 1}": every[k::_SMOKE_JOBS] for k in range(min(_SMOKE_JOBS, len(every)))
        }
        needed_by.clear()
    for key, names in needed_by.items():
        case = widest[key]
        at_once = _MOVING_AT_ONCE if case.kind.moving else _AT_ONCE[case.dim]
        groups.setdefault((at_once, *names), []).append(case)
    for (at_once, name, *_), cases in groups.items():
        for first in range(0, len(cases), at_once):
            number = sum(batch.rsplit("_", 1)[0] == name for batch in named) + 1
            named[f"{name}_{number}"] = cases[first : first + at_once]
    return {name: [widest[key] for key in keys] for name, keys in wanted.items()}, named
