"""The report builder: what it shows, where it links, and what it says when something is missing."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from fracstudy.claims import Claim, Finding
from fracstudy.ledger import ledger, write_ledger
from fracstudy.report import ReportError, SceneEntry, build

REPORT = Path(__file__).parents[1] / "report"
TEMPLATES = REPORT / "template"

LIMITS = SceneEntry(
    name="limits",
    items=["L-T3", "L-C12"],
    title="Table 3: the stability limit",
    figures=["limit_beta0.5"],
    tables=["limits"],
)
EXTREME = SceneEntry(name="extreme", items=[], title="Stiff and extreme cases")
SCENES = [LIMITS, EXTREME]


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
    """Write a study of one table, one figure and two claims; its folders as `build` takes them."""
    results, captions = tmp_path / "results", tmp_path / "report" / "captions"
    for folder in (results / "tables", results / "figures", captions):
        folder.mkdir(parents=True)
    shared = {"where": "Table 3", "what": "A limit."}
    claims = [
        Claim(id="L-T3.DD", item="L-T3", kind="value", printed="4.81", **shared),
        Claim(
            id="L-C12.sym",
            item="L-C12",
            kind="statement",
            statement="A on |x| < D is symm.",
            **shared,
        ),
    ]
    findings = [
        Finding(claim="L-T3.DD", ours=4.8161),
        Finding(claim="L-C12.sym", verdict=False, evidence="Off by 0.3.", reason="A product."),
    ]
    write_ledger(ledger(claims, findings), results / "claims.csv", results / "claims.md")
    (results / "tables" / "limits.md").write_text("| s | a |\n|:--|--:|\n| DD | 4.8161 |\n")
    (results / "tables" / "limits.csv").write_text("s,a\nDD,4.8161\n")
    (results / "figures" / "limit_beta0.5.svg").write_text("<svg/>")
    (results / "figures" / "limit_beta0.5.png").write_bytes(b"png")
    (captions / "limits.md").write_text(
        'Printed {{ printed("L-T3.DD") }}, ours {{ ours("L-T3.DD") }}.'
    )
    (captions / "extreme.md").write_text("Where it is stiff.")
    return {
        "results_dir": results,
        "captions_dir": captions,
        "template_dir": TEMPLATES,
        "out_dir": tmp_path / "report",
    }


def test_the_report_shows_every_part(study):
    paths = build(SCENES, **study)
    assert [path.name for path in paths] == ["report.md", "report.html"]
    text = paths[0].read_text("utf-8")
    assert "2 claims: 0 reproduced, 1 within the print's rounding, 0 deviate, 1 refuted" in text
    assert "Printed 4.81, ours 4.8161." in text
    assert "| DD | 4.8161 |" in text
    assert "### Claims: L-T3, L-C12" in text
    order = ["## Summary", f"## {LIMITS.title}", f"## {EXTREME.title}", "## The full ledger"]
    assert [text.index(heading) for heading in order] == sorted(map(text.index, order))
    summary = text[text.index(order[0]) : text.index(order[1])]
    assert "L-C12.sym" in summary
    assert "L-T3.DD" not in summary
    extreme = text[text.index(order[2]) : text.index(order[3])]
    assert "Claims" not in extreme


def test_every_link_of_the_page_leads_somewhere_in_the_study(study):
    page_path = build(SCENES, **study)[1]
    page = Page(page_path.read_text("utf-8"))
    assert page.images == ["../results/figures/limit_beta0.5.svg"]
    local = [link for link in page.links if not link.startswith(("#", "https://doi.org/"))]
    assert {*local} == {
        "../results/figures/limit_beta0.5.svg",
        "../results/figures/limit_beta0.5.png",
        "../results/tables/limits.csv",
        "../results/claims.csv",
    }
    assert all((page_path.parent / link).resolve().is_file() for link in local + page.images)
    inner = [link[1:] for link in page.links if link.startswith("#")]
    assert inner == ["summary", "ledger", "limits", "extreme"]
    assert {*inner} <= {*page.anchors}
    assert not {"script", "link", "iframe"} & {*page.tags}


def test_the_page_renders_tables_and_escapes(study):
    html = build(SCENES, **study)[1].read_text("utf-8")
    assert ">A on |x| &lt; D is symm.</td>" in html
    assert "<code>L-C12.sym</code><br>" in html.replace("<br />", "<br>")
    # one table of the scene; values and statements of its claims and of the full ledger; exceptions
    assert html.count("<table>") == 1 + 2 + 2 + 1
    assert not re.search(r"^\|", html, flags=re.MULTILINE)
    assert "{{" not in html


def test_the_same_study_gives_the_same_bytes(study):
    first = [path.read_bytes() for path in build(SCENES, **study)]
    assert [path.read_bytes() for path in build(SCENES, **study)] == first


def test_a_figure_may_come_as_png_alone(study):
    (study["results_dir"] / "figures" / "limit_beta0.5.svg").unlink()
    page = Page(build(SCENES, **study)[1].read_text("utf-8"))
    assert page.images == ["../results/figures/limit_beta0.5.png"]


def test_nothing_to_explain_is_said(study):
    claims = [Claim(id="L-T3.DD", item="L-T3", kind="value", what="A.", where="T", printed="4.81")]
    df = ledger(claims, [Finding(claim="L-T3.DD", ours=4.81)])
    write_ledger(df, study["results_dir"] / "claims.csv", study["results_dir"] / "claims.md")
    text = build([EXTREME], **study)[0].read_text("utf-8")
    assert "Nothing deviates, is refuted or is left untested." in text


@pytest.mark.parametrize(
    ("missing", "complaint"),
    [
        ("results/claims.csv", r"claims\.csv is missing: make it with `snakemake .*claims\.csv`"),
        ("results/tables/limits.md", r"limits\.md is missing: .*limits\.md` \(scene limits\)"),
        ("results/tables/limits.csv", r"limits\.csv is missing: .*limits\.csv` \(scene limits\)"),
        ("report/captions/extreme.md", r"extreme\.md is missing: write it.* the scene extreme"),
    ],
)
def test_what_is_missing_is_named_with_what_makes_it(study, tmp_path, missing, complaint):
    (tmp_path / missing).unlink()
    with pytest.raises(ReportError, match=complaint):
        build(SCENES, **study)
    assert not (study["out_dir"] / "report.md").exists()


def test_a_missing_figure_or_template_is_named(study, tmp_path):
    with pytest.raises(ReportError, match=r"report\.md\.j2 is missing: restore it"):
        build(SCENES, **(study | {"template_dir": tmp_path}))
    for figure in (study["results_dir"] / "figures").iterdir():
        figure.unlink()
    with pytest.raises(ReportError, match=r"limit_beta0\.5\.svg is missing: .* \(scene limits\)"):
        build(SCENES, **study)


@pytest.mark.parametrize(
    ("caption", "complaint"),
    [
        ('{{ printed("L-T3.XX") }}', r"limits\.md: the ledger has no claim L-T3\.XX"),
        ("{{ measured }}", r"limits\.md: 'measured' is undefined"),
        ("{{ printed(", r"limits\.md, line 1"),
    ],
)
def test_a_caption_that_asks_for_what_is_not_there_is_named(study, caption, complaint):
    (study["captions_dir"] / "limits.md").write_text(caption)
    with pytest.raises(ReportError, match=complaint):
        build(SCENES, **study)


def test_an_item_without_claims_is_refused(study):
    stranger = SceneEntry(name="extreme", items=["L-C99"], title="Nowhere")
    with pytest.raises(ReportError, match="scene extreme: no claims for the item L-C99"):
        build([stranger], **study)


SUPERSCRIPT = re.compile(r"</?su[bp]>")


@pytest.mark.parametrize(
    "caption", sorted((REPORT / "captions").glob("*.md")), ids=lambda p: p.stem
)
def test_captions_are_plain_prose(caption):
    """Without headings, which would break the order of the page, and tags but sub and sup."""
    text = caption.read_text("utf-8")
    assert not re.search(r"^#", text, flags=re.MULTILINE)
    assert "<" not in SUPERSCRIPT.sub("", text).replace(" < ", "")
