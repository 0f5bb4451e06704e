# Run times: one file each. They differ from machine to machine; all else that is made is the same everywhere.


for job, names in BENCHMARK_JOBS.items():

    rule:
        name:
            f"benchmark_{job}"
        input:
            compiled=rules.compile.output,
        output:
            [RESULTS / f"benchmarks/{name}.nc" for name in names],
        log:
            RESULTS / f"logs/benchmark_{job}.log",
        priority: 1 if STUDY.smoke else 0  # the long ones first, where the time does not matter
        threads: 1 if STUDY.smoke else workflow.cores  # all: nothing else runs while the clock does
        resources:
            runtime=60,
            mem_mb=4000,
        params:
            code=code(*(SCENES[name].file("benchmark.py") for name in names)),
            scenes=[SCENES[name].packed() for name in names],
        message:
            f"Time {shortly(names)}."
        script:
            "../scripts/benchmark.py"


rule bench:
    input:
        expand(RESULTS / "tables/{scene}.csv", scene=FROM_TIMES),
    message:
        "All run times are there."
