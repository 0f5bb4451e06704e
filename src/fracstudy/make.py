"""Make the files of a scene: table, findings, series, figure."""

from __future__ import annotations

from collections.abc import Sequence
from inspect import signature
from pathlib import Path

import pandas as pd

from fracparticles.errors import FracparticlesError
from fracparticles.run.dataset import read_benchmark
from fracstudy.claims import Value
from fracstudy.findings import write_findings
from fracstudy.inputs import Inputs, Result, write_table
from fracstudy.printed import read_claims
from fracstudy.scene import Scene, call

__all__ = ["made", "make"]


def made(scene: Scene, results: Path, figure_formats: Sequence[str]) -> list[Path]:
    """Return the files of a scene, below the folder of the results; those of its figure come last."""
    kinds = ["tables/{}.csv", "tables/{}.md", "findings/{}.json", "series/{}.csv"]
    if scene.file("figure.py"):
        kinds += [f"figures/{{}}.{suffix}" for suffix in figure_formats]
    return [results / kind.format(scene.name) for kind in kinds]


def make(
    scene: Scene,
    results: Path,
    runs: Sequence[str],
    printed: Path | None,
    figure_formats: Sequence[str] = ("svg", "png"),
) -> None:
    """Run the study of a scene, write its results, and draw its figure from the files that were written.

    Parameters
    ----------
    scene : Scene
    results : Path
        The folder of the results: tables and benchmarks of other scenes are read there, and its own files written.
    runs : sequence of str
        Its run files, in the order of its cases.
    printed : Path, optional
        The file of the printed claims that the scene judges.
    figure_formats : sequence of str
        The formats of its figure.

    Raises
    ------
    FracparticlesError
        If the figure draws series that the study does not return.
    """
    csv, md, findings, series, *figures = made(scene, results, figure_formats)
    claims = [] if printed is None else read_claims(printed)
    inputs = Inputs(
        scene=scene.name,
        items=scene.items,
        printed={claim.id: claim.printed for claim in claims if isinstance(claim, Value)},
        runs=runs,
        tables={other: _read(results / f"tables/{other}.csv") for other in scene.tables},
        benchmarks={
            other: read_benchmark(results / f"benchmarks/{other}.nc")
            for other in scene.all_benchmarks
        },
    )
    result: Result = call(scene.function("study"), inputs, **scene.parameters)
    write_findings(result.findings, findings)
    write_table(pd.DataFrame() if result.series is None else result.series, series)
    write_table(result.table, csv, md)
    if figures:
        from fracstudy.figure_files import save

        draw = scene.function("figure")
        given = {"table": _read(csv), **scene.parameters}
        if "series" in signature(draw).parameters:
            if result.series is None:
                raise FracparticlesError(
                    f"{scene.name}: figure.py draws the series, and study.py returns none. Return Result(table, "
                    "series=...), or draw the table: figure(table)."
                )
            given["series"] = _read(series)
        drawn = call(draw, **given)
        save(drawn, figures[0].with_suffix(""), figure_formats)


def _read(table: Path) -> pd.DataFrame:
    """Read a table, each number as it was written."""
    return pd.read_csv(table, float_precision="round_trip")
