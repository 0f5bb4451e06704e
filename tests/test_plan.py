"""The configuration: validated with messages a person understands, expanded, shared, batched."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from fracparticles.errors import InvalidInput
from fracstudy import plan
from fracstudy.studies import OWN_PARAMETERS, STUDIES

ROOT = Path(__file__).resolve().parents[1]
BLOCK = {
    "scheme": ["DD", "KPSE"],
    "order": [2, 4],
    "beta": 0.5,
    "truncation": 10.0,
    "spacing": [0.5, 0.25],
    "dt": 0.01,
    "store": "metrics",
}


def config(**scene):
    scene = {"title": "t", "study": "truncation", "runs": [BLOCK], **scene}
    return {"results_dir": "r", "report_dir": "p", "scenes": {"one": scene}}


def changed(**fields):
    return config(runs=[{**BLOCK, **fields}])


def test_a_block_stands_for_the_cartesian_product_without_repeats():
    cases = plan.expand([BLOCK, {**BLOCK, "scheme": "DD"}])
    assert len(cases) == 2 * 2 * 2
    assert len({case.path for case in cases}) == len(cases)


@pytest.mark.parametrize(
    ("broken", "words"),
    [
        (changed(dt="1e-4"), ("scenes.one.runs.0.dt", "'1e-4'", "1.0e-4")),
        (changed(spacng=0.1), ("spacng", "Did you mean 'spacing'?")),
        (changed(scheme="KPSF"), ("scheme", "KPSF", "KPSE")),
        (changed(order=3), ("order", "3", "2, 4, 6, 8, 10 or 12")),
        (changed(beta=1.5), ("beta", "1.5", "1")),
        (changed(truncation=-1.0), ("truncation", "-1.0", "0")),
        (
            changed(exterior="open", scheme="FD", order=2),
            ("one", "exterior", "'open'", "truncated"),
        ),
        (config(study="truncatoin"), ("scenes.one.study", "truncatoin", "truncation")),
        (config(figure="none"), ("scenes.one.figure", "none")),
        (config(tables=["two"]), ("scenes.one.tables", "two", "one")),
        (config(titel="x"), ("titel", "Did you mean 'title'?")),
        ({**config(), "result_dir": "x"}, ("result_dir", "Did you mean 'results_dir'?")),
        ({"results_dir": "r", "report_dir": "p"}, ("scenes", "needed")),
    ],
)
def test_a_mistake_is_named_in_one_line(broken, words):
    with pytest.raises(InvalidInput) as caught:
        plan.read_config(broken)
    message = str(caught.value)
    assert "\n" not in message
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    "parameters",
    [
        {"beta": 0.5000001},
        {"order": [2, 4], "spacing": [0.25, 0.5]},
        {"scheme": "DD", "store": "metrics"},
        {
            "half_width": 3.0,
            "t_final": 1.5,
        },  # the runs have a truncation; the end is that of the case
        {"spacing": {"0.5": 0.1}, "lines": 4},  # words of the study
    ],
)
def test_a_parameter_may_say_what_the_runs_are(parameters):
    plan.read_config(config(parameters=parameters))


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"beta": 0.3}, ("beta = 0.3", "0.5")),
        ({"beta": [0.5, 0.3]}, ("beta", "0.5")),
        ({"truncation": 20.0}, ("truncation = 20.0", "10.0")),
        ({"spacing": 0.3}, ("spacing", "0.5 or 0.25")),
        ({"scheme": "FPSE"}, ("scheme", "DD or KPSE")),
        ({"t_final": 2.0}, ("t_final", "1.5")),
        ({"order": "2"}, ("order", "2 or 4")),
    ],
)
def test_a_parameter_that_the_runs_do_not_have_is_refused_before_anything_runs(parameters, words):
    """Else a figure would be drawn from the runs that are there, under another name."""
    with pytest.raises(InvalidInput, match=r"^scenes\.one\.parameters\.") as error:
        plan.read_config(config(parameters=parameters))
    for word in (*words, "Change the runs"):
        assert word in str(error.value)


def test_a_study_may_have_parameters_of_its_own():
    plan.read_config(config(study="random_walk", parameters={"dt": [0.5, 0.05]}))
    with pytest.raises(InvalidInput, match="beta"):
        plan.read_config(config(study="random_walk", parameters={"beta": 0.3}))
    assert set(OWN_PARAMETERS) <= set(STUDIES)


def test_one_switch_for_the_step_of_dvm():
    block = {"scheme": ["DVM", "DD"], "beta": 0.5, "truncation": 10.0, "spacing": 0.1, "dt": 1.0e-3}
    steps = {**block, "scheme": "DVM", "dt": [1.0e-3, 2.0e-3]}
    given = config(runs=[block, steps])
    study = plan.read_config({**given, "dvm_dt": 5.0e-5})
    found = [(c.scheme, c.dt) for c in plan.cases_of("one", study.scenes["one"])]
    assert found == [("DD", 1e-3), ("DVM", 5e-5), ("DVM", 1e-3), ("DVM", 2e-3)]
    unchanged = plan.cases_of("one", plan.read_config(given).scenes["one"])
    assert {c.dt for c in unchanged} == {1e-3, 2e-3}


def test_scenes_share_a_run_and_the_wider_store_wins():
    scenes = {
        "a": plan.Scene(title="a", study="truncation", runs=[BLOCK]),
        "b": plan.Scene(
            title="b", study="truncation", runs=[{**BLOCK, "scheme": "DD", "store": "field"}]
        ),
    }
    cases, batches = plan.batches(scenes)
    shared = {case.path for case in cases["a"]} & {case.path for case in cases["b"]}
    assert len(shared) == 4
    assert all(case.store == "field" for case in cases["b"])
    computed = [case.path for batch in batches.values() for case in batch]
    assert len(computed) == len(set(computed)) == 8


def test_a_scene_computes_nothing_that_it_does_not_need():
    study = plan.read_config(yaml.safe_load((ROOT / "config/study.yaml").read_text()))
    cases, batches = plan.batches(study.scenes)
    for scene in study.scenes:
        wanted = {case.path for case in cases[scene]}
        for batch in batches.values():
            computed = {case.path for case in batch}
            assert computed <= wanted or not computed & wanted


def test_both_configurations_hold_the_same_scenes():
    study, smoke = (
        yaml.safe_load((ROOT / f"config/{name}.yaml").read_text()) for name in ("study", "smoke")
    )
    assert list(study["scenes"]) == list(smoke["scenes"])
    for name, scene in study["scenes"].items():
        # smoke.yaml is laid over study.yaml: a key that it lacks would bring in the full grid.
        assert scene.keys() == smoke["scenes"][name].keys(), name
        assert scene.get("items") == smoke["scenes"][name].get("items")


def test_the_schema_file_is_the_models_own():
    schema = json.loads((ROOT / "workflow/schemas/config.schema.json").read_text())
    assert schema == plan.config_schema()
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"


def test_the_schema_accepts_both_configurations_and_refuses_a_misspelt_key():
    import jsonschema

    validator = jsonschema.Draft202012Validator(plan.config_schema())
    for name in ("study", "smoke"):
        validator.validate(yaml.safe_load((ROOT / f"config/{name}.yaml").read_text()))
    assert list(validator.iter_errors({**config(), "result_dir": "x"}))
    assert list(validator.iter_errors(changed(spacng=0.1)))
    assert list(validator.iter_errors(changed(dt="1e-4")))
