"""The scenes of DVM beyond the paper, on tiny grids: paths and lattice, remeshing."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.run.dataset import read_run
from fracparticles.run.strengths import lattice_strengths
from fracstudy.inputs import Inputs
from scene_functions import figure, study
from scenes.beyond.dvm_particles.study import spread

REMESHINGS = ["M4'", "Lambda3", "none"]


@pytest.fixture(scope="module")
def runs(computed):
    common = {"scheme": "DVM", "beta": 0.5, "truncation": 5.0, "remeshing": REMESHINGS}
    h = [0.3990701, 0.1995350]
    blocks = [
        {**common, "order": [2, 4], "spacing": h, "dt": 0.01},
        {**common, "spacing": h[1], "dt": [0.02, 0.005]},
    ]
    return computed(blocks)


def test_particles_follow_the_exact_paths_in_the_bulk_and_tear_at_the_ends(runs):
    chosen = [
        path
        for path in runs
        if "DVM-2" in path and "h0.199" in path and "dt0.01" in path and "Lambda3" not in path
    ]
    parameters = {"times": [0.51, 0.6], "every": 10}
    result = study("dvm_particles")(Inputs("p", runs=chosen), **parameters)
    table = result.table
    assert table["exact spacing / h"].to_numpy() == pytest.approx(spread(table["t"], 0.5, 1.5))
    # The smoothing changes the velocity by about (k epsilon)^2 / 4 = 4 % at epsilon = 0.4, over a stretch of 13 %.
    stretch = table["bulk spacing / h"] / table["exact spacing / h"]
    assert np.abs(stretch - 1.0).max() < 0.01
    assert (table["largest spacing / h"] > 1.3 * table["bulk spacing / h"]).all()
    assert table["remeshings, M4'"].iloc[-1] > 0
    assert (table["nearest to the centre / D"].iloc[-1]) > 0.9
    assert len(figure("dvm_particles")(result.series, result.table, parameters).axes) == 3


def test_remeshing_table_has_every_run_and_its_orders(runs):
    parameters = {"shown": 0.2}
    result = study("dvm_remeshing")(Inputs("r", runs=runs), **parameters)
    table = result.table
    assert len(table) == len(runs)
    by_run = table.set_index(["order", "remeshing", "h", "Δt"]).sort_index()
    assert table["error, strengths"].isna().sum() == (table["remeshing"] == "none").sum()
    # The spike of Lambda3 at x = 0, where M4' has none.
    spike = table[table["order"] == "II"].groupby("remeshing")["strength at x = 0, relative error"]
    assert spike.min()["Lambda3"] > 0.2 > spike.min()["M4'"] > 0.0
    # The step study: two steps beside the smallest, for each remeshing.
    timed = by_run["in time / error"].dropna()
    assert len(timed) == 2 * len(REMESHINGS)
    free = timed.xs("none", level="remeshing").sort_index()
    # Midpoint rule against one with a step of 1/2 and 1/4: (16 - 1) / (4 - 1).
    assert free.iloc[1] / free.iloc[0] == pytest.approx(5.0, rel=0.2)
    assert len(figure("dvm_remeshing")(result.series, result.table, parameters).axes) == 3


def test_lattice_strengths_keep_the_total_within_the_lattice(runs):
    run = read_run(next(path for path in runs if "Lambda3" in path))
    h, u = float(run["particle_spacing"]), lattice_strengths(run)
    # The last step moved the particles by a cell at most: what a remeshing puts beyond the ends is what one loses.
    assert h * u.sum() == pytest.approx(float(run["mass_final"]), abs=2e-3)
    assert u.shape == run["x"].shape
