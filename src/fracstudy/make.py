"""Make what a scene consists of: table, findings, series, figure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from fracparticles.run.dataset import read_benchmark
from fracstudy.claims import read_claims, write_findings
from fracstudy.inputs import Inputs, Result, excuse, write_table
from fracstudy.scene import Scene, call

__all__ = ["make"]


def make(scene: Scene, given: Any, output: Any, smoke: bool) -> None:
    """Run the study of a scene, write what it gives, and draw its figure from what was written.

    Parameters
    ----------
    scene : Scene
    given : named lists of paths
        `runs`, `tables`, `benchmarks` of other scenes, and `printed`, the claims of the documents.
    output : named paths
        `csv` and `md`, the table; `findings`; `series`; `figures`, none or one a format.
    smoke : bool
        Whether the grids are too coarse to judge the claims.
    """
    claims = [claim for claim in read_claims(*given.printed) if claim.item in scene.items]
    inputs = Inputs(
        scene=scene.name,
        items=scene.items,
        parameters=scene.parameters,
        printed={claim.id: claim.printed for claim in claims if claim.printed is not None},
        runs=list(given.runs),
        tables={Path(path).stem: pd.read_csv(path) for path in given.tables},
        benchmarks={Path(path).stem: read_benchmark(path) for path in given.benchmarks},
    )
    result: Result = call(scene.function("study"), inputs, **scene.parameters)
    findings = excuse(result.findings, claims) if smoke else result.findings
    write_findings(findings, output.findings)
    series = pd.DataFrame() if result.series is None else result.series
    write_table(series, output.series)
    write_table(result.table, output.csv, output.md)
    if output.figures:
        from fracstudy.style import save

        drawn = [pd.read_csv(output.series), pd.read_csv(output.csv)]
        figure = call(scene.function("figure"), *drawn, **scene.parameters)
        save(figure, Path(output.figures[0]).with_suffix(""))
