"""The report builder: what it shows, where it links, and what it says when something is missing."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
import yaml

from fracstudy.claims import read_printed
from fracstudy.config import Document
from fracstudy.criteria import Convention, Status
from fracstudy.findings import measured
from fracstudy.ledger import ledger, write_ledger
from fracstudy.report import ReportError, build
from fracstudy.scene import Scene

ROOT = Path(__file__).parents[1]
TEMPLATES = ROOT / "report/template"
SCENES = ROOT / "workflow/scenes"

LIMITS = "limits_beta0.5"  # a dot is no suffix
WORDS = {"much_smaller": Convention(at_most=0.1, means="At most a tenth.")}
PRINTED = """
- {id: L-T3.DD, where: Table 3, what: A limit., printed: "4.81"}
- sentence: L-4.4.symmetric
  where: Sec. 4.4
  quote: A on |x| < D is symmetric with real eigenvalues.
  statements:
  - id: L-C12.sym
    what: A is symmetric.
    holds: [{of: asymmetry, means: asymmetry of A, word: much_smaller}]
    reason: A product.
  - id: L-C12.real
    what: Its eigenvalues are real.
    holds: [{of: imaginary, means: largest imaginary part, at_most: 0.1, why: round-off}]
"""


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
    """Write a study of one table, one figure, a printed number and a sentence; what `build` takes."""
    results, paper, own = tmp_path / "results", tmp_path / "paper", tmp_path / "own"
    for folder in (results / "tables", results / "figures", paper / "limits", own / "extreme"):
        folder.mkdir(parents=True)
    printed = tmp_path / "limits.yaml"
    printed.write_text(PRINTED)
    findings = [
        measured("L-T3.DD", ours=4.8161),
        measured("L-C12.sym", asymmetry=0.3),
        measured("L-C12.real", imaginary=0.0),
    ]
    rows = ledger(read_printed(printed), findings, WORDS)
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
        "conventions": WORDS,
        "documents": {
            "paper": Document(title="The paper", printed=str(tmp_path)),
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
    counts = "1 printed number: 1 within the print's rounding; 1 sentence: 1 true in part."
    assert text.count(counts) == 4  # of everything, of the document, of the scene, of the ledger
    assert "Printed 4.81, ours 4.8161." in text
    assert "| DD | 4.8161 |" in text
    assert "### Claims: L-T3, L-C12" in text
    order = [
        "## Summary",
        "## How verdicts are made",
        "## Table 3: the stability limit",
        "## Stiff and extreme cases",
        "## The full ledger",
    ]
    assert [text.index(heading) for heading in order] == sorted(map(text.index, order))
    summary = text[text.index(order[0]) : text.index(order[1])]
    assert "L-C12.sym" in summary
    assert "as a whole: ◐ true in part" in summary
    assert "L-C12.real" not in summary
    assert "L-T3.DD" not in summary
    extreme = text[text.index(order[3]) : text.index(order[4])]
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
    assert list(dict.fromkeys(inner)) == ["summary", "verdicts", "ledger", LIMITS, "extreme"]
    assert {*inner} <= {*page.anchors}
    assert not {"script", "link", "iframe"} & {*page.tags}


def test_the_page_renders_tables_and_escapes(study):
    html = build(**study)[1].read_text("utf-8")
    assert "“A on |x| &lt; D is symmetric with real eigenvalues.” (Sec. 4.4)<br>" in html
    assert "<code>L-C12.sym</code><br>" in html.replace("<br />", "<br>")
    # a table of each scene; numbers and sentences of its claims and of the full ledger; exceptions; verdicts and words
    assert html.count("<table>") == 2 + 2 + 2 + 1 + 2
    assert not re.search(r"^\|", html, flags=re.MULTILINE)
    assert "{{" not in html


def test_the_same_study_gives_the_same_bytes(study):
    first = [path.read_bytes() for path in build(**study)]
    assert [path.read_bytes() for path in build(**study)] == first


def test_a_figure_may_come_as_png_alone(study):
    (study["results_dir"] / "figures" / "limits_beta0.5.svg").unlink()
    page = Page(build(**study)[1].read_text("utf-8"))
    assert page.images == ["../results/figures/limits_beta0.5.png"]


def test_every_verdict_and_every_word_is_explained(study):
    text = build(**study)[0].read_text("utf-8")
    section = text[text.index("## How verdicts are made") : text.index("## Table 3")]
    for status in Status:
        assert f"| {status.sign} {status} | {status.meaning} |" in section
    assert "| much smaller | at most 0.1 | At most a tenth. |" in section
    assert "1.5 times as large or as small" in section


def test_the_words_are_those_of_the_project(study):
    del study["conventions"]
    text = build(**study)[0].read_text("utf-8")
    assert "| several | at least 2 |" in text


EXCEPTIONS = {
    "deviates": ({"ours": 5.0}, {}),
    "not testable": ({}, {}),
    "refuted": ({"ours": 4.81}, {"m": 2.0, "meant": 2.0}),
    "true in part": ({"ours": 4.81}, {"m": {"DD": 0.1, "KPSE": 2.0}, "meant": 2.0}),
    "misprint": ({"ours": 4.81}, {"m": 2.0, "meant": 0.0}),
}


@pytest.mark.parametrize("status", [None, *EXCEPTIONS])
def test_the_exceptions_are_all_that_is_not_simply_reproduced(study, status):
    of_value, of_statement = EXCEPTIONS.get(status, ({"ours": 4.81}, {}))
    condition = {"means": "an error", "at_most": 1.0, "why": "as it is"}
    given = [
        {"id": "L-T3.DD", "where": "T", "what": "A.", "printed": "4.81", "reason": "So."},
        {
            "sentence": "L-5.law",
            "where": "Sec. 5",
            "quote": "This is the law.",
            "statements": [
                {
                    "id": "L-C12.law",
                    "what": "A law.",
                    "holds": [{"of": "m", **condition}],
                    "intended": {"what": "Its root.", "holds": [{"of": "meant", **condition}]},
                    "reason": "So it is.",
                }
            ],
        },
    ]
    path = study["results_dir"] / "one.yaml"
    path.write_text(yaml.safe_dump(given))
    findings = [
        measured("L-T3.DD", **of_value),
        measured("L-C12.law", **(of_statement or {"m": 0.0, "meant": 0.0})),
    ]
    df = ledger(read_printed(path), findings, WORDS)
    write_ledger(df, study["results_dir"] / "claims.csv", study["results_dir"] / "claims.md")
    text = build(**study)[0].read_text("utf-8")
    summary = text[text.index("### The paper") : text.index("## How verdicts")]
    if status is None:
        assert "Everything that it prints is reproduced." in summary
    else:
        assert f"{Status(status).sign} {status} | So" in summary
        assert summary.count("| So") == 1


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
