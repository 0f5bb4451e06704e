"""The report builder: what it shows, where it links, and what it says when something is missing."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
import yaml

from fracstudy.claims import Claim, Finding, read_claims
from fracstudy.config import Document
from fracstudy.ledger import ledger, write_ledger
from fracstudy.report import ReportError, build
from fracstudy.scene import Scene

ROOT = Path(__file__).parents[1]
TEMPLATES = ROOT / "report/template"
SCENES = ROOT / "workflow/scenes"

LIMITS = "limits_beta0.5"  # a dot is no suffix


class Page(HTMLParser):
    """The links, images, anchors and tags of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.images: list[str] = []
        self.anchors: list[str] = []
        self.tags: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.tags.append(tag)
        self.links += [given["href"]] if "href" in given else []
        self.images += [given["src"]] if "src" in given else []
        self.anchors += [given["id"]] if "id" in given else []


@pytest.fixture
def study(tmp_path):
    """Write a study of one table, one figure and two claims; what `build` takes."""
    results, paper, own = tmp_path / "results", tmp_path / "paper", tmp_path / "own"
    for folder in (results / "tables", results / "figures", paper / "limits", own / "extreme"):
        folder.mkdir(parents=True)
    shared = {"where": "Table 3", "what": "A limit."}
    of_value = {"id": "L-T3.DD", "item": "L-T3", "kind": "value", "printed": "4.81"}
    says = {"kind": "statement", "statement": "A on |x| < D is symm."}
    given = [{**of_value, **shared}, {"id": "L-C12.sym", "item": "L-C12", **says, **shared}]
    printed = tmp_path / "paper.yaml"
    printed.write_text(yaml.safe_dump(given))
    findings = [
        Finding(claim="L-T3.DD", ours=4.8161),
        Finding(claim="L-C12.sym", verdict=False, evidence="Off by 0.3.", reason="A product."),
    ]
    rows = ledger(read_claims(str(printed)), findings)
    write_ledger(rows, results / "claims.csv", results / "claims.md")
    (results / f"tables/{LIMITS}.md").write_text("| s | a |\n|:--|--:|\n| DD | 4.8161 |\n")
    (results / f"tables/{LIMITS}.csv").write_text("s,a\nDD,4.8161\n")
    (results / "tables/extreme.md").write_text("| s |\n|:--|\n| DD |\n")
    (results / "tables/extreme.csv").write_text("s\nDD\n")
    (results / f"figures/{LIMITS}.svg").write_text("<svg/>")
    (results / f"figures/{LIMITS}.png").write_bytes(b"png")
    (paper / "limits/caption.md").write_text(
        'Printed {{ printed("L-T3.DD") }}, ours {{ ours("L-T3.DD") }}.'
    )
    (paper / "limits/figure.py").touch()
    (own / "extreme/caption.md").write_text("Where it is stiff.")
    title = "Table 3: the stability limit"
    return {
        "scenes": [
            Scene(name=LIMITS, folder=paper / "limits", title=title, items=["L-T3", "L-C12"]),
            Scene(name="extreme", folder=own / "extreme", title="Stiff and extreme cases"),
        ],
        "documents": {
            "paper": Document(title="The paper", printed=str(printed)),
            "own": Document(title="Studies of our own"),
        },
        "results_dir": results,
        "template_dir": TEMPLATES,
        "out_dir": tmp_path / "report",
    }


def test_the_report_shows_every_part(study):
    paths = build(**study)
    assert [path.name for path in paths] == ["report.md", "report.html"]
    text = paths[0].read_text("utf-8")
    assert "2 claims: 0 reproduced, 1 within the print's rounding, 0 deviate, 1 refuted" in text
    assert "Printed 4.81, ours 4.8161." in text
    assert "| DD | 4.8161 |" in text
    assert "### Claims: L-T3, L-C12" in text
    order = [
        "## Summary",
        "## Table 3: the stability limit",
        "## Stiff and extreme cases",
        "## The full ledger",
    ]
    assert [text.index(heading) for heading in order] == sorted(map(text.index, order))
    summary = text[text.index(order[0]) : text.index(order[1])]
    assert "L-C12.sym" in summary
    assert "L-T3.DD" not in summary
    extreme = text[text.index(order[2]) : text.index(order[3])]
    assert "Claims" not in extreme


