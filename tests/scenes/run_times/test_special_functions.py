"""The times of the fundamental solution: structure and arithmetic, no run times."""

from __future__ import annotations

import numpy as np

from fracstudy.inputs import Inputs
from scene_functions import measured
from scenes.run_times.special_functions.benchmark import benchmark
from scenes.run_times.special_functions.study import study


def test_ours_and_scipy_s_are_timed_for_each_alpha():
    data = benchmark(alpha=[1.2, 1.5], points=100, points_of_scipy=2, repeats=2)
    assert data["alpha"].values.tolist() == [1.2, 1.5]
    for name in ("table_time", "point_time", "scipy_time"):
        assert (data[name] > 0.0).all(), name
    given = Inputs("s", benchmarks={"special_functions": measured(data)})
    table = study(given).table
    ratio = table["scipy / ns a point"] / table["ours / ns a point"]
    assert np.allclose(table["scipy / ours"], ratio)
    assert table["alpha"].tolist() == [1.2, 1.5]
