"""Collect all runs in one data set."""

import sys
from pathlib import Path
from typing import Any

from fracstudy.collect import collect

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

collect(list(snakemake.input.runs), Path(snakemake.output[0]))
