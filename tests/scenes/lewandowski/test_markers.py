"""The marker scenes on few markers: every claim answered, every figure drawn, and what they must find."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fracparticles.markers import SHAPES
from fracparticles.markers.nonlinear import NonlinearDiffusion
from fracparticles.markers.stability import rate
from fracstudy.claims import Status, judge, read_claims
from fracstudy.inputs import Inputs
from scene_functions import figure, scenes, study
from scenes.lewandowski.marker_nonlinear.study import Evolution, Markers

CLAIMS = {
    claim.id: claim
    for claim in read_claims(Path(__file__).parents[3] / "report/printed/lewandowski2005.yaml")
}
RUN = {"dt": 0.05, "t_final": 0.5, "markers": 48, "half_width": 14.0, "grid": 120}
RANDOM = {"run": RUN, "seed": 2005, "seeds": 2}
PARAMETERS = {
    "marker_shapes": {"wavenumbers": 20.0},
    "marker_loading": {
        "support": 0.1,
        "markers": 32,
        "ends": [2.0, 4.0, 5],
        "tabled": [3.0],
        "shown": 3.0,
    },
    "marker_square": {
        "run": {**RUN, "dt": 0.02, "t_final": 0.1},
        "seed": 1,
        "supports": [0.5],
        "shown": [0.2, 2.0, 1.0],
    },
    "marker_fixed_grid": RANDOM,
    "marker_moving_grid": {**RANDOM, "compared": ["S2", "S5"]},
    "marker_error_norm": {**RANDOM, "long": {**RUN, "t_final": 1.0}},
    "marker_growth": {
        "run": {**RUN, "t_final": 1.25},
        "lattices": {"S4": {"spacing": 0.125, "period": 4.0, "amplitude": 1e-4, "modes": [2, 4]}},
        "wavenumbers": 13.0,
        "limits": {"shapes": ["S4"], "supports": [1.0]},
        "steps": [0.05, 1.25],
    },
    "marker_claims": {
        **RANDOM,
        "small_dt": 0.025,
        "watched": 0.2,
        "counts": [16, 32],
        "shapes": ["S4", "S8"],
        "law": ["S4", "S8"],
        "spacings": [0.4],
        "times": [0.25, 0.5],
    },
    "marker_nonlinear": {
        "problem": {"d0": 10.0, "alpha": 4.0, "x0": 0.5},
        "half_width": 2.5,
        "markers": 128,
        "dt": 0.01,
        "t_final": 2.0,
        "small_dt": 0.005,
        "small_until": 1.0,
        "scan_dt": [0.005, 0.01, 0.02],
        "scan_until": 1.0,
        "times": [0.5, 1.0],
        "compared_at": 0.2,
        "reference_times": [0.1, 0.2],
        "lines": {"half_width": 4.0, "cells": 400, "within": 3.0},
    },
    "marker_velocities": {
        "burgers": {
            "total": 2.0,
            "reynolds": [5.0, 20.0],
            "start": 0.5,
            "times": [1.0, 2.0],
            "dt": 0.05,
            "support": 0.3,
            "markers": [32, 64],
            "shown": 20.0,
        },
        "kdv": {
            "c": 4.0,
            "background": 0.5,
            "period": 16.0,
            "t_final": 0.1,
            "residual_half_width": 12.0,
            "runs": [[128, 0.5, 2.0e-3], [128, 0.4, 1.0e-3]],
            "bare": {"half_width": 6.0, "markers": 64, "support": 0.3, "dt": 1.0e-3},
        },
        "source": {
            "q": {"0": 0.5, "2": -0.5},
            "t_final": 0.5,
            "support": 0.5,
            "step": 0.25,
            "markers": [32, 64],
        },
    },
    "marker_plane": {
        "a": [0.0, 1.0],
        "per_axis": [16, 48],
        "support": 0.45,
        "half_width": 6.0,
        "grid": 61,
        "shown": {"a": 1.0, "per_axis": 8},
    },
}


@cache
def result(name):
    inputs = Inputs(name, scenes()[name].items)
    return study(name)(inputs, **PARAMETERS[name])


def verdicts(name):
    return {finding.claim.split(".")[1]: finding.verdict for finding in result(name).findings}


@pytest.mark.parametrize("name", PARAMETERS)
def test_every_claim_is_answered_with_its_evidence(name):
    findings, items = result(name).findings, scenes()[name].items
    answered = sorted(finding.claim for finding in findings)
    assert answered == sorted(key for key, claim in CLAIMS.items() if claim.item in items)
    for finding in findings:
        assert finding.evidence
        assert finding.verdict or finding.reason
        assert finding.reason or not judge(CLAIMS[finding.claim], finding)[0].needs_reason
    assert len(result(name).table)


@pytest.mark.parametrize("name", PARAMETERS)
def test_the_figure_is_drawn(name):
    drawing = figure(name)(result(name).series, result(name).table, PARAMETERS[name])
    drawing.draw_without_rendering()


def test_a_claim_of_another_scene_is_not_answered():
    inputs = Inputs("marker_loading", ["M-F4"])
    findings = study("marker_loading")(inputs, **PARAMETERS["marker_loading"]).findings
    assert {finding.claim for finding in findings} == {"M-F4.better", "M-F4.degrades"}


def test_two_printed_constants_are_wrong():
    findings = result("marker_shapes").findings
    refuted = {f.claim for f in findings if judge(CLAIMS[f.claim], f)[0] is Status.REFUTED}
    assert refuted == {"M-SHAPES.beta", "M-SHAPES.alpha"}


def test_the_growth_is_called_unbounded_where_it_is():
    """-k^2 S^(k) of the gate is -k sin k; of the others it falls, or nears twice the slope at the end."""
    table = result("marker_shapes").table.set_index("S")
    assert list(table.index[table["beyond"] == "unbounded"]) == ["S1"]
    largest = table["largest growth × ε², k < 30"]
    # The highest wave below 30 ends at 3 pi / 2 + 8 pi, its top is where tan k = -k.
    assert largest["S1"] == pytest.approx(29.8618, abs=1e-3)
    for waves in (10, 100, 1000):
        k = np.array((2.0 * waves + 1.5) * np.pi)
        assert rate(SHAPES["S1"], k) == pytest.approx(k, rel=1e-9)
    beyond = np.linspace(30.0, 1000.0, 20001)
    for name in table.index.drop("S1"):
        # The transform is good to 1e-14, its product with k^2 to 1e-8.
        assert rate(SHAPES[name], beyond).max() <= largest[name] + 1e-7, name


def test_nonlinear():
    found = verdicts("marker_nonlinear")
    assert found["steady"]
    assert not found["integral"]
    assert not found["time_step"]
    assert not found["long_time"]
    table = result("marker_nonlinear").table
    stable = table[table["run"] == "stable integrator"]
    assert (stable["stopped"] == "").all()
    # Both stable runs show the same field in the core; the steps' own errors are far below.
    core = "max |F - f_inf|, core"
    small = table[table["run"] == "smaller step"]
    both = small.merge(stable, on="t")
    assert np.abs(both[f"{core}_x"] - both[f"{core}_y"]).max() < 2e-3


def test_a_run_that_stops_keeps_its_last_markers():
    run = Evolution(Markers(NonlinearDiffusion(), 2.5, 128), 0.02).to(2.0, [0.0])
    assert run.stopped.startswith("step ")
    assert run.times[0] == 0.0
    assert run.times[-1] == run.last < 2.0
    assert np.isfinite(run.end).all()


def test_other_equations():
    found = verdicts("marker_velocities")
    assert found["kdv_velocity"]
    assert found["kdv"]
    assert not found["source"]
    # So short a run of a bare soliton does not stop: the verdict can fail.
    assert not found["positive"]


def test_plane():
    assert verdicts("marker_plane") == {"product": True, "general": False, "decoupled": True}
