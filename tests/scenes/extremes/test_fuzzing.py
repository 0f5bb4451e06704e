"""Fuzzing: no case of any property is bad, of those that seeds draw and of those that hypothesis finds."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pydantic import BaseModel, Field

from fracparticles.errors import InvalidInput
from fracstudy.inputs import Inputs
from fracstudy.probe import BAD, Verdict
from scene_functions import study
from scenes.extremes.fuzzing import again
from scenes.extremes.fuzzing.harness import Property, draw, judged, outcome, row
from scenes.extremes.fuzzing.strategies import fields_of, given_fields
from scenes.extremes.fuzzing.study import PROPERTIES

NAMES = [one.name for one in PROPERTIES]


@pytest.mark.parametrize("one", PROPERTIES, ids=NAMES)
def test_no_case_that_hypothesis_finds_is_bad(one):
    @settings(
        max_examples=settings.default.max_examples // 5,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(one.cases)
    def holds(case):
        found = judged(one, lambda: case)
        assert found.verdict not in BAD, found.words

    holds()


@pytest.fixture(scope="module")
def table():
    return study("fuzzing")(Inputs("fuzzing"), cases=60).table


def test_no_case_of_the_study_is_bad(table):
    bad = table[table["verdict"].isin(BAD)]
    assert bad.empty, bad.to_markdown(index=False)
    assert (table["deviation"] == 0.0).all()


def test_every_case_is_counted(table):
    verdicts = [str(verdict) for verdict in Verdict]
    assert (table["cases"] == table[[*verdicts, "not run"]].sum(axis=1)).all()
    assert table[["held", "refused"]].sum().gt(0).all()


def test_runs_that_are_not_right_are_warned_of():
    _, counts = row(PROPERTIES[NAMES.index("a run, fundamental")], 20)
    assert counts["warned"] > 0


def test_properties_have_names_of_their_own():
    assert len(set(NAMES)) == len(NAMES)


# --- the harness --------------------------------------------------------------------------------------------


def refuses(_):
    raise InvalidInput("x", 1, "two", "Take two.")


def breaks(_):
    raise RuntimeError("broken")


def waits(_):
    while True:
        pass


@pytest.mark.parametrize(
    ("holds", "must", "verdict"),
    [
        (lambda _: 0.5, None, Verdict.HELD),
        (lambda _: 1.5, None, Verdict.SILENT),
        (refuses, Verdict.HELD, Verdict.REFUSED),
        (breaks, None, Verdict.FAILED),
        (waits, None, Verdict.FAILED),
    ],
)
def test_a_case_is_judged(holds, must, verdict, monkeypatch):
    monkeypatch.setattr("scenes.extremes.fuzzing.harness._LONGEST", 0.1)
    one = Property("x", "y", "", st.integers(), holds, 1, must)
    assert outcome(one, 3).verdict is verdict


def test_a_seed_draws_the_same_case_and_another_one_another():
    one = Property("x", "y", "", st.lists(st.floats(), min_size=3), lambda _: 0.0)
    assert repr(draw(one, 7)) == repr(draw(one, 7)) != repr(draw(one, 8))


def test_the_seeds_of_bad_cases_are_printed(capsys):
    one = Property("odd numbers", "an even one", "", st.integers(0, 100), lambda k: 2.0 * (k % 2))
    probe, counts = row(one, 20)
    bad = [seed for seed in range(20) if draw(one, seed) % 2]
    assert counts["silent"] == probe.deviation == len(bad) > 0
    assert probe.verdict is Verdict.SILENT
    assert probe.found.startswith(f"seed {bad[0]}: ")
    printed = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in printed] == [f"'odd numbers', seed {s}" for s in bad]


def test_a_case_is_drawn_again_and_shown(capsys):
    again.main("mean_radius", 3)
    shown = capsys.readouterr().out.splitlines()
    one = PROPERTIES[NAMES.index("mean_radius")]
    assert shown[0] == str(draw(one, 3))
    assert "held" in shown[1]


def test_a_new_field_is_drawn_by_its_type_and_bounds():
    class Model(BaseModel):
        size: float = Field(gt=1.0, le=3.0)
        times: tuple[float, ...] | None = None
        count: int = Field(default=1, ge=4)

    @settings(database=None)
    @given(fields_of(Model)["size"], fields_of(Model)["times"], fields_of(Model)["count"])
    def allowed(size, times, count):
        Model(size=size, times=times, count=count)

    allowed()

    @settings(database=None)
    @given(given_fields(Model, wrong=0))
    def given_together(fields):
        assert "size" in fields

    given_together()
