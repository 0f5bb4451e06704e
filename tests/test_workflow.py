"""The smoke workflow of some scenes, in a copy of the project, what makes it run again, and what is added to it.

All scenes together are run by `make smoke`.
"""

from __future__ import annotations

import fcntl
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pandas as pd
import pytest
import yaml

from copies import copy_folder
from snakemake_call import call, started
from sweeps import few
from test_contributing import FILES

ROOT = Path(__file__).resolve().parents[1]
PARTS = ("Snakefile", "config", "profiles", "workflow", "report", "src")
SMOKE = ("--configfile", "config/smoke.yaml")
# One of each kind, the quickest: with runs, variants, tables of others, a benchmark, a study alone.
KEPT = {
    "lucchesi": ("rejected_dpse", "truncation", "truncation_claims"),
    "lewandowski": (),
    "ghorbani": ("sph_spline",),
    "particle_note": (),
    "run_times": ("scattered_sums",),
    "beyond": (),
    "problems": (),
    "extremes": (),
}
TARGETS = tuple(name for names in KEPT.values() for name in names)
SMOKE_JOBS = "_SMOKE_JOBS = "


def environment(project: Path) -> dict[str, str]:
    paths = [str(project / "src"), os.environ.get("PYTHONPATH", "")]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}


def planned(project: Path, *arguments: str) -> set[str]:
    """The rules that a call would run, from the counts of a dry run."""
    succeeded, said = call(project, *arguments, "--dry-run")
    assert succeeded, said
    return {name.rstrip("_0123456789") for name in re.findall(r"^(\w+) +\d+$", said, re.MULTILINE)}


def copy(target: Path) -> Path:
    target.mkdir(exist_ok=True)
    for part in PARTS:
        source = ROOT / part
        if source.is_dir():
            copy_folder(source, target / part)
        else:
            shutil.copy2(source, target / part)
    for folder in target.glob("workflow/scenes/*/*/"):
        if (folder / "scene.yaml").exists() and folder.name not in KEPT[folder.parent.name]:
            (folder / "scene.yaml").unlink()  # others may take their functions
    # To start a job takes longer than what it does here: no more of them than must wait for each other.
    config = target / "src/fracstudy/config.py"
    text = config.read_text()
    assert SMOKE_JOBS + "2" in text
    config.write_text(text.replace(SMOKE_JOBS + "2", SMOKE_JOBS + "1"))
    # What numba compiles comes with the copy; what is not there yet is compiled by the jobs.
    (target / "workflow/scripts/compile.py").write_text("")
    # The findings ask for claims of scenes that are not here.
    (target / "report/template/findings.md.j2").write_text("# Findings\n")
    return target


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    return copy(tmp_path_factory.mktemp("project"))


