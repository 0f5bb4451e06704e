"""What a scheme costs in a box, against the sums themselves."""

from __future__ import annotations

import gc
import types
from dataclasses import replace

import numpy as np
import pytest

from fracparticles.lattice.fourier import transform_length
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.cost import bytes_kept, operations


def test_operations_of_a_square_are_those_of_its_transforms():
    """All N rows and half the L columns, there and back: one real and one complex transform each."""
    size = 161
    length = transform_length(2 * size - 1)
    half = length // 2 + 1
    complex_line = 5.0 * length * np.log2(length)
    expected = 2.0 * (size * 0.5 + half) * complex_line + 2.0 * half * length
    square = Setting(alpha=1.5, dim=2, n=size // 2)
    assert operations("KPSE", square) == pytest.approx(expected, rel=1e-14)
    fourth = operations("FPSE", replace(square, order=4))
    assert fourth > operations("FPSE", square) > 1.5 * expected


@pytest.mark.parametrize("scheme", ["DD", "KPSE", "FPSE"])
@pytest.mark.parametrize(("dim", "size"), [(2, 81), (3, 25)])
def test_bytes_kept_cover_the_arrays_of_the_operator(scheme, dim, size):
    """The arrays that an operator holds, and the vectors of the series, are what is counted."""
    setting = Setting(alpha=1.5, dim=dim, n=size // 2, spacing=18.0 / (size - 1))
    held = _array_bytes(SCHEMES[scheme].operator(setting))
    counted = bytes_kept(scheme, setting)
    vectors = counted - held
    # Five vectors of the series, for FPSE three more of the divergence; stencils aside.
    expected = 8.0 * size**dim * (8 if scheme == "FPSE" else 5)
    assert vectors == pytest.approx(expected, abs=0.005 * counted)


def _array_bytes(thing: object) -> int:
    """The memory of all arrays that can be reached from an object, each counted once."""
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
