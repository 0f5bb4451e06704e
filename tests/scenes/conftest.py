"""Runs for the studies of scenes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from fracparticles.run.dataset import write
from fracparticles.run.solve import solve
from fracstudy.run_blocks import expand


@pytest.fixture(scope="module")
def computed(tmp_path_factory) -> Callable[[list[dict[str, Any]]], list[str]]:
    """Return a function that solves the cases of run blocks, each once, and returns their files."""
    folder = tmp_path_factory.mktemp("runs")

    def files(blocks: list[dict[str, Any]]) -> list[str]:
        cases = expand(blocks)
        for case in cases:
            if not (folder / case.path).exists():
                write(solve(case), folder / case.path)
        return [str(folder / case.path) for case in cases]

    return files
