"""The report: captions, figures, tables and the ledger, put together.

Every number in it comes from a data file: the tables and `claims.csv` in the results. A caption is
prose in Markdown; where it wants a printed value or ours it asks the ledger:
``{{ printed("L-C1.D") }}`` or ``{{ ours("L-C1.D") }}``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import jinja2
import markdown

from fracparticles.errors import FracparticlesError
from fracparticles.files import write_text
from fracstudy.claims import Status
from fracstudy.ledger import ledger_markdown, ours_text, read_ledger, summary_line

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["ReportError", "SceneEntry", "build"]

FIGURE_FORMATS = (".svg", ".png")
# The documents by the letter that begins the ids of their claims.
DOCUMENTS = {
    "L": "Lucchesi et al. (2020)",
    "M": "Lewandowski (2005), the marker method",
    "S": "Ghorbani and Semperlotti, SPH",
    "P": "Lecture note on particle strength exchange",
}


class ReportError(FracparticlesError, ValueError):
    """Something the report needs is missing; says what, and what makes it."""


@dataclass(frozen=True)
class SceneEntry:
    """One section of the report.

    Parameters
    ----------
    name : str
        Name of the scene; its caption is ``<captions_dir>/<name>.md``.
    items : sequence of str
        Items of the documents whose claims the section shows: ``["L-T3", "L-C12"]``.
    title : str
        Heading of the section.
    figures : sequence of str
        Figures, each ``<results_dir>/figures/<figure>.svg``, ``.png`` or both.
    tables : sequence of str
        Tables, each ``<results_dir>/tables/<table>.md`` and ``.csv``.
    timed : bool
        Whether it shows run times: those sections come first.
    """

    name: str
    items: Sequence[str]
    title: str
    figures: Sequence[str] = ()
    tables: Sequence[str] = ()
    timed: bool = False


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
    timed: bool
    caption: str
    figures: list[_Figure]
    tables: list[_Table]
    summary: str
    claims: str


@dataclass(frozen=True)
class _Document:
    """A document, or what is our own: its sections, and what came of its claims."""

    title: str
    sections: list[_Section]
    summary: str
    exceptions: str


def build(
    scenes: Sequence[SceneEntry],
    results_dir: str | os.PathLike[str],
    captions_dir: str | os.PathLike[str],
    template_dir: str | os.PathLike[str],
    out_dir: str | os.PathLike[str],
) -> list[Path]:
    """Build ``report.md`` and ``report.html`` from the results, the captions and the templates.

    Parameters
    ----------
    scenes : sequence of SceneEntry
        The sections, in order.
    results_dir : path
        Holds ``claims.csv``, ``tables/`` and ``figures/``.
    captions_dir : path
        Holds one ``<scene>.md`` a scene.
    template_dir : path
        Holds ``report.md.j2``, ``report.html.j2`` and ``style.css``.
    out_dir : path
        Where the report goes; its links to the results are relative to it.

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
    results, captions, out = Path(results_dir), Path(captions_dir), Path(out_dir)
    claims_csv = results / "claims.csv"
    _require(claims_csv, _target(claims_csv))
    df = read_ledger(claims_csv)
    sections = [_section(scene, df, results, captions, out) for scene in scenes]
    documents = _documents(sections, df)
    templates = _templates(Path(template_dir))
    text = _render(
        templates["report.md.j2"],
        summary=summary_line(df),
        statuses=[(status.sign, str(status)) for status in Status],
        documents=documents,
        sections=[section for document in documents for section in document.sections],
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


def _documents(sections: Sequence[_Section], df: pd.DataFrame) -> list[_Document]:
    found = []
    for letter, title in DOCUMENTS.items():
        rows = df[df["id"].str.startswith(letter)]
        if len(rows):
            exceptions = rows[[Status(word).needs_reason for word in rows["status"]]]
            own = [
                section for section in sections if section.items and section.items[0][0] == letter
            ]
            text = ledger_markdown(exceptions) if len(exceptions) else ""
            found.append(_Document(title, own, summary_line(rows), text))
    timed = [section for section in sections if section.timed]
    ours = [section for section in sections if not section.items and not section.timed]
    groups = [
        *([_Document("Error against run time", timed, "", "")] if timed else []),
        *found,
        *([_Document("Studies of our own", ours, "", "")] if ours else []),
    ]
    return groups


def _section(
    scene: SceneEntry, df: pd.DataFrame, results: Path, captions: Path, out: Path
) -> _Section:
    if strangers := sorted(set(scene.items) - set(df["item"])):
        raise ReportError(f"scene {scene.name}: no claims for the item {', '.join(strangers)}")
    rows = df[df["item"].isin(list(scene.items))]
    return _Section(
        name=scene.name,
        title=scene.title,
        items=scene.items,
        timed=scene.timed,
        caption=_caption(captions / f"{scene.name}.md", scene, df),
        figures=[_figure(results / "figures" / name, scene, out) for name in scene.figures],
        tables=[_table(results / "tables" / name, scene, out) for name in scene.tables],
        summary=summary_line(rows),
        claims=ledger_markdown(rows),
    )


def _caption(path: Path, scene: SceneEntry, df: pd.DataFrame) -> str:
    _require(path, f"write it: it is the caption of the scene {scene.name}")
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)
    by_id = df.set_index("id")

    def look_up(function: Callable[[pd.Series], str]) -> Callable[[str], str]:
        def of(claim: str) -> str:
            if claim not in by_id.index:
                raise ReportError(f"{path}: the ledger has no claim {claim}")
            return function(by_id.loc[claim])

        return of

    environment.globals["printed"] = look_up(lambda row: row["printed"])
    environment.globals["ours"] = look_up(lambda row: ours_text(row["printed"], row["ours"]))
    try:
        template = environment.from_string(path.read_text(encoding="utf-8"))
    except jinja2.TemplateSyntaxError as error:
        raise ReportError(f"{path}, line {error.lineno}: {error}") from error
    return _render(template, source=path).strip()


def _figure(stem: Path, scene: SceneEntry, out: Path) -> _Figure:
    files = [path for path in _candidates(stem, FIGURE_FORMATS) if path.is_file()]
    if not files:
        svg = _candidates(stem, FIGURE_FORMATS)[0]
        raise ReportError(f"{svg} is missing: {_target(svg, scene)}")
    links = [(path.suffix[1:].upper(), _link(path, out)) for path in files]
    return _Figure(image=links[0][1], links=links)


def _table(stem: Path, scene: SceneEntry, out: Path) -> _Table:
    text, csv = _candidates(stem, (".md", ".csv"))
    _require(text, _target(text, scene))
    _require(csv, _target(csv, scene))
    lines = text.read_text(encoding="utf-8").strip()
    return _Table(text=lines, rows=lines.count("\n") - 1, csv=_link(csv, out))


def _candidates(stem: Path, suffixes: Sequence[str]) -> list[Path]:
    """Append to the name, which may hold a dot: `with_suffix` would cut it there."""
    return [stem.with_name(stem.name + suffix) for suffix in suffixes]


def _target(path: Path, scene: SceneEntry | None = None) -> str:
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
