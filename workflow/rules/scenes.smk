# From runs to tables, findings and figures, a scene each; then the ledger and the report.

for name, scene in SCENES.items():

    rule:
        name:
            name
        input:
            runs=[RESULTS / "runs" / case.path for case in CASES[name]],
            tables=[RESULTS / f"tables/{other}.csv" for other in scene.tables],
            benchmarks=[RESULTS / f"benchmarks/{other}.nc" for other in scene.all_benchmarks],
            printed=STUDY.printed,
            reference=scene.parameters.get("reference", []),
            style="src/fracstudy/fracstudy.mplstyle",
            compiled=rules.compile.output,
        output:
            csv=RESULTS / f"tables/{name}.csv",
            md=RESULTS / f"tables/{name}.md",
            findings=RESULTS / f"findings/{name}.json",
            series=RESULTS / f"series/{name}.csv",
            figures=[
                RESULTS / f"figures/{name}.{kind}"
                for kind in ("svg", "png")
                if scene.file("figure.py")
            ],
        log:
            RESULTS / f"logs/{name}.log",
        params:
            scene=scene.model_dump_json(exclude={"runs"}),
            smoke=STUDY.smoke,
            code=code("src/fracstudy/make.py", scene.file("study.py"), scene.file("figure.py")),
        priority: 2
        script:
            "../scripts/scene.py"


rule ledger:
    input:
        findings=expand(RESULTS / "findings/{scene}.json", scene=SCENES),
        printed=STUDY.printed,
    output:
        csv=LEDGER[0],
        md=LEDGER[1],
    log:
        RESULTS / "logs/ledger.log",
    params:
        code=code("src/fracstudy/ledger.py"),
    script:
        "../scripts/ledger.py"


rule tables:
    input:
        expand(RESULTS / "tables/{scene}.csv", scene=SCENES),
        LEDGER,


rule figures:
    input:
        [RESULTS / f"figures/{name}.svg" for name, scene in SCENES.items() if scene.file("figure.py")],


rule report:
    input:
        rules.tables.input,
        rules.figures.input,
        ledger=LEDGER[0],
        captions=[scene.file("caption.md") or [] for scene in SCENES.values()],
        template=[
            "report/template/report.md.j2",
            "report/template/report.html.j2",
            "report/template/style.css",
        ],
    output:
        REPORT / "report.md",
        REPORT / "report.html",
    log:
        RESULTS / "logs/report.log",
    params:
        scenes=[scene.model_dump_json(exclude={"runs"}) for scene in SCENES.values()],
        code=code("src/fracstudy/report.py"),
        documents=STUDY.model_dump(mode="json")["documents"],
    script:
        "../scripts/report.py"
