"""Is DVM stable, is GPSE? The scene on tiny grids, and the mathematics behind it."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.stability import stability_limit
from fracstudy.inputs import Inputs
from scene_functions import figure, study
from scenes.lucchesi.dvm_stability.study import displacement_growth, gpse_factors, worst_wave

STABILITY = {
    "beta": 0.9,
    "truncation": 5.0,
    "spacing": 0.05,
    "factors": [0.3, 0.8, 3.0],
    "growth": [0.5, 1.2],
    "half": 200,
    "overlap": [0.5, 2.0, 8.0],
    "spacings": [0.2, 0.1, 0.05, 0.025],
    "stop": {"beta": 0.1, "truncation": 5.0, "spacing": 0.2, "dt": 0.02, "remeshing": "M4'"},
}


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("factor", [0.5, 1.0, 1.3])
def test_a_displacement_wave_has_the_symbol_of_dd(order, factor):
    alpha, theta = 1.5, worst_wave(1.5, order)
    step = factor * stability_limit("DD", 0.5, order)
    z = step * float(SCHEMES["DD"].symbol(np.array([theta]), Setting(alpha=alpha, order=order))[0])
    measured = displacement_growth(alpha, order, step, theta, half=300)
    # The ends are felt in the middle like (k half)^-alpha; displacements are small to 1e-5.
    assert measured == pytest.approx(1.0 + z + 0.5 * z * z, abs=2e-3)
    assert z == pytest.approx(-2.0 * factor, rel=1e-5)


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("overlap", [0.25, 1.0, 3.0, 20.0])
def test_gpse_amplifies_no_wave(alpha, overlap):
    factors = gpse_factors(alpha, overlap)
    assert factors.max() <= 1.0 + 1e-12
    assert factors.min() >= -1e-12


def test_gpse_is_stable_and_dvm_is_not():
    result = study("dvm_stability")(Inputs("s", ["L-C11"]), **STABILITY)
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    assert verdicts == {
        "L-C11.GPSE": True,
        "L-C11.DVM": False,
        "L-C11.DVM_bounded": False,
        "L-C11.DVM_divergence": True,
    }
    table = result.table
    assert set(table.loc[table["step / limit of DD"] < 1.0, "outcome"]) == {"fine"}
    above = table[table["step / limit of DD"] > 1.0].set_index("run")["outcome"]
    assert above["GPSE, open exterior"] == "fine"
    assert above["DVM, M4'"] != "fine"
    assert len(figure("dvm_stability")(result.series, result.table, STABILITY).axes) == 2


def test_statements_on_stability_can_turn_out_otherwise():
    harmless = {**STABILITY, "factors": [0.3, 0.8]}
    harmless["stop"] = {**STABILITY["stop"], "dt": 1e-3, "t_final": 0.51}
    findings = study("dvm_stability")(Inputs("s", ["L-C11"]), **harmless).findings
    verdicts = {finding.claim: finding.verdict for finding in findings}
    assert verdicts["L-C11.DVM"] is True  # no run above the limit
    assert verdicts["L-C11.DVM_divergence"] is False  # nothing stops


def test_the_printed_step_of_dvm_is_that_of_the_paper():
    case = Case(scheme="DVM", beta=0.9, truncation=10.0, spacing=0.01473467, dt=5e-5)
    # 4.4 calls DVM stable: the printed step is far below the limit, which is why it looked so.
    assert case.time_step < 0.03 * case.largest_stable_step
