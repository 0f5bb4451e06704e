"""Snakemake called in a process that has its libraries already: to import them takes longer than most calls."""

from __future__ import annotations

import multiprocessing
import os
import sys
from pathlib import Path

_SAID = ".said"
_CONTEXT = multiprocessing.get_context("forkserver")
_CONTEXT.set_forkserver_preload(
    ["jinja2", "matplotlib.pyplot", "numba", "pyfftw", "pydantic", "scipy.stats", "smart_open", "snakemake.cli",
     "snakemake.report.html_reporter", "xarray"]
)  # fmt: skip


def call(folder: Path, *arguments: str) -> tuple[bool, str]:
    """Return whether a call in this folder succeeds, and what it says; the packages are those of the folder."""
    process = started(folder, *arguments)
    process.join(600)
    return process.exitcode == 0, (folder / _SAID).read_text()


def started(folder: Path, *arguments: str) -> multiprocessing.Process:
    """Return the process of a call, the first of a process group of its own."""
    process = _CONTEXT.Process(target=_main, args=(folder, ["-j2", *arguments]), daemon=True)
    process.start()
    return process


def _main(folder: Path, arguments: list[str]) -> None:
    os.setsid()
    with open(folder / _SAID, "w") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    os.chdir(folder)
    os.environ["PYTHONPATH"] = os.pathsep.join(
        filter(None, [str(folder / "src"), os.environ.get("PYTHONPATH", "")])
    )
    sys.path.insert(0, str(folder / "src"))
    sys.argv = ["snakemake", *arguments]  # what it says that it was called by
    from snakemake.cli import main

    main(arguments)
