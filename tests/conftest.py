"""What the tests share: the profiles of hypothesis, and every scheme in every variant that the paper has."""

from __future__ import annotations

import gc
import os

import pytest
from hypothesis import settings

# BLAS reads its number of threads once, when it is loaded: a benchmark wants one.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")

gc.disable()  # until all is collected: nothing of that is garbage
from combinations import COMBINATIONS  # noqa: E402

# The same examples each time; `--hypothesis-profile=thorough` takes twenty times as many, and whole sweeps.
settings.register_profile("quick", deadline=None, derandomize=True, max_examples=15)
settings.register_profile("thorough", settings.get_profile("quick"), max_examples=300)
settings.load_profile("quick")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the complete workflow, which takes longest, so that another process does the rest meanwhile."""
    items.sort(key=lambda item: item.path.stem != "test_workflow")


def pytest_collection_finish() -> None:
    """Leave what is collected, hundreds of thousands of objects that stay, out of all searches for garbage."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(10_000)
    gc.enable()


@pytest.fixture(params=COMBINATIONS)
def combination(request) -> tuple[str, int, str]:
    """Return scheme, order and exterior."""
    return request.param
