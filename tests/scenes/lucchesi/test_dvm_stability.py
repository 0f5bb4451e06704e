"""Is DVM stable, is GPSE? The scene on tiny grids, and the mathematics behind it."""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from scene_functions import figure, study
from scenes.lucchesi.dvm_stability.study import gpse_factors

STABILITY = {
    "beta": 0.9,
    "truncation": 5.0,
    "spacing": 0.05,
    "factors": [0.3, 0.8, 3.0],
    "growth": [0.5, 1.2],
    "half": 200,
    "overlap": [0.5, 2.0, 8.0],
    "spacings": [0.2, 0.1, 0.05, 0.025],
    "ends": [{"beta": 0.1, "truncation": 5.0, "spacing": 0.2, "dt": 0.02, "remeshing": "M4'"}],
    "printed_spacing": {0.1: 1.21e-2, 0.5: 1.11e-2, 0.9: 1.47e-2},
    "printed_step": 5e-5,
}


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("overlap", [0.25, 1.0, 3.0, 20.0])
def test_gpse_amplifies_no_wave(alpha, overlap):
    factors = gpse_factors(alpha, overlap)
    assert factors.max() <= 1.0 + 1e-12
    assert factors.min() >= -1e-12


def test_gpse_is_stable_and_dvm_is_not():
    result = study("dvm_stability")(Inputs("s", ["L-C11"]), **STABILITY)
    findings = {finding.claim: finding for finding in result.findings}
    numbers = {claim: finding.numbers for claim, finding in findings.items()}
    assert numbers["L-C11.GPSE"]["excess"] < 1e-12
    assert numbers["L-C11.GPSE"]["lowest"] > -1e-12
    # A second-order error in time would grow a hundredfold; what is left is the exterior at C = 5.
    assert numbers["L-C11.GPSE_exact"]["change"] < 1.0
    # At three times the limit both are ruined, below it none.
    dvm = findings["L-C11.DVM"]
    assert set(dvm.numbers["ruined"].values()) == {1}
    assert set(dvm.others["no trace of the worst wave at the start"]["ruined"].values()) == {1}
    assert dvm.numbers["below"] == 0
    # 4.4 calls DVM stable: the paper's step is far below the limit, which is why it looked so.
    assert min(dvm.numbers["limit"].values()) > 30.0
    # A jump of the field gives a flux like epsilon^-beta.
    assert numbers["L-C11.DVM_bounded"]["power"] == pytest.approx(-0.9, abs=0.2)
    assert numbers["L-C11.DVM_invariant"]["remeshed"]["DVM, no remeshing"] == 0
    table = result.table
    assert set(table.loc[table["step / limit of DD"] < 1.0, "outcome"]) == {"fine"}
    above = table[table["step / limit of DD"] > 1.0].set_index("run")["outcome"]
    assert above["GPSE, open exterior"] == "fine"
    assert above["DVM, M4'"] != "fine"
    assert len(figure("dvm_stability")(result.series, result.table, STABILITY).axes) == 2


def test_the_velocity_diverges_at_the_weak_ends_only():
    def measured(**ends):
        given = {**STABILITY, "factors": [0.3, 1.1], "ends": [{**STABILITY["ends"][0], **ends}]}
        findings = study("dvm_stability")(Inputs("s", ["L-C11"]), **given).findings
        return {finding.claim: finding.numbers for finding in findings}

    found = measured()["L-C11.DVM_divergence"]
    assert found["stopped"] == 1
    assert 0.0 < found["excess"]["beta = 0.1"] < 0.5 < found["weak"]["beta = 0.1"] - 1.0
    # For a short time without remeshing nothing stops, and a lattice of C = 1 has no weak end.
    short = measured(truncation=1.0, remeshing="none", t_final=0.52)
    assert short["L-C11.DVM_divergence"]["stopped"] == 0
    assert short["L-C11.DVM_divergence"]["weak"]["beta = 0.1"] == 0.0
    assert short["L-C11.small_strengths"]["least"]["beta = 0.1"] > 1e-3
