"""Benchmarks keep their process to one thread; the other tests of this one need not."""

from __future__ import annotations

import numba as nb
import pytest


@pytest.fixture(scope="module", autouse=True)
def threads():
    before = nb.get_num_threads()
    yield
    nb.set_num_threads(before)
