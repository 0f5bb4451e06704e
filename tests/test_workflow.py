"""One complete smoke workflow, in a copy of the project, and what makes it run again."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

ROOT = Path(__file__).resolve().parents[1]
PARTS = ("Snakefile", "config", "workflow", "report", "src")
SMOKE = ("--configfile", "config/smoke.yaml")


def snakemake(project: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "snakemake", "-j2", *arguments],
        cwd=project,
        env=environment(project),
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


def environment(project: Path) -> dict[str, str]:
    paths = [str(project / "src"), os.environ.get("PYTHONPATH", "")]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}


def planned(project: Path, *arguments: str) -> str:
    """The rules that a call would run, from a dry run."""
    done = snakemake(project, *arguments, "--dry-run")
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    project = tmp_path_factory.mktemp("project")
    for part in PARTS:
        source = ROOT / part
        if source.is_dir():
            shutil.copytree(source, project / part, ignore=shutil.ignore_patterns("*.nb?"))
        else:
            shutil.copy2(source, project / part)
    return project


@pytest.fixture(scope="module")
def finished(project):
    done = snakemake(project, "all", *SMOKE)
    assert done.returncode == 0, done.stderr[-4000:]
    return project


def test_a_misspelt_key_is_refused_before_any_work(project):
    done = snakemake(project, "all", "--config", "result_dir=elsewhere")
    assert done.returncode != 0
    assert "result_dir" in done.stderr
    assert "Did you mean 'results_dir'?" in done.stderr
    assert not (project / "results").exists()


def test_every_scene_has_its_table_findings_and_figure(finished):
    from fracstudy import plan

    results = finished / "results-smoke"
    study = plan.read_config(_merged(finished))
    for name, scene in study.scenes.items():
        assert (results / f"tables/{name}.csv").stat().st_size > 0
        assert (results / f"tables/{name}.md").stat().st_size > 0
        if scene.figure:
            assert (results / f"figures/{name}.png").stat().st_size > 5000
            assert (results / f"figures/{name}.svg").stat().st_size > 5000
    assert len(pd.read_csv(results / "claims.csv")) > 100
    assert "</html>" in (results / "report/report.html").read_text()


def test_nothing_is_left_to_do_and_nothing_half_written(finished):
    assert "Nothing to be done" in planned(finished, "all", *SMOKE)
    stray = [
        path
        for path in (finished / "results-smoke").rglob(".*")
        if not path.name.startswith(".compiled_")
    ]
    assert not stray


def test_editing_a_plot_reruns_the_plot_and_no_solver(finished):
    touch(finished / "src/fracstudy/figures/errors.py")
    jobs = planned(finished, "figures", *SMOKE)
    assert "rule figure:" in jobs
    assert "rule solve_" not in jobs
    assert "rule study:" not in jobs
    snakemake(finished, "all", *SMOKE)


def test_editing_a_solver_reruns_its_runs(finished):
    touch(finished / "src/fracparticles/time/chebyshev.py")
    jobs = planned(finished, "lucchesi_figure_4a", *SMOKE)
    assert "rule solve_smoke_1:" in jobs
    assert "rule study:" in jobs
    assert "scene=lucchesi_table_2" not in jobs


def test_a_killed_workflow_carries_on(finished):
    """Killed outright in the middle of its runs: no file under a final name is damaged, the next call ends the work."""
    from fracparticles.run.dataset import read_run

    runs = finished / "results-killed/runs"
    call = ["lucchesi_figure_4a", *SMOKE, "--config", "results_dir=results-killed"]
    process = subprocess.Popen(
        [sys.executable, "-m", "snakemake", "-j1", *call],
        cwd=finished,
        env=environment(finished),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    for _ in range(1200):
        if any(runs.rglob("[!.]*.nc")):
            break
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    for path in runs.rglob("[!.]*.nc"):
        assert "mass_final" in read_run(path)
    profile = ("--workflow-profile", "workflow/profiles/default")
    done = snakemake(finished, *call, *profile)
    assert done.returncode == 0, done.stderr[-4000:]


def touch(path: Path) -> None:
    """Change a file as an editor would."""
    path.write_text(path.read_text() + "\n")


def _merged(project: Path) -> dict:
    import yaml
    from snakemake.utils import update_config

    study, smoke = (
        yaml.safe_load((project / f"config/{name}.yaml").read_text()) for name in ("study", "smoke")
    )
    update_config(study, smoke)  # as Snakemake lays one file over the other
    return study
