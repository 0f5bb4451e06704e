"""The scenes of the diffusion velocity method on tiny grids, and the mathematics behind them."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracparticles.errors import FracparticlesError
from fracparticles.run.case import Case
from fracparticles.run.dataset import read_run, write
from fracparticles.run.solver import solve
from fracparticles.schemes import dd
from fracparticles.schemes.stability import stability_limit
from fracstudy.inputs import Inputs
from fracstudy.scene import expand
from scene_functions import figure, study
from scenes.beyond.dvm_particles.study import lattice_strengths, spread
from scenes.lucchesi.dvm_domain import truncation_effect
from scenes.lucchesi.dvm_stability.study import displacement_growth, gpse_factors, worst_wave

REMESHINGS = ["M4'", "Lambda3", "none"]


def computed(folder, blocks):
    paths = []
    for case in expand(blocks):
        paths.append(str(folder / case.path))
        write(solve(case), paths[-1])
    return paths


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dvm")
    common = {"scheme": "DVM", "beta": 0.5, "truncation": 5.0, "remeshing": REMESHINGS}
    h = [0.3990701, 0.1995350]
    blocks = [
        {**common, "order": [2, 4], "spacing": h, "dt": 0.01},
        {**common, "spacing": h[1], "dt": [0.02, 0.005]},
    ]
    return computed(folder, blocks)


def drawn(name, result, parameters):
    return figure(name)(result.series, result.table, parameters).axes


def test_particles_follow_the_exact_paths_in_the_bulk_and_tear_at_the_ends(runs):
    chosen = [
        path
        for path in runs
        if "DVM-2" in path and "h0.199" in path and "dt0.01" in path and "Lambda3" not in path
    ]
    parameters = {"times": [0.51, 0.6], "every": 10}
    result = study("dvm_particles")(Inputs("p", parameters=parameters, runs=chosen))
    table = result.table
    assert table["exact spacing / h"].to_numpy() == pytest.approx(spread(table["t"], 0.5, 1.5))
    # The smoothing changes the velocity by about (k epsilon)^2 / 4 = 4 % at epsilon = 0.4, over a stretch of 13 %.
    stretch = table["bulk spacing / h"] / table["exact spacing / h"]
    assert np.abs(stretch - 1.0).max() < 0.01
    assert (table["largest spacing / h"] > 1.3 * table["bulk spacing / h"]).all()
    assert table["remeshings, M4'"].iloc[-1] > 0
    assert (table["nearest to the centre / D"].iloc[-1]) > 0.9
    assert len(drawn("dvm_particles", result, parameters)) == 3


def test_remeshing_table_has_every_run_and_its_orders(runs):
    parameters = {"shown": 0.2}
    result = study("dvm_remeshing")(Inputs("r", parameters=parameters, runs=runs))
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
    assert len(drawn("dvm_remeshing", result, parameters)) == 3


def test_lattice_strengths_keep_the_total_within_the_lattice(runs):
    run = read_run(next(path for path in runs if "Lambda3" in path))
    h, u = float(run["particle_spacing"]), lattice_strengths(run)
    # The last step moved the particles by a cell at most: what a remeshing puts beyond the ends is what one loses.
    assert h * u.sum() == pytest.approx(float(run["mass_final"]), abs=2e-3)
    assert u.shape == run["x"].shape


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("factor", [0.5, 1.0, 1.3])
def test_a_displacement_wave_has_the_symbol_of_dd(order, factor):
    alpha, theta = 1.5, worst_wave(1.5, order)
    step = factor * stability_limit("DD", 0.5, order)
    z = step * float(dd.symbol(np.array([theta]), alpha, order, 2.0)[0])
    measured = displacement_growth(alpha, order, step, theta, half=300)
    # The ends are felt in the middle like (k half)^-alpha; displacements are small to 1e-5.
    assert measured == pytest.approx(1.0 + z + 0.5 * z * z, abs=2e-3)
    assert z == pytest.approx(-2.0 * factor, rel=1e-5)


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("overlap", [0.25, 1.0, 3.0, 20.0])
def test_gpse_amplifies_no_wave(alpha, overlap):
    factors = gpse_factors(alpha, overlap)
    assert factors.max() <= 1.0 + 1e-12
    assert factors.min() >= -1e-12


STABILITY = {
    "beta": 0.9,
    "truncation": 5.0,
    "spacing": 0.05,
    "factors": [0.3, 0.8, 3.0],
    "growth": [0.5, 1.2],
    "half": 200,
    "overlap": [0.5, 2.0, 8.0],
    "spacings": [0.2, 0.1, 0.05, 0.025],
    "stop": {"beta": 0.1, "truncation": 5.0, "spacing": 0.2, "dt": 0.02, "remeshing": "M4'"},
}


def test_gpse_is_stable_and_dvm_is_not():
    result = study("dvm_stability")(Inputs("s", ["L-C11"], STABILITY))
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    assert verdicts == {
        "L-C11.GPSE": True,
        "L-C11.DVM": False,
        "L-C11.DVM_bounded": False,
        "L-C11.DVM_divergence": True,
    }
    table = result.table
    assert set(table.loc[table["step / limit of DD"] < 1.0, "outcome"]) == {"fine"}
    above = table[table["step / limit of DD"] > 1.0].set_index("run")["outcome"]
    assert above["GPSE, open exterior"] == "fine"
    assert above["DVM, M4'"] != "fine"
    assert len(drawn("dvm_stability", result, STABILITY)) == 2


def test_statements_on_stability_can_turn_out_otherwise():
    harmless = {**STABILITY, "factors": [0.3, 0.8]}
    harmless["stop"] = {**STABILITY["stop"], "dt": 1e-3, "t_final": 0.51}
    findings = study("dvm_stability")(Inputs("s", ["L-C11"], harmless)).findings
    verdicts = {finding.claim: finding.verdict for finding in findings}
    assert verdicts["L-C11.DVM"] is True  # no run above the limit
    assert verdicts["L-C11.DVM_divergence"] is False  # nothing stops


def test_truncation_acts_on_dvm_as_on_dd(tmp_path):
    common = {"beta": 0.5, "spacing": 0.1995350, "dt": 0.01, "store": "profile"}
    paths = computed(
        tmp_path,
        [
            {**common, "scheme": ["DD", "KPSE"], "truncation": 5.0},
            # A run that another scene needs in full.
            {**common, "scheme": ["DD", "KPSE"], "truncation": 20.0, "store": "field"},
            {**common, "scheme": "DVM", "truncation": [5.0, 20.0], "remeshing": "none"},
        ],
    )
    effect, error = truncation_effect(Inputs("t", runs=paths).scalars)
    assert list(effect.columns) == [5.0]
    assert set(effect.index) == {"DD", "KPSE", "DVM, none"} == set(error.index)
    # DD and DVM miss the tail itself, KPSE its exchange: an order of magnitude apart.
    assert effect.loc["KPSE", 5.0] > 10.0 * effect.loc[["DD", "DVM, none"], 5.0].max()


def test_table_2_of_dvm_needs_its_three_levels(tmp_path):
    h = [0.3990701, 0.1995350, 0.09976752]
    runs = computed(
        tmp_path,
        [
            {"scheme": "DVM", "beta": 0.5, "truncation": 5.0, "spacing": h, "dt": 5e-3, "remeshing": "M4'"},
            {"scheme": "DVM", "beta": 0.5, "truncation": 5.0, "spacing": h[:2], "dt": 5e-3, "remeshing": "Lambda3"},
        ],
    )  # fmt: skip
    parameters = {
        "schemes": [],
        "remeshings": ["M4'", "Lambda3"],
        "spacing": {"0.5": 0.2},
        "printed": {"L-T2.DVM.II.beta0.5": "2.00"},
    }
    result = study("lucchesi_table_2")(Inputs("t", ["L-T2"], parameters, runs))
    ours = result.table.set_index("scheme")["ours"]
    # Epsilon = 2 h = 0.4 on the middle level: the next term of the smoothing error is of relative size 0.4^2.
    assert ours["DVM, M4'"] == pytest.approx(2.0, abs=0.16)
    assert np.isnan(ours["DVM, Lambda3"])
    assert {finding.claim for finding in result.findings} == {
        "L-T2.DVM.II.beta0.5",
        "L-T2.expected",
        "L-T2.DVM.rate",
    }


def test_lattices_that_do_not_match_are_refused():
    runs = pd.DataFrame({"particle_spacing": [0.1, 0.1001]})
    with pytest.raises(FracparticlesError, match="multiples"):
        truncation_effect(runs)


def test_the_printed_step_of_dvm_is_that_of_the_paper():
    case = Case(scheme="DVM", beta=0.9, truncation=10.0, spacing=0.01473467, dt=5e-5)
    # 4.4 calls DVM stable: the printed step is far below the limit, which is why it looked so.
    assert case.time_step < 0.03 * case.largest_stable_step
