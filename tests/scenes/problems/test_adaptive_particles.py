"""Adaptive particles: what the scene says of its numbers, on the smoke grid."""

from __future__ import annotations

from pathlib import Path

import pytest

from fracstudy.inputs import Inputs
from fracstudy.scene import call, read_scenes

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def scene():
    return read_scenes(ROOT / "workflow/scenes", ["problems"], smoke=True)["adaptive_particles"]


@pytest.fixture(scope="module")
def result(scene):
    return call(scene.function("study"), Inputs("adaptive_particles"), **scene.parameters)


def test_twenty_times_fewer_particles_than_the_best_lattice(result):
    known = result.table["times fewer"].dropna()
    assert len(known) >= 2
    assert (known > 20.0).all()


def test_placed_again_the_mass_is_kept_and_the_error_small(result):
    rows = result.table.dropna(subset="placements")
    assert (rows["mass"] <= 1e-12).all()
    assert (rows["error"] < 1e-4).all()
    assert rows["placements"].is_monotonic_increasing
    assert rows["particles"].is_monotonic_decreasing


def test_the_figure_can_be_drawn(scene, result):
    drawn = call(scene.function("figure"), result.series, result.table, **scene.parameters)
    assert len(drawn.axes) == 3
