"""Rounding: nothing silent, nothing failed; what is no real number is refused; other threads, the same bits."""

from __future__ import annotations

import numpy as np
import pytest

import fracparticles as fp

PARAMETERS = {"steps": 1000, "particles": 101, "threads": [], "workflow": False}


def test_no_probe_is_bad(bad):
    assert bad == ""


def test_what_is_no_real_number_is_refused(table):
    refused = table[table["verdict"] == "refused"]["case"].tolist()
    assert {f"strengths of {kind}" for kind in ("complex", "bool", "text", "object")} <= set(
        refused
    )


@pytest.mark.parametrize("name", ["green", "green_flux", "green_rate"])
def test_single_precision_is_widened(name):
    x, t, alpha = np.linspace(-3.0, 3.0, 7, dtype=np.float32), np.float32(0.7), np.float32(1.3)
    function = getattr(fp, name)
    assert np.array_equal(function(x, t, alpha), function(x.astype(float), float(t), float(alpha)))


def test_the_figure_is_drawn(drawn):
    assert len(drawn.axes[0].lines) == 6
