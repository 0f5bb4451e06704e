# The solver runs: one file each, many to a job.


rule compile:
    # numba fills its cache once, before two jobs could do it at the same time.
    input:
        code=lambda wildcards: AREAS[wildcards.area],
    output:
        touch(RESULTS / "runs/.compiled_{area}"),
    log:
        RESULTS / "logs/compile_{area}.log",
    script:
        "../scripts/compile.py"


for batch, cases in BATCHES.items():

    rule:
        name:
            f"solve_{batch}"
        input:
            code=CORE,
            compiled=COMPILED,
        output:
            [RESULTS / "runs" / case.path for case in cases],
        log:
            RESULTS / f"logs/solve_{batch}.log",
        params:
            cases=[case.to_json() for case in cases],
        script:
            "../scripts/solve.py"
