"""Turn a scene's runs into its table, findings, series and figure."""

import sys
from typing import Any

from fracstudy.make import make
from fracstudy.scene import Scene

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

make(
    Scene.model_validate_json(snakemake.params.scene),
    snakemake.input,
    snakemake.output,
    smoke=snakemake.params.smoke,
)
