# Run times: one file each. They differ from machine to machine; all else that is made is the same everywhere.


rule benchmark:
    input:
        compiled=rules.compile.output,
    output:
        RESULTS / "benchmarks/{scene}.nc",
    log:
        RESULTS / "logs/benchmark_{scene}.log",
    threads: 1 if STUDY.smoke else workflow.cores  # all: nothing else runs while the clock does
    resources:
        runtime=60,
        mem_mb=4000,
    params:
        code=lambda wildcards: code(SCENES[wildcards.scene].file("benchmark.py")),
        scene=lambda wildcards: SCENES[wildcards.scene].packed(),
    script:
        "../scripts/benchmark.py"


rule bench:
    input:
        expand(RESULTS / "tables/{scene}.csv", scene=FROM_TIMES),
