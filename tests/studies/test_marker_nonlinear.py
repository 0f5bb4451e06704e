"""The scenes of nonlinear diffusion, other equations and the plane, on few markers."""

from __future__ import annotations

import numpy as np
import pytest

from fracstudy.inputs import Inputs
from scene_functions import figure, study
from scenes.lewandowski.marker_nonlinear.study import Setting, evolve

NONLINEAR = {
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
    "core": 1.2,
    "flank": 1.7,
}
VELOCITIES = {
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
}
PLANE = {
    "a": [0.0, 1.0],
    "per_axis": [16, 48],
    "support": 0.45,
    "half_width": 6.0,
    "grid": 61,
    "shown": {"a": 1.0, "per_axis": 8},
}
CLAIMS = {
    "marker_nonlinear": {
        *(f"M-F17.{name}" for name in ("steady", "integral", "initial")),
        *(f"M-F18.{name}" for name in ("time_step", "agreement", "long_time")),
    },
    "marker_velocities": {
        f"M-C6.{name}"
        for name in ("kdv_velocity", "kdv", "burgers", "shocks", "positive", "source")
    },
    "marker_plane": {f"M-C7.{name}" for name in ("product", "general", "decoupled")},
}
PARAMETERS = {
    "marker_nonlinear": NONLINEAR,
    "marker_velocities": VELOCITIES,
    "marker_plane": PLANE,
}


@pytest.fixture(scope="module")
def results():
    return {name: study(name)(Inputs(name, [], p)) for name, p in PARAMETERS.items()}


@pytest.mark.parametrize("name", PARAMETERS)
def test_each_claim_has_one_finding_with_its_evidence(results, name):
    findings = results[name].findings
    assert sorted(finding.claim for finding in findings) == sorted(CLAIMS[name])
    assert all(finding.evidence and (finding.verdict or finding.reason) for finding in findings)


@pytest.mark.parametrize("name", PARAMETERS)
def test_figure(results, name):
    drawing = figure(name)(results[name].series, results[name].table, PARAMETERS[name])
    drawing.draw_without_rendering()


def verdicts(result):
    return {finding.claim.split(".")[1]: finding.verdict for finding in result.findings}


def test_nonlinear(results):
    found = verdicts(results["marker_nonlinear"])
    assert found["steady"]
    assert not found["integral"]
    assert not found["time_step"]
    assert not found["long_time"]
    table = results["marker_nonlinear"].table
    stable = table[table["run"] == "stable integrator"]
    assert (stable["stopped"] == "").all()
    # Both stable runs show the same field in the core; the steps' own errors are far below.
    core = "max |F - f_inf|, core"
    small = table[table["run"] == "smaller step"]
    both = small.merge(stable, on="t")
    assert np.abs(both[f"{core}_x"] - both[f"{core}_y"]).max() < 2e-3


def test_a_run_that_stops_keeps_its_last_markers():
    setting = Setting.of(NONLINEAR)
    run = evolve(setting, "coarse", 0.02, 2.0, [0.0])
    assert run.stopped.startswith("step ")
    assert run.times[0] == 0.0
    assert run.times[-1] == run.last < 2.0
    assert np.isfinite(run.end).all()


def test_other_equations(results):
    found = verdicts(results["marker_velocities"])
    assert found["kdv_velocity"]
    assert found["kdv"]
    assert not found["source"]
    # So short a run of a bare soliton does not stop: the verdict can fail.
    assert not found["positive"]


def test_plane(results):
    found = verdicts(results["marker_plane"])
    assert found == {"product": True, "general": False, "decoupled": True}
