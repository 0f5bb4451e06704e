# The configuration, validated; where things are; what a change of the code makes stale.
import os
from pathlib import Path

from snakemake.exceptions import WorkflowError

# One thread a job: the jobs run side by side.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

from fracparticles.errors import InvalidInput
from fracstudy import plan
from fracstudy.benchmarks import BENCHMARKS
from fracstudy.figures import FIGURES
from fracstudy.sources import sources_of
from fracstudy.studies import STUDIES

try:
    STUDY = plan.read_config(config)
except InvalidInput as error:
    raise WorkflowError(f"configuration: {error}") from None

RESULTS = Path(STUDY.results_dir)
REPORT = Path(STUDY.report_dir)
SCENES = STUDY.scenes
CASES, BATCHES = plan.batches(SCENES, STUDY.smoke)

SRC = Path("src")
PACKAGE = SRC / "fracparticles"
STUDY_PACKAGE = SRC / "fracstudy"
# What a run depends on, and nothing else: editing a plot reruns no solver.
CORE = sources_of(PACKAGE / "run/solver.py", SRC)
# The printed claims, by the letter that the inventory gives a document.
PRINTED = {
    "L": "report/printed/lucchesi2020.yaml",
    "M": "report/printed/lewandowski2005.yaml",
    "S": "report/printed/ghorbani.yaml",
    "P": "report/printed/particle_note.yaml",
}
# What is compiled together: the solver, and what only some scenes need.
AREAS = {
    "core": CORE,
    "random_walk": [str(PACKAGE / "moving/random_walk.py")],
    "sph": sorted(map(str, PACKAGE.glob("sph/*.py"))),
}
BENCHMARK_SCENES = [name for name, scene in SCENES.items() if scene.benchmarks]
COMPILED = RESULTS / "runs/.compiled_core"
LEDGER = [RESULTS / "claims.csv", RESULTS / "claims.md"]


wildcard_constraints:
    scene="|".join(SCENES),
    benchmark="|".join(STUDY.benchmarks),
    area="|".join(AREAS),


def run_files(scene):
    """The run files of a scene."""
    return [RESULTS / "runs" / case.path for case in CASES[scene]]


def study_sources(scene):
    """The source files that a scene's study is made of; to read runs it does not take what makes them."""
    study = STUDY_PACKAGE / f"studies/{STUDIES[SCENES[scene].study]}.py"
    return sources_of(study, SRC, ends=[PACKAGE / "run/dataset.py"])


def benchmark_sources(benchmark):
    """The source files that a benchmark is made of."""
    return sources_of(STUDY_PACKAGE / f"benchmarks/{BENCHMARKS[benchmark]}.py", SRC)


def compiled_areas(scene):
    """The marks of the areas of whose compiled modules a scene's study uses any."""
    compiled = {module for module in study_sources(scene) if "@njit(" in Path(module).read_text()}
    return [
        RESULTS / f"runs/.compiled_{area}" for area, code in AREAS.items() if compiled & set(code)
    ]


def printed_files(scene):
    """The files of the documents whose items a scene judges."""
    return sorted({PRINTED[item[0]] for item in SCENES[scene].items})


def has_figure(scene):
    return SCENES[scene].figure is not None
