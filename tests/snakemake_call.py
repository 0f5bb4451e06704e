"""Snakemake called in a process that has its libraries already: to import them takes longer than most calls."""

from __future__ import annotations

import multiprocessing
import os
import sys
from pathlib import Path

_CONTEXT = multiprocessing.get_context("forkserver")
_CONTEXT.set_forkserver_preload(
    ["matplotlib.pyplot", "numba", "pydantic", "scipy.stats", "snakemake.cli", "xarray"]
)


def call(folder: Path, *arguments: str) -> tuple[bool, str]:
    """Return whether a call in this folder succeeds, and what it says; the packages are those of the folder."""
    said = folder / ".said"
    process = _CONTEXT.Process(target=_main, args=(folder, ["-j2", *arguments], said), daemon=True)
    process.start()
    process.join(600)
    return process.exitcode == 0, said.read_text()


def _main(folder: Path, arguments: list[str], said: Path) -> None:
    with open(said, "w") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    os.chdir(folder)
    os.environ["PYTHONPATH"] = os.pathsep.join(
        filter(None, [str(folder / "src"), os.environ.get("PYTHONPATH", "")])
    )
    sys.path.insert(0, str(folder / "src"))
    from snakemake.cli import main

    main(arguments)
