# From runs to tables, findings, figures, the ledger and the report.


rule study:
    input:
        runs=lambda wildcards: run_files(wildcards.scene),
        tables=lambda wildcards: [
            RESULTS / f"tables/{other}.csv" for other in SCENES[wildcards.scene].tables
        ],
        benchmarks=lambda wildcards: [
            RESULTS / f"benchmarks/{name}.nc" for name in SCENES[wildcards.scene].benchmarks
        ],
        printed=lambda wildcards: printed_files(wildcards.scene),
        code=lambda wildcards: study_sources(wildcards.scene),
        reference=lambda wildcards: SCENES[wildcards.scene].parameters.get("reference", []),
        compiled=lambda wildcards: compiled_areas(wildcards.scene),
    output:
        csv=RESULTS / "tables/{scene}.csv",
        md=RESULTS / "tables/{scene}.md",
        findings=RESULTS / "findings/{scene}.json",
        series=RESULTS / "series/{scene}.csv",
    log:
        RESULTS / "logs/study_{scene}.log",
    params:
        study=lambda wildcards: SCENES[wildcards.scene].study,
        parameters=lambda wildcards: SCENES[wildcards.scene].parameters,
        claimed=lambda wildcards: SCENES[wildcards.scene].items,
        tables=lambda wildcards: SCENES[wildcards.scene].tables,
        smoke=STUDY.smoke,
    script:
        "../scripts/study.py"


rule figure:
    input:
        series=RESULTS / "series/{scene}.csv",
        table=RESULTS / "tables/{scene}.csv",
        code=lambda wildcards: [
            STUDY_PACKAGE / "style.py",
            STUDY_PACKAGE / "fracstudy.mplstyle",
            STUDY_PACKAGE / f"figures/{FIGURES[SCENES[wildcards.scene].figure]}.py",
        ],
    output:
        svg=report(RESULTS / "figures/{scene}.svg", category="Figures"),
        png=RESULTS / "figures/{scene}.png",
    log:
        RESULTS / "logs/figure_{scene}.log",
    params:
        figure=lambda wildcards: SCENES[wildcards.scene].figure,
        parameters=lambda wildcards: SCENES[wildcards.scene].parameters,
    script:
        "../scripts/figure.py"


rule ledger:
    input:
        findings=expand(RESULTS / "findings/{scene}.json", scene=SCENES),
        printed=list(PRINTED.values()),
        code=[STUDY_PACKAGE / "claims.py", STUDY_PACKAGE / "ledger.py"],
    output:
        csv=report(LEDGER[0], category="Claims ledger"),
        md=LEDGER[1],
    log:
        RESULTS / "logs/ledger.log",
    script:
        "../scripts/ledger.py"


for scene in SCENES:

    rule:
        name:
            scene
        input:
            RESULTS / f"tables/{scene}.csv",
            [RESULTS / f"figures/{scene}.svg"] if has_figure(scene) else [],


rule tables:
    input:
        expand(RESULTS / "tables/{scene}.csv", scene=SCENES),
        LEDGER,


rule figures:
    input:
        [RESULTS / f"figures/{scene}.svg" for scene in SCENES if has_figure(scene)],


rule report:
    input:
        rules.tables.input,
        rules.figures.input,
        ledger=LEDGER[0],
        captions=expand("report/captions/{scene}.md", scene=SCENES),
        template=[
            "report/template/report.md.j2",
            "report/template/report.html.j2",
            "report/template/style.css",
        ],
        code=[STUDY_PACKAGE / name for name in ("report.py", "claims.py", "ledger.py")],
    output:
        REPORT / "report.md",
        REPORT / "report.html",
    log:
        RESULTS / "logs/report.log",
    params:
        scenes=[
            {
                "name": name,
                "items": scene.items,
                "title": scene.title,
                "figures": [name] if scene.figure else [],
                "tables": [name],
                "timed": bool(scene.benchmarks),
            }
            for name, scene in SCENES.items()
        ],
    script:
        "../scripts/report.py"
