"""The three rejected variants: the mathematics of their studies, and tiny runs."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from fracparticles.kernels.families import kernel
from fracparticles.run.dataset import write
from fracparticles.run.solver import solve
from fracparticles.schemes import riesz
from fracparticles.special.stable import green, green_flux
from fracstudy.inputs import Inputs
from fracstudy.scene import expand
from scene_functions import figure, study


def inputs(folder, scene, items, blocks, parameters):
    paths = []
    for case in expand(blocks):
        paths.append(str(folder / case.path))
        write(solve(case), paths[-1])
    return Inputs(scene, items, parameters, paths)


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


def test_dpse(tmp_path):
    blocks = [
        {"scheme": ["DPSE", "FPSE", "KPSE", "DD"], "beta": 0.5, "truncation": 10.0, "spacing": 0.1,
         "dt": 1e-3, "store": "field"},
    ]  # fmt: skip
    parameters = {"beta": 0.5, "truncation": 10.0}
    scene = inputs(tmp_path, "rejected_dpse", ["L-C14"], blocks, parameters)
    result = study("rejected_dpse")(scene)
    assert {f.claim: f.verdict for f in result.findings} == {
        "L-C14.edges": True,
        "L-C14.cause": True,
    }
    row = result.table.set_index("scheme").loc["DPSE"]
    assert row["u / exact at |x| = D"] > 10.0
    assert abs(row["the same, v continued"]) < 0.1 * row["error of du/dt at D"]
    assert figure("rejected_dpse")(result.series, result.table, parameters).axes


def test_scheme_29(tmp_path):
    blocks = [
        {"scheme": ["PSE29", "DD"], "beta": 0.5, "truncation": 5.0, "spacing": [0.3575667, 0.03],
         "dt": 2e-3, "evaluation": "stepping", "store": "field"},
    ]  # fmt: skip
    parameters = {
        "beta": 0.5,
        "dense": 61,
        "history": {"half_width": 5.0, "spacing": [0.3575667, 0.1787833], "foldings": 40},
    }
    scene = inputs(tmp_path, "rejected_29", ["L-C15"], blocks, parameters)
    result = study("rejected_29")(scene)
    verdicts = {f.claim: f.verdict for f in result.findings}
    assert verdicts == {"L-C15.kernel": True, "L-C15.errors": True, "L-C15.instability": True}
    growing = result.table["greatest eigenvalue, λ h^α / D"]
    assert (growing > 0.09).all()
    instability = next(f for f in result.findings if f.claim == "L-C15.instability")
    assert "no longer finite after step" in instability.evidence
    assert len(figure("rejected_29")(result.series, result.table, parameters).axes) == 3


def test_riesz(tmp_path):
    blocks = [
        {"scheme": ["RIESZ", "KPSE"], "beta": [0.1, 0.9], "truncation": 10.0, "spacing": [0.4, 0.2],
         "dt": 2e-3, "store": "metrics"},
    ]  # fmt: skip
    parameters = {
        "alpha": [1.3, 1.5, 1.9],
        "sum_half_width": 60.0,
        "sum_spacing": [0.08, 0.04, 0.02],
        "sum_overlap": 2.0,
        "time": 1.0,
    }
    scene = inputs(tmp_path, "rejected_riesz", ["L-C16"], blocks, parameters)
    result = study("rejected_riesz")(scene)
    flux = result.table[(result.table["of"] == "flux") & (result.table["h"] == 0.02)]
    # a epsilon^(2-alpha) + b epsilon^2: the second is epsilon^alpha = 0.015 of the first at most.
    np.testing.assert_allclose(flux["observed order, cut-off"], flux["2 - α"], atol=0.03)
    assert all(f.verdict for f in result.findings)
    assert len(figure("rejected_riesz")(result.series, result.table, parameters).axes) == 3
