"""The site: pages that lead somewhere, the ledger with its filters, and nothing asked of another host."""

from __future__ import annotations

import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest

from fracstudy.config import Document
from fracstudy.criteria import Convention
from fracstudy.findings import measured
from fracstudy.ledger import ledger
from fracstudy.ledger_text import write_ledger
from fracstudy.report import build as build_report
from fracstudy.scene import Scene
from fracstudy.site import SiteError, build, ledger_page

ROOT = Path(__file__).parents[2]
PAGES = ("README.md", "INDEX.md", "CONTRIBUTING.md", "CHANGELOG.md", "config/README.md")
PRINTED = """
- {id: L-T3.DD, where: Table 3, what: A limit of DD., printed: "4.81"}
- sentence: L-4.4.symmetric
  where: Sec. 4.4
  quote: A on |x| < D is symmetric.
  statements:
  - id: L-C12.sym
    what: A of KPSE is symmetric.
    holds: [{of: asymmetry, means: asymmetry of A, at_most: 0.1, why: round-off}]
"""


class Page(HTMLParser):
    """The links, sources and anchors of a page, and the rows of tables with their attributes."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.anchors: list[str] = []
        self.rows: list[dict[str, str | None]] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.links += [given[name] for name in ("href", "src") if given.get(name)]
        self.anchors += [given["id"]] if "id" in given else []
        self.rows += [given] if tag == "tr" and "id" in given else []


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A repository of one scene, its results, its report, and a library of one function."""
    from fracstudy.printed import read_printed

    root = tmp_path_factory.mktemp("repository")
    for page in (*PAGES, "src/fracparticles/README.md"):
        (root / page).parent.mkdir(parents=True, exist_ok=True)
        (root / page).write_text(f"# {page}\n\nSee [the grid](../x.txt).\n".replace("../x", "x"))
        (root / page).with_name("x.txt").write_text("x")
    (root / "README.md").write_text(
        "# Home\n\n$$u_t = 0$$\n\nThe [report](report/README.md), the [ledger](results/claims.md), "
        "[folder](config), ![figure](results/figures/limits.svg)\n"
    )
    room = root / "src/fracparticles/special"
    room.mkdir()
    (room / "__init__.py").write_text('"""Special functions."""\n')
    (room.parent / "__init__.py").write_text('"""The library."""\n')
    (room / "stable.py").write_text('"""Densities."""\n\ndef green(x):\n    """The density."""\n')
    docs = root / "docs"
    docs.mkdir()
    for name in ("mkdocs.yml", "formulas.py"):
        (docs / name).write_text((ROOT / "docs" / name).read_text())
    (docs / "theme").symlink_to(ROOT / "docs/theme")
    (docs / "how.md").write_text("# How\n\nBack [home](../README.md).\n")
    (root / "examples").mkdir()
    (root / "examples/one.py").write_text('"""# One\n\nIt prints."""\n\nprint("eleven")\n')
    (root / "results/examples").mkdir(parents=True)
    (root / "results/examples/one.txt").write_text("eleven\n")
    (root / "results/examples/one.svg").write_text("<svg/>")
    scene = root / "workflow/scenes/paper/limits"
    results = root / "results"
    for folder in (scene, results / "tables", results / "figures"):
        folder.mkdir(parents=True)
    (scene / "scene.yaml").touch()
    (scene / "figure.py").touch()
    (scene / "caption.md").write_text("A limit.")
    (results / "tables/limits.md").write_text("| s |\n|:--|\n| DD |\n")
    (results / "tables/limits.csv").write_text("s\nDD\n")
    (results / "figures/limits.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
    printed = root / "printed.yaml"
    printed.write_text(PRINTED)
    found = [measured("L-T3.DD", ours=4.8161), measured("L-C12.sym", asymmetry=0.3)]
    rows = ledger(read_printed(printed), found, {}, smoke=True)
    write_ledger(rows, results / "claims.csv", results / "claims.md")
    scenes = [Scene(name="limits", folder=scene, title="The limit", items=["L-T3", "L-C12"])]
    documents = {"paper": Document(title="The paper", printed=str(root))}
    word = {"much": Convention(at_most=0.1, means="At most a tenth.")}
    shutil.copytree(ROOT / "report/template", root / "template")
    (root / "template/findings.md.j2").write_text("# Findings\n")
    build_report(scenes, documents, results, root / "template", root / "report", word)
    return {"scenes": scenes, "documents": documents, "root": root, "rows": rows}


def built(study, folder, **more):
    root = study["root"]
    folders = {"results": root / "results", "report": root / "report", "sources": folder / "pages"}
    site = folder / "s"
    build(study["scenes"], study["documents"], root, **folders, site=site, **more)
    return site


@pytest.fixture(scope="module")
def site(study):
    return built(study, study["root"])


def test_every_link_of_every_page_leads_somewhere_on_the_site(site):
    pages = {path: Page(path.read_text("utf-8")) for path in site.rglob("*.html")}
    assert {"index.html", "claims.html", "limits.html", "how.html", "special.html"} <= {
        path.name for path in pages
    }
    for path, page in pages.items():
        if path.name == "404.html":
            continue  # its links start at the root of a server
        for link in page.links:
            assert not link.startswith(("http://", "//")), link
            if link.startswith(("https://doi.org/", "mailto:", "data:")):
                continue
            name, _, anchor = link.partition("#")
            target = (path.parent / name).resolve() if name else path
            assert target.exists(), (path, link)
            if anchor and target in pages and anchor != "__skip":
                assert anchor in pages[target].anchors, (path, link)


def test_a_formula_is_shown_without_a_script_and_a_folder_is_no_link(site):
    text = (site / "index.html").read_text("utf-8")
    assert "<math" in text
    assert "$$" not in text
    assert "folder" in text
    assert ">folder</a>" not in text


def test_an_example_is_shown_with_what_it_printed(site):
    text = (site / "examples/one.html").read_text("utf-8")
    assert text.count("eleven") == 2
    assert "one.svg" in text


def test_the_api_is_made_of_the_docstrings(site):
    text = (site / "api/special.html").read_text("utf-8")
    assert "green" in text
    assert "The density." in text
    assert "Special functions." in text


def test_the_numbers_of_the_tables_are_not_searched(site):
    tables = [page.name for page in (site / "results/tables").glob("*.html")]
    index = json.loads((site / "search/search_index.json").read_text("utf-8"))["docs"]
    assert tables
    assert any(entry["location"].startswith("report/") for entry in index)
    assert not any(entry["location"].startswith("results/tables") for entry in index)


def test_a_site_without_the_api_has_no_page_of_it_and_none_leads_there(study, tmp_path):
    out = built(study, tmp_path, api=False)
    assert not (out / "api").exists()
    assert "api/" not in (out / "index.html").read_text("utf-8")


def test_a_row_of_the_ledger_says_what_the_filters_look_for(study):
    homes = {"L-T3": "The paper", "L-C12": "The paper"}
    rows = Page(ledger_page(study["rows"], homes)).rows
    assert [row["id"] for row in rows] == ["L-T3.DD", "L-C12.sym"]
    assert [row["data-scheme"] for row in rows] == ["DD", "KPSE"]
    assert {row["data-document"] for row in rows} == {"The paper"}
    assert rows[1]["data-verdict"] == "refuted"


def test_a_link_that_leads_nowhere_is_named(study, tmp_path):
    page = study["root"] / "docs/how.md"
    kept = page.read_text()
    page.write_text("# How\n\nBack [home](../gone.md).\n")
    with pytest.raises(SiteError, match=r"how\.md: the link \.\./gone\.md leads nowhere"):
        built(study, tmp_path)
    page.write_text(kept)


def test_the_pages_of_the_project_link_to_what_is_there():
    link = re.compile(r"\]\((?!https?:|#)([^)#\s]+)")
    for page in (*PAGES, "src/fracparticles/README.md", *ROOT.glob("docs/*.md")):
        path = ROOT / page
        for target in link.findall(path.read_text("utf-8")):
            assert (path.parent / target).exists(), (path, target)
