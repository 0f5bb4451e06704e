"""The three rejected variants: the mathematics of their studies, and tiny runs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from fracparticles.kernels.families import kernel
from fracparticles.schemes import riesz
from fracparticles.special.stable import green, green_flux
from fracstudy.inputs import Inputs
from scenes.lucchesi.rejected_29.figure import figure as draw_29
from scenes.lucchesi.rejected_29.study import study as scheme_29
from scenes.lucchesi.rejected_dpse.figure import figure as draw_dpse
from scenes.lucchesi.rejected_dpse.study import study as dpse
from scenes.lucchesi.rejected_riesz.figure import figure as draw_riesz
from scenes.lucchesi.rejected_riesz.study import study as cut_off


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_the_exact_flux_carries_the_mass_that_leaves(alpha):
    # int_a^b u dx falls at the rate Q(b) - Q(a); central difference in time, error dt^2 / 6.
    a, b, t, dt = 0.3, 2.0, 0.8, 1e-4
    mass = [
        quad(lambda x, s=s: green(x, s, alpha), a, b, epsabs=1e-14)[0] for s in (t - dt, t + dt)
    ]
    flux = green_flux(np.array([a, b]), t, alpha)
    assert (mass[1] - mass[0]) / (2.0 * dt) == pytest.approx(flux[0] - flux[1], rel=1e-6)


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_the_tail_of_kappa_is_that_of_the_cut_off_potential(alpha):
    # kappa ~ c |r|^(1-alpha) of the regularised potential: what predicts the slope of v at the ends.
    r = 1e4
    expected = riesz.potential_constant(alpha) * r ** (1.0 - alpha)
    assert kernel("kappa", r, alpha) == pytest.approx(expected, rel=1e-7)


def test_dpse(computed):
    blocks = [
        {"scheme": ["DPSE", "FPSE", "KPSE", "DD"], "beta": 0.5, "truncation": 10.0, "spacing": 0.1,
         "dt": 1e-3, "store": "field"},
    ]  # fmt: skip
    result = dpse(Inputs("rejected_dpse", ["L-C14"], runs=computed(blocks)))
    found = {f.claim: f.numbers for f in result.findings}
    case = "beta = 0.5, C = 10"
    assert found["L-C14.edges"]["error"][case] > 10.0 > found["L-C14.edges"]["kpse"][case]
    assert found["L-C14.cause"]["difference"][case] < 0.2
    # FPSE has the same layer.
    assert found["L-C14.mitigation"]["ratio"][case] == pytest.approx(1.0, rel=0.5)
    assert found["L-C14.remedy"]["gain"][case] > 10.0
    row = result.table.set_index("scheme").loc["DPSE"]
    assert row["u / exact at |x| = D"] > 10.0
    assert abs(row["with v continued"]) < 0.1 * row["error of du/dt at D"]
    assert draw_dpse(result.series).axes


@pytest.mark.filterwarnings("ignore::fracparticles.errors.StabilityWarning")  # it grows
def test_scheme_29(computed):
    blocks = [
        {"scheme": ["PSE29", "DD"], "beta": 0.5, "truncation": 5.0, "spacing": [0.3575667, 0.03],
         "dt": 2e-3, "evaluation": "stepping", "store": "field"},
    ]  # fmt: skip
    history = {"half_width": 5.0, "spacing": [0.3575667, 0.1787833], "foldings": 40}
    inputs = Inputs("rejected_29", ["L-C15"], runs=computed(blocks))
    result = scheme_29(inputs, shown_beta=0.5, dense=61, history=history)
    found = {f.claim: f.numbers for f in result.findings}
    assert found["L-C15.kernel"]["origin"]["beta = 0.5"] < 0.0
    assert found["L-C15.kernel"]["turns"]["beta = 0.5"] == 1
    assert found["L-C15.errors"]["ratio"]["beta = 0.5"] > 10.0
    assert found["L-C15.errors"]["coarse"]["beta = 0.5"] < 2.0
    instability = found["L-C15.instability"]
    assert instability["deviation"] < 0.01
    assert "no longer finite after step" in instability["message"]
    growing = result.table["greatest eigenvalue, λ h^α / D"]
    assert (growing > 0.09).all()
    assert len(draw_29(result.series, shown_beta=0.5).axes) == 3


def test_riesz(computed):
    blocks = [
        {"scheme": ["RIESZ", "KPSE"], "beta": [0.1, 0.9], "truncation": 10.0, "spacing": [0.4, 0.2],
         "dt": 2e-3, "store": "metrics"},
    ]  # fmt: skip
    sums = {"sum_half_width": 60.0, "sum_spacing": [0.08, 0.04, 0.02], "sum_overlap": 2.0}
    inputs = Inputs("rejected_riesz", ["L-C16"], runs=computed(blocks))
    result = cut_off(inputs, alpha=[1.3, 1.5, 1.9], time=1.0, **sums)
    flux = result.table[(result.table["of"] == "flux") & (result.table["h"] == 0.02)]
    # a epsilon^(2-alpha) + b epsilon^2: the second is epsilon^alpha = 0.015 of the first at most.
    np.testing.assert_allclose(flux["observed order, cut-off"], flux["2 - α"], atol=0.03)
    poor, worst = (f.numbers for f in result.findings)
    assert min(poor["ratio"].values()) > 10.0
    assert list(worst["rise"]) == ["alpha = 1.5", "alpha = 1.9"]
    assert min(worst["rise"].values()) > 1.0
    assert len(draw_riesz(result.series).axes) == 3
