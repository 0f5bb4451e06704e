"""The report: captions, figures, tables and the ledger, put together.

Every number in it comes from a data file: the tables and `claims.csv` in the results. A caption is
prose in Markdown; where it wants a printed value or ours it asks the ledger:
``{{ printed("L-C1.D") }}`` or ``{{ ours("L-C1.D") }}``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import jinja2
import markdown

from fracparticles.errors import FracparticlesError
from fracparticles.files import write_text
from fracstudy.claims import read_conventions
from fracstudy.config import Document
from fracstudy.criteria import CLOSE, Convention, Status
from fracstudy.ledger import (
    ledger_markdown,
    ours_text,
    read_ledger,
    sentence_status,
    summary_line,
)
from fracstudy.scene import Scene

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["ReportError", "build"]

FIGURE_FORMATS = (".svg", ".png")


class ReportError(FracparticlesError, ValueError):
    """Something the report needs is missing; says what, and what makes it."""


@dataclass(frozen=True)
class _Figure:
    image: str
    links: list[tuple[str, str]]


@dataclass(frozen=True)
class _Table:
    text: str
    rows: int
    csv: str


@dataclass(frozen=True)
class _Section:
    """A scene as the template sees it: text, and links relative to the report."""

    name: str
    title: str
    items: Sequence[str]
    document: str
    caption: str
    figures: list[_Figure]
    tables: list[_Table]
    summary: str
    claims: str


@dataclass(frozen=True)
class _Part:
    """A document, or what is our own: its sections, and what came of its claims."""

    title: str
    sections: list[_Section]
    summary: str
    exceptions: str


def build(
    scenes: Sequence[Scene],
    documents: Mapping[str, Document],
    results_dir: str | os.PathLike[str],
    template_dir: str | os.PathLike[str],
    out_dir: str | os.PathLike[str],
    conventions: Mapping[str, Convention] | None = None,
) -> list[Path]:
    """Build ``report.md`` and ``report.html`` from the results, the captions and the templates.

    Parameters
    ----------
    scenes : sequence of Scene
        The sections, in order.
    documents : mapping
        The parts, in order: a document or studies of our own, by the name of its folder.
    results_dir : path
        Holds ``claims.csv``, ``tables/`` and ``figures/``.
    template_dir : path
        Holds ``report.md.j2``, ``report.html.j2`` and ``style.css``.
    out_dir : path
        Where the report goes; its links to the results are relative to it.
    conventions : mapping, optional
        What the words of the documents mean; by default those of the project.

    Returns
    -------
    list of Path
        The two files, Markdown first.

    Raises
    ------
    ReportError
        If a caption, figure, table, template or the ledger is missing (naming the file and what
        makes it), if a scene shows an item without claims, or if a caption asks for what is not
        there.
    """
    results, out = Path(results_dir), Path(out_dir)
    claims_csv = results / "claims.csv"
    _require(claims_csv, _target(claims_csv))
    df = read_ledger(claims_csv)
    sections = [_section(scene, df, results, out) for scene in scenes]
    parts = _parts(documents, sections, df)
    templates = _templates(Path(template_dir))
    words = read_conventions() if conventions is None else conventions
    text = _render(
        templates["report.md.j2"],
        summary=summary_line(df),
        statuses=list(Status),
        close=CLOSE,
        conventions=[(word.replace("_", " "), of, *of.threshold) for word, of in words.items()],
        refuted=_refuted(df, sections),
        documents=parts,
        sections=[section for part in parts for section in part.sections],
        ledger=ledger_markdown(df),
        claims_csv=_link(claims_csv, out),
    )
    page = _render(
        templates["report.html.j2"],
        body=markdown.markdown(
            text, extensions=["tables", "sane_lists", "md_in_html"], output_format="html"
        ),
        style=templates["style.css"].render(),
    )
    paths = [out / "report.md", out / "report.html"]
    for path, content in zip(paths, (text, page), strict=True):
        write_text(path, content.rstrip("\n") + "\n")
    return paths


def _refuted(df: pd.DataFrame, sections: Sequence[_Section]) -> list[dict[str, str]]:
    """The refuted statements of sentences of which nothing holds, each with the section that shows it."""
    home = {item: section for section in sections for item in section.items}
    whole = df.groupby("sentence")["status"].transform(lambda words: str(sentence_status(words)))
    rows = df[(df["sentence"] != "") & (whole == str(Status.REFUTED))]
    return [
        {**row, "anchor": home[row["item"]].name, "title": home[row["item"]].title}
        for row in rows[rows["status"] == str(Status.REFUTED)].to_dict("records")
    ]


def _parts(
    documents: Mapping[str, Document], sections: Sequence[_Section], df: pd.DataFrame
) -> list[_Part]:
    parts = []
    for name, document in documents.items():
        own = [section for section in sections if section.document == name]
        if document.printed is None:
            summary = exceptions = ""
        else:
            rows = df["item"].isin([item for section in own for item in section.items])
            summary = summary_line(df, rows) if rows.any() else ""
            needs_reason = df["status"].map(lambda word: Status(word).needs_reason)
            exceptions = ledger_markdown(df, rows & needs_reason)
        if own or summary:
            parts.append(_Part(document.title, own, summary, exceptions))
    return parts


def _section(scene: Scene, df: pd.DataFrame, results: Path, out: Path) -> _Section:
    if strangers := sorted(set(scene.items) - set(df["item"])):
        raise ReportError(f"scene {scene.name}: no claims for the item {', '.join(strangers)}")
    rows = df["item"].isin(list(scene.items))
    return _Section(
        name=scene.name,
        title=scene.heading,
        items=scene.items,
        document=scene.document,
        caption=_caption(scene, df),
        figures=[_figure(results / "figures" / scene.name, scene, out)]
        if scene.file("figure.py")
        else [],
        tables=[_table(results / "tables" / scene.name, scene, out)],
        summary=summary_line(df, rows),
        claims=ledger_markdown(df, rows),
    )


def _caption(scene: Scene, df: pd.DataFrame) -> str:
    path = scene.folder / "caption.md"
    _require(path, f"write it: it is the caption of the scene {scene.name}")
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)
    by_id = df.set_index("id")

    def look_up(function: Callable[[pd.Series], str]) -> Callable[[str], str]:
        def of(claim: str) -> str:
            if claim not in by_id.index:
                raise ReportError(f"{path}: the ledger has no claim {claim}")
            return function(by_id.loc[claim])

        return of

    environment.globals["scene"] = scene
    environment.globals["printed"] = look_up(lambda row: row["printed"])
    environment.globals["ours"] = look_up(lambda row: ours_text(row["printed"], row["ours"]))
    try:
        template = environment.from_string(path.read_text(encoding="utf-8"))
    except jinja2.TemplateSyntaxError as error:
        raise ReportError(f"{path}, line {error.lineno}: {error}") from error
    return _render(template, source=path).strip()


def _figure(stem: Path, scene: Scene, out: Path) -> _Figure:
    files = [path for path in _candidates(stem, FIGURE_FORMATS) if path.is_file()]
    if not files:
        svg = _candidates(stem, FIGURE_FORMATS)[0]
        raise ReportError(f"{svg} is missing: {_target(svg, scene)}")
    links = [(path.suffix[1:].upper(), _link(path, out)) for path in files]
    return _Figure(image=links[0][1], links=links)


def _table(stem: Path, scene: Scene, out: Path) -> _Table:
    text, csv = _candidates(stem, (".md", ".csv"))
    _require(text, _target(text, scene))
    _require(csv, _target(csv, scene))
    lines = text.read_text(encoding="utf-8").strip()
    return _Table(text=lines, rows=lines.count("\n") - 1, csv=_link(csv, out))


def _candidates(stem: Path, suffixes: Sequence[str]) -> list[Path]:
    """Append to the name, which may hold a dot: `with_suffix` would cut it there."""
    return [stem.with_name(stem.name + suffix) for suffix in suffixes]


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
    names = ("report.md.j2", "report.html.j2", "style.css")
    for name in names:
        _require(directory / name, "restore it from the repository")
    return {name: environment.get_template(name) for name in names}


def _render(template: jinja2.Template, source: Path | None = None, **values: object) -> str:
    try:
        return template.render(**values)
    except jinja2.UndefinedError as error:
        raise ReportError(f"{source or template.name}: {error}") from error
