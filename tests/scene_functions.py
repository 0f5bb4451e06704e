"""The functions of our scenes by the scene's name, called as the workflow calls them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from fracstudy.config import StudyConfig, read_config
from fracstudy.inputs import Result
from fracstudy.scene import Scene, call
from fracstudy.scene_files import read_scenes

ROOT = Path(__file__).resolve().parents[1]


@cache
def scenes() -> dict[str, Scene]:
    documents = yaml.safe_load((ROOT / "config/study.yaml").read_text())["documents"]
    return read_scenes(ROOT / "workflow/scenes", list(documents), smoke=True)


@cache
def configured() -> tuple[StudyConfig, dict[str, Scene]]:
    """The study and its scenes on their full grids."""
    given = yaml.safe_load((ROOT / "config/study.yaml").read_text())
    return read_config(given | {"scenes_dir": str(ROOT / "workflow/scenes"), "grids": None})


def measured(benchmark: Any) -> pd.DataFrame:
    """What a study gets of the data set of a benchmark."""
    frame = benchmark.to_dataframe().reset_index()
    frame.attrs = dict(benchmark.attrs)
    return frame


def study(name: str) -> Callable[..., Result]:
    function = scenes()[name].function("study")
    return lambda inputs, **parameters: call(function, inputs, **parameters)


def figure(name: str) -> Callable[..., Any]:
    function = scenes()[name].function("figure")
    return lambda series, table, parameters: call(function, series, table=table, **parameters)
