"""Copies of the project to change, with what numba compiled, so that only what is changed is compiled again."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import fracparticles

_SOURCES = Path(fracparticles.__file__).parents[1]


def copy_folder(source: Path, target: Path) -> None:
    """Copy a folder but for what another process is writing there."""
    shutil.copytree(source, target, ignore=shutil.ignore_patterns("*.tmp.*", "*.pyc.*"))


def copy_packages(target: Path) -> None:
    for package in ("fracparticles", "fracstudy"):
        copy_folder(_SOURCES / package, target / package)


def answer(copy: Path, program: str) -> dict[str, Any]:
    """Return what a program prints last, an object in JSON, that runs with the packages of the copy."""
    run = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(copy)},
        cwd=copy,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout.splitlines()[-1])
    assert Path(found["file"]).is_relative_to(copy)
    return found
