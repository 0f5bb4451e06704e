"""Draw a scene's figure from its series."""

import sys
from pathlib import Path
from typing import Any

import pandas as pd

from fracstudy.figures import figure
from fracstudy.style import save

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

drawing = figure(snakemake.params.figure)(
    pd.read_csv(snakemake.input.series),
    pd.read_csv(snakemake.input.table),
    snakemake.params.parameters,
)
save(drawing, Path(snakemake.output.svg).with_suffix(""))
