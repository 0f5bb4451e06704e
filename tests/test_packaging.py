"""The lock check finds what it is for, and the package is what its metadata say."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import tomllib
from pathlib import Path
from types import ModuleType

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
PROJECT = {
    "project": {
        "dependencies": ["numpy>=2.0"],
        "optional-dependencies": {"dev": ["PyTest_xdist"]},
    },
    "build-system": {"requires": ["setuptools>=77"]},
}
LOCK = """\
# a comment
numpy==2.4.6 \\
    --hash=sha256:00 \\
    --hash=sha256:01
    # via fracparticles (pyproject.toml)
pytest-xdist==3.8.0 \\
    --hash=sha256:02
setuptools==84.0.0 \\
    --hash=sha256:03
"""


@pytest.fixture(scope="module")
def check_lock() -> ModuleType:
    spec = importlib.util.spec_from_file_location("check_lock", ROOT / "tools" / "check_lock.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_good_lock_passes(check_lock):
    assert check_lock.problems(LOCK, PROJECT) == []


def test_the_lock_of_the_project_passes(check_lock):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert check_lock.problems((ROOT / "requirements.lock").read_text(), project) == []


@pytest.mark.parametrize(
    ("lock", "complaint"),
    [
        ("--index-url something\n" + LOCK, "line 1: an address or an index option"),
        ("--extra-index-url something\n" + LOCK, "line 1: an address or an index option"),
        ("--find-links wheels\n" + LOCK, "line 1: an address or an index option"),
        (LOCK + "scipy @ https://example.org/scipy.whl\n", "an address or an index option"),
        (LOCK + "    # via https://example.org\n", "an address or an index option"),
        (LOCK + "scipy>=1.13\n", "line 10: neither a pin"),
        (LOCK + "scipy==1.17.1\n", "scipy: no hash"),
        (LOCK.replace("numpy==2.4.6", "numpy==1.26.4"), "numpy>=2.0: asked for"),
        (LOCK.replace("pytest-xdist==", "pytest-other=="), "PyTest_xdist: asked for"),
        (LOCK.replace("setuptools==84.0.0", "setuptools==60.0.0"), "setuptools>=77: asked for"),
    ],
)
def test_a_bad_lock_is_found(check_lock, lock, complaint):
    (problem,) = check_lock.problems(lock, PROJECT)
    assert complaint in problem


def test_installed_metadata_agree_with_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert importlib.metadata.version(project["name"]) == project["version"]


def test_citation_names_the_same_version():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert (citation["title"], citation["version"]) == (project["name"], project["version"])
    assert len(citation["references"]) == 4
