"""Run the worked examples as a reader would: what each prints becomes a text, and its figure lies beside it."""

import runpy
import sys
from contextlib import chdir, redirect_stdout
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("svg")

import matplotlib.pyplot as plt

snakemake: Any
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)  # noqa: SIM115

for script, text in zip(snakemake.input.scripts, snakemake.output.texts, strict=True):
    path = Path(script).resolve()
    with (
        Path(text).open("w", encoding="utf-8") as printed,
        redirect_stdout(printed),
        chdir(Path(text).parent),
    ):
        runpy.run_path(str(path), run_name="__main__")
    plt.close("all")
