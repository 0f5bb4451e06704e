"""The report builder: what it shows, where it links, and what it says when something is missing."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from fracstudy.config import Document
from fracstudy.criteria import Convention
from fracstudy.findings import measured
from fracstudy.ledger import ledger
from fracstudy.ledger_text import write_ledger
from fracstudy.lookup import LookUpError
from fracstudy.printed import read_printed
from fracstudy.report import ReportError, build
from fracstudy.scene import Scene
from fracstudy.verdicts import Status
from sweeps import at_once

ROOT = Path(__file__).parents[2]
TEMPLATES = ROOT / "report/template"
FINDINGS = 'A limit is {{ ours("L-T3.DD") }}.'
SCENES = ROOT / "workflow/scenes"
CAPTIONS = sorted(SCENES.glob("*/*/caption.md"))

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
    for folder in (paper / "limits", own / "extreme"):
        (folder / "scene.yaml").touch()
    (own / "extreme/caption.md").write_text("Where it is stiff.")
    templates = tmp_path / "template"
    shutil.copytree(TEMPLATES, templates)
    (templates / "findings.md.j2").write_text(FINDINGS)
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
        "template_dir": templates,
        "out_dir": tmp_path / "report",
    }


LINK = re.compile(r"\]\(([^)#]*)(#[^)]*)?\)")


def test_the_report_shows_every_part(study):
    paths = build(**study)
    assert [path.name for path in paths] == ["README.md", "paper.md", "own.md", "findings.md"]
    summary, paper, own, findings = (path.read_text("utf-8") for path in paths)
    counts = "1 printed number: 1 within the print's rounding; 1 sentence: 1 true in part."
    assert counts[:-1] in summary
    assert paper.count(counts) == 2  # of the document, of the scene
    assert "Printed 4.81, ours 4.8161." in paper
    assert "| DD | 4.8161 |" in paper
    assert "## Table 3: the stability limit" in paper
    assert "### Claims: L-T3, L-C12" in paper
    assert "## How verdicts are made" in summary
    assert "## Stiff and extreme cases" in own
    assert "Claims" not in own
    assert "“A on |x| &lt; D is symmetric with real eigenvalues.” (Sec. 4.4)<br>" in paper.replace(
        r"\|", "|"
    )
    assert findings == "A limit is 4.8161.\n"
    assert "{{" not in summary + paper + own


def test_every_link_leads_somewhere_in_the_study(study):
    pages = build(**study)
    claims = (study["results_dir"] / "claims.md").read_text("utf-8")
    found = set()
    for page in pages:
        for link, anchor in LINK.findall(page.read_text("utf-8")):
            if link.startswith("https://"):
                continue
            target = (page.parent / link).resolve() if link else page
            assert target.is_file(), link
            found.add(target.name)
            if anchor:
                text = claims if target.name == "claims.md" else target.read_text("utf-8")
                assert f'<a id="{anchor[1:]}"></a>' in text, anchor
    assert {"limits_beta0.5.svg", "limits_beta0.5.png", "limits_beta0.5.csv"} < found
    assert {"extreme.md", "extreme.csv", "claims.csv", "claims.md", "paper.md"} < found


def test_a_large_table_has_a_page_of_its_own(study):
    lines = ["| s |", "|:--|", *(f"| row {k} |" for k in range(40))]
    (study["results_dir"] / "tables/extreme.md").write_text("\n".join(lines))
    text = build(**study)[2].read_text("utf-8")
    assert "row 7" not in text
    assert "[table, 40 rows](../results/tables/extreme.md)" in text


def test_a_table_takes_the_place_of_a_figure(study):
    """The figure first; where there is none the table; the caption after either."""
    paper, own = (path.read_text("utf-8") for path in build(**study)[1:3])
    assert own.index("| ", own.index('<a id="extreme"')) < own.index("Where it is stiff.")
    assert paper.index("![") < paper.index("Printed 4.81") < paper.index("| DD | 4.8161 |")


def test_the_same_study_gives_the_same_bytes(study):
    first = [path.read_bytes() for path in build(**study)]
    assert [path.read_bytes() for path in build(**study)] == first


def test_a_figure_may_come_as_png_alone(study):
    (study["results_dir"] / "figures" / "limits_beta0.5.svg").unlink()
    page = build(**study)[1].read_text("utf-8")
    assert "](../results/figures/limits_beta0.5.png)](" in page


def test_every_verdict_and_every_word_is_explained(study):
    text = build(**study)[0].read_text("utf-8")
    section = text[text.index("## How verdicts are made") :]
    for status in Status:
        assert f"| {status.sign} {status} | {status.meaning} |" in section
    assert "| much smaller | at most 0.1 | At most a tenth. |" in section
    assert "1.5 times as large or as small" in section


def test_the_words_are_those_of_the_project(study):
    del study["conventions"]
    text = build(**study)[0].read_text("utf-8")
    assert "| several | at least 2 |" in text


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
    assert not (study["out_dir"] / "README.md").exists()


def test_a_missing_figure_or_template_is_named(study, tmp_path):
    with pytest.raises(ReportError, match=r"summary\.md\.j2 is missing: restore it"):
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
    with pytest.raises(LookUpError, match=complaint):
        build(**study)


def test_an_item_without_claims_is_refused(study):
    stranger = study["scenes"][1].model_copy(update={"items": ["L-C99"]})
    with pytest.raises(ReportError, match="scene extreme: no claims for the item L-C99"):
        build(**(study | {"scenes": [stranger]}))


SUPERSCRIPT = re.compile(r"</?su[bp]>")


@at_once(CAPTIONS)
def test_captions_are_plain_prose(caption):
    """Without headings, which would break the order of the page, and tags but sub and sup."""
    text = caption.read_text("utf-8")
    assert not re.search(r"^#", text, flags=re.MULTILINE)
    assert "<" not in SUPERSCRIPT.sub("", text).replace(" < ", "")


def allowed_numbers(scene) -> set[str]:
    """The numbers that stand in a scene's grid and in what is printed that it measures: not results of ours."""
    texts = [(scene.folder / "scene.yaml").read_text("utf-8")]
    texts += [
        p.read_text("utf-8") for p in (ROOT / "report/printed").glob(f"*/{scene.folder.name}.yaml")
    ]
    return {plain(number) for text in texts for number in NUMBER.findall(text)}


