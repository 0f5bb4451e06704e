"""Table 3: what the study says of the matrix, on small lattices."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

from fracparticles.lattice.dense import spectrum
from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_table_3.figure import figure
from scenes.lucchesi.lucchesi_table_3.study import _matrix, study, truncated_print

BETAS = [0.1, 0.5, 0.9]


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
    found = {finding.claim: finding for finding in result.findings}
    assert found["L-T3.DD.beta0.1"].ours == pytest.approx(4.8161, abs=5e-5)
    assert "truncated, not rounded" in found["L-T3.DD.beta0.1"].reason
    assert not found["L-T3.KPSE.beta0.9"].reason
    assert found["L-C12.symmetric.DD"].verdict
    assert not found["L-C12.symmetric.FPSE"].verdict
    assert found["L-C12.criterion.FPSE"].verdict
    assert not found["L-T3.several_times"].verdict


def test_power_iteration_comes_from_above(result):
    """A Rayleigh quotient lies inside the range of eigenvalues: |lambda| too small, a too large."""
    table = result.table.dropna(subset=["power iteration"])
    symmetric = table[table["scheme"] != "FPSE"]
    assert (symmetric["power iteration"] >= symmetric["symbol"]).all()
    assert np.allclose(table["closed form"], table["symbol"], rtol=1e-4)


def test_figure_renders(result):
    drawn = figure(result.series, result.table, beta=BETAS)
    assert isinstance(drawn, Figure)
    assert len(drawn.axes) == 2
    drawn.draw_without_rendering()


@pytest.mark.parametrize(
    ("printed", "ours", "truncated"),
    [
        ("4.81", 4.8161, True),
        ("2.17", 2.1762, True),
        ("5.25", 5.2536, False),  # truncated and rounded alike
        ("5.43", 5.4297, False),  # rounded
    ],
)
def test_truncated_print(printed, ours, truncated):
    assert truncated_print(printed, ours) == truncated


def test_asymmetry_of_fpse_falls_like_a_boundary_effect():
    """A fixed number of rows out of N: |A - A^T| / |A| ~ N^(-1/2), a factor of 2 from N to 4 N."""
    small, large = (spectrum(_matrix("FPSE", 1.5, 2, size)).asymmetry for size in (61, 241))
    assert small / large == pytest.approx(2.0, rel=0.02)
