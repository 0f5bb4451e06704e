"""The study of the total strength: the bound of its round-off, and tiny runs."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.schemes import Setting
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.inputs import Inputs
from scenes.lucchesi.conservation.figure import figure
from scenes.lucchesi.conservation.study import study, weight_sum


@pytest.mark.parametrize("scheme", ["DD", "DPSE", "FPSE", "KPSE", "GPSE", "FD"])
def test_the_sum_of_absolute_weights_bounds_the_rows(scheme):
    n, h, alpha = 20, 0.2, 1.5
    matrix = scheme_matrix(scheme, Setting(n=n, spacing=h, alpha=alpha))
    rows = np.abs(matrix).sum(axis=1).max()
    assert rows <= weight_sum(scheme, n, h, alpha, 2, 2.0) * (1.0 + 1e-12)


@pytest.fixture(scope="module")
def result(computed):
    fixed = {"beta": 0.5, "half_width": 20.0, "spacing": 0.1, "t_final": [0.75, 1.5]}
    fixed |= {"store": "metrics"}
    moving = {"scheme": "DVM", "beta": 0.5, "half_width": 10.0, "spacing": 0.2, "dt": 0.01}
    moving |= {"store": "metrics"}
    blocks = [
        {"scheme": ["DD", "DPSE", "FPSE", "KPSE", "FD"], "dt": 1e-3, **fixed},
        {"scheme": ["DD", "FPSE", "KPSE"], "dt": 1e-3, "exterior": "open", **fixed},
        {"scheme": "GPSE", **fixed},
        {**moving, "t_final": [0.75, 1.5], "remeshing": ["none", "M4'"]},
        {**moving, "remeshing": "M4'", "threshold": 1e-3},
    ]
    return study(Inputs("conservation", ["L-C18"], runs=computed(blocks)), shown_beta=0.5)


def test_exchange_keeps_the_strength_and_dd_loses_what_flows_out(result):
    found = {finding.claim: finding.numbers for finding in result.findings}
    for scheme in ("DPSE", "FPSE", "KPSE", "GPSE", "DVM"):
        assert found[f"L-C18.{scheme}"]["share"]["beta = 0.5"] < 1.0
    assert found["L-C18.DD"]["share"]["beta = 0.5"] > 1000.0
    assert found["L-C18.DD"]["outflow"]["beta = 0.5"] == pytest.approx(1.0, rel=0.1)
    # All that is missing after remeshing is what it put beyond the lattice.
    assert found["L-C18.DVM_remeshed"]["rest"] < 1.0
    moments = next(f for f in result.findings if f.claim == "L-C18.DVM_moments")
    assert moments.numbers["kept"] == {"M4'": 3, "Lambda3": 4}
    table = result.table.set_index(["scheme", "exterior"])
    leak = -table.loc[("DD", "truncated"), "M(t_f) / M(t_0) - 1"]
    assert leak == pytest.approx(table.loc[("DD", "truncated"), "exact outflow / M(t_0)"], rel=0.1)


def test_dvm_loses_what_remeshing_puts_beyond_the_lattice_or_leaves_out(result):
    table = result.table
    moving = table[table["scheme"] == "DVM"].set_index("exterior")
    change = moving["M(t_f) / M(t_0) - 1"]
    assert abs(change["remeshing none"]) < 1e-14
    gone = moving["put beyond ±D by remeshing / M(t_0)"] + moving["left out as too weak / M(t_0)"]
    np.testing.assert_allclose(change, -gone, atol=1e-12)
    assert moving.loc["remeshing M4', threshold", "left out as too weak / M(t_0)"] > 1e-4
    assert moving.loc["remeshing M4'", "left out as too weak / M(t_0)"] == 0.0


def test_with_the_open_exterior_the_strength_leaves_as_in_the_exact_solution(result):
    table = result.table
    opened = table[table["exterior"] == "open"]
    # The continuation of the far field leaves a relative error of about (t / D^alpha)^2 = 3e-4 of the outflow.
    missed = opened["change + exact outflow"].abs() / opened["exact outflow / M(t_0)"]
    assert (missed < 1e-2).all()


def test_the_figure_is_drawn(result):
    assert figure(result.series).axes


def test_the_particles_of_dvm_spread_as_the_solution(result):
    """The velocity is x / (alpha t), so that all spacings grow like t^(1/alpha) but for the ends."""
    found = {finding.claim: finding.numbers for finding in result.findings}
    assert found["L-C18.DVM_distortion"]["stretch"]["beta = 0.5"] > 3.0 ** (1.0 / 1.5)
    assert found["L-C18.DVM_overlap"]["overlap"]["beta = 0.5"] < 1.0