NUMBER = re.compile(r"(?<![\w.^])\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w]*\.\d)")
LOOKED_UP = re.compile(r"\{\{.*?\}\}|\{%.*?%\}", re.DOTALL)
PLACE = re.compile(r"(?:Sec|Secs|Section|Sections|Eq|Eqs|Fig|Figs|Figure|Figures|Table)\.?\s*$")
# A number with a decimal point or a per cent sign, or a factor: what a result looks like.
TYPED = re.compile(
    r"(?<![\w.^(])\d+\.\d+(?:e[-+]?\d+)?|\d+(?:\.\d+)?(?=\s*(?:%|per cent))|\d+(?:\.\d+)?(?= times)"
)


def plain(number: str) -> str:
    return f"{float(number):g}"


@at_once(CAPTIONS)
def test_no_result_is_typed_in_a_caption(caption):
    """A number in a caption is looked up, or stands in the grid of the scene or in the document."""
    from scene_functions import scenes

    scene = next(s for s in scenes().values() if s.folder.resolve() == caption.parent)
    allowed = allowed_numbers(scene)
    text = LOOKED_UP.sub("", caption.read_text("utf-8"))
    typed = [
        match[0]
        for match in TYPED.finditer(text)
        if plain(match[0]) not in allowed and not PLACE.search(text[: match.start()])
    ]
    assert typed == [], f"look these up, or say it without: {typed}"


@pytest.mark.parametrize("text", ["an error of 2.5 %", "3 times as large", "about 0.6 is better"])
def test_a_typed_result_would_be_found(text):
    assert TYPED.search(text)


PAGES = ("README.md", "src/fracparticles/README.md", "docs/*.md", "report/template/*.j2")
# What holds no result: code, addresses, look-ups, and what a machine must have.
NO_RESULT = re.compile(
    r"```.*?```|`[^`]*`|\]\([^)]*\)|doi [\d./s-]+|Python \d\.\d+|[\d.]+ (?:to [\d.]+ )?GB",
    re.DOTALL,
)


@pytest.mark.parametrize(
    "page", sorted(p for name in PAGES for p in ROOT.glob(name)), ids=lambda p: p.name
)
def test_no_result_is_typed_in_a_page(page):
    text = NO_RESULT.sub("", LOOKED_UP.sub("", page.read_text("utf-8")))
    typed = [m[0] for m in TYPED.finditer(text) if not PLACE.search(text[: m.start()])]
    assert typed == [], f"look these up, or link to the table: {typed}"


def test_the_readme_says_which_method_to_use_as_the_scene_does():
    """Situation, what to take and the line of code, row by row; what it costs stands in the report alone."""
    import yaml

    text = (SCENES / "run_times/which_method/scene.yaml").read_text("utf-8")
    rows = [
        f"| {row['situation']} | {row['take']} | `{row['code']}` |"
        for row in yaml.safe_load(text)["parameters"]["situations"]
    ]
    assert len(rows) == 6
    assert "\n".join(rows) in (ROOT / "README.md").read_text("utf-8")


def test_every_look_up_of_every_caption_and_page_is_answered_by_the_tracked_results():
    import yaml

    from fracstudy.config import read_config
    from fracstudy.lookup import LookUps

    given = yaml.safe_load((ROOT / "config/study.yaml").read_text("utf-8"))
    given |= {"scenes_dir": str(SCENES), "grids": None}
    look_ups = LookUps(ROOT / "results")
    for scene in read_config(given)[1].values():
        text = look_ups.filled(scene.folder / "caption.md", scene=scene, root=".")
        assert not re.search(r"\bnan\b|\{\{|\{%", text), scene.name
    assert look_ups.filled(TEMPLATES / "findings.md.j2", results="results")
