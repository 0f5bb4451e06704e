"""The site: the README, the report, the pages of `docs` and the API, as pages that load nothing from elsewhere.

The sources are laid out in one folder, much as they are in the repository. Files that a page links to are copied there,
and the links are adapted. A link to a folder, which a site cannot show, becomes plain text.
"""

from __future__ import annotations

import ast
import html
import os
import re
import shutil
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fracparticles.errors import FracparticlesError
from fracparticles.files import write_text
from fracstudy.config import Document
from fracstudy.ledger_text import ours_text, read_ledger, summary_line
from fracstudy.scene import Scene
from fracstudy.verdicts import Status

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["SiteError", "build", "ledger_page"]

_LINK = re.compile(r"(\]\(|(?:href|src)=\")(?!https?://|#|mailto:)([^)\"#\s]+)(#[^)\"\s]*)?")
_FOLDER_LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)#\s]+)\)")
# Pages of `docs` that a newcomer reads first, and pages about the project itself.
_FIRST, _PROJECT = ("own_problem", "other_equations"), ("architecture",)
# Begins pages of tables: without it the index of the search would consist mostly of numbers.
_UNSEARCHED = "---\nsearch: {exclude: true}\n---\n\n"
_SCHEMES = ("DD", "DPSE", "FPSE", "KPSE", "GPSE", "DVM", "FD")


class SiteError(FracparticlesError, ValueError):
    """The site cannot be built as it is: a link that leads nowhere, or a complaint of the site generator."""


def build(
    scenes: Sequence[Scene],
    documents: Mapping[str, Document],
    root: Path,
    results: Path,
    report: Path,
    sources: Path,
    site: Path,
    api: bool = True,
) -> None:
    """Build the site.

    Parameters
    ----------
    scenes : sequence of Scene
        The sections of the report.
    documents : mapping
        Its pages, in order.
    root : Path
        The repository.
    results, report : Path
        The folders of the results and of the report; on the site they stand at `results` and `report`.
    sources : Path
        The folder in which the sources are laid out; it is made anew.
    site : Path
        The folder of the site; it is made anew.
    api : bool
        Whether the site has a page for each room of the library. They take half of the time, and do not depend on the
        study.

    Raises
    ------
    SiteError
        If a link of a page leads nowhere, or the site generator complains of anything.
    """
    root, results, report = root.absolute(), results.absolute(), report.absolute()
    shutil.rmtree(sources, ignore_errors=True)
    places = {report: sources / "report", results: sources / "results", root: sources}
    pages = {
        root / "README.md": sources / "index.md",
        **{root / page: sources / page for page in ("INDEX.md", "CONTRIBUTING.md", "CHANGELOG.md")},
        root / "config/README.md": sources / "config/README.md",
        root / "src/fracparticles/README.md": sources / "src/fracparticles/README.md",
        **{page: sources / "docs" / page.name for page in (root / "docs").glob("*.md")},
        **{page: sources / "report" / page.name for page in report.glob("*.md")},
        **{page: sources / "results/tables" / page.name for page in results.glob("tables/*.md")},
    }
    pages |= {results / "claims.md": sources / "results/claims.md"}
    for page in pages:
        _lay_out(page, pages, places)
    homes = {item: documents[scene.document].title for scene in scenes for item in scene.items}
    write_text(
        sources / "results/claims.md", ledger_page(read_ledger(results / "claims.csv"), homes)
    )
    shutil.copytree(root / "docs/theme", sources / "theme")
    examples = _examples(root / "examples", results / "examples", sources / "examples")
    rooms = _api(root / "src/fracparticles", sources / "api") if api else []
    _generate(root, sources, site, _navigation(documents, root, examples, rooms))
    runs = results / "runs"
    if runs.is_dir():
        (site / "results/runs").symlink_to(runs.resolve(), target_is_directory=True)


def _lay_out(page: Path, pages: Mapping[Path, Path], places: Mapping[Path, Path]) -> None:
    """Copy a page, and the files that it links to, to their places."""
    place = pages[page]

    def placed(match: re.Match[str]) -> str:
        before, link, anchor = match.groups(default="")
        target = Path(os.path.normpath(page.parent / link))
        if target in pages:
            there = pages[target]
        else:
            folder = next(folder for folder in places if target.is_relative_to(folder))
            there = places[folder] / target.relative_to(folder)
            if target.is_file():
                there.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(target, there)
            elif not target.is_dir():
                raise SiteError(f"{page}: the link {link} leads nowhere")
        return f"{before}{Path(os.path.relpath(there, place.parent)).as_posix()}{anchor}"

    def without_folder(match: re.Match[str]) -> str:
        return match[1] if (page.parent / match[2]).is_dir() else match[0]

    text = page.read_text("utf-8")
    if page.parent.name == "tables":
        text = f"{_UNSEARCHED}# {page.stem}\n\n{text}"
    write_text(place, _LINK.sub(placed, _FOLDER_LINK.sub(without_folder, text)))


def _examples(scripts: Path, outputs: Path, out: Path) -> list[Path]:
    """Write a page for each worked example: its docstring, the code, the printed output, and the figure."""
    pages = []
    for script in sorted(scripts.glob("*.py")):
        text = script.read_text("utf-8")
        words = ast.get_docstring(ast.parse(text)) or ""
        code = text.split('"""', 2)[2].strip()
        printed = (outputs / f"{script.stem}.txt").read_text("utf-8").rstrip()
        page = out / f"{script.stem}.md"
        write_text(
            page,
            f"{words}\n\n![{script.stem}]({script.stem}.svg)\n\n```python\n{code}\n```\n\n"
            f"It prints:\n\n```\n{printed}\n```\n\nThe script: `examples/{script.name}`.\n",
        )
        shutil.copyfile(outputs / f"{script.stem}.svg", out / f"{script.stem}.svg")
        pages.append(page)
    return pages


