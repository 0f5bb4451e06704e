"""The study of the cube on tiny grids, and its counts against the sums themselves."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.lattice.fourier import transform_length
from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES
from fracstudy.inputs import Inputs
from scenes.beyond.three_dimensions.figure import figure
from scenes.beyond.three_dimensions.study import bytes_kept, operations, study


@pytest.fixture(scope="module")
def result(computed):
    common = {"beta": 0.5, "dim": 3, "truncation": 4.0, "store": "metrics"}
    blocks = [
        {"scheme": ["DD", "FPSE", "KPSE"], "order": [2, 4], "spacing": [1.1, 0.7], **common}
        | {"integrator": "exponential"},
        {"scheme": "GPSE", "spacing": 0.7, "exterior": ["truncated", "open"], **common},
    ]
    return study(Inputs("three_dimensions", runs=computed(blocks)))


def test_truncated_exchanges_keep_the_mass_that_should_leave(result):
    table = result.table
    truncated = table[(table["exterior"] == "truncated") & (table["scheme"] != "DD")]
    # Conservative: round-off of some thousand terms.
    assert truncated["mass at tf"].to_numpy() == pytest.approx(truncated["mass at t0"], rel=1e-11)
    assert (truncated["mass at tf, exact"] < truncated["mass at tf"]).all()
    gpse = table[table["scheme"] == "GPSE"].set_index("exterior")
    excess = gpse["mass at tf"] - gpse["mass at tf, exact"]
    # The closure leaves out terms of relative size (R / D)^2 = 1 / C^2 of what is outside.
    assert abs(excess["open"]) < excess["truncated"] / 16.0


def test_sizes_orders_and_figure(result):
    table, series = result.table, result.series
    assert set(table["N"]) == {"17^3", "27^3"}
    # Two h for six pairs of scheme and order.
    assert table["order from the h above"].notna().sum() == 6
    assert (series["work"] > 0.0).all()
    assert len(figure(series, table).axes) == 2


def test_operations_of_a_square_are_those_of_its_transforms():
    """All N rows and half the L columns, there and back: one real and one complex transform each."""
    size = 161
    length = transform_length(2 * size - 1)
    half = length // 2 + 1
    complex_line = 5.0 * length * np.log2(length)
    expected = 2.0 * (size * 0.5 + half) * complex_line + 2.0 * half * length
    assert operations("KPSE", 2, 2, size, 2.0) == pytest.approx(expected, rel=1e-14)
    assert (
        operations("FPSE", 4, 2, size, 2.0) > operations("FPSE", 2, 2, size, 2.0) > 1.5 * expected
    )


@pytest.mark.parametrize("scheme", ["DD", "KPSE", "FPSE"])
@pytest.mark.parametrize(("dim", "size"), [(2, 81), (3, 25)])
def test_bytes_kept_cover_the_arrays_of_the_operator(scheme, dim, size):
    """The arrays that an operator holds, and the vectors of the series, are what is counted."""
    case = Case(
        scheme=scheme, beta=0.5, dim=dim, half_width=9.0, spacing=18.0 / (size - 1),
        integrator="exponential",
    )  # fmt: skip
    held = _array_bytes(SCHEMES[scheme].operator(case.setting))
    counted = bytes_kept(scheme, 2, dim, size, "truncated")
    vectors = counted - held
    # Five vectors of the series, for FPSE three more of the divergence; stencils aside.
    expected = 8.0 * size**dim * (8 if scheme == "FPSE" else 5)
    assert vectors == pytest.approx(expected, abs=0.005 * counted)


def _array_bytes(thing: object) -> int:
    """The memory of all arrays that can be reached from an object, each counted once."""
    import gc
    import types

    seen: set[int] = set()
    arrays: dict[int, int] = {}
    todo = [thing]
    while todo:
        item = todo.pop()
        if id(item) in seen or isinstance(item, types.ModuleType | type):
            continue
        seen.add(id(item))
        if isinstance(item, np.ndarray):
            base = item
            while isinstance(base.base, np.ndarray):
                base = base.base
            arrays[id(base)] = base.nbytes
        elif isinstance(item, types.FunctionType):
            todo.extend(item.__closure__ or ())
        else:
            todo.extend(gc.get_referents(item))
    return sum(arrays.values())
