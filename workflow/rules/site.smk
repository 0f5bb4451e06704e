# The worked examples, run as anyone would run them; then the site of all pages.


rule example:
    input:
        script="examples/{example}.py",
        compiled=rules.compile.output,
    output:
        text=RESULTS / "examples/{example}.txt",
        figure=RESULTS / "examples/{example}.svg",
    log:
        RESULTS / "logs/example_{example}.log",
    resources:
        runtime=5,
        mem_mb=1500,
    params:
        code=code(SOLVER),
        python=sys.executable,
    shell:
        "script=$PWD/{input.script}; output=$PWD/{output.text}; log=$PWD/{log}; cd $(dirname {output.figure}) && "
        "MPLBACKEND=svg {params.python} $script > $output 2> $log"


rule site:
    input:
        rules.report.output,
        ["README.md", "INDEX.md", "CONTRIBUTING.md", "CHANGELOG.md", "config/README.md"],
        "src/fracparticles/README.md",
        [path for path in Path("docs").rglob("*") if path.suffix in SITE_SUFFIXES],
        expand(RESULTS / "examples/{example}.svg", example=EXAMPLES),
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
    script:
        "../scripts/site.py"
