"""Build the report from the tables, the figures and the ledger."""

import sys
from pathlib import Path
from typing import Any

from fracstudy.report import SceneEntry, build

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

build(
    [SceneEntry(**scene) for scene in snakemake.params.scenes],
    results_dir=Path(snakemake.input.ledger).parent,
    captions_dir=Path("report/captions"),
    template_dir=Path("report/template"),
    out_dir=Path(snakemake.output[0]).parent,
)
