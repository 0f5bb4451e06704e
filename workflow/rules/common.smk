# The configuration, validated; where things are; what a change of the code makes stale.
import os
from pathlib import Path

from snakemake.exceptions import WorkflowError

# One thread a job: the jobs run side by side.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

from fracparticles import plan
from fracparticles.errors import InvalidInput
from fracparticles.figures import FIGURES
from fracparticles.studies import STUDIES

try:
    STUDY = plan.read_config(config)
except InvalidInput as error:
    raise WorkflowError(f"configuration: {error}") from None

RESULTS = Path(STUDY.results_dir)
REPORT = Path(STUDY.report_dir)
SCENES = STUDY.scenes
CASES, BATCHES = plan.batches(SCENES, STUDY.smoke)

PACKAGE = Path("src/fracparticles")
# What a run depends on, and nothing else: editing a plot reruns no solver.
CORE = sorted(
    str(path)
    for part in ("special", "sums", "schemes", "integrators", ".")
    for path in PACKAGE.glob(f"{part}/*.py")
    if path.parent != PACKAGE
    or path.stem
    in {
        "case",
        "complaints",
        "dataset",
        "errors",
        "exterior",
        "kernels",
        "operators",
        "solver",
        "spectrum",
        "stability",
    }
)
COMPILED = RESULTS / "runs" / ".compiled"
LEDGER = [RESULTS / "claims.csv", RESULTS / "claims.md"]


wildcard_constraints:
    scene="|".join(SCENES),


def run_files(scene):
    """The run files of a scene."""
    return [RESULTS / "runs" / case.path for case in CASES[scene]]


def has_figure(scene):
    return SCENES[scene].figure is not None
