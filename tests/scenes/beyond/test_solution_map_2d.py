"""The maps of the plane on a tiny square."""

from __future__ import annotations

import pytest

from fracparticles.errors import FracparticlesError
from fracparticles.run.case import Case
from fracparticles.special.plane import square_tail_mass
from fracstudy.inputs import Inputs
from scenes.beyond.solution_map_2d.figure import figure
from scenes.beyond.solution_map_2d.study import study

GRID = {"beta": 0.5, "dim": 2, "truncation": 4.0, "dt": 5e-3, "spacing": 0.5586979}
BLOCK = {**GRID, "scheme": ["DD", "KPSE"], "exterior": ["truncated", "open"]}
MAPS = [["DD", 2, "u"], ["DD", 2, "error"], ["KPSE", 2, "error"]]


def test_maps(computed):
    result = study(Inputs("map", runs=computed([BLOCK])), maps=MAPS)
    assert len(result.table) == 4
    # Three maps, truncated and open, of the quadrant of 17^2 particles.
    assert len(result.series) == 3 * 2 * 17**2
    kpse = result.table.set_index(["scheme", "exterior"]).loc[("KPSE", "truncated")]
    # The exchange conserves: at t_f it holds the mass inside the square at t_0, up to the midpoint rule.
    half = Case(scheme="KPSE", **GRID).reach
    assert kpse["mass at t_f"] == pytest.approx(1.0 - square_tail_mass(half, 0.5, 1.5), abs=2e-3)
    figure(result.series, maps=MAPS).draw_without_rendering()


def test_runs_without_a_field_are_refused(computed):
    files = computed([{**BLOCK, "store": "metrics"}])
    with pytest.raises(FracparticlesError, match="store: field"):
        study(Inputs("map", runs=files), maps=MAPS)
