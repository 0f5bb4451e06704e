"""Probes of long and short times: nothing silent, nothing failed; what has no time or no lattice is refused."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest
from scipy.integrate import quad

from scenes.extremes.long_and_short_times.profile import profile, rate, tail_constant

PARAMETERS = {
    "betas": [0.5],
    "times": [1e-75, 1e12],
    "ratios": [1e3, 1e6],
    "shares": [1e-9],
    "dims": [1, 2],
}


def test_no_probe_is_bad(bad):
    assert bad == ""


def test_most_are_held_against_something_independent(table):
    assert (table["source"] != "").mean() > 0.5


def test_what_has_no_time_is_refused(table):
    assert (table[table["kind"] == "refused"]["verdict"] == "refused").all()


def test_what_is_kept_over_a_long_time_is_spoken_of(table):
    kept = table[table["expected"] == "spoken of: u_0 kept"]
    assert list(kept["verdict"]) == ["warned"]


def test_the_profile_is_the_fourier_integral():
    r = np.array([0.0, 0.7, 3.0])
    for at, value in zip(r, profile(r, 1.5, 1), strict=True):
        exact = quad(lambda k, at=at: np.cos(k * at) * np.exp(-(k**1.5)) / np.pi, 0.0, 12.0)[0]
        assert value == pytest.approx(exact, abs=1e-10)
    # dG/dt = -(G + r G') / alpha at t = 1, G' by differences.
    slope = (profile(r + 1e-5, 1.5, 1) - profile(np.abs(r - 1e-5), 1.5, 1)) / 2e-5
    assert rate(r, 1.5, 1) == pytest.approx(-(profile(r, 1.5, 1) + r * slope) / 1.5, abs=1e-8)
    far = np.array([1e6])
    assert profile(far, 1.5, 2) == pytest.approx(tail_constant(1.5, 2) * far**-3.5, rel=1e-8)


def test_the_figure_draws_each_time(drawn):
    assert len(drawn.axes) == 2
    assert len(drawn.axes[1].get_lines()) == len(PARAMETERS["ratios"])
    plt.close("all")
