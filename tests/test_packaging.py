"""The lock holds what the project asks for, and the package is what its metadata say."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parent.parent


def test_the_lock_names_no_address_and_all_that_the_project_asks_for():
    """Pins and hashes are pip's to check, --require-hashes."""
    lock = (ROOT / "requirements.lock").read_text()
    assert not re.search(r"://|--(?:extra-)?index|--find-links|--trusted-host", lock)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    asked = [project["dependencies"], *project["optional-dependencies"].values()]
    names = {
        re.match(r"[\w-]+", text)[0].lower().replace("_", "-") for texts in asked for text in texts
    }
    assert names <= set(re.findall(r"^([\w-]+)==", lock.replace("_", "-"), flags=re.MULTILINE))


def test_every_module_of_the_library_imports_without_the_extras():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    modules = {"import-linter": "importlinter", "pyyaml": "yaml", "pytest-xdist": "xdist"}
    names = [
        re.match(r"[\w-]+", text)[0]
        for texts in project["optional-dependencies"].values()
        for text in texts
    ]
    blocked = {modules.get(name, name.replace("-", "_")) for name in names} | {"fracstudy"}
    program = f"""
import importlib, pkgutil, sys
sys.modules.update(dict.fromkeys({sorted(blocked)}))
import fracparticles
for module in pkgutil.walk_packages(fracparticles.__path__, "fracparticles."):
    importlib.import_module(module.name)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_installed_metadata_agree_with_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert importlib.metadata.version(project["name"]) == project["version"]


def test_citation_names_the_same_version():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert (citation["title"], citation["version"]) == (project["name"], project["version"])
    assert len(citation["references"]) == 4
