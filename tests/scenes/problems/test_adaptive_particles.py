"""Adaptive particles: what the scene says of its numbers, on the smoke grid."""

from __future__ import annotations

from fracstudy.panels import pick


def test_a_lattice_takes_fifty_times_the_particles_for_the_same_error(result):
    rows = result.table.dropna(subset="times fewer")
    assert len(rows) == 3
    assert (rows["times fewer"] > 50.0).all()
    assert rows["error"].min() < 1e-5


def test_placing_again_keeps_the_error_and_the_mass(result):
    rows = result.table.dropna(subset="mass")
    assert (rows["error"] < 2e-5).all()
    assert (rows["mass"] <= 1e-12).all()
    assert (rows["corrected"] < 1e-5).all()
    assert rows["placements"].max() > 5
    assert rows["particles"].is_monotonic_decreasing


def test_particles_that_are_acted_on_know_their_exact_solutions(result):
    rows = result.table.dropna(subset="acts")
    assert len(rows) == 3
    assert (rows["error"] < 2e-5).all()


def test_volumes_are_smallest_where_the_narrow_blob_is(result):
    first = pick(result.series, panel="spacing", series="t = 0")
    assert abs(first["x"].iloc[first["y"].argmin()]) < 0.01
    assert first["y"].max() / first["y"].min() > 500.0


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 3
