"""The studies of the spacing on a tiny grid."""

from __future__ import annotations

import numpy as np

from fracparticles.run.case import Case
from fracstudy.inputs import Inputs
from scenes.lucchesi.spacing.figure import figure
from scenes.lucchesi.spacing.study import study
from scenes.lucchesi.spatial_claims.study import study as study_of_claims


def test_the_orders_of_the_kernels_are_found(computed):
    half = Case(scheme="DD", beta=0.5, truncation=20.0, spacing=0.1, dt=1e-3).reach
    h = [half / n for n in (128, 256, 512)]
    block = {"order": [2, 4], "beta": 0.5, "truncation": 20.0, "spacing": h, "store": "metrics"}
    both = {"exterior": ["truncated", "open"]}
    blocks = [
        {**block, "scheme": ["DD", "FPSE", "KPSE"], "dt": 1e-3, **both},
        {**block, "scheme": "KPSE", "integrator": "exponential"},
    ]
    result = study(Inputs("lucchesi_figure_4b", ["L-F4b"], runs=computed(blocks)))
    table = result.table
    assert len(table) == 3 * 2 * 3
    finest = table.groupby(["scheme", "order"])["observed order, open"].last().unstack()
    # The next term of the error is of relative size (k epsilon)^2: 6 % at k ~ 1 and epsilon = 2 h = 0.17.
    np.testing.assert_allclose(finest["II"], 2.0, atol=0.1)
    np.testing.assert_allclose(finest["IV"], 4.0, atol=0.2)
    tables = {f"t{beta:g}": table.assign(beta=beta) for beta in (0.1, 0.5, 0.9)}
    claims = study_of_claims(Inputs("spatial_claims", ["L-C7", "L-C8"], tables=tables))
    verdicts = {finding.claim: finding.verdict for finding in claims.findings}
    assert verdicts["L-C8.cause"] is False
    assert figure(result.series, table).axes
