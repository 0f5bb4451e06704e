"""The smoke workflow of some scenes, in a copy of the project, what makes it run again, and what is added to it.

All scenes together are run by `make smoke`.
"""

from __future__ import annotations

import fcntl
import os
import re
import shutil
import signal
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
# One of each kind, the quickest: with variants, tables of others, a benchmark, a study alone.
KEPT = {
    "lucchesi": ("truncation", "truncation_claims"),
    "lewandowski": (),
    "ghorbani": ("sph_spline",),
    "particle_note": (),
    "run_times": ("scattered_sums",),
    "beyond": (),
    "problems": (),
    "extremes": (),
}
OWN = "of_my_own"  # added to them: with runs
TARGETS = (*(name for names in KEPT.values() for name in names), OWN)
SMOKE_JOBS = "_SMOKE_JOBS = "


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
    """With a new scheme and a new scene: one module, one folder."""
    project = copy(tmp_path_factory.mktemp("project"))
    module = "src/fracparticles/schemes/smear.py"
    (project / module).write_text(FILES[module])
    folder = project / "workflow/scenes/beyond" / OWN
    folder.mkdir()
    (folder / "scene.yaml").write_text(NEW_SCENE)
    (folder / "figure.py").write_text(NEW_FIGURE)
    (folder / "caption.md").write_text("The report wants one.\n")
    return project


@pytest.fixture(scope="module")
def killed(project):
    """Killed outright in the middle of its runs."""
    runs = project / "results-smoke/runs"
    process = started(project, "solve_part_1", *SMOKE)
    for _ in range(12_000):
        if any(runs.rglob("[!.]*.nc")):
            break
        time.sleep(0.005)
    os.killpg(process.pid, signal.SIGKILL)
    process.join()
    return project


@pytest.fixture(scope="module")
def finished(killed):
    """All of it is there: the call carries on where another was killed."""
    succeeded, said = call(killed, *TARGETS, "report", *SMOKE)
    assert succeeded, said[-4000:]
    longest = max(said.splitlines(), key=len)
    assert len(longest) < 300, longest  # a job says what it does, and does not list its files
    return killed


def test_a_misspelt_key_is_refused_before_any_work(project):
    succeeded, said = call(project, OWN, "--config", "result_dir=elsewhere")
    assert not succeeded
    assert "result_dir" in said
    assert "Did you mean 'results_dir'?" in said
    assert not (project / "results").exists()


def test_no_file_of_a_killed_workflow_is_damaged(killed):
    """The next call ends its work: that is the one of all other tests."""
    from fracparticles.run.dataset import read_run

    runs = list((killed / "results-smoke/runs").rglob("[!.]*.nc"))
    assert runs
    for path in runs:
        assert "mass_final" in read_run(path)


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
    with changed(finished / "workflow/scenes/lucchesi/truncation/figure.py"):
        jobs = planned(finished, *TARGETS, *SMOKE)
    assert "make_part" in jobs
    assert not {"solve_part", "compile"} & jobs


def test_editing_a_solver_reruns_its_runs(finished):
    with changed(finished / "src/fracparticles/time/chebyshev.py"):
        jobs = planned(finished, "truncation", *SMOKE)
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


def test_a_new_scheme_and_a_new_scene_run_to_a_figure_and_nothing_else_is_touched(finished):
    """There is nothing to register."""
    table = pd.read_csv(finished / f"results-smoke/tables/{OWN}.csv")
    assert set(table["scheme"]) == {"KPSE", "SMEAR"}
    assert len(table) == 4
    assert (table["relative error"] < 0.5).all()
    assert (finished / f"results-smoke/figures/{OWN}.svg").stat().st_size > 5000


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
