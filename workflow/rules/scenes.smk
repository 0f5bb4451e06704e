# From runs to tables, findings and figures; then the ledger and the report.

for job, names in JOBS.items():

    rule:
        name:
            f"make_{job}"
        input:
            runs=[run_files(name) for name in names],
            tables=[RESULTS / f"tables/{other}.csv" for n in names for other in SCENES[n].tables],
            benchmarks=[
                RESULTS / f"benchmarks/{other}.nc"
                for n in names
                for other in SCENES[n].all_benchmarks
            ],
            printed=STUDY.all_printed(SCENES[name] for name in names),
            reference=[SCENES[name].parameters.get("reference", []) for name in names],
            style="src/fracstudy/fracstudy.mplstyle",
            compiled=rules.compile.output,
        output:
            [
                report(file, category="Figures") if file.suffix == ".svg" else file
                for name in names
                for file in files_of(name)
            ],
        log:
            RESULTS / f"logs/make_{job}.log",
        # After the last benchmark, two at a time: between two benchmarks, which take all cores, one core would wait.
        priority: -1 if not STUDY.smoke and set(names) & set(FROM_TIMES) else 0
        resources:
            runtime=30,
            mem_mb=3000,
        params:
            results=str(RESULTS),
            scenes=[SCENES[name].packed() for name in names],
            runs=[list(map(str, run_files(name))) for name in names],
            printed=[str(STUDY.printed(SCENES[name]) or "") for name in names],
            figure_formats=STUDY.figure_formats,
            code=code(
                "src/fracstudy/make.py", *(SCENES[n].file(f) for n in names for f in FUNCTIONS)
            ),
        message:
            f"Make {shortly(names)}."
        script:
            "../scripts/make.py"


# A target a scene, and one for a folder of several.
for target, names in targets(SCENES).items():

    rule:
        name:
            target
        input:
            [files_of(name) for name in names],
        message:
            f"{target} is there."


rule ledger:
    input:
        findings=expand(RESULTS / "findings/{scene}.json", scene=SCENES),
        printed=STUDY.all_printed(SCENES.values()),
        conventions=CONVENTIONS,
    output:
        csv=report(LEDGER[0], category="Claims ledger"),
        md=LEDGER[1],
    log:
        RESULTS / "logs/ledger.log",
    resources:
        runtime=5,
        mem_mb=1500,
    params:
        smoke=STUDY.smoke,
        code=code("src/fracstudy/ledger.py", "src/fracstudy/ledger_text.py"),
    message:
        "Judge every claim: {output.csv}."
    script:
        "../scripts/ledger.py"


rule tables:
    input:
        expand(RESULTS / "tables/{scene}.csv", scene=SCENES),
        LEDGER,
    message:
        "All tables are there."


rule figures:
    input:
        [
            RESULTS / f"figures/{name}.{kind}"
            for name, scene in SCENES.items()
            if scene.file("figure.py")
            for kind in STUDY.figure_formats
        ],
    message:
        "All figures are there."


rule report:
    input:
        rules.tables.input,
        rules.figures.input,
        ledger=LEDGER[0],
        conventions=CONVENTIONS,
        captions=[scene.file("caption.md") or [] for scene in SCENES.values()],
        template=sorted(Path("report/template").glob("*.md.j2")),
    output:
        pages(STUDY.documents, REPORT),
    log:
        RESULTS / "logs/report.log",
    resources:
        runtime=10,
        mem_mb=2000,
    params:
        scenes=[scene.packed(runs=True) for scene in SCENES.values()],
        code=code("src/fracstudy/report.py"),
        documents=STUDY.model_dump(mode="json")["documents"],
    message:
        "Write the report."
    script:
        "../scripts/report.py"
