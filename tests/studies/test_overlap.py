"""The study of the smoothing length on a tiny grid."""

from __future__ import annotations

import pytest

from fracparticles.run.dataset import write
from fracparticles.run.solver import solve
from fracstudy.inputs import Inputs
from fracstudy.scene import expand
from scene_functions import figure, study


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("overlap")
    common = {"beta": 0.5, "spacing": 0.05, "overlap": [1.0, 2.0, 4.0], "store": "metrics"}
    common |= {"truncation": 10.0, "exterior": ["open", "truncated"]}
    blocks = [
        {"scheme": ["DD", "FPSE", "KPSE"], "order": [2, 4], "dt": 1e-3, **common},
        {"scheme": "GPSE", **common},
    ]
    paths = []
    for case in expand(blocks):
        paths.append(str(folder / case.path))
        write(solve(case), paths[-1])
    return Inputs("overlap", ["L-C9"], {"beta": 0.5, "claimed_from": 1.0}, paths)


def test_the_smoothing_error_has_the_power_of_its_order(inputs):
    table = study("overlap")(inputs).table
    opened = table[(table["exterior"] == "open") & (table["scheme"] != "GPSE")]
    # The next term of the smoothing error is (epsilon k)^2 smaller, epsilon <= 0.2.
    for row in opened.itertuples():
        assert row[-1] == pytest.approx({"II": 2.0, "IV": 4.0}[row.order], abs=0.25)


def test_gpse_keeps_the_overlap_asked_for(inputs):
    table = study("overlap")(inputs).table
    gpse = table[table["scheme"] == "GPSE"]
    assert gpse.filter(like="error, ε").notna().all(axis=None)


def test_every_claim_has_a_verdict_and_the_figure_is_drawn(inputs):
    result = study("overlap")(inputs)
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    # On a short lattice truncation hides the smoothing error of KPSE, not those of DD and FPSE.
    assert verdicts["L-C9.DD"] is False
    assert verdicts["L-C9.FPSE"] is False
    assert "L-C9.KPSE" in verdicts
    assert all(finding.reason for finding in result.findings if not finding.verdict)
    assert len(figure("overlap")(result.series, result.table, inputs.parameters).axes) == 2
