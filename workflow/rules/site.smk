# The worked examples, run as anyone would run them; then the site of all pages.


rule examples:
    input:
        scripts=expand("examples/{example}.py", example=EXAMPLES),
        compiled=rules.compile.output,
    output:
        texts=expand(RESULTS / "examples/{example}.txt", example=EXAMPLES),
        figures=expand(RESULTS / "examples/{example}.svg", example=EXAMPLES),
    log:
        RESULTS / "logs/examples.log",
    resources:
        runtime=5,
        mem_mb=2000,
    params:
        code=code(SOLVER),
    message:
        "Run the examples."
    script:
        "../scripts/examples.py"


rule site:
    input:
        rules.report.output,
        ["README.md", "INDEX.md", "CONTRIBUTING.md", "CHANGELOG.md", "config/README.md"],
        "src/fracparticles/README.md",
        [path for path in Path("docs").rglob("*") if path.suffix in SITE_SUFFIXES],
        rules.examples.output,
        ledger=LEDGER[0],
    output:
        SITE / "index.html",
    log:
        RESULTS / "logs/site.log",
    resources:
        runtime=10,
        mem_mb=2000,
    params:
        scenes=[scene.packed() for scene in SCENES.values()],
        code=code("src/fracstudy/site.py", SOLVER),
        documents=STUDY.model_dump(mode="json")["documents"],
        report=str(REPORT),
        api=STUDY.site_api,
    message:
        "Build the site, {output}."
    script:
        "../scripts/site.py"
