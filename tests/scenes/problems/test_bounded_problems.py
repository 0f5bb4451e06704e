"""Problems on bounded domains: what the scene says of its numbers, on the smoke grid."""

from __future__ import annotations

from pathlib import Path

import pytest

from fracstudy.inputs import Inputs
from fracstudy.panels import pick
from fracstudy.scene import call, read_scenes

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def scene():
    return read_scenes(ROOT / "workflow/scenes", ["problems"], smoke=True)["bounded_problems"]


@pytest.fixture(scope="module")
def result(scene):
    return call(scene.function("study"), Inputs("bounded_problems"), **scene.parameters)


def test_the_interval_has_five_digits_with_a_hundred_particles(result):
    rows = pick(result.table, domain="interval", particles=100)
    assert len(rows) == 3
    assert (rows["error"] < 1e-5).all()
    assert (
        rows["observed order"] > rows["of theory"] - 0.8
    ).all()  # that of D(x, t) is still rising


def test_the_disc_has_the_order_of_its_rings(result):
    rows = pick(result.table, domain="disc", particles=32).dropna(subset="observed order")
    assert len(rows) == 2
    assert (rows["observed order"] > rows["of theory"] - 0.2).all()


def test_the_square_gains_with_its_particles(result):
    rows = pick(result.table, domain="square", particles=24).dropna(subset="observed order")
    assert (rows["observed order"] > 1.8).all()
    assert (rows["error"] < 5e-4).all()


def test_what_reflects_keeps_its_total_and_what_turns_only_turns(result):
    kept = pick(result.table, exterior="reflecting")
    assert len(kept) == 3
    assert (kept["drift of the total"] <= 1e-12).all()
    assert (pick(result.table, problem="rotation")["error"] < 1e-6).all()


def test_the_figure_can_be_drawn(scene, result):
    drawn = call(scene.function("figure"), result.series, result.table, **scene.parameters)
    assert len(drawn.axes) == 3
