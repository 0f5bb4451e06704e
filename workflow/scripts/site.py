"""Build the site from the report and the pages of the repository."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fracstudy.config import Document
from fracstudy.scene import Scene
from fracstudy.site import build

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

documents = snakemake.params.documents.items()
with TemporaryDirectory() as sources:
    build(
        [Scene(**scene) for scene in snakemake.params.scenes],
        {name: Document(**document) for name, document in documents},
        root=Path.cwd(),
        results=Path(snakemake.input.ledger).parent,
        report=Path(snakemake.params.report),
        sources=Path(sources) / "pages",
        site=Path(snakemake.output[0]).parent,
        api=snakemake.params.api,
    )