def test_every_link_of_the_page_leads_somewhere_in_the_study(study):
    page_path = build(**study)[1]
    page = Page(page_path.read_text("utf-8"))
    assert page.images == ["../results/figures/limits_beta0.5.svg"]
    local = [link for link in page.links if not link.startswith(("#", "https://doi.org/"))]
    assert {*local} == {
        "../results/figures/limits_beta0.5.svg",
        "../results/figures/limits_beta0.5.png",
        "../results/tables/limits_beta0.5.csv",
        "../results/tables/extreme.csv",
        "../results/claims.csv",
    }
    assert all((page_path.parent / link).resolve().is_file() for link in local + page.images)
    inner = [link[1:] for link in page.links if link.startswith("#")]
    assert inner == ["summary", "ledger", LIMITS, "extreme"]
    assert {*inner} <= {*page.anchors}
    assert not {"script", "link", "iframe"} & {*page.tags}


def test_the_page_renders_tables_and_escapes(study):
    html = build(**study)[1].read_text("utf-8")
    assert ">A on |x| &lt; D is symm.</td>" in html
    assert "<code>L-C12.sym</code><br>" in html.replace("<br />", "<br>")
    # a table of each scene; values and statements of its claims and of the full ledger; exceptions
    assert html.count("<table>") == 2 + 2 + 2 + 1
    assert not re.search(r"^\|", html, flags=re.MULTILINE)
    assert "{{" not in html


def test_the_same_study_gives_the_same_bytes(study):
    first = [path.read_bytes() for path in build(**study)]
    assert [path.read_bytes() for path in build(**study)] == first


def test_a_figure_may_come_as_png_alone(study):
    (study["results_dir"] / "figures" / "limits_beta0.5.svg").unlink()
    page = Page(build(**study)[1].read_text("utf-8"))
    assert page.images == ["../results/figures/limits_beta0.5.png"]


def test_nothing_to_explain_is_said(study):
    claims = [Claim(id="L-T3.DD", item="L-T3", kind="value", what="A.", where="T", printed="4.81")]
    df = ledger(claims, [Finding(claim="L-T3.DD", ours=4.81)])
    write_ledger(df, study["results_dir"] / "claims.csv", study["results_dir"] / "claims.md")
    text = build(**(study | {"scenes": study["scenes"][1:]}))[0].read_text("utf-8")
    assert "Nothing deviates, is refuted or is left untested." in text


@pytest.mark.parametrize(
    ("missing", "complaint"),
    [
        ("results/claims.csv", r"claims\.csv is missing: make it with `snakemake .*claims\.csv`"),
        (
            "results/tables/limits_beta0.5.md",
            r"\.5\.md is missing: .*\.5\.md` \(scene limits_beta0\.5\)",
        ),
        ("results/tables/limits_beta0.5.csv", r"\.5\.csv is missing: .*\.5\.csv` \(scene"),
        ("own/extreme/caption.md", r"caption\.md is missing: write it.* the scene extreme"),
    ],
)
def test_what_is_missing_is_named_with_what_makes_it(study, tmp_path, missing, complaint):
    (tmp_path / missing).unlink()
    with pytest.raises(ReportError, match=complaint):
        build(**study)
    assert not (study["out_dir"] / "report.md").exists()


def test_a_missing_figure_or_template_is_named(study, tmp_path):
    with pytest.raises(ReportError, match=r"report\.md\.j2 is missing: restore it"):
        build(**(study | {"template_dir": tmp_path}))
    for figure in (study["results_dir"] / "figures").iterdir():
        figure.unlink()
    with pytest.raises(
        ReportError, match=r"limits_beta0\.5\.svg is missing: .* \(scene limits_beta0\.5\)"
    ):
        build(**study)


@pytest.mark.parametrize(
    ("caption", "complaint"),
    [
        ('{{ printed("L-T3.XX") }}', r"caption\.md: the ledger has no claim L-T3\.XX"),
        ("{{ measured }}", r"caption\.md: 'measured' is undefined"),
        ("{{ printed(", r"caption\.md, line 1"),
    ],
)
def test_a_caption_that_asks_for_what_is_not_there_is_named(study, caption, complaint):
    (study["scenes"][0].folder / "caption.md").write_text(caption)
    with pytest.raises(ReportError, match=complaint):
        build(**study)


def test_an_item_without_claims_is_refused(study):
    stranger = study["scenes"][1].model_copy(update={"items": ["L-C99"]})
    with pytest.raises(ReportError, match="scene extreme: no claims for the item L-C99"):
        build(**(study | {"scenes": [stranger]}))


SUPERSCRIPT = re.compile(r"</?su[bp]>")


@pytest.mark.parametrize(
    "caption", sorted(SCENES.glob("*/*/caption.md")), ids=lambda p: p.parent.name
)
def test_captions_are_plain_prose(caption):
    """Without headings, which would break the order of the page, and tags but sub and sup."""
    text = caption.read_text("utf-8")
    assert not re.search(r"^#", text, flags=re.MULTILINE)
    assert "<" not in SUPERSCRIPT.sub("", text).replace(" < ", "")