@pytest.fixture(scope="module")
def finished(project):
    """By the command itself, in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-m", "snakemake", "-j2", *TARGETS, "report", *SMOKE],
        cwd=project,
        env=environment(project),
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-4000:]
    longest = max(done.stderr.splitlines(), key=len)
    assert len(longest) < 300, longest  # a job says what it does, and does not list its files
    return project


def test_a_misspelt_key_is_refused_before_any_work(project):
    succeeded, said = call(project, "rejected_dpse", "--config", "result_dir=elsewhere")
    assert not succeeded
    assert "result_dir" in said
    assert "Did you mean 'results_dir'?" in said
    assert not (project / "results").exists()


def test_every_scene_has_its_table_findings_and_figure(finished):
    results = finished / "results-smoke"
    scenes = {
        name: folder
        for folder in finished.glob("workflow/scenes/*/*/")
        if (folder / "scene.yaml").exists()
        for name in yaml.safe_load((folder / "scene.yaml").read_text()).get(
            "variants", [folder.name]
        )
    }
    assert len(scenes) == len(TARGETS) + 2  # three variants in one folder
    for name, folder in scenes.items():
        assert (results / f"tables/{name}.csv").stat().st_size > 0
        assert (results / f"tables/{name}.md").stat().st_size > 0
        if (folder / "figure.py").exists():
            assert (results / f"figures/{name}.svg").stat().st_size > 5000


def test_the_ledger_judges_every_claim_and_the_report_shows_it(finished):
    from fracstudy.ledger_text import read_ledger, summary_line
    from fracstudy.printed import read_claims

    df = read_ledger(finished / "results-smoke/claims.csv")
    printed = [
        finished / f"report/printed/{document}/{name}.yaml"
        for document, names in KEPT.items()
        for name in names
    ]
    claims = read_claims(*(path for path in printed if path.exists()))
    assert sorted(df["id"]) == sorted(claim.id for claim in claims)
    assert summary_line(df) in (finished / "results-smoke/claims.md").read_text("utf-8")
    assert summary_line(df) in (finished / "results-smoke/report/README.md").read_text("utf-8")


def test_another_meaning_of_a_word_is_judged_anew_and_nothing_measured(finished):
    with changed(finished / "report/printed/conventions.yaml"):
        jobs = planned(finished, "report", *SMOKE)
    assert {"ledger", "report"} <= jobs
    assert "make_part" not in jobs


def test_nothing_is_left_to_do_and_nothing_half_written(finished):
    """A second workflow may look meanwhile: that does no harm."""
    with claimed(finished):
        assert not planned(finished, *TARGETS, *SMOKE)
    stray = [path for path in (finished / "results-smoke").rglob(".*") if path.name != ".compiled"]
    assert not stray


def test_editing_a_plot_reruns_its_scene_and_no_solver(finished):
    with changed(finished / "workflow/scenes/lucchesi/rejected_dpse/figure.py"):
        jobs = planned(finished, *TARGETS, *SMOKE)
    assert "make_part" in jobs
    assert not {"solve_part", "compile"} & jobs


def test_editing_a_solver_reruns_its_runs(finished):
    with changed(finished / "src/fracparticles/time/chebyshev.py"):
        jobs = planned(finished, "rejected_dpse", *SMOKE)
    assert {"solve_part", "make_part"} <= jobs


def test_a_second_workflow_in_the_same_folder_is_refused_in_one_line(finished):
    with claimed(finished):
        name = "sph_spline"
        succeeded, said = call(finished, name, *SMOKE, "--forcerun", name)
    assert not succeeded
    assert "a workflow runs in this folder already" in said


@pytest.mark.parametrize("folder", few(["with'quote", "with a blank"], 1))
def test_a_folder_that_jobs_cannot_take_is_refused_in_one_line(tmp_path, folder):
    project = copy(tmp_path / folder)
    succeeded, said = call(project, "sph_spline")
    assert not succeeded
    assert "in its path" in said
    assert not (project / "results").exists()


def test_a_killed_workflow_carries_on(finished):
    """Killed outright in the middle of its runs: no file under a final name is damaged, the next call ends the work."""
    from fracparticles.run.dataset import read_run

    runs = finished / "results-killed/runs"
    runs.mkdir(parents=True)
    shutil.copy2(finished / "results-smoke/runs/.compiled", runs)  # what is compiled is there
    words = ["solve_part_1", *SMOKE, "--config", "results_dir=results-killed"]
    process = started(finished, *words)
    for _ in range(12_000):
        if any(runs.rglob("[!.]*.nc")):
            break
        time.sleep(0.005)
    os.killpg(process.pid, signal.SIGKILL)
    process.join()
    for path in runs.rglob("[!.]*.nc"):
        assert "mass_final" in read_run(path)
    succeeded, said = call(finished, *words)
    assert succeeded, said[-4000:]


# --- nothing to register ------------------------------------------------------------------------------------------

NEW_SCENE = """
title: "Errors of a scheme of one's own"
runs:
  - {scheme: [KPSE, SMEAR], beta: 0.5, truncation: 10.0, spacing: [0.4, 0.2], integrator: exponential, store: metrics}
"""

NEW_FIGURE = """
from fracstudy.style import axes_row, scheme_lines


def figure(series, table):
    figure, (axes,) = axes_row(1)
    scheme_lines(axes, table, x="particle_spacing", y="relative error")
    return figure
"""


def test_a_new_scheme_and_a_new_scene_run_to_a_figure_and_nothing_else_is_touched(finished):
    """One module, one folder."""
    (finished / "src/fracparticles/schemes/smear.py").write_text(
        FILES["src/fracparticles/schemes/smear.py"]
    )
    folder = finished / "workflow/scenes/beyond/of_my_own"
    folder.mkdir()
    (folder / "scene.yaml").write_text(NEW_SCENE)
    (folder / "figure.py").write_text(NEW_FIGURE)
    (finished / "mine/runs").mkdir(parents=True)
    shutil.copy2(finished / "results-smoke/runs/.compiled", finished / "mine/runs")
    succeeded, said = call(finished, "of_my_own", "--config", "results_dir=mine")
    assert succeeded, said[-4000:]
    table = pd.read_csv(finished / "mine/tables/of_my_own.csv")
    assert set(table["scheme"]) == {"KPSE", "SMEAR"}
    assert len(table) == 4
    assert (table["relative error"] < 0.5).all()
    assert (finished / "mine/figures/of_my_own.png").stat().st_size > 5000


@contextmanager
def claimed(project: Path) -> Iterator[None]:
    """Hold the lock of a folder, as a workflow does that runs there."""
    with open(project / ".snakemake/running", "w") as running:
        fcntl.flock(running, fcntl.LOCK_EX)
        yield


@contextmanager
def changed(path: Path) -> Iterator[None]:
    """Change a file for a while; then it is as it was, and as old."""
    before, text = path.stat(), path.read_text()
    path.write_text(text + "\n# changed\n")
    yield
    path.write_text(text)
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
