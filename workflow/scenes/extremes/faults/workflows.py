"""A workflow of two runs: killed, interrupted, begun twice, with another configuration meanwhile."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from fracstudy.probe import HELD, Kind, Probe
from scenes.extremes.faults.processes import counted

_SCENE = """\
title: "Two runs"
runs:
  - {{scheme: [DD, KPSE], beta: {beta}, half_width: 10.0, spacing: 0.5, integrator: exponential, store: metrics}}
"""
_CONFIG = """\
results_dir: results
report_dir: report
documents:
  own: {title: "Of our own"}
"""
_LONGEST = 300  # seconds


class Project:
    """A copy of the workflow with one scene of two runs."""

    def __init__(self, folder: Path, root: Path) -> None:
        self.folder = folder
        shutil.copytree(root / "workflow/rules", folder / "workflow/rules")
        shutil.copytree(root / "workflow/scripts", folder / "workflow/scripts")
        shutil.copy2(root / "Snakefile", folder)
        for part in ("src", "profiles"):
            (folder / part).symlink_to(root / part)
        (folder / "config").mkdir()
        (folder / "config/study.yaml").write_text(_CONFIG)
        self.configure(0.5)
        (folder / "results/runs").mkdir(parents=True)
        (folder / "results/runs/.compiled").touch()  # what runs this has compiled it all

    def configure(self, beta: float) -> None:
        """Write the scene."""
        scene = self.folder / "workflow/scenes/own/two/scene.yaml"
        scene.parent.mkdir(parents=True, exist_ok=True)
        scene.write_text(_SCENE.format(beta=beta))

    def begin(self, jobs: int = 1) -> subprocess.Popen[str]:
        """Start the workflow, in a session of its own."""
        words = ["-m", "snakemake", f"-j{jobs}", "two", "--directory", str(self.folder)]
        words += ["--snakefile", str(self.folder / "Snakefile")]
        paths = [str(self.folder / "src"), os.environ.get("PYTHONPATH", "")]
        return subprocess.Popen(
            [sys.executable, *words],
            cwd=self.folder,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )

    def end(self, jobs: int = 1) -> dict[str, bytes]:
        """Run the workflow and return its files."""
        process = self.begin(jobs)
        text, _ = process.communicate(timeout=_LONGEST)
        if process.returncode:
            raise RuntimeError(text[-500:])
        return self.files

    def clear(self) -> None:
        """Remove what it has made."""
        for path in self.folder.glob("results/*/*"):
            if path.name != ".compiled":
                shutil.rmtree(path) if path.is_dir() else path.unlink()

    @property
    def files(self) -> dict[str, bytes]:
        """Runs, tables, findings and series."""
        folder = self.folder / "results"
        kept = (p for p in folder.rglob("*") if p.is_file() and "logs" not in p.parts)
        return {str(p.relative_to(folder)): p.read_bytes() for p in kept}

    def disturbed(self, by: int) -> None:
        """Begin anew, and end it by a signal to all of its processes as soon as a job works."""
        self.clear()
        process = self.begin()
        log = self.folder / "results/logs/solve_two_1.log"
        until = time.monotonic() + _LONGEST
        while not log.exists() and process.poll() is None and time.monotonic() < until:
            time.sleep(0.01)
        os.killpg(process.pid, by)
        process.communicate(timeout=_LONGEST)


def probes(folder: Path) -> Iterator[Probe]:
    """Each fault once, on a workflow of two runs; then the next call."""
    project, table = Project(folder / "workflow", Path.cwd()), "tables/two.csv"
    right = project.end()
    same = Kind("workflow", "then the files of an undisturbed run", must=HELD)
    for name, by in (("SIGKILL", signal.SIGKILL), ("SIGINT", signal.SIGINT)):
        project.disturbed(by)
        again = project.end() == right
        yield same(f"{name} while a job solves", counted, [again])
    project.configure(0.25)
    other = project.end()
    project.configure(0.5)
    back = project.end()
    changed = other[table] != right[table] and all(back[name] == right[name] for name in right)
    expected = f"another table, {same.expected}"
    yield same("another beta, and back", counted, [changed], expected=expected)
    project.clear()
    for path in project.folder.glob("results/runs/scheme*"):
        shutil.rmtree(path)
    both = project.begin(), project.begin()
    texts = [process.communicate(timeout=_LONGEST)[0] for process in both]
    refused = [process.returncode != 0 for process in both]
    # One is refused; or none, one after the other, where the machine is slow.
    told = [
        no and "runs in this folder already" in text
        for no, text in zip(refused, texts, strict=True)
    ]
    good = told == refused and not all(refused) and project.end() == right
    expected = f"one is refused in a line; {same.expected}"
    yield same("two in one folder", counted, [good], expected=expected)
