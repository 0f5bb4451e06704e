"""All runs in one data set."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from fracparticles.run.case import Case
from fracparticles.run.dataset import write
from fracparticles.run.solve import solve
from fracstudy.collect import collect

CASES = [
    Case(
        scheme=scheme, order=order, beta=0.5, truncation=5.0, spacing=0.25, integrator="exponential"
    )
    for scheme in ("DD", "KPSE")
    for order in (2, 4)
] + [Case(scheme="GPSE", beta=0.5, truncation=5.0, spacing=0.25, exterior="open")]


def test_runs_are_sliced_by_what_they_are(tmp_path):
    files = []
    for case in CASES:
        write(solve(case), tmp_path / case.path)
        files.append(str(tmp_path / case.path))
    collect(files, tmp_path / "runs.nc")
    with xr.open_dataset(tmp_path / "runs.nc") as data:
        runs = data.to_dataframe()
    assert len(runs) == 5
    (row,) = runs.query("scheme == 'KPSE' and order == 4 and beta == 0.5").to_dict("records")
    with xr.open_dataset(row["file"]) as run:
        assert run.u.size > 20
        assert row["relative_l1_error"] == run.relative_l1_error
        assert row["particle_spacing"] == run.particle_spacing
    # The far field is estimated where there is one.
    assert np.isfinite(runs.query("exterior == 'open'")["far_field_error"]).all()
    assert np.isnan(runs.query("exterior == 'truncated'")["far_field_error"]).all()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # the checker's own
def test_the_data_set_conforms(tmp_path):
    from compliance_checker.runner import CheckSuite, ComplianceChecker

    case = CASES[0]
    write(solve(case), tmp_path / case.path)
    collect([str(tmp_path / case.path)], tmp_path / "runs.nc")
    CheckSuite.load_all_available_checkers()
    report = tmp_path / "report.json"
    ComplianceChecker.run_checker(
        str(tmp_path / "runs.nc"), ["cf:1.11"], 0, "normal", output_filename=str(report), output_format="json"
    )  # fmt: skip
    verdict = json.loads(report.read_text())["cf:1.11"]
    assert not [
        m for c in verdict["high_priorities"] + verdict["medium_priorities"] for m in c["msgs"]
    ]
