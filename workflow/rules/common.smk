# The configuration, validated; where things are; what a change of the code makes stale.
import fcntl
import os
import sys
import time
from hashlib import sha256
from pathlib import Path

from snakemake.exceptions import WorkflowError

# One thread a job: the jobs run side by side.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[name] = "1"

if workflow.scheduling_settings:
    # A limit for the rate of jobs, which Snakemake always has, starts at each pass of the scheduler a timer for one more,
    # for ever; each pass asks for the size of every input of every waiting job, and the last timer keeps the process.
    workflow.scheduling_settings.max_jobs_per_timespan = None

from fracparticles.errors import InvalidInput
from fracstudy.config import batches, benchmark_jobs, jobs, read_config, targets
from fracstudy.criteria import CONVENTIONS
from fracstudy.make import made
from fracstudy.report import pages
from fracstudy.sources import sources_of
from fracstudy.summary import already, shortly, slowest, summary

if problem := next((c for c in " '\"" if c in str(Path.cwd())), None):
    raise WorkflowError(
        f"the folder {Path.cwd()} has {problem!r} in its path, which Snakemake's jobs cannot take: "
        "move the project, or call it by a link without."
    )

try:
    STUDY, SCENES = read_config(config)
    CASES, BATCHES = batches(SCENES, STUDY.smoke)
except InvalidInput as error:
    raise WorkflowError(f"configuration: {error}") from None

if STUDY.smoke and workflow.dag_settings:
    # A job that makes half of the scenes has some hundred files; for each Snakemake reads all that the job read.
    workflow.dag_settings.max_checksum_file_size = 0

JOBS = jobs(SCENES, STUDY.smoke)
RESULTS = Path(STUDY.results_dir)
REPORT = Path(STUDY.report_dir)
SITE = Path(STUDY.site_dir)
EXAMPLES = sorted(path.stem for path in Path("examples").glob("*.py"))
SITE_SUFFIXES = (".md", ".yml", ".py", ".css", ".js")
LEDGER = [RESULTS / "claims.csv", RESULTS / "claims.md"]
BENCHMARK_JOBS = benchmark_jobs(SCENES, STUDY.smoke)
FROM_TIMES = [name for name, scene in SCENES.items() if scene.all_benchmarks]
# What a run depends on, and nothing else: editing a plot reruns no solver.
SOLVER = Path("src/fracparticles/run/solve.py")
READER = Path("src/fracparticles/run/dataset.py")
FUNCTIONS = ("study.py", "figure.py")


wildcard_constraints:
    scene="|".join(SCENES),


def claim_folder():
    """Refuse a second workflow in this folder. The system lets go of the lock when the process ends, whatever ends it."""
    global RUNNING, STARTED
    STARTED = time.time()
    RUNNING = open(".snakemake/running", "w")
    try:
        fcntl.flock(RUNNING, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise WorkflowError("a workflow runs in this folder already: wait for its end.") from None


onstart:
    claim_folder()
    runs = [[RESULTS / "runs" / case.path] for cases in BATCHES.values() for case in cases]
    scenes = [files_of(name) for name in SCENES]
    print(already(RESULTS, {"runs": runs, "scenes": scenes}), flush=True)


onsuccess:
    jobs = slowest(Path(".snakemake/metadata"), STARTED)
    print(summary(LEDGER[0], [SITE / "index.html", REPORT / "README.md", RESULTS], jobs))


def code(*files):
    """A digest of the source files that these are made of, a parameter of their rule: a change of one reruns it.

    To read runs takes not what makes them. As inputs they would be sixty files more a job for Snakemake to look after.
    """
    made_of = {source for file in files if file for source in sources_of(Path(file), ends=[READER])}
    return sha256(b"".join(Path(source).read_bytes() for source in sorted(made_of))).hexdigest()


def files_of(name):
    """The files that a scene consists of."""
    return made(SCENES[name], RESULTS, STUDY.figure_formats)


def run_files(name):
    """The run files of a scene."""
    return [RESULTS / "runs" / case.path for case in CASES[name]]
