"""The reference case on a coarse grid."""

from __future__ import annotations

import pandas as pd

from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_figure_2.figure import figure
from scenes.lucchesi.lucchesi_figure_2.study import study


def test_the_reference_case_judges_both_windows(computed):
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
        mass_beta=[0.5],
    )
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    assert verdicts["L-F2.peak"] is True, result.findings[0].evidence
    assert verdicts["L-F2.initial_decay"] is False
    assert verdicts["L-C1.odd_number"] is False
    assert verdicts["L-F2.DVM_window"] is False
    assert verdicts["L-C1.DVM_domain"] is False
    assert set(result.series["panel"]) == {0, 1}
    assert isinstance(result.table, pd.DataFrame)
    assert len(figure(result.series, result.table).axes) == 3
