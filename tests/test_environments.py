"""The container and the conda environment are those of the lock."""

from __future__ import annotations

import re
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[1]
MAKEFILE = (ROOT / "Makefile").read_text("utf-8")
(PYTHON,) = re.findall(r"^PYTHON_VERSION := (\S+)$", MAKEFILE, re.MULTILINE)


def test_all_name_one_python():
    (image,) = re.findall(r"^FROM python:(\d+\.\d+)", (ROOT / "Dockerfile").read_text(), re.M)
    conda = yaml.safe_load((ROOT / "environment.yml").read_text())["dependencies"]
    actions = re.findall(
        r'python-version: "(.+?)"', (ROOT / ".github/workflows/ci.yml").read_text()
    )
    assert {image, *actions} == {PYTHON}
    assert f"python={PYTHON}" in conda


def test_all_install_the_lock_and_no_other_version():
    docker = (ROOT / "Dockerfile").read_text("utf-8")
    installed = re.findall(r"pip install (.+?)(?: \\|$)", docker, re.MULTILINE)
    for line in installed:
        assert ("--require-hashes" in line and ".lock" in line) or "--no-deps" in line, line
    (pip,) = [
        one["pip"]
        for one in yaml.safe_load((ROOT / "environment.yml").read_text())["dependencies"]
        if isinstance(one, dict)
    ]
    assert pip == ["-r requirements.lock"]
    lock = (ROOT / "requirements.lock").read_text("utf-8")
    names = re.findall(r"^([A-Za-z0-9_.-]+)==\S+ \\$", lock, re.MULTILINE)
    assert len(names) == len(set(names)) > 50


def test_every_rule_says_what_it_takes():
    for path in (ROOT / "workflow/rules").glob("*.smk"):
        rules = re.split(r"^ *rule\b", path.read_text("utf-8"), flags=re.MULTILINE)[1:]
        for rule in rules:
            if "script:" in rule:
                assert "runtime=" in rule, (path.name, rule[:40])
                assert "mem_mb=" in rule, (path.name, rule[:40])
