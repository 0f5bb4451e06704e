"""The accuracy of the fundamental solution, and the values that it is measured by."""

from __future__ import annotations

import csv
import random
from pathlib import Path

import mpmath as mp
import pandas as pd

from fracstudy.inputs import Inputs
from scenes.beyond.fundamental_solution.figure import figure
from scenes.beyond.fundamental_solution.study import study

REFERENCE = Path(__file__).parents[3] / "report/reference/stable_density.csv"


def test_fundamental_solution(tmp_path):
    reference = pd.read_csv(REFERENCE)
    few = reference[reference["alpha"].isin([1.5])].iloc[::6]
    path = tmp_path / "few.csv"
    few.to_csv(path, index=False)
    result = study(Inputs("f"), reference=str(path))
    row = result.table.iloc[0]
    assert row["ours, error below"] <= 1e-13
    assert row["scipy, largest error"] > row["ours, error below"]
    figure(result.series, shown=[1.5]).draw_without_rendering()


def _by_series(x: float, alpha: float) -> mp.mpf:
    """(A.1) near 0, (A.2) far away: not the integral that made the file."""
    with mp.workdps(60):
        x, alpha, total = mp.mpf(x), mp.mpf(alpha), mp.mpf(0)
        for m in range(1, 400):
            if x < 2:
                size = mp.gamma(1 + m / alpha) / mp.factorial(m) * x ** (m - 1)
                term = size * mp.sin(mp.pi * m / 2)
            else:
                size = mp.gamma(1 + alpha * m) / mp.factorial(m) * x ** (-alpha * m - 1)
                term = size * mp.sin(mp.pi * alpha * m / 2) * (-1) ** (m + 1)
            total += term / mp.pi
            if size < mp.mpf(10) ** -28 * abs(total):
                return total
        raise AssertionError(f"no convergence at x = {x}, alpha = {alpha}")


def test_reference_values_are_right():
    """A random choice of the points that a series reaches; the file holds 25 digits."""
    with REFERENCE.open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if not 0.6 < float(row["x"]) < 90.0]
    for row in random.Random(3).sample(rows, 40):
        exact = _by_series(float(row["x"]), float(row["alpha"]))
        with mp.workdps(40):
            assert abs(mp.mpf(row["density"]) / exact - 1) < mp.mpf(10) ** -23, row
