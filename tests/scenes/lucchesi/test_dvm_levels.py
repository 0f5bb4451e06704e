"""What DVM adds to Table 2 and Fig. 2: its levels, and the truncation of its lattice."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracparticles.errors import FracparticlesError
from fracstudy.inputs import Inputs
from scene_functions import study
from scenes.lucchesi.lucchesi_figure_2.dvm_domain import truncation_effect


def test_truncation_acts_on_dvm_as_on_dd(computed):
    common = {"beta": 0.5, "spacing": 0.1995350, "dt": 0.01, "store": "profile"}
    paths = computed(
        [
            {**common, "scheme": ["DD", "KPSE"], "truncation": 5.0},
            # A run that another scene needs in full.
            {**common, "scheme": ["DD", "KPSE"], "truncation": 20.0, "store": "field"},
            {**common, "scheme": "DVM", "truncation": [5.0, 20.0], "remeshing": "none"},
        ],
    )
    effect = truncation_effect(Inputs("t", runs=paths).scalars)
    assert list(effect.columns) == [5.0]
    assert set(effect.index) == {"DD", "KPSE", "DVM, none"}
    # DD and DVM miss the tail itself, KPSE its exchange: an order of magnitude apart.
    assert effect.loc["KPSE", 5.0] > 10.0 * effect.loc[["DD", "DVM, none"], 5.0].max()


def test_table_2_of_dvm_needs_its_three_levels(computed):
    h = [0.3990701, 0.1995350, 0.09976752]
    runs = computed([
            {"scheme": "DVM", "beta": 0.5, "truncation": 5.0, "spacing": h, "dt": 5e-3, "remeshing": "M4'"},
            {"scheme": "DVM", "beta": 0.5, "truncation": 5.0, "spacing": h[:2], "dt": 5e-3, "remeshing": "Lambda3"},
        ],
    )  # fmt: skip
    parameters = {"judged_remeshing": "M4'", "printed_spacing": {0.5: 0.2}}
    printed = {"L-T2.DVM.II.beta0.5": "2.00"}
    result = study("lucchesi_table_2")(Inputs("t", ["L-T2"], runs, printed=printed), **parameters)
    ours = result.table.set_index("scheme")["ours"]
    # Epsilon = 2 h = 0.4 on the middle level: the next term of the smoothing error is of relative size 0.4^2.
    assert ours["DVM, M4'"] == pytest.approx(2.0, abs=0.16)
    assert np.isnan(ours["DVM, Lambda3"])
    findings = {finding.claim: finding for finding in result.findings}
    assert set(findings) == {"L-T2.DVM.II.beta0.5", "L-T2.expected", "L-T2.DVM.rate"}
    assert findings["L-T2.DVM.II.beta0.5"].numbers["nearest"] == "middle level and M4'"
    assert findings["L-T2.expected"].numbers["away"]["DVM, II, beta = 0.5"] < 0.16
    assert findings["L-T2.expected"].others["the printed orders"]["away"] == {
        "DVM, II, beta = 0.5": 0.0
    }
    rate = findings["L-T2.DVM.rate"]
    assert rate.numbers["away"]["M4', beta = 0.5"] < 0.16
    # Lambda3 leaves a spike at x = 0 in the strengths.
    assert rate.numbers["away"]["Lambda3, beta = 0.5"] > 0.5


def test_lattices_that_do_not_match_are_refused():
    runs = pd.DataFrame({"particle_spacing": [0.1, 0.1001]})
    with pytest.raises(FracparticlesError, match="multiples"):
        truncation_effect(runs)
