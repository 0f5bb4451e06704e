"""The marker scenes on few markers: every claim answered, every figure drawn, and what they must find."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fracparticles.markers import SHAPES
from fracparticles.markers.nonlinear import NonlinearDiffusion
from fracparticles.markers.stability import extremes, rate
from fracstudy.inputs import Inputs
from fracstudy.ledger import judge
from fracstudy.printed import read_claims
from fracstudy.verdicts import Status
from scene_functions import figure, scenes, study
from scenes.lewandowski.marker_claims.error_law import _best, rows
from scenes.lewandowski.marker_claims.numbers import _parameters
from scenes.lewandowski.marker_nonlinear.evolution import Evolution, Markers
from scenes.lewandowski.marker_square.study import _apart
from scenes.lewandowski.square_profile import INFINITE, SquareRuns, Starts
from sweeps import few, thorough

CLAIMS = {
    claim.id: claim
    for claim in read_claims(Path(__file__).parents[3] / "report/printed/lewandowski")
}
RUN = {"dt": 0.05, "t_final": 0.5, "markers": 48, "half_width": 14.0, "grid": 120}
RANDOM = {"run": RUN, "seed": 2005, "seeds": 1}
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
        "counts": [16, 64],
        "shapes": ["S4", "S8"],
        "law": ["S4", "S8"],
        "spacings": [0.4, 0.2],
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
        "per_axis": [16, 36],
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


def numbers(name):
    return {finding.claim: finding.numbers for finding in result(name).findings}


def statuses(name):
    return {
        finding.claim: judge(CLAIMS[finding.claim], finding) for finding in result(name).findings
    }


@pytest.mark.parametrize("name", PARAMETERS)
def test_every_claim_is_measured(name):
    wanted = {key for key, claim in CLAIMS.items() if claim.item in scenes()[name].items}
    untestable = {key for key in wanted if CLAIMS[key].untestable}
    found = statuses(name)
    assert set(found) <= wanted <= set(found) | untestable
    assert all(numbers(name).values())
    assert {key for key, status in found.items() if status is Status.NOT_TESTABLE} <= untestable
    assert len(result(name).table)


@pytest.mark.parametrize("name", few(PARAMETERS))  # the smoke run draws all of them
def test_the_figure_is_drawn(name):
    drawing = figure(name)(result(name).series, result(name).table, PARAMETERS[name])
    drawing.draw_without_rendering()


def test_a_claim_of_another_scene_is_not_answered():
    inputs = Inputs("marker_loading", ["M-F4"])
    findings = study("marker_loading")(inputs, **PARAMETERS["marker_loading"]).findings
    assert {finding.claim for finding in findings} == {"M-F4.better", "M-F4.degrades"}


def test_two_printed_constants_are_misprints():
    found = statuses("marker_shapes")
    wrong = {claim for claim, status in found.items() if status is Status.MISPRINT}
    assert wrong == {"M-SHAPES.beta", "M-SHAPES.alpha"}
    miss = numbers("marker_shapes")["M-SHAPES.normalised"]["miss"]
    assert {name for name, m in miss.items() if m > 1e-12} == {"S6", "S7"}


def test_equal_weights_are_a_misprint_but_their_positions_are_right():
    found = numbers("marker_loading")
    assert found["M-F1.positions"]["miss"] < 1e-14
    # sigma = (1 - exp(-9)) / 2
    assert found["M-F1.weights"]["factor"] == pytest.approx(2.0 / (1.0 - np.exp(-9.0)), rel=1e-12)
    assert statuses("marker_loading")["M-F1.weights"] is Status.MISPRINT


def test_a_smooth_shape_function_of_infinite_support_may_have_a_negative_transform():
    x, k = np.linspace(-7.0, 7.0, 1401), np.array([0.0, 1.0, 2.0, 3.2, 6.0])
    values = (x[1] - x[0]) * np.cos(np.multiply.outer(k, x)) @ INFINITE(x)
    assert INFINITE.transform(k) == pytest.approx(values, abs=1e-12)
    found = extremes(INFINITE)
    # -k^2 (1 - k^2/4) exp(-k^2/4) is largest at k^2/4 = (3 + sqrt(5)) / 2.
    q = 0.5 * (3.0 + np.sqrt(5.0))
    assert found.k_growth == pytest.approx(2.0 * np.sqrt(q), rel=1e-4)
    assert found.growth == pytest.approx(4.0 * q * (q - 1.0) * np.exp(-q), rel=1e-6)
    growth = numbers("marker_growth")["M-C1.ensures"]["growth"]
    assert growth[INFINITE.name] == pytest.approx(found.growth, rel=0.01)


def test_which_shape_functions_form_clusters():
    runs = SquareRuns(dt=0.05, t_final=5.0, markers=128, half_width=14.0, grid=100)
    share = {name: Starts(runs, [name], range(1)).share(name) for name in ("S2", "S4", "S9")}
    assert share == {"S2": 0.0, "S4": 1.0, "S9": 1.0}


def test_second_differences_are_more_accurate_than_markers():
    ratio = numbers("marker_square")["M-F7.accuracy"]["ratio"]
    assert min(ratio.values()) > 1.0
    assert numbers("marker_square")["M-F5.exact"]["gap"] < 1e-13


def test_the_slope_of_the_large_scales_is_wrong_only_where_eps_is_large():
    """Smoothed over the half-width 1, wiggles of eps = 0.2 are damped by exp(-(2 pi / 0.2)^2 / 2); eps = 2 is wider."""
    excess = {}
    for epsilon in (0.2, 2.0):
        runs = SquareRuns(
            dt=0.02, t_final=2.0, markers=128, half_width=14.0, grid=500, support=epsilon
        )
        trace = runs.trace("S8", "midpoints", follow=False)
        excess[epsilon] = _apart(runs, trace, epsilon)["excess of the coarse slope"]
    assert abs(excess[0.2]) < 0.05 < excess[2.0]


def test_the_best_support_parameter_is_the_power_of_h_that_the_law_says():
    """Its derivative is zero where k eps^k = M (h / eps)^M, so that eps ~ h^(M / (k + M)), 3/5 for S4."""
    best = pd.DataFrame(rows(["S4", "S8"], [0.4, 0.2, 0.1, 0.05])).query("what == 'best ε'")
    found = next(f for f in _best(best) if f.claim == "M-C3.optimum").numbers
    assert found["power"]["S4"] < 0.1


def test_the_number_of_markers_in_a_support_parameter_is_what_counts():
    found = numbers("marker_claims")
    assert found["M-C2.per_support"]["quotient"] > 1000.0
    assert found["M-C2.per_support"]["product"] < 2.0
    assert found["M-C3.formula"]["miss"] < 1e-6
    assert statuses("marker_claims")["M-C5.delta"] is Status.MISPRINT


def test_a_denominator_is_no_less_than_its_first_term_if_no_shape_function_is_negative():
    least = numbers("marker_claims")["M-C5.denominator"]["least"]
    assert min(least["S4"], least["S7"]) >= 1.0


def test_the_growth_is_called_unbounded_where_it_is():
    """-k^2 S^(k) of the gate is -k sin k; of the others it falls, or nears twice the slope at the end."""
    table = result("marker_shapes").table.set_index("S")
    assert list(table.index[table["beyond"] == "unbounded"]) == ["S1"]
    largest = table["largest growth × ε², k < 30"]
    # The highest wave below 30 ends at 3 pi / 2 + 8 pi, its top is where tan k = -k.
    assert largest["S1"] == pytest.approx(29.8618, abs=1e-3)
    for waves in (10, 100, *[1000] * thorough()):
        k = np.array((2.0 * waves + 1.5) * np.pi)
        assert rate(SHAPES["S1"], k) == pytest.approx(k, rel=1e-9)
    beyond = np.linspace(30.0, 1000.0, 4001)  # some thirteen of a wave
    for name in table.index.drop("S1"):
        # The transform is good to 1e-14, its product with k^2 to 1e-8.
        assert rate(SHAPES[name], beyond).max() <= largest[name] + 1e-7, name


def test_nonlinear():
    found, judged = numbers("marker_nonlinear"), statuses("marker_nonlinear")
    assert found["M-F17.steady"]["gap"] < 1e-12
    assert max(found["M-F17.integral"]["work"].values()) < 1.0
    assert found["M-F18.time_step"]["left"] > 0.5
    assert judged["M-F18.long_time"] is judged["M-F18.demonstrated"] is Status.REFUTED
    assert found["M-F18.shown"]["apart"] < 0.02
    table = result("marker_nonlinear").table
    stable = table[table["run"] == "stable integrator"]
    assert (stable["stopped"] == "").all()
    # Both stable runs show the same field in the core; the steps' own errors are far below.
    core = "max |F - f_inf|, core"
    small = table[table["run"] == "smaller step"]
    both = small.merge(stable, on="t")
    assert np.abs(both[f"{core}_x"] - both[f"{core}_y"]).max() < 2e-3


def test_a_run_that_stops_keeps_its_last_markers():
    run = Evolution(Markers(NonlinearDiffusion(), 2.5, 64), 0.1).to(2.0, [0.0])
    assert run.stopped.startswith("step ")
    assert run.times[0] == 0.0
    assert run.times[-1] == run.last < 2.0
    assert np.isfinite(run.end).all()


def test_other_equations():
    found = numbers("marker_velocities")
    assert found["M-C6.kdv_velocity"]["miss"] < 1e-6
    assert found["M-C6.diffusion"]["miss"] < 1e-5
    assert found["M-C6.source_velocity"]["miss"] < 1e-4
    # Markers of constant weight lack what the source adds: q sqrt(pi) t of (1 + q t) sqrt(pi).
    missing = found["M-C6.source"]["gained"]
    assert missing == pytest.approx(0.2)
    assert found["M-C6.source"]["error"]["a source with a total"] == pytest.approx(
        missing, abs=0.02
    )
    # So short a run of a bare soliton does not stop: the verdict can fail.
    assert statuses("marker_velocities")["M-C6.kdv"] is Status.REPRODUCED
    assert found["M-C6.positive"]["ratio"] > 10.0
    # Flexible but for a source with a total.
    flexible = found["M-C6.flexible"]["error"]
    assert {case for case, error in flexible.items() if error > 0.05} == {"a source with a total"}


def test_the_tails_do_not_ask_for_a_smaller_step():
    """A quarter of the step moves no marker by a hundredth of eps, the outermost ones not more than the others."""
    runs = SquareRuns(dt=0.05, t_final=2.0, markers=128, half_width=14.0, grid=200)
    step = next(f for f in _parameters(runs, seed=1) if f.claim == "M-C5.step").numbers
    assert 0.0 < step["tail"] < 3.0 * step["core"] < 0.01


def test_plane():
    found, judged = numbers("marker_plane"), statuses("marker_plane")
    assert judged["M-C7.general"] is Status.PART
    error = found["M-C7.general"]["error"]
    assert error["a = 0"] < 0.05 < error["a = 1"]
    assert found["M-C7.plane_diffusion"]["error"] < 0.05
    assert max(found["M-C7.uniform"]["error"].values()) < 0.05
