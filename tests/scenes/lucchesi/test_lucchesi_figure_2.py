"""The reference case on a coarse grid."""

from __future__ import annotations

import pandas as pd
import pytest

from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_figure_2.figure import figure
from scenes.lucchesi.lucchesi_figure_2.study import study


def test_the_reference_case_is_measured_in_both_windows(computed):
    common = {"beta": 0.5, "truncation": 20.0, "spacing": 0.03, "store": "field"}
    both = {"exterior": ["truncated", "open"]}
    moving = {**common, "scheme": "DVM", "dt": 5e-3, "remeshing": ["M4'", "none"]}
    coarse = {"truncation": [5.0, 10.0, 20.0], "spacing": 0.1995350}
    blocks = [
        {**common, "scheme": ["DD", "FPSE", "KPSE"], "dt": 1e-3, **both},
        {**common, "scheme": "GPSE", "dt": 0.05, **both},
        {**common, "scheme": "FD", "dt": 1e-3},
        {**moving, "truncation": 10.0},
        {**moving, **coarse},
        {**common, "scheme": ["DD", "KPSE"], "dt": 1e-2, **coarse},
    ]
    result = study(
        Inputs("f2", ["L-F2", "L-C1", "L-C2"], runs=computed(blocks)),
        windows=[[0.0, 5.0], [40.0, 45.0]],
        shown_spacing=0.03,
        printed_particles=64000,
        mass_beta=[0.1, 0.5, 0.9],
    )
    numbers = {finding.claim: finding.numbers for finding in result.findings}
    # A smoothing length of 0.06: its square, times half the curvature at the peak, is 1e-3.
    assert max(numbers["L-F2.peak"]["error"].values()) < 0.01
    # The next term of (A.2) is of relative size (D/2)^-alpha, 1e-2.
    assert numbers["L-F2.initial_decay"]["exponent"] == pytest.approx(-2.5, abs=0.02)
    assert numbers["L-F2.initial_shape"]["step"] < 0.0
    assert numbers["L-F2.DVM_window"]["reach"]["x in [40, 45]"] < 1.0
    # DD and remeshed DVM stay on the initial lattice: the truncation changes DD no more than DVM.
    assert numbers["L-C1.DVM_domain"]["ratio"]["remeshed"] < 1.1
    assert numbers["L-C1.DVM_stretching"]["stretch"]["remeshed"] < 0.6
    assert numbers["L-C1.redistribution_domain"]["ratio"] > 2.0
    # The open exterior is what a truncated boundary lacks; KPSE feels it everywhere, DD at the boundary.
    changed = numbers["L-C2.truncation_at_edge"]["ratio"]
    assert changed["DD"] > 10.0 * changed["KPSE"] > 10.0
    assert max(numbers["L-C2.not_instability"]["step"].values()) < 1.0
    # An even number of particles is printed.
    particles = numbers["L-C1.particles"]
    assert (particles["printed"], particles["ours"]) == (0, 1)
    # 1 - P(|X| <= 5 R_alpha) by the law at t = 1.5: of the printed 97 % only that at beta = 0.5 rounds to it.
    mass = [numbers[f"L-C1.mass.beta{beta}"]["mass"] for beta in (0.1, 0.5, 0.9)]
    assert [round(share) for share in mass] == [98, 97, 99]
    assert set(numbers["L-C2.fd_comparable"]["ratio"]) == {"DD", "FPSE", "KPSE", "GPSE"}
    assert set(result.series["panel"]) == {0, 1}
    assert isinstance(result.table, pd.DataFrame)
    assert len(figure(result.series).axes) == 3
