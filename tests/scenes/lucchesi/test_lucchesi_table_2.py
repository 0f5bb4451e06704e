"""Table 2 on grids of someone else; for DVM see the test of its levels."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.run.case import Case
from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_table_2.study import study


@pytest.mark.parametrize("counts", [(64, 128, 256), (64, 100, 256)])
def test_without_a_print_the_middle_level_is_taken(computed, counts):
    """The levels that are not nested have no order (49)."""
    grid = {"scheme": "DD", "beta": 0.7, "truncation": 5.0, "dt": 5e-3}
    half = Case(**grid, spacing=0.1).reach
    files = computed([{**grid, "spacing": [half / n for n in counts], "store": "field"}])
    result = study(Inputs("mine", runs=files), judged_remeshing="M4'", printed_spacing={})
    row = result.table.iloc[0]
    assert row["h"] == pytest.approx(half / counts[1])
    # The next term of the smoothing error is of relative size epsilon^2, 0.2^2 on the middle level.
    expected = 2.0 if counts[1] == 128 else np.nan
    assert row["ours"] == pytest.approx(expected, abs=0.1, nan_ok=True)
    assert not result.findings
