"""What holds of the configuration: it is read, and its cases are those that it names, or it is refused in a line."""

# ruff: noqa: B008  an argument of a property is drawn from its default

import datetime
import math
import tempfile
from collections.abc import Iterator
from contextlib import chdir
from copy import deepcopy
from math import prod
from pathlib import Path
from typing import Any

import yaml
from hypothesis import strategies as st
from pydantic import BaseModel

from fracparticles.run.case import Case
from fracstudy.config import StudyConfig, batches, jobs, read_config, targets
from fracstudy.scene import Scene
from fracstudy.scene_files import merged, resolved
from scenes.extremes.fuzzing.harness import always
from scenes.extremes.fuzzing.strategies import among, chance, fields_of, numbers, texts

Tree = Any  # of mappings, lists and values, as YAML gives it
_STUDY: Tree = yaml.safe_load("""
{results_dir: results, report_dir: report, site_dir: site, scenes_dir: scenes,
 documents: {own: {title: Our own}}, smoke: false}
""")
_SCENE: Tree = yaml.safe_load("""
title: Errors
place: 3
runs:
- {scheme: [DD, KPSE], order: [2, 4], beta: [0.3, 0.5], half_width: 10.0, spacing: 0.5, dt: 0.01}
- {scheme: DVM, beta: 0.5, truncation: 6.0, spacing: 0.5, dt: 0.05, store: metrics}
smoke: {title: Few errors}
variants: {one: {runs: [{beta: 0.7}]}, two: {place: 4, runs: [{}, {dt: 0.1}]}}
""")
_MODELS = (StudyConfig, Scene, Case)
_FIELDS = {name for model in _MODELS for name in model.model_fields}
_KEYS = sorted({*_FIELDS, "variants", "smoke", "title"})
_ODD = (math.nan, math.inf, "1e-4", "{beta}", "{", "x/../y", "/", datetime.date(2020, 1, 1), b"x")
_SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(-3, 10**20), numbers(), among(*_ODD), texts()
)
_NAMES = st.one_of(st.sampled_from(_KEYS), texts(), st.integers(0, 3))
_TREES = st.recursive(
    _SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(_NAMES, inner, max_size=3)
    ),
    max_leaves=5,
)


def _places(tree: Tree, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The ways to every value of a tree."""
    if at:
        yield at
    of_list = enumerate(tree) if isinstance(tree, list) else ()
    inner = tree.items() if isinstance(tree, dict) else of_list
    for key, value in inner:
        yield from _places(value, (*at, key))


@st.composite
def _changed(draw: st.DrawFn, whole: Tree) -> Tree:
    """Draw a tree with up to three values changed, left out, or set under another key."""
    tree = deepcopy(whole)
    for _ in range(draw(st.integers(0, 3))):
        places = list(_places(tree))
        if not places:
            break
        *way, last = draw(st.sampled_from(places))
        holder = tree
        for key in way:
            holder = holder[key]
        how = draw(st.integers(0, 5))
        if how == 0:
            del holder[last]
        elif how == 1 and isinstance(holder, dict):
            holder[draw(st.one_of(st.sampled_from(_KEYS), texts()))] = draw(_TREES)
        elif how <= 3 and last in Case.model_fields:
            values = fields_of(Case)[last]
            holder[last] = draw(st.one_of(values, st.lists(values, max_size=3)))
        else:
            holder[last] = draw(_TREES)
    return tree


@st.composite
def _files(draw: st.DrawFn) -> tuple[Tree, bytes]:
    """Draw a configuration, and the text of a scene that may be spoilt."""
    scene, unicode = draw(_changed(_SCENE)), draw(st.booleans())
    text = _bytes(yaml.safe_dump(scene, allow_unicode=unicode))
    if draw(chance(30)):
        at, length = draw(st.integers(0, len(text))), draw(st.integers(0, 5))
        other = draw(st.one_of(st.binary(max_size=3), texts().map(_bytes)))
        text = text[:at] + other + text[at + length :]
    return draw(_changed(_STUDY)) if draw(chance(40)) else _STUDY, text


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _combinations(block: BaseModel) -> int:
    values = block.model_dump(exclude_none=True).values()
    return prod(len(value) if isinstance(value, list) else 1 for value in values)


@always("study.yaml, scene.yaml, runs", "its cases, or a line", share=8)
def _read(parts=_files()):
    """A configuration is refused, or all that is made of it fits together."""
    config, scene = parts
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        Path("scenes/own/errors").mkdir(parents=True)
        Path("scenes/own/errors/scene.yaml").write_bytes(scene)
        study, scenes = read_config(config if isinstance(config, dict) else {})
        cases, groups = batches(scenes, study.smoke)
        made = [case.path for group in groups.values() for case in group]
        wanted = {case.path for of_scene in cases.values() for case in of_scene}
        wrong = len(set(made)) != len(made) or set(made) != wanted
        of_jobs = [name for names in jobs(scenes, study.smoke).values() for name in names]
        wrong |= sorted(of_jobs) != sorted(scenes) or not set(scenes) <= set(targets(scenes))
        for one in scenes.values():
            again = Scene(**one.packed(runs=True))
            wrong |= [case.path for case in again.cases] != [case.path for case in one.cases]
            wrong |= len(one.cases) > sum(map(_combinations, one.runs))
        return 2.0 * wrong


@always("smoke, variants", "laid over, nothing else", share=4)
def _laid(tree=_TREES, other=_TREES, smoke=st.booleans()):
    """To lay a tree over itself, or an empty one over it, changes nothing; what is resolved stays as it is."""
    before = deepcopy((tree, other))
    whole = resolved(tree, smoke)
    wrong = repr(merged(tree, {}) if isinstance(tree, dict) else tree) != repr(tree)
    wrong |= isinstance(whole, dict) and "smoke" in whole
    wrong |= isinstance(whole, dict) and repr(resolved(whole, smoke)) != repr(whole)
    merged(tree, other)
    return 2.0 * (wrong or repr((tree, other)) != repr(before))
