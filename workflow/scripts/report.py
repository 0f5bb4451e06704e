"""Build the report from the tables, the figures and the ledger."""

import sys
from pathlib import Path
from typing import Any

from fracstudy.config import Document
from fracstudy.report import build
from fracstudy.scene import Scene

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

documents = snakemake.params.documents.items()
build(
    [Scene(**scene) for scene in snakemake.params.scenes],
    {name: Document(**document) for name, document in documents},
    results_dir=Path(snakemake.input.ledger).parent,
    template_dir=Path("report/template"),
    out_dir=Path(snakemake.output[0]).parent,
)