def _api(package: Path, out: Path) -> list[str]:
    """Write a page for each room of the library: its docstring, then its modules; return the rooms."""
    rooms = sorted(path.parent.name for path in package.glob("*/__init__.py"))
    for room in rooms:
        modules = sorted(
            path.stem for path in (package / room).glob("*.py") if not path.stem.startswith("_")
        )
        words = ast.get_docstring(ast.parse((package / room / "__init__.py").read_text("utf-8")))
        parts = [f"::: fracparticles.{room}.{module}\n" for module in modules]
        write_text(out / f"{room}.md", "\n".join([f"# {room}\n", f"{words or ''}\n", *parts]))
    return rooms


def _navigation(
    documents: Mapping[str, Document], root: Path, examples: Iterable[Path], rooms: Sequence[str]
) -> list[dict[str, Any]]:
    places = {stem: place for place, stem in enumerate(_FIRST)}
    own = sorted((root / "docs").glob("*.md"))
    own.sort(key=lambda page: places.get(page.stem, len(places)))
    how = [page for page in own if page.stem not in _PROJECT]
    about = [page for page in own if page.stem in _PROJECT]
    return [
        {"Home": "index.md"},
        {
            "How to": [{_title(page): f"docs/{page.name}"} for page in how]
            + [
                {"The library": "src/fracparticles/README.md"},
                {"The configuration": "config/README.md"},
            ]
        },
        {
            "Report": [
                {"Summary": "report/README.md"},
                {"Findings": "report/findings.md"},
                *({document.title: f"report/{name}.md"} for name, document in documents.items()),
            ]
        },
        {"Examples": [{_title(page): f"examples/{page.name}"} for page in examples]},
        {"Ledger": "results/claims.md"},
        *([{"API": [{room: f"api/{room}.md"} for room in rooms]}] if rooms else []),
        {
            "Project": [
                *({_title(page): f"docs/{page.name}"} for page in about),
                {"Index": "INDEX.md"},
                {"Contributing": "CONTRIBUTING.md"},
                {"Changes": "CHANGELOG.md"},
            ]
        },
    ]


def _title(page: Path) -> str:
    return page.read_text("utf-8").partition("\n")[0].lstrip("# ")


def _generate(root: Path, sources: Path, site: Path, navigation: Sequence[Any]) -> None:
    from mkdocs.commands.build import build as generate
    from mkdocs.config import load_config
    from mkdocs.exceptions import MkDocsException

    config = load_config(
        str(root / "docs/mkdocs.yml"),
        docs_dir=str(sources.resolve()),
        site_dir=str(site.resolve()),
        nav=list(navigation),
        strict=True,
    )
    try:
        generate(config)
    except MkDocsException as error:
        raise SiteError(str(error)) from error


def ledger_page(df: pd.DataFrame, homes: Mapping[str, str]) -> str:
    """Return the ledger as a page with one table, whose rows can be filtered by document, verdict, scheme and words.

    Parameters
    ----------
    df : DataFrame
        The ledger.
    homes : mapping
        The title of its document by item.
    """
    rows = "\n".join(_ledger_row(row, homes[row["item"]]) for row in df.to_dict("records"))
    choices = {
        "document": list(dict.fromkeys(homes.values())),
        "verdict": [str(status) for status in Status],
        "scheme": list(_SCHEMES),
    }
    filters = " ".join(
        f'<label>{name} <select data-filter="{name}"><option value="">all</option>'
        + "".join(f"<option>{html.escape(choice)}</option>" for choice in of)
        + "</select></label>"
        for name, of in choices.items()
    )
    return (
        f"# The ledger\n\n{summary_line(df)}.\n\n"
        f'<div class="filters">{filters} <label>words <input type="search" data-filter="words"></label> '
        '<span id="shown" role="status"></span></div>\n\n'
        '<table id="ledger"><thead><tr><th>printed</th><th>ours</th><th>verdict</th></tr></thead>\n'
        f"<tbody>\n{rows}\n</tbody></table>\n"
    )


def _ledger_row(row: Mapping[str, Any], document: str) -> str:
    status = Status(row["status"])
    text = f"{row['id']} {row['what']} {row['printed']}"
    schemes = [name for name in _SCHEMES if re.search(rf"\b{name}\b", text)]
    remarks = {
        "criterion": row["criterion"],
        "holds for": row["holds_for"],
        "not for": row["fails_for"],
        "reason": row["reason"],
        "close call": row["close_call"],
        "criterion changed": row["changed"],
        "note": row["note"],
        "made by": row["made_by"],
        "runs": row["runs"],
    }
    more = "".join(
        f"<dt>{name}</dt><dd>{html.escape(str(value))}</dd>"
        for name, value in remarks.items()
        if value
    )
    details = (
        f"<details><summary>how it is judged</summary><dl>{more}</dl></details>" if more else ""
    )
    printed = html.escape(row["printed"])
    quoted = f"“{printed}”" if row["sentence"] else printed
    ours = html.escape(ours_text(row["printed"], row["ours"]))
    data = f'data-document="{html.escape(document)}" data-verdict="{status}" data-scheme="{" ".join(schemes)}"'
    return (
        f'<tr id="{row["id"]}" {data}><td>{quoted} <small>{html.escape(row["where"])}</small><br>'
        f"{html.escape(row['what'])} <code>{row['id']}</code></td>"
        f"<td>{ours}{details}</td><td>{status.sign} {status}</td></tr>"
    )
