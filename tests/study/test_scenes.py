"""Scenes and the configuration: found by path, validated in words that a person understands, shared, batched."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
import yaml

from fracparticles.errors import InvalidInput
from fracstudy.config import batches, benchmark_jobs, jobs, read_config
from fracstudy.run_blocks import expand
from fracstudy.scene import Scene
from fracstudy.scene_files import merged, resolved
from scene_functions import configured

BLOCK = {
    "scheme": ["DD", "KPSE"],
    "order": [2, 4],
    "beta": 0.5,
    "truncation": 10.0,
    "spacing": [0.5, 0.25],
    "dt": 0.01,
    "store": "metrics",
}
STUDY = """
from fracstudy.inputs import Inputs, Result

NEEDS = {"exterior": ["truncated"]}


def study(inputs: Inputs, *, width: float, counts: list[int] = ()) -> Result:
    return Result(inputs.scalars)
"""


def write(root: Path, name: str = "one", study: str = "", **scene) -> dict:
    """Write a scene below `root`, a package of its own, and return the configuration that finds it."""
    folder = root / f"scenes_of_{root.name}" / "mine" / name
    folder.mkdir(parents=True)
    scene = {"title": "t", "runs": [BLOCK], **scene}
    (folder / "scene.yaml").write_text(yaml.safe_dump(scene))
    if study:
        (folder / "study.py").write_text(study)
    return {
        "results_dir": "r",
        "report_dir": "p",
        "scenes_dir": str(folder.parents[1]),
        "documents": {"mine": {"title": "Mine"}},
    }


def test_an_empty_scene_is_no_missing_one(tmp_path):
    config = write(tmp_path)
    file = next(tmp_path.rglob("scene.yaml"))
    file.write_text("")
    assert "scene.yaml = 'an empty file' is not allowed. Allowed: a mapping" in refusal(config)


def refusal(config: dict) -> str:
    with pytest.raises(InvalidInput) as caught:
        read_config(config)
    message = str(caught.value)
    assert "\n" not in message
    return message


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        ({"runs": [{**BLOCK, "dt": "1e-4"}]}, ("scene.yaml: runs.0.dt = ", "'1e-4'", "1.0e-4")),
        ({"runs": BLOCK}, ("runs = ", "Begin each item of a list with a dash.")),
        ({"title": None, "titel": "t"}, ("titel = 't'", "Did you mean 'title'?")),
        ({"runs": [{**BLOCK, "spacng": 0.1}]}, ("spacng", "Did you mean 'spacing'?")),
        ({"runs": [{**BLOCK, "scheme": "KPSF"}]}, ("scheme", "KPSF", "KPSE")),
        ({"runs": [{**BLOCK, "order": 3}]}, ("order", "3", "2, 4, 6, 8, 10 or 12")),
        ({"runs": [{**BLOCK, "beta": 1.5}]}, ("beta", "1.5", "1")),
        ({"runs": [{**BLOCK, "truncation": -1.0}]}, ("truncation", "-1.0", "0")),
        (
            {"runs": [{**BLOCK, "exterior": "open", "scheme": "FD", "order": 2}]},
            ("mine/one/scene.yaml", "exterior", "'open'", "truncated"),
        ),
        ({"tables": ["two"]}, ("tables", "two", "one")),
        ({"benchmarks": ["one"]}, ("benchmarks", "one")),
        ({"titel": "x"}, ("titel", "Did you mean 'title'?")),
        ({"title": None}, ("title", "string")),
        ({"parameters": {"width": 1.0}}, ("parameters.width", "none")),
        ({"variants": ["two"]}, ("scene.yaml: variants", "mappings by name")),
        ({"variants": {"two": 1.5}}, ("scene.yaml: variants", "mappings by name")),
        ({"variants": {"two": {"name": "x"}}}, ("scene.yaml: name", "paths say it")),
        ({"variants": {"two": {3: "x"}}}, ("scene.yaml: 3", "Keys should be strings")),
    ],
)
def test_a_mistake_is_named_in_one_line(tmp_path, scene, words):
    message = refusal(write(tmp_path, **scene))
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        ({}, ("parameters.width", "which the study needs")),
        ({"parameters": {"width": "1e-4"}}, ("parameters.width", "'1e-4'", "number")),
        ({"parameters": {"width": 1.0, "widht": 1.0}}, ("widht", "Did you mean 'width'?")),
        ({"parameters": {"width": 1.0, "counts": [1.5]}}, ("counts", "integer")),
        ({"parameters": {"width": 1.0, "beta": 0.3}}, ("parameters.beta = 0.3", "the runs say")),
        (
            {"parameters": {"width": 1.0}, "runs": [{**BLOCK, "exterior": "open"}]},
            ("runs: exterior", "open", "truncated", "Add runs"),
        ),
    ],
)
def test_what_a_study_needs_is_declared_and_checked_before_anything_runs(tmp_path, scene, words):
    study = STUDY
    if "beta" in scene.get("parameters", {}):
        study = study.replace("width: float", "width: float, beta: float")
    message = refusal(write(tmp_path, study=study, **scene))
    for word in words:
        assert word in message, message


def test_a_claim_is_judged_on_the_grid_that_it_speaks_of(tmp_path):
    (tmp_path / "grids.yaml").write_text("X-1: {beta: [0.1], order: [2]}")
    config = {**write(tmp_path, items=["X-1"]), "grids": str(tmp_path / "grids.yaml")}
    message = refusal(config)
    for word in ("items = 'X-1'", "beta = 0.1", "the runs have 0.5", "Leave the item out"):
        assert word in message
    assert "one" in read_config({**config, "smoke": True})[1]


def test_what_a_scene_measures_is_printed_in_the_file_of_its_folder(tmp_path):
    write(tmp_path, "own")
    halves = {"left": {"items": ["L-F1"]}, "right": {"items": ["L-F2"]}}
    config = write(tmp_path, "two", variants=halves)
    config["documents"]["mine"]["printed"] = "report/printed/mine"
    study, scenes = read_config(config)
    file = Path("report/printed/mine/two.yaml")
    assert {name: study.printed(scene) for name, scene in scenes.items()} == {
        "own": None,
        "left": file,
        "right": file,
    }
    assert study.all_printed(scenes.values()) == [file]
    del config["documents"]["mine"]["printed"]
    study, scenes = read_config(config)
    assert study.all_printed(scenes.values()) == []


def test_a_scene_needs_a_title_and_runs_and_nothing_else(tmp_path):
    _, scenes = read_config(write(tmp_path))
    assert len(scenes["one"].cases) == 8


def test_a_misspelt_global_key_is_named(tmp_path):
    config = write(tmp_path)
    assert "Did you mean 'results_dir'?" in refusal({**config, "result_dir": "x"})
    assert "documents" in refusal({key: config[key] for key in ("results_dir", "report_dir")})
    assert "nothing" in refusal({**config, "documents": {"nothing": {"title": "x"}}})


def test_two_scenes_cannot_have_one_name(tmp_path):
    config = write(tmp_path)
    write(tmp_path, "two", variants={"one": {}})
    assert "a name that no other scene has" in refusal(config)


def test_a_block_stands_for_the_cartesian_product_without_repeats():
    cases = expand([BLOCK, {**BLOCK, "scheme": "DD"}])
    assert len(cases) == 2 * 2 * 2
    assert len({case.path for case in cases}) == len(cases)


def test_the_smoke_value_stands_beside_the_full_one():
    tree = {
        "a": 1,
        "b": {"c": [1, 2], "d": 4, "smoke": {"c": [3], "d": None}},
        "runs": [{"h": 0.1, "smoke": {"h": 0.5, "dt": 1.0}}, {"h": 0.2, "smoke": None}],
    }
    assert resolved(tree, smoke=False) == {
        "a": 1,
        "b": {"c": [1, 2], "d": 4},
        "runs": [{"h": 0.1}, {"h": 0.2}],
    }
    assert resolved(tree, smoke=True) == {"a": 1, "b": {"c": [3]}, "runs": [{"h": 0.5, "dt": 1.0}]}


def test_a_variant_is_laid_over_the_common_part_block_by_block():
    base = {"title": "t", "runs": [{"h": 0.1, "smoke": {"dt": 1.0}}, {"h": 0.2}]}
    own = {"runs": [{"beta": 0.5, "smoke": {"h": 0.4}}], "items": ["x"]}
    assert merged(base, own) == {
        "title": "t",
        "items": ["x"],
        "runs": [{"h": 0.1, "beta": 0.5, "smoke": {"dt": 1.0, "h": 0.4}}, {"h": 0.2}],
    }


def test_a_title_says_what_the_runs_say(tmp_path):
    config = write(tmp_path, title="at beta = {beta}, C = {truncation:g}")
    assert read_config(config)[1]["one"].heading == "at beta = 0.5, C = 10"
    write(tmp_path, "two", title="h = {spacing}")  # there are two of them
    assert "title = 'h = {spacing}'" in refusal(config)


def test_variants_are_scenes_of_one_folder(tmp_path):
    beta = {f"at_{beta}": {"runs": [{"beta": beta}]} for beta in (0.1, 0.9)}
    _, scenes = read_config(write(tmp_path, variants=beta))
    assert {name: scene.cases[0].beta for name, scene in scenes.items()} == {
        "at_0.1": 0.1,
        "at_0.9": 0.9,
    }


def test_a_scene_may_take_the_study_of_another(tmp_path):
    config = write(tmp_path, study=STUDY, parameters={"width": 1.0})
    write(tmp_path, "two", runs=[{**BLOCK, "beta": 0.3}], parameters={"width": 2.0})
    config["documents"] = {"mine": {"title": "Mine"}}
    folder = Path(config["scenes_dir"]) / "mine/two"
    scene = yaml.safe_load((folder / "scene.yaml").read_text())
    (folder / "scene.yaml").write_text(yaml.safe_dump({**scene, "study": "mine/one"}))
    _, scenes = read_config(config)
    assert scenes["two"].function("study") is scenes["one"].function("study")


def test_one_switch_for_the_step_of_dvm(tmp_path):
    block = {"scheme": ["DVM", "DD"], "beta": 0.5, "truncation": 10.0, "spacing": 0.1, "dt": 1.0e-3}
    steps = {**block, "scheme": "DVM", "dt": [1.0e-3, 2.0e-3]}
    given = write(tmp_path, runs=[block, steps])
    _, scenes = read_config({**given, "dvm_dt": 5.0e-5})
    found = [(c.scheme, c.dt) for c in scenes["one"].cases]
    assert found == [("DD", 1e-3), ("DVM", 5e-5), ("DVM", 1e-3), ("DVM", 2e-3)]
    _, scenes = read_config(given)
    assert {c.dt for c in scenes["one"].cases} == {1e-3, 2e-3}


def test_scenes_share_a_run_and_the_wider_store_wins(tmp_path):
    config = write(tmp_path)
    write(tmp_path, "two", runs=[{**BLOCK, "scheme": "DD", "store": "field"}])
    _, scenes = read_config(config)
    cases, made = batches(scenes)
    shared = {case.path for case in cases["one"]} & {case.path for case in cases["two"]}
    assert len(shared) == 4
    assert all(case.store == "field" for case in cases["two"])
    computed = [case.path for batch in made.values() for case in batch]
    assert len(computed) == len(set(computed)) == 8


@pytest.fixture(scope="module")
def ours():
    return configured()[1]


def test_a_scene_computes_nothing_that_it_does_not_need(ours):
    cases, made = batches(ours)
    for scene in ours:
        wanted = {case.path for case in cases[scene]}
        for batch in made.values():
            computed = {case.path for case in batch}
            assert computed <= wanted or not computed & wanted


def test_a_job_takes_the_scene_as_it_is(ours):
    """Numbers that are keys of a parameter, too: as JSON they were text, and looked up in vain."""
    for scene in ours.values():
        taken = pickle.loads(pickle.dumps(scene.packed(runs=True)))
        assert Scene(**taken) == scene
        assert Scene(**scene.packed()).parameters == scene.parameters
    keys = ours["lucchesi_table_2"].parameters["printed_spacing"]
    assert all(isinstance(key, float) for key in keys)


@pytest.mark.parametrize("smoke", [False, True])
def test_each_scene_is_made_by_one_job(ours, smoke):
    made = [name for names in jobs(ours, smoke).values() for name in names]
    assert sorted(made) == sorted(ours)
    timed = [name for names in benchmark_jobs(ours, smoke).values() for name in names]
    assert sorted(timed) == sorted(name for name, scene in ours.items() if scene.benchmark)


def test_every_scene_has_a_caption_and_its_items_are_its_own(ours):
    assert [name for name, scene in ours.items() if not scene.file("caption.md")] == []
    items = [item for scene in ours.values() for item in scene.items]
    assert len(items) == len(set(items))


@pytest.mark.parametrize(
    "text",
    [b"title: \xff", b"title: 2020-13-45", b"[" * 5000],
    ids=["not UTF-8", "no date", "too deep"],
)
def test_what_is_no_yaml_is_refused_in_one_line(tmp_path, text):
    config = write(tmp_path)
    (Path(config["scenes_dir"]) / "mine/one/scene.yaml").write_bytes(text)
    assert "scene.yaml" in refusal(config)


def test_scenes_that_wait_for_each_other_are_refused(tmp_path):
    write(tmp_path, "one", tables=["two"])
    message = refusal(write(tmp_path, "two", tables=["one"]))
    for word in ("scene.yaml: tables", "one of two of one", "Take what they share"):
        assert word in message or "two of one of two" in message
