# Run times: one file each. They differ from machine to machine; all else that is made is the same everywhere.


rule benchmark:
    input:
        code=lambda wildcards: benchmark_sources(wildcards.benchmark),
        compiled=[COMPILED, RESULTS / "runs/.compiled_random_walk"],
    output:
        RESULTS / "benchmarks/{benchmark}.nc",
    log:
        RESULTS / "logs/benchmark_{benchmark}.log",
    # More than there are, which Snakemake scales down to all: nothing else runs while the clock does.
    threads: 1024
    params:
        parameters=lambda wildcards: STUDY.benchmarks[wildcards.benchmark],
    script:
        "../scripts/benchmark.py"


rule bench:
    input:
        expand(RESULTS / "benchmarks/{benchmark}.nc", benchmark=STUDY.benchmarks),
        expand(RESULTS / "tables/{scene}.csv", scene=BENCHMARK_SCENES),
        [RESULTS / f"figures/{scene}.svg" for scene in BENCHMARK_SCENES if has_figure(scene)],
