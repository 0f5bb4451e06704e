# The solver runs: one file each, several to a job.


rule compile:
    # numba fills its cache once, before two jobs could do it at the same time.
    output:
        touch(RESULTS / "runs/.compiled"),
    log:
        RESULTS / "logs/compile.log",
    priority: 2
    threads: 2  # nothing else runs before it has ended
    resources:
        runtime=10,
        mem_mb=1500,
    params:
        code=code(SOLVER),
    message:
        "Compile the functions of the package, once."
    script:
        "../scripts/compile.py"


for batch, cases in BATCHES.items():

    rule:
        name:
            f"solve_{batch}"
        input:
            compiled=rules.compile.output,
        output:
            [RESULTS / "runs" / case.path for case in cases],
        log:
            RESULTS / f"logs/solve_{batch}.log",
        # Particles that move take the longest: first.
        priority: 1 if any(case.kind.moving for case in cases) else 0
        resources:
            runtime=60,
            mem_mb=2000,
        params:
            cases=[case.to_json() for case in cases],
        message:
            f"Solve {len(cases)} cases of {shortly({case.scheme for case in cases})}."
        script:
            "../scripts/solve.py"


rule collect:
    # All of them in one data set, to be sliced by scheme, order, beta, C, h.
    input:
        runs=[RESULTS / "runs" / case.path for cases in BATCHES.values() for case in cases],
    output:
        RESULTS / "runs.nc",
    log:
        RESULTS / "logs/collect.log",
    priority: -1  # nothing waits for it: beside the site, the last of what takes one core
    resources:
        runtime=10,
        mem_mb=1500,
    params:
        code=code("src/fracstudy/collect.py"),
    message:
        "Collect all runs in one data set, {output}."
    script:
        "../scripts/collect.py"
