"""Check that the lock pins all that ``pyproject.toml`` asks for, by hash and without addresses.

``python tools/check_lock.py`` lists what is wrong, one line each, and exits with status 1 if
anything is.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parent.parent
ADDRESS = re.compile(r"://|--(?:extra-)?index|--find-links|--trusted-host")
PIN = re.compile(r"^([A-Za-z0-9._-]+)==([^\s;\\]+)")


def requirements(project: dict[str, Any]) -> list[Requirement]:
    """Return the direct requirements of a parsed ``pyproject.toml``: run, extras and build."""
    lists = [
        project["project"]["dependencies"],
        *project["project"]["optional-dependencies"].values(),
        project["build-system"]["requires"],
    ]
    return [Requirement(text) for texts in lists for text in texts]


def problems(lock: str, project: dict[str, Any]) -> list[str]:
    """Return what is wrong with the text of a lock, given the parsed ``pyproject.toml``."""
    found: list[str] = []
    versions: dict[str, str] = {}
    hashes: dict[str, int] = {}
    name = ""
    for number, line in enumerate(lock.splitlines(), start=1):
        if ADDRESS.search(line):
            found.append(f"line {number}: an address or an index option: {line.strip()}")
        elif pin := PIN.match(line):
            name = canonicalize_name(pin[1])
            versions[name], hashes[name] = pin[2], 0
        elif line.startswith("    --hash=sha256:") and name:
            hashes[name] += 1
        elif line and not line.startswith("#") and not line.startswith("    # "):
            found.append(f"line {number}: neither a pin with ==, a hash nor a comment: {line}")
    found += [f"{name}: no hash" for name, count in hashes.items() if count == 0]
    for wanted in requirements(project):
        version = versions.get(canonicalize_name(wanted.name))
        if version is None or not wanted.specifier.contains(version, prereleases=True):
            found.append(f"{wanted}: asked for in pyproject.toml, locked is {version} (make lock)")
    return found


def main() -> int:
    """Print what is wrong with the project's lock; return the exit status."""
    found = problems(
        (ROOT / "requirements.lock").read_text(),
        tomllib.loads((ROOT / "pyproject.toml").read_text()),
    )
    for problem in found:
        print(f"requirements.lock: {problem}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
