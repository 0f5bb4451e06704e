"""The studies of the spacing on a tiny grid."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracparticles.run.case import Case
from fracstudy.inputs import Inputs
from scenes.lucchesi.spacing.figure import figure
from scenes.lucchesi.spacing.study import settled, study
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
    numbers = {finding.claim: finding.numbers for finding in result.findings}
    assert set(numbers["L-F4b.O_h2"]["observed"]) == {"DD", "FPSE", "KPSE"}
    # FPSE smooths twice: the error of order II is twice that of DD, of the next order less.
    assert numbers["L-F4b.fpse_largest"]["ratio"]["II"] == pytest.approx(2.0, abs=0.1)
    # At C = 20 truncation has stopped KPSE IV at these h.
    assert numbers["L-F4b.kpse_levels_off"]["change"]["IV"] < 0.01
    tables = {f"t{beta:g}": table.assign(beta=beta) for beta in (0.1, 0.5, 0.9)}
    claims = study_of_claims(
        Inputs("spatial_claims", ["L-C7", "L-C8"], tables=tables),
        short=5.0,
        spacing=h[1:],
        at_beta=0.5,
    )
    found = {finding.claim: finding.numbers for finding in claims.findings}
    assert {c.removeprefix("L-C7.") for c in found} == {
        "O_h2",
        "O_h4",
        "rate",
        "large_domain",
        "passes",
        "L-C8.cause",
    }
    # The error of a step of 1e-3 is below 1e-6, that of the truncated domain some 1e-3.
    assert max(found["L-C8.cause"]["share"].values()) < 0.01
    assert min(found["L-C7.large_domain"]["short"].values()) > 0.5
    assert max(found["L-C7.large_domain"]["large"].values()) < 0.2
    assert figure(result.series).axes


def test_the_settled_order_is_of_the_finest_levels_that_show_the_spatial_error():
    def part(truncated, opened):
        observed = {"truncated": [np.nan, 3.0, 3.5, 1.0], "open": [np.nan, 3.1, 3.6, 3.9]}
        columns = {f"observed order, {name}": orders for name, orders in observed.items()}
        columns |= {"error, truncated": truncated, "error, open exterior": opened}
        return pd.DataFrame({"h": [0.8, 0.4, 0.2, 0.1], **columns})

    # On the last level truncation is most of the error, with the open exterior it is below 1e-7.
    errors = part([1e-2, 1e-3, 1e-4, 5e-5], [1e-2, 1e-3, 1e-4, 1e-5])
    assert settled(errors, "truncated") == 3.5
    assert settled(errors, "open") == 3.9
    assert settled(part([1e-2, 1e-3, 1e-4, 5e-8], [1e-2, 1e-3, 1e-4, 5e-8]), "open") == 3.6
