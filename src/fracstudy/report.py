"""The report: pages in Markdown, one for the summary and one for each document.

They are put together from captions, figures, tables and the ledger. Every number comes from a data file: the tables and
`claims.csv` in the results. `lookup` says what a caption may ask for. The pages can be read as they are, and `site`
makes a site of them.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import jinja2

from fracparticles.errors import FracparticlesError
from fracparticles.files import write_text
from fracstudy.config import Document
from fracstudy.criteria import CLOSE, Convention
from fracstudy.ledger_text import sentence_status, short_markdown, summary_line
from fracstudy.lookup import LookUps
from fracstudy.printed import read_conventions
from fracstudy.scene import Scene
from fracstudy.verdicts import Status

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["ReportError", "build", "pages"]

FINDINGS = "findings"
FIGURE_FORMATS = (".svg", ".png")
# The most rows and columns of a table that a page shows; larger tables have a page of their own.
_INLINE = (32, 8)


class ReportError(FracparticlesError, ValueError):
    """Something that the report needs is missing; the message names it, and the command that makes it."""


@dataclass(frozen=True)
class _Section:
    """A scene as the template sees it: text, and links relative to the report."""

    name: str
    title: str
    caption: str
    figure: str
    table: str
    rows: int
    links: list[tuple[str, str]]
    runs: list[tuple[str, int]]
    items: Sequence[str]
    summary: str
    claims: str


@dataclass(frozen=True)
class _Page:
    """A document, or studies of our own: its sections, and the verdicts on its claims in a line."""

    name: str
    title: str
    sections: list[_Section]
    summary: str


def pages(documents: Mapping[str, Document], out_dir: Path) -> list[Path]:
    """Return the pages of the report, the summary first, the findings last."""
    return [out_dir / f"{name}.md" for name in ("README", *documents, FINDINGS)]


def build(
    scenes: Sequence[Scene],
    documents: Mapping[str, Document],
    results_dir: str | os.PathLike[str],
    template_dir: str | os.PathLike[str],
    out_dir: str | os.PathLike[str],
    conventions: Mapping[str, Convention] | None = None,
) -> list[Path]:
    """Build the pages from the results, the captions and the templates.

    Parameters
    ----------
    scenes : sequence of Scene
        The sections, in order.
    documents : mapping
        The pages, in order: a document or studies of our own, by the name of its folder.
    results_dir : path
        Holds ``claims.csv``, ``tables/`` and ``figures/``.
    template_dir : path
        Holds ``summary.md.j2``, ``document.md.j2`` and ``findings.md.j2``.
    out_dir : path
        The folder of the pages; their links to the results are relative to it.
    conventions : mapping, optional
        The meanings of the words of the documents; by default those of the project.

    Returns
    -------
    list of Path
        The pages, as `pages` has them.

    Raises
    ------
    ReportError
        If a caption, figure, table, template or the ledger is missing (naming the file and what
        makes it), or if a scene shows an item without claims.
    LookUpError
        If a caption asks for what is not there.
    """
    results, out = Path(results_dir), Path(out_dir)
    claims_csv = results / "claims.csv"
    _require(claims_csv, _target(claims_csv))
    look_ups = LookUps(results)
    df = look_ups.ledger
    sections = {scene.name: _section(scene, look_ups, results, out) for scene in scenes}
    parts = []
    for name, document in documents.items():
        own = [scene for scene in scenes if scene.document == name]
        summary = _summary_of(document, own, df)
        parts.append(_Page(name, document.title, [sections[scene.name] for scene in own], summary))
    templates = _templates(Path(template_dir))
    words = read_conventions() if conventions is None else conventions
    texts = [
        _render(
            templates["summary.md.j2"],
            summary=summary_line(df),
            statuses=list(Status),
            close=CLOSE,
            conventions=[(word.replace("_", " "), of, *of.threshold) for word, of in words.items()],
            refuted=_refuted(df, scenes),
            pages=parts,
            ledger=_link(results / "claims.md", out),
            claims_csv=_link(claims_csv, out),
        ),
        *(_render(templates["document.md.j2"], page=part) for part in parts),
        look_ups.filled(Path(template_dir) / f"{FINDINGS}.md.j2", results=_link(results, out)),
    ]
    paths = pages(documents, out)
    for path, text in zip(paths, texts, strict=True):
        write_text(path, text.rstrip("\n") + "\n")
    return paths


def _refuted(df: pd.DataFrame, scenes: Sequence[Scene]) -> list[dict[str, str]]:
    """The refuted statements of sentences in which nothing holds, each with the section that shows it."""
    home = {item: scene for scene in scenes for item in scene.items}
    whole = df.groupby("sentence")["status"].transform(lambda words: str(sentence_status(words)))
    rows = df[(df["sentence"] != "") & (whole == str(Status.REFUTED))]
    return [
        {**row, "link": f"{scene.document}.md#{scene.name}", "title": scene.heading}
        for row in rows[rows["status"] == str(Status.REFUTED)].to_dict("records")
        for scene in [home[row["item"]]]
    ]


def _summary_of(document: Document, scenes: Sequence[Scene], df: pd.DataFrame) -> str:
    rows = df["item"].isin([item for scene in scenes for item in scene.items])
    return summary_line(df, rows) if document.printed is not None and rows.any() else ""


def _section(scene: Scene, look_ups: LookUps, results: Path, out: Path) -> _Section:
    df = look_ups.ledger
    if strangers := sorted(set(scene.items) - set(df["item"])):
        raise ReportError(f"scene {scene.name}: no claims for the item {', '.join(strangers)}")
    rows = df["item"].isin(list(scene.items))
    caption = scene.folder / "caption.md"
    _require(caption, f"write it: it is the caption of the scene {scene.name}")
    table, length = _table(results / "tables" / scene.name, scene)
    figures = _figures(results / "figures" / scene.name, scene) if scene.file("figure.py") else []
    files = {
        "grid": scene.folder / "scene.yaml",
        "study": scene.file("study.py"),
        "drawing": scene.file("figure.py"),
        "table": results / f"tables/{scene.name}.md",
        "CSV": results / f"tables/{scene.name}.csv",
        **{path.suffix[1:].upper(): path for path in figures},
    }
    return _Section(
        name=scene.name,
        title=scene.heading,
        caption=look_ups.filled(caption, scene=scene, root=_link(Path.cwd(), out)),
        figure=_link(figures[0], out) if figures else "",
        table=table,
        rows=length,
        links=[(what, _link(path, out)) for what, path in files.items() if path is not None],
        runs=_runs(scene, results, out),
        items=scene.items,
        summary=summary_line(df, rows),
        claims=short_markdown(df, rows, _link(results / "claims.md", out)),
    )


def _runs(scene: Scene, results: Path, out: Path) -> list[tuple[str, int]]:
    """The folders of the run files of a scene, and the number of files in each."""
    folders = Counter((results / "runs" / case.path).parent for case in scene.cases)
    return [(_link(folder, out), count) for folder, count in folders.items()]


def _figures(stem: Path, scene: Scene) -> list[Path]:
    # Append to the name, which may hold a dot: `with_suffix` would cut it there.
    candidates = [stem.with_name(stem.name + suffix) for suffix in FIGURE_FORMATS]
    files = [path for path in candidates if path.is_file()]
    if not files:
        raise ReportError(f"{candidates[0]} is missing: {_target(candidates[0], scene)}")
    return files


def _table(stem: Path, scene: Scene) -> tuple[str, int]:
    """The table, or an empty text if it is too large to be shown, and the number of its rows."""
    text, csv = (stem.with_name(stem.name + suffix) for suffix in (".md", ".csv"))
    _require(text, _target(text, scene))
    _require(csv, _target(csv, scene))
    lines = text.read_text(encoding="utf-8").strip()
    rows, columns = lines.count("\n") - 1, lines.partition("\n")[0].count("|") - 1
    return (lines if rows <= _INLINE[0] and columns <= _INLINE[1] else ""), rows


def _target(path: Path, scene: Scene | None = None) -> str:
    of_scene = f" (scene {scene.name})" if scene else ""
    return f"make it with `snakemake -j2 {path.as_posix()}`{of_scene}"


def _require(path: Path, remedy: str) -> None:
    if not path.is_file():
        raise ReportError(f"{path} is missing: {remedy}")


def _link(path: Path, out: Path) -> str:
    return Path(os.path.relpath(path, out)).as_posix()


def _templates(directory: Path) -> dict[str, jinja2.Template]:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(directory),
        undefined=jinja2.StrictUndefined,
        autoescape=False,  # the Markdown is ours and escaped cell by cell
        trim_blocks=True,
        lstrip_blocks=True,
    )
    names = ("summary.md.j2", "document.md.j2")
    for name in names:
        _require(directory / name, "restore it from the repository")
    return {name: environment.get_template(name) for name in names}


def _render(template: jinja2.Template, **values: object) -> str:
    try:
        return template.render(**values)
    except jinja2.UndefinedError as error:
        raise ReportError(f"{template.name}: {error}") from error
