"""The scene of the random walk, on few walkers and a small lattice."""

from __future__ import annotations

import numpy as np
import pytest

from fracstudy.inputs import Inputs
from scene_functions import figure, study

PARAMETERS = {
    "seed": 1976,
    "earlier": [1.0],
    "walk_steps": [0.5, 0.1],
    "walkers": [1000, 10000, 50000],
    "increments": 150000,
    "cells": 32,
    "tail": 20.0,
    "zones": [0.0, 1.0, 2.0, 5.0, 10.0],
    "shown": [1000, 10000],
    "reach": 20.0,
}


@pytest.fixture(scope="module")
def result(computed):
    block = {
        "scheme": "KPSE",
        "order": 4,
        "beta": 0.5,
        "truncation": 20.0,
        "spacing": 0.2,
        "integrator": "exponential",
        "exterior": ["truncated", "open"],
        "store": "field",
    }
    runs = computed([block])
    return study("random_walk")(Inputs("random_walk", ["L-C3"], runs=runs), **PARAMETERS)


def test_rows(result):
    walks = result.table[result.table["method"] == "random walk"]
    # Three numbers of walkers at the first dt, two within 150000 increments in 10 steps at the second; two times.
    assert len(walks) == 2 * (3 + 2)
    # The spread of one ensemble's error is a few per cent of it; four of its standard deviations.
    assert np.abs(walks["relative error"] / walks["expected"] - 1.0).max() < 0.4
    many = walks[walks["ensembles"] >= 10]
    assert np.abs(many["relative error"] / many["expected"] - 1.0).max() < 0.4 / np.sqrt(10.0)
    assert (walks["Kolmogorov-Smirnov p"] > 1e-3).all()


def test_findings(result):
    numbers = {finding.claim: finding.numbers for finding in result.findings}
    assert set(numbers) == {"L-C3.matches", "L-C3.visible", "L-C3.tails"}
    # The spread of one ensemble's error is a few per cent of it, and three numbers of walkers give the rate.
    assert numbers["L-C3.matches"]["rate"] == pytest.approx(-0.5, abs=0.05)
    # 50000 walkers are not within 1 %: the error that is measured can be too large.
    assert min(numbers["L-C3.matches"]["error"].values()) > 0.01
    few, *_, many = numbers["L-C3.visible"]["deviation"].values()
    # One ensemble of 1000 walkers, a few in each of the outer cells: its deviation varies itself.
    assert 0.4 < few / (many * np.sqrt(50.0)) < 2.5
    assert numbers["L-C3.tails"]["ratio"] > 10.0


def test_another_seed_and_the_absolute_deviation_are_other_readings(result):
    others = {finding.claim: finding.others for finding in result.findings}
    seed = "another seed, 1e+04 walkers"
    assert [*others["L-C3.matches"]] == [*others["L-C3.visible"]] == [seed]
    assert (
        others["L-C3.tails"][seed]["ratio"]
        > 1.0
        > others["L-C3.tails"]["the absolute deviation"]["ratio"]
    )


def test_figure(result):
    figure("random_walk")(result.series, result.table, PARAMETERS).draw_without_rendering()
