"""The studies of the truncation on tiny grids."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracstudy.config import read_config
from fracstudy.inputs import Inputs
from scenes.lucchesi.truncation import figure, study
from scenes.lucchesi.truncation_claims import figure as figure_of_claims
from scenes.lucchesi.truncation_claims import study as study_of_claims

SCENES = Path(__file__).parents[3] / "workflow/scenes"
COMMON = {"exterior": ["truncated", "open"], "truncation": [10.0, 20.0, 40.0], "store": "metrics"}
SCHEMES = {"scheme": ["DD", "FPSE", "KPSE"], "order": [2, 4], "dt": 2e-3}


@pytest.fixture(scope="module")
def truncated(computed):
    grid = {**COMMON, "beta": 0.5, "spacing": 0.08}
    blocks = [{**grid, **SCHEMES}, {**grid, "scheme": "GPSE", "dt": 0.0625}]
    return study.study(Inputs("lucchesi_figure_4a", ["L-F4a"], runs=computed(blocks)))


def test_every_scheme_order_and_width_is_tabulated(truncated):
    table = truncated.table
    assert len(table) == 7 * 3
    kpse = table[(table["scheme"] == "KPSE") & (table["order"] == "IV")]
    # The closed form is 5 % exact from C = 10 on, and the spatial error a hundredth of it at this h.
    np.testing.assert_allclose(
        kpse["error, truncated"], kpse["truncation error, predicted"], rtol=0.3
    )
    assert (kpse["error, open exterior"] < kpse["error, truncated"]).all()
    assert figure.figure(truncated.series, table).axes


def test_what_the_data_refute_is_refuted(truncated):
    verdicts = {finding.claim: finding.verdict for finding in truncated.findings}
    assert verdicts["L-F4a.negligible"] is False
    steps = [finding.ours for finding in truncated.findings if finding.claim == "L-F4a.gpse_dt"]
    assert steps == [pytest.approx((2 * 0.08) ** 1.5)]


def test_the_claims_read_the_tables(truncated):
    tables = {f"t{beta:g}": truncated.table.assign(beta=beta) for beta in (0.1, 0.5, 0.9)}
    items = ["L-C4", "L-C5", "L-C6"]
    result = study_of_claims.study(Inputs("truncation_claims", items, tables=tables))
    assert len({finding.claim for finding in result.findings}) == 15
    assert all(finding.evidence for finding in result.findings)
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    assert verdicts["L-C5.origin"] is True
    assert verdicts["L-C6.different_mechanism"] is False
    assert len(figure_of_claims.figure(result.series, result.table).axes) == 3


def test_another_scene_takes_other_beta_schemes_and_orders(computed):
    """Without an item there is nothing to judge, and without GPSE the guide stands elsewhere."""
    grid = {**COMMON, "beta": 0.7, "spacing": 0.2, "truncation": [5.0, 10.0]}
    blocks = [{**grid, "scheme": ["DD", "FPSE"], "order": [4, 6], "dt": 5e-3}]
    result = study.study(Inputs("mine", runs=computed(blocks)))
    assert list(result.table["order"].unique()) == ["IV", "VI"]
    assert (result.table["beta"] == 0.7).all()
    assert not result.findings
    assert figure.figure(result.series, result.table).axes


def test_a_scene_without_the_open_exterior_is_refused(tmp_path):
    scenes = tmp_path / "scenes"
    (scenes / "mine/one").mkdir(parents=True)
    (scenes / "lucchesi").symlink_to(SCENES / "lucchesi")
    (scenes / "mine/one/scene.yaml").write_text(
        "title: mine\nstudy: lucchesi/truncation\n"
        "runs:\n  - {scheme: DD, beta: 0.7, truncation: 5.0, spacing: 0.2, dt: 0.01}\n"
    )
    config = {"results_dir": "results", "report_dir": "report", "scenes_dir": str(scenes)}
    with pytest.raises(InvalidInput, match="exterior: open"):
        read_config({**config, "documents": {"mine": {"title": "mine"}}})
