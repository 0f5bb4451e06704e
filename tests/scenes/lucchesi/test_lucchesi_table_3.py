"""Table 3: what the study says of the matrix, on small lattices."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from fracparticles.lattice.dense import spectrum
from fracparticles.schemes.stability import stability_limit
from fracstudy.claims import Value
from fracstudy.inputs import Inputs
from fracstudy.printed import read_claims
from scenes.lucchesi.lucchesi_table_3.figure import figure
from scenes.lucchesi.lucchesi_table_3.study import _matrix, study

BETAS = [0.1, 0.5, 0.9]
PRINTED = Path(__file__).parents[3] / "report/printed/lucchesi/lucchesi_table_3.yaml"


@pytest.fixture(scope="module")
def result():
    printed = {"L-T3.DD.beta0.1": "4.81", "L-T3.KPSE.beta0.9": "2.04"}
    return study(
        Inputs("table", ["L-T3", "L-C12", "L-C13"], printed=printed),
        beta=BETAS,
        truncation=10.0,
        spacing=[0.4, 0.4, 0.4],
        tolerance=1.0e-3,
        dense=[41, 61],
    )


def test_findings(result):
    found = {finding.claim: finding.numbers for finding in result.findings}
    assert found["L-T3.DD.beta0.1"]["ours"] == pytest.approx(4.8161, abs=5e-5)
    assert found["L-C12.symmetric.DD"]["asymmetry"] < 1e-12
    assert found["L-C12.symmetric.FPSE"]["asymmetry"] > 0.1
    step = found["L-C12.polynomial"]["asymmetry"]
    assert max(step["DD"], step["KPSE"]) < 1e-12 < 0.01 < step["FPSE"]
    # In closed form the limit of FPSE is 2^(alpha/2) times that of DD.
    ratio = [*found["L-T3.ordering"]["fpse_over_dd"].values()]
    np.testing.assert_allclose(ratio, 2.0 ** (0.5 * (1.0 + np.array(BETAS))), rtol=1e-4)
    assert found["L-T3.several_times"]["ratio"]["DD"] == pytest.approx(min(ratio))
    assert max(found["L-C12.nonpositive"]["highest"].values()) < 1e-12
    # (1 + 2 / 100)^1024, and none below the limit.
    assert min(found["L-C12.constraint"]["above"].values()) > 1e6
    assert abs(found["L-C12.criterion.DD"]["growth"]) < 0.01


def test_the_step_itself_is_another_reading_of_the_constraint(result):
    (weak,) = (f for f in result.findings if f.claim == "L-T3.conclusion_weak")
    (step,) = weak.others.values()
    # h^alpha at h = 0.4 changes 0.4^-0.8 = 2.1 times over beta, a of DD by an eighth.
    assert weak.numbers["spread"]["DD"] == pytest.approx(0.127, abs=1e-3)
    assert step["spread"]["DD"] == pytest.approx(0.4**-0.8 / 1.127 - 1.0, abs=0.02)


def test_power_iteration_comes_from_above(result):
    """A Rayleigh quotient lies inside the range of eigenvalues: |lambda| too small, a too large."""
    table = result.table.dropna(subset=["power iteration"])
    symmetric = table[table["scheme"] != "FPSE"]
    assert (symmetric["power iteration"] >= symmetric["symbol"]).all()
    assert np.allclose(table["closed form"], table["symbol"], rtol=1e-4)


def test_figure_renders(result):
    drawn = figure(result.series, beta=BETAS)
    assert isinstance(drawn, Figure)
    assert len(drawn.axes) == 2
    drawn.draw_without_rendering()


def test_what_is_said_to_be_truncated_is():
    """The reason of a value that is printed truncated: it is the limit, cut off after the printed digits."""
    claims = [c for c in read_claims(PRINTED) if c.id.startswith("L-T3.") and isinstance(c, Value)]
    for claim in claims:
        _, scheme, beta = claim.id.split(".", 2)
        limit = f"{stability_limit(scheme, float(beta.removeprefix('beta'))):.6f}"
        assert limit.startswith(claim.printed) or "truncated" not in claim.reason
    assert len([c for c in claims if c.reason]) == 3


def test_asymmetry_of_fpse_falls_like_a_boundary_effect():
    """A fixed number of rows out of N: |A - A^T| / |A| ~ N^(-1/2), a factor of 2 from N to 4 N."""
    small, large = (spectrum(_matrix("FPSE", 1.5, 2, size)).asymmetry for size in (61, 241))
    assert small / large == pytest.approx(2.0, rel=0.02)
