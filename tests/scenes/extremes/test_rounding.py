"""Rounding: nothing silent, nothing failed; what is no real number is refused; other threads, the same bits."""

from __future__ import annotations

import numpy as np
import pytest

import fracparticles as fp
from fracstudy.inputs import Inputs
from fracstudy.probe import BAD
from scene_functions import figure, study

PARAMETERS = {"steps": 1000, "particles": 101, "threads": [], "workflow": False}


@pytest.fixture(scope="module")
def result():
    return study("rounding")(Inputs("rounding"), **PARAMETERS)


def test_no_probe_is_bad(result):
    bad = result.table[result.table["verdict"].isin(BAD)]
    assert bad.empty, bad[["kind", "case", "found", "bound"]].to_string()


def test_what_is_no_real_number_is_refused(result):
    refused = result.table[result.table["verdict"] == "refused"]["case"].tolist()
    assert {f"strengths of {kind}" for kind in ("complex", "bool", "text", "object")} <= set(
        refused
    )


@pytest.mark.parametrize("name", ["green", "green_flux", "green_rate"])
def test_single_precision_is_widened(name):
    x, t, alpha = np.linspace(-3.0, 3.0, 7, dtype=np.float32), np.float32(0.7), np.float32(1.3)
    function = getattr(fp, name)
    assert np.array_equal(function(x, t, alpha), function(x.astype(float), float(t), float(alpha)))


def test_the_figure_is_drawn(result):
    drawn = figure("rounding")(result.series, result.table, PARAMETERS)
    assert len(drawn.axes[0].lines) == 6
