"""Turn the runs of scenes into tables, findings, series and figures."""

import sys
from pathlib import Path
from typing import Any

from fracstudy.make import make
from fracstudy.scene import Scene

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

params = snakemake.params
for scene, runs, printed in zip(params.scenes, params.runs, params.printed, strict=True):
    printed = Path(printed) if printed else None
    make(Scene(**scene), Path(params.results), runs, printed, params.figure_formats)
