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
    assert figure.figure(truncated.series).axes


def test_the_truncation_is_a_share_of_the_error(truncated):
    numbers = {finding.claim: finding.numbers for finding in truncated.findings}
    share = numbers["L-F4a.negligible"]["share"]
    assert all(0.0 <= part <= 1.1 for part in share.values())
    # A step of GPSE is exact but for it, and at order II the smoothing error of DD is far larger.
    assert share["GPSE, II"] == pytest.approx(1.0, abs=1e-6)
    assert share["DD, II"] < 0.01
    assert numbers["L-F4a.gpse_dt"]["ours"] == pytest.approx((2 * 0.08) ** 1.5)


def test_the_claims_read_the_tables(truncated):
    """The errors of one beta stand for the three: what compares beta with beta finds them equal."""
    tables = {f"t{beta:g}": truncated.table.assign(beta=beta) for beta in (0.1, 0.5, 0.9)}
    items = ["L-C4", "L-C5", "L-C6"]
    result = study_of_claims.study(Inputs("truncation_claims", items, tables=tables))
    numbers = {finding.claim: finding.numbers for finding in result.findings}
    assert len(numbers) == 17
    for claim in ("L-C4.grows", "L-C5.sensitive", "L-C6.small_domains", "L-C6.higher_for_low_beta"):
        np.testing.assert_allclose([*numbers[claim]["ratio"].values()], 1.0)
    # The closed form is that of beta = 0.5, and 5 % exact from C = 10 on.
    assert numbers["L-C5.origin"]["tail"]["GPSE"] < 0.05
    assert numbers["L-C5.power.GPSE"]["away"]["II, beta = 0.5"] < 0.05
    # KPSE IV and GPSE have the same truncation error but for the spatial error at this h.
    assert numbers["L-C6.different_mechanism"]["difference"] < 0.3
    # From C = 20 to C = 40 a power of 3/2 is left.
    change = numbers["L-C6.levels_off"]["change"]["beta = 0.5"]
    assert change == pytest.approx(2.0**1.5 - 1.0, rel=0.05)
    assert numbers["L-C4.independent.DD"]["variation"]["II, beta = 0.5"] < 0.01
    assert len(figure_of_claims.figure(result.series).axes) == 3


def test_another_scene_takes_other_beta_schemes_and_orders(computed):
    """Without an item there is nothing to judge, and without GPSE the guide stands elsewhere."""
    grid = {**COMMON, "beta": 0.7, "spacing": 0.2, "truncation": [5.0, 10.0]}
    blocks = [{**grid, "scheme": ["DD", "FPSE"], "order": [4, 6], "dt": 5e-3}]
    result = study.study(Inputs("mine", runs=computed(blocks)))
    assert list(result.table["order"].unique()) == ["IV", "VI"]
    assert (result.table["beta"] == 0.7).all()
    assert not result.findings
    assert figure.figure(result.series).axes


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
