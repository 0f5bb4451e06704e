"""What a scene of the extremes gives for the PARAMETERS of its test module."""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from fracstudy.probe import BAD
from scene_functions import figure, study


@pytest.fixture(scope="module")
def result(request):
    name = request.module.__name__.rpartition("test_")[2]
    return study(name)(Inputs(name), **request.module.PARAMETERS)


@pytest.fixture(scope="module")
def table(result):
    return result.table


@pytest.fixture(scope="module")
def drawn(request, result):
    name = request.module.__name__.rpartition("test_")[2]
    return figure(name)(result.series, result.table, request.module.PARAMETERS)


@pytest.fixture(scope="module")
def bad(table):
    """The probes that are silent or failed, in words: none."""
    rows = table[table["verdict"].isin(BAD)]
    return rows.to_string(index=False) if len(rows) else ""
